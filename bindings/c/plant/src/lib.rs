//! The simulated flight for the example in C: field, aircraft, sensors and lidar call an autopilot at 100 Hz, and the
//! flight gets the log and the hash that `sil-harness fly` would write.

#![expect(unsafe_code, reason = "a C interface takes pointers")]

use core::ffi::{c_char, c_void};
use hil_protocol::{
    ActuatorCommand, ConfigureReply, ConfigureVerdict, ControlMode, HealthReport, Hello, LidarScan,
    Message, PlanControls, PlanOutcome, PlanReport, PlanTrajectory, Role, SensorFrame, SensorState,
    SensorStates, StepReport,
};
pub use mpp_c;
use mpp_c::{MPP_COUNTERS, MppOutput, MppPlan, MppScan, MppSensors, MppState, MppStatus};
use mpp_sim::flight::fly;
use mpp_sim::link::{Link, LinkError};
use mpp_sim::scenario::{Preset, Scenario, TICK_US, TICKS_PER_SECOND};
use std::collections::VecDeque;

/// What an autopilot gives back in a tick.
#[repr(C)]
pub struct MppAnswer {
    /// The step's output.
    pub output: MppOutput,
    /// Whether a plan was taken over in this tick.
    pub has_plan: bool,
    /// The plan.
    pub plan: MppPlan,
    /// Tick of the plan's scan.
    pub plan_tick: u32,
    /// The core's counters.
    pub counters: [u32; MPP_COUNTERS],
}

/// An autopilot: it gets a tick, its sensors, and a scan or null. Anything but `MPP_STATUS_OK` ends the flight.
pub type MppAutopilot = unsafe extern "C" fn(
    context: *mut c_void,
    tick: u32,
    sensors: *const MppSensors,
    scan: *const MppScan,
    answer: *mut MppAnswer,
) -> MppStatus;

/// A link that asks an autopilot.
struct Callback {
    autopilot: MppAutopilot,
    context: *mut c_void,
    scan: Option<LidarScan>,
    beams: u16,
    answers: VecDeque<Message>,
    status: MppStatus,
}

impl Callback {
    fn tick(&mut self, frame: &SensorFrame) {
        let sensors = sensors(frame);
        let scan = self.scan.take();
        let scan = scan.as_ref().map(|scan| MppScan {
            age: frame.tick.wrapping_sub(scan.tick),
            angle_min: f64::from(scan.angle_min),
            angle_increment: f64::from(scan.angle_increment),
            count: scan.ranges.len(),
            ranges: scan.ranges.as_ptr(),
        });
        let mut answer = MppAnswer::nothing();
        let scan = scan.as_ref().map_or(core::ptr::null(), core::ptr::from_ref);
        // SAFETY: all pointers are valid during the call. What the autopilot does is its author's promise.
        self.status =
            unsafe { (self.autopilot)(self.context, frame.tick, &sensors, scan, &mut answer) };
        if self.status == MppStatus::Ok {
            self.answer(frame.tick, &answer);
        }
    }

    fn answer(&mut self, tick: u32, answer: &MppAnswer) {
        if answer.has_plan {
            let report = plan_report(tick, answer);
            self.answers.push_back(Message::PlanReport(report));
            if report.outcome.is_new() {
                let trajectory = trajectory(answer);
                self.answers.push_back(Message::PlanTrajectory(trajectory));
                let controls = controls(answer);
                self.answers.push_back(Message::PlanControls(controls));
            }
        }
        let output = &answer.output;
        let step = step_report(tick, output);
        self.answers.push_back(Message::StepReport(step));
        // Once a second, as the core behind a link tells them.
        if tick % 100 == 63 {
            let counters = answer.counters;
            let health = HealthReport { tick, counters };
            self.answers.push_back(Message::HealthReport(health));
        }
        let mode = if output.tracking {
            ControlMode::Tracking
        } else {
            ControlMode::TrimHold
        };
        self.answers
            .push_back(Message::ActuatorCommand(ActuatorCommand {
                tick,
                thrust: output.thrust,
                elevator: output.elevator,
                mode,
            }));
    }
}

impl Link for Callback {
    fn send(&mut self, message: &Message) -> Result<(), LinkError> {
        match message {
            Message::Hello(_) => self.answers.push_back(Message::Hello(Hello {
                role: Role::Core,
                software: [0; 3],
                tick_period_us: TICK_US,
                beams_max: self.beams,
                stages: 18,
            })),
            // The autopilot has configured itself.
            Message::Configure(_) => {
                self.answers
                    .push_back(Message::ConfigureReply(ConfigureReply {
                        verdict: ConfigureVerdict::Accepted,
                    }));
            }
            Message::LidarScan(scan) => self.scan = Some(scan.clone()),
            Message::SensorFrame(frame) => self.tick(frame),
            _ => {}
        }
        Ok(())
    }

    fn receive(&mut self, awaited: &str) -> Result<Message, LinkError> {
        self.answers.pop_front().ok_or_else(|| LinkError::Silent {
            waiting: "plant",
            awaited: awaited.to_owned(),
            patience: None,
        })
    }
}

impl MppAnswer {
    fn nothing() -> Self {
        Self {
            output: MppOutput::default(),
            has_plan: false,
            plan: MppPlan {
                outcome: 3,
                complete: false,
                blind: false,
                candidates: 0,
                feasible: 0,
                trees: 0,
                slices: 0,
                cost: f64::INFINITY,
                violation: f64::INFINITY,
                period: 0.0,
                knots: [MppState::default(); mpp_c::MPP_KNOTS],
                thrust: [0.0; mpp_c::MPP_KNOTS],
                elevator: [0.0; mpp_c::MPP_KNOTS],
                start: 0.0,
            },
            plan_tick: 0,
            counters: [0; MPP_COUNTERS],
        }
    }
}

