//! A stand-in for an autopilot and its aircraft, in simulated time: the plant, lidar and fields of `mpp-sim` behind the
//! messages and the rules of ArduPlane's GUIDED, or of PX4's OFFBOARD.

mod autopilot;
mod faults;
mod figures;
pub(crate) mod flight;
mod rules;

pub use autopilot::StandIn;
pub use faults::Fault;
pub use figures::figures;
pub use flight::{Flight, Outcome};

/// ArduPlane's simulated plane behind its pitch loop. The numbers of the loop were fitted to its steps.
pub const AIRCRAFT: &str = include_str!("../../plane.toml");
