//! Marks in the instruction stream for the emulator's instruction counter. The marks are `dbg` hints,
//! which have no effect on a processor.

use core::arch::asm;
use mpp_core::planner::Phase;

/// The kind of a counted region.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Region {
    /// A frame that made no step: hello, configuration, scan.
    Frame,
    /// A sensor frame and all of its answer: decoding, take-over, estimate, control, reports.
    Step,
    /// An order that the planner takes: a set-up, or the start of a cycle.
    Order,
    /// A slice that built the map.
    Map,
    /// A slice of the path search.
    Tree,
    /// A slice that traced a corridor or set the faces about a candidate.
    Corridor,
    /// A slice of a program.
    Program,
    /// An answer of the planner: to a set-up, or at the end of a cycle.
    Answer,
    /// An interrupt of the UART.
    Uart,
    /// A slice that took beams into the map with memory, or built its clearance field.
    Remember,
    /// A slice of the search over the lattice.
    Lattice,
    /// A slice that linearised about a candidate.
    Linearise,
    /// A slice of the solver for a candidate, with the roll-out at the end.
    Improve,
    /// A byte inside a frame.
    Byte,
    /// A check by the planner for work, when there is no work to do.
    Idle,
}

impl Region {
    /// The region that the next slice of the planner belongs to.
    #[must_use]
    pub fn of(phase: Phase) -> Self {
        #[cfg(feature = "paper")]
        use mpp_core::paper::Phase as Paper;
        use mpp_core::planner::plane::Phase as Flight;
        match phase {
            Phase::Plane(Flight::Map) => Self::Remember,
            Phase::Plane(Flight::Lattice) => Self::Lattice,
            Phase::Plane(Flight::Faces) => Self::Corridor,
            Phase::Plane(Flight::Linearise) => Self::Linearise,
            Phase::Plane(Flight::Improve | Flight::Gate | Flight::Idle | Flight::Done) => {
                Self::Improve
            }
            #[cfg(feature = "paper")]
            Phase::Paper(Paper::Map) => Self::Map,
            #[cfg(feature = "paper")]
            Phase::Paper(Paper::Tree) => Self::Tree,
            #[cfg(feature = "paper")]
            Phase::Paper(Paper::Corridor) => Self::Corridor,
            #[cfg(feature = "paper")]
            Phase::Paper(Paper::Program | Paper::Idle | Paper::Done) => Self::Program,
        }
    }
}

/// Marks the beginning of a region. Regions nest: an inner region does not count for the outer one.
#[inline(always)]
pub fn begin() {
    // SAFETY: a hint has no effect.
    unsafe { asm!("dbg #0") }
}

/// Marks the end of the innermost region.
#[inline(always)]
pub fn end(region: Region) {
    // SAFETY: hints have no effect.
    unsafe {
        match region {
            Region::Frame => asm!("dbg #1"),
            Region::Step => asm!("dbg #2"),
            Region::Order => asm!("dbg #3"),
            Region::Map => asm!("dbg #4"),
            Region::Tree => asm!("dbg #5"),
            Region::Corridor => asm!("dbg #6"),
            Region::Program => asm!("dbg #7"),
            Region::Answer => asm!("dbg #8"),
            Region::Uart => asm!("dbg #9"),
            Region::Byte => asm!("dbg #10"),
            Region::Idle => asm!("dbg #11"),
            Region::Remember => asm!("dbg #12"),
            Region::Lattice => asm!("dbg #13"),
            Region::Linearise => asm!("dbg #14"),
            Region::Improve => asm!("dbg #15"),
        }
    }
}
