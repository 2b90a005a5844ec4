//! Motion of the air, and what it makes of motion through it.

use super::AirState;

/// Velocity of the air over ground.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wind {
    /// Downrange [m/s].
    pub x: f64,
    /// Up [m/s].
    pub z: f64,
}

impl Wind {
    /// None.
    pub const STILL: Self = Self { x: 0.0, z: 0.0 };

    /// Velocity over ground of an aircraft that moves like this through the air, `(x, z)` [m/s].
    #[must_use]
    pub fn ground_velocity(&self, air: &AirState) -> (f64, f64) {
        let (sin, cos) = libm::sincos(air.flight_path);
        (air.airspeed * cos + self.x, air.airspeed * sin + self.z)
    }
}
