//! Hostile bytes: random and damaged frames of the link into a flight core, and of MAVLink into framer
//! and verifier.
//!
//! The frames come in rounds of [`ROUND`]. A round depends on seed and number alone, so that a failed one
//! can be repeated, and each ends with a good session, which must be answered. The profiles `dev` and
//! `test` check for overflow, and so does this module: without these checks it refuses to run.

mod aircraft;
mod draw;
mod link;
mod radio;

use crate::golden::Failure;
use draw::Draw;
use std::panic::catch_unwind;

/// Number of hostile frames in a round.
pub const ROUND: u64 = 1000;

/// What a run did, as a proof that it reached the inside of the core.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// Hostile frames and pieces of noise.
    pub frames: u64,
    /// Of these, frames that the core's decoder took for messages.
    pub messages: u64,
    /// Commands of the core to the actuators.
    pub commands: u64,
    /// Configurations and parameters that the core took.
    pub accepted: u64,
    /// Plans that the core finished.
    pub plans: u64,
    /// MAVLink frames that the framer found in the hostile bytes.
    pub found: u64,
}

impl Report {
    /// The sum of two reports.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            frames: self.frames + other.frames,
            messages: self.messages + other.messages,
            commands: self.commands + other.commands,
            accepted: self.accepted + other.accepted,
            plans: self.plans + other.plans,
            found: self.found + other.found,
        }
    }
}

/// Runs the rounds that hold a number of frames, half of them for the link and half for MAVLink.
///
/// # Errors
/// The first round that failed, with its cause.
pub fn run(count: u64, seed: u64) -> Result<Report, Failure> {
    if !cfg!(debug_assertions) {
        return Err("this build does not check for overflow: build it without --release".into());
    }
    let mut report = Report::default();
    for round in 0..count.div_ceil(ROUND) {
        let result = catch_unwind(|| {
            let mut draw = Draw::new(seed, round);
            if round % 2 == 0 {
                link::round(&mut draw)
            } else {
                radio::round(&mut draw)
            }
        });
        let cause = match result {
            Ok(Ok(done)) => {
                report = report.and(done);
                continue;
            }
            Ok(Err(cause)) => cause,
            Err(_) => "it panicked".to_owned(),
        };
        return Err(format!("round {round} of seed {seed}: {cause}").into());
    }
    Ok(report)
}
