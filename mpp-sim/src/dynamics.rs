//! The motion of the true aircraft. This module integrates the core's equations of motion, with the
//! aerodynamics that an aircraft file adds to them.

use crate::aircraft_file::AircraftFile;
use crate::plant::PlantError;
use mpp_core::vehicle::{AirState, Airframe, Control, VehicleState, vehicle_rate};

/// The number of Runge-Kutta steps within one [`Dynamics::step`]. At the flight's 100 Hz the local
/// error is then far below the sensors' resolution, even in the fast pitch mode.
pub const SUBSTEPS: u32 = 2;

/// A rigid aircraft in still air, and its true state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dynamics {
    /// Parameters of the true aircraft; a campaign may make them differ from the core's.
    pub airframe: Airframe,
    /// What the core's equations leave out.
    pub more: Aerodynamics,
    /// True state.
    pub state: VehicleState,
}

/// Aerodynamics of the true aircraft that the core's equations leave out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aerodynamics {
    /// Airspeed at which the derivatives by rates are as the airframe says [m/s]. They fall with `1 / v`,
    /// because they are of `theta' c / 2v`. Without a value they are constant, as in the paper.
    pub rates_airspeed: Option<f64>,
    /// Angle of attack at which the wing stalls \[rad\]; it never does without a value. It also stalls as far below the
    /// angle of no lift as this is above it.
    pub stall: Option<f64>,
}

/// Sharpness of the stall [1/rad]. Source: Beard, McLain, "Small Unmanned Aircraft", 2012, table E.2.
const STALL_SHARPNESS: f64 = 50.0;

impl Aerodynamics {
    /// The core's equations alone.
    pub const NONE: Self = Self {
        rates_airspeed: None,
        stall: None,
    };

    /// The aerodynamics of an aircraft file.
    #[must_use]
    pub fn of(file: &AircraftFile) -> Self {
        let (lift, moment) = (&file.lift, &file.moment);
        let rates = [
            lift.pitch_rate,
            lift.alpha_rate,
            moment.pitch_rate,
            moment.alpha_rate,
        ];
        let constant = rates.iter().all(|rate| *rate == 0.0);
        Self {
            rates_airspeed: (!constant).then_some(file.cruise),
            stall: file.lift.stall,
        }
    }

    /// The airframe whose linear lift and constant derivatives by rates are those of the true aircraft in this motion.
    pub(crate) fn at(&self, airframe: &Airframe, air: &AirState) -> Airframe {
        let mut at = *airframe;
        if let Some(airspeed) = self.rates_airspeed {
            for rate in [
                &mut at.lift_alpha_rate,
                &mut at.lift_pitch_rate,
                &mut at.moment_alpha_rate,
                &mut at.moment_pitch_rate,
            ] {
                *rate *= airspeed / air.airspeed;
            }
        }
        if let Some(stall) = self.stall {
            // The wing stalls as far below its angle of no lift as above it; angles of attack may count from any line.
            let no_lift = -at.lift_zero / at.lift_alpha;
            let alpha = air.angle_of_attack() - no_lift;
            let linear = at.lift_alpha * alpha;
            at.lift_zero += separated(alpha, stall - no_lift) * (flat_plate(alpha) - linear);
        }
        at
    }
}

/// Share of the flow that is separated [-]: a smooth step at the stall, to either side. Both angles count from the angle
/// of no lift. Source: Beard and McLain, equation 4.10.
fn separated(alpha: f64, stall: f64) -> f64 {
    let above = libm::exp(-STALL_SHARPNESS * (alpha - stall));
    let below = libm::exp(STALL_SHARPNESS * (alpha + stall));
    (1.0 + above + below) / ((1.0 + above) * (1.0 + below))
}

/// Lift coefficient of a flat plate [-]. Source: Beard and McLain, equation 4.9.
fn flat_plate(alpha: f64) -> f64 {
    let (sin, cos) = libm::sincos(alpha);
    2.0 * alpha.signum() * sin * sin * cos
}

impl Dynamics {
    /// Flies `dt` \[s\] with a constant control, by the classic Runge-Kutta method in [`SUBSTEPS`]
    /// steps.
    ///
    /// # Errors
    /// [`PlantError`]; the state is then as before.
    pub fn step(&mut self, control: Control, dt: f64) -> Result<(), PlantError> {
        let substep = dt / f64::from(SUBSTEPS);
        let (airframe, more) = (self.airframe, self.more);
        let rate = |at: &VehicleState| vehicle_rate(&more.at(&airframe, &at.air), at, control);
        self.advance(control, |state| {
            (0..SUBSTEPS).fold(*state, |state, _| runge_kutta(rate, moved, &state, substep))
        })
    }

