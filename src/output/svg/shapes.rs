//! The right panel: what the rods look like under the load.

use std::io;

use super::axis::{Axis, Range, Scale, is_drawable};
use super::canvas::{Anchor, Canvas, GREY, INK, Pen, SMALL, pen, text_width};
use super::frame::{Area, Entry, Frame, Label, draw_entries, legend_size};
use super::path::Point;
use crate::solution::Shape;
use plotters::style::RGBColor;

/// Colours from the first to the last shape: light to dark, readable in grey too.
const RAMP: [[f64; 3]; 5] = [
    [138.0, 208.0, 190.0],
    [65.0, 182.0, 196.0],
    [29.0, 125.0, 185.0],
    [36.0, 66.0, 148.0],
    [10.0, 20.0, 72.0],
];
/// More shapes than this are thinned out.
const MOST_SHAPES: usize = 11;
/// Between the panel and its legend [px].
const GAP: f64 = 14.0;
const AXES: [&str; 3] = ["x", "y", "z"];

/// How the load, or the time, is named beside a shape.
pub struct Amount {
    pub name: &'static str,
    pub unit: &'static str,
    /// Its value at load factor 1, or at 1 s.
    pub full: f64,
    /// Its largest value in the figure.
    pub largest: f64,
}

impl Amount {
    fn scale(&self) -> Scale {
        Scale::of(self.largest)
    }

    fn title(&self) -> String {
        self.scale().title(self.name, self.unit)
    }

    fn at(&self, parameter: f64) -> String {
        self.scale().number(parameter * self.full)
    }
}

/// The shapes in the plane in which they are largest.
pub struct Shapes<'a> {
    shapes: Vec<&'a Shape>,
    /// Indices of the horizontal and the vertical direction.
    plane: [usize; 2],
    /// Of all shapes, horizontal and vertical [m].
    ranges: [Range; 2],
    /// Largest extent of the scene in any direction [m].
    pub size: f64,
}

/// Chooses the plane; `None` if there is nothing to draw.
pub fn shapes<'a>(all: &[&'a Shape]) -> Option<Shapes<'a>> {
    let shapes: Vec<&Shape> = if all.len() > MOST_SHAPES {
        let last = MOST_SHAPES - 1;
        (0..=last).map(|k| all[k * (all.len() - 1) / last]).collect()
    } else {
        all.to_vec()
    };
    let range = |axis: usize| {
        let points = shapes.iter().flat_map(|shape| &shape.rods).flatten();
        Range::of(points.map(|point| point[axis]))
    };
    let ranges = [range(0)?, range(1)?, range(2)?];
    let extent = |plane: &[usize; 2]| ranges[plane[0]].length() + ranges[plane[1]].length();
    // The first of equals.
    let plane = [[1, 2], [0, 2], [0, 1]].into_iter().max_by(|a, b| extent(a).total_cmp(&extent(b)))?;
    let size = ranges.iter().map(|range| range.length()).fold(0.0, f64::max);
    Some(Shapes { shapes, plane, ranges: plane.map(|axis| ranges[axis]), size })
}

