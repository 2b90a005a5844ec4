//! Place and attitude of an aircraft in its world.

use super::Quaternion;
use super::motion::SpaceState;
use super::world::Vector;

/// Place and attitude.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Place of the centre of mass: ahead, to the right, up \[m\].
    pub at: Vector,
    /// Turn of the body.
    pub attitude: Quaternion,
}

impl Pose {
    /// The pose of a state.
    #[must_use]
    pub fn of(state: &SpaceState) -> Self {
        Self {
            at: [state.plane.x, state.lateral.y, state.plane.z],
            attitude: state.attitude(),
        }
    }

    /// A direction in the body's axes (ahead, to the right, *down*) in those of the world (ahead, to the right, up).
    #[must_use]
    pub fn direction(&self, in_body: [f64; 3]) -> Vector {
        let [x, y, down] = self.attitude.in_world(in_body);
        [x, y, -down]
    }

    /// The place of a point that is fixed to the body.
    #[must_use]
    pub fn place(&self, in_body: [f64; 3]) -> Vector {
        let offset = self.direction(in_body);
        [0, 1, 2].map(|axis| self.at[axis] + offset[axis])
    }

    /// The pose at a share of the way to another one.
    #[must_use]
    pub fn towards(&self, other: &Self, share: f64) -> Self {
        Self {
            at: [0, 1, 2].map(|axis| self.at[axis] + share * (other.at[axis] - self.at[axis])),
            attitude: self.attitude.towards(other.attitude, share),
        }
    }

    /// Way to another pose \[m\], and the angle between their attitudes \[rad\].
    #[must_use]
    pub fn change(&self, other: &Self) -> (f64, f64) {
        let [x, y, z] = [0, 1, 2].map(|axis| other.at[axis] - self.at[axis]);
        let way = (x * x + y * y + z * z).sqrt();
        (way, self.attitude.angle_to(other.attitude))
    }
}
