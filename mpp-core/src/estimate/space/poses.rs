//! The poses of the last 0.3 s, for fixes that come late and points of a lidar that bear their own time.

use super::inertial::Correction;
use crate::config::TICK_PERIOD;
use crate::estimate::history::MOST_AGE;
use crate::map::SpaceBeam;
use crate::vehicle::{Quaternion, between};

/// Number of ticks that the history holds, the present one included; a power of two.
const TICKS: usize = 32;

const _: () = assert!((MOST_AGE as usize) + 1 < TICKS);

/// How far ahead of the present a pose may be asked for \[s\]: the clock of a lidar may be fast.
const AHEAD: f64 = 0.02;

/// Place and attitude of the aircraft at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpacePose {
    /// Place: ahead, to the right, up \[m\].
    pub position: [f64; 3],
    /// Attitude.
    pub attitude: Quaternion,
}

impl SpacePose {
    /// A vector in the body's axes (ahead, to the right, *down*) in those of the world (ahead, to the right, up).
    #[must_use]
    pub fn turned(&self, in_body: [f64; 3]) -> [f64; 3] {
        let [x, y, down] = self.attitude.in_world(in_body);
        [x, y, -down]
    }

    /// A beam of a lidar at the body's origin, measured at this pose, as it would be from another place `origin` \[m\]: the map
    /// takes all beams of a sweep from one place.
    #[must_use]
    pub fn beam(&self, direction: [f64; 3], range: Option<f64>, origin: &[f64; 3]) -> SpaceBeam {
        let direction = self.turned(direction);
        let Some(range) = range else {
            return SpaceBeam {
                direction,
                range: None,
            };
        };
        let off: [f64; 3] = core::array::from_fn(|axis| {
            self.position[axis] + range * direction[axis] - origin[axis]
        });
        let length = libm::sqrt(off.iter().map(|it| it * it).sum());
        if length > 0.0 {
            SpaceBeam {
                direction: off.map(|it| it / length),
                range: Some(length),
            }
        } else {
            SpaceBeam {
                direction,
                range: None,
            }
        }
    }
}

/// Motion at one tick.
#[derive(Clone, Copy, Debug)]
struct Entry {
    position: [f64; 3],
    velocity: [f64; 3],
    attitude: Quaternion,
}

/// The motion at each tick of the last 0.3 s.
#[derive(Clone, Debug)]
pub(super) struct Poses {
    entries: [Entry; TICKS],
    /// Number of entries so far.
    count: u32,
    /// Rates of the body at the last one [rad/s].
    rates: [f64; 3],
}

impl Poses {
    pub(super) const fn new() -> Self {
        Self {
            entries: [Entry {
                position: [0.0; 3],
                velocity: [0.0; 3],
                attitude: Quaternion::ONE,
            }; TICKS],
            count: 0,
            rates: [0.0; 3],
        }
    }

    /// Forgets everything.
    pub(super) fn clear(&mut self) {
        self.count = 0;
    }

    pub(super) fn push(
        &mut self,
        position: [f64; 3],
        velocity: [f64; 3],
        attitude: Quaternion,
        rates: [f64; 3],
    ) {
        if let Some(entry) = self.entries.get_mut(self.count as usize % TICKS) {
            *entry = Entry {
                position,
                velocity,
                attitude,
            };
        }
        self.rates = rates;
        self.count = self.count.saturating_add(1);
    }

    /// Corrects all entries as the last one was: with a constant error of the acceleration the past has this error too.
    pub(super) fn correct(&mut self, corrections: &[Correction]) {
        for age in 0..TICKS as u32 {
            let since = f64::from(age) * TICK_PERIOD;
            let Some(entry) = self.entry_mut(age) else {
                return;
            };
            for by in corrections {
                for axis in 0..3 {
                    let (velocity, bias) = (by.velocity[axis], by.bias[axis]);
                    let moved = by.position[axis] - since * (velocity + 0.5 * since * bias);
                    entry.position[axis] += moved;
                    entry.velocity[axis] += by.velocity_then(axis, since);
                }
            }
        }
    }

    /// Replaces the attitudes since a late one that has become the present one by its rates [rad/s].
    pub(super) fn turn(&mut self, late: u32, now: Quaternion, rates: [f64; 3]) {
        for age in 0..=late.min(MOST_AGE) {
            let since = f64::from(age) * TICK_PERIOD;
            if let Some(entry) = self.entry_mut(age) {
                entry.attitude = now.times(Quaternion::about(rates.map(|it| -since * it)));
            }
        }
    }

    /// Position \[m\] and velocity [m/s] some ticks ago; `None` if the history does not reach that far.
    pub(super) fn then(&self, age: u32) -> Option<([f64; 3], [f64; 3])> {
        self.entry(age).map(|it| (it.position, it.velocity))
    }

    /// The pose `age` \[s\] ago; a time after the last tick is negative.
    pub(super) fn at(&self, age: f64) -> Option<SpacePose> {
        if !(age.is_finite() && age >= -AHEAD) {
            return None;
        }
        let ticks = between(age / TICK_PERIOD, [0.0, 2.0 * TICKS as f64]);
        let later = self.entry(ticks as u32)?;
        let share = ticks - libm::floor(ticks);
        if age <= 0.0 {
            let position =
                core::array::from_fn(|axis| later.position[axis] - age * later.velocity[axis]);
            let turned = Quaternion::about(self.rates.map(|it| -age * it));
            return Some(SpacePose {
                position,
                attitude: later.attitude.times(turned),
            });
        }
        let earlier = if share > 0.0 {
            self.entry(ticks as u32 + 1)?
        } else {
            later
        };
        Some(SpacePose {
            position: core::array::from_fn(|axis| {
                later.position[axis] + share * (earlier.position[axis] - later.position[axis])
            }),
            attitude: later.attitude.towards(earlier.attitude, share),
        })
    }

    fn slot(&self, age: u32) -> Option<usize> {
        let known = age < self.count && (age as usize) < TICKS;
        known.then(|| (self.count - 1 - age) as usize % TICKS)
    }

    fn entry(&self, age: u32) -> Option<&Entry> {
        self.entries.get(self.slot(age)?)
    }

    fn entry_mut(&mut self, age: u32) -> Option<&mut Entry> {
        let slot = self.slot(age)?;
        self.entries.get_mut(slot)
    }
}
