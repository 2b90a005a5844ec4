//! Signatures of MAVLink 2. A sender that holds the key may send commands. A signature does not hide the
//! content of a frame.

use super::frame::{Frame, SIGNATURE};
use sha2::{Digest, Sha256};

/// Number of senders whose last time a verifier stores.
const STREAMS: usize = 16;
/// Greatest delay of a new sender behind our own time: a minute in units of 10 us.
const MINUTE: u64 = 6_000_000;

/// The secret key that both ends hold.
#[derive(Clone)]
pub struct Key(pub [u8; 32]);

impl Key {
    /// The key of a passphrase: its SHA-256. Other tools compute the key in the same way.
    #[must_use]
    pub fn of_passphrase(passphrase: &str) -> Self {
        Self(Sha256::digest(passphrase.as_bytes()).into())
    }

    /// The first 48 bits of the SHA-256 of key, frame, link and time.
    fn hash(&self, frame: &[u8], link_and_time: &[u8]) -> [u8; 6] {
        let digest = Sha256::new()
            .chain_update(self.0)
            .chain_update(frame)
            .chain_update(link_and_time)
            .finalize();
        let [a, b, c, d, e, f, ..]: [u8; 32] = digest.into();
        [a, b, c, d, e, f]
    }
}

/// Signs frames to send.
#[derive(Clone)]
pub struct Signer {
    key: Key,
    link: u8,
    time: u64,
}

impl Signer {
    /// A signer whose next signature has the time `time` [10 us since 2015-01-01]. A receiver refuses a new
    /// sender that is more than a minute behind the receiver's own time.
    #[must_use]
    pub const fn new(key: Key, link: u8, time: u64) -> Self {
        Self { key, link, time }
    }

    /// Sets the time, unless the new time is earlier.
    pub fn set_time(&mut self, time: u64) {
        self.time = self.time.max(time);
    }

    /// The signature of a frame that ends with its checksum.
    pub(super) fn sign(&mut self, frame: &[u8]) -> [u8; SIGNATURE] {
        let [a, b, c, d, e, f, ..] = self.time.to_le_bytes();
        let stamp = [self.link, a, b, c, d, e, f];
        // Each frame has a different time, because a receiver accepts no time twice.
        self.time = self.time.saturating_add(1);
        let [h0, h1, h2, h3, h4, h5] = self.key.hash(frame, &stamp);
        [self.link, a, b, c, d, e, f, h0, h1, h2, h3, h4, h5]
    }
}

/// The reason why a signature is not valid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// The frame has no signature.
    #[error("the frame has no signature: give the sender the key")]
    Unsigned,
    /// The signature was made with another key, or for another frame.
    #[error("the signature does not fit key and frame: give the sender this key")]
    WrongKey,
    /// The signature is not newer than the last one of its sender, or a new sender is more than a minute
    /// behind our own time. The frame may be a repetition.
    #[error("the signature is not newer than the last: set the sender's clock")]
    Old,
    /// There are more senders than the verifier can store.
    #[error("more senders sign than are remembered: use fewer of them")]
    TooManySenders,
}

/// Checks the signatures of received frames.
#[derive(Clone)]
pub struct Verifier {
    key: Key,
    newest: u64,
    streams: heapless::Vec<Stream, STREAMS>,
}

#[derive(Clone, PartialEq)]
struct Stream {
    system: u8,
    component: u8,
    link: u8,
    time: u64,
}

impl Verifier {
    /// A verifier at a time [10 us since 2015-01-01].
    #[must_use]
    pub const fn new(key: Key, time: u64) -> Self {
        Self {
            key,
            newest: time,
            streams: heapless::Vec::new(),
        }
    }

    /// Sets the time, unless the new time is earlier.
    pub fn set_time(&mut self, time: u64) {
        self.newest = self.newest.max(time);
    }

    /// The newest time that was set or seen [10 us since 2015-01-01].
    #[must_use]
    pub const fn time(&self) -> u64 {
        self.newest
    }

    /// Checks that the frame is signed with the key and is not a repetition.
    ///
    /// # Errors
    /// [`Refusal`]: the receiver must treat the frame as one from an unknown sender.
    pub fn verify(&mut self, frame: &Frame<'_>) -> Result<(), Refusal> {
        if !frame.is_signed() {
            return Err(Refusal::Unsigned);
        }
        let (content, signature) = frame
            .bytes
            .split_last_chunk::<SIGNATURE>()
            .ok_or(Refusal::Unsigned)?;
        let [link, a, b, c, d, e, f, hash @ ..] = *signature;
        if self.key.hash(content, &[link, a, b, c, d, e, f]) != hash {
            return Err(Refusal::WrongKey);
        }
        let time = u64::from_le_bytes([a, b, c, d, e, f, 0, 0]);
        let known = self.streams.iter_mut().find(|stream| {
            (stream.system, stream.component, stream.link) == (frame.system, frame.component, link)
        });
        match known {
            Some(stream) if time > stream.time => stream.time = time,
            None if time.saturating_add(MINUTE) >= self.newest => self
                .streams
                .push(Stream {
                    system: frame.system,
                    component: frame.component,
                    link,
                    time,
                })
                .map_err(|_| Refusal::TooManySenders)?,
            _ => return Err(Refusal::Old),
        }
        self.newest = self.newest.max(time);
        Ok(())
    }
}
