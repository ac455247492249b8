//! Dijkstra's search from the goal over the cells of a window, a part of it in every control period.

use nalgebra::Vector2;
use numeric::error::{Result, not_negative, positive};

use super::buckets::Buckets;
use super::time_to_go::{NONE, TimeToGo};
use crate::map::Cells;

/// How far in cells a node may be that stands for a goal in an obstacle.
const AROUND_GOAL: i64 = 8;

/// Prices of a way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuideOptions {
    /// Distance in m beside the outline that a node has at least.
    pub clearance: f64,
    /// Price of places where the robot cannot turn.
    pub narrow_weight: f64,
    /// Price of places near to what stands, and up to which distance from the middle of the robot, in m.
    pub near_weight: f64,
    /// In m.
    pub near_distance: f64,
    /// Price of unknown ground.
    pub unknown_weight: f64,
    /// How much longer than to the robot the search continues, in s.
    pub beyond: f64,
}

impl Default for GuideOptions {
    fn default() -> Self {
        Self {
            clearance: 0.06,
            narrow_weight: 16.0,
            near_weight: 0.8,
            near_distance: 0.55,
            unknown_weight: 0.3,
            beyond: 0.8,
        }
    }
}

impl GuideOptions {
    /// Returns the options if they are allowed.
    ///
    /// # Errors
    /// Names the number that is not.
    pub fn checked(self) -> Result<Self> {
        not_negative("clearance", self.clearance)?;
        not_negative("narrow_weight", self.narrow_weight)?;
        not_negative("near_weight", self.near_weight)?;
        positive("near_distance", self.near_distance)?;
        not_negative("unknown_weight", self.unknown_weight)?;
        not_negative("beyond", self.beyond)?;
        Ok(self)
    }
}

/// A robot for which ways are searched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Size {
    /// Radius of the circle within its outline in m.
    pub inner: f64,
    /// Radius of the circle around it in m.
    pub outer: f64,
    /// Largest speed in m/s.
    pub max_speed: f64,
}

/// From a node to one of its neighbors.
#[derive(Clone, Copy, Debug)]
struct Link {
    step: i64,
    columns: i64,
    /// Half of the time at the largest speed in s.
    half: f32,
}

/// A node under search.
#[derive(Clone, Copy, Debug)]
struct Node {
    /// Least time found so far in s.
    time: f32,
    /// Its price, infinite where there is no node.
    cost: f32,
}

/// Nodes that a link crosses along an axis at most.
const STRIDE: usize = 2;

/// A search under way.
#[derive(Clone, Debug)]
pub struct Search {
    options: GuideOptions,
    size: Size,
    goal: Vector2<f64>,
    plan: TimeToGo,
    settled: Vec<u64>,
    nodes: Vec<Node>,
    queue: Buckets,
    links: Vec<Link>,
    /// Square of the distance of each node, and so many more if it is unknown.
    ground: Vec<i16>,
    unknown: i16,
    /// Which of the least distances is tried.
    attempt: usize,
    /// End of the search, once the robot was met.
    until: f32,
    running: bool,
}

/// How a search stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// It continues.
    Running,
    /// A way was found.
    Found,
    /// There is none.
    NoWay,
}

impl Search {
    /// A search for a robot over so many nodes, none under way.
    #[must_use]
    pub fn new(options: GuideOptions, size: Size, nodes: usize) -> Self {
        Self {
            options,
            size,
            goal: Vector2::zeros(),
            plan: TimeToGo::with_room(nodes),
            settled: Vec::new(),
            nodes: Vec::with_capacity(nodes),
            queue: Buckets::default(),
            links: Vec::new(),
            ground: vec![1; nodes],
            unknown: 0,
            attempt: 0,
            until: f32::INFINITY,
            running: false,
        }
    }

    /// Whether a search is under way.
    #[must_use]
    pub fn running(&self) -> bool {
        self.running
    }

    /// Ends the search that is under way.
    pub fn stop(&mut self) {
        self.running = false;
    }

    /// Least distances of nodes from occupied cells in m, one tried after the other.
    fn least_distances(&self) -> [f64; 5] {
        let inner = self.size.inner;
        [
            inner + self.options.clearance,
            inner + 0.4 * self.options.clearance,
            inner,
            0.84 * inner,
            0.465 * inner,
        ]
    }

