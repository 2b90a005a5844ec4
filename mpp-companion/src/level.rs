//! Level flight by pitch and thrust: of the stand-in's autopilots, and of the companion while PX4 waits for the core.

use mpp_core::vehicle::GRAVITY;

/// Trim of an aircraft in level flight.
pub(crate) struct Level {
    /// Pitch \[rad\].
    pub(crate) pitch: f64,
    /// Thrust \[N\].
    pub(crate) thrust: f64,
    /// Mass \[kg\].
    pub(crate) mass: f64,
    /// Airspeed [m/s].
    pub(crate) cruise: f64,
}

impl Level {
    /// Pitch \[rad\] and thrust \[N\] of an aircraft so far below its height \[m\], at an airspeed and on a path angle.
    pub(crate) fn hold(&self, below: f64, airspeed: f64, path: f64) -> (f64, f64) {
        let climb = (0.5 * below / self.cruise).clamp(-0.25, 0.25);
        let pitch = self.pitch + climb + 0.5 * (climb - path);
        let thrust =
            self.thrust + GRAVITY * self.mass * climb + 1.5 * self.mass * (self.cruise - airspeed);
        (pitch, thrust)
    }
}
