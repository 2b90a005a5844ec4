//! The two tasks, their mailboxes, and the work of each task when it gets the processor.

use crate::mailbox::Mailbox;
use crate::owned::{self, Owned};
use crate::{faults, image, mark, restart, trap};
use core::sync::atomic::{AtomicU32, Ordering};
use hil_protocol::{ConfigureVerdict, RejectionCause};
use mark::Region;
use mpp_node::{Pace, PlanReply, PlanRequest, PlanTask, Progress, StepTask};

/// Requests of the step to the planner.
static REQUESTS: Mailbox<PlanRequest> = Mailbox::new();
/// Replies of the planner to the step.
static REPLIES: Mailbox<PlanReply> = Mailbox::new();
/// The planner's clock, from [`StepTask::clock`].
static CLOCK: AtomicU32 = AtomicU32::new(0);
/// Counter of the planner's activity. As long as it changes, the planner is alive.
static PULSE: AtomicU32 = AtomicU32::new(0);

static STEP: Owned<StepSide> = Owned::uninit();
#[unsafe(link_section = ".axisram")]
static PLAN: Owned<PlanTask> = Owned::uninit();
// SAFETY: this is a constant, and the compiler checks it.
const _: PlanTask = unsafe { owned::zeros() };

/// The data that the step's interrupt owns.
pub struct StepSide {
    task: StepTask,
    pulse: u32,
    silent_for: u32,
    /// Number of calls of [`StepSide::watch_planner`] since the last fault.
    calm_for: u32,
    planner_off: bool,
    /// Number of restarts of the planner.
    pub restarts: u32,
}

/// Number of calls of [`StepSide::watch_planner`], one in each 10 ms, after which a planner without a pulse
/// counts as stuck. The longest slice of the planner takes a tenth of this time.
const SILENCE_LIMIT: u32 = 10;
/// Number of calls of [`StepSide::watch_planner`], 30 s of them, after which the next fault counts as the first.
/// A fault that comes in each cycle comes within seconds.
const CALM: u32 = 3000;

/// Prepares the step's side.
///
/// # Safety
/// The caller calls this function once, before it enables any interrupt.
// Not inlined, so that the stack that it needs is free again when the planner runs.
#[inline(never)]
pub unsafe fn set_up(pace: Pace) {
    // SAFETY: nothing else runs yet.
    unsafe {
        STEP.write(StepSide {
            task: StepTask::new(pace),
            pulse: 0,
            silent_for: 0,
            calm_for: 0,
            planner_off: false,
            restarts: 0,
        });
    }
    if !image::is_whole() {
        // SAFETY: as above.
        let side = unsafe { STEP.get() };
        side.task.refuse(ConfigureVerdict::ImageDamaged);
    }
}

/// The data that the step's interrupt owns.
///
/// # Safety
/// Only the step's interrupt may call this function, or code that runs before it is enabled.
pub unsafe fn step_side() -> &'static mut StepSide {
    // SAFETY: `set_up` has written the value. There is one user at a time, as the caller promises.
    unsafe { STEP.get() }
}

impl StepSide {
    /// Sends a hello without being asked, and tells the fault that made the core restart.
    pub fn announce(&mut self, mut send: impl FnMut(&[u8])) {
        self.task.announce(&mut send);
        if let Some(fault) = trap::untold() {
            self.task.report(fault, &mut send);
        }
        if trap::planner_stays_off() {
            self.planner_off = true;
            self.task.planner_off(send);
        }
    }

    /// Whether bytes of the link have to wait for the planner.
    #[must_use]
    pub fn waits(&self) -> bool {
        self.task.waits()
    }

    /// The tick of the last step, if there was one.
    #[must_use]
    pub fn last_tick(&self) -> Option<u32> {
        self.task.last_tick()
    }

    /// Takes a byte from the link.
    pub fn receive(&mut self, byte: u8, send: impl FnMut(&[u8])) {
        let before = self.task.last_tick();
        mark::begin();
        self.task.receive(byte, send);
        self.end_region(byte == 0, before);
        self.post();
    }

    /// Takes the planner's reply, if there is one.
    // Not inlined, so that the reply is not on the stack of each byte.
    #[inline(never)]
    pub fn collect(&mut self, send: impl FnMut(&[u8])) {
        // SAFETY: the step is the consumer.
        if let Some(reply) = unsafe { REPLIES.take() } {
            let before = self.task.last_tick();
            mark::begin();
            self.task.take_reply(reply, send);
            self.end_region(true, before);
        }
        self.post();
    }

    /// Reports lost bytes of the link.
    pub fn bytes_lost(&mut self, count: u32, send: impl FnMut(&[u8])) {
        self.task.report(RejectionCause::BytesLost { count }, send);
    }

