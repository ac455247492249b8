//! Metrics of runs, and objectives and constraints of a search over gains.

use crate::run::metrics::Performance;
use crate::run::{Outcome, RunTotals};
use numeric::error::{Failure, Given, Result};

/// A number that a run is judged by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Metric {
    /// `H`; 0 after a contact or without arrival.
    Performance,
    /// `H_T`.
    TimePerformance,
    /// `H_D`.
    AvoidancePerformance,
    /// `H_E`.
    EnergyPerformance,
    /// Time of arrival in s.
    ArrivalTime,
    /// Electrical loss in J.
    Energy,
    /// Length of the path in m.
    PathLength,
    /// Least distance of the surfaces in m.
    MinClearance,
}

impl Metric {
    /// Every metric.
    pub const ALL: [Self; 8] = [
        Self::Performance,
        Self::TimePerformance,
        Self::AvoidancePerformance,
        Self::EnergyPerformance,
        Self::ArrivalTime,
        Self::Energy,
        Self::PathLength,
        Self::MinClearance,
    ];

    /// The metric of a word.
    ///
    /// # Errors
    /// There is no such metric.
    pub fn of(word: &str) -> Result<Self> {
        let known = Self::ALL.into_iter().find(|metric| metric.word() == word);
        known.ok_or_else(|| {
            let rule = "be the word of a metric";
            Failure::invalid("metric", rule, Given::Word(word.into()))
        })
    }

    /// Its word.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Performance => "performance",
            Self::TimePerformance => "performance_arrival_time",
            Self::AvoidancePerformance => "performance_avoidance",
            Self::EnergyPerformance => "performance_energy_saving",
            Self::ArrivalTime => "arrival_time",
            Self::Energy => "energy",
            Self::PathLength => "path_length",
            Self::MinClearance => "min_clearance",
        }
    }

    /// Whether more is better.
    #[must_use]
    pub fn maximized(self) -> bool {
        !matches!(self, Self::ArrivalTime | Self::Energy | Self::PathLength)
    }

    /// Whether a run that fails has this metric all the same.
    #[must_use]
    pub fn scores_failures(self) -> bool {
        matches!(
            self,
            Self::Performance
                | Self::TimePerformance
                | Self::AvoidancePerformance
                | Self::EnergyPerformance
        )
    }
}

/// How one number comes from many runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Over {
    /// Mean over the scenarios.
    Mean,
    /// The worst of the scenarios.
    Worst,
    /// One scenario alone.
    Scenario(usize),
}

/// Objective of a search over gains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Objective {
    /// The metric.
    pub metric: Metric,
    /// Combination over the scenarios.
    pub over: Over,
}

/// A limit of a metric.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limit {
    /// The metric must not be below.
    AtLeast(f64),
    /// The metric must not be above.
    AtMost(f64),
}

/// A constraint on a metric.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MetricConstraint {
    /// The metric.
    pub metric: Metric,
    /// Its limit.
    pub limit: Limit,
    /// The scenario that it holds for; every one when `None`.
    pub scenario: Option<usize>,
}

impl MetricConstraint {
    /// Not negative where the constraint is satisfied.
    pub(crate) fn margin(&self, value: f64) -> f64 {
        match self.limit {
            Limit::AtLeast(least) => value - least,
            Limit::AtMost(most) => most - value,
        }
    }
}

/// Margin of the constraint that every run arrives without a contact: 1 when all do, else minus the
/// number of runs that fail.
///
/// It is well away from zero where it holds, so that a method with linear models sees a constraint
/// that is not active.
#[must_use]
pub fn arrival_margin(failures: usize) -> f64 {
    if failures == 0 {
        1.0
    } else {
        -(failures as f64)
    }
}

/// How the value of a gain set comes from its values with different seeds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Robustness {
    /// Their mean.
    Mean,
    /// The mean less so many standard errors of it.
    LowerBound {
        /// How many.
        factor: f64,
    },
}

impl Robustness {
    /// One value from those of every seed, larger being better.
    pub(crate) fn combine(self, values: impl Iterator<Item = f64> + Clone) -> f64 {
        let count = values.clone().count() as f64;
        let mean = values.clone().sum::<f64>() / count;
        match self {
            Self::LowerBound { factor } if count > 1.0 && mean.is_finite() => {
                let squares: f64 = values.map(|value| (value - mean) * (value - mean)).sum();
                mean - factor * (squares / (count - 1.0) / count).sqrt()
            }
            _ => mean,
        }
    }
}

/// Numbers of a run that objectives and constraints are made of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Judged {
    pub performance: Performance,
    pub arrival_time: f64,
    pub energy: f64,
    pub path_length: f64,
    pub min_clearance: f64,
    pub failed: bool,
}

impl Judged {
    pub fn new(run: &RunTotals, performance: Performance, min_clearance: f64) -> Self {
        Self {
            performance,
            arrival_time: run.arrival_time,
            energy: run.energy,
            path_length: run.path_length,
            min_clearance,
            failed: run.outcome != Outcome::Arrived,
        }
    }

    /// A run that is not worth making, because it cannot score.
    pub fn hopeless() -> Self {
        Self {
            performance: Performance {
                total: 0.0,
                arrival_time: 0.0,
                avoidance: 0.0,
                energy_saving: 0.0,
            },
            arrival_time: f64::NAN,
            energy: f64::NAN,
            path_length: f64::NAN,
            min_clearance: f64::NAN,
            failed: true,
        }
    }

    /// A metric as it is.
    pub fn metric(&self, metric: Metric) -> f64 {
        match metric {
            Metric::Performance => self.performance.total,
            Metric::TimePerformance => self.performance.arrival_time,
            Metric::AvoidancePerformance => self.performance.avoidance,
            Metric::EnergyPerformance => self.performance.energy_saving,
            Metric::ArrivalTime => self.arrival_time,
            Metric::Energy => self.energy,
            Metric::PathLength => self.path_length,
            Metric::MinClearance => self.min_clearance,
        }
    }

    /// A metric turned so that more is better; a failure is worst where it has no score.
    pub fn value(&self, metric: Metric) -> f64 {
        if self.failed && !metric.scores_failures() {
            return f64::NEG_INFINITY;
        }
        let value = self.metric(metric);
        if metric.maximized() { value } else { -value }
    }
}
