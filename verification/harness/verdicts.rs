//! Verdicts and the report: what fails must be seen to fail.

use std::time::Duration;

use cosserat::scene::Scene;

use super::{REASON, SOURCE, is};
use crate::case::{Case, Checks, Kind, Outcome, Trajectory};
use crate::measure::solve;
use crate::report::{Environment, Record, Report, Verdict};

pub fn all() -> Vec<Case> {
    vec![
        Case::new("harness::verdicts", SOURCE, verdicts),
        Case::new("harness::report", SOURCE, report),
        Case::new("harness::names", SOURCE, names),
    ]
}

/// A scene that needs more Newton iterations than it may have.
const STOPS: &str = r#"
[[rod]]
name = "rod"
curve = { kind = "line", length = 1.0 }
section = { kind = "circle", diameter = 0.01 }
material = { young_modulus = 1e9, poisson_ratio = 0.3 }
elements = 4
degree = 2
[[joint]]
kind = "rigid"
between = ["ground", "rod@0"]
[[load]]
kind = "force"
on = "rod@1"
value = [0.0, 100.0, 0.0]
[statics]
increments = 1
max_iterations = 1
"#;

fn good(checks: &mut Checks) -> Outcome {
    checks.below(Kind::Invariant, "less", 1.0, 2.0, REASON);
    Ok(())
}

fn bad(checks: &mut Checks) -> Outcome {
    checks.below(Kind::Invariant, "less", 3.0, 2.0, REASON);
    good(checks)
}

fn not_a_number(checks: &mut Checks) -> Outcome {
    checks.absolute(Kind::ClosedForm, "nan & <b>", (f64::NAN, 1.0), 1.0, REASON);
    Ok(())
}

fn stops(checks: &mut Checks) -> Outcome {
    good(checks)?;
    solve(&Scene::from_toml(STOPS)?).map(|_| ())
}

fn unavailable(_: &mut Checks) -> Outcome {
    let scene = Scene::from_toml(&STOPS.replace("degree = 2", "degree = 2\ntheory = \"inextensible\""))?;
    solve(&scene).map(|_| ())
}

fn mistaken(_: &mut Checks) -> Outcome {
    Scene::from_toml(&STOPS.replace("elements = 4", "elements = 0"))?;
    Ok(())
}

fn empty(_: &mut Checks) -> Outcome {
    Ok(())
}

fn record(case: &Case) -> Record {
    let mut checks = Checks::of(case);
    let outcome = (case.run)(&mut checks);
    Record::new(case, outcome, checks, Duration::from_millis(1500))
}

fn verdicts(checks: &mut Checks) -> Outcome {
    let case = |run| Case::new("made_up::case", SOURCE, run);
    let attempts = [
        ("a check that holds", case(good), Verdict::Passed),
        ("a check that does not", case(bad), Verdict::Failed),
        ("not a number", case(not_a_number), Verdict::Failed),
        ("no check", case(empty), Verdict::Failed),
        ("a solver that stops early", case(stops), Verdict::Diverged),
        ("what is not available yet, awaited", case(unavailable).awaits("it"), Verdict::Unsupported),
        ("what is not available yet, not awaited", case(unavailable), Verdict::Failed),
        ("what is awaited and there", case(good).awaits("it"), Verdict::Failed),
        ("a mistake in the scene", case(mistaken), Verdict::Failed),
        ("a mistake in the scene that awaits something", case(mistaken).awaits("it"), Verdict::Failed),
        ("a file that was declared and not read", case(good).reads(&["made_up/values.csv"]), Verdict::Failed),
    ];
    for (name, case, expected) in attempts {
        let record = record(&case);
        is(checks, format!("{name}: {}", expected.name()), record.verdict == expected);
        let fine = matches!(expected, Verdict::Passed | Verdict::Unsupported);
        is(
            checks,
            format!("{name}: the run {}", if fine { "goes on" } else { "fails" }),
            record.is_fine() == fine,
        );
    }
    Ok(())
}

fn shown(checks: &mut Checks) -> Outcome {
    checks.order("made up", &[1, 2, 4], &[1.0, 0.3, f64::NAN], (2.0, 0.1), REASON);
    let points = vec![[0.0, 1.0], [1.0, f64::NAN], [2.0, 3.0]];
    checks.trajectory(Trajectory {
        title: "made-up path".to_string(),
        axes: ["t [s]", "x [m]"],
        measured: points.clone(),
        source: "nobody",
        reference: points,
    });
    Ok(())
}

fn report(checks: &mut Checks) -> Outcome {
    let of = |cases: Vec<Case>, not_run| {
        let records = cases.iter().map(record).collect();
        Report::new(records, not_run, "fast".to_string(), Environment::find())
    };
    let passed = of(vec![Case::new("made_up::good", SOURCE, good)], vec!["made_up::skipped"]);
    let failing = [good, bad, not_a_number, stops, shown];
    let names = ["made_up::good", "made_up::bad", "made_up::nan", "other::stops", "other::shown"];
    let cases = names.iter().zip(failing).map(|(name, run)| Case::new(name, SOURCE, run)).collect();
    let failed = of(cases, Vec::new());
    is(checks, "one good case: passed", passed.verdict == Verdict::Passed);
    is(checks, "one of five good: failed", failed.verdict == Verdict::Failed);
    is(checks, "no case at all: failed", of(Vec::new(), Vec::new()).verdict == Verdict::Failed);

    let (good, bad) = (passed.html()?, failed.html()?);
    is(checks, "the page opens with a pass", good.contains("<div class=\"verdict passed\""));
    is(checks, "the page opens with a failure", bad.contains("<div class=\"verdict failed\""));
    is(checks, "what was not run is named", good.contains("<code>made_up::skipped</code>"));
    is(checks, "words are escaped", bad.contains("nan &amp; &lt;b&gt;") && !bad.contains("nan & <b>"));
    is(checks, "the solver's words are there", bad.contains("iteration"));
    is(checks, "both pictures are there", bad.matches("<svg").count() == 2);
    let outside = ["http://", "https://", "src=", "@import"];
    let plain = bad.replace("http://www.w3.org/2000/svg", "");
    is(checks, "the page needs nothing else", outside.iter().all(|word| !plain.contains(word)));

    let (good, bad) = (passed.junit()?, failed.junit()?);
    is(
        checks,
        "JUnit counts the failures",
        bad.contains("failures=\"4\"") && good.contains("failures=\"0\""),
    );
    is(checks, "JUnit names what was not run", good.contains("<skipped message=\"not in this run\""));
    let json = serde_json::to_value(&failed)?;
    is(checks, "JSON has the verdict", json["verdict"] == "failed" && json["counts"]["diverged"] == 1);
    let first = &json["cases"][0];
    is(checks, "JSON puts failures first", first["verdict"] == "failed");
    is(checks, "a number that is none is null", json.to_string().contains("\"measured\":null"));
    Ok(())
}

/// Two cases of one name would hide each other.
fn names(checks: &mut Checks) -> Outcome {
    let mut names: Vec<&str> = crate::cases::all().iter().map(|case| case.name).collect();
    let count = names.len();
    names.sort_unstable();
    names.dedup();
    is(checks, "no two cases have one name", names.len() == count);
    is(checks, "every case is problem::what", names.iter().all(|name| name.split("::").count() == 2));
    is(checks, "there are more than sixty", count > 60);
    Ok(())
}
