//! The core in space in the harness's own process, behind a pipe of bytes.

use crate::link::{Link, LinkError};
use crate::pipe::Inbox;
use hil_protocol::{MAX_FRAME, Message, encode};
use mpp_node::SpaceNode;

/// A core in space in this process. It is built on the stack, of which the thread needs 32 MB, and then lies in a box.
pub struct SpacePipe {
    node: Box<SpaceNode>,
    inbox: Inbox,
}

impl SpacePipe {
    /// A fresh core.
    #[must_use]
    pub fn new() -> Self {
        Self {
            node: Box::new(SpaceNode::new()),
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
        Ok(())
    }

    fn receive(&mut self, awaited: &str) -> Result<Message, LinkError> {
        self.inbox.receive(awaited)
    }
}
