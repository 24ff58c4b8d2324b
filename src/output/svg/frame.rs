//! A panel: two axes, their ticks and titles, and a legend.

use std::io;

use super::axis::{Axis, is_drawable};
use super::canvas::{Anchor, Canvas, INK, MEDIUM, Pen, SMALL, pen, text_width};
use super::path::Point;

/// Length of a tick, drawn inwards [px].
const TICK: f64 = 4.0;
/// Length of the piece of line in a legend [px].
const SAMPLE: f64 = 24.0;
/// Height of a line in a legend [px].
const LINE: f64 = 17.0;

/// A rectangle on the sheet [px].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Area {
    pub left: f64,
    pub top: f64,
    pub right: f64,
    pub bottom: f64,
}

impl Area {
    /// Width and height.
    pub fn size(&self) -> [f64; 2] {
        [self.right - self.left, self.bottom - self.top]
    }

    /// Without the room that titles and labels need to the left and below.
    pub fn inside_axes(&self, y: &Axis) -> Self {
        let widths = y.ticks.iter().map(|tick| text_width(&tick.1, SMALL));
        Self { left: self.left + 32.0 + widths.fold(0.0, f64::max), bottom: self.bottom - 48.0, ..*self }
    }
}

/// What stands beside a line of the legend.
#[derive(Clone, Debug, PartialEq)]
pub enum Label {
    Text(String),
    /// A component of the displacement.
    Component(&'static str),
}

/// A line of the legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    pub pen: Pen,
    pub label: Label,
}

/// Two axes around an area.
pub struct Frame {
    pub area: Area,
    pub x: Axis,
    pub y: Axis,
}

impl Frame {
    /// Where a point of the plane lies on the sheet; `None` for what cannot be drawn.
    pub fn place(&self, point: Point) -> Option<Point> {
        let [width, height] = self.area.size();
        let drawable = point.iter().all(|value| is_drawable(*value));
        drawable.then(|| {
            [
                self.area.left + width * self.x.fraction(point[0]),
                self.area.bottom - height * self.y.fraction(point[1]),
            ]
        })
    }

    /// Box, ticks, numbers and titles.
    pub fn draw(&self, canvas: &mut Canvas) -> io::Result<()> {
        let Area { left, top, right, bottom } = self.area;
        let thin = pen(INK, 0.8);
        let corners = [[left, top], [right, top], [right, bottom], [left, bottom], [left, top]];
        canvas.curve(&corners, thin)?;
        let [width, height] = self.area.size();
        for (value, label) in &self.x.ticks {
            let x = left + width * self.x.fraction(*value);
            canvas.curve(&[[x, bottom], [x, bottom - TICK]], thin)?;
            canvas.text(label, [x, bottom + 13.0], SMALL, Anchor::Middle)?;
        }
        let mut widest = 0.0_f64;
        for (value, label) in &self.y.ticks {
            let y = bottom - height * self.y.fraction(*value);
            canvas.curve(&[[left, y], [left + TICK, y]], thin)?;
            canvas.text(label, [left - 6.0, y], SMALL, Anchor::End)?;
            widest = widest.max(text_width(label, SMALL));
        }
        let below = [left + 0.5 * width, bottom + 33.0];
        canvas.text(self.x.title(), below, MEDIUM, Anchor::Middle)?;
        let beside = [left - 20.0 - widest, top + 0.5 * height];
        canvas.upward_text(self.y.title(), beside, MEDIUM)
    }

    /// A legend in the corner where it hides least of the curves.
    pub fn draw_legend(
        &self,
        canvas: &mut Canvas,
        entries: &[Entry],
        curves: &[Vec<Point>],
    ) -> io::Result<()> {
        let [width, height] = legend_size(entries);
        let Area { left, top, right, bottom } = self.area;
        let gap = 8.0;
        let corners = [
            [left + gap, top + gap],
            [right - gap - width, bottom - gap - height],
            [right - gap - width, top + gap],
            [left + gap, bottom - gap - height],
        ];
        let hidden = |corner: &Point| {
            let points = curves.iter().flat_map(|curve| sampled(curve));
            let inside = |k: usize, x: f64, length: f64| x > corner[k] - gap && x < corner[k] + length + gap;
            points.filter(|point| inside(0, point[0], width) && inside(1, point[1], height)).count()
        };
        // The first of equals: the order above is one of taste.
        let best = corners.iter().min_by_key(|corner| hidden(corner));
        best.map_or(Ok(()), |corner| draw_entries(canvas, entries, *corner))
    }
}

/// Points of a polyline a few pixels apart, so that long segments count too.
fn sampled(curve: &[Point]) -> impl Iterator<Item = Point> {
    curve.windows(2).flat_map(|pair| {
        let (a, b) = (pair[0], pair[1]);
        let count = 1 + ((b[0] - a[0]).hypot(b[1] - a[1]) / 4.0) as usize;
        (0..=count).map(move |k| {
            let t = k as f64 / count as f64;
            [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]
        })
    })
}

/// Width and height of a legend.
pub fn legend_size(entries: &[Entry]) -> [f64; 2] {
    let widths = entries.iter().map(|entry| match &entry.label {
        Label::Text(text) => text_width(text, SMALL),
        Label::Component(_) => 1.3 * SMALL,
    });
    let widest = widths.fold(0.0, f64::max);
    [SAMPLE + 8.0 + widest, LINE * entries.len() as f64]
}

/// Draws a legend with its upper left corner at a point.
pub fn draw_entries(canvas: &mut Canvas, entries: &[Entry], at: Point) -> io::Result<()> {
    for (k, entry) in entries.iter().enumerate() {
        let y = at[1] + LINE * (k as f64 + 0.5);
        canvas.curve(&[[at[0], y], [at[0] + SAMPLE, y]], entry.pen)?;
        let beside = [at[0] + SAMPLE + 8.0, y];
        match &entry.label {
            Label::Text(text) => canvas.text(text, beside, SMALL, Anchor::Start)?,
            Label::Component(index) => canvas.symbol("u", index, beside, 1.1 * SMALL)?,
        }
    }
    Ok(())
}

/// Between two entries of a row [px].
const BETWEEN: f64 = 14.0;

/// Where the entries of a legend begin that runs along the top of a panel, line by line, and the number of lines.
fn row_places(entries: &[Entry], width: f64) -> (Vec<Point>, usize) {
    let (mut places, mut x, mut line) = (Vec::new(), 0.0, 0);
    for entry in entries {
        let own = legend_size(std::slice::from_ref(entry))[0];
        if x > 0.0 && x + own > width {
            (x, line) = (0.0, line + 1);
        }
        places.push([x, LINE * line as f64]);
        x += own + BETWEEN;
    }
    (places, if entries.is_empty() { 0 } else { line + 1 })
}

/// Height of a legend along the top of a panel.
pub fn row_height(entries: &[Entry], width: f64) -> f64 {
    match row_places(entries, width).1 {
        0 => 0.0,
        lines => LINE * lines as f64 + 3.0,
    }
}

/// Draws a legend along the top of a panel, above its upper left corner.
pub fn draw_row(canvas: &mut Canvas, entries: &[Entry], corner: Point, width: f64) -> io::Result<()> {
    let top = corner[1] - row_height(entries, width);
    for (entry, place) in entries.iter().zip(row_places(entries, width).0) {
        draw_entries(canvas, std::slice::from_ref(entry), [corner[0] + place[0], top + place[1]])?;
    }
    Ok(())
}
