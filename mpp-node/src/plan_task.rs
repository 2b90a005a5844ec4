//! The task of the planner, which runs cycles slice by slice.

use crate::mail::{Plan, PlanReply, PlanRequest};
use crate::ticks;
use mpp_core::planner::Planner;

/// The result of a call of [`PlanTask::advance`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// There is nothing to do until a later tick grants more slices, or a request comes.
    Waiting,
    /// The task has done a slice.
    Working,
    /// A reply is ready: [`PlanTask::reply`].
    Replied,
}

/// A cycle under way.
#[derive(Clone, Copy, Debug)]
struct Cycle {
    tick: u32,
    slices: u32,
}

/// The planner and the cycle that it works on. The value is large: place it in a `static` or a box.
///
/// A cycle gets `slices_per_tick` slices for each tick from its start until its plan is due. The cycle ends
/// when it has used these slices, when it has no more work, or when the tick at which the plan is due has
/// passed. The reply then has the best trajectory so far.
#[derive(Clone, Debug)]
pub struct PlanTask {
    planner: Planner,
    latency: u32,
    slices_per_tick: u32,
    cycle: Option<Cycle>,
    reply: Option<Due>,
}

/// A reply that waits to be collected.
#[derive(Clone, Copy, Debug)]
enum Due {
    SetUp(u32, Result<(), mpp_core::planner::SetupError>),
    Plan(u32),
}

impl PlanTask {
    /// A task that waits for its first request.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            planner: Planner::new(),
            latency: 0,
            slices_per_tick: 0,
            cycle: None,
            reply: None,
        }
    }

    /// The planner, for inspection between slices.
    #[must_use]
    pub fn planner(&self) -> &Planner {
        &self.planner
    }

    pub(crate) fn planner_mut(&mut self) -> &mut Planner {
        &mut self.planner
    }

    /// Takes a request, and drops the present work.
    // The set-up needs a deep stack. The function is not inlined, so that this stack is free again when
    // slices run.
    #[inline(never)]
    pub fn take(&mut self, request: &PlanRequest) {
        self.cycle = None;
        self.reply = None;
        match request {
            PlanRequest::SetUp { number, settings } => {
                let result = self.planner.set_up(settings);
                self.reply = Some(Due::SetUp(*number, result));
            }
            PlanRequest::Begin {
                tick,
                time,
                forget,
                poses,
                state,
                conditions,
                scan,
                planner,
                latency_ticks,
                slices_per_tick,
            } => {
                self.latency = *latency_ticks;
                self.slices_per_tick = *slices_per_tick;
                // The step checks all values before it requests a cycle, so the planner refuses none of them.
                let _ = self.planner.retune(planner);
                if *forget {
                    self.planner.forget();
                }
                self.planner
                    .begin_from(*time, poses, state, conditions, scan.as_ref());
                self.cycle = Some(Cycle {
                    tick: *tick,
                    slices: 0,
                });
            }
        }
    }

    /// Does at most one slice. `clock` is the tick of the last step.
    pub fn advance(&mut self, clock: u32) -> Progress {
        if self.reply.is_some() {
            return Progress::Replied;
        }
        let Some(cycle) = &mut self.cycle else {
            return Progress::Waiting;
        };
        let elapsed = u32::try_from(ticks(cycle.tick, clock)).ok();
        let late = elapsed.is_some_and(|elapsed| elapsed >= self.latency);
        let quota = self.latency.saturating_mul(self.slices_per_tick);
        if late || cycle.slices >= quota || !self.planner.is_working() {
            self.reply = Some(Due::Plan(cycle.tick));
            self.cycle = None;
            return Progress::Replied;
        }
        // The clock may still show the tick before the cycle.
        let granted = elapsed.map_or(0, |elapsed| elapsed.saturating_add(1));
        if cycle.slices >= granted.saturating_mul(self.slices_per_tick) {
            return Progress::Waiting;
        }
        cycle.slices = cycle.slices.saturating_add(1);
        self.planner.advance();
        Progress::Working
    }

    /// Takes the reply, if one is ready.
    pub fn reply(&mut self) -> Option<PlanReply> {
        Some(match self.reply.take()? {
            Due::SetUp(number, result) => PlanReply::SetUp { number, result },
            Due::Plan(tick) => PlanReply::Plan(Plan {
                tick,
                verdict: self.planner.finish(),
                summary: *self.planner.summary(),
                trajectory: self.planner.best().clone(),
                seal: self.planner.seal(),
            }),
        })
    }
}
