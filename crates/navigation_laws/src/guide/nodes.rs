//! The grid of nodes of a plan.

use nalgebra::Vector2;

use numeric::error::{Failure, Given, Result};

/// Most nodes of a grid.
pub const MOST_NODES: usize = 1 << 24;

/// Share of a cell by which a box may miss a whole number of them: typed numbers are rounded.
const WHOLE: f64 = 1e-9;

/// Nodes at `lower + h (column, row)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Nodes {
    lower: Vector2<f64>,
    pub spacing: f64,
    pub columns: usize,
    pub rows: usize,
}

impl Nodes {
    /// The nodes in a box.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // bounded before
    pub fn new(lower: Vector2<f64>, upper: Vector2<f64>, spacing: f64) -> Result<Self> {
        let cells = (upper - lower) / spacing;
        let count = (cells.x + 1.0) * (cells.y + 1.0);
        if count.is_nan() || count > MOST_NODES as f64 {
            let rule = format!("give at most {MOST_NODES} nodes in the box of the guide");
            let advice = format!("{spacing} m gives {count:.3e}; a smaller box needs fewer");
            let given = Given::Number(spacing);
            return Err(Failure::invalid("spacing", rule, given).mended_by(advice));
        }
        let along = |cells: f64| (cells + WHOLE).floor() as usize + 1;
        Ok(Self {
            lower,
            spacing,
            columns: along(cells.x),
            rows: along(cells.y),
        })
    }

    pub fn count(&self) -> usize {
        self.columns * self.rows
    }

    /// Where a node is, in m.
    #[inline]
    pub fn place(&self, node: usize) -> Vector2<f64> {
        let (column, row) = (node % self.columns, node / self.columns);
        self.lower + Vector2::new(column as f64, row as f64) * self.spacing
    }

    /// Whether a place lies within half a cell of the nodes.
    pub fn around(&self, place: Vector2<f64>) -> bool {
        let cell = (place - self.lower) / self.spacing;
        let within = |value: f64, count: usize| value >= -0.5 && value <= count as f64 - 0.5;
        within(cell.x, self.columns) && within(cell.y, self.rows)
    }

    /// The four nodes around a place, `None` outside of the grid, with their shares in a value between them.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // within the grid
    pub fn corners(&self, place: Vector2<f64>) -> ([Option<usize>; 4], [f64; 4]) {
        let cell = (place - self.lower) / self.spacing;
        let lower = cell.map(f64::floor);
        let share = cell - lower;
        let node = |x: f64, y: f64| {
            let within = x >= 0.0 && y >= 0.0 && x < self.columns as f64 && y < self.rows as f64;
            within.then(|| y as usize * self.columns + x as usize)
        };
        let (right, above) = (lower.x + 1.0, lower.y + 1.0);
        let corners = [
            node(lower.x, lower.y),
            node(right, lower.y),
            node(lower.x, above),
            node(right, above),
        ];
        let (left, below) = (1.0 - share.x, 1.0 - share.y);
        (
            corners,
            [
                left * below,
                share.x * below,
                left * share.y,
                share.x * share.y,
            ],
        )
    }

    /// The place in the box of the nodes that is nearest to another one.
    pub fn nearest(&self, place: Vector2<f64>) -> Vector2<f64> {
        let last = Vector2::new((self.columns - 1) as f64, (self.rows - 1) as f64);
        let upper = self.lower + last * self.spacing;
        Vector2::new(
            place.x.max(self.lower.x).min(upper.x),
            place.y.max(self.lower.y).min(upper.y),
        )
    }

    /// The nodes in the square of so many cells around the node nearest to a place.
    #[allow(clippy::cast_possible_truncation)] // saturates, far outside the grid
    pub fn square(&self, place: Vector2<f64>, reach: i64) -> impl Iterator<Item = usize> {
        let cell = (place - self.lower) / self.spacing;
        let range = |middle: f64, count: usize| {
            let middle = middle.round() as i64;
            let last = i64::try_from(count).unwrap_or(i64::MAX) - 1;
            middle.saturating_sub(reach).max(0)..=middle.saturating_add(reach).min(last)
        };
        let columns = range(cell.x, self.columns);
        let width = self.columns;
        range(cell.y, self.rows).flat_map(move |row| {
            let columns = columns.clone();
            // Neither is negative.
            columns.filter_map(move |column| {
                let row = usize::try_from(row).ok()?;
                Some(row * width + usize::try_from(column).ok()?)
            })
        })
    }

    /// The nodes linked to one, with the number and the length of each link in cells.
    #[inline]
    pub fn linked(&self, node: usize) -> impl Iterator<Item = (usize, usize, f64)> {
        let (column, row) = (node % self.columns, node / self.columns);
        let nodes = *self;
        LINKS
            .iter()
            .enumerate()
            .filter_map(move |(link, (x, y, length))| {
                let column = column.checked_add_signed(*x)?;
                let row = row.checked_add_signed(*y)?;
                let within = column < nodes.columns && row < nodes.rows;
                within.then_some((row * nodes.columns + column, link, *length))
            })
    }
}

const DIAGONAL: f64 = std::f64::consts::SQRT_2;
/// Length of a knight's move, `sqrt(5)`.
const KNIGHT: f64 = 2.236_067_977_499_79;

/// Steps along the axes, along the diagonals, and of a knight, with their lengths.
pub(super) const LINKS: [(isize, isize, f64); 16] = [
    (1, 0, 1.0),
    (0, 1, 1.0),
    (-1, 0, 1.0),
    (0, -1, 1.0),
    (1, 1, DIAGONAL),
    (-1, 1, DIAGONAL),
    (-1, -1, DIAGONAL),
    (1, -1, DIAGONAL),
    (2, 1, KNIGHT),
    (1, 2, KNIGHT),
    (-1, 2, KNIGHT),
    (-2, 1, KNIGHT),
    (-2, -1, KNIGHT),
    (-1, -2, KNIGHT),
    (1, -2, KNIGHT),
    (2, -1, KNIGHT),
];
