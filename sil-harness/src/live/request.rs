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

/// Reads a head with `read`, which waits no longer than it is told; `elapsed` is the time since the
/// browser connected.
pub(super) fn head(
    mut read: impl FnMut(&mut [u8], Duration) -> io::Result<usize>,
    mut elapsed: impl FnMut() -> Duration,
) -> io::Result<Request> {
    let mut bytes = Vec::new();
    let mut buffer = [0; 1024];
    while !bytes.ends_with(b"\r\n\r\n") {
        let left = QUESTION.saturating_sub(elapsed());
        if left.is_zero() {
            return Err(ErrorKind::TimedOut.into());
        }
        let count = read(&mut buffer, left)?;
        bytes.extend(buffer.iter().take(count));
        if count == 0 || bytes.len() > HEAD {
            return Err(ErrorKind::InvalidData.into());
        }
    }
    Ok(parse(&String::from_utf8_lossy(&bytes)))
}

fn parse(head: &str) -> Request {
    let mut lines = head.lines();
    let mut words = lines.next().unwrap_or_default().split_whitespace();
    let mut word = || words.next().unwrap_or_default().to_owned();
    let mut request = Request {
        method: word(),
        path: word(),
        ..Request::default()
    };
    for (name, value) in lines.filter_map(|line| line.split_once(':')) {
        let value = Some(value.trim().to_owned());
        match name.to_ascii_lowercase().as_str() {
            "host" => request.host = value,
            "origin" => request.origin = value,
            "x-token" => request.token = value,
            "last-event-id" => request.last_event = value,
            _ => {}
        }
    }
    request
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
        for size in [1, 7, 1000] {
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
        let error = head(drip, clock).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::TimedOut);
        assert_eq!(seconds, QUESTION.as_secs());
        let error = head(drip, || Duration::ZERO).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::InvalidData);
        let error = head(|_, _| Ok(0), || Duration::ZERO).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::InvalidData);
    }
}
