//! The node that runs both tasks in one thread.

use crate::mail::PlanRequest;
use crate::out::{Frames, Messages, Out};
use crate::plan_task::{PlanTask, Progress};
use crate::step_task::{Pace, StepTask};
use hil_protocol::Message;
use mpp_core::health::Health;
use mpp_core::planner::Planner;

/// The core and its side of the link. The value is large: place it in a `static` or a box.
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

    /// Takes bytes from the link. `send` gets each frame of the answer as a whole. When the function
    /// returns, the planner has used all slices granted so far.
    pub fn receive(&mut self, bytes: &[u8], send: impl FnMut(&[u8])) {
        self.receive_advised(bytes, send, |_, _| {});
    }

    /// Does the work of [`FlightNode::receive`] for a caller that knows more than the link tells. `advise`
    /// may change each request, and the planner's map, before the planner takes the request.
    pub fn receive_advised(
        &mut self,
        bytes: &[u8],
        send: impl FnMut(&[u8]),
        mut advise: impl FnMut(&mut PlanRequest, &mut Planner),
    ) {
        let send = &mut Frames(send);
        for byte in bytes {
            self.step.take_byte(*byte, send);
            self.run_planner(send, &mut advise);
        }
    }

    /// Does the work of [`FlightNode::receive_advised`] without a link: takes a message as it is, and `send` gets the
    /// messages of the answer.
    pub fn take_advised(
        &mut self,
        message: &Message,
        send: impl FnMut(Message),
        mut advise: impl FnMut(&mut PlanRequest, &mut Planner),
    ) {
        let send = &mut Messages(send);
        self.step.take_message(message, send);
        self.run_planner(send, &mut advise);
    }

    /// The counters of this flight; `None` before the configuration.
    #[must_use]
    pub fn health(&self) -> Option<&Health> {
        self.step.health()
    }

    /// The planner, for inspection between ticks.
    #[must_use]
    pub fn planner(&self) -> &Planner {
        self.plan.planner()
    }

    /// Runs the planner until it waits. The loop ends, because a cycle has a bounded number of slices, and
    /// a reply starts at most one more tick.
    fn run_planner(
        &mut self,
        send: &mut impl Out,
        advise: &mut impl FnMut(&mut PlanRequest, &mut Planner),
    ) {
        loop {
            if let Some(mut request) = self.step.request() {
                advise(&mut request, self.plan.planner_mut());
                self.plan.take(&request);
            }
            match self.plan.advance(self.step.clock()) {
                Progress::Waiting => return,
                Progress::Working => {}
                Progress::Replied => {
                    if let Some(reply) = self.plan.reply() {
                        self.step.settle(reply, send);
                    }
                }
            }
        }
    }
}
