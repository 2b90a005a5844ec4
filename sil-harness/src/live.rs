//! The live view of a flight: one page, and a stream of server-sent events.
//!
//! The flight waits for nobody. It puts events into a ring, and every viewer reads them from there,
//! from the oldest that is kept. Viewers send back only pause and speed. These change when a tick is
//! flown, never what is flown. Only the server's own page may send them.

mod door;
mod events;
mod request;

use crate::pace::{self, Speed};
use door::Door;
use events::Events;
use mpp_analysis::picture::live_page;
use mpp_node::parameters::Tuning;
use mpp_sim::entries::Columns;
use mpp_sim::inspector::{Inspector, PlanDetail};
use mpp_sim::log::{Header, Summary};
use mpp_sim::moment::Moment;
use request::head;
use serde::Serialize;
use std::io::{self, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Number of ticks that are sent together.
const BATCH: usize = 5;
/// The events that are kept \[bytes\]: more than half an hour with a plan each second.
const KEPT: usize = 64 << 20;
/// Greatest number of connections at a time. Further ones are refused with 503.
const PLACES: usize = 32;
/// The longest time that a viewer may take to accept data.
const PATIENCE: Duration = Duration::from_secs(30);
/// Without events a viewer gets an empty comment after this time, so that a closed connection is
/// noticed.
const SIGN: Duration = Duration::from_secs(5);
/// Pause after an error of `accept`, for instance when file descriptors run out.
const REST: Duration = Duration::from_millis(200);
/// The longest time that the end of a flight waits for its viewers. It does not wait for a viewer
/// that reads no more.
const FAREWELL: Duration = Duration::from_secs(10);

/// The pause and the speed that the pages ask for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wish {
    /// Whether the flight pauses.
    pub pause: bool,
    /// Speed relative to real time. `None` means the speed at the start.
    pub speed: Option<Speed>,
}

struct State {
    events: Events,
    wish: Wish,
    /// Connections.
    places: usize,
    /// Number of viewers that have not seen the last event.
    behind: usize,
    ended: bool,
}

