//! The rules of the paper's method.

/// The rules of the grid, the tree and the raytracing: the authors' or the corrected ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rules {
    /// The rules of the authors' code with its faults, for comparison. The tree does not check its edges,
    /// it does not update costs when it rewires nodes, and rays see a window that wraps around.
    Authors,
    /// The rules that the paper's text means.
    Corrected,
}

impl Rules {
    /// Whether these are the authors' rules.
    #[must_use]
    pub const fn are_authors(self) -> bool {
        match self {
            Self::Authors => true,
            Self::Corrected => false,
        }
    }
}
