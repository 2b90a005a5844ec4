//! The rows of the program: the outputs in each row, and the right-hand sides.

use crate::config::{DIRECTIONS, KNOTS, STAGES};
use crate::corridor::{Corridor, DIRECTION_VECTORS};

/// Number of outputs. Outputs are the quantities that rows bound: positions `(x, z)` at boundaries 1 to N,
/// then the thrusts of stages 0 to N - 1, then attitudes `(theta, gamma)` at boundaries 1 to N. Programs
/// without attitude rows do not need the attitudes.
pub(super) const OUTPUTS: usize = ATTITUDE_OUTPUT + 2 * STAGES;
/// Index of the first thrust among the outputs.
pub(super) const THRUST_OUTPUT: usize = 2 * STAGES;
/// Index of the first attitude among the outputs.
pub(super) const ATTITUDE_OUTPUT: usize = THRUST_OUTPUT + STAGES;

/// Number of controls, from the first on, that can change an output: those of the stages before it.
pub(super) const fn reach(output: usize) -> usize {
    let stage = if output < THRUST_OUTPUT {
        output / 2
    } else if output < ATTITUDE_OUTPUT {
        output - THRUST_OUTPUT
    } else {
        (output - ATTITUDE_OUTPUT) / 2
    };
    2 * (stage + 1)
}

/// Number of rows on positions, boundary 0 included.
const POSITION_ROWS: usize = KNOTS * DIRECTIONS;
/// Number of rows on attitudes: angle of attack and flight path, upper and lower, at boundaries 1 to N.
const ATTITUDE_ROWS: usize = STAGES * 4;
/// Number of all rows of a program.
pub const ROWS: usize = POSITION_ROWS + ATTITUDE_ROWS + STAGES;

const _: () = assert!(ROWS < u16::MAX as usize && OUTPUTS < u8::MAX as usize);

/// Right-hand sides of the rows; infinite for a row that the program does not have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds(pub [f64; ROWS]);

/// The quantity that a row bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowKind {
    /// Half-plane of the corridor. The numbers are the stage boundary and the direction.
    Position(usize, usize),
    /// Limit of the attitude. The first number is the stage boundary. The second number is even for the
    /// angle of attack and odd for the flight path; 0 and 1 are upper limits, 2 and 3 are lower limits.
    Attitude(usize, usize),
    /// Lower limit of the thrust. The number is the stage.
    Thrust(usize),
}

impl RowKind {
    /// The meaning of a row number.
    #[must_use]
    pub fn of(row: usize) -> Self {
        if row < POSITION_ROWS {
            Self::Position(row / DIRECTIONS, row % DIRECTIONS)
        } else if row < POSITION_ROWS + ATTITUDE_ROWS {
            let row = row - POSITION_ROWS;
            Self::Attitude(row / 4 + 1, row % 4)
        } else {
            Self::Thrust(row - POSITION_ROWS - ATTITUDE_ROWS)
        }
    }
}

/// Left-hand side of a row in the outputs `y`: `first.1 y[first.0] + second.1 y[second.0]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RowPattern {
    pub(super) first: (usize, f64),
    pub(super) second: (usize, f64),
}

impl RowPattern {
    /// The pattern of a row. It is `None` for the rows of boundary 0, which no control can change.
    pub(super) fn of(row: usize) -> Option<Self> {
        match RowKind::of(row) {
            RowKind::Position(0, _) => None,
            RowKind::Position(stage, direction) => {
                let [up, forward] = *DIRECTION_VECTORS.get(direction)?;
                let base = 2 * (stage - 1);
                Some(Self {
                    first: (base, forward),
                    second: (base + 1, up),
                })
            }
            RowKind::Attitude(stage, which) => {
                let pitch = ATTITUDE_OUTPUT + 2 * (stage - 1);
                let side = if which < 2 { 1.0 } else { -1.0 };
                let angle_of_attack = which % 2 == 0;
                Some(Self {
                    first: (pitch, if angle_of_attack { side } else { 0.0 }),
                    second: (pitch + 1, if angle_of_attack { -side } else { side }),
                })
            }
            RowKind::Thrust(stage) => Some(Self::single(THRUST_OUTPUT + stage, -1.0)),
        }
    }

    fn single(output: usize, factor: f64) -> Self {
        Self {
            first: (output, factor),
            second: (output, 0.0),
        }
    }

