//! The 100 Hz step (estimate, reference, control) and the hand-over of trajectories.

use crate::config::TICK_PERIOD;
use crate::control::{Lqr, holds};
use crate::estimate::{Ahead, Estimator, Innovation, PositionVerdict, Sensors};
use crate::health::Health;
use crate::planner::{PlanSummary, SetupError, Verdict, check};
use crate::sense::SensorFrame;
use crate::settings::Settings;
use crate::trajectory::{Reference, Trajectory};
use crate::tuning::sensors::LONGEST_DOUBT;
use crate::tuning::tracking::{LEAST_ADVANCE, MOST_TURN};
use crate::vehicle::{
    AirState, Conditions, Control, ScanPoses, StallGuard, Trim, VehicleState, linearize,
};

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
    /// The flight loop flies a path of the lattice from now on, because no plan passes the gate.
    Pursuit,
    /// The flight loop flies a reserve from now on, because no plan and no path passes the gate.
    Reserve,
    /// The flight loop flies what strikes latest from now on, because nothing passes the gate.
    Latest,
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
    /// The filter's verdict on the position, if there was one.
    pub position: Option<PositionVerdict>,
    /// Whether the estimates have moved to another origin or turned by another bias of the pitch. A plan that was begun
    /// before does not fit them.
    pub moved: bool,
}

/// The state and the parts of the 100 Hz loop.
#[derive(Clone, Debug)]
pub struct FlightLoop {
    estimator: Estimator,
    /// The aircraft when the command of the last step acts. With a dead time, references and plans are for then.
    ahead: Ahead,
    lqr: Lqr,
    trim: Trim,
    cross_track: f64,
    airspeed_hold: f64,
    /// The guard against the stall, if the stall is known.
    guard: Option<StallGuard>,
    trajectory: Option<Trajectory>,
    /// Time \[s\] of the last step, and its command.
    last: Option<(f64, Control)>,
    jump: Option<Jump>,
    health: Health,
}

/// A time between two steps that the loop does not believe. Either the clock jumped or steps were lost; the next
/// position tells.
#[derive(Clone, Copy, Debug)]
struct Jump {
    /// Time of the step after it \[s\].
    time: f64,
    /// Part of it that the estimate was not moved on by \[s\].
    rest: f64,
}

impl FlightLoop {
    /// A loop that starts from level trim at the origin.
    ///
    /// # Errors
    /// [`SetupError`] if a setting is not valid, or if trim or gain do not exist.
    pub fn new(settings: &Settings) -> Result<Self, SetupError> {
        Ok(Self::regulated(settings, &Regulated::new(settings)?))
    }

    /// A loop with a regulator that was designed for these settings.
    // Inlined, so that its parts are written where the loop will be, not first on the stack.
    #[inline(always)]
    #[must_use]
    pub fn regulated(settings: &Settings, regulated: &Regulated) -> Self {
        let Regulated { trim, lqr } = *regulated;
        Self {
            // Not in a variable first: the estimator is larger than the stack should be.
            estimator: Estimator::new(settings, &trim),
            ahead: Ahead::level(settings.planner.altitude, &trim),
            lqr,
            trim,
            cross_track: settings.cross_track,
            airspeed_hold: settings.airspeed_hold,
            guard: (settings.planner.plane().and_then(|own| own.stall))
                .map(|stall| StallGuard::new(stall, &settings.airframe, &trim)),
            trajectory: None,
            last: None,
            jump: None,
            health: Health::default(),
        }
    }

