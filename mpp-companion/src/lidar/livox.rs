//! Point data of a Livox Mid-360: a header, and points of which each ends with reflectivity and tag.
//!
//! Source: "Livox LiDAR Communication Protocol - Mid360", v1.4.11: "Point Cloud & IMU Data Protocol" (offsets, data types, tag)
//! and "CRC Algorithm". All is little-endian. Elevations: user manual.

use super::packet_error::PacketError;
use crc::{CRC_32_ISO_HDLC, Crc};
use std::collections::VecDeque;

const HEADER: usize = 36;
/// Where the time stands, and what the checksum covers begins.
const TIME: usize = 28;
const SUM: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);
/// Elevations that it sees \[deg\].
pub(crate) const SEES: [f64; 2] = [-7.0, 52.0];

/// How a point is written.
#[derive(Clone, Copy, Debug)]
enum Format {
    Millimetres,
    Centimetres,
    Spherical,
}

/// A datagram.
#[derive(Clone, Debug)]
pub(crate) struct Packet<'a> {
    /// Its number. The protocol says that it begins anew with each frame; sensors are said to count on.
    pub(crate) count: u16,
    /// When its first point was taken, by a clock of the sensor \[us\].
    pub(crate) taken: u64,
    /// For how long the sensor took its points \[us\].
    pub(crate) lasted: u64,
    format: Format,
    points: &'a [u8],
}

/// Bytes at an offset; zeros beyond the end.
fn field<const N: usize>(bytes: &[u8], at: usize) -> [u8; N] {
    let rest = bytes.get(at..).unwrap_or_default();
    rest.first_chunk().copied().unwrap_or([0; N])
}

impl<'a> Packet<'a> {
    /// Reads a datagram.
    ///
    /// # Errors
    /// [`PacketError`].
    pub(crate) fn read(bytes: &'a [u8]) -> Result<Self, PacketError> {
        let came = bytes.len();
        let data = bytes.get(HEADER..).ok_or(PacketError::Short(came))?;
        let number = |at| u16::from_le_bytes(field(bytes, at));
        let [told, interval, points, count] = [1, 3, 5, 7].map(number);
        let [version, data_type, time_type] = [0, 10, 11].map(|at| field::<1>(bytes, at)[0]);
        let format = match data_type {
            1 => Format::Millimetres,
            2 => Format::Centimetres,
            3 => Format::Spherical,
            _ => return Err(PacketError::Field("data type", data_type, "1, 2 or 3")),
        };
        if version != 0 {
            return Err(PacketError::Field("version", version, "0"));
        }
        if time_type > 2 {
            return Err(PacketError::Field("time type", time_type, "0, 1 or 2"));
        }
        if usize::from(told) != came || data.len() != usize::from(points) * format.size() {
            return Err(PacketError::Length { told, points, came });
        }
        // Livox's own SDK does not check it, and sensors are said to leave it 0. The datagram has UDP's sum beside it.
        let sum = u32::from_le_bytes(field(bytes, 24));
        if sum != 0 && sum != SUM.checksum(bytes.get(TIME..).unwrap_or_default()) {
            return Err(PacketError::Checksum);
        }
        // The time to the first point of the next datagram counts too.
        let gaps = u64::from(points.saturating_sub(1).max(1));
        Ok(Self {
            count,
            taken: u64::from_le_bytes(field(bytes, TIME)) / 1000,
            lasted: u64::from(interval) * u64::from(points) / gaps / 10,
            format,
            points: data,
        })
    }

    /// The returns: ahead, to the right and down by the axes of the sensor \[m\]. A point at the middle is a beam without a
    /// return. A point of low confidence (glued edge, rain, fog, dust) is none.
    pub(crate) fn returns(&self) -> impl Iterator<Item = [f64; 3]> {
        let points = self.points.chunks_exact(self.format.size());
        points.filter_map(|point| {
            let [.., tag] = point else { return None };
            let is_sure = [0, 2, 4].iter().all(|bit| (tag >> bit) & 3 < 2);
            // x ahead, y to the left, z up.
            let [x, y, z] = self.format.place(point);
            (is_sure && [x, y, z].iter().any(|it| it.abs() > 0.0)).then_some([x, -y, -z])
        })
    }
}

impl Format {
    /// Size of a point \[bytes\].
    const fn size(self) -> usize {
        match self {
            Self::Millimetres => 14,
            Self::Centimetres => 8,
            Self::Spherical => 10,
        }
    }

    /// x, y and z of a point \[m\].
    fn place(self, point: &[u8]) -> [f64; 3] {
        match self {
            Self::Millimetres => {
                [0, 4, 8].map(|at| 1e-3 * f64::from(i32::from_le_bytes(field(point, at))))
            }
            Self::Centimetres => {
                [0, 2, 4].map(|at| 1e-2 * f64::from(i16::from_le_bytes(field(point, at))))
            }
            Self::Spherical => {
                let depth = 1e-3 * f64::from(u32::from_le_bytes(field(point, 0)));
                let angles =
                    [4, 6].map(|at| 0.01 * f64::from(u16::from_le_bytes(field(point, at))));
                let [(sin, cos), (y, x)] = angles.map(|angle| libm::sincos(angle.to_radians()));
                [sin * x, sin * y, cos].map(|part| depth * part)
            }
        }
    }
}

/// The datagrams of the last moments.
#[derive(Debug, Default)]
pub(crate) struct Flow {
    last: Option<u16>,
    /// When each was sent, and for how long it took points \[us\].
    recent: VecDeque<(u64, u64)>,
}

impl Flow {
    /// Counts a datagram: how many are missing before it; `None` for one that came before. A great gap is a new beginning.
    pub(crate) fn count(&mut self, count: u16) -> Option<u32> {
        let gap = self.last.map_or(1, |last| count.wrapping_sub(last));
        self.last = Some(count);
        let missing = u32::from(gap).checked_sub(1)?;
        Some(if missing < 1023 { missing } else { 0 })
    }

    /// Whether points were taken for nine tenths of the window before this datagram: what is missing would look like air.
    pub(crate) fn is_whole(&mut self, sent: u64, lasted: u64, window: u64) -> bool {
        self.recent.push_back((sent, lasted));
        self.recent.retain(|(it, _)| it + window >= sent);
        10 * self.recent.iter().map(|(_, lasted)| lasted).sum::<u64>() >= 9 * window
    }
}
