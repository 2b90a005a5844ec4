//! The addresses to which the vehicle sends. An address that asks for something of its own gets a channel: its own rates,
//! its own numbering of frames, and its own form of parameters. All others share the first channel.

use super::demands::Address;
use super::security::Security;
use super::streams::{self, Streams};
use hil_protocol::mavlink::{Datagram, MessageData, Sender};
use std::net::SocketAddr;

/// Channels at most, with the shared one. An address beyond them cannot have rates of its own.
const CHANNELS: usize = 32;

/// A frame on its way.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Outgoing {
    /// The frame for the recording, numbered among those of the recording, without a signature. It is `None` if the
    /// recording has the same message in another form.
    pub plain: Option<Datagram>,
    /// The frame for each channel that gets it: for an address with a channel of its own, or for all others (`None`).
    pub wire: Vec<(Option<SocketAddr>, Datagram)>,
}

/// What an address is sent.
pub(super) struct Channel {
    /// The address; `None` stands for all that have no channel of their own.
    pub(super) peer: Option<SocketAddr>,
    sender: Sender,
    pub(super) streams: Streams,
    /// System and component that spoke last.
    station: (u8, u8),
    /// Whether whole numbers among the parameters are sent as such.
    pub(super) typed: bool,
}

/// All channels, and the frames that are on their way.
pub(super) struct Channels {
    recorder: Sender,
    /// The first one is the shared one.
    all: Vec<Channel>,
    outbox: Vec<Outgoing>,
    turn: Turn,
}

/// Who gets what is sent meanwhile.
#[derive(Clone, Copy)]
pub(super) enum Turn {
    All,
    /// The channels at which this stream is due at this tick.
    Stream(u32, u32),
    /// The address that asked.
    Peer(SocketAddr),
}

impl Channels {
    /// The shared channel alone.
    pub(super) fn new(sender: &Sender) -> Self {
        let shared = Channel {
            peer: None,
            sender: sender.clone(),
            streams: Streams::new(),
            station: (0, 0),
            typed: false,
        };
        Self {
            recorder: sender.clone(),
            all: vec![shared],
            outbox: Vec::new(),
            turn: Turn::All,
        }
    }

    /// The key of an address in [`Outgoing::wire`].
    pub(super) fn key(&self, peer: SocketAddr) -> Option<SocketAddr> {
        let mut keys = self.all.iter().map(|channel| channel.peer);
        keys.find(|key| *key == Some(peer)).flatten()
    }

    /// The channel that an address has now.
    pub(super) fn of(&self, peer: SocketAddr) -> Option<&Channel> {
        let key = self.key(peer);
        self.all.iter().find(|channel| channel.peer == key)
    }

    /// The channel of an address alone, which is made if there is none; `None` if there are too many.
    pub(super) fn own(&mut self, from: Address) -> Option<&mut Channel> {
        if self.key(from.peer).is_none() && self.all.len() < CHANNELS {
            self.split(from);
        }
        self.all
            .iter_mut()
            .find(|channel| channel.peer == Some(from.peer))
    }

    /// Gives an address a channel that goes on where the shared one is.
    fn split(&mut self, from: Address) {
        let Some(shared) = self.all.first() else {
            return;
        };
        let own = Channel {
            peer: Some(from.peer),
            sender: shared.sender.clone(),
            streams: Streams::new(),
            station: (from.system, from.component),
            typed: false,
        };
        self.all.push(own);
        // What is on its way to all is on its way to this address, too.
        for frame in &mut self.outbox {
            let shared = frame.wire.iter().find(|(to, _)| to.is_none()).cloned();
            let own = shared.map(|(_, datagram)| (Some(from.peer), datagram));
            frame.wire.extend(own);
        }
    }

    /// Takes note of who speaks at an address. Another station has not asked for the form of parameters.
    pub(super) fn hear(&mut self, from: Address) {
        let station = (from.system, from.component);
        let mut all = self.all.iter_mut();
        if let Some(channel) = all.find(|channel| channel.peer == Some(from.peer))
            && channel.station != station
        {
            channel.station = station;
            channel.typed = false;
        }
    }

    /// Gives up the channels of addresses that are gone.
    pub(super) fn keep(&mut self, is_there: impl Fn(&SocketAddr) -> bool) {
        self.all
            .retain(|channel| channel.peer.as_ref().is_none_or(&is_there));
    }

    /// The streams that are due at a tick at any channel.
    pub(super) fn due(&self, tick: u32) -> Vec<u32> {
        streams::ids()
            .filter(|id| self.any(|channel| channel.streams.is_due(*id, tick)))
            .collect()
    }

    /// Sets who gets what is sent from now on.
    pub(super) fn set_turn(&mut self, turn: Turn) {
        self.turn = turn;
    }

    pub(super) fn any(&self, who: impl Fn(&Channel) -> bool) -> bool {
        self.all.iter().any(who)
    }

    /// Sends a message to some channels. `record` says whether it goes to the recording, too.
    pub(super) fn send<M: MessageData>(
        &mut self,
        message: &M,
        security: &mut Security,
        record: bool,
        who: impl Fn(&Channel) -> bool,
    ) {
        let turn = self.turn;
        let is_due = |channel: &Channel| match turn {
            Turn::All => true,
            Turn::Stream(id, tick) => channel.streams.is_due(id, tick),
            Turn::Peer(peer) => channel.peer == Some(peer),
        };
        let mut wire = Vec::new();
        for channel in self.all.iter_mut() {
            if is_due(channel) && who(channel) {
                let datagram = security.frame(&mut channel.sender, message);
                wire.push((channel.peer, datagram));
            }
        }
        // A recording has what nobody asked for, too.
        if record || !wire.is_empty() {
            let plain = record.then(|| self.recorder.frame(message));
            self.outbox.push(Outgoing { plain, wire });
        }
    }

    pub(super) fn take_outgoing(&mut self) -> Vec<Outgoing> {
        std::mem::take(&mut self.outbox)
    }
}
