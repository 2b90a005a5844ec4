//! The step in space, 100 times a second.

use super::cycle::Flown;
use super::{Session, SpaceMemory, SpaceTask};
use crate::convert::sensor_states;
use crate::ticks;
use hil_protocol::{
    ActuatorCommand, ControlMode, RejectionCause, SensorFrame, SpaceReport, StepReport,
    SurfaceCommand,
};
use mpp_core::control::SpaceMotion;
use mpp_core::estimate::{InertialSample, MeasurementStatus, PositionVerdict, SpaceFix, Trust};
use mpp_core::vehicle::{Control, LateralControl, SpaceControl, SpaceModel, SpacePath};

impl SpaceTask {
    /// Makes the tick of a sensor frame, unless the frame is old.
    pub(super) fn sensor_frame(
        &mut self,
        frame: &SensorFrame,
        memory: &mut SpaceMemory<'_>,
        send: &mut impl FnMut(&[u8]),
    ) {
        let Some(session) = &mut self.session else {
            return self.reject(RejectionCause::NotConfigured, send);
        };
        let found = frame.tick;
        let expected = session.last_tick.map_or(found, |last| last.wrapping_add(1));
        let old = ticks(expected, found) < 0;
        if !old {
            session.last_tick = Some(found);
        }
        if found != expected {
            self.reject(RejectionCause::TickOrder { expected, found }, send);
        }
        if !old {
            self.tick(frame, memory, send);
        }
    }

    fn tick(
        &mut self,
        frame: &SensorFrame,
        memory: &mut SpaceMemory<'_>,
        send: &mut impl FnMut(&[u8]),
    ) {
        let tick = frame.tick;
        let Some(session) = &mut self.session else {
            return;
        };
        let finite = session.estimate(frame);
        session.model.wind = session.estimator.wind();
        // A tick tells the report of a plan, the next one its trajectory: both in one would be its longest by far.
        let report = session.untold.take();
        let shown = core::mem::take(&mut session.unshown);
        let trajectory = session.flown.some().filter(|_| shown).map(Flown::told);
        session.unshown = report.as_ref().is_some_and(|it| it.outcome.is_new());
        session.take_over(memory.planner, tick);
        // A plan is followed in the wind for which it was made, so that a change of the wind is no error of the velocity.
        let model = (session.flown.some()).map_or(&session.model, |flown| &flown.model);
        let (answer, place) = match session.estimator.motion_in(&model.wind) {
            Some(motion) => {
                let (answer, followed) = session.step(tick, &motion, model);
                (answer, Some((motion.path.position, followed)))
            }
            None => (session.level(tick), None),
        };
        session.surfaces = LateralControl {
            aileron: answer.surfaces.aileron,
            rudder: answer.surfaces.rudder,
        };
        if !finite {
            self.reject(RejectionCause::NonFiniteSensor, send);
        }
        if let Some(report) = report {
            self.emit(&report, send);
        }
        if let Some(trajectory) = trajectory {
            self.emit(&trajectory, send);
        }
        if let Some((lateral, step)) = &answer.reports {
            self.emit(lateral, send);
            self.emit(step, send);
        }
        self.emit(&answer.surfaces, send);
        self.emit(&answer.command, send);
        match place {
            Some(place) => self.plan(tick, place, memory.planner),
            // Points without a place show nothing.
            None => self.sweep.clear(),
        }
    }
}

/// What a tick answers.
struct Answer {
    reports: Option<(SpaceReport, StepReport)>,
    surfaces: SurfaceCommand,
    command: ActuatorCommand,
}

impl Session {
    /// Gives the estimator what was measured since the last tick, each with its age. Returns whether all numbers are finite.
    fn estimate(&mut self, frame: &SensorFrame) -> bool {
        let age = |tick: u32| frame.tick.wrapping_sub(tick);
        let sample = self.inertial.take().map(|told| InertialSample {
            age: age(told.tick),
            attitude: told.attitude.map(f64::from),
            sigma: f64::from(told.sigma),
            rates: told.rates.map(f64::from),
            force: told.force.map(f64::from),
        });
        let fix = self.position.take().map(|told| SpaceFix {
            age: age(told.tick),
            position: told.position,
            sigma: f64::from(told.sigma),
            velocity: told
                .velocity
                .map(|(it, sigma)| (it.map(f64::from), f64::from(sigma))),
        });
        let airspeed = frame.air.map(|air| air.airspeed);
        let told = [
            self.estimator.predict(sample.as_ref()),
            self.estimator.observe_airspeed(airspeed, &self.surfaces),
        ];
        let fix = self.estimator.observe_fix(fix.as_ref());
        fix != Some(PositionVerdict::NotFinite) && !told.contains(&MeasurementStatus::NotFinite)
    }

