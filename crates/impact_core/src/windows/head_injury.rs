//! Search for the window of the head injury criterion.

use super::Window;
use crate::roots::stationary;
use crate::signal::search::{self as branch, Best, Block, Leaf};

/// Nodes of the coarse search, at most.
const COARSE: usize = 64;
/// Newton steps that finish a search.
const POLISH: usize = 8;
/// Last of these steps over the distance of two nodes; the value is good to its square.
const SETTLED: f64 = 1e-6;
/// Where Newton steps set out in a pair of pieces if they lead nowhere from its middle.
const QUARTERS: [[f64; 2]; 4] = [[0.25, 0.25], [0.25, 0.75], [0.75, 0.25], [0.75, 0.75]];

/// Head injury criterion in windows up to `width`: the largest
/// `T^-1.5 (V(t2) - V(t1))^2.5`, `T = t2 - t1`; `jet` gives `V`, `a`, `a'`, `a''`.
///
/// Windows on a bound (full ones, those that start or stop with the interval) depend on one number
/// and are searched along it. All others have `a(t1) = a(t2) = 0.6 (V(t2) - V(t1)) / T`, with `a`
/// rising at the start and falling at the end; branch and bound over pairs of pieces leaves the
/// few pairs in which one may be the best.
pub fn injury(jet: impl Fn(f64) -> [f64; 4], end: f64, width: f64, pieces: usize) -> Window {
    let whole = jet(end)[0];
    let width = width.min(end);
    if whole.is_nan() || whole <= 0.0 {
        return Window {
            value: 0.0,
            start: 0.0,
            end: width,
        };
    }
    let search = WindowSearch {
        nodes: nodes(&jet, end, pieces),
        jet: &jet,
        end,
        width,
        step: end / pieces as f64,
        whole,
    };
    let mut best = Best::NONE;
    search.coarse(&mut best);
    search.bounds(&mut best);
    let best = branch::search(search.blocks(), width, &search, best);
    Window {
        value: criterion(best.integral * whole, best.length),
        start: best.start,
        end: best.end,
    }
}

/// Time, `V`, `a`, `a'` and `a''`.
type JetSample = (f64, [f64; 4]);

fn nodes(jet: &impl Fn(f64) -> [f64; 4], end: f64, pieces: usize) -> Vec<JetSample> {
    (0..=pieces)
        .map(|index| {
            let time = end * (index as f64 / pieces as f64);
            (time, jet(time))
        })
        .collect()
}

struct WindowSearch<'a, F> {
    jet: &'a F,
    end: f64,
    width: f64,
    /// Time between nodes.
    step: f64,
    /// Velocity at the end; velocities are over it, so that their powers are numbers.
    whole: f64,
    nodes: Vec<JetSample>,
}

