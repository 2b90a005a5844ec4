//! The heights that obstacles leave free at a place downrange.

use mpp_sim::field::{Obstacle, Shape};

/// An interval of heights \[m\], from the first number to the second.
pub(super) type Interval = (f64, f64);

/// Least step between looked-up heights \[m\]. A part of an obstacle that is thinner counts as free.
const STEP: f64 = 0.02;

/// Free heights of the band at `x`: the band without what is surely nearer to an obstacle than `margin` \[m\]. The
/// intervals are in order and do not overlap. What is left may be too much by [`STEP`], and never too little.
pub(super) fn free(obstacles: &[Obstacle], x: f64, band: Interval, margin: f64) -> Vec<Interval> {
    let mut closed: Vec<Interval> = Vec::new();
    for obstacle in obstacles {
        match obstacle.shape {
            Shape::Circle { centre, radius } => {
                let (radius, off) = (radius + margin, x - centre.0);
                if off.abs() < radius {
                    let half = (radius * radius - off * off).sqrt();
                    closed.push((centre.1 - half, centre.1 + half));
                }
            }
            _ => march(obstacle, x, band, margin, &mut closed),
        }
    }
    closed.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut open = Vec::new();
    let mut low = band.0;
    for (from, to) in closed {
        if from > low {
            open.push((low, from.min(band.1)));
        }
        low = low.max(to);
        if low >= band.1 {
            return open;
        }
    }
    open.push((low, band.1));
    open
}

/// Adds the closed heights of an obstacle of any shape. A distance changes by no more than the height does, so that a
/// point at a depth of d closes d to either side, and a point at a distance of d opens as much.
fn march(obstacle: &Obstacle, x: f64, band: Interval, margin: f64, closed: &mut Vec<Interval>) {
    let mut z = band.0;
    while z <= band.1 {
        let clearance = obstacle.clearance((x, z), 0.0) - margin;
        if clearance < 0.0 {
            closed.push((z + clearance, z - clearance));
        }
        z += clearance.abs().max(STEP);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const BAND: Interval = (39.0, 61.0);

    #[test]
    fn a_circle_closes_its_chord_and_a_margin() {
        let circle = [Obstacle::circle(10.0, 50.0, 1.0)];
        assert_eq!(free(&circle, 8.0, BAND, 0.5), [BAND]);
        assert_eq!(free(&circle, 10.0, BAND, 0.5), [(39.0, 48.5), (51.5, 61.0)]);
    }

    proptest! {
        /// No closed height is farther from every obstacle than the margin, and open heights are at most a step
        /// too many.
        #[test]
        fn closed_heights_are_closed(x in 0.0_f64..20.0, z in 39.0_f64..61.0, margin in 0.0_f64..0.6, thick in 0.05_f64..1.5) {
            let line = Obstacle::at_rest(Shape::Line { points: vec![(4.0, 44.0), (12.0, 56.0)], radius: thick });
            let wedge = Obstacle::at_rest(Shape::Polygon { corners: vec![(9.0, 40.0), (16.0, 41.0), (12.0, 49.0)] });
            let field = [line, wedge, Obstacle::circle(8.0, 55.0, thick)];
            let open = free(&field, x, BAND, margin);
            let clearance = field.iter().map(|one| one.clearance((x, z), 0.0)).fold(f64::INFINITY, f64::min);
            let is_open = open.iter().any(|(low, high)| (*low..=*high).contains(&z));
            prop_assert!(is_open || clearance <= margin);
            prop_assert!(!is_open || clearance >= margin - 2.0 * STEP, "{clearance} at {x} {z}");
            prop_assert!(open.windows(2).all(|pair| pair[0].1 <= pair[1].0));
        }
    }
}
