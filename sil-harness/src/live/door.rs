//! Who may look, and who may change something: every page in the same browser can send requests.

use super::request::Request;
use std::collections::hash_map::RandomState;
use std::hash::{BuildHasher, Hasher};
use std::net::SocketAddr;

/// The rules of one server.
pub(super) struct Door {
    /// The address as it was given.
    given: String,
    /// What our own page sends along and no other one knows. It is no part of a flight, so it comes
    /// from the operating system and not from a seed.
    pub(super) token: String,
}

impl Door {
    pub(super) fn new(given: &str) -> Self {
        let number = || RandomState::new().build_hasher().finish();
        Self {
            given: given.to_owned(),
            token: format!("{:016x}{:016x}", number(), number()),
        }
    }

    /// Whether the request comes from a page of our own, or of nobody; `local` is the address that
    /// it reached. A foreign name that leads here is refused, too.
    pub(super) fn admits(&self, request: &Request, local: SocketAddr) -> bool {
        let own = |name: &str| self.is_own(name, local);
        let origin = match &request.origin {
            None => true,
            Some(origin) => origin.strip_prefix("http://").is_some_and(own),
        };
        origin && request.host.as_deref().is_some_and(own)
    }

    /// Whether it may change something.
    pub(super) fn trusts(&self, request: &Request) -> bool {
        request.token.as_ref() == Some(&self.token)
    }

    fn is_own(&self, name: &str, local: SocketAddr) -> bool {
        // The port that a browser leaves out.
        let (name, port) = match name.rsplit_once(':') {
            Some((host, port)) if !port.ends_with(']') => (host, port),
            _ => (name, "80"),
        };
        let host = match local {
            SocketAddr::V4(address) => address.ip().to_string(),
            SocketAddr::V6(address) => format!("[{}]", address.ip()),
        };
        let given = self.given.rsplit_once(':').map(|(host, _)| host);
        let own = ["localhost", "127.0.0.1", "[::1]", &host];
        port == local.port().to_string()
            && (own.into_iter().chain(given)).any(|own| own.eq_ignore_ascii_case(name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_own_address_is_at_home() {
        let door = Door::new("plane.example:8088");
        let local: SocketAddr = "192.168.0.7:8088".parse().unwrap();
        let asked = |host: &str, origin: Option<&str>| {
            let request = Request {
                host: Some(host.to_owned()),
                origin: origin.map(str::to_owned),
                ..Request::default()
            };
            door.admits(&request, local)
        };
        for host in ["localhost", "127.0.0.1", "192.168.0.7", "Plane.example"] {
            assert!(asked(&format!("{host}:8088"), None), "{host}");
            let origin = format!("http://{host}:8088");
            assert!(asked("localhost:8088", Some(&origin)), "{host}");
            assert!(!asked(&format!("{host}:8089"), None), "{host}");
            assert!(!asked(host, None), "{host}");
        }
        assert!(!asked("evil.example:8088", None));
        for origin in [
            "null",
            "http://evil.example",
            "http://localhost:1",
            "https://localhost:8088",
        ] {
            assert!(!asked("localhost:8088", Some(origin)), "{origin}");
        }
        assert!(!door.admits(&Request::default(), local));
    }

    #[test]
    fn a_token_is_nobody_elses() {
        let (door, other) = (Door::new(""), Door::new(""));
        assert_ne!(door.token, other.token);
        let with = |token: Option<String>| Request {
            token,
            ..Request::default()
        };
        assert!(door.trusts(&with(Some(door.token.clone()))));
        assert!(!door.trusts(&with(Some(other.token))));
        assert!(!door.trusts(&with(None)));
    }
}
