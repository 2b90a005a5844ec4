//! The motion of the last 1.2 s, for measurements and scans that come late.

use crate::config::TICK_PERIOD;
use crate::vehicle::{AirState, Wind};

/// Number of ticks that the history holds, the present one included; a power of two.
const TICKS: usize = 128;

/// Greatest age of a measurement that the estimators use \[ticks\]: 0.3 s.
pub const MOST_AGE: u32 = 30;

/// Greatest age of a scan of which the pose is known \[ticks\]: a replan at 1 Hz and 0.2 s more.
pub const MOST_SCAN_AGE: u32 = 120;

const _: () = assert!(MOST_AGE <= MOST_SCAN_AGE && (MOST_SCAN_AGE as usize) + 1 < TICKS);

/// The aircraft's way through the air at one tick, and its pitch.
#[derive(Clone, Copy, Debug)]
struct Entry {
    /// Way through the air since the start, `(x, z)` \[m\].
    way: (f64, f64),
    /// Pitch \[rad\].
    pitch: f64,
}

/// The aircraft's way through the air and its pitch at each tick of the last 1.2 s.
#[derive(Clone, Debug)]
pub struct History {
    entries: [Entry; TICKS],
    /// Number of entries so far.
    count: u32,
    /// Velocity through the air at the last tick, `(x, z)` [m/s].
    velocity: Option<(f64, f64)>,
}

impl History {
    /// A history without an entry.
    #[inline(always)]
    #[must_use]
    pub const fn new() -> Self {
        Self {
            entries: [Entry {
                way: (0.0, 0.0),
                pitch: 0.0,
            }; TICKS],
            count: 0,
            velocity: None,
        }
    }

    /// Adds the motion `air` at the end of a further `period` \[s\]. Gives the way through the air in this
    /// period, `(x, z)` \[m\], by the mean of the velocities at its ends.
    pub fn push(&mut self, air: &AirState, period: f64) -> (f64, f64) {
        let now = Wind::STILL.ground_velocity(air);
        let before = self.velocity.replace(now).unwrap_or(now);
        let step = (
            0.5 * period * (before.0 + now.0),
            0.5 * period * (before.1 + now.1),
        );
        let last = self.entry(0).map_or((0.0, 0.0), |last| last.way);
        let slot = self.count as usize % TICKS;
        if let Some(entry) = self.entries.get_mut(slot) {
            *entry = Entry {
                way: (last.0 + step.0, last.1 + step.1),
                pitch: air.pitch,
            };
        }
        self.count = self.count.saturating_add(1);
        step
    }

    /// Corrects the motion of the last entry, after the sensors of its tick were used. Gives the velocity through the
    /// air, `(x, z)` [m/s].
    pub fn correct(&mut self, air: &AirState) -> (f64, f64) {
        let velocity = Wind::STILL.ground_velocity(air);
        self.velocity = Some(velocity);
        let slot = self.count.wrapping_sub(1) as usize % TICKS;
        if self.count > 0
            && let Some(entry) = self.entries.get_mut(slot)
        {
            entry.pitch = air.pitch;
        }
        velocity
    }

    /// Turns the pitch of all entries by a known error \[rad\].
    pub fn turn(&mut self, by: f64) {
        for entry in &mut self.entries {
            entry.pitch += by;
        }
    }

    /// Way through the air since the tick that was `age` ticks ago, `(x, z)` \[m\]. `None` if the history
    /// does not reach that far.
    #[must_use]
    pub fn way_since(&self, age: u32) -> Option<(f64, f64)> {
        let (now, then) = (self.entry(0)?, self.entry(age)?);
        Some((now.way.0 - then.way.0, now.way.1 - then.way.1))
    }

    /// Velocity through the air at the tick that was `age` ticks ago, `(x, z)` [m/s].
    #[must_use]
    pub fn velocity_at(&self, age: u32) -> Option<(f64, f64)> {
        if age == 0 {
            return self.velocity;
        }
        let (before, after) = (self.entry(age.saturating_add(1))?, self.entry(age - 1)?);
        let period = 2.0 * TICK_PERIOD;
        Some((
            (after.way.0 - before.way.0) / period,
            (after.way.1 - before.way.1) / period,
        ))
    }

    /// Pitch at the tick that was `age` ticks ago \[rad\].
    #[must_use]
    pub fn pitch_at(&self, age: u32) -> Option<f64> {
        self.entry(age).map(|entry| entry.pitch)
    }

    fn entry(&self, age: u32) -> Option<&Entry> {
        if age >= self.count || age as usize >= TICKS {
            return None;
        }
        let slot = (self.count - 1 - age) as usize % TICKS;
        self.entries.get(slot)
    }
}
