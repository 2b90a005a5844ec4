//! The aircraft: parameters, equations of motion, Jacobians and steady flight.

mod airframe;
mod dynamics;
mod limits;
mod linearize;
mod point_mass;
mod trim;
mod wind;

pub use airframe::{Airframe, GRAVITY};
pub use dynamics::{AirState, Control, VehicleState, air_rate, vehicle_rate};
pub use limits::ActuatorLimits;
pub use linearize::{JacobianForm, Linearization, linearize};
pub use point_mass::{PathControl, PathState};
pub use trim::{Trim, TrimError};
pub use wind::Wind;
