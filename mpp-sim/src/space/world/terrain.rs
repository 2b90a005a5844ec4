//! Terrain: a height map as ground.
//!
//! Each cell of its grid is two triangles along the diagonal from the first corner to the last one, so that rays and distances
//! are exact. Beyond its edges the ground is as high as there.

use super::body::{Vector, by_halving, dot, length, minus, nearest_of_segment, plus};
use super::error::{FARTHEST, WorldError};
use serde::{Deserialize, Serialize};

/// Most heights of a map. They take 8 MB.
const MOST_HEIGHTS: usize = 1_000_000;
/// Least and greatest distance of heights \[m\].
const CELLS: [f64; 2] = [0.1, 1000.0];

/// Heights of the ground on a regular grid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Terrain {
    /// Place of the first height: ahead, to the right \[m\].
    pub corner: [f64; 2],
    /// Distance of heights along both axes \[m\].
    pub cell: f64,
    /// Heights \[m\]: rows from left to right, and in each of them from behind to ahead.
    pub rows: Vec<Vec<f64>>,
}

type Triangle = [Vector; 3];

impl Terrain {
    /// Refuses heights that are no map of the ground at the start.
    pub(super) fn check(&self) -> Result<(), WorldError> {
        let refuse = |key, advice: String| Err(WorldError::Value { key, advice });
        let [least, most] = CELLS;
        if !(least..=most).contains(&self.cell) {
            return refuse("terrain cell", format!("give {least} to {most} m"));
        }
        let columns = self.rows.first().map_or(0, Vec::len);
        let even = self.rows.iter().all(|row| row.len() == columns);
        if self.rows.len() < 2 || columns < 2 || !even {
            let advice = "give two rows or more, all with the same number of heights, two or more";
            return refuse("terrain rows", advice.to_owned());
        }
        if columns.saturating_mul(self.rows.len()) > MOST_HEIGHTS {
            let advice =
                format!("give at most {MOST_HEIGHTS} heights: cut the map, or thin it out");
            return refuse("terrain rows", advice);
        }
        if !self.rows.iter().flatten().all(|it| it.abs() <= FARTHEST) {
            return refuse(
                "terrain rows",
                format!("give numbers of at most {FARTHEST} m"),
            );
        }
        let far = self.far();
        let around = [0, 1].map(|axis| self.corner[axis] <= 0.0 && far[axis] > 0.0);
        if around != [true; 2] || !far.iter().all(|it| *it <= FARTHEST) {
            let advice = "the start at x = y = 0 must lie in the map: subtract its place from that of the map";
            return refuse("terrain corner", advice.to_owned());
        }
        Ok(())
    }

    /// The same map, so much lower \[m\].
    pub(super) fn lowered(mut self, by: f64) -> Self {
        self.rows.iter_mut().flatten().for_each(|it| *it -= by);
        self
    }

    /// Place of the last height: ahead, to the right \[m\].
    pub(super) fn far(&self) -> [f64; 2] {
        let columns = self.rows.first().map_or(0, Vec::len);
        let [x, y] = [columns, self.rows.len()].map(|it| (it as f64 - 1.0) * self.cell);
        [self.corner[0] + x, self.corner[1] + y]
    }

    /// Least and greatest height \[m\].
    #[must_use]
    pub fn heights(&self) -> [f64; 2] {
        let all = || self.rows.iter().flatten().copied();
        [
            all().fold(f64::INFINITY, f64::min),
            all().fold(f64::NEG_INFINITY, f64::max),
        ]
    }

    /// Steepest slope along one of the axes [-].
    #[must_use]
    pub fn steepest(&self) -> f64 {
        let ahead = self.rows.iter().flat_map(|row| row.windows(2));
        let ahead = ahead.map(|pair| (pair[1] - pair[0]).abs());
        let aside = self.rows.windows(2).flat_map(|pair| {
            let pairs = pair[0].iter().zip(&pair[1]);
            pairs.map(|(one, other)| (one - other).abs())
        });
        ahead.chain(aside).fold(0.0, f64::max) / self.cell
    }

    /// The height at a place of the grid, or at the nearest one.
    fn at(&self, column: i64, row: i64) -> f64 {
        let within = |at: i64, count: usize| at.clamp(0, count as i64 - 1) as usize;
        let row = &self.rows[within(row, self.rows.len())];
        row[within(column, row.len())]
    }

    /// Height of the ground \[m\].
    pub(super) fn height(&self, x: f64, y: f64) -> f64 {
        let (rows, columns) = (self.rows.len(), self.rows[0].len());
        let place = |value: f64, first: f64, count: usize| {
            let at = ((value - first) / self.cell).clamp(0.0, count as f64 - 1.0);
            let low = (at as usize).min(count - 2);
            (low, at - low as f64)
        };
        let (column, ahead) = place(x, self.corner[0], columns);
        let (row, aside) = place(y, self.corner[1], rows);
        let ([near, far], [left, right]) = (
            [self.rows[row][column], self.rows[row + 1][column + 1]],
            [self.rows[row][column + 1], self.rows[row + 1][column]],
        );
        if ahead >= aside {
            near + ahead * (left - near) + aside * (far - left)
        } else {
            near + aside * (right - near) + ahead * (far - right)
        }
    }

