//! Work–precision diagram: errors over processor time, and the runs that nothing beats.

use std::io;

use plotters::style::RGBColor;

use super::axis::{Axis, Range};
use super::canvas::{Anchor, Canvas, GREY, INK, Pen, SMALL, pen, text_width};
use super::curves::{COLORS, entry};
use super::frame::{Area, Entry, Frame, draw_row, row_height};
use super::path::Point;
use super::{BETWEEN, HEIGHT, MARGIN, WIDTHS, halves, sheet};
use crate::scene::InterpolationKind;
use crate::study::{Errors, Key, Measure, Row, front};

/// Errors below this are rounding, and zero has no logarithm.
const SMALLEST: f64 = 1e-16;
/// Width of the line through the runs of one kind, and of the Pareto front [px].
const WIDTH: f64 = 1.1;
const FRONT: Pen = Pen { color: RGBColor(212, 212, 212), width: 4.0, dashes: &[] };
const REFERENCE: Pen = Pen { color: GREY, width: 1.2, dashes: &[5.0, 4.0] };
/// Height of a label [px].
const LINE: f64 = 13.0;

/// The document; panels are empty until a run has arrived.
pub fn study(title: Option<&str>, rows: &[Row], reference: &Errors) -> io::Result<String> {
    let kinds = kinds(rows);
    let mut legend: Vec<Entry> =
        kinds.iter().enumerate().map(|(index, kind)| entry(kind_pen(index), &kind.name())).collect();
    legend.push(entry(FRONT, "Pareto front"));
    legend.push(entry(REFERENCE, "reference error"));
    let width = WIDTHS[0];
    let above = row_height(&legend, width - 2.0 * MARGIN);
    sheet(title, [width, HEIGHT + above], |canvas, whole| {
        let corner = [whole.left, whole.top + above];
        draw_row(canvas, &legend, corner, whole.size()[0])?;
        let below = Area { top: corner[1] + 4.0, ..whole };
        let [left, right] = halves(below, 0.5 * (width - BETWEEN));
        let panels = [
            (left, Measure::Position, reference.position, "position error / length of the rods"),
            (right, Measure::Rotation, reference.rotation, "rotation error [rad]"),
        ];
        panels.into_iter().try_for_each(|(area, measure, own, title)| {
            panel(canvas, area, &Panel { rows, kinds: &kinds, measure, own, title })
        })
    })
}

/// What has a colour of its own.
#[derive(Clone, Copy, PartialEq)]
struct Kind {
    degree: Option<usize>,
    interpolation: Option<InterpolationKind>,
    /// Whether increments are equal, and no matter of the mesh.
    equal: bool,
}

impl Kind {
    fn of(key: &Key) -> Self {
        Self { degree: key.degree, interpolation: key.interpolation, equal: key.increments.is_some() }
    }

    fn name(self) -> String {
        let degree =
            self.degree.map_or_else(|| "own degrees".to_owned(), |degree| format!("degree {degree}"));
        let kind = match self.interpolation {
            Some(InterpolationKind::Se3) => format!("{degree}, SE(3)"),
            Some(InterpolationKind::Quaternion) => format!("{degree}, quaternions"),
            Some(InterpolationKind::R12) => degree,
            None if self.degree.is_none() => "runs".to_owned(),
            None => format!("{degree}, own interpolations"),
        };
        if self.equal { format!("{kind}, equal increments") } else { kind }
    }

    /// Where it stands in the legend.
    fn rank(&self) -> (bool, Option<u8>, Option<usize>) {
        (self.equal, self.interpolation.map(|kind| kind as u8), self.degree)
    }
}

/// Automatic increments before equal ones, degrees in order.
fn kinds(rows: &[Row]) -> Vec<Kind> {
    let mut kinds = Vec::new();
    for kind in rows.iter().filter(|row| row.errors.is_some()).map(|row| Kind::of(&row.key)) {
        if !kinds.contains(&kind) {
            kinds.push(kind);
        }
    }
    kinds.sort_by_key(Kind::rank);
    kinds
}

/// Six colours, then the same dashed.
fn kind_pen(index: usize) -> Pen {
    const DASHES: [&[f64]; 2] = [&[], &[3.0, 3.0]];
    Pen {
        color: COLORS[index % COLORS.len()],
        width: WIDTH,
        dashes: DASHES[index / COLORS.len() % DASHES.len()],
    }
}

struct Panel<'a> {
    rows: &'a [Row],
    kinds: &'a [Kind],
    measure: Measure,
    /// The error of the reference.
    own: f64,
    title: &'a str,
}

