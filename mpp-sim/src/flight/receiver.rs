//! The receiver of commands in the aircraft. When it hears nothing it flies the rest of the plan by itself.

use super::session::StepReply;
use crate::scenario::{Preset, Scenario};
use hil_protocol::{ActuatorCommand, ControlMode, PlanControls};
use mpp_core::config::TICK_PERIOD;
use mpp_core::vehicle::TrimError;

/// Ticks without a command after which the receiver flies by the plan. Before that it keeps the last command, which holds
/// the answer of the regulator too.
const PATIENCE: u32 = 8;

/// The receiver of one flight.
pub(super) struct Receiver {
    trim: ActuatorCommand,
    command: ActuatorCommand,
    plan: Option<Plan>,
    /// Whether plans start at their scan, and not where they are taken over.
    from_scan: bool,
    /// Ticks since the last command.
    silent: u32,
}

/// The last plan that was heard.
struct Plan {
    /// Tick at which it starts.
    start: u32,
    /// Tick of its scan.
    scan: u32,
    /// Time from a knot to the next \[s\].
    period: f64,
    /// Its commands, once they have come.
    controls: Option<PlanControls>,
    /// Whether the last command was one of this plan. A newer plan may have been lost.
    is_flown: bool,
}

impl Receiver {
    /// A receiver that holds trim before the first command.
    pub(super) fn new(scenario: &Scenario) -> Result<Self, TrimError> {
        let trim = scenario.trim()?.control;
        let trim = ActuatorCommand {
            tick: 0,
            thrust: trim.thrust,
            elevator: trim.elevator,
            mode: ControlMode::TrimHold,
        };
        Ok(Self {
            trim,
            command: trim,
            plan: None,
            from_scan: scenario.preset != Preset::Flight,
            silent: 0,
        })
    }

    /// Takes in what the core sent in a tick.
    pub(super) fn hear(&mut self, reply: &StepReply) {
        self.command = reply.command;
        self.silent = 0;
        if let (Some(report), Some(trajectory)) = (&reply.plan, &reply.trajectory) {
            self.plan = Some(Plan {
                start: if self.from_scan {
                    report.scan_tick
                } else {
                    report.used_from_tick
                },
                scan: report.scan_tick,
                period: f64::from(trajectory.period),
                controls: None,
                is_flown: true,
            });
        }
        if let (Some(plan), Some(controls)) = (&mut self.plan, &reply.controls) {
            plan.controls = Some(controls.clone()).filter(|_| controls.scan_tick == plan.scan);
        }
        if let (Some(plan), Some(step)) = (&mut self.plan, &reply.step) {
            let flown = step.tick.wrapping_sub(step.plan_age_ticks);
            plan.is_flown = flown == plan.scan;
        }
    }

    /// The command of this tick.
    pub(super) fn command(&self) -> ActuatorCommand {
        self.command
    }

    /// A tick without a command.
    pub(super) fn miss(&mut self, now: u32) {
        self.silent = self.silent.saturating_add(1);
        let flown = self.plan.as_ref().filter(|plan| plan.is_flown);
        let Some((plan, controls)) = flown.and_then(|plan| Some((plan, plan.controls.as_ref()?)))
        else {
            return;
        };
        let tracking = self.command.mode == ControlMode::Tracking;
        if tracking && self.silent >= PATIENCE {
            self.command = plan.command(controls, now).unwrap_or(self.trim);
        }
    }
}

