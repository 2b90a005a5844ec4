//! The core in space in the harness's own process, behind a pipe of bytes.

use super::SpaceScenario;
use super::baseline::Baseline;
use crate::link::{Link, LinkError};
use crate::pipe::Inbox;
use hil_protocol::{MAX_FRAME, Message, encode};
use mpp_node::SpaceNode;

/// Stack of a thread that flies in space \[bytes\]: the core is built on it before it moves to its box.
pub const STACK: usize = 32 << 20;

/// A core in space in this process, in a box.
pub struct SpacePipe {
    node: Box<SpaceNode>,
    baseline: Option<Baseline>,
    inbox: Inbox,
}

impl SpacePipe {
    /// A fresh core for a scenario, with its baseline in place of the planner if it has one.
    #[must_use]
    pub fn of(scenario: &SpaceScenario) -> Self {
        Self {
            node: Box::new(SpaceNode::new()),
            baseline: scenario.baseline(),
            inbox: Inbox::new(),
        }
    }

    /// The core, for inspection.
    #[must_use]
    pub fn node(&self) -> &SpaceNode {
        &self.node
    }
}

impl Link for SpacePipe {
    fn send(&mut self, message: &Message) -> Result<(), LinkError> {
        let mut buffer = [0; MAX_FRAME];
        let frame = encode(message, &mut buffer)?;
        let send = |frame: &[u8]| self.inbox.bytes.extend(frame);
        self.node.receive(frame, send);
        if let Some(baseline) = &mut self.baseline {
            baseline.follow(message, &mut self.node);
        }
        Ok(())
    }

    fn receive(&mut self, awaited: &str) -> Result<Message, LinkError> {
        self.inbox.receive(awaited)
    }
}
