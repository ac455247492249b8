//! What a controller sees, as Python takes it.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::lanes::Planar;
use vff_core::laws::Situation;
use vff_core::world::geometry::Body;
use vff_core::world::obstacle::Shape;

use crate::arrays::Fields;

/// Radius of a disc, length, width and heading of a rectangle; NaN where there is none.
fn sizes(body: &Body) -> (f64, [f64; 2], f64) {
    match body.shape {
        Shape::Disc { radius } => (radius, [f64::NAN; 2], f64::NAN),
        Shape::Rectangle {
            half_length,
            half_width,
            axis,
        } => {
            let size = [2.0 * half_length, 2.0 * half_width];
            (f64::NAN, size, axis[1].atan2(axis[0]))
        }
    }
}

/// A vector of an obstacle that is present, NaN otherwise.
fn shown(body: &Body, vector: [f64; 2]) -> [f64; 2] {
    if body.state.present {
        vector
    } else {
        [f64::NAN; 2]
    }
}

/// Fields of a situation.
pub fn situation_fields<'py>(
    py: Python<'py>,
    situation: &Situation<'_, f64>,
) -> PyResult<Bound<'py, PyDict>> {
    let bodies = situation.bodies;
    let count = bodies.len();
    let pairs = |of: &dyn Fn(&Body) -> [f64; 2]| bodies.iter().flat_map(of).collect();
    let values = |of: &dyn Fn(&Body) -> f64| bodies.iter().map(of).collect();
    let fields = Fields::new(py);
    fields.value("time", situation.time)?;
    fields.vector("position", situation.robot.position.lane(0).to_vec())?;
    fields.vector("velocity", situation.robot.velocity.lane(0).to_vec())?;
    fields.value("heading", situation.heading)?;
    let place = |body: &Body| shown(body, body.state.position);
    fields.matrix("obstacle_position", pairs(&place), count, 2)?;
    let speed = |body: &Body| shown(body, body.state.velocity);
    fields.matrix("obstacle_velocity", pairs(&speed), count, 2)?;
    fields.vector("obstacle_radius", values(&|body| sizes(body).0))?;
    fields.matrix("obstacle_size", pairs(&|body| sizes(body).1), count, 2)?;
    fields.vector("obstacle_heading", values(&|body| sizes(body).2))?;
    let active = |body: &Body| body.regions.active_radius;
    fields.vector("active_radius", values(&active))?;
    let critical = |body: &Body| body.regions.critical_radius;
    fields.vector("critical_radius", values(&critical))?;
    let present: Vec<bool> = bodies.iter().map(|body| body.state.present).collect();
    fields.vector("obstacle_present", present)?;
    fields.value("control_period", situation.interval)?;
    Ok(fields.finish())
}
