//! The reports of the core: planning cycles, trajectories and rejected inputs.

use super::size;
use crate::error::DecodeError;
use core::fmt;
use heapless::Vec;
use serde::{Deserialize, Serialize};

/// Core to harness: the result of one planning cycle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlanReport {
    /// The tick of the scan from which the cycle planned. If the cycle had no scan, this is the tick at which it
    /// started.
    pub scan_tick: u32,
    /// The first tick that flies the outcome.
    pub used_from_tick: u32,
    /// The consequence for the flight.
    pub outcome: PlanOutcome,
    /// Number of programs that the cycle solved: one for each candidate, and further rounds of the best.
    pub candidates: u16,
    /// Number of these programs that gave a feasible trajectory.
    pub feasible: u16,
    /// Number of trees.
    pub tree_runs: u16,
    /// Number of slices of planning work.
    pub slices: u32,
    /// Cost of the best trajectory by the planner's weights \[-\]; infinite without a trajectory.
    pub cost: f64,
    /// Worst violation of the best trajectory \[m or rad\]; 0 if it violates nothing, and infinite without a
    /// trajectory.
    pub violation: f64,
    /// Whether the cycle finished all its work before the deadline.
    pub complete: bool,
}

impl PlanReport {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize = 3 * size::U32 + 2 * size::BYTE + 3 * size::U16 + 2 * size::F64;
}

/// The consequence of a planning cycle for the flight. The order goes over the wire: append only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum PlanOutcome {
    /// The vehicle flies the best trajectory of the cycle, which is feasible.
    Adopted = 0,
    /// The vehicle flies the best trajectory of the cycle, which is not feasible.
    LeastViolating = 1,
    /// The cycle gave no trajectory, or the gate refused it. The vehicle flies the rest of the previous plan.
    KeptPrevious = 2,
    /// There is no trajectory and no previous plan. The vehicle flies straight and level.
    TrimHold = 3,
    /// No plan passes the gate. The vehicle flies a path of the lattice, by pursuit.
    Pursuit = 4,
    /// No plan and no path passes the gate. The vehicle flies a reserve: level, slow, or a climb.
    Reserve = 5,
    /// Nothing passes the gate. The vehicle flies what strikes latest.
    Latest = 6,
}

impl PlanOutcome {
    /// Whether the vehicle flies a trajectory of this cycle.
    #[must_use]
    pub fn is_new(self) -> bool {
        !matches!(self, Self::KeptPrevious | Self::TrimHold)
    }
}

/// Core to harness: the trajectory that a planning cycle chose, after its [`PlanReport`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlanTrajectory {
    /// [`PlanReport::scan_tick`] of its report. A trajectory of preset `flight` starts when the step takes it over
    /// ([`PlanReport::used_from_tick`]); those of the other presets start at the scan.
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

/// Core to harness: the commands along a [`PlanTrajectory`], the tick after it. An aircraft that hears nothing more can fly the
/// rest of the plan by them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlanControls {
    /// [`PlanReport::scan_tick`] of its report.
    pub scan_tick: u32,
    /// Thrust \[N\] from each knot to the next, and elevator at each knot, which moves straight to that of the next.
    pub knots: Vec<[f32; 2], MAX_KNOTS>,
}

impl PlanControls {
    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize = size::U32 + size::BYTE + MAX_KNOTS * 2 * size::F32;
}

/// Core to harness: an input that the core did not use, and the cause.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Rejection {
    /// The core's tick at that moment.
    pub tick: u32,
    /// The cause.
    pub cause: RejectionCause,
}

impl Rejection {
    /// Size of the longest payload, a [`RejectionCause::TickOrder`] \[bytes\].
    pub const MAX_SIZE: usize = size::U32 + size::BYTE + 2 * size::U32;
}

