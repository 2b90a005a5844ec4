//! The server of the live page: it answers requests, each on a thread of its own.

use super::request::{NoRequest, Request, head};
use super::shared::{Shared, Wish};
use crate::pace;
use mpp_analysis::picture::live_page;
use std::io::{self, Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::{Arc, PoisonError};
use std::time::{Duration, Instant};

/// Greatest number of connections at a time. Further ones are refused with 503.
const PLACES: usize = 32;
/// The longest time that a viewer may take to accept data.
const PATIENCE: Duration = Duration::from_secs(30);
/// Without events a viewer gets an empty comment after this time, so that a closed connection is
/// noticed.
const SIGN: Duration = Duration::from_secs(5);
/// How long a browser waits before it connects again \[ms\].
const RETRY: u32 = 1000;
/// Pause after an error of `accept`, for instance when file descriptors run out.
const REST: Duration = Duration::from_millis(200);

/// Serves everybody who connects, for as long as the process lives.
pub(super) fn serve(listener: &TcpListener, shared: &Arc<Shared>) {
    for accepted in listener.incoming() {
        if let Some(stream) = rested(accepted, std::thread::sleep) {
            welcome(stream, shared);
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
    let Some(place) = ViewerPlace::take(shared) else {
        let again = "too many pages look at this flight: close one";
        let _ = respond(&stream, "503 Service Unavailable", "text/plain", again);
        return;
    };
    // Without a thread the place is free again. A viewer that goes away is no error.
    let _ = std::thread::Builder::new().spawn(move || {
        let _ = answer(&stream, &place.0);
        // The place is free before the client sees the end of the connection.
        drop(place);
        drop(stream);
    });
}

/// One of the [`PLACES`], until it is dropped.
struct ViewerPlace(Arc<Shared>);

impl ViewerPlace {
    fn take(shared: &Arc<Shared>) -> Option<Self> {
        let mut state = shared.lock();
        (state.places < PLACES).then(|| {
            state.places += 1;
            Self(Arc::clone(shared))
        })
    }
}

impl Drop for ViewerPlace {
    fn drop(&mut self) {
        self.0.lock().places -= 1;
    }
}

/// Answers one request.
fn answer(mut stream: &TcpStream, shared: &Shared) -> io::Result<()> {
    let begin = Instant::now();
    let read = |buffer: &mut [u8], patience| {
        stream.set_read_timeout(Some(patience))?;
        stream.read(buffer)
    };
    let request = match head(read, || begin.elapsed()) {
        Ok(request) => request,
        Err(NoRequest::Gone(error)) => return Err(error),
        Err(NoRequest::Refused(status, why)) => return dismiss(stream, status, why),
    };
    if !shared.door.admits(&request, stream.local_addr()?) {
        let why = "this page is not the flight's own: open the address that the harness printed";
        return respond(stream, "403 Forbidden", "text/plain", why);
    }
    match (request.method.as_str(), request.path.as_str()) {
        ("GET", "/") => {
            let page = live_page(&shared.door.token);
            respond(stream, "200 OK", "text/html; charset=utf-8", &page)
        }
        ("GET", "/events") => stream_events(stream, shared, &request),
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

/// Takes over what a page asks for, if it makes sense, and tells all of them.
fn obey(stream: &TcpStream, shared: &Shared, path: &str) -> io::Result<()> {
    let mut state = shared.lock();
    let Some(wish) = wish(path, state.wish) else {
        drop(state);
        let advice = format!("give pause=0 or pause=1, or for speed: {}", pace::ADVICE);
        return respond(stream, "400 Bad Request", "text/plain", &advice);
    };
    state.wish = wish;
    state.events.push("pace", &wish.text());
    drop(state);
    shared.changed.notify_all();
    respond(stream, "204 No Content", "text/plain", "")
}

/// Refuses what has not come whole. Reads some of the rest: what is not read might take the answer with it.
fn dismiss(mut stream: &TcpStream, status: &str, why: &str) -> io::Result<()> {
    const MOST: usize = 64;
    const REST: Duration = Duration::from_millis(500);
    respond(stream, status, "text/plain", why)?;
    stream.shutdown(Shutdown::Write)?;
    stream.set_read_timeout(Some(REST))?;
    let mut buffer = [0; 4096];
    for _ in 0..MOST {
        if stream.read(&mut buffer)? == 0 {
            break;
        }
    }
    Ok(())
}

/// No other page may hold this one in a frame, where people would press its buttons unknowingly, and nothing may keep
/// its token.
fn respond(mut stream: &TcpStream, status: &str, kind: &str, body: &str) -> io::Result<()> {
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nCache-Control: no-store\r\n\
         Content-Security-Policy: frame-ancestors 'none'\r\nX-Frame-Options: DENY\r\nConnection: close\r\n\r\n{body}",
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
            ("speed", times) => wish.speed = pace::speed(times).ok()?,
            _ => return None,
        }
    }
    Some(wish)
}

/// Sends every event that there is and that will be, from the one on that the viewer lacks.
fn stream_events(mut stream: &TcpStream, shared: &Shared, request: &Request) -> io::Result<()> {
    write!(
        stream,
        "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\nCache-Control: no-store\r\nConnection: close\r\n\r\n\
         retry: {RETRY}\n\n"
    )?;
    let mut state = shared.lock();
    state.behind += 1;
    let seen = state.events.after(request.last_event.as_deref());
    drop(state);
    let result = follow(stream, shared, seen);
    shared.lock().behind -= 1;
    shared.changed.notify_all();
    result
}

fn follow(mut stream: &TcpStream, shared: &Shared, mut seen: usize) -> io::Result<()> {
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
    use crate::pace::Speed;

    const AS_STARTED: Wish = Wish {
        pause: false,
        speed: Speed::Times(1.0),
    };

    #[test]
    fn wishes_are_read_or_refused() {
        let read = |query: &str| wish(&format!("/control?{query}"), AS_STARTED);
        assert_eq!(read("pause=1").map(|wish| wish.pause), Some(true));
        assert_eq!(
            read("speed=4&pause=0").map(|wish| wish.speed),
            Some(Speed::Times(4.0))
        );
        assert_eq!(read("speed=max").map(|wish| wish.speed), Some(Speed::Max));
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
