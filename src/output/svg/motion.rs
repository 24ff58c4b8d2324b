//! Motion in time: where the probes are, how they are turned, and where the energy is.

use std::io;

use super::axis::{Axis, Range, is_drawable, significant};
use super::canvas::{Anchor, Canvas, INK, MEDIUM, Pen, SMALL, pen, shortened, text_width};
use super::curves::{COLORS, FEW, Line, ROUND_OFF, entry};
use super::envelope::{Beat, Swing, answering, beat, envelope, sides};
use super::frame::{Area, Entry, Frame, draw_row, row_height};
use super::path::{Point, thinned};
use crate::scene::Scene;
use crate::solution::{Energies, ProbePose, Solution};
use plotters::style::RGBColor;

/// Width of a curve, of an envelope and of a mark [px].
const WIDTHS: [f64; 3] = [1.3, 0.9, 0.9];
/// What moves by less than this share of what moves most would be a straight line.
const LEGIBLE: f64 = 0.25;
/// More curves in one panel cannot be told apart.
const MOST_LINES: usize = COLORS.len();
/// Width of a name in a legend [px].
const NAME: f64 = 260.0;
/// Between two panels [px].
const GAP: f64 = 12.0;
/// Above a panel, for the times of its marks [px].
const MARKS: f64 = 20.0;
/// Below the last panel, for the numbers and the title of the time axis [px].
const TIME_AXIS: f64 = 48.0;

/// Of marks: lighter than what they go through.
const LIGHT: RGBColor = RGBColor(190, 190, 190);
/// Of envelopes.
const DARK: RGBColor = RGBColor(105, 105, 105);
/// Of a line in a legend that has only text.
const WHITE: RGBColor = RGBColor(255, 255, 255);

/// Curves over time with their own vertical axis.
pub struct Panel {
    range: Range,
    quantity: String,
    unit: &'static str,
    lines: Vec<Line>,
    legend: Vec<Entry>,
    swings: Vec<Swing>,
    beat: Beat,
}

/// All that is drawn over time.
pub struct Motion {
    /// Positions and angles, as far as there are any.
    pub signals: Vec<Panel>,
    /// Absent where no energies are recorded.
    pub energies: Option<Panel>,
    time: Range,
}

