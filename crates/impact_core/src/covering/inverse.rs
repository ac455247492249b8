//! Inverse of a rising function.

/// Steps after which a bracket has no room left.
const MAX_STEPS: usize = 200;

/// Newton steps this short, over how far a function is smooth, leave an error below rounding.
const NEAR: f64 = 1e-9;

/// Share of the target that a value may miss, and of the distance from a pole at the bound that a step may go,
/// for its slope to tell how far the solution is, even where numbers are few.
const LITTLE: f64 = 0.01;

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

/// Largest argument in [`low`, `bound`) whose value is at most `target`, which that at `low` is; infinite where
/// nothing bounds a function that stays below it.
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
    let mut count = u64::MAX;
    for step in 0..MAX_STEPS {
        let [value, slope] = function(x);
        if value <= target {
            low = x;
        } else {
            high = x;
        }
        // Beside a kink Newton steps may jump from side to side and narrow the bracket by little: where two steps
        // do not halve the count of numbers in it, it is halved, so that none is left before the last step.
        let mut slow = false;
        if step >= FEW_STEPS && step.is_multiple_of(2) {
            let left = numbers_between(low, high);
            slow = left > count / 2;
            count = left;
        }
        let missing = (target / value).ln();
        let newton = x * (missing * value / (slope * x)).exp();
        let sloped = slope > 0.0 && slope < f64::INFINITY;
        let short = (2.0 * f64::EPSILON * x).min(LITTLE * (bound - x));
        if sloped && missing.abs() <= LITTLE && (newton - x).abs() <= short {
            return x;
        }
        if high - low <= f64::EPSILON * low || numbers_between(low, high) <= 1 {
            return low;
        }
        x = if slow {
            middle(low, high)
        } else if newton > low && newton < high {
            newton
        } else if high.is_infinite() {
            16.0 * low
        } else if low > 0.0 {
            // A bracket may span many powers of ten.
            (low * high).sqrt()
        } else {
            0.0625 * high
        };
    }
    low
}

/// Number of steps from one double number to the next between `low` and `high`, both not negative.
fn numbers_between(low: f64, high: f64) -> u64 {
    high.to_bits().saturating_sub(low.to_bits())
}

/// The double number in the middle of those from `low` to `high`, both not negative.
fn middle(low: f64, high: f64) -> f64 {
    f64::from_bits(low.to_bits() + numbers_between(low, high) / 2)
}

/// Largest argument in [`low`, `bound`) whose value is at most `target`, of a function that rises steeply from `low`
/// on, as on a backing, and has no kink beyond `last_kink`; it may have the value `at_low` and the slope `slope` at
/// `low`. Newton steps from beyond, where they cannot jump over the solution of a convex function.
#[must_use]
pub fn beyond(
    target: f64,
    (low, at_low, slope): (f64, f64, f64),
    (last_kink, bound): (f64, f64),
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
        if slope.is_infinite() {
            break;
        }
        let step = (value - target) / slope;
        let next = x - step;
        // How far the function is smooth on both sides. Beside a pole a step may also be lost in rounding.
        let smooth = (x.min(next) - last_kink).min(bound - x);
        let least = 2.0 * f64::EPSILON * x.min(bound - x);
        if step.abs() <= least.max(NEAR * smooth) {
            return next;
        }
        x = next;
    }
    between(target, low, bound, function)
}

#[cfg(test)]
mod tests;
