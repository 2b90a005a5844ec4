//! The flight core on the computer beside an autopilot. MAVLink and a lidar's scans go in, attitude setpoints come out.
//!
//! [`Companion`] has no clock, socket and thread: each input bears its time, so that a recorded flight replays to the last
//! bit. The binary brings sockets, clock and log; [`stand_in`] brings an autopilot that flies in simulated time.

mod autopilot;
mod brain;
mod checks;
mod clock;
mod companion;
mod error;
mod frames;
mod guard;
mod level;
mod lidar;
mod log;
mod setpoint;
pub mod stand_in;
mod wire;

pub use autopilot::Kind;
pub use companion::{Companion, Config, Side, Told};
pub use error::CompanionError;
pub use guard::{Reason, State};
pub use lidar::{Mounting, ScanSource};
pub use log::{LogWriter, Replayed, replay};
