//! A test of the skirt that Python steps, or lets run to its end.

use numeric::error::{Failure, Given};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::lanes::Vector2;
use vff_core::run::skirt::{Direction, EscapeAction, SkirtRecord, SkirtSteps as Steps, TestPlan};

use crate::arrays::Fields;
use crate::errors::CoreResult;
use crate::reactive::percept_fields;
use crate::reactive::skirt::{SkirtMotion, SkirtScene, UltrasonicSkirt, action_word};
use crate::run::episode::BUSY;
use crate::run::stepped::Stepped;

/// A test under way.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct SkirtSteps(Stepped<Steps>);

/// Action of a word.
fn action_of(given: &str) -> CoreResult<EscapeAction> {
    let moves = Direction::ALL.into_iter().map(EscapeAction::Move);
    let mut known = [EscapeAction::Keep, EscapeAction::Spin]
        .into_iter()
        .chain(moves);
    known
        .find(|action| action_word(*action) == given)
        .ok_or_else(|| {
            let rule = "be \"keep\", \"spin\" or a motion direction";
            Failure::invalid("action", rule, Given::Word(given.into())).into()
        })
}

#[pymethods]
impl SkirtSteps {
    #[new]
    #[pyo3(signature = (skirt, scene, motion, *, index, repeats, seed))]
    fn new(
        skirt: &UltrasonicSkirt,
        scene: &SkirtScene,
        motion: &SkirtMotion,
        index: usize,
        repeats: usize,
        seed: u64,
    ) -> CoreResult<Self> {
        let plan = TestPlan {
            layouts: 1,
            repeats,
            scene: scene.0,
            motion: motion.0,
            seed,
        };
        Ok(Self(Stepped::new(
            Steps::new(&skirt.0, &plan, index)?,
            BUSY,
        )))
    }

    /// Fields of what the skirt decides by.
    fn percept<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let steps = self.0.idle()?;
        percept_fields(py, steps.time(), &steps.percept())
    }

    /// One firing period under the skirt's decision or an action.
    #[pyo3(signature = (*, action))]
    fn step(&self, py: Python<'_>, action: Option<&str>) -> PyResult<()> {
        let action = action.map(action_of).transpose()?;
        self.0
            .work(py, |steps, interrupted| steps.period(action, interrupted))
    }

    /// Runs to the end under the skirt's decisions.
    fn run(&self, py: Python<'_>) -> PyResult<()> {
        self.0.work(py, Steps::run)
    }

    /// Time of the firings so far in s.
    #[getter]
    fn time(&self) -> PyResult<f64> {
        Ok(self.0.idle()?.time())
    }

    /// Whether the test has ended.
    #[getter]
    fn finished(&self) -> PyResult<bool> {
        Ok(self.0.idle()?.finished())
    }

    /// Fields of the test so far.
    fn recorded<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let steps = self.0.idle()?;
        let (course, rows) = steps.recorded();
        let fields = Fields::new(py);
        firings(&fields, rows, steps.percept().readings.len())?;
        let (discs, seen) = (&steps.scene().discs, &steps.scene().seen);
        let centers = discs.iter().map(|disc| disc.center);
        fields.array("disc_center", flat(centers), [discs.len(), 2])?;
        let radii = discs.iter().map(|disc| disc.shape.inner_radius());
        fields.vector("disc_radius", radii.collect())?;
        fields.vector("disc_seen", seen.clone())?;
        fields.value("min_clearance", course.min_clearance)?;
        fields.value("contact_time", course.contact_time.unwrap_or(f64::NAN))?;
        Ok(fields.finish())
    }
}

/// Rows of a test.
fn firings(fields: &Fields<'_>, rows: &SkirtRecord, sensors: usize) -> PyResult<()> {
    let count = rows.time.len();
    fields.vector("time", rows.time.clone())?;
    fields.array("position", flat(rows.position.iter().copied()), [count, 2])?;
    fields.vector("heading", rows.heading.clone())?;
    fields.array("velocity", flat(rows.velocity.iter().copied()), [count, 2])?;
    fields.vector("yaw_rate", rows.yaw_rate.clone())?;
    fields.array("readings", rows.readings.clone(), [count, sensors])?;
    fields.words(
        "action",
        rows.action.iter().map(|action| action_word(*action)),
    )
}

/// Vectors one after the other.
fn flat(vectors: impl Iterator<Item = Vector2<f64>>) -> Vec<f64> {
    vectors.flat_map(<[f64; 2]>::from).collect()
}
