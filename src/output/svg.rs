//! `plot.svg`: what the probes do under the load, and what the rods look like meanwhile.

mod axis;
mod canvas;
mod curves;
mod frame;
mod path;
mod shapes;

use std::io;
use std::path::Path;

use crate::error::Error;
use crate::scene::Scene;
use crate::solution::Solution;
use canvas::{Anchor, LARGE, text_width};
use frame::Area;
use shapes::Amount;

/// Height of a figure without its title [px].
const HEIGHT: f64 = 430.0;
/// Width of a figure with two panels and with one [px].
const WIDTHS: [f64; 2] = [980.0, 580.0];
/// Height of the title [px].
const TITLE: f64 = 30.0;
/// White around everything [px].
const MARGIN: f64 = 14.0;

/// Writes the figure: force over displacement if the only point force is ramped and has a fixed direction,
/// otherwise the displacements of the probes over the load factor; and the shapes of the rods.
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
    let shapes = shapes::shapes(solution);
    let curves = curves::curves(scene, solution, shapes.as_ref().map_or(0.0, |shapes| shapes.size));
    let title = scene.title.as_deref().filter(|title| !title.trim().is_empty());
    let width = WIDTHS[usize::from(curves.is_none() || shapes.is_none())];
    let whole = Area {
        left: MARGIN,
        top: MARGIN + title.map_or(0.0, |_| TITLE),
        right: width - MARGIN,
        bottom: HEIGHT + title.map_or(0.0, |_| TITLE),
    };
    let amount = match curves::single_force(scene) {
        Some(force) => Amount { name: "force", unit: "N", full: curves::magnitude(force) },
        None => Amount { name: "load factor", unit: "", full: 1.0 },
    };
    canvas::document([width, whole.bottom], |canvas| {
        if let Some(title) = title {
            let at = [0.5 * width, MARGIN + 0.4 * TITLE];
            canvas.text(&shortened(title, width - 2.0 * MARGIN), at, LARGE, Anchor::Middle)?;
        }
        let [mut left, mut right] = [whole; 2];
        if curves.is_some() && shapes.is_some() {
            left.right = 0.46 * width;
            right.left = left.right + 24.0;
        }
        if let Some(curves) = curves {
            curves.draw(canvas, left)?;
        }
        shapes.map_or(Ok(()), |shapes| shapes.draw(canvas, right, &amount))
    })
}

/// The title, or as much of it as fits.
fn shortened(title: &str, width: f64) -> String {
    if text_width(title, LARGE) <= width {
        return title.to_owned();
    }
    let fits = (width / text_width("x", LARGE)) as usize;
    let start: String = title.chars().take(fits.saturating_sub(1)).collect();
    format!("{}…", start.trim_end())
}

#[cfg(test)]
mod tests;
