//! Convex outline of a robot: distances, swept distances, room ahead.

use nalgebra::Vector2;
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use vff_core::world::footprint::{self, Arc};

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
        each(py, &points, |[x, y]: &[f64; 2]| {
            self.0.swept_point(Vector2::new(*x, *y), arc)
        })
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

/// A number for each row, which the caller has made contiguous.
fn each<'py, const N: usize>(
    py: Python<'py>,
    rows: &Rows<'_>,
    of: impl Fn(&[f64; N]) -> f64 + Send,
) -> PyResult<Column<'py>> {
    let rows = rows.as_slice()?.as_chunks::<N>().0;
    let found: Vec<f64> = py.detach(|| rows.iter().map(of).collect());
    Ok(found.into_pyarray(py))
}
