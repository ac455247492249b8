//! How the runs of a task are carried out: lanes, instructions, teams, what they have in common.

use crate::run::options::Options;
use numeric::error::{Failure, Given, Result};
use numeric::lanes::{Vectors, vectors};

/// Number of gain sets that are stepped side by side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// One.
    One,
    /// Four.
    Four,
    /// Eight.
    Eight,
    /// Sixteen.
    Sixteen,
}

impl Width {
    /// Width by its number of lanes.
    ///
    /// # Errors
    /// There is no such width.
    pub fn of(lanes: usize) -> Result<Self> {
        match lanes {
            1 => Ok(Self::One),
            4 => Ok(Self::Four),
            8 => Ok(Self::Eight),
            16 => Ok(Self::Sixteen),
            other => {
                let given = Given::Count(other as u64);
                Err(Failure::invalid("lanes", "be 1, 4, 8 or 16", given))
            }
        }
    }
}

/// Which instructions of the processor a batch may use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Instructions {
    /// The widest vectors that the processor has.
    #[default]
    Widest,
    /// Instructions that every processor of its family has.
    Baseline,
}

impl Instructions {
    /// Vectors for lanes, where they may be used.
    pub(crate) fn vectors(self) -> Option<Vectors> {
        match self {
            // What x86 has without asking is too little for lanes.
            Self::Baseline if cfg!(target_arch = "x86_64") => None,
            Self::Baseline | Self::Widest => vectors(),
        }
    }
}

/// Most gains of a law.
pub(crate) const MAX_GAINS: usize = 8;

/// How the runs of a task are made.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RunPlan {
    pub run: Options,
    pub width: Width,
    pub instructions: Instructions,
    /// Count the control periods over which the Lyapunov function does not grow.
    pub descent: bool,
    /// End runs that can neither arrive nor touch anything any more, and make the part of the way
    /// that all runs of a task have in common only once. Changes no bit of a run that arrives.
    pub shortcuts: bool,
}

impl RunPlan {
    /// One run by itself.
    pub fn single(run: Options) -> Self {
        Self {
            run,
            width: Width::One,
            instructions: Instructions::default(),
            descent: false,
            shortcuts: false,
        }
    }

    /// Vectors for runs side by side; nothing for one after the other, as where every stage of a step asks
    /// the law, which lanes make little faster.
    pub fn vectors(&self) -> Option<Vectors> {
        let alone = self.width == Width::One || self.run.is_staged();
        self.instructions.vectors().filter(|_| !alone)
    }
}

/// The gains that act without obstacles, as bits.
pub(crate) type Key = [u64; MAX_GAINS];

/// Key of a gain set.
pub(crate) fn key_of(free_gains: &[usize], set: &[f64]) -> Key {
    let mut key = [0; MAX_GAINS];
    for (slot, axis) in key.iter_mut().zip(free_gains) {
        *slot = set[*axis].to_bits();
    }
    key
}
