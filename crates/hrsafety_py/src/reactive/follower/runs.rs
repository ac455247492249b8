//! Runs of the follower: one recorded, or many in one crossing.

use numeric::parallel::Work;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::run::follower::{
    Follower as Robot, Layouts, Leader, Mover as Obstacle, Outcome, Recording, Scene, Setting,
    record, run_batch, touching_layouts,
};
use vff_core::sensing::sonar::Shape;

use super::{Follower, Mover, VirtualImpedance, word};
use crate::arrays::Fields;
use crate::errors::{CoreError, CoreResult};
use crate::watch::{Report, watched};

/// How random layouts are drawn.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct FollowerLayouts(Layouts);

#[pymethods]
impl FollowerLayouts {
    #[new]
    #[pyo3(signature = (*, kind, obstacle_speed, size_factor, leader_size))]
    fn new(
        kind: &str,
        obstacle_speed: [f64; 2],
        size_factor: f64,
        leader_size: Option<[f64; 2]>,
    ) -> CoreResult<Self> {
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
            ..Layouts::of(word("kind", rule, kind, &kinds)?)
        };
        Ok(Self(layouts.checked()?))
    }
}

/// Boxes, leader and length of the layout of a seed.
#[pyfunction]
pub fn follower_layout<'py>(
    py: Python<'py>,
    layouts: &FollowerLayouts,
    seed: u64,
) -> PyResult<Bound<'py, PyDict>> {
    let scene = layouts.0.scene(seed);
    let boxes: Vec<_> = scene
        .obstacles
        .iter()
        .filter_map(|obstacle| match obstacle.shape {
            Shape::Rectangle(shape) => Some((obstacle, shape)),
            Shape::Disc(_) | Shape::Wall(_) => None,
        })
        .collect();
    let fields = Fields::new(py);
    let rows = |numbers: Vec<[f64; 2]>| numbers.into_iter().flatten().collect::<Vec<f64>>();
    let count = boxes.len();
    let centers = rows(boxes.iter().map(|(_, shape)| shape.center).collect());
    fields.matrix("center", centers, count, 2)?;
    let sizes = boxes.iter().map(|(_, shape)| shape.half_size);
    let sizes = sizes.map(|half| half.map(|side| 2.0 * side)).collect();
    fields.matrix("size", rows(sizes), count, 2)?;
    let velocities = rows(
        boxes
            .iter()
            .map(|(obstacle, _)| obstacle.velocity)
            .collect(),
    );
    fields.matrix("velocity", velocities, count, 2)?;
    fields.vector("start", boxes.iter().map(|(each, _)| each.start).collect())?;
    fields.vector("stop", boxes.iter().map(|(each, _)| each.stop).collect())?;
    let leader = scene.leader;
    fields.value("leader_start", leader.start)?;
    fields.value("leader_end", leader.at(leader.duration))?;
    let [x, y] = leader.velocity;
    fields.value("leader_speed", x.hypot(y))?;
    fields.value("duration", scene.duration)?;
    Ok(fields.finish())
}

/// One run, sample by sample.
#[pyfunction]
#[pyo3(signature = (follower, law, obstacles, *, leader_start, leader_end, leader_speed,
    leader_size, duration, seed))]
#[allow(clippy::too_many_arguments)] // keyword-only in Python
#[allow(clippy::needless_pass_by_value)] // references to Python objects
pub fn follower_record<'py>(
    py: Python<'py>,
    follower: &Follower,
    law: &VirtualImpedance,
    obstacles: Vec<PyRef<'py, Mover>>,
    leader_start: [f64; 2],
    leader_end: [f64; 2],
    leader_speed: f64,
    leader_size: Option<[f64; 2]>,
    duration: f64,
    seed: u64,
) -> PyResult<Bound<'py, PyDict>> {
    let mut leader =
        Leader::going(leader_start, leader_end, leader_speed).map_err(CoreError::from)?;
    leader.visible = leader_size.map(|size| size.map(|side| 0.5 * side));
    let obstacles: Vec<Obstacle> = obstacles.iter().map(|mover| mover.0).collect();
    let scene = Scene {
        leader,
        obstacles,
        duration,
    };
    let robot = Robot::new(&follower.with(law)).map_err(CoreError::from)?;
    let (outcome, recording) = watched(py, Report::none(), |control| {
        record(&robot, &scene, seed, &|| control.interrupted())
    })?;
    let fields = Fields::new(py);
    samples(&fields, recording, robot.sensors(), scene.obstacles.len())?;
    summary(&fields, &outcome)?;
    Ok(fields.finish())
}

