//! When somebody who is not tracked can be in a cell.

use nalgebra::Vector2;
use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};

use super::Belief;

/// Ways along 16 neighbors are at most this much longer than straight ones.
const DETOUR: f64 = 1.0275;

/// Length of a knight's link in cells.
const KNIGHT: f64 = 2.236_067_977_499_79;

/// Links to 16 neighbors with their lengths in cells.
const LINKS: [([i64; 2], f64); 16] = [
    ([1, 0], 1.0),
    ([0, 1], 1.0),
    ([-1, 0], 1.0),
    ([0, -1], 1.0),
    ([1, 1], SQRT_2),
    ([-1, 1], SQRT_2),
    ([-1, -1], SQRT_2),
    ([1, -1], SQRT_2),
    ([2, 1], KNIGHT),
    ([1, 2], KNIGHT),
    ([-1, 2], KNIGHT),
    ([-2, 1], KNIGHT),
    ([-2, -1], KNIGHT),
    ([-1, -2], KNIGHT),
    ([1, -2], KNIGHT),
    ([2, -1], KNIGHT),
];

/// Cells along a side of a block.
const BLOCK: usize = 8;

/// Lower bounds of the time after the latest scan at which somebody who is not tracked can be in the cells of a window.
#[derive(Clone, Debug, Default)]
pub struct Arrivals {
    /// Column and row of the first cell of the window.
    first: [usize; 2],
    /// Columns and rows of the window.
    size: [usize; 2],
    /// Lower corner of the window in m, and side of a cell.
    lower: Vector2<f64>,
    cell: f64,
    /// In s, infinite where nobody comes in time.
    times: Vec<f64>,
    /// The least of them in blocks of cells.
    blocks: Vec<f64>,
    /// Length of the shortest way from the belief in cells.
    ways: Vec<f64>,
    queue: Vec<Vec<u32>>,
}

