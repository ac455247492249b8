//! Reactive avoidance: conversions only, everything is computed by the core.

pub mod follower;
pub mod localization;
pub mod skirt;
pub mod skirt_steps;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::laws::reflex::Percept;

use crate::arrays::fields;

/// Fields of what a law knows at a time in s.
fn percept_fields<'py>(
    py: Python<'py>,
    time: f64,
    percept: &Percept<'_>,
) -> PyResult<Bound<'py, PyDict>> {
    let bearing = |direction: [f64; 2]| direction[1].atan2(direction[0]);
    let heard = percept.heard.map(|heard| bearing(heard.direction.into()));
    let places: Vec<f64> = percept
        .bodies
        .iter()
        .flat_map(|body| body.state.position)
        .collect();
    Ok(fields! { py;
        value time = time;
        vector position = percept.pose.position.as_slice().to_vec();
        vector velocity = percept.velocity.as_slice().to_vec();
        value heading = percept.pose.angle();
        vector readings = percept.readings.to_vec();
        value source_range = percept.heard.map(|heard| heard.range);
        value source_bearing = heard;
        array [percept.bodies.len(), 2] obstacle_position = places;
    })
}
