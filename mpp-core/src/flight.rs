//! The 100 Hz step (estimate, reference, control) and the hand-over of trajectories.

mod design;

use crate::config::TICK_PERIOD;
use crate::control::Lqr;
use crate::estimate::{
    Changes, Conditions, ConditionsEstimator, Ekf, Innovation, Measurement,
    Verdict as MeasurementVerdict,
};
use crate::health::Health;
use crate::planner::{SetupError, Verdict, check_vehicle};
use crate::sense::SensorFrame;
use crate::settings::Settings;
use crate::trajectory::{Reference, Trajectory};
use crate::tuning::sensors::LONGEST_PREDICTION;
use crate::tuning::tracking::{LEAST_ADVANCE, MOST_TURN};
use crate::vehicle::{ActuatorLimits, AirState, Airframe, Control, Trim, VehicleState, linearize};
pub use design::Design;

/// The source of the reference: a trajectory, or level trim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// The regulator holds level trim, because there is no trajectory or the trajectory has ended.
    TrimHold,
    /// The regulator tracks a trajectory.
    Tracking,
}

/// The consequence of a finished planning cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Adoption {
    /// The flight loop flies a new, feasible trajectory from now on.
    Feasible,
    /// The flight loop flies a new trajectory from now on, although it violates some rows or its margin.
    LeastViolating,
    /// The flight loop continues the last trajectory.
    Kept,
    /// The flight loop holds level trim.
    TrimHold,
}

/// The outcome of one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepOutput {
    /// The command to the actuators.
    pub control: Control,
    /// The reference that the regulator tracks.
    pub reference: Reference,
    /// The source of the reference: a trajectory, or level trim.
    pub mode: Mode,
    /// The filter's verdicts on the measurement.
    pub innovation: Innovation,
    /// Whether the position was finite and new. The step uses no other.
    pub position_used: bool,
    /// Whether the position was finite.
    pub position_finite: bool,
}

/// The state and the parts of the 100 Hz loop.
#[derive(Clone, Debug)]
pub struct FlightLoop {
    ekf: Ekf,
    airframe: Airframe,
    conditions: ConditionsEstimator,
    lqr: Lqr,
    trim: Trim,
    limits: ActuatorLimits,
    cross_track: f64,
    airspeed_hold: f64,
    trajectory: Option<Trajectory>,
    /// The position as far as it is known, and as it was delivered last \[m\].
    position: (f64, f64),
    delivered: Option<(f64, f64)>,
    /// Time \[s\] of the last step, and its command.
    last: Option<(f64, Control)>,
    /// The controls that the actuators gave up to the last step, by the model of the actuators.
    given: Control,
    airspeed_changes: Changes,
    pitch_changes: Changes,
    health: Health,
}

impl FlightLoop {
    /// A loop that starts from level trim at the origin.
    ///
    /// # Errors
    /// [`SetupError`] if a setting is not valid, or if trim or gain do not exist.
    pub fn new(settings: &Settings) -> Result<Self, SetupError> {
        let airframe = &settings.airframe;
        let trim = settings.cruise.trim(airframe).map_err(SetupError::Trim)?;
        check_vehicle(settings, &trim)?;
        let design = Control {
            thrust: settings.design_thrust.unwrap_or(trim.control.thrust),
            ..trim.control
        };
        let linear = linearize(airframe, &trim.state, design, settings.design_jacobian);
        let lqr = Lqr::design(&linear, &settings.regulator).map_err(SetupError::Regulator)?;
        Ok(Self {
            ekf: Ekf::new(*airframe, settings.estimator, trim.state),
            airframe: *airframe,
            conditions: ConditionsEstimator::new(settings),
            lqr,
            trim,
            limits: settings.actuators,
            cross_track: settings.cross_track,
            airspeed_hold: settings.airspeed_hold,
            trajectory: None,
            position: (0.0, settings.planner.altitude),
            delivered: None,
            last: None,
            given: trim.control,
            airspeed_changes: Changes::new(),
            pitch_changes: Changes::new(),
            health: Health::default(),
        })
    }

