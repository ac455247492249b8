//! Branch and bound over pairs (start, end) of a window.
//!
//! With dV the integral over a window of length dt, the square of the criterion is dV^5 / dt^3,
//! which needs no roots. Starts and ends are grouped in blocks of a binary tree; a pair of blocks is
//! opened only where a bound says that it may hold something better than the best window so far.
//! Building the tree is O(n). The number of opened pairs is proportional to n for signals that have
//! a shape (pulses, constants, ramps); noise opens more, and the worst case is every pair within one
//! window, O(n m) with m samples per window.

use crate::error::{Failure, Result};
use numeric::threads::Interrupted;

/// Pairs of blocks between two looks whether to stop.
const CHECK: usize = 1 << 14;

/// Relative room that a bound must leave above the best value (squared) to be followed.
const WORTHWHILE: f64 = 1.0 + 1e-13;

/// Times and integrals inside one block of samples.
#[derive(Clone, Copy)]
pub(crate) struct Block {
    /// First and last time.
    pub(crate) first: f64,
    pub(crate) last: f64,
    /// Integral at the first and at the last time.
    pub(crate) first_integral: f64,
    pub(crate) last_integral: f64,
    /// Range of the integral.
    pub(crate) low: f64,
    pub(crate) high: f64,
    /// Largest slope of the integral from the block's first time to the first time of the next one.
    pub(crate) steepest: f64,
}

impl Block {
    /// Both blocks.
    fn with(self, right: Self) -> Self {
        Self {
            first: self.first,
            last: right.last,
            first_integral: self.first_integral,
            last_integral: right.last_integral,
            low: lower(self.low, right.low),
            high: higher(self.high, right.high),
            steepest: higher(self.steepest, right.steepest),
        }
    }

    /// Bound on the windows that start and end in this block.
    fn bound_inside(&self, window: f64) -> f64 {
        if self.steepest <= 0.0 {
            return 0.0;
        }
        let longest = lower(window, self.last - self.first);
        let rise = lower(self.high - self.low, self.steepest * longest);
        rise * rise * cube(self.steepest)
    }

    /// Bound on the windows that start in this block and end in `right`.
    ///
    /// First bound: the largest rise in the shortest time. Second bound: the rise between the blocks
    /// plus the steepest slope times the rest; along that line dV^5 / dt^3 has no inner maximum, so
    /// one of its ends bounds it. It is sharp for smooth signals, the first one for noise.
    fn bound_to(&self, right: &Self, window: f64) -> f64 {
        let shortest = right.first - self.last;
        let rise = right.high - self.low;
        if rise <= 0.0 || shortest > window {
            return 0.0;
        }
        let steepest = higher(self.steepest, right.steepest);
        let longest = lower(window, right.last - self.first);
        let between = right.first_integral - self.last_integral;
        let at_longest = higher(0.0, between + steepest * (longest - shortest));
        let along = fifth(at_longest) / cube(longest);
        if shortest > 0.0 {
            let at_shortest = fifth(higher(0.0, between)) / cube(shortest);
            lower(fifth(rise) / cube(shortest), higher(along, at_shortest))
        } else {
            along
        }
    }
}

/// The best window so far.
#[derive(Clone, Copy)]
pub(crate) struct Best {
    /// Square of the criterion.
    pub(crate) squared: f64,
    pub(crate) start: f64,
    pub(crate) end: f64,
    /// Length, more exact than the difference of late times.
    pub(crate) length: f64,
    /// Mean over the window times its length.
    pub(crate) integral: f64,
}

impl Best {
    pub(crate) const NONE: Self = Self {
        squared: 0.0,
        start: 0.0,
        end: 0.0,
        length: 0.0,
        integral: 0.0,
    };

    /// Takes a window `[start, end]` if it is better.
    #[inline(always)]
    pub(crate) fn offer(&mut self, [start, end]: [f64; 2], length: f64, integral: f64) {
        let length_cubed = cube(length);
        if integral > 0.0 && fifth(integral) > self.squared * length_cubed {
            *self = Self {
                squared: fifth(integral) / length_cubed,
                start,
                end,
                length,
                integral,
            };
        }
    }
}

