//! The core as a process of its own: serves one harness after another.

use super::LinkError;
use super::tcp::read_error;
use flight_node::FlightNode;
use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::time::Duration;

/// Serves a core on a listening socket; after the first flight only, if `once`. `report` gets a
/// line for each session.
///
/// # Errors
/// [`LinkError`] of the socket, and with `once` that of the session.
pub fn serve(
    listener: &TcpListener,
    once: bool,
    patience: Duration,
    mut report: impl FnMut(&str),
) -> Result<(), LinkError> {
    loop {
        let (stream, peer) = listener
            .accept()
            .map_err(|error| LinkError::Io("waiting for a harness".to_owned(), error))?;
        report(&format!("harness connected from {peer}"));
        let result = serve_session(stream, patience);
        match &result {
            Ok(()) => report("harness closed the link"),
            Err(error) => report(&error.to_string()),
        }
        if once {
            return result;
        }
    }
}

/// One harness, until it closes the link.
fn serve_session(mut stream: TcpStream, patience: Duration) -> Result<(), LinkError> {
    let io = |error| LinkError::Io("preparing the link to the harness".to_owned(), error);
    stream.set_nodelay(true).map_err(io)?;
    stream.set_read_timeout(Some(patience)).map_err(io)?;
    stream.set_write_timeout(Some(patience)).map_err(io)?;
    let mut node = Box::new(FlightNode::new());
    let mut bytes = [0; 4096];
    loop {
        let count = match stream.read(&mut bytes) {
            Ok(0) => return Ok(()),
            Ok(count) => count,
            Err(error) => {
                let awaited = "the next frame from the harness".to_owned();
                return Err(read_error(error, "core", awaited, patience));
            }
        };
        let mut sent = Ok(());
        node.receive(&bytes[..count], |frame| {
            if sent.is_ok() {
                sent = stream.write_all(frame);
            }
        });
        sent.map_err(|error| LinkError::Io("answering the harness".to_owned(), error))?;
    }
}
