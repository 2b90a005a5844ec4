//! Stations that came unasked.

use std::net::SocketAddr;

/// Addresses that are remembered beside those that were given.
const GUESTS: usize = 16;
/// Silence after which a guest's place is free, in simulated time \[us\].
const SILENCE_US: u64 = 60_000_000;

/// Addresses, with the time of their last word.
#[derive(Default)]
pub(super) struct Guests(Vec<(SocketAddr, u64)>);

impl Guests {
    /// An address spoke.
    pub(super) fn hear(&mut self, from: SocketAddr, now_us: u64) {
        if let Some((_, last)) = self.0.iter_mut().find(|(guest, _)| *guest == from) {
            *last = now_us;
        } else if self.0.len() < GUESTS {
            self.0.push((from, now_us));
        }
    }

    /// Forgets who is silent.
    pub(super) fn expire(&mut self, now_us: u64) {
        self.0
            .retain(|(_, last)| now_us.saturating_sub(*last) <= SILENCE_US);
    }

    pub(super) fn addresses(&self) -> impl Iterator<Item = &SocketAddr> {
        self.0.iter().map(|(guest, _)| guest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_of_the_silent_are_given_to_others() {
        let guest = |port| SocketAddr::from(([127, 0, 0, 1], port));
        let mut guests = Guests::default();
        for port in 1..=20 {
            guests.hear(guest(port), 0);
        }
        assert_eq!(guests.addresses().count(), 16);
        guests.hear(guest(3), 30_000_000);
        guests.expire(60_000_000);
        assert_eq!(guests.addresses().count(), 16);
        guests.expire(60_000_001);
        assert_eq!(guests.addresses().collect::<Vec<_>>(), [&guest(3)]);
        guests.hear(guest(20), 60_000_001);
        assert_eq!(guests.addresses().count(), 2);
    }
}