    /// Handles a trap of the planner, which is restarted already, and restarts a planner that is stuck. The
    /// step calls this function every 10 ms.
    pub fn watch_planner(&mut self, mut send: impl FnMut(&[u8])) {
        if self.planner_off {
            return;
        }
        self.calm_for = self.calm_for.saturating_add(1);
        if self.calm_for == CALM {
            trap::forget();
        }
        let pulse = PULSE.load(Ordering::Relaxed);
        if let Some(fault) = trap::untold() {
            self.task.report(fault, &mut send);
            self.planner_dropped(send);
        } else if pulse != self.pulse {
            self.pulse = pulse;
            self.silent_for = 0;
        } else {
            self.silent_for = self.silent_for.saturating_add(1);
            if self.silent_for >= SILENCE_LIMIT {
                trap::record_hang();
                self.planner_dropped(send);
                restart::planner();
            }
        }
    }

    /// Handles the loss of the planner: it starts anew, or stays off after too many faults in a row.
    fn planner_dropped(&mut self, send: impl FnMut(&[u8])) {
        self.silent_for = 0;
        self.calm_for = 0;
        self.restarts = self.restarts.saturating_add(1);
        // SAFETY: the step is the consumer. It drops a reply from before the restart.
        drop(unsafe { REPLIES.take() });
        if trap::planner_stays_off() {
            self.planner_off = true;
            self.task.planner_off(send);
        } else {
            self.task.planner_lost(send);
        }
        self.post();
    }

    /// Sends the request and the time to the planner.
    fn post(&mut self) {
        if !REQUESTS.is_full() && self.task.has_request() {
            self.post_request();
        }
        CLOCK.store(self.task.clock(), Ordering::Release);
    }

    // Not inlined, so that the request is not on the stack of each byte.
    #[inline(never)]
    fn post_request(&mut self) {
        if let Some(request) = self.task.request() {
            // SAFETY: the step is the producer.
            unsafe { REQUESTS.post(request) };
        }
    }

    fn end_region(&self, frame: bool, before: Option<u32>) {
        if self.task.last_tick() != before {
            mark::end(Region::Step);
            faults::step(self.task.clock());
        } else if frame {
            mark::end(Region::Frame);
        } else {
            mark::end(Region::Byte);
        }
    }
}

/// Whether a request waits for the planner.
#[must_use]
pub fn has_order() -> bool {
    REQUESTS.is_full()
}

fn pulse() {
    PULSE.fetch_add(1, Ordering::Relaxed);
}

/// The planner's thread. `idle` is called when there is nothing to do.
///
/// # Safety
/// Only the thread may call this function, and the thread never runs twice at a time: it starts from
/// `main`, or anew after [`restart::planner`] has dropped it.
pub unsafe fn plan(notify_step: fn(), mut idle: impl FnMut()) -> ! {
    trap::planner_runs();
    while trap::planner_stays_off() {
        idle();
    }
    // SAFETY: the thread is the only user, and there is only one thread. Zeros are a valid task, as the
    // constant beside `PLAN` proves. `PlanTask::new()` would lie on the stack, which is smaller.
    let task = unsafe {
        PLAN.write_zeros();
        PLAN.get()
    };
    // A task of zeros is valid, but not ready. It must do nothing until its first `SetUp`, which sets
    // all of its state. The loop also ignores requests to a planner before a restart.
    let mut set_up = false;
    let mut first_slice = false;
    loop {
        pulse();
        if REQUESTS.is_full() {
            // SAFETY: this is the thread.
            let begins = unsafe { obey(task, &mut set_up) };
            first_slice |= begins;
        }
        if !set_up {
            idle();
            continue;
        }
        let clock = CLOCK.load(Ordering::Acquire);
        let phase = task.planner().phase();
        mark::begin();
        let progress = task.advance(clock);
        match progress {
            Progress::Working => {
                mark::end(Region::of(phase));
                faults::planner(clock);
                if core::mem::take(&mut first_slice) {
                    faults::slice();
                }
            }
            Progress::Waiting => {
                mark::end(Region::Idle);
                idle();
            }
            Progress::Replied => {
                if !REPLIES.is_full() {
                    // SAFETY: this is the thread.
                    unsafe { post_reply(task) };
                }
                mark::end(Region::Answer);
                notify_step();
            }
        }
    }
}

/// Takes a request, if the planner is or will be set up. Returns true if a cycle begins.
///
/// # Safety
/// Only the thread may call this function.
unsafe fn obey(task: &mut PlanTask, set_up: &mut bool) -> bool {
    let take = |request: &PlanRequest| {
        let begins = matches!(request, PlanRequest::Begin { .. });
        *set_up |= !begins;
        if !*set_up {
            return false;
        }
        if !begins {
            faults::set_up(pulse);
        }
        mark::begin();
        task.take(request);
        mark::end(Region::Order);
        begins
    };
    // SAFETY: the thread is the consumer.
    unsafe { REQUESTS.read(take) }.unwrap_or_default()
}

/// Posts the reply of the planner.
///
/// # Safety
/// Only the thread may call this function.
// Not inlined, so that the reply is not on the stack of the slices.
#[inline(never)]
unsafe fn post_reply(task: &mut PlanTask) {
    if let Some(reply) = task.reply() {
        // SAFETY: the thread is the producer.
        unsafe { REPLIES.post(reply) };
    }
}
