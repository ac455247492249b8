//! Windows with free ends in a piecewise linear signal: the best one in every pair of pieces has a
//! formula.

use super::search::{Best, Block, Leaf};
use super::{Signal, collected};
use crate::error::Result;
use numeric::threads::Interrupted;

/// One piece of a piecewise linear signal.
#[derive(Clone, Copy)]
struct LinearSegment {
    time: f64,
    length: f64,
    value: f64,
    slope: f64,
    integral: f64,
}

impl LinearSegment {
    fn integral_at(&self, offset: f64) -> f64 {
        self.integral + offset * (self.value + 0.5 * self.slope * offset)
    }
}

/// Windows with free ends in a piecewise linear signal.
pub(super) struct Cells {
    cells: Vec<LinearSegment>,
    window: f64,
}

impl Cells {
    pub(super) fn new_until(
        signal: Signal<'_>,
        integral: &[f64],
        window: f64,
        interrupted: Interrupted<'_>,
    ) -> Result<Self> {
        let cells = collected(signal.time.len() - 1, interrupted, |k| {
            let length = signal.time[k + 1] - signal.time[k];
            LinearSegment {
                time: signal.time[k],
                length,
                value: signal.value[k],
                slope: (signal.value[k + 1] - signal.value[k]) / length,
                integral: integral[k],
            }
        })?;
        Ok(Self { cells, window })
    }

    pub(super) fn blocks_until(&self, interrupted: Interrupted<'_>) -> Result<Vec<Block>> {
        collected(self.cells.len(), interrupted, |k| {
            let cell = &self.cells[k];
            let last_integral = cell.integral_at(cell.length);
            let last_value = cell.value + cell.slope * cell.length;
            let turn = (-cell.value / cell.slope).clamp(0.0, cell.length);
            let turned = if turn.is_nan() {
                cell.integral
            } else {
                cell.integral_at(turn)
            };
            Block {
                first: cell.time,
                last: cell.time + cell.length,
                first_integral: cell.integral,
                last_integral,
                low: cell.integral.min(last_integral).min(turned),
                high: cell.integral.max(last_integral).max(turned),
                steepest: cell.value.max(last_value),
            }
        })
    }

    /// Offers the window with these offsets in its two cells, moved into the cells.
    fn offer(&self, left: usize, right: usize, offsets: [f64; 2], best: &mut Best) {
        if offsets.iter().any(|offset| offset.is_nan()) {
            return;
        }
        let (from, to) = (&self.cells[left], &self.cells[right]);
        let start = offsets[0].clamp(0.0, from.length);
        let room = (from.time - to.time) + start + self.window;
        let end = offsets[1].clamp(0.0, to.length).min(room);
        let length = (to.time - from.time) + (end - start);
        if end >= 0.0 && length > 0.0 {
            let integral = to.integral_at(end) - from.integral_at(start);
            best.offer([from.time + start, to.time + end], length, integral);
        }
    }

    /// Both ends free: the signal has 0.6 of the window's mean at both (derivatives of the
    /// criterion), which is a quadratic equation for that value.
    fn offer_free(&self, left: usize, right: usize, best: &mut Best) {
        let (from, to) = (&self.cells[left], &self.cells[right]);
        // A maximum needs a signal that rises at the start and falls at the end.
        if from.slope <= 0.0 || to.slope >= 0.0 {
            return;
        }
        let slopes = from.slope * to.slope;
        let apart = to.time - from.time;
        let roots = quadratic(
            0.7 * (from.slope - to.slope),
            apart * slopes - to.value * from.slope + from.value * to.slope,
            -0.6 * ((to.integral - from.integral) * slopes
                + 0.5 * (from.value * from.value * to.slope - to.value * to.value * from.slope)),
        );
        for level in roots {
            let offsets = [
                (level - from.value) / from.slope,
                (level - to.value) / to.slope,
            ];
            self.offer(left, right, offsets, best);
        }
    }

    /// Windows of full length: equal values at both ends.
    fn offer_full(&self, left: usize, right: usize, best: &mut Best) {
        let (from, to) = (&self.cells[left], &self.cells[right]);
        let shift = (from.time - to.time) + self.window;
        let earliest = (-shift).max(0.0);
        let latest = (to.length - shift).min(from.length);
        if earliest > latest {
            return;
        }
        let turn = (to.value + to.slope * shift - from.value) / (from.slope - to.slope);
        let mut starts = [earliest, latest, earliest];
        if from.slope > to.slope {
            starts[2] = turn.clamp(earliest, latest);
        }
        for start in starts {
            self.offer(left, right, [start, start + shift], best);
        }
    }

    /// Windows that begin with the signal.
    fn offer_from_first(&self, right: usize, best: &mut Best) {
        let to = &self.cells[right];
        let before = to.time - self.cells[0].time;
        let roots = quadratic(
            0.7 * to.slope,
            0.4 * to.value + to.slope * before,
            to.value * before - 0.6 * to.integral,
        );
        for end in roots.into_iter().chain([to.length]) {
            self.offer(0, right, [0.0, end], best);
        }
    }

    /// Windows that end with the signal.
    fn offer_to_last(&self, left: usize, best: &mut Best) {
        let right = self.cells.len() - 1;
        let (from, to) = (&self.cells[left], &self.cells[right]);
        let after = (to.time - from.time) + to.length;
        let rest = to.integral_at(to.length) - from.integral;
        let roots = quadratic(
            -0.7 * from.slope,
            from.slope * after - 0.4 * from.value,
            from.value * after - 0.6 * rest,
        );
        for start in roots.into_iter().chain([after - self.window, 0.0]) {
            self.offer(left, right, [start, to.length], best);
        }
    }
}

impl Leaf for Cells {
    fn visit(&self, left: usize, right: usize, best: &mut Best) {
        self.offer_free(left, right, best);
        self.offer_full(left, right, best);
        if left == 0 {
            self.offer_from_first(right, best);
        }
        if right == self.cells.len() - 1 {
            self.offer_to_last(left, best);
        }
    }
}

/// Real roots of `a x^2 + b x + c`, not-a-number where there are none.
fn quadratic(a: f64, b: f64, c: f64) -> [f64; 2] {
    let half = -0.5 * (b + (b * b - 4.0 * a * c).sqrt().copysign(b));
    [half / a, c / half]
}
