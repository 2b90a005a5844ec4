//! The pace of a flight: relative to real time, or as fast as possible.

use crate::live::Live;
use crate::pace::Speed;
use mpp_sim::scenario::TICKS_PER_SECOND;
use std::time::{Duration, Instant};

/// Simulated seconds of silence after which a station is lost, at the pace of real time.
const PATIENCE: u32 = 5;

/// Ticks of silence after which a station is lost. It is `None` at maximum speed, where a station's
/// second has no fixed number of ticks.
pub(super) fn patience(speed: Speed) -> Option<u32> {
    match speed {
        Speed::Max => None,
        Speed::Times(times) => {
            Some((f64::from(PATIENCE * TICKS_PER_SECOND) * times.max(1.0)) as u32)
        }
    }
}

/// Keeps a flight at its pace.
pub(super) struct Pacer {
    speed: Speed,
    begin: Instant,
    ticks: u32,
}

impl Pacer {
    pub(super) fn new(speed: Speed) -> Self {
        Self {
            speed,
            begin: Instant::now(),
            ticks: 0,
        }
    }

    /// Does what the pages of a live flight ask for. Waits while they pause, unless the flight is
    /// interrupted, and takes their speed. Returns this speed if it is new.
    pub(super) fn obey(&mut self, live: &Live, interrupted: impl Fn() -> bool) -> Option<Speed> {
        let mut wish = live.wish();
        let paused = wish.pause;
        while wish.pause && !interrupted() {
            std::thread::sleep(Duration::from_millis(20));
            wish = live.wish();
        }
        let other = wish.speed != self.speed;
        if paused || other {
            *self = Self::new(wish.speed);
        }
        other.then_some(wish.speed)
    }

    /// Waits for the end of a tick. A tick before the flight takes real time even at maximum speed.
    pub(super) fn wait(&mut self, at_start: bool) {
        let times = match self.speed {
            Speed::Max if !at_start => return,
            Speed::Max => 1.0,
            Speed::Times(times) => times,
        };
        self.ticks += 1;
        let due = f64::from(self.ticks) / f64::from(TICKS_PER_SECOND) / times;
        std::thread::sleep(Duration::from_secs_f64(due).saturating_sub(self.begin.elapsed()));
    }
}
