//! Exact Euclidean distance transform, Felzenszwalb and Huttenlocher (2012), in whole numbers.

use crate::world::map::grid::MOST_CELLS;
use numeric::error::{Failure, Given, Interrupted, Result, at_most, proceed};

/// Larger than any squared distance of cells, and small enough to be added to one.
const NOTHING: i64 = i64::MAX / 4;

/// Cells between two looks whether to stop: a few milliseconds, also where memory is touched first.
const CHECK: usize = 1 << 20;

/// Distances from the centers of cells of side `resolution` to the center of the nearest occupied one;
/// infinite where there is none. Cells are given row after row.
///
/// # Errors
/// The cells are not whole rows of `columns`, there are too many, or the caller asked to stop.
pub fn distances(
    occupied: &[bool],
    columns: usize,
    resolution: f64,
    interrupted: Interrupted<'_>,
) -> Result<Vec<f64>> {
    let mut squares = squared_distances(occupied, columns, interrupted)?;
    for part in squares.chunks_mut(CHECK) {
        proceed(interrupted)?;
        for square in part {
            *square = square.sqrt() * resolution;
        }
    }
    Ok(squares)
}

/// Squares of the distances in cells, which are whole numbers.
#[allow(clippy::cast_possible_truncation)] // far below 2^53
fn squared_distances(
    occupied: &[bool],
    columns: usize,
    interrupted: Interrupted<'_>,
) -> Result<Vec<f64>> {
    at_most("cells", occupied.len(), MOST_CELLS)?;
    if columns == 0 || !occupied.len().is_multiple_of(columns) || occupied.is_empty() {
        let rule = "be whole rows of cells, one at least";
        let given = Given::Count(occupied.len() as u64);
        return Err(Failure::invalid("cells", rule, given));
    }
    let rows = occupied.len() / columns;
    let mut squares = Vec::with_capacity(occupied.len());
    while squares.len() < occupied.len() {
        proceed(interrupted)?;
        squares.resize(occupied.len().min(squares.len() + CHECK), f64::INFINITY);
    }
    for column in 0..columns {
        proceed(interrupted)?;
        within_column(occupied, &mut squares, column, columns, rows);
    }
    let mut envelope = Envelope::with_room(columns);
    let mut heights = vec![NOTHING; columns];
    for row in squares.chunks_exact_mut(columns) {
        proceed(interrupted)?;
        // Squares of whole numbers below 2^53 are exact in either type.
        for (height, square) in heights.iter_mut().zip(&*row) {
            *height = if square.is_finite() {
                *square as i64
            } else {
                NOTHING
            };
        }
        envelope.lower(&mut heights);
        for (height, square) in heights.iter().zip(row) {
            *square = if *height >= NOTHING {
                f64::INFINITY
            } else {
                *height as f64
            };
        }
    }
    Ok(squares)
}

/// Squared distances along a column.
fn within_column(
    occupied: &[bool],
    squares: &mut [f64],
    column: usize,
    columns: usize,
    rows: usize,
) {
    let mut sweep = |row: usize, since: &mut Option<f64>| {
        let at = row * columns + column;
        *since = if occupied[at] {
            Some(0.0)
        } else {
            since.map(|steps| steps + 1.0)
        };
        if let Some(steps) = since {
            squares[at] = squares[at].min(*steps * *steps);
        }
    };
    let mut since = None;
    (0..rows).for_each(|row| sweep(row, &mut since));
    since = None;
    (0..rows).rev().for_each(|row| sweep(row, &mut since));
}

/// Lower envelope of parabolas `(x - v)^2 + f(v)` along a row.
struct Envelope {
    /// Places and heights of the parabolas in the envelope, from left to right.
    parabolas: Vec<(i64, i64)>,
    /// Last place at which each of them, but the last one, is the lowest.
    until: Vec<i64>,
}

impl Envelope {
    fn with_room(columns: usize) -> Self {
        Self {
            parabolas: Vec::with_capacity(columns),
            until: Vec::with_capacity(columns),
        }
    }

    /// Replaces the heights of a row by the lowest parabola over each place.
    fn lower(&mut self, row: &mut [i64]) {
        self.parabolas.clear();
        self.until.clear();
        for (place, height) in (0..).zip(row.iter().copied()) {
            if height < NOTHING {
                self.add(place, height);
            }
        }
        let mut at = 0;
        for (place, height) in (0..).zip(row.iter_mut()) {
            while self.until.get(at).is_some_and(|until| *until < place) {
                at += 1;
            }
            if let Some((foot, least)) = self.parabolas.get(at) {
                *height = least + (place - foot) * (place - foot);
            }
        }
    }

    fn add(&mut self, place: i64, height: i64) {
        while let Some((foot, least)) = self.parabolas.last().copied() {
            // Both are equally high at the quotient without rounding; whole numbers are exact.
            let difference = height + place * place - least - foot * foot;
            let until = difference.div_euclid(2 * (place - foot));
            let hidden = self.until.last().is_some_and(|before| until <= *before);
            if hidden || until < 0 {
                self.parabolas.pop();
                self.until.pop();
                continue;
            }
            self.until.push(until);
            break;
        }
        self.parabolas.push((place, height));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_corners_as_in_the_definition() {
        let mut cells = [false; 12];
        cells[0] = true;
        cells[11] = true;
        let expected = [0.0, 1.0, 4.0, 4.0, 1.0, 2.0, 2.0, 1.0, 4.0, 4.0, 1.0, 0.0];
        assert_eq!(squared_distances(&cells, 4, &|| false).unwrap(), expected);
        let nothing = squared_distances(&[false; 6], 3, &|| false).unwrap();
        assert!(nothing.iter().all(|distance| *distance == f64::INFINITY));
        assert!(squared_distances(&[], 3, &|| false).is_err());
        assert!(squared_distances(&[true; 5], 3, &|| false).is_err());
    }

    #[test]
    fn every_cell_has_the_distance_of_a_search_over_all() {
        let mut word = 12_345_u32;
        let (columns, rows) = (37, 29);
        for share in [2, 9, 60] {
            let cells: Vec<bool> = (0..columns * rows)
                .map(|_| {
                    word = word.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    (word >> 8).is_multiple_of(share)
                })
                .collect();
            let found = squared_distances(&cells, columns, &|| false).unwrap();
            for (at, found) in found.iter().enumerate() {
                let square = |other: usize| {
                    let x = (at % columns).abs_diff(other % columns);
                    let y = (at / columns).abs_diff(other / columns);
                    (x * x + y * y) as f64
                };
                let occupied = (0..cells.len()).filter(|other| cells[*other]);
                let least = occupied.map(square).fold(f64::INFINITY, f64::min);
                assert_eq!(*found, least);
            }
        }
    }
}
