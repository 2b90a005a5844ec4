//! The aircraft: parameters, equations of motion, Jacobians and steady flight.

mod airframe;
mod dynamics;
mod linearize;
mod point_mass;
mod trim;

pub use airframe::{Airframe, GRAVITY};
pub use dynamics::{AirState, Control, VehicleState, air_rate, vehicle_rate};
pub use linearize::{JacobianForm, Linearization, linearize};
pub use point_mass::{PathControl, PathState};
pub use trim::{Trim, TrimError};
