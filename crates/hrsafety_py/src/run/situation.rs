//! Situation of a controller as a Python class.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::lanes::Planar;
use vff_core::laws::Situation;
use vff_core::world::geometry::Body;
use vff_core::world::obstacle::Shape;

use crate::arrays::fields;

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
    let place = |body: &Body| shown(body, body.state.position);
    let speed = |body: &Body| shown(body, body.state.velocity);
    let active = |body: &Body| body.regions.active_radius;
    let critical = |body: &Body| body.regions.critical_radius;
    let present: Vec<bool> = bodies.iter().map(|body| body.state.present).collect();
    Ok(fields! { py;
        value situation: time, heading;
        vector position = situation.robot.position.lane(0).to_vec();
        vector velocity = situation.robot.velocity.lane(0).to_vec();
        array [count, 2] obstacle_position = pairs(&place);
        array [count, 2] obstacle_velocity = pairs(&speed);
        vector obstacle_radius = values(&|body| sizes(body).0);
        array [count, 2] obstacle_size = pairs(&|body| sizes(body).1);
        vector obstacle_heading = values(&|body| sizes(body).2);
        vector active_radius = values(&active);
        vector critical_radius = values(&critical);
        vector obstacle_present = present;
        value control_period = situation.interval;
    })
}
