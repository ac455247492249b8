//! Cells around a corner, and the least cost between two corners.

use std::f64::consts::FRAC_1_SQRT_2;

/// A neighbor along an axis, one across a cell, that cell and the one on the other side of the
/// edge to the first: places relative to a node. A cell has the number of its lower left corner.
#[derive(Clone, Copy, Debug)]
pub(super) struct Triangle {
    pub(super) axis: isize,
    pub(super) diagonal: isize,
    pub(super) cell: isize,
    pub(super) beside: isize,
}

/// A neighbor and the two triangles of that neighbor that hold the node itself.
#[derive(Clone, Copy, Debug)]
pub(super) struct GridNeighbor {
    pub(super) step: isize,
    pub(super) triangles: [usize; 2],
}

/// Lower bound on the cost between corners that are so many cells apart along the axes:
/// `max/sqrt(2) + (1 - 1/sqrt(2)) min`.
///
/// A corner's cost exceeds that of a neighbor along an axis that it is interpolated from by as
/// little as `1/sqrt(2)`, and that of one across a cell by 1 at least. The bound changes by no
/// more than that from neighbor to neighbor, so the order of the queue is right; with the
/// distance itself corners would be expanded too late and costs would not be the least.
pub(super) fn bound(across: usize, along: usize) -> f64 {
    let (far, near) = (across.max(along) as f64, across.min(along) as f64);
    FRAC_1_SQRT_2 * far + (1.0 - FRAC_1_SQRT_2) * near
}

/// Triangles around a node, for rows of so many nodes.
pub(super) fn triangles(stride: usize) -> [Triangle; 8] {
    let up = stride.cast_signed();
    // Cells around a node: upper right, upper left, lower right, lower left.
    let (ur, ul, lr, ll) = (0, -1, -up, -up - 1);
    let triangle = |axis, diagonal, cell, beside| Triangle {
        axis,
        diagonal,
        cell,
        beside,
    };
    [
        triangle(1, up + 1, ur, lr),
        triangle(1, 1 - up, lr, ur),
        triangle(up, up + 1, ur, ul),
        triangle(up, up - 1, ul, ur),
        triangle(-1, up - 1, ul, ll),
        triangle(-1, -up - 1, ll, ul),
        triangle(-up, 1 - up, lr, ll),
        triangle(-up, -up - 1, ll, lr),
    ]
}

/// Neighbors of a node, counter-clockwise.
pub(super) fn neighbors(triangles: &[Triangle; 8]) -> [GridNeighbor; 8] {
    let up = triangles[2].axis;
    [1, up + 1, up, up - 1, -1, -up - 1, -up, 1 - up].map(|step| {
        let mut holders = [0; 2];
        let holding = (0..triangles.len()).filter(|&number| {
            let triangle = &triangles[number];
            triangle.axis == -step || triangle.diagonal == -step
        });
        for (holder, number) in holders.iter_mut().zip(holding) {
            *holder = number;
        }
        GridNeighbor {
            step,
            triangles: holders,
        }
    })
}
