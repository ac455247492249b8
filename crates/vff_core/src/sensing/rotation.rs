//! Rotations in space: matrices, small turns, products.

/// A matrix by rows.
pub type Matrix = [[f64; 3]; 3];

/// Turns below this angle in rad use series, which are exact to rounding there.
const SMALL: f64 = 1e-2;

/// Product of a matrix and a vector.
pub fn times(matrix: &Matrix, vector: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| dot(row, vector))
}

/// Product of the transposed matrix and a vector.
pub fn transposed_times(matrix: &Matrix, vector: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|j| (0..3).map(|i| matrix[i][j] * vector[i]).sum())
}

/// Scalar product.
pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Vector product.
pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Product of two matrices.
pub fn product(a: &Matrix, b: &Matrix) -> Matrix {
    a.map(|row| transposed_times(b, row))
}

/// Largest departure of `R R^T` from the identity; infinite for a mirror image.
pub fn departure(matrix: &Matrix) -> f64 {
    if dot(matrix[0], cross(matrix[1], matrix[2])) <= 0.0 {
        return f64::INFINITY;
    }
    let mut largest = 0.0_f64;
    for (i, row) in matrix.iter().enumerate() {
        for (j, other) in matrix.iter().enumerate() {
            let wanted = if i == j { 1.0 } else { 0.0 };
            largest = largest.max((dot(*row, *other) - wanted).abs());
        }
    }
    largest
}

/// `a I + b [w] + c [w]^2` with the cross-product matrix `[w]`.
fn polynomial(a: f64, b: f64, c: f64, w: [f64; 3]) -> Matrix {
    let square = dot(w, w);
    let skew = [[0.0, -w[2], w[1]], [w[2], 0.0, -w[0]], [-w[1], w[0], 0.0]];
    let mut matrix = [[0.0; 3]; 3];
    for (i, row) in matrix.iter_mut().enumerate() {
        for (j, entry) in row.iter_mut().enumerate() {
            let unit = if i == j { 1.0 } else { 0.0 };
            // [w]^2 = w w^T - |w|^2 I.
            *entry = a * unit + b * skew[i][j] + c * (w[i] * w[j] - square * unit);
        }
    }
    matrix
}

/// Rotation by the angle `|w|` about `w`, Rodrigues (1840).
pub fn turn(w: [f64; 3]) -> Matrix {
    let [_, b, c, _] = coefficients(w);
    polynomial(1.0, b, c, w)
}

/// Left Jacobian of a turn: `turn(w + dw) = turn(J dw) turn(w)` to first order.
pub fn left_jacobian(w: [f64; 3]) -> Matrix {
    let [_, _, c, d] = coefficients(w);
    polynomial(1.0, c, d, w)
}

/// `cos t, sin t / t, (1 - cos t) / t^2, (t - sin t) / t^3` of the angle t of a turn.
fn coefficients(w: [f64; 3]) -> [f64; 4] {
    let square = dot(w, w);
    let angle = square.sqrt();
    let (sin, cos) = angle.sin_cos();
    if angle < SMALL {
        let x = square;
        return [
            cos,
            1.0 - x / 6.0 * (1.0 - x / 20.0 * (1.0 - x / 42.0)),
            0.5 - x / 24.0 * (1.0 - x / 30.0 * (1.0 - x / 56.0)),
            (1.0 - x / 20.0 * (1.0 - x / 42.0 * (1.0 - x / 72.0))) / 6.0,
        ];
    }
    let half = (0.5 * angle).sin();
    [
        cos,
        sin / angle,
        2.0 * half * half / square,
        (angle - sin) / (square * angle),
    ]
}