    /// Neutral surfaces and the elevator of level flight, as long as nothing is known of the position.
    fn level(&self, tick: u32) -> Answer {
        let Control { thrust, elevator } = self.model.trim.control;
        Answer {
            reports: None,
            surfaces: SurfaceCommand {
                tick,
                aileron: 0.0,
                rudder: 0.0,
            },
            command: ActuatorCommand {
                tick,
                thrust,
                elevator,
                mode: ControlMode::TrimHold,
            },
        }
    }

    /// The answer, and the state of the plan that is followed in this tick.
    fn step(&self, tick: u32, motion: &SpaceMotion, model: &SpaceModel) -> (Answer, SpacePath) {
        let (now, ahead) = self.reference(tick, motion);
        let (Control { thrust, elevator }, LateralControl { aileron, rudder }) = self
            .regulator
            .step(model, motion, &now, (&ahead.0, &ahead.1));
        let level = self.level(tick);
        let reports = Some(self.reports(tick, motion, &now));
        if ![thrust, elevator, aileron, rudder]
            .iter()
            .all(|command| command.is_finite())
        {
            return (Answer { reports, ..level }, now);
        }
        let mode = match self.flown.some() {
            Some(_) => ControlMode::Tracking,
            None => ControlMode::TrimHold,
        };
        let answer = Answer {
            reports,
            surfaces: SurfaceCommand {
                tick,
                aileron,
                rudder,
            },
            command: ActuatorCommand {
                tick,
                thrust,
                elevator,
                mode,
            },
        };
        (answer, now)
    }

    /// The plan's state now, and state and control ahead. Without a plan: straight and level.
    fn reference(&self, tick: u32, motion: &SpaceMotion) -> (SpacePath, (SpacePath, SpaceControl)) {
        if let Some(flown) = self.flown.some() {
            let here = &motion.path.position;
            if let Some((loiter, [now, ahead])) = flown.circles(tick, self.ahead, here) {
                return (now, (ahead, loiter.control(&flown.model, &ahead)));
            }
            return (
                flown.reference(tick),
                flown.at(flown.age(tick) + self.ahead),
            );
        }
        let model = &self.model;
        let [x, _, _] = motion.path.position;
        let level = SpacePath {
            position: [x, 0.0, self.configure.altitude],
            airspeed: model.trim.state.airspeed,
            angle_of_attack: model.trim.state.angle_of_attack(),
            ..SpacePath::default()
        };
        let control = SpaceControl {
            thrust: model.trim.control.thrust,
            ..SpaceControl::default()
        };
        (level, (level, control))
    }

    fn reports(
        &self,
        tick: u32,
        motion: &SpaceMotion,
        now: &SpacePath,
    ) -> (SpaceReport, StepReport) {
        let path = &motion.path;
        let [roll_rate, pitch_rate, yaw_rate] = motion.rates;
        let ([x, y, z], [wind_x, wind_y, wind_z]) = (path.position, self.model.wind);
        let [ref_x, ref_y, ref_z] = now.position;
        let lateral = SpaceReport {
            tick,
            estimate: [motion.sideslip, path.bank, roll_rate, yaw_rate, path.course],
            y,
            wind: wind_y,
            reference: [ref_y, now.bank, now.course],
            way_out: self.flown.some().map_or(0.0, |flown| flown.way_out(tick)) as f32,
        };
        let flown = self.flown.some();
        let age = flown.map_or(0, |flown| ticks(flown.begun, tick));
        let step = StepReport {
            tick,
            estimate: [path.airspeed, pitch(path), pitch_rate, path.flight_path],
            position: [x, z],
            wind: [wind_x, wind_z],
            lift: 0.0,
            reference: [ref_x, ref_z, now.airspeed, pitch(now), 0.0, now.flight_path],
            plan_age_ticks: age.unsigned_abs(),
            sensors: sensor_states(self.estimator.trust(), Trust::Healthy),
        };
        (lateral, step)
    }
}

/// Pitch \[rad\]: the elevation of the body's axis, from the flight path, the angle of attack and the bank between them.
fn pitch(path: &SpacePath) -> f64 {
    let (sin, cos) = libm::sincos(path.angle_of_attack);
    let (sin_path, cos_path) = libm::sincos(path.flight_path);
    let up = sin_path * cos + cos_path * sin * libm::cos(path.bank);
    let up = up.max(-1.0);
    libm::asin(up.min(1.0))
}
