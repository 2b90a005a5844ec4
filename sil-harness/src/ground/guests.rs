//! Stations that came unasked.

use mpp_sim::scenario::TICK_US;
use std::net::SocketAddr;

/// Addresses that are remembered beside those that were given.
const GUESTS: usize = 16;
/// Silence after which a guest is forgotten, in silences after which a station is lost: 60 s.
const SILENCES: u64 = 12;

/// Addresses, with the time of their last word.
pub(super) struct Guests {
    heard: Vec<(SocketAddr, u64)>,
    /// Silence after which a guest is forgotten, in simulated time \[us\]; `None` means never.
    silence: Option<u64>,
}

impl Guests {
    /// No guest yet. A station is lost after so many silent ticks, or never.
    pub(super) fn new(patience: Option<u32>) -> Self {
        let mut guests = Self {
            heard: Vec::new(),
            silence: None,
        };
        guests.set_patience(patience);
        guests
    }

    /// Sets another number of silent ticks after which a station is lost.
    pub(super) fn set_patience(&mut self, patience: Option<u32>) {
        self.silence = patience.map(|ticks| SILENCES * u64::from(TICK_US) * u64::from(ticks));
    }

    /// An address spoke. If no place is free, it takes that of the guest who was silent longest.
    pub(super) fn hear(&mut self, from: SocketAddr, now_us: u64) {
        if let Some((_, last)) = self.heard.iter_mut().find(|(guest, _)| *guest == from) {
            *last = now_us;
            return;
        }
        if self.heard.len() == GUESTS {
            let places = self.heard.iter().map(|(_, last)| *last).enumerate();
            let longest = places.min_by_key(|(_, last)| *last);
            self.heard.remove(longest.map_or(0, |(place, _)| place));
        }
        self.heard.push((from, now_us));
    }

    /// Forgets who is silent.
    pub(super) fn expire(&mut self, now_us: u64) {
        if let Some(silence) = self.silence {
            (self.heard).retain(|(_, last)| now_us.saturating_sub(*last) <= silence);
        }
    }

    pub(super) fn addresses(&self) -> impl Iterator<Item = &SocketAddr> {
        self.heard.iter().map(|(guest, _)| guest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn guest(port: u16) -> SocketAddr {
        SocketAddr::from(([127, 0, 0, 1], port))
    }

    #[test]
    fn a_new_guest_takes_the_place_of_the_most_silent_one() {
        let mut guests = Guests::new(Some(500));
        for port in 1..=16 {
            guests.hear(guest(port), u64::from(port));
        }
        guests.hear(guest(1), 20);
        guests.hear(guest(17), 21);
        assert_eq!(guests.addresses().count(), 16);
        let has = |port| guests.addresses().any(|address| *address == guest(port));
        assert!(has(1) && !has(2) && has(3) && has(17));
    }

    #[test]
    fn the_silent_are_forgotten_at_the_pace_of_the_flight() {
        for times in [1, 100] {
            let minute = 60_000_000 * u64::from(times);
            let mut guests = Guests::new(Some(500 * times));
            guests.hear(guest(3), 0);
            guests.expire(minute);
            assert_eq!(guests.addresses().count(), 1);
            guests.expire(minute + 1);
            assert_eq!(guests.addresses().count(), 0);
        }
        let mut guests = Guests::new(None);
        guests.hear(guest(3), 0);
        guests.expire(u64::MAX);
        assert_eq!(guests.addresses().count(), 1);
    }
}
