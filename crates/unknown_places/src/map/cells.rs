//! Kinds of the cells of a rolling map, the points that stand for them, and how far the nearest occupied cell is.

use nalgebra::Vector2;

use super::rolling::{RollingMap, WORD};

/// Cells of a row whose distances are computed together.
const BLOCK: usize = 32;

/// Kind of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// No beam tells.
    Unknown,
    /// Beams passed.
    Free,
    /// Beams were stopped.
    Occupied,
}

/// A disc that stands for a cell: the mean of the points that were hit, or the front of the unknown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// Middle in m, in the frame of the odometry.
    pub place: Vector2<f64>,
    /// Radius in m: 0 of a point.
    pub radius: f64,
}

/// The cells of a rolling map at an instant.
#[derive(Clone, Debug)]
pub struct Cells {
    size: usize,
    words: usize,
    cell: f64,
    low: [i64; 2],
    occupied: Vec<u64>,
    free: Vec<u64>,
    /// Unknown cells beside free ones.
    front: Vec<u64>,
    /// Point of each occupied cell, from the lowest corner of the window in m.
    points: Vec<[f32; 2]>,
    /// Square of the distance of the nearest occupied cell, in cells, up to `far` squared.
    squares: Vec<i16>,
    columns: Vec<i16>,
    far: i16,
}

impl Cells {
    /// No cells yet, of the only reader of the map; distances are known up to `far` in m.
    #[must_use]
    pub fn new(map: &mut RollingMap, far: f64) -> Self {
        map.all_changed();
        let (size, cell) = (map.size(), map.options().cell);
        let far = ((far / cell).ceil() + 1.0).min(100.0) as i16;
        Self {
            size,
            words: size / WORD,
            cell,
            low: map.low(),
            occupied: vec![0; size * size / WORD],
            free: vec![0; size * size / WORD],
            front: vec![0; size * size / WORD],
            points: vec![[0.0; 2]; size * size],
            squares: vec![far * far; size * size],
            columns: vec![far; size * size],
            far,
        }
    }

    /// Cells along a side.
    #[must_use]
    pub fn size(&self) -> usize {
        self.size
    }

    /// Side of a cell in m.
    #[must_use]
    pub fn cell(&self) -> f64 {
        self.cell
    }

    /// The cell at the lowest corner of the window, counted from the origin of the odometry.
    #[must_use]
    pub fn low(&self) -> [i64; 2] {
        self.low
    }

    /// Kind of a cell of the window.
    #[must_use]
    pub fn kind(&self, column: usize, row: usize) -> Kind {
        let (word, bit) = (row * self.words + column / WORD, column % WORD);
        if self.occupied[word] >> bit & 1 == 1 {
            Kind::Occupied
        } else if self.free[word] >> bit & 1 == 1 {
            Kind::Free
        } else {
            Kind::Unknown
        }
    }

    /// Largest square of a distance that is told, in cells.
    #[must_use]
    pub fn farthest(&self) -> i16 {
        self.far * self.far
    }

    /// Squares of the distances of the nearest occupied cells in cells, row by row.
    #[must_use]
    pub fn squares(&self) -> &[i16] {
        &self.squares
    }

    /// Distance in m from the middle of the cell at a place to that of the nearest occupied cell; `None` outside of the
    /// window.
    #[inline]
    #[must_use]
    pub fn distance(&self, place: Vector2<f64>) -> Option<f64> {
        let index = self.index_of(place)?;
        Some(f64::from(self.squares[index]).sqrt() * self.cell)
    }

    /// Index of the cell at a place.
    #[inline]
    #[must_use]
    pub fn index_of(&self, place: Vector2<f64>) -> Option<usize> {
        let axis = |index: usize| {
            let found = place[index] / self.cell - self.low[index] as f64;
            // Cut off, a number that is not negative is rounded down.
            (found >= 0.0 && found < self.size as f64).then_some(found as i64 as usize)
        };
        Some(axis(1)? * self.size + axis(0)?)
    }

