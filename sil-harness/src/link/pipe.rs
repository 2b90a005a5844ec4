//! The core in the harness's own process, behind a pipe of bytes.

use super::{Link, LinkError};
use flight_node::FlightNode;
use hil_protocol::{Decoder, MAX_FRAME, Message, encode};
use std::collections::VecDeque;

/// A core of our own; bytes go in and come out as they would over a wire.
pub struct PipeLink {
    node: Box<FlightNode>,
    to_harness: VecDeque<u8>,
    decoder: Decoder,
}

impl PipeLink {
    /// A fresh core.
    #[must_use]
    pub fn new() -> Self {
        Self {
            node: Box::new(FlightNode::new()),
            to_harness: VecDeque::new(),
            decoder: Decoder::new(),
        }
    }

    /// Sends bytes as they are, whatever they mean.
    pub fn send_bytes(&mut self, bytes: &[u8]) {
        self.node
            .receive(bytes, |frame| self.to_harness.extend(frame));
    }

    /// The core, to look at.
    #[must_use]
    pub fn node(&self) -> &FlightNode {
        &self.node
    }
}

impl Default for PipeLink {
    fn default() -> Self {
        Self::new()
    }
}

impl Link for PipeLink {
    fn send(&mut self, message: &Message) -> Result<(), LinkError> {
        let mut buffer = [0; MAX_FRAME];
        let frame = encode(message, &mut buffer)?;
        self.send_bytes(frame);
        Ok(())
    }

    fn receive(&mut self, awaited: &str) -> Result<Message, LinkError> {
        while let Some(byte) = self.to_harness.pop_front() {
            match self.decoder.push(byte) {
                None => {}
                Some(Ok(message)) => return Ok(message),
                Some(Err(error)) => return Err(LinkError::Frame(error)),
            }
        }
        Err(LinkError::Silent {
            waiting: "harness",
            awaited: format!("{awaited} from the core"),
            patience: None,
        })
    }
}
