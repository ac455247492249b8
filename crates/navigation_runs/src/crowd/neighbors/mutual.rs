//! Whom a few people keep off, and how: what is found for pairs, by person.

use numeric::lanes::Vector2;

type Vector = Vector2<f64>;

/// How a person keeps off somebody.
#[derive(Clone, Copy, Debug, Default)]
pub struct KnownPair {
    /// Change of the own velocity in m/s.
    pub change: Vector,
    /// Direction of the line of permitted velocities.
    pub direction: Vector,
    /// Distance in m.
    pub distance: f64,
    /// Place of the other.
    pub other: usize,
}

/// How few people keep off each other.
#[derive(Clone, Debug, Default)]
pub struct Mutual {
    /// For each person a row that has room for everybody.
    known: Vec<KnownPair>,
    /// How many of each row there are.
    counts: Vec<usize>,
    width: usize,
}

impl Mutual {
    /// Makes room for so many people and robots; nobody knows anybody.
    #[inline(always)]
    pub fn open(&mut self, people: usize, robots: usize) {
        self.width = people + robots;
        self.counts.clear();
        self.counts.resize(people, 0);
        if self.known.len() < people * self.width {
            self.known.resize(people * self.width, KnownPair::default());
        }
    }

    /// Adds somebody to those whom a person keeps off.
    #[inline(always)]
    pub fn push(&mut self, row: usize, known: KnownPair) {
        // Robots, who come after the people, have no row.
        if let Some(count) = self.counts.get_mut(row) {
            self.known[row * self.width + *count] = known;
            *count += 1;
        }
    }

    /// Neighbors whom a person avoids.
    #[inline(always)]
    #[must_use]
    pub fn row(&self, row: usize) -> &[KnownPair] {
        let start = row * self.width;
        &self.known[start..start + self.counts[row]]
    }
}
