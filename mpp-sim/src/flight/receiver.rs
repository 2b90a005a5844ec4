//! The receiver of commands in the aircraft. When it hears nothing it flies the rest of the plan by itself.

use super::session::Answer;
use crate::scenario::{Preset, Scenario};
use hil_protocol::{ActuatorCommand, ControlMode, PlanTrajectory};
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
    trajectory: PlanTrajectory,
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
    pub(super) fn hear(&mut self, answer: &Answer) {
        self.command = answer.command;
        self.silent = 0;
        if let (Some(report), Some(trajectory)) = (&answer.plan, &answer.trajectory) {
            self.plan = Some(Plan {
                start: if self.from_scan {
                    report.scan_tick
                } else {
                    report.used_from_tick
                },
                trajectory: trajectory.clone(),
                is_flown: true,
            });
        }
        if let (Some(plan), Some(step)) = (&mut self.plan, &answer.step) {
            let flown = step.tick.wrapping_sub(step.plan_age_ticks);
            plan.is_flown = flown == plan.trajectory.scan_tick;
        }
    }

    /// The command of this tick.
    pub(super) fn command(&self) -> ActuatorCommand {
        self.command
    }

    /// A tick without a command.
    pub(super) fn miss(&mut self, now: u32) {
        self.silent = self.silent.saturating_add(1);
        let Some(plan) = self.plan.as_ref().filter(|plan| plan.is_flown) else {
            return;
        };
        let tracking = self.command.mode == ControlMode::Tracking;
        if tracking && self.silent >= PATIENCE {
            self.command = plan.command(now).unwrap_or(self.trim);
        }
    }
}

impl Plan {
    /// The command of the plan at a tick; `None` at its end.
    fn command(&self, now: u32) -> Option<ActuatorCommand> {
        let time = f64::from(now.checked_sub(self.start)?) * TICK_PERIOD;
        let stages = time / f64::from(self.trajectory.period);
        let stage = stages as usize;
        let knots = self.trajectory.knots.get(stage..stage.checked_add(2)?)?;
        let [[.., thrust, from], [.., to]] = knots else {
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
