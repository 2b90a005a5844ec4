//! The way to the autopilot: UDP, whoever speaks first, or a stream.

use crate::stream::{self, Tries};
use mpp_companion::CompanionError;
use std::net::{SocketAddr, UdpSocket};
use std::sync::{Arc, Mutex, PoisonError};

type Reader = Box<dyn FnMut(&mut [u8]) -> std::io::Result<usize> + Send>;
pub(crate) type Writer = Box<dyn FnMut(&[u8]) -> std::io::Result<()>>;

/// Both directions of a way to the autopilot.
pub(crate) struct Port {
    /// Reads what came, which may be nothing. An error is the end.
    pub(crate) read: Reader,
    /// Sends a frame.
    pub(crate) write: Writer,
}

impl Port {
    /// The forms of an address.
    const FORM: &str = "udp:HOST:PORT, udpin:HOST:PORT, tcp:HOST:PORT or serial:DEVICE:BAUD";

    /// Opens an address.
    ///
    /// # Errors
    /// [`CompanionError::Address`], [`CompanionError::Io`].
    pub(crate) fn open(address: &str, tries: Tries) -> Result<Self, CompanionError> {
        let failed = |error| CompanionError::Io(format!("open {address}"), error);
        match address.split_once(':') {
            Some(("udp", peer)) => Self::speaks(peer).map_err(failed),
            Some(("udpin", own)) => Self::listens(own).map_err(failed),
            Some(("tcp", peer)) => stream::lasting(peer, tries, stream::tcp).map_err(failed),
            #[cfg(unix)]
            Some(("serial", line)) => stream::lasting(line, tries, stream::serial).map_err(failed),
            _ => Err(CompanionError::Address(address.to_owned(), Self::FORM)),
        }
    }

    fn speaks(peer: &str) -> std::io::Result<Self> {
        let socket = UdpSocket::bind("0.0.0.0:0")?;
        socket.connect(peer)?;
        let own = socket.try_clone()?;
        Ok(Self {
            // An error tells that the autopilot is not there yet.
            read: Box::new(move |buffer| Ok(own.recv(buffer).unwrap_or(0))),
            write: Box::new(move |frame| socket.send(frame).map(drop)),
        })
    }

    /// The answers go to whoever spoke last: an autopilot that restarts may have another port.
    fn listens(own: &str) -> std::io::Result<Self> {
        let socket = UdpSocket::bind(own)?;
        let hears = socket.try_clone()?;
        let spoke: Arc<Mutex<Option<SocketAddr>>> = Arc::default();
        let peer = Arc::clone(&spoke);
        Ok(Self {
            read: Box::new(move |buffer| {
                let Ok((size, from)) = hears.recv_from(buffer) else {
                    return Ok(0);
                };
                *spoke.lock().unwrap_or_else(PoisonError::into_inner) = Some(from);
                Ok(size)
            }),
            write: Box::new(move |frame| {
                let peer = *peer.lock().unwrap_or_else(PoisonError::into_inner);
                peer.map_or(Ok(()), |peer| socket.send_to(frame, peer).map(drop))
            }),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ArduPlane's simulation speaks first over UDP.
    #[test]
    fn a_peer_that_speaks_first_is_reached() {
        let free = UdpSocket::bind("127.0.0.1:0").unwrap();
        let own = free.local_addr().unwrap();
        drop(free);
        let mut port = Port::open(&format!("udpin:{own}"), stream::USUAL).unwrap();
        assert!((port.write)(b"nobody").is_ok());
        let peer = UdpSocket::bind("127.0.0.1:0").unwrap();
        peer.send_to(b"beat", own).unwrap();
        let mut buffer = [0; 8];
        assert_eq!((port.read)(&mut buffer).unwrap(), 4);
        (port.write)(b"set").unwrap();
        assert_eq!(peer.recv(&mut buffer).unwrap(), 3);

        assert!(matches!(
            Port::open("14550", stream::USUAL),
            Err(CompanionError::Address(..))
        ));
    }
}
