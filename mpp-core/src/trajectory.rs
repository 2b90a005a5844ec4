//! The trajectory that the regulator tracks: references at the stage boundaries, and interpolation
//! between them.

use crate::config::{KNOTS, STAGE_PERIOD, STAGES};
use crate::units::Units;
use crate::vehicle::{
    AirState, Airframe, Control, PathControl, PathState, ThrustLag, VehicleState, Wind,
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

/// A plan as the point mass flies it out, in the planner's [own units](Units).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RollOut {
    /// States at the stage boundaries.
    pub knots: [PathState; KNOTS],
    /// Commands of the stages.
    pub controls: [PathControl; STAGES],
    /// Thrust at the start. From there it follows the commands with the lag of the actuators.
    pub thrust: f64,
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
#[expect(
    clippy::large_enum_variant,
    reason = "there is no heap to put the larger one on"
)]
#[derive(Clone, Copy, Debug, PartialEq)]
enum Between {
    /// Linear interpolation (the paper).
    Lines,
    /// Motion of the point mass in a steady wind. The rate of the angle of attack is constant over a stage, and the
    /// thrust has its mean.
    Flown(Medium),
}

/// The values on which the motion between the references of a roll-out depends.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Medium {
    airframe: Airframe,
    wind: Wind,
    lag: ThrustLag,
    /// Mean thrust of each stage \[N\].
    thrusts: [f64; STAGES],
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

    /// Starts a plan whose references are joined by straight lines, as in the paper. The caller fills the references.
    #[cfg(feature = "paper")]
    pub(crate) fn start_lines(&mut self, start: f64) {
        self.start = start;
        self.stage_period = STAGE_PERIOD;
        self.between = Between::Lines;
    }

    /// A sum over everything on which [`Self::sample`] depends. It changes with each single bit that flips.
    // Not inlined: planner and step need the same one.
    #[inline(never)]
    #[must_use]
    pub fn seal(&self) -> u64 {
        let mut seal = 0_u64;
        let mut take = |number: f64| seal = seal.rotate_left(7) ^ number.to_bits();
        take(self.start);
        take(self.stage_period);
        for Reference { state, feedforward } in &self.knots {
            let air = &state.air;
            take(state.x);
            take(state.z);
            take(air.airspeed);
            take(air.pitch);
            take(air.pitch_rate);
            take(air.flight_path);
            take(feedforward.thrust);
            take(feedforward.elevator);
        }
        if let Between::Flown(medium) = &self.between {
            medium.airframe.numbers().into_iter().for_each(&mut take);
            take(medium.wind.x);
            take(medium.wind.z);
            medium.lag.numbers().into_iter().for_each(&mut take);
            medium.thrusts.into_iter().for_each(&mut take);
        }
        seal
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
        if let Between::Flown(medium) = &mut self.between {
            medium.wind.z -= airspeed * by;
        }
    }

    /// Takes over a roll-out in own units, for an airframe and a wind in SI units.
    pub fn fly_out(
        &mut self,
        flown: &RollOut,
        units: &Units,
        airframe: &Airframe,
        wind: &Wind,
        lag: &ThrustLag,
        start: f64,
    ) {
        self.start = start;
        self.stage_period = STAGE_PERIOD * units.time;
        let mut thrusts = [0.0; STAGES];
        let (mut given, mut command, mut acting) = (flown.thrust, 0.0, PathControl::default());
        for (stage, (place, knot)) in self.knots.iter_mut().zip(&flown.knots).enumerate() {
            // The last knot has the controls of the last stage.
            if let (Some(control), Some(mean)) = (flown.controls.get(stage), thrusts.get_mut(stage))
            {
                acting = units.si_path_control(control);
                command = acting.thrust;
                acting.thrust = lag.mean(given, control.thrust) * units.force();
                given = lag.end(given, control.thrust);
                *mean = acting.thrust;
            }
            *place = commanded(&units.si_path_state(knot), airframe, &acting, command);
        }
        self.between = Between::Flown(Medium {
            airframe: *airframe,
            wind: *wind,
            lag: *lag,
            thrusts,
        });
    }

    /// The thrust that the motor gives at a time \[s\], by its lag. `None` where [`Self::sample`] gives none, and for
    /// a plan that is no roll-out.
    #[must_use]
    pub fn thrust(&self, time: f64) -> Option<f64> {
        let Between::Flown(medium) = &self.between else {
            return None;
        };
        let (stage, share) = self.stage_at(time)?;
        let command = self.knots[stage].feedforward.thrust;
        Some((medium.lag).within(share, medium.thrusts[stage], command))
    }

    /// The stage at a time \[s\], and the share of it that is over. `None` before the start and after the last stage.
    fn stage_at(&self, time: f64) -> Option<(usize, f64)> {
        let stages = (time - self.start) / self.stage_period;
        // Rounding may move a tick on the first or last boundary slightly outside.
        if !(-1e-6..=STAGES as f64 + 1e-6).contains(&stages) {
            return None;
        }
        let stage = (stages.max(0.0) as usize).min(STAGES - 1);
        Some((stage, stages - stage as f64))
    }

    /// The reference at a time \[s\], interpolated between stage boundaries. It is `None` before the start
    /// and after the last stage.
    #[must_use]
    pub fn sample(&self, time: f64) -> Option<Reference> {
        let (stage, share) = self.stage_at(time)?;
        let (from, to) = (&self.knots[stage], &self.knots[stage + 1]);
        if let Between::Flown(medium) = &self.between {
            let thrust = medium.thrusts[stage];
            return Some(medium.flown([from, to], thrust, share, self.stage_period));
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

impl Medium {
    /// The motion of the point mass at a share of the way from one knot to the next, under the mean thrust.
    fn flown(
        &self,
        [from, to]: [&Reference; 2],
        thrust: f64,
        share: f64,
        stage_period: f64,
    ) -> Reference {
        let rise = to.state.air.angle_of_attack() - from.state.air.angle_of_attack();
        let control = PathControl {
            angle_of_attack_rate: rise / stage_period,
            thrust,
        };
        let knot = PathState::of(&from.state);
        let elapsed = share * stage_period;
        let at = knot.after_in(&self.wind, &self.airframe, &control, elapsed, STEPS);
        commanded(&at, &self.airframe, &control, from.feedforward.thrust)
    }
}

/// The reference of a point mass that moves under `control`, with the thrust to command.
fn commanded(at: &PathState, airframe: &Airframe, control: &PathControl, thrust: f64) -> Reference {
    let (state, mut feedforward) = at.reference(airframe, control);
    feedforward.thrust = thrust;
    Reference { state, feedforward }
}
