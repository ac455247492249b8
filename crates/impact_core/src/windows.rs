//! Criteria of moving windows on the continuous acceleration of the head.
//!
//! The velocity `V` of the head against the torso is the integral of its acceleration `a`, so the
//! mean over a window is a difference of two velocities.

use crate::roots::{stationary, turning_point};
use crate::signal::search::{self as branch, Best, Block, Leaf};

/// A window and what it gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// The value.
    pub value: f64,
    /// Start, in s.
    pub start: f64,
    /// End, in s.
    pub end: f64,
}

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
    let search = Search {
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
type Node = (f64, [f64; 4]);

fn nodes(jet: &impl Fn(f64) -> [f64; 4], end: f64, pieces: usize) -> Vec<Node> {
    (0..=pieces)
        .map(|index| {
            let time = end * (index as f64 / pieces as f64);
            (time, jet(time))
        })
        .collect()
}

struct Search<'a, F> {
    jet: &'a F,
    end: f64,
    width: f64,
    /// Time between nodes.
    step: f64,
    /// Velocity at the end; velocities are over it, so that their powers are numbers.
    whole: f64,
    nodes: Vec<Node>,
}

impl<F: Fn(f64) -> [f64; 4]> Search<'_, F> {
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

impl<F: Fn(f64) -> [f64; 4]> Leaf for Search<'_, F> {
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
fn criterion(rise: f64, length: f64) -> f64 {
    if rise > 0.0 && length > 0.0 {
        let mean = rise / length;
        length * mean * mean * mean.sqrt()
    } else {
        0.0
    }
}

/// Largest mean over windows of a width, and largest level held through one of them; `None` if
/// the interval is shorter. The function gives `V`, `a`, `a'` and `a''`.
pub fn held(
    jet: impl Fn(f64) -> [f64; 4],
    end: f64,
    width: f64,
    pieces: usize,
) -> Option<(Window, Window)> {
    if end < width {
        return None;
    }
    let window = |start: f64, value: f64| Window {
        value,
        start,
        end: start + width,
    };
    let troughs = troughs(&jet, end, pieces);
    let mean = |start: f64| (jet(start + width)[0] - jet(start)[0]) / width;
    let level = |start: f64| {
        let inside = |trough: &&[f64; 2]| trough[0] > start && trough[0] < start + width;
        troughs
            .iter()
            .filter(inside)
            .fold(jet(start)[1].min(jet(start + width)[1]), |least, trough| {
                least.min(trough[1])
            })
    };
    let mut best = (window(0.0, mean(0.0)), window(0.0, level(0.0)));
    let mut offer = |start: f64| {
        let other = (mean(start), level(start));
        if other.0 > best.0.value {
            best.0 = window(start, other.0);
        }
        if other.1 > best.1.value {
            best.1 = window(start, other.1);
        }
    };
    // Either optimum has equal accelerations at both ends, or starts or stops with the interval.
    let difference = |start: f64| {
        let [left, right] = [jet(start), jet(start + width)];
        [right[1] - left[1], right[2] - left[2]]
    };
    stationary(difference, 0.0, end - width, pieces, &mut offer);
    offer(end - width);
    Some(best)
}

/// Times and values of the local minima of the acceleration.
fn troughs(jet: &impl Fn(f64) -> [f64; 4], end: f64, pieces: usize) -> Vec<[f64; 2]> {
    let mut found = Vec::new();
    let slope = |time: f64| {
        let [_, _, first, second] = jet(time);
        [first, second]
    };
    stationary(slope, 0.0, end, pieces, |time| {
        let [_, acceleration, _, curve] = jet(time);
        if curve > 0.0 {
            found.push([time, acceleration]);
        }
    });
    found
}

