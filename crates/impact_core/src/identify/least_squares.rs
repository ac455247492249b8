//! Nonlinear least squares for a few parameters (Levenberg-Marquardt).

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
    pub(super) inverse: Vec<Vec<f64>>,
    pub(super) residuals: Vec<f64>,
    /// Derivatives of the residuals, one row per parameter.
    pub(super) jacobian: Vec<Vec<f64>>,
    pub(super) steps: usize,
}

/// Parameters with their limits: a scale that says what a small change is, and a lower bound.
pub(super) struct Start {
    pub(super) parameters: Vec<f64>,
    pub(super) scale: Vec<f64>,
    pub(super) lower: Vec<f64>,
}

/// Minimizes the sum of squares; `None` if the residuals do not determine the parameters.
pub(super) fn minimize(
    start: &Start,
    mut residuals: impl FnMut(&[f64]) -> Vec<f64>,
) -> Option<Minimum> {
    let mut parameters = start.parameters.clone();
    let mut current = residuals(&parameters);
    let mut cost = squares(&current);
    let mut damping = 1e-4;
    let mut steps = 0;
    let mut settled = false;
    while steps < STEPS && !settled {
        steps += 1;
        let jacobian = differences(&parameters, &start.scale, &mut residuals);
        let (normal, gradient) = normal_equations(&jacobian, &current);
        loop {
            let mut damped = normal.clone();
            for (k, row) in damped.iter_mut().enumerate() {
                row[k] *= 1.0 + damping;
            }
            let step = solve(&damped, &gradient)?;
            let trial: Vec<f64> = parameters
                .iter()
                .zip(&step)
                .zip(&start.scale)
                .zip(&start.lower)
                .map(|(((value, step), scale), &lower)| (value - step * scale).max(lower))
                .collect();
            let largest = step.iter().fold(0.0_f64, |most, step| most.max(step.abs()));
            let next = residuals(&trial);
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
    let mut jacobian = differences(&parameters, &start.scale, &mut residuals);
    let (normal, _) = normal_equations(&jacobian, &current);
    let inverse = inverse(&normal, &start.scale)?;
    for (row, scale) in jacobian.iter_mut().zip(&start.scale) {
        for value in row {
            *value /= scale;
        }
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

/// Derivatives of the residuals by scaled parameters, one row per parameter.
fn differences(
    parameters: &[f64],
    scale: &[f64],
    residuals: &mut impl FnMut(&[f64]) -> Vec<f64>,
) -> Vec<Vec<f64>> {
    let mut moved = parameters.to_vec();
    (0..parameters.len())
        .map(|k| {
            moved[k] = parameters[k] + DIFFERENCE * scale[k];
            let above = residuals(&moved);
            moved[k] = parameters[k] - DIFFERENCE * scale[k];
            let below = residuals(&moved);
            moved[k] = parameters[k];
            above
                .iter()
                .zip(&below)
                .map(|(above, below)| (above - below) / (2.0 * DIFFERENCE))
                .collect()
        })
        .collect()
}

fn normal_equations(jacobian: &[Vec<f64>], residuals: &[f64]) -> (Vec<Vec<f64>>, Vec<f64>) {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let normal = jacobian
        .iter()
        .map(|row| jacobian.iter().map(|column| dot(row, column)).collect())
        .collect();
    let gradient = jacobian.iter().map(|row| dot(row, residuals)).collect();
    (normal, gradient)
}

/// Cholesky factor of a symmetric positive definite matrix.
fn factor(matrix: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let size = matrix.len();
    let mut lower = vec![vec![0.0; size]; size];
    for row in 0..size {
        for column in 0..=row {
            let known: f64 = (0..column).map(|k| lower[row][k] * lower[column][k]).sum();
            let rest = matrix[row][column] - known;
            if row > column {
                lower[row][column] = rest / lower[column][column];
            } else if rest > matrix[row][row] * 1e-14 {
                lower[row][row] = rest.sqrt();
            } else {
                return None;
            }
        }
    }
    Some(lower)
}

fn solve(matrix: &[Vec<f64>], right: &[f64]) -> Option<Vec<f64>> {
    let lower = factor(matrix)?;
    let size = right.len();
    let mut result = right.to_vec();
    for row in 0..size {
        for k in 0..row {
            result[row] -= lower[row][k] * result[k];
        }
        result[row] /= lower[row][row];
    }
    for row in (0..size).rev() {
        for k in row + 1..size {
            result[row] -= lower[k][row] * result[k];
        }
        result[row] /= lower[row][row];
    }
    Some(result)
}

/// Inverse of the scaled normal matrix, in the units of the parameters.
fn inverse(normal: &[Vec<f64>], scale: &[f64]) -> Option<Vec<Vec<f64>>> {
    (0..scale.len())
        .map(|k| {
            let mut unit = vec![0.0; scale.len()];
            unit[k] = 1.0;
            let column = solve(normal, &unit)?;
            Some(
                column
                    .iter()
                    .zip(scale)
                    .map(|(value, row_scale)| value * row_scale * scale[k])
                    .collect(),
            )
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn start(parameters: [f64; 2]) -> Start {
        Start {
            parameters: parameters.to_vec(),
            scale: vec![1.0; 2],
            lower: vec![f64::NEG_INFINITY; 2],
        }
    }

    #[test]
    fn the_banana_valley_has_its_minimum_at_one() {
        let found = minimize(&start([-1.2, 1.0]), |p| {
            vec![10.0 * (p[1] - p[0] * p[0]), 1.0 - p[0]]
        })
        .unwrap();
        assert!(
            (found.parameters[0] - 1.0).abs() < 1e-9 && (found.parameters[1] - 1.0).abs() < 1e-9
        );
    }

    #[test]
    fn undetermined_parameters_are_noticed() {
        assert!(minimize(&start([1.0, 1.0]), |p| vec![p[0] + p[1] - 3.0; 4]).is_none());
    }
}
