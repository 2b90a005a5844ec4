//! The flight core behind its link: frames in, frames out.
//!
//! `mpp-core` knows no wire format, and `hil-protocol` knows no planner. This crate joins them for every
//! place where the core runs: in the process of the harness, in a separate process, and on a flight
//! computer. It has no clock, no I/O and no heap. The owner of the link feeds received bytes in and sends
//! the bytes that come out.
//!
//! # One tick
//!
//! ```text
//! LidarScan k      kept until the next sensor frame
//! SensorFrame k    1. a plan that tick k - 1 has taken over is told -> PlanReport, PlanTrajectory
//!                     the commands of the plan that tick k - 1 has told -> PlanControls
//!                  2. a cycle whose latency has passed is finished and taken over
//!                  3. estimate, reference, control          -> StepReport, ActuatorCommand
//!                  4. if it is time to replan, a scan starts a cycle; without a scan one starts if the lidar
//!                     has fallen silent
//!                  5. the planner runs its slices of this tick
//! ```
//!
//! The step uses a plan `latency_ticks` after the start of its cycle and not earlier, even if the planner was faster.
//! The flight therefore does not depend on the speed of the machine.
//!
//! # In space
//!
//! [`SpaceNode`] does the same for the planner in space, in one thread.
//!
//! # Two tasks
//!
//! ```text
//! bytes -> StepTask -- PlanRequest -> PlanTask     1, 2, 3, 4 | 5
//! bytes <-          <- PlanReply ---
//! ```
//!
//! [`StepTask`] has the link and the 100 Hz step, and [`PlanTask`] has the planner. They share no data and
//! send each other values. [`FlightNode`] runs both in one thread. A flight computer runs the step in an
//! interrupt, which may come at any instruction of the planner; the result is the same.
#![no_std]
#![forbid(unsafe_code)]

mod convert;
mod mail;
mod node;
mod out;
pub mod parameters;
mod plan_task;
mod space;
mod step_task;

pub use convert::sensor_frame;
pub use mail::{Plan, PlanReply, PlanRequest};
pub use node::FlightNode;
pub use plan_task::{PlanTask, Progress};
pub use space::{MOST_POINTS, SpaceMemory, SpaceNode, SpaceSlice, SpaceTask};
pub use step_task::{Pace, StepTask};

use hil_protocol::{Hello, Role};
use mpp_core::config::{MAX_BEAMS, STAGES, TICK_PERIOD};

/// Length of a number of ticks \[s\].
fn duration(ticks: u32) -> f64 {
    f64::from(ticks) * TICK_PERIOD
}

/// Ticks from one tick to another. It is negative if `to` came before `from`. Ticks count on from 0 after the
/// greatest number, so two ticks may be at most half of all numbers apart, which is 248 days.
const fn ticks(from: u32, to: u32) -> i32 {
    to.wrapping_sub(from).cast_signed()
}

/// The hello of a core.
fn greeting() -> Hello {
    Hello {
        role: Role::Core,
        software: software(),
        tick_period_us: (TICK_PERIOD * 1e6) as u32,
        beams_max: MAX_BEAMS as u16,
        stages: STAGES as u16,
    }
}

/// The version of this crate.
fn software() -> [u8; 3] {
    let part = |text: &str| text.parse().unwrap_or(0);
    [
        part(env!("CARGO_PKG_VERSION_MAJOR")),
        part(env!("CARGO_PKG_VERSION_MINOR")),
        part(env!("CARGO_PKG_VERSION_PATCH")),
    ]
}
