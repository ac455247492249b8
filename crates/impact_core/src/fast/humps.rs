//! Windows of impacts whose acceleration has two humps or a shelf: several may be the best.

use super::apart::apart;
use super::scan::{Piece, Tops};
use super::windows::{FreeWindow, SETTLED, Window, criterion};
use super::{MAX_STEPS, MapWith, Solved};
use crate::criteria::INJURY_WINDOWS;
use lanes::{Mask, Real};
use pulp::Simd;

/// Windows between nodes that are looked at, at most.
const SEEDS: usize = 4;
/// How much better than between nodes a window may be.
const NEAR: f64 = 1.25;

/// A window between nodes.
#[derive(Clone, Copy)]
struct Seed<R: Real> {
    found: R::Mask,
    ends: [R; 2],
    rise: R,
}

impl<S: Simd, R: Real> Solved<'_, S, R> {
    /// The same where the acceleration has a valley: there may be several good windows.
    #[inline(always)]
    pub(super) fn full_of_humps(&mut self, mask: R::Mask, width: R) -> Window<R> {
        apart(
            self.simd,
            #[inline(always)]
            || self.full_of_humps_here(mask, width),
        )
    }

    #[inline(always)]
    fn full_of_humps_here(&mut self, mask: R::Mask, width: R) -> Window<R> {
        let room = self.end - width;
        let difference = |solved: &Self, time: R| {
            let [left, right] = [solved.head(time), solved.head(time + width)];
            [right[1] - left[1], right[2] - left[2]]
        };
        let tops = self.tops_along(mask, room, difference);
        let trough = self.trough(mask);
        let mut best = self.full(mask, width, R::zero());
        best.level = best.level_with(width, trough);
        for place in &tops.places {
            let also = mask & place.found & self.accepted;
            if also.any() {
                let window = self.full(also, width, place.piece.zero());
                let level = window.level_with(width, trough);
                let better = also & window.rise.gt(best.rise);
                best.rise = R::select(better, window.rise, best.rise);
                best.edge = R::select(better, window.edge, best.edge);
                best.level = R::select(also & level.gt(best.level), level, best.level);
            }
        }
        best
    }

    /// Tops of a function between 0 and an end whose derivative with its slope is given.
    #[inline(always)]
    fn tops_along(
        &mut self,
        mask: R::Mask,
        end: R,
        derivative: impl Fn(&Self, R) -> [R; 2],
    ) -> Tops<R> {
        let mut tops = Tops::new();
        let mut from = R::zero();
        let mut left = derivative(self, from);
        for index in 1..=self.nodes {
            let to = R::splat(index as f64).min(end);
            let right = derivative(self, to);
            let piece = Piece {
                from,
                width: to - from,
                values: [left[0], right[0]],
                slopes: [left[1], right[1]],
            };
            tops.look(mask & from.lt(end), &piece);
            from = to;
            left = right;
            if !(mask & from.lt(end)).any() {
                break;
            }
        }
        self.accepted = self.accepted & !(mask & (tops.odd | tops.hidden.0));
        tops
    }

    /// Time and acceleration of the valley.
    #[inline(always)]
    fn trough(&mut self, mask: R::Mask) -> [R; 2] {
        let mut time = self.valley.piece.zero();
        let mut open = mask & self.accepted;
        let mut value = R::zero();
        for _ in 0..MAX_STEPS {
            let [_, acceleration, slope, curve] = self.head(time);
            let step = -(slope / curve);
            let lowest = acceleration + R::splat(0.5) * step * slope;
            value = R::select(open, lowest, value);
            time = R::select(open, time + step, time);
            open = open & !step.abs().lt(R::splat(SETTLED));
            if !open.any() {
                break;
            }
        }
        self.accepted = self.accepted & !(mask & open);
        [time, value]
    }

    /// The same where there may be several good windows: those that are better than their
    /// neighbors among the windows between nodes are where Newton steps set out.
    #[inline(always)]
    pub(super) fn injuries_of_humps(&mut self, humps: R::Mask, values: &mut [R; 2]) {
        apart(
            self.simd,
            #[inline(always)]
            || self.injuries_of_humps_here(humps, values),
        );
    }

    #[inline(always)]
    fn injuries_of_humps_here(&mut self, humps: R::Mask, values: &mut [R; 2]) {
        let zero = R::zero();
        let length = self.motion.modes.length;
        let mut best = [zero; 2];
        let mut shrinks = [R::Mask::none(); 2];
        for (index, width) in INJURY_WINDOWS.into_iter().enumerate() {
            let width = R::splat(width) / length;
            let full = humps & width.lt(self.end) & self.accepted;
            if full.any() {
                let window = self.full_of_humps(full, width);
                let value = criterion(window.rise, width, length);
                best[index] = R::select(full, value, zero);
                // A shorter window nearby is better, so one with free ends has to be found.
                shrinks[index] = full & (window.edge * width).lt(R::splat(0.6) * window.rise);
            }
        }
        let full = best;
        let before = self.motion.head[0].at_contact();
        let from_contact = |solved: &Self, time: R| {
            let [velocity, acceleration, slope, _] = solved.head(time);
            [
                time * acceleration - R::splat(0.6) * (velocity - before),
                time * slope + R::splat(0.4) * acceleration,
            ]
        };
        let tops = self.tops_along(humps, self.end, from_contact);
        let mut seeds = self.seeds(humps);
        for place in &tops.places {
            let held = humps & place.found & self.accepted;
            if held.any() {
                let window = self.free_window(held, [zero, place.piece.zero()], held);
                self.offer(&mut best, held, &window);
            }
        }
        for seed in &mut seeds {
            // One that is far below what is known already needs no steps.
            let value = criterion(seed.rise, seed.ends[1] - seed.ends[0], length);
            let good = (value * R::splat(NEAR)).gt(full[0]);
            let mask = humps & seed.found & good & self.accepted;
            if mask.any() {
                let window = self.free_window(mask, seed.ends, R::Mask::none());
                self.offer(&mut best, mask, &window);
            }
        }
        for index in 0..2 {
            let missed = shrinks[index] & best[index].le(full[index]);
            self.accepted = self.accepted & !missed;
        }
        for (value, best) in values.iter_mut().zip(best) {
            *value = R::select(humps, best, *value);
        }
    }

    /// Takes a window with free ends where it is not too wide.
    #[inline(always)]
    fn offer(&self, best: &mut [R; 2], mask: R::Mask, window: &FreeWindow<R>) {
        let width = (window.ends[1] - window.ends[0]) * self.motion.modes.length;
        for (best, most) in best.iter_mut().zip(INJURY_WINDOWS) {
            let fits = mask & width.le(R::splat(most));
            *best = R::select(fits, best.max(window.value), *best);
        }
    }

    /// Windows between nodes that are not worse than their neighbors.
    #[inline(always)]
    fn seeds(&mut self, humps: R::Mask) -> [Seed<R>; SEEDS] {
        let zero = R::zero();
        let mut seeds = [Seed {
            found: R::Mask::none(),
            ends: [zero; 2],
            rise: zero,
        }; SEEDS];
        let nodes = self.nodes;
        let last = self.motion.head[0].at(&self.at_end);
        let end = self.end;
        let node = |index: usize, head: &[[R; 2]]| {
            let time = R::splat(index as f64);
            let past = time.ge(end);
            (
                R::select(past, end, time),
                R::select(past, last, head[index][0]),
            )
        };
        let rows = nodes + 1;
        self.space.windows.clear();
        self.space.windows.resize(rows * rows, zero);
        for i in 0..rows {
            let (start, before) = node(i, &self.space.head);
            for j in i + 1..rows {
                let (stop, after) = node(j, &self.space.head);
                let (rise, width) = (after - before, stop - start);
                let square = rise * rise;
                let value = square * square * rise / (width * width * width);
                let real = humps & rise.gt(zero) & width.gt(zero);
                self.space.windows[i * rows + j] = R::select(real, value, zero);
            }
        }
        for i in 0..rows {
            for j in i + 1..rows {
                let value = self.space.windows[i * rows + j];
                let mut top = value.gt(zero);
                for (di, dj) in [
                    (0, 1),
                    (0, 2),
                    (1, 0),
                    (1, 2),
                    (2, 0),
                    (2, 1),
                    (0, 0),
                    (2, 2),
                ] {
                    let (row, column) = (i + di, j + dj);
                    if row >= 1 && row <= rows && column >= 1 && column <= rows {
                        let other = self.space.windows[(row - 1) * rows + column - 1];
                        // Of two equal ones the first.
                        let before = (di, dj) < (1, 1);
                        top = top
                            & if before {
                                other.lt(value)
                            } else {
                                other.le(value)
                            };
                    }
                }
                if !top.any() {
                    continue;
                }
                let (start, before) = node(i, &self.space.head);
                let (stop, after) = node(j, &self.space.head);
                let mut left = top;
                for seed in &mut seeds {
                    let here = left & !seed.found;
                    seed.found = seed.found | here;
                    seed.ends =
                        [start, stop].map_with(seed.ends, |new, old| R::select(here, new, old));
                    seed.rise = R::select(here, after - before, seed.rise);
                    left = left & !here;
                }
                self.accepted = self.accepted & !left;
            }
        }
        seeds
    }
}
