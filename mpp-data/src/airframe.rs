//! Airframe parameters: the paper's appendix, and the authors' code.

use crate::Setting;
use serde::{Deserialize, Serialize};

/// Standard gravity [m/s^2], from the paper's appendix.
pub const GRAVITY: f64 = 9.81;

/// The airframe, by its longitudinal coefficients: `L = q S (C_L + C_La' alpha' + C_Lq theta')`, `D = q S C_D`,
/// `M = q S l C_M` with the dynamic pressure `q = rho v^2 / 2` and
/// `C_L = C_L0 + C_La alpha + C_Le delta_e`, `C_D = C_D0 + K C_L^2`,
/// `C_M = C_M0 + C_Ma alpha + C_Ma' alpha' + C_Mq theta' + C_Me delta_e`.
///
/// The elevator may be in any unit. Command, limits and derivatives have the same one.
///
/// The four derivatives by rates are in s/rad: the usual coefficient, which counts per radian of `rate c / (2 v)`,
/// times `c / (2 v)` at cruise. With `c` = 0.2 m and `v` = 15 m/s a usual `C_Mq` of -10 becomes -0.067. The usual
/// number itself is about 150 times too large, and the core does not refuse it. An aircraft file (docs/aircraft.md)
/// takes the usual numbers; `sil-harness aircraft FILE` converts them itself and prints the modes that follow.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Airframe {
    /// Mass `m` \[kg\].
    pub mass: f64,
    /// Moment of inertia in pitch `I_yy` [kg m^2].
    pub pitch_inertia: f64,
    /// Wing area `S` [m^2].
    pub wing_area: f64,
    /// Reference length of the pitching moment `l` \[m\]: usually the chord `c`.
    pub moment_length: f64,
    /// Air density `rho` [kg/m^3].
    pub air_density: f64,
    /// Lift coefficient at zero angle of attack `C_L0` [-].
    pub lift_zero: f64,
    /// Lift slope `C_La` [1/rad].
    pub lift_alpha: f64,
    /// Lift by the rate of the angle of attack `C_La'` [s/rad]: the usual coefficient times `c / (2 v)` at cruise.
    pub lift_alpha_rate: f64,
    /// Lift by the pitch rate `C_Lq` [s/rad]: the usual coefficient times `c / (2 v)` at cruise.
    pub lift_pitch_rate: f64,
    /// Lift of the elevator `C_Le` [1 per unit of elevator].
    pub lift_elevator: f64,
    /// Parasitic drag coefficient `C_D0` [-].
    pub drag_zero: f64,
    /// Induced drag factor `K` [-].
    pub drag_induced: f64,
    /// Pitching moment coefficient at zero angle of attack `C_M0` [-].
    pub moment_zero: f64,
    /// Pitch stiffness `C_Ma` [1/rad], negative.
    pub moment_alpha: f64,
    /// Pitch damping through the rate of the angle of attack `C_Ma'` [s/rad]: the usual coefficient times
    /// `c / (2 v)` at cruise; 0 or negative.
    pub moment_alpha_rate: f64,
    /// Pitch damping through the pitch rate `C_Mq` [s/rad]: the usual coefficient times `c / (2 v)` at cruise; 0 or
    /// negative.
    pub moment_pitch_rate: f64,
    /// Elevator effectiveness `C_Me` [1 per unit of elevator]. If it is positive, a greater elevator raises the nose.
    pub moment_elevator: f64,
}

/// Makes what has to know every field: its setting and its value in the paper's appendix. A field that is not in the
/// list does not compile.
macro_rules! fields {
    ($($field:ident: $setting:ident = $paper:expr,)*) => {
        impl Airframe {
            /// The setting of each field, in the order of the fields.
            pub const SETTINGS: &'static [Setting] = &[$(Setting::$setting),*];

            /// The number of fields.
            pub const COUNT: usize = Self::SETTINGS.len();

            /// The airframe of the paper's appendix as printed, with chord and `I_yy = 0.17`.
            pub const PAPER: Self = Self { $($field: $paper),* };

            /// The numbers, in the order of the fields.
            #[must_use]
            pub const fn numbers(&self) -> [f64; Self::COUNT] {
                [$(self.$field),*]
            }

            /// The airframe with these numbers, in the order of the fields.
            #[must_use]
            pub const fn of_numbers([$($field),*]: [f64; Self::COUNT]) -> Self {
                Self { $($field),* }
            }
        }
    };
}

