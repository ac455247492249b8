//! Cubic splines through given values, not-a-knot at both ends.

use numeric::error::{Failure, Given, Result};

use super::path::JointPath;

/// The path through rows of values at rising knots: straight for two knots, a parabola for three, and a cubic spline
/// without a jump of the third derivative at the second and the last but one knot for more.
///
/// # Errors
/// Numbers do not fit each other or are not finite, knots do not rise, neighboring rows are equal.
pub fn through(knots: &[f64], values: &[f64], joints: usize) -> Result<JointPath> {
    let count = knots.len();
    if count < 2 || joints == 0 || values.len() != count * joints {
        let found = Given::Found(format!("{} numbers", values.len()).into());
        let rule = "hold a row of all joints for each knot, of which there are two at least";
        return Err(Failure::invalid("values", rule, found));
    }
    let steps: Vec<f64> = knots.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let mut coefficients = vec![0.0; 4 * joints * (count - 1)];
    for joint in 0..joints {
        let of = |knot: usize| values[knot * joints + joint];
        let rises: Vec<f64> = steps
            .iter()
            .enumerate()
            .map(|(index, step)| (of(index + 1) - of(index)) / step)
            .collect();
        let slopes = slopes(&steps, &rises);
        for (index, row) in coefficients.chunks_exact_mut(4 * joints).enumerate() {
            let (h, rise) = (steps[index], rises[index]);
            let [start, end] = [slopes[index], slopes[index + 1]];
            let powers = [
                of(index),
                start,
                (3.0 * rise - 2.0 * start - end) / h,
                (start + end - 2.0 * rise) / (h * h),
            ];
            for (power, value) in powers.into_iter().enumerate() {
                row[power * joints + joint] = value;
            }
        }
    }
    JointPath::new(knots.to_vec(), coefficients, joints)
}

/// Derivatives at the knots, by elimination of their tridiagonal equations.
fn slopes(steps: &[f64], rises: &[f64]) -> Vec<f64> {
    let last = steps.len();
    match last {
        1 => return vec![rises[0]; 2],
        2 => {
            let middle = (steps[1] * rises[0] + steps[0] * rises[1]) / (steps[0] + steps[1]);
            return vec![2.0 * rises[0] - middle, middle, 2.0 * rises[1] - middle];
        }
        _ => {}
    }
    // Rows of an end: that of the other end read backwards.
    let end = |near: usize, next: usize| {
        let both = steps[near] + steps[next];
        let first = (steps[near] + 2.0 * both) * steps[next] * rises[near];
        let value = (first + steps[near] * steps[near] * rises[next]) / both;
        (steps[next], both, value)
    };
    let (mut pivot, mut above, mut value) = end(0, 1);
    let mut eliminated = Vec::with_capacity(last);
    for row in 1..=last {
        let (under, diagonal, over, right) = if row < last {
            let [before, after] = [steps[row - 1], steps[row]];
            let right = 3.0 * (after * rises[row - 1] + before * rises[row]);
            (after, 2.0 * (before + after), before, right)
        } else {
            let (diagonal, under, right) = end(last - 1, last - 2);
            (under, diagonal, 0.0, right)
        };
        eliminated.push((above / pivot, value / pivot));
        let share = under / pivot;
        (pivot, above, value) = (diagonal - share * above, over, right - share * value);
    }
    let mut found = vec![value / pivot; last + 1];
    for (row, (above, value)) in eliminated.into_iter().enumerate().rev() {
        found[row] = value - above * found[row + 1];
    }
    found
}
