//! Metrics of impacts side by side, for responses of the usual shape.
//!
//! The response is a sum over two pairs of roots ([`modes`]). A walk in steps of the fastest root
//! notes where slopes change sign ([`scan`]), Newton steps finish what it found. Impacts whose
//! pairs of roots are too close to each other, whose slopes may hide a pair of zeros between
//! two nodes, or whose Newton steps have not settled are refused, criterion by criterion; the caller
//! takes the general search for them. What a lane does depends on its own numbers only, and whether
//! a criterion holds on nothing that another one alone needs, so its bits are the same at any width
//! and whatever else is asked for.

pub(crate) mod apart;
mod arithmetic;
mod factors;
mod humps;
mod masked;
mod maxima;
mod modes;
mod scan;
mod side;
mod space;
mod windows;

use crate::metrics::Searches;
use crate::series::Plant;
use apart::apart;
use arithmetic::{Each, product, third_order};
use masked::{GroupPeaks, GroupRest, MaskedValue};
use modes::{Basis, LaneMotion, Wave};
use numeric::lanes::{Number, Truth};
use pulp::Simd;
use scan::{SignChange, touching};
pub(crate) use side::{MOST_LANES, Rows, Side, Walk, usual};
pub use space::Workspace;
use space::{NODES, Node, NodePair, Walked};

/// Newton steps after which a place is refused.
const MAX_STEPS: usize = 12;
/// Last step to a zero, in cells; its third power is what the place may be wrong by.
const SETTLED_ZERO: f64 = 1e-5;

/// Least slope at the end of an impact over the curvature there: how far, in cells, the end is
/// from where the acceleration turns.
const STEEP: f64 = 0.02;
/// Least squared modulus of the slower pair of roots over the impact: the terms of which the
/// motion is a sum exceed it by the inverse.
const SLOWEST: f64 = 1e-2;

/// Length of a cell times the fastest root.
pub const CELL_ANGLE: f64 = 0.75;
/// [`CELL_ANGLE`] for impacts that are refused with longer cells: half as far between nodes, fewer
/// shapes may hide something.
pub const FINE_CELL_ANGLE: f64 = 0.3;

/// A valley this near to zero, over the largest acceleration, may reach it in cells of
/// [`CELL_ANGLE`]: the fourth derivative of the response, over 384, is what the cubic over a cell is
/// wrong by. It grows with the fourth power of the length of a cell.
const FLAT: f64 = 4e-3;

/// A group of impacts.
pub struct Group<R> {
    /// Their numbers.
    pub plant: Plant<R>,
    /// `v_c`, in m/s.
    pub closing_speed: R,
    /// `v_r`, in m/s.
    pub manipulator_speed: R,
    /// Time until which a release counts, in s.
    pub horizon: f64,
    /// Length of a cell times the fastest root.
    pub cell_angle: f64,
    /// Whether lanes with two humps or a shelf are followed; else they are deferred: it takes so
    /// many steps that they better share them with their like.
    pub humps: bool,
    /// Quantities to search for.
    pub searches: Searches,
}

/// A group with its motion and what the walk along it noted.
pub struct Solved<'a, S, R: Number> {
    simd: S,
    motion: &'a LaneMotion<S, R>,
    /// `v_r`, in m per cell.
    manipulator_speed: R,
    /// Impact period, in cells; the horizon in lanes without a release before it.
    end: R,
    /// Lanes without a release before the horizon.
    lasting: R::Mask,
    at_end: Basis<R>,
    /// Nodes before the end, at most.
    nodes: usize,
    space: &'a mut Walked<R>,
    /// The largest acceleration at a node so far.
    highest: R,
    /// Possible error of the cubic over a cell, as a share of `highest`.
    flat: f64,
    /// Lanes with more than one valley of the acceleration.
    ragged: R::Mask,
    /// Lanes whose acceleration has a flank that flattens and steepens again.
    shelf: R::Mask,
    /// Whether lanes with two humps or a shelf are followed.
    humps: bool,
    /// Quantities to search for.
    searches: Searches,
    /// Lanes whose walk and end hold.
    accepted: R::Mask,
}

