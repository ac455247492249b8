//! Cells of a known place: where walls are, and where the center of a person can be.

use nalgebra::Vector2;

use super::CellSet;
use navigation_world::world::map::StaticMap;
use numeric::error::{Failure, Given, Result, positive};
use std::f64::consts::FRAC_1_SQRT_2;

/// Most cells of a place.
pub const MOST_CELLS: usize = 1 << 22;

/// Cells of a known place.
#[derive(Clone, Debug, PartialEq)]
pub struct Ground {
    lower: Vector2<f64>,
    cell: f64,
    /// Cells that may hold a part of a wall: beams end there.
    occupied: CellSet,
    /// `W`: cells in which the center of a person can be.
    walkable: CellSet,
    /// Cells of `W` at the rim, over which people come from outside.
    rim: CellSet,
}

impl Ground {
    /// Of occupied cells; `core`: radius `r_k` of the core of a person in m. Cells whose centers are at least
    /// `r_k - h/sqrt 2` from those of all occupied ones are walkable.
    ///
    /// # Errors
    /// A number is not positive, or there is no cell.
    pub fn of_cells(lower: [f64; 2], cell: f64, core: f64, occupied: CellSet) -> Result<Self> {
        positive("cell", cell)?;
        positive("person_core", core)?;
        let size = occupied.size();
        counted(size.map(|count| count as f64), cell)?;
        let least = (core - cell * FRAC_1_SQRT_2) / cell;
        #[allow(clippy::cast_possible_truncation)] // a few cells
        let reach = (least.ceil() as i64).max(0);
        let near = |[x, y]: [i64; 2]| ((x * x + y * y) as f64) < least * least;
        let square = (-reach..=reach).flat_map(|y| (-reach..=reach).map(move |x| [x, y]));
        let near: Vec<[i64; 2]> = square
            .filter(|offset| near(*offset) || *offset == [0, 0])
            .collect();
        let mut walkable = CellSet::of(size, |_| true);
        for taken in occupied.iter() {
            for offset in &near {
                let beside =
                    [0, 1].map(|axis| taken[axis].checked_add_signed(offset[axis] as isize));
                if let [Some(column), Some(row)] = beside
                    && column < size[0]
                    && row < size[1]
                {
                    walkable.remove([column, row]);
                }
            }
        }
        Ok(Self::new(lower.into(), cell, occupied, walkable))
    }

    /// Of a map within two corners, in m, with exact clearances.
    ///
    /// # Errors
    /// A number is not positive, or there are too many cells.
    pub fn of_map(
        map: &StaticMap,
        [lower, upper]: [[f64; 2]; 2],
        cell: f64,
        core: f64,
    ) -> Result<Self> {
        positive("cell", cell)?;
        positive("person_core", core)?;
        let extent = [0, 1].map(|axis: usize| ((upper[axis] - lower[axis]) / cell).ceil().max(1.0));
        let size = counted(extent, cell)?;
        let lower = Vector2::from(lower);
        let half = cell * FRAC_1_SQRT_2;
        let least = core - half;
        let far = half.max(least) + cell;
        let mut occupied = CellSet::empty(size);
        let walkable = CellSet::of(size, |place| {
            let clearance = map.clearance_up_to(center(lower, cell, place), far);
            if clearance <= half {
                occupied.insert(place);
            }
            clearance >= least
        });
        Ok(Self::new(lower, cell, occupied, walkable))
    }

    fn new(lower: Vector2<f64>, cell: f64, occupied: CellSet, walkable: CellSet) -> Self {
        let size = walkable.size();
        let rim = CellSet::of(size, |place| {
            let at_rim = (0..2).any(|axis| place[axis] == 0 || place[axis] + 1 == size[axis]);
            at_rim && walkable.contains(place)
        });
        Self {
            lower,
            cell,
            occupied,
            walkable,
            rim,
        }
    }

    /// Side of a cell in m.
    #[inline]
    #[must_use]
    pub fn cell(&self) -> f64 {
        self.cell
    }

    /// Lower corner in m.
    #[must_use]
    pub fn lower(&self) -> Vector2<f64> {
        self.lower
    }

    /// Columns and rows.
    #[inline]
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        self.walkable.size()
    }

    /// Cells in which the center of a person can be.
    #[inline]
    #[must_use]
    pub fn walkable(&self) -> &CellSet {
        &self.walkable
    }

    /// Cells that may hold a part of a wall.
    #[inline]
    #[must_use]
    pub fn occupied(&self) -> &CellSet {
        &self.occupied
    }

    /// Walkable cells at the rim.
    #[must_use]
    pub fn rim(&self) -> &CellSet {
        &self.rim
    }

    /// Center of a cell in m.
    #[inline]
    #[must_use]
    pub fn center(&self, cell: [usize; 2]) -> Vector2<f64> {
        center(self.lower, self.cell, cell)
    }

    /// A place in cells from the lower corner.
    #[inline]
    #[must_use]
    pub fn in_cells(&self, place: Vector2<f64>) -> [f64; 2] {
        ((place - self.lower) / self.cell).into()
    }

    /// The cell of given column and row, if there is one.
    #[inline]
    #[must_use]
    pub fn cell_at(&self, [column, row]: [i64; 2]) -> Option<[usize; 2]> {
        let [columns, rows] = self.size();
        let cell = [usize::try_from(column).ok()?, usize::try_from(row).ok()?];
        (cell[0] < columns && cell[1] < rows).then_some(cell)
    }

    /// The cell that holds a place, if there is one.
    #[must_use]
    #[allow(clippy::cast_possible_truncation)] // saturates, far outside of the grid
    pub fn holding(&self, place: Vector2<f64>) -> Option<[usize; 2]> {
        self.cell_at(self.in_cells(place).map(|axis| axis.floor() as i64))
    }

    /// Cells whose centers are within a distance of a place, in m.
    pub fn around(
        &self,
        place: Vector2<f64>,
        radius: f64,
    ) -> impl Iterator<Item = [usize; 2]> + '_ {
        let middle = self.in_cells(place);
        let reach = radius / self.cell;
        let size = self.size();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates at the rim
        let span = [0, 1].map(|axis: usize| {
            let first = (middle[axis] - reach - 0.5).ceil().max(0.0) as usize;
            let beyond = (middle[axis] + reach - 0.5).floor() + 1.0;
            first..(beyond.max(0.0) as usize).min(size[axis])
        });
        let [columns, rows] = span;
        rows.flat_map(move |row| {
            columns.clone().filter_map(move |column| {
                let [x, y] = [
                    column as f64 + 0.5 - middle[0],
                    row as f64 + 0.5 - middle[1],
                ];
                (x * x + y * y <= reach * reach).then_some([column, row])
            })
        })
    }
}

#[inline]
fn center(lower: Vector2<f64>, cell: f64, [column, row]: [usize; 2]) -> Vector2<f64> {
    lower + Vector2::new(column as f64 + 0.5, row as f64 + 0.5) * cell
}

/// Columns and rows, if they are not too many.
fn counted([columns, rows]: [f64; 2], cell: f64) -> Result<[usize; 2]> {
    let count = columns * rows;
    if !(count >= 1.0 && count <= MOST_CELLS as f64) {
        let rule = format!("give 1 to {MOST_CELLS} cells in the map");
        let advice = format!("{cell} m gives {count:.3e}; a smaller map needs fewer");
        return Err(Failure::invalid("cell", rule, Given::Number(cell)).mended_by(advice));
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // bounded
    Ok([columns as usize, rows as usize])
}
