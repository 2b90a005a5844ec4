//! What a browser asks: the head of a request, which may not take for ever to come.

use std::io::{self, ErrorKind};
use std::time::Duration;

/// Longest head that is read \[bytes\].
const HEAD: usize = 8192;
/// How long a head may take to come, however often a bit of it does.
pub(super) const QUESTION: Duration = Duration::from_secs(5);

/// What is of interest in a request.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Request {
    pub(super) method: String,
    pub(super) path: String,
    pub(super) host: Option<String>,
    pub(super) origin: Option<String>,
    pub(super) token: Option<String>,
    /// The last event that the browser got before it lost the connection.
    pub(super) last_event: Option<String>,
}

/// Why there is no request.
#[derive(Debug)]
pub(super) enum NoRequest {
    /// Nothing can be answered.
    Gone(io::Error),
    /// What came gets this status and this text for an answer.
    Refused(&'static str, &'static str),
}

impl From<io::Error> for NoRequest {
    fn from(error: io::Error) -> Self {
        Self::Gone(error)
    }
}

/// Reads a head with `read`, which waits no longer than it is told; `elapsed` is the time since the
/// browser connected.
pub(super) fn head(
    mut read: impl FnMut(&mut [u8], Duration) -> io::Result<usize>,
    mut elapsed: impl FnMut() -> Duration,
) -> Result<Request, NoRequest> {
    let mut bytes = Vec::new();
    let mut buffer = [0; 1024];
    loop {
        let left = QUESTION.saturating_sub(elapsed());
        if left.is_zero() {
            return Err(io::Error::from(ErrorKind::TimedOut).into());
        }
        let count = read(&mut buffer, left)?;
        bytes.extend(buffer.iter().take(count));
        let end = end_of_head(&bytes);
        if end.unwrap_or(bytes.len()) > HEAD {
            let status = "431 Request Header Fields Too Large";
            return Err(NoRequest::Refused(status, "give a head of at most 8 kB"));
        }
        if let Some(end) = end {
            return parse(&String::from_utf8_lossy(
                bytes.get(..end).unwrap_or_default(),
            ));
        }
        if count == 0 {
            return Err(io::Error::from(ErrorKind::UnexpectedEof).into());
        }
    }
}

/// Length of a head up to its empty line \[bytes\], if it has come. Some programs end lines without a carriage return.
fn end_of_head(bytes: &[u8]) -> Option<usize> {
    let length = |end: &[u8]| {
        let at = bytes.windows(end.len()).position(|window| window == end);
        at.map(|at| at + end.len())
    };
    [length(b"\n\r\n"), length(b"\n\n")]
        .into_iter()
        .flatten()
        .min()
}

fn parse(head: &str) -> Result<Request, NoRequest> {
    let wrong = |why| Err(NoRequest::Refused("400 Bad Request", why));
    let mut lines = head.lines();
    let mut words = lines.next().unwrap_or_default().split_whitespace();
    let mut word = || words.next().unwrap_or_default().to_owned();
    let mut request = Request {
        method: word(),
        path: word(),
        ..Request::default()
    };
    for (name, value) in lines.filter_map(|line| line.split_once(':')) {
        let value = value.trim().to_owned();
        let place = match name.to_ascii_lowercase().as_str() {
            "host" => &mut request.host,
            "origin" => &mut request.origin,
            "x-token" => &mut request.token,
            "last-event-id" => &mut request.last_event,
            "content-length" if value != "0" => return wrong("give a request without a body"),
            "transfer-encoding" => return wrong("give a request without a body"),
            _ => continue,
        };
        // Which of two holds, programs do not agree about.
        if place.replace(value).is_some() {
            return wrong("give each line of the head once");
        }
    }
    Ok(request)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_head_is_read_in_whatever_bits_it_comes() {
        let text =
            b"POST /control?pause=1 HTTP/1.1\r\nhost: a:1\r\nORIGIN:http://b\r\nX-Token: c\r\nLast-Event-ID: d-1\r\n\r\n";
        let wanted = Request {
            method: "POST".to_owned(),
            path: "/control?pause=1".to_owned(),
            host: Some("a:1".to_owned()),
            origin: Some("http://b".to_owned()),
            token: Some("c".to_owned()),
            last_event: Some("d-1".to_owned()),
        };
        let bare = String::from_utf8_lossy(text).replace('\r', "");
        for (text, size) in [
            (&text[..], 1),
            (text, 7),
            (text, 1000),
            (bare.as_bytes(), 5),
        ] {
            let mut bits = text.chunks(size);
            let read = |buffer: &mut [u8], _| {
                let bit = bits.next().unwrap();
                buffer[..bit.len()].copy_from_slice(bit);
                Ok(bit.len())
            };
            assert_eq!(head(read, || Duration::ZERO).unwrap(), wanted, "{size}");
        }
    }

    #[test]
    fn a_head_that_drips_or_never_ends_is_given_up() {
        let drip = |buffer: &mut [u8], _| {
            buffer[0] = b'G';
            Ok(1)
        };
        let mut seconds = 0;
        let clock = || {
            seconds += 1;
            Duration::from_secs(seconds)
        };
        let gone = |result: Result<Request, NoRequest>| match result.unwrap_err() {
            NoRequest::Gone(error) => error.kind(),
            refused => panic!("{refused:?}"),
        };
        assert_eq!(gone(head(drip, clock)), ErrorKind::TimedOut);
        assert_eq!(seconds, QUESTION.as_secs());
        let end = head(|_, _| Ok(0), || Duration::ZERO);
        assert_eq!(gone(end), ErrorKind::UnexpectedEof);
        let endless = head(drip, || Duration::ZERO).unwrap_err();
        assert!(matches!(endless, NoRequest::Refused(status, _) if status.starts_with("431")));
    }

    #[test]
    fn a_body_and_a_line_that_comes_twice_are_refused() {
        for (line, advice) in [
            ("Host: b", "each line of the head once"),
            ("hOST: a", "each line of the head once"),
            ("Content-Length: 3", "without a body"),
            ("Transfer-Encoding: chunked", "without a body"),
        ] {
            let refused = parse(&format!("GET / HTTP/1.1\r\nHost: a\r\n{line}\r\n\r\n"));
            let Err(NoRequest::Refused(status, why)) = refused else {
                panic!("{line}: {refused:?}");
            };
            assert!(status.starts_with("400") && why.contains(advice), "{why}");
        }
        // Browsers send this with a POST that has no body.
        assert!(parse("POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 0\r\n\r\n").is_ok());
    }
}
