//! Numbers and bits of cells, for flight computers that round and shift long words slowly.

/// Whether a cell of a row is set. A flight computer takes a byte of the row with fewer instructions than it
/// shifts the row.
pub(super) fn bit(cells: &u128, col: usize) -> bool {
    cells.to_le_bytes()[col / 8 % 16] >> (col % 8) & 1 == 1
}

/// The number of the cell that holds a coordinate in cells: the coordinate, rounded down. Coordinates beyond the
/// range of numbers give its end. A flight computer does this with far fewer instructions than
/// `libm::floor`, and the result is the same.
pub(crate) fn rounded_down(coordinate: f64) -> i32 {
    let cut = coordinate as i32;
    cut.saturating_sub(i32::from(f64::from(cut) > coordinate))
}

/// A coordinate in cells as a fixed-point number, in parts of 2^-32. To go along a line, a flight computer adds whole numbers with fewer
/// instructions than it rounds floats.
#[derive(Clone, Copy)]
pub(super) struct FixedPoint(i64);

impl FixedPoint {
    /// The number for a coordinate in cells, rounded down to a part.
    pub(super) fn of(coordinate: f64) -> Self {
        let cell = rounded_down(coordinate);
        let rest = (coordinate - f64::from(cell)) * 4_294_967_296.0;
        Self(i64::from(cell) << 32 | i64::from(rest as u32))
    }

    /// The cell that holds the coordinate. A cell below the first one is a number beyond the last one.
    pub(super) fn cell(self) -> u32 {
        (self.0 >> 32) as u32
    }

    /// The coordinate after a step.
    pub(super) fn after(self, step: Self) -> Self {
        Self(self.0.wrapping_add(step.0))
    }
}

/// Highest bit of each byte.
const HIGH: u32 = 0x8080_8080;

/// Which of four bytes are at least `LEAST`, which is above 0: bit 0 is the first byte's.
pub(super) fn at_least<const LEAST: i8>(bytes: [i8; 4]) -> u32 {
    let word = word(bytes);
    let up_to_high = u32::from_le_bytes([0x80 - LEAST as u8; 4]);
    first_bits((word & !HIGH).wrapping_add(up_to_high) & !word & HIGH)
}

/// Which of four bytes are 0: bit 0 is the first byte's.
pub(super) fn zeros(bytes: [i8; 4]) -> u32 {
    let word = word(bytes);
    first_bits(!((word & !HIGH).wrapping_add(!HIGH) | word) & HIGH)
}

fn word(bytes: [i8; 4]) -> u32 {
    u32::from_le_bytes(bytes.map(|byte| byte as u8))
}

/// The highest bits of four bytes as a number of four bits. The product moves each of them to its place.
fn first_bits(high: u32) -> u32 {
    (high >> 7).wrapping_mul(0x0102_0408) >> 24 & 0xF
}

#[cfg(test)]
mod tests {
    use super::{FixedPoint, at_least, zeros};
    use rand_core::{Rng, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    #[test]
    fn four_bytes_at_once_are_as_each_alone() {
        let mut random = Pcg64Mcg::seed_from_u64(1);
        for _ in 0..100_000 {
            // One of five bytes is 0, and each other value occurs.
            let drawn = random.next_u64().to_le_bytes();
            let bytes = [0, 1, 2, 3].map(|at| {
                let zero = drawn[at + 4] % 5 == 0;
                if zero { 0 } else { drawn[at] as i8 }
            });
            let each = |holds: fn(i8) -> bool| {
                (0..4)
                    .map(|at| u32::from(holds(bytes[at])) << at)
                    .sum::<u32>()
            };
            assert_eq!(zeros(bytes), each(|byte| byte == 0), "{bytes:?}");
            assert_eq!(at_least::<25>(bytes), each(|byte| byte >= 25), "{bytes:?}");
            assert_eq!(at_least::<1>(bytes), each(|byte| byte >= 1), "{bytes:?}");
        }
    }

    #[test]
    fn a_fixed_point_goes_along_a_line_as_its_coordinate_does() {
        let mut random = Pcg64Mcg::seed_from_u64(2);
        let mut between = |least: f64, most: f64| {
            least + (most - least) * (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
        };
        for _ in 0..1000 {
            let (start, step) = (between(-200.0, 300.0), between(-1.0, 1.0));
            let (mut place, next) = (FixedPoint::of(start), FixedPoint::of(step));
            for number in 0..384 {
                let coordinate = start + f64::from(number) * step;
                let off = coordinate - f64::from(place.cell() as i32);
                assert!((-1e-6..1.0 + 1e-6).contains(&off), "{coordinate}");
                place = place.after(next);
            }
        }
    }
}
