//! Criteria of moving windows, impacts side by side.

use super::apart::apart;
use super::arithmetic::{Each, MapWith, third_order};
use super::modes::{Basis, Wave};
use super::{MAX_STEPS, MaskedValue, Solved};
use crate::metrics::{HELD_WINDOW, INJURY_WINDOWS};
use numeric::lanes::{Number, Truth};
use pulp::Simd;

/// Last step of a window, in cells; its third power is what its place, and with it a level held
/// through it, may be wrong by.
pub(super) const SETTLED: f64 = 1e-4;
/// Last step of a window of which only the mean is wanted, in cells: the mean is wrong by the fourth
/// power, over 24, and by the square of what the place is wrong by.
pub(super) const SETTLED_MEAN: f64 = 1e-3;

/// Window of each lane, for `V` and accelerations per cell.
#[derive(Clone, Copy)]
pub(super) struct LaneWindow<R: Number> {
    pub(super) start: R,
    pub(super) rise: R,
    /// Smaller acceleration at its ends.
    pub(super) edge: R,
    /// Smallest acceleration in it.
    pub(super) level: R,
    /// Lanes in which the steps did not come to rest.
    pub(super) restless: R::Mask,
}

impl<R: Number> LaneWindow<R> {
    /// Level held through a window that a valley may lie in, of which time and value are given.
    #[inline(always)]
    pub(super) fn level_with(&self, width: R, [time, value]: [R; 2]) -> R {
        let inside = time.gt(self.start) & time.lt(self.start + width);
        R::select(inside, self.edge.min(value), self.edge)
    }
}