impl<F: Fn(f64) -> [f64; 4]> WindowSearch<'_, F> {
    fn offer(&self, best: &mut Best, start: f64, end: f64) {
        self.offer_long(best, start, end, end - start);
    }

    fn offer_long(&self, best: &mut Best, start: f64, end: f64, length: f64) {
        let rise = (self.jet)(end)[0] - (self.jet)(start)[0];
        if length > 0.0 {
            best.offer([start, end], length, rise / self.whole);
        }
    }

    /// Pairs of some nodes, to begin with something good.
    fn coarse(&self, best: &mut Best) {
        let stride = (self.nodes.len() / COARSE).max(1);
        for first in (0..self.nodes.len()).step_by(stride) {
            let (start, left) = self.nodes[first];
            for last in (first + stride..self.nodes.len()).step_by(stride) {
                let (end, right) = self.nodes[last];
                if end - start > self.width {
                    break;
                }
                let rise = (right[0] - left[0]) / self.whole;
                best.offer([start, end], end - start, rise);
            }
        }
    }

    /// Pieces of an interval, as long as those between nodes.
    fn pieces(&self, from: f64, to: f64) -> usize {
        // At most the number of nodes.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let pieces = ((to - from) / self.step).ceil() as usize;
        pieces.max(1)
    }

    /// Windows on a bound.
    fn bounds(&self, best: &mut Best) {
        let Self {
            jet, end, width, ..
        } = *self;
        let room = end - width;
        let mut full = |start: f64| self.offer_long(best, start, start + width, width);
        full(0.0);
        if room > 0.0 {
            full(room);
            let difference = |start: f64| {
                let [left, right] = [jet(start), jet(start + width)];
                [right[1] - left[1], right[2] - left[2]]
            };
            stationary(difference, 0.0, room, self.pieces(0.0, room), full);
        }
        let shortest = (0.5 * self.step).min(width);
        // T (a - 0.6 mean) at the free end, and its slope.
        let from_contact = |time: f64| {
            let [velocity, acceleration, slope, _] = jet(time);
            [
                time * acceleration - 0.6 * velocity,
                time * slope + 0.4 * acceleration,
            ]
        };
        let pieces = self.pieces(shortest, width);
        stationary(from_contact, shortest, width, pieces, |time| {
            self.offer(best, 0.0, time);
        });
        let to_the_end = |start: f64| {
            let [velocity, acceleration, slope, _] = jet(start);
            let length = end - start;
            [
                length * acceleration - 0.6 * (self.whole - velocity),
                length * slope - 0.4 * acceleration,
            ]
        };
        let (from, to) = (room, end - shortest);
        let pieces = self.pieces(from, to);
        stationary(to_the_end, from, to, pieces, |start| {
            self.offer(best, start, end);
        });
    }

    /// Least and largest value in a piece of a function with values and slopes at its nodes, from
    /// the bends there: a parabola differs from its chord by an eighth of its second derivative.
    fn range(&self, values: [f64; 2], bends: [f64; 2]) -> [f64; 2] {
        // Twice that, as bends change along a quarter of a radian.
        let margin = 0.25 * self.step * bends[0].abs().max(bends[1].abs());
        [
            values[0].min(values[1]) - margin,
            values[0].max(values[1]) + margin,
        ]
    }

    /// Range of the acceleration in a piece.
    fn accelerations(&self, piece: usize) -> [f64; 2] {
        let [left, right] = [self.nodes[piece].1, self.nodes[piece + 1].1];
        let bends = [left[3], right[3]].map(|curve| curve * self.step);
        self.range([left[1], right[1]], bends)
    }

    /// Range of the slope of the acceleration in a piece.
    fn slopes(&self, piece: usize) -> [f64; 2] {
        let [left, right] = [self.nodes[piece].1, self.nodes[piece + 1].1];
        self.range([left[2], right[2]], [left[3], right[3]])
    }

    fn blocks(&self) -> Vec<Block> {
        let block = |piece: usize| {
            let [(first, left), (last, right)] = [self.nodes[piece], self.nodes[piece + 1]];
            let [from, to] = [left[0] / self.whole, right[0] / self.whole];
            Block {
                first,
                last,
                first_integral: from,
                last_integral: to,
                // There is no negative acceleration before the end.
                low: from.min(to),
                high: from.max(to),
                steepest: self.accelerations(piece)[1] / self.whole,
            }
        };
        (0..self.nodes.len() - 1).map(block).collect()
    }

    /// Whether a window with free ends may start in one piece and end in another one.
    fn may_hold(&self, left: usize, right: usize) -> bool {
        let [(t1, first), (t2, second)] = [self.nodes[left], self.nodes[left + 1]];
        let [(t3, third), (t4, fourth)] = [self.nodes[right], self.nodes[right + 1]];
        let least = 0.6 * (third[0] - second[0]) / (t4 - t1);
        let most = if t3 > t2 {
            0.6 * (fourth[0] - first[0]) / (t3 - t2)
        } else {
            f64::INFINITY
        };
        let [starts, ends] = [self.accelerations(left), self.accelerations(right)];
        let low = least.max(starts[0]).max(ends[0]);
        let high = most.min(starts[1]).min(ends[1]);
        low <= high && self.slopes(left)[1] >= 0.0 && self.slopes(right)[0] <= 0.0
    }

    /// Newton steps to a window with free ends; `None` if they do not stay near.
    fn polished(&self, from: [f64; 2]) -> Option<[f64; 2]> {
        let [mut start, mut end] = from;
        let mut last = f64::INFINITY;
        for _ in 0..POLISH {
            let [v1, a1, d1, _] = (self.jet)(start);
            let [v2, a2, d2, _] = (self.jet)(end);
            let (rise, length) = (v2 - v1, end - start);
            let (u1, u2, over) = (a1 / rise, a2 / rise, 1.5 / length);
            let (g1, g2) = (over - 2.5 * u1, 2.5 * u2 - over);
            let curve = over / length;
            let h11 = -2.5 * (d1 / rise + u1 * u1) + curve;
            let h22 = 2.5 * (d2 / rise - u2 * u2) + curve;
            let h12 = 2.5 * u1 * u2 - curve;
            let determinant = h11 * h22 - h12 * h12;
            let s1 = (h12 * g2 - h22 * g1) / determinant;
            let s2 = (h12 * g1 - h11 * g2) / determinant;
            start += s1;
            end += s2;
            let moved = (start - from[0]).abs().max((end - from[1]).abs());
            // Also true for a step that is not a number.
            if !(moved < 1.5 * self.step && start >= 0.0 && end <= self.end && start < end) {
                return None;
            }
            last = s1.abs() + s2.abs();
            if last < SETTLED * SETTLED * self.step {
                break;
            }
        }
        (last < SETTLED * self.step && end - start <= self.width).then_some([start, end])
    }
}

impl<F: Fn(f64) -> [f64; 4]> Leaf for WindowSearch<'_, F> {
    fn visit(&self, left: usize, right: usize, best: &mut Best) {
        // A window with free ends is not shorter than a piece.
        if left == right || !self.may_hold(left, right) {
            return;
        }
        let place = |[first, second]: [f64; 2]| {
            [
                self.nodes[left].0 + first * self.step,
                self.nodes[right].0 + second * self.step,
            ]
        };
        if let Some([start, end]) = self.polished(place([0.5, 0.5])) {
            self.offer(best, start, end);
            return;
        }
        for quarters in QUARTERS {
            if let Some([start, end]) = self.polished(place(quarters)) {
                self.offer(best, start, end);
            }
        }
    }
}

/// `T^-1.5 rise^2.5`, 0 where the mean is not positive.
pub(super) fn criterion(rise: f64, length: f64) -> f64 {
    if rise > 0.0 && length > 0.0 {
        let mean = rise / length;
        length * mean * mean * mean.sqrt()
    } else {
        0.0
    }
}
