//! The core, linked in: the same bytes as over the link, without a socket.

use hil_protocol::{
    ActuatorCommand, Configure, ControlMode, LidarScan, Message, SensorFrame, SensorState,
    StepReport,
};
use mpp_sim::link::{Link, LinkError};
use mpp_sim::pipe::PipeLink;

/// The most ticks of a core that takes over: it has a plan, and has learnt nothing wrong yet.
const FRESH: u32 = 30;

/// What the core said in a tick.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Thought {
    /// The command.
    pub(crate) command: ActuatorCommand,
    /// Estimate and reference.
    pub(crate) step: StepReport,
}

impl Thought {
    /// Whether the core trusts air data and positions.
    #[must_use]
    pub(crate) fn knows(&self) -> bool {
        let sensors = self.step.sensors;
        let trusted = |sensor| sensor != SensorState::Excluded;
        trusted(sensors.airspeed) && trusted(sensors.pitch) && trusted(sensors.position)
    }

    /// Whether the core trusts the scans.
    #[must_use]
    pub(crate) fn sees(&self) -> bool {
        self.step.sensors.lidar != SensorState::Excluded
    }
}

/// A core that flies.
pub(crate) struct Brain {
    link: PipeLink,
    /// The next tick.
    pub(crate) next: u32,
    /// The last scan that the core got.
    pub(crate) scanned: Option<u32>,
    /// Plans that were adopted one after the other.
    pub(crate) plans: u32,
    /// Ticks in trim hold, one after the other.
    pub(crate) planless: u32,
    /// Ticks without trust in air data or positions, one after the other.
    pub(crate) unsure: u32,
    /// What it said last.
    pub(crate) last: Option<Thought>,
}

impl Brain {
    /// A configured core.
    ///
    /// # Errors
    /// [`LinkError`] when the core refuses.
    pub(crate) fn new(configure: &Configure) -> Result<Self, LinkError> {
        Ok(Self {
            link: PipeLink::configured(configure)?,
            next: 0,
            scanned: None,
            plans: 0,
            planless: 0,
            unsure: 0,
            last: None,
        })
    }

    /// Whether it may take over.
    pub(crate) fn is_fresh(&self) -> bool {
        self.next <= FRESH && self.planless == 0
    }

    /// Does the next tick. The frame's tick is `next`.
    ///
    /// # Errors
    /// [`LinkError`] when the core does not answer.
    pub(crate) fn tick(
        &mut self,
        frame: SensorFrame,
        scan: Option<LidarScan>,
    ) -> Result<(), LinkError> {
        if let Some(scan) = scan {
            self.scanned = Some(frame.tick);
            self.link.send(&Message::LidarScan(scan))?;
        }
        self.link.send(&Message::SensorFrame(frame))?;
        self.next = frame.tick.wrapping_add(1);
        let mut step = None;
        loop {
            match self.link.receive("the command of a tick")? {
                Message::StepReport(report) => step = Some(report),
                Message::PlanReport(report) if report.outcome.is_new() => self.plans += 1,
                Message::PlanReport(_) => self.plans = 0,
                Message::ActuatorCommand(command) => {
                    let holds = command.mode == ControlMode::TrimHold;
                    self.planless = if holds { self.planless + 1 } else { 0 };
                    self.last = step.map(|step| Thought { command, step });
                    let knows = self.last.is_some_and(|last| last.knows());
                    self.unsure = if knows { 0 } else { self.unsure + 1 };
                    return Ok(());
                }
                _ => {}
            }
        }
    }
}
