//! All estimates of the 100 Hz step: motion through the air, position, wind and lift.

mod ahead;
mod watching;

use super::verdicts::{count_position, count_verdict};
use super::{
    Actuators, BiasMonitor, Innovation, LaggedEkf, LiftEstimator, MOST_SCAN_AGE, MeasurementStatus,
    Navigation, PositionVerdict, SensorMonitor, Sensors, SteadyTurn, StuckDetector, Taken, Trust,
};
use crate::config::TICK_PERIOD;
use crate::health::Health;
use crate::sense::{AirData, Measurement, Position, SensorFrame};
use crate::settings::Settings;
use crate::tuning::pitch_bias::LEAST_TURN;
use crate::tuning::scan_match::{AGE_STEP, AGES};
use crate::tuning::sensors::{
    CHANGED, GAP_AIRSPEED, GAP_ANGLE, GAP_RATE, LONGEST_GAP, LONGEST_PREDICTION, POSITION_PERIOD,
};
use crate::vehicle::{
    AirState, Airframe, Conditions, Control, GRAVITY, Pose, ScanPoses, Trim, VehicleState,
};

/// The aircraft after the dead time of the elevator, under the commands that have been sent.
#[derive(Clone, Copy, Debug, Default)]
pub struct Ahead {
    /// Position and motion.
    pub state: VehicleState,
    /// The controls that the actuators will have given until then.
    pub given: Control,
}

/// The estimators of a flight.
#[derive(Clone, Debug)]
pub struct Estimator {
    airframe: Airframe,
    actuators: Actuators,
    air: LaggedEkf,
    navigation: Navigation,
    /// Estimator of the lift. Without it the lift is that of the known airframe.
    lift: Option<LiftEstimator>,
    airspeed_changes: StuckDetector,
    pitch_changes: StuckDetector,
    steady_turn: SteadyTurn,
    airspeed: SensorMonitor,
    pitch: SensorMonitor,
    position: SensorMonitor,
    biases: BiasMonitor,
    /// Amount by which the pitch reads too much, as the estimates take it \[rad\].
    pitch_error: f64,
    /// Part of the airspeed by which the sensors have corrected it since the motor's watch saw it [m/s].
    corrected: f64,
    /// Amount by which the estimated airspeed is behind the measured one of this tick [m/s].
    behind: Option<f64>,
}

impl Estimator {
    /// Estimators that start from level trim at the origin.
    #[inline(always)]
    #[must_use]
    pub fn new(settings: &Settings, trim: &Trim) -> Self {
        let airframe = settings.airframe;
        let lift = LiftEstimator::new(&airframe, trim.state.airspeed);
        Self {
            airframe,
            actuators: Actuators::new(settings, trim),
            air: LaggedEkf::new(airframe, settings.estimator, trim.state),
            navigation: Navigation::new(settings.wind_change, settings.planner.altitude),
            lift: settings.wind_change.is_some().then_some(lift),
            airspeed_changes: StuckDetector::new(),
            pitch_changes: StuckDetector::new(),
            steady_turn: SteadyTurn::default(),
            airspeed: SensorMonitor::new(1),
            pitch: SensorMonitor::new(1),
            position: SensorMonitor::new(POSITION_PERIOD),
            biases: BiasMonitor::new(&airframe, trim.state.airspeed),
            pitch_error: 0.0,
            corrected: 0.0,
            behind: None,
        }
    }

    /// The actuators by their model.
    #[must_use]
    pub fn actuators(&self) -> &Actuators {
        &self.actuators
    }

    /// The estimated motion through the air.
    #[must_use]
    pub fn air(&self) -> &AirState {
        self.air.present()
    }

    /// The estimated position and motion.
    #[must_use]
    pub fn state(&self) -> VehicleState {
        let (x, z) = self.navigation.smooth().position();
        VehicleState {
            x,
            z,
            air: *self.air.present(),
        }
    }

    /// The estimated wind and lift.
    #[must_use]
    pub fn conditions(&self) -> Conditions {
        Conditions {
            wind: self.navigation.smooth().wind(),
            lift: self.lift.as_ref().map_or(0.0, LiftEstimator::offset),
        }
    }

    /// The pose of the lidar at the tick that was `age` ticks ago. `None` if that was before the first step or more
    /// than [`MOST_SCAN_AGE`] ticks ago.
    // The poses of all ages call it, and each would hold a copy.
    #[inline(never)]
    #[must_use]
    pub fn pose_at(&self, age: u32) -> Option<Pose> {
        if age == 0 {
            return Some(Pose::of(&self.state()));
        }
        if age > MOST_SCAN_AGE {
            return None;
        }
        let ((x, z), pitch) = self.navigation.pose_at(age)?;
        Some(Pose { x, z, pitch })
    }

