//! Places that a robot has never seen: its map, the law that finds a way, and a controller that is told scans.

use numpy::{IntoPyArray, PyArray2, PyArrayMethods, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::error::Result;
use vff_core::laws;
use vff_core::unknown::explore::{
    self, Explorer, ExplorerOptions, Order, Robot, Status, TimedScan, Trust,
};
use vff_core::unknown::guide::GuideOptions;
use vff_core::unknown::map::{Kind, MapOptions};

use crate::arrays::fields;
use crate::errors::CoreError;
use crate::keywords::{Keywords, parameter_class, taken, value_class};
use crate::laws::Law;
use crate::maps::Lidar;
use crate::parameters::DifferentialDriveRobot;
use crate::run::stepped::Stepped;

const BUSY: &str = "an update of this controller is under way; update it from one place";

parameter_class! {
    /// Map that moves with a robot.
    UnknownMap(MapOptions) { cell, reach, hit_share, least_hits }
}

value_class! {
    /// How a robot finds its way through a place that it knows from its scans alone.
    ArcRollouts(ExplorerOptions) of given {
        let map: PyRef<'_, UnknownMap> = given.take("map")?;
        let guide = taken!(given: GuideOptions {
            clearance, narrow_weight, near_weight, near_distance, unknown_weight, beyond,
        });
        taken!(given: ExplorerOptions {
            map = map.0, guide = guide, margin, replan, nodes, verify, seed,
        })
    }
}

/// The law that finds its way so.
#[pyfunction]
pub fn exploring_law(rollouts: &ArcRollouts) -> PyResult<Law> {
    Law::of(laws::arc_rollouts::ArcRollouts(rollouts.0))
}

/// A robot that is told poses and scans.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct ScanController(Stepped<explore::Controller>);

/// Position and heading.
type Pose = ([f64; 2], f64);

#[pymethods]
impl ScanController {
    #[new]
    #[pyo3(signature = (rollouts, robot, period, lidars, **given))]
    fn new(
        rollouts: &ArcRollouts,
        robot: &DifferentialDriveRobot,
        period: f64,
        lidars: Vec<PyRef<'_, Lidar>>,
        given: Option<Keywords<'_>>,
    ) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let trust =
            taken!(given: Trust { scan_timeout, oldest_scan, position_tracking, heading_tracking });
        let goal = (given.take("goal")?, given.take("arrival_tolerance")?);
        given.done()?;
        let scanners = lidars.iter().map(|lidar| lidar.0.scanner()).collect();
        let robot = Robot::of(&robot.0, robot.1.as_deref(), period);
        let robot = robot.map_err(CoreError::from)?;
        let core = explore::Controller::new(robot, rollouts.0, trust, scanners, goal);
        Ok(Self(Stepped::new(core.map_err(CoreError::from)?, BUSY)))
    }

    /// Fields of what the robot is to do; `scans`: index of the lidar, instant and ranges of each.
    fn update<'py>(
        &self,
        py: Python<'py>,
        time: f64,
        pose: Option<Pose>,
        scans: Vec<(usize, f64, PyReadonlyArray1<'py, f64>)>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let told = scans.iter().map(|(lidar, time, ranges)| {
            Ok(TimedScan {
                lidar: *lidar,
                time: *time,
                heading: None,
                ranges: ranges.as_slice()?,
            })
        });
        let told: Vec<TimedScan<'_>> = told.collect::<PyResult<_>>()?;
        let order = self.0.work(py, |core, _| core.update(time, pose, &told))?;
        fields_of(py, &order)
    }

    /// Forgets everything, with another goal.
    fn restart(&self, goal: [f64; 2]) -> PyResult<()> {
        let found: Result<()> = self.0.idle()?.restart(goal);
        Ok(found.map_err(CoreError::from)?)
    }

    /// Lowest corner of the cells in m, and their kinds row by row: 0 unknown, 1 free, 2 occupied.
    fn cells<'py>(&self, py: Python<'py>) -> PyResult<([f64; 2], Bound<'py, PyArray2<u8>>)> {
        cells_of(py, self.0.idle()?.explorer())
    }

    /// Places of the plan from a place on.
    fn way(&self, place: [f64; 2]) -> PyResult<Vec<[f64; 2]>> {
        Ok(way_of(self.0.idle()?.explorer(), place))
    }
}

/// Cells of a rolling map.
type Cells<'py> = ([f64; 2], Bound<'py, PyArray2<u8>>);

/// Lowest corner of the cells in m, and their kinds row by row: 0 unknown, 1 free, 2 occupied.
pub fn cells_of<'py>(py: Python<'py>, explorer: &Explorer) -> PyResult<Cells<'py>> {
    let cells = explorer.cells();
    let size = cells.size();
    let kind = |row: usize, column: usize| match cells.kind(column, row) {
        Kind::Unknown => 0,
        Kind::Free => 1,
        Kind::Occupied => 2,
    };
    let kinds: Vec<u8> = (0..size * size)
        .map(|at| kind(at / size, at % size))
        .collect();
    let low = cells.low().map(|axis| axis as f64 * cells.cell());
    Ok((low, kinds.into_pyarray(py).reshape([size, size])?))
}

/// Places of the plan from a place on; none where it has no plan.
fn way_of(explorer: &Explorer, place: [f64; 2]) -> Vec<[f64; 2]> {
    let way = explorer.plan().map(|plan| plan.way(place.into()));
    let way = way.unwrap_or_default();
    way.into_iter().map(Into::into).collect()
}

/// Cells of the map that a law makes, side of a cell in m, and the way from a place on.
pub type Explored<'py> = ([f64; 2], Bound<'py, PyArray2<u8>>, f64, Vec<[f64; 2]>);

/// What a law knows of a place from scans.
pub fn explored<'py>(
    py: Python<'py>,
    explorer: Option<&Explorer>,
    place: [f64; 2],
) -> PyResult<Option<Explored<'py>>> {
    let Some(explorer) = explorer else {
        return Ok(None);
    };
    let (low, kinds) = cells_of(py, explorer)?;
    Ok(Some((
        low,
        kinds,
        explorer.cells().cell(),
        way_of(explorer, place),
    )))
}

fn word(status: Status) -> &'static str {
    match status {
        Status::Kept => "kept",
        Status::Changed => "changed",
        Status::Braking => "braking",
    }
}

fn fields_of<'py>(py: Python<'py>, order: &Order) -> PyResult<Bound<'py, PyDict>> {
    let doubts = order.doubts;
    let plan: Vec<_> = order
        .plan
        .iter()
        .map(|(time, twist)| (*time, (twist.speed, twist.turn_rate)))
        .collect();
    Ok(fields! { py;
        value speed = order.twist.speed;
        value turn_rate = order.twist.turn_rate;
        value status = word(order.status);
        value order: time_to_go, recovering, arrived, scan_age;
        value doubts: blind, forgotten, unknown_beams;
        value off_plan = doubts.off_plan.map(|[away, off]| (away, off));
        value clock_set_back = doubts.clock;
        value ignored_scans = doubts.ignored;
        value plan = plan;
    })
}
