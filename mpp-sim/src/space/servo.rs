//! The servo of a lateral surface, and the roll loop in place of surfaces.

use super::SpaceState;
use crate::aircraft_file::{RollLoop, Surface};
use mpp_core::config::TICK_PERIOD;
use mpp_core::vehicle::{GRAVITY, LateralControl};
use std::collections::VecDeque;

/// Steps of a servo of second order within one call.
const SUBSTEPS: u32 = 10;

/// A surface and its servo, within range and rate.
#[derive(Clone, Copy, Debug)]
pub struct Servo {
    range: f64,
    most_rate: f64,
    bandwidth: f64,
    damping: Option<f64>,
    angle: f64,
    rate: f64,
}

impl Servo {
    /// A servo at rest in the middle.
    #[must_use]
    pub fn new(surface: &Surface) -> Self {
        Self {
            range: surface.range.to_radians(),
            most_rate: surface.rate.to_radians(),
            bandwidth: surface.bandwidth,
            damping: surface.damping,
            angle: 0.0,
            rate: 0.0,
        }
    }

    /// Follows a command \[rad\] for `dt` \[s\], and returns the deflection \[rad\].
    pub fn follow(&mut self, command: f64, dt: f64) -> f64 {
        let wanted = command.clamp(-self.range, self.range);
        match self.damping {
            None => {
                let share = 1.0 - libm::exp(-self.bandwidth * dt);
                let most = self.most_rate * dt;
                self.angle += (share * (wanted - self.angle)).clamp(-most, most);
            }
            Some(damping) => {
                let h = dt / f64::from(SUBSTEPS);
                for _ in 0..SUBSTEPS {
                    let push = self.bandwidth * self.bandwidth * (wanted - self.angle)
                        - 2.0 * damping * self.bandwidth * self.rate;
                    self.rate = (self.rate + h * push).clamp(-self.most_rate, self.most_rate);
                    let angle = self.angle + h * self.rate;
                    self.angle = angle.clamp(-self.range, self.range);
                    if angle.abs() > self.range {
                        self.rate = 0.0;
                    }
                }
            }
        }
        self.angle
    }
}

/// The roll loop of an autopilot: the bank that it holds, after a dead time.
#[derive(Clone, Debug)]
pub struct RollHold {
    of: RollLoop,
    /// Commands under way \[rad\], the oldest one first.
    commands: VecDeque<f64>,
}

impl RollHold {
    /// A loop that holds the wings level.
    #[must_use]
    pub fn new(of: RollLoop) -> Self {
        let ticks = libm::round(of.delay / TICK_PERIOD);
        let commands = core::iter::repeat_n(0.0, ticks as usize).collect();
        Self { of, commands }
    }

    /// The bank \[rad\] that it holds in the tick of a command.
    pub fn follow(&mut self, command: f64) -> f64 {
        self.commands.push_back(command);
        let held = self.commands.pop_front().unwrap_or_default();
        held.clamp(-self.of.max_bank, self.of.max_bank)
    }

    /// The deflections that bring a state to a bank \[rad\]: what is missing, and the yaw rate of a coordinated turn.
    #[must_use]
    pub fn deflections(&self, state: &SpaceState, held: f64) -> LateralControl {
        let most = self.of.most_missing();
        let air = &state.plane.air;
        let [_, slide, _] = state.lateral.attitude.world_in([0.0, 0.0, GRAVITY]);
        let (sin, cos) = libm::sincos(air.angle_of_attack());
        LateralControl {
            aileron: (held - state.bank()).clamp(-most, most),
            rudder: (slide / air.airspeed + state.lateral.roll_rate * sin) / cos,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SURFACE: Surface = Surface {
        range: 25.0,
        rate: 1e4,
        bandwidth: 30.0,
        damping: None,
    };

    fn after(surface: &Surface, command: f64, ticks: u32) -> f64 {
        let mut servo = Servo::new(surface);
        (0..ticks).fold(0.0, |_, _| servo.follow(command, 0.01))
    }

    #[test]
    fn both_orders_follow_as_their_equations_say() {
        let first = after(&SURFACE, 0.1, 5);
        assert!((first - 0.1 * (1.0 - libm::exp(-1.5))).abs() < 1e-12);
        let critical = Surface {
            damping: Some(1.0),
            ..SURFACE
        };
        let expected = 0.1 * (1.0 - libm::exp(-1.5) * 2.5);
        let second = after(&critical, 0.1, 5);
        assert!((second - expected).abs() < 2e-3, "{second} {expected}");
    }

    #[test]
    fn range_and_rate_bound_it_to_both_sides() {
        for damping in [None, Some(1.7)] {
            let slow = Surface {
                rate: 100.0,
                damping,
                ..SURFACE
            };
            let mut servo = Servo::new(&slow);
            let mut last = 0.0;
            for _ in 0..100 {
                let angle = servo.follow(9.0, 0.01);
                assert!(angle - last <= 1_f64.to_radians() + 1e-12);
                last = angle;
            }
            let range = 25_f64.to_radians();
            assert!((last - range).abs() < 1e-3, "{last}");
            assert_eq!(after(&slow, -9.0, 100).to_bits(), (-last).to_bits());
        }
    }
}