    /// [`Self::pose_at`] for each age that the stamp of a scan may hide. Where an earlier pose is not known, or the pitch is
    /// left out, it is that of the stamp.
    #[must_use]
    pub fn poses_at(&self, age: u32) -> Option<ScanPoses> {
        let stamped = self.pose_at(age)?;
        let mut poses = [stamped; AGES];
        let mut then = age;
        for pose in poses.iter_mut().skip(1).filter(|_| self.pitch.uses()) {
            then = then.saturating_add(AGE_STEP);
            *pose = self.pose_at(then).unwrap_or(stamped);
        }
        Some(poses)
    }

    /// Corrects the pitch by the bias that the watch has found, if it is another one than before. Gives the angle by which
    /// the motion turns \[rad\].
    pub fn correct_pitch(&mut self) -> Option<f64> {
        let by = self.pitch_error - self.biases.pitch().angle();
        if libm::fabs(by) < LEAST_TURN {
            return None;
        }
        self.pitch_error -= by;
        self.air.turn(by);
        self.navigation.turn(by, self.air.present());
        self.actuators.see_speed(None, 0.0);
        Some(by)
    }

    /// Notes the elevator command of the plan until the next step.
    pub fn expect_elevator(&mut self, planned: f64) {
        self.actuators.expect_elevator(planned);
    }

    /// The trust in each sensor.
    #[must_use]
    pub fn sensors(&self) -> Sensors {
        Sensors {
            airspeed: if self.biases.airspeed().found() {
                Trust::Excluded
            } else {
                self.airspeed.trust()
            },
            pitch: if self.biases.pitch().found() {
                self.pitch.trust().doubted()
            } else {
                self.pitch.trust()
            },
            position: self.position.trust(),
            elevator: self.actuators.elevator().trust(),
            motor: self.actuators.motor().trust(),
        }
    }

    /// Notes the motion at the first step.
    pub fn begin(&mut self) {
        self.navigation.predict(self.air.present(), 0.0);
    }

    /// Moves the estimates on by the time since the last step \[s\], in pieces of about a tick, and gives the time that
    /// it moved them on by. A time that goes back counts as none.
    ///
    /// A time that is too long is not believed. If the air data of this step agree with the motion of the last one, the
    /// clock has jumped, and one tick has passed. Else the aircraft flew without control meanwhile, and the
    /// estimates move on by [`LONGEST_PREDICTION`].
    pub fn predict(
        &mut self,
        elapsed: f64,
        control: Control,
        air: Option<&AirData>,
        health: &mut Health,
    ) -> f64 {
        let believed = (0.0..=LONGEST_PREDICTION).contains(&elapsed);
        let mut period = elapsed;
        if !believed {
            Health::count(&mut health.time_jumps);
            // A time that is not a number is in no range and not greater than any.
            period = match air {
                _ if elapsed.is_nan() || elapsed <= 0.0 => 0.0,
                Some(air) if self.agrees(&air.measurement) => TICK_PERIOD,
                _ => LONGEST_PREDICTION,
            };
            // Not `clamp`, which gives no number for a time that is none.
            let gap = if elapsed > LONGEST_PREDICTION {
                elapsed.min(LONGEST_GAP)
            } else {
                LONGEST_PREDICTION
            };
            self.navigation.doubt(self.air.present().airspeed * gap);
        }
        let pieces = libm::round(period / TICK_PERIOD).max(1.0);
        for _ in 0..pieces as u32 {
            let piece = period / pieces;
            self.actuators.follow(control, piece);
            if self.air.predict(self.actuators.effective(), piece).is_err() {
                Health::count(&mut health.predictions_diverged);
            }
            self.navigation.predict(self.air.present(), piece);
        }
        if !believed && period > TICK_PERIOD {
            self.actuators.see_speed(None, 0.0);
            let airspeed = GAP_AIRSPEED * self.air.present().airspeed;
            self.air.doubt([airspeed, GAP_ANGLE, GAP_RATE, GAP_ANGLE]);
        }
        period
    }

    /// Whether a measurement is that of the present motion.
    fn agrees(&self, measured: &Measurement) -> bool {
        let now = self.air.present();
        let tuning = self.air.tuning();
        let within = |off: f64, variance: f64| off * off <= CHANGED * CHANGED * variance;
        within(measured.airspeed - now.airspeed, tuning.airspeed_variance)
            && within(
                measured.pitch - self.pitch_error - now.pitch,
                tuning.pitch_variance,
            )
    }

