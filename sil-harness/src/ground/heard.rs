//! The newest signed time of every sender, kept from flight to flight: what was recorded in one is
//! obeyed in no other.

use std::collections::BTreeMap;

/// A minute in units of 10 us.
pub(super) const MINUTE: u64 = 6_000_000;

/// System, component and link of a sender.
pub(super) type Sender = (u8, u8, u8);

/// Newest times [10 us since 2015-01-01], by sender.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Heard(BTreeMap<Sender, u64>);

impl Heard {
    /// Reads lines of `SYSTEM COMPONENT LINK TIME`.
    ///
    /// # Errors
    /// A sentence about the line that is none.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut heard = Self::default();
        for (index, line) in text.lines().enumerate() {
            let read = || {
                let mut words = line.split(' ');
                let mut byte = || words.next()?.parse().ok();
                let sender = (byte()?, byte()?, byte()?);
                let time = words.next()?.parse().ok()?;
                words.next().is_none().then_some((sender, time))
            };
            let (sender, time) = read().ok_or_else(|| {
                format!(
                    "line {} is no signed time: delete the file if it is not needed",
                    index + 1
                )
            })?;
            heard.note(sender, time);
        }
        Ok(heard)
    }

    /// The text of the file.
    #[must_use]
    pub fn format(&self) -> String {
        let line = |(&(system, component, link), time): (&Sender, &u64)| {
            format!("{system} {component} {link} {time}\n")
        };
        self.0.iter().map(line).collect()
    }

    /// Takes over what is newer.
    pub fn merge(&mut self, other: &Self) {
        for (sender, time) in &other.0 {
            self.note(*sender, *time);
        }
    }

    /// Forgets what nobody would believe any more at this time.
    pub fn forget(&mut self, now: u64) {
        self.0.retain(|_, time| time.saturating_add(MINUTE) >= now);
    }

    pub(super) fn is_news(&self, sender: Sender, time: u64) -> bool {
        self.0.get(&sender).is_none_or(|last| time > *last)
    }

    pub(super) fn note(&mut self, sender: Sender, time: u64) {
        let last = self.0.entry(sender).or_default();
        *last = time.max(*last);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_go_through_a_file_and_only_forward() {
        let mut heard = Heard::default();
        heard.note((255, 190, 1), 70);
        heard.note((255, 190, 1), 60);
        heard.note((1, 2, 3), u64::MAX);
        assert_eq!(
            heard.format(),
            format!("1 2 3 {}\n255 190 1 70\n", u64::MAX)
        );
        assert_eq!(Heard::parse(&heard.format()), Ok(heard.clone()));
        let older = Heard::parse("255 190 1 50\n9 9 9 9\n").unwrap();
        heard.merge(&older);
        assert!(!heard.is_news((255, 190, 1), 70) && heard.is_news((255, 190, 1), 71));
        assert!(!heard.is_news((9, 9, 9), 9) && heard.is_news((9, 9, 8), 9));
        heard.forget(MINUTE + 70);
        assert_eq!(heard.format().lines().count(), 2);
        for nonsense in ["x", "1 2 3", "1 2 300 4", "1 2 3 4 5", "1 2 3 -4", "\n"] {
            assert!(Heard::parse(nonsense).is_err(), "{nonsense:?}");
        }
    }
}