    /// Makes one step at a time \[s\]. It predicts the motion since the last step under the last control,
    /// corrects the estimate by the measurement, and tracks the reference.
    pub fn step(&mut self, time: f64, frame: &SensorFrame) -> StepOutput {
        let elapsed = match self.last {
            Some((before, control)) => {
                let period = time - before;
                let air = frame.air.as_ref();
                let believed = (self.estimator).predict(period, control, air, &mut self.health);
                if period > believed {
                    let rest = period - believed;
                    self.jump = Some(Jump { time, rest });
                }
                believed
            }
            None => {
                self.estimator.begin();
                0.0
            }
        };
        let expected = self.estimator.state();
        let (innovation, position) = self.estimator.take(elapsed, frame, &mut self.health);
        if position == Some(PositionVerdict::Restarted)
            && let Some(trajectory) = &mut self.trajectory
        {
            // The origin of the positions has jumped, not the aircraft.
            let found = self.estimator.state();
            trajectory.shift((found.x - expected.x, found.z - expected.z));
        }
        self.settle_jump(time, position, expected.x);
        let turned = self.estimator.correct_pitch();
        if let (Some(by), Some(trajectory)) = (turned, &mut self.trajectory) {
            trajectory.turn(by);
        }
        self.ahead = self.estimator.ahead();

        let tracked = self
            .trajectory
            .as_ref()
            .and_then(|trajectory| trajectory.sample(time));
        let (mode, reference) = match tracked {
            Some(reference) => (Mode::Tracking, reference),
            None => (Mode::TrimHold, self.level_reference()),
        };
        let mut wanted = self.lqr.track(
            &self.ahead.state.air,
            &self.turned_back(&reference.state),
            reference.feedforward,
        );
        let slower = reference.state.air.airspeed - self.ahead.state.air.airspeed;
        wanted.thrust += self.airspeed_hold * slower;
        let control = self.limit(wanted);
        self.last = Some((time, control));
        self.estimator
            .expect_elevator(reference.feedforward.elevator);
        StepOutput {
            control,
            reference,
            mode,
            innovation,
            position,
            moved: turned.is_some() || position == Some(PositionVerdict::Restarted),
        }
    }

    /// Takes over the result of a planning cycle at a time \[s\], on the clock of [`Self::step`]. This function alone decides
    /// what the vehicle flies without a feasible trajectory.
    ///
    /// A trajectory of preset `flight` starts at the time of `begin` plus the latency of the settings. Call this function
    /// then: a trajectory that is taken over earlier replaces the last one at once, and until it starts the vehicle holds
    /// level trim.
    pub fn adopt(&mut self, time: f64, verdict: Verdict, offered: &Trajectory) -> Adoption {
        let valid = self
            .trajectory
            .as_ref()
            .is_some_and(|last| last.sample(time).is_some());
        let health = &mut self.health;
        let (adoption, counter) = match verdict {
            Verdict::Feasible => (Adoption::Feasible, &mut health.plans_feasible),
            // The planner made the last trajectory for an older map, without the obstacles that are in the
            // way now. The least-violating trajectory takes these obstacles into account.
            Verdict::LeastViolating => {
                (Adoption::LeastViolating, &mut health.plans_least_violating)
            }
            Verdict::Pursuit => (Adoption::Pursuit, &mut health.plans_pursuit),
            Verdict::Reserve => (Adoption::Reserve, &mut health.plans_reserve),
            Verdict::Latest => (Adoption::Latest, &mut health.plans_latest),
            Verdict::Nothing | Verdict::Kept if valid => (Adoption::Kept, &mut health.plans_kept),
            Verdict::Nothing | Verdict::Kept => (Adoption::TrimHold, &mut health.plans_trim_hold),
        };
        Health::count(counter);
        match adoption {
            Adoption::Kept => {}
            Adoption::TrimHold => self.trajectory = None,
            _ => self.trajectory = Some(offered.clone()),
        }
        adoption
    }

    /// Counts a cycle that the planner ended early because of a defect, and one whose plan the gate refused. Call it when a cycle has ended, with its summary.
    pub fn count_cycle(&mut self, summary: &PlanSummary) {
        if summary.inconsistent {
            Health::count(&mut self.health.planner_inconsistent);
        }
        if summary.refused.is_some() {
            Health::count(&mut self.health.plans_refused);
        }
    }

    /// The estimated motion.
    #[must_use]
    pub fn estimate(&self) -> &AirState {
        self.estimator.air()
    }

    /// The estimated position and motion.
    #[must_use]
    pub fn state(&self) -> VehicleState {
        self.estimator.state()
    }

    /// The first state of a plan: position and motion when the command of the last step acts. Without a dead time it is
    /// [`Self::state`].
    #[must_use]
    pub fn planned_from(&self) -> VehicleState {
        self.ahead.state
    }

    /// The poses of a scan with a stamp `age` ticks ago; see [`Estimator::poses_at`].
    #[must_use]
    pub fn poses_at(&self, age: u32) -> Option<ScanPoses> {
        self.estimator.poses_at(age)
    }

    /// The estimated wind and lift, which a plan uses with the state.
    #[must_use]
    pub fn conditions(&self) -> Conditions {
        self.estimator.conditions()
    }