impl<S: Simd, R: Number> Solved<'_, S, R> {
    /// Velocity, acceleration and two derivatives of the head.
    #[inline(always)]
    pub(super) fn head(&self, time: R) -> [R; 4] {
        self.head_at(&self.motion.modes.basis(time))
    }

    #[inline(always)]
    fn head_at(&self, basis: &Basis<R>) -> [R; 4] {
        Wave::values(&self.motion.head, 0, basis)
    }

    /// The best window of a width for lanes of a mask: equal accelerations at both ends, or it
    /// starts with the impact.
    #[inline(always)]
    pub(super) fn full(&self, mask: R::Mask, width: R, guess: R, settled: f64) -> LaneWindow<R> {
        apart(
            self.simd,
            #[inline(always)]
            || self.full_here(mask, width, guess, settled),
        )
    }

    #[inline(always)]
    fn full_here(&self, mask: R::Mask, width: R, guess: R, settled: f64) -> LaneWindow<R> {
        let zero = width.like(0.0);
        let room = self.end - width;
        let mut start = guess.min(room).max(zero);
        let mut open = mask;
        let mut found = LaneWindow {
            start: zero,
            rise: zero,
            edge: zero,
            level: zero,
            restless: zero.truth(false),
        };
        let over_the_width = self.motion.modes.basis(width);
        for _ in 0..MAX_STEPS {
            let at_start = self.motion.modes.basis(start);
            let at_end = self.motion.modes.turned(&at_start, &over_the_width);
            let [left, right] = [self.head_at(&at_start), self.head_at(&at_end)];
            let [rise, gain, bend, third] = right.map_with(
                left,
                #[inline(always)]
                |right, left| right - left,
            );
            // Towards the better side where the mean is not concave.
            let uphill = R::select(gain.lt(zero), -start, width * 0.5);
            let concave = bend.lt(zero);
            let wanted = R::select(concave, third_order(gain, bend, third), uphill);
            let next = (start + wanted).min(room).max(zero);
            let step = next - start;
            let bent = (step * (1.0 / 6.0)).mul_add(third, bend * 0.5);
            let rise = step.mul_add(step.mul_add(bent, gain), rise);
            let [low, high] = [left, right].each(
                #[inline(always)]
                |[_, value, slope, curve]| step.mul_add((step * 0.5).mul_add(curve, slope), value),
            );
            found.rise = R::select(open, rise, found.rise);
            found.level = R::select(open, low.min(high), found.level);
            // At the end of the room the mean would have to grow still.
            let stuck = next.ge(room) & gain.lt(zero) & !start.le(zero);
            start = R::select(open, next, start);
            open = open & (stuck | !step.abs().lt(zero.like(settled)));
            if !open.any() {
                break;
            }
        }
        found.restless = open;
        found.start = start;
        found.edge = found.level;
        found
    }

    /// Largest 3 ms mean and largest level held for 3 ms, in m/s^2, in lanes of a mask.
    #[inline(always)]
    pub(super) fn held(&self, mask: R::Mask, [time, curve, third]: &[R; 3]) -> [MaskedValue<R>; 2] {
        let rate = self.motion.modes.rate;
        let width = rate * HELD_WINDOW;
        let exists = width.le(self.end);
        // The first terms of the acceleration around its top.
        let half = width * 0.5;
        let skew = half * half * *third / (*curve * 6.0);
        let skew = R::select(skew.abs().lt(half), skew, half.like(0.0));
        let humps = self.space.found.valley.found;
        let plain = mask & exists & !humps;
        let mut window = self.full(plain, width, *time - half - skew, SETTLED);
        let humps = mask & exists & humps;
        if humps.any() {
            let (trough, missed) = self.trough(humps);
            let other = self.full_of_humps(humps & !missed, width, trough);
            window.rise = R::select(humps, other.rise, window.rise);
            window.level = R::select(humps, other.level, window.level);
            window.restless = window.restless | other.restless | missed;
        }
        let nan = width.like(f64::NAN);
        [
            window.rise * rate * (1.0 / HELD_WINDOW),
            window.level * rate * rate,
        ]
        .each(
            #[inline(always)]
            |value| MaskedValue {
                value: R::select(exists, value, nan),
                holds: mask & !window.restless,
            },
        )
    }

    /// Injury criteria in lanes of a mask: the window with free ends where it is not too wide, else
    /// the full one.
    #[inline(always)]
    pub(super) fn injuries(&mut self, mask: R::Mask) -> [MaskedValue<R>; 2] {
        let rate = self.motion.modes.rate;
        let humps = self.space.found.valley.found | self.shelf;
        let plain = mask & !humps;
        let free = self.free_window(plain, self.half_level(), rate.truth(false));
        let [start, end] = free.ends;
        let cut = self.lasting & end.ge(self.end);
        let plain = plain & free.settled & free.concave & !cut;
        let free_width = end - start;
        let mut found = [MaskedValue {
            value: free.value,
            holds: plain,
        }; 2];
        let asked = self.searches.injury;
        for ((known, width), asked) in found.iter_mut().zip(INJURY_WINDOWS).zip(asked) {
            let width = rate * width;
            let wide = plain & free_width.gt(width);
            if !asked || !wide.any() {
                continue;
            }
            // Both ends towards each other, each as its slope tells.
            let [first, last] = free.slopes;
            let share = last / (last - first);
            let possible = share.gt(share.like(0.0)) & share.lt(share.like(1.0));
            let share = R::select(possible, share, share.like(0.5));
            let guess = start + share * (free_width - width);
            let window = self.full(wide, width, guess, SETTLED_MEAN);
            known.value = R::select(wide, criterion(window.rise, width, rate), free.value);
            known.holds = plain & !window.restless;
        }
        let humps = mask & humps;
        if humps.any() {
            self.injuries_of_humps(humps, &mut found);
        }
        found
    }

    /// Newton steps to the best window without a limit of its width, for lanes of a mask; some may
    /// be held to start with the impact.
    #[inline(always)]
    pub(super) fn free_window(&self, mask: R::Mask, guess: [R; 2], held: R::Mask) -> FreeWindow<R> {
        apart(
            self.simd,
            #[inline(always)]
            || self.free_window_here(mask, guess, held),
        )
    }

    #[inline(always)]
    fn free_window_here(&self, mask: R::Mask, guess: [R; 2], held: R::Mask) -> FreeWindow<R> {
        let zero = self.end.like(0.0);
        let [mut start, mut end] = guess;
        let mut open = mask;
        let mut found = FreeWindow {
            ends: [zero; 2],
            slopes: [zero; 2],
            value: zero,
            settled: zero.truth(false),
            concave: zero.truth(false),
        };
        let mut best = zero.truth(false);
        let mut rise = zero;
        for _ in 0..MAX_STEPS {
            let [v1, a1, d1, c1] = self.head(start);
            let [v2, a2, d2, c2] = self.head(end);
            let width = end - start;
            let per_rise = zero.like(1.0) / (v2 - v1);
            let (u1, u2) = (a1 * per_rise, a2 * per_rise);
            let per_width = width.like(1.0) / width;
            let over = per_width * 1.5;
            let factor = zero.like(2.5);
            let (g1, g2) = ((-u1).mul_add(factor, over), u2.mul_add(factor, -over));
            let curve = over * per_width;
            let h11 = (-d1.mul_add(per_rise, u1 * u1)).mul_add(factor, curve);
            let h22 = d2.mul_add(per_rise, -(u2 * u2)).mul_add(factor, curve);
            let h12 = (u1 * 2.5).mul_add(u2, -curve);
            let determinant = h11.mul_add(h22, -(h12 * h12));
            let pinned = held | (start.le(zero) & g1.le(zero));
            let inverse = zero.like(1.0) / R::select(pinned, h22, determinant);
            let s1 = R::select(pinned, zero, h12.mul_add(g2, -(h22 * g1)) * inverse);
            let s2 = R::select(pinned, -g2, h12.mul_add(g1, -(h11 * g2))) * inverse;
            let next = [(start + s1).max(zero), (end + s2).min(self.end)];
            let (s1, s2) = (next[0] - start, next[1] - end);
            let [v1, v2] = [(v1, a1, d1, c1, s1), (v2, a2, d2, c2, s2)].each(
                #[inline(always)]
                |(v, a, d, c, s)| {
                    let bend = (s * (1.0 / 6.0)).mul_add(c, d * 0.5);
                    s.mul_add(s.mul_add(bend, a), v)
                },
            );
            rise = R::select(open, v2 - v1, rise);
            found.slopes = [d1, d2].map_with(
                found.slopes,
                #[inline(always)]
                |new, old| R::select(open, new, old),
            );
            start = R::select(open, next[0], start);
            end = R::select(open, next[1], end);
            let moved = s1.abs() + s2.abs();
            let concave = h22.lt(zero) & (pinned | (h11.lt(zero) & determinant.gt(zero)));
            best = (best & !open) | (concave & open);
            open = open & !moved.lt(zero.like(SETTLED_MEAN));
            if !open.any() {
                break;
            }
        }
        found.ends = [start, end];
        found.value = criterion(rise, end - start, self.motion.modes.rate);
        found.settled = !open & start.lt(end);
        found.concave = best;
        found
    }

    /// Where the acceleration crosses half its peak at the nodes, in cells.
    #[inline(always)]
    fn half_level(&self) -> [R; 2] {
        let (mut start, mut end) = (self.end.like(0.0), self.end);
        let mut peak = self.space.head[0][1];
        for index in 1..=self.nodes {
            let value = self.space.head[index][1];
            // Nodes behind the end depend on what is beside.
            let inside = end.like(index as f64).lt(self.end);
            peak = R::select(inside & value.gt(peak), value, peak);
        }
        let half = peak * 0.5;
        for index in 0..self.nodes {
            let [left, right] = [index, index + 1].each(
                #[inline(always)]
                |node: usize| self.space.head[node][1],
            );
            let rises = left.lt(half) & right.ge(half);
            let falls = left.ge(half) & right.lt(half);
            if !(rises | falls).any() {
                continue;
            }
            let place = (half - left) / (right - left) + index as f64;
            let inside = place.lt(self.end);
            let (rises, falls) = (inside & rises, inside & falls);
            start = R::select(rises, place, start);
            end = R::select(falls, place, end);
        }
        [start, end]
    }
}

/// A window with free ends.
#[derive(Clone, Copy)]
pub(super) struct FreeWindow<R: Number> {
    pub(super) ends: [R; 2],
    /// Slopes of the acceleration there.
    slopes: [R; 2],
    /// Criterion of the window.
    pub(super) value: R,
    /// Lanes in which the steps came to rest.
    pub(super) settled: R::Mask,
    /// Lanes in which the criterion is largest there.
    pub(super) concave: R::Mask,
}

/// `T mean^2.5` from a rise in m per cell, a width in cells and the cells per second.
#[inline(always)]
pub(super) fn criterion<R: Number>(rise: R, width: R, rate: R) -> R {
    let gained = rise * rate;
    let mean = gained * (rate / width);
    let zero = rise.like(0.0);
    R::select(rise.gt(zero), gained * mean * mean.sqrt(), zero)
}