/// The reason why the core did not use an input. [`Display`](fmt::Display) says what is wrong and what to
/// do. The order goes over the wire: append only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, thiserror::Error)]
pub enum RejectionCause {
    /// A measurement is infinite or not a number.
    #[error("a measurement is not a finite number: check the sensors")]
    NonFiniteSensor,
    /// A measurement is too far from what the estimator expected.
    #[error(
        "{} too far from the estimate: check the sensors",
        gated(*.airspeed, *.pitch)
    )]
    InnovationGate {
        /// Whether the airspeed is too far away.
        airspeed: bool,
        /// Whether the pitch is too far away.
        pitch: bool,
    },
    /// The number of beams in a scan differs from the configured one.
    #[error("the scan has {found} beams instead of {expected}: send what was configured")]
    ScanLength {
        /// Configured number of beams.
        expected: u16,
        /// Number of beams in the scan.
        found: u16,
    },
    /// A range is infinite or not a number. It is not sent any more: such a beam has no return.
    #[error("the range of beam {beam} is not a finite number: send 0 where nothing came back")]
    ScanNotFinite {
        /// The first such beam, counted from 0.
        beam: u16,
    },
    /// More than half of the ranges are negative.
    #[error("more than half of the ranges are negative, as that of beam {beam}: check the lidar")]
    ScanRange {
        /// The first such beam, counted from 0.
        beam: u16,
    },
    /// The received bytes are not a message.
    #[error("the core received no message: {0}")]
    Frame(DecodeError),
    /// A tick does not follow the last one, or a scan and its sensor frame have different ticks.
    #[error("tick {found} came instead of tick {expected}: send every tick once")]
    TickOrder {
        /// The expected tick.
        expected: u32,
        /// The received tick.
        found: u32,
    },
    /// A measurement or a scan came before an accepted [`Configure`](crate::Configure).
    #[error("the core is not configured: send a configuration first")]
    NotConfigured,
    /// The core did not expect this message: only the core sends it, or it does not fit this moment.
    #[error("message {id} has no place here: follow the order of a session")]
    UnexpectedMessage {
        /// Number of the message, one of [`id`](crate::id).
        id: u8,
    },
    /// A scan came while the planner still worked on the previous one.
    #[error("the planner still works on the scan before: replan less often, or with less latency")]
    PlannerBusy,
    /// More bytes came than the core could take in.
    #[error("{count} bytes came faster than the core takes them in: send more slowly")]
    BytesLost {
        /// Number of lost bytes.
        count: u32,
    },
    /// The planner was stuck. The core restarted it, and its cycle gave no trajectory.
    #[error("the planner was stuck and started anew: the last plan is flown on, report the fault")]
    PlannerRestarted,
    /// An angle of a scan is infinite or not a number.
    #[error("an angle of the scan is not a finite number: check the lidar")]
    ScanAngle,
    /// A scan has the same ranges as the one before, to the last bit. The lidar is frozen.
    #[error("the scan repeats the one before to the last bit: the lidar is frozen, check it")]
    ScanRepeated,
    /// A scan, or a sector of it, has no return, although obstacles are known there, or its beams come in reverse order.
    #[error(
        "the scan does not show known obstacles: the lidar is blind, check it and the order of its beams"
    )]
    ScanBlind,
    /// A task of the core trapped or hung. The core restarted the planner, or itself if the step was the task.
    #[error(
        "{task} was restarted, because {fault} (address {address:#010x}, fault {count} in a row): report the \
         fault"
    )]
    Trapped {
        /// The task.
        task: CoreTask,
        /// What happened.
        fault: CoreFault,
        /// Address of the instruction; 0 if it is not known.
        address: u32,
        /// Number of faults in a row.
        count: u8,
    },
    /// After several faults in a row the core flies on without its planner, until its power goes off.
    #[error(
        "after several faults in a row the core flies without its planner: land, and switch the power off"
    )]
    PlannerOff,
    /// Nothing returns from beneath the body axis where obstacles are known, or for long to a lidar that is not believed. The
    /// aircraft goes above the altitude band.
    #[error(
        "the lidar is silent beneath: the aircraft climbs out of the altitude band, check the lidar"
    )]
    ScanSilentBelow,
    /// Scans are older than their stamps say by another age than before. From this one on the core reckons with that age.
    #[error(
        "the scans are not as old as their stamps say, and the core corrects that: check the clock of the lidar"
    )]
    ScanAged,
}

/// A task of the core. The order goes over the wire: append only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum CoreTask {
    /// The 100 Hz step, with everything that is not the planner.
    Step = 0,
    /// The planner.
    Planner = 1,
}

/// The reason why a task of the core could not go on. The order goes over the wire: append only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, thiserror::Error)]
pub enum CoreFault {
    /// Another reason than the following ones.
    #[error("the processor could not go on")]
    Other = 0,
    /// The stack grew beyond its memory.
    #[error("its stack grew too large")]
    Stack = 1,
    /// An access that the memory's protection does not allow.
    #[error("it used memory that is not for this use")]
    Memory = 2,
    /// An access that no memory and no device answered.
    #[error("it used an address without memory")]
    Bus = 3,
    /// An instruction that does not exist, or not in this state of the processor.
    #[error("it came to an instruction that does not exist")]
    Instruction = 4,
    /// The task did not come to an end in time.
    #[error("it did not come to an end")]
    Hang = 5,
}

fn gated(airspeed: bool, pitch: bool) -> &'static str {
    match (airspeed, pitch) {
        (true, true) => "airspeed and pitch are",
        (true, false) => "the airspeed is",
        (false, true) => "the pitch is",
        (false, false) => "a measurement is",
    }
}

impl fmt::Display for CoreTask {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Step => "the core",
            Self::Planner => "the planner",
        })
    }
}

/// Core to harness: the counters of everything that the core refused, limited or did without. It comes once a
/// second. The counters only grow, and a full one stays full.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct HealthReport {
    /// The tick of the report.
    pub tick: u32,
    /// The counters, in the order of [`HealthReport::NAMES`].
    pub counters: [u32; HealthReport::NAMES.len()],
}

impl HealthReport {
    /// The name of each counter. The order goes over the wire: append only.
    pub const NAMES: [&str; 24] = [
        "measurements_not_finite",
        "measurements_frozen",
        "measurements_late",
        "measurements_distrusted",
        "measurements_gated",
        "time_jumps",
        "predictions_diverged",
        "positions_not_finite",
        "positions_held",
        "positions_late",
        "positions_gated",
        "positions_restarted",
        "commands_not_finite",
        "thrust_limited",
        "elevator_limited",
        "plans_feasible",
        "plans_kept",
        "plans_least_violating",
        "plans_trim_hold",
        "planner_inconsistent",
        "plans_refused",
        "plans_pursuit",
        "plans_reserve",
        "plans_latest",
    ];

    /// Size of the longest payload \[bytes\].
    pub const MAX_SIZE: usize = (1 + Self::NAMES.len()) * size::U32;
}
