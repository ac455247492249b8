//! The function of the gains that is searched: metrics of the core, Python callables, or both.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

use numeric::error::Result;
use numpy::{PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::run::metrics::Weights;
use vff_core::run::{BatchOptions, Instructions, Options, Width};
use vff_core::search;
use vff_core::search::{
    Evaluated, Evaluation, GainOptions, Limit, Metric, MetricConstraint, Objective, Over, Problem,
    Robustness, Score, evaluate_all,
};
use vff_core::world::scenario;

use crate::arrays::fields;
use crate::errors::{CoreError, CoreResult};
use crate::gains::scorer::Scorer;
use crate::keywords::Keywords;
use crate::laws::Law;
use crate::run::{run_options, weights_of};
use crate::scenes::Scenes;
use crate::signals::attended;

/// Runs that the callables see at once: few enough that Ctrl-C is answered soon.
const RUNS_OF_A_CALL: usize = 2048;

/// A constraint as Python gives it: metric, least value, largest value, scenario.
type Bounded = (String, Option<f64>, Option<f64>, Option<usize>);

/// Function of the gains over scenarios: objectives to maximize and margins that must not be negative.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct GainProblem {
    /// Number of gains of the law.
    dimension: usize,
    /// Objectives and constraints on metrics.
    native: Option<search::GainProblem>,
    /// Objectives that are callables.
    scorer: Option<Scorer>,
    /// Whether each objective is a metric.
    is_metric: Vec<bool>,
    scorer_constraints: usize,
}

#[pymethods]
impl GainProblem {
    #[new]
    #[pyo3(signature = (**given))]
    fn new(given: Option<Keywords<'_>>) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let scenarios: Scenes = given.take("scenarios")?;
        let law: PyRef<'_, Law> = given.take("law")?;
        let weights = weights_of(given.take("weights")?);
        let integrator: Bound<'_, PyAny> = given.take("integrator")?;
        let (step, hold) = (given.take("step")?, given.take("hold")?);
        // A contact decides the value of a run, so nothing after it matters.
        let run = run_options(&integrator, step, hold, true)?;
        let seeds: Vec<u64> = given.take("seeds")?;
        let factor: Option<f64> = given.take("lower_bound_factor")?;
        let objectives: Vec<Option<String>> = given.take("objectives")?;
        let constraints: Vec<Bounded> = given.take("constraints")?;
        let (require_arrival, cap_ratios) =
            (given.take("require_arrival")?, given.take("cap_ratios")?);
        let scorer: Option<Py<PyAny>> = given.take("scorer")?;
        let whole: bool = given.take("whole")?;
        let scorer_constraints = given.take("scorer_constraints")?;
        let lanes: Option<usize> = given.take("lanes")?;
        given.done()?;
        let scenarios: Vec<scenario::Scenario> = scenarios.to_vec();
        let width = lanes.map(Width::of).transpose().map_err(CoreError::from)?;
        let is_metric: Vec<bool> = objectives.iter().map(Option::is_some).collect();
        let alone = !is_metric.contains(&true) && constraints.is_empty();
        let scorer = scorer.map(|call| Scorer {
            call,
            whole,
            scenarios: seeded(&scenarios, &seeds),
            law: law.any.clone(),
            options: batch_options(run, weights, width),
            requires_arrival: require_arrival && alone && !whole,
            raised: Mutex::new(None),
        });
        let mut metrics: Vec<String> = objectives.into_iter().flatten().collect();
        let native = if alone {
            None
        } else {
            if metrics.is_empty() {
                // The core wants an objective; this one is not looked at.
                metrics.push(Metric::Performance.word().into());
            }
            let options = GainOptions {
                run,
                weights,
                objectives: objectives_of(&metrics)?,
                constraints: constraints_of(&constraints)?,
                require_arrival,
                cap_ratios,
                time_limit: None,
                seeds,
                robustness: factor
                    .map_or(Robustness::Mean, |factor| Robustness::LowerBound { factor }),
                width,
                instructions: Instructions::Widest,
            };
            let built = search::GainProblem::new(scenarios, &law.any, options);
            Some(built.map_err(CoreError::from)?)
        };
        Ok(Self {
            dimension: law.any.gain_names().len(),
            native,
            scorer,
            is_metric,
            scorer_constraints,
        })
    }

    /// Values as maximized, violations and failures of gain sets.
    #[pyo3(signature = (points, *, threads))]
    fn evaluate<'py>(
        &self,
        py: Python<'py>,
        points: PyReadonlyArray2<'py, f64>,
        threads: Option<usize>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let rows = points.shape()[0];
        let points = points.as_slice()?;
        let stop = AtomicBool::new(false);
        let stopped = || stop.load(Ordering::Relaxed);
        #[allow(clippy::redundant_closure_for_method_calls)] // lifetimes differ
        let look = || Python::attach(|py| py.check_signals());
        let (result, raised) = py.detach(|| {
            attended(
                || evaluate_all(self, points, threads, &stopped),
                look,
                || stop.store(true, Ordering::Relaxed),
            )
        })?;
        if let Some(error) = raised.or_else(|| self.take_raised()) {
            return Err(error);
        }
        let found = result.map_err(CoreError::from)?;
        Ok(fields! { py;
            vector violation = violations(&found, self.constraints());
            array [rows, self.objectives()] found: values;
            vector found: failed;
        })
    }
}

impl GainProblem {
    /// Error that a callable raised, once.
    pub fn take_raised(&self) -> Option<PyErr> {
        let scorer = self.scorer.as_ref()?;
        scorer.raised.lock().ok()?.take()
    }

