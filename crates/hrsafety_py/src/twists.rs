//! Twists of laws that choose them, from one place.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::lanes::Vector2;
use vff_core::laws::filters::Near;
use vff_core::laws::local_planning::{Gaps, LocalView, MovingShape, Pose, Walls, Way};
use vff_core::world::shape::PlacedShape;

use crate::arrays::fields;
use crate::errors::InvalidParameterError;
use crate::keywords::Keywords;
use crate::laws::Law;
use crate::maps::StaticMap;

/// Twist that a law chooses from a place, and the twists that it plans after it.
#[pyfunction]
#[pyo3(signature = (law, **given))]
pub fn choose_twist<'py>(
    py: Python<'py>,
    law: &Law,
    given: Option<Keywords<'py>>,
) -> PyResult<Bound<'py, PyDict>> {
    let given = given.unwrap_or_default();
    let Some(mut planner) = law.any.twist_planner(given.take("seed")?) else {
        let error = ("law", "choose twists", law.any.gain_names().to_vec());
        return Err(InvalidParameterError::new_err(error));
    };
    let ([x, y, heading], path): ([f64; 3], Vec<[f64; 2]>) =
        (given.take("pose")?, given.take("path")?);
    let (people, walls): (Vec<[f64; 5]>, Vec<Vec<[f64; 2]>>) =
        (given.take("people")?, given.take("walls")?);
    let map: Option<PyRef<'_, StaticMap>> = given.take("map")?;
    let goal: [f64; 2] = given.take("goal")?;
    let people: Vec<Near> = people
        .into_iter()
        .map(|[x, y, vx, vy, radius]| Near {
            position: Vector2::new(x, y),
            velocity: Vector2::new(vx, vy),
            radius,
        })
        .collect();
    let shapes: Vec<MovingShape> = walls
        .iter()
        .flat_map(|wall| wall.windows(2))
        .map(|ends| MovingShape {
            placed: PlacedShape::wall(ends[0], ends[1]),
            velocity: Vector2::zeros(),
        })
        .collect();
    let gaps = Gaps {
        radius: given.take("radius")?,
        people: &people,
        walls: Walls {
            shapes: &shapes,
            map: map.as_ref().map(|map| &map.0),
        },
    };
    let position = Vector2::new(x, y);
    let way = Way::new(path.into_iter().map(Vector2::from));
    let way = way.unwrap_or_else(|| Way::straight(position, goal.into()));
    let plan: Vec<[f64; 3]> = given.take("plan")?;
    planner.resume(&plan, given.take("call")?);
    let choice = planner.choose(&LocalView {
        pose: Pose { position, heading },
        twist: given.take("twist")?,
        local_goal: goal.into(),
        way: &way,
        period: given.take("control_period")?,
        max_speed: given.take("max_speed")?,
        gaps: &gaps,
    });
    given.done()?;
    let planned = planner.planned();
    Ok(fields! { py;
        vector twist = choice.twist.to_vec();
        value score = choice.score.unwrap_or(f64::NAN);
        value mode = choice.mode.word();
        array [planned.len(), 3] plan = planned.as_flattened().to_vec();
    })
}