    /// Middle of a cell in m.
    #[must_use]
    pub fn middle(&self, index: usize) -> Vector2<f64> {
        let axis = |place: usize, low: i64| ((place as i64 + low) as f64 + 0.5) * self.cell;
        Vector2::new(
            axis(index % self.size, self.low[0]),
            axis(index / self.size, self.low[1]),
        )
    }

    /// Reads the cells of the map again that changed.
    pub fn read(&mut self, map: &mut RollingMap) {
        self.low = map.low();
        for row in 0..self.size {
            let mut left = map.take_changed(row);
            while left != 0 {
                let word = left.trailing_zeros() as usize;
                left &= left - 1;
                if word >= self.words {
                    break;
                }
                self.read_word(map, row * self.words + word);
            }
        }
        self.find_front();
        self.transform();
    }

    fn read_word(&mut self, map: &RollingMap, word: usize) {
        let (share, least) = (
            map.options().hit_share as f32,
            map.options().least_hits as f32,
        );
        let chunk = &map.evidence()[word * WORD..(word + 1) * WORD];
        let (mut occupied, mut free) = (0_u64, 0_u64);
        for (bit, cell) in chunk.iter().enumerate() {
            let hit = cell.hits >= least && cell.hits >= share * (cell.hits + cell.passes);
            occupied |= u64::from(hit) << bit;
            free |= u64::from(!hit && cell.passes > 0.0) << bit;
        }
        self.occupied[word] = occupied;
        self.free[word] = free;
        let half = 0.5 * self.cell as f32;
        let mut left = occupied;
        while left != 0 {
            let bit = left.trailing_zeros() as usize;
            left &= left - 1;
            let (cell, index) = (&chunk[bit], word * WORD + bit);
            let corner = [index % self.size, index / self.size];
            self.points[index] = [0, 1].map(|axis: usize| {
                corner[axis] as f32 * self.cell as f32 + half + cell.sum[axis] / cell.hits
            });
        }
    }

    /// Finds unknown cells with a free neighbor.
    fn find_front(&mut self) {
        let words = self.words;
        for row in 0..self.size {
            for word in 0..words {
                let at = row * words + word;
                let free = self.free[at];
                let left = if word > 0 {
                    self.free[at - 1] >> (WORD - 1)
                } else {
                    0
                };
                let right = if word + 1 < words {
                    self.free[at + 1] << (WORD - 1)
                } else {
                    0
                };
                let below = if row > 0 { self.free[at - words] } else { 0 };
                let above = if row + 1 < self.size {
                    self.free[at + words]
                } else {
                    0
                };
                let beside = free << 1 | left | free >> 1 | right | below | above;
                self.front[at] = beside & !(free | self.occupied[at]);
            }
        }
    }

    /// Columns of the window within reach of which something is occupied.
    fn columns_of_interest(&self) -> Option<(usize, usize)> {
        let mut all = vec![0_u64; self.words];
        for row in self.occupied.chunks_exact(self.words) {
            for (all, word) in all.iter_mut().zip(row) {
                *all |= word;
            }
        }
        let first = all.iter().position(|word| *word != 0)?;
        let last = all.iter().rposition(|word| *word != 0)?;
        let wide = self.far.unsigned_abs() as usize;
        let low = first * WORD + all[first].trailing_zeros() as usize;
        let high = last * WORD + WORD - all[last].leading_zeros() as usize;
        Some((low.saturating_sub(wide), (high + wide).min(self.size)))
    }

