//! The way to the autopilot: UDP, whoever speaks first, or TCP.

use mpp_companion::CompanionError;
use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream, UdpSocket};
use std::sync::{Arc, Mutex, PoisonError};

type Reader = Box<dyn FnMut(&mut [u8]) -> std::io::Result<usize> + Send>;
pub(crate) type Writer = Box<dyn FnMut(&[u8]) -> std::io::Result<()>>;

/// Both directions of a way to the autopilot.
pub(crate) struct Port {
    /// Reads what came; nothing read is the end of a stream.
    pub(crate) read: Reader,
    /// Sends a frame.
    pub(crate) write: Writer,
}

impl Port {
    /// The forms of an address.
    const FORM: &str = "udp:HOST:PORT, udpin:HOST:PORT or tcp:HOST:PORT";

    /// Opens an address.
    ///
    /// # Errors
    /// [`CompanionError::Address`], [`CompanionError::Io`].
    pub(crate) fn open(address: &str) -> Result<Self, CompanionError> {
        let failed = |error| CompanionError::Io(format!("open {address}"), error);
        match address.split_once(':') {
            Some(("udp", peer)) => Self::speaks(peer).map_err(failed),
            Some(("udpin", own)) => Self::listens(own).map_err(failed),
            Some(("tcp", peer)) => Self::stream(peer).map_err(failed),
            _ => Err(CompanionError::Address(address.to_owned(), Self::FORM)),
        }
    }

    fn speaks(peer: &str) -> std::io::Result<Self> {
        let socket = UdpSocket::bind("0.0.0.0:0")?;
        socket.connect(peer)?;
        let own = socket.try_clone()?;
        Ok(Self {
            read: Box::new(move |buffer| own.recv(buffer)),
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
                let (size, from) = hears.recv_from(buffer)?;
                *spoke.lock().unwrap_or_else(PoisonError::into_inner) = Some(from);
                Ok(size)
            }),
            write: Box::new(move |frame| {
                let peer = *peer.lock().unwrap_or_else(PoisonError::into_inner);
                peer.map_or(Ok(()), |peer| socket.send_to(frame, peer).map(drop))
            }),
        })
    }

    fn stream(peer: &str) -> std::io::Result<Self> {
        let mut stream = TcpStream::connect(peer)?;
        stream.set_nodelay(true)?;
        let mut own = stream.try_clone()?;
        Ok(Self {
            read: Box::new(move |buffer| own.read(buffer)),
            write: Box::new(move |frame| stream.write_all(frame)),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::net::TcpListener;

    /// ArduPlane's simulation speaks first over UDP, and waits for a client over TCP.
    #[test]
    fn a_peer_that_speaks_first_and_one_that_waits_are_reached() {
        let free = UdpSocket::bind("127.0.0.1:0").unwrap();
        let own = free.local_addr().unwrap();
        drop(free);
        let mut port = Port::open(&format!("udpin:{own}")).unwrap();
        assert!((port.write)(b"nobody").is_ok());
        let peer = UdpSocket::bind("127.0.0.1:0").unwrap();
        peer.send_to(b"beat", own).unwrap();
        let mut buffer = [0; 8];
        assert_eq!((port.read)(&mut buffer).unwrap(), 4);
        (port.write)(b"set").unwrap();
        assert_eq!(peer.recv(&mut buffer).unwrap(), 3);

        let waits = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = format!("tcp:{}", waits.local_addr().unwrap());
        let mut port = Port::open(&address).unwrap();
        let (mut peer, _) = waits.accept().unwrap();
        peer.write_all(b"beat").unwrap();
        assert_eq!((port.read)(&mut buffer).unwrap(), 4);
        (port.write)(b"set").unwrap();
        assert_eq!(peer.read(&mut buffer).unwrap(), 3);
        assert!(matches!(
            Port::open("14550"),
            Err(CompanionError::Address(..))
        ));
    }
}
