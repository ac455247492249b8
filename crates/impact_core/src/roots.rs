//! Safeguarded roots and maxima of smooth functions of one variable.

/// Steps after which a bracket has no room left for a double number.
const MAX_STEPS: usize = 200;

/// Root of a function between two points where its signs differ; the function gives its value
/// and derivative. Newton steps, halved brackets where they leave or shrink too slowly.
pub fn root(function: impl Fn(f64) -> [f64; 2], from: f64, to: f64) -> f64 {
    let (mut low, mut high) = (from, to);
    let rising = function(high)[0] > 0.0;
    let mut x = 0.5 * (low + high);
    let mut last = high - low;
    for _ in 0..MAX_STEPS {
        let [value, slope] = function(x);
        if value == 0.0 {
            return x;
        }
        if (value > 0.0) == rising {
            high = x;
        } else {
            low = x;
        }
        let step = value / slope;
        let newton = x - step;
        let inside = newton > low && newton < high && 2.0 * step.abs() <= last.abs();
        let next = if inside { newton } else { 0.5 * (low + high) };
        last = next - x;
        // Also ends at a bracket of two neighbouring numbers.
        if last.abs() <= f64::EPSILON * next.abs() {
            return next;
        }
        x = next;
    }
    x
}

/// Places in an interval where a derivative vanishes, in order; the function gives the
/// derivative and its own derivative. Pairs of zeros between neighbouring nodes are found by the
/// extremum between them.
pub fn stationary(
    function: impl Fn(f64) -> [f64; 2],
    from: f64,
    to: f64,
    pieces: usize,
    mut found: impl FnMut(f64),
) {
    let node = |index: usize| {
        if index == pieces {
            to
        } else {
            from + (to - from) * (index as f64 / pieces as f64)
        }
    };
    let mut left = (from, function(from));
    for index in 1..=pieces {
        let right = (node(index), function(node(index)));
        let ((low, [low_value, low_slope]), (high, [high_value, high_slope])) = (left, right);
        if (low_value > 0.0) != (high_value > 0.0) {
            found(root(&function, low, high));
        } else if low_value * low_slope < 0.0 && high_value * high_slope > 0.0 {
            let turn = turning_point(&function, low, high);
            if function(turn)[0] * low_value < 0.0 {
                found(root(&function, low, turn));
                found(root(&function, turn, high));
            }
        }
        left = right;
    }
}

/// Place where the slope changes sign: secants between both ends, the weight of an end that stays is
/// halved, and so is a bracket that three of them leave longer than half.
pub fn turning_point(function: &impl Fn(f64) -> [f64; 2], from: f64, to: f64) -> f64 {
    let (mut low, mut high) = (from, to);
    let [mut left, mut right] = [from, to].map(|time| function(time)[1]);
    let side = left > 0.0;
    let mut x = from;
    let mut goal = high - low;
    for step in 0..MAX_STEPS {
        let mut next = low + (high - low) * (left / (left - right));
        if step % 3 == 2 {
            if high - low > 0.5 * goal {
                next = 0.5 * (low + high);
            }
            goal = high - low;
        }
        if !(next > low && next < high) {
            next = 0.5 * (low + high);
        }
        let settled = (next - x).abs() <= f64::EPSILON * next.abs();
        let lasted = x;
        x = next;
        if settled {
            break;
        }
        let slope = function(x)[1];
        if slope == 0.0 {
            break;
        }
        if (slope > 0.0) == side {
            if lasted == low {
                right *= 0.5;
            }
            (low, left) = (x, slope);
        } else {
            if lasted == high {
                left *= 0.5;
            }
            (high, right) = (x, slope);
        }
    }
    x
}

/// A maximum and where it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// The value.
    pub value: f64,
    /// The time, in s.
    pub time: f64,
}

impl Peak {
    /// Below every value.
    pub const NONE: Self = Self {
        value: f64::NEG_INFINITY,
        time: 0.0,
    };

    /// Takes a value that is larger.
    pub fn offer(&mut self, value: f64, time: f64) {
        if value > self.value {
            *self = Self { value, time };
        }
    }
}

/// Largest value in an interval, ends included; the function gives value, first and second
/// derivative.
pub fn maximum(function: impl Fn(f64) -> [f64; 3], from: f64, to: f64, pieces: usize) -> Peak {
    let mut best = Peak {
        value: function(from)[0],
        time: from,
    };
    let mut offer = |time: f64| best.offer(function(time)[0], time);
    let slope = |time: f64| {
        let [_, first, second] = function(time);
        [first, second]
    };
    stationary(slope, from, to, pieces, &mut offer);
    offer(to);
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn root_of_a_cosine_is_exact() {
        let cosine = |x: f64| [x.cos(), -x.sin()];
        assert!((root(cosine, 0.0, 3.0) - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
    }

    #[test]
    fn two_zeros_between_nodes_are_found() {
        let parabola = |x: f64| [(x - 0.5).powi(2) - 1e-6, 2.0 * (x - 0.5)];
        let mut zeros = Vec::new();
        stationary(parabola, 0.0, 1.0, 1, |x| zeros.push(x));
        assert_eq!(zeros.len(), 2);
        assert!((zeros[0] - 0.499).abs() < 1e-12 && (zeros[1] - 0.501).abs() < 1e-12);
    }

    #[test]
    fn a_turning_point_takes_few_evaluations() {
        let calls = std::cell::Cell::new(0);
        for phase in [1e-9, 0.01, 0.3, 1.0, 1.9, 1.999] {
            let wave = |x: f64| {
                calls.set(calls.get() + 1);
                [-(x - phase).cos(), (x - phase).sin() * (1.0 + x * x)]
            };
            calls.set(0);
            let turn = turning_point(&wave, 0.0, 2.0);
            assert!((turn - phase).abs() <= 4e-16 * phase, "{turn} {phase}");
            assert!(calls.get() <= 20, "{} {phase}", calls.get());
        }
    }

    #[test]
    fn maximum_may_sit_at_an_end() {
        let peak = maximum(|x| [x * x, 2.0 * x, 2.0], 0.0, 2.0, 4);
        assert_eq!(
            peak,
            Peak {
                value: 4.0,
                time: 2.0
            }
        );
    }
}