impl Arrivals {
    /// Brings them to a belief: in the window of cells within `reach` m of a place along each axis, for people of a
    /// speed in m/s, along ways in free space no longer than `longest` m.
    pub fn find(
        &mut self,
        belief: &Belief,
        place: Vector2<f64>,
        [reach, longest]: [f64; 2],
        speed: f64,
    ) {
        self.place_window(belief, place, reach);
        self.seed(belief);
        let cell = self.cell;
        self.search(belief, longest / cell);
        let (eta, half) = (belief.eta(), cell * FRAC_1_SQRT_2);
        self.times.clear();
        self.times.extend(self.ways.iter().map(|way| {
            let left = way * cell / DETOUR - eta - half;
            if left.is_infinite() {
                f64::INFINITY
            } else if speed > 0.0 {
                left / speed
            } else if left <= 0.0 {
                0.0
            } else {
                f64::INFINITY
            }
        }));
        self.fill_blocks();
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // within the grid
    fn place_window(&mut self, belief: &Belief, place: Vector2<f64>, reach: f64) {
        let ground = belief.ground();
        let middle = ground.in_cells(place);
        let wide = reach / ground.cell();
        let whole = ground.size();
        let span = [0, 1].map(|axis: usize| {
            let first = (middle[axis] - wide).floor().max(0.0) as usize;
            let beyond = (middle[axis] + wide).ceil().max(0.0) as usize;
            let beyond = beyond.min(whole[axis]);
            [first.min(beyond), beyond]
        });
        self.first = span.map(|[first, _]| first);
        self.size = span.map(|[first, beyond]| beyond - first);
        self.cell = ground.cell();
        let corner = Vector2::new(self.first[0] as f64, self.first[1] as f64);
        self.lower = ground.lower() + corner * self.cell;
    }

    /// All cells of the belief are at no way; those with a walkable neighbor beside the belief begin the search.
    #[allow(clippy::cast_possible_truncation)] // cells of a window
    fn seed(&mut self, belief: &Belief) {
        let (cells, ground) = (belief.cells(), belief.ground());
        let [columns, rows] = self.size;
        self.ways.clear();
        self.ways.resize(columns * rows, f64::INFINITY);
        for bucket in &mut self.queue {
            bucket.clear();
        }
        if self.queue.is_empty() {
            self.queue.push(Vec::new());
        }
        for row in 0..rows {
            for column in 0..columns {
                let place = [self.first[0] + column, self.first[1] + row];
                if !cells.contains(place) {
                    continue;
                }
                let index = row * columns + column;
                self.ways[index] = 0.0;
                let leaves = LINKS[..8].iter().any(|([x, y], _)| {
                    let beside = [place[0] as i64 + x, place[1] as i64 + y];
                    let open = |near| ground.walkable().contains(near) && !cells.contains(near);
                    ground.cell_at(beside).is_some_and(open)
                });
                if leaves {
                    self.queue[0].push(index as u32);
                }
            }
        }
    }

    /// Dijkstra's algorithm with a bucket for each whole length: no link is shorter than 1.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // bounded by the window
    fn search(&mut self, belief: &Belief, longest: f64) {
        let walkable = belief.ground().walkable();
        let [columns, rows] = self.size.map(|count| count as i64);
        let open = |[column, row]: [i64; 2]| {
            let inside = column >= 0 && row >= 0 && column < columns && row < rows;
            inside
                && walkable.contains([
                    self.first[0] + column as usize,
                    self.first[1] + row as usize,
                ])
        };
        let mut level = 0;
        while level < self.queue.len() {
            let bucket = std::mem::take(&mut self.queue[level]);
            for index in &bucket {
                let way = self.ways[*index as usize];
                if way < level as f64 {
                    continue;
                }
                let here = [i64::from(*index) % columns, i64::from(*index) / columns];
                for ([x, y], length) in LINKS {
                    let there = [here[0] + x, here[1] + y];
                    let total = way + length;
                    if total > longest || !open(there) {
                        continue;
                    }
                    let place = (there[1] * columns + there[0]) as usize;
                    if total >= self.ways[place] {
                        continue;
                    }
                    if length == KNIGHT {
                        let between = [
                            [here[0] + x / 2, here[1] + y / 2],
                            [here[0] + x.signum(), here[1] + y.signum()],
                        ];
                        if !between.into_iter().any(open) {
                            continue;
                        }
                    }
                    self.ways[place] = total;
                    let bucket = total as usize;
                    if bucket >= self.queue.len() {
                        self.queue.resize(bucket + 1, Vec::new());
                    }
                    self.queue[bucket].push(place as u32);
                }
            }
            self.queue[level] = bucket;
            level += 1;
        }
    }

    fn fill_blocks(&mut self) {
        let [columns, rows] = self.size;
        let across = columns.div_ceil(BLOCK);
        self.blocks.clear();
        self.blocks
            .resize(across * rows.div_ceil(BLOCK), f64::INFINITY);
        for row in 0..rows {
            let times = &self.times[row * columns..][..columns];
            for (index, part) in times.chunks(BLOCK).enumerate() {
                let least = part.iter().copied().fold(f64::INFINITY, f64::min);
                let block = &mut self.blocks[row / BLOCK * across + index];
                *block = block.min(least);
            }
        }
    }

    /// Lower bound in s for the cell that holds a place in m; 0 outside of the window.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // checked before
    pub fn at(&self, place: Vector2<f64>) -> f64 {
        let [x, y] = <[f64; 2]>::from((place - self.lower) / self.cell).map(f64::floor);
        let [columns, rows] = self.size;
        if x >= 0.0 && y >= 0.0 && x < columns as f64 && y < rows as f64 {
            self.times[y as usize * columns + x as usize]
        } else {
            0.0
        }
    }

    /// Whether nobody comes by a time in s to any cell whose center is within `reach` m of a place and for which
    /// `counts` holds, told the center in m. False where the window does not hold all of it.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // checked before
    pub fn nobody_near(
        &self,
        place: Vector2<f64>,
        reach: f64,
        until: f64,
        mut counts: impl FnMut(Vector2<f64>) -> bool,
    ) -> bool {
        let middle: [f64; 2] = ((place - self.lower) / self.cell).into();
        let wide = reach / self.cell;
        let [columns, rows] = self.size;
        let first = middle.map(|axis| (axis - wide - 0.5).ceil());
        let last = middle.map(|axis| (axis + wide - 0.5).floor());
        if !(first[0] >= 0.0
            && first[1] >= 0.0
            && last[0] < columns as f64
            && last[1] < rows as f64)
        {
            return false;
        }
        let (first, last) = (
            first.map(|axis| axis as usize),
            last.map(|axis| axis as usize),
        );
        let across = columns.div_ceil(BLOCK);
        for high in first[1] / BLOCK..=last[1] / BLOCK {
            for wide_block in first[0] / BLOCK..=last[0] / BLOCK {
                if self.blocks[high * across + wide_block] > until {
                    continue;
                }
                let block = [wide_block * BLOCK, high * BLOCK];
                let range = |axis: usize| {
                    first[axis].max(block[axis])..=last[axis].min(block[axis] + BLOCK - 1)
                };
                for row in range(1) {
                    for column in range(0) {
                        if self.times[row * columns + column] > until {
                            continue;
                        }
                        let [x, y] = [
                            column as f64 + 0.5 - middle[0],
                            row as f64 + 0.5 - middle[1],
                        ];
                        if x * x + y * y > wide * wide {
                            continue;
                        }
                        if counts(place + Vector2::new(x, y) * self.cell) {
                            return false;
                        }
                    }
                }
            }
        }
        true
    }
}
