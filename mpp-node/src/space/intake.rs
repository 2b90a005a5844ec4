//! Points on their way into the map.

/// Points that wait for the map, and how far they have come.
#[derive(Clone, Copy)]
pub(super) struct Intake {
    /// Tick, position \[m\] and course \[rad\] of their sensor frame.
    pub(super) tick: u32,
    pub(super) position: [f64; 3],
    pub(super) course: f64,
    pub(super) stage: IntakeStage,
}

/// What the next slice does with the points: from which one on it takes their hits, or what they passed.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum IntakeStage {
    Begin,
    Mark(usize),
    Pass(usize),
}