    /// Flies `dt` \[s\] with one forward Euler step, as the authors' code does. This is for the
    /// comparison with the flights that the authors' code recorded.
    ///
    /// # Errors
    /// [`PlantError`]; the state is then as before.
    pub fn step_euler(&mut self, control: Control, dt: f64) -> Result<(), PlantError> {
        let airframe = self.airframe;
        self.advance(control, |state| {
            moved(state, &vehicle_rate(&airframe, state, control), dt)
        })
    }

    /// Replaces the state by `next(state)` if control and result are finite.
    fn advance(
        &mut self,
        control: Control,
        next: impl FnOnce(&VehicleState) -> VehicleState,
    ) -> Result<(), PlantError> {
        if !(control.thrust.is_finite() && control.elevator.is_finite()) {
            return Err(PlantError::NonFiniteControl);
        }
        let state = next(&self.state);
        if !(state.x.is_finite() && state.z.is_finite() && state.air.is_finite()) {
            return Err(PlantError::NonFiniteState);
        }
        self.state = state;
        Ok(())
    }
}

/// One step of the classic fourth-order Runge-Kutta method over `h` \[s\].
pub(crate) fn runge_kutta<S>(
    rate: impl Fn(&S) -> S,
    moved: impl Fn(&S, &S, f64) -> S,
    state: &S,
    h: f64,
) -> S {
    let k1 = rate(state);
    let k2 = rate(&moved(state, &k1, 0.5 * h));
    let k3 = rate(&moved(state, &k2, 0.5 * h));
    let k4 = rate(&moved(state, &k3, h));
    // x + h/6 (k1 + 2 k2 + 2 k3 + k4)
    let ends = moved(&moved(state, &k1, h / 6.0), &k4, h / 6.0);
    moved(&moved(&ends, &k2, h / 3.0), &k3, h / 3.0)
}

