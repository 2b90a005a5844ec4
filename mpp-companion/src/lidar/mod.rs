//! Scans of the lidar: frames of our link, or the slice of what a sensor tells by a protocol of its own.

mod livox;
mod mounting;
mod obstacles;
mod packet_error;
mod slice;

pub use mounting::Mounting;
pub(crate) use mounting::Rotation;
pub(crate) use slice::{Pose, Wanted};

use crate::CompanionError;
use crate::clock::SenderClock;
use crate::wire::{Framer, Mav};
use hil_protocol::{Decoder, LidarScan, Message};
use livox::{Flow, Packet};
use mavlink::dialects::common::OBSTACLE_DISTANCE_DATA;
use packet_error::PacketError;
use slice::Slice;

/// A scan that waits longer is not used \[us\].
const OLDEST: u64 = 200_000;
/// For how long the points of a scan were taken \[us\].
const WINDOW: u64 = 100_000;
/// How far from the vertical plane the plane of `OBSTACLE_DISTANCE` may lie \[rad\]: it is flattened into it.
const TILT: f64 = 20.0 * std::f64::consts::PI / 180.0;

/// What sends scans.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ScanSource {
    /// Frames of our link with a `LidarScan`, one or more in a datagram. Their tick is not used: a scan counts as taken when
    /// it came.
    Frames,
    /// `OBSTACLE_DISTANCE`, beside the autopilot's messages or in datagrams of its own.
    Obstacles(Mounting),
    /// Point data of a Livox Mid-360, of which those count that lie so near to the vertical plane of the course \[deg\].
    Livox(Mounting, f64),
}

/// Reads what comes.
enum Reader {
    Frames(Box<Decoder>),
    /// With the distances of the last message.
    Obstacles(Framer, Slice, [u16; 72]),
    Livox(Flow, Slice),
}

/// What went wrong.
#[derive(Debug, Default, PartialEq)]
struct Trouble {
    bad: u32,
    lost: u32,
    late: u32,
    last: Option<PacketError>,
}

/// The newest scan.
pub(crate) struct Lidar {
    reader: Reader,
    newest: Option<(u64, LidarScan)>,
    clock: SenderClock,
    trouble: Trouble,
    /// When the last scan came \[us\].
    pub(crate) heard: Option<u64>,
}

impl Lidar {
    /// A lidar that was not heard yet.
    ///
    /// # Errors
    /// [`CompanionError::Unseen`] when the sensor as it is mounted does not see the vertical plane.
    pub(crate) fn new(source: ScanSource, wanted: Wanted) -> Result<Self, CompanionError> {
        let slice = |mounting: Mounting, within: f64, sees, tells| {
            let slice = Slice {
                mounting: mounting.rotation(),
                within: libm::tan(within),
                sees,
                tells,
                wanted,
                returns: Vec::new(),
            };
            let seen = slice.seen();
            let is_enough = 4 * seen >= 3 * wanted.beams;
            is_enough
                .then_some(slice)
                .ok_or(CompanionError::Unseen(seen, wanted.beams))
        };
        let reader = match source {
            ScanSource::Frames => Reader::Frames(Box::new(Decoder::new())),
            ScanSource::Obstacles(mounting) => {
                let slice = slice(mounting, TILT, [-TILT, TILT], true)?;
                Reader::Obstacles(Framer::default(), slice, [u16::MAX; 72])
            }
            ScanSource::Livox(mounting, within) => {
                if !(0.1..=30.0).contains(&within) {
                    return Err(CompanionError::Mounting(within.to_string()));
                }
                let sees = livox::SEES.map(f64::to_radians);
                let slice = slice(mounting, within.to_radians(), sees, false)?;
                Reader::Livox(Flow::default(), slice)
            }
        };
        Ok(Self {
            reader,
            newest: None,
            clock: SenderClock::default(),
            trouble: Trouble::default(),
            heard: None,
        })
    }

