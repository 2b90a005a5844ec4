//! What was last told of scans and plans, for a station that asks for it.

use hil_protocol::mavlink::messages::{
    MPP_LIDAR_SCAN_DATA, MPP_PLAN_STATUS_DATA, MPP_TRAJECTORY_DATA,
};

/// The last message of each event.
#[derive(Clone, Debug, Default)]
pub(super) struct Last {
    pub(super) scan: Option<MPP_LIDAR_SCAN_DATA>,
    pub(super) plan: Option<MPP_PLAN_STATUS_DATA>,
    pub(super) trajectory: Option<MPP_TRAJECTORY_DATA>,
}
