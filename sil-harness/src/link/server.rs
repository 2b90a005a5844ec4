//! The core as a process of its own: serves one harness after another.

use super::tcp::{is_silence, read_error};
use hil_protocol::{Decoder, Message};
use mpp_node::FlightNode;
use mpp_sim::link::LinkError;
use mpp_sim::oracle::Oracle;
use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::time::{Duration, Instant};

/// Serves a core on a listening socket. With `once` it ends after the first session in which a flight was
/// configured; who only connects is a stranger, and does not keep the harness from its core. An oracle advises
/// the core. `report` gets lines about each session.
///
/// # Errors
/// [`LinkError`] of the socket, and with `once` that of the session.
pub fn serve(
    listener: &TcpListener,
    once: bool,
    patience: Duration,
    oracle: Option<&Oracle>,
    mut report: impl FnMut(&str),
) -> Result<(), LinkError> {
    loop {
        let (stream, peer) = listener
            .accept()
            .map_err(|error| LinkError::Io("waiting for a harness".to_owned(), error))?;
        report(&format!("harness connected from {peer}"));
        let mut configured = false;
        let result = serve_session(stream, patience, oracle, &mut configured);
        match &result {
            Ok(()) => report("harness closed the link"),
            Err(error) => report(&error.to_string()),
        }
        if once && configured {
            return result;
        }
    }
}

/// How long a client may take to say hello, whatever else it sends: others wait for it to end.
const HELLO: Duration = Duration::from_secs(5);

/// Whether a client is a harness, and when its last whole message came.
struct Client {
    decoder: Decoder,
    greeted: bool,
    last: Instant,
    patience: Duration,
}

impl Client {
    /// Takes in what came; bytes that come to no message do not count.
    fn hear(&mut self, bytes: &[u8]) {
        let messages = bytes
            .iter()
            .filter_map(|byte| self.decoder.push(*byte)?.ok());
        let mut heard = false;
        for message in messages {
            self.greeted |= matches!(message, Message::Hello(_));
            heard = self.greeted;
        }
        if heard {
            self.last = Instant::now();
        }
    }

    /// How long it may be silent in all.
    fn patience(&self) -> Duration {
        match self.greeted {
            true => self.patience,
            false => self.patience.min(HELLO),
        }
    }

    /// How long it is still waited for.
    fn left(&self) -> Duration {
        self.patience().saturating_sub(self.last.elapsed())
    }

    fn silent(&self) -> LinkError {
        LinkError::Silent {
            waiting: "core",
            awaited: self.awaited(),
            patience: Some(self.patience()),
        }
    }

    fn awaited(&self) -> String {
        let what = if self.greeted {
            "the next frame"
        } else {
            "hello"
        };
        format!("{what} from the harness")
    }
}

/// Serves one harness until it closes the link. Tells whether it configured a flight.
fn serve_session(
    mut stream: TcpStream,
    patience: Duration,
    oracle: Option<&Oracle>,
    configured: &mut bool,
) -> Result<(), LinkError> {
    let io = |error| LinkError::Io("preparing the link to the harness".to_owned(), error);
    stream.set_nodelay(true).map_err(io)?;
    stream.set_write_timeout(Some(patience)).map_err(io)?;
    let mut node = Box::new(FlightNode::new());
    let mut client = Client {
        decoder: Decoder::new(),
        greeted: false,
        last: Instant::now(),
        patience,
    };
    let mut bytes = [0; 4096];
    loop {
        // What is there already is looked at, however late.
        let wait = client.left().max(Duration::from_millis(1));
        stream.set_read_timeout(Some(wait)).map_err(io)?;
        let count = match stream.read(&mut bytes) {
            Ok(0) => return Ok(()),
            Ok(count) => count,
            Err(error) if is_silence(&error) => return Err(client.silent()),
            Err(error) => return Err(read_error(error, "core", client.awaited(), patience)),
        };
        let mut sent = Ok(());
        let send = |frame: &[u8]| {
            if sent.is_ok() {
                sent = stream.write_all(frame);
            }
        };
        node.receive_advised(&bytes[..count], send, Oracle::advice(oracle));
        *configured |= node.health().is_some();
        // After the core has done its work: that takes nothing of the harness's time.
        client.hear(&bytes[..count]);
        sent.map_err(|error| LinkError::Io("answering the harness".to_owned(), error))?;
        if client.left().is_zero() {
            return Err(client.silent());
        }
    }
}
