//! Canvas, scale and legend of a picture.

use super::error::FigureError;
use super::mark::{Mark, Offsets, Outline};
use super::panel::{self, Canvas, DrawingError};
use super::range::widened;
use plotters::prelude::*;
use std::ops::Range;

/// The backend draws on whole pixels, so everything is drawn this many times larger than shown.
const OVERSAMPLING: u32 = 4;

/// Width of a picture that stands in one column \[px\]; shown as 600.
pub(super) const COLUMN: u32 = 2400;

/// Width of a circle's edge \[px\].
pub(super) const RING: u32 = 8;

/// Height of one line of a legend \[px\].
const LINE: u32 = 125;

/// An SVG document of this size on the canvas \[px\].
pub(super) fn document(
    size: (u32, u32),
    draw: impl FnOnce(&Canvas<'_>) -> Result<(), DrawingError>,
) -> Result<String, FigureError> {
    let mut svg = String::new();
    {
        let canvas = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        canvas.fill(&WHITE)?;
        draw(&canvas)?;
        canvas.present()?;
    }
    let tag = |(width, height): (u32, u32)| format!("width=\"{width}\" height=\"{height}\"");
    let shown = (size.0 / OVERSAMPLING, size.1 / OVERSAMPLING);
    Ok(svg.replacen(&tag(size), &tag(shown), 1))
}

/// Gives both axes of a panel of this size the same scale, with or without a label on its downrange
/// axis. The axis with the finer scale gets a wider range about its middle. Returns the ranges and
/// the scale [m/px].
pub(super) fn to_scale(
    size: (u32, u32),
    labelled: bool,
    x: Range<f64>,
    z: Range<f64>,
) -> (Range<f64>, Range<f64>, f64) {
    let (width, height) = panel::plot_size(size, labelled);
    let scale = ((x.end - x.start) / width).max((z.end - z.start) / height);
    let x_room = 0.5 * (scale * width - (x.end - x.start));
    let z_room = 0.5 * (scale * height - (z.end - z.start));
    (widened(x, x_room), widened(z, z_room), scale)
}

/// The sign of an entry in a legend.
pub(super) enum Sample {
    /// A line of this width \[px\].
    Line(RGBColor, u32),
    /// A line with a mark.
    Curve(RGBColor, Outline),
    /// A mark.
    Mark(RGBColor, Outline),
    /// A filled circle.
    Dot(RGBColor),
    /// A circle's edge.
    Ring(RGBColor),
    /// A filled square.
    Area(RGBAColor),
}

/// Height of a legend with this number of entries, two to a line \[px\].
pub(super) fn legend_height(entries: usize) -> u32 {
    LINE * entries.div_ceil(2) as u32 + 25
}

/// Draws the names of the colours, two to a line.
pub(super) fn legend(area: &Canvas<'_>, entries: &[(Sample, &str)]) -> Result<(), DrawingError> {
    const LEFT: i32 = 120;
    const COLUMN_WIDTH: i32 = 1160;
    const SAMPLE: i32 = 140;
    for (index, (sample, words)) in entries.iter().enumerate() {
        let x = LEFT + COLUMN_WIDTH * (index % 2) as i32;
        let y = LINE as i32 * (index / 2) as i32 + 80;
        let middle = (x + SAMPLE / 2, y);
        match sample {
            Sample::Line(colour, width) => {
                let line = vec![(x, y), (x + SAMPLE, y)];
                area.draw(&PathElement::new(line, colour.stroke_width(*width)))?;
            }
            Sample::Curve(colour, outline) => {
                let line = vec![(x, y), (x + SAMPLE, y)];
                area.draw(&PathElement::new(line, colour.stroke_width(16)))?;
                draw_mark(area, middle, *outline, *colour)?;
            }
            Sample::Mark(colour, outline) => draw_mark(area, middle, *outline, *colour)?,
            Sample::Dot(colour) => area.draw(&Circle::new(middle, 28, colour.filled()))?,
            Sample::Ring(colour) => {
                area.draw(&Circle::new(middle, 28, colour.stroke_width(RING)))?;
            }
            Sample::Area(colour) => {
                let corners = [(middle.0 - 40, y - 40), (middle.0 + 40, y + 40)];
                area.draw(&Rectangle::new(corners, colour.filled()))?;
            }
        }
        let style = panel::text_style().pos(panel::left_middle());
        area.draw(&Text::new((*words).to_owned(), (x + SAMPLE + 40, y), style))?;
    }
    Ok(())
}

/// Draws a mark in a legend.
pub(super) fn draw_mark(
    area: &Canvas<'_>,
    at: (i32, i32),
    outline: Outline,
    colour: RGBColor,
) -> Result<(), DrawingError> {
    let mark = Mark {
        at: (0.0, 0.0),
        outline,
        colour,
    };
    let placed = |offsets: Offsets| {
        offsets
            .iter()
            .map(|(x, y)| (at.0 + x, at.1 + y))
            .collect::<Offsets>()
    };
    if let Some(filled) = mark.filled() {
        area.draw(&Polygon::new(placed(filled), colour.filled()))?;
    }
    let (lines, colour) = mark.lines();
    for line in lines {
        area.draw(&PathElement::new(placed(line), colour.stroke_width(RING)))?;
    }
    Ok(())
}