fn panel(canvas: &mut Canvas, area: Area, panel: &Panel) -> io::Result<()> {
    let points: Vec<Option<Point>> = panel.rows.iter().map(|row| point(row, panel.measure)).collect();
    let shown = |k: usize| points.iter().flatten().map(move |point: &Point| point[k]);
    let own = panel.own.max(SMALLEST).log10();
    let (Some(x), Some(y)) = (Range::of(shown(0)), Range::of(shown(1).chain([own]))) else {
        return Ok(());
    };
    // Room to the left and below, where the front has its labels; a decade at least, so that noise stays small.
    let (x, y) = (x.at_least(1.0), y.at_least(1.0));
    let x = Range { low: x.low - 0.22 * x.length(), high: x.high + 0.06 * x.length() };
    let y = Range { low: y.low - 0.1 * y.length(), high: y.high + 0.05 * y.length() };
    let y = Axis::logarithmic(y, panel.title);
    let frame = Frame { area: area.inside_axes(&y), x: Axis::logarithmic(x, "processor time [s]"), y };
    frame.draw(canvas)?;
    let ends = [frame.x.range.low, frame.x.range.high].map(|x| frame.place([x, own]));
    canvas.curve(&ends.into_iter().flatten().collect::<Vec<_>>(), REFERENCE)?;
    let front = front(panel.rows, panel.measure);
    let at = |index: usize| points[index].and_then(|point| frame.place(point));
    let line: Vec<Point> = front.iter().filter_map(|&index| at(index)).collect();
    canvas.curve(&line, FRONT)?;
    for series in series(panel.rows) {
        let kind = Kind::of(&panel.rows[series[0]].key);
        let index = panel.kinds.iter().position(|other| *other == kind).unwrap_or(0);
        let places: Vec<Point> = series.iter().filter_map(|&index| at(index)).collect();
        canvas.curve(&places, kind_pen(index))?;
        places.iter().try_for_each(|place| canvas.dot(*place, kind_pen(index).color))?;
    }
    labels(canvas, &frame, &front, panel.rows, at)
}

/// Decimal logarithms of processor time and error.
fn point(row: &Row, measure: Measure) -> Option<Point> {
    let (seconds, error) = (row.seconds?, measure.of(row)?);
    Some([seconds.max(1e-9).log10(), error.max(SMALLEST).log10()])
}

/// Indices of runs that differ in one setting only, which grows: the time step where there are several, equal
/// increments, otherwise the elements.
fn series(rows: &[Row]) -> Vec<Vec<usize>> {
    let mut steps = rows.iter().filter_map(|row| row.key.time_step);
    let first = steps.next();
    let in_time = steps.any(|step| Some(step) != first);
    let rest = |key: &Key| {
        let rest = match (in_time, key.increments) {
            (true, _) => Key { time_step: None, ..key.clone() },
            (false, Some(_)) => Key { increments: None, ..key.clone() },
            (false, None) => Key { elements: None, ..key.clone() },
        };
        (key.increments.is_some(), rest)
    };
    let mut series: Vec<((bool, Key), Vec<usize>)> = Vec::new();
    for (index, row) in rows.iter().enumerate().filter(|(_, row)| row.errors.is_some()) {
        let key = rest(&row.key);
        match series.iter_mut().find(|(other, _)| *other == key) {
            Some((_, members)) => members.push(index),
            None => series.push((key, vec![index])),
        }
    }
    let grows = |index: &usize| {
        let key = &rows[*index].key;
        match (in_time, key.increments) {
            (true, _) => key.time_step.unwrap_or(0.0),
            (false, Some(increments)) => increments as f64,
            (false, None) => key.elements.unwrap_or(0) as f64,
        }
    };
    let sorted = series.into_iter().map(|(_, mut members)| {
        members.sort_by(|a, b| grows(a).total_cmp(&grows(b)));
        members
    });
    sorted.collect()
}

