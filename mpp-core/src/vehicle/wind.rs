//! Motion of the air, and its effect on the motion of the aircraft over ground.

use super::AirState;

/// Velocity of the air over ground.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wind {
    /// Downrange component [m/s].
    pub x: f64,
    /// Upward component [m/s].
    pub z: f64,
}

impl Wind {
    /// Still air.
    pub const STILL: Self = Self { x: 0.0, z: 0.0 };

    /// Velocity over ground `(x, z)` [m/s] of an aircraft with the motion `air` through the air.
    #[must_use]
    pub fn ground_velocity(&self, air: &AirState) -> (f64, f64) {
        let (sin, cos) = libm::sincos(air.flight_path);
        (air.airspeed * cos + self.x, air.airspeed * sin + self.z)
    }
}
