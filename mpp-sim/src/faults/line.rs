//! Faults of the line to the core: ticks whose messages are lost, and a clock that is wrong.

use super::window::{TICKS_PER_SECOND, Timed, Window, fault_table};
use crate::random::{self, Draws, Stream};
use serde::{Deserialize, Serialize};

fault_table! {
    /// The faults of the link; each may be absent.
    pub struct LinkFault {
        /// Whether every message is lost.
        pub silent: bool,
        /// Share of the ticks whose measurements are lost, and share of the commands that are lost [-].
        pub loss: Option<f64>,
    }
}

impl LinkFault {
    fn wrong_key(&self) -> Option<&'static str> {
        let sound = (0.0..=1.0).contains(&self.loss.unwrap_or(0.0));
        (!sound).then_some("give a `loss` from 0 to 1")
    }
}

/// The messages of a tick that come through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Passage {
    /// Whether the measurements come to the core.
    pub to_core: bool,
    /// Whether the command comes to the aircraft.
    pub to_aircraft: bool,
}

/// The line of one flight.
#[derive(Clone, Debug)]
pub struct Line {
    fault: LinkFault,
    generator: Draws,
}

impl Line {
    /// The line of the flight with this seed.
    #[must_use]
    pub fn new(seed: u64, fault: LinkFault) -> Self {
        Self {
            fault,
            generator: random::generator(seed, Stream::LinkFault),
        }
    }

    /// The messages of a tick that come through.
    pub fn passage(&mut self, tick: u32) -> Passage {
        let active = self.fault.window().holds(tick);
        let silent = active && self.fault.silent;
        let loss = self.fault.loss.filter(|_| active);
        let mut comes = || {
            let lost = loss.is_some_and(|loss| random::uniform(&mut self.generator) < loss);
            !silent && !lost
        };
        Passage {
            to_core: comes(),
            to_aircraft: comes(),
        }
    }
}

/// The faults of the tick counter that the core sees.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ClockFault {
    /// Number of the first tick; by default 0. After 4294967295 comes 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub start: Option<u32>,
    /// Time at which the counter jumps \[s\]; by default the start of the flight.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from: Option<f64>,
    /// Time at which the counter jumps back \[s\]; by default it does not jump back.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub until: Option<f64>,
    /// Time by which the counter jumps \[s\]; negative if it goes back.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub jump: Option<f64>,
}

impl Timed for ClockFault {
    fn window(&self) -> Window {
        Window {
            from: self.from,
            until: self.until,
            toggle_hz: None,
        }
    }

    fn timeless(&self) -> Self {
        // The number of the first tick has no times.
        Self {
            jump: self.jump,
            ..Self::default()
        }
    }

    fn wrong_key(&self) -> Option<&'static str> {
        let sound = self.jump.unwrap_or(0.0).abs() <= 1e6;
        (!sound).then_some("give a `jump` of -1000000 to 1000000 s")
    }
}

impl ClockFault {
    /// The number that the core sees for a tick of the flight.
    #[must_use]
    pub fn shown(&self, tick: u32) -> u32 {
        let jump = self.jump.filter(|_| self.window().holds(tick));
        let ahead = (jump.unwrap_or(0.0) * f64::from(TICKS_PER_SECOND)).round() as i32;
        let start = self.start.unwrap_or(0);
        tick.wrapping_add(start).wrapping_add_signed(ahead)
    }

    /// The last tick of the flight, up to this one, for which the core sees this number.
    #[must_use]
    pub fn flown(&self, shown: u32, now: u32) -> Option<u32> {
        (0..=now).rev().find(|tick| self.shown(*tick) == shown)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn passages(fault: LinkFault, ticks: u32) -> Vec<Passage> {
        let mut line = Line::new(5, fault);
        (0..ticks).map(|tick| line.passage(tick)).collect()
    }

    #[test]
    fn a_silent_link_loses_both_ways_within_its_time_only() {
        let fault = LinkFault {
            from: Some(0.05),
            until: Some(0.1),
            silent: true,
            ..LinkFault::default()
        };
        for (tick, passage) in passages(fault, 20).into_iter().enumerate() {
            let comes = !(5..10).contains(&tick);
            assert_eq!((passage.to_core, passage.to_aircraft), (comes, comes));
        }
    }

    #[test]
    fn a_lossy_link_loses_its_share_each_way_by_itself() {
        const COUNT: u32 = 20_000;
        let fault = LinkFault {
            loss: Some(0.2),
            ..LinkFault::default()
        };
        let passages = passages(fault, COUNT);
        let share = |lost: fn(&Passage) -> bool| {
            passages.iter().filter(|passage| lost(passage)).count() as f64 / f64::from(COUNT)
        };
        assert!((share(|passage| !passage.to_core) - 0.2).abs() < 0.012);
        assert!((share(|passage| !passage.to_aircraft) - 0.2).abs() < 0.012);
        let both = share(|passage| !passage.to_core && !passage.to_aircraft);
        assert!((both - 0.04).abs() < 0.006, "{both}");
    }

    #[test]
    fn a_clock_jumps_goes_back_and_wraps() {
        assert_eq!(ClockFault::default().shown(7), 7);
        let fault = ClockFault {
            from: Some(1.0),
            until: Some(2.0),
            jump: Some(-0.5),
            ..ClockFault::default()
        };
        assert_eq!(
            [99, 100, 199, 200].map(|tick| fault.shown(tick)),
            [99, 50, 149, 200]
        );
        assert_eq!(fault.flown(60, 105), Some(60));
        assert_eq!(fault.flown(60, 110), Some(110));
        assert_eq!(fault.flown(99, 100), Some(99));
        assert_eq!(fault.flown(7000, 100), None);
        let fault = ClockFault {
            start: Some(u32::MAX - 1),
            ..ClockFault::default()
        };
        assert_eq!(
            [0, 1, 2].map(|tick| fault.shown(tick)),
            [u32::MAX - 1, u32::MAX, 0]
        );
        assert_eq!(fault.flown(0, 9), Some(2));
    }
}
