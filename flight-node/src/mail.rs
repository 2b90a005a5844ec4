//! What step and planner tell each other.

use crate::parameters::Tuning;
use mpp_core::estimate::Conditions;
use mpp_core::planner::{PlanSummary, SetupError, Verdict};
use mpp_core::sense::LidarScan;
use mpp_core::trajectory::Trajectory;
use mpp_core::vehicle::VehicleState;

/// From the step to the planner.
#[expect(
    clippy::large_enum_variant,
    reason = "there is no heap to put the scan on"
)]
#[derive(Clone, Debug)]
pub enum Order {
    /// Sets the planner up, whatever it was doing; answered by [`Answer::SetUp`].
    SetUp {
        /// Comes back with the answer: an answer to an earlier set-up is nobody's.
        number: u32,
        /// The values in force.
        tuning: Tuning,
    },
    /// Starts a cycle; answered by [`Answer::Plan`].
    Begin {
        /// The tick of the scan.
        tick: u32,
        /// Where the aircraft was then.
        state: VehicleState,
        /// The air and the aircraft's lift then.
        conditions: Conditions,
        /// What it saw.
        scan: LidarScan,
        /// The values in force.
        tuning: Tuning,
    },
}

/// From the planner to the step.
#[expect(
    clippy::large_enum_variant,
    reason = "there is no heap to put the trajectory on"
)]
#[derive(Clone, Debug)]
pub enum Answer {
    /// Whether the planner can fly with the configuration.
    SetUp {
        /// That of the order.
        number: u32,
        /// Why not.
        result: Result<(), SetupError>,
    },
    /// What a cycle came to.
    Plan(Plan),
}

/// What a cycle came to.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The tick of its scan.
    pub scan_tick: u32,
    /// What it has to offer.
    pub verdict: Verdict,
    /// How it went.
    pub summary: PlanSummary,
    /// The best trajectory, if there is one.
    pub trajectory: Trajectory,
}
