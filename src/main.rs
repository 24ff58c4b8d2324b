//! The program `cosserat`: reads a scene, calls the library, prints and writes.

/// The commands that are more than a few lines.
mod commands {
    pub mod study;
}

use std::fmt::Display;
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use clap::{Args, Parser, Subcommand};
use cosserat::accuracy::{self, Accurate, Shortfall};
use cosserat::output::{self, Outcome};
use cosserat::scene::{Analysis, Dynamics, Scene, SceneFile, Statics};
use cosserat::solution::{Mode, Solution, SolveError, SolveFailure, Statistics};
use cosserat::{Error, Model, SceneError, dynamics, modes, statics};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Slender rods: statics, dynamics and modes of Cosserat rods described by a scene file.
///
/// Exit codes: 0 solved, 2 the command or the scene is wrong, 3 the solver stopped early,
/// 4 a file could not be read or written.
#[derive(Parser)]
#[command(version, about, long_about)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Solve a scene and write the results into a folder
    ///
    /// What the scene asks for is solved: the static equilibrium with [statics], the motion in time with
    /// [dynamics], small vibrations about the equilibrium with [modes]. The folder then holds probes.csv,
    /// reactions.csv (with joints), energies.csv (dynamics), modes.csv (modes), plot.svg, scene.toml and
    /// summary.json; tables of an earlier run that do not belong to this one are removed.
    ///
    /// With --accuracy the settings are chosen instead of taken from the scene: degree, elements, increments or
    /// time step, and tolerance. Runs are refined until the estimated error, the largest over probes and the whole
    /// path, is no larger than asked: relative to the length of all rods for positions, radians for rotations.
    #[command(verbatim_doc_comment)]
    Run {
        #[command(flatten)]
        scene: SceneArguments,
        /// The folder for the results; created if absent.
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
        /// Choose the settings that reach this accuracy, such as 1e-4.
        #[arg(long, value_name = "ERROR", allow_hyphen_values = true)]
        accuracy: Option<f64>,
        /// Show no progress.
        #[arg(long)]
        quiet: bool,
    },
    /// Read a scene, build the model and report its sizes; solve nothing.
    Check {
        #[command(flatten)]
        scene: SceneArguments,
    },
    /// Show what speed and accuracy the settings of a scene give, and name the cheapest
    ///
    /// Runs the scene with many meshes, degrees, increments or time steps (what the table [study] lists, or a
    /// selection about the scene's own settings) and holds every run against one that is far finer. The folder
    /// then holds study.csv, one row a run, study.svg, and study.json, from which the same study goes on after it
    /// was interrupted.
    #[command(verbatim_doc_comment)]
    Study {
        #[command(flatten)]
        scene: SceneArguments,
        /// The folder for the results; created if absent.
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
        /// Show no progress.
        #[arg(long)]
        quiet: bool,
    },
}

#[derive(Args)]
struct SceneArguments {
    /// The scene file.
    #[arg(value_name = "SCENE")]
    path: PathBuf,
    /// Override one entry by its dotted path, arrays by index; the value is TOML.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    overrides: Vec<String>,
}

/// Why the program did not end well.
enum Failure {
    /// The scene is wrong, or a file could not be read or written.
    Library(Error),
    /// The solver stopped early; the results are written.
    Stopped(SolveError),
    /// The solver stopped early on the way to the reference of a study.
    Reference(SolveError),
    /// The accuracy that was asked is not reached; the best results are written.
    Inaccurate(Shortfall),
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::Library(error)
    }
}

impl Failure {
    fn exit_code(&self) -> u8 {
        match self {
            Self::Library(Error::Scene(_)) => 2,
            Self::Stopped(_) | Self::Reference(_) | Self::Inaccurate(_) => 3,
            Self::Library(Error::File { .. }) => 4,
        }
    }

    fn message(&self) -> String {
        match self {
            Self::Library(error) => error.to_string(),
            Self::Stopped(error) => error.to_string(),
            Self::Reference(error) => {
                format!("the reference that all runs would be held against was not reached: {error}")
            }
            Self::Inaccurate(shortfall) => shortfall.to_string(),
        }
    }
}

fn main() -> ExitCode {
    // clap itself ends the program: 0 after --help and --version, 2 after a wrong command.
    let result = match Arguments::parse().command {
        Command::Run { scene, out, accuracy, quiet } => match accuracy {
            None => run(&scene, out, quiet),
            Some(accuracy) => run_to(&scene, out, accuracy, quiet),
        },
        Command::Check { scene } => check(&scene),
        Command::Study { scene, out, quiet } => commands::study::study(&scene, &out, quiet),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            print_error(failure.message());
            ExitCode::from(failure.exit_code())
        }
    }
}

/// Reads the scene and builds the model; errors of both carry their place in the file.
fn load(arguments: &SceneArguments) -> Result<(SceneFile, Scene, Model), Error> {
    let file = SceneFile::read(&arguments.path, &arguments.overrides)?;
    let scene = file.scene()?;
    let model = Model::new(&scene).map_err(|error| located(&file, error))?;
    Ok((file, scene, model))
}

