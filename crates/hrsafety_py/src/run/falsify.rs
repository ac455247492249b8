//! Search for a pursuer against whom a law breaks a property.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::run::pursuit::{Encounter, HiddenHunt, NUMBERS, Pursued, Pursuer};
use vff_core::run::{ContactCounts, as_built};
use vff_core::search;

use crate::arrays::fields;
use crate::errors::InvalidParameterError;
use crate::laws::Law;
use crate::parameters::Scenario;
use crate::robots::as_built::AsBuilt;
use crate::safe::Unseen;
use crate::watch::{Report, watched_law};

/// A robot under a law, and the bounds of who pursues it.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct Hunt {
    scenario: vff_core::world::scenario::Scenario,
    law: Py<Law>,
    built: as_built::AsBuilt,
    max_speed: f64,
    free: f64,
}

impl Hunt {
    fn with<T>(&self, law: &Law, work: impl FnOnce(&search::Falsification<'_>) -> T) -> T {
        work(&search::Falsification {
            scenario: &self.scenario,
            law: &law.any,
            built: &self.built,
            max_speed: self.max_speed,
            free: self.free,
        })
    }
}

/// A property by its word and its limit.
#[derive(FromPyObject)]
struct Limited(String, f64);

impl Limited {
    fn property(self) -> PyResult<search::Property> {
        let Self(word, limit) = self;
        match word.as_str() {
            "at_fault" => Ok(search::Property::NotAtFault),
            "clearance" => Ok(search::Property::Clearance(limit)),
            "arrival" => Ok(search::Property::Arrival),
            "speed" => Ok(search::Property::Speed(limit)),
            _ => {
                let rule = "be one of \"at_fault\", \"clearance\", \"arrival\", \"speed\"";
                Err(InvalidParameterError::new_err(("property", rule, word)))
            }
        }
    }
}

/// Columns of encounters, with the margin of a property.
fn columns<'py>(
    py: Python<'py>,
    found: &[Encounter],
    property: search::Property,
) -> PyResult<Bound<'py, PyDict>> {
    let column = |of: &dyn Fn(&Encounter) -> f64| found.iter().map(of).collect::<Vec<f64>>();
    let counts = |of: fn(&ContactCounts) -> u32| -> Vec<i64> {
        found
            .iter()
            .map(|each| i64::from(of(&each.contacts)))
            .collect()
    };
    Ok(fields! { py;
        vector margin = column(&|each| property.margin(each));
        each found: least_toward, arrival_time, top_speed, fault_speed, end_time;
        vector min_clearance = column(&|each| each.least);
        vector contacts_toward = counts(|each| each.toward);
        vector contacts_away = counts(|each| each.away);
        vector contacts_standing = counts(|each| each.standing);
        vector wall_contacts = counts(|each| each.walls);
        vector overlooked = found.iter().map(|each| i64::from(each.overlooked)).collect::<Vec<i64>>();
    })
}

/// Columns of encounters, times in s and starts in m, and when the robot arrives with nobody there, in s.
type HiddenColumns<'py> = (Bound<'py, PyDict>, Vec<(f64, [f64; 2])>, f64);

#[pymethods]
impl Hunt {
    #[new]
    #[pyo3(signature = (scenario, law, built, *, step, person_speed, free))]
    fn new(
        scenario: &Scenario,
        law: Py<Law>,
        built: &AsBuilt,
        step: f64,
        person_speed: f64,
        free: f64,
    ) -> Self {
        Self {
            scenario: scenario.0.clone(),
            law,
            built: built.run(step, false),
            max_speed: person_speed,
            free,
        }
    }

