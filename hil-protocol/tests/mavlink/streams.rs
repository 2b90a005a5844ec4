//! Streams such as noisy lines and attackers make them.

use super::oracle::{Span, crc, seed};
use hil_protocol::mavlink::messages::*;
use hil_protocol::mavlink::{Key, Sender, Signer, text};
use rand_core::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// A stream, and the intact frames of known messages in it.
#[derive(Default)]
pub(crate) struct Stream {
    pub(crate) bytes: Vec<u8>,
    pub(crate) planted: Vec<Span>,
}

pub(crate) struct Maker(Pcg64Mcg);

impl Maker {
    pub(crate) fn new(seed: u64) -> Self {
        Self(Pcg64Mcg::seed_from_u64(seed))
    }

    pub(crate) fn below(&mut self, limit: usize) -> usize {
        (self.0.next_u32() as usize) % limit
    }

    /// Bytes with far more beginnings of frames than by chance.
    pub(crate) fn malice(&mut self, length: usize) -> Vec<u8> {
        (0..length)
            .map(|_| match self.below(20) {
                0 => 0xFD,
                1 => 0xFE,
                2..6 => self.below(2) as u8,
                _ => self.0.next_u32() as u8,
            })
            .collect()
    }

    /// Any bytes.
    fn noise(&mut self, length: usize) -> Vec<u8> {
        (0..length).map(|_| self.0.next_u32() as u8).collect()
    }

    /// A known message, in one of three envelopes.
    fn known(&mut self) -> Vec<u8> {
        let mut sender = Sender::new(self.below(256) as u8, self.below(256) as u8);
        let float = |maker: &mut Self| f32::from_bits(maker.0.next_u32());
        match self.below(7) {
            0 => sender.frame(&HEARTBEAT_DATA {
                custom_mode: self.0.next_u32(),
                ..HEARTBEAT_DATA::DEFAULT
            }),
            1 => sender.frame(&PARAM_SET_DATA {
                param_id: text("A_NAME"),
                param_value: float(self),
                ..PARAM_SET_DATA::DEFAULT
            }),
            2 => sender.frame(&COMMAND_LONG_DATA {
                command: self.0.next_u32() as u16,
                param1: float(self),
                ..COMMAND_LONG_DATA::DEFAULT
            }),
            3 => {
                let mut scan = MPP_LIDAR_SCAN_DATA::DEFAULT;
                scan.ranges.fill_with(|| self.0.next_u32() as u16);
                sender.frame(&scan)
            }
            4 => sender.frame(&PARAM_REQUEST_LIST_DATA::DEFAULT),
            5 => {
                let mut signer = Signer::new(Key([7; 32]), 0, self.0.next_u64() >> 20);
                let ping = PING_DATA {
                    seq: self.0.next_u32(),
                    ..PING_DATA::DEFAULT
                };
                sender.signed_frame(&ping, &mut signer)
            }
            _ => return self.version_1(),
        }
        .as_bytes()
        .to_vec()
    }

    /// A MAVLink 1 heartbeat.
    fn version_1(&mut self) -> Vec<u8> {
        let mut frame = vec![0xFE, 9, self.below(256) as u8, 255, 190, 0];
        frame.extend((0..9).map(|_| self.0.next_u32() as u8));
        let sum = crc(&frame, 50);
        frame.extend(sum.to_le_bytes());
        frame
    }

    /// A frame of a message that the dialect does not have, full of false beginnings.
    pub(crate) fn unknown(&mut self) -> Vec<u8> {
        let length = self.below(256);
        let mut frame = match self.below(4) {
            0 => vec![0xFE, length as u8, 0, 2, 3, self.unknown_id(256)[0]],
            _ => {
                let id = self.unknown_id(65_536);
                vec![0xFD, length as u8, 0, 0, 1, 2, 3, id[0], id[1], id[2]]
            }
        };
        frame.extend(self.malice(length));
        let sum = crc(&frame, self.below(256) as u8);
        frame.extend(sum.to_le_bytes());
        frame
    }

    fn unknown_id(&mut self, below: usize) -> [u8; 4] {
        loop {
            let id = self.below(below) as u32;
            if seed(id).is_none() {
                return id.to_le_bytes();
            }
        }
    }

    /// A frame that ends where it says, but that is not as it was sent.
    fn damaged(&mut self) -> Vec<u8> {
        let mut frame = if self.below(2) == 0 {
            self.unknown()
        } else {
            self.known()
        };
        let header = if frame[0] == 0xFD { 10 } else { 6 };
        let inside = usize::from(frame[1]) + 2;
        for _ in 0..3 {
            let at = header + self.below(inside);
            frame[at] ^= 1 << self.below(8);
        }
        frame
    }

    /// Frames of known and unknown messages that end where they say. With `damaged`, some of them
    /// have a wrong checksum.
    pub(crate) fn whole(&mut self, pieces: usize, damaged: bool) -> Stream {
        let mut stream = Stream::default();
        for _ in 0..pieces {
            match self.below(if damaged { 5 } else { 4 }) {
                0..3 => {
                    let frame = self.known();
                    stream.plant(&frame);
                }
                3 => stream.bytes.extend(self.unknown()),
                _ => stream.bytes.extend(self.damaged()),
            }
        }
        stream
    }

    /// Frames that are whole, doubled, cut and damaged, with noise between.
    pub(crate) fn mixed(&mut self, pieces: usize) -> Stream {
        let mut stream = Stream::default();
        for _ in 0..pieces {
            let mut frame = self.known();
            match self.below(8) {
                0..3 => stream.plant(&frame),
                3 => {
                    stream.plant(&frame);
                    stream.plant(&frame);
                }
                4 => {
                    // A signed frame that is cut behind its checksum would take the following bytes
                    // for its signature; only the key could tell. The following bytes may also by
                    // chance be the one or two bytes that were cut off.
                    let most = if frame[2] == 1 { 13 } else { 0 } + 3;
                    let length = self.below(frame.len() - most + 1);
                    stream.bytes.extend(&frame[..length]);
                }
                5 => {
                    let most = if frame[0] == 0xFD && frame[2] == 1 {
                        13
                    } else {
                        0
                    };
                    let at = self.below(frame.len() - most);
                    frame[at] ^= 1 << self.below(8);
                    stream.bytes.extend(frame);
                }
                6 => {
                    let frame = self.unknown();
                    let length = if self.below(2) == 0 {
                        frame.len()
                    } else {
                        self.below(frame.len())
                    };
                    stream.bytes.extend(&frame[..length]);
                }
                _ => {
                    let length = self.below(400);
                    let noise = self.noise(length);
                    stream.bytes.extend(noise);
                }
            }
        }
        stream
    }
}

impl Stream {
    fn plant(&mut self, frame: &[u8]) {
        let begin = self.bytes.len();
        self.bytes.extend(frame);
        self.planted.push(begin..self.bytes.len());
    }
}