    /// Corrects the estimates by what arrived `elapsed` \[s\] after the last step.
    pub fn take(
        &mut self,
        elapsed: f64,
        frame: &SensorFrame,
        health: &mut Health,
    ) -> (Innovation, Option<PositionVerdict>) {
        let innovation = self.measure(frame.air.as_ref());
        self.watch_elevator(elapsed, frame.air.as_ref(), innovation);
        count_verdict(innovation.airspeed, health);
        count_verdict(innovation.pitch, health);
        let position = self.locate(elapsed, frame.position.as_ref());
        count_position(position, health);
        self.watch_ground(elapsed, frame.air.as_ref());
        (innovation, position)
    }

    /// Corrects the motion by what was measured. Values that a sensor only repeats, and those of a sensor that
    /// is not trusted, are not used.
    fn measure(&mut self, air: Option<&AirData>) -> Innovation {
        let Some(air) = air else {
            self.airspeed.tick(None);
            self.pitch.tick(None);
            return Innovation::both(MeasurementStatus::Missing);
        };
        let fresh = Measurement {
            airspeed: self.airspeed_changes.take(air.measurement.airspeed),
            pitch: self.pitch_changes.take(air.measurement.pitch) - self.pitch_error,
        };
        let biased = self.biases.airspeed().found();
        let used = [self.airspeed.uses() && !biased, self.pitch.uses()];
        let estimate = self.air.present().airspeed;
        (self.biases).compare_airspeed(air.measurement.airspeed, estimate, TICK_PERIOD);
        let Taken::Measured(mut innovation) = self.air.take(air.age, &fresh, used) else {
            self.airspeed.tick(None);
            self.pitch.tick(None);
            return Innovation::both(MeasurementStatus::Late);
        };
        self.corrected += self.air.present().airspeed - estimate;
        if innovation.airspeed == MeasurementStatus::Accepted {
            self.behind = Some(fresh.airspeed - self.air.present().airspeed);
        }
        if self.airspeed_changes.frozen() {
            innovation.airspeed = MeasurementStatus::Frozen;
        }
        if self.pitch_changes.frozen() {
            innovation.pitch = MeasurementStatus::Frozen;
        }
        if self.steady_turn.take(fresh.pitch, innovation.pitch) {
            self.air.doubt([0.0, GAP_ANGLE, GAP_RATE, 0.0]);
        }
        self.airspeed.tick(Some(innovation.airspeed.is_good()));
        let turns = !self.actuators.elevator().pitch_fails();
        self.pitch.tick(Some(innovation.pitch.is_good() && turns));
        innovation
    }

    /// Takes in the position, if there is one, and then estimates the lift.
    fn locate(&mut self, elapsed: f64, fix: Option<&Position>) -> Option<PositionVerdict> {
        let air = *self.air.present();
        let (_, rise) = self.navigation.correct_motion(&air);
        let verdict = fix.map(|fix| self.navigation.take(fix));
        self.position.tick(match verdict {
            Some(PositionVerdict::Accepted) => Some(true),
            Some(PositionVerdict::Held) | None => None,
            Some(_) => Some(false),
        });
        self.watch_motor(elapsed, verdict);
        let effective = self.actuators.effective();
        let climb = rise + self.navigation.quick().wind().z;
        if let Some(lift) = &mut self.lift {
            if verdict == Some(PositionVerdict::Restarted) || !self.navigation.is_settled() {
                lift.interrupt();
            } else {
                lift.update(elapsed, climb, &air, effective);
                if let Some(behind) = self.behind.take() {
                    // The tilts as they would seem if nothing corrected the pitch.
                    let by_wind =
                        self.pitch_error - self.navigation.quick().wind().z / air.airspeed;
                    let by_airspeed = self.pitch_error + behind * self.air.follows() / GRAVITY;
                    self.biases.see_tilt(by_wind, by_airspeed, elapsed);
                }
                let (wind, observed) = (self.navigation.quick().wind().x, lift.observed());
                if let Some(before) = (self.biases).see_wind(wind, observed, air.airspeed, elapsed)
                {
                    self.air.shift_airspeed(wind - before.wind);
                    self.navigation.set_wind_along(before.wind);
                    lift.set_offset(before.lift);
                    self.actuators.see_speed(None, 0.0);
                }
            }
        }
        let airframe = self.conditions().airframe(&self.airframe);
        self.air.set_airframe(&airframe);
        verdict
    }
}
