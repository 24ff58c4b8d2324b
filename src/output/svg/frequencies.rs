//! Frequencies of small vibrations, as stems.

use std::io;

use super::axis::{Axis, Range, is_drawable, significant};
use super::canvas::{Anchor, Canvas, GREY, SMALL, pen, text_width};
use super::curves::{COLORS, entry};
use super::frame::{Area, Entry, Frame, draw_row, row_height};
use crate::solution::{Mode, Solution};

/// Width of a stem [px].
const WIDTH: f64 = 2.0;
/// Significant digits of a frequency: neighbours often differ little.
const DIGITS: i32 = 5;

/// Draws into an area, titles and labels included; nothing without modes.
pub fn draw(canvas: &mut Canvas, area: Area, solution: &Solution) -> io::Result<()> {
    let frequencies: Vec<f64> = solution.modes.iter().map(Mode::frequency).collect();
    let count = frequencies.len() as f64;
    let Some(range) = Range::of(frequencies.iter().copied().chain([0.0])) else {
        return Ok(());
    };
    let mut legend: Vec<Entry> = Vec::new();
    if range.low < 0.0 {
        legend.push(entry(pen(COLORS[1], WIDTH), "unstable, grows e-fold in 1/(2π|f|)"));
    }
    let room = 0.12 * range.length();
    let range = Range {
        low: if range.low < 0.0 { range.low - room } else { 0.0 },
        high: if range.high > 0.0 { range.high + room } else { 0.0 },
    };
    let y = Axis::new(range, 6, "frequency", "Hz");
    let inside = area.inside_axes(&y);
    let inside = Area { top: inside.top + row_height(&legend, inside.size()[0]), ..inside };
    let spacing = inside.size()[0] / count.max(1.0);
    let skip = (20.0 / spacing).ceil().max(1.0) as usize;
    let ticks = (1..=frequencies.len()).step_by(skip).map(|mode| (mode as f64, mode.to_string()));
    let x =
        Axis::of_labels(Range { low: 0.5, high: count.max(1.0) + 0.5 }, ticks.collect(), "mode".to_owned());
    let frame = Frame { area: inside, x, y };
    frame.draw(canvas)?;
    draw_row(canvas, &legend, [inside.left, inside.top], inside.size()[0])?;
    let labels: Vec<String> = frequencies.iter().map(|frequency| significant(*frequency, DIGITS)).collect();
    let widest = labels.iter().map(|label| text_width(label, SMALL)).fold(0.0, f64::max);
    if range.low < 0.0 {
        let ends = [frame.x.range.low, frame.x.range.high].map(|x| frame.place([x, 0.0]));
        canvas.curve(&ends.into_iter().flatten().collect::<Vec<_>>(), pen(GREY, 0.8))?;
    }
    for (k, (frequency, label)) in frequencies.iter().zip(&labels).enumerate() {
        let mode = (k + 1) as f64;
        let (Some(foot), Some(head)) = (frame.place([mode, 0.0]), frame.place([mode, *frequency])) else {
            continue;
        };
        let unstable = *frequency < 0.0;
        let color = COLORS[usize::from(unstable)];
        canvas.curve(&[foot, head], pen(color, WIDTH))?;
        canvas.dot(head, color)?;
        if widest + 4.0 < spacing && is_drawable(*frequency) {
            let beyond = [head[0], head[1] + if unstable { 12.0 } else { -12.0 }];
            canvas.text(label, beyond, SMALL, Anchor::Middle)?;
        }
    }
    Ok(())
}