impl Shapes<'_> {
    /// Draws into an area, titles and labels included.
    pub fn draw(&self, canvas: &mut Canvas, area: Area, amount: &Amount) -> io::Result<()> {
        match self.narrow_direction() {
            Some(across) => self.draw_side_by_side(canvas, area, amount, across),
            None => self.draw_together(canvas, area, amount),
        }
    }

    /// The direction (0 horizontal, 1 vertical) in which the shapes are so narrow, and wind so much, that
    /// drawn over each other none of them could be followed.
    fn narrow_direction(&self) -> Option<usize> {
        let across = usize::from(self.ranges[1].length() < self.ranges[0].length());
        let (narrow, long) = (self.ranges[across].length(), self.ranges[1 - across].length());
        let winds = |rod: &Vec<[f64; 3]>| {
            let axis = self.plane[across];
            let travel: f64 = rod.windows(2).map(|pair| (pair[1][axis] - pair[0][axis]).abs()).sum();
            let own = Range::of(rod.iter().map(|point| point[axis])).map_or(0.0, Range::length);
            // An arch goes there and back; a coil does so every turn. Round-off in a straight rod is no coil.
            own > 1e-6 * long && travel > 3.0 * own
        };
        let coiled = self.shapes.first().is_some_and(|shape| shape.rods.iter().any(winds));
        (self.shapes.len() > 1 && coiled && 1.5 * narrow < long).then_some(across)
    }

    fn draw_together(&self, canvas: &mut Canvas, area: Area, amount: &Amount) -> io::Result<()> {
        let entry = |shape: &&Shape| Entry {
            pen: self.pen(shape, 1.5),
            label: Label::Text(amount.at(shape.parameter)),
        };
        let legend: Vec<Entry> = self.shapes.iter().map(entry).collect();
        let legend_width = legend_size(&legend)[0].max(text_width(&amount.title(), SMALL));
        let area = Area { right: area.right - GAP - legend_width, ..area };
        let frame = self.frame(area, self.ranges, None);
        frame.draw(canvas)?;
        for (shape, entry) in self.shapes.iter().zip(&legend) {
            self.draw_shape(canvas, &frame, shape, entry.pen, [0.0; 2])?;
        }
        let at = [frame.area.right + GAP, frame.area.top];
        canvas.text(&amount.title(), [at[0], at[1] + 6.0], SMALL, Anchor::Start)?;
        draw_entries(canvas, &legend, [at[0], at[1] + 18.0])
    }

    /// Each shape has a place of its own, marked with its load.
    fn draw_side_by_side(
        &self,
        canvas: &mut Canvas,
        area: Area,
        amount: &Amount,
        across: usize,
    ) -> io::Result<()> {
        let count = self.shapes.len() as f64;
        let width = self.ranges[across].length();
        let mut ranges = self.ranges;
        ranges[across] = Range { low: 0.0, high: 1.2 * width * count };
        let frame = self.frame(area, ranges, Some((across, amount)));
        frame.draw(canvas)?;
        let axis = if across == 0 { &frame.x } else { &frame.y };
        for (shape, (place, _)) in self.shapes.iter().zip(&axis.ticks) {
            let mut offset = [0.0; 2];
            offset[across] = place - self.ranges[across].middle();
            self.draw_shape(canvas, &frame, shape, self.pen(shape, 1.0), offset)?;
        }
        Ok(())
    }

    /// Axes of equal scale that hold the ranges; in the direction `across` the load instead of a length.
    fn frame(&self, area: Area, ranges: [Range; 2], across: Option<(usize, &Amount)>) -> Frame {
        let least = if self.size > 0.0 { 1e-3 * self.size } else { 1.0 };
        let axes = |ranges: [Range; 2], counts: [usize; 2]| {
            [0, 1].map(|k| match across {
                Some((direction, amount)) if direction == k => self.places(ranges[k], amount, k),
                _ => Axis::new(ranges[k].at_least(least), counts[k], AXES[self.plane[k]], "m"),
            })
        };
        let area = area.inside_axes(&axes(ranges, [5, 6])[1]);
        let pixels = area.size();
        let scale =
            [0, 1].map(|k| 1.1 * ranges[k].length().max(least) / pixels[k]).into_iter().fold(0.0, f64::max);
        let ranges = [0, 1].map(|k| ranges[k].with_length(scale * pixels[k]));
        let [x, y] = axes(ranges, [5, 6]);
        Frame { area, x, y }
    }

    /// Evenly spaced places for the shapes: from left to right, from top to bottom.
    fn places(&self, range: Range, amount: &Amount, direction: usize) -> Axis {
        let count = self.shapes.len() as f64;
        let places = self.shapes.iter().enumerate().map(|(k, shape)| {
            let fraction = (k as f64 + 0.5) / count;
            let fraction = if direction == 0 { fraction } else { 1.0 - fraction };
            let label = amount.at(shape.parameter);
            (range.low + fraction * range.length(), label)
        });
        let names = self.plane.map(|axis| AXES[axis]);
        let title = format!("{}, {}–{} plane to scale", amount.title(), names[0], names[1]);
        Axis::of_labels(range, places.collect(), title)
    }

    fn draw_shape(
        &self,
        canvas: &mut Canvas,
        frame: &Frame,
        shape: &Shape,
        pen: Pen,
        offset: [f64; 2],
    ) -> io::Result<()> {
        for rod in &shape.rods {
            let points = rod.iter().filter_map(|point| {
                let projected = [0, 1].map(|k| point[self.plane[k]] + offset[k]);
                frame.place(projected)
            });
            canvas.curve(&points.collect::<Vec<Point>>(), pen)?;
        }
        Ok(())
    }

    /// Grey for the undeformed shape, then from light to dark.
    fn pen(&self, shape: &Shape, width: f64) -> Pen {
        let loaded = self.shapes.iter().map(|shape| shape.parameter);
        let last = Range::of(loaded).map_or(0.0, |range| range.high);
        let color = if shape.parameter == 0.0 {
            GREY
        } else if last > 0.0 && is_drawable(shape.parameter) {
            ramp(shape.parameter / last)
        } else {
            INK
        };
        pen(color, width)
    }
}

/// The colour at a fraction of the ramp.
fn ramp(fraction: f64) -> RGBColor {
    let along = fraction.clamp(0.0, 1.0) * (RAMP.len() - 1) as f64;
    let below = (along as usize).min(RAMP.len() - 2);
    let t = along - below as f64;
    let [r, g, b] =
        [0, 1, 2].map(|k| (RAMP[below][k] + t * (RAMP[below + 1][k] - RAMP[below][k])).round() as u8);
    RGBColor(r, g, b)
}
