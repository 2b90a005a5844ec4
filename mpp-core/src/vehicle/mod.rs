//! The aircraft: parameters, equations of motion, Jacobians and steady flight.

mod conditions;
mod dynamics;
mod lateral;
mod linearize;
mod loiter;
mod nose;
mod point_mass;
mod pose;
mod quaternion;
mod space_path;
mod stall;
mod thrust_lag;
mod trim;
mod wind;

pub use conditions::Conditions;
pub use dynamics::{AirState, VehicleState, air_rate, vehicle_rate};
pub(crate) use dynamics::{Directions, air_rate_along};
pub use lateral::{LateralLinearization, linearize_lateral};
pub(crate) use linearize::linearize_along;
pub use linearize::{JacobianForm, Linearization, linearize};
pub use loiter::{Loiter, within_half_turn};
pub use mpp_data::{
    ActuatorLimits, Airframe, Control, Derivatives, GRAVITY, LateralAirframe, LateralControl,
};
pub use nose::Nose;
pub use point_mass::{PathControl, PathState};
pub use pose::{Pose, ScanPoses};
pub use quaternion::Quaternion;
pub use space_path::{SPACE_STATES, SpaceControl, SpaceModel, SpacePath, path_axes};
pub(crate) use space_path::{between, within};
pub use stall::{StallGuard, stall_sides};
pub use thrust_lag::ThrustLag;
pub use trim::{Trim, TrimError};
pub use wind::Wind;
