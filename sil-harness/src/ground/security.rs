//! Signatures. With a key, only commands from holders of the key count.

use super::heard::{self, Heard, MINUTE};
use hil_protocol::mavlink::{Datagram, Frame, Key, MessageData, Sender, Signer, Verifier};

/// Link, time and hash at the end of a signed frame.
const SIGNATURE: usize = 13;

/// Signs and checks with a key, if there is one.
pub(super) struct Security {
    keys: Option<Keys>,
    /// Number of commands and writes that were refused because of their signature.
    pub(super) refused: u32,
}

struct Keys {
    signer: Signer,
    verifier: Verifier,
    /// Our own clock [10 us since 2015-01-01]. Received signatures do not move it.
    clock: u64,
    /// What was believed, in earlier flights too.
    heard: Heard,
}

impl Security {
    /// Takes the key, if there is one, and the time of the first signature
    /// [10 us since 2015-01-01].
    pub(super) fn new(key: Option<(Key, u64)>) -> Self {
        let keys = key.map(|(key, time)| Keys {
            signer: Signer::new(key.clone(), 0, time),
            verifier: Verifier::new(key, time),
            clock: time,
            heard: Heard::default(),
        });
        Self { keys, refused: 0 }
    }

    /// Believes nothing that is not newer than this.
    pub(super) fn remember(&mut self, heard: &Heard) {
        if let Some(keys) = &mut self.keys {
            keys.heard.merge(heard);
        }
    }

    /// The newest times that were believed; none without a key.
    pub(super) fn heard(&self) -> Option<&Heard> {
        self.keys.as_ref().map(|keys| &keys.heard)
    }

    /// The frame of an outgoing message.
    pub(super) fn frame<M: MessageData>(&mut self, sender: &mut Sender, message: &M) -> Datagram {
        match &mut self.keys {
            Some(keys) => sender.signed_frame(message, &mut keys.signer),
            None => sender.frame(message),
        }
    }

    /// Advances the time of signatures [10 us since 2015-01-01].
    pub(super) fn set_time(&mut self, time: u64) {
        if let Some(keys) = &mut self.keys {
            keys.clock = keys.clock.max(time);
            keys.signer.set_time(time);
            keys.verifier.set_time(time);
        }
    }

    /// Whether a frame comes from a holder of the key. Without a key every frame is trusted.
    pub(super) fn trusts(&mut self, frame: &Frame<'_>) -> bool {
        self.keys.as_mut().is_none_or(|keys| keys.trust(frame))
    }
}

impl Keys {
    fn trust(&mut self, frame: &Frame<'_>) -> bool {
        let Some((sender, time)) = stamp(frame) else {
            return false;
        };
        // A time from far ahead would make every later signature too old.
        if time > self.clock.saturating_add(MINUTE) || !self.heard.is_news(sender, time) {
            return false;
        }
        let trusted = self.verifier.verify(frame).is_ok();
        if trusted {
            self.heard.note(sender, time);
        }
        // A station whose clock is ahead must not see our signatures as a minute late.
        self.signer.set_time(self.verifier.time());
        trusted
    }
}

/// Who signed a frame and when, by what the frame says.
fn stamp(frame: &Frame<'_>) -> Option<(heard::Sender, u64)> {
    let (_, signature) = frame.bytes.split_last_chunk::<SIGNATURE>()?;
    let [link, a, b, c, d, e, f, ..] = *signature;
    let time = u64::from_le_bytes([a, b, c, d, e, f, 0, 0]);
    let sender = (frame.system, frame.component, link);
    frame.is_signed().then_some((sender, time))
}
