//! The best compromises so far, kept while points are evaluated: nothing is left to do after a stop.

use crate::evaluated::Evaluated;
use crate::pareto::{dominates, non_dominated};
use crate::problem::Problem;
use numeric::order::sort_indices;

/// A feasible point that no other one beats.
#[derive(Clone, Debug)]
pub(crate) struct Entry {
    /// Position among all points, over all rounds: of equal values the first point stands for all.
    number: usize,
    point: Vec<f64>,
    values: Vec<f64>,
}

/// Feasible points that no other one beats in every objective; which they are does not depend on
/// the order in which they come.
pub(crate) struct Archive {
    dimension: usize,
    objectives: usize,
    entries: Vec<Entry>,
    /// Number of the first point of the round.
    first: usize,
    /// Points of the round.
    pub evaluations: u64,
    /// Failures among them.
    pub failures: u64,
}

impl Archive {
    pub fn new(dimension: usize, objectives: usize) -> Self {
        Self {
            dimension,
            objectives,
            entries: Vec::new(),
            first: 0,
            evaluations: 0,
            failures: 0,
        }
    }

    /// Points of the archive at the start of a round.
    pub fn renewed(&mut self) -> Self {
        Self {
            entries: std::mem::take(&mut self.entries),
            evaluations: 0,
            failures: 0,
            ..*self
        }
    }

    /// Numbers of the next round come after those of this one.
    pub fn number_from(&mut self, count: usize) {
        self.first += count;
    }

    /// Points of a block that no other one of the block beats.
    pub fn best_of(
        first: usize,
        points: &[f64],
        part: &Evaluated,
        problem: &dyn Problem,
    ) -> Vec<Entry> {
        let (dimension, objectives) = (problem.dimension(), problem.objectives());
        let feasible: Vec<usize> = (0..part.len())
            .filter(|index| part.score(*index).feasible())
            .collect();
        let values_of = |index: usize| &part.values[index * objectives..(index + 1) * objectives];
        let values: Vec<f64> = feasible
            .iter()
            .flat_map(|index| values_of(*index))
            .copied()
            .collect();
        let entry = |place: usize| {
            let index = feasible[place];
            Entry {
                number: first + index,
                point: points[index * dimension..(index + 1) * dimension].to_vec(),
                values: values_of(index).to_vec(),
            }
        };
        let best = non_dominated(&values, objectives);
        best.into_iter().map(entry).collect()
    }

    /// Takes the best points of a block.
    pub fn merge(&mut self, best: Vec<Entry>, part: &Evaluated) {
        self.evaluations += part.len() as u64;
        self.failures += part.failed.iter().filter(|failed| **failed).count() as u64;
        for entry in best {
            let number = self.first + entry.number;
            self.add(Entry { number, ..entry });
        }
    }

    fn add(&mut self, entry: Entry) {
        let beats = |known: &Entry| dominates(&known.values, &entry.values);
        let alike = |known: &Entry| known.values == entry.values;
        let known = self.entries.iter().position(|own| beats(own) || alike(own));
        if let Some(place) = known {
            if alike(&self.entries[place]) && entry.number < self.entries[place].number {
                self.entries[place] = entry;
            } else {
                // One that beats many is asked first.
                self.entries.swap(place, place / 2);
            }
            return;
        }
        self.entries
            .retain(|known| !dominates(&entry.values, &known.values));
        self.entries.push(entry);
    }

    /// Points and values row by row, the best in the first objective first.
    pub fn rows(&self) -> (Vec<f64>, Vec<f64>) {
        let mut order: Vec<usize> = (0..self.entries.len()).collect();
        sort_indices(&mut order, &mut |one, other| {
            let (one, other) = (&self.entries[*one], &self.entries[*other]);
            let (a, b) = (one.values[0] + 0.0, other.values[0] + 0.0);
            b.total_cmp(&a).then(one.number.cmp(&other.number))
        });
        let mut points = Vec::with_capacity(self.entries.len() * self.dimension);
        let mut values = Vec::with_capacity(self.entries.len() * self.objectives);
        for entry in order.iter().map(|index| &self.entries[*index]) {
            points.extend_from_slice(&entry.point);
            values.extend_from_slice(&entry.values);
        }
        (points, values)
    }
}
