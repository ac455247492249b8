//! How gains are judged.

use crate::run::metrics::Weights;
use crate::run::{Instructions, Options, Width};
use crate::search::gain_objective::{Limit, Metric, MetricConstraint, Objective, Over, Robustness};
use navigation_world::world::scenario::Scenario;
use numeric::error::{Failure, Given, Result, finite, positive};

/// How gains are judged.
#[derive(Clone, Debug, PartialEq)]
pub struct GainOptions {
    /// Options of every run; a contact ends it, whatever they say.
    pub run: Options,
    /// Weights of the criterion.
    pub weights: Weights,
    /// Objectives.
    pub objectives: Vec<Objective>,
    /// Constraints.
    pub constraints: Vec<MetricConstraint>,
    /// Whether every scenario has to be arrived in without a contact: one more constraint, the
    /// last, which is missed by the number of runs that fail.
    pub require_arrival: bool,
    /// Whether `T*/T` and `L*/L` above 1 count as 1.
    pub cap_ratios: bool,
    /// Longest simulated time in s, if it is shorter than a scenario's own.
    pub time_limit: Option<f64>,
    /// Every scenario is run with every seed; as it is when there is none.
    pub seeds: Vec<u64>,
    /// How the seeds of a scenario are put together.
    pub robustness: Robustness,
    /// Lanes; chosen when `None`.
    pub width: Option<Width>,
    /// Instructions that may be used; never changes a bit of the result.
    pub instructions: Instructions,
}

impl GainOptions {
    /// Refuses what the scenarios cannot give.
    pub(crate) fn check(&self, scenarios: &[Scenario]) -> Result<()> {
        let empty = |name: &str, rule| {
            let given = Given::Found("an empty list".into());
            Err(Failure::invalid(name, rule, given))
        };
        if scenarios.is_empty() {
            return empty("scenarios", "hold at least one scenario");
        }
        if self.objectives.is_empty() {
            return empty("objectives", "hold at least one objective");
        }
        if let Some(limit) = self.time_limit {
            positive("time_limit", limit)?;
        }
        if let Robustness::LowerBound { factor } = self.robustness {
            finite("robustness", factor)?;
        }
        for objective in &self.objectives {
            let alone = match objective.over {
                Over::Scenario(index) => Some(index),
                Over::Mean | Over::Worst => None,
            };
            check_metric("objective", objective.metric, alone, scenarios)?;
        }
        for (index, constraint) in self.constraints.iter().enumerate() {
            let name = format!("constraints[{index}]");
            let (Limit::AtLeast(limit) | Limit::AtMost(limit)) = constraint.limit;
            finite(&name, limit)?;
            check_metric(&name, constraint.metric, constraint.scenario, scenarios)?;
        }
        Ok(())
    }
}

/// The scenario is there, and a clearance has something to be clear of.
fn check_metric(
    name: &str,
    metric: Metric,
    alone: Option<usize>,
    scenarios: &[Scenario],
) -> Result<()> {
    let concerned = match alone {
        None => scenarios,
        Some(index) => scenarios.get(index..=index).ok_or_else(|| {
            let rule = "name a scenario that is there";
            Failure::invalid(name, rule, Given::Count(index as u64))
        })?,
    };
    let clear = |scenario: &Scenario| scenario.obstacle_count() == 0;
    if metric == Metric::MinClearance && concerned.iter().any(clear) {
        let rule = "be a metric that every scenario has";
        return Err(Failure::invalid(
            name,
            rule,
            Given::Word(metric.word().into()),
        ));
    }
    Ok(())
}
