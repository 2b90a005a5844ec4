//! The 100 Hz step: estimate, reference, control; and the hand-over of trajectories.

use crate::config::TICK_PERIOD;
use crate::control::Lqr;
use crate::estimate::{
    Conditions, ConditionsEstimator, Ekf, Innovation, Verdict as MeasurementVerdict,
};
use crate::health::Health;
use crate::planner::{SetupError, Verdict, check_vehicle};
use crate::sense::SensorFrame;
use crate::settings::Settings;
use crate::trajectory::{Reference, Trajectory};
use crate::vehicle::{ActuatorLimits, AirState, Airframe, Control, Trim, VehicleState, linearize};

/// Least motion ahead over ground by which a course is reckoned [m/s].
const LEAST_ADVANCE: f64 = 1.0;
/// Most by which a reference is turned back to its path [rad].
const MOST_TURN: f64 = 0.15;

/// What flies the vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Level trim: there is no trajectory, or it has ended.
    TrimHold,
    /// A trajectory.
    Tracking,
}

/// What became of a finished planning cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Adoption {
    /// A feasible trajectory is flown from now on.
    Feasible,
    /// The least-violating trajectory is flown from now on.
    LeastViolating,
    /// The last trajectory is flown on.
    Kept,
    /// Level trim is held.
    TrimHold,
}

/// The outcome of one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepOutput {
    /// What the actuators are told.
    pub control: Control,
    /// What is tracked.
    pub reference: Reference,
    /// By what.
    pub mode: Mode,
    /// The verdicts on the measurement.
    pub innovation: Innovation,
    /// Whether the position was finite and used.
    pub position_used: bool,
}

/// Everything that runs at 100 Hz.
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
    position: (f64, f64),
    /// When the last step was, and what it commanded.
    last: Option<(f64, Control)>,
    /// What the actuators gave before the last command.
    given: Control,
    health: Health,
}

impl FlightLoop {
    /// A loop that starts from level trim at the origin.
    ///
    /// # Errors
    /// [`SetupError`] when trim or gain do not exist.
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
            last: None,
            given: trim.control,
            health: Health::default(),
        })
    }

    /// One step at a time [s]: predicts under the last control over the time since, corrects by
    /// the measurement, and tracks the reference.
    pub fn step(&mut self, time: f64, frame: &SensorFrame) -> StepOutput {
        if let Some((before, control)) = self.last {
            let period = time - before;
            // A time that is none, or goes back, moves no actuator.
            self.given = self.limits.given(control, self.given, period.max(0.0));
            if self.ekf.predict(self.given, period).is_err() {
                Health::count(&mut self.health.predictions_diverged);
            }
        }
        let innovation = self.ekf.update(&frame.measurement);
        self.count_verdict(innovation.airspeed);
        self.count_verdict(innovation.pitch);
        let position_used = frame.x.is_finite() && frame.z.is_finite();
        if position_used {
            self.position = (frame.x, frame.z);
            let air = self.ekf.estimate();
            if !self.conditions.update(time, self.position, air, self.given) {
                Health::count(&mut self.health.winds_refused);
            }
            let airframe = self.conditions().airframe(&self.airframe);
            self.ekf.set_airframe(&airframe);
        } else {
            Health::count(&mut self.health.positions_not_finite);
        }

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
        }
    }

    /// Takes over what a planning cycle has to offer. What happens without a feasible trajectory
    /// stands here and nowhere else.
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
            // The last trajectory was made for a map that did not show what is in the way now: the
            // least-violating one knows it.
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

    /// The state that a plan starts from: position as delivered, motion as estimated.
    #[must_use]
    pub fn state(&self) -> VehicleState {
        VehicleState {
            x: self.position.0,
            z: self.position.1,
            air: *self.ekf.estimate(),
        }
    }

    /// What a plan reckons with besides the state.
    #[must_use]
    pub fn conditions(&self) -> Conditions {
        self.conditions.conditions()
    }

    /// The trajectory being flown, if any.
    #[must_use]
    pub fn trajectory(&self) -> Option<&Trajectory> {
        self.trajectory.as_ref()
    }

    /// What went wrong so far.
    #[must_use]
    pub fn health(&self) -> &Health {
        &self.health
    }

    /// The command within the actuators' limits.
    fn limit(&mut self, wanted: Control) -> Control {
        if !(wanted.thrust.is_finite() && wanted.elevator.is_finite()) {
            Health::count(&mut self.health.commands_not_finite);
            return self.trim.control;
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

    /// The reference's motion, turned back to its path.
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
            MeasurementVerdict::NotFinite => {
                Health::count(&mut self.health.measurements_not_finite);
            }
        }
    }
}
