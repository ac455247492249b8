//! Problems of searches: a function over a box, its constraints, and the order of its points.

use std::cmp::Ordering;

use numeric::error::{Failure, Given, Result, Stop, finite};

/// A constraint may miss its limit by this much, in its own unit: rounding, and the last steps
/// of a local search towards an active constraint.
pub const FEASIBILITY: f64 = 1e-6;

/// Where the values of some points go, row by row.
#[derive(Debug)]
pub struct Evaluation<'a> {
    /// Objectives, all maximized: points x objectives. Minus infinity is the worst, and so is NaN.
    pub values: &'a mut [f64],
    /// Margins of the constraints, not negative where they are satisfied: points x constraints.
    pub margins: &'a mut [f64],
    /// Whether a point counts as a failure.
    pub failed: &'a mut [bool],
    /// Whether to stop; what is there then counts for nothing.
    pub stop: Stop<'a>,
}

/// A function to maximize over a box.
pub trait Problem: Sync {
    /// Number of coordinates.
    fn dimension(&self) -> usize;
    /// Number of objectives.
    fn objectives(&self) -> usize {
        1
    }
    /// Number of constraints.
    fn constraints(&self) -> usize {
        0
    }
    /// Values of points that are given row by row; called from several threads. Each value depends
    /// on its own point only.
    ///
    /// # Errors
    /// Any failure to compute the values; it ends the search.
    fn evaluate(&self, points: &[f64], into: &mut Evaluation<'_>) -> Result<()>;
    /// Axes from the slowest to the fastest in which neighbours are best handed in.
    fn slowest_first(&self) -> Vec<usize> {
        (0..self.dimension()).collect()
    }
    /// Most points that are best handed in at once.
    fn block(&self) -> usize {
        512
    }
}

/// Value of a point under constraints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Score {
    /// Value, maximized.
    pub value: f64,
    /// Sum of what the constraints miss beyond [`FEASIBILITY`]; 0 for a feasible point.
    pub violation: f64,
    /// Whether the point counts as a failure.
    pub failed: bool,
}

impl Score {
    /// Score from a value and the margins of the constraints.
    #[must_use]
    pub fn new(value: f64, margins: &[f64], failed: bool) -> Self {
        let missed = |margin: &f64| {
            if *margin >= -FEASIBILITY {
                0.0
            } else if margin.is_nan() {
                f64::INFINITY
            } else {
                -margin
            }
        };
        Self {
            value: if value.is_nan() {
                f64::NEG_INFINITY
            } else {
                value
            },
            violation: margins.iter().map(missed).fold(0.0, |sum, part| sum + part),
            failed,
        }
    }

    /// Less is better: feasible points by their value, before infeasible ones by their violation.
    #[must_use]
    pub fn order(&self, other: &Self) -> Ordering {
        let violation = self.violation.total_cmp(&other.violation);
        // Adding zero makes no difference between the two zeros.
        violation.then((other.value + 0.0).total_cmp(&(self.value + 0.0)))
    }

    /// Whether this score is better than another one.
    #[must_use]
    pub fn better(&self, other: &Self) -> bool {
        self.order(other) == Ordering::Less
    }

    /// Whether every constraint is satisfied.
    #[must_use]
    pub fn feasible(&self) -> bool {
        self.violation == 0.0
    }
}

/// A point with its score.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// Coordinates.
    pub point: Vec<f64>,
    /// Score.
    pub score: Score,
}

/// A box.
#[derive(Clone, Debug, PartialEq)]
pub struct Bounds {
    lower: Vec<f64>,
    upper: Vec<f64>,
}

impl Bounds {
    /// A box by its corners.
    ///
    /// # Errors
    /// The corners differ in length or have none, a coordinate is not finite, or the lower one is
    /// above the upper one.
    pub fn new(lower: Vec<f64>, upper: Vec<f64>) -> Result<Self> {
        if lower.is_empty() || lower.len() != upper.len() {
            let rule = "have as many upper as lower values, at least one";
            let given = Given::Count(upper.len() as u64);
            return Err(Failure::invalid("bounds", rule, given));
        }
        for (axis, (low, high)) in lower.iter().zip(&upper).enumerate() {
            finite(&format!("bounds[{axis}].lower"), *low)?;
            finite(&format!("bounds[{axis}].upper"), *high)?;
            if low > high {
                let name = format!("bounds[{axis}]");
                let rule = "have its lower value first";
                let given = Given::Pair([*low, *high]);
                return Err(Failure::invalid(name, rule, given));
            }
        }
        Ok(Self { lower, upper })
    }

    /// Lower corner.
    #[must_use]
    pub fn lower(&self) -> &[f64] {
        &self.lower
    }

    /// Upper corner.
    #[must_use]
    pub fn upper(&self) -> &[f64] {
        &self.upper
    }

    /// Number of coordinates.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.lower.len()
    }

    /// Whether a point lies inside or on the boundary.
    #[must_use]
    pub fn contains(&self, point: &[f64]) -> bool {
        let sides = self.lower.iter().zip(&self.upper);
        point.len() == self.lower.len()
            && sides
                .zip(point)
                .all(|((low, high), value)| low <= value && value <= high)
    }

    /// The point of the box with coordinates relative to its sides; 0..1 is inside, beyond is
    /// brought back to the boundary.
    pub(crate) fn at(&self, share: &[f64]) -> Vec<f64> {
        let sides = self.lower.iter().zip(&self.upper);
        let along = |((low, high), share): ((&f64, &f64), &f64)| {
            (low + (high - low) * share).max(*low).min(*high)
        };
        sides.zip(share).map(along).collect()
    }

    /// Coordinates of a point relative to the sides.
    pub(crate) fn share(&self, point: &[f64]) -> Vec<f64> {
        let sides = self.lower.iter().zip(&self.upper);
        let along = |((low, high), value): ((&f64, &f64), &f64)| {
            if high > low {
                (value - low) / (high - low)
            } else {
                0.0
            }
        };
        sides.zip(point).map(along).collect()
    }

    /// Refuses a problem of another dimension.
    pub(crate) fn check(&self, problem: &dyn Problem) -> Result<()> {
        if self.dimension() == problem.dimension() {
            return Ok(());
        }
        let rule = "have as many sides as the problem has coordinates";
        let given = Given::Count(self.dimension() as u64);
        Err(Failure::invalid("bounds", rule, given))
    }
}

/// Refuses a problem with several objectives.
pub(crate) fn single_objective(problem: &dyn Problem) -> Result<()> {
    if problem.objectives() == 1 {
        return Ok(());
    }
    let rule = "be a single one for this search";
    let given = Given::Count(problem.objectives() as u64);
    Err(Failure::invalid("objective", rule, given))
}
