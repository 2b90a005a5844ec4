//! The servo of a lateral surface.

use crate::aircraft_file::Surface;

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