/// First time in an interval at which the acceleration goes below zero; `jet` gives `V`, `a`,
/// `a'` and `a''`, `noise` how far below zero is nothing but rounding. Touching zero is no crossing.
pub fn first_fall(
    jet: impl Fn(f64) -> [f64; 4],
    from: f64,
    to: f64,
    noise: impl Fn(f64) -> f64,
) -> Option<f64> {
    let pair = |time: f64| {
        let [_, value, slope, _] = jet(time);
        [value, slope]
    };
    let [low, high] = [jet(from), jet(to)];
    if high[1] < -noise(to) {
        return Some(if low[1] > 0.0 {
            crate::roots::root(pair, from, to)
        } else {
            from
        });
    }
    if low[2] < 0.0 && high[2] > 0.0 && low[1] > 0.0 {
        let bottom = turning_point(&pair, from, to);
        if jet(bottom)[1] < -noise(bottom) {
            return Some(crate::roots::root(pair, from, bottom));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use crate::criteria::{Impact, MetricOptions};
    use crate::parameters::{Foam, Head, Manipulator, System, Target};

    /// Systems with numbers over many decades; many of them ring.
    fn draw(seed: &mut u64) -> (System, f64) {
        let mut within = |low: f64, high: f64| {
            *seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let share = (*seed >> 11) as f64 / (1_u64 << 53) as f64;
            low * (high / low).powf(share)
        };
        let system = System {
            manipulator: Manipulator {
                mass: within(0.05, 50.0),
                damping: within(0.1, 600.0),
                stiffness: within(1e3, 1e6),
            },
            foam: Foam {
                stiffness: within(1.0, 1e5),
                damping: within(0.1, 400.0),
                thickness: 0.03,
                linear_range: 0.02,
            },
            head: Target::Free(Head {
                mass: within(2.0, 200.0),
                damping: within(1.0, 200.0),
                stiffness: within(100.0, 1e4),
            }),
        };
        (system, within(0.1, 3.0))
    }

    #[test]
    fn no_pair_of_nodes_is_better() {
        let mut seed = 3;
        for _ in 0..300 {
            let (system, speed) = draw(&mut seed);
            let impact = Impact::new(&system, speed, None).unwrap();
            let nodes: u32 = 1500;
            let step = impact.end() / f64::from(nodes);
            let velocity: Vec<f64> = (0..=nodes)
                .map(|node| impact.motion().head(step * f64::from(node))[0])
                .collect();
            for width in [0.015, 0.036] {
                let found = impact.injury(width);
                let mut best = 0.0_f64;
                for (first, from) in velocity.iter().enumerate() {
                    for (steps, to) in velocity[first..].iter().enumerate().skip(1) {
                        let length = step * steps as f64;
                        if length > width {
                            break;
                        }
                        best = best.max((to - from).max(0.0).powi(5) / length.powi(3));
                    }
                }
                let best = best.sqrt();
                assert!(
                    found.value >= best * (1.0 - 1e-12),
                    "{system:?} {speed} {width}: {found:?} {best}"
                );
                assert!(found.end - found.start <= width * (1.0 + 1e-12));
                let rise =
                    impact.motion().head(found.end)[0] - impact.motion().head(found.start)[0];
                let again = super::criterion(rise, found.end - found.start);
                assert!((again - found.value).abs() <= 1e-11 * found.value);
            }
        }
    }

    #[test]
    fn the_best_window_among_many_humps_is_found() {
        // The window of an independent search over all humps.
        let system = System {
            manipulator: Manipulator {
                mass: 0.063_574_854_160_984_36,
                damping: 0.534_205_074_040_328,
                stiffness: 843_635.518_587_817_2,
            },
            foam: Foam {
                stiffness: 3.278_164_464_732_597,
                damping: 28.675_232_797_161_27,
                thickness: 0.03,
                linear_range: 0.02,
            },
            head: Target::Free(Head {
                mass: 190.668_579_613_070_85,
                damping: 68.900_533_231_368_2,
                stiffness: 451.119_524_015_534_24,
            }),
        };
        let impact = Impact::new(&system, 0.383_244_664_189_429_2, None).unwrap();
        let found = impact.injury(0.015);
        assert!((found.start - 0.839_76e-3).abs() < 1e-8, "{found:?}");
        assert!((found.end - found.start - 0.015).abs() < 1e-15);
    }

    #[test]
    fn the_usual_shape_has_one_best_window() {
        let mut seed = 5;
        let options = MetricOptions::default();
        let scale = options.gravity.powi(2) * options.gravity.sqrt();
        let mut usual = 0;
        for _ in 0..4000 {
            let (system, speed) = draw(&mut seed);
            let Some(fast) = crate::batch::usual(&system, speed, &options) else {
                continue;
            };
            usual += 1;
            let impact = Impact::new(&system, speed, None).unwrap();
            for (value, width) in [(fast.hic15, 0.015), (fast.hic36, 0.036)] {
                let global = impact.injury(width).value / scale;
                assert!(
                    (value - global).abs() <= 1e-10 * global,
                    "{system:?} {speed} {width}: {value} {global}"
                );
            }
        }
        assert!(usual > 500, "{usual}");
    }
}
