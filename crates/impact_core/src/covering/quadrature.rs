//! Gauss-Legendre quadrature of functions that start like a power.

/// Positive nodes on [-1, 1] and their weights, order 64.
#[rustfmt::skip]
#[allow(clippy::unreadable_literal)] // nodes and weights as tables print them
const NODES: [(f64, f64); 32] = [
    (0.9993050417357722, 0.001783280721696433),
    (0.9963401167719553, 0.004147033260562468),
    (0.9910133714767443, 0.006504457968978363),
    (0.983336253884626, 0.008846759826363947),
    (0.973326827789911, 0.011168139460131128),
    (0.9610087996520538, 0.013463047896718643),
    (0.9464113748584028, 0.015726030476024718),
    (0.9295691721319396, 0.017951715775697343),
    (0.9105221370785028, 0.02013482315353021),
    (0.8893154459951141, 0.022270173808383253),
    (0.8659993981540928, 0.024352702568710874),
    (0.8406292962525803, 0.02637746971505466),
    (0.8132653151227975, 0.028339672614259483),
    (0.7839723589433414, 0.030234657072402478),
    (0.7528199072605319, 0.03205792835485155),
    (0.7198818501716109, 0.033805161837141606),
    (0.6852363130542333, 0.035472213256882386),
    (0.6489654712546573, 0.03705512854024005),
    (0.6111553551723933, 0.038550153178615626),
    (0.571895646202634, 0.03995374113272034),
    (0.5312794640198946, 0.04126256324262353),
    (0.48940314570705296, 0.04247351512365359),
    (0.4463660172534641, 0.04358372452932345),
    (0.4022701579639916, 0.044590558163756566),
    (0.3572201583376681, 0.04549162792741814),
    (0.31132287199021097, 0.046284796581314416),
    (0.2646871622087674, 0.04696818281621002),
    (0.21742364374000708, 0.04754016571483031),
    (0.16964442042399283, 0.04799938859645831),
    (0.12146281929612056, 0.048344762234802954),
    (0.07299312178779904, 0.04857546744150343),
    (0.024350292663424433, 0.048690957009139724),
];

/// Integral over [0, 1]. The nodes crowd at 0 like `y^4`, so that powers between whole numbers are
/// integrated as if they were polynomials.
#[must_use]
pub fn unit_integral(function: impl Fn(f64) -> f64) -> f64 {
    let at = |y: f64, weight: f64| {
        let cube = y * y * y;
        2.0 * weight * cube * function(cube * y)
    };
    NODES
        .iter()
        .map(|&(x, weight)| at(0.5 - 0.5 * x, weight) + at(0.5 + 0.5 * x, weight))
        .sum()
}

/// Distances from 1, as shares of the way from 0, within which a pole beyond it would cost digits.
const NEAR_POLE: f64 = 0.11;
const NEAR_PAIR: f64 = 0.25;
/// Shortest distance that counts.
const NO_DISTANCE: f64 = 1e-15;

/// Integral over [0, 1] of a function with a pole at `1 + gap`: towards it pieces get shorter as it gets nearer.
#[must_use]
pub fn integral_before_pole(gap: f64, function: impl Fn(f64) -> f64) -> f64 {
    if gap.is_nan() || gap >= NEAR_POLE {
        return unit_integral(function);
    }
    let nearest = gap.max(NO_DISTANCE);
    halved(
        2.0 * NEAR_POLE,
        nearest,
        |distance| 1.0 + gap - distance,
        function,
    )
}

/// Integral over [0, 1] of a function with poles at `1 - gap i` and `1 + gap i`.
#[must_use]
pub fn integral_between_poles(gap: f64, function: impl Fn(f64) -> f64) -> f64 {
    if gap.is_nan() || gap >= NEAR_PAIR {
        return unit_integral(function);
    }
    let nearest = gap.max(NO_DISTANCE);
    let last = piece(1.0 - nearest, 1.0, &function);
    last + halved(NEAR_PAIR, nearest, |distance| 1.0 - distance, function)
}

/// Integral up to the nearest of some distances, over a first piece and pieces that halve them.
fn halved(
    first: f64,
    nearest: f64,
    place: impl Fn(f64) -> f64,
    function: impl Fn(f64) -> f64,
) -> f64 {
    let begin = place(first);
    let mut sum = begin * unit_integral(|y| function(begin * y));
    let mut far = first;
    while far > nearest {
        let near = (0.5 * far).max(nearest);
        sum += piece(place(far), place(near), &function);
        far = near;
    }
    sum
}

/// Integral of a smooth function over [`from`, `to`].
fn piece(from: f64, to: f64, function: impl Fn(f64) -> f64) -> f64 {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let both = |x: f64| function(middle - half * x) + function(middle + half * x);
    let sum: f64 = NODES.iter().map(|&(x, weight)| weight * both(x)).sum();
    half * sum
}

#[cfg(test)]
mod tests {
    use super::{integral_before_pole, integral_between_poles, unit_integral};

    #[test]
    fn powers_are_exact() {
        for power in [0.25_f64, 0.5, 1.0, 2.006, 3.7, 9.0] {
            let found = unit_integral(|x| x.powf(power));
            assert!((found * (power + 1.0) - 1.0).abs() < 1e-13, "{power}");
        }
    }

    #[test]
    fn poles_cost_no_digits() {
        for gap in [0.5, 0.11, 0.1, 0.01, 1e-4, 1e-7] {
            // int (1 + gap - x)^-3, and int gap/(gap^2 + (1 - x)^2).
            let found = integral_before_pole(gap, |x| (1.0 + gap - x).powi(-3));
            let exact = 0.5 * (gap.powi(-2) - (1.0 + gap).powi(-2));
            assert!((found / exact - 1.0).abs() < 1e-15 / gap + 1e-13, "{gap}");
            let found = integral_between_poles(gap, |x| gap / (gap * gap + (1.0 - x).powi(2)));
            let exact = (1.0 / gap).atan();
            assert!((found / exact - 1.0).abs() < 1e-15 / gap + 1e-13, "{gap}");
        }
        assert!(integral_before_pole(0.0, |x| (1.0 - x).powf(-0.5)).is_finite());
        assert!(integral_before_pole(f64::NAN, |x| x).is_finite());
    }
}
