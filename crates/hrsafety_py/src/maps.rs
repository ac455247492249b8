//! Static maps, plans through them, and lidars among them.

use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;
use vff_core::laws::Stop;
use vff_core::laws::guide::{self, LocalGoal};
use vff_core::laws::safe::Plans;
use vff_core::sensing::lidar::{self, ScanNoise};
use vff_core::world::frame::Frame;
use vff_core::world::map::distance_transform::distances;
use vff_core::world::map::{self, GridPlace, MapShapes};
use vff_core::world::obstacle::PlacedShape;

use crate::errors::{CoreError, CoreResult};
use crate::keywords::{parameter_class, taken, value_class};
use crate::parameters::Scenario;
use crate::robots::footprint::{Footprint, each};
use crate::watch::{Report, watched};

type Rows<'py> = PyReadonlyArray2<'py, f64>;
type Cells<'py> = PyReadonlyArray2<'py, bool>;
type Column<'py> = Bound<'py, PyArray1<f64>>;
type Matrix<'py> = Bound<'py, PyArray2<f64>>;

/// Local goal: where it is, cost-to-go from it, whether it is the goal itself.
type Carrot = ([f64; 2], f64, bool);

/// Pairs of an array with two columns, which the caller has made contiguous.
fn pairs<'a>(rows: &'a Rows<'_>) -> PyResult<&'a [[f64; 2]]> {
    Ok(rows.as_slice()?.as_chunks::<2>().0)
}

