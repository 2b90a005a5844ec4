//! Telemetry logs in the format of ground stations: frames with the time before each frame.

use std::io::{self, Write};

/// The time at which every recording begins: 2026-01-01T00:00:00Z [us since 1970]. This time is
/// fixed, and simulated time is added to it, so that a flight's recording has the same bytes each
/// time.
pub const EPOCH_US: u64 = 1_767_225_600_000_000;

/// Writes frames, each after its time [us since 1970], big endian in eight bytes.
pub struct TlogWriter<W> {
    to: W,
}

impl<W: Write> TlogWriter<W> {
    /// An empty recording.
    pub fn new(to: W) -> Self {
        Self { to }
    }

    /// Appends a frame at a time since the vehicle's start \[us\].
    ///
    /// # Errors
    /// The error of the writer.
    pub fn write(&mut self, since_start_us: u64, frame: &[u8]) -> io::Result<()> {
        self.to
            .write_all(&(EPOCH_US + since_start_us).to_be_bytes())?;
        self.to.write_all(frame)
    }

    /// Ends the recording.
    ///
    /// # Errors
    /// The error of the writer.
    pub fn finish(mut self) -> io::Result<W> {
        self.to.flush()?;
        Ok(self.to)
    }
}
