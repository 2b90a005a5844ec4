//! The trajectory that the regulator tracks: references at the stage boundaries, and interpolation
//! between them.

use crate::config::{KNOTS, STAGE_PERIOD, STAGES};
use crate::map::GridPoint;
use crate::paths::CollocationPoints;
use crate::qp::Solution;
use crate::vehicle::{
    AirState, Airframe, Control, PathControl, PathState, Trim, VehicleState, Wind,
};

/// Number of integration steps in a stage of a trajectory that is flown out. Roll-outs have the same number, so that
/// a stage ends where the next one begins. One step of the fourth order errs by 3 mm at most, at the fastest turns
/// (test `the_roll_out_is_of_fourth_order`).
pub(crate) const STEPS: u8 = 1;

/// The desired state and controls of the vehicle at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reference {
    /// Desired position and motion.
    pub state: VehicleState,
    /// Controls that give this motion by the plan's own model.
    pub feedforward: Control,
}

/// A plan over the whole horizon.
#[derive(Clone, Debug, PartialEq)]
pub struct Trajectory {
    /// Start time \[s\].
    pub start: f64,
    /// Length of a stage \[s\].
    pub stage_period: f64,
    /// References at the stage boundaries. The last reference has the controls of the last stage.
    pub knots: [Reference; KNOTS],
    /// Kind of interpolation between the references.
    between: Between,
}

/// Kind of interpolation between the references of a trajectory.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Between {
    /// Linear interpolation (the paper).
    Lines,
    /// Motion of the point mass in a steady wind. Thrust and rate of the angle of attack are constant over
    /// a stage.
    Flown(Airframe, Wind),
}

impl Trajectory {
    /// A trajectory of zeros, to be filled.
    #[must_use]
    pub const fn new() -> Self {
        let nothing = Reference {
            state: VehicleState {
                x: 0.0,
                z: 0.0,
                air: AirState {
                    airspeed: 0.0,
                    pitch: 0.0,
                    pitch_rate: 0.0,
                    flight_path: 0.0,
                },
            },
            feedforward: Control {
                thrust: 0.0,
                elevator: 0.0,
            },
        };
        Self {
            start: 0.0,
            stage_period: STAGE_PERIOD,
            knots: [nothing; KNOTS],
            between: Between::Lines,
        }
    }

    /// Empties the trajectory: it then has no reference at any time.
    pub fn clear(&mut self) {
        self.start = f64::INFINITY;
    }

    /// Moves the whole trajectory by `(x, z)` \[m\].
    pub fn shift(&mut self, (x, z): (f64, f64)) {
        for knot in &mut self.knots {
            knot.state.x += x;
            knot.state.z += z;
        }
    }

    /// Turns the motion of the whole trajectory by a known error of the pitch with which it was made \[rad\]. The way over
    /// ground stays.
    pub fn turn(&mut self, by: f64) {
        let airspeed = self.knots[0].state.air.airspeed;
        for knot in &mut self.knots {
            knot.state.air.pitch += by;
            knot.state.air.flight_path += by;
        }
        if let Between::Flown(_, wind) = &mut self.between {
            wind.z -= airspeed * by;
        }
    }

    /// Takes over a roll-out: its states at the stage boundaries, and the controls of the stages, which last
    /// `stage_period` \[s\] each.
    pub fn fly_out(
        &mut self,
        knots: &[PathState; KNOTS],
        controls: &[PathControl; STAGES],
        airframe: &Airframe,
        wind: &Wind,
        start: f64,
        stage_period: f64,
    ) {
        self.start = start;
        self.stage_period = stage_period;
        self.between = Between::Flown(*airframe, *wind);
        for (stage, (place, knot)) in self.knots.iter_mut().zip(knots).enumerate() {
            let (state, feedforward) = knot.reference(airframe, &controls[stage.min(STAGES - 1)]);
            *place = Reference { state, feedforward };
        }
    }

