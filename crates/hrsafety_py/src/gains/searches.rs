//! Searches over a gain problem.

use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use vff_core::search::{
    Bounds, FrontOptions, GlobalMethod, GlobalOptions, GridOptions, LocalOptions, Problem,
    SearchOptions, SearchState, front_search, global_search, hypervolume, search,
};

use crate::errors::CoreError;
use crate::gains::problem::GainProblem;
use crate::gains::results::{front_fields, global_fields, search_fields};
use crate::gains::watch::{Followers, follow};
use crate::keywords::{Keywords, taken};

/// The state that a search is resumed from.
fn state_of(given: &Keywords<'_>) -> PyResult<Option<SearchState>> {
    let state: Option<Bound<'_, PyBytes>> = given.take("state")?;
    let state = state.map(|state| SearchState::from_bytes(state.as_bytes()));
    Ok(state.transpose().map_err(CoreError::from)?)
}

/// Coarse-to-fine grids, then local searches from their best points.
#[pyfunction]
#[pyo3(signature = (problem, lower, upper, **given))]
pub fn search_gains<'py>(
    py: Python<'py>,
    problem: PyRef<'py, GainProblem>,
    lower: Vec<f64>,
    upper: Vec<f64>,
    given: Option<Keywords<'py>>,
) -> PyResult<Bound<'py, PyDict>> {
    let given = given.unwrap_or_default();
    let bounds = Bounds::new(lower, upper).map_err(CoreError::from)?;
    let local_starts = given.take("local_starts")?;
    let local = LocalOptions {
        starts: local_starts,
        ..LocalOptions::default()
    };
    let options = SearchOptions {
        grid: taken!(given: GridOptions { shape, refinements, survivors, keep }),
        local: (local_starts > 0).then_some(local),
        threads: given.take("threads")?,
    };
    let resume = state_of(&given)?;
    let followers = taken!(given: Followers { progress, save });
    given.done()?;
    let problem: &GainProblem = &problem;
    let found = py.detach(|| {
        follow(problem, &followers, |observer| {
            search(problem, &bounds, &options, observer, resume.as_ref())
        })
    })?;
    search_fields(py, found)
}

/// Global search with a budget.
#[pyfunction]
#[pyo3(signature = (problem, lower, upper, **given))]
pub fn search_gains_globally<'py>(
    py: Python<'py>,
    problem: PyRef<'py, GainProblem>,
    lower: Vec<f64>,
    upper: Vec<f64>,
    given: Option<Keywords<'py>>,
) -> PyResult<Bound<'py, PyDict>> {
    let given = given.unwrap_or_default();
    let bounds = Bounds::new(lower, upper).map_err(CoreError::from)?;
    let methods = [
        (
            "differential_evolution",
            GlobalMethod::DifferentialEvolution,
        ),
        ("cma_es", GlobalMethod::CmaEs),
    ];
    let rule = "be \"differential_evolution\" or \"cma_es\"";
    let options = taken!(given: GlobalOptions {
        method = given.word("method", rule, &methods)?, evaluations, islands, seed, threads,
    });
    let resume = state_of(&given)?;
    let followers = taken!(given: Followers { progress, save });
    given.done()?;
    let problem: &GainProblem = &problem;
    let found = py.detach(|| {
        follow(problem, &followers, |observer| {
            global_search(problem, &bounds, &options, observer, resume.as_ref())
        })
    })?;
    global_fields(py, &found)
}

/// Gain sets that no other one beats in every objective.
#[pyfunction]
#[pyo3(signature = (problem, lower, upper, **given))]
pub fn gain_front<'py>(
    py: Python<'py>,
    problem: PyRef<'py, GainProblem>,
    lower: Vec<f64>,
    upper: Vec<f64>,
    given: Option<Keywords<'py>>,
) -> PyResult<Bound<'py, PyDict>> {
    let given = given.unwrap_or_default();
    let bounds = Bounds::new(lower, upper).map_err(CoreError::from)?;
    let options = taken!(given: FrontOptions { shape, refinements, threads });
    let resume = state_of(&given)?;
    let followers = taken!(given: Followers { progress, save });
    given.done()?;
    let problem: &GainProblem = &problem;
    let found = py.detach(|| {
        follow(problem, &followers, |observer| {
            front_search(problem, &bounds, &options, observer, resume.as_ref())
        })
    })?;
    front_fields(py, found, problem.dimension(), problem.objectives())
}

/// Volume between points, all objectives maximized, and a reference below them.
#[pyfunction]
pub fn front_hypervolume(values: Vec<f64>, objectives: usize, reference: Vec<f64>) -> f64 {
    hypervolume(&values, objectives, &reference)
}
