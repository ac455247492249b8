//! Gains of the virtual force field.

use numeric::error::{Result, not_negative};
use numeric::lanes::Real;

/// One set of gains; the damping gains are `K2 = b K1`, `K4 = b K3`, `K6 = b K5` (5.5.7).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gains {
    /// `K_1` in N/m.
    pub attractive: f64,
    /// `K_3` in N/m.
    pub repulsive: f64,
    /// `K_5` in N/m^2.
    pub detour: f64,
    /// `b` in s.
    pub ratio: f64,
}

impl Gains {
    /// Number of gains of a set.
    pub const COUNT: usize = 4;

    /// `K_1, K_3, K_5, b`.
    #[must_use]
    pub fn in_order(&self) -> [f64; Self::COUNT] {
        [self.attractive, self.repulsive, self.detour, self.ratio]
    }

    /// A set from `K_1, K_3, K_5, b`.
    #[must_use]
    pub fn of([attractive, repulsive, detour, ratio]: [f64; Self::COUNT]) -> Self {
        Self {
            attractive,
            repulsive,
            detour,
            ratio,
        }
    }

    /// Sets one after the other, as a batch takes them.
    #[must_use]
    pub fn one_after_another(sets: &[Self]) -> Vec<f64> {
        sets.iter().flat_map(Self::in_order).collect()
    }

    /// Returns the set if its gains are finite and not negative.
    ///
    /// # Errors
    /// Names the gain that is not.
    pub fn checked(self) -> Result<Self> {
        not_negative("attractive_gain", self.attractive)?;
        not_negative("repulsive_gain", self.repulsive)?;
        not_negative("detour_gain", self.detour)?;
        not_negative("gain_ratio", self.ratio)?;
        Ok(self)
    }
}

/// Gain sets side by side.
#[derive(Clone, Copy, Debug)]
pub struct GainLanes<R> {
    /// `K_1` in N/m.
    pub attractive: R,
    /// `K_3` in N/m.
    pub repulsive: R,
    /// `K_5` in N/m^2.
    pub detour: R,
    /// `b` in s.
    pub ratio: R,
}

impl<R: Real> GainLanes<R> {
    /// The four gains of every lane, in the order of [`Gains`].
    #[must_use]
    pub(crate) fn of(gains: &[R]) -> Self {
        Self {
            attractive: gains[0],
            repulsive: gains[1],
            detour: gains[2],
            ratio: gains[3],
        }
    }

    /// The first sets, one a lane; the last set fills lanes that are left over.
    #[must_use]
    pub fn gather(first: Gains, rest: &[Gains]) -> Self {
        let set = |lane: usize| match lane {
            0 => first,
            _ => rest.get(lane - 1).or(rest.last()).copied().unwrap_or(first),
        };
        Self {
            attractive: R::from_fn(|lane| set(lane).attractive),
            repulsive: R::from_fn(|lane| set(lane).repulsive),
            detour: R::from_fn(|lane| set(lane).detour),
            ratio: R::from_fn(|lane| set(lane).ratio),
        }
    }
}