/// A matrix with two columns.
fn two_columns(py: Python<'_>, points: impl Iterator<Item = [f64; 2]>) -> PyResult<Matrix<'_>> {
    let flat: Vec<f64> = points.flatten().collect();
    let rows = flat.len() / 2;
    flat.into_pyarray(py).reshape([rows, 2])
}

/// Map of everything that stands still, and the plans that were made in it: laws with the same map share them.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct StaticMap(pub map::StaticMap, pub Plans);

#[pymethods]
impl StaticMap {
    /// Polylines with radii, polygons, discs as rows (x, y, radius), grids with resolution, origin, yaw
    /// and whether nothing is known outside, all in the order given.
    #[new]
    #[pyo3(signature = (*, polylines, polygons, discs, grids))]
    fn new(
        py: Python<'_>,
        polylines: Vec<(Rows<'_>, f64)>,
        polygons: Vec<Rows<'_>>,
        discs: Rows<'_>,
        grids: Vec<(Cells<'_>, f64, [f64; 2], f64, bool)>,
    ) -> PyResult<Self> {
        let mut shapes = MapShapes::new();
        let owned = |kind: &str, index: usize| {
            let owner = format!("{kind}[{index}]");
            move |error: numeric::error::Failure| CoreError::from(error.within(&owner))
        };
        for (index, (points, radius)) in polylines.iter().enumerate() {
            let added = shapes.polyline(pairs(points)?, *radius);
            added.map_err(owned("polylines", index))?;
        }
        for (index, points) in polygons.iter().enumerate() {
            let added = shapes.polygon(pairs(points)?);
            added.map_err(owned("polygons", index))?;
        }
        let (rows, _) = discs.as_slice()?.as_chunks::<3>();
        for (index, [x, y, radius]) in rows.iter().enumerate() {
            let added = shapes.disc([*x, *y], *radius);
            added.map_err(owned("discs", index))?;
        }
        for (cells, resolution, origin, yaw, limits) in &grids {
            let columns = cells.as_array().ncols();
            let place = GridPlace {
                resolution: *resolution,
                origin: *origin,
                yaw: *yaw,
            };
            let cells = cells.as_slice()?;
            watched(py, Report::none(), |control| {
                let interrupted = || control.interrupted();
                if *limits {
                    shapes.limiting_grid(cells, columns, place, &interrupted)
                } else {
                    shapes.grid(cells, columns, place, &interrupted)
                }
            })?;
        }
        Ok(Self(py.detach(|| shapes.map()), Plans::default()))
    }

    /// Distances of points, zero inside.
    fn clearance<'py>(&self, py: Python<'py>, points: Rows<'py>) -> PyResult<Column<'py>> {
        let points = pairs(&points)?.iter();
        let distances: Vec<f64> = points
            .map(|point| self.0.clearance((*point).into()))
            .collect();
        Ok(distances.into_pyarray(py))
    }

    /// Least distance of the points of a segment.
    fn segment_clearance(&self, start: [f64; 2], end: [f64; 2]) -> f64 {
        self.0.segment_clearance(start.into(), end.into())
    }

    /// Nearest boundary points; NaN without shapes.
    fn nearest<'py>(&self, py: Python<'py>, points: Rows<'py>) -> PyResult<Matrix<'py>> {
        let nearest = |point: &[f64; 2]| {
            let found = self.0.nearest((*point).into());
            found.map_or([f64::NAN; 2], Into::into)
        };
        two_columns(py, pairs(&points)?.iter().map(nearest))
    }

    /// Distances along bearings, infinite where nothing is hit.
    fn ray(&self, start: [f64; 2], bearings: Vec<f64>) -> Vec<f64> {
        let cast = |bearing: f64| {
            let (sin, cos) = bearing.sin_cos();
            self.0.ray(start.into(), [cos, sin].into())
        };
        bearings.into_iter().map(cast).collect()
    }

    /// Boundary points that a law sees.
    fn boundary_points<'py>(
        &self,
        py: Python<'py>,
        position: [f64; 2],
        reach: f64,
        kappa: f64,
    ) -> PyResult<Matrix<'py>> {
        let kappa = map::checked_kappa(kappa).map_err(CoreError::from)?;
        let mut points = Vec::with_capacity(map::MOST_POINTS);
        let position = position.into();
        self.0.boundary_points(position, reach, kappa, &mut points);
        two_columns(py, points.into_iter())
    }

    /// Whether something is known of points.
    fn knows(&self, points: Rows<'_>) -> PyResult<Vec<bool>> {
        let points = pairs(&points)?.iter();
        Ok(points.map(|point| self.0.knows((*point).into())).collect())
    }

    /// A scenario in which the map stands, which laws are not told of.
    fn around(&self, scenario: &Scenario) -> Scenario {
        Scenario(scenario.0.clone().with_walls(self.0.clone()))
    }

    /// Ends and radii of the segments, a row each.
    fn segments<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        let capsules = self.0.capsules();
        let row = |capsule: &map::Capsule| {
            let (from, to) = (capsule.from, capsule.to);
            [from.x, from.y, to.x, to.y, capsule.radius]
        };
        let flat: Vec<f64> = capsules.iter().flat_map(row).collect();
        flat.into_pyarray(py).reshape([capsules.len(), 5])
    }

    /// Lower and upper corner of the box around everything.
    fn bounds(&self) -> Option<[[f64; 2]; 2]> {
        self.0.bounds().map(|corners| corners.map(Into::into))
    }

    /// Distances of a footprint at poses as rows (x, y, heading), zero where they meet.
    fn footprint_clearances<'py>(
        &self,
        py: Python<'py>,
        footprint: &Footprint,
        poses: Rows<'_>,
    ) -> PyResult<Column<'py>> {
        each(py, &poses, |[x, y, heading]: &[f64; 3]| {
            let pose = Frame::at([*x, *y], *heading);
            footprint.0.clearance(&pose, &self.0, f64::INFINITY)
        })
    }
}

/// Distances of cells of a side in m from the nearest occupied one.
#[pyfunction]
pub fn cell_distances<'py>(
    py: Python<'py>,
    occupied: Cells<'py>,
    resolution: f64,
) -> PyResult<Matrix<'py>> {
    let (rows, columns) = occupied.as_array().dim();
    let cells = occupied.as_slice()?;
    let found = watched(py, Report::none(), |control| {
        distances(cells, columns, resolution, &|| control.interrupted())
    })?;
    found.into_pyarray(py).reshape([rows, columns])
}