/// What a kind of signal is called.
struct Kind {
    /// Of one curve, and of several.
    components: [&'static str; 3],
    several: &'static str,
    unit: &'static str,
    /// Several are drawn from where they start: they may be far apart.
    from_start: bool,
    /// Ranges below this are round-off.
    least: f64,
}

/// One component of a probe over time.
struct Track {
    probe: usize,
    component: usize,
    points: Vec<Point>,
    travel: f64,
}

impl Motion {
    /// `size` is the extent of the scene [m].
    pub fn new(scene: &Scene, solution: &Solution, size: f64) -> Self {
        let positions = Kind {
            components: ["x", "y", "z"],
            several: "displacement",
            unit: "m",
            from_start: true,
            least: ROUND_OFF * size,
        };
        let angles = Kind {
            components: ["α", "β", "γ"],
            several: "angle",
            unit: "rad",
            from_start: false,
            least: ROUND_OFF,
        };
        let mut signals: Vec<Panel> = [
            panel(scene, &positions, tracks(solution, scene.probe.len(), |pose| Some(pose.position))),
            panel(scene, &angles, tracks(solution, scene.probe.len(), |pose| pose.angles)),
        ]
        .into_iter()
        .flatten()
        .collect();
        if let [first, rest @ ..] = signals.as_mut_slice() {
            first.beat = beat(&first.swings);
            for panel in rest {
                panel.beat = match first.beat {
                    Beat { least: None, most: None } => beat(&panel.swings),
                    both => answering(&panel.swings, both),
                };
            }
        }
        let times = solution.rows.iter().map(|row| row.parameter);
        let time = Range::of(times.chain([0.0])).filter(|time| time.length() > 0.0);
        Self { signals, energies: energies(solution), time: time.unwrap_or(Range { low: 0.0, high: 1.0 }) }
    }
}

/// Every component of every probe that has one; what cannot be drawn is left out.
fn tracks(solution: &Solution, probes: usize, value: impl Fn(&ProbePose) -> Option<[f64; 3]>) -> Vec<Track> {
    let components = (0..probes).flat_map(|probe| (0..3).map(move |component| (probe, component)));
    let track = |(probe, component): (usize, usize)| {
        let points = solution.rows.iter().filter_map(|row| {
            let value = value(row.probes.get(probe)?)?[component];
            (is_drawable(value) && is_drawable(row.parameter)).then_some([row.parameter, value])
        });
        let points: Vec<Point> = points.collect();
        let travel = Range::of(points.iter().map(|point| point[1]))?.length();
        Some(Track { probe, component, points, travel })
    };
    components.filter_map(track).collect()
}

/// The curves that move most; `None` if there are none.
fn panel(scene: &Scene, kind: &Kind, mut tracks: Vec<Track>) -> Option<Panel> {
    tracks.sort_by(|a, b| b.travel.total_cmp(&a.travel));
    let enough = LEGIBLE * tracks.first()?.travel;
    tracks.retain(|track| track.travel >= enough);
    let moving = tracks.len();
    tracks.truncate(MOST_LINES);
    tracks.sort_by_key(|track| (track.probe, track.component));
    let alone = tracks.len() == 1;
    if kind.from_start && !alone {
        for track in &mut tracks {
            let start = track.points.first().map_or(0.0, |point| point[1]);
            track.points.iter_mut().for_each(|point| point[1] -= start);
        }
    }
    let name = |track: &Track| {
        let component = kind.components[track.component];
        match scene.probe.get(track.probe) {
            Some(probe) if scene.probe.len() > 1 || alone => {
                format!("{component} of {}", shortened(&probe.name, NAME, SMALL))
            }
            _ => component.to_owned(),
        }
    };
    let quantity = if alone { tracks.first().map(name) } else { None };
    let color = |index: usize, track: &Track| {
        // The components of one probe have the colours they have elsewhere.
        COLORS[if scene.probe.len() == 1 { track.component } else { index }]
    };
    let pens: Vec<Pen> =
        tracks.iter().enumerate().map(|(index, track)| pen(color(index, track), WIDTHS[0])).collect();
    let mut legend: Vec<Entry> = Vec::new();
    if !alone {
        legend.extend(tracks.iter().zip(&pens).map(|(track, pen)| entry(*pen, &name(track))));
        if moving > tracks.len() {
            let rest = format!("and {} more, not drawn", moving - tracks.len());
            legend.push(entry(pen(WHITE, 0.0), &rest));
        }
    }
    let swings = match tracks.as_slice() {
        [track] => envelope(&track.points),
        _ => Vec::new(),
    };
    let lines: Vec<Line> = pens.into_iter().zip(tracks.into_iter().map(|track| track.points)).collect();
    Some(Panel {
        range: padded(&lines, kind.least),
        quantity: quantity.unwrap_or_else(|| kind.several.to_owned()),
        unit: kind.unit,
        lines,
        legend,
        swings,
        beat: Beat::default(),
    })
}

/// Kinetic, strain and gravitational energy and their sum, each from where it starts: the zero of the gravitational
/// one is arbitrary, and far away it would leave no room for the others.
fn energies(solution: &Solution) -> Option<Panel> {
    let first = *solution.energies.first()?;
    let line = |color: RGBColor, width: f64, value: &dyn Fn(&Energies) -> f64| -> Line {
        let pairs = solution.rows.iter().zip(&solution.energies);
        let points = pairs.map(|(row, energies)| [row.parameter, value(energies) - value(&first)]);
        (pen(color, width), points.filter(|point| point.iter().all(|value| is_drawable(*value))).collect())
    };
    let named = [
        ("kinetic", line(COLORS[1], WIDTHS[1], &|energies| energies.kinetic)),
        ("strain", line(COLORS[0], WIDTHS[1], &|energies| energies.strain)),
        ("gravity", line(COLORS[2], WIDTHS[1], &|energies| energies.gravity)),
        ("total", line(INK, WIDTHS[0], &Energies::total)),
    ];
    let legend = named.iter().map(|(name, line)| entry(line.0, name)).collect();
    let lines: Vec<Line> = named.into_iter().map(|(_, line)| line).collect();
    Some(Panel {
        range: padded(&lines, 0.0),
        quantity: "Δ energy".to_owned(),
        unit: "J",
        lines,
        legend,
        swings: Vec::new(),
        beat: Beat::default(),
    })
}

/// The range of the lines with room above and below; of some length for a constant, too.
fn padded(lines: &[Line], least: f64) -> Range {
    let values = lines.iter().flat_map(|line| &line.1).map(|point| point[1]);
    let range = Range::of(values).unwrap_or(Range { low: 0.0, high: 0.0 }).at_least(least);
    let range = if range.length() > 0.0 { range } else { range.with_length(1.0) };
    range.with_length(1.1 * range.length())
}

/// Draws panels one above the other over one time axis, titles and labels included.
pub fn draw_column(canvas: &mut Canvas, area: Area, panels: &[&Panel], motion: &Motion) -> io::Result<()> {
    let Some(last) = panels.len().checked_sub(1) else {
        return Ok(());
    };
    // The room of the numbers first, with any ticks: legends wrap to what is left of the width.
    let axes = |ticks: usize| -> Vec<Axis> {
        panels.iter().map(|panel| Axis::new(panel.range, ticks, &panel.quantity, panel.unit)).collect()
    };
    let left = |axes: &[Axis]| axes.iter().map(|axis| area.inside_axes(axis).left).fold(area.left, f64::max);
    let width = area.right - left(&axes(5));
    let headers: Vec<f64> = panels.iter().map(|panel| panel.header(width)).collect();
    let room = area.size()[1] - TIME_AXIS - headers.iter().sum::<f64>() - GAP * last as f64;
    let height = room / panels.len() as f64;
    let ticks = ((height / 40.0) as usize).clamp(3, 6);
    let axes = axes(ticks);
    let left = left(&axes);
    let time = Axis::new(motion.time, 6, "time", "s");
    let mut top = area.top;
    for (k, (panel, y)) in panels.iter().zip(axes).enumerate() {
        top += headers[k];
        let place = Area { left, top, right: area.right, bottom: top + height };
        let x = if k == last { time.clone() } else { time.clone().without_labels() };
        let y = y.with_title(|title| shortened(title, 1.2 * height, MEDIUM));
        draw_row(canvas, &panel.legend, [left, top], width)?;
        panel.draw(canvas, Frame { area: place, x, y })?;
        top += height + GAP;
    }
    Ok(())
}

impl Panel {
    /// Height of what stands above the panel.
    fn header(&self, width: f64) -> f64 {
        let marks = if self.beat == Beat::default() { 0.0 } else { MARKS };
        row_height(&self.legend, width).max(marks)
    }