    /// Makes one step at a time \[s\]. It predicts the motion since the last step under the last control,
    /// corrects the estimate by the measurement, and tracks the reference.
    pub fn step(&mut self, time: f64, frame: &SensorFrame) -> StepOutput {
        let mut elapsed = 0.0;
        if let Some((before, control)) = self.last {
            elapsed = self.predict(time - before, control);
        }
        let innovation = self.measure(&frame.measurement);
        self.count_verdict(innovation.airspeed);
        self.count_verdict(innovation.pitch);
        let position_used = self.locate(time, elapsed, (frame.x, frame.z));

        let tracked = self
            .trajectory
            .as_ref()
            .and_then(|trajectory| trajectory.sample(time));
        let (mode, reference) = match tracked {
            Some(reference) => (Mode::Tracking, reference),
            None => (Mode::TrimHold, self.level_reference()),
        };
        let mut wanted = self.lqr.track(
            self.ekf.estimate(),
            &self.turned_back(&reference.state),
            reference.feedforward,
        );
        let slower = reference.state.air.airspeed - self.ekf.estimate().airspeed;
        wanted.thrust += self.airspeed_hold * slower;
        let control = self.limit(wanted);
        self.last = Some((time, control));
        StepOutput {
            control,
            reference,
            mode,
            innovation,
            position_used,
            position_finite: frame.x.is_finite() && frame.z.is_finite(),
        }
    }

    /// Moves the estimate on by the time since the last step \[s\], in pieces of about a tick. A time that
    /// goes back counts as none. Of a long time only the last part is believed: the clock has jumped, or the
    /// aircraft was not controlled meanwhile.
    /// Gives the time that it believes \[s\].
    fn predict(&mut self, elapsed: f64, control: Control) -> f64 {
        let believed = (0.0..=LONGEST_PREDICTION).contains(&elapsed);
        if !believed {
            Health::count(&mut self.health.time_jumps);
        }
        // A time that is not a number is in no range and not greater than any.
        let period = if believed {
            elapsed
        } else if elapsed > 0.0 {
            LONGEST_PREDICTION
        } else {
            0.0
        };
        let pieces = libm::round(period / TICK_PERIOD).max(1.0);
        for _ in 0..pieces as u32 {
            let piece = period / pieces;
            self.given = self.limits.given(control, self.given, piece);
            if self.ekf.predict(self.given, piece).is_err() {
                Health::count(&mut self.health.predictions_diverged);
            }
        }
        period
    }

    /// Takes a position `(x, z)` \[m\] if it is new. A position that repeats the one before to the last bit is
    /// held by its source: an aircraft never stands still. Without a new one the last one moves on with the
    /// estimated motion over ground.
    fn locate(&mut self, time: f64, elapsed: f64, delivered: (f64, f64)) -> bool {
        let finite = delivered.0.is_finite() && delivered.1.is_finite();
        let bits = |(x, z): (f64, f64)| (x.to_bits(), z.to_bits());
        let held = self
            .delivered
            .is_some_and(|last| bits(last) == bits(delivered));
        if !finite {
            Health::count(&mut self.health.positions_not_finite);
        } else if held {
            Health::count(&mut self.health.positions_held);
        }
        if !finite || held {
            let air = self.ekf.estimate();
            let (ahead, up) = self.conditions.conditions().wind.ground_velocity(air);
            self.position.0 += ahead * elapsed;
            self.position.1 += up * elapsed;
            return false;
        }
        self.delivered = Some(delivered);
        self.position = delivered;
        let air = self.ekf.estimate();
        if !self.conditions.update(time, self.position, air, self.given) {
            Health::count(&mut self.health.winds_refused);
        }
        let airframe = self.conditions().airframe(&self.airframe);
        self.ekf.set_airframe(&airframe);
        true
    }

    /// Corrects the estimate by what was measured, without values that the sensors only repeat.
    fn measure(&mut self, measured: &Measurement) -> Innovation {
        let fresh = Measurement {
            airspeed: self.airspeed_changes.take(measured.airspeed),
            pitch: self.pitch_changes.take(measured.pitch),
        };
        let mut innovation = self.ekf.update(&fresh);
        if self.airspeed_changes.frozen() {
            innovation.airspeed = MeasurementVerdict::Frozen;
        }
        if self.pitch_changes.frozen() {
            innovation.pitch = MeasurementVerdict::Frozen;
        }
        innovation
    }

