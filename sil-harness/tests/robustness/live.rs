//! The server of a live flight, among pages that are not its own.

use crate::common::{harness, talk};
use mpp_sim::log::Header;
use mpp_sim::scenario::{Preset, Scenario};
use sil_harness::live::{Live, Wish};
use sil_harness::pace::Speed;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;

const AS_STARTED: Wish = Wish {
    pause: false,
    speed: Speed::Times(1.0),
};

fn open() -> Live {
    let scenario = Scenario::new(Preset::Flight, 1);
    let header = Header::of(&scenario, &scenario.field());
    Live::open("127.0.0.1:0", &header, AS_STARTED.speed).unwrap()
}

/// Sends a request with these lines in its head.
fn ask(live: &Live, request: &str, lines: &str) -> TcpStream {
    let mut stream = TcpStream::connect(live.address()).unwrap();
    let host = live.address();
    let lines = if lines.contains("Host:") {
        lines.to_owned()
    } else {
        format!("Host: {host}\r\n{lines}")
    };
    let head = format!("{request} HTTP/1.1\r\n{lines}\r\n");
    stream.write_all(head.as_bytes()).unwrap();
    stream
}

fn answer(mut stream: TcpStream) -> String {
    let mut text = String::new();
    stream.read_to_string(&mut text).unwrap();
    text
}

fn status(answer: &str) -> &str {
    answer.split(' ').nth(1).unwrap()
}

fn token(live: &Live) -> String {
    let page = answer(ask(live, "GET /", ""));
    assert_eq!(status(&page), "200");
    let (_, rest) = page.split_once("TOKEN = \"").unwrap();
    rest.split('"').next().unwrap().to_owned()
}

#[test]
fn only_the_flights_own_page_changes_its_pace() {
    let live = open();
    let token = token(&live);
    let pause = "POST /control?pause=1";
    for (lines, why) in [
        (String::new(), "no token"),
        (
            "X-Token: 0123456789abcdef0123456789abcdef\r\n".to_owned(),
            "no token",
        ),
        (
            format!("X-Token: {token}\r\nOrigin: http://evil.example\r\n"),
            "not the flight's own",
        ),
        (
            format!("X-Token: {token}\r\nOrigin: null\r\n"),
            "not the flight's own",
        ),
        (
            format!("X-Token: {token}\r\nHost: evil.example:8088\r\n"),
            "not the flight's own",
        ),
    ] {
        let answer = answer(ask(&live, pause, &lines));
        assert_eq!(status(&answer), "403", "{lines}: {answer}");
        assert!(answer.contains(why), "{lines}: {answer}");
        assert_eq!(live.wish(), AS_STARTED, "{lines}");
    }
    // Nor does a foreign page see anything.
    for path in ["GET /", "GET /events"] {
        let answer = answer(ask(&live, path, "Origin: http://evil.example\r\n"));
        assert_eq!(status(&answer), "403", "{path}");
    }
    let port = live.address().port();
    let lines = format!(
        "X-Token: {token}\r\nHost: localhost:{port}\r\nOrigin: http://localhost:{port}\r\n"
    );
    assert_eq!(status(&answer(ask(&live, pause, &lines))), "204");
    assert!(live.wish().pause);
}

#[test]
fn the_page_stands_in_no_frame_and_is_not_kept() {
    let live = open();
    for request in ["GET /", "GET /nothing", "POST /control?pause=1"] {
        let answer = answer(ask(&live, request, ""));
        let (head, _) = answer.split_once("\r\n\r\n").unwrap();
        for line in [
            "Cache-Control: no-store",
            "Content-Security-Policy: frame-ancestors 'none'",
            "X-Frame-Options: DENY",
        ] {
            assert!(head.lines().any(|found| found == line), "{request}: {head}");
        }
    }
}

#[test]
fn what_is_no_request_is_told_so_at_once() {
    let live = open();
    let (host, token) = (live.address(), token(&live));
    let pause = format!("POST /control?pause=1 HTTP/1.1\r\nX-Token: {token}\r\nHost: {host}\r\n");
    let long = format!("X-Long: {}\r\n", "a".repeat(20_000));
    for (lines, rest, expected) in [
        ("Host: evil.example\r\n", "", "400"),
        ("Content-Length: 7\r\n", "pause=1", "400"),
        ("Content-Length: 100000\r\n", "pause=1", "400"),
        (
            "Transfer-Encoding: chunked\r\n",
            "1\r\na\r\n0\r\n\r\n",
            "400",
        ),
        (long.as_str(), "", "431"),
    ] {
        let mut stream = TcpStream::connect(host).unwrap();
        let request = format!("{pause}{lines}\r\n{rest}");
        stream.write_all(request.as_bytes()).unwrap();
        stream.shutdown(std::net::Shutdown::Write).unwrap();
        let answer = answer(stream);
        assert_eq!(status(&answer), expected, "{answer}");
        assert!(answer.contains("\r\n\r\ngive "), "{answer}");
        assert_eq!(live.wish(), AS_STARTED, "{lines}");
    }
    // Lines without a carriage return are read as well.
    let mut stream = TcpStream::connect(host).unwrap();
    let bare = format!("{pause}\r\n").replace('\r', "");
    stream.write_all(bare.as_bytes()).unwrap();
    assert_eq!(status(&answer(stream)), "204");
    assert!(live.wish().pause);
}