    /// Value of the row's left-hand side.
    pub(super) fn value(&self, outputs: &[f64; OUTPUTS]) -> f64 {
        let at = |(output, factor): (usize, f64)| {
            outputs.get(output).map_or(0.0, |value| value * factor)
        };
        at(self.first) + at(self.second)
    }
}

/// Excess of the outputs over the bounds of all rows. The outputs do not contain boundary 0, so its rows
/// get minus infinity.
pub(super) fn excesses(outputs: &[f64; OUTPUTS], bounds: &Bounds) -> [f64; ROWS] {
    let mut excess = [f64::NEG_INFINITY; ROWS];
    let (positions, rest) = excess.split_at_mut(POSITION_ROWS);
    let (attitudes, thrusts) = rest.split_at_mut(ATTITUDE_ROWS);
    let (position_bounds, attitude_bounds, thrust_bounds) = bounds.parts();
    let (motion, thrust, attitude) = parts(outputs);

    let positions = positions.as_chunks_mut::<DIRECTIONS>().0.iter_mut().skip(1);
    for ((at, excess), bounds) in motion
        .iter()
        .zip(positions)
        .zip(position_bounds.iter().skip(1))
    {
        *excess = position_excess(at, bounds);
    }
    let attitudes = attitudes.as_chunks_mut::<4>().0;
    for ((at, excess), limits) in attitude.iter().zip(attitudes).zip(attitude_bounds) {
        *excess = attitude_excess(at, limits);
    }
    for ((excess, thrust), bound) in thrusts.iter_mut().zip(thrust).zip(thrust_bounds) {
        *excess = -thrust - bound;
    }
    excess
}

/// The row whose excess counts most, if any row has an excess. An excess `s` counts as `s^2` times the row's
/// price if `by_effort` is true, which is twice the cost of its correction. Otherwise it counts as `s^4` times
/// the price, which is between its size and its effort; this shortens the longest solves of programs with soft
/// rows. The function leaves out the attitude rows unless `attitude_rows` is true.
pub(super) fn most_violated(
    outputs: &[f64; OUTPUTS],
    bounds: &Bounds,
    prices: &[f64; ROWS],
    by_effort: bool,
    attitude_rows: bool,
) -> Option<usize> {
    let count = |excess: &mut f64, price: &f64| {
        let over = excess.max(0.0);
        let square = over * over;
        let counted = if by_effort { square } else { square * square };
        *excess = counted * price;
    };
    let (position_bounds, attitude_bounds, thrust_bounds) = bounds.parts();
    let (position_prices, rest) = prices.split_at(POSITION_ROWS);
    let (attitude_prices, thrust_prices) = rest.split_at(ATTITUDE_ROWS);
    let (motion, thrust, attitude) = parts(outputs);
    let mut worst = Worst {
        most: 0.0,
        row: None,
    };

    let prices = position_prices.as_chunks::<DIRECTIONS>().0.iter();
    let stages = motion
        .iter()
        .zip(position_bounds.iter().zip(prices).skip(1));
    for (stage, (at, (bounds, prices))) in stages.enumerate() {
        let mut excess = position_excess(at, bounds);
        for (excess, price) in excess.iter_mut().zip(prices) {
            count(excess, price);
        }
        worst.consider(&excess, (stage + 1) * DIRECTIONS);
    }
    let stages = thrust.iter().zip(thrust_bounds.iter().zip(thrust_prices));
    for (stage, (thrust, (bound, price))) in stages.enumerate() {
        let mut excess = [-thrust - bound];
        count(&mut excess[0], price);
        worst.consider(&excess, POSITION_ROWS + ATTITUDE_ROWS + stage);
    }
    if attitude_rows {
        let prices = attitude_prices.as_chunks::<4>().0;
        let stages = attitude.iter().zip(attitude_bounds.iter().zip(prices));
        for (stage, (at, (limits, prices))) in stages.enumerate() {
            let mut excess = attitude_excess(at, limits);
            for (excess, price) in excess.iter_mut().zip(prices) {
                count(excess, price);
            }
            worst.consider(&excess, POSITION_ROWS + 4 * stage);
        }
    }
    worst.row
}

/// The largest value so far and its row.
struct Worst {
    most: f64,
    row: Option<usize>,
}

