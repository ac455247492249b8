//! A grid of cells that obstacles cover, updated where something changed.

use crate::planning::footprint::Footprint;
use numeric::error::{Failure, Given, Result, positive};

/// Most cells of a grid.
pub const MOST_CELLS: usize = 4_000_000;

/// Where the cells are. Positions are relative to the goal, which lies on a corner of cells, so
/// that moving the whole scene changes nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GridFrame {
    /// Side of a cell in m.
    pub resolution: f64,
    /// Number of cells along x.
    pub columns: usize,
    /// Number of cells along y.
    pub rows: usize,
    /// Corner of cells that the goal lies on.
    pub goal: [usize; 2],
}

impl GridFrame {
    /// Cells over the box around a start and the goal, with room on every side, in m.
    ///
    /// # Errors
    /// The resolution or the room is not positive, or there would be more than [`MOST_CELLS`].
    pub fn new(start: [f64; 2], room: f64, resolution: f64) -> Result<Self> {
        positive("resolution", resolution)?;
        positive("room", room)?;
        let cells = |meters: f64| (meters / resolution).ceil();
        let before = start.map(|s| cells(room - s.min(0.0)));
        let after = start.map(|s| cells(room + s.max(0.0)));
        let sides = [before[0] + after[0], before[1] + after[1]];
        // Written so that it refuses what is not a number.
        let fits = sides[0] * sides[1] <= MOST_CELLS as f64;
        if !fits {
            let rule = "give a grid of at most 4,000,000 cells";
            let given = Given::Number(resolution);
            return Err(Failure::invalid("resolution", rule, given));
        }
        Ok(Self {
            resolution,
            columns: whole(sides[0], MOST_CELLS),
            rows: whole(sides[1], MOST_CELLS),
            goal: before.map(|count| whole(count, MOST_CELLS)),
        })
    }

    /// Position in cells from the corner of the grid.
    #[must_use]
    pub fn in_cells(&self, position: [f64; 2]) -> [f64; 2] {
        [
            position[0] / self.resolution + self.goal[0] as f64,
            position[1] / self.resolution + self.goal[1] as f64,
        ]
    }

    /// Position in m relative to the goal.
    #[must_use]
    pub fn in_meters(&self, point: [f64; 2]) -> [f64; 2] {
        [
            (point[0] - self.goal[0] as f64) * self.resolution,
            (point[1] - self.goal[1] as f64) * self.resolution,
        ]
    }

    /// The cell that a point, in cells, lies in, or the nearest one.
    #[must_use]
    pub fn cell(&self, point: [f64; 2]) -> [usize; 2] {
        [
            whole(point[0], self.columns - 1),
            whole(point[1], self.rows - 1),
        ]
    }

    /// Place of a cell in a list of all cells, row by row.
    #[must_use]
    pub fn index(&self, cell: [usize; 2]) -> usize {
        cell[1] * self.columns + cell[0]
    }
}

/// The whole part of a number, between zero and a bound; zero for what is not a number.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the number is between zero and a bound that is far below 2^52"
)]
pub(crate) fn whole(number: f64, bound: usize) -> usize {
    number.max(0.0).min(bound as f64) as usize
}

/// Which cells are covered by obstacles.
///
/// A cell is blocked when a footprint reaches into it, so that whoever stays within the other cells
/// and on their borders stays outside every footprint.
#[derive(Clone, Debug)]
pub struct OccupancyGrid {
    frame: GridFrame,
    /// How many footprints reach into a cell.
    cover: Vec<u32>,
    blocked: Vec<bool>,
    footprints: Vec<Option<Footprint>>,
    touched: Vec<[usize; 2]>,
    changed: Vec<[usize; 2]>,
}

impl OccupancyGrid {
    /// A grid without obstacles.
    #[must_use]
    pub fn new(frame: GridFrame) -> Self {
        let cells = frame.columns * frame.rows;
        Self {
            frame,
            cover: vec![0; cells],
            blocked: vec![false; cells],
            footprints: Vec::new(),
            touched: Vec::new(),
            changed: Vec::new(),
        }
    }

    /// Where the cells are.
    #[must_use]
    pub fn frame(&self) -> &GridFrame {
        &self.frame
    }

    /// Whether a cell is blocked.
    #[must_use]
    pub fn is_blocked(&self, cell: [usize; 2]) -> bool {
        self.blocked[self.frame.index(cell)]
    }

    /// Cells that the last update blocked or freed.
    #[must_use]
    pub fn changed(&self) -> &[[usize; 2]] {
        &self.changed
    }

    /// Whether the goal lies on the border of no free cell.
    #[must_use]
    pub fn goal_is_blocked(&self) -> bool {
        let [x, y] = self.frame.goal;
        [[x, y], [x - 1, y], [x, y - 1], [x - 1, y - 1]]
            .into_iter()
            .all(|cell| self.is_blocked(cell))
    }

    /// Replaces the obstacles, the same one at the same place in the order; cells that became
    /// blocked or free.
    pub fn update(&mut self, footprints: impl Iterator<Item = Option<Footprint>>) -> &[[usize; 2]] {
        self.touched.clear();
        self.changed.clear();
        let mut count = 0;
        for (index, footprint) in footprints.enumerate() {
            if index == self.footprints.len() {
                self.footprints.push(None);
            }
            self.replace(index, footprint);
            count = index + 1;
        }
        for index in count..self.footprints.len() {
            self.replace(index, None);
        }
        self.footprints.truncate(count);
        for &cell in &self.touched {
            let index = self.frame.index(cell);
            let covered = self.cover[index] > 0;
            if covered != self.blocked[index] {
                self.blocked[index] = covered;
                self.changed.push(cell);
            }
        }
        &self.changed
    }

    fn replace(&mut self, index: usize, footprint: Option<Footprint>) {
        let last = self.footprints[index];
        if last == footprint {
            return;
        }
        self.footprints[index] = footprint;
        let (cover, touched, frame) = (&mut self.cover, &mut self.touched, self.frame);
        if let Some(footprint) = footprint {
            for_covered(&frame, &footprint, |cell| {
                let count = &mut cover[frame.index(cell)];
                *count += 1;
                if *count == 1 {
                    touched.push(cell);
                }
            });
        }
        if let Some(footprint) = last {
            for_covered(&frame, &footprint, |cell| {
                let count = &mut cover[frame.index(cell)];
                *count -= 1;
                if *count == 0 {
                    touched.push(cell);
                }
            });
        }
    }
}

/// Calls with every cell that a footprint reaches into; touching its border is not enough.
fn for_covered(frame: &GridFrame, footprint: &Footprint, mut each: impl FnMut([usize; 2])) {
    let height = footprint.height();
    let low = frame.in_cells([0.0, height[0]])[1];
    let high = frame.in_cells([0.0, height[1]])[1];
    for row in whole(low, frame.rows)..whole(high.ceil(), frame.rows) {
        let [bottom, top] = [row, row + 1].map(|edge| frame.in_meters([0.0, edge as f64])[1]);
        let Some(width) = footprint.width_between(bottom, top) else {
            continue;
        };
        let left = frame.in_cells([width[0], 0.0])[0];
        let right = frame.in_cells([width[1], 0.0])[0];
        for column in whole(left, frame.columns)..whole(right.ceil(), frame.columns) {
            each([column, row]);
        }
    }
}
