//! Layouts of the follower, and its runs through many of them.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::run::follower::{FollowerOutcome, Layouts, Setting, run_batch, touching_layouts};
use vff_core::world::obstacle::Obstacle;
use vff_core::world::shape::Shape;

use super::{Follower, VirtualImpedance};
use crate::arrays::Fields;
use crate::errors::CoreError;
use crate::keywords::word;
use crate::watch::{Report, spread};

/// How random layouts are drawn.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct FollowerLayouts(Layouts);

#[pymethods]
impl FollowerLayouts {
    #[new]
    #[pyo3(signature = (*, kind, obstacle_speed, size_factor, leader_size))]
    fn new(
        kind: &Bound<'_, PyAny>,
        obstacle_speed: [f64; 2],
        size_factor: f64,
        leader_size: Option<[f64; 2]>,
    ) -> PyResult<Self> {
        let kinds = [
            ("tracking", Setting::Tracking),
            ("static", Setting::Static),
            ("one_dynamic", Setting::OneDynamic),
            ("two_dynamic", Setting::TwoDynamic),
        ];
        let rule = "be one of \"tracking\", \"static\", \"one_dynamic\", \"two_dynamic\"";
        let layouts = Layouts {
            speeds: obstacle_speed,
            size_factor,
            leader: leader_size.map(|size| size.map(|side| 0.5 * side)),
            ..Layouts::of(word("kind", kind, rule, &kinds)?)
        };
        Ok(Self(layouts.checked().map_err(CoreError::from)?))
    }
}

/// Boxes, leader and length of the layout of a seed.
#[pyfunction]
pub fn follower_layout<'py>(
    py: Python<'py>,
    layouts: &FollowerLayouts,
    seed: u64,
) -> PyResult<Bound<'py, PyDict>> {
    let scene = layouts.0.scene(seed).map_err(CoreError::from)?;
    let fields = Fields::new(py);
    boxes(&fields, &scene.obstacles)?;
    let motion = &scene.leader.motion;
    let ([start, end], velocity) = motion.first_move().unwrap_or_default();
    fields.value("leader_start", motion.at(start, &mut 0).position)?;
    fields.value("leader_end", motion.at(end, &mut 0).position)?;
    fields.value("leader_speed", velocity[0].hypot(velocity[1]))?;
    fields.value("duration", scene.duration)?;
    Ok(fields.finish())
}

/// Boxes of a layout: first places, sides, velocities, and when they move.
fn boxes(fields: &Fields<'_>, obstacles: &[Obstacle]) -> PyResult<()> {
    let (mut centers, mut sizes, mut velocities) = (Vec::new(), Vec::new(), Vec::new());
    let (mut starts, mut stops) = (Vec::new(), Vec::new());
    for obstacle in obstacles {
        let Shape::Rectangle {
            half_length,
            half_width,
            ..
        } = obstacle.shape
        else {
            continue;
        };
        let ([start, stop], velocity) = obstacle.motion.first_move().unwrap_or_default();
        centers.extend(obstacle.motion.at(0.0, &mut 0).position);
        sizes.extend([2.0 * half_length, 2.0 * half_width]);
        velocities.extend(velocity);
        starts.push(start);
        stops.push(stop);
    }
    let count = starts.len();
    fields.array("center", centers, [count, 2])?;
    fields.array("size", sizes, [count, 2])?;
    fields.array("velocity", velocities, [count, 2])?;
    fields.vector("start", starts)?;
    fields.vector("stop", stops)
}

/// The first seeds in whose layouts the robot without repulsion touches an obstacle.
#[pyfunction]
#[pyo3(signature = (follower, layouts, *, first, count, threads))]
pub fn follower_touching(
    py: Python<'_>,
    follower: &Follower,
    layouts: &FollowerLayouts,
    first: u64,
    count: usize,
    threads: Option<usize>,
) -> PyResult<Vec<u64>> {
    let (settings, layouts) = (&follower.0, &layouts.0);
    spread(py, Report::none(), threads, |work| {
        touching_layouts(settings, layouts, first, count, work)
    })
}

/// Ends of the runs through the layouts of seeds.
#[pyfunction]
#[pyo3(signature = (follower, law, layouts, seeds, *, threads, progress))]
pub fn follower_batch<'py>(
    py: Python<'py>,
    follower: &Follower,
    law: &VirtualImpedance,
    layouts: &FollowerLayouts,
    seeds: Vec<u64>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let settings = follower.with(law);
    let layouts = &layouts.0;
    let report = Report::new(progress.as_ref(), seeds.len());
    let outcomes = spread(py, report, threads, |work| {
        run_batch(&settings, layouts, &seeds, work)
    })?;
    let fields = Fields::new(py);
    let column =
        |get: &dyn Fn(&FollowerOutcome) -> f64| outcomes.iter().map(get).collect::<Vec<f64>>();
    let collided = outcomes.iter().map(|outcome| outcome.contact.is_some());
    fields.vector("collided", collided.collect::<Vec<bool>>())?;
    let touched = |outcome: &FollowerOutcome| {
        let index = outcome.contact.map(|touch| i64::try_from(touch.obstacle));
        index.and_then(Result::ok).unwrap_or(-1)
    };
    fields.vector::<i64>(
        "contact_obstacle",
        outcomes.iter().map(touched).collect::<Vec<i64>>(),
    )?;
    let bearing = |each: &FollowerOutcome| each.contact.map_or(f64::NAN, |touch| touch.bearing);
    fields.vector("contact_bearing", column(&bearing))?;
    fields.vector("end_time", column(&|each| each.end_time))?;
    fields.vector("source_distance", column(&|each| each.source_distance))?;
    fields.vector("least_clearance", column(&|each| each.least_clearance))?;
    fields.vector("path_length", column(&|each| each.path_length))?;
    fields.vector("turning", column(&|each| each.turning))?;
    Ok(fields.finish())
}
