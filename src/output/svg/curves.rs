//! The left panel: how far the probes go under the load.

use std::io;

use super::axis::{Axis, Range, significant};
use super::canvas::{Canvas, GREY, Pen, pen};
use super::frame::{Area, Entry, Frame, Label};
use super::path::Point;
use crate::scene::{Basis, Load, LoadKind, LoadTime, NamedTime, Scene};
use crate::solution::Solution;
use plotters::style::RGBColor;

/// Colours that differ for every kind of colour vision (Okabe & Ito 2008).
pub const COLORS: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
];
/// One for each probe; the first is a full line.
const DASHES: [&[f64]; 4] = [&[], &[7.0, 4.0], &[1.5, 3.5], &[9.0, 3.5, 1.5, 3.5]];
/// Width of a curve [px].
const WIDTH: f64 = 1.6;
/// More lines than this do not fit into a legend.
const MOST_PROBES: usize = 12;
/// Curves with at most so many points show them.
pub const FEW: usize = 30;
/// Displacements below this share of the size of the scene are round-off.
pub const ROUND_OFF: f64 = 1e-9;

/// A line in the units of the axes.
pub type Line = (Pen, Vec<Point>);

/// Curves with their axes and legend.
pub struct Curves {
    x: (Range, String, &'static str),
    y: (Range, &'static str, &'static str),
    lines: Vec<Line>,
    /// A straight line to compare with.
    comparison: Option<Line>,
    legend: Vec<Entry>,
}

/// The one ramped point force with a fixed direction, if the load is that.
pub fn single_force(scene: &Scene) -> Option<&Load> {
    let mut forces = scene.load.iter().filter(|load| load.kind == LoadKind::Force);
    let force = forces.next()?;
    let ramped = matches!(force.time, None | Some(LoadTime::Named(NamedTime::Ramp)));
    let alone = forces.next().is_none();
    (alone && ramped && force.basis == Basis::Inertial && magnitude(force) > 0.0).then_some(force)
}

/// |F| [N].
pub fn magnitude(force: &Load) -> f64 {
    force.value[0].hypot(force.value[1]).hypot(force.value[2])
}

/// What to draw for a scene with probes; `None` without. `size` is the extent of the scene [m].
pub fn curves(scene: &Scene, solution: &Solution, size: f64) -> Option<Curves> {
    if scene.probe.is_empty() || solution.rows.is_empty() {
        return None;
    }
    Some(match single_force(scene) {
        Some(force) => force_over_displacement(scene, solution, force, size),
        None => components_over_load_factor(scene, solution, size),
    })
}

/// Displacements of a probe [m], beside the load factor.
fn displacements(solution: &Solution, probe: usize) -> impl Iterator<Item = (f64, [f64; 3])> {
    let position = move |row: &crate::solution::Row| row.probes.get(probe).map(|pose| pose.position);
    let start = solution.rows.first().and_then(position).unwrap_or_default();
    solution.rows.iter().filter_map(move |row| {
        let now = position(row)?;
        Some((row.parameter, std::array::from_fn(|k| now[k] - start[k])))
    })
}

fn force_over_displacement(scene: &Scene, solution: &Solution, force: &Load, size: f64) -> Curves {
    let newtons = magnitude(force);
    let direction = force.value.map(|component| component / newtons);
    let probes = scene.probe.iter().enumerate().take(MOST_PROBES);
    let mut lines: Vec<Line> = Vec::new();
    let mut legend = Vec::new();
    for (index, probe) in probes {
        let along = |u: [f64; 3]| u[0] * direction[0] + u[1] * direction[1] + u[2] * direction[2];
        let points = displacements(solution, index).map(|(factor, u)| [along(u), factor * newtons]);
        let pen = Pen {
            color: COLORS[index % COLORS.len()],
            width: WIDTH,
            dashes: DASHES[index / COLORS.len() % DASHES.len()],
        };
        lines.push((pen, points.collect()));
        legend.push(entry(pen, &probe.name));
    }
    let [x, y] = [0, 1].map(|k| range(&lines, k, [0.0]));
    let x = x.at_least(ROUND_OFF * size).padded_from_zero();
    let y = if y.length() > 0.0 { y.padded_from_zero() } else { Range { low: 0.0, high: newtons } };
    let comparison = scene.plot.as_ref().and_then(|plot| plot.slope).map(|slope| {
        let pen = Pen { color: GREY, width: WIDTH, dashes: DASHES[1] };
        legend.push(entry(pen, &format!("{} N/m", significant(slope, 4))));
        (pen, line_through_zero(slope, x, y))
    });
    Curves {
        x: (x, format!("displacement {}", named(direction)), "m"),
        y: (y, "force", "N"),
        lines,
        comparison,
        legend,
    }
}

fn components_over_load_factor(scene: &Scene, solution: &Solution, size: f64) -> Curves {
    let mut lines: Vec<Line> = Vec::new();
    for index in 0..scene.probe.len().min(MOST_PROBES) {
        for component in 0..3 {
            let points = displacements(solution, index).map(|(factor, u)| [factor, u[component]]);
            let pen = Pen { color: COLORS[component], width: WIDTH, dashes: DASHES[index % DASHES.len()] };
            lines.push((pen, points.collect()));
        }
    }
    let mut legend: Vec<Entry> = ["x", "y", "z"]
        .into_iter()
        .zip(COLORS)
        .map(|(component, color)| Entry { pen: pen(color, WIDTH), label: Label::Component(component) })
        .collect();
    if scene.probe.len() > 1 {
        let probes = scene.probe.iter().zip(DASHES.iter().cycle()).take(MOST_PROBES);
        legend.extend(probes.map(|(probe, dashes)| {
            let pen = Pen { dashes, ..pen(GREY, WIDTH) };
            entry(pen, &probe.name)
        }));
    }
    let factors = range(&lines, 0, [0.0]);
    let factors = if factors.length() > 0.0 { factors } else { Range { low: 0.0, high: 1.0 } };
    let y = range(&lines, 1, [0.0]).at_least(ROUND_OFF * size);
    Curves {
        x: (factors, "load factor".to_owned(), ""),
        y: (y.with_length(1.1 * y.length()), "displacement", "m"),
        lines,
        comparison: None,
        legend,
    }
}

/// A line of the legend with a text.
pub fn entry(pen: Pen, text: &str) -> Entry {
    Entry { pen, label: Label::Text(text.to_owned()) }
}

/// Range of a coordinate over all lines and some other values.
fn range(lines: &[Line], coordinate: usize, others: [f64; 1]) -> Range {
    let values = lines.iter().flat_map(|line| &line.1).map(|point| point[coordinate]);
    Range::of(values.chain(others)).unwrap_or(Range { low: 0.0, high: 0.0 })
}

/// The part of y = slope × x within the ranges, which both hold zero.
fn line_through_zero(slope: f64, x: Range, y: Range) -> Vec<Point> {
    let (mut low, mut high) = (x.low, x.high);
    if slope != 0.0 {
        let ends = [y.low / slope, y.high / slope];
        low = low.max(ends[0].min(ends[1]));
        high = high.min(ends[0].max(ends[1]));
    }
    vec![[low, slope * low], [high, slope * high]]
}

/// "in x", "in −z" or, oblique, "along the force".
fn named(direction: [f64; 3]) -> String {
    for (component, name) in direction.into_iter().zip(["x", "y", "z"]) {
        if component.abs() > 1.0 - 1e-12 {
            let sign = if component < 0.0 { "−" } else { "" };
            return format!("in {sign}{name}");
        }
    }
    "along the force".to_owned()
}

impl Curves {
    /// Draws into an area, titles and labels included.
    pub fn draw(self, canvas: &mut Canvas, area: Area) -> io::Result<()> {
        let y = Axis::new(self.y.0, 6, self.y.1, self.y.2);
        let frame = Frame { area: area.inside_axes(&y), x: Axis::new(self.x.0, 6, &self.x.1, self.x.2), y };
        frame.draw(canvas)?;
        let place = |points: &[Point]| -> Vec<Point> {
            points.iter().filter_map(|point| frame.place(*point)).collect()
        };
        let mut placed = Vec::with_capacity(self.lines.len() + 1);
        if let Some((pen, points)) = &self.comparison {
            placed.push(place(points));
            canvas.curve(&placed[0], *pen)?;
        }
        for (pen, points) in &self.lines {
            let points = place(points);
            canvas.curve(&points, *pen)?;
            // Where a curve is only a polygon, its corners are what was computed.
            if points.len() <= FEW {
                points.iter().try_for_each(|point| canvas.dot(*point, pen.color))?;
            }
            placed.push(points);
        }
        if self.legend.len() > 1 {
            frame.draw_legend(canvas, &self.legend, &placed)?;
        }
        Ok(())
    }
}
