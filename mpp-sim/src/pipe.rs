//! The core in the harness's own process, behind a pipe of bytes, or without a link.

use crate::field::Field;
use crate::flight::own_hello;
use crate::link::{Link, LinkError};
use crate::oracle::Oracle;
use crate::scenario::Scenario;
use hil_protocol::{Configure, ConfigureVerdict, Decoder, MAX_FRAME, Message, encode};
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
        Err(silent(awaited))
    }
}

/// The core has nothing more to say.
fn silent(awaited: &str) -> LinkError {
    LinkError::Silent {
        waiting: "harness",
        awaited: format!("{awaited} from the core"),
        patience: None,
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

    /// A core that has accepted a configuration.
    ///
    /// # Errors
    /// [`LinkError::Refused`] when it does not accept it.
    pub fn configured(configure: &Configure) -> Result<Self, LinkError> {
        let mut link = Self::new();
        link.send(&Message::Hello(own_hello()))?;
        link.receive("hello")?;
        link.send(&Message::Configure(*configure))?;
        let awaited = "the reply to the configuration";
        match link.receive(awaited)? {
            Message::ConfigureReply(reply) if reply.verdict == ConfigureVerdict::Accepted => {
                Ok(link)
            }
            Message::ConfigureReply(reply) => Err(LinkError::Refused(reply.verdict)),
            other => Err(LinkError::Unexpected {
                awaited: awaited.to_owned(),
                id: other.id(),
            }),
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
        Self {
            oracle: Oracle::of(scenario, field),
            ..Self::new()
        }
    }

    /// Sends bytes as they are, without a check.
    pub fn send_bytes(&mut self, bytes: &[u8]) {
        let send = |frame: &[u8]| self.inbox.bytes.extend(frame);
        let advice = Oracle::advice(self.oracle.as_ref());
        self.node.receive_advised(bytes, send, advice);
    }

    /// The core, for inspection.
    #[must_use]
    pub fn node(&self) -> &FlightNode {
        &self.node
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
        reveal(self.oracle.as_mut(), truth, wind)
    }
}

fn reveal(oracle: Option<&mut Oracle>, truth: &VehicleState, wind: Wind) -> Result<(), LinkError> {
    oracle.ok_or(LinkError::NoOracle)?.see(truth, wind);
    Ok(())
}

/// A core in this process that takes and gives messages, without the frames of a wire. A campaign keeps one for each thread,
/// so that its flights share the memory of their cores.
pub struct DirectLink {
    node: Box<FlightNode>,
    oracle: Option<Oracle>,
    inbox: VecDeque<Message>,
}

impl DirectLink {
    /// A fresh core without an oracle.
    #[must_use]
    pub fn new() -> Self {
        Self {
            node: Box::new(FlightNode::new()),
            oracle: None,
            inbox: VecDeque::new(),
        }
    }

    /// A fresh core for a scenario, with its oracle if it has one.
    #[must_use]
    pub fn of(scenario: &Scenario) -> Self {
        Self {
            oracle: advisor(scenario),
            ..Self::new()
        }
    }

    /// Puts a fresh core for a scenario, with its oracle if it has one, in place of the core.
    pub fn restart(&mut self, scenario: &Scenario) {
        *self.node = FlightNode::new();
        self.inbox.clear();
        self.oracle = advisor(scenario);
    }
}

fn advisor(scenario: &Scenario) -> Option<Oracle> {
    let oracle = || Oracle::of(scenario, &scenario.field());
    scenario.is_advised().then(oracle).flatten()
}

impl Link for DirectLink {
    fn send(&mut self, message: &Message) -> Result<(), LinkError> {
        let send = |answer| self.inbox.push_back(answer);
        let advice = Oracle::advice(self.oracle.as_ref());
        self.node.take_advised(message, send, advice);
        Ok(())
    }

    fn receive(&mut self, awaited: &str) -> Result<Message, LinkError> {
        self.inbox.pop_front().ok_or_else(|| silent(awaited))
    }

    fn reveal(&mut self, truth: &VehicleState, wind: Wind) -> Result<(), LinkError> {
        reveal(self.oracle.as_mut(), truth, wind)
    }
}
