//! Measured stress over strain, linear between its points.

use super::Kinks;
use crate::error::{Failure, Given, Result, at_most};

/// Most points of a table.
const MOST_POINTS: usize = 100_000;

/// Points from (0, 0), with the integrals of the stress up to each.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    strain: Vec<f64>,
    stress: Vec<f64>,
    works: Vec<[f64; 2]>,
}

impl Table {
    /// Table of some points.
    ///
    /// # Errors
    /// The columns differ in length or have fewer than two points, a number is not finite, the
    /// first point is not (0, 0), the strains do not rise, or a stress falls.
    pub fn new(strain: Vec<f64>, stress: Vec<f64>) -> Result<Self> {
        at_most("strain", strain.len(), MOST_POINTS)?;
        if strain.len() != stress.len() {
            let rule = format!("have as many points as strain, {}", strain.len());
            return Err(Failure::invalid(
                "stress",
                rule,
                Given::Count(stress.len() as u64),
            ));
        }
        if strain.len() < 2 {
            let given = Given::Count(strain.len() as u64);
            return Err(Failure::invalid("strain", "have at least 2 points", given));
        }
        for (name, values, strictly) in [("strain", &strain, true), ("stress", &stress, false)] {
            check_column(name, values, strictly)?;
        }
        let mut works = vec![[0.0; 2]];
        let mut table = Self {
            strain,
            stress,
            works: Vec::new(),
        };
        for index in 1..table.strain.len() {
            let length = table.strain[index] - table.strain[index - 1];
            works.push(table.added(works[index - 1], index - 1, length));
        }
        table.works = works;
        if table.stress.last() == Some(&0.0) {
            let rule = "rise above 0";
            return Err(Failure::invalid("stress", rule, Given::Number(0.0)));
        }
        Ok(table)
    }

    /// Last strain.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.strain.last().copied().unwrap_or(0.0)
    }

    /// Strains of the points between first and last.
    #[must_use]
    pub fn kinks(&self) -> Kinks {
        Kinks::from_slice(&self.strain[1..self.strain.len() - 1])
    }

    /// Points as pairs of strain and slope of the stress from there on.
    pub fn slopes(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        (0..self.strain.len() - 1).map(|index| (self.strain[index], self.slope(index)))
    }

    fn slope(&self, index: usize) -> f64 {
        (self.stress[index + 1] - self.stress[index])
            / (self.strain[index + 1] - self.strain[index])
    }

    /// The piece that holds a strain; a strain beyond the end lies in the last piece.
    fn piece(&self, strain: f64) -> usize {
        let after = self.strain.partition_point(|point| *point <= strain);
        after.clamp(1, self.strain.len() - 1) - 1
    }

    fn added(&self, [once, twice]: [f64; 2], index: usize, length: f64) -> [f64; 2] {
        let (stress, slope) = (self.stress[index], self.slope(index));
        [
            once + length * (stress + 0.5 * slope * length),
            twice + length * (once + length * (0.5 * stress + slope * length / 6.0)),
        ]
    }

    /// Stress and its slope.
    #[must_use]
    pub fn stress(&self, strain: f64) -> [f64; 2] {
        let index = self.piece(strain);
        let slope = self.slope(index);
        [
            self.stress[index] + slope * (strain - self.strain[index]),
            slope,
        ]
    }

    /// Integral of the stress, and that of the integral.
    #[must_use]
    pub fn works(&self, strain: f64) -> [f64; 2] {
        let index = self.piece(strain);
        self.added(self.works[index], index, strain - self.strain[index])
    }

    /// Largest strain whose stress is at most a value; `None` beyond the last point.
    #[must_use]
    pub fn strain_at(&self, stress: f64) -> Option<f64> {
        let after = self.stress.partition_point(|point| *point <= stress);
        if after == self.stress.len() {
            let last = self.stress.last().copied()?;
            return (stress <= last).then(|| self.end());
        }
        let index = after.checked_sub(1)?;
        Some(self.strain[index] + (stress - self.stress[index]) / self.slope(index))
    }
}

fn check_column(name: &'static str, values: &[f64], strictly: bool) -> Result<()> {
    if values[0] != 0.0 {
        return Err(Failure::invalid(
            format!("{name}[0]"),
            "be 0: a table starts at (0, 0)",
            Given::Number(values[0]),
        ));
    }
    for (index, pair) in values.windows(2).enumerate() {
        let fine = pair[1].is_finite()
            && if strictly {
                pair[1] > pair[0]
            } else {
                pair[1] >= pair[0]
            };
        if !fine {
            let word = if strictly { "above" } else { "at least" };
            return Err(Failure::invalid(
                format!("{name}[{}]", index + 1),
                format!("be finite and {word} the value before it, {}", pair[0]),
                Given::Number(pair[1]),
            ));
        }
    }
    Ok(())
}
