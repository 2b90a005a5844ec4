//! The outputs of a program, and their response to the normalised controls.

use super::kernel::{ControlVector, Response, Solution, dot, price_of};
use super::layout::{
    ATTITUDE_OUTPUT, ATTITUDES, FACE_ROWS, INPUT_OUTPUT, INPUTS, LAST_ROWS, OUTPUTS, POSITION, ROWS,
};
use super::rows::Normals;
use nalgebra::SMatrix;

/// The outputs of a trajectory.
pub(in crate::qp) fn outputs(solution: &Solution) -> [f64; OUTPUTS] {
    let mut outputs = [0.0; OUTPUTS];
    let (positions, rest) = outputs.split_at_mut(INPUT_OUTPUT);
    let (inputs, attitudes) = rest.split_at_mut(ATTITUDE_OUTPUT - INPUT_OUTPUT);
    let places = positions.as_chunks_mut::<POSITION>().0.iter_mut();
    let places = places.zip(inputs.as_chunks_mut::<INPUTS>().0);
    let places = places.zip(attitudes.as_chunks_mut::<ATTITUDES>().0);
    let stages = solution.controls.iter().zip(solution.states.iter().skip(1));
    for (((position, input), attitude), (control, state)) in places.zip(stages) {
        let [x, y, z, _, attitudes @ ..] = *state;
        (*position, *input, *attitude) = ([x, y, z], *control, attitudes);
    }
    outputs
}

/// The outputs at normalised controls, from those without.
pub(in crate::qp) fn respond(
    response: &Response,
    free: &[f64; OUTPUTS],
    normalised: &ControlVector,
    outputs: &mut [f64; OUTPUTS],
) {
    for (output, (to, free)) in outputs.iter_mut().zip(free).enumerate() {
        *to = free + dot(normalised, response.row(output));
    }
}

/// Writes the price of each row.
pub(in crate::qp) fn write_prices(
    response: &Response,
    normals: &Normals,
    prices: &mut [f64; ROWS],
) {
    write_face_prices(response, normals, prices);
    let price = |output: usize| price_of(dot(response.row(output), response.row(output)));
    for (row, pair) in prices.as_chunks_mut::<2>().0.iter_mut().enumerate() {
        let row = 2 * row;
        if row >= LAST_ROWS {
            *pair = [price(INPUT_OUTPUT + (row - LAST_ROWS) / 2); 2];
        } else if row >= FACE_ROWS {
            *pair = [price(ATTITUDE_OUTPUT + (row - FACE_ROWS) / 2); 2];
        }
    }
}

/// Writes the price of each face. The squared norm of its response is a quadratic form of the normal.
pub(in crate::qp) fn write_face_prices(
    response: &Response,
    normals: &Normals,
    prices: &mut [f64; ROWS],
) {
    let mut prices = prices.iter_mut();
    for (stage, normals) in normals.iter().enumerate() {
        let [x, y, z] = [0, 1, 2].map(|axis| response.row(POSITION * stage + axis));
        let squares = [dot(x, x), dot(y, y), dot(z, z)];
        let products = [dot(x, y), dot(x, z), dot(y, z)];
        for ([a, b, c], price) in normals.iter().zip(&mut prices) {
            let square = a * a * squares[0] + b * b * squares[1] + c * c * squares[2];
            let mixed = a * b * products[0] + a * c * products[1] + b * c * products[2];
            *price = price_of(square + 2.0 * mixed);
        }
    }
}

/// The lower triangle `T` with `T T' = M^-1`, or `None` if `M` is not positive definite.
pub(in crate::qp) fn inverse_root(
    matrix: &SMatrix<f64, INPUTS, INPUTS>,
) -> Option<SMatrix<f64, INPUTS, INPUTS>> {
    let [[a, b, c], [_, d, e], [_, _, f]]: [[f64; 3]; 3] = (*matrix).into();
    let root = |square: f64| (square > 0.0 && square.is_finite()).then(|| libm::sqrt(square));
    // `M = U U'` with an upper triangle `U`, and `T` is the inverse of `U'`.
    let third = root(f)?;
    let (from_first, from_second) = (c / third, e / third);
    let second = root(d - from_second * from_second)?;
    let beside = (b - from_first * from_second) / second;
    let first = root(a - beside * beside - from_first * from_first)?;
    let [first, second, third] = [first, second, third].map(|diagonal| 1.0 / diagonal);
    let low = -beside * first * second;
    let last = -(from_first * first + from_second * low) * third;
    Some(SMatrix::from([
        [first, low, last],
        [0.0, second, -from_second * second * third],
        [0.0, 0.0, third],
    ]))
}
