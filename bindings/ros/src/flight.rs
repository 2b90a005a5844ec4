//! A flight of the core, linked in: the same bytes as over the link, without a socket.

use crate::settings::Settings;
use hil_protocol::{
    ActuatorCommand, Configure, HealthReport, LidarScan, Message, ParameterVerdict, PlanReport,
    PlanTrajectory, RejectionCause, SensorFrame, SetParameter, StepReport,
};
use mpp_core::planner::plane::PlanePlanner;
use mpp_sim::link::{Link, LinkError};
use mpp_sim::pipe::PipeLink;
use mpp_sim::scenario::TICK_US;

/// A core that flies.
pub(crate) struct Flight {
    link: PipeLink,
    /// The time of tick 0 \[ns\].
    pub(crate) start: i64,
    /// The next tick.
    pub(crate) next: u32,
    /// The tick of the last scan that the core got.
    pub(crate) scanned: Option<u32>,
    /// Beams of its scans.
    pub(crate) beams: usize,
    /// The core's last counters.
    pub(crate) health: Option<HealthReport>,
    /// The report of the last cycle.
    pub(crate) plan: Option<PlanReport>,
    /// What the core said last.
    pub(crate) last: Option<(ActuatorCommand, StepReport)>,
}

/// Why the core does not fly.
#[derive(Debug, thiserror::Error)]
pub(crate) enum FlightError {
    /// The core does not answer, or refuses its configuration.
    #[error("{0}")]
    Link(#[from] LinkError),
    /// The core refuses a parameter.
    #[error("the core refuses parameter {0}: {1}")]
    Parameter(u8, ParameterVerdict),
}

/// What a tick brought beside the command.
#[derive(Default)]
pub(crate) struct Answer {
    /// A new plan.
    pub(crate) trajectory: Option<(PlanReport, PlanTrajectory)>,
    /// Inputs that the core refused.
    pub(crate) refused: Vec<RejectionCause>,
}

impl Flight {
    /// A core that begins at this time and height with scans like this one.
    ///
    /// # Errors
    /// [`FlightError`] when the core refuses.
    pub(crate) fn begin(
        settings: &Settings,
        altitude: f64,
        start: i64,
        (beams, range_max): (usize, f32),
    ) -> Result<Self, FlightError> {
        let configure = Configure {
            altitude,
            beams: beams as u16,
            range_max,
            ..settings.configure
        };
        let mut flight = Self {
            link: PipeLink::configured(&configure)?,
            start,
            next: 0,
            scanned: None,
            beams,
            health: None,
            plan: None,
            last: None,
        };
        for (parameter, value) in &settings.tuned {
            flight.set(*parameter, *value)?;
        }
        Ok(flight)
    }

    /// Changes a parameter.
    ///
    /// # Errors
    /// [`FlightError`] when the core refuses.
    pub(crate) fn set(&mut self, parameter: u8, value: f64) -> Result<(), FlightError> {
        let set = SetParameter { parameter, value };
        self.link.send(&Message::SetParameter(set))?;
        loop {
            if let Message::ParameterReply(reply) = self.link.receive("a parameter")? {
                return match reply.verdict {
                    ParameterVerdict::Accepted => Ok(()),
                    verdict => Err(FlightError::Parameter(parameter, verdict)),
                };
            }
        }
    }

    /// The tick nearest to a time, if the flight had begun.
    pub(crate) fn tick_of(&self, nanos: i64) -> Option<u32> {
        let period = i64::from(TICK_US) * 1000;
        let since = nanos.saturating_sub(self.start).saturating_add(period / 2);
        u32::try_from(since.div_euclid(period)).ok()
    }

    /// The time of a tick \[ns\].
    pub(crate) fn time_of(&self, tick: u32) -> i64 {
        self.start + i64::from(tick) * i64::from(TICK_US) * 1000
    }

    /// Does the next tick. The frame's tick is `next`.
    ///
    /// # Errors
    /// [`LinkError`] when the core does not answer.
    pub(crate) fn tick(
        &mut self,
        frame: SensorFrame,
        scan: Option<LidarScan>,
    ) -> Result<Answer, LinkError> {
        if let Some(scan) = scan {
            self.scanned = Some(frame.tick);
            self.link.send(&Message::LidarScan(scan))?;
        }
        self.link.send(&Message::SensorFrame(frame))?;
        self.next = frame.tick.wrapping_add(1);
        let (mut answer, mut step) = (Answer::default(), None);
        loop {
            match self.link.receive("the command of a tick")? {
                Message::StepReport(report) => step = Some(report),
                Message::PlanReport(report) => self.plan = Some(report),
                Message::PlanTrajectory(plan) => {
                    answer.trajectory = self.plan.map(|report| (report, plan));
                }
                Message::HealthReport(report) => self.health = Some(report),
                Message::Rejection(rejection) => answer.refused.push(rejection.cause),
                Message::ActuatorCommand(command) => {
                    self.last = step.map(|step| (command, step));
                    return Ok(answer);
                }
                _ => {}
            }
        }
    }

    /// The planner, to look at its candidates and its map.
    pub(crate) fn planner(&self) -> Option<&PlanePlanner> {
        self.link.node().planner().plane()
    }
}
