//! Convex outline of a robot: distances, swept distances, room ahead.

use nalgebra::Vector2;
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use vff_core::world::footprint::{self, Arc, PassingWay};
use vff_core::world::shape::Shape;

use crate::errors::CoreError;

type Rows<'py> = PyReadonlyArray2<'py, f64>;
type Column<'py> = Bound<'py, PyArray1<f64>>;

/// Convex outline of a robot.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct Footprint(pub footprint::Footprint);

#[pymethods]
impl Footprint {
    /// Outline of corners as rows (x, y).
    #[new]
    fn new(corners: Rows<'_>) -> PyResult<Self> {
        let core = footprint::Footprint::polygon(corners.as_slice()?.as_chunks::<2>().0);
        Ok(Self(core.map_err(CoreError::from)?))
    }

    /// Corners counterclockwise, outer and inner radius.
    fn facts(&self) -> (Vec<(f64, f64)>, f64, f64) {
        let corners = self.0.corners().iter().map(|corner| (corner.x, corner.y));
        (
            corners.collect(),
            self.0.outer_radius(),
            self.0.inner_radius(),
        )
    }

    /// Signed distances of points as rows (x, y).
    fn distances<'py>(&self, py: Python<'py>, points: Rows<'_>) -> PyResult<Column<'py>> {
        each(py, &points, |[x, y]: &[f64; 2]| {
            self.0.signed_distance(Vector2::new(*x, *y))
        })
    }

    /// Distances of points as rows (x, y) from the outline on an arc (distance, angle).
    fn swept_points<'py>(
        &self,
        py: Python<'py>,
        points: Rows<'_>,
        arc: (f64, f64),
    ) -> PyResult<Column<'py>> {
        let arc = Arc {
            distance: arc.0,
            angle: arc.1,
        };
        let places = points.as_slice()?.as_chunks::<2>().0;
        Ok(self.0.swept_points(places, arc).into_pyarray(py))
    }

    /// Distances of segments as rows (x, y, x, y) from the outline on an arc (distance, angle).
    fn swept_segments<'py>(
        &self,
        py: Python<'py>,
        segments: Rows<'_>,
        arc: (f64, f64),
    ) -> PyResult<Column<'py>> {
        let arc = Arc {
            distance: arc.0,
            angle: arc.1,
        };
        each(py, &segments, |[x0, y0, x1, y1]: &[f64; 4]| {
            self.0
                .swept_segment([Vector2::new(*x0, *y0), Vector2::new(*x1, *y1)], arc)
        })
    }

    /// Least distances of discs in steps, as rows: offset from the robot at both ends (x, y, x, y), headings at both ends,
    /// radius.
    fn least_in_steps<'py>(&self, py: Python<'py>, steps: Rows<'_>) -> PyResult<Column<'py>> {
        each(py, &steps, |row: &[f64; 7]| passing(row).least(&self.0))
    }

    /// Contact in a step, given as a row of `least_in_steps`, of a robot with a velocity in a time: shares, whether the
    /// bodies overlap by a depth, and speeds of the touching points with their parts toward the disc.
    fn contact_in_step(
        &self,
        step: [f64; 7],
        velocity: [f64; 2],
        duration: f64,
        depth: f64,
    ) -> Option<([f64; 2], bool, [[f64; 2]; 2])> {
        let found = passing(&step).contact(&self.0, (velocity.into(), duration), depth)?;
        Some((found.shares, found.deep, found.speeds))
    }

    /// Distances of points as rows (x, y) from the room ahead of the part that moves outward.
    fn room_ahead_distances<'py>(
        &self,
        py: Python<'py>,
        points: Rows<'_>,
        twist: [f64; 2],
        depth: f64,
    ) -> PyResult<Column<'py>> {
        each(py, &points, |[x, y]: &[f64; 2]| {
            self.0
                .distance_from_room_ahead(Vector2::new(*x, *y), twist, depth)
        })
    }
}

fn passing(row: &[f64; 7]) -> PassingWay {
    let [x0, y0, x1, y1, first, last, radius] = *row;
    PassingWay {
        offsets: [Vector2::new(x0, y0), Vector2::new(x1, y1)],
        headings: [first, last],
        shape: Shape::Disc { radius },
    }
}

/// A number for each row, which the caller has made contiguous.
pub(crate) fn each<'py, const N: usize>(
    py: Python<'py>,
    rows: &Rows<'_>,
    of: impl Fn(&[f64; N]) -> f64 + Send,
) -> PyResult<Column<'py>> {
    let rows = rows.as_slice()?.as_chunks::<N>().0;
    let found: Vec<f64> = py.detach(|| rows.iter().map(of).collect());
    Ok(found.into_pyarray(py))
}
