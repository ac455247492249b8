//! Order of numbers and indices, each sort compiled once.

use std::cmp::Ordering;

/// Sorts numbers, the smallest first; NaN behind infinity.
pub fn sort_ascending(values: &mut [f64]) {
    values.sort_unstable_by(f64::total_cmp);
}

/// Sorts pairs of a number and an index by the number, the smallest first, then by the index.
pub fn sort_pairs(pairs: &mut [(f64, usize)]) {
    pairs.sort_unstable_by(|one, other| one.0.total_cmp(&other.0).then(one.1.cmp(&other.1)));
}

/// Sorts indices by a comparison; what is equal by it comes in any order, always the same one.
pub fn sort_indices(indices: &mut [usize], compare: &mut dyn FnMut(&usize, &usize) -> Ordering) {
    indices.sort_unstable_by(compare);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_of_one_number_follow_their_indices() {
        let mut pairs = [
            (2.0, 0),
            (1.0, 3),
            (f64::NAN, 1),
            (1.0, 2),
            (-0.0, 5),
            (0.0, 4),
        ];
        sort_pairs(&mut pairs);
        assert_eq!(pairs.map(|(_, index)| index), [5, 4, 2, 3, 0, 1]);
    }

    #[test]
    fn indices_are_sorted_by_what_they_stand_for() {
        let values = [3.0, 1.0, 2.0];
        let mut indices = [0, 1, 2];
        sort_indices(&mut indices, &mut |one, other| {
            f64::total_cmp(&values[*one], &values[*other])
        });
        assert_eq!(indices, [1, 2, 0]);
    }
}
