//! `plot.svg`: what the probes do under the load or in time, or the frequencies, and what the rods look like
//! meanwhile.

mod axis;
mod canvas;
mod curves;
mod envelope;
mod frame;
mod frequencies;
mod motion;
mod path;
mod shapes;
mod study;

use std::io;
use std::path::Path;

use crate::error::Error;
use crate::scene::{Analysis, Scene};
use crate::solution::{Shape, Solution};
use canvas::{Anchor, Canvas, LARGE, shortened};
use frame::Area;
use motion::{Motion, draw_column};
use shapes::{Amount, Shapes};
pub(super) use study::study;

/// Height of a figure without its title [px].
const HEIGHT: f64 = 430.0;
/// With so many panels over time, one above the other [px].
const HEIGHTS: [f64; 4] = [HEIGHT, HEIGHT, 520.0, 660.0];
/// Width of a figure with two panels and with one [px].
const WIDTHS: [f64; 2] = [980.0, 580.0];
/// Width of a figure with panels over time and nothing beside them [px].
const WIDTH_IN_TIME: f64 = 780.0;
/// Height of the title [px].
const TITLE: f64 = 30.0;
/// White around everything [px].
const MARGIN: f64 = 14.0;
/// White between panels side by side [px].
const BETWEEN: f64 = 24.0;

/// Writes the figure, and in it the shapes of the rods beside
/// - in statics, force over displacement if the only point force is ramped and has a fixed direction, otherwise
///   the displacements of the probes over the load factor;
/// - in dynamics, positions and angles of the probes that move most over time, with its envelope where there is
///   one curve that oscillates, and the energies;
/// - in modes, the frequencies.
///
/// # Errors
/// [`Error::File`] if it cannot be written.
pub(super) fn plot(dir: &Path, scene: &Scene, solution: &Solution) -> Result<(), Error> {
    let path = dir.join("plot.svg");
    let document = figure(scene, solution).map_err(|error| super::cannot_write(&path, error))?;
    super::write_text(path, &document)
}

/// The document.
fn figure(scene: &Scene, solution: &Solution) -> io::Result<String> {
    match scene.analysis() {
        Some(Analysis::Dynamics(_)) => in_time(scene, solution),
        Some(Analysis::Modes(_)) => of_modes(scene, solution),
        Some(Analysis::Statics(_)) | None => under_load(scene, solution),
    }
}

fn under_load(scene: &Scene, solution: &Solution) -> io::Result<String> {
    let all: Vec<&Shape> = solution.shapes.iter().collect();
    let shapes = shapes::shapes(&all);
    let curves = curves::curves(scene, solution, size(&shapes));
    let amount = match curves::single_force(scene) {
        Some(force) => {
            let full = curves::magnitude(force);
            Amount { name: "force", unit: "N", full, largest: full }
        }
        None => LOAD_FACTOR,
    };
    let width = WIDTHS[usize::from(curves.is_none() || shapes.is_none())];
    sheet(scene.title.as_deref(), [width, HEIGHT], |canvas, whole| {
        let [left, right] = match (&curves, &shapes) {
            (Some(_), Some(_)) => halves(whole, 0.46 * width),
            _ => [whole; 2],
        };
        if let Some(curves) = curves {
            curves.draw(canvas, left)?;
        }
        shapes.map_or(Ok(()), |shapes| shapes.draw(canvas, right, &amount))
    })
}

/// Positions and angles one above the other; the energies below them, or, where there are two already, below the
/// shapes.
fn in_time(scene: &Scene, solution: &Solution) -> io::Result<String> {
    let all: Vec<&Shape> = solution.shapes.iter().collect();
    let shapes = shapes::shapes(&all);
    let motion = Motion::new(scene, solution, size(&shapes));
    let mut column: Vec<_> = motion.signals.iter().collect();
    let mut below = None;
    if column.len() > 1 && shapes.is_some() {
        below = motion.energies.as_ref();
    } else {
        column.extend(&motion.energies);
    }
    let end = solution.rows.last().map_or(0.0, |row| row.parameter);
    let amount = Amount { name: "time", unit: "s", full: 1.0, largest: end };
    let width = match (&shapes, column.is_empty()) {
        (Some(_), false) => WIDTHS[0],
        (Some(_), true) => WIDTHS[1],
        (None, _) => WIDTH_IN_TIME,
    };
    let height = HEIGHTS[column.len().min(HEIGHTS.len() - 1)];
    sheet(scene.title.as_deref(), [width, height], |canvas, whole| {
        let [left, mut right] =
            if shapes.is_some() && !column.is_empty() { halves(whole, 0.54 * width) } else { [whole; 2] };
        draw_column(canvas, left, &column, &motion)?;
        if let Some(energies) = below {
            let middle = right.top + 0.55 * right.size()[1];
            draw_column(canvas, Area { top: middle + MARGIN, ..right }, &[energies], &motion)?;
            right.bottom = middle;
        }
        shapes.map_or(Ok(()), |shapes| shapes.draw(canvas, right, &amount))
    })
}

/// The frequencies, and the rods at the start and at the equilibrium the vibrations are about.
fn of_modes(scene: &Scene, solution: &Solution) -> io::Result<String> {
    let mut ends: Vec<&Shape> = solution.shapes.first().into_iter().collect();
    ends.extend(solution.shapes.get(1..).and_then(<[Shape]>::last));
    let shapes = shapes::shapes(&ends);
    let width = WIDTHS[usize::from(shapes.is_none() || solution.modes.is_empty())];
    sheet(scene.title.as_deref(), [width, HEIGHT], |canvas, whole| {
        let [left, right] = match (&shapes, solution.modes.is_empty()) {
            (Some(_), false) => halves(whole, 0.54 * width),
            _ => [whole; 2],
        };
        if !solution.modes.is_empty() {
            frequencies::draw(canvas, left, solution)?;
        }
        shapes.map_or(Ok(()), |shapes| shapes.draw(canvas, right, &LOAD_FACTOR))
    })
}

const LOAD_FACTOR: Amount = Amount { name: "load factor", unit: "", full: 1.0, largest: 1.0 };

/// Largest extent of the rods in any direction [m].
fn size(shapes: &Option<Shapes>) -> f64 {
    shapes.as_ref().map_or(0.0, |shapes| shapes.size)
}

/// Two areas side by side.
fn halves(whole: Area, left: f64) -> [Area; 2] {
    [Area { right: left, ..whole }, Area { left: left + BETWEEN, ..whole }]
}

/// A sheet of a size without its title [px], and the area below the title.
fn sheet(
    title: Option<&str>,
    [width, height]: [f64; 2],
    draw: impl FnOnce(&mut Canvas, Area) -> io::Result<()>,
) -> io::Result<String> {
    let title = title.filter(|title| !title.trim().is_empty());
    let above = title.map_or(0.0, |_| TITLE);
    let whole = Area { left: MARGIN, top: MARGIN + above, right: width - MARGIN, bottom: height + above };
    canvas::document([width, whole.bottom], |canvas| {
        if let Some(title) = title {
            let at = [0.5 * width, MARGIN + 0.4 * TITLE];
            canvas.text(&shortened(title, width - 2.0 * MARGIN, LARGE), at, LARGE, Anchor::Middle)?;
        }
        draw(canvas, whole)
    })
}

#[cfg(test)]
mod tests;
