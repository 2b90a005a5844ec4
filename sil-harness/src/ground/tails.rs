//! Frames that a station cut: their beginning ends one datagram, and their rest begins the next one.

use hil_protocol::mavlink::Framer;
use std::collections::VecDeque;
use std::net::SocketAddr;

/// Addresses whose last beginning is kept. A new one takes the place of the oldest.
const KEPT: usize = 32;

/// The beginning of a frame that each address sent last.
#[derive(Default)]
pub(super) struct Tails(VecDeque<(SocketAddr, Vec<u8>)>);

impl Tails {
    /// The datagram, behind the beginning that was kept from its address if the two make an intact frame.
    pub(super) fn join(&mut self, peer: SocketAddr, datagram: &[u8]) -> Vec<u8> {
        let kept = self.0.iter().position(|(of, _)| *of == peer);
        let Some((_, tail)) = kept.and_then(|place| self.0.remove(place)) else {
            return datagram.to_vec();
        };
        let joined = [&tail, datagram].concat();
        let first = length(&joined).and_then(|length| joined.get(..length));
        if first.is_some_and(is_frame) {
            joined
        } else {
            datagram.to_vec()
        }
    }

    /// Keeps the beginning of a frame that stands behind the frames of a datagram.
    pub(super) fn keep(&mut self, peer: SocketAddr, datagram: &[u8], frames: &[Vec<u8>]) {
        let mut rest = datagram;
        for frame in frames {
            let place = rest.windows(frame.len()).position(|bytes| bytes == frame);
            rest = place.map_or(rest, |place| &rest[place + frame.len()..]);
        }
        let tails = (0..rest.len()).map(|place| &rest[place..]);
        if let Some(tail) = tails.into_iter().find(|tail| is_cut(tail)) {
            self.0.push_back((peer, tail.to_vec()));
            self.0.drain(..self.0.len().saturating_sub(KEPT));
        }
    }
}

/// The first bytes of frames of MAVLink 1 and 2.
const MAGIC: [u8; 2] = [0xFE, 0xFD];

/// The length of a frame with its header and checksum, and with its signature if it has one.
fn length(frame: &[u8]) -> Option<usize> {
    match *frame {
        [0xFE, payload, ..] => Some(8 + usize::from(payload)),
        [0xFD, payload, flags, ..] => Some(12 + 13 * usize::from(flags & 1) + usize::from(payload)),
        _ => None,
    }
}

fn is_cut(bytes: &[u8]) -> bool {
    bytes.first().is_some_and(|first| MAGIC.contains(first))
        && length(bytes).is_none_or(|length| length > bytes.len())
}

fn is_frame(bytes: &[u8]) -> bool {
    let mut whole = false;
    Framer::new().receive_datagram(bytes, |frame| whole = frame.bytes == bytes);
    whole
}
