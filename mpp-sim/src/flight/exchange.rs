//! The exchange of one tick over a link that may lose it, under a tick counter that may be wrong.

use super::receiver::Receiver;
use super::session::{Session, StepReply};
use crate::entries::RejectionEntry;
use crate::faults::{ClockFault, Line, Passage};
use crate::link::LinkError;
use crate::scenario::Scenario;
use hil_protocol::{LidarScan, SensorFrame};
use mpp_core::vehicle::TrimError;

/// The link of one flight, with its faults.
pub(super) struct Exchange {
    line: Line,
    clock: ClockFault,
    receiver: Receiver,
    /// A scan that no command has answered. It goes out again with the next frame.
    unanswered: Option<LidarScan>,
}

impl Exchange {
    /// The link of a scenario. Before the first command the aircraft holds trim.
    pub(super) fn new(scenario: &Scenario) -> Result<Self, TrimError> {
        Ok(Self {
            line: Line::new(scenario.seed, scenario.faults.link),
            clock: scenario.faults.clock,
            receiver: Receiver::new(scenario)?,
            unanswered: None,
        })
    }

    /// The messages of a tick that come through.
    pub(super) fn passage(&mut self, tick: u32) -> Passage {
        self.line.passage(tick)
    }

    /// Sends what comes to the core, and gives its reply. Without a reply, and if the command is lost, the
    /// receiver in the aircraft decides. For the log the reports are never lost.
    pub(super) fn tick(
        &mut self,
        session: &mut Session<'_>,
        passage: Passage,
        scan: Option<LidarScan>,
        frame: SensorFrame,
    ) -> Result<StepReply, LinkError> {
        let now = frame.tick;
        let unanswered = self.unanswered.take();
        let scan = scan.or(unanswered);
        if !(passage.to_core && passage.to_aircraft) {
            self.unanswered.clone_from(&scan);
        }
        let known = session.told.rejections.len();
        let mut reply = if passage.to_core {
            session.fly(
                scan.map(|scan| self.stamped(scan)).as_ref(),
                self.frame(frame),
            )?
        } else {
            None
        };
        if let Some(reply) = &mut reply {
            self.restore(reply, now);
        }
        match reply.as_ref().filter(|_| passage.to_aircraft) {
            Some(reply) => self.receiver.hear(reply),
            None => self.receiver.miss(now),
        }
        for entry in session.told.rejections.iter_mut().skip(known) {
            self.restore_entry(entry, now);
        }
        let command = self.receiver.command();
        Ok(match reply {
            Some(reply) => StepReply { command, ..reply },
            None => StepReply {
                command,
                step: None,
                plan: None,
                trajectory: None,
                controls: None,
                health: None,
            },
        })
    }

    /// A scan with the number that the core sees.
    fn stamped(&self, scan: LidarScan) -> LidarScan {
        LidarScan {
            tick: self.clock.shown(scan.tick),
            ..scan
        }
    }

    /// A frame with the numbers that the core sees.
    fn frame(&self, mut frame: SensorFrame) -> SensorFrame {
        frame.tick = self.clock.shown(frame.tick);
        if let Some(air) = &mut frame.air {
            air.tick = self.clock.shown(air.tick);
        }
        if let Some(position) = &mut frame.position {
            position.tick = self.clock.shown(position.tick);
        }
        frame
    }

    /// Gives the reports the ticks of the flight.
    fn restore(&self, reply: &mut StepReply, now: u32) {
        let flown = |shown: &mut u32| *shown = self.clock.flown(*shown, now).unwrap_or(*shown);
        reply.command.tick = now;
        if let Some(step) = &mut reply.step {
            step.tick = now;
        }
        if let Some(health) = &mut reply.health {
            health.tick = now;
        }
        if let Some(plan) = &mut reply.plan {
            flown(&mut plan.scan_tick);
            flown(&mut plan.used_from_tick);
        }
        if let Some(trajectory) = &mut reply.trajectory {
            flown(&mut trajectory.scan_tick);
        }
        if let Some(controls) = &mut reply.controls {
            flown(&mut controls.scan_tick);
        }
    }

    fn restore_entry(&self, entry: &mut RejectionEntry, now: u32) {
        let shown = u32::try_from(entry.tick).ok();
        let flown = shown.and_then(|shown| self.clock.flown(shown, now));
        entry.tick = flown.map_or(entry.tick, u64::from);
    }
}
