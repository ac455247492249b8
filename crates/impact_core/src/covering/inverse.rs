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
    let mut width = f64::INFINITY;
    for step in 0..MAX_STEPS {
        let [value, slope] = function(x);
        if value <= target {
            low = x;
        } else {
            high = x;
        }
        // Beside a kink Newton steps may jump from side to side and narrow the bracket by little.
        let mut slow = false;
        if step >= FEW_STEPS && step.is_multiple_of(2) {
            slow = high - low > 0.5 * width;
            width = high - low;
        }
        let newton = x * ((target / value).ln() * value / (slope * x)).exp();
        if slope > 0.0 && (newton - x).abs() <= 2.0 * f64::EPSILON * x {
            return x;
        }
        let inside = newton > low && newton < high;
        let next = if inside && !slow {
            newton
        } else if slow && high <= 2.0 * low {
            0.5 * (low + high)
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

#[cfg(test)]
mod tests {
    use super::{between, largest};

    /// A law that becomes `steeper` at a kink, with its slope.
    fn kinked(kink: f64, power: f64, steeper: f64) -> impl Fn(f64) -> [f64; 2] {
        move |x: f64| {
            let own = [x.powf(power), power * x.powf(power - 1.0)];
            let past = (x - kink).max(0.0);
            let extra = if past > 0.0 { steeper } else { 0.0 };
            [own[0] + extra * past, own[1] + extra]
        }
    }

    #[test]
    fn kinks_do_not_keep_the_solution_from_being_found() {
        for power in [0.5, 1.0, 1.5, 3.0] {
            for steeper in [1.0, 1e2, 1e4, 1e8] {
                for past in [-1e-3, -1e-9, 0.0, 1e-12, 1e-9, 1e-6, 1e-4, 1e-2, 0.1] {
                    let function = kinked(0.8, power, steeper);
                    let target = function(0.8 + past)[0];
                    for found in [
                        largest(target, 1.0, &function),
                        largest(target, f64::INFINITY, &function),
                        between(target, 0.1, 1.0, &function),
                    ] {
                        let error = function(found)[0] / target - 1.0;
                        // As far as an argument with rounding reaches.
                        let room = 4.0 * f64::EPSILON * (1.0 + steeper / target);
                        assert!(error.abs() <= room, "{power} {steeper} {past}: {error}");
                    }
                }
            }
        }
    }
}
