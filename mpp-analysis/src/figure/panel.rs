//! One pair of axes, and everything that is drawn between them.

pub(super) use super::axis::Axis;
use super::mark::Mark;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::ops::Range;

pub(super) type Canvas<'a> = DrawingArea<SVGBackend<'a>, Shift>;
pub(super) type DrawingError = DrawingAreaErrorKind<std::io::Error>;

/// Text height \[px\]; the backend shows it smaller by 1.24.
const TEXT: u32 = 100;
/// Room left of the plot for numbers and label, and around the panel for half a number \[px\].
const LEFT: u32 = 380;
const MARGIN_LEFT: u32 = 40;
const MARGIN_BOTTOM: u32 = 25;
const RIGHT: u32 = 90;
const TOP: u32 = 50;
/// Room below the plot, first with numbers and label, then without them \[px\].
const BELOW_LABELLED: u32 = 230;
const BELOW: u32 = 35;

/// Height that a panel saves without words on its downrange axis \[px\].
pub(super) const BELOW_SAVED: u32 = BELOW_LABELLED - BELOW;

/// Width of the lines of marks \[px\].
const MARK_LINE: u32 = 8;

const GREY: RGBColor = RGBColor(222, 222, 222);
const DARK: RGBColor = RGBColor(40, 40, 40);

pub(super) fn text_style() -> TextStyle<'static> {
    ("sans-serif", TEXT).into_font().color(&DARK)
}

pub(super) fn left_middle() -> Pos {
    Pos::new(HPos::Left, VPos::Center)
}

/// Width and height of the plot itself in a panel of this size \[px\].
pub(super) fn plot_size(panel: (u32, u32), labelled: bool) -> (f64, f64) {
    let below = if labelled { BELOW_LABELLED } else { BELOW };
    (
        f64::from(panel.0 - MARGIN_LEFT - LEFT - RIGHT),
        f64::from(panel.1 - TOP - below - MARGIN_BOTTOM),
    )
}

/// A line in one colour, in pieces.
pub(super) struct Curve {
    pub(super) colour: RGBColor,
    pub(super) width: u32,
    pieces: Vec<Vec<(f64, f64)>>,
}

impl Curve {
    /// The flown line is the wider one: the planned line, drawn upon it, leaves its edges visible.
    pub(super) const FLOWN_WIDTH: u32 = 16;
    pub(super) const PLANNED_WIDTH: u32 = 9;

    /// A curve of one piece through every point.
    pub(super) fn flown(colour: RGBColor, x: &[f64], y: &[f64]) -> Self {
        Self {
            colour,
            width: Self::FLOWN_WIDTH,
            pieces: vec![thinned(x.iter().copied().zip(y.iter().copied()).collect())],
        }
    }

    /// A curve of one piece for each range, without the points that are missing.
    pub(super) fn planned(
        colour: RGBColor,
        x: &[Option<f64>],
        y: &[Option<f64>],
        ranges: &[Range<usize>],
    ) -> Self {
        let piece = |range: &Range<usize>| {
            let points = x.iter().zip(y).skip(range.start).take(range.len());
            thinned(points.filter_map(|(x, y)| Some(((*x)?, (*y)?))).collect())
        };
        Self {
            colour,
            width: Self::PLANNED_WIDTH,
            pieces: ranges.iter().map(piece).collect(),
        }
    }

    /// The pieces, each of which is drawn without a gap.
    pub(super) fn pieces(&self) -> &[Vec<(f64, f64)>] {
        &self.pieces
    }

    pub(super) fn points(&self) -> impl Iterator<Item = &(f64, f64)> {
        self.pieces.iter().flatten()
    }
}

/// Every fourth point and the last one; of a long line, one for each few pixels. 25 points in a second draw a smooth
/// line; 100 points on whole pixels draw a ragged line.
pub(super) fn thinned(points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    const STRIDE: usize = 4;
    const MOST: usize = 6000;
    let last = points.len().saturating_sub(1);
    let stride = STRIDE.max(points.len() / MOST);
    let kept = points.into_iter().enumerate();
    kept.filter(|(index, _)| index % stride == 0 || *index == last)
        .map(|(_, point)| point)
        .collect()
}

/// Joins segments into pieces. A piece goes on while each segment begins where the last one ends.
fn joined(segments: impl Iterator<Item = [(f64, f64); 2]>) -> Vec<Vec<(f64, f64)>> {
    let mut pieces: Vec<Vec<(f64, f64)>> = Vec::new();
    for [from, to] in segments {
        match pieces.last_mut() {
            Some(piece) if piece.last() == Some(&from) => piece.push(to),
            _ => pieces.push(vec![from, to]),
        }
    }
    pieces
}

