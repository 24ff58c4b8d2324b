//! Results as files: tables, a summary, a plot and the scene as solved.

mod csv;
pub mod study;
mod summary;
mod svg;

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::Instant;

use crate::accuracy::Report;
use crate::error::Error;
use crate::scene::{Analysis, Scene};
use crate::solution::{Solution, SolveError};

/// What came out of a solve.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The solution, or as much of it as converged.
    pub solution: Solution,
    /// Why it stopped early; absent when the scene was solved.
    pub failure: Option<SolveError>,
    /// Where an accuracy was asked for, what is known of the error.
    pub accuracy: Option<Report>,
    /// Time spent reading the scene and building the model [s].
    pub setup_seconds: f64,
    /// Time spent solving [s].
    pub solve_seconds: f64,
}

impl Outcome {
    /// Why there is not what was asked for; absent where there is.
    pub fn stopped(&self) -> Option<String> {
        let shortfall = self.accuracy.as_ref().and_then(|report| report.shortfall.as_ref());
        self.failure.as_ref().map(ToString::to_string).or(shortfall.map(ToString::to_string))
    }
}

/// Creates the folder for the results if it is absent, so that a folder that cannot be made is known
/// before anything is solved, and removes the summary of an earlier run: should this one be killed,
/// nothing must say that it was solved.
///
/// # Errors
/// [`Error::File`] if it cannot be created, or the summary not removed.
pub fn prepare(dir: &Path) -> Result<(), Error> {
    create(dir)?;
    remove(dir.join("summary.json"))
}

/// Creates the folder for the results if it is absent.
///
/// # Errors
/// [`Error::File`] if it cannot be created.
pub fn create(dir: &Path) -> Result<(), Error> {
    std::fs::create_dir_all(dir).map_err(|source| cannot_write(dir, source))
}

/// A solution with the scene it belongs to.
#[derive(Clone, Copy)]
struct Results<'a> {
    scene: &'a Scene,
    solution: &'a Solution,
}

impl Results<'_> {
    /// The analysis as it is named in the scene file.
    fn analysis(self) -> &'static str {
        match self.scene.analysis() {
            Some(Analysis::Dynamics(_)) => "dynamics",
            Some(Analysis::Modes(_)) => "modes",
            Some(Analysis::Statics(_)) | None => "statics",
        }
    }

    /// The name of what the rows follow one another in.
    fn parameter(self) -> &'static str {
        match self.scene.analysis() {
            Some(Analysis::Dynamics(_)) => "time",
            Some(Analysis::Statics(_) | Analysis::Modes(_)) | None => "load_factor",
        }
    }
}

/// Writes all results into `dir`, which is created if absent: `probes.csv`, `reactions.csv` if the
/// scene has joints, `energies.csv` in dynamics, `modes.csv` in modes, `plot.svg`, `scene.toml` and
/// `summary.json`. After an early stop they hold what had converged; in modes, the rows of probes and
/// reactions are the static path to the equilibrium.
///
/// Those of the tables that this scene does not have are removed from `dir`, so that what lies there
/// together belongs together; files of other names stay.
///
/// # Errors
/// [`Error::File`] for the first file that cannot be written or removed.
pub fn write(dir: &Path, scene: &Scene, outcome: &Outcome) -> Result<(), Error> {
    let start = Instant::now();
    prepare(dir)?;
    let results = Results { scene, solution: &outcome.solution };
    let analysis = scene.analysis();
    csv::probes(dir, results)?;
    if scene.joint.is_empty() {
        remove(dir.join("reactions.csv"))?;
    } else {
        csv::reactions(dir, results)?;
    }
    if matches!(analysis, Some(Analysis::Dynamics(_))) {
        csv::energies(dir, results)?;
    } else {
        remove(dir.join("energies.csv"))?;
    }
    if matches!(analysis, Some(Analysis::Modes(_))) {
        csv::modes(dir, results)?;
    } else {
        remove(dir.join("modes.csv"))?;
    }
    svg::plot(dir, scene, &outcome.solution)?;
    scene_file(dir, scene)?;
    // Last, so that it holds the time of the others.
    summary::write(dir, scene, outcome, start.elapsed().as_secs_f64())
}

/// Removes a table that an earlier run may have left.
fn remove(path: PathBuf) -> Result<(), Error> {
    match std::fs::remove_file(&path) {
        Err(source) if source.kind() != ErrorKind::NotFound => {
            Err(Error::File { action: "remove", path, source })
        }
        _ => Ok(()),
    }
}

/// The scene as solved, defaults filled in; it can be run again.
fn scene_file(dir: &Path, scene: &Scene) -> Result<(), Error> {
    let path = dir.join("scene.toml");
    let text = toml::to_string(&scene.with_defaults())
        .map_err(|error| cannot_write(&path, std::io::Error::other(error)))?;
    write_text(path, &text)
}

fn write_text(path: PathBuf, text: &str) -> Result<(), Error> {
    std::fs::write(&path, text).map_err(|source| cannot_write(&path, source))
}

fn cannot_write(path: &Path, source: std::io::Error) -> Error {
    Error::File { action: "write", path: path.to_owned(), source }
}

#[cfg(test)]
mod tables_tests;

#[cfg(test)]
mod tests {
    use super::*;

