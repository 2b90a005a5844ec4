//! The core in the harness's own process, behind a pipe of bytes.

use crate::field::Field;
use crate::link::{Link, LinkError};
use crate::oracle::Oracle;
use crate::scenario::Scenario;
use hil_protocol::{Decoder, MAX_FRAME, Message, encode};
use mpp_core::vehicle::{VehicleState, Wind};
use mpp_node::FlightNode;
use std::collections::VecDeque;

/// The bytes from a core in this process.
pub(crate) struct Inbox {
    pub(crate) bytes: VecDeque<u8>,
    decoder: Decoder,
}

impl Inbox {
    /// Nothing yet.
    pub(crate) fn new() -> Self {
        Self {
            bytes: VecDeque::new(),
            decoder: Decoder::new(),
        }
    }

    /// The next message. `awaited` names the expected one for the error.
    pub(crate) fn receive(&mut self, awaited: &str) -> Result<Message, LinkError> {
        while let Some(byte) = self.bytes.pop_front() {
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

/// A core in this process. Bytes go in and come out as they would over a wire.
pub struct PipeLink {
    node: Box<FlightNode>,
    oracle: Option<Oracle>,
    inbox: Inbox,
}

impl PipeLink {
    /// A fresh core.
    #[must_use]
    pub fn new() -> Self {
        Self {
            node: Box::new(FlightNode::new()),
            oracle: None,
            inbox: Inbox::new(),
        }
    }

    /// A fresh core for a scenario, with its oracle if it has one.
    #[must_use]
    pub fn of(scenario: &Scenario) -> Self {
        Self::in_field(scenario, &scenario.field())
    }

    /// A fresh core for a scenario in a field that is not the scenario's.
    #[must_use]
    pub fn in_field(scenario: &Scenario, field: &dyn Field) -> Self {
        let obstacles = field.obstacles();
        let oracle = if scenario.oracle {
            Some(Oracle::new(obstacles))
        } else if scenario.known_map {
            Some(Oracle::of_map(obstacles, scenario.lidar.range_max))
        } else {
            None
        };
        Self {
            oracle,
            ..Self::new()
        }
    }

    /// Sends bytes as they are, without a check.
    pub fn send_bytes(&mut self, bytes: &[u8]) {
        let send = |frame: &[u8]| self.inbox.bytes.extend(frame);
        Oracle::receive(self.oracle.as_ref(), &mut self.node, bytes, send);
    }

    /// The core, for inspection.
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
        self.inbox.receive(awaited)
    }

    fn reveal(&mut self, truth: &VehicleState, wind: Wind) -> Result<(), LinkError> {
        match &mut self.oracle {
            Some(oracle) => {
                oracle.see(truth, wind);
                Ok(())
            }
            None => Err(LinkError::NoOracle),
        }
    }
}
