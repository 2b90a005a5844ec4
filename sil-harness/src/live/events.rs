//! The events of a live flight: the first one, and as many of the newest as fit.

use std::collections::VecDeque;
use std::sync::Arc;

/// A ring of events. The first event, which says what flies, is never dropped.
pub(super) struct Events {
    first: Option<Arc<str>>,
    /// The newest events after the first.
    newest: VecDeque<Arc<str>>,
    /// Number of events that were dropped.
    dropped: usize,
    /// Lengths of the newest events together, and the most that they may have \[bytes\].
    bytes: usize,
    most: usize,
}

impl Events {
    /// A ring without events, of at most this length \[bytes\] besides the first event.
    pub(super) fn new(most: usize) -> Self {
        Self {
            first: None,
            newest: VecDeque::new(),
            dropped: 0,
            bytes: 0,
            most,
        }
    }

    /// Adds an event, and drops the oldest ones if there are too many.
    pub(super) fn push(&mut self, event: Arc<str>) {
        if self.first.is_none() {
            self.first = Some(event);
            return;
        }
        self.bytes += event.len();
        self.newest.push_back(event);
        while self.bytes > self.most
            && let Some(oldest) = self.newest.pop_front()
        {
            self.bytes -= oldest.len();
            self.dropped += 1;
        }
    }

    /// The number of the event that comes next.
    pub(super) fn end(&self) -> usize {
        usize::from(self.first.is_some()) + self.dropped + self.newest.len()
    }

    /// The events from this number on that are still there.
    pub(super) fn since(&self, number: usize) -> Vec<Arc<str>> {
        let first = self.first.iter().filter(|_| number == 0);
        let skipped = number.saturating_sub(1 + self.dropped);
        first
            .chain(self.newest.iter().skip(skipped))
            .cloned()
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_oldest_events_go_and_the_first_one_stays() {
        let mut events = Events::new(6);
        assert_eq!((events.end(), events.since(0).len()), (0, 0));
        for event in ["begin", "aa", "bb", "cc", "dd"] {
            events.push(event.into());
        }
        let since = |number| events.since(number).join(" ");
        assert_eq!(events.end(), 5);
        assert_eq!(since(0), "begin bb cc dd");
        // A viewer who has seen "aa" misses nothing; one who has seen only the first event misses "aa".
        assert_eq!(since(2), "bb cc dd");
        assert_eq!(since(1), "bb cc dd");
        assert_eq!(since(4), "dd");
        assert_eq!(since(5), "");
        events.push("longer than all".into());
        assert_eq!((events.end(), events.since(1).len()), (6, 0));
    }
}