fn sensors(frame: &SensorFrame) -> MppSensors {
    let age = |tick: u32| frame.tick.wrapping_sub(tick);
    let (air, position) = (frame.air, frame.position);
    let velocity = position.and_then(|position| position.velocity);
    MppSensors {
        has_air: air.is_some(),
        air_age: air.map_or(0, |air| age(air.tick)),
        airspeed: air.map_or(0.0, |air| air.airspeed),
        pitch: air.map_or(0.0, |air| air.pitch),
        has_position: position.is_some(),
        position_age: position.map_or(0, |position| age(position.tick)),
        x: position.map_or(0.0, |position| position.x),
        z: position.map_or(0.0, |position| position.z),
        sigma: position.map_or(0.0, |position| f64::from(position.sigma)),
        has_velocity: velocity.is_some(),
        velocity_x: velocity.map_or(0.0, |velocity| f64::from(velocity.x)),
        velocity_z: velocity.map_or(0.0, |velocity| f64::from(velocity.z)),
        velocity_sigma: velocity.map_or(0.0, |velocity| f64::from(velocity.sigma)),
    }
}

fn plan_report(tick: u32, answer: &MppAnswer) -> PlanReport {
    let plan = &answer.plan;
    PlanReport {
        scan_tick: answer.plan_tick,
        used_from_tick: tick,
        outcome: match plan.outcome {
            0 => PlanOutcome::Adopted,
            1 => PlanOutcome::LeastViolating,
            2 => PlanOutcome::KeptPrevious,
            3 => PlanOutcome::TrimHold,
            4 => PlanOutcome::Pursuit,
            5 => PlanOutcome::Reserve,
            _ => PlanOutcome::Latest,
        },
        candidates: plan.candidates as u16,
        feasible: plan.feasible as u16,
        tree_runs: plan.trees as u16,
        slices: plan.slices,
        cost: plan.cost,
        violation: plan.violation,
        complete: plan.complete,
    }
}

fn trajectory(answer: &MppAnswer) -> PlanTrajectory {
    let knots = answer.plan.knots.iter();
    PlanTrajectory {
        scan_tick: answer.plan_tick,
        period: answer.plan.period as f32,
        knots: knots
            .map(|knot| [knot.x, knot.z, knot.flight_path].map(|value| value as f32))
            .collect(),
    }
}

fn controls(answer: &MppAnswer) -> PlanControls {
    let commands = answer.plan.thrust.iter().zip(&answer.plan.elevator);
    PlanControls {
        scan_tick: answer.plan_tick,
        knots: commands
            .map(|(thrust, elevator)| [*thrust as f32, *elevator as f32])
            .collect(),
    }
}

fn step_report(tick: u32, output: &MppOutput) -> StepReport {
    let air = |state: &MppState| {
        [
            state.airspeed,
            state.pitch,
            state.pitch_rate,
            state.flight_path,
        ]
    };
    let trust = |code| match code {
        0 => SensorState::Healthy,
        1 => SensorState::Suspected,
        2 => SensorState::Excluded,
        _ => SensorState::Recovering,
    };
    let [airspeed, pitch, rate, path] = air(&output.reference);
    StepReport {
        tick,
        estimate: air(&output.estimate),
        position: [output.estimate.x, output.estimate.z],
        wind: [output.wind_x, output.wind_z],
        lift: output.lift,
        reference: [
            output.reference.x,
            output.reference.z,
            airspeed,
            pitch,
            rate,
            path,
        ],
        plan_age_ticks: 0,
        sensors: SensorStates {
            airspeed: trust(output.airspeed_trust),
            pitch: trust(output.pitch_trust),
            position: trust(output.position_trust),
            lidar: SensorState::Healthy,
            elevator: trust(output.elevator_trust),
            motor: trust(output.motor_trust),
        },
    }
}

/// Flies the reference aircraft past 20 obstacles with this seed for so many seconds; the lidar scans once a second.
/// Writes the hash of the log, 16 digits and an end, and whether the aircraft survived.
///
/// # Safety
/// `hash` is null or points to 17 characters, `survived` is null or points to a value, and the autopilot may be called
/// with `context`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mpp_plant_fly(
    seed: u64,
    seconds: u32,
    autopilot: MppAutopilot,
    context: *mut c_void,
    hash: *mut [c_char; 17],
    survived: *mut bool,
) -> MppStatus {
    // SAFETY: the caller's promises.
    let places = unsafe { (hash.as_mut(), survived.as_mut()) };
    let (Some(hash), Some(survived)) = places else {
        return MppStatus::Null;
    };
    let scenario = Scenario {
        ticks: seconds.saturating_mul(TICKS_PER_SECOND),
        ..Scenario::new(Preset::Flight, seed)
    };
    let mut link = Callback {
        autopilot,
        context,
        scan: None,
        beams: mpp_c::MPP_BEAMS as u16,
        answers: VecDeque::new(),
        status: MppStatus::Ok,
    };
    let flown = fly(&scenario, &mut link, |_| {});
    let Some((log, text)) = flown
        .ok()
        .and_then(|log| log.hash().ok().map(|text| (log, text)))
    else {
        // Only the autopilot leaves this flight without an outcome.
        return if link.status == MppStatus::Ok {
            MppStatus::OutOfRange
        } else {
            link.status
        };
    };
    *hash = [0; 17];
    for (place, letter) in hash.iter_mut().zip(text.bytes().take(16)) {
        *place = letter.cast_signed();
    }
    *survived = log.summary.outcome == mpp_sim::outcome::Outcome::Survived;
    MppStatus::Ok
}
