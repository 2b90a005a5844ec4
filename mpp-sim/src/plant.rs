//! The plant: the interface of a flight's true aircraft.

use crate::disturbance::Disturbance;
use mpp_core::vehicle::{Control, VehicleState};

/// The reason why the plant did not step. Its state is unchanged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PlantError {
    /// Thrust or elevator is not a number: the controller is broken, and the flight ends.
    #[error("thrust or elevator command is not a finite number")]
    NonFiniteControl,
    /// The equations left their domain (an airspeed of zero): the flight ends, as one beyond the limit of the flight path.
    #[error("the aircraft's state is no longer a finite number")]
    NonFiniteState,
    /// The equations of six degrees of freedom left their domain: the flight ends likewise.
    #[error(
        "the aircraft departed: at 80 deg of sideslip or without airspeed the equations of motion end"
    )]
    Departed,
}

/// The true aircraft, and the air that it flies in.
pub trait Plant {
    /// Position over ground and motion through the air.
    fn state(&self) -> &VehicleState;

    /// Motion of the air, downrange and up [m/s].
    fn wind(&self) -> (f64, f64);

    /// Flies one tick of the flight loop. Returns the control that the actuators gave.
    ///
    /// # Errors
    /// [`PlantError`] when the plant cannot step; the flight then ends.
    fn step(&mut self, command: Control) -> Result<Control, PlantError>;

    /// Changes the air and the elevator. Returns `false` if this plant cannot be disturbed so.
    fn disturb(&mut self, disturbance: &Disturbance) -> bool {
        let _ = disturbance;
        false
    }
}