    /// Takes a datagram. Without a pose a point has no place.
    pub(crate) fn receive(&mut self, now: u64, bytes: &[u8], pose: Option<&Pose>) {
        match &mut self.reader {
            Reader::Frames(decoder) => {
                for byte in bytes {
                    match decoder.push(*byte) {
                        Some(Ok(Message::LidarScan(scan))) => {
                            self.newest = Some((now, scan));
                            self.heard = Some(now);
                        }
                        Some(Err(error)) => self.trouble.bad(PacketError::Link(error)),
                        _ => {}
                    }
                }
            }
            Reader::Obstacles(framer, ..) => {
                let mut told = Vec::new();
                framer.receive(bytes, |_, _, message| {
                    if let Mav::OBSTACLE_DISTANCE(one) = message {
                        told.push(one);
                    }
                });
                for one in told {
                    self.hear(now, &one, pose);
                }
            }
            Reader::Livox(flow, slice) => {
                let packet = match Packet::read(bytes) {
                    Ok(packet) => packet,
                    Err(error) => return self.trouble.bad(error),
                };
                let Some(lost) = flow.count(packet.count) else {
                    return;
                };
                self.trouble.lost += lost;
                let sent = self.clock.sent(now, packet.taken);
                let Some(pose) = pose.filter(|_| self.trouble.is_timely(now, sent)) else {
                    return;
                };
                slice.returns.retain(|(at, _)| at + WINDOW >= sent);
                for seen in packet.returns() {
                    slice.add(sent, pose, seen);
                }
                if flow.is_whole(sent, packet.lasted, WINDOW) {
                    self.heard = Some(now);
                }
            }
        }
    }

    /// Takes a message, if such messages are the source.
    pub(crate) fn hear(&mut self, now: u64, told: &OBSTACLE_DISTANCE_DATA, pose: Option<&Pose>) {
        let (Reader::Obstacles(_, slice, last), Some(pose)) = (&mut self.reader, pose) else {
            return;
        };
        // Some senders leave the time out.
        let sent = match told.time_usec {
            0 => now,
            taken => self.clock.sent(now, taken),
        };
        if !self.trouble.is_timely(now, sent) {
            return;
        }
        // The slice of the same distances from another place would look new to the core.
        let frozen = std::mem::replace(last, told.distances) == told.distances;
        if frozen && told.distances.iter().any(|it| *it <= told.max_distance) {
            return self.trouble.bad(PacketError::Repeated);
        }
        slice.returns.clear();
        match obstacles::points(told, slice.step(), |point| slice.add(sent, pose, point)) {
            Err(error) => self.trouble.bad(error),
            Ok(()) => self.heard = Some(now),
        }
    }

    /// Takes the newest scan away, with its age \[us\], unless it is old. Points are put where they are for an aircraft with
    /// this pose at the time `at`: that scan has no age.
    pub(crate) fn take(
        &mut self,
        now: u64,
        at: u64,
        pose: Option<&Pose>,
    ) -> Option<(u64, LidarScan)> {
        let (slice, oldest) = match &self.reader {
            Reader::Frames(_) => {
                let (came, scan) = self.newest.take()?;
                let age = now.saturating_sub(came);
                return (age <= OLDEST).then_some((age, scan));
            }
            Reader::Obstacles(_, slice, _) => (slice, OLDEST),
            // Datagrams go on to come, but not for a whole scan.
            Reader::Livox(_, slice) => (slice, WINDOW / 2),
        };
        let is_old = now.saturating_sub(self.heard?) > oldest;
        let pose = pose.filter(|_| !is_old)?;
        Some((0, slice.scan(at, pose)))
    }

    /// What went wrong since the last question, if anything did.
    pub(crate) fn trouble(&mut self) -> Option<String> {
        let it = std::mem::take(&mut self.trouble);
        let why = |last| format!(", the last one: {last}");
        let why = it.last.map_or(String::new(), why);
        let counts = format!("{} lost, {} late, {} refused", it.lost, it.late, it.bad);
        (it.bad + it.lost + it.late > 0).then(|| format!("lidar messages: {counts}{why}"))
    }
}

impl Trouble {
    fn bad(&mut self, error: PacketError) {
        self.bad += 1;
        self.last = Some(error);
    }

    /// Whether what was sent at this time is not too late.
    fn is_timely(&mut self, now: u64, sent: u64) -> bool {
        let is = now.saturating_sub(sent) <= OLDEST;
        self.late += u32::from(!is);
        is
    }
}

#[cfg(test)]
mod tests;
