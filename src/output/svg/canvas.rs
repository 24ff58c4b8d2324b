//! The sheet a figure is drawn on: plotters' SVG backend, in pixels with a fraction.

use std::io;

use plotters::backend::{DrawingBackend, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{
    Color, FontDesc, FontFamily, FontStyle, FontTransform, RGBColor, ShapeStyle, TextStyle,
};

use super::path::{self, Point};

/// Black for text and axes; a little softer than pure black.
pub const INK: RGBColor = RGBColor(34, 34, 34);
/// For what is only there to compare with.
pub const GREY: RGBColor = RGBColor(150, 150, 150);
/// Size of tick labels and legends [px].
pub const SMALL: f64 = 12.0;
/// Size of axis titles [px].
pub const MEDIUM: f64 = 13.0;
/// Size of the figure's title [px].
pub const LARGE: f64 = 14.5;

/// The backend knows whole units only: everything is drawn this much larger, and the document scaled back.
const UNITS: f64 = 10.0;
/// A deviation from a curve that nobody sees [px].
const INVISIBLE: f64 = 0.15;
/// Radius of a dot [px].
const DOT: f64 = 2.2;
/// The backend divides font sizes by this.
const BACKEND_FONT_RATIO: f64 = 1.24;
const FONTS: &str = "Helvetica, Arial, sans-serif";

/// Pen of a line: colour, width and dash pattern (lengths drawn and left out, alternating) [px].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pen {
    pub color: RGBColor,
    pub width: f64,
    pub dashes: &'static [f64],
}

/// A full line.
pub fn pen(color: RGBColor, width: f64) -> Pen {
    Pen { color, width, dashes: &[] }
}

/// Which part of a text lies at its point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Anchor {
    Start,
    Middle,
    End,
}

/// Lines and text become an SVG document in a string.
pub struct Canvas<'a> {
    backend: SVGBackend<'a>,
}

/// Draws on a white sheet of the given size [px] and returns the document.
pub fn document(size: [f64; 2], draw: impl FnOnce(&mut Canvas) -> io::Result<()>) -> io::Result<String> {
    let units = size.map(|length| unit(length).unsigned_abs());
    let mut text = String::new();
    let mut canvas = Canvas { backend: SVGBackend::with_string(&mut text, (units[0], units[1])) };
    canvas.fill([0.0, 0.0], size)?;
    draw(&mut canvas)?;
    canvas.backend.present().map_err(io::Error::other)?;
    drop(canvas);
    // The first line is the opening tag with the enlarged size; joins and caps are inherited from it.
    let body = text.split_once('\n').map_or("", |(_, body)| body);
    Ok(format!(
        "<svg width=\"{}\" height=\"{}\" viewBox=\"0 0 {} {}\" xmlns=\"http://www.w3.org/2000/svg\" \
         stroke-linejoin=\"round\" stroke-linecap=\"round\">\n{body}",
        size[0], size[1], units[0], units[1]
    ))
}

impl Canvas<'_> {
    /// A white rectangle from its upper left to its lower right corner.
    pub fn fill(&mut self, from: Point, to: Point) -> io::Result<()> {
        let white = RGBColor(255, 255, 255).filled();
        self.backend.draw_rect(units(from), units(to), &white, true).map_err(io::Error::other)
    }

    /// A curve, without the points that do not show; a dot if it has no extent.
    pub fn curve(&mut self, points: &[Point], pen: Pen) -> io::Result<()> {
        let points = path::simplify(points, INVISIBLE);
        match points.as_slice() {
            [] => Ok(()),
            [point] => self.dot(*point, pen.color),
            points if pen.dashes.is_empty() => self.stroke(points, pen),
            points => path::dashed(points, pen.dashes).iter().try_for_each(|dash| self.stroke(dash, pen)),
        }
    }

    /// A small filled circle.
    pub fn dot(&mut self, at: Point, color: RGBColor) -> io::Result<()> {
        self.backend
            .draw_circle(units(at), unit(DOT).unsigned_abs(), &color.filled(), true)
            .map_err(io::Error::other)
    }

    fn stroke(&mut self, points: &[Point], pen: Pen) -> io::Result<()> {
        let style: ShapeStyle = pen.color.stroke_width(unit(pen.width).unsigned_abs());
        let points = points.iter().map(|point| units(*point));
        self.backend.draw_path(points, &style).map_err(io::Error::other)
    }

    /// A line of text, vertically centred on its point.
    pub fn text(&mut self, text: &str, at: Point, size: f64, anchor: Anchor) -> io::Result<()> {
        // The backend centres lower-case letters; capitals and digits are taller.
        let at = [at[0], at[1] + 0.07 * size];
        self.write(text, at, style(size, FontStyle::Normal, anchor))
    }

    /// A line of text that reads upwards, centred on its point.
    pub fn upward_text(&mut self, text: &str, at: Point, size: f64) -> io::Result<()> {
        let style = style(size, FontStyle::Normal, Anchor::Middle).transform(FontTransform::Rotate270);
        self.write(text, at, style)
    }

    /// An italic symbol with an upright index.
    pub fn symbol(&mut self, symbol: &str, index: &str, at: Point, size: f64) -> io::Result<()> {
        self.write(symbol, at, style(size, FontStyle::Italic, Anchor::Start))?;
        let below = [at[0] + 0.62 * size, at[1] + 0.25 * size];
        self.write(index, below, style(0.75 * size, FontStyle::Italic, Anchor::Start))
    }

    fn write(&mut self, text: &str, at: Point, style: TextStyle) -> io::Result<()> {
        if text.is_empty() {
            return Ok(());
        }
        self.backend.draw_text(&printable(text), &style, units(at)).map_err(io::Error::other)
    }
}

/// Width of a text [px], guessed: the reader's font is not known here.
pub fn text_width(text: &str, size: f64) -> f64 {
    0.58 * size * text.chars().count() as f64
}

/// The text, or as much of it as fits.
pub fn shortened(text: &str, width: f64, size: f64) -> String {
    if text_width(text, size) <= width {
        return text.to_owned();
    }
    let fits = (width / text_width("x", size)) as usize;
    let start: String = text.chars().take(fits.saturating_sub(1)).collect();
    format!("{}…", start.trim_end())
}

fn style(size: f64, slant: FontStyle, anchor: Anchor) -> TextStyle<'static> {
    let horizontal = match anchor {
        Anchor::Start => HPos::Left,
        Anchor::Middle => HPos::Center,
        Anchor::End => HPos::Right,
    };
    FontDesc::new(FontFamily::Name(FONTS), size * UNITS * BACKEND_FONT_RATIO, slant)
        .color(&INK)
        .pos(Pos::new(horizontal, VPos::Center))
}

/// Without the characters XML does not allow.
fn printable(text: &str) -> String {
    let allowed = |c: &char| !matches!(c, '\u{fffe}' | '\u{ffff}');
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).filter(allowed).collect()
}

fn units(point: Point) -> (i32, i32) {
    (unit(point[0]), unit(point[1]))
}

fn unit(length: f64) -> i32 {
    (length * UNITS).round() as i32
}
