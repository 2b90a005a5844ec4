//! The aircraft of a configuration, as numbers.

use super::size;
use core::f64::consts::PI;
use serde::{Deserialize, Serialize};

/// The aircraft that the core flies. The coefficients are those of the paper's appendix, and four more:
/// with the dynamic pressure `q`, `L = q S (C_L + C_La' alpha' + C_Lq theta')`, `D = q S C_D`, `M = q S l C_M` and
/// `C_L = C_L0 + C_La alpha + C_Le delta_e`, `C_D = C_D0 + K C_L^2`,
/// `C_M = C_M0 + C_Ma alpha + C_Ma' alpha' + C_Mq theta' + C_Me delta_e`. The elevator `delta_e` may be in any
/// unit; commands, limits and coefficients have the same one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Aircraft {
    /// Mass \[kg\].
    pub mass: f64,
    /// Moment of inertia in pitch \[kg m^2\].
    pub pitch_inertia: f64,
    /// Wing area `S` \[m^2\].
    pub wing_area: f64,
    /// Reference length of the pitching moment `l` \[m\].
    pub moment_length: f64,
    /// Air density \[kg/m^3\].
    pub air_density: f64,
    /// `C_L0` \[-\].
    pub lift_zero: f64,
    /// `C_La` \[1/rad\].
    pub lift_alpha: f64,
    /// `C_La'` \[s/rad\].
    pub lift_alpha_rate: f64,
    /// `C_Lq` \[s/rad\].
    pub lift_pitch_rate: f64,
    /// `C_Le` \[1 per unit of elevator\].
    pub lift_elevator: f64,
    /// `C_D0` \[-\].
    pub drag_zero: f64,
    /// `K` \[-\].
    pub drag_induced: f64,
    /// `C_M0` \[-\].
    pub moment_zero: f64,
    /// `C_Ma` \[1/rad\].
    pub moment_alpha: f64,
    /// `C_Ma'` \[s/rad\].
    pub moment_alpha_rate: f64,
    /// `C_Mq` \[s/rad\].
    pub moment_pitch_rate: f64,
    /// `C_Me` \[1 per unit of elevator\].
    pub moment_elevator: f64,
    /// Airspeed of level flight \[m/s\]. The presets of the paper have their own.
    pub cruise: f64,
    /// Radius of the circle that holds the aircraft \[m\].
    pub body_radius: f64,
    /// Distance of the stall from the angle of attack of level flight \[rad\], if it is known.
    pub stall: Option<f64>,
}

impl Aircraft {
    /// Size of the longest form \[bytes\].
    pub const MAX_SIZE: usize = 19 * size::F64 + size::BYTE + size::F64;

    /// The aircraft of the authors' code, for which the presets were tuned.
    pub const REFERENCE: Self = Self {
        mass: 3.2,
        pitch_inertia: 1.0 / 12.0 * 3.2 * (0.8 * 0.8),
        wing_area: 0.25,
        moment_length: 1.0,
        air_density: 1.225,
        lift_zero: 0.5,
        lift_alpha: 0.1 * 180.0 / PI,
        lift_alpha_rate: 0.0,
        lift_pitch_rate: 0.0,
        lift_elevator: 0.0,
        drag_zero: 0.1,
        drag_induced: 0.05,
        moment_zero: 0.5,
        moment_alpha: -0.14 * 180.0 / PI,
        moment_alpha_rate: -0.008 * 180.0 / PI,
        moment_pitch_rate: 0.0,
        moment_elevator: 0.2,
        cruise: 12.0,
        body_radius: 0.0,
        stall: None,
    };
}

/// Limits of the actuators. `None` means no limit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ActuatorLimits {
    /// Greatest thrust \[N\].
    pub thrust_max: Option<f64>,
    /// Time constant of the thrust's first-order lag \[s\].
    pub thrust_lag: Option<f64>,
    /// Greatest distance of the elevator below its trim, in units of the command.
    pub elevator_below: Option<f64>,
    /// Greatest distance of the elevator above its trim, in units of the command.
    pub elevator_above: Option<f64>,
    /// Greatest rate of the elevator \[1/s\].
    pub elevator_rate: Option<f64>,
}

impl ActuatorLimits {
    /// Size of the longest form \[bytes\].
    pub const MAX_SIZE: usize = 5 * (size::BYTE + size::F64);

    /// No limit.
    pub const NONE: Self = Self {
        thrust_max: None,
        thrust_lag: None,
        elevator_below: None,
        elevator_above: None,
        elevator_rate: None,
    };
}
