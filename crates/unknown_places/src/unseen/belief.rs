//! Where those can be who are not tracked.

use nalgebra::Vector2;
use std::f64::consts::FRAC_1_SQRT_2;
use std::sync::Arc;

use super::{CellSet, Ground};
use crate::map::walk_while;

/// Cells in which those can be who are not tracked: the center of everybody is within [`Belief::eta`] of one of them.
#[derive(Clone, Debug)]
pub struct Belief {
    ground: Arc<Ground>,
    pub(super) cells: CellSet,
    /// Way in cells that people may have gone beyond what the cells show; below 1.
    budget: f64,
    /// Room for [`CellSet::spread`].
    beside: Vec<u64>,
    /// Cells that the beams of a scan cross.
    crossed: CellSet,
}

impl Belief {
    /// Somebody can be everywhere.
    #[must_use]
    pub fn new(ground: Arc<Ground>) -> Self {
        let cells = ground.walkable().clone();
        Self {
            crossed: CellSet::empty(cells.size()),
            ground,
            cells,
            budget: 0.0,
            beside: Vec::new(),
        }
    }

    /// The cells.
    #[must_use]
    pub fn cells(&self) -> &CellSet {
        &self.cells
    }

    /// The place that they are cells of.
    #[must_use]
    pub fn ground(&self) -> &Arc<Ground> {
        &self.ground
    }

    /// Way in cells that people may have gone beyond what the cells show.
    #[must_use]
    pub fn budget(&self) -> f64 {
        self.budget
    }

    /// Distance `eta` in m between the center of a person and that of a cell: when the cells last grew, they held it, and
    /// people have gone no farther since than what is left of the budget.
    #[must_use]
    pub fn eta(&self) -> f64 {
        (self.budget + FRAC_1_SQRT_2) * self.ground.cell()
    }

    /// Lets everybody go a way in m. Eight neighbors hold every point within a side of a cell.
    pub fn grow(&mut self, way: f64) {
        self.budget += way / self.ground.cell();
        let [columns, rows] = self.ground.size();
        if self.budget > (columns + rows) as f64 * 2.0 {
            // Longer than any way of the grid that is not a maze; a maze only seems more full.
            self.cells = self.ground.walkable().clone();
            self.budget = 0.0;
        }
        while self.budget >= 1.0 {
            self.cells.spread(self.ground.walkable(), &mut self.beside);
            self.budget -= 1.0;
        }
    }

    /// Adds somebody who was tracked and is not any more: he is within a distance in m of a place.
    pub fn add(&mut self, place: Vector2<f64>, within: f64) {
        let ground = self.ground.clone();
        let radius = within + ground.cell() * FRAC_1_SQRT_2;
        for cell in ground.around(place, radius) {
            if ground.walkable().contains(cell) {
                self.cells.insert(cell);
            }
        }
    }

    /// Takes out the cells that beams cross before their ends, in m, and before a cell with a wall, and those beside them
    /// in which somebody would be within `least` m of a beam. People come in over the rim, whatever is seen there.
    pub fn see(
        &mut self,
        from: Vector2<f64>,
        ends: impl Iterator<Item = Vector2<f64>>,
        least: f64,
    ) {
        let ground = self.ground.clone();
        self.crossed.clear();
        let start = ground.in_cells(from);
        for end in ends {
            let mut last = None;
            walk_while(start, ground.in_cells(end), |cell| {
                if let Some(before) = last.take() {
                    self.crossed.insert(before);
                }
                last = ground.cell_at(cell);
                last.is_some_and(|cell| !ground.occupied().contains(cell))
            });
        }
        let beside = least - self.eta() - ground.cell() * FRAC_1_SQRT_2;
        let radius = beside.max(0.0) / ground.cell();
        self.cells.remove_around(&self.crossed, radius);
        self.cells.unite(ground.rim());
    }

    /// Whether somebody at a place in m who is not tracked is reckoned with.
    #[must_use]
    pub fn covers(&self, place: Vector2<f64>) -> bool {
        self.covers_within(place, 0.0)
    }

    /// Whether somebody who is not tracked is reckoned with, within a distance in m of a place.
    #[must_use]
    pub fn covers_within(&self, place: Vector2<f64>, within: f64) -> bool {
        let within = (self.eta() + within) * (1.0 + 1e-9);
        let mut near = self.ground.around(place, within);
        near.any(|cell| self.cells.contains(cell))
    }
}