    const SCENES: [&str; 4] = [
        r#"
title = "every \"table\""
gravity = [0, 0, -9.81]
[[rod]]
name = "helix"
curve = { kind = "helix", coils = 10, radius = 10e-3, pitch = 5e-3, origin = [1, 2, 3] }
section = { kind = "circle", diameter = 1e-3, inner_diameter = 1e-4 }
material = { young_modulus = 1e11, poisson_ratio = 0.2, density = 7850 }
elements = 75
degree = 2
reference = { kind = "fit", samples = 301 }
[[rod]]
name = "line"
curve = { kind = "line", from = [0, 0, 0], to = [0, 0, 1], normal = [1, 0, 1] }
section = { kind = "custom", axial = 1, shear_y = 1, shear_z = 1, torsion = 1, bending_y = 1, bending_z = 0.1 }
elements = 3
degree = 1
interpolation = "se3"
node_spacing = "equal"
quadrature = "full"
gravity = false
[[joint]]
kind = "revolute"
between = ["helix@0", "ground"]
axis = [0, 0, 2]
point = [0, 0, 0.1]
[[load]]
kind = "force"
on = "line@1"
value = [0, 0, 0.1]
basis = "body"
offset = [0, 0.3333333333333333, 0]
time = [[0, 0], [0.5, 1]]
[[load]]
kind = "line_moment"
on = "line"
value = [0, 0, 1e-300]
time = "constant"
[[probe]]
name = "tip"
on = "line@0.7"
angles = "zyx"
[statics]
increments = 5
tolerance = 1e-8
newton = "displacement"
coordinates = "quaternions"
[plot]
slope = 65.1
"#,
        r#"
[[rod]]
name = "arc"
curve = { kind = "arc", radius = 2, angle = 1, orientation = [1, 1, 0, 0] }
section = { kind = "rectangle", width = 0.1, height = 0.2, torsion_constant = 1e-5 }
material = { young_modulus = 2e9, shear_modulus = 1e9 }
elements = 1
degree = 8
[statics]
"#,
        r#"
gravity = [0, 0, -9.81]
[[rod]]
name = "rope"
curve = { kind = "line", length = 0.7 }
section = { kind = "circle", diameter = 0.01 }
material = { young_modulus = 1e7, poisson_ratio = 0.5, density = 1100 }
elements = 4
degree = 2
inertia = false
gravity = false
[[body]]
name = "bob"
shape = { kind = "cylinder", radius = 23e-3, height = 36e-3 }
density = 7850
position = [0.7, 0, -18e-3]
orientation = [1, 2, 3, 4]
[[body]]
name = "crate"
shape = { kind = "cuboid", size = [0.1, 0.2, 0.3333333333333333] }
density = 500
position = [0, 1, 0]
velocity = [0, 0, 1]
angular_velocity = [0, 150, -4.61538]
[[body]]
name = "plate"
mass = 0.1
inertia = [0.1, 0.2, 0.3]
position = [0, -1, 0]
[[joint]]
name = "grip"
kind = "rigid"
between = ["rope@1", "bob"]
[[joint]]
kind = "revolute"
between = ["crate", "ground"]
axis = [0, 1, 0]
point = [0, 1, 0]
[[load]]
kind = "force"
on = "plate"
value = [0, 0, 1]
[[load]]
kind = "moment"
on = "bob"
value = [0, 0, 1]
time = "ramp"
[[probe]]
name = "swing"
on = "bob"
offset = [0, 0, 0.02]
[dynamics]
end_time = 2
time_step = 1e-3
spectral_radius = 0.9
tolerance = 1e-8
newton = "displacement"
max_iterations = 7
"#,
        r#"
[[body]]
name = "ball"
shape = { kind = "sphere", radius = 0.1 }
density = 500
position = [0, 0, 0]
[modes]
count = 6
"#,
    ];

    #[test]
    fn the_scene_reads_back_equal() {
        for text in SCENES {
            let scene = Scene::from_toml(text).unwrap();
            let folder = tempfile::tempdir().unwrap();
            scene_file(folder.path(), &scene).unwrap();
            let again = Scene::from_file(folder.path().join("scene.toml")).unwrap();
            assert_eq!(scene.with_defaults(), again);
        }
    }

    #[test]
    fn loads_that_do_not_say_are_constant_in_dynamics_only() {
        use crate::scene::{LoadTime, NamedTime};
        let times = |text: &str| -> Vec<_> {
            let scene = Scene::from_toml(text).unwrap().with_defaults();
            scene.load.into_iter().map(|load| load.time.unwrap()).collect()
        };
        let [ramp, constant] = [NamedTime::Ramp, NamedTime::Constant].map(LoadTime::Named);
        assert_eq!(times(SCENES[2]), [constant.clone(), ramp.clone()]);
        let statics = SCENES[0].replacen("time = \"constant\"\n", "", 1);
        assert_eq!(times(&statics)[1], ramp);
        let modes = statics.replacen("[statics]\nincrements = 5\ntolerance = 1e-8\nnewton = \"displacement\"\ncoordinates = \"quaternions\"", "[modes]\ncount = 1", 1);
        let modes = modes.replacen("gravity = false", "gravity = false\ninertia = false", 1);
        assert_eq!(times(&modes)[1], ramp);
    }

    #[test]
    fn a_file_where_the_folder_should_be_is_a_write_error() {
        let file = tempfile::NamedTempFile::new().unwrap();
        let error = prepare(file.path()).unwrap_err();
        assert!(matches!(error, Error::File { action: "write", .. }));
    }
}