/// The part of a convex polygon where `normal . p <= bound`.
pub(super) fn clipped(polygon: &[(f64, f64)], normal: (f64, f64), bound: f64) -> Vec<(f64, f64)> {
    let excess = |p: (f64, f64)| normal.0 * p.0 + normal.1 * p.1 - bound;
    let mut kept = Vec::new();
    for (index, &from) in polygon.iter().enumerate() {
        let to = polygon[(index + 1) % polygon.len()];
        let (before, after) = (excess(from), excess(to));
        if before <= 0.0 {
            kept.push(from);
        }
        if (before < 0.0) != (after < 0.0) {
            let share = before / (before - after);
            kept.push((
                from.0 + share * (to.0 - from.0),
                from.1 + share * (to.1 - from.1),
            ));
        }
    }
    kept
}

/// Axes, and everything that is drawn between them. Each list is drawn upon the one before.
pub(super) struct Panel {
    pub(super) x: Axis,
    pub(super) y: Axis,
    /// Filled polygons.
    pub(super) areas: Vec<(Vec<(f64, f64)>, RGBAColor)>,
    /// Circles: centre, radius \[px\], colour.
    pub(super) circles: Vec<((f64, f64), u32, RGBColor)>,
    pub(super) curves: Vec<Curve>,
    /// Dots. They are like the circles, but lie upon the curves.
    pub(super) dots: Vec<((f64, f64), u32, RGBColor)>,
    /// Marks upon the curves.
    pub(super) marks: Vec<Mark>,
    /// Words. Their position is their left middle.
    pub(super) labels: Vec<((f64, f64), String, RGBColor)>,
}

impl Panel {
    pub(super) fn new(x: Axis, y: Axis) -> Self {
        Self {
            x,
            y,
            areas: Vec::new(),
            circles: Vec::new(),
            curves: Vec::new(),
            dots: Vec::new(),
            marks: Vec::new(),
            labels: Vec::new(),
        }
    }

    /// Adds a line, cut off at the panel's edges.
    pub(super) fn line(&mut self, colour: RGBColor, width: u32, points: &[(f64, f64)]) {
        let pieces = points
            .windows(2)
            .filter_map(|pair| self.cut(pair[0], pair[1]));
        let curve = Curve {
            colour,
            width,
            pieces: joined(pieces),
        };
        self.curves.push(curve);
    }

    /// Adds a filled polygon, which must be convex, cut off at the panel's edges.
    pub(super) fn area(&mut self, colour: RGBAColor, points: &[(f64, f64)]) {
        let (x, y) = (&self.x.range, &self.y.range);
        let sides = [
            ((1.0, 0.0), x.end),
            ((-1.0, 0.0), -x.start),
            ((0.0, 1.0), y.end),
            ((0.0, -1.0), -y.start),
        ];
        let inside = sides
            .iter()
            .fold(points.to_vec(), |points, (normal, bound)| {
                clipped(&points, *normal, *bound)
            });
        if inside.len() > 2 {
            self.areas.push((inside, colour));
        }
    }

    pub(super) fn holds(&self, point: (f64, f64)) -> bool {
        self.x.range.contains(&point.0) && self.y.range.contains(&point.1)
    }

    /// Adds a dot if it lies within the panel.
    pub(super) fn dot(&mut self, centre: (f64, f64), radius: u32, colour: RGBColor) {
        if self.holds(centre) {
            self.dots.push((centre, radius, colour));
        }
    }

    /// The part of a segment within the panel (Liang and Barsky).
    fn cut(&self, from: (f64, f64), to: (f64, f64)) -> Option<[(f64, f64); 2]> {
        let (mut first, mut last) = (0.0_f64, 1.0_f64);
        for (start, step, range) in [
            (from.0, to.0 - from.0, &self.x.range),
            (from.1, to.1 - from.1, &self.y.range),
        ] {
            let (a, b) = ((range.start - start) / step, (range.end - start) / step);
            if step.abs() > 0.0 {
                first = first.max(a.min(b));
                last = last.min(a.max(b));
            } else if !range.contains(&start) {
                return None;
            }
        }
        // An end within the panel stays what it is, to the last bit: pieces are joined there.
        let at = |share: f64| match share {
            ..=0.0 => from,
            1.0.. => to,
            _ => (
                from.0 + share * (to.0 - from.0),
                from.1 + share * (to.1 - from.1),
            ),
        };
        (first < last).then(|| [at(first), at(last)])
    }

