//! Finds frames in a stream of bytes.

use super::frame::{Claim, Frame, MAX_FRAME, claim};

/// Two frames that cannot be checked, and the first byte of one behind them.
const ROOM: usize = 2 * MAX_FRAME + 1;

/// What a stream held besides frames. Full counters stay full.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Frames given out.
    pub frames: u32,
    /// Frames of messages that the dialect does not have, passed over.
    pub unknown: u32,
    /// Beginnings of frames whose checksum was wrong.
    pub damaged: u32,
    /// Bytes that belonged to no frame.
    pub noise: u32,
}

/// Finds the intact frames of known messages in a stream of bytes.
///
/// It goes from length to length: what lies inside a frame is never taken for another. A frame
/// whose checksum is wrong is gone through byte by byte, so that nothing is lost with it.
///
/// The checksum of an unknown message cannot be checked. Such a frame is passed over only if an
/// intact frame, or another unknown one that ends where a frame begins, follows it at once; else
/// its inside is gone through too. So an unknown frame holds up nothing, and noise that looks like
/// one hides nothing.
///
/// Noise can hold up a frame, but not by more than [`MAX_FRAME`] bytes, or twice that if it looks
/// like an unknown frame.
#[derive(Clone, Debug)]
pub struct Framer {
    bytes: [u8; ROOM],
    length: usize,
    counters: Counters,
}

impl Framer {
    /// At the beginning of a stream.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            bytes: [0; ROOM],
            length: 0,
            counters: Counters {
                frames: 0,
                unknown: 0,
                damaged: 0,
                noise: 0,
            },
        }
    }

    /// What was found so far.
    #[must_use]
    pub fn counters(&self) -> &Counters {
        &self.counters
    }

    /// Takes in bytes; `take` gets every frame, as soon as it is certain.
    pub fn receive(&mut self, bytes: &[u8], mut take: impl FnMut(&Frame<'_>)) {
        for byte in bytes {
            // There is room: `sift` waits for no more than that.
            if let Some(next) = self.bytes.get_mut(self.length) {
                *next = *byte;
                self.length += 1;
            }
            self.sift(false, &mut take);
        }
    }

    /// Takes in a datagram: what was begun before it is at an end, and so is what it leaves
    /// unfinished.
    pub fn receive_datagram(&mut self, bytes: &[u8], mut take: impl FnMut(&Frame<'_>)) {
        self.end(&mut take);
        self.receive(bytes, &mut take);
        self.end(&mut take);
    }

    /// Ends the stream: nothing more comes that could complete what was begun.
    pub fn end(&mut self, mut take: impl FnMut(&Frame<'_>)) {
        self.sift(true, &mut take);
    }

    /// Goes on from the first byte as far as it can be judged, and drops what was.
    fn sift(&mut self, ended: bool, take: &mut impl FnMut(&Frame<'_>)) {
        let mut start = 0;
        while let Some(rest @ [_, ..]) = self.bytes.get(start..self.length) {
            let (step, counter) = match verdict(rest, ended) {
                Verdict::Wait => break,
                Verdict::Frame(frame) => {
                    take(&frame);
                    (frame.bytes.len(), &mut self.counters.frames)
                }
                Verdict::Unknown(length) => (length, &mut self.counters.unknown),
                Verdict::Damaged => (1, &mut self.counters.damaged),
                Verdict::Noise => (1, &mut self.counters.noise),
            };
            *counter = counter.saturating_add(1);
            start += step;
        }
        if start > 0 {
            self.bytes.copy_within(start..self.length, 0);
            self.length -= start;
        }
    }
}

impl Default for Framer {
    fn default() -> Self {
        Self::new()
    }
}

enum Verdict<'a> {
    /// It takes more bytes to tell.
    Wait,
    Noise,
    Damaged,
    Unknown(usize),
    Frame(Frame<'a>),
}

fn verdict(bytes: &[u8], ended: bool) -> Verdict<'_> {
    match claim(bytes) {
        Claim::No => Verdict::Noise,
        Claim::Damaged => Verdict::Damaged,
        Claim::Intact(frame) => Verdict::Frame(frame),
        Claim::Incomplete if ended => Verdict::Noise,
        Claim::Incomplete => Verdict::Wait,
        Claim::Unknown(length) => match follower(bytes, length, ended) {
            None => Verdict::Wait,
            Some(true) => Verdict::Unknown(length),
            Some(false) => Verdict::Noise,
        },
    }
}

/// Whether what follows an unknown frame speaks for it; none: too early to tell.
fn follower(bytes: &[u8], length: usize, ended: bool) -> Option<bool> {
    match bytes.get(length..) {
        // Its own end has not come.
        None => ended.then_some(false),
        // The end of a stream is as good as a frame.
        Some([]) => ended.then_some(true),
        Some(next) => match claim(next) {
            Claim::No | Claim::Damaged => Some(false),
            Claim::Intact(_) => Some(true),
            Claim::Incomplete => ended.then_some(false),
            Claim::Unknown(second) => match next.get(second..) {
                None => ended.then_some(false),
                Some([]) => ended.then_some(true),
                Some(third) => Some(!matches!(claim(third), Claim::No)),
            },
        },
    }
}
