//! Both tasks in one thread.

use crate::plan_task::{PlanTask, Progress};
use crate::step_task::{Pace, StepTask};
use mpp_core::health::Health;
use mpp_core::planner::Planner;

/// The core and its side of the link. Large: place it in a `static` or a box.
pub struct FlightNode {
    step: StepTask,
    plan: PlanTask,
}

impl FlightNode {
    /// A node that waits for a hello.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            step: StepTask::new(Pace::Lockstep),
            plan: PlanTask::new(),
        }
    }

    /// Takes bytes from the link; `send` gets every frame of the answer, whole. The planner has
    /// used all slices granted so far when it returns.
    pub fn receive(&mut self, bytes: &[u8], mut send: impl FnMut(&[u8])) {
        for byte in bytes {
            self.step.receive(*byte, &mut send);
            self.run_planner(&mut send);
        }
    }

    /// What went wrong so far in this flight; none before it is configured.
    #[must_use]
    pub fn health(&self) -> Option<&Health> {
        self.step.health()
    }

    /// The planner, to look at between ticks.
    #[must_use]
    pub fn planner(&self) -> &Planner {
        self.plan.planner()
    }

    /// Ends: a cycle is a bounded number of slices, and an answer starts the next tick at most.
    fn run_planner(&mut self, send: &mut impl FnMut(&[u8])) {
        loop {
            if let Some(order) = self.step.order() {
                self.plan.take(&order);
            }
            match self.plan.advance(self.step.clock()) {
                Progress::Waiting => return,
                Progress::Working => {}
                Progress::Answered => {
                    if let Some(answer) = self.plan.answer() {
                        self.step.answer(answer, &mut *send);
                    }
                }
            }
        }
    }
}

impl Default for FlightNode {
    fn default() -> Self {
        Self::new()
    }
}