parameter_class! {
    /// Options of the guide.
    Guide(guide::Guide) { spacing, margin, look_ahead, bounds }

    /// Plan of a robot of a radius from everywhere to a goal.
    fn plan(
        &self,
        py: Python<'_>,
        map: &StaticMap,
        radius: f64,
        start: [f64; 2],
        goal: [f64; 2],
    ) -> PyResult<Plan> {
        let plan = watched(py, Report::none(), |control| {
            let stop = || control.interrupted();
            self.0.plan(&map.0, radius, [start, goal], Stop(&stop))
        })?;
        Ok(Plan(plan))
    }
}

/// Checks when a takeover begins.
#[pyfunction]
#[pyo3(signature = (progress, window))]
pub fn check_takeover(progress: Option<f64>, window: Option<f64>) -> CoreResult<()> {
    guide::TakeoverOptions { progress, window }.checked()?;
    Ok(())
}

/// Plan through a map.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct Plan(pub guide::Plan);

#[pymethods]
impl Plan {
    /// Costs at points, NaN without a plan there.
    fn cost<'py>(&self, py: Python<'py>, points: Rows<'py>) -> PyResult<Column<'py>> {
        let cost = |point: &[f64; 2]| self.0.cost((*point).into()).unwrap_or(f64::NAN);
        let costs: Vec<f64> = pairs(&points)?.iter().map(cost).collect();
        Ok(costs.into_pyarray(py))
    }

    /// Where a law should go from a position, `None` without a plan there.
    fn local_goal(&self, position: [f64; 2]) -> Option<Carrot> {
        let position = position.into();
        let view = self.0.view(position)?;
        let LocalGoal {
            point,
            cost_to_go,
            is_goal,
        } = self.0.local_goal(position, &view);
        Some((point.into(), cost_to_go, is_goal))
    }

    /// Points of the path from a position to the goal.
    fn path<'py>(&self, py: Python<'py>, position: [f64; 2]) -> PyResult<Matrix<'py>> {
        let path = self.0.path(position.into());
        two_columns(py, path.into_iter().map(Into::into))
    }
}

value_class! {
    /// Lidar on a robot.
    Lidar(lidar::Lidar) of given {
        let map: Option<PyRef<'_, StaticMap>> = given.take("map")?;
        let mounting = frame(given.take("mounting")?);
        taken!(given: lidar::Lidar {
            map = map.map(|map| map.0.clone()).unwrap_or_default(), beams, mounting = mounting, field_of_view, angle_min,
            range_min, range_max, range_noise, dropout, latency, sees_obstacles, kappa, influence, reach, max_speed,
        })
    }

    /// Bearings of the beams from straight ahead.
    fn bearings(&self) -> Vec<f64> {
        (0..self.0.beams).map(|beam| self.0.bearing(beam)).collect()
    }

    /// Ranges from a pose (x, y, heading) among discs as rows (x, y, radius).
    fn scan(&self, pose: [f64; 3], discs: Rows<'_>, seed: u64) -> PyResult<Vec<f64>> {
        let (rows, _) = discs.as_slice()?.as_chunks::<3>();
        let shapes: Vec<PlacedShape> = rows
            .iter()
            .map(|[x, y, radius]| PlacedShape::disc([*x, *y], *radius))
            .collect();
        let mut ranges = Vec::with_capacity(self.0.beams);
        let mut noise = ScanNoise::new(seed, 0);
        self.0.scan(&frame(pose), &shapes, &mut noise, &mut ranges);
        Ok(ranges)
    }

    /// Points that a scan hit.
    fn points<'py>(
        &self,
        py: Python<'py>,
        pose: [f64; 3],
        ranges: Vec<f64>,
    ) -> PyResult<Matrix<'py>> {
        let mut points = Vec::with_capacity(ranges.len());
        self.0.points(&frame(pose), &ranges, &mut points);
        two_columns(py, points.into_iter().map(Into::into))
    }

    /// Critical and active radius of a boundary point in a scenario.
    fn regions(&self, scenario: &Scenario) -> CoreResult<(f64, f64)> {
        let regions = self.0.regions(&scenario.0)?;
        Ok((regions.critical_radius, regions.active_radius))
    }
}

fn frame([x, y, heading]: [f64; 3]) -> Frame {
    Frame::at([x, y], heading)
}
