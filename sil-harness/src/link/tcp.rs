//! The core as another process, over TCP.

use hil_protocol::{Decoder, MAX_FRAME, Message, encode};
use mpp_sim::link::{Link, LinkError};
use std::collections::VecDeque;
use std::io::{ErrorKind, Read, Write};
use std::net::TcpStream;
use std::time::Duration;

/// A connection to a core.
pub struct TcpLink {
    stream: TcpStream,
    address: String,
    patience: Duration,
    decoder: Decoder,
    received: VecDeque<u8>,
}

impl TcpLink {
    /// Connects to a core at `HOST:PORT`, which may be silent for as long as `patience`.
    ///
    /// # Errors
    /// [`LinkError::Io`] when nobody listens there.
    pub fn connect(address: &str, patience: Duration) -> Result<Self, LinkError> {
        let io = |error| LinkError::Io(format!("connecting to the core at {address}"), error);
        let stream = TcpStream::connect(address).map_err(io)?;
        Self::over(stream, address.to_owned(), patience).map_err(io)
    }

    /// A link over a connection, with its own patience.
    ///
    /// # Errors
    /// The error of the operating system when it refuses the connection's options.
    pub fn over(stream: TcpStream, address: String, patience: Duration) -> std::io::Result<Self> {
        // A tick is one small frame each way, so the link never waits to fill a packet.
        stream.set_nodelay(true)?;
        stream.set_read_timeout(Some(patience))?;
        stream.set_write_timeout(Some(patience))?;
        Ok(Self {
            stream,
            address,
            patience,
            decoder: Decoder::new(),
            received: VecDeque::new(),
        })
    }

    fn fill(&mut self, awaited: &str) -> Result<(), LinkError> {
        let awaited = || format!("{awaited} from the core at {}", self.address);
        let mut bytes = [0; 4096];
        match self.stream.read(&mut bytes) {
            Ok(0) => Err(LinkError::Closed { awaited: awaited() }),
            Ok(count) => {
                self.received.extend(bytes.iter().take(count));
                Ok(())
            }
            Err(error) => Err(read_error(error, "harness", awaited(), self.patience)),
        }
    }
}

/// Whether nothing came, for as long as was waited.
pub(super) fn is_silence(error: &std::io::Error) -> bool {
    matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut)
}

/// The meaning of a failed read: silence, a closed link or another error.
pub(super) fn read_error(
    error: std::io::Error,
    waiting: &'static str,
    awaited: String,
    patience: Duration,
) -> LinkError {
    match error.kind() {
        _ if is_silence(&error) => LinkError::Silent {
            waiting,
            awaited,
            patience: Some(patience),
        },
        ErrorKind::ConnectionReset | ErrorKind::UnexpectedEof => LinkError::Closed { awaited },
        _ => LinkError::Io(format!("waiting for {awaited}"), error),
    }
}

impl Link for TcpLink {
    fn send(&mut self, message: &Message) -> Result<(), LinkError> {
        let mut buffer = [0; MAX_FRAME];
        let frame = encode(message, &mut buffer)?;
        self.stream.write_all(frame).map_err(|error| {
            LinkError::Io(format!("sending to the core at {}", self.address), error)
        })
    }

    fn receive(&mut self, awaited: &str) -> Result<Message, LinkError> {
        loop {
            while let Some(byte) = self.received.pop_front() {
                match self.decoder.push(byte) {
                    None => {}
                    Some(Ok(message)) => return Ok(message),
                    Some(Err(error)) => return Err(LinkError::Frame(error)),
                }
            }
            self.fill(awaited)?;
        }
    }
}
