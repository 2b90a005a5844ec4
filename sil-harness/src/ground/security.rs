//! Whose commands count.

use hil_protocol::mavlink::{Datagram, Frame, Key, MessageData, Sender, Signer, Verifier};

/// Signs and checks with a key, if there is one.
pub(super) struct Security {
    keys: Option<(Signer, Verifier)>,
    /// Commands and writes that were refused for their signature.
    pub(super) refused: u32,
}

impl Security {
    /// With the time of the first signature [10 us since 2015-01-01].
    pub(super) fn new(key: Option<(Key, u64)>) -> Self {
        let keys = key.map(|(key, time)| {
            let signer = Signer::new(key.clone(), 0, time);
            (signer, Verifier::new(key, time))
        });
        Self { keys, refused: 0 }
    }

    /// A message as it goes out.
    pub(super) fn frame<M: MessageData>(&mut self, sender: &mut Sender, message: &M) -> Datagram {
        match &mut self.keys {
            Some((signer, _)) => sender.signed_frame(message, signer),
            None => sender.frame(message),
        }
    }

    /// Moves the time of signatures on [10 us since 2015-01-01].
    pub(super) fn set_time(&mut self, time: u64) {
        if let Some((signer, verifier)) = &mut self.keys {
            signer.set_time(time);
            verifier.set_time(time);
        }
    }

    /// Whether a frame comes from somebody who holds the key; anybody does if there is none.
    pub(super) fn trusts(&mut self, frame: &Frame<'_>) -> bool {
        match &mut self.keys {
            Some((signer, verifier)) => {
                let trusted = verifier.verify(frame).is_ok();
                // Nobody who was ahead of our clock shall find us a minute behind.
                signer.set_time(verifier.time());
                trusted
            }
            None => true,
        }
    }
}
