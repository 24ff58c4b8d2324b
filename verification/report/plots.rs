//! Pictures beside the numbers, as SVG text: errors over sizes, and what was computed over what it is held against.

use std::error::Error;
use std::ops::Range;

use plotters::coord::ranged1d::ValueFormatter;
use plotters::prelude::*;

use crate::case::{Check, Trajectory};

const SIZE: (u32, u32) = (460, 300);
const FONT: (&str, u32) = ("sans-serif", 12);
const COLOURS: [RGBColor; 6] = [
    RGBColor(0, 90, 160),
    RGBColor(200, 80, 0),
    RGBColor(20, 130, 70),
    RGBColor(150, 40, 120),
    RGBColor(120, 100, 0),
    RGBColor(90, 90, 90),
];
/// More ladders than colours cannot be told apart.
const LADDERS: usize = COLOURS.len();

type Outcome<T> = Result<T, Box<dyn Error>>;

/// Errors over numbers of elements or steps, both logarithmic, each with a dashed line of the order that is expected.
/// None if there is nothing to draw.
pub fn convergence(checks: &[Check]) -> Outcome<Option<String>> {
    let mut lines = Vec::new();
    for check in checks {
        let Some(ladder) = &check.ladder else { continue };
        let points: Vec<(f64, f64)> = ladder
            .sizes
            .iter()
            .zip(&ladder.errors)
            .map(|(size, error)| (*size as f64, *error))
            .filter(|(size, error)| *size > 0.0 && *error > 0.0 && error.is_finite())
            .collect();
        if points.len() > 1 && lines.len() < LADDERS {
            lines.push((check, points));
        }
    }
    let all = || lines.iter().flat_map(|(_, points)| points);
    let (Some(sizes), Some(errors)) = (span(all().map(|p| p.0)), span(all().map(|p| p.1))) else {
        return Ok(None);
    };
    let ranges = (
        (sizes.start / 1.2..sizes.end * 1.2).log_scale(),
        (errors.start / 4.0..errors.end * 4.0).log_scale(),
    );
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
            .x_desc("elements or steps")
            .y_desc("error")
            .x_label_formatter(&|size| format!("{size:.0}"))
            .y_label_formatter(&|error| format!("{error:.0e}"))
            .draw()?;
        for ((check, points), colour) in lines.iter().zip(COLOURS) {
            chart
                .draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(2)))?
                .label(format!("order {:.2}, expected {}", check.measured, check.reference))
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], colour.stroke_width(2)));
            chart.draw_series(points.iter().map(|point| Circle::new(*point, 3, colour.filled())))?;
            if let (Some(first), Some(last)) = (points.first(), points.last()) {
                let expected = |size: f64| last.1 * (last.0 / size).powf(check.reference);
                let slope = [(first.0, expected(first.0)), *last];
                chart.draw_series(DashedLineSeries::new(slope, 4, 4, colour.mix(0.6).stroke_width(1)))?;
            }
        }
        legend(&mut chart, SeriesLabelPosition::LowerLeft)?;
        area.present()?;
    }
    Ok(Some(text))
}

/// What was computed as a line, the reference as dots. None if there is nothing to draw.
pub fn trajectory(trajectory: &Trajectory) -> Outcome<Option<String>> {
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
            .x_label_formatter(&|value| short(*value))
            .y_label_formatter(&|value| short(*value))
            .draw()?;
        let (ours, theirs) = (COLOURS[0], COLOURS[1]);
        chart
            .draw_series(LineSeries::new(measured, ours.stroke_width(2)))?
            .label("cosserat")
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], ours.stroke_width(2)));
        chart
            .draw_series(reference.into_iter().map(|point| Circle::new(point, 2, theirs.filled())))?
            .label(trajectory.source)
            .legend(move |(x, y)| Circle::new((x + 8, y), 3, theirs.filled()));
        legend(&mut chart, SeriesLabelPosition::UpperRight)?;
        area.present()?;
    }
    Ok(Some(text))
}

fn legend<'a, X, Y>(
    chart: &mut ChartContext<'a, SVGBackend<'a>, Cartesian2d<X, Y>>,
    position: SeriesLabelPosition,
) -> Outcome<()>
where
    X: Ranged<ValueType = f64> + ValueFormatter<f64>,
    Y: Ranged<ValueType = f64> + ValueFormatter<f64>,
{
    Ok(chart
        .configure_series_labels()
        .position(position)
        .background_style(WHITE.mix(0.85))
        .border_style(BLACK.mix(0.2))
        .label_font(FONT)
        .draw()?)
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

/// A few digits.
fn short(value: f64) -> String {
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    let size = rounded.abs();
    if size != 0.0 && !(1e-3..1e5).contains(&size) { format!("{rounded:e}") } else { format!("{rounded}") }
}