fn located(file: &SceneFile, error: Error) -> Error {
    match error {
        // Options are in no file.
        Error::Scene(error) if !error.key.starts_with("--") => Error::Scene(file.locate(error)),
        other => other,
    }
}

fn run(arguments: &SceneArguments, out: PathBuf, quiet: bool) -> Result<(), Failure> {
    let start = Instant::now();
    let (_, scene, model) = load(arguments)?;
    refuse_overwriting(&arguments.path, &out)?;
    output::prepare(&out)?;
    let setup_seconds = start.elapsed().as_secs_f64();

    let start = Instant::now();
    let bar = progress_bar(quiet);
    let mut progress = |done: f64, work: &Statistics| {
        // A position in thousandths of the load or the time; the bar draws itself a few times a second at most.
        bar.set_position((1000.0 * done.clamp(0.0, 1.0)) as u64);
        bar.set_message(work_so_far(&scene, done, work));
    };
    let (solution, failure) = match solve(&scene, &model, &mut progress) {
        Ok(solution) => (solution, None),
        Err(stopped) => (stopped.partial, Some(stopped.error)),
    };
    bar.finish_and_clear();
    let solve_seconds = start.elapsed().as_secs_f64();
    let outcome = Outcome { solution, failure, accuracy: None, setup_seconds, solve_seconds };
    finish(&out, &scene, outcome)
}

/// Solves with settings that reach an accuracy.
fn run_to(arguments: &SceneArguments, out: PathBuf, accuracy: f64, quiet: bool) -> Result<(), Failure> {
    let start = Instant::now();
    let file = SceneFile::read(&arguments.path, &arguments.overrides)?;
    let scene = file.scene().map_err(Error::from)?;
    accuracy::check(&scene, accuracy).map_err(|error| located(&file, error))?;
    refuse_overwriting(&arguments.path, &out)?;
    output::prepare(&out)?;
    let setup_seconds = start.elapsed().as_secs_f64();

    let start = Instant::now();
    let bar = progress_bar(quiet);
    let mut progress = |run: usize, done: f64, work: &Statistics| {
        bar.set_position((1000.0 * done.clamp(0.0, 1.0)) as u64);
        bar.set_message(format!("run {run}: {}", work_so_far(&scene, done, work)));
    };
    let found = accuracy::solve_to(&scene, accuracy, &mut progress);
    bar.finish_and_clear();
    let Accurate { scene, solution, report } = found?;
    let failure = match &report.shortfall {
        Some(Shortfall::Solver(error)) => Some(error.clone()),
        _ => None,
    };
    let solve_seconds = start.elapsed().as_secs_f64();
    finish(&out, &scene, Outcome { solution, failure, accuracy: Some(report), setup_seconds, solve_seconds })
}

/// Writes and reports what came out.
fn finish(out: &Path, scene: &Scene, outcome: Outcome) -> Result<(), Failure> {
    if let Err(error) = output::write(out, scene, &outcome) {
        // The error that ends the program says only that a file failed.
        if let Some(message) = outcome.stopped() {
            print_error(message);
        }
        return Err(error.into());
    }
    report(scene, &outcome);
    say(format_args!("results in {}", out.display()));
    if let Some(error) = outcome.failure {
        return Err(Failure::Stopped(error));
    }
    outcome
        .accuracy
        .and_then(|report| report.shortfall)
        .map_or(Ok(()), |short| Err(Failure::Inaccurate(short)))
}

fn solve(
    scene: &Scene,
    model: &Model,
    progress: &mut dyn FnMut(f64, &Statistics),
) -> Result<Solution, Box<SolveFailure>> {
    match scene.analysis() {
        Some(Analysis::Statics(options)) => statics::solve(model, options, progress),
        Some(Analysis::Dynamics(options)) => dynamics::solve(model, options, progress),
        Some(Analysis::Modes(options)) => modes::solve(model, options, progress),
        None => statics::solve(model, &Statics::default(), progress),
    }
}

/// Beside the bar; `done` is the load factor, or the fraction of the end time.
fn work_so_far(scene: &Scene, done: f64, work: &Statistics) -> String {
    let iterations = work.newton_iterations;
    match scene.analysis() {
        Some(Analysis::Dynamics(Dynamics { end_time, .. })) => {
            let time = done * end_time;
            format!("{time:.3} of {end_time} s, {} steps, {iterations} iterations", work.increments)
        }
        _ => format!("{} increments, {iterations} iterations", work.increments),
    }
}

/// The results hold the scene with its defaults as `scene.toml`; that must not be the user's own file.
fn refuse_overwriting(scene: &Path, out: &Path) -> Result<(), Error> {
    let written = out.join("scene.toml");
    match (scene.canonicalize(), written.canonicalize()) {
        (Ok(scene), Ok(written)) if scene == written => Err(Error::Scene(SceneError::new(
            "--out",
            format!("is the folder of {}, which the results would overwrite", scene.display()),
            "another folder",
        ))),
        _ => Ok(()),
    }
}

