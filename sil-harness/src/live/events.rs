//! The events of a live flight: numbered, and as many of the newest as fit.

use std::collections::VecDeque;
use std::sync::Arc;

/// The kinds of events whose last one says how things are. It stays when it becomes too old for the ring.
const STATES: [&str; 3] = ["begin", "pace", "closest"];

struct Event {
    kind: &'static str,
    /// What viewers get.
    text: Arc<str>,
}

/// A ring of events, which a viewer can leave and enter again where it was.
pub(super) struct Events {
    /// What all numbers begin with on the wire, so that those of another flight mean nothing here.
    flight: String,
    newest: VecDeque<Event>,
    /// Number of events that were dropped.
    dropped: usize,
    /// The last dropped event of each kind in [`STATES`], `begin` first.
    states: Vec<Event>,
    /// Lengths of the newest events together, and the most that they may have \[bytes\].
    bytes: usize,
    most: usize,
}

impl Events {
    /// A ring without events, of at most this length \[bytes\] besides the states. The name of the flight has no line
    /// breaks.
    pub(super) fn new(flight: &str, most: usize) -> Self {
        Self {
            flight: flight.to_owned(),
            newest: VecDeque::new(),
            dropped: 0,
            states: Vec::new(),
            bytes: 0,
            most,
        }
    }

    /// Adds an event, and drops the oldest ones if there are too many. The data are one line.
    pub(super) fn push(&mut self, kind: &'static str, data: &str) {
        let (flight, number) = (&self.flight, self.end());
        let text = format!("id: {flight}-{number}\nevent: {kind}\ndata: {data}\n\n");
        self.bytes += text.len();
        self.newest.push_back(Event {
            kind,
            text: text.into(),
        });
        while self.bytes > self.most
            && let Some(oldest) = self.newest.pop_front()
        {
            self.bytes -= oldest.text.len();
            self.dropped += 1;
            self.keep_state(oldest);
        }
    }

    fn keep_state(&mut self, event: Event) {
        if !STATES.contains(&event.kind) {
            return;
        }
        match (self.states.iter_mut()).find(|state| state.kind == event.kind) {
            Some(state) => *state = event,
            None => self.states.push(event),
        }
    }

    /// The number of the event that comes next.
    pub(super) fn end(&self) -> usize {
        self.dropped + self.newest.len()
    }

    /// The number of the event after the one that a viewer names; 0 if it names none of this flight.
    pub(super) fn after(&self, name: Option<&str>) -> usize {
        let number = || {
            let number = name?.strip_prefix(&self.flight)?.strip_prefix('-')?;
            number.parse::<usize>().ok()?.checked_add(1)
        };
        number().filter(|next| *next <= self.end()).unwrap_or(0)
    }

    /// The events from this number on. If some of them are gone: the states, and all events that are there.
    pub(super) fn since(&self, number: usize) -> Vec<Arc<str>> {
        let states = self.states.iter().filter(|_| number < self.dropped);
        let news = (self.newest.iter()).skip(number.saturating_sub(self.dropped));
        (states.chain(news).map(|event| &event.text))
            .cloned()
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The data of the events from a number on.
    fn since(events: &Events, number: usize) -> String {
        let texts = events.since(number);
        let data = |text: &Arc<str>| {
            let (_, data) = text.split_once("data: ").unwrap();
            data.trim_end().to_owned()
        };
        texts.iter().map(data).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn the_oldest_events_go_and_the_states_stay() {
        let length = "id: f-0\nevent: ticks\ndata: t0\n\n".len();
        let mut events = Events::new("f", 3 * length);
        assert_eq!((events.end(), since(&events, 0).as_str()), (0, ""));
        for (kind, data) in [("begin", "b0"), ("pace", "p1"), ("ticks", "t2")] {
            events.push(kind, data);
        }
        assert_eq!(since(&events, 0), "b0 p1 t2");
        for (kind, data) in [("pace", "p3"), ("ticks", "t4"), ("ticks", "t5")] {
            events.push(kind, data);
        }
        assert_eq!(
            (events.end(), since(&events, 0).as_str()),
            (6, "b0 p1 p3 t4 t5")
        );
        // Who missed nothing goes on; who missed an event that is gone begins again.
        assert_eq!(since(&events, 3), "p3 t4 t5");
        assert_eq!(since(&events, 5), "t5");
        assert_eq!(since(&events, 6), "");
        assert_eq!(since(&events, 2), "b0 p1 p3 t4 t5");
        for data in ["t6", "t7", "t8"] {
            events.push("ticks", data);
        }
        assert_eq!(since(&events, 2), "b0 p3 t6 t7 t8");
        events.push("ticks", &"longer than all".repeat(length));
        assert_eq!((events.end(), since(&events, 1).as_str()), (10, "b0 p3"));
    }

    #[test]
    fn a_viewer_goes_on_after_the_event_that_it_names() {
        let mut events = Events::new("f", 1000);
        events.push("begin", "b0");
        events.push("ticks", "t1");
        assert!(events.since(1)[0].starts_with("id: f-1\nevent: ticks\n"));
        let after = |name| events.after(Some(name));
        assert_eq!((after("f-0"), after("f-1"), events.after(None)), (1, 2, 0));
        for other in [
            "",
            "0",
            "g-1",
            "f-",
            "f-x",
            "f-2",
            "f--1",
            "f-18446744073709551615",
        ] {
            assert_eq!(after(other), 0, "{other}");
        }
    }
}
