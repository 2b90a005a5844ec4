//! Spare copies of the values that only a configuration or a parameter changes.

use crate::parameters::Tuning;
use mpp_core::flight::Design;

/// The second and the third copy. The first one is in use.
#[derive(Clone, Copy)]
pub(super) struct Spare {
    pub(super) tuning: [Tuning; 2],
    pub(super) design: [Design; 2],
}

/// The result of a comparison of three copies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Copies {
    /// All are equal.
    Equal,
    /// One was different, and has the value of the others now.
    Repaired,
    /// All are different.
    Lost,
}

/// One copy of two, the other one at the next turn.
pub(super) fn in_turn<T>([second, third]: &[T; 2], turn: u32) -> &T {
    if turn.is_multiple_of(2) {
        second
    } else {
        third
    }
}

/// Compares three copies and repairs one that differs. A flip of the sign of a zero does not count.
pub(super) fn compare<T: Copy + PartialEq>(first: &mut T, others: &mut [T; 2]) -> Copies {
    let [second, third] = others;
    match [same(first, second), same(first, third)] {
        [true, true] => return Copies::Equal,
        [true, false] => *third = *first,
        [false, true] => *second = *first,
        [false, false] if same(second, third) => *first = *second,
        [false, false] => return Copies::Lost,
    }
    Copies::Repaired
}

// Not inlined, so that the comparison of so many numbers is in the image only once.
#[inline(never)]
pub(super) fn same<T: PartialEq>(first: &T, second: &T) -> bool {
    first == second
}
