//! What the core tells about itself: plans and refused inputs.

use super::size;
use crate::error::DecodeError;
use heapless::Vec;
use serde::{Deserialize, Serialize};

/// Core to harness: how one planning cycle ended.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlanReport {
    /// The tick of the scan that was planned from.
    pub scan_tick: u32,
    /// The first tick that flies the outcome.
    pub used_from_tick: u32,
    /// What will be flown.
    pub outcome: PlanOutcome,
    /// Candidates that were refined.
    pub candidates: u16,
    /// Candidates of these that keep every constraint.
    pub feasible: u16,
    /// Trees that were grown.
    pub tree_runs: u16,
    /// Slices of planning work that were used.
    pub slices: u32,
    /// Cost of the trajectory to be flown, as the planner weighs it \[-\].
    pub cost: f64,
    /// How far this trajectory leaves its corridor at the worst stage; 0 = inside \[m\].
    pub violation: f64,
    /// Whether all work was done before the deadline.
    pub complete: bool,
}

impl PlanReport {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize = 3 * size::U32 + 2 * size::BYTE + 3 * size::U16 + 2 * size::F64;
}

/// What will be flown after a planning cycle. The order is what goes over the wire: append only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum PlanOutcome {
    /// The best feasible candidate.
    Adopted = 0,
    /// No candidate is feasible: the one that violates its corridor least.
    LeastViolating = 1,
    /// No candidate is feasible: the rest of the plan before.
    KeptPrevious = 2,
    /// Nothing to fly: straight and level.
    TrimHold = 3,
}

/// Core to harness: the trajectory that a planning cycle chose, after its [`PlanReport`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlanTrajectory {
    /// The tick of the scan that it was planned from, at which it starts.
    pub scan_tick: u32,
    /// Time from a knot to the next \[s\].
    pub period: f32,
    /// Downrange distance \[m\], height \[m\] and flight path angle \[rad\] at each knot.
    pub knots: Vec<[f32; 3], MAX_KNOTS>,
}

/// The most knots in a [`PlanTrajectory`].
pub const MAX_KNOTS: usize = 19;

impl PlanTrajectory {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize = size::U32 + size::F32 + size::BYTE + MAX_KNOTS * 3 * size::F32;
}

/// Core to harness: an input that was not used, and why.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Rejection {
    /// The core's tick at that moment.
    pub tick: u32,
    /// Why.
    pub cause: RejectionCause,
}

impl Rejection {
    /// Size of the longest payload, a [`RejectionCause::TickOrder`] \[bytes\].
    pub const MAX_SIZE: usize = size::U32 + size::BYTE + 2 * size::U32;
}

/// Why an input was not used. The order is what goes over the wire: append only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum RejectionCause {
    /// A measurement is infinite or not a number.
    NonFiniteSensor,
    /// A measurement is too far from what the estimator expected.
    InnovationGate {
        /// The airspeed was.
        airspeed: bool,
        /// The pitch was.
        pitch: bool,
    },
    /// A scan with another number of beams than was configured.
    ScanLength {
        /// As configured.
        expected: u16,
        /// In the scan.
        found: u16,
    },
    /// A range is infinite or not a number.
    ScanNotFinite {
        /// The first such beam, counted from 0.
        beam: u16,
    },
    /// A range is negative or beyond the lidar's reach.
    ScanRange {
        /// The first such beam, counted from 0.
        beam: u16,
    },
    /// Bytes that were no message.
    Frame(DecodeError),
    /// A tick that is not the one after the last.
    TickOrder {
        /// The one after the last.
        expected: u32,
        /// The one that came.
        found: u32,
    },
    /// A measurement or a scan before an accepted [`Configure`](crate::Configure).
    NotConfigured,
    /// A message that only the other side sends, or not at this moment.
    UnexpectedMessage {
        /// Its number, one of [`id`](crate::id).
        id: u8,
    },
    /// A scan came while the planner still works on the one before.
    PlannerBusy,
    /// More bytes came than could be taken in.
    BytesLost {
        /// How many are gone.
        count: u32,
    },
    /// The planner was stuck: it was started anew, and its cycle came to nothing.
    PlannerRestarted,
}
