//! Where a rising function reaches a value.

/// Steps after which a bracket has no room left.
const MAX_STEPS: usize = 200;

/// Newton steps this short, relatively, leave an error below rounding.
const NEAR: f64 = 1e-9;

/// Steps after which plain Newton steps are too slow.
const FEW_STEPS: usize = 12;

/// Largest argument in [0, `bound`) whose value is at most `target`, of a function from (0, 0) that does
/// not fall; it gives its value and slope. Newton steps on logarithms, in which power laws are lines.
#[must_use]
pub fn largest(target: f64, bound: f64, function: impl Fn(f64) -> [f64; 2]) -> f64 {
    if target <= 0.0 {
        return 0.0;
    }
    between(target, 0.0, bound, function)
}

/// The same in [`low`, `bound`), where the value at `low` is at most `target`.
#[must_use]
pub fn between(target: f64, low: f64, bound: f64, function: impl Fn(f64) -> [f64; 2]) -> f64 {
    let (mut low, mut high) = (low, bound);
    let mut x = if high.is_finite() {
        0.5 * (low + high)
    } else if low > 0.0 {
        2.0 * low
    } else {
        1.0
    };
    for _ in 0..MAX_STEPS {
        let [value, slope] = function(x);
        if value <= target {
            low = x;
        } else {
            high = x;
        }
        let newton = x * ((target / value).ln() * value / (slope * x)).exp();
        if slope > 0.0 && (newton - x).abs() <= 2.0 * f64::EPSILON * x {
            return x;
        }
        let inside = newton > low && newton < high;
        let next = if inside {
            newton
        } else if high.is_finite() {
            // A bracket from 0 may span many powers of ten.
            if low > 0.0 {
                (low * high).sqrt()
            } else {
                0.0625 * high
            }
        } else {
            16.0 * low
        };
        if high - low <= f64::EPSILON * low {
            return low;
        }
        x = next;
    }
    x
}

/// The same in [`low`, `bound`) of a function that rises steeply from there on, as on a backing; it
/// may have the value `at_low` and the slope `slope` at `low`. Newton steps from beyond, where they
/// cannot jump over the solution of a convex function.
#[must_use]
pub fn beyond(
    target: f64,
    (low, at_low, slope): (f64, f64, f64),
    bound: f64,
    function: impl Fn(f64) -> [f64; 2],
) -> f64 {
    let straight = low + (target - at_low) / slope;
    // A law with a pole at its bound rises like 1/(bound - x) at least.
    let mut x = if bound.is_finite() {
        straight.min(bound - (bound - low) * at_low / target)
    } else {
        straight
    };
    for _ in 0..FEW_STEPS {
        if !(x > low && x < bound) {
            break;
        }
        let [value, slope] = function(x);
        let newton = x - (value - target) / slope;
        if (newton - x).abs() <= NEAR * x {
            return newton;
        }
        x = newton;
    }
    between(target, low, bound, function)
}
