//! Values of points.

use crate::problem::{Evaluation, Problem, Score};
use numeric::error::{Result, Stop};

/// Values of some points, row by row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Evaluated {
    /// Objectives, maximized: points x objectives.
    pub values: Vec<f64>,
    /// Margins of the constraints: points x constraints.
    pub margins: Vec<f64>,
    /// Whether a point counts as a failure.
    pub failed: Vec<bool>,
}

impl Evaluated {
    /// Values of points that a problem computes.
    pub(crate) fn of(problem: &dyn Problem, points: &[f64], stop: Stop<'_>) -> Result<Self> {
        let count = points.len() / problem.dimension();
        let mut evaluated = Self {
            values: vec![f64::NEG_INFINITY; count * problem.objectives()],
            margins: vec![0.0; count * problem.constraints()],
            failed: vec![false; count],
        };
        problem.evaluate(
            points,
            &mut Evaluation {
                values: &mut evaluated.values,
                margins: &mut evaluated.margins,
                failed: &mut evaluated.failed,
                stop,
            },
        )?;
        Ok(evaluated)
    }

    /// Number of points.
    pub(crate) fn len(&self) -> usize {
        self.failed.len()
    }

    /// Appends the values of more points.
    pub(crate) fn extend(&mut self, other: &Self) {
        self.values.extend_from_slice(&other.values);
        self.margins.extend_from_slice(&other.margins);
        self.failed.extend_from_slice(&other.failed);
    }

    /// Margins of a point.
    pub(crate) fn margins_of(&self, index: usize) -> &[f64] {
        let count = self.margins.len() / self.len().max(1);
        &self.margins[index * count..(index + 1) * count]
    }

    /// Values of one point alone.
    pub(crate) fn single(&self, index: usize) -> Self {
        let count = self.values.len() / self.len().max(1);
        Self {
            values: self.values[index * count..(index + 1) * count].to_vec(),
            margins: self.margins_of(index).to_vec(),
            failed: vec![self.failed[index]],
        }
    }

    /// Score of a point by its first objective.
    pub(crate) fn score(&self, index: usize) -> Score {
        let count = self.values.len() / self.len().max(1);
        let value = self.values[index * count];
        Score::new(value, self.margins_of(index), self.failed[index])
    }
}