    /// Takes over the result of a planning cycle. This function alone decides what the vehicle flies without
    /// a feasible trajectory.
    pub fn adopt(&mut self, time: f64, verdict: Verdict, offered: &Trajectory) -> Adoption {
        let valid = self
            .trajectory
            .as_ref()
            .is_some_and(|last| last.sample(time).is_some());
        match (verdict, valid) {
            (Verdict::Feasible, _) => {
                self.trajectory = Some(offered.clone());
                Health::count(&mut self.health.plans_feasible);
                Adoption::Feasible
            }
            // The planner made the last trajectory for an older map, without the obstacles that are in the
            // way now. The least-violating trajectory takes these obstacles into account.
            (Verdict::LeastViolating, _) => {
                self.trajectory = Some(offered.clone());
                Health::count(&mut self.health.plans_least_violating);
                Adoption::LeastViolating
            }
            (Verdict::Nothing, true) => {
                Health::count(&mut self.health.plans_kept);
                Adoption::Kept
            }
            (Verdict::Nothing, false) => {
                self.trajectory = None;
                Health::count(&mut self.health.plans_trim_hold);
                Adoption::TrimHold
            }
        }
    }

    /// The estimated motion.
    #[must_use]
    pub fn estimate(&self) -> &AirState {
        self.ekf.estimate()
    }

    /// The first state of a plan: the delivered position and the estimated motion.
    #[must_use]
    pub fn state(&self) -> VehicleState {
        VehicleState {
            x: self.position.0,
            z: self.position.1,
            air: *self.ekf.estimate(),
        }
    }

    /// The estimated wind and lift that a plan uses besides the state.
    #[must_use]
    pub fn conditions(&self) -> Conditions {
        self.conditions.conditions()
    }

    /// The last trajectory that the loop took over, if any.
    #[must_use]
    pub fn trajectory(&self) -> Option<&Trajectory> {
        self.trajectory.as_ref()
    }

    /// The counters of all events so far.
    #[must_use]
    pub fn health(&self) -> &Health {
        &self.health
    }

    /// Limits a command to the range of the actuators, and counts each limitation.
    fn limit(&mut self, wanted: Control) -> Control {
        if !(wanted.thrust.is_finite() && wanted.elevator.is_finite()) {
            Health::count(&mut self.health.commands_not_finite);
            let trim = self.trim.control;
            return self.limits.within(trim, trim, self.given, TICK_PERIOD);
        }
        let trim = self.trim.control;
        let control = self.limits.within(wanted, trim, self.given, TICK_PERIOD);
        if libm::fabs(control.thrust - wanted.thrust) > 0.0 {
            Health::count(&mut self.health.thrust_limited);
        }
        if libm::fabs(control.elevator - wanted.elevator) > 0.0 {
            Health::count(&mut self.health.elevator_limited);
        }
        control
    }

    /// The motion of the reference, turned towards the path of the reference.
    fn turned_back(&self, reference: &VehicleState) -> AirState {
        let (x, z) = self.position;
        let (ahead, up) = self.conditions().wind.ground_velocity(&reference.air);
        let ahead = ahead.max(LEAST_ADVANCE);
        let off = (ahead * (reference.z - z) - up * (reference.x - x)) / libm::hypot(ahead, up);
        let turn = (self.cross_track * off).clamp(-MOST_TURN, MOST_TURN);
        AirState {
            pitch: reference.air.pitch + turn,
            flight_path: reference.air.flight_path + turn,
            ..reference.air
        }
    }

    fn level_reference(&self) -> Reference {
        Reference {
            state: VehicleState {
                x: self.position.0,
                z: self.position.1,
                air: self.trim.state,
            },
            feedforward: self.trim.control,
        }
    }

    fn count_verdict(&mut self, verdict: MeasurementVerdict) {
        match verdict {
            MeasurementVerdict::Accepted => {}
            MeasurementVerdict::Gated => Health::count(&mut self.health.measurements_gated),
            MeasurementVerdict::Frozen => Health::count(&mut self.health.measurements_frozen),
            MeasurementVerdict::NotFinite => {
                Health::count(&mut self.health.measurements_not_finite);
            }
        }
    }
}
