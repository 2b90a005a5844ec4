//! What core and link must know of an aircraft, beside the limits of its actuators.

use crate::Airframe;
use serde::{Deserialize, Serialize};

/// The aircraft that the core flies.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Aircraft {
    /// Mass, inertia and aerodynamics.
    pub airframe: Airframe,
    /// Airspeed of level flight [m/s]. The presets of the paper have their own.
    pub cruise: f64,
    /// Radius of the circle that holds the aircraft \[m\].
    pub body_radius: f64,
    /// Distance of the stall from the angle of attack of level flight \[rad\], if it is known.
    pub stall: Option<f64>,
}

impl Aircraft {
    /// The aircraft of the authors' code, for which the presets were tuned.
    pub const REFERENCE: Self = Self {
        airframe: Airframe::REFERENCE,
        cruise: 12.0,
        body_radius: 0.0,
        stall: None,
    };

    /// Angle of attack that changes the lift by the weight, over that of the reference aircraft [-].
    #[must_use]
    pub fn angle_unit(&self) -> f64 {
        let (own, reference) = (self.airframe.balanced(), Airframe::REFERENCE);
        (own.level_lift(self.cruise) * reference.lift_alpha)
            / (reference.level_lift(Self::REFERENCE.cruise) * own.lift_alpha)
    }

    /// Command of the elevator with the effect that a unit of the command has on the reference aircraft: in a steady turn
    /// it balances stiffness and damping (the distance to the manoeuvre point; Etkin, Reid, "Dynamics of Flight", 3.1).
    #[must_use]
    pub fn elevator_unit(&self) -> f64 {
        let (own, reference) = (&self.airframe, Airframe::REFERENCE);
        let angle = self.angle_unit();
        libm::fabs(
            angle * (own.turn_stiffness(self.cruise) * reference.moment_elevator)
                / (reference.turn_stiffness(Self::REFERENCE.cruise) * own.moment_elevator),
        )
    }
}
