//! Windows of impacts whose acceleration has two humps or a shelf: several may be the best.

use super::apart::{apart, inlined};
use super::arithmetic::{Each, MapWith};
use super::modes::{Basis, Wave};
use super::scan::{Piece, Tops};
use super::space::Walked;
use super::windows::{FreeWindow, LaneWindow, SETTLED, criterion};
use super::{MAX_STEPS, MaskedValue, Solved};
use crate::metrics::INJURY_WINDOWS;
use numeric::lanes::{Number, Truth};
use pulp::Simd;

/// Places of windows from which Newton steps set out, at most.
const SEEDS: usize = 6;
/// How much better than in the middle of its cells a window may be.
const NEAR: f64 = 1.5;
/// How far from the middle of its cells a window may be, in cells.
const FAR: f64 = 2.0;
/// Largest acceleration over that in the nodes, at most: only windows that stop with the horizon, of
/// which nothing else is known, ask for it.
const BETWEEN: f64 = 1.25;
/// A stationary window this near to the best one has to be a maximum itself.
const CLOSE: f64 = 0.99;

/// A pair of cells, with a start in one and an end in the other, that may hold the best window.
#[derive(Clone, Copy)]
struct Seed<R: Number> {
    found: R::Mask,
    /// The middle of both.
    ends: [R; 2],
    /// `rise^2.5 width^-1.5` there, squared.
    square: R,
}