struct Shared {
    state: Mutex<State>,
    changed: Condvar,
    door: Door,
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        // A viewer's thread that died leaves no half-done change.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The server of one flight.
pub struct Live {
    shared: Arc<Shared>,
    address: SocketAddr,
    batch: Columns,
    inspector: Option<Inspector>,
}

impl Live {
    /// Listens at `HOST:PORT`; port 0 takes a free one.
    ///
    /// # Errors
    /// An error when nothing can listen there.
    pub fn open(given: &str, header: &Header) -> io::Result<Self> {
        let listener = TcpListener::bind(given)?;
        let address = listener.local_addr()?;
        let shared = Arc::new(Shared {
            state: Mutex::new(State {
                events: Events::new(KEPT),
                wish: Wish {
                    pause: false,
                    speed: None,
                },
                places: 0,
                behind: 0,
                ended: false,
            }),
            changed: Condvar::new(),
            door: Door::new(given),
        });
        let for_lookers = Arc::clone(&shared);
        std::thread::spawn(move || {
            for accepted in listener.incoming() {
                if let Some(stream) = rested(accepted, std::thread::sleep) {
                    welcome(stream, &for_lookers);
                }
            }
        });
        let live = Self {
            shared,
            address,
            batch: Columns::default(),
            inspector: None,
        };
        live.tell("begin", header);
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
    pub fn watch(&mut self, moment: &Moment<'_>, tuning: &Tuning) {
        self.batch.push(moment.tick);
        if self.batch.t.len() >= BATCH {
            self.flush();
        }
        if let Some(plan) = moment.plan {
            self.tell("plan", plan);
        }
        // The inspector does not exist before the first tick: until then any parameter may change.
        if self.inspector.is_none() {
            self.inspector = Inspector::new(tuning).ok();
        }
        let inspector = self.inspector.as_mut();
        let detail: Option<PlanDetail> = inspector.and_then(|i| i.look(moment, tuning));
        if let Some(detail) = detail {
            self.tell("detail", &detail);
        }
    }

    /// Ends the stream after the flight. Waits a moment for the viewers.
    pub fn end(mut self, summary: &Summary) {
        self.flush();
        self.tell("end", summary);
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
    }

    fn tell(&self, event: &str, data: &impl Serialize) {
        // The logged values hold no numbers that JSON cannot write.
        if let Ok(data) = serde_json::to_string(data) {
            let text = format!("event: {event}\ndata: {data}\n\n");
            self.shared.lock().events.push(text.into());
            self.shared.changed.notify_all();
        }
    }
}

/// The accepted connection. Rests after an error.
fn rested<T>(accepted: io::Result<T>, rest: impl FnOnce(Duration)) -> Option<T> {
    if accepted.is_err() {
        rest(REST);
    }
    accepted.ok()
}

/// Serves a connection on a thread of its own, if there is a place.
fn welcome(stream: TcpStream, shared: &Arc<Shared>) {
    // A client that sends or reads nothing must not keep a thread.
    if stream.set_write_timeout(Some(PATIENCE)).is_err() {
        return;
    }
    let Some(place) = Place::take(shared) else {
        let again = "too many pages look at this flight: close one";
        let _ = respond(&stream, "503 Service Unavailable", "text/plain", again);
        return;
    };
    // Without a thread the place is free again. A viewer that goes away is no error.
    let _ = std::thread::Builder::new().spawn(move || {
        let _ = serve(&stream, &place.0);
        // The place is free before the client sees the end of the connection.
        drop(place);
        drop(stream);
    });
}

/// One of the [`PLACES`], until it is dropped.
struct Place(Arc<Shared>);

impl Place {
    fn take(shared: &Arc<Shared>) -> Option<Self> {
        let mut state = shared.lock();
        (state.places < PLACES).then(|| {
            state.places += 1;
            Self(Arc::clone(shared))
        })
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        self.0.lock().places -= 1;
    }
}

/// Answers one request.
fn serve(mut stream: &TcpStream, shared: &Shared) -> io::Result<()> {
    let begin = Instant::now();
    let read = |buffer: &mut [u8], patience| {
        stream.set_read_timeout(Some(patience))?;
        stream.read(buffer)
    };
    let request = head(read, || begin.elapsed())?;
    if !shared.door.admits(&request, stream.local_addr()?) {
        let why = "this page is not the flight's own: open the address that the harness printed";
        return respond(stream, "403 Forbidden", "text/plain", why);
    }
    match (request.method.as_str(), request.path.as_str()) {
        ("GET", "/") => {
            let page = live_page(&shared.door.token);
            respond(stream, "200 OK", "text/html; charset=utf-8", &page)
        }
        ("GET", "/events") => stream_events(stream, shared),
        ("POST", path) if path.starts_with("/control?") => {
            if !shared.door.trusts(&request) {
                let why = "no token of this flight's page: load the page again";
                return respond(stream, "403 Forbidden", "text/plain", why);
            }
            obey(stream, shared, path)
        }
        _ => respond(stream, "404 Not Found", "text/plain", "the flight is at /"),
    }
}

/// Takes over what a page asks for, if it makes sense.
fn obey(stream: &TcpStream, shared: &Shared, path: &str) -> io::Result<()> {
    let before = shared.lock().wish;
    let Some(wish) = wish(path, before) else {
        let advice = format!("give pause=0 or pause=1, or for speed: {}", pace::ADVICE);
        return respond(stream, "400 Bad Request", "text/plain", &advice);
    };
    shared.lock().wish = wish;
    respond(stream, "204 No Content", "text/plain", "")
}

fn respond(mut stream: &TcpStream, status: &str, kind: &str, body: &str) -> io::Result<()> {
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nConnection: close\r\n\r\n{body}",
        body.len()
    )
}

/// The wish after a request for another pace; `None` if the request is invalid.
fn wish(path: &str, before: Wish) -> Option<Wish> {
    let (_, query) = path.split_once('?')?;
    let mut wish = before;
    for pair in query.split('&') {
        match pair.split_once('=')? {
            ("pause", "0") => wish.pause = false,
            ("pause", "1") => wish.pause = true,
            ("speed", times) => wish.speed = Some(pace::speed(times).ok()?),
            _ => return None,
        }
    }
    Some(wish)
}

/// Sends every event that there is and that will be.
fn stream_events(mut stream: &TcpStream, shared: &Shared) -> io::Result<()> {
    write!(
        stream,
        "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\nCache-Control: no-store\r\nConnection: close\r\n\r\n"
    )?;
    shared.lock().behind += 1;
    let result = follow(stream, shared);
    shared.lock().behind -= 1;
    shared.changed.notify_all();
    result
}

fn follow(mut stream: &TcpStream, shared: &Shared) -> io::Result<()> {
    let mut seen = 0;
    loop {
        let mut state = shared.lock();
        while state.events.end() == seen {
            if state.ended {
                return Ok(());
            }
            let (woken, waited) = shared
                .changed
                .wait_timeout(state, SIGN)
                .unwrap_or_else(PoisonError::into_inner);
            state = woken;
            if waited.timed_out() {
                drop(state);
                stream.write_all(b":\n\n")?;
                state = shared.lock();
            }
        }
        let news = state.events.since(seen);
        seen = state.events.end();
        // The events are sent without the lock: a slow viewer must not stop the flight.
        drop(state);
        for event in news {
            stream.write_all(event.as_bytes())?;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const AS_STARTED: Wish = Wish {
        pause: false,
        speed: None,
    };

    #[test]
    fn wishes_are_read_or_refused() {
        let read = |query: &str| wish(&format!("/control?{query}"), AS_STARTED);
        assert_eq!(read("pause=1").map(|wish| wish.pause), Some(true));
        assert_eq!(
            read("speed=4&pause=0").and_then(|wish| wish.speed),
            Some(Speed::Times(4.0))
        );
        assert_eq!(
            read("speed=max").and_then(|wish| wish.speed),
            Some(Speed::Max)
        );
        for nonsense in [
            "",
            "speed=0",
            "speed=-1",
            "speed=inf",
            "speed=1e-300",
            "speed=1e-4",
            "speed=1001",
            "speed=NaN",
            "pause=2",
            "x=1",
        ] {
            assert_eq!(read(nonsense), None, "{nonsense}");
        }
    }

    #[test]
    fn who_cannot_be_let_in_is_not_asked_for_at_once() {
        let mut rests = Vec::new();
        assert_eq!(rested(Ok(1), |rest| rests.push(rest)), Some(1));
        assert!(rests.is_empty());
        let none: io::Result<u8> = Err(io::ErrorKind::Other.into());
        assert_eq!(rested(none, |rest| rests.push(rest)), None);
        assert_eq!(rests, [REST]);
    }
}
