//! A flight as it happens: one page, and a stream of server-sent events.
//!
//! The flight waits for nobody: it leaves events in a list, and whoever looks takes them from
//! there, from the first one on. What comes back is pause and speed, which change when a tick is
//! flown, never what is flown.

use super::detail::{Inspector, PlanDetail};
use super::page;
use crate::log::{Columns, Header, Summary};
use crate::run::Moment;
use flight_node::parameters::Tuning;
use serde::Serialize;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Ticks that are told together.
const BATCH: usize = 5;
/// Longest head of a request that is read [bytes].
const HEAD: u64 = 8192;
/// How long a request may take to come.
const QUESTION: Duration = Duration::from_secs(30);
/// How long the end of a flight waits for those who look; one that takes nothing any more is left.
const FAREWELL: Duration = Duration::from_secs(10);

/// What a page asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wish {
    /// Fly no further for now.
    pub pause: bool,
    /// Speed against real time; none: as it was started. Infinite: as fast as it goes.
    pub speed: Option<f64>,
}

struct State {
    events: Vec<Arc<str>>,
    wish: Wish,
    /// Lookers that have not seen the last event.
    behind: usize,
    ended: bool,
}

struct Shared {
    state: Mutex<State>,
    changed: Condvar,
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        // A looker's thread that died leaves nothing half done.
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
    /// When nothing can listen there.
    pub fn open(address: &str, header: &Header) -> io::Result<Self> {
        let listener = TcpListener::bind(address)?;
        let address = listener.local_addr()?;
        let shared = Arc::new(Shared {
            state: Mutex::new(State {
                events: Vec::new(),
                wish: Wish {
                    pause: false,
                    speed: None,
                },
                behind: 0,
                ended: false,
            }),
            changed: Condvar::new(),
        });
        let for_lookers = Arc::clone(&shared);
        std::thread::spawn(move || {
            for stream in listener.incoming().flatten() {
                let shared = Arc::clone(&for_lookers);
                // Whoever goes away is no error.
                std::thread::spawn(move || serve(&stream, &shared));
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

    /// Where it listens.
    #[must_use]
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// What the pages ask for at the moment.
    #[must_use]
    pub fn wish(&self) -> Wish {
        self.shared.lock().wish
    }

    /// One tick was flown with these values in force.
    pub fn watch(&mut self, moment: &Moment<'_>, tuning: &Tuning) {
        self.batch.push(moment.tick);
        if self.batch.t.len() >= BATCH {
            self.flush();
        }
        if let Some(plan) = moment.plan {
            self.tell("plan", plan);
        }
        // Not before the first tick: until then any parameter may change.
        if self.inspector.is_none() {
            self.inspector = Inspector::new(tuning).ok();
        }
        let inspector = self.inspector.as_mut();
        let detail: Option<PlanDetail> = inspector.and_then(|i| i.look(moment, tuning));
        if let Some(detail) = detail {
            self.tell("detail", &detail);
        }
    }

    /// The flight is over; waits a moment for those who look.
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
        // Numbers that JSON does not know cannot occur in what was logged.
        if let Ok(data) = serde_json::to_string(data) {
            let text = format!("event: {event}\ndata: {data}\n\n");
            self.shared.lock().events.push(text.into());
            self.shared.changed.notify_all();
        }
    }
}

/// Answers one request.
fn serve(stream: &TcpStream, shared: &Shared) -> io::Result<()> {
    // Whoever asks for nothing shall not keep a thread.
    stream.set_read_timeout(Some(QUESTION))?;
    let mut reader = BufReader::new(stream.try_clone()?.take(HEAD));
    let mut request = String::new();
    reader.read_line(&mut request)?;
    // The rest of the head says nothing of interest.
    let mut line = String::new();
    while reader.read_line(&mut line)? > 2 {
        line.clear();
    }
    let mut words = request.split_whitespace();
    match (words.next(), words.next()) {
        (Some("GET"), Some("/")) => {
            respond(stream, "200 OK", "text/html; charset=utf-8", &page("null"))
        }
        (Some("GET"), Some("/events")) => stream_events(stream, shared),
        (Some("POST"), Some(path)) if path.starts_with("/control?") => {
            let before = shared.lock().wish;
            match wish(path, before) {
                Some(wish) => {
                    shared.lock().wish = wish;
                    respond(stream, "204 No Content", "text/plain", "")
                }
                None => respond(
                    stream,
                    "400 Bad Request",
                    "text/plain",
                    "pause=0|1, speed=NUMBER|max",
                ),
            }
        }
        _ => respond(stream, "404 Not Found", "text/plain", "the flight is at /"),
    }
}

fn respond(mut stream: &TcpStream, status: &str, kind: &str, body: &str) -> io::Result<()> {
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nConnection: close\r\n\r\n{body}",
        body.len()
    )
}

/// What a request for another pace asks for.
fn wish(path: &str, before: Wish) -> Option<Wish> {
    let (_, query) = path.split_once('?')?;
    let mut wish = before;
    for pair in query.split('&') {
        match pair.split_once('=')? {
            ("pause", "0") => wish.pause = false,
            ("pause", "1") => wish.pause = true,
            ("speed", "max") => wish.speed = Some(f64::INFINITY),
            ("speed", times) => {
                let times = times
                    .parse()
                    .ok()
                    .filter(|t: &f64| t.is_finite() && *t > 0.0)?;
                wish.speed = Some(times);
            }
            _ => return None,
        }
    }
    Some(wish)
}

/// Sends every event there is and will be.
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
        while state.events.len() == seen {
            if state.ended {
                return Ok(());
            }
            state = shared
                .changed
                .wait(state)
                .unwrap_or_else(PoisonError::into_inner);
        }
        let news = state.events[seen..].to_vec();
        // Not under the lock: a slow looker must not stop the flight.
        drop(state);
        seen += news.len();
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
            Some(4.0)
        );
        assert_eq!(
            read("speed=max").and_then(|wish| wish.speed),
            Some(f64::INFINITY)
        );
        for nonsense in [
            "",
            "speed=0",
            "speed=-1",
            "speed=inf",
            "speed=NaN",
            "pause=2",
            "x=1",
        ] {
            assert_eq!(read(nonsense), None, "{nonsense}");
        }
    }
}