    fn draw(&self, canvas: &mut Canvas, frame: Frame) -> io::Result<()> {
        let Area { left, top, right, bottom } = frame.area;
        let place = |point: Point| frame.place(point);
        let marks = [("smallest", self.beat.least), ("largest", self.beat.most)];
        let marks = marks.into_iter().filter_map(|(name, time)| Some((name, time?)));
        let mut marks: Vec<(&str, f64)> = marks.collect();
        marks.sort_by(|a, b| a.1.total_cmp(&b.1));
        let mut labels = Vec::new();
        for (name, time) in marks {
            let x = left + (right - left) * frame.x.fraction(time);
            canvas.curve(&[[x, top], [x, bottom]], pen(LIGHT, WIDTHS[2]))?;
            labels.push((x, format!("{name} swing at {} s", significant(time, 3))));
        }
        draw_labels(canvas, &labels, frame.area)?;
        for (pen, points) in &self.lines {
            let points: Vec<Point> = points.iter().copied().filter_map(place).collect();
            canvas.curve(&thinned(&points, 0.5), *pen)?;
            if points.len() <= FEW {
                points.iter().try_for_each(|point| canvas.dot(*point, pen.color))?;
            }
        }
        for side in sides(&self.swings) {
            let side: Vec<Point> = side.into_iter().filter_map(place).collect();
            canvas.curve(&thinned(&side, 0.5), pen(DARK, WIDTHS[1]))?;
        }
        frame.draw(canvas)
    }
}

/// Labels above a panel, from left to right, each over its place as nearly as the others and the ends allow.
fn draw_labels(canvas: &mut Canvas, labels: &[(f64, String)], area: Area) -> io::Result<()> {
    let widths: Vec<f64> = labels.iter().map(|label| text_width(&label.1, SMALL)).collect();
    let mut centres: Vec<f64> = Vec::new();
    for (k, (x, _)) in labels.iter().enumerate() {
        let from = match k.checked_sub(1) {
            Some(before) => centres[before] + 0.5 * widths[before] + 12.0,
            None => area.left,
        };
        // The others to the right need their room too.
        let rest: f64 = widths[k + 1..].iter().map(|width| width + 12.0).sum();
        centres.push(x.min(area.right - rest - 0.5 * widths[k]).max(from + 0.5 * widths[k]));
    }
    for ((_, text), centre) in labels.iter().zip(centres) {
        canvas.text(text, [centre, area.top - 9.0], SMALL, Anchor::Middle)?;
    }
    Ok(())
}