/// Samples of a run.
fn samples(
    fields: &Fields<'_>,
    recording: Recording,
    sensors: usize,
    obstacles: usize,
) -> PyResult<()> {
    let count = recording.time.len();
    let pairs = [
        ("position", recording.position),
        ("virtual_velocity", recording.virtual_velocity),
        ("wheel_speed", recording.wheel_speed),
        ("target", recording.target),
        ("source", recording.source),
        ("attraction", recording.attraction),
        ("repulsion", recording.repulsion),
    ];
    for (name, rows) in pairs {
        fields.matrix(name, rows.into_iter().flatten().collect(), count, 2)?;
    }
    fields.vector("time", recording.time)?;
    fields.vector("heading", recording.heading)?;
    fields.matrix("readings", recording.readings, count, sensors)?;
    fields.matrix("clearance", recording.clearance, count, obstacles)?;
    let shifts = recording.shifts.into_iter().flatten().collect();
    fields.cube("shift", shifts, [count, obstacles, 2])
}

/// End of a run.
fn summary(fields: &Fields<'_>, outcome: &Outcome) -> PyResult<()> {
    let contact = outcome.contact;
    fields.value("contact_obstacle", contact.map(|touch| touch.obstacle))?;
    fields.value("contact_bearing", contact.map(|touch| touch.bearing))?;
    fields.value("end_time", outcome.end_time)?;
    fields.value("source_distance", outcome.source_distance)?;
    fields.value("least_clearance", outcome.least_clearance)?;
    fields.value("path_length", outcome.path_length)?;
    fields.value("turning", outcome.turning)
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
    watched(py, Report::none(), |control| {
        let work = Work {
            threads,
            interrupted: &|| control.interrupted(),
            progress: &|_| (),
        };
        touching_layouts(settings, layouts, first, count, work)
    })
}

/// Ends of the runs through the layouts of seeds.
#[pyfunction]
#[pyo3(signature = (follower, law, layouts, seeds, *, threads, progress))]
#[allow(clippy::needless_pass_by_value)] // references to Python objects
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
    let outcomes = watched(py, report, |control| {
        let work = Work {
            threads,
            interrupted: &|| control.interrupted(),
            progress: &|runs| control.count(runs),
        };
        run_batch(&settings, layouts, &seeds, work)
    })?;
    let fields = Fields::new(py);
    let column = |get: &dyn Fn(&Outcome) -> f64| outcomes.iter().map(get).collect::<Vec<f64>>();
    let collided = outcomes.iter().map(|outcome| outcome.contact.is_some());
    fields.vector("collided", collided.collect::<Vec<bool>>())?;
    let touched = |outcome: &Outcome| {
        let index = outcome.contact.map(|touch| i64::try_from(touch.obstacle));
        index.and_then(Result::ok).unwrap_or(-1)
    };
    fields.vector::<i64>(
        "contact_obstacle",
        outcomes.iter().map(touched).collect::<Vec<i64>>(),
    )?;
    let bearing = |each: &Outcome| each.contact.map_or(f64::NAN, |touch| touch.bearing);
    fields.vector("contact_bearing", column(&bearing))?;
    fields.vector("end_time", column(&|each| each.end_time))?;
    fields.vector("source_distance", column(&|each| each.source_distance))?;
    fields.vector("least_clearance", column(&|each| each.least_clearance))?;
    fields.vector("path_length", column(&|each| each.path_length))?;
    fields.vector("turning", column(&|each| each.turning))?;
    Ok(fields.finish())
}