#[test]
fn a_speed_out_of_range_is_refused_with_the_range() {
    let live = open();
    let token = format!("X-Token: {}\r\n", token(&live));
    for speed in ["1e-300", "1e-4", "0", "-1", "NaN", "1e9"] {
        let request = format!("POST /control?speed={speed}");
        let answer = answer(ask(&live, &request, &token));
        assert_eq!(status(&answer), "400", "{speed}");
        assert!(answer.contains("from 0.01 to 1000, or max"), "{answer}");
        assert_eq!(live.wish(), AS_STARTED, "{speed}");
    }
    let answer = answer(ask(&live, "POST /control?speed=0.01", &token));
    assert_eq!(status(&answer), "204");
    assert_eq!(live.wish().speed, Speed::Times(0.01));
    for speed in ["1e-300", "1e-4", "1001"] {
        let output = harness().args(["fly", "--speed", speed]).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{speed}");
        assert!(
            talk(&output).contains("from 0.01 to 1000, or max"),
            "{}",
            talk(&output)
        );
    }
}

#[test]
fn who_comes_when_all_places_are_taken_is_told_so() {
    let live = open();
    // Places come back.
    for _ in 0..100 {
        assert_eq!(status(&answer(ask(&live, "GET /", ""))), "200");
    }
    let lookers: Vec<TcpStream> = (0..32).map(|_| ask(&live, "GET /events", "")).collect();
    // Nothing is asked: what is not read might take the answer with it.
    let late = TcpStream::connect(live.address()).unwrap();
    let answer = answer(late);
    assert_eq!(status(&answer), "503", "{answer}");
    // Those who look are served.
    for mut looker in lookers {
        let mut head = [0; 15];
        looker.read_exact(&mut head).unwrap();
        assert_eq!(&head, b"HTTP/1.1 200 OK");
    }
}

/// Reads events until one of this kind has come; gives the name of each of them.
fn events_until(stream: TcpStream, kind: &str) -> Vec<(String, String)> {
    let mut lines = BufReader::new(stream).lines().map(Result::unwrap);
    let mut events: Vec<(String, String)> = Vec::new();
    while events.last().is_none_or(|(_, last)| last != kind) {
        let line = lines.next().unwrap();
        if let Some(id) = line.strip_prefix("id: ") {
            let event = lines.next().unwrap();
            events.push((
                id.to_owned(),
                event.strip_prefix("event: ").unwrap().to_owned(),
            ));
        }
    }
    events
}

#[test]
fn who_lost_the_connection_goes_on_where_it_was() {
    let live = open();
    let token = format!("X-Token: {}\r\n", token(&live));
    let pace = |query: &str| {
        let answer = answer(ask(&live, &format!("POST /control?{query}"), &token));
        assert_eq!(status(&answer), "204");
    };
    let since = |last: &str| {
        let lines = format!("Last-Event-ID: {last}\r\n");
        let events = events_until(ask(&live, "GET /events", &lines), "pace");
        events.into_iter().map(|(_, kind)| kind).collect::<Vec<_>>()
    };
    let events = events_until(ask(&live, "GET /events", ""), "pace");
    assert_eq!(
        events
            .iter()
            .map(|(_, kind)| kind.as_str())
            .collect::<Vec<_>>(),
        ["begin", "pace"]
    );
    let (begin, first_pace) = (&events[0].0, &events[1].0);
    assert_eq!(since(begin), ["pace"]);
    // Nothing comes twice: the next event is the new one.
    pace("pause=1");
    assert_eq!(since(first_pace), ["pace"]);
    // A name that is none of this flight gets everything.
    let other = open();
    let foreign = &events_until(ask(&other, "GET /events", ""), "begin")[0].0;
    assert_ne!(foreign, begin);
    for name in [foreign, "", "7"] {
        assert_eq!(since(name), ["begin", "pace"], "{name}");
    }
}

#[test]
fn every_viewer_is_told_of_the_pace() {
    let live = open();
    let mut viewers = [ask(&live, "GET /events", ""), ask(&live, "GET /events", "")];
    for viewer in &mut viewers {
        // Both look before anything changes.
        assert!(
            read_until(viewer, r#""pause":false"#).contains(r#"data: {"pause":false,"speed":"1"}"#)
        );
    }
    let token = format!("X-Token: {}\r\n", token(&live));
    let request = "POST /control?pause=1&speed=max";
    assert_eq!(status(&answer(ask(&live, request, &token))), "204");
    let late = ask(&live, "GET /events", "");
    for mut viewer in viewers.into_iter().chain([late]) {
        let told = read_until(&mut viewer, r#""pause":true"#);
        assert!(
            told.ends_with(r#"data: {"pause":true,"speed":"max"}"#),
            "{told}"
        );
    }
}

/// Reads up to the end of the line that holds this.
fn read_until(stream: &mut TcpStream, wanted: &str) -> String {
    let (mut text, mut byte) = (String::new(), [0]);
    while !(text.ends_with('\n') && text.contains(wanted)) {
        stream.read_exact(&mut byte).unwrap();
        text.push(char::from(byte[0]));
    }
    text.trim_end().to_owned()
}