/// `state + h rate`.
pub(crate) fn moved(state: &VehicleState, rate: &VehicleState, h: f64) -> VehicleState {
    VehicleState {
        x: state.x + h * rate.x,
        z: state.z + h * rate.z,
        air: AirState::from_vector(&(state.air.to_vector() + rate.air.to_vector() * h)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mpp_core::vehicle::{GRAVITY, SpaceModel, Trim};

    const DT: f64 = 0.01;

    fn trimmed(airframe: Airframe) -> (Dynamics, Control) {
        let trim = Trim::at_speed(&airframe, 12.0, 0.0).unwrap();
        let state = VehicleState {
            x: 0.0,
            z: 50.0,
            air: trim.state,
        };
        let more = Aerodynamics::NONE;
        (
            Dynamics {
                airframe,
                more,
                state,
            },
            trim.control,
        )
    }

    /// Flies `seconds` in steps of `dt` with a constant control that differs from trim.
    fn weave(
        dt: f64,
        seconds: f64,
        step: fn(&mut Dynamics, Control, f64) -> Result<(), PlantError>,
    ) -> VehicleState {
        let (mut plant, control) = trimmed(Airframe::REFERENCE);
        // The offset from trim is constant: a control that changes within a step would hide the
        // order.
        let control = Control {
            thrust: control.thrust + 2.0,
            elevator: control.elevator + 1.0,
        };
        for _ in 0..(seconds / dt).round() as usize {
            step(&mut plant, control, dt).unwrap();
        }
        plant.state
    }

    /// Largest difference of any component, each in its own unit.
    fn difference(a: &VehicleState, b: &VehicleState) -> f64 {
        let air = (a.air.to_vector() - b.air.to_vector()).amax();
        air.max((a.x - b.x).abs()).max((a.z - b.z).abs())
    }

    #[test]
    fn trim_stays_trim() {
        for airframe in [Airframe::PAPER, Airframe::REFERENCE] {
            let (mut plant, control) = trimmed(airframe);
            let start = plant.state;
            for _ in 0..2000 {
                plant.step(control, DT).unwrap();
            }
            let expected = VehicleState {
                x: start.air.airspeed * 20.0,
                ..start
            };
            assert!(difference(&plant.state, &expected) < 1e-8);
        }
    }

    #[test]
    fn runge_kutta_is_of_fourth_order() {
        // The flight is so short that the first swing is still visible. The steps are small enough
        // for the fast pitch mode.
        let exact = weave(0.001, 0.24, Dynamics::step);
        let coarse = difference(&weave(0.01, 0.24, Dynamics::step), &exact);
        let fine = difference(&weave(0.005, 0.24, Dynamics::step), &exact);
        let order = libm::log2(coarse / fine);
        assert!((3.8..4.2).contains(&order), "{order}");
    }

    #[test]
    fn euler_is_of_first_order() {
        let exact = weave(0.001, 2.0, Dynamics::step);
        let coarse = difference(&weave(0.01, 2.0, Dynamics::step_euler), &exact);
        let fine = difference(&weave(0.005, 2.0, Dynamics::step_euler), &exact);
        let order = libm::log2(coarse / fine);
        assert!((0.8..1.2).contains(&order), "{order}");
    }

    #[test]
    fn a_flights_step_is_exact_enough() {
        let full = weave(DT, 5.0, Dynamics::step);
        let half = weave(0.5 * DT, 5.0, Dynamics::step);
        assert!(
            difference(&full, &half) < 1e-6,
            "{}",
            difference(&full, &half)
        );
        let euler = weave(DT, 5.0, Dynamics::step_euler);
        let gap = difference(&full, &euler);
        assert!((1e-4..1.0).contains(&gap), "{gap}");
    }

    #[test]
    fn a_glide_pays_height_and_speed_for_drag() {
        let (mut plant, control) = trimmed(Airframe::PAPER);
        let a = plant.airframe;
        let energy =
            |s: &VehicleState| a.mass * (GRAVITY * s.z + 0.5 * s.air.airspeed * s.air.airspeed);
        let drag_power = |s: &VehicleState| {
            let lift = a.lift_zero + a.lift_alpha * s.air.angle_of_attack();
            let v = s.air.airspeed;
            0.5 * a.air_density
                * v
                * v
                * v
                * a.wing_area
                * (a.drag_zero + a.drag_induced * lift * lift)
        };
        let glide = Control {
            thrust: 0.0,
            ..control
        };
        let start = energy(&plant.state);
        let mut lost = 0.0;
        for _ in 0..500 {
            let before = plant.state;
            plant.step(glide, DT).unwrap();
            assert!(energy(&plant.state) < energy(&before));
            lost += 0.5 * DT * (drag_power(&before) + drag_power(&plant.state));
        }
        let gap = start - energy(&plant.state) - lost;
        assert!(gap.abs() < 1e-3 * lost, "{gap} of {lost} J");
    }

    /// Far beyond the stall the wing is a flat plate, to either side of its angle of no lift.
    #[test]
    fn the_wing_stalls_to_either_side() {
        let file = AircraftFile::known("zagi").unwrap();
        let (airframe, more) = (file.airframe(), Aerodynamics::of(&file));
        let no_lift = -airframe.lift_zero / airframe.lift_alpha;
        let lift = |angle: f64| {
            let air = AirState {
                airspeed: 15.0,
                pitch: no_lift + angle,
                pitch_rate: 0.0,
                flight_path: 0.0,
            };
            let at = more.at(&airframe, &air);
            at.lift_zero + at.lift_alpha * air.angle_of_attack()
        };
        for angle in [0.2, 0.45, 0.5, 0.7, 1.0] {
            assert!((lift(angle) + lift(-angle)).abs() < 1e-12, "{angle}");
        }
        for angle in [0.8, -0.8] {
            assert!(
                (lift(angle) - flat_plate(angle)).abs() < 1e-3,
                "{angle}: {}",
                lift(angle)
            );
        }
        assert!((lift(0.2) - airframe.lift_alpha * 0.2).abs() < 1e-3);
    }

    /// At the greatest angle of attack that roll-outs in space reach, no wing carries less than at a smaller one, and each carries
    /// nine tenths of what plans count on.
    #[test]
    fn plans_in_space_count_on_lift_that_is_there() {
        for (name, _) in AircraftFile::KNOWN {
            let file = AircraftFile::known(name).unwrap();
            let (airframe, more) = (file.airframe(), Aerodynamics::of(&file));
            let stall = file.lift.stall.unwrap_or(1.0);
            let model = SpaceModel::new(&airframe, file.cruise, stall, 20.0, [1.0; 2]).unwrap();
            let lift = |pitch: f64| {
                let air = AirState {
                    pitch,
                    ..model.trim.state
                };
                let at = more.at(&airframe, &air);
                at.lift_zero + at.lift_alpha * pitch
            };
            let [_, most] = model.reachable_angles();
            let counted = airframe.lift_zero + airframe.lift_alpha * most;
            assert!(lift(most) >= 0.9 * counted, "{name}: {}", lift(most));
            let smaller = (0..100).map(|part| most * f64::from(part) / 100.0);
            assert!(smaller.map(lift).all(|less| less < lift(most)), "{name}");
        }
    }

    #[test]
    fn nonsense_is_refused_and_changes_nothing() {
        let (mut plant, control) = trimmed(Airframe::PAPER);
        let start = plant.state;
        for bad in [f64::NAN, f64::INFINITY] {
            let thrust = Control {
                thrust: bad,
                ..control
            };
            let elevator = Control {
                elevator: bad,
                ..control
            };
            assert_eq!(plant.step(thrust, DT), Err(PlantError::NonFiniteControl));
            assert_eq!(
                plant.step_euler(elevator, DT),
                Err(PlantError::NonFiniteControl)
            );
        }
        assert_eq!(plant.state, start);
        plant.state.air.airspeed = 0.0;
        assert_eq!(plant.step(control, DT), Err(PlantError::NonFiniteState));
    }
}