/// Names the runs on the front, to the lower left of each, where by its meaning there is nothing else; lower where
/// another label is.
fn labels(
    canvas: &mut Canvas,
    frame: &Frame,
    front: &[usize],
    rows: &[Row],
    at: impl Fn(usize) -> Option<Point>,
) -> io::Result<()> {
    let several = |of: &dyn Fn(&Key) -> Option<String>| {
        front.iter().any(|&index| of(&rows[index].key) != of(&rows[front[0]].key))
    };
    let steps = several(&|key| key.time_step.map(|step| format!("{step:?}")));
    let tolerances = several(&|key| key.tolerance.map(|tolerance| format!("{tolerance:?}")));
    let mut taken: Vec<[f64; 4]> = Vec::new();
    for &index in front {
        let Some(place) = at(index) else { continue };
        let text = label(&rows[index].key, steps, tolerances);
        let width = text_width(&text, SMALL);
        let right = (place[0] - 6.0).max(frame.area.left + 4.0 + width);
        let mut y = place[1] + 10.0;
        let overlaps = |y: f64, other: &[f64; 4]| {
            right - width < other[2]
                && other[0] < right
                && y - 0.5 * LINE < other[3]
                && other[1] < y + 0.5 * LINE
        };
        while taken.iter().any(|other| overlaps(y, other)) {
            y += 0.5 * LINE;
        }
        if y + 0.5 * LINE > frame.area.bottom {
            continue;
        }
        taken.push([right - width, y - 0.5 * LINE, right, y + 0.5 * LINE]);
        if y > place[1] + 1.5 * LINE {
            canvas.curve(&[place, [right - 2.0, y - 0.4 * LINE]], pen(INK, 0.4))?;
        }
        canvas.text(&text, [right, y], SMALL, Anchor::End)?;
    }
    Ok(())
}

/// Degree and elements, and the time step where it makes a difference.
fn label(key: &Key, with_step: bool, with_tolerance: bool) -> String {
    let kind = match (key.interpolation, key.degree) {
        (Some(InterpolationKind::Se3), _) => "SE(3)".to_owned(),
        (_, Some(degree)) => format!("p {degree}"),
        (_, None) => "own p".to_owned(),
    };
    let mesh = key.elements.map(|elements| format!("{kind} × {elements}"));
    // Steps that follow an accuracy are none of the others.
    let step = key.time_step.map_or("accuracy".to_owned(), |step| format!("h {}", short(step)));
    let step = (with_step || mesh.is_none()).then_some(step);
    let increments = key.increments.map(|count| format!("{count} incr."));
    let tolerance =
        key.tolerance.map_or("tol. default".to_owned(), |tolerance| format!("tol. {tolerance:e}"));
    let tolerance = with_tolerance.then_some(tolerance);
    mesh.into_iter().chain(step).chain(increments).chain(tolerance).collect::<Vec<_>>().join(", ")
}

fn short(number: f64) -> String {
    super::axis::significant(number, 3)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(degree: usize, elements: usize, seconds: f64, error: f64) -> Row {
        Row {
            key: Key { degree: Some(degree), elements: Some(elements), ..Key::default() },
            errors: Some(Errors { position: error, rotation: 2.0 * error }),
            seconds: Some(seconds),
            newton_iterations: Some(1),
            factorizations: Some(1),
            status: "solved".into(),
        }
    }

    #[test]
    fn the_front_is_named() {
        let rows =
            [row(2, 10, 1e-3, 1e-2), row(2, 20, 2e-3, 1e-3), row(3, 20, 3e-3, 1e-5), row(1, 99, 9e-3, 1e-1)];
        let document = study(Some("a title"), &rows, &Errors { position: 1e-9, rotation: 1e-9 }).unwrap();
        for wanted in ["a title", "p 2 × 10", "p 2 × 20", "p 3 × 20", "degree 1", "10⁻³", "Pareto front"]
        {
            assert!(document.contains(wanted), "{wanted}");
        }
        assert!(!document.contains("p 1 × 99") && !document.contains("NaN"));
    }

    /// Only what differs along the front.
    #[test]
    fn runs_that_differ_have_different_names() {
        let of = |time_step, tolerance| Key { time_step, tolerance, ..row(2, 10, 1.0, 1.0).key };
        assert_eq!(label(&of(Some(0.25), Some(1e-8)), false, false), "p 2 × 10");
        assert_eq!(label(&of(Some(0.25), Some(1e-8)), true, true), "p 2 × 10, h 0.25, tol. 1e-8");
        assert_eq!(label(&of(None, None), true, true), "p 2 × 10, accuracy, tol. default");
    }

    #[test]
    fn nothing_and_zero_can_be_drawn() {
        for rows in [vec![], vec![row(8, 1, 0.0, 0.0)]] {
            let document = study(None, &rows, &Errors::default()).unwrap();
            assert!(
                document.contains("Pareto front") && !document.contains("NaN") && !document.contains("inf")
            );
        }
    }
}
