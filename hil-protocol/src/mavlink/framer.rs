//! Finds frames in a stream of bytes.

use super::frame::{Claim, Frame, MAX_FRAME, claim};

/// An unknown frame, and what follows it.
const ROOM: usize = 2 * MAX_FRAME;

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
/// A frame of an unknown message is passed over if its checksum is right for some message and a
/// frame, or the stream's end, follows it at once. One whose end was lost looks like that once in
/// 256 times, and then only if a frame begins where it says that its own end is. If both hold, the
/// frames in between stay unseen: the same bytes could be an unknown message that carries them,
/// and no receiver without its definition can tell. It is better to miss an order than to obey one
/// that somebody carries past.
///
/// A frame is given out with its last byte if what goes before it ends where it says, intact,
/// damaged or unknown. Else noise that looks like the beginning of a frame can hold it up, by no
/// more than [`MAX_FRAME`] bytes, or twice that if it looks like an unknown frame to its end.
#[derive(Clone, Debug)]
pub struct Framer {
    bytes: [u8; ROOM],
    length: usize,
    /// Where a damaged frame says that its end is; the first one that nothing speaks against yet.
    boundary: Option<usize>,
    /// Up to here everything is judged as if the stream ended here: an intact frame follows.
    closed: usize,
    counters: Counters,
}

impl Framer {
    /// At the beginning of a stream.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            bytes: [0; ROOM],
            length: 0,
            boundary: None,
            closed: 0,
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
        (self.boundary, self.closed) = (None, 0);
    }

    /// Goes on from the first byte as far as it can be judged, and drops what was.
    fn sift(&mut self, ended: bool, take: &mut impl FnMut(&Frame<'_>)) {
        let mut start = 0;
        loop {
            self.look_ahead(start);
            let (end, ended) = if start < self.closed {
                (self.closed, true)
            } else {
                (self.length, ended)
            };
            let Some(rest @ [_, ..]) = self.bytes.get(start..end) else {
                break;
            };
            let (step, counter) = match verdict(rest, ended) {
                Verdict::Wait => break,
                Verdict::Frame(frame) => {
                    take(&frame);
                    (frame.bytes.len(), &mut self.counters.frames)
                }
                Verdict::Unknown(length) => (length, &mut self.counters.unknown),
                Verdict::Damaged(length) => {
                    self.boundary.get_or_insert(start + length);
                    (1, &mut self.counters.damaged)
                }
                Verdict::Noise => (1, &mut self.counters.noise),
            };
            *counter = counter.saturating_add(1);
            start += step;
        }
        if start > 0 {
            self.bytes.copy_within(start..self.length, 0);
            self.length -= start;
            self.closed = self.closed.saturating_sub(start);
            self.boundary = self.boundary.and_then(|at| at.checked_sub(start));
        }
    }

    /// Whether an intact frame begins where a damaged one, and perhaps others behind it, ends.
    fn look_ahead(&mut self, start: usize) {
        // Each step leads on by the length of a frame.
        while let Some(at) = self.boundary {
            let next = match self.bytes.get(at..self.length) {
                // It was passed, or reached and will be judged as any byte.
                _ if at <= start => return self.boundary = None,
                None | Some([]) => return,
                Some(next) => next,
            };
            self.boundary = match claim(next) {
                Claim::Incomplete => return,
                Claim::Damaged(length) | Claim::Unknown(length) => Some(at + length),
                Claim::Intact(_) => {
                    self.closed = at;
                    None
                }
                Claim::No => None,
            };
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
    Damaged(usize),
    Unknown(usize),
    Frame(Frame<'a>),
}

fn verdict(bytes: &[u8], ended: bool) -> Verdict<'_> {
    match claim(bytes) {
        Claim::No => Verdict::Noise,
        Claim::Damaged(length) => Verdict::Damaged(length),
        Claim::Intact(frame) => Verdict::Frame(frame),
        Claim::Incomplete if ended => Verdict::Noise,
        Claim::Incomplete => Verdict::Wait,
        Claim::Unknown(length) => match is_followed(bytes.get(length..), ended) {
            None => Verdict::Wait,
            Some(true) => Verdict::Unknown(length),
            Some(false) => Verdict::Damaged(length),
        },
    }
}

/// Whether what follows an unknown frame speaks for it; none: too early to tell.
fn is_followed(next: Option<&[u8]>, ended: bool) -> Option<bool> {
    // The end of a stream is as good as a frame.
    let Some(next @ [_, ..]) = next else {
        return ended.then_some(true);
    };
    match claim(next) {
        Claim::No | Claim::Damaged(_) => Some(false),
        Claim::Intact(_) | Claim::Unknown(_) => Some(true),
        Claim::Incomplete => ended.then_some(true),
    }
}
