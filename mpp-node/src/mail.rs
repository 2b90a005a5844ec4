//! The messages between step and planner.

use mpp_core::planner::{PlanSummary, SetupError, Verdict};
use mpp_core::sense::LidarScan;
use mpp_core::settings::{PlannerSettings, Settings};
use mpp_core::trajectory::Trajectory;
use mpp_core::vehicle::Conditions;
use mpp_core::vehicle::ScanPoses;
use mpp_core::vehicle::VehicleState;

/// A request of the step to the planner.
#[expect(
    clippy::large_enum_variant,
    reason = "there is no heap to put the scan on"
)]
#[derive(Clone, Debug)]
pub enum PlanRequest {
    /// Sets the planner up and drops its present work. The reply is [`PlanReply::SetUp`].
    SetUp {
        /// Number of the set-up. It comes back with the reply, and the step drops a reply to an earlier
        /// set-up.
        number: u32,
        /// The settings in force.
        settings: Settings,
    },
    /// Starts a cycle. The reply is [`PlanReply::Plan`].
    Begin {
        /// The tick at which the cycle starts.
        tick: u32,
        /// Time of that tick \[s\].
        time: f64,
        /// Whether the planner must forget its map and its last plan first, because the origin of the
        /// positions has jumped.
        forget: bool,
        /// Poses of the lidar when it took the scan, by each age that its stamp may hide.
        poses: ScanPoses,
        /// State of the aircraft at that tick.
        state: VehicleState,
        /// Estimated wind and lift at that tick.
        conditions: Conditions,
        /// The scan; `None` if the lidar has fallen silent.
        scan: Option<LidarScan>,
        /// The settings of the planner in force.
        planner: PlannerSettings,
        /// Ticks from the start of the cycle until its plan is due.
        latency_ticks: u32,
        /// Number of slices that the cycle may use in a tick.
        slices_per_tick: u32,
    },
}

/// The reply of the planner to a [`PlanRequest`].
#[expect(
    clippy::large_enum_variant,
    reason = "there is no heap to put the trajectory on"
)]
#[derive(Clone, Debug)]
pub enum PlanReply {
    /// The result of a set-up.
    SetUp {
        /// The number of the request.
        number: u32,
        /// The cause if the set-up failed.
        result: Result<(), SetupError>,
    },
    /// The result of a cycle.
    Plan(Plan),
}

/// The result of a cycle.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The tick at which the cycle started.
    pub tick: u32,
    /// The verdict on the best trajectory.
    pub verdict: Verdict,
    /// The summary of the cycle.
    pub summary: PlanSummary,
    /// The best trajectory, if there is one.
    pub trajectory: Trajectory,
    /// The seal of the trajectory that the gate let through. The step drops another one.
    pub seal: u64,
}
