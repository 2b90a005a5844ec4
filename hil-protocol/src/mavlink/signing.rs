//! Signatures of MAVLink 2: who holds the key may command. They hide nothing.

use super::frame::{Frame, SIGNATURE};
use sha2::{Digest, Sha256};

/// Senders whose time is remembered.
const STREAMS: usize = 16;
/// A minute in units of 10 us: how far behind our own time a new sender may be.
const MINUTE: u64 = 6_000_000;

/// The secret that both ends hold.
#[derive(Clone)]
pub struct Key(pub [u8; 32]);

impl Key {
    /// The key of a passphrase: its SHA-256, as other tools make it.
    #[must_use]
    pub fn of_passphrase(passphrase: &str) -> Self {
        Self(Sha256::digest(passphrase.as_bytes()).into())
    }

    /// First 48 bits of SHA-256 over key, frame, link and time.
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

/// Signs what is sent.
#[derive(Clone)]
pub struct Signer {
    key: Key,
    link: u8,
    time: u64,
}

impl Signer {
    /// With the time of the next signature [10 us since 2015-01-01]; a receiver refuses what is a
    /// minute behind its own.
    #[must_use]
    pub const fn new(key: Key, link: u8, time: u64) -> Self {
        Self { key, link, time }
    }

    /// Moves the time on; it never goes back.
    pub fn set_time(&mut self, time: u64) {
        self.time = self.time.max(time);
    }

    /// The signature of a frame that ends with its checksum.
    pub(super) fn sign(&mut self, frame: &[u8]) -> [u8; SIGNATURE] {
        let [a, b, c, d, e, f, ..] = self.time.to_le_bytes();
        let stamp = [self.link, a, b, c, d, e, f];
        // Each frame a time of its own: a receiver takes none twice.
        self.time = self.time.saturating_add(1);
        let [h0, h1, h2, h3, h4, h5] = self.key.hash(frame, &stamp);
        [self.link, a, b, c, d, e, f, h0, h1, h2, h3, h4, h5]
    }
}

/// Why a signature does not count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Refusal {
    /// There is none.
    Unsigned,
    /// It was made with another key, or for another frame.
    WrongKey,
    /// It is not newer than the last one of its sender, or a minute old: a repetition.
    Old,
    /// More senders than are remembered.
    TooManySenders,
}

/// Checks what is received.
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
    /// At a time [10 us since 2015-01-01].
    #[must_use]
    pub const fn new(key: Key, time: u64) -> Self {
        Self {
            key,
            newest: time,
            streams: heapless::Vec::new(),
        }
    }

    /// Moves the time on; it never goes back.
    pub fn set_time(&mut self, time: u64) {
        self.newest = self.newest.max(time);
    }

    /// The newest time that was set or seen [10 us since 2015-01-01].
    #[must_use]
    pub const fn time(&self) -> u64 {
        self.newest
    }

    /// Whether the frame is signed with the key and is no repetition.
    ///
    /// # Errors
    /// [`Refusal`]: the frame is to be treated as if anybody had sent it.
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
