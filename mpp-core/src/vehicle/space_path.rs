//! The point mass that banks: the motion that plans in space are made of. In the vertical plane it is
//! [`PathState`](super::PathState) without the lift by rates.
//!
//! World: x ahead, y to the right, z up. Bank and course are positive to the right.

use super::{Airframe, GRAVITY, Nose, Trim, TrimError};

/// Least airspeed in the equations [m/s]. It keeps their divisor away from zero.
const LEAST_AIRSPEED: f64 = 3.0;
/// Least cosine of the flight path angle in the rate of the course, which is singular in vertical flight.
const LEAST_COS_PATH: f64 = 0.2;
/// Number of states.
pub const SPACE_STATES: usize = 8;

/// State of the point mass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpacePath {
    /// Position `(x, y, z)` \[m\].
    pub position: [f64; 3],
    /// Airspeed [m/s].
    pub airspeed: f64,
    /// Angle of attack \[rad\].
    pub angle_of_attack: f64,
    /// Bank \[rad\].
    pub bank: f64,
    /// Flight path angle through the air \[rad\].
    pub flight_path: f64,
    /// Course through the air \[rad\].
    pub course: f64,
}

/// Control of the point mass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpaceControl {
    /// Rate of the bank [rad/s].
    pub bank_rate: f64,
    /// Rate of the angle of attack [rad/s].
    pub angle_of_attack_rate: f64,
    /// Thrust \[N\].
    pub thrust: f64,
}

/// The aircraft of a plan in space: forces, limits, and the air in which it flies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpaceModel {
    /// Forces; a [balanced](Airframe::balanced) airframe.
    pub airframe: Airframe,
    /// Level flight.
    pub trim: Trim,
    /// Greatest thrust \[N\].
    pub thrust_max: f64,
    /// Least and greatest angle of attack of a plan \[rad\].
    pub angle_of_attack: [f64; 2],
    /// Greatest rate of the angle of attack [rad/s].
    pub angle_of_attack_rate: f64,
    /// Greatest bank \[rad\].
    pub bank: f64,
    /// Greatest rate of the bank [rad/s].
    pub bank_rate: f64,
    /// Velocity of the air over ground [m/s].
    pub wind: [f64; 3],
    /// The nose, if it runs away.
    pub nose: Option<Nose>,
}

/// Angle of attack beyond that of level flight that a plan may use \[rad\]. More turns more tightly. Source: the limits of the plane.
const MOST_ABOVE_LEVEL: f64 = 0.2;
/// How far beyond the angles of plans roll-outs and regulator may go \[rad\]: programs break soft rows by a little. Source: the
/// trial of a prototype that decision 46 names.
const BEYOND: f64 = 0.03;
/// Distance of what they may reach from the stall \[rad\]: from there on the lift does not grow. Less counts on lift that is not
/// there, more turns less tightly. Source: D64.
const FROM_STALL: f64 = 0.05;

impl SpacePath {
    /// At rest in the origin.
    pub(crate) const ORIGIN: Self = Self {
        position: [0.0; 3],
        airspeed: 0.0,
        angle_of_attack: 0.0,
        bank: 0.0,
        flight_path: 0.0,
        course: 0.0,
    };
}

impl SpaceModel {
    /// No aircraft: the value before a set-up.
    pub(crate) const NONE: Self = Self {
        airframe: Airframe::REFERENCE,
        trim: Trim::NONE,
        thrust_max: 0.0,
        angle_of_attack: [0.0; 2],
        angle_of_attack_rate: 0.0,
        bank: 0.0,
        bank_rate: 0.0,
        wind: [0.0; 3],
        nose: None,
    };

    /// The model of an aircraft at an airspeed [m/s], with the stall \[rad\], the greatest thrust \[N\], bank \[rad\] and rate of
    /// the bank [rad/s].
    ///
    /// # Errors
    /// [`TrimError`] if there is no level flight.
    pub fn new(
        airframe: &Airframe,
        airspeed: f64,
        stall: f64,
        thrust_max: f64,
        [bank, bank_rate]: [f64; 2],
    ) -> Result<Self, TrimError> {
        let trim = Trim::at_speed(airframe, airspeed, 0.0)?;
        let airframe = airframe.balanced();
        let level = trim.state.angle_of_attack();
        let no_lift = -airframe.lift_zero / airframe.lift_alpha;
        Ok(Self {
            airframe,
            trim,
            thrust_max,
            angle_of_attack: [
                (level - MOST_ABOVE_LEVEL).max(no_lift),
                (level + MOST_ABOVE_LEVEL).min(stall - (FROM_STALL + BEYOND)),
            ],
            angle_of_attack_rate: 1.0,
            bank,
            bank_rate,
            wind: [0.0; 3],
            nose: None,
        })
    }