    /// Evaluates the metrics and the callables apart and puts their columns together.
    fn merge(
        &self,
        native: &search::GainProblem,
        scorer: &Scorer,
        points: &[f64],
        into: &mut Evaluation<'_>,
    ) -> Result<()> {
        let rows = into.failed.len();
        let metrics = native.objectives();
        let (own, called) = (native.constraints(), self.scorer_constraints);
        let mut native_values = vec![0.0; rows * metrics];
        let mut native_margins = vec![0.0; rows * own];
        native.evaluate(
            points,
            &mut Evaluation {
                values: &mut native_values,
                margins: &mut native_margins,
                failed: &mut *into.failed,
                stop: into.stop,
            },
        )?;
        let calls = self.is_metric.len() - self.is_metric.iter().filter(|is| **is).count();
        let mut called_values = vec![0.0; rows * calls];
        let mut called_margins = vec![0.0; rows * called];
        scorer.evaluate(
            points,
            &mut Evaluation {
                values: &mut called_values,
                margins: &mut called_margins,
                failed: &mut *into.failed,
                stop: into.stop,
            },
        )?;
        for row in 0..rows {
            let mut of_metrics = native_values[row * metrics..].iter();
            let mut of_calls = called_values[row * calls..].iter();
            let slots = into.values[row * self.is_metric.len()..].iter_mut();
            for (slot, is_metric) in slots.zip(&self.is_metric) {
                let next = if *is_metric {
                    of_metrics.next()
                } else {
                    of_calls.next()
                };
                *slot = next.copied().unwrap_or(f64::NEG_INFINITY);
            }
            let slots = &mut into.margins[row * (own + called)..(row + 1) * (own + called)];
            slots[..own].copy_from_slice(&native_margins[row * own..(row + 1) * own]);
            slots[own..].copy_from_slice(&called_margins[row * called..(row + 1) * called]);
        }
        Ok(())
    }
}

impl Problem for GainProblem {
    fn dimension(&self) -> usize {
        self.dimension
    }

    fn objectives(&self) -> usize {
        self.is_metric.len()
    }

    fn constraints(&self) -> usize {
        let own = self.native.as_ref().map_or(0, Problem::constraints);
        let arrival = self
            .scorer
            .as_ref()
            .is_some_and(|scorer| scorer.requires_arrival);
        own + self.scorer_constraints + usize::from(arrival)
    }

    fn evaluate(&self, points: &[f64], into: &mut Evaluation<'_>) -> Result<()> {
        match (&self.native, &self.scorer) {
            (Some(native), None) => native.evaluate(points, into),
            (None, Some(scorer)) => scorer.evaluate(points, into),
            (Some(native), Some(scorer)) => self.merge(native, scorer, points, into),
            (None, None) => Ok(()),
        }
    }

    fn slowest_first(&self) -> Vec<usize> {
        match &self.native {
            Some(native) => native.slowest_first(),
            None => (0..self.dimension()).collect(),
        }
    }

    fn block(&self) -> usize {
        let own = self.native.as_ref().map_or(usize::MAX, Problem::block);
        let called = self.scorer.as_ref().map_or(usize::MAX, |scorer| {
            let runs: usize = scorer.scenarios.iter().map(Vec::len).sum();
            (RUNS_OF_A_CALL / runs.max(1)).max(16)
        });
        own.min(called)
    }
}

/// Sum by which the constraints are missed, for each gain set.
fn violations(found: &Evaluated, constraints: usize) -> Vec<f64> {
    let rows = 0..found.failed.len();
    let margins = rows.map(|row| &found.margins[row * constraints..(row + 1) * constraints]);
    margins
        .map(|margins| Score::new(0.0, margins, false).violation)
        .collect()
}

/// The scenarios of each seed; as they are when there is none.
fn seeded(scenarios: &[scenario::Scenario], seeds: &[u64]) -> Vec<Vec<scenario::Scenario>> {
    if seeds.is_empty() {
        return vec![scenarios.to_vec()];
    }
    let with = |seed: &u64| {
        let copies = scenarios.iter().cloned();
        copies.map(|scene| scene.reseeded(*seed)).collect()
    };
    seeds.iter().map(with).collect()
}

fn batch_options(run: Options, weights: Weights, width: Option<Width>) -> BatchOptions {
    BatchOptions {
        run,
        weights,
        descent: false,
        threads: None,
        width,
        instructions: Instructions::Widest,
    }
}

/// Objectives: the mean over the scenarios, of a clearance the least.
fn objectives_of(words: &[String]) -> CoreResult<Vec<Objective>> {
    let objective = |word: &String| {
        let metric = Metric::of(word)?;
        let over = match metric {
            Metric::MinClearance => Over::Worst,
            Metric::Performance
            | Metric::TimePerformance
            | Metric::AvoidancePerformance
            | Metric::EnergyPerformance
            | Metric::ArrivalTime
            | Metric::Energy
            | Metric::PathLength => Over::Mean,
        };
        Ok(Objective { metric, over })
    };
    words.iter().map(objective).collect()
}

fn constraints_of(given: &[Bounded]) -> CoreResult<Vec<MetricConstraint>> {
    let mut constraints = Vec::new();
    for (word, least, most, scenario) in given {
        let metric = Metric::of(word)?;
        let limits = [least.map(Limit::AtLeast), most.map(Limit::AtMost)];
        constraints.extend(limits.into_iter().flatten().map(|limit| MetricConstraint {
            metric,
            limit,
            scenario: *scenario,
        }));
    }
    Ok(constraints)
}