fields! {
    mass: Mass = 3.2,
    pitch_inertia: PitchInertia = 0.17,
    wing_area: WingArea = 0.25,
    moment_length: MomentLength = 0.13,
    air_density: AirDensity = 1.225,
    lift_zero: LiftZero = 0.5,
    lift_alpha: LiftAlpha = 5.73,
    lift_alpha_rate: LiftAlphaRate = 0.0,
    lift_pitch_rate: LiftPitchRate = 0.0,
    lift_elevator: LiftElevator = 0.0,
    drag_zero: DragZero = 0.1,
    drag_induced: DragInduced = 0.05,
    moment_zero: MomentZero = 0.5,
    moment_alpha: MomentAlpha = -8.02,
    moment_alpha_rate: MomentAlphaRate = -0.46,
    moment_pitch_rate: MomentPitchRate = 0.0,
    moment_elevator: MomentElevator = 0.2,
}

impl Airframe {
    /// Whether every parameter is a finite number.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.numbers().iter().all(|number| number.is_finite())
    }

    /// The airframe of the authors' code: derivatives per degree times 180/pi, no chord in the moment, and
    /// the inertia of a uniform rod. The flights behind the paper's results used this airframe. Its elevator's command
    /// is a number without a unit, not an angle in radians: level trim at 12 m/s needs 3.749.
    pub const REFERENCE: Self = Self {
        mass: 3.2,
        pitch_inertia: 1.0 / 12.0 * 3.2 * (0.8 * 0.8),
        moment_length: 1.0,
        lift_alpha: 0.1 * 180.0 / core::f64::consts::PI,
        moment_alpha: -0.14 * 180.0 / core::f64::consts::PI,
        moment_alpha_rate: -0.008 * 180.0 / core::f64::consts::PI,
        ..Self::PAPER
    };

    /// Lift coefficient [-] at which the lift carries the weight at an airspeed [m/s].
    #[must_use]
    pub fn level_lift(&self, airspeed: f64) -> f64 {
        self.mass * GRAVITY / (0.5 * self.air_density * (airspeed * airspeed) * self.wing_area)
    }

    /// Moment per angle of attack \[1/rad\] that the elevator balances in a steady turn at an airspeed [m/s]: stiffness, and
    /// damping of the turn that the angle gives (the distance to the manoeuvre point).
    #[must_use]
    pub fn turn_stiffness(&self, airspeed: f64) -> f64 {
        self.moment_alpha
            + self.moment_pitch_rate
                * (0.5 * self.air_density * self.wing_area * self.lift_alpha * airspeed / self.mass)
    }

    /// Whether the elevator is a commanded angle of attack, as of an aircraft behind the pitch loop of an autopilot.
    #[must_use]
    pub fn commands_angle_of_attack(&self) -> bool {
        let apart = libm::fabs(self.moment_elevator + self.moment_alpha);
        self.moment_zero == 0.0 && apart < 1e-9 * libm::fabs(self.moment_alpha)
    }

    /// The airframe whose lift is that with the elevator in balance at each angle of attack and each rate, and
    /// whose elevator has no lift of its own.
    #[must_use]
    pub fn balanced(&self) -> Self {
        // An elevator without effect has no balance; the trim says so.
        if self.lift_elevator == 0.0 {
            return *self;
        }
        let per_moment = self.lift_elevator / self.moment_elevator;
        Self {
            lift_zero: self.lift_zero - per_moment * self.moment_zero,
            lift_alpha: self.lift_alpha - per_moment * self.moment_alpha,
            lift_alpha_rate: self.lift_alpha_rate - per_moment * self.moment_alpha_rate,
            lift_pitch_rate: self.lift_pitch_rate - per_moment * self.moment_pitch_rate,
            lift_elevator: 0.0,
            ..*self
        }
    }

    /// Path rate of a turn at an airspeed [m/s] over the path rate without lift by the pitch rate [-]. The
    /// airframe is a [balanced](Self::balanced) one.
    #[must_use]
    pub fn turn_gain(&self, airspeed: f64) -> f64 {
        let per_rate = 0.5 * self.air_density * airspeed * self.wing_area / self.mass;
        1.0 / (1.0 - per_rate * self.lift_pitch_rate)
    }

    /// Elevator command [-] that balances the pitching moment at a constant angle of attack \[rad\].
    #[must_use]
    pub fn elevator_for(&self, angle_of_attack: f64) -> f64 {
        -(self.moment_alpha * angle_of_attack + self.moment_zero) / self.moment_elevator
    }

    /// Angle of attack \[rad\] at which an elevator command [-] balances the pitching moment. It is the
    /// inverse of [`Airframe::elevator_for`].
    #[must_use]
    pub fn angle_of_attack_for(&self, elevator: f64) -> f64 {
        -(self.moment_elevator * elevator + self.moment_zero) / self.moment_alpha
    }
}