    /// Angles of attack that roll-outs and regulator may reach \[rad\]: a little beyond those of plans.
    #[must_use]
    pub fn reachable_angles(&self) -> [f64; 2] {
        let [low, high] = self.angle_of_attack;
        [low - BEYOND, high + BEYOND]
    }

    fn pressure_area(&self, airspeed: f64) -> f64 {
        0.5 * self.airframe.air_density * (airspeed * airspeed) * self.airframe.wing_area
    }

    /// Lift and the share of the thrust across the flight path, per mass [m/s^2].
    #[must_use]
    pub fn pull(&self, airspeed: f64, angle_of_attack: f64, thrust: f64) -> f64 {
        let a = &self.airframe;
        let lift = a.lift_zero + a.lift_alpha * angle_of_attack;
        let across = thrust * libm::sin(angle_of_attack);
        (self.pressure_area(airspeed) * lift + across) / a.mass
    }

    /// The angle of attack \[rad\] that pulls with an acceleration [m/s^2] at the thrust of level flight, without limits.
    #[must_use]
    pub fn angle_for(&self, airspeed: f64, pull: f64) -> f64 {
        let (a, pressure) = (&self.airframe, self.pressure_area(airspeed));
        let thrust = self.trim.control.thrust;
        (pull * a.mass / pressure - a.lift_zero) / (a.lift_alpha + thrust / pressure)
    }

    /// The thrust \[N\], within its limits, that holds an airspeed [m/s] at an angle of attack \[rad\] and a flight path \[rad\]
    /// and brings it to that of level flight within a second.
    #[must_use]
    pub fn thrust_for(&self, airspeed: f64, angle_of_attack: f64, flight_path: f64) -> f64 {
        let a = &self.airframe;
        let lift = a.lift_zero + a.lift_alpha * angle_of_attack;
        let drag = self.pressure_area(airspeed) * (a.drag_zero + a.drag_induced * lift * lift);
        let wanted = self.trim.state.airspeed - airspeed;
        let thrust = drag + a.mass * (GRAVITY * libm::sin(flight_path) + wanted);
        thrust.min(self.thrust_max).max(0.0)
    }

    /// Curvature of the tightest level turn at the airspeed of level flight [1/m].
    #[must_use]
    pub fn curvature(&self) -> f64 {
        let v = self.trim.state.airspeed;
        let [_, most] = self.angle_of_attack;
        let load = self.pull(v, most, self.trim.control.thrust) / GRAVITY;
        let bank = self.bank.min(libm::acos((1.0 / load).min(1.0)));
        GRAVITY * libm::tan(bank) / (v * v)
    }
}

impl SpacePath {
    /// The state from its numbers, in the order of the fields.
    #[must_use]
    pub fn of(numbers: [f64; SPACE_STATES]) -> Self {
        let [
            x,
            y,
            z,
            airspeed,
            angle_of_attack,
            bank,
            flight_path,
            course,
        ] = numbers;
        Self {
            position: [x, y, z],
            airspeed,
            angle_of_attack,
            bank,
            flight_path,
            course,
        }
    }

    /// The numbers of the state, in the order of the fields.
    #[must_use]
    pub fn numbers(&self) -> [f64; SPACE_STATES] {
        let [x, y, z] = self.position;
        [
            x,
            y,
            z,
            self.airspeed,
            self.angle_of_attack,
            self.bank,
            self.flight_path,
            self.course,
        ]
    }

    /// Unit vectors along the flight path through the air, across it in the vertical plane, and across it to the right.
    #[must_use]
    pub fn axes(&self) -> [[f64; 3]; 3] {
        path_axes(self.flight_path, self.course)
    }

    /// Velocity over ground in a wind [m/s].
    #[must_use]
    pub fn ground_velocity(&self, wind: &[f64; 3]) -> [f64; 3] {
        let [along, ..] = self.axes();
        self.ground_velocity_along(&along, wind)
    }

    /// The same where the first of the [axes](Self::axes) is known.
    pub(crate) fn ground_velocity_along(&self, along: &[f64; 3], wind: &[f64; 3]) -> [f64; 3] {
        core::array::from_fn(|axis| along[axis] * self.airspeed + wind[axis])
    }

    /// Unit vector along the wing, to the right.
    #[must_use]
    pub fn wing(&self) -> [f64; 3] {
        let [_, up, right] = self.axes();
        let (sin, cos) = libm::sincos(self.bank);
        core::array::from_fn(|axis| cos * right[axis] - sin * up[axis])
    }