    /// Distance transform: first along columns, then along rows; far from everything nothing is computed.
    fn transform(&mut self) {
        let (size, far) = (self.size, self.far);
        self.squares.fill(far * far);
        let Some((low, high)) = self.columns_of_interest() else {
            return;
        };
        let mut last = vec![far; size];
        for up in [true, false] {
            last.fill(far);
            for place in 0..size {
                let row = if up { place } else { size - 1 - place };
                for each in &mut last[low..high] {
                    *each = (*each + 1).min(far);
                }
                for word in low / WORD..=(high - 1) / WORD {
                    let mut left = self.occupied[row * self.words + word];
                    while left != 0 {
                        last[word * WORD + left.trailing_zeros() as usize] = 0;
                        left &= left - 1;
                    }
                }
                let cells = &mut self.columns[row * size + low..row * size + high];
                if up {
                    cells.copy_from_slice(&last[low..high]);
                } else {
                    for (cell, last) in cells.iter_mut().zip(&last[low..high]) {
                        *cell = (*cell).min(*last);
                    }
                }
            }
        }
        let wide = far.unsigned_abs() as usize;
        let mut squared = vec![far * far; size + 2 * wide];
        for row in 0..size {
            let column = &self.columns[row * size..(row + 1) * size];
            if column[low..high].iter().all(|away| *away == far) {
                continue;
            }
            for (square, away) in squared[wide + low..wide + high]
                .iter_mut()
                .zip(&column[low..high])
            {
                *square = away * away;
            }
            let blocks = self.squares[row * size..(row + 1) * size]
                .as_chunks_mut::<BLOCK>()
                .0;
            for (block, out) in blocks.iter_mut().enumerate() {
                let first = wide + block * BLOCK;
                if first + BLOCK <= wide + low || first >= wide + high {
                    continue;
                }
                let mut least = [0; BLOCK];
                least.copy_from_slice(&squared[first..first + BLOCK]);
                for off in 1..far {
                    let (square, step) = (off * off, off.unsigned_abs() as usize);
                    let left = &squared[first - step..first - step + BLOCK];
                    let right = &squared[first + step..first + step + BLOCK];
                    for ((least, one), other) in least.iter_mut().zip(left).zip(right) {
                        *least = (*least).min((*one).min(*other) + square);
                    }
                }
                *out = least;
            }
        }
    }

    /// Hands over the points of the occupied cells in a square of half a side in m around a place, until one is answered
    /// by `false`.
    #[inline]
    pub fn occupied_near(
        &self,
        place: Vector2<f64>,
        half: f64,
        mut visit: impl FnMut(Vector2<f64>) -> bool,
    ) {
        let corner = Vector2::new(self.low[0] as f64, self.low[1] as f64) * self.cell;
        self.near(&self.occupied, place, half, |index| {
            let [x, y] = self.points[index];
            visit(corner + Vector2::new(f64::from(x), f64::from(y)))
        });
    }

    /// Hands over everything that a plan may not touch in a square of half a side in m around a place: points of
    /// occupied cells, and the front of the unknown.
    pub fn known_near(&self, place: Vector2<f64>, half: f64, mut visit: impl FnMut(Known)) {
        self.occupied_near(place, half, |place| {
            visit(Known { place, radius: 0.0 });
            true
        });
        let radius = 0.5 * self.cell;
        self.near(&self.front, place, half, |index| {
            visit(Known {
                place: self.middle(index),
                radius,
            });
            true
        });
    }

    #[inline]
    fn near(
        &self,
        bits: &[u64],
        place: Vector2<f64>,
        half: f64,
        mut visit: impl FnMut(usize) -> bool,
    ) {
        let most = self.size as f64 - 1.0;
        let bound = |axis: usize, off: f64| {
            ((place[axis] + off) / self.cell - self.low[axis] as f64).clamp(0.0, most) as i64
                as usize
        };
        let (first, last) = (bound(0, -half), bound(0, half));
        for row in bound(1, -half)..=bound(1, half) {
            for word in first / WORD..=last / WORD {
                let mut left = bits[row * self.words + word];
                if word == first / WORD {
                    left &= !0 << (first % WORD);
                }
                if word == last / WORD {
                    left &= !0 >> (WORD - 1 - last % WORD);
                }
                while left != 0 {
                    let bit = left.trailing_zeros() as usize;
                    left &= left - 1;
                    if !visit(row * self.size + word * WORD + bit) {
                        return;
                    }
                }
            }
        }
    }

    /// Which cells are not unknown, 64 of a row in a word.
    pub fn known(&self) -> impl Iterator<Item = u64> {
        let words = self.occupied.iter().zip(&self.free);
        words.map(|(occupied, free)| occupied | free)
    }
}
