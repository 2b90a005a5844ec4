//! Loss of the planner: for as long as its restart takes, or for good.

use super::{Cycle, StepTask};
use crate::mail::Plan;
use crate::out::{Frames, Out};
use hil_protocol::RejectionCause;
use mpp_core::planner::{PlanSummary, Verdict};
use mpp_core::trajectory::Trajectory;

impl StepTask {
    /// Handles a restart of the planner: requests its set-up, and ends its cycle without a trajectory.
    pub fn planner_lost(&mut self, send: impl FnMut(&[u8])) {
        let send = &mut Frames(send);
        let Some(session) = &self.session else {
            return;
        };
        let ready = session.ready;
        self.request_set_up();
        if ready {
            self.reject(RejectionCause::PlannerRestarted, send);
            self.give_cycle_up(send);
        }
    }

    /// Flies on without the planner for good, in this session and in later ones: the present trajectory to its
    /// end, and then level. The cycle ends without a trajectory.
    pub fn planner_off(&mut self, send: impl FnMut(&[u8])) {
        let send = &mut Frames(send);
        self.planner_off = true;
        self.reject(RejectionCause::PlannerOff, send);
        self.give_cycle_up(send);
        self.fly_without_planner(send);
    }

    /// Drops requests for the planner, and answers whoever waits for its set-up.
    pub(super) fn fly_without_planner(&mut self, send: &mut impl Out) {
        self.request = None;
        if self.session.as_ref().is_some_and(|session| !session.ready) {
            self.set_up_done(Ok(()), send);
        }
    }

    fn give_cycle_up(&mut self, send: &mut impl Out) {
        let cycle = self.session.as_ref().and_then(|session| session.cycle);
        if let Some(Cycle { begun, .. }) = cycle
            && self.plan.is_none()
        {
            self.plan = Some(Plan {
                tick: begun,
                verdict: Verdict::Nothing,
                summary: PlanSummary::NOTHING,
                trajectory: Trajectory::new(),
                seal: Trajectory::new().seal(),
            });
        }
        if let Some(frame) = self.held.take() {
            self.tick(&frame, send);
        }
    }
}
