//! Both tasks in one thread.

use crate::mail::Order;
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
    pub fn receive(&mut self, bytes: &[u8], send: impl FnMut(&[u8])) {
        self.receive_advised(bytes, send, |_, _| {});
    }

    /// As [`FlightNode::receive`], with somebody who knows more than the link tells: `advise` may
    /// change each order, and the planner's map, before the planner sees them.
    pub fn receive_advised(
        &mut self,
        bytes: &[u8],
        mut send: impl FnMut(&[u8]),
        mut advise: impl FnMut(&mut Order, &mut Planner),
    ) {
        for byte in bytes {
            self.step.receive(*byte, &mut send);
            self.run_planner(&mut send, &mut advise);
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
    fn run_planner(
        &mut self,
        send: &mut impl FnMut(&[u8]),
        advise: &mut impl FnMut(&mut Order, &mut Planner),
    ) {
        loop {
            if let Some(mut order) = self.step.order() {
                advise(&mut order, self.plan.planner_mut());
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
