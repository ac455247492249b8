//! Turns in space by their rotation vector, and how they change with it.

use nalgebra::{Matrix3, Vector3};

/// Turns below this angle in rad use series, which are exact to rounding there.
const SMALL: f64 = 1e-2;

/// Largest departure of `R R^T` from the identity; infinite for a mirror image.
pub fn departure(matrix: &Matrix3<f64>) -> f64 {
    if matrix.determinant() <= 0.0 {
        return f64::INFINITY;
    }
    (matrix * matrix.transpose() - Matrix3::identity()).amax()
}

/// `a I + b [w] + c [w]^2` with the cross-product matrix `[w]`.
fn polynomial(a: f64, b: f64, c: f64, w: &Vector3<f64>) -> Matrix3<f64> {
    // [w]^2 = w w^T - |w|^2 I.
    let square = w * w.transpose() - Matrix3::from_diagonal_element(w.dot(w));
    Matrix3::from_diagonal_element(a) + w.cross_matrix() * b + square * c
}

/// Rotation by the angle `|w|` about `w`, Rodrigues (1840). Unlike `nalgebra::Rotation3::new` it is
/// exact to rounding for the smallest turns, as its derivatives are taken there.
pub fn turn(w: &Vector3<f64>) -> Matrix3<f64> {
    let [b, c, _] = coefficients(w);
    polynomial(1.0, b, c, w)
}

/// Left Jacobian of a turn: `turn(w + dw) = turn(J dw) turn(w)` to first order.
pub fn left_jacobian(w: &Vector3<f64>) -> Matrix3<f64> {
    let [_, c, d] = coefficients(w);
    polynomial(1.0, c, d, w)
}

/// `sin t / t, (1 - cos t) / t^2, (t - sin t) / t^3` of the angle t of a turn.
fn coefficients(w: &Vector3<f64>) -> [f64; 3] {
    let square = w.dot(w);
    let angle = square.sqrt();
    if angle < SMALL {
        let x = square;
        return [
            1.0 - x / 6.0 * (1.0 - x / 20.0 * (1.0 - x / 42.0)),
            0.5 - x / 24.0 * (1.0 - x / 30.0 * (1.0 - x / 56.0)),
            (1.0 - x / 20.0 * (1.0 - x / 42.0 * (1.0 - x / 72.0))) / 6.0,
        ];
    }
    let (sin, half) = (angle.sin(), (0.5 * angle).sin());
    [
        sin / angle,
        2.0 * half * half / square,
        (angle - sin) / (square * angle),
    ]
}
