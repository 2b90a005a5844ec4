//! The filter of position and velocity in space against least squares over all ticks at once.

use crate::common::draw::gaussian;
use crate::space_estimate::{SIGMA, estimator, off, time};
use mpp_core::config::TICK_PERIOD;
use mpp_core::estimate::{InertialSample, PositionVerdict, SpaceFix};
use mpp_core::tuning::navigation::LEAST_SIGMA;
use mpp_core::tuning::space_inertial::{ATTITUDE_TIME, FORCE_BIAS, FORCE_NOISE, VELOCITY_DOUBT};
use mpp_core::vehicle::GRAVITY;
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::SeedableRng;

/// A number that is linear in the unknowns of [`least_squares`]; the last factor is that of 1.
type Row = Vec<f64>;

fn sum(terms: &[(f64, &Row)]) -> Row {
    let length = terms[0].1.len();
    let part = |at: usize| terms.iter().map(|(by, row)| by * row[at]).sum();
    (0..length).map(part).collect()
}

/// The unknowns, of which each has a standard deviation of 1, that fit best to rows that are 0 with a standard deviation of 1.
fn least_squares(rows: &[Row]) -> Vec<f64> {
    let count = rows[0].len() - 1;
    let mut normal = vec![vec![0.0; count + 1]; count];
    for (index, line) in normal.iter_mut().enumerate() {
        line[index] = 1.0;
        for row in rows {
            for (at, value) in line.iter_mut().enumerate() {
                *value += row[index] * row[at];
            }
        }
    }
    // Gauss and Jordan; the matrix is positive definite.
    for at in 0..count {
        let pivot: Vec<f64> = normal[at].iter().map(|it| it / normal[at][at]).collect();
        for (index, line) in normal.iter_mut().enumerate() {
            let by = line[at];
            for (value, of) in line.iter_mut().zip(&pivot) {
                *value = if index == at { *of } else { *value - by * of };
            }
        }
    }
    let mut solved: Vec<f64> = normal.iter().map(|line| -line[count]).collect();
    solved.push(1.0);
    solved
}

/// The filter's model without a filter: all ticks at once.
#[test]
fn the_filter_is_the_least_squares_of_its_model() {
    const TICKS: usize = 100;
    const COUNT: usize = 3 + 2 * TICKS;
    let dt = TICK_PERIOD;
    let keep = libm::exp(-dt / ATTITUDE_TIME);
    // Less than half a g of lift, so that no bias of the bank is learned.
    let force = [1.5, -0.7, -0.4 * GRAVITY];
    let wander = SIGMA * off(force, [0.0; 3]);
    let fresh = ((wander * wander + FORCE_BIAS * FORCE_BIAS) * (1.0 - keep * keep)).sqrt();
    let unknown = |at: usize, by: f64, known: f64| {
        let mut row = vec![0.0; COUNT + 1];
        (row[at], row[COUNT]) = (by, known);
        row
    };
    let mut draws = Pcg64Mcg::seed_from_u64(7);
    let mut estimator = estimator();
    let mut rows = Vec::new();
    let first = [0.1 * gaussian(&mut draws), 2.0 + 0.1 * gaussian(&mut draws)];
    let mut p = unknown(0, libm::hypot(0.02, LEAST_SIGMA), first[0]);
    let mut v = unknown(1, libm::hypot(0.1, LEAST_SIGMA), first[1]);
    let mut b = unknown(2, FORCE_BIAS, 0.0);
    for tick in 0..TICKS {
        let sample = InertialSample {
            age: 0,
            // The last bits of an attitude are never the same.
            attitude: [0.0, 0.0, 1e-12 * (tick % 2) as f64],
            sigma: SIGMA,
            rates: [0.0; 3],
            force,
        };
        estimator.predict(Some(&sample));
        if tick == 0 {
            let start = SpaceFix {
                age: 0,
                position: [first[0], 0.0, 50.0],
                sigma: 0.02,
                velocity: Some(([first[1], 0.0, 0.0], 0.1)),
            };
            estimator.observe_fix(Some(&start));
            continue;
        }
        let known = |value: f64| unknown(COUNT, value, value);
        let (pushed, way) = (known(dt * force[0]), known(0.5 * dt * dt * force[0]));
        let noise = unknown(3 + 2 * tick, (FORCE_NOISE * dt).sqrt(), 0.0);
        p = sum(&[(1.0, &p), (dt, &v), (-0.5 * dt * dt, &b), (1.0, &way)]);
        v = sum(&[(1.0, &v), (-dt, &b), (1.0, &pushed), (1.0, &noise)]);
        b = sum(&[(keep, &b), (1.0, &unknown(4 + 2 * tick, fresh, 0.0))]);
        if tick % 10 == 0 {
            let along = time(tick as u32);
            let fix = SpaceFix {
                age: 0,
                position: [
                    (2.0 + 0.75 * along) * along + 0.02 * gaussian(&mut draws),
                    -0.35 * along * along,
                    50.0 - 0.3 * GRAVITY * along * along,
                ],
                sigma: 0.02,
                velocity: Some((
                    [
                        2.0 + 1.5 * along + 0.1 * gaussian(&mut draws),
                        -0.7 * along,
                        -0.6 * GRAVITY * along,
                    ],
                    0.1,
                )),
            };
            let verdict = estimator.observe_fix(Some(&fix));
            assert_eq!(verdict, Some(PositionVerdict::Accepted));
            let told = [fix.position[0], fix.velocity.unwrap().0[0]];
            rows.push(sum(&[(50.0, &p), (-50.0, &known(told[0]))]));
            let by = 1.0 / (VELOCITY_DOUBT * 0.1);
            rows.push(sum(&[(by, &v), (-by, &known(told[1]))]));
        }
    }
    let solved = least_squares(&rows);
    let value = |row: &Row| row.iter().zip(&solved).map(|(a, b)| a * b).sum::<f64>();
    let position = estimator.position().unwrap()[0];
    let velocity = estimator.ground_velocity().unwrap()[0];
    assert!(
        (position - value(&p)).abs() < 1e-7,
        "{position} {}",
        value(&p)
    );
    assert!(
        (velocity - value(&v)).abs() < 1e-7,
        "{velocity} {}",
        value(&v)
    );
}
