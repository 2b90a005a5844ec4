//! The memory that field, search and programs use one after the other.

use super::lattice::Lattice;
use crate::map::voxel_field::NearSlices;
use crate::qp::Status;
use crate::qp::space::{Bounds, Condensed, Faces, Solution, Solver};
use core::mem::ManuallyDrop;

/// The memory of one phase. The next phase overwrites it.
#[derive(Clone, Debug)]
#[expect(
    clippy::large_enum_variant,
    reason = "both are large, and there is no heap"
)]
pub(super) enum Workspace {
    Program(Program),
    Search(Lattice),
    Field(NearSlices),
}

/// What the program of a candidate needs while it is solved.
#[derive(Clone, Debug)]
pub(super) struct Program {
    pub(super) faces: Faces,
    pub(super) shared: Condensed,
    /// Nothing in it needs a drop. A type that has one would be built on the stack before it takes the place of another.
    pub(super) solver: ManuallyDrop<Solver>,
    pub(super) solution: Solution,
}

impl Workspace {
    /// Zeros: the compiler writes them in place, and builds no such large value on the stack.
    pub(super) const PROGRAM: Self = Self::Program(Program {
        faces: Faces::ZEROS,
        shared: Condensed::new(),
        solver: ManuallyDrop::new(ZEROS),
        solution: Solution::new(),
    });
}

/// A solver of zeros, which waits until its program is posed.
const ZEROS: Solver = {
    let mut solver = Solver::new();
    solver.problem.bounds = Bounds([0.0; _]);
    solver.problem.cost_limit = 0.0;
    solver.open = Bounds([0.0; _]);
    solver.status = Some(Status::Optimal);
    solver
};