    /// Columns of episodes against random pursuers.
    #[pyo3(signature = (property, *, episodes, seed, threads, progress))]
    fn sweep<'py>(
        &self,
        py: Python<'py>,
        property: Limited,
        episodes: usize,
        seed: u64,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let property = property.property()?;
        let law = self.law.get();
        let report = Report::new(progress.as_ref(), episodes);
        let found = watched_law(py, (law, threads), report, |control| {
            let interrupted = || control.interrupted();
            let count = |runs| control.count(runs);
            let threads = law.threads(threads);
            self.with(law, |hunt| {
                hunt.sweep(episodes, seed, threads, &interrupted, &count)
            })
        })?;
        columns(py, &found, property)
    }

    /// Numbers of the worst pursuer that CMA-ES finds, and the margin against him.
    #[pyo3(signature = (property, *, episodes, seed, threads, progress))]
    fn worst(
        &self,
        py: Python<'_>,
        property: Limited,
        episodes: usize,
        seed: u64,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(Vec<f64>, f64)> {
        let property = property.property()?;
        let law = self.law.get();
        let report = Report::new(progress.as_ref(), episodes);
        let found = watched_law(py, (law, threads), report, |control| {
            let interrupted = || control.interrupted();
            let count = |runs| control.count(runs);
            let threads = law.threads(threads);
            let budget = episodes as u64;
            self.with(law, |hunt| {
                hunt.worst(property, budget, seed, threads, &interrupted, &count)
            })
        })?;
        let (numbers, margin) = found.unwrap_or(([f64::NAN; NUMBERS], f64::NAN));
        Ok((numbers.to_vec(), margin))
    }

    /// One episode again with its rows: that of a random pursuer, or of the numbers of one.
    #[pyo3(signature = (*, seed, index, numbers))]
    fn replay<'py>(
        &self,
        py: Python<'py>,
        seed: u64,
        index: u64,
        numbers: Option<[f64; NUMBERS]>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let law = self.law.get();
        let mut rows = Pursued::default();
        let found = watched_law(py, (law, Some(1)), Report::none(), |control| {
            let interrupted = || control.interrupted();
            self.with(law, |hunt| {
                let (pursuer, own): (Pursuer, u64) = match &numbers {
                    Some(numbers) => (hunt.planned(numbers), seed),
                    None => (hunt.random(seed, index), seed.wrapping_add(index)),
                };
                hunt.episode(&pursuer, own, Some(&mut rows), &interrupted)
            })
        })?;
        told(py, found, &rows)
    }

    /// Columns of encounters with people who were hidden, with their times in s and starts in m, and when the robot
    /// arrives with nobody there, in s.
    #[allow(clippy::too_many_arguments)] // each by name in Python's face
    #[pyo3(signature = (property, unseen, *, every, lasting, most, seed))]
    fn hidden<'py>(
        &self,
        py: Python<'py>,
        property: Limited,
        unseen: &Unseen,
        every: f64,
        lasting: f64,
        most: usize,
        seed: u64,
    ) -> PyResult<HiddenColumns<'py>> {
        let property = property.property()?;
        let law = self.law.get();
        let (alone, found) = watched_law(py, (law, Some(1)), Report::none(), |control| {
            let interrupted = || control.interrupted();
            self.hidden_hunt(law, unseen, [every, lasting])
                .encounters(most, seed, &interrupted)
        })?;
        let places = found.iter().map(|each| (each.time, each.start)).collect();
        let found: Vec<Encounter> = found.into_iter().map(|each| each.found).collect();
        Ok((columns(py, &found, property)?, places, alone.arrival_time))
    }

    /// One encounter with somebody who was hidden again, with its rows.
    #[pyo3(signature = (unseen, *, time, start, lasting))]
    fn hidden_replay<'py>(
        &self,
        py: Python<'py>,
        unseen: &Unseen,
        time: f64,
        start: [f64; 2],
        lasting: f64,
    ) -> PyResult<Bound<'py, PyDict>> {
        let law = self.law.get();
        let mut rows = Pursued::default();
        let found = watched_law(py, (law, Some(1)), Report::none(), |control| {
            let interrupted = || control.interrupted();
            let hunt = self.hidden_hunt(law, unseen, [1.0, lasting]);
            hunt.encounter(time, start, Some(&mut rows), &interrupted)
        })?;
        told(py, found, &rows)
    }
}

impl Hunt {
    fn hidden_hunt<'a>(
        &'a self,
        law: &'a Law,
        unseen: &Unseen,
        [every, lasting]: [f64; 2],
    ) -> HiddenHunt<'a> {
        HiddenHunt {
            scenario: &self.scenario,
            law: &law.any,
            built: &self.built,
            unseen: unseen.0,
            max_speed: self.max_speed,
            every,
            lasting,
        }
    }
}

/// Columns of an encounter, with its rows.
fn told<'py>(py: Python<'py>, found: Encounter, rows: &Pursued) -> PyResult<Bound<'py, PyDict>> {
    let fields = columns(py, &[found], search::Property::NotAtFault)?;
    let count = rows.time.len();
    let more = fields! { py;
        vector time = rows.time.clone();
        array [count, 2] position = rows.position.clone();
        array [count, 2] velocity = rows.velocity.clone();
        array [count, 2] person_position = rows.pursuer.clone();
    };
    fields.update(more.as_mapping())?;
    Ok(fields)
}
