//! Scans of the lidar: frames of our link with a `LidarScan`, one or more in a datagram. Their tick is not used: a scan
//! counts as taken when it came.

use hil_protocol::{Decoder, LidarScan, Message};

/// A scan that waits longer is not used \[us\].
const OLDEST: u64 = 200_000;

/// The newest scan.
pub(crate) struct Lidar {
    decoder: Decoder,
    newest: Option<(u64, LidarScan)>,
    /// When the last scan came \[us\].
    pub(crate) heard: Option<u64>,
}

impl Lidar {
    pub(crate) fn new() -> Self {
        Self {
            decoder: Decoder::new(),
            newest: None,
            heard: None,
        }
    }

    /// Takes a datagram.
    pub(crate) fn receive(&mut self, now: u64, bytes: &[u8]) {
        for byte in bytes {
            if let Some(Ok(Message::LidarScan(scan))) = self.decoder.push(*byte) {
                self.newest = Some((now, scan));
                self.heard = Some(now);
            }
        }
    }

    /// Takes the newest scan away, with its age \[us\], unless it is old.
    pub(crate) fn take(&mut self, now: u64) -> Option<(u64, LidarScan)> {
        let (came, scan) = self.newest.take()?;
        let age = now.saturating_sub(came);
        (age <= OLDEST).then_some((age, scan))
    }
}