    pub(super) fn draw(&self, area: &Canvas<'_>) -> Result<(), DrawingError> {
        let labelled = !self.x.label.is_empty();
        let mut chart = ChartBuilder::on(area)
            .margin_left(MARGIN_LEFT)
            .margin_top(TOP)
            .margin_bottom(MARGIN_BOTTOM)
            .margin_right(RIGHT)
            .x_label_area_size(if labelled { BELOW_LABELLED } else { BELOW })
            .y_label_area_size(LEFT)
            .build_cartesian_2d(self.x.clone(), self.y.clone())?;
        chart
            .configure_mesh()
            .max_light_lines(0)
            .bold_line_style(GREY.stroke_width(4))
            .axis_style(DARK.stroke_width(5))
            .set_all_tick_mark_size(20)
            .label_style(text_style())
            .axis_desc_style(text_style())
            .x_desc(self.x.label)
            .y_desc(self.y.label)
            .draw()?;
        let circle = |&(centre, radius, colour): &((f64, f64), u32, RGBColor)| {
            Circle::new(centre, radius, colour.filled())
        };
        let areas = self.areas.iter();
        chart.draw_series(areas.map(|(points, colour)| Polygon::new(points.clone(), *colour)))?;
        chart.draw_series(self.circles.iter().map(circle))?;
        for curve in &self.curves {
            let style = curve.colour.stroke_width(curve.width);
            let lines = curve.pieces.iter().filter(|piece| piece.len() > 1);
            chart.draw_series(lines.map(|piece| PathElement::new(piece.clone(), style)))?;
        }
        chart.draw_series(self.dots.iter().map(circle))?;
        for mark in &self.marks {
            let filled = mark
                .filled()
                .into_iter()
                .map(|area| EmptyElement::at(mark.at) + Polygon::new(area, mark.colour.filled()));
            chart.draw_series(filled)?;
            let (lines, colour) = mark.lines();
            chart.draw_series(lines.into_iter().map(|line| {
                EmptyElement::at(mark.at) + PathElement::new(line, colour.stroke_width(MARK_LINE))
            }))?;
        }
        chart.draw_series(self.labels.iter().map(|(place, words, colour)| {
            let style = text_style().color(colour).pos(left_middle());
            Text::new(words.clone(), *place, style)
        }))?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn panel() -> Panel {
        Panel::new(
            Axis::tight("x", 0.0..10.0, 5),
            Axis::tight("y", 0.0..5.0, 5),
        )
    }

    #[test]
    fn lines_are_cut_off_at_the_edges_and_stay_whole_within() {
        let mut panel = panel();
        panel.line(
            BLACK,
            1,
            &[(-5.0, 1.0), (5.0, 1.0), (5.0, 9.0), (8.0, 9.0), (8.0, 2.0)],
        );
        let pieces = &panel.curves[0].pieces;
        assert_eq!(pieces[0], [(0.0, 1.0), (5.0, 1.0), (5.0, 5.0)]);
        assert_eq!(pieces[1], [(8.0, 5.0), (8.0, 2.0)]);
        panel.dot((11.0, 1.0), 1, BLACK);
        assert!(panel.dots.is_empty());
    }

    #[test]
    fn clipping_a_square_leaves_the_half_plane() {
        let square = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)];
        let area = |p: &[(f64, f64)]| {
            let pairs = p.iter().zip(p.iter().cycle().skip(1));
            0.5 * pairs.map(|(a, b)| a.0 * b.1 - b.0 * a.1).sum::<f64>()
        };
        assert!((area(&clipped(&square, (1.0, 0.0), 0.5)) - 1.0).abs() < 1e-12);
        assert!((area(&clipped(&square, (1.0, 1.0), 1.0)) - 0.5).abs() < 1e-12);
        assert!((area(&clipped(&square, (1.0, 0.0), 5.0)) - 4.0).abs() < 1e-12);
        assert!(clipped(&square, (1.0, 0.0), -1.0).is_empty());
        let mut panel = panel();
        panel.area(
            BLACK.to_rgba(),
            &[(8.0, 1.0), (12.0, 1.0), (12.0, 2.0), (8.0, 2.0)],
        );
        assert!((area(&panel.areas[0].0) - 2.0).abs() < 1e-12);
    }
}
