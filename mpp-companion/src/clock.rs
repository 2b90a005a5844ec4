//! The autopilot's time by the companion's clock, from TIMESYNC.

use std::collections::VecDeque;

/// Samples that are looked at. At 1 Hz it is 10 s.
const SAMPLES: usize = 10;
/// A longer round trip tells nothing \[us\].
const LONGEST: u64 = 200_000;

/// The offset between two clocks, by the round trips that were quickest.
#[derive(Debug, Default)]
pub(crate) struct Clock {
    /// Round trip and autopilot's time less ours \[us\].
    samples: VecDeque<(u64, i64)>,
}

impl Clock {
    /// Takes an answer of the autopilot that came at `now`: `sent` is our time of the question, `theirs` its time \[us\].
    pub(crate) fn hear(&mut self, now: u64, sent: i64, theirs: i64) {
        let round = u64::try_from(sent)
            .ok()
            .and_then(|sent| now.checked_sub(sent));
        let Some(round) = round.filter(|round| *round <= LONGEST) else {
            return;
        };
        let middle = now.saturating_sub(round / 2);
        let offset = theirs.saturating_sub(i64::try_from(middle).unwrap_or(i64::MAX));
        self.samples.push_back((round, offset));
        if self.samples.len() > SAMPLES {
            self.samples.pop_front();
        }
    }

    /// How long ago the autopilot's clock showed this time \[s\]; `None` before the clocks are in step.
    pub(crate) fn age(&self, now: u64, boot_ms: u32) -> Option<f64> {
        let (_, offset) = self.samples.iter().min_by_key(|(round, _)| *round)?;
        let theirs = i64::try_from(now).ok()?.checked_add(*offset)?;
        Some(theirs.checked_sub(i64::from(boot_ms) * 1000)? as f64 * 1e-6)
    }

    /// Whether the clocks are in step.
    pub(crate) fn is_in_step(&self) -> bool {
        self.samples.len() >= 3
    }
}

/// How much the clocks of two machines drift apart, at most \[parts in 10,000\].
const DRIFT: u64 = 1;
/// A time that is so much before the last one is that of a sender that restarted \[us\].
const RESTART: u64 = 1_000_000;

/// The clock of a sender that answers no questions: its quickest message so far is taken to have come at once.
#[derive(Debug, Default)]
pub(crate) struct SenderClock {
    /// Our time less the sender's \[us\].
    offset: Option<i64>,
    /// Our time and the sender's of the last message.
    last: (u64, u64),
}

impl SenderClock {
    /// When a message was sent, by our clock. The sender took it for `theirs` \[us\].
    pub(crate) fn sent(&mut self, now: u64, theirs: u64) -> u64 {
        let offset = now.cast_signed().wrapping_sub(theirs.cast_signed());
        let (before, last) = self.last;
        let known = self
            .offset
            .filter(|_| theirs.saturating_add(RESTART) >= last);
        let drift = (now.saturating_sub(before) * DRIFT / 10_000).cast_signed();
        let quickest = known.map_or(offset, |known| offset.min(known.saturating_add(drift)));
        (self.offset, self.last) = (Some(quickest), (now, theirs));
        now.saturating_sub(offset.abs_diff(quickest))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_quickest_round_trip_counts() {
        let mut clock = Clock::default();
        // The autopilot is 5 s ahead. Way there and way back are 1 ms, and once 1 ms and 41 ms.
        clock.hear(2_000, 0, 5_001_000);
        clock.hear(142_000, 100_000, 5_101_000);
        clock.hear(10_000_000, 0, 9);
        clock.hear(202_000, 200_000, 5_201_000);
        clock.hear(302_000, 300_000, 5_301_000);
        assert!(clock.is_in_step());
        let age = clock.age(1_020_000, 6_000).unwrap();
        assert!((age - 0.02).abs() < 1e-9, "{age}");
    }

    #[test]
    fn a_late_message_is_dated_back_and_a_restart_begins_anew() {
        let mut clock = SenderClock::default();
        for (now, theirs, sent) in [
            (1_000_000, 77_000, 1_000_000),
            (1_400_000, 177_000, 1_100_040),
            // Quicker than ever.
            (1_490_000, 577_000, 1_490_000),
            (9_000_000, 5_000_000, 5_913_751),
            (9_100_000, 3_000, 9_100_000),
        ] {
            assert_eq!(clock.sent(now, theirs), sent);
        }
        clock.sent(9_200_000, u64::MAX);
        assert_eq!(clock.sent(9_300_000, 203_000), 9_300_000);
    }
}
