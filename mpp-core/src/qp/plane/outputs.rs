//! The outputs of a program, and their response to the normalised controls.

use super::kernel::{ControlVector, Response, Solution, dot, price_of};
use super::layout::{ATTITUDE_OUTPUT, OUTPUTS, PITCH, ROWS, STATES, THRUST_OUTPUT};
use super::rows::{Normals, parts_mut};
use crate::config::STAGES;
use crate::corridor::DIRECTION_VECTORS;
use nalgebra::Matrix2;

/// The outputs of a trajectory.
pub(in crate::qp) fn outputs(solution: &Solution) -> [f64; OUTPUTS] {
    let mut outputs = [0.0; OUTPUTS];
    let (motion, rest) = outputs.split_at_mut(THRUST_OUTPUT);
    let (thrusts, attitudes) = rest.split_at_mut(STAGES);
    let places = motion.as_chunks_mut::<2>().0.iter_mut().zip(thrusts);
    let places = places.zip(attitudes.as_chunks_mut::<2>().0);
    let stages = solution.controls.iter().zip(solution.states.iter().skip(1));
    for (((motion, thrust), attitude), (control, state)) in places.zip(stages) {
        *motion = [state[0], state[1]];
        *thrust = control[1];
        *attitude = [state[PITCH], state[STATES - 1]];
    }
    outputs
}

/// The positions and thrusts at normalised controls, from those without. Two rows at a time, which are equally long.
#[inline(never)]
pub(in crate::qp) fn respond(
    response: &Response,
    free: &[f64; OUTPUTS],
    normalised: &ControlVector,
    outputs: &mut [f64; OUTPUTS],
) {
    products(response, normalised, |output, by| {
        if let (Some(to), Some(free)) = (outputs.get_mut(output), free.get(output)) {
            *to = free + by;
        }
    });
}

/// The products of the rows of all positions and thrusts with a vector. Those of two stages are equally long.
#[inline(always)]
fn products(response: &Response, vector: &ControlVector, mut put: impl FnMut(usize, f64)) {
    let known = vector.as_chunks::<4>().0;
    let mut rest = response.0.as_chunks::<4>().0;
    for len in 1..=STAGES / 2 {
        let Some((rows, later)) = rest.split_at_checked(4 * len) else {
            return;
        };
        rest = later;
        let (one, two) = rows.split_at(2 * len);
        for (offset, rows) in [(0, one), (2, two)] {
            let (one, other) = rows.split_at(len);
            let [a, b] = pair(one, other, known);
            put(4 * (len - 1) + offset, a);
            put(4 * (len - 1) + offset + 1, b);
        }
    }
    for len in 1..=STAGES / 2 {
        let Some((rows, later)) = rest.split_at_checked(2 * len) else {
            return;
        };
        rest = later;
        let (one, other) = rows.split_at(len);
        let [a, b] = pair(one, other, known);
        put(2 * STAGES + 2 * (len - 1), a);
        put(2 * STAGES + 2 * (len - 1) + 1, b);
    }
}

/// Products of two rows with a vector.
#[inline(always)]
fn pair(one: &[[f64; 4]], other: &[[f64; 4]], vector: &[[f64; 4]]) -> [f64; 2] {
    let (mut first, mut second) = ([0.0; 4], [0.0; 4]);
    for ((one, other), v) in one.iter().zip(other).zip(vector) {
        for k in 0..4 {
            first[k] += one[k] * v[k];
            second[k] += other[k] * v[k];
        }
    }
    [first, second].map(|[a, b, c, d]| (a + c) + (b + d))
}

/// Writes the price of each row.
pub(in crate::qp) fn write_prices(response: &Response, _: &Normals, prices: &mut [f64; ROWS]) {
    prices.fill(0.0);
    let (positions, attitudes, thrusts) = parts_mut(prices);
    // No control can change the rows of boundary 0.
    let stages = positions.iter_mut().skip(1).zip(attitudes).zip(thrusts);
    for (stage, ((position, attitude), thrust)) in stages.enumerate() {
        let pair = Pair::of(response, 2 * stage);
        for (price, [up, forward]) in position.iter_mut().zip(&DIRECTION_VECTORS) {
            *price = price_of(pair.norm_squared([*forward, *up]));
        }
        let pair = Pair::of(response, ATTITUDE_OUTPUT + 2 * stage);
        let attack = price_of(pair.norm_squared([1.0, -1.0]));
        let flight_path = price_of(pair.norm_squared([0.0, 1.0]));
        *attitude = [attack, flight_path, attack, flight_path];
        let row = response.row(THRUST_OUTPUT + stage);
        *thrust = [price_of(dot(row, row)); 2];
    }
}

/// Products of the responses of two outputs, from which the norms of all rows in these outputs follow.
struct Pair {
    first: f64,
    both: f64,
    second: f64,
}

impl Pair {
    /// The products of the responses of an output and the next one.
    fn of(response: &Response, output: usize) -> Self {
        let [one, other] = [output, output + 1].map(|output| response.row(output));
        Self {
            first: dot(one, one),
            both: dot(one, other),
            second: dot(other, other),
        }
    }

    /// Squared norm of the response of a row that bounds `p first + q second`.
    fn norm_squared(&self, [p, q]: [f64; 2]) -> f64 {
        p * p * self.first + 2.0 * p * q * self.both + q * q * self.second
    }
}

/// The lower triangle `T` with `T T' = M^-1`, or `None` if `M` is not positive definite.
pub(in crate::qp) fn inverse_root(matrix: &Matrix2<f64>) -> Option<Matrix2<f64>> {
    let [[first, coupling], [_, second]]: [[f64; 2]; 2] = (*matrix).into();
    let root = |square: f64| (square > 0.0 && square.is_finite()).then(|| libm::sqrt(square));
    // `M = U U'` with an upper triangle `U`, and `T` is the inverse of `U'`.
    let corner = root(second)?;
    let beside = coupling / corner;
    let diagonal = root(first - beside * beside)?;
    Some(Matrix2::new(
        1.0 / diagonal,
        0.0,
        -beside / (diagonal * corner),
        1.0 / corner,
    ))
}
