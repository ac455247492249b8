//! Sets of best compromises: points that no other point beats in every objective.

use std::cmp::Ordering;

use numeric::order::{sort_indices, sort_pairs};

/// Whether a row is at least as good in every objective and better in one; all maximized.
pub(crate) fn dominates(one: &[f64], other: &[f64]) -> bool {
    let pairs = || one.iter().zip(other);
    pairs().all(|(a, b)| a >= b) && pairs().any(|(a, b)| a > b)
}

/// Larger first objective first, then the next; then the index.
fn order(values: &[f64], objectives: usize, one: usize, other: usize) -> Ordering {
    let row = |index: usize| &values[index * objectives..(index + 1) * objectives];
    let pairs = row(one).iter().zip(row(other));
    let differing = pairs.map(|(a, b)| (b + 0.0).total_cmp(&(a + 0.0)));
    let first = differing
        .into_iter()
        .find(|order| *order != Ordering::Equal);
    first.unwrap_or_else(|| one.cmp(&other))
}

/// Indices of the rows that no other row dominates, in ascending order; all objectives are
/// maximized, and rows with a value that is NaN or minus infinity never belong. Of equal rows the
/// first one stands for all.
#[must_use]
pub fn non_dominated(values: &[f64], objectives: usize) -> Vec<usize> {
    let row = |index: usize| &values[index * objectives..(index + 1) * objectives];
    let sound = |index: &usize| row(*index).iter().all(|value| *value > f64::NEG_INFINITY);
    let count = values.len() / objectives.max(1);
    let mut sorted: Vec<usize> = (0..count).filter(sound).collect();
    sort_indices(&mut sorted, &mut |one, other| {
        order(values, objectives, *one, *other)
    });
    // A row can only be dominated by, or equal to, one before it.
    let mut front: Vec<usize> = Vec::new();
    for index in sorted {
        let own = row(index);
        let beaten = |known: &usize| {
            let known = row(*known);
            dominates(known, own) || known == own
        };
        if !front.iter().rev().any(beaten) {
            front.push(index);
        }
    }
    sort_indices(&mut front, &mut Ord::cmp);
    front
}

/// Volume that a set of rows dominates above a reference, all objectives maximized: slices along
/// the last objective (While, Hingston, Barone and Huband 2006).
#[must_use]
pub fn hypervolume(values: &[f64], objectives: usize, reference: &[f64]) -> f64 {
    let above = |row: &&[f64]| {
        row.iter()
            .zip(reference)
            .all(|(value, least)| value > least)
    };
    let gains = |row: &[f64]| -> Vec<f64> {
        row.iter()
            .zip(reference)
            .map(|(value, least)| value - least)
            .collect()
    };
    let rows = values
        .chunks_exact(objectives.max(1))
        .filter(above)
        .map(gains);
    volume(&rows.collect::<Vec<_>>(), objectives)
}

/// Volume of a union of boxes from the origin.
fn volume(rows: &[Vec<f64>], dimension: usize) -> f64 {
    if rows.is_empty() || dimension == 0 {
        return 0.0;
    }
    let last = dimension - 1;
    let pairs = rows.iter().enumerate();
    let mut order: Vec<(f64, usize)> = pairs.map(|(index, row)| (-row[last], index)).collect();
    sort_pairs(&mut order);
    if last == 0 {
        return rows[order[0].1][0];
    }
    let mut total = 0.0;
    let mut slice: Vec<Vec<f64>> = Vec::new();
    for (place, (_, index)) in order.iter().enumerate() {
        let own = &rows[*index][..last];
        let covered = |known: &Vec<f64>| known.iter().zip(own).all(|(a, b)| a >= b);
        if !slice.iter().any(covered) {
            slice.retain(|known| !own.iter().zip(known).all(|(a, b)| a >= b));
            slice.push(own.to_vec());
        }
        let next = order
            .get(place + 1)
            .map_or(0.0, |(_, next)| rows[*next][last]);
        let depth = rows[*index][last] - next;
        if depth > 0.0 {
            total += depth * volume(&slice, last);
        }
    }
    total
}
