//! Sends messages to those that get them.

use super::channels::Channel;
use super::demands::Address;
use super::vehicle::Vehicle;
use hil_protocol::mavlink::MessageData;

impl Vehicle {
    /// Sends a message to all, or to those at which a stream is due if it is the turn of one.
    pub(super) fn send<M: MessageData>(&mut self, message: &M) {
        self.send_where(message, true, |_| true);
    }

    /// Sends what is new to those who want it.
    pub(super) fn send_event<M: MessageData>(&mut self, message: &M) {
        self.send_where(message, true, |channel| channel.streams.wants(M::ID));
    }

    /// Sends what is meant for one station to its address, or to all that share its channel.
    pub(super) fn send_to_station<M: MessageData>(&mut self, message: &M, to: Address) {
        let key = self.channels.key(to.peer);
        self.send_where(message, true, |channel| channel.peer == key);
    }

    /// Sends a message to some channels. `record` says whether it goes to the recording, too.
    pub(super) fn send_where<M: MessageData>(
        &mut self,
        message: &M,
        record: bool,
        who: impl Fn(&Channel) -> bool,
    ) {
        let Self {
            channels, security, ..
        } = self;
        channels.send(message, security, record, who);
    }
}