    /// Starts a search over the cells as they are now.
    pub fn start(&mut self, cells: &Cells, goal: Vector2<f64>) {
        self.goal = goal;
        self.plan.size = cells.size();
        self.plan.cell = cells.cell();
        self.plan.low = cells.low();
        let (width, step) = (
            cells.size() as i64,
            (cells.cell() / self.size.max_speed) as f32,
        );
        self.links.clear();
        for (x, y) in [(1, 0), (1, 1), (2, 1), (1, 2)] {
            let time = ((x * x + y * y) as f32).sqrt() * step;
            for (x, y) in [(x, y), (-y, x), (-x, -y), (y, -x)] {
                self.links.push(Link {
                    step: x + y * width,
                    columns: x,
                    half: time * 0.5,
                });
            }
        }
        self.unknown = cells.farthest() + 1;
        self.ground.clear();
        self.ground.extend_from_slice(cells.squares());
        for (ground, known) in self.ground.chunks_mut(64).zip(cells.known()) {
            if known == 0 {
                for square in ground {
                    *square += self.unknown;
                }
            } else if known != u64::MAX {
                for (bit, square) in ground.iter_mut().enumerate() {
                    *square += self.unknown * i16::from(known >> bit & 1 == 0);
                }
            }
        }
        self.attempt = 0;
        self.running = true;
        self.begin();
    }

    /// Prices of all nodes for the least distance that is tried; what is nearer to an occupied cell is none.
    fn price(&mut self) {
        let (options, size, cell) = (self.options, self.size, self.plan.cell);
        let turning = size.outer + 0.03;
        let least = self.least_square();
        let factor = |square: i16| {
            if square < least {
                return f32::INFINITY;
            }
            let away = f64::from(square).sqrt() * cell;
            let narrow = ((turning - away) / (turning - size.inner)).max(0.0);
            let near = ((options.near_distance - away) / 0.3).max(0.0);
            (1.0 + options.narrow_weight * narrow + options.near_weight * near) as f32
        };
        let mut table: Vec<f32> = (0..self.unknown).map(factor).collect();
        let more = options.unknown_weight as f32;
        table.extend_from_within(..);
        for price in &mut table[self.unknown.unsigned_abs() as usize..] {
            *price += more;
        }
        self.nodes.clear();
        let priced = self.ground.iter();
        self.nodes.extend(priced.map(|ground| Node {
            time: f32::INFINITY,
            cost: table[ground.unsigned_abs() as usize],
        }));
    }

    /// Puts the goal into the queue, for the least distance that is tried.
    fn begin(&mut self) {
        self.price();
        let size = self.plan.size;
        self.plan.next.resize(size * size, NONE);
        self.settled.clear();
        self.settled.resize((size * size).div_ceil(64), 0);
        self.queue
            .restart((self.plan.cell / self.size.max_speed) as f32);
        self.until = f32::INFINITY;
        if let Some(node) = self.goal_node() {
            self.seed(node, 0.0);
        } else {
            let last = size - 1;
            for place in 0..size {
                for node in [
                    place,
                    last * size + place,
                    place * size,
                    place * size + last,
                ] {
                    if self.is_node(node) {
                        let away = (self.plan_middle(node) - self.goal).norm();
                        self.seed(node, (away / self.size.max_speed) as f32);
                    }
                }
            }
        }
    }

    fn seed(&mut self, node: usize, time: f32) {
        if time < self.nodes[node].time {
            self.nodes[node].time = time;
            self.plan.next[node] = index(node);
            self.queue.push(time, index(node));
        }
    }

    fn plan_middle(&self, node: usize) -> Vector2<f64> {
        let axis = |place: usize, low: i64| ((place as i64 + low) as f64 + 0.5) * self.plan.cell;
        let size = self.plan.size;
        Vector2::new(
            axis(node % size, self.plan.low[0]),
            axis(node / size, self.plan.low[1]),
        )
    }

    #[inline]
    fn is_node(&self, node: usize) -> bool {
        self.nodes[node].cost < f32::INFINITY
    }

    fn least_square(&self) -> i16 {
        let least = self.least_distances()[self.attempt] / self.plan.cell;
        ((least * least).ceil() as i16).max(1)
    }

