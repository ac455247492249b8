//! Metrics of a row that are not known yet.

use super::{CRITERIA, Loads, Searches};

/// Missing metrics of a row: criteria by their place in [`CRITERIA`], and the status behind them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Missing(u32);

impl Missing {
    /// Bit of the status.
    const STATUS: u32 = 1 << CRITERIA.len();
    /// Nothing.
    pub const NOTHING: Self = Self(0);
    /// The status and all criteria.
    pub const ALL: Self = Self(2 * Self::STATUS - 1);

    /// The status and the criteria that are asked for.
    #[must_use]
    pub fn of(asked: Loads<bool>) -> Self {
        let mut found = Self::STATUS;
        for (place, asked) in asked.into_array().into_iter().enumerate() {
            found |= u32::from(asked) << place;
        }
        Self(found)
    }

    /// Notes whether a criterion is among them, by its place; the status comes behind all criteria.
    #[inline(always)]
    pub fn insert(&mut self, place: usize, also: bool) {
        self.0 |= u32::from(also) << place;
    }

    /// Metrics missing in either.
    #[must_use]
    pub fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Missing metrics beside known ones.
    #[must_use]
    pub fn without(self, known: Self) -> Self {
        Self(self.0 & !known.0)
    }

    /// Whether all is known.
    #[inline(always)]
    #[must_use]
    pub fn is_nothing(self) -> bool {
        self.0 == 0
    }

    /// Whether a criterion is missing, by its place.
    #[inline(always)]
    #[must_use]
    pub fn has(self, place: usize) -> bool {
        self.0 >> place & 1 == 1
    }

    /// Whether the status is missing.
    #[must_use]
    pub fn has_status(self) -> bool {
        self.0 & Self::STATUS != 0
    }

    /// Searches that the missing metrics need.
    #[must_use]
    pub fn searches(self) -> Searches {
        let mut place = 0;
        let missing = Loads::of(|_| {
            place += 1;
            self.has(place - 1)
        });
        let mut searches = missing.searches();
        // The status follows from it.
        searches.compression |= self.has_status();
        searches
    }
}
