//! The log of both sides: each record is time \[us\], kind, length and bytes, little-endian. It replays to the last bit.

use crate::{Companion, CompanionError, Side};
use std::fmt;
use std::io::{Read, Write};
use std::time::{Duration, Instant};

/// One record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Record {
    /// Time \[us\].
    pub(crate) time: u64,
    /// Where it came from; `None` if the companion sent it.
    pub(crate) side: Option<Side>,
    /// The bytes.
    pub(crate) bytes: Vec<u8>,
}

const SIDES: [Option<Side>; 4] = [
    None,
    Some(Side::Autopilot),
    Some(Side::Lidar),
    Some(Side::Time),
];

/// Writes a log.
pub struct LogWriter<W>(pub W);

impl<W: Write> LogWriter<W> {
    /// Writes a record.
    ///
    /// # Errors
    /// What the file reports.
    pub fn write(&mut self, time: u64, side: Option<Side>, bytes: &[u8]) -> std::io::Result<()> {
        let kind = SIDES.iter().position(|known| *known == side).unwrap_or(0);
        let length = u16::try_from(bytes.len()).map_err(std::io::Error::other)?;
        self.0.write_all(&time.to_le_bytes())?;
        self.0.write_all(&[kind as u8])?;
        self.0.write_all(&length.to_le_bytes())?;
        self.0.write_all(bytes)
    }
}

/// Reads a log.
pub(crate) struct LogReader<R> {
    from: R,
    read: usize,
}

impl<R: Read> LogReader<R> {
    /// A reader at the first record.
    pub(crate) fn new(from: R) -> Self {
        Self { from, read: 0 }
    }

    /// The next record; `None` at the end. A record that the end cuts off, as when the power fails, is the end.
    ///
    /// # Errors
    /// [`CompanionError::Log`].
    pub(crate) fn record(&mut self) -> Result<Option<Record>, CompanionError> {
        let mut head = [0; 11];
        if self.from.read_exact(&mut head).is_err() {
            return Ok(None);
        }
        let [a, b, c, d, e, f, g, h, kind, low, high] = head;
        let side = SIDES.get(usize::from(kind));
        let side = *side.ok_or(CompanionError::Log(self.read))?;
        let mut bytes = vec![0; usize::from(u16::from_le_bytes([low, high]))];
        if self.from.read_exact(&mut bytes).is_err() {
            return Ok(None);
        }
        self.read += 1;
        let time = u64::from_le_bytes([a, b, c, d, e, f, g, h]);
        Ok(Some(Record { time, side, bytes }))
    }
}

/// What a replay showed.
#[derive(Clone, Debug, Default)]
pub struct Replayed {
    /// Frames that are the same to the last bit.
    pub same: usize,
    /// Time from each measurement to the setpoint that follows from it, on this machine, in order of its length.
    pub times: Vec<Duration>,
}

impl fmt::Display for Replayed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} frames are the same to the last bit", self.same)?;
        let last = self.times.len().saturating_sub(1);
        for (name, share) in [("median", 50), ("95 %", 95), ("99 %", 99), ("most", 100)] {
            if let Some(time) = self.times.get(last * share / 100) {
                write!(f, "; {name} {:.3} ms", 1e3 * time.as_secs_f64())?;
            }
        }
        write!(
            f,
            " from measurement to setpoint, {} times",
            self.times.len()
        )
    }
}

/// Flies a log again, compares each frame that the companion sends, and takes the time to each setpoint.
///
/// # Errors
/// [`CompanionError::Differs`] at the first frame that is another.
pub fn replay(companion: &mut Companion, from: impl Read) -> Result<Replayed, CompanionError> {
    let mut reader = LogReader::new(from);
    let mut sent = std::collections::VecDeque::new();
    let (mut same, mut times) = (0, Vec::new());
    while let Some(Record { time, side, bytes }) = reader.record()? {
        match side {
            Some(side) => {
                let begun = Instant::now();
                companion.receive(time, side, &bytes, &mut |frame| {
                    // SET_ATTITUDE_TARGET.
                    if frame.get(7..10) == Some(&[82, 0, 0]) {
                        times.push(begun.elapsed());
                    }
                    sent.push_back(frame.to_vec());
                });
            }
            None if sent.pop_front().as_ref() == Some(&bytes) => same += 1,
            None => return Err(CompanionError::Differs(same)),
        }
    }
    times.sort_unstable();
    Ok(Replayed { same, times })
}
