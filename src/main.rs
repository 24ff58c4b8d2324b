//! The program `cosserat`: reads a scene, calls the library, prints and writes.

use std::fmt::Display;
use std::io::{IsTerminal, Write};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use clap::{Args, Parser, Subcommand};
use cosserat::output::{self, Outcome};
use cosserat::scene::{Scene, SceneFile};
use cosserat::solution::{SolveError, Statistics};
use cosserat::{Error, Model, statics};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Slender rods: solves Cosserat rods described by a scene file.
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
    /// Solve a scene and write the results into a folder.
    Run {
        #[command(flatten)]
        scene: SceneArguments,
        /// The folder for the results; created if absent.
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
        /// Show no progress.
        #[arg(long)]
        quiet: bool,
    },
    /// Read a scene, build the model and report its sizes; solve nothing.
    Check {
        #[command(flatten)]
        scene: SceneArguments,
    },
    /// Speed against accuracy on a scene (not available yet).
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
    /// The command asks for what is not there yet.
    Unavailable(&'static str),
    /// The scene is wrong, or a file could not be read or written.
    Library(Error),
    /// The solver stopped early; the results are written.
    Stopped(SolveError),
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::Library(error)
    }
}

impl Failure {
    fn exit_code(&self) -> u8 {
        match self {
            Self::Unavailable(_) | Self::Library(Error::Scene(_)) => 2,
            Self::Stopped(_) => 3,
            Self::Library(Error::File { .. }) => 4,
        }
    }

    fn message(&self) -> String {
        match self {
            Self::Unavailable(command) => {
                format!("the command `{command}` is not available yet; expected `run` or `check`")
            }
            Self::Library(error) => error.to_string(),
            Self::Stopped(error) => error.to_string(),
        }
    }
}

fn main() -> ExitCode {
    // clap itself ends the program: 0 after --help and --version, 2 after a wrong command.
    let result = match Arguments::parse().command {
        Command::Run { scene, out, quiet } => run(&scene, out, quiet),
        Command::Check { scene } => check(&scene),
        Command::Study { .. } => Err(Failure::Unavailable("study")),
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
fn load(arguments: &SceneArguments) -> Result<(Scene, Model), Error> {
    let file = SceneFile::read(&arguments.path, &arguments.overrides)?;
    let scene = file.scene()?;
    let model = Model::new(&scene).map_err(|error| match error {
        Error::Scene(error) => Error::Scene(file.locate(error)),
        other => other,
    })?;
    Ok((scene, model))
}

fn run(arguments: &SceneArguments, out: PathBuf, quiet: bool) -> Result<(), Failure> {
    let start = Instant::now();
    let (scene, model) = load(arguments)?;
    output::prepare(&out)?;
    let options = scene.statics.clone().unwrap_or_default();
    let setup_seconds = start.elapsed().as_secs_f64();

    let start = Instant::now();
    let bar = progress_bar(quiet);
    let mut progress = |load_factor: f64, work: &Statistics| {
        // A position in thousandths of the load; the bar draws itself a few times a second at most.
        bar.set_position((1000.0 * load_factor.clamp(0.0, 1.0)) as u64);
        bar.set_message(format!("{} increments, {} iterations", work.increments, work.newton_iterations));
    };
    let (solution, failure) = match statics::solve(&model, &options, &mut progress) {
        Ok(solution) => (solution, None),
        Err(stopped) => (stopped.partial, Some(stopped.error)),
    };
    bar.finish_and_clear();
    let outcome = Outcome { solution, failure, setup_seconds, solve_seconds: start.elapsed().as_secs_f64() };

    if let Err(error) = output::write(&out, &scene, &outcome) {
        // The error that ends the program says only that a file failed.
        if let Some(stopped) = &outcome.failure {
            print_error(stopped);
        }
        return Err(error.into());
    }
    report(&outcome);
    say(format_args!("results in {}", out.display()));
    outcome.failure.map_or(Ok(()), |error| Err(Failure::Stopped(error)))
}

fn check(arguments: &SceneArguments) -> Result<(), Failure> {
    let (scene, model) = load(arguments)?;
    for rod in model.rods() {
        say(format_args!(
            "rod {}: {} elements of degree {}, {} nodes, length {} m",
            rod.name, rod.elements, rod.degree, rod.nodes, rod.length
        ));
    }
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

fn report(outcome: &Outcome) {
    let solution = &outcome.solution;
    let work = &solution.statistics;
    let status = match outcome.failure {
        None => "solved",
        Some(_) => "stopped early",
    };
    say(format_args!(
        "{status}: {} unknowns, {} increments ({} rejected), {} Newton iterations, {:.3} s",
        solution.unknowns,
        work.increments,
        work.rejected,
        work.newton_iterations,
        outcome.setup_seconds + outcome.solve_seconds
    ));
    for warning in &solution.warnings {
        say(format_args!("warning: {warning}"));
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