    /// The node of the goal, or the nearest one; `None` where the goal is outside of the window.
    fn goal_node(&self) -> Option<usize> {
        let size = self.plan.size as i64;
        let cell = [0, 1].map(|axis: usize| {
            (self.goal[axis] / self.plan.cell).floor() as i64 - self.plan.low[axis]
        });
        if cell.iter().any(|axis| !(0..size).contains(axis)) {
            return None;
        }
        let mut nearest = None;
        for y in -AROUND_GOAL..=AROUND_GOAL {
            for x in -AROUND_GOAL..=AROUND_GOAL {
                let (column, row, away) = (cell[0] + x, cell[1] + y, x * x + y * y);
                if !(0..size).contains(&column) || !(0..size).contains(&row) {
                    continue;
                }
                let node = (row * size + column) as usize;
                let nearer = nearest.is_none_or(|(least, _)| away < least);
                if nearer && away <= AROUND_GOAL * AROUND_GOAL && self.is_node(node) {
                    nearest = Some((away, node));
                }
            }
        }
        // Without a node the search ends at once, and another distance is tried.
        Some(nearest.map_or((cell[1] * size + cell[0]) as usize, |(_, node)| node))
    }

    /// Goes on for at most so many nodes, towards a robot at a place.
    pub fn go_on(&mut self, place: Vector2<f64>, nodes: usize) -> Progress {
        let (size, mut left) = (self.plan.size, nodes);
        let Some(robot) = self.near(place) else {
            self.running = false;
            return Progress::NoWay;
        };
        let inner = STRIDE..size - STRIDE;
        loop {
            if left == 0 {
                return Progress::Running;
            }
            let Some(node) = self.queue.pop() else {
                if self.until.is_finite() {
                    break;
                }
                self.attempt += 1;
                if self.attempt == self.least_distances().len() {
                    self.running = false;
                    return Progress::NoWay;
                }
                self.begin();
                continue;
            };
            let node = node as usize;
            let (word, bit) = (node / 64, 1 << (node % 64));
            if self.settled[word] & bit != 0 {
                continue;
            }
            let Node { time, cost } = self.nodes[node];
            if time > self.until {
                break;
            }
            self.settled[word] |= bit;
            left -= 1;
            if self.until.is_infinite() && robot.contains(&node) {
                self.until = time + self.options.beyond as f32;
            }
            let column = node % size;
            let inside = inner.contains(&column) && inner.contains(&(node / size));
            for link in &self.links {
                let there = node as i64 + link.step;
                if !inside {
                    let beside = column as i64 + link.columns;
                    let nodes = 0..(size * size) as i64;
                    if !(0..size as i64).contains(&beside) || !nodes.contains(&there) {
                        continue;
                    }
                }
                let there = there as usize;
                let other = &mut self.nodes[there];
                let reached = time + link.half * (cost + other.cost);
                if reached < other.time {
                    other.time = reached;
                    self.plan.next[there] = index(node);
                    self.queue.push(reached, index(there));
                }
            }
        }
        self.running = false;
        Progress::Found
    }

    /// The nine nodes at a place.
    fn near(&self, place: Vector2<f64>) -> Option<[usize; 9]> {
        let size = self.plan.size;
        let cell = [0, 1]
            .map(|axis: usize| (place[axis] / self.plan.cell).floor() as i64 - self.plan.low[axis]);
        if cell.iter().any(|axis| !(1..size as i64 - 1).contains(axis)) {
            return None;
        }
        let middle = cell[1] as usize * size + cell[0] as usize;
        Some([0, 1, 2, 3, 4, 5, 6, 7, 8].map(|at| middle + (at / 3) * size + at % 3 - size - 1))
    }

    /// Gives what was found for what was found before, whose room it takes over.
    pub fn exchange(&mut self, plan: &mut TimeToGo) {
        self.plan.time.clear();
        for (nodes, settled) in self.nodes.chunks(64).zip(&self.settled) {
            let known = nodes.iter().enumerate();
            self.plan.time.extend(known.map(|(bit, node)| {
                if settled >> bit & 1 == 0 {
                    f32::INFINITY
                } else {
                    node.time
                }
            }));
        }
        self.plan.ahead.clear();
        self.plan.ahead.resize(self.plan.time.len(), NONE);
        std::mem::swap(&mut self.plan, plan);
    }
}

/// A node in 32 bits.
#[inline]
fn index(node: usize) -> u32 {
    node as u32
}
