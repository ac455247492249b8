//! Costs to the goal from the corners of cells, repaired where cells changed.

use super::cost::corner_cost;
use super::queue::{Key, Queue};
use super::surroundings::{GridNeighbor, Triangle, bound, neighbors, triangles};
use crate::Stop;
use numeric::error::{Failure, Given, Result};

/// Nodes that are expanded between two looks at whether to stop.
const EXPANSIONS_PER_LOOK: u64 = 4096;

/// Rings of blocked cells around the grid, so that every neighbor exists.
const RINGS: usize = 2;

/// Value of a node.
#[derive(Clone, Copy, Debug)]
struct NodeValue {
    /// Cost to the goal when last expanded.
    cost: f64,
    /// Cost to the goal from the costs of its neighbors.
    lookahead: f64,
    /// Triangle that the latter comes from.
    triangle: usize,
}

/// Field D* of Ferguson and Stentz (2006): the incremental search of D* Lite (Koenig and
/// Likhachev 2002) on the corners of cells, with costs interpolated along the edges of cells.
///
/// The robot may be anywhere in its cell: the search ends when the costs of all four corners of
/// that cell are final. Free cells cost 1 or more per length of a cell.
#[derive(Clone, Debug)]
pub struct IncrementalSearch {
    columns: usize,
    rows: usize,
    stride: usize,
    triangles: [Triangle; 8],
    neighbors: [GridNeighbor; 8],
    cell_costs: Vec<f64>,
    nodes: Vec<NodeValue>,
    queue: Queue,
    goal: usize,
    /// Cell of the robot.
    start: [usize; 2],
    /// By how much the lower bounds of earlier keys may be too large, `k_m`.
    moved: f64,
    /// Corners of cells that changed since the last repair.
    dirty: Vec<usize>,
    is_dirty: Vec<bool>,
    expansions: u64,
}

impl IncrementalSearch {
    /// A grid of free cells; the goal is a corner of cells, the start a cell.
    ///
    /// # Errors
    /// There is no such corner or cell.
    pub fn new([columns, rows]: [usize; 2], goal: [usize; 2], start: [usize; 2]) -> Result<Self> {
        if goal[0] > columns || goal[1] > rows {
            return Err(outside("goal", goal));
        }
        let stride = columns + 1 + 2 * RINGS;
        let count = stride * (rows + 1 + 2 * RINGS);
        let triangles = triangles(stride);
        let unknown = NodeValue {
            cost: f64::INFINITY,
            lookahead: f64::INFINITY,
            triangle: 0,
        };
        let mut search = Self {
            columns,
            rows,
            stride,
            triangles,
            neighbors: neighbors(&triangles),
            cell_costs: vec![f64::INFINITY; count],
            nodes: vec![unknown; count],
            queue: Queue::new(count),
            goal: 0,
            start: [0; 2],
            moved: 0.0,
            dirty: Vec::new(),
            is_dirty: vec![false; count],
            expansions: 0,
        };
        for row in 0..rows {
            let first = search.place([0, row]);
            search.cell_costs[first..first + columns].fill(1.0);
        }
        search.goal = search.place(goal);
        search.check_cell("start", start)?;
        search.start = start;
        search.nodes[search.goal].lookahead = 0.0;
        let key = search.key(search.goal);
        search.queue.set(search.goal, key);
        Ok(search)
    }

    /// Changes what a cell costs per length of a cell; an infinite cost blocks it.
    ///
    /// # Errors
    /// There is no such cell, or the cost is below 1.
    pub fn set_cost(&mut self, cell: [usize; 2], cost: f64) -> Result<()> {
        self.check_cell("cell", cell)?;
        if cost.is_nan() || cost < 1.0 {
            let given = Given::Number(cost);
            return Err(Failure::invalid("cost", "be at least 1", given));
        }
        self.change(cell, cost);
        Ok(())
    }

    /// Blocks a cell, or makes it free at a cost of 1.
    pub(super) fn set_blocked(&mut self, cell: [usize; 2], blocked: bool) {
        self.change(cell, if blocked { f64::INFINITY } else { 1.0 });
    }

    fn change(&mut self, cell: [usize; 2], cost: f64) {
        let place = self.place(cell);
        if self.cell_costs[place] == cost {
            return;
        }
        self.cell_costs[place] = cost;
        for corner in [
            place,
            place + 1,
            place + self.stride,
            place + self.stride + 1,
        ] {
            if !self.is_dirty[corner] {
                self.is_dirty[corner] = true;
                self.dirty.push(corner);
            }
        }
    }

    /// The robot is in another cell.
    ///
    /// # Errors
    /// There is no such cell.
    pub fn move_start(&mut self, cell: [usize; 2]) -> Result<()> {
        self.check_cell("start", cell)?;
        self.go_to(cell);
        Ok(())
    }

    pub(super) fn go_to(&mut self, cell: [usize; 2]) {
        let away = |i: usize| self.start[i].abs_diff(cell[i]);
        self.moved += bound(away(0), away(1));
        self.start = cell;
    }

    /// Makes the costs of the corners of the robot's cell final.
    pub fn repair(&mut self) {
        self.repair_until(Stop::never());
    }

    /// Repairs like [`Self::repair`], until told to stop; the costs are not final then.
    pub(super) fn repair_until(&mut self, stop: Stop<'_>) {
        let mut dirty = std::mem::take(&mut self.dirty);
        for &node in &dirty {
            self.is_dirty[node] = false;
            self.look_again(node);
        }
        dirty.clear();
        self.dirty = dirty;
        while let Some((key, node)) = self.queue.first() {
            if !self.start_waits_for(key) {
                break;
            }
            let now = self.key(node);
            if key < now {
                self.queue.set(node, now);
                continue;
            }
            self.expansions += 1;
            if self.expansions.is_multiple_of(EXPANSIONS_PER_LOOK) && stop.asked() {
                break;
            }
            if self.nodes[node].cost > self.nodes[node].lookahead {
                self.lower(node);
            } else {
                self.raise(node);
            }
        }
    }

