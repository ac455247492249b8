//! The fastest motion along a path within caps of its nodes and limits of acceleration.

use numeric::error::{Interrupted, Result, proceed};

use super::path::JointPath;
use super::strips::Strips;

/// Intervals between two questions whether to stop.
const LOOK: usize = 4096;

/// `x = (ds/dt)^2` at the nodes of a path, as large as `tops` and the accelerations allow.
///
/// Where a joint turns around, a larger `x` may leave less room for the next one: the steps are not the same in both
/// directions of the path. The faster one counts, so that a path takes the same time backwards.
///
/// # Errors
/// The caller asked to stop.
pub fn fastest(
    path: &JointPath,
    acceleration: &[f64],
    tops: &[f64],
    interrupted: Interrupted<'_>,
) -> Result<Vec<f64>> {
    let onward = swept(path, acceleration, tops.to_vec(), (false, interrupted))?;
    let mut reversed = tops.to_vec();
    reversed.reverse();
    let mut backward = swept(path, acceleration, reversed, (true, interrupted))?;
    backward.reverse();
    let time = |squares: &[f64]| times(path, squares).last().copied();
    Ok(if time(&backward) < time(&onward) {
        backward
    } else {
        onward
    })
}

/// The values in one direction of the path: first the largest ones from which the end can be reached, from the end
/// backwards, then the largest steps from the start.
fn swept(
    path: &JointPath,
    acceleration: &[f64],
    mut squares: Vec<f64>,
    (reversed, interrupted): (bool, Interrupted<'_>),
) -> Result<Vec<f64>> {
    let intervals = path.intervals();
    let mut strips = Strips::default();
    let read = |strips: &mut Strips, step: usize| -> Result<()> {
        if step.is_multiple_of(LOOK) {
            proceed(interrupted)?;
        }
        let index = if reversed { intervals - 1 - step } else { step };
        strips.read(&path.piece(index), acceleration, reversed);
        Ok(())
    };
    for step in (0..intervals).rev() {
        read(&mut strips, step)?;
        squares[step] = strips.largest(squares[step], squares[step + 1]);
    }
    for step in 0..intervals {
        read(&mut strips, step)?;
        squares[step + 1] = strips.onward(squares[step], squares[step + 1]);
    }
    Ok(squares)
}

/// Times at the nodes (s), infinite from an interval on that is not left.
#[must_use]
pub fn times(path: &JointPath, squares: &[f64]) -> Vec<f64> {
    let mut time = 0.0;
    let mut found = vec![time];
    for (index, pair) in squares.windows(2).enumerate() {
        time += 2.0 * path.piece(index).length / (pair[0].sqrt() + pair[1].sqrt());
        found.push(time);
    }
    found
}
