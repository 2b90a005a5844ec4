//! Finds frames in a stream of bytes.

use super::frame::{Claim, Frame, MAX_FRAME, claim};

/// Size of the buffer: it holds an unknown frame and the frame that follows it.
const ROOM: usize = 2 * MAX_FRAME;

/// Counts of the frames and of other bytes in a stream. A full counter stays at its maximum.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Frames that the framer gave out.
    pub frames: u32,
    /// Skipped frames of messages that the dialect does not have.
    pub unknown: u32,
    /// Beginnings of frames whose checksum was wrong.
    pub damaged: u32,
    /// Bytes that belonged to no frame.
    pub noise: u32,
}

/// Finds the intact frames of known messages in a stream of bytes.
///
/// The framer goes from frame to frame by their lengths, so that bytes inside a frame never count as
/// another frame. If the checksum of a frame is wrong, the framer searches its bytes one by one, so that
/// it loses no frame inside.
///
/// The framer skips a frame of an unknown message if its checksum is right for some message, and if a
/// frame or the end of the stream directly follows it. A frame whose end was lost passes the first test
/// once in 256 times, and the second only if a frame begins at the end that its header states. If it
/// passes both tests, the framer does not see the frames in between. The same bytes could be an unknown
/// message that contains these frames as data, and a receiver without the definition of that message
/// cannot tell the difference. It is safer to miss a command than to obey a command inside other data.
///
/// The framer gives out a frame with its last byte if the frame before it has the length that its header
/// states, be it intact, damaged or unknown. Otherwise noise that looks like the beginning of a frame can
/// delay the frame by at most [`MAX_FRAME`] bytes, or by twice that if the noise looks like a complete
/// unknown frame.
#[derive(Clone, Debug)]
pub struct Framer {
    bytes: [u8; ROOM],
    length: usize,
    /// Place of the end that a damaged frame states in its header. It is the first such place at which a
    /// frame may still begin.
    boundary: Option<usize>,
    /// Place of an intact frame behind a damaged one. The framer judges the bytes before it as if the
    /// stream ended there.
    closed: usize,
    counters: Counters,
}

impl Framer {
    /// A framer at the beginning of a stream.
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

    /// The counters so far.
    #[must_use]
    pub fn counters(&self) -> &Counters {
        &self.counters
    }

    /// Takes in bytes. `take` gets each frame as soon as the framer is certain of it.
    pub fn receive(&mut self, bytes: &[u8], mut take: impl FnMut(&Frame<'_>)) {
        for byte in bytes {
            // There is always room, because `sift` never waits for more bytes than the buffer holds.
            if let Some(next) = self.bytes.get_mut(self.length) {
                *next = *byte;
                self.length += 1;
            }
            self.sift(false, &mut take);
        }
    }

    /// Takes in a datagram. A frame does not continue from one datagram into the next, so the stream ends
    /// before and after the datagram.
    pub fn receive_datagram(&mut self, bytes: &[u8], mut take: impl FnMut(&Frame<'_>)) {
        self.end(&mut take);
        self.receive(bytes, &mut take);
        self.end(&mut take);
    }

    /// Ends the stream: no more bytes come that could complete a frame.
    pub fn end(&mut self, mut take: impl FnMut(&Frame<'_>)) {
        self.sift(true, &mut take);
        (self.boundary, self.closed) = (None, 0);
    }

    /// Judges the bytes from the first one on, as far as possible, and drops the judged bytes.
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
            let (step, counter) = match check(rest, ended) {
                FrameCheck::Wait => break,
                FrameCheck::Frame(frame) => {
                    take(&frame);
                    (frame.bytes.len(), &mut self.counters.frames)
                }
                FrameCheck::Unknown(length) => (length, &mut self.counters.unknown),
                FrameCheck::Damaged(length) => {
                    self.boundary.get_or_insert(start + length);
                    (1, &mut self.counters.damaged)
                }
                FrameCheck::Noise => (1, &mut self.counters.noise),
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

    /// Checks whether an intact frame begins at the end of a damaged frame, or behind further damaged or
    /// unknown frames that follow it. If so, it sets `closed`.
    fn look_ahead(&mut self, start: usize) {
        // Each step moves forward by the length of a frame, so the loop ends.
        while let Some(at) = self.boundary {
            let next = match self.bytes.get(at..self.length) {
                // The search has passed this place, or has reached it and judges it like any other byte.
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

enum FrameCheck<'a> {
    /// The framer needs more bytes to decide.
    Wait,
    Noise,
    Damaged(usize),
    Unknown(usize),
    Frame(Frame<'a>),
}

fn check(bytes: &[u8], ended: bool) -> FrameCheck<'_> {
    match claim(bytes) {
        Claim::No => FrameCheck::Noise,
        Claim::Damaged(length) => FrameCheck::Damaged(length),
        Claim::Intact(frame) => FrameCheck::Frame(frame),
        Claim::Incomplete if ended => FrameCheck::Noise,
        Claim::Incomplete => FrameCheck::Wait,
        Claim::Unknown(length) => match is_followed(bytes.get(length..), ended) {
            None => FrameCheck::Wait,
            Some(true) => FrameCheck::Unknown(length),
            Some(false) => FrameCheck::Damaged(length),
        },
    }
}

/// Whether the bytes after an unknown frame confirm it; `None` if more bytes are needed.
fn is_followed(next: Option<&[u8]>, ended: bool) -> Option<bool> {
    // The end of a stream confirms the frame as well as another frame does.
    let Some(next @ [_, ..]) = next else {
        return ended.then_some(true);
    };
    match claim(next) {
        Claim::No | Claim::Damaged(_) => Some(false),
        Claim::Intact(_) | Claim::Unknown(_) => Some(true),
        Claim::Incomplete => ended.then_some(true),
    }
}