impl Plan {
    /// The command of the plan at a tick; `None` at its end.
    fn command(&self, controls: &PlanControls, now: u32) -> Option<ActuatorCommand> {
        let time = f64::from(now.checked_sub(self.start)?) * TICK_PERIOD;
        let stages = time / self.period;
        let stage = stages as usize;
        let knots = controls.knots.get(stage..stage.checked_add(2)?)?;
        let [[thrust, from], [_, to]] = knots else {
            return None;
        };
        let share = stages - stages.floor();
        Some(ActuatorCommand {
            tick: now,
            thrust: f64::from(*thrust),
            elevator: f64::from(*from) + share * f64::from(to - from),
            mode: ControlMode::Tracking,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hil_protocol::{
        PlanOutcome, PlanReport, PlanTrajectory, SensorState, SensorStates, StepReport,
    };

    const SCAN: u32 = 100;
    const TRACKING: ActuatorCommand = ActuatorCommand {
        tick: SCAN,
        thrust: 7.0,
        elevator: 2.0,
        mode: ControlMode::Tracking,
    };

    fn receiver() -> Receiver {
        let scenario = Scenario::new(Preset::Flight, 1);
        Receiver::new(&scenario).expect("the default aircraft has a trim")
    }

    /// The reply of a tick in which the plan of the scan at `flown` is flown.
    fn reply(tick: u32, flown: u32) -> StepReply {
        let state = SensorState::Healthy;
        StepReply {
            command: TRACKING,
            step: Some(StepReport {
                tick,
                estimate: [0.0; 4],
                position: [0.0; 2],
                wind: [0.0; 2],
                lift: 0.0,
                reference: [0.0; 6],
                plan_age_ticks: tick - flown,
                sensors: SensorStates {
                    airspeed: state,
                    pitch: state,
                    position: state,
                    lidar: state,
                    elevator: state,
                    motor: state,
                },
            }),
            plan: None,
            trajectory: None,
            controls: None,
            health: None,
        }
    }

    /// The same with a plan of three knots, 0.5 s apart, that is flown from the next tick on.
    fn with_plan(tick: u32) -> StepReply {
        let controls = PlanControls {
            scan_tick: tick,
            knots: [[8.0, 3.0], [9.0, 4.0], [0.0, 2.0]].into_iter().collect(),
        };
        StepReply {
            plan: Some(PlanReport {
                scan_tick: tick,
                used_from_tick: tick + 1,
                outcome: PlanOutcome::Adopted,
                candidates: 1,
                feasible: 1,
                tree_runs: 0,
                slices: 1,
                cost: 0.0,
                violation: 0.0,
                complete: true,
            }),
            trajectory: Some(PlanTrajectory {
                scan_tick: tick,
                period: 0.5,
                knots: [[0.0; 3]; 3].into_iter().collect(),
            }),
            controls: Some(controls),
            ..reply(tick, tick)
        }
    }

    /// Elevator and thrust at each of the ticks after the last one heard.
    fn silence(receiver: &mut Receiver, ticks: u32) -> Vec<(f64, f64)> {
        let ticks = 1..=ticks;
        let commands = ticks.map(|tick| {
            receiver.miss(SCAN + tick);
            (receiver.command().elevator, receiver.command().thrust)
        });
        commands.collect()
    }

    #[test]
    fn a_long_silence_is_flown_by_the_plan_and_then_by_trim() {
        let mut receiver = receiver();
        receiver.hear(&with_plan(SCAN));
        let flown = silence(&mut receiver, 110);
        let patient = PATIENCE as usize - 1;
        assert!(flown[..patient].iter().all(|flown| *flown == (2.0, 7.0)));
        // The plan starts a tick after its scan.
        assert_eq!(flown[25], (3.5, 8.0));
        assert_eq!(flown[75], (3.0, 9.0));
        let trim = (receiver.trim.elevator, receiver.trim.thrust);
        assert_eq!(flown[109], trim);
        receiver.hear(&reply(SCAN + 111, SCAN + 111));
        assert_eq!(receiver.command(), TRACKING);
    }

    #[test]
    fn without_the_plan_that_is_flown_the_last_command_is_kept() {
        let kept = |receiver: &mut Receiver| {
            let flown = silence(receiver, 60);
            flown.iter().all(|flown| *flown == (2.0, 7.0))
        };
        // It heard no plan.
        let mut deaf = receiver();
        deaf.hear(&reply(SCAN, SCAN));
        assert!(kept(&mut deaf));
        // It did not hear its commands.
        let mut half = receiver();
        half.hear(&StepReply {
            controls: None,
            ..with_plan(SCAN)
        });
        assert!(kept(&mut half));
        // A newer plan was lost.
        let mut outdated = receiver();
        outdated.hear(&with_plan(SCAN - 50));
        outdated.hear(&reply(SCAN, SCAN - 25));
        assert!(kept(&mut outdated));
        // The core holds trim.
        let mut trimmed = receiver();
        let mut reply = with_plan(SCAN);
        reply.command.mode = ControlMode::TrimHold;
        trimmed.hear(&reply);
        assert!(kept(&mut trimmed));
    }
}
