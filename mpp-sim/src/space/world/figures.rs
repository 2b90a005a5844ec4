//! How dense a world is: mean free path and traversability.

use super::body::{Vector, plus};
use super::{Extent, World};

/// Distance between the lines flown, and between the starts on each \[m\].
const LINES: f64 = 1.0;
const STARTS: f64 = 5.0;
/// Distance at which something counts as touched, and least step of a march \[m\].
const TOUCH: f64 = 0.01;
/// Distance between the places of traversability \[m\], and their rays (AvoidBench).
const PLACES: f64 = 1.0;
const RAYS: u32 = 8;
/// Most that a ray of traversability counts \[m\]. Source: chosen, the length of AvoidBench's outdoor fields.
const MOST: f64 = 40.0;

impl World {
    /// Way from a segment along a direction of unit length until it touches a body or the ground \[m\], if that is at most
    /// `most`.
    #[must_use]
    pub fn sweep(&self, a: Vector, b: Vector, direction: Vector, most: f64) -> Option<f64> {
        let mut way = 0.0;
        while way <= most {
            let at = |point| plus(point, direction, way);
            let clearance = self.clearance_of_segment(at(a), at(b), most - way + 1.0);
            if clearance <= TOUCH {
                return Some(way);
            }
            way += clearance.max(TOUCH);
        }
        None
    }

    /// Mean free path of a level wing that flies straight ahead at a height \[m\]: ways flown over hits, from starts all over the
    /// extent to its end. `None` without a hit.
    #[must_use]
    pub fn mean_free_path(&self, half_span: f64, height: f64) -> Option<f64> {
        let Extent {
            length, half_width, ..
        } = *self.extent();
        let (mut flown, mut hits) = (0.0, 0_u32);
        for y in steps(-half_width, half_width, LINES) {
            for x in steps(0.0, length, STARTS) {
                let wing = [[x, y - half_span, height], [x, y + half_span, height]];
                if self.clearance_of_segment(wing[0], wing[1], 1.0) <= TOUCH {
                    continue;
                }
                let way = self.sweep(wing[0], wing[1], [1.0, 0.0, 0.0], length - x);
                flown += way.unwrap_or(length - x);
                hits += u32::from(way.is_some());
            }
        }
        (hits > 0).then(|| flown / f64::from(hits))
    }

    /// AvoidBench's traversability \[m\]: the mean way that level rays in 8 directions are free, of at most 40 m, from places on
    /// a grid of 1 m. `None` if every place is in a body.
    #[must_use]
    pub fn traversability(&self, height: f64) -> Option<f64> {
        let Extent {
            length, half_width, ..
        } = *self.extent();
        let directions = (0..RAYS).map(|ray| {
            let turn = core::f64::consts::TAU * f64::from(ray) / f64::from(RAYS);
            let (sin, cos) = libm::sincos(turn);
            [cos, sin, 0.0]
        });
        let directions: Vec<Vector> = directions.collect();
        let (mut free, mut rays) = (0.0, 0_u32);
        for x in steps(0.0, length, PLACES) {
            for y in steps(-half_width, half_width, PLACES) {
                let from = [x, y, height];
                if self.clearance(from, 1.0) <= 0.0 {
                    continue;
                }
                for direction in &directions {
                    free += self.ray(from, *direction, MOST).unwrap_or(MOST);
                    rays += 1;
                }
            }
        }
        (rays > 0).then(|| free / f64::from(rays))
    }
}

/// `from`, `from + step`, ... below `to`.
fn steps(from: f64, to: f64, step: f64) -> impl Iterator<Item = f64> {
    let count = ((to - from) / step) as usize;
    (0..count).map(move |number| from + step * number as f64)
}
