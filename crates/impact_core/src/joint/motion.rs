//! The linear motion of an impact, evaluated at any time.

use crate::error::{Failure, Given, Result};
use crate::series::{
    CELL_ANGLE, Cell, CellDrive, Plant, Recurrence, State, derivatives, integrated,
};
use numeric::lanes::Real;

/// Cells that a motion may have; more means that its fastest root is far too fast for its length.
pub const MAX_CELLS: usize = 200_000;

/// A function of time with its first three derivatives.
pub type Jet<R> = [R; 4];

/// Cells of equal length from first contact on.
#[derive(Clone, Debug)]
pub struct ImpactMotion<R> {
    length: f64,
    recurrence: Recurrence<R>,
    foam: [R; 2],
    cells: Vec<Cell<R>>,
    next: State<R>,
}

impl<R: Real> ImpactMotion<R> {
    /// The motion with a cell length, in s, and no cell yet.
    #[must_use]
    pub fn new(plant: &Plant<R>, closing_speed: R, length: f64) -> Self {
        Self {
            length,
            recurrence: plant.recurrence(R::splat(length)),
            foam: plant.foam,
            cells: Vec::with_capacity(8),
            next: State::contact(closing_speed, R::splat(length)),
        }
    }

    /// Adds the next cell.
    pub fn grow(&mut self) {
        let mut cell = Cell::empty();
        self.next = cell.fill(&self.recurrence, &CellDrive::none(), &self.next);
        self.cells.push(cell);
    }

    /// Adds cells until they reach a time.
    pub fn reach(&mut self, time: f64) {
        while self.end() < time {
            self.grow();
        }
    }

    /// Length of a cell, in s.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// End of the last cell, in s.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.cells.len() as f64 * self.length
    }

    fn cell(&self, time: f64) -> (&Cell<R>, R) {
        let steps = time / self.length;
        // The cast saturates; there is at least one cell before anything is asked.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let index = (steps as usize).min(self.cells.len() - 1);
        (&self.cells[index], R::splat(steps - index as f64))
    }

    fn per_second<const D: usize>(&self, mut jet: [R; D]) -> [R; D] {
        let mut factor = 1.0;
        for value in &mut jet {
            factor /= self.length;
            *value *= R::splat(factor);
        }
        jet
    }

    /// Velocity `w'` of the head against the torso and its derivatives, `w''` the acceleration.
    #[must_use]
    pub fn head(&self, time: f64) -> Jet<R> {
        let (cell, x) = self.cell(time);
        self.per_second(derivatives(&cell.head_rate, x))
    }

    /// Velocity of the head and its acceleration.
    #[must_use]
    pub fn head_pair(&self, time: f64) -> [R; 2] {
        let (cell, x) = self.cell(time);
        self.per_second(derivatives(&cell.head_rate, x))
    }

    /// Displacement `w` of the head against the torso.
    #[must_use]
    pub fn head_displacement(&self, time: f64) -> R {
        let (cell, x) = self.cell(time);
        integrated(cell.start.head[0], &cell.head_rate, x)
    }

    /// Rate of the lag and its derivatives.
    #[must_use]
    pub fn lag_rate(&self, time: f64) -> Jet<R> {
        let (cell, x) = self.cell(time);
        self.per_second(derivatives(&cell.lag_rate, x))
    }

    /// Lag `u` of the manipulator behind its set-point.
    #[must_use]
    pub fn lag(&self, time: f64) -> R {
        let (cell, x) = self.cell(time);
        integrated(cell.start.lag[0], &cell.lag_rate, x)
    }

    /// Compression of the foam and its derivatives.
    #[must_use]
    pub fn compression(&self, time: f64) -> Jet<R> {
        let (cell, x) = self.cell(time);
        let [first, second, third] = self.per_second(derivatives(&cell.compression_rate, x));
        let value = integrated(cell.start.compression[0], &cell.compression_rate, x);
        [value, first, second, third]
    }

    /// Contact force with its first and second derivative, from those of the compression.
    #[must_use]
    pub fn force_of(&self, compression: Jet<R>) -> [R; 3] {
        let [stiffness, damping] = self.foam;
        let [value, first, second, third] = compression;
        [
            stiffness * value + damping * first,
            stiffness * first + damping * second,
            stiffness * second + damping * third,
        ]
    }

    /// Contact force with its first and second derivative.
    #[must_use]
    pub fn force(&self, time: f64) -> [R; 3] {
        self.force_of(self.compression(time))
    }
}

/// Length of the cells of a plant, in s; a motion of a duration must not need too many.
///
/// # Errors
/// The fastest root is too fast for the duration.
pub fn cell_length(plant: &Plant<f64>, duration: f64) -> Result<f64> {
    let fastest = plant.fastest();
    let length = if fastest > 0.0 {
        (CELL_ANGLE / fastest).min(duration)
    } else {
        duration
    };
    if duration / length <= MAX_CELLS as f64 {
        Ok(length)
    } else {
        Err(Failure::invalid(
            "system",
            "have no root faster than 2e5 per time of interest",
            Given::Number(fastest),
        ))
    }
}
