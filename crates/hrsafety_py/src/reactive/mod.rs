//! Reactive avoidance: conversions only, everything is computed by the core.

pub mod follower;
pub mod localization;
pub mod skirt;
pub mod skirt_steps;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::laws::reflex::Percept;

use crate::arrays::Fields;

/// Fields of what a law knows at a time in s.
fn percept_fields<'py>(
    py: Python<'py>,
    time: f64,
    percept: &Percept<'_>,
) -> PyResult<Bound<'py, PyDict>> {
    let fields = Fields::new(py);
    fields.value("time", time)?;
    fields.vector("position", percept.pose.position.as_slice().to_vec())?;
    fields.vector("velocity", percept.velocity.as_slice().to_vec())?;
    fields.value("heading", percept.pose.angle())?;
    fields.vector("readings", percept.readings.to_vec())?;
    fields.value("source_range", percept.heard.map(|heard| heard.range))?;
    let bearing = |direction: [f64; 2]| direction[1].atan2(direction[0]);
    let heard = percept.heard.map(|heard| bearing(heard.direction.into()));
    fields.value("source_bearing", heard)?;
    let places: Vec<f64> = percept
        .bodies
        .iter()
        .flat_map(|body| body.state.position)
        .collect();
    fields.matrix("obstacle_position", places, percept.bodies.len(), 2)?;
    Ok(fields.finish())
}
