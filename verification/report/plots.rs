//! Pictures beside the numbers, as SVG text: errors over sizes, and what was computed over what it is held against.

use std::error::Error;
use std::ops::Range;

use plotters::prelude::*;
use serde::Serialize;

use crate::case::{Check, Trajectory};
use crate::placement::placements;

const SIZE: (u32, u32) = (460, 300);
const FONT: (&str, u32) = ("sans-serif", 14);
const COLOURS: [RGBColor; 6] = [
    RGBColor(0, 90, 160),
    RGBColor(200, 80, 0),
    RGBColor(20, 130, 70),
    RGBColor(150, 40, 120),
    RGBColor(120, 100, 0),
    RGBColor(90, 90, 90),
];
/// Ladders in one picture.
const LADDERS: usize = COLOURS.len();

type Outcome<T> = Result<T, Box<dyn Error>>;

/// A picture and what its lines are.
#[derive(Serialize)]
pub struct Plot {
    pub title: String,
    pub svg: String,
    pub legend: Vec<Entry>,
}

/// One line of a legend.
#[derive(Serialize)]
pub struct Entry {
    colour: String,
    /// Dots instead of a line.
    dots: bool,
    name: String,
}

impl Entry {
    fn new(colour: RGBColor, dots: bool, name: impl Into<String>) -> Self {
        let RGBColor(red, green, blue) = colour;
        Self { colour: format!("rgb({red}, {green}, {blue})"), dots, name: name.into() }
    }
}

/// Errors over numbers of elements or steps, both logarithmic, each with a dashed line of the order that is expected.
/// None if there is nothing to draw. Of more ladders than there are colours, some from the first to the last; the same
/// ladder turned and shifted would lie on top of it.
pub fn convergence(checks: &[Check]) -> Outcome<Option<Plot>> {
    let placed = |check: &Check| {
        let mut others = placements(1.0).into_iter().skip(1);
        others.any(|placement| check.quantity.contains(placement.name))
    };
    let mut all = Vec::new();
    for check in checks.iter().filter(|check| !placed(check)) {
        let Some(ladder) = &check.ladder else { continue };
        let points: Vec<(f64, f64)> = ladder
            .sizes
            .iter()
            .zip(&ladder.errors)
            .filter(|(size, error)| **size > 0 && **error > 0.0 && error.is_finite())
            .map(|(size, error)| ((*size as f64).log2(), *error))
            .collect();
        if points.len() > 1 {
            all.push((check, points));
        }
    }
    let (count, shown) = (all.len(), all.len().min(LADDERS));
    let lines: Vec<_> = (0..shown).map(|i| &all[i * (count - 1) / (shown - 1).max(1)]).collect();
    let all = || lines.iter().flat_map(|(_, points)| points);
    let (Some(sizes), Some(errors)) = (span(all().map(|p| p.0)), span(all().map(|p| p.1))) else {
        return Ok(None);
    };
    let ranges = (widened(&sizes), (errors.start / 4.0..errors.end * 4.0).log_scale());
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        let mut chart = ChartBuilder::on(&area)
            .margin(8)
            .x_label_area_size(36)
            .y_label_area_size(64)
            .build_cartesian_2d(ranges.0, ranges.1)?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.1))
            .label_style(FONT)
            .x_labels(6)
            .x_desc("elements or steps")
            .y_desc("error")
            .x_label_formatter(&|size| short(size.exp2(), 2))
            .y_label_formatter(&|error| format!("{error:.0e}"))
            .draw()?;
        for ((check, points), colour) in lines.iter().zip(COLOURS) {
            chart.draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(2)))?;
            chart.draw_series(points.iter().map(|point| Circle::new(*point, 3, colour.filled())))?;
            if let (Some(first), Some(last)) = (points.first(), points.last()) {
                let expected = |size: f64| last.1 * ((last.0 - size) * check.reference).exp2();
                let slope = [(first.0, expected(first.0)), *last];
                chart.draw_series(DashedLineSeries::new(slope, 4, 4, colour.mix(0.6).stroke_width(1)))?;
            }
        }
        area.present()?;
    }
    let legend = lines.iter().zip(COLOURS).map(|(line, colour)| {
        let check = line.0;
        let name = check.quantity.split(": order on").next().unwrap_or_default();
        let orders = format!("{name}: order {:.2}, expected {}", check.measured, check.reference);
        Entry::new(colour, false, orders)
    });
    Ok(Some(Plot { title: "Convergence".to_string(), svg: text, legend: legend.collect() }))
}

/// What was computed as a line, the reference as dots. None if there is nothing to draw.
pub fn trajectory(trajectory: &Trajectory) -> Outcome<Option<Plot>> {
    let finite = |points: &[[f64; 2]]| -> Vec<(f64, f64)> {
        points.iter().filter(|p| p.iter().all(|v| v.is_finite())).map(|p| (p[0], p[1])).collect()
    };
    let (measured, reference) = (finite(&trajectory.measured), finite(&trajectory.reference));
    let all = || measured.iter().chain(&reference);
    let (Some(across), Some(up)) = (span(all().map(|p| p.0)), span(all().map(|p| p.1))) else {
        return Ok(None);
    };
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        let mut chart = ChartBuilder::on(&area)
            .margin(8)
            .x_label_area_size(36)
            .y_label_area_size(64)
            .build_cartesian_2d(widened(&across), widened(&up))?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.1))
            .label_style(FONT)
            .x_labels(6)
            .y_labels(6)
            .x_desc(trajectory.axes[0])
            .y_desc(trajectory.axes[1])
            .x_label_formatter(&|value| short(*value, 3))
            .y_label_formatter(&|value| short(*value, 3))
            .draw()?;
        let (ours, theirs) = (COLOURS[0], COLOURS[1]);
        chart.draw_series(LineSeries::new(measured, ours.stroke_width(2)))?;
        chart.draw_series(reference.into_iter().map(|point| Circle::new(point, 3, theirs.filled())))?;
        area.present()?;
    }
    let legend =
        vec![Entry::new(COLOURS[0], false, "cosserat"), Entry::new(COLOURS[1], true, trajectory.source)];
    Ok(Some(Plot { title: trajectory.title.clone(), svg: text, legend }))
}

/// Least and greatest; none for no values.
fn span(values: impl Iterator<Item = f64>) -> Option<Range<f64>> {
    values.fold(None, |span: Option<Range<f64>>, value| {
        Some(span.map_or(value..value, |span| span.start.min(value)..span.end.max(value)))
    })
}

/// With some air, and never empty.
fn widened(span: &Range<f64>) -> Range<f64> {
    let air = (0.05 * (span.end - span.start)).max(1e-12 + 1e-6 * span.start.abs());
    span.start - air..span.end + air
}

/// With so many digits after the first.
fn short(value: f64, digits: usize) -> String {
    let rounded: f64 = format!("{value:.digits$e}").parse().unwrap_or(value);
    let size = rounded.abs();
    if size != 0.0 && !(1e-3..1e5).contains(&size) { format!("{rounded:e}") } else { format!("{rounded}") }
}