    /// Places a solution in the world. Its states are deviations from level flight at trim that starts at
    /// `(x, z)` \[m\].
    pub fn place(&mut self, solution: &Solution, trim: &Trim, start: f64, x: f64, z: f64) {
        self.start = start;
        self.stage_period = STAGE_PERIOD;
        self.between = Between::Lines;
        for (stage, (knot, state)) in self.knots.iter_mut().zip(&solution.states).enumerate() {
            let elapsed = STAGE_PERIOD * stage as f64;
            knot.state = VehicleState {
                x: x + trim.state.airspeed * elapsed + state[0],
                z: z + state[1],
                air: AirState {
                    airspeed: trim.state.airspeed + state[2],
                    pitch: trim.state.pitch + state[3],
                    pitch_rate: trim.state.pitch_rate + state[4],
                    flight_path: trim.state.flight_path + state[5],
                },
            };
            let [elevator, thrust] = solution.controls[stage.min(STAGES - 1)];
            knot.feedforward = Control {
                thrust: trim.control.thrust + thrust,
                elevator: trim.control.elevator + elevator,
            };
        }
    }

    /// Follows collocation points at cruise speed in steady climbs and descents. This is the paper's
    /// baseline, which tracks a path without refinement. It starts at the aircraft's `state`.
    pub fn follow(
        &mut self,
        points: &CollocationPoints,
        trim: &Trim,
        airframe: &Airframe,
        start: f64,
        state: &VehicleState,
    ) {
        self.start = start;
        self.stage_period = STAGE_PERIOD;
        self.between = Between::Lines;
        let mut slope = 0.0;
        for (stage, (knot, point)) in self.knots.iter_mut().zip(points).enumerate() {
            // The last point keeps the slope that led to it.
            if let Some(next) = points.get(stage + 1) {
                slope = libm::atan2(next.row - point.row, next.col - point.col);
            }
            // If there is no steady flight at this slope, the controls of the trim serve instead.
            let steady = Trim::at_speed(airframe, trim.state.airspeed, slope).unwrap_or(*trim);
            knot.state = VehicleState {
                x: state.x + point.col - GridPoint::AIRCRAFT.col,
                z: state.z + point.row - GridPoint::AIRCRAFT.row,
                air: AirState {
                    pitch: slope + steady.state.angle_of_attack(),
                    flight_path: slope,
                    ..trim.state
                },
            };
            knot.feedforward = steady.control;
            // A steep descent would need a negative thrust, which the propeller does not give.
            knot.feedforward.thrust = knot.feedforward.thrust.max(0.0);
        }
    }

    /// The reference at a time \[s\], interpolated between stage boundaries. It is `None` before the start
    /// and after the last stage.
    #[must_use]
    pub fn sample(&self, time: f64) -> Option<Reference> {
        let stages = (time - self.start) / self.stage_period;
        // Rounding may move a tick on the first or last boundary slightly outside.
        if !(-1e-6..=STAGES as f64 + 1e-6).contains(&stages) {
            return None;
        }
        let stage = (stages.max(0.0) as usize).min(STAGES - 1);
        let share = stages - stage as f64;
        let (from, to) = (&self.knots[stage], &self.knots[stage + 1]);
        if let Between::Flown(airframe, wind) = &self.between {
            let period = self.stage_period;
            return Some(flown(airframe, wind, from, to, share, period));
        }
        let mix = |a: f64, b: f64| a * (1.0 - share) + b * share;
        let air = from.state.air.to_vector() * (1.0 - share) + to.state.air.to_vector() * share;
        Some(Reference {
            state: VehicleState {
                x: mix(from.state.x, to.state.x),
                z: mix(from.state.z, to.state.z),
                air: AirState::from_vector(&air),
            },
            feedforward: Control {
                thrust: mix(from.feedforward.thrust, to.feedforward.thrust),
                elevator: mix(from.feedforward.elevator, to.feedforward.elevator),
            },
        })
    }
}

/// The motion of the point mass at a share of the way from one knot to the next.
fn flown(
    airframe: &Airframe,
    wind: &Wind,
    from: &Reference,
    to: &Reference,
    share: f64,
    stage_period: f64,
) -> Reference {
    let rise = to.state.air.angle_of_attack() - from.state.air.angle_of_attack();
    let control = PathControl {
        angle_of_attack_rate: rise / stage_period,
        thrust: from.feedforward.thrust,
    };
    let knot = PathState::of(&from.state);
    let at = knot.after_in(wind, airframe, &control, share * stage_period, STEPS);
    let (state, feedforward) = at.reference(airframe, &control);
    Reference { state, feedforward }
}

impl Default for Trajectory {
    fn default() -> Self {
        Self::new()
    }
}
