//! Triangular matrices without their zeros.

/// Number of entries in a triangle with this number of rows.
pub(super) const fn entries(rows: usize) -> usize {
    rows * (rows + 1) / 2
}

/// A triangle whose row `i` has `i + 1` entries; `LEN` entries in all.
#[derive(Clone, Debug)]
pub(super) struct Triangle<const LEN: usize>([f64; LEN]);

impl<const LEN: usize> Triangle<LEN> {
    pub(super) const fn new() -> Self {
        Self([0.0; LEN])
    }

    /// A row. It is empty for an index beyond the last row.
    pub(super) fn row(&self, index: usize) -> &[f64] {
        self.0
            .get(entries(index)..entries(index + 1))
            .unwrap_or(&[])
    }

    pub(super) fn row_mut(&mut self, index: usize) -> &mut [f64] {
        self.0
            .get_mut(entries(index)..entries(index + 1))
            .unwrap_or(&mut [])
    }

    /// The rows from `first` on.
    pub(super) fn rows_from(&self, first: usize) -> impl Iterator<Item = &[f64]> {
        let mut rest = self.0.get(entries(first)..).unwrap_or(&[]);
        (first + 1..).map_while(move |len| {
            let (row, later) = rest.split_at_checked(len)?;
            rest = later;
            Some(row)
        })
    }

    /// The same, to change them.
    pub(super) fn rows_from_mut(&mut self, first: usize) -> impl Iterator<Item = &mut [f64]> {
        let mut rest = self.0.get_mut(entries(first)..).unwrap_or(&mut []);
        (first + 1..).map_while(move |len| {
            let (row, later) = core::mem::take(&mut rest).split_at_mut_checked(len)?;
            rest = later;
            Some(row)
        })
    }

    /// The rows before `end`, in reverse order.
    pub(super) fn rows_before(&self, end: usize) -> impl Iterator<Item = &[f64]> {
        let mut rest = self.0.get(..entries(end)).unwrap_or(&[]);
        (1..end + 1).rev().map_while(move |len| {
            let (earlier, row) = rest.split_at_checked(rest.len().checked_sub(len)?)?;
            rest = earlier;
            Some(row)
        })
    }

    /// Overwrites a row with the first entries of the next row.
    pub(super) fn move_up(&mut self, index: usize) {
        if let Some((to, from)) = self.0.split_at_mut_checked(entries(index + 1)) {
            let row = to.get_mut(entries(index)..).unwrap_or(&mut []);
            for (to, from) in row.iter_mut().zip(from) {
                *to = *from;
            }
        }
    }
}