/// Search in a pair of blocks that are not divided further.
pub(crate) trait Leaf {
    /// Offers the windows that start in block `left` and end in block `right` (`left <= right`).
    fn visit(&self, left: usize, right: usize, best: &mut Best);
}

/// Searches all pairs of `leaves`, given the best window that is already known.
pub(crate) fn search(leaves: Vec<Block>, window: f64, leaf: &impl Leaf, known: Best) -> Best {
    search_until(leaves, window, leaf, known, &|| false).unwrap_or(known)
}

/// Interruptible [`search`].
///
/// # Errors
/// The caller asked to stop.
pub(crate) fn search_until(
    leaves: Vec<Block>,
    window: f64,
    leaf: &impl Leaf,
    known: Best,
    interrupted: Interrupted<'_>,
) -> Result<Best> {
    let mut levels = vec![leaves];
    while levels[levels.len() - 1].len() > 1 {
        if interrupted() {
            return Err(Failure::Interrupted);
        }
        let below = &levels[levels.len() - 1];
        let above = below
            .chunks(2)
            .map(|pair| pair.iter().copied().reduce(Block::with).unwrap_or(pair[0]))
            .collect();
        levels.push(above);
    }
    let mut tree = BlockTree {
        levels: &levels,
        window,
        leaf,
        best: known,
        interrupted,
        pairs: 0,
        stopped: false,
    };
    tree.inside(levels.len() - 1, 0);
    if tree.stopped {
        Err(Failure::Interrupted)
    } else {
        Ok(tree.best)
    }
}

struct BlockTree<'a, L> {
    levels: &'a [Vec<Block>],
    window: f64,
    leaf: &'a L,
    best: Best,
    interrupted: Interrupted<'a>,
    /// Pairs that were opened since the last look whether to stop.
    pairs: usize,
    stopped: bool,
}

impl<L: Leaf> BlockTree<'_, L> {
    fn hopeless(&self, bound: f64) -> bool {
        bound <= self.best.squared * WORTHWHILE
    }

    /// Whether the search is to end; every opened pair asks.
    fn ends(&mut self) -> bool {
        self.pairs += 1;
        if self.pairs == CHECK {
            self.pairs = 0;
            self.stopped |= (self.interrupted)();
        }
        self.stopped
    }

    fn inside(&mut self, level: usize, node: usize) {
        if self.hopeless(self.levels[level][node].bound_inside(self.window)) {
            return;
        }
        if self.ends() {
            return;
        }
        if level == 0 {
            self.leaf.visit(node, node, &mut self.best);
            return;
        }
        self.inside(level - 1, 2 * node);
        if 2 * node + 1 < self.levels[level - 1].len() {
            self.inside(level - 1, 2 * node + 1);
            self.between(level - 1, 2 * node, 2 * node + 1);
        }
    }

    fn between(&mut self, level: usize, left: usize, right: usize) {
        let blocks = &self.levels[level];
        if self.hopeless(blocks[left].bound_to(&blocks[right], self.window)) {
            return;
        }
        if self.ends() {
            return;
        }
        if level == 0 {
            self.leaf.visit(left, right, &mut self.best);
            return;
        }
        let ends = 2 * right + 2 > self.levels[level - 1].len();
        for start in [2 * left + 1, 2 * left] {
            self.between(level - 1, start, 2 * right);
            if !ends {
                self.between(level - 1, start, 2 * right + 1);
            }
        }
    }
}

/// Minimum of finite numbers: one instruction, unlike the one that minds not-a-number.
pub(crate) fn lower(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}

/// Maximum of finite numbers.
pub(crate) fn higher(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

fn cube(x: f64) -> f64 {
    x * x * x
}

fn fifth(x: f64) -> f64 {
    let square = x * x;
    square * square * x
}
