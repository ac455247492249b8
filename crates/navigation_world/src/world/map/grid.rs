//! Occupancy grids: their boundary as segments, and which cell a point lies in.

use nalgebra::Vector2;

use crate::world::frame::Frame;
use crate::world::map::capsule::Capsule;
use numeric::error::{
    Failure, Given, Interrupted, Result, at_most, finite, finite_pair, positive, proceed,
};

/// Most cells of a grid.
pub const MOST_CELLS: usize = 1 << 28;

/// Share of a cell by which rounding may move a point beyond the edge.
const EDGE: f64 = 1e-9;

/// Where a grid lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GridPlace {
    /// Side of a cell in m.
    pub resolution: f64,
    /// Lower left corner of the first cell, in m.
    pub origin: [f64; 2],
    /// Angle by which the grid is turned around it, in rad.
    pub yaw: f64,
}

/// Which cells of a grid are occupied.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cells {
    /// One bit a cell, row after row.
    bits: Vec<u64>,
    columns: usize,
    rows: usize,
    resolution: f64,
    frame: Frame,
    /// Whether nothing is known of what lies outside.
    limits: bool,
}

impl Cells {
    pub fn new(occupied: &[bool], columns: usize, place: GridPlace) -> Result<Self> {
        at_most("cells", occupied.len(), MOST_CELLS)?;
        positive("resolution", place.resolution)?;
        finite_pair("origin", place.origin)?;
        finite("yaw", place.yaw)?;
        if columns == 0 || occupied.is_empty() || !occupied.len().is_multiple_of(columns) {
            let rule = "be whole rows of cells, one at least";
            let given = Given::Count(occupied.len() as u64);
            return Err(Failure::invalid("cells", rule, given));
        }
        let word = |cells: &[bool]| {
            let set = cells.iter().enumerate().filter(|(_, occupied)| **occupied);
            set.fold(0, |word, (bit, _)| word | 1 << bit)
        };
        let frame = if place.yaw == 0.0 {
            Frame {
                position: place.origin.into(),
                direction: Vector2::x(),
            }
        } else {
            Frame::at(place.origin, place.yaw)
        };
        Ok(Self {
            bits: occupied.chunks(64).map(word).collect(),
            columns,
            rows: occupied.len() / columns,
            resolution: place.resolution,
            frame,
            limits: false,
        })
    }

    /// Cells outside of which nothing is known.
    pub fn limiting(self) -> Self {
        Self {
            limits: true,
            ..self
        }
    }

    /// Whether nothing is known of what lies outside.
    pub fn limits(&self) -> bool {
        self.limits
    }

    /// Whether a point lies within the grid or on its edge.
    pub fn covers(&self, point: Vector2<f64>) -> bool {
        let local = self.frame.inward(point - self.frame.position) / self.resolution;
        let within = |value: f64, count: usize| value >= -EDGE && value <= count as f64 + EDGE;
        within(local.x, self.columns) && within(local.y, self.rows)
    }

    /// Its four corners, in m.
    pub fn corners(&self) -> [Vector2<f64>; 4] {
        let (columns, rows) = (self.columns, self.rows);
        [(0, 0), (columns, 0), (columns, rows), (0, rows)]
            .map(|(column, row)| self.corner(column, row))
    }

    fn occupied(&self, column: usize, row: usize) -> bool {
        let at = row * self.columns + column;
        self.bits[at / 64] >> (at % 64) & 1 == 1
    }

    /// Whether a point lies in an occupied cell.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // within the grid
    pub fn occupied_at(&self, point: Vector2<f64>) -> bool {
        let local = self.frame.inward(point - self.frame.position) / self.resolution;
        let within = |value: f64, count: usize| value >= 0.0 && value < count as f64;
        within(local.x, self.columns)
            && within(local.y, self.rows)
            && self.occupied(local.x as usize, local.y as usize)
    }

    /// A corner of cells, in m.
    fn corner(&self, column: usize, row: usize) -> Vector2<f64> {
        let own = Vector2::new(column as f64, row as f64) * self.resolution;
        self.frame.position + self.frame.outward(own)
    }

    /// Number of segments of the boundary.
    pub fn count_boundary(&self, interrupted: Interrupted<'_>) -> Result<usize> {
        let mut count = 0;
        self.each_run(interrupted, |_, _| count += 1)?;
        Ok(count)
    }

    /// Adds the boundary between occupied and free cells as segments, as long as may be.
    pub fn boundary(
        &self,
        segments: &mut Vec<Capsule>,
        interrupted: Interrupted<'_>,
    ) -> Result<()> {
        self.each_run(interrupted, |from, to| {
            segments.push(Capsule::wall(from, to, 0.0));
        })
    }

    /// Calls with the ends of every straight piece of the boundary.
    fn each_run(
        &self,
        interrupted: Interrupted<'_>,
        mut piece: impl FnMut(Vector2<f64>, Vector2<f64>),
    ) -> Result<()> {
        // Edges between a cell and the one to its left, and between it and the one below it.
        for column in 0..=self.columns {
            proceed(interrupted)?;
            let differs = |row: usize| {
                let left = column > 0 && self.occupied(column - 1, row);
                let right = column < self.columns && self.occupied(column, row);
                left != right
            };
            each_run_of(self.rows, differs, |first, end| {
                piece(self.corner(column, first), self.corner(column, end));
            });
        }
        for row in 0..=self.rows {
            proceed(interrupted)?;
            let differs = |column: usize| {
                let below = row > 0 && self.occupied(column, row - 1);
                let above = row < self.rows && self.occupied(column, row);
                below != above
            };
            each_run_of(self.columns, differs, |first, end| {
                piece(self.corner(first, row), self.corner(end, row));
            });
        }
        Ok(())
    }
}

/// Calls with the first and the end of every run of places that hold.
fn each_run_of(count: usize, holds: impl Fn(usize) -> bool, mut run: impl FnMut(usize, usize)) {
    let mut first = None;
    for place in 0..=count {
        let here = place < count && holds(place);
        match (first, here) {
            (None, true) => first = Some(place),
            (Some(start), false) => {
                run(start, place);
                first = None;
            }
            _ => {}
        }
    }
}