impl<R: Number> Group<R> {
    /// Walks along the motion until every impact has ended or is refused.
    #[inline(always)]
    pub fn solve<'a, S: Simd, const POWERS: bool>(
        &self,
        space: &'a mut Workspace<S, R>,
        valid: R::Mask,
    ) -> Solved<'a, S, R> {
        let Workspace {
            simd,
            zero,
            motion,
            walked: space,
        } = space;
        let (simd, zero) = (*simd, *zero);
        let one = zero.like(1.0);
        let none = zero.truth(false);
        let square = (self.cell_angle / CELL_ANGLE) * (self.cell_angle / CELL_ANGLE);
        space.found.clear();
        let mut solved = Solved {
            simd,
            motion: LaneMotion::fill(
                motion,
                simd,
                &self.plant,
                self.closing_speed,
                self.cell_angle,
            ),
            manipulator_speed: zero,
            end: zero,
            lasting: none,
            at_end: [one, zero, one, zero],
            nodes: 0,
            space,
            highest: zero,
            flat: FLAT * (square * square),
            ragged: none,
            shelf: none,
            humps: self.humps,
            searches: self.searches,
            accepted: valid,
        };
        let (length, rate) = (solved.motion.modes.length, solved.motion.modes.rate);
        solved.manipulator_speed = self.manipulator_speed * length;
        solved.accepted = solved.accepted & solved.motion.accepted;
        let horizon = rate * self.horizon;
        let turn = solved.motion.modes.basis(one);
        let mut basis = [one, zero, one, zero];
        solved.reach::<POWERS>(0, &basis, zero);
        let first = &mut solved.space.pair[0];
        // Rounding errors may put it below zero.
        first.acceleration[0] = first.acceleration[0].max(zero);
        solved.space.head[0] = first.head();
        // Also false for what is not a number.
        let mut alive = solved.accepted & turn[0].le(one);
        let mut end = SignChange::none(zero);
        for index in 1..NODES {
            basis = solved.motion.modes.turned(&basis, &turn);
            let time = zero.like(index as f64);
            solved.reach::<POWERS>(index, &basis, time);
            solved.nodes = index;
            solved.space.head[index] = solved.space.pair[index % 2].head();
            let fall = NodePair::ending(&solved.space.pair, index).piece(Node::fall);
            let ends = alive & fall.values[1].lt(zero);
            let lasts = alive & !ends & time.ge(horizon);
            if (ends | lasts).any() {
                end.note(ends | lasts, fall);
                solved.lasting = solved.lasting | lasts;
            }
            alive = alive & !(ends | lasts);
            solved.look::<POWERS>(alive, index);
            if !alive.any() {
                break;
            }
        }
        solved.finish::<POWERS>(&end, horizon);
        solved
    }
}

