//! Random programs of few rows, some of which contradict each other.

use super::programs::{Draw, Setup, left_hand_side};
use mpp_core::config::STAGES;
use mpp_core::qp::{Bounds, Problem, ROWS, RowKind, StageControl};

/// A row that controls can change.
pub(crate) fn any_row(draw: &mut Draw) -> usize {
    let kind = match draw.below(3) {
        0 => RowKind::Position(2 + draw.below(STAGES - 1), draw.below(8)),
        1 => RowKind::Attitude(1 + draw.below(STAGES), draw.below(4)),
        _ => {
            // Thrust rows are always hard, and two of one stage could contradict each other.
            let stage = draw.below(STAGES);
            RowKind::Thrust(stage, stage % 2)
        }
    };
    number(kind)
}

pub(crate) fn number(kind: RowKind) -> usize {
    (0..ROWS).find(|row| RowKind::of(*row) == kind).unwrap()
}

/// Rows that together leave no room, with the weights with which they cancel: opposite faces, three
/// faces around a point, opposite attitudes, and a climb from below that its flight path forbids.
fn opposed_rows(setup: &Setup, draw: &mut Draw) -> Vec<(usize, f64)> {
    let knot = 2 + draw.below(STAGES - 1);
    let position = |knot, direction: usize| number(RowKind::Position(knot, direction % 8));
    let attitude = |which| number(RowKind::Attitude(knot, which));
    let (face, which) = (draw.below(8), draw.below(2));
    match draw.below(4) {
        0 => vec![(position(knot, face), 1.0), (position(knot, face + 4), 1.0)],
        1 => vec![
            (position(knot, face), libm::sqrt(2.0)),
            (position(knot, face + 3), 1.0),
            (position(knot, face + 5), 1.0),
        ],
        2 => vec![(attitude(which), 1.0), (attitude(which + 2), 1.0)],
        _ => {
            let knot = knot.min(STAGES - 1);
            let climb = setup.model.a[(1, 5)];
            vec![
                (position(knot, 0), 1.0),
                (number(RowKind::Attitude(knot, 1)), climb),
                (position(knot + 1, 4), 1.0),
            ]
        }
    }
}

/// The intended kind of a program.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Made {
    Feasible,
    Infeasible,
    Either,
}

/// A program of few rows about random controls. The controls keep all rows, or miss some that
/// contradict each other, or neither.
fn program(setup: &Setup, most_rows: usize, made: Made, draw: &mut Draw) -> Problem {
    let spread = [0.0, 0.0, 1.5, 0.2, 0.4, 0.2];
    let initial = spread.map(|spread| draw.between(-spread, spread));
    let controls: [StageControl; STAGES] =
        core::array::from_fn(|_| [draw.between(-2.0, 2.0), draw.between(-1.0, 1.0)]);
    let states = setup.roll_out(&initial, &controls);
    let value = |row: usize| left_hand_side(row, &states, &controls);
    let opposed = opposed_rows(setup, draw);
    let mut bounds = Bounds::none();
    if made == Made::Infeasible {
        let missed = draw.between(0.01, 0.5);
        for (row, weight) in &opposed {
            bounds.0[*row] = value(*row) - missed / weight / opposed.len() as f64;
        }
    }
    let spare = if made == Made::Either {
        if draw.unit() < 0.5 {
            for (row, _) in &opposed {
                bounds.0[*row] = value(*row) + draw.between(-0.1, 0.1);
            }
        }
        draw.between(-1.0, 0.0)
    } else {
        0.0
    };
    while bounds.0.iter().filter(|bound| bound.is_finite()).count() < most_rows {
        let row = any_row(draw);
        if bounds.0[row].is_infinite() {
            bounds.0[row] = value(row) + draw.between(spare, 0.3);
        }
    }
    Problem {
        initial,
        target: [0.0, draw.between(-8.0, 8.0), 0.0, 0.0, 0.0, 0.0],
        bounds,
        // With both sides two hard rows could contradict each other.
        hard_angle_of_attack: [draw.unit() < 0.5, false],
        ..Problem::EMPTY
    }
}

/// Calls `check` with this many programs of all presets and makes in turn.
pub(crate) fn for_each_program(
    seed: u64,
    count: usize,
    most_rows: usize,
    mut check: impl FnMut(&Setup, &Problem, Made, &mut Draw),
) {
    let mut draw = Draw::new(seed);
    let setups = Setup::all();
    for index in 0..count {
        let made = [Made::Feasible, Made::Infeasible, Made::Either, Made::Either][index % 4];
        let setup = &setups[draw.below(setups.len())];
        let rows = most_rows - draw.below(3);
        let problem = program(setup, rows, made, &mut draw);
        check(setup, &problem, made, &mut draw);
    }
}

/// Largest difference of two flights' controls.
pub(crate) fn difference(a: &[StageControl; STAGES], b: &[StageControl; STAGES]) -> f64 {
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}
