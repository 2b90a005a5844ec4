//! The task of the planner, which runs cycles slice by slice.

use crate::mail::{Answer, Order, Plan};
use crate::ticks;
use mpp_core::planner::Planner;

/// The result of a call of [`PlanTask::advance`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// There is nothing to do until a later tick grants more slices, or an order comes.
    Waiting,
    /// The task has done a slice.
    Working,
    /// An answer is ready: [`PlanTask::answer`].
    Answered,
}

/// A cycle under way.
#[derive(Clone, Copy, Debug)]
struct Cycle {
    tick: u32,
    slices: u32,
}

/// The planner and its orders. The value is large: place it in a `static` or a box.
///
/// A cycle gets `slices_per_tick` slices for each tick from its start until its plan is due. The cycle ends
/// when it has used these slices, when it has no more work, or when the tick at which the plan is due has
/// passed. It then answers with its best trajectory so far.
#[derive(Clone, Debug)]
pub struct PlanTask {
    planner: Planner,
    latency: u32,
    slices_per_tick: u32,
    cycle: Option<Cycle>,
    answer: Option<Due>,
}

/// An answer that waits to be collected.
#[derive(Clone, Copy, Debug)]
enum Due {
    SetUp(u32, Result<(), mpp_core::planner::SetupError>),
    Plan(u32),
}

impl PlanTask {
    /// A task that waits for its first order.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            planner: Planner::new(),
            latency: 0,
            slices_per_tick: 0,
            cycle: None,
            answer: None,
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

    /// Takes an order, and drops the present work.
    // The set-up needs a deep stack. The function is not inlined, so that this stack is free again when
    // slices run.
    #[inline(never)]
    pub fn take(&mut self, order: &Order) {
        self.cycle = None;
        self.answer = None;
        match order {
            Order::SetUp { number, settings } => {
                let result = self.planner.set_up(settings);
                self.answer = Some(Due::SetUp(*number, result));
            }
            Order::Begin {
                tick,
                time,
                forget,
                pose,
                state,
                conditions,
                scan,
                planner,
                latency_ticks,
                slices_per_tick,
            } => {
                self.latency = *latency_ticks;
                self.slices_per_tick = *slices_per_tick;
                // The step checks all values before it orders a cycle, so the planner refuses none of them.
                let _ = self.planner.retune(planner);
                if *forget {
                    self.planner.forget();
                }
                self.planner
                    .begin_from(*time, pose, state, conditions, scan.as_ref());
                self.cycle = Some(Cycle {
                    tick: *tick,
                    slices: 0,
                });
            }
        }
    }

    /// Does at most one slice. `clock` is the tick of the last step.
    pub fn advance(&mut self, clock: u32) -> Progress {
        if self.answer.is_some() {
            return Progress::Answered;
        }
        let Some(cycle) = &mut self.cycle else {
            return Progress::Waiting;
        };
        let elapsed = u32::try_from(ticks(cycle.tick, clock)).ok();
        let late = elapsed.is_some_and(|elapsed| elapsed >= self.latency);
        let quota = self.latency.saturating_mul(self.slices_per_tick);
        if late || cycle.slices >= quota || !self.planner.is_working() {
            self.answer = Some(Due::Plan(cycle.tick));
            self.cycle = None;
            return Progress::Answered;
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

    /// Takes the answer, if one is ready.
    pub fn answer(&mut self) -> Option<Answer> {
        Some(match self.answer.take()? {
            Due::SetUp(number, result) => Answer::SetUp { number, result },
            Due::Plan(tick) => Answer::Plan(Plan {
                tick,
                verdict: self.planner.finish(),
                summary: *self.planner.summary(),
                trajectory: self.planner.best().clone(),
            }),
        })
    }
}

impl Default for PlanTask {
    fn default() -> Self {
        Self::new()
    }
}