    /// The commands that do what these controls of the known aircraft do.
    #[must_use]
    pub fn command_for(&self, wanted: Control) -> Control {
        self.estimator.actuators().command_for(wanted)
    }

    /// The trust in each sensor.
    #[must_use]
    pub fn sensors(&self) -> Sensors {
        self.estimator.sensors()
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
        let trim = self.trim.control;
        let sound = wanted.thrust.is_finite() && wanted.elevator.is_finite();
        let asked = if sound {
            let air = &self.ahead.state.air;
            let safe = (self.guard).map_or(wanted, |guard| guard.within(wanted, air));
            self.estimator.actuators().command_for(safe)
        } else {
            trim
        };
        let actuators = self.estimator.actuators();
        let control = (actuators.limits()).within(asked, trim, self.ahead.given, TICK_PERIOD);
        if !sound {
            Health::count(&mut self.health.commands_not_finite);
            return control;
        }
        if libm::fabs(control.thrust - asked.thrust) > 0.0 {
            Health::count(&mut self.health.thrust_limited);
        }
        if libm::fabs(control.elevator - asked.elevator) > 0.0 {
            Health::count(&mut self.health.elevator_limited);
        }
        control
    }

    /// Whether the time and the place of the aircraft are in doubt, because the time jumped and there was no
    /// position since. A scan then has no certain pose.
    #[must_use]
    pub fn is_lost(&self) -> bool {
        self.jump.is_some()
    }

    /// Finds by the first position after a jump of the time how much of it was flown, and delays the trajectory by
    /// the rest. `expected` is the place downrange \[m\] where the estimate was before the position.
    fn settle_jump(&mut self, time: f64, position: Option<PositionVerdict>, expected: f64) {
        let Some(jump) = self.jump else {
            return;
        };
        if position == Some(PositionVerdict::Accepted) {
            let state = self.estimator.state();
            let (ahead, _) = self.conditions().wind.ground_velocity(&state.air);
            let flown = (state.x - expected) / ahead.max(LEAST_ADVANCE);
            if let Some(trajectory) = &mut self.trajectory {
                trajectory.start += (jump.rest - flown).max(0.0);
            }
            self.jump = None;
        } else if position == Some(PositionVerdict::Restarted) || time - jump.time > LONGEST_DOUBT {
            self.jump = None;
        }
    }

    /// The motion of the reference, turned towards the path of the reference.
    fn turned_back(&self, reference: &VehicleState) -> AirState {
        let VehicleState { x, z, .. } = self.ahead.state;
        let (ahead, up) = self.conditions().wind.ground_velocity(&reference.air);
        let ahead = ahead.max(LEAST_ADVANCE);
        let speed = libm::sqrt(ahead * ahead + up * up);
        let off = (ahead * (reference.z - z) - up * (reference.x - x)) / speed;
        let turn = (self.cross_track * off).clamp(-MOST_TURN, MOST_TURN);
        AirState {
            pitch: reference.air.pitch + turn,
            flight_path: reference.air.flight_path + turn,
            ..reference.air
        }
    }

    fn level_reference(&self) -> Reference {
        let VehicleState { x, z, .. } = self.ahead.state;
        Reference {
            state: VehicleState {
                x,
                z,
                air: self.trim.state,
            },
            feedforward: self.trim.control,
        }
    }
}

/// Level trim, and the regulator about it. They take a deep stack to find and a small one to keep.
#[derive(Clone, Copy, Debug)]
pub struct Regulated {
    trim: Trim,
    lqr: Lqr,
}

impl Regulated {
    /// Checks the settings and designs the regulator about level trim.
    ///
    /// # Errors
    /// [`SetupError`] if a setting is not valid, or if trim or gain do not exist.
    #[inline(never)]
    pub fn new(settings: &Settings) -> Result<Self, SetupError> {
        let trim = check(settings)?;
        let design = Control {
            thrust: settings.design_thrust.unwrap_or(trim.control.thrust),
            ..trim.control
        };
        let linear = linearize(
            &settings.airframe,
            &trim.state,
            design,
            settings.design_jacobian,
        );
        let lqr = Lqr::design(&linear, &settings.regulator).map_err(SetupError::Regulator)?;
        if holds(settings, &trim, &lqr) {
            Ok(Self { trim, lqr })
        } else {
            Err(SetupError::Unstable)
        }
    }
}
