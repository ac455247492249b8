//! Places that a robot has never seen: its map, a controller that is told scans, and whole episodes.

use numpy::{IntoPyArray, PyArray2, PyArrayMethods, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::error::Result;
use vff_core::robots::differential::DifferentialLimits;
use vff_core::unknown::explore::{
    self, ExplorerOptions, Order, Robot, Scanner, Status, TimedScan, Trust,
};
use vff_core::unknown::guide::GuideOptions;
use vff_core::unknown::map::{Kind, MapOptions};
use vff_core::unknown::trial::{Ended, Moment, Trial};

use crate::arrays::fields;
use crate::errors::CoreError;
use crate::keywords::{Keywords, parameter_class, taken, value_class};
use crate::maps::{Lidar, StaticMap};
use crate::robots::footprint::Footprint;
use crate::run::stepped::Stepped;
use crate::watch::{Report, here};

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

/// Largest speed, acceleration, deceleration, turn rate and its change.
type Limits = [f64; 5];

fn robot(
    footprint: &Footprint,
    [
        max_speed,
        max_acceleration,
        max_deceleration,
        max_turn_rate,
        change,
    ]: Limits,
    period: f64,
) -> Robot {
    Robot {
        footprint: footprint.0.clone(),
        limits: DifferentialLimits {
            max_speed,
            max_acceleration,
            max_deceleration,
            max_turn_rate,
            max_angular_acceleration: change,
        },
        period,
    }
}

/// A robot that is told poses and scans.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct ScanController(Stepped<explore::Controller>);

/// Position and heading.
type Pose = ([f64; 2], f64);

#[pymethods]
impl ScanController {
    #[new]
    #[pyo3(signature = (rollouts, footprint, limits, period, lidars, **given))]
    fn new(
        rollouts: &ArcRollouts,
        footprint: &Footprint,
        limits: Limits,
        period: f64,
        lidars: Vec<PyRef<'_, Lidar>>,
        given: Option<Keywords<'_>>,
    ) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let trust =
            taken!(given: Trust { scan_timeout, oldest_scan, position_tracking, heading_tracking });
        let goal = (given.take("goal")?, given.take("arrival_tolerance")?);
        given.done()?;
        let scanner = |lidar: &PyRef<'_, Lidar>| Scanner {
            mounting: lidar.0.mounting,
            bearings: (0..lidar.0.beams)
                .map(|beam| lidar.0.bearing(beam))
                .collect(),
            range_min: lidar.0.range_min,
            range_max: lidar.0.range_max,
        };
        let scanners = lidars.iter().map(scanner).collect();
        let robot = robot(footprint, limits, period);
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
        let core = self.0.idle()?;
        let cells = core.explorer().cells();
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

    /// Places of the plan from a place on.
    fn way(&self, place: [f64; 2]) -> PyResult<Vec<[f64; 2]>> {
        let core = self.0.idle()?;
        let way = core.explorer().plan().map(|plan| plan.way(place.into()));
        Ok(way
            .unwrap_or_default()
            .into_iter()
            .map(Into::into)
            .collect())
    }
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

/// Outcome of an episode in a place that the robot does not know.
#[pyfunction]
#[pyo3(signature = (rollouts, footprint, limits, period, place, **given))]
pub fn unknown_trial<'py>(
    py: Python<'py>,
    rollouts: &ArcRollouts,
    footprint: &Footprint,
    limits: Limits,
    period: f64,
    place: &StaticMap,
    given: Option<Keywords<'py>>,
) -> PyResult<Bound<'py, PyDict>> {
    let given = given.unwrap_or_default();
    let timed: bool = given.take("timed")?;
    let lidar: PyRef<'_, Lidar> = given.take("lidar")?;
    let trial = taken!(given: Trial {
        robot = robot(footprint, limits, period), options = rollouts.0, place = place.0.clone(), start, heading, goal,
        tolerance as arrival_tolerance, time_limit, lidar = lidar.0.clone(), length_drift, heading_drift, late, seed,
    });
    given.done()?;
    let (outcome, times) = here(py, Report::none(), |_| {
        let (mut begun, mut times) = (std::time::Instant::now(), Vec::new());
        let outcome = trial.run(&mut |moment| match moment {
            Moment::Scanned if timed => begun = std::time::Instant::now(),
            Moment::Decided { .. } if timed => times.push(begun.elapsed().as_secs_f64()),
            _ => {}
        })?;
        Ok::<_, numeric::error::Failure>((outcome, times))
    })?;
    let ended = match outcome.ended {
        Ended::Arrived => "arrived",
        Ended::Collided => "collided",
        Ended::TimedOut => "timed_out",
    };
    let rows = outcome.poses.len();
    let poses: Vec<f64> = outcome.poses.into_iter().flatten().collect();
    Ok(fields! { py;
        value outcome = ended;
        value arrival_time = outcome.time;
        value end_time = outcome.end_time;
        value clearance = outcome.clearance;
        value path_length = outcome.path;
        value recoveries = outcome.recoveries;
        value braking = outcome.braking;
        array [rows, 3] poses = poses;
        vector decision_times = times;
    })
}
