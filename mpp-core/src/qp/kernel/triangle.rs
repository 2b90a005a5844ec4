//! Triangular matrices without most of their zeros.

/// Number of entries in a triangle with this number of rows. The length of a row is rounded up to a multiple of four.
pub(super) const fn entries(rows: usize) -> usize {
    let (fours, rest) = (rows / 4, rows % 4);
    8 * fours * (fours + 1) + rest * 4 * (fours + 1)
}

/// Number of entries of a row.
pub(super) const fn length(index: usize) -> usize {
    (index + 1).next_multiple_of(4)
}

/// A triangle whose row `i` has `i + 1` entries, and zeros up to a multiple of four; `LEN` entries in all.
#[derive(Clone, Debug)]
pub(super) struct Triangle<const LEN: usize>([f64; LEN]);

impl<const LEN: usize> Triangle<LEN> {
    pub(super) const fn new() -> Self {
        Self([0.0; LEN])
    }

    /// A row. It is empty for an index beyond the last row.
    pub(super) fn row(&self, index: usize) -> &[f64] {
        self.0
            .get(entries(index)..entries(index) + length(index))
            .unwrap_or(&[])
    }

    pub(super) fn row_mut(&mut self, index: usize) -> &mut [f64] {
        self.0
            .get_mut(entries(index)..entries(index) + length(index))
            .unwrap_or(&mut [])
    }

    /// The rows from `first` on.
    pub(super) fn rows_from(&self, first: usize) -> impl Iterator<Item = &[f64]> {
        let mut rest = self.0.get(entries(first)..).unwrap_or(&[]);
        (first..).map_while(move |index| {
            let (row, later) = rest.split_at_checked(length(index))?;
            rest = later;
            Some(row)
        })
    }

    /// The same, to change them.
    pub(super) fn rows_from_mut(&mut self, first: usize) -> impl Iterator<Item = &mut [f64]> {
        let mut rest = self.0.get_mut(entries(first)..).unwrap_or(&mut []);
        (first..).map_while(move |index| {
            let (row, later) = core::mem::take(&mut rest).split_at_mut_checked(length(index))?;
            rest = later;
            Some(row)
        })
    }

    /// The four rows from a multiple of four on, which are equally long.
    pub(super) fn four(&self, first: usize) -> Option<[&[f64]; 4]> {
        let len = length(first);
        let rows = self.0.get(entries(first)..)?.get(..4 * len)?;
        let (one, rest) = rows.split_at(len);
        let (two, rest) = rest.split_at(len);
        let (three, four) = rest.split_at(len);
        Some([one, two, three, four])
    }

    /// Overwrites a row with the first entries of the next row.
    pub(super) fn move_up(&mut self, index: usize) {
        if let Some((to, from)) = self.0.split_at_mut_checked(entries(index + 1)) {
            let row = to.get_mut(entries(index)..).unwrap_or(&mut []);
            for (to, from) in row.iter_mut().zip(from) {
                *to = *from;
            }
            for zero in row.iter_mut().skip(index + 1) {
                *zero = 0.0;
            }
        }
    }
}
