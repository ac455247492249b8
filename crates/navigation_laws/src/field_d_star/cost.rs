//! Least costs through one cell with linear interpolation along the edge that is crossed.
//!
//! Lengths are in cells. The costs `c` and `b` are per length; infinite costs are allowed.

use std::f64::consts::SQRT_2;

/// Least cost from a corner of a cell to the goal through the triangle that it spans with a
/// neighbor `s1` along an axis and the neighbor `s2` across the cell.
///
/// `min over x, y in [0, 1] of b x + c sqrt((1 - x)^2 + y^2) + (1 - y) g1 + y g2`, Ferguson and
/// Stentz (2006): along the edge towards `s1`, whose other side costs `b`, then across the cell,
/// which costs `c`, to a point between `s1` and `s2`. The function is convex, its minimum lies
/// where the slopes below say. The published form compares `f` with `b` instead of
/// `sqrt(c^2 - b^2)`; the least of all triangles of a corner is the same.
#[inline]
#[must_use]
pub fn corner_cost(g1: f64, g2: f64, c: f64, b: f64) -> f64 {
    let along = c.min(b);
    if along == f64::INFINITY {
        return f64::INFINITY;
    }
    if g1 <= g2 {
        return along + g1;
    }
    if c == f64::INFINITY {
        return b + g1;
    }
    // Gain of a step along the crossed edge.
    let f = g1 - g2;
    if b < c {
        let r = (c * c - b * b).sqrt();
        if f <= r {
            return b + g1;
        }
        if r >= b {
            return b + r + g2;
        }
    }
    if f * SQRT_2 >= c {
        c * SQRT_2 + g2
    } else {
        (c * c - f * f).sqrt() + g1
    }
}

/// Least cost from a point at a distance `d > 0` from the line of an edge, its foot at `foot` on
/// that line, through a cell that costs `c`, and where on the edge it leaves, in [0, 1]:
/// `min over t of c sqrt(d^2 + (t - foot)^2) + (1 - t) g0 + t g1`.
#[inline]
#[must_use]
pub fn crossing(d: f64, foot: f64, ends: [f64; 2], c: f64) -> (f64, f64) {
    let [g0, g1] = ends;
    let at = |t: f64| c * d.hypot(t - foot);
    match (g0 < f64::INFINITY, g1 < f64::INFINITY) {
        (false, false) => (f64::INFINITY, 0.0),
        (true, false) => (at(0.0) + g0, 0.0),
        (false, true) => (at(1.0) + g1, 1.0),
        (true, true) => {
            let slope = g1 - g0;
            let steep = c * c - slope * slope;
            let t = if steep > 0.0 {
                (foot - slope * d / steep.sqrt()).clamp(0.0, 1.0)
            } else if slope > 0.0 {
                0.0
            } else {
                1.0
            };
            (at(t) + (1.0 - t) * g0 + t * g1, t)
        }
    }
}
