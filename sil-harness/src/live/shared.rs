//! What a live flight and the threads of its viewers share.

use super::door::Door;
use super::events::Events;
use crate::pace::Speed;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// The pause and the speed that the pages ask for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wish {
    /// Whether the flight pauses.
    pub pause: bool,
    /// Speed relative to real time.
    pub speed: Speed,
}

impl Wish {
    /// What pages are told of it.
    pub(super) fn text(&self) -> String {
        format!(r#"{{"pause":{},"speed":"{}"}}"#, self.pause, self.speed)
    }
}

/// The events, and what the pages ask for.
pub(super) struct State {
    pub(super) events: Events,
    pub(super) wish: Wish,
    /// Connections.
    pub(super) places: usize,
    /// Number of viewers that have not seen the last event.
    pub(super) behind: usize,
    pub(super) ended: bool,
}

/// What the flight and the threads of its viewers share.
pub(super) struct Shared {
    pub(super) state: Mutex<State>,
    pub(super) changed: Condvar,
    pub(super) door: Door,
}

impl Shared {
    pub(super) fn lock(&self) -> MutexGuard<'_, State> {
        // A viewer's thread that died leaves no half-done change.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds an event and wakes the viewers.
    pub(super) fn tell(&self, kind: &'static str, data: &str) {
        self.lock().events.push(kind, data);
        self.changed.notify_all();
    }
}
