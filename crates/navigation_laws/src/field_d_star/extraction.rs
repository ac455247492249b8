//! A path over the grid from the costs of its corners.

use super::cost::crossing;
use super::search::IncrementalSearch;
use crate::planning::grid::whole;

/// A point closer to a corner or an edge of cells than this is on it, in cells.
const SNAP: f64 = 1e-9;

/// A point of a path and the cost from there.
type Reached = ([f64; 2], f64);

/// Path from a point, in cells, to the goal or until it is `enough` cells long; each leg stays
/// within one free cell. The cost of a crossing point on an edge is looked up one step ahead of
/// it, Ferguson and Stentz (2006): between corners whose ways part, interpolation is wrong. Costs
/// fall from point to point; where none does the path ends before the goal. `false` then.
pub fn extract(
    search: &IncrementalSearch,
    from: [f64; 2],
    enough: f64,
    path: &mut Vec<[f64; 2]>,
) -> bool {
    let goal = search.goal().map(|place| place as f64);
    let mut at = from.map(snapped);
    path.push(at);
    let mut left = enough;
    let mut cost = f64::INFINITY;
    while at != goal && left > 0.0 {
        let Some((next, value)) = next_point(search, at, cost) else {
            return false;
        };
        left -= (next[0] - at[0]).hypot(next[1] - at[1]);
        path.push(next);
        (at, cost) = (next, value);
    }
    true
}

/// The best point on the border of the cells around a point.
fn next_point(search: &IncrementalSearch, from: [f64; 2], below: f64) -> Option<Reached> {
    let mut best: Option<(f64, Reached)> = None;
    for_cells(from, |cell| {
        let c = search.cell_cost(cell);
        if c == f64::INFINITY {
            return;
        }
        let mut consider = |point: [f64; 2], value: f64| {
            let way = (point[0] - from[0]).hypot(point[1] - from[1]);
            let total = c * way + value;
            let known = best.map_or(f64::INFINITY, |(known, _)| known);
            if way > 0.0 && value < below && total < known {
                best = Some((total, (point, value)));
            }
        };
        for corner in corners(cell) {
            consider(corner, corner_value(search, corner));
        }
        for edge in edges(cell) {
            if let Some((_, t)) = edge.leave(search, from, c)
                && t > SNAP
                && t < 1.0 - SNAP
            {
                let point = edge.point(t);
                consider(point, value_ahead(search, point));
            }
        }
    });
    best.map(|(_, reached)| reached)
}

/// Cost from a point on an edge, through the cells on both sides of it.
fn value_ahead(search: &IncrementalSearch, from: [f64; 2]) -> f64 {
    let mut best = f64::INFINITY;
    for_cells(from, |cell| {
        let c = search.cell_cost(cell);
        if c == f64::INFINITY {
            return;
        }
        for edge in edges(cell) {
            if let Some((cost, _)) = edge.leave(search, from, c) {
                best = best.min(cost);
            }
        }
        for corner in corners(cell) {
            let way = (corner[0] - from[0]).hypot(corner[1] - from[1]);
            best = best.min(c * way + corner_value(search, corner));
        }
    });
    best
}

/// An edge of a cell: its first corner and the axis along which it runs.
#[derive(Clone, Copy, Debug)]
struct Edge {
    first: [f64; 2],
    axis: usize,
}

impl Edge {
    fn point(self, t: f64) -> [f64; 2] {
        let mut point = self.first;
        point[self.axis] += t;
        point
    }

    /// Least cost from a point beside the edge, and where on the edge it leaves the cell.
    fn leave(self, search: &IncrementalSearch, from: [f64; 2], c: f64) -> Option<(f64, f64)> {
        let beside = (from[1 - self.axis] - self.first[1 - self.axis]).abs();
        if beside == 0.0 {
            return None;
        }
        let ends = [0.0, 1.0].map(|t| corner_value(search, self.point(t)));
        let foot = from[self.axis] - self.first[self.axis];
        Some(crossing(beside, foot, ends, c))
    }
}

fn edges(cell: [isize; 2]) -> [Edge; 4] {
    let [left, low] = cell.map(|number| number as f64);
    let edge = |first, axis| Edge { first, axis };
    [
        edge([left, low], 0),
        edge([left, low + 1.0], 0),
        edge([left, low], 1),
        edge([left + 1.0, low], 1),
    ]
}

fn corners(cell: [isize; 2]) -> [[f64; 2]; 4] {
    let [left, low] = cell.map(|number| number as f64);
    [
        [left, low],
        [left + 1.0, low],
        [left, low + 1.0],
        [left + 1.0, low + 1.0],
    ]
}

fn corner_value(search: &IncrementalSearch, corner: [f64; 2]) -> f64 {
    search.cost(corner.map(|number| whole(number, usize::MAX)))
}

/// Calls with the cells that a point lies in or on the border of.
fn for_cells(point: [f64; 2], mut each: impl FnMut([isize; 2])) {
    let along = point.map(|number| {
        let low = number.floor();
        let first = if low == number { low - 1.0 } else { low };
        (floor_cell(first), floor_cell(low))
    });
    for column in along[0].0..=along[0].1 {
        for row in along[1].0..=along[1].1 {
            each([column, row]);
        }
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "points lie on the grid or one cell beside it"
)]
fn floor_cell(number: f64) -> isize {
    number as isize
}

fn snapped(number: f64) -> f64 {
    let near = number.round();
    if (number - near).abs() <= SNAP {
        near
    } else {
        number
    }
}
