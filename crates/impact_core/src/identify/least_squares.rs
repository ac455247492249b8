//! Nonlinear least squares for a few parameters (Levenberg-Marquardt). The crate of that name knows
//! no bounds, and here friction must not become negative on the way.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// Relative change of the parameters that ends the search.
const SETTLED: f64 = 1e-10;
/// Step of the central differences, as a share of each parameter's scale.
const DIFFERENCE: f64 = 1e-5;
/// Most steps of one search.
const STEPS: usize = 60;

/// Result of a search.
pub(super) struct Minimum {
    pub(super) parameters: Vec<f64>,
    /// Inverse of J^T J: the covariance for residuals of unit variance.
    pub(super) inverse: DMatrix<f64>,
    pub(super) residuals: Vec<f64>,
    /// Derivatives of the residuals, one column per parameter.
    pub(super) jacobian: DMatrix<f64>,
    pub(super) steps: usize,
}

/// Parameters with their limits: a scale that says what a small change is, and a lower bound.
pub(super) struct InitialGuess {
    pub(super) parameters: Vec<f64>,
    pub(super) scale: Vec<f64>,
    pub(super) lower: Vec<f64>,
}

/// Minimizes the sum of squares; `None` if the residuals do not determine the parameters, or if
/// there are none any more because the caller was asked to stop.
pub(super) fn minimize(
    start: &InitialGuess,
    mut residuals: impl FnMut(&[f64]) -> Option<Vec<f64>>,
) -> Option<Minimum> {
    let mut parameters = start.parameters.clone();
    let mut current = residuals(&parameters)?;
    let mut cost = squares(&current);
    let mut damping = 1e-4;
    let mut steps = 0;
    let mut settled = false;
    while steps < STEPS && !settled {
        steps += 1;
        let jacobian = differences(&parameters, &start.scale, &mut residuals)?;
        let normal = jacobian.tr_mul(&jacobian);
        let gradient = jacobian.tr_mul(&DVector::from_column_slice(&current));
        loop {
            let damped = &normal + DMatrix::from_diagonal(&(normal.diagonal() * damping));
            let step = factor(damped)?.solve(&gradient);
            let trial: Vec<f64> = parameters
                .iter()
                .zip(&step)
                .zip(&start.scale)
                .zip(&start.lower)
                .map(|(((value, step), scale), &lower)| (value - step * scale).max(lower))
                .collect();
            let largest = step.amax();
            let next = residuals(&trial)?;
            let next_cost = squares(&next);
            settled = largest < SETTLED;
            if next_cost <= cost {
                (parameters, current, cost) = (trial, next, next_cost);
                damping = (damping * 0.1).max(1e-12);
                break;
            }
            damping = (damping * 10.0).max(1e-8);
            if settled || damping > 1e12 {
                settled = true;
                break;
            }
        }
    }
    let mut jacobian = differences(&parameters, &start.scale, &mut residuals)?;
    // In the units of the parameters.
    let scale = DMatrix::from_diagonal(&DVector::from_column_slice(&start.scale));
    let inverse = &scale * factor(jacobian.tr_mul(&jacobian))?.inverse() * &scale;
    for (mut column, scale) in jacobian.column_iter_mut().zip(&start.scale) {
        column /= *scale;
    }
    Some(Minimum {
        parameters,
        inverse,
        residuals: current,
        jacobian,
        steps,
    })
}

fn squares(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum()
}

/// Derivatives of the residuals by scaled parameters, one column per parameter.
fn differences(
    parameters: &[f64],
    scale: &[f64],
    residuals: &mut impl FnMut(&[f64]) -> Option<Vec<f64>>,
) -> Option<DMatrix<f64>> {
    let mut moved = parameters.to_vec();
    let columns: Option<Vec<DVector<f64>>> = (0..parameters.len())
        .map(|k| {
            moved[k] = parameters[k] + DIFFERENCE * scale[k];
            let above = DVector::from_vec(residuals(&moved)?);
            moved[k] = parameters[k] - DIFFERENCE * scale[k];
            let below = DVector::from_vec(residuals(&moved)?);
            moved[k] = parameters[k];
            Some((above - below) / (2.0 * DIFFERENCE))
        })
        .collect();
    Some(DMatrix::from_columns(&columns?))
}

/// Cholesky factor of a symmetric matrix; `None` if it is not positive definite, to rounding.
fn factor(matrix: DMatrix<f64>) -> Option<Cholesky<f64, Dyn>> {
    let diagonal = matrix.diagonal();
    let found = Cholesky::new(matrix)?;
    let left = found.l_dirty().diagonal();
    let definite = left
        .iter()
        .zip(&diagonal)
        .all(|(left, whole)| left * left > whole * 1e-14);
    definite.then_some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn start(parameters: [f64; 2]) -> InitialGuess {
        InitialGuess {
            parameters: parameters.to_vec(),
            scale: vec![1.0; 2],
            lower: vec![f64::NEG_INFINITY; 2],
        }
    }

    #[test]
    fn the_banana_valley_has_its_minimum_at_one() {
        let found = minimize(&start([-1.2, 1.0]), |p| {
            Some(vec![10.0 * (p[1] - p[0] * p[0]), 1.0 - p[0]])
        })
        .unwrap();
        assert!(
            (found.parameters[0] - 1.0).abs() < 1e-9 && (found.parameters[1] - 1.0).abs() < 1e-9
        );
    }

    #[test]
    fn undetermined_parameters_are_noticed() {
        assert!(minimize(&start([1.0, 1.0]), |p| Some(vec![p[0] + p[1] - 3.0; 4])).is_none());
    }
}
