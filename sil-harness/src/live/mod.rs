//! The live view of a flight: one page, and a stream of server-sent events.
//!
//! The flight waits for nobody. It puts events into a ring, and every viewer reads them from there,
//! from the oldest that is kept, or from where it lost the connection. Viewers send back only pause and
//! speed. These change when a tick is flown, never what is flown. Every viewer is told of them. Only
//! the server's own page may send them.

mod door;
mod events;
mod request;
mod server;
mod shared;

use crate::pace::Speed;
use door::Door;
use events::Events;
use mpp_analysis::closest::{Approach, Closest, closest};
use mpp_node::parameters::Tuning;
use mpp_sim::entries::Columns;
use mpp_sim::inspector::{Inspector, PlanDetail};
use mpp_sim::log::{FlightLog, Header};
use mpp_sim::orders::{Order, OrderEntry};
use mpp_sim::tick_record::TickRecord;
use serde::Serialize;
pub use shared::Wish;
use shared::{Shared, State};
use std::io;
use std::net::{SocketAddr, TcpListener};
use std::sync::{Arc, Condvar, Mutex};
use std::time::Duration;

/// Number of ticks that are sent together.
const BATCH: usize = 5;
/// The events that are kept \[bytes\]: more than half an hour with a plan each second.
const KEPT: usize = 64 << 20;
/// The longest time that the end of a flight waits for its viewers. It does not wait for a viewer
/// that reads no more.
const FAREWELL: Duration = Duration::from_secs(10);

/// The server of one flight.
pub struct Live {
    shared: Arc<Shared>,
    address: SocketAddr,
    batch: Columns,
    approach: Approach,
    /// The closest approach that the pages know.
    closest: Option<Closest>,
    inspector: Option<Inspector>,
}

impl Live {
    /// Listens at `HOST:PORT`; port 0 takes a free one. The flight begins at this speed.
    ///
    /// # Errors
    /// An error when nothing can listen there.
    pub fn open(given: &str, header: &Header, speed: Speed) -> io::Result<Self> {
        let listener = TcpListener::bind(given)?;
        let address = listener.local_addr()?;
        let door = Door::new(given);
        let wish = Wish {
            pause: false,
            speed,
        };
        let shared = Arc::new(Shared {
            state: Mutex::new(State {
                // A page compares this name with its own token: it may be that of an earlier flight.
                events: Events::new(&door.token, KEPT),
                wish,
                places: 0,
                behind: 0,
                ended: false,
            }),
            changed: Condvar::new(),
            door,
        });
        let for_viewers = Arc::clone(&shared);
        std::thread::spawn(move || server::serve(&listener, &for_viewers));
        let live = Self {
            shared,
            address,
            batch: Columns::default(),
            approach: Approach::new(header),
            closest: None,
            inspector: None,
        };
        live.tell("begin", header);
        live.shared.tell("pace", &wish.text());
        Ok(live)
    }

    /// The address on which the server listens.
    #[must_use]
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// The pause and the speed that the pages ask for at the moment.
    #[must_use]
    pub fn wish(&self) -> Wish {
        self.shared.lock().wish
    }

    /// Takes one tick that was flown with these values in force.
    pub fn watch(&mut self, record: &TickRecord<'_>, tuning: &Tuning) {
        self.batch.push(record.tick);
        self.approach
            .reach((record.tick.state.x, record.tick.state.z));
        if self.batch.t.len() >= BATCH {
            self.flush();
        }
        if let Some(plan) = record.plan {
            self.tell("plan", plan);
        }
        // The inspector does not exist before the first tick: until then any parameter may change.
        if self.inspector.is_none() {
            self.inspector = Inspector::new(tuning).ok();
        }
        let inspector = self.inspector.as_mut();
        let detail: Option<PlanDetail> = inspector.and_then(|i| i.look(record, tuning));
        if let Some(detail) = detail {
            self.tell("detail", &detail);
        }
    }

    /// Takes an order that holds from the next tick on.
    pub fn ordered(&mut self, order: &Order) {
        if let Order::Obstacles { field } = order {
            self.approach.add(field);
        }
        let tick = u64::from(self.approach.ticks());
        let order = order.clone();
        self.tell("order", &OrderEntry { tick, order });
    }

    /// Ends the stream after the flight. Waits a moment for the viewers.
    pub fn end(mut self, log: &FlightLog) {
        self.flush();
        self.tell("closest", &closest(log));
        self.tell("end", &log.summary);
        let mut state = self.shared.lock();
        state.ended = true;
        self.shared.changed.notify_all();
        let _ = self
            .shared
            .changed
            .wait_timeout_while(state, FAREWELL, |state| state.behind > 0);
    }

    fn flush(&mut self) {
        let batch = std::mem::take(&mut self.batch);
        self.tell("ticks", &batch);
        let nearest = self.approach.nearest();
        if nearest != self.closest.as_ref() {
            self.closest = nearest.cloned();
            self.tell("closest", &self.closest);
        }
    }

    fn tell(&self, kind: &'static str, data: &impl Serialize) {
        // The logged values hold no numbers that JSON cannot write.
        if let Ok(data) = serde_json::to_string(data) {
            self.shared.tell(kind, &data);
        }
    }
}