    /// The state after `dt` \[s\] under a constant control, by one step of the classic Runge-Kutta method.
    #[must_use]
    pub fn after(&self, model: &SpaceModel, control: &SpaceControl, dt: f64) -> Self {
        let start = self.numbers();
        let angles = Angles::of(&start);
        let k1 = rate(&start, &angles, model, control);
        let half = moved(&start, &k1, 0.5 * dt);
        // Bank and angle of attack do not depend on the other states, so both middles have the same.
        let angles = Angles::of(&half);
        let k2 = rate(&half, &angles, model, control);
        let k3 = rate(&moved(&start, &k2, 0.5 * dt), &angles, model, control);
        let end = moved(&start, &k3, dt);
        let k4 = rate(&end, &Angles::of(&end), model, control);
        Self::of(core::array::from_fn(|state| {
            combined(
                start[state],
                [k1[state], k2[state], k3[state], k4[state]],
                dt,
            )
        }))
    }

    /// The state after `dt` \[s\] as far as it does not depend on forces: its bank and its angle of attack.
    pub(crate) fn turned(&self, control: &SpaceControl, dt: f64) -> Self {
        let (bank, attack) = (control.bank_rate, control.angle_of_attack_rate);
        Self {
            bank: combined(self.bank, [bank; 4], dt),
            angle_of_attack: combined(self.angle_of_attack, [attack; 4], dt),
            ..*self
        }
    }
}

/// The end of a step of the method of Runge and Kutta, from its four rates.
fn combined(start: f64, [k1, k2, k3, k4]: [f64; 4], dt: f64) -> f64 {
    start + dt / 6.0 * (k1 + 2.0 * (k2 + k3) + k4)
}

/// The nearest value of a range; its lower end for what is no number. Unlike `clamp` it has no panic.
pub(crate) fn between(value: f64, [low, high]: [f64; 2]) -> f64 {
    if value > low {
        if value < high { value } else { high }
    } else {
        low
    }
}

/// The nearest value within a limit to either side.
pub(crate) fn within(value: f64, limit: f64) -> f64 {
    between(value, [-limit, limit])
}

/// The axes of [`SpacePath::axes`] for a flight path and a course \[rad\].
#[must_use]
pub fn path_axes(flight_path: f64, course: f64) -> [[f64; 3]; 3] {
    let (sin_path, cos_path) = libm::sincos(flight_path);
    let (sin_course, cos_course) = libm::sincos(course);
    [
        [cos_path * cos_course, cos_path * sin_course, sin_path],
        [-sin_path * cos_course, -sin_path * sin_course, cos_path],
        [-sin_course, cos_course, 0.0],
    ]
}

fn moved(state: &[f64; SPACE_STATES], rate: &[f64; SPACE_STATES], dt: f64) -> [f64; SPACE_STATES] {
    core::array::from_fn(|index| state[index] + dt * rate[index])
}

/// Sines and cosines of the angles whose rates are controls.
struct Angles {
    attack: (f64, f64),
    bank: (f64, f64),
}

impl Angles {
    fn of([_, _, _, _, attack, bank, _, _]: &[f64; SPACE_STATES]) -> Self {
        Self {
            attack: libm::sincos(*attack),
            bank: libm::sincos(*bank),
        }
    }
}

/// Time derivative of the numbers of a state.
fn rate(
    numbers: &[f64; SPACE_STATES],
    angles: &Angles,
    model: &SpaceModel,
    control: &SpaceControl,
) -> [f64; SPACE_STATES] {
    let [_, _, _, airspeed, angle_of_attack, _, flight_path, course] = *numbers;
    let ((sin_attack, cos_attack), (sin_bank, cos_bank)) = (angles.attack, angles.bank);
    let (a, v) = (&model.airframe, airspeed.max(LEAST_AIRSPEED));
    let (sin_path, cos_path) = libm::sincos(flight_path);
    let (sin_course, cos_course) = libm::sincos(course);
    let lift = a.lift_zero + a.lift_alpha * angle_of_attack;
    let pressure = model.pressure_area(v);
    let drag = pressure * (a.drag_zero + a.drag_induced * (lift * lift));
    let pull = (pressure * lift + control.thrust * sin_attack) / a.mass;
    let pushed = control.thrust * cos_attack - drag;
    [
        v * (cos_path * cos_course) + model.wind[0],
        v * (cos_path * sin_course) + model.wind[1],
        v * sin_path + model.wind[2],
        pushed / a.mass - GRAVITY * sin_path,
        control.angle_of_attack_rate,
        control.bank_rate,
        (pull * cos_bank - GRAVITY * cos_path) / v,
        pull * sin_bank / (v * cos_path.max(LEAST_COS_PATH)),
    ]
}
