//! The rows that enter next, and what an excess counts.

/// Number of rows on a short list. With 4 and 8 the ten longest hard solves take as long, and the soft ones up to a tenth longer.
pub(in crate::qp) const LISTED: usize = 5;

/// The violated rows that count most, in falling order: at most one of a kind and stage. Each has what it counts.
#[derive(Clone, Debug)]
pub(in crate::qp) struct Shortlist {
    rows: [(f64, usize); LISTED],
    len: usize,
}

impl Shortlist {
    pub(in crate::qp) const fn new() -> Self {
        Self {
            rows: [(0.0, 0); LISTED],
            len: 0,
        }
    }

    pub(in crate::qp) fn clear(&mut self) {
        self.len = 0;
    }

    /// Takes the row that counts most, and what it counts.
    pub(in crate::qp) fn take_first(&mut self) -> Option<(f64, usize)> {
        self.len = self.len.checked_sub(1)?;
        let [first, second, third, fourth, fifth] = self.rows;
        self.rows = [second, third, fourth, fifth, first];
        Some(first)
    }

    pub(in crate::qp) fn rows(&self) -> impl Iterator<Item = usize> + '_ {
        self.rows.iter().take(self.len).map(|(_, row)| *row)
    }

    pub(in crate::qp) fn keep(&mut self, mut keeps: impl FnMut(usize) -> bool) {
        let mut kept = Self::new();
        for entry in self.rows.iter().take(self.len) {
            if keeps(entry.1) {
                kept.push(*entry);
            }
        }
        *self = kept;
    }

    fn push(&mut self, entry: (f64, usize)) {
        if let Some(place) = self.rows.get_mut(self.len) {
            *place = entry;
            self.len += 1;
        }
    }

    /// Inserts a row before those that count less. The last one leaves a full list.
    #[inline(never)]
    fn insert(&mut self, mut entry: (f64, usize)) {
        let mut moves = false;
        for place in self.rows.iter_mut().take(self.len) {
            moves |= place.0 < entry.0;
            if moves {
                core::mem::swap(place, &mut entry);
            }
        }
        self.push(entry);
    }
}

/// What an excess counts: `s^2` times the row's price if `by_effort` is true, which is twice the cost of its
/// correction. Otherwise `s^4` times the price, which is between its size and its effort; this shortens the longest
/// solves of programs with soft rows.
pub(in crate::qp) fn count(excess: f64, price: f64, by_effort: bool) -> f64 {
    let over = if excess > 0.0 { excess } else { 0.0 };
    let square = over * over;
    (if by_effort { square } else { square * square }) * price
}

/// The largest value. Repeated halving needs few comparisons that depend on each other.
#[inline(always)]
pub(in crate::qp) fn largest<const N: usize>(values: &[f64; N]) -> f64 {
    let mut halves = *values;
    let mut len = N;
    while len > 1 {
        len /= 2;
        let (low, high) = halves.split_at_mut(len);
        for (low, high) in low.iter_mut().zip(high) {
            *low = if *high > *low { *high } else { *low };
        }
    }
    halves[0]
}

/// Lists the row of a kind and stage, from `first` on, that counts most.
#[inline(never)]
pub(in crate::qp) fn consider<const N: usize>(
    list: &mut Shortlist,
    excess: &[f64; N],
    prices: Option<&[f64; N]>,
    first: usize,
    by_effort: bool,
) {
    let mut most = (0.0, 0);
    for (offset, (excess, price)) in excess.iter().zip(prices.unwrap_or(&[0.0; N])).enumerate() {
        let value = count(*excess, *price, by_effort);
        if value > most.0 {
            most = (value, first + offset);
        }
    }
    if most.0 > 0.0 {
        list.insert(most);
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::{LISTED, Shortlist};
    use rand_core::{Rng, SeedableRng};
    use rand_pcg::Pcg64Mcg;
    use std::vec::Vec;

    #[test]
    fn a_short_list_holds_the_rows_that_count_most_in_order() {
        let mut random = Pcg64Mcg::seed_from_u64(7);
        for count in 0..40 {
            let mut list = Shortlist::new();
            let mut all: Vec<(f64, usize)> = (0..count)
                .map(|row| ((random.next_u64() % 1_000_000) as f64, row))
                .collect();
            for entry in &all {
                list.insert(*entry);
            }
            all.sort_by(|a, b| b.0.total_cmp(&a.0));
            all.truncate(LISTED);
            let rows: Vec<usize> = all.iter().map(|(_, row)| *row).collect();
            assert_eq!(list.rows().collect::<Vec<_>>(), rows);
            assert_eq!(list.take_first(), all.first().copied());
            list.keep(|row| row % 2 == 0);
            let even = rows.iter().skip(1).filter(|row| *row % 2 == 0);
            assert!(list.rows().eq(even.copied()));
        }
    }
}
