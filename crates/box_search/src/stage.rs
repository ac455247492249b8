//! Parts of a search.

/// Part of a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    /// A round of the coarse-to-fine grid.
    Grid {
        /// Which, from 0.
        round: usize,
    },
    /// The local searches.
    Local,
    /// A global method.
    Global,
    /// A round of the search for the best compromises.
    Front {
        /// Which, from 0.
        round: usize,
    },
}
