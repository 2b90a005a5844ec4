//! Marks in the instruction stream, which the emulator's counter sees: `dbg` hints, which do
//! nothing on any processor.

use core::arch::asm;
use mpp_core::planner::Phase;

/// What a counted region was.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Region {
    /// A frame that made no step: hello, configuration, scan.
    Frame,
    /// A sensor frame and all of its answer: decoding, take-over, estimate, control, reports.
    Step,
    /// An order taken by the planner; a cycle starts.
    Order,
    /// A slice that built the map.
    Map,
    /// A slice of the path search.
    Tree,
    /// A slice that traced a corridor.
    Corridor,
    /// A slice of a program.
    Program,
    /// An answer given by the planner; a cycle ends.
    Answer,
    /// An interrupt of the UART.
    Uart,
    /// A slice that joined a scan to the map's memory.
    Remember,
    /// A slice of the search over the lattice.
    Lattice,
    /// A slice that linearised about a candidate.
    Linearise,
    /// A slice of a candidate's round.
    Improve,
    /// A byte inside a frame.
    Byte,
    /// The planner's look round for work.
    Idle,
}

impl Region {
    /// The region that the next slice of the planner belongs to.
    #[must_use]
    pub fn of(phase: Phase) -> Self {
        match phase {
            Phase::Map => Self::Map,
            Phase::Tree => Self::Tree,
            Phase::Corridor => Self::Corridor,
            Phase::Remember => Self::Remember,
            Phase::Lattice => Self::Lattice,
            Phase::Linearise => Self::Linearise,
            Phase::Improve => Self::Improve,
            Phase::Idle | Phase::Program | Phase::Done => Self::Program,
        }
    }
}

/// A region begins. Regions nest; an inner one does not count for the outer.
#[inline(always)]
pub fn begin() {
    // SAFETY: a hint.
    unsafe { asm!("dbg #0") }
}

/// The innermost region ends.
#[inline(always)]
pub fn end(region: Region) {
    // SAFETY: hints.
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