fn check(arguments: &SceneArguments) -> Result<(), Failure> {
    let (_, scene, model) = load(arguments)?;
    list_rods(&model);
    list_bodies(&model);
    say(format_args!(
        "joints: {}, loads: {}, probes: {}, unknowns: {}",
        scene.joint.len(),
        scene.load.len(),
        scene.probe.len(),
        model.unknowns()
    ));
    for warning in model.warnings() {
        say(format_args!("warning: {warning}"));
    }
    Ok(())
}

fn list_rods(model: &Model) {
    for rod in model.rods() {
        say(format_args!(
            "rod {}: {} elements of degree {}, {} nodes, length {} m",
            rod.name, rod.elements, rod.degree, rod.nodes, rod.length
        ));
    }
}

fn list_bodies(model: &Model) {
    for body in model.bodies() {
        let inertia = body.mass.inertia;
        say(format_args!(
            "body {}: mass {} kg, principal inertia {} {} {} kg m²",
            body.name, body.mass.mass, inertia.x, inertia.y, inertia.z
        ));
    }
}

fn report(scene: &Scene, outcome: &Outcome) {
    let solution = &outcome.solution;
    let work = &solution.statistics;
    let status = match outcome.stopped() {
        None => "solved",
        Some(_) => "stopped early",
    };
    let (parts, iterations) = match scene.analysis() {
        Some(Analysis::Dynamics(_)) => ("steps", iterations_of_steps(work)),
        _ => ("increments", format!("{} Newton iterations", work.newton_iterations)),
    };
    say(format_args!(
        "{status}: {} unknowns, {} {parts} ({} rejected), {iterations}, {:.3} s",
        solution.unknowns,
        work.increments,
        work.rejected,
        outcome.setup_seconds + outcome.solve_seconds
    ));
    if let Some(accuracy) = &outcome.accuracy {
        say(accuracy);
    }
    report_energy(scene, solution);
    report_modes(&solution.modes);
    for warning in &solution.warnings {
        say(format_args!("warning: {warning}"));
    }
}

/// In all, mean and most; the mean with those of rejected steps, which are work too.
fn iterations_of_steps(work: &Statistics) -> String {
    let iterations = format!("{} Newton iterations", work.newton_iterations);
    match work.increments {
        0 => iterations,
        steps => {
            let mean = work.newton_iterations as f64 / steps as f64;
            format!("{iterations} ({mean:.2} a step, {} at most)", work.most_iterations)
        }
    }
}

/// Nothing where no energies are recorded.
fn report_energy(scene: &Scene, solution: &Solution) {
    if let (Some(first), Some(last)) = (solution.energies.first(), solution.energies.last()) {
        let (start, end) = (first.total(), last.total());
        let what = if scene.load.is_empty() { "drift" } else { "change, with the work of the loads," };
        say(format_args!(
            "total energy: {start:.6e} J at the start, {end:.6e} J at the end, {what} {:.3e} J",
            end - start
        ));
    }
}

/// Nothing where there are no modes.
fn report_modes(modes: &[Mode]) {
    if modes.is_empty() {
        return;
    }
    say(format_args!("{:>4}  {:>14}  {:>14}", "mode", "f [Hz]", "ω [rad/s]"));
    for (index, mode) in modes.iter().enumerate() {
        let unstable = if mode.angular_frequency < 0.0 { "  unstable" } else { "" };
        say(format_args!(
            "{:>4}  {:>14}  {:>14}{unstable}",
            index + 1,
            seven_digits(mode.frequency()),
            seven_digits(mode.angular_frequency)
        ));
    }
}

/// Fixed where that reads well, scientific elsewhere.
fn seven_digits(number: f64) -> String {
    let size = number.abs();
    if (1e-3..1e6).contains(&size) {
        let decimals = (6 - size.log10().floor() as i32).max(0) as usize;
        format!("{number:.decimals$}")
    } else {
        format!("{number:.6e}")
    }
}

/// Prints a line on stdout; a reader that has gone away (`| head`) is no error.
fn say(line: impl Display) {
    let _ = writeln!(std::io::stdout(), "{line}");
}

fn print_error(error: impl Display) {
    let _ = writeln!(std::io::stderr(), "error: {error}");
}

/// A bar on stderr, or none if nobody would see it move.
fn progress_bar(quiet: bool) -> ProgressBar {
    if quiet || !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::with_draw_target(Some(1000), ProgressDrawTarget::stderr());
    // The template is fixed; should it ever be wrong, the plain bar will do.
    if let Ok(style) = ProgressStyle::with_template("{wide_bar} {percent}%  {msg}") {
        bar.set_style(style);
    }
    bar
}
