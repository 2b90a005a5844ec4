//! The data of one tick, for an observer of a flight.

use crate::entries::{PlanEntry, RejectionEntry, Tick};
use hil_protocol::{HealthReport, LidarScan, PlanReport, PlanTrajectory, SensorStates};

/// The data of one tick.
pub struct TickRecord<'a> {
    /// The tick as logged.
    pub tick: &'a Tick,
    /// The scan taken at this tick, as the lidar shows it, if one was taken. It may arrive at the core later.
    /// It is absent if the link loses the messages of this tick.
    pub scan: Option<&'a LidarScan>,
    /// The plan taken over at this tick, if one was.
    pub plan: Option<&'a PlanEntry>,
    /// The core's report on this plan.
    pub report: Option<&'a PlanReport>,
    /// The plan's trajectory.
    pub trajectory: Option<&'a PlanTrajectory>,
    /// The core's trust in its sensors.
    pub sensors: SensorStates,
    /// The core's counters, if it reported them at this tick.
    pub health: Option<&'a HealthReport>,
    /// Inputs refused and faults told so far.
    pub rejections: &'a [RejectionEntry],
}
