//! The pace of a flight: that of the clock, or as fast as it goes.

use crate::picture::live::Live;
use crate::scenario::TICKS_PER_SECOND;
use std::time::{Duration, Instant};

/// Simulated seconds of a station's silence after which it is lost, at the pace of real time.
const PATIENCE: u32 = 5;
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Speed {
    Max,
    Times(f64),
}

impl Speed {
    /// Ticks of a station's silence after which it is lost; none where its second is any number of
    /// ours.
    pub(super) fn patience(self) -> Option<u32> {
        match self {
            Self::Max => None,
            Self::Times(times) => {
                Some((f64::from(PATIENCE * TICKS_PER_SECOND) * times.max(1.0)) as u32)
            }
        }
    }
}

pub(super) fn speed(text: &str) -> Result<Speed, String> {
    match text.parse::<f64>() {
        _ if text == "max" => Ok(Speed::Max),
        Ok(times) if times.is_finite() && times > 0.0 => Ok(Speed::Times(times)),
        _ => Err("give a positive number, or max".to_owned()),
    }
}

/// Keeps a flight at its pace.
pub(super) struct Pacer {
    /// As the command line has it.
    started: Speed,
    speed: Speed,
    begin: Instant,
    ticks: u32,
}

impl Pacer {
    pub(super) fn new(speed: Speed) -> Self {
        Self {
            started: speed,
            speed,
            begin: Instant::now(),
            ticks: 0,
        }
    }

    /// Does what the pages of a live flight ask for: waits while they pause, and takes their speed,
    /// which it gives if it is another.
    pub(super) fn obey(&mut self, live: &Live) -> Option<Speed> {
        let mut wish = live.wish();
        let paused = wish.pause;
        while wish.pause {
            std::thread::sleep(Duration::from_millis(20));
            wish = live.wish();
        }
        let speed = match wish.speed {
            None => self.started,
            Some(times) if times.is_finite() => Speed::Times(times),
            Some(_) => Speed::Max,
        };
        let other = speed != self.speed;
        if paused || other {
            *self = Self {
                started: self.started,
                ..Self::new(speed)
            };
        }
        other.then_some(speed)
    }

    /// Waits for the end of a tick; one at the start takes its time even if the flight takes none.
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
