//! Order of numbers.

/// Sorts numbers, the smallest first; NaN behind infinity. Compiled once.
pub fn sort_ascending(values: &mut [f64]) {
    values.sort_unstable_by(f64::total_cmp);
}
