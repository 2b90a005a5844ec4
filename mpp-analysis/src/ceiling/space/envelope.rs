//! The flights about which the ceiling in space speaks: bounds of what they do, whatever forces do it.

use mpp_core::config::TICK_PERIOD;
use mpp_core::vehicle::GRAVITY;
use mpp_sim::space::{SpaceState, true_path};

/// Horizontal speeds as shares of the wanted airspeed [-]. Witnesses keep it within 2 %.
const SPEED: [f64; 2] = [0.9, 1.1];

/// Bounds of the motion. A flight that keeps all of them in each tick is a flight of the envelope.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpaceEnvelope {
    /// Horizontal speed, least and greatest [m/s].
    pub speed: [f64; 2],
    /// Greatest bank \[rad\].
    pub bank: f64,
    /// Greatest rate of the bank [rad/s].
    pub bank_rate: f64,
    /// How far the horizontal acceleration across the course may be from that of a level turn at this bank [m/s^2]: by climbs,
    /// by lift that follows the bank late, by sideslip.
    pub uneven: f64,
    /// Greatest course \[rad\].
    pub course: f64,
}

impl SpaceEnvelope {
    /// The envelope of flights at an airspeed [m/s]. Source: chosen, beyond all of 24 witnesses of the Ultra Stick and the X8.
    #[must_use]
    pub fn of(airspeed: f64) -> Self {
        Self {
            speed: SPEED.map(|share| share * airspeed),
            bank: 1.2,
            bank_rate: 4.0,
            uneven: 9.0,
            course: 1.2,
        }
    }

    /// Whether the motion of a tick from one state to another is in the envelope.
    #[must_use]
    pub fn holds(&self, before: &SpaceState, state: &SpaceState) -> bool {
        let (from, to) = (true_path(before), true_path(state));
        let rate = |from: f64, to: f64| (to - from) / TICK_PERIOD;
        let [x, y] = [0, 1].map(|axis| rate(from.position[axis], to.position[axis]));
        let speed = libm::hypot(x, y);
        let level = GRAVITY * libm::tan(0.5 * (from.bank + to.bank));
        let uneven = speed * rate(from.course, to.course) - level;
        (self.speed[0]..=self.speed[1]).contains(&speed)
            && to.bank.abs() <= self.bank
            && rate(from.bank, to.bank).abs() <= self.bank_rate
            && uneven.abs() <= self.uneven
            && to.course.abs() <= self.course
    }
}