    /// Cost to the goal from a corner of cells, in lengths of a cell; final for the corners of
    /// the robot's cell, infinite where there is no way.
    #[must_use]
    pub fn cost(&self, corner: [usize; 2]) -> f64 {
        self.nodes[self.place(corner)].cost
    }

    /// Costs of the corners of the robot's cell: lower left, lower right, upper left, upper right.
    #[must_use]
    pub fn start_costs(&self) -> [f64; 4] {
        self.start_corners().map(|node| self.nodes[node].cost)
    }

    /// Number of nodes expanded so far.
    #[must_use]
    pub fn expansions(&self) -> u64 {
        self.expansions
    }

    /// Corner of cells that is the goal.
    #[must_use]
    pub fn goal(&self) -> [usize; 2] {
        let [x, y] = [self.goal % self.stride, self.goal / self.stride];
        [x - RINGS, y - RINGS]
    }

    /// Cell of the robot.
    #[must_use]
    pub fn start(&self) -> [usize; 2] {
        self.start
    }

    /// Cost of a cell; infinite outside the grid. Numbers count from the first cell.
    pub(super) fn cell_cost(&self, cell: [isize; 2]) -> f64 {
        let place = |i: usize, count: usize| {
            let inside = usize::try_from(cell[i]).ok();
            inside.filter(|&number| number < count)
        };
        match (place(0, self.columns), place(1, self.rows)) {
            (Some(column), Some(row)) => self.cell_costs[self.place([column, row])],
            _ => f64::INFINITY,
        }
    }

    fn check_cell(&self, name: &str, cell: [usize; 2]) -> Result<()> {
        if cell[0] < self.columns && cell[1] < self.rows {
            Ok(())
        } else {
            Err(outside(name, cell))
        }
    }

    fn place(&self, [column, row]: [usize; 2]) -> usize {
        (row + RINGS) * self.stride + column + RINGS
    }

    fn start_corners(&self) -> [usize; 4] {
        let first = self.place(self.start);
        [
            first,
            first + 1,
            first + self.stride,
            first + self.stride + 1,
        ]
    }

    /// Whether a node with this key can still change the cost of a corner of the robot's cell.
    fn start_waits_for(&self, key: Key) -> bool {
        self.start_corners().into_iter().any(|corner| {
            let node = &self.nodes[corner];
            node.cost != node.lookahead || key < self.key(corner)
        })
    }

    fn key(&self, node: usize) -> Key {
        let NodeValue {
            cost, lookahead, ..
        } = self.nodes[node];
        let least = cost.min(lookahead);
        let from = |place: usize, i: usize| {
            let place = place - RINGS;
            let start = self.start[i];
            if place < start {
                start - place
            } else {
                place.saturating_sub(start + 1)
            }
        };
        let ahead = bound(from(node % self.stride, 0), from(node / self.stride, 1));
        (least + ahead + self.moved, least)
    }

    /// Cost of a node through one of its triangles.
    #[inline]
    fn through(&self, node: usize, triangle: usize) -> f64 {
        let Triangle {
            axis,
            diagonal,
            cell,
            beside,
        } = self.triangles[triangle];
        let at = |step: isize| node.wrapping_add_signed(step);
        corner_cost(
            self.nodes[at(axis)].cost,
            self.nodes[at(diagonal)].cost,
            self.cell_costs[at(cell)],
            self.cell_costs[at(beside)],
        )
    }

    /// Finds the lookahead cost of a node anew.
    fn look_again(&mut self, node: usize) {
        if node == self.goal {
            return;
        }
        let mut best = (f64::INFINITY, 0);
        for triangle in 0..self.triangles.len() {
            let cost = self.through(node, triangle);
            if cost < best.0 {
                best = (cost, triangle);
            }
        }
        (self.nodes[node].lookahead, self.nodes[node].triangle) = best;
        self.file(node);
    }

    /// Puts a node into the queue or takes it out.
    fn file(&mut self, node: usize) {
        if self.nodes[node].cost == self.nodes[node].lookahead {
            self.queue.remove(node);
        } else {
            let key = self.key(node);
            self.queue.set(node, key);
        }
    }

    /// A node has become cheaper.
    fn lower(&mut self, node: usize) {
        self.nodes[node].cost = self.nodes[node].lookahead;
        self.queue.remove(node);
        for GridNeighbor { step, triangles } in self.neighbors {
            let other = node.wrapping_add_signed(step);
            let mut cheaper = false;
            for triangle in triangles {
                let cost = self.through(other, triangle);
                if cost < self.nodes[other].lookahead && other != self.goal {
                    self.nodes[other].lookahead = cost;
                    self.nodes[other].triangle = triangle;
                    cheaper = true;
                }
            }
            if cheaper {
                self.file(other);
            }
        }
    }

    /// A node has become more expensive: those that relied on it look again.
    fn raise(&mut self, node: usize) {
        self.nodes[node].cost = f64::INFINITY;
        for GridNeighbor { step, triangles } in self.neighbors {
            let other = node.wrapping_add_signed(step);
            if triangles.contains(&self.nodes[other].triangle)
                && self.nodes[other].lookahead < f64::INFINITY
            {
                self.look_again(other);
            }
        }
        self.file(node);
    }
}

fn outside(name: &str, place: [usize; 2]) -> Failure {
    let given = Given::Pair(place.map(|number| number as f64));
    Failure::invalid(name, "lie on the grid", given)
}