impl<S: Simd, R: Number> Solved<'_, S, R> {
    /// Puts what is at a node where the node before the last one was.
    #[inline(always)]
    fn reach<const POWERS: bool>(&mut self, index: usize, basis: &Basis<R>, time: R) {
        apart(
            self.simd,
            #[inline(always)]
            || self.space.pair[index % 2] = self.node_here::<POWERS>(basis, time),
        );
    }

    #[inline(always)]
    fn node_here<const POWERS: bool>(&self, basis: &Basis<R>, time: R) -> Node<R> {
        let motion = &self.motion;
        let [stiffness, damping] = motion.foam;
        let rate = motion.compression[1].at(basis) + motion.ramp[1];
        let second = motion.compression[2].at(basis);
        let third = motion.compression[3].at(basis);
        let slope = stiffness.mul_add(rate, damping * second);
        let curve = stiffness.mul_add(second, damping * third);
        let zero = time.like(0.0);
        let (mut manipulator_power, mut foam_power) = ([zero; 2], [zero; 2]);
        let mut velocity = zero;
        if POWERS {
            velocity = motion.head[0].at(basis);
        }
        if POWERS && self.searches.powers {
            let value =
                motion.compression[0].at(basis) + motion.ramp[1].mul_add(time, motion.ramp[0]);
            let force = [stiffness.mul_add(value, damping * rate), slope, curve];
            let [_, slope, curve] = product(force, self.manipulator(basis));
            manipulator_power = [slope, curve];
            let [_, slope, curve] = product(force, [rate, second, third]);
            foam_power = [slope, curve];
        }
        Node {
            time,
            velocity,
            acceleration: Wave::values(&motion.head, 1, basis),
            force: [slope, curve],
            compression: [rate, second],
            manipulator_power,
            foam_power,
        }
    }

    /// Velocity of the manipulator and derivatives.
    #[inline(always)]
    fn manipulator<const N: usize>(&self, basis: &Basis<R>) -> [R; N] {
        let mut values = Wave::values(&self.motion.lag_rate, 0, basis);
        values[0] += self.motion.lag_ramp - self.manipulator_speed;
        for value in &mut values {
            *value = -*value;
        }
        values
    }

    /// Looks for changes of sign in a piece that the impact does not end in.
    #[inline(always)]
    fn look<const POWERS: bool>(&mut self, inside: R::Mask, index: usize) {
        apart(
            self.simd,
            #[inline(always)]
            || self.look_here::<POWERS>(inside, index),
        );
    }

    #[inline(always)]
    fn look_here<const POWERS: bool>(&mut self, inside: R::Mask, index: usize) {
        let zero = self.highest.like(0.0);
        let Walked { pair, found, .. } = &mut *self.space;
        let step = NodePair::ending(pair, index);
        let fall = step.piece(Node::fall);
        let bend = step.piece(
            #[inline(always)]
            |node| [node.acceleration[1], node.acceleration[2]],
        );
        self.highest = self.highest.max(fall.values[0]);
        let slack = self.highest * self.flat;
        let ([dips, _], _) = touching(inside, &fall, slack);
        self.accepted = self.accepted & !dips;
        let ([above, below], beyond) = touching(inside, &bend, zero);
        let wavers = above | below;
        if wavers.any() {
            // A valley may hide there, this much below the lower end.
            let low = fall.values[0].min(fall.values[1]) - beyond * bend.width;
            self.accepted = self.accepted & !(wavers & low.le(zero));
        }
        let [up, still_up] = bend.values.each(
            #[inline(always)]
            |value| value.gt(zero),
        );
        let valley = inside & !up & still_up;
        if valley.any() {
            self.ragged = self.ragged | (valley & found.valley.found);
            found.valley.note(valley, bend);
        }
        if POWERS {
            let [bent_up, still_bent_up] = bend.slopes.each(
                #[inline(always)]
                |slope| slope.gt(zero),
            );
            let fall = !up & !still_up & bent_up & !still_bent_up;
            let rise = up & still_up & !bent_up & still_bent_up;
            self.shelf = self.shelf | (inside & (fall | rise));
        }
        found.acceleration.look(inside, &bend);
        let closing = step.piece(
            #[inline(always)]
            |node| node.compression,
        );
        if self.searches.force {
            found.force.look(
                inside,
                &step.piece(
                    #[inline(always)]
                    |node| node.force,
                ),
            );
        }
        if self.searches.compression {
            found.compression.look(inside, &closing);
        }
        if POWERS && self.searches.powers {
            let power = step.piece(
                #[inline(always)]
                |node| node.manipulator_power,
            );
            found.manipulator_power.look(inside, &power);
            // A foam that expands takes no power.
            let inside = inside & closing.values[0].gt(zero);
            found.foam_power.look(
                inside,
                &step.piece(
                    #[inline(always)]
                    |node| node.foam_power,
                ),
            );
        }
    }

    /// Newton steps to the end of the impact, and a look at the piece before it, or before the horizon
    /// if that comes first.
    #[inline(always)]
    fn finish<const POWERS: bool>(&mut self, end: &SignChange<R>, horizon: R) {
        apart(
            self.simd,
            #[inline(always)]
            || self.finish_here::<POWERS>(end, horizon),
        );
    }

    #[inline(always)]
    fn finish_here<const POWERS: bool>(&mut self, end: &SignChange<R>, horizon: R) {
        let mut time = end.piece().zero();
        let mut open = self.accepted & end.found & !self.lasting;
        let zero = time.like(0.0);
        let mut steep = zero.truth(false);
        self.at_end = self.motion.modes.basis(time);
        for _ in 0..MAX_STEPS {
            let [value, slope, curve] = Wave::values(&self.motion.head, 1, &self.at_end);
            let step = R::select(open, third_order(value, slope, curve), zero);
            time += step;
            // Else it may be a pair of zeros, or none.
            let here = slope.abs().gt(curve.abs() * STEEP);
            steep = (steep & !open) | (here & open);
            let near = step.abs().lt(zero.like(SETTLED_ZERO));
            // Where the step is as small as that, only rounding is lost.
            self.at_end = self.motion.modes.advanced(&self.at_end, step);
            open = open & !near;
            if !open.any() {
                break;
            }
            let anew = self.motion.modes.basis(time);
            for (function, anew) in self.at_end.iter_mut().zip(anew) {
                *function = R::select(open, anew, *function);
            }
        }
        let past = time - end.piece().from;
        let slack = zero.like(1e-9);
        let released =
            !open & steep & past.ge(-slack) & past.le(end.piece().width + slack) & !self.lasting;
        self.accepted = self.accepted & end.found & (released | self.lasting);
        self.lasting = self.accepted & (self.lasting | time.ge(horizon));
        if self.lasting.any() {
            time = R::select(self.lasting, horizon, time);
            let at_horizon = self.motion.modes.basis(horizon);
            for (function, anew) in self.at_end.iter_mut().zip(at_horizon) {
                *function = R::select(self.lasting, anew, *function);
            }
        }
        let slow = self.motion.modes.slow() * time * time;
        self.accepted = self.accepted & slow.gt(zero.like(SLOWEST));
        self.end = time;
        let before = self.motion.modes.basis(end.piece().from);
        let at_end = self.at_end;
        self.reach::<POWERS>(0, &before, end.piece().from);
        self.reach::<POWERS>(1, &at_end, time);
        self.look::<POWERS>(self.accepted, 1);
    }

    /// The other metrics.
    #[inline(always)]
    pub fn rest(&mut self, peaks: &GroupPeaks<R>) -> GroupRest<R> {
        let searches = self.searches;
        let zero = self.end.like(0.0);
        let nothing = [MaskedValue::nothing(zero); 2];
        let found = &self.space.found;
        let hidden = found.acceleration.hidden.0;
        let course = peaks.head_acceleration.holds & !hidden;
        // The horizon cuts off what comes after it like a steep flank: together with one that flattens
        // before it that is a shelf.
        let [_, slope, curve] = Wave::values(&self.motion.head, 1, &self.at_end);
        let cut = self.lasting & (slope.ge(zero) | curve.gt(zero));
        self.shelf = self.shelf | cut;
        let put_off = if self.humps || !searches.windows() {
            zero.truth(false)
        } else {
            course & (found.valley.found | self.shelf)
        };
        let course = course & !put_off;
        let held = if searches.held {
            self.held(course & !self.ragged, &peaks.top)
        } else {
            nothing
        };
        let injury = if searches.injury == [false; 2] {
            nothing
        } else {
            self.injuries(course)
        };
        GroupRest {
            injury,
            held,
            put_off,
        }
    }
}

#[cfg(test)]
mod tests;