impl<S: Simd, R: Number> Solved<'_, S, R> {
    /// Best windows of a width where the acceleration has a valley: there may be several good ones.
    #[inline(always)]
    pub(super) fn full_of_humps(&self, mask: R::Mask, width: R, trough: [R; 2]) -> LaneWindow<R> {
        apart(
            self.simd,
            #[inline(always)]
            || self.full_of_humps_here(mask, width, trough),
        )
    }

    #[inline(always)]
    fn full_of_humps_here(&self, mask: R::Mask, width: R, trough: [R; 2]) -> LaneWindow<R> {
        let modes = &self.motion.modes;
        let room = self.end - width;
        // The mean grows with the start by the difference of the accelerations at both ends.
        let over_the_width = modes.basis(width);
        let difference = modes.growth(self.motion.head[1], &over_the_width);
        let bend = modes.slope(difference);
        let (tops, lost) = self.tops_along(
            mask,
            room,
            &modes.basis(room),
            #[inline(always)]
            |basis, _| [difference.at(basis), bend.at(basis)],
        );
        let mask = mask & !lost;
        let mut best = self.full(mask, width, width.like(0.0), SETTLED);
        best.level = best.level_with(width, trough);
        best.restless = best.restless | lost;
        let [first, second] = tops.places;
        let others = [
            (first.found, first.piece().zero()),
            (second.found, second.piece().zero()),
            // The best one may stop with the horizon.
            (self.lasting, room),
        ];
        for (found, guess) in others {
            let also = mask & found & !best.restless;
            if also.any() {
                let window = self.full(also, width, guess, SETTLED);
                let level = window.level_with(width, trough);
                let better = also & window.rise.gt(best.rise);
                best.rise = R::select(better, window.rise, best.rise);
                best.edge = R::select(better, window.edge, best.edge);
                best.level = R::select(also & level.gt(best.level), level, best.level);
                best.restless = best.restless | window.restless;
            }
        }
        best
    }

    /// Tops of a function between 0 and an end whose derivative with its slope is given, and lanes that
    /// have more of them or may hide one. It is evaluated in the nodes and at the end.
    #[inline(always)]
    fn tops_along(
        &self,
        mask: R::Mask,
        end: R,
        at_end: &Basis<R>,
        derivative: impl Fn(&Basis<R>, R) -> [R; 2],
    ) -> (Tops<R>, R::Mask) {
        let (zero, one) = (end.like(0.0), end.like(1.0));
        let modes = &self.motion.modes;
        let turn = modes.basis(one);
        let mut tops = Tops::new(zero);
        let mut from = zero;
        let mut basis = [one, zero, one, zero];
        let mut left = derivative(&basis, from);
        for index in 1..=self.nodes {
            basis = modes.turned(&basis, &turn);
            let time = end.like(index as f64);
            let inside = time.lt(end);
            let here = basis.map_with(
                *at_end,
                #[inline(always)]
                |at_node, at_end| R::select(inside, at_node, at_end),
            );
            let to = R::select(inside, time, end);
            let right = derivative(&here, to);
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
        let lost = mask & (tops.odd | tops.hidden.0);
        (tops, lost)
    }

    /// Time and acceleration of the valley, and lanes in which it was not found.
    #[inline(always)]
    pub(super) fn trough(&self, mask: R::Mask) -> ([R; 2], R::Mask) {
        apart(
            self.simd,
            #[inline(always)]
            || self.trough_here(mask),
        )
    }

    #[inline(always)]
    fn trough_here(&self, mask: R::Mask) -> ([R; 2], R::Mask) {
        let mut time = self.space.found.valley.piece().zero();
        let mask = mask & self.space.found.valley.found;
        let mut open = mask;
        let zero = time.like(0.0);
        let mut value = zero;
        let mut bent_up = zero.truth(false);
        for _ in 0..MAX_STEPS {
            let [_, acceleration, slope, curve] = self.head(time);
            let step = -(slope / curve);
            let up = curve.gt(zero);
            bent_up = (bent_up & !open) | (up & open);
            let lowest = acceleration + step * 0.5 * slope;
            value = R::select(open, lowest, value);
            time = R::select(open, time + step, time);
            open = open & !step.abs().lt(zero.like(SETTLED));
            if !open.any() {
                break;
            }
        }
        let past = time - self.space.found.valley.piece().from;
        let slack = zero.like(SETTLED);
        let inside = past.ge(-slack) & past.le(self.space.found.valley.piece().width + slack);
        let missed = mask & (open | !bent_up | !inside);
        // Without a valley, a time that no window holds.
        ([R::select(mask, time, zero.like(-1.0)), value], missed)
    }

    /// Injury criteria where there may be several good windows: Newton steps set out from windows
    /// between nodes that are better than their neighbors.
    #[inline(always)]
    pub(super) fn injuries_of_humps(&mut self, humps: R::Mask, known: &mut [MaskedValue<R>; 2]) {
        apart(
            self.simd,
            #[inline(always)]
            || self.injuries_of_humps_here(humps, known),
        );
    }

    #[inline(always)]
    fn injuries_of_humps_here(&mut self, humps: R::Mask, known: &mut [MaskedValue<R>; 2]) {
        let rate = self.motion.modes.rate;
        let zero = rate.like(0.0);
        let mut best = [zero; 2];
        let mut shrinks = [zero.truth(false); 2];
        let mut holds = [humps; 2];
        // The narrower windows show where the wider ones need no search.
        let asked = [true, self.searches.injury[1]];
        // No level is wanted that a valley would limit.
        let nowhere = [zero.like(-1.0), zero];
        for (index, width) in INJURY_WINDOWS.into_iter().enumerate() {
            let width = rate * width;
            let full = humps & width.lt(self.end);
            if asked[index] && full.any() {
                let window = self.full_of_humps(full, width, nowhere);
                let value = criterion(window.rise, width, rate);
                best[index] = R::select(full & !window.restless, value, zero);
                holds[index] = holds[index] & !window.restless;
                // A shorter window nearby is better, so one with free ends has to be found.
                shrinks[index] = full & (window.edge * width).lt(window.rise * 0.6);
            }
        }
        let full = best;
        let before = self.motion.head[0].at_contact();
        // Over the time, as all of it is zero at contact; there it may start to grow from zero.
        let from_contact = inlined(
            #[inline(always)]
            |basis: &Basis<R>, time: R| {
                let [velocity, acceleration, slope] = Wave::values(&self.motion.head, 0, basis);
                let started = time.gt(zero);
                let span = R::select(started, time, zero.like(1.0));
                let mean = (velocity - before) / span;
                let bend = (acceleration - mean) / span;
                let smallest = zero.like(f64::MIN_POSITIVE);
                [
                    R::select(
                        started,
                        acceleration - mean * 0.6,
                        (acceleration * 0.4).max(smallest),
                    ),
                    slope - R::select(started, bend, slope * 0.5) * 0.6,
                ]
            },
        );
        let (tops, lost) = self.tops_along(humps, self.end, &self.at_end, from_contact);
        let (seeds, more) = self.seeds(humps);
        let mut refused = lost | more;
        for place in &tops.places {
            let held = humps & place.found & !refused;
            if held.any() {
                let window = self.free_window(held, [zero, place.piece().zero()], held);
                refused = refused | (held & !(window.settled & window.concave));
                self.offer(&mut best, held, &window);
            }
        }
        for seed in &seeds {
            // One that is far below what is known already needs no steps.
            let value = seed.square.sqrt() * (rate * rate * rate * rate);
            let good = (value * NEAR).gt(full[0]);
            let mask = humps & seed.found & good & !refused;
            if mask.any() {
                let window = self.free_window(mask, seed.ends, zero.truth(false));
                let [start, end] = window.ends.map_with(
                    seed.ends,
                    #[inline(always)]
                    |end, guess| (end - guess).abs(),
                );
                let far = start.gt(zero.like(FAR)) | end.gt(zero.like(FAR));
                refused = refused | (mask & (far | !window.settled));
                let flat = mask & !window.concave;
                self.offer(&mut best, mask & !flat, &window);
                for (holds, best) in holds.iter_mut().zip(best) {
                    let rival = window.value.gt(best * CLOSE);
                    *holds = *holds & !(flat & rival);
                }
            }
        }
        let lasting = humps & self.lasting;
        if lasting.any() {
            for (index, width) in INJURY_WINDOWS.into_iter().enumerate() {
                let width = rate * width;
                let steepest = self.steepest_after(self.end - width) * BETWEEN;
                let bound = criterion(steepest * width, width, rate);
                holds[index] = holds[index] & !(lasting & bound.gt(best[index]));
            }
        }
        for (index, known) in known.iter_mut().enumerate() {
            let missed = shrinks[index] & best[index].le(full[index]);
            known.value = R::select(humps, best[index], known.value);
            known.holds = known.holds | (holds[index] & !missed & !refused);
        }
    }

    /// Largest acceleration in the nodes from one before a time on, and at the end.
    #[inline(always)]
    fn steepest_after(&self, time: R) -> R {
        let first = time - 1.0;
        let mut steepest = self.motion.head[1].at(&self.at_end);
        for (index, [_, acceleration]) in self.space.head.iter().enumerate().take(self.nodes) {
            let node = time.like(index as f64);
            let inside = node.ge(first) & node.lt(self.end);
            let higher = inside & acceleration.gt(steepest);
            steepest = R::select(higher, *acceleration, steepest);
        }
        steepest
    }

    /// Takes a window with free ends where it is not too wide.
    #[inline(always)]
    fn offer(&self, best: &mut [R; 2], mask: R::Mask, window: &FreeWindow<R>) {
        let width = (window.ends[1] - window.ends[0]) * self.motion.modes.length;
        for (best, most) in best.iter_mut().zip(INJURY_WINDOWS) {
            let fits = mask & width.le(width.like(most));
            *best = R::select(fits, best.max(window.value), *best);
        }
    }

    /// Pairs of cells in which a window is stationary: both derivatives of the criterion change
    /// sign in them. Lanes that have more of them.
    #[inline(always)]
    fn seeds(&mut self, humps: R::Mask) -> ([Seed<R>; SEEDS], R::Mask) {
        let zero = self.end.like(0.0);
        let none = zero.truth(false);
        let mut seeds = [Seed {
            found: none,
            ends: [zero; 2],
            square: zero,
        }; SEEDS];
        let mut more = none;
        let at_end = [self.end, self.motion.head[0].at(&self.at_end), zero];
        let end = self.end;
        let rows = self.nodes + 1;
        let Walked {
            head,
            clipped,
            signs,
            ..
        } = &mut *self.space;
        clipped.clear();
        for (index, [velocity, acceleration]) in head.iter().enumerate().take(rows) {
            let time = end.like(index as f64);
            let past = time.ge(end);
            let node = [time, *velocity, *acceleration];
            clipped.push(node.map_with(
                at_end,
                #[inline(always)]
                |node, end| R::select(past, end, node),
            ));
        }
        for row in signs.iter_mut() {
            row.resize(rows, [none; 2]);
        }
        let [above, here] = signs;
        for (i, &[start, before, first]) in clipped.iter().enumerate() {
            // Signs of both derivatives of the criterion, times something positive; as the width goes to
            // zero they are those of the acceleration.
            std::mem::swap(above, here);
            here[i] = [first.gt(zero); 2];
            for (&[stop, after, last], signs) in clipped[i + 1..].iter().zip(&mut here[i + 1..]) {
                let (rise, width) = ((after - before) * 0.6, stop - start);
                *signs = [first, last].each(
                    #[inline(always)]
                    |at: R| (at * width).gt(rise),
                );
            }
            if i == 0 {
                continue;
            }
            let [last_start, last_before, _] = clipped[i - 1];
            let column = inlined(
                #[inline(always)]
                |j: usize| {
                    let [up, down]: [[R::Mask; 2]; 2] = [above[j], here[j]];
                    (
                        [up[0] | down[0], up[1] | down[1]],
                        [up[0] & down[0], up[1] & down[1]],
                    )
                },
            );
            let (mut any, mut all) = column(i);
            for j in i..rows - 1 {
                let (next_any, next_all) = column(j + 1);
                let [stop, after, _] = clipped[j];
                let mut found = humps & stop.lt(end);
                for side in 0..2 {
                    found = found & (any[side] | next_any[side]) & !(all[side] & next_all[side]);
                }
                (any, all) = (next_any, next_all);
                if !found.any() {
                    continue;
                }
                let [next_stop, next_after, _] = clipped[j + 1];
                let rise = (after + next_after - last_before - before) * 0.5;
                let ends = [(last_start + start) * 0.5, (stop + next_stop) * 0.5];
                let width = ends[1] - ends[0];
                let square = rise * rise;
                let square = square * square * rise / (width * width * width);
                let mut left = found;
                for seed in &mut seeds {
                    let new = left & !seed.found;
                    seed.found = seed.found | new;
                    seed.ends = ends.map_with(
                        seed.ends,
                        #[inline(always)]
                        |end, old| R::select(new, end, old),
                    );
                    seed.square = R::select(new, square, seed.square);
                    left = left & !new;
                    if !left.any() {
                        break;
                    }
                }
                more = more | left;
            }
        }
        (seeds, more)
    }
}
