//! Demands of stations, so many in a tick: a flood of them must not stop the flight.

use hil_protocol::mavlink::messages::{PARAM_SET_DATA, REQUEST_DATA_STREAM_DATA, SET_MODE_DATA};
use std::collections::VecDeque;
use std::net::SocketAddr;

/// Demands that are met in a tick.
pub(super) const DEMANDS_PER_TICK: usize = 16;
/// Demands that may wait for a later one.
pub(super) const WAITING: usize = 256;

/// A station or one of its parts, and where it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Address {
    pub(super) peer: SocketAddr,
    pub(super) system: u8,
    pub(super) component: u8,
}

/// A command from either of the two command messages.
pub(super) struct Command {
    pub(super) number: u16,
    pub(super) first: f32,
    pub(super) second: f32,
    /// Whether it names a latitude or a longitude.
    pub(super) has_place: bool,
    pub(super) altitude: f32,
    /// The MAV_FRAME of the altitude.
    pub(super) frame: u32,
    pub(super) from: Address,
}

/// A message to this vehicle that changes the flight or the link.
pub(super) enum Demand {
    Command(Command),
    Parameter(PARAM_SET_DATA),
    Mode(SET_MODE_DATA),
    Streams(REQUEST_DATA_STREAM_DATA, Address),
}

/// What is to be met, in its order.
pub(super) struct Demands<T> {
    waiting: VecDeque<T>,
    /// Met in this tick.
    met: usize,
    /// Lost because too many waited.
    lost: u32,
    /// Whether that was told since there was last room.
    told: bool,
}

impl<T> Demands<T> {
    pub(super) fn new() -> Self {
        Self {
            waiting: VecDeque::new(),
            met: 0,
            lost: 0,
            told: false,
        }
    }

    /// Gives the demand back if it may be met at once.
    pub(super) fn admit(&mut self, demand: T) -> Option<T> {
        if self.waiting.is_empty() && self.met < DEMANDS_PER_TICK {
            self.met += 1;
            return Some(demand);
        }
        if self.waiting.len() < WAITING {
            self.waiting.push_back(demand);
        } else {
            self.lost = self.lost.saturating_add(1);
        }
        None
    }

    /// In a new tick: the demands that waited for it.
    pub(super) fn due(&mut self) -> Vec<T> {
        self.met = DEMANDS_PER_TICK.min(self.waiting.len());
        self.waiting.drain(..self.met).collect()
    }

    /// How many were lost.
    pub(super) fn lost(&self) -> u32 {
        self.lost
    }

    /// Whether a flood is to be told of: once until there is room again.
    pub(super) fn is_news(&mut self) -> bool {
        let full = self.waiting.len() >= WAITING && self.lost > 0;
        let news = full && !self.told;
        self.told = full;
        news
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flood_is_met_bit_by_bit_and_in_order() {
        let mut demands = Demands::new();
        let at_once: Vec<usize> = (0..400).filter_map(|n| demands.admit(n)).collect();
        assert_eq!(at_once, (0..DEMANDS_PER_TICK).collect::<Vec<_>>());
        assert_eq!(demands.lost() as usize, 400 - DEMANDS_PER_TICK - WAITING);
        assert!(demands.is_news() && !demands.is_news());
        let mut met = at_once;
        while met.len() < DEMANDS_PER_TICK + WAITING {
            let due = demands.due();
            assert!((1..=DEMANDS_PER_TICK).contains(&due.len()));
            met.extend(due);
        }
        assert_eq!(met, (0..DEMANDS_PER_TICK + WAITING).collect::<Vec<_>>());
        assert!(!demands.is_news());
        // A tick without any is a new one.
        assert!(demands.due().is_empty());
        assert_eq!(demands.admit(7), Some(7));
    }
}
