//! Largest loads between two points of a curve.

use super::Loading;
use super::plane::Point;
use super::variable::Variable;
use crate::collision::curve::{CurveStep, Inside};
use crate::roots::Peak;

/// Most steps towards a top.
const MOST_TRIALS: usize = 12;
/// Shares of a step from a half power at which a load is evaluated.
const RISES: [f64; 2] = [0.5, 0.2];

impl Loading<'_> {
    /// Offers the loads at the end of a step, and what peaks within it; of a flat contact only the force.
    pub fn offer(
        &self,
        over: (Variable, &dyn Fn() -> CurveStep),
        ends: [&Point; 2],
        tops: &mut [Peak; 2],
    ) {
        let count = if self.curved { 2 } else { 1 };
        for (load, top) in tops.iter_mut().take(count).enumerate() {
            self.offer_load(over, ends, load, top);
        }
    }

    fn offer_load(
        &self,
        (variable, step): (Variable, &dyn Fn() -> CurveStep),
        [from, to]: [&Point; 2],
        load: usize,
        top: &mut Peak,
    ) {
        top.offer(to.loads[load][0], to.state[1]);
        let rises = from.loads[load][1] > 0.0;
        // Beyond a half power a load that falls may rise once more, ever faster at first.
        let may_rise = self.half_powers && from.depth <= self.piece[0];
        if !(to.loads[load][1] < 0.0 && (rises || may_rise)) {
            return;
        }
        let taken = &step();
        let inside = self.inside(variable, taken, [from, to]);
        let (mut low, mut high) = (*from, *to);
        if !rises {
            let tried = RISES.map(|share| {
                let at = from.at + share * (to.at - from.at);
                self.tried(variable, (from, taken), &inside, at)
            });
            let Some(rising) = tried.into_iter().find(|point| point.loads[load][1] > 0.0) else {
                return;
            };
            low = rising;
        }
        let near = 0.01 * self.collision.tolerance.cbrt() * (to.at - from.at);
        let mut last: Option<Point> = None;
        for _ in 0..MOST_TRIALS {
            let width = high.at - low.at;
            // A load may start infinitely steep.
            let share = if low.at == 0.0 {
                0.5
            } else {
                top_of_cubic(low.loads[load], high.loads[load], width)
            };
            let at = low.at + share * width;
            if let Some(tried) = last
                && (at - tried.at).abs() <= near
            {
                let more = at - tried.at;
                let [value, rate] = tried.loads[load];
                let time = tried.state[1] + tried.rates[1] * more;
                top.offer(value + 0.5 * rate * more, time);
                return;
            }
            let found = self.tried(variable, (from, taken), &inside, at);
            top.offer(found.loads[load][0], found.state[1]);
            if found.loads[load][1] > 0.0 {
                low = found;
            } else {
                high = found;
            }
            last = Some(found);
        }
    }
}

impl Loading<'_> {
    /// A point within a step: of its polynomial, if that keeps the rates there, else of a step of its own.
    fn tried(
        &self,
        variable: Variable,
        (from, taken): (&Point, &CurveStep),
        inside: &Inside,
        at: f64,
    ) -> Point {
        self.evaluations.set(self.evaluations.get() + 1);
        let [state, change] = inside.at((at - from.at) / taken.length);
        let found = self.point(variable, at, state);
        let scales = self.scales_of(variable, from);
        let defect = |entry: usize| {
            (change[entry] - taken.length * found.rates[entry]).abs() / scales[entry]
        };
        if defect(0).max(defect(1)) <= self.collision.tolerance {
            return found;
        }
        let own = self.walk(variable, from, at - from.at);
        self.point(variable, at, own.state)
    }
}

/// Where the cubic through two values with their rates, rising first and falling last, is largest: a share of the
/// width.
fn top_of_cubic(first: [f64; 2], last: [f64; 2], width: f64) -> f64 {
    let (rise, fall) = (first[1] * width, last[1] * width);
    let gain = last[0] - first[0];
    let a = 3.0 * (rise + fall) - 6.0 * gain;
    let b = 6.0 * gain - 4.0 * rise - 2.0 * fall;
    let share = 2.0 * rise / ((b * b - 4.0 * a * rise).sqrt() - b);
    if share > 0.0 && share < 1.0 {
        share
    } else {
        0.5
    }
}

#[cfg(test)]
mod tests {
    use super::top_of_cubic;

    #[test]
    fn tops_of_cubics_are_exact() {
        // x (x - 1) (x - 3), which peaks where 3 x^2 - 8 x + 3 = 0.
        let of = |x: f64| [x * (x - 1.0) * (x - 3.0), 3.0 * x * x - 8.0 * x + 3.0];
        let share = top_of_cubic(of(0.1), of(0.9), 0.8);
        let exact = (4.0 - 7.0_f64.sqrt()) / 3.0;
        assert!((0.1 + 0.8 * share - exact).abs() < 1e-14);
        // A parabola.
        let of = |x: f64| [-x * x, -2.0 * x];
        assert!((top_of_cubic(of(-0.3), of(0.7), 1.0) - 0.3).abs() < 1e-14);
    }
}
