//! Why the companion cannot start or go on.

use mpp_sim::link::LinkError;
use mpp_sim::scenario::ScenarioError;

/// Why the companion cannot start or go on.
#[derive(Debug, thiserror::Error)]
pub enum CompanionError {
    /// The range of the lidar is no length.
    #[error("--range {0}: give the longest range of the lidar, more than 0 m")]
    Range(f32),
    /// The aircraft file makes no sense.
    #[error("{0}")]
    Aircraft(#[from] ScenarioError),
    /// The aircraft is not one that an autopilot flies.
    #[error("the aircraft file lacks `{0}`: a companion needs it")]
    Lacks(&'static str),
    /// The elevator of the aircraft is no angle of attack, so its command is no pitch.
    #[error("the aircraft file has moments: a companion needs a `pitch_loop` in their place")]
    NoPitchLoop,
    /// The core does not answer, or refuses its configuration.
    #[error("{0}")]
    Core(#[from] LinkError),
    /// The operating system reports an error. The text names the action that failed.
    #[error("{0}: {1}")]
    Io(String, #[source] std::io::Error),
    /// An address makes no sense.
    #[error("`{0}` is no address: give {1}")]
    Address(String, &'static str),
    /// A mounting or a slice makes no sense.
    #[error(
        "{0}: give roll, pitch and yaw of the lidar in deg, as --mounting 90,0,0, and 0.1 to 30 deg as --slice"
    )]
    Mounting(String),
    /// The lidar does not see the vertical plane.
    #[error(
        "as it is mounted the lidar sees {0} of {1} beams of the vertical plane, of 100 deg about the body axis: lay it on its \
         side and say so with --mounting, as 90,0,0"
    )]
    Unseen(usize, usize),
    /// A log is damaged.
    #[error("the log is damaged at record {0}: record the flight anew")]
    Log(usize),
    /// A replay sent something else than the flight.
    #[error(
        "the replay differs from the flight at sent frame {0}: give the same aircraft file and options as in flight"
    )]
    Differs(usize),
}