impl Worst {
    /// Compares with the values of the rows from `first` on. Repeated halving finds the largest value with
    /// few comparisons that depend on each other.
    fn consider<const N: usize>(&mut self, values: &[f64; N], first: usize) {
        let mut halves = *values;
        let mut len = N;
        while len > 1 {
            len /= 2;
            let (low, high) = halves.split_at_mut(len);
            for (low, high) in low.iter_mut().zip(high) {
                if *high > *low {
                    *low = *high;
                }
            }
        }
        if halves.first().is_some_and(|largest| *largest > self.most) {
            for (offset, value) in values.iter().enumerate() {
                if *value > self.most {
                    self.most = *value;
                    self.row = Some(first + offset);
                }
            }
        }
    }
}

type OutputParts<'a> = (&'a [[f64; 2]], &'a [f64], &'a [[f64; 2]]);

/// Splits the outputs into positions, thrusts and attitudes.
fn parts(outputs: &[f64; OUTPUTS]) -> OutputParts<'_> {
    let (motion, rest) = outputs.split_at(THRUST_OUTPUT);
    let (thrust, attitude) = rest.split_at(STAGES);
    (motion.as_chunks().0, thrust, attitude.as_chunks().0)
}

fn position_excess([x, z]: &[f64; 2], bounds: &[f64; DIRECTIONS]) -> [f64; DIRECTIONS] {
    let mut excess = [0.0; DIRECTIONS];
    for ((excess, bound), [up, forward]) in excess.iter_mut().zip(bounds).zip(&DIRECTION_VECTORS) {
        *excess = forward * x + up * z - bound;
    }
    excess
}

fn attitude_excess([pitch, flight_path]: &[f64; 2], limits: &[f64; 4]) -> [f64; 4] {
    let attack = pitch - flight_path;
    let [a, b, c, d] = limits;
    [attack - a, flight_path - b, -attack - c, -flight_path - d]
}

/// Splits values by row into those of rows that a penalty can soften and those of rows that are always
/// hard.
pub(super) fn split_soft(values: &[f64; ROWS]) -> (&[f64], &[f64]) {
    values.split_at(POSITION_ROWS + ATTITUDE_ROWS)
}

impl Bounds {
    /// Bounds without any row.
    #[must_use]
    pub const fn none() -> Self {
        Self([f64::INFINITY; ROWS])
    }

    /// Splits the bounds into those of positions, attitudes and thrusts.
    fn parts(&self) -> (&[[f64; DIRECTIONS]], &[[f64; 4]], &[f64]) {
        let (position, rest) = self.0.split_at(POSITION_ROWS);
        let (attitude, thrust) = rest.split_at(ATTITUDE_ROWS);
        (position.as_chunks().0, attitude.as_chunks().0, thrust)
    }

    /// The rows of two opposite faces that cross by more than `least` \[m\], if there are such faces.
    pub(super) fn crossing_faces(&self, least: f64) -> Option<(usize, usize)> {
        const HALF: usize = DIRECTIONS / 2;
        self.parts()
            .0
            .iter()
            .enumerate()
            .find_map(|(stage, faces)| {
                let (one, other) = faces.split_at(HALF);
                let crossing = one
                    .iter()
                    .zip(other)
                    .position(|(one, other)| one + other < -least)?;
                let row = stage * DIRECTIONS + crossing;
                Some((row, row + HALF))
            })
    }

    /// Whether the program has any attitude row.
    pub(super) fn has_attitude(&self) -> bool {
        self.parts()
            .1
            .as_flattened()
            .iter()
            .any(|bound| *bound != f64::INFINITY)
    }

    /// Removes every row.
    pub fn clear(&mut self) {
        self.0.fill(f64::INFINITY);
    }

    /// Sets the half-planes of a corridor.
    pub fn set_corridor(&mut self, corridor: &Corridor) {
        let rows = self.0.iter_mut().take(POSITION_ROWS);
        for (row, bound) in rows.zip(corridor.bounds.iter().flatten()) {
            *row = *bound;
        }
    }

    /// Sets the attitude rows: upper and lower limits \[rad\] of the deviations of `(angle of attack, flight
    /// path)` from trim.
    pub fn set_attitude(&mut self, upper: [f64; 2], lower: [f64; 2]) {
        let sides = [upper[0], upper[1], -lower[0], -lower[1]];
        let rows = self.0.iter_mut().skip(POSITION_ROWS).take(ATTITUDE_ROWS);
        for (row, side) in rows.zip(sides.iter().cycle()) {
            *row = *side;
        }
    }

    /// Sets the thrust rows: the thrust may fall below trim by at most `reserve` \[N\].
    pub fn set_thrust(&mut self, reserve: f64) {
        for row in self.0.iter_mut().skip(POSITION_ROWS + ATTITUDE_ROWS) {
            *row = reserve;
        }
    }
}
