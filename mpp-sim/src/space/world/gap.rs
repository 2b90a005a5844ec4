//! Whether a wing fits through a world anywhere.

use super::{Body, Vector, World};

/// Distances of the tried places: ahead, to the side, in height \[m\].
const AHEAD: f64 = 1.0;
const ASIDE: f64 = 0.25;
const UPWARDS: f64 = 1.0;
/// Banks at which the wing is tried \[rad\]: level, and that of the steepest plans to both sides.
const BANKS: [f64; 3] = [0.0, 1.047, -1.047];

impl World {
    /// The least way ahead \[m\] at which a wing with this half of its span \[m\] and a body of this radius \[m\] fit nowhere within
    /// the extent; `None` if they fit somewhere at each tried one. Where a world can be crossed is another question.
    #[must_use]
    pub fn narrows(&self, half_span: f64, radius: f64) -> Option<f64> {
        let length = self.extent.length;
        let mut ways: Vec<f64> = (0..=(length / AHEAD) as u32)
            .map(|step| f64::from(step) * AHEAD)
            .collect();
        ways.extend(self.bodies().iter().map(|body| match *body {
            Body::Cylinder { x, .. } => x,
            Body::Capsule { from, to, .. } => 0.5 * (from[0] + to[0]),
            Body::Sphere { centre, .. } => centre[0],
            Body::Box { least, most } => 0.5 * (least[0] + most[0]),
        }));
        ways.retain(|x| (0.0..=length).contains(x));
        ways.sort_by(f64::total_cmp);
        ways.into_iter().find(|x| !self.fits(*x, half_span, radius))
    }

    fn fits(&self, x: f64, half_span: f64, radius: f64) -> bool {
        let half_width = self.extent.half_width;
        let steps = (half_width / ASIDE) as i32;
        // From the middle to both sides: most worlds have room near by.
        let aside = (0..=steps).flat_map(|step| [step, -step]);
        let levels = (self.extent.ceiling / UPWARDS) as u32;
        let mut places = aside.flat_map(|step| {
            (1..levels).map(move |level| [x, f64::from(step) * ASIDE, f64::from(level) * UPWARDS])
        });
        places.any(|place| {
            BANKS.iter().any(|bank| {
                let (left, right) = wing(place, half_span, *bank);
                left[1].abs().max(right[1].abs()) <= half_width
                    && self.clearance_of_segment(left, right, 2.0 * radius + 1.0) > radius
            })
        })
    }
}

/// The tips of a wing across the way.
fn wing([x, y, z]: Vector, half_span: f64, bank: f64) -> (Vector, Vector) {
    let (sin, cos) = libm::sincos(bank);
    let (side, up) = (half_span * cos, half_span * sin);
    ([x, y - side, z + up], [x, y + side, z - up])
}