    /// Way along a ray to the ground \[m\], if it is at most `most`. Over each triangle the height above ground is linear, so
    /// the ray is looked at where it crosses the lines between them: two families of edges, and the diagonals. `top` is the
    /// greatest height.
    pub(super) fn ray(&self, from: Vector, direction: Vector, most: f64, top: f64) -> Option<f64> {
        let above = |way: f64| {
            let [x, y, z] = plus(from, direction, way);
            z - self.height(x, y)
        };
        let [.., up] = direction;
        let room = from[2] - top;
        // Where the ray is below the top.
        let (start, end) = match room > 0.0 {
            true if up >= 0.0 => return None,
            true => (room / -up, most),
            false if up > 0.0 => (0.0, most.min(room / -up)),
            false => (0.0, most),
        };
        if start > end {
            return None;
        }
        let (mut way, mut height) = (start, above(start));
        if height <= 0.0 {
            return Some(way);
        }
        let [u, v] = [0, 1].map(|axis| {
            let first = from[axis] - self.corner[axis] + start * direction[axis];
            (first / self.cell, direction[axis] / self.cell)
        });
        let lines = [u, v, (u.0 - v.0, u.1 - v.1)];
        let steps = lines.map(|(_, pace)| pace.abs().recip());
        let mut next = lines.map(|(at, pace)| {
            let line = if pace > 0.0 {
                at.floor() + 1.0
            } else {
                at.ceil() - 1.0
            };
            if pace == 0.0 {
                f64::INFINITY
            } else {
                start + (line - at) / pace
            }
        });
        loop {
            let family = if next[0] < next[1] { 0 } else { 1 };
            let family = if next[2] < next[family] { 2 } else { family };
            let to = next[family].min(end);
            let reached = above(to);
            if reached <= 0.0 {
                return Some(way + (to - way) * height / (height - reached));
            }
            if to >= end {
                return None;
            }
            next[family] += steps[family];
            (way, height) = (to, reached);
        }
    }

    /// The triangles over which a box lies, those beyond the edges included.
    fn triangles(&self, least: [f64; 2], most: [f64; 2]) -> impl Iterator<Item = Triangle> + '_ {
        let range = |axis: usize| {
            let at = |value: f64| ((value - self.corner[axis]) / self.cell).floor() as i64;
            at(least[axis])..=at(most[axis])
        };
        let (columns, rows) = (range(0), range(1));
        let corner = |column: i64, row: i64| {
            let [x, y] = self.corner;
            let (ahead, aside) = (column as f64 * self.cell, row as f64 * self.cell);
            [x + ahead, y + aside, self.at(column, row)]
        };
        rows.flat_map(move |row| {
            columns.clone().flat_map(move |column| {
                let (near, far) = (corner(column, row), corner(column + 1, row + 1));
                let beside = [corner(column + 1, row), corner(column, row + 1)];
                beside.map(|other| [near, other, far])
            })
        })
    }

    /// Least distance of a segment from the ground \[m\], at most `most`; 0 where they meet. `top` is the greatest height.
    pub(super) fn clearance(&self, a: Vector, b: Vector, most: f64, top: f64) -> f64 {
        let over = |[x, y, z]: Vector| z - self.height(x, y);
        if a[2].min(b[2]) - top >= most {
            return most;
        }
        let mut least = over(a).min(over(b));
        let half = 0.5 * length(minus(b, a));
        let along = || minus(b, a).map(|it| it / (2.0 * half));
        if least <= 0.0 || (half > 0.0 && self.ray(a, along(), 2.0 * half, top).is_some()) {
            return 0.0;
        }
        least = least.min(most);
        let middle = plus(a, minus(b, a), 0.5);
        let low = [0, 1].map(|axis| a[axis].min(b[axis]) - least);
        let high = [0, 1].map(|axis| a[axis].max(b[axis]) + least);
        for triangle in self.triangles(low, high) {
            let peak = triangle
                .iter()
                .fold(f64::NEG_INFINITY, |it, at| it.max(at[2]));
            let separation = |point| separation(&triangle, point);
            if a[2].min(b[2]) - peak < least && length(separation(middle)) - half < least {
                least = least.min(by_halving(a, b, separation));
            }
        }
        least
    }
}

/// The way from the nearest point of a triangle to a point.
fn separation(triangle: &Triangle, point: Vector) -> Vector {
    let [a, b, c] = *triangle;
    let (one, other, to) = (minus(b, a), minus(c, a), minus(point, a));
    // The place of the foot of the perpendicular, along both edges.
    let (aa, ab, bb) = (dot(one, one), dot(one, other), dot(other, other));
    let (ap, bp) = (dot(to, one), dot(to, other));
    let whole = aa * bb - ab * ab;
    let (u, v) = ((bb * ap - ab * bp) / whole, (aa * bp - ab * ap) / whole);
    if u >= 0.0 && v >= 0.0 && u + v <= 1.0 {
        return plus(plus(to, one, -u), other, -v);
    }
    let edges =
        [(a, b), (b, c), (c, a)].map(|(a, b)| minus(point, nearest_of_segment(a, b, point)));
    let [first, rest @ ..] = edges;
    let nearer = |one: Vector, other: Vector| {
        if dot(other, other) < dot(one, one) {
            other
        } else {
            one
        }
    };
    rest.into_iter().fold(first, nearer)
}
