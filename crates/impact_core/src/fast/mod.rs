//! Metrics of impacts side by side, for responses of the usual shape.
//!
//! The response is a sum over two pairs of roots ([`modes`]). A walk in steps of the fastest root
//! notes where slopes change sign ([`scan`]), Newton steps finish what it found. Impacts whose
//! pairs of roots are too close to each other, whose slopes may hide a pair of zeros between
//! two nodes, or whose Newton steps have not settled are refused; the caller takes the general
//! search for them. What a lane does depends on its own numbers only, so its bits are the same at
//! any width.

pub(crate) mod apart;
mod elementary;
mod humps;
mod maxima;
mod modes;
mod scan;
mod windows;

use crate::series::Plant;
use apart::apart;
use lanes::{Mask, Real};
use modes::{Basis, Motion};
use pulp::Simd;
use scan::{Piece, Place, Tops, touching};

/// Nodes after which an impact is refused.
const NODES: usize = 65;
/// Newton steps after which a place is refused.
const MAX_STEPS: usize = 12;
/// Last step to a zero, in cells; its third power is what the place may be wrong by.
const SETTLED_ZERO: f64 = 1e-5;

/// Space for the nodes of a group.
pub struct Workspace<R> {
    /// Velocity of the head, up to a constant, and its acceleration.
    head: [[R; 2]; NODES],
    /// Derivatives of the criterion of windows between nodes by their start and end, times
    /// something positive.
    windows: Vec<[R; 2]>,
}

impl<R: Real> Workspace<R> {
    /// Space for one group after the other.
    #[must_use]
    pub fn new() -> Self {
        Self {
            head: [[R::zero(); 2]; NODES],
            windows: Vec::new(),
        }
    }
}

impl<R: Real> Default for Workspace<R> {
    fn default() -> Self {
        Self::new()
    }
}

/// Least slope at the end of an impact over the curvature there: how far, in cells, the end is
/// from where the acceleration turns.
const STEEP: f64 = 0.02;
/// Least squared modulus of the slower pair of roots over the impact: the terms of which the
/// motion is a sum exceed it by the inverse.
const SLOWEST: f64 = 1e-2;

/// Length of a cell times the fastest root.
pub const CELL_ANGLE: f64 = 0.75;
/// The same for impacts that are refused with longer cells: half as far between nodes, fewer
/// shapes may hide something.
pub const FINE_CELL_ANGLE: f64 = 0.3;

/// A valley this near to zero, over the largest acceleration, may reach it: the fourth derivative
/// of the response, over 384, is what the cubic over a cell is wrong by.
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
    /// Whether lanes with two humps or a shelf are followed; else they are put off: it takes so
    /// many steps that they better share them with their like.
    pub humps: bool,
}

/// Peaks and duration.
pub struct GroupPeaks<R: Real> {
    /// Acceleration of the head, in m/s^2.
    pub head_acceleration: R,
    /// Contact force, in N.
    pub contact_force: R,
    /// Compression, in m.
    pub compression: R,
    /// Impact period, in s.
    pub duration: R,
    /// Lanes whose numbers hold.
    pub accepted: R::Mask,
    /// Time of the peak acceleration and two derivatives after it.
    top: [R; 3],
}

/// All other metrics, accelerations in m/s^2.
pub struct GroupRest<R: Real> {
    /// Mean acceleration.
    pub mean: R,
    /// Injury criteria for both windows.
    pub injury: [R; 2],
    /// Largest 3 ms mean.
    pub average: R,
    /// Largest level held for 3 ms.
    pub clip: R,
    /// Power from the manipulator, in W.
    pub manipulator_power: R,
    /// Power of compression, in W.
    pub foam_power: R,
    /// Lanes whose numbers hold.
    pub accepted: R::Mask,
    /// Lanes that are put off.
    pub put_off: R::Mask,
}

/// Values and slopes at a node of all functions whose signs matter.
#[derive(Clone, Copy)]
struct Node<R> {
    time: R,
    velocity: R,
    acceleration: [R; 3],
    force: [R; 2],
    compression: [R; 2],
    manipulator_power: [R; 2],
    foam_power: [R; 2],
}

/// A group with its motion and what the walk along it noted.
pub struct Solved<'a, S, R: Real> {
    simd: S,
    motion: Motion<S, R>,
    /// `v_r`, in m per cell.
    manipulator_speed: R,
    /// Impact period, in cells.
    end: R,
    at_end: Basis<R>,
    /// Nodes before the end, at most.
    nodes: usize,
    space: &'a mut Workspace<R>,
    acceleration: Tops<R>,
    /// The largest acceleration at a node so far.
    highest: R,
    /// A valley of the acceleration.
    valley: Place<R>,
    /// Lanes with more of them.
    ragged: R::Mask,
    /// Lanes whose acceleration has a flank that flattens and steepens again.
    shelf: R::Mask,
    /// Whether such lanes are followed.
    humps: bool,
    force: Tops<R>,
    compression: Tops<R>,
    manipulator_power: Tops<R>,
    foam_power: Tops<R>,
    accepted: R::Mask,
}

/// Values at a node, and at the next one.
struct Step<'a, R> {
    left: &'a Node<R>,
    right: &'a Node<R>,
}

impl<R: Real> Step<'_, R> {
    #[inline(always)]
    fn piece(&self, of: impl Fn(&Node<R>) -> [R; 2]) -> Piece<R> {
        let [left, right] = [of(self.left), of(self.right)];
        Piece {
            from: self.left.time,
            width: self.right.time - self.left.time,
            values: [left[0], right[0]],
            slopes: [left[1], right[1]],
        }
    }
}

impl<R: Real> Group<R> {
    /// Walks along the motion until every impact has ended or is refused.
    #[inline(always)]
    pub fn solve<'a, S: Simd, const POWERS: bool>(
        &self,
        simd: S,
        space: &'a mut Workspace<R>,
        valid: R::Mask,
    ) -> Solved<'a, S, R> {
        let motion = Motion::new(simd, &self.plant, self.closing_speed, self.cell_angle);
        let (zero, one) = (R::zero(), R::splat(1.0));
        let mut solved = Solved {
            simd,
            manipulator_speed: self.manipulator_speed * motion.modes.length,
            end: zero,
            at_end: [one, zero, one, zero],
            nodes: 0,
            space,
            acceleration: Tops::new(),
            highest: zero,
            valley: Place::none(),
            ragged: R::Mask::none(),
            shelf: R::Mask::none(),
            humps: self.humps,
            force: Tops::new(),
            compression: Tops::new(),
            manipulator_power: Tops::new(),
            foam_power: Tops::new(),
            accepted: valid & motion.accepted,
            motion,
        };
        let turn = solved.motion.modes.basis(one);
        let horizon = R::splat(self.horizon) / solved.motion.modes.length;
        let mut basis = [one, zero, one, zero];
        let mut left = solved.node::<POWERS>(&basis, zero);
        // Rounding errors may put it below zero.
        left.acceleration[0] = left.acceleration[0].max(zero);
        // Also false for what is not a number.
        let mut alive = solved.accepted & turn[0].le(one);
        let mut end = Place::none();
        solved.space.head[0] = [left.velocity, left.acceleration[0]];
        for index in 1..NODES {
            basis = solved.motion.modes.turned(&basis, &turn);
            let right = solved.node::<POWERS>(&basis, R::splat(index as f64));
            solved.nodes = index;
            solved.space.head[index] = [right.velocity, right.acceleration[0]];
            let step = Step {
                left: &left,
                right: &right,
            };
            let fall = step.piece(|node| [node.acceleration[0], node.acceleration[1]]);
            let ends = alive & fall.values[1].lt(zero);
            end.note(ends, fall);
            alive = alive & !ends;
            solved.look::<POWERS>(alive, &step);
            alive = alive & right.time.lt(horizon);
            left = right;
            if !alive.any() {
                break;
            }
        }
        solved.finish::<POWERS>(&end, horizon);
        solved
    }
}

impl<S: Simd, R: Real> Solved<'_, S, R> {
    #[inline(always)]
    fn node<const POWERS: bool>(&self, basis: &Basis<R>, time: R) -> Node<R> {
        apart(
            self.simd,
            #[inline(always)]
            || self.node_here::<POWERS>(basis, time),
        )
    }

    #[inline(always)]
    fn node_here<const POWERS: bool>(&self, basis: &Basis<R>, time: R) -> Node<R> {
        let motion = &self.motion;
        let [stiffness, damping] = motion.foam;
        let rate = motion.compression[1].at(basis) + motion.ramp[1];
        let second = motion.compression[2].at(basis);
        let third = motion.compression[3].at(basis);
        let slope = stiffness * rate + damping * second;
        let curve = stiffness * second + damping * third;
        let (mut manipulator_power, mut foam_power) = ([R::zero(); 2], [R::zero(); 2]);
        let mut velocity = R::zero();
        if POWERS {
            velocity = motion.head[0].at(basis);
            let value = motion.compression[0].at(basis) + (motion.ramp[0] + motion.ramp[1] * time);
            let force = [stiffness * value + damping * rate, slope, curve];
            let [_, slope, curve] = product(force, self.manipulator(basis));
            manipulator_power = [slope, curve];
            let [_, slope, curve] = product(force, [rate, second, third]);
            foam_power = [slope, curve];
        }
        Node {
            time,
            velocity,
            acceleration: [1, 2, 3].each(|order: usize| motion.head[order].at(basis)),
            force: [slope, curve],
            compression: [rate, second],
            manipulator_power,
            foam_power,
        }
    }

    /// Velocity of the manipulator and two derivatives.
    #[inline(always)]
    fn manipulator(&self, basis: &Basis<R>) -> [R; 3] {
        let [rate, second, third] = self.motion.lag_rate.each(|wave| wave.at(basis));
        [
            self.manipulator_speed - (rate + self.motion.lag_ramp),
            -second,
            -third,
        ]
    }

    /// Looks for changes of sign in a piece that the impact does not end in.
    #[inline(always)]
    fn look<const POWERS: bool>(&mut self, inside: R::Mask, step: &Step<'_, R>) {
        apart(
            self.simd,
            #[inline(always)]
            || self.look_here::<POWERS>(inside, step),
        );
    }

    #[inline(always)]
    fn look_here<const POWERS: bool>(&mut self, inside: R::Mask, step: &Step<'_, R>) {
        let zero = R::zero();
        let fall = step.piece(|node| [node.acceleration[0], node.acceleration[1]]);
        let bend = step.piece(|node| [node.acceleration[1], node.acceleration[2]]);
        self.highest = self.highest.max(fall.values[0]);
        let slack = R::splat(FLAT) * self.highest;
        let ([dips, _], _) = touching(inside, &fall, slack);
        self.accepted = self.accepted & !dips;
        let ([above, below], beyond) = touching(inside, &bend, zero);
        let wavers = above | below;
        if wavers.any() {
            // A valley may hide there, this much below the lower end.
            let low = fall.values[0].min(fall.values[1]) - beyond * bend.width;
            self.accepted = self.accepted & !(wavers & low.le(zero));
        }
        let [up, still_up] = bend.values.each(|value| value.gt(zero));
        let valley = inside & !up & still_up;
        if valley.any() {
            self.ragged = self.ragged | (valley & self.valley.found);
            self.valley.note(valley, bend);
        }
        if POWERS {
            let [bent_up, still_bent_up] = bend.slopes.each(|slope| slope.gt(zero));
            let fall = !up & !still_up & bent_up & !still_bent_up;
            let rise = up & still_up & !bent_up & still_bent_up;
            self.shelf = self.shelf | (inside & (fall | rise));
        }
        self.acceleration.look(inside, &bend);
        self.force.look(inside, &step.piece(|node| node.force));
        let closing = step.piece(|node| node.compression);
        self.compression.look(inside, &closing);
        if POWERS {
            let power = step.piece(|node| node.manipulator_power);
            self.manipulator_power.look(inside, &power);
            // A foam that expands takes no power.
            let inside = inside & closing.values[0].gt(zero);
            self.foam_power
                .look(inside, &step.piece(|node| node.foam_power));
        }
    }

    /// Newton steps to the end of the impact, and a look at the piece before it.
    #[inline(always)]
    fn finish<const POWERS: bool>(&mut self, end: &Place<R>, horizon: R) {
        apart(
            self.simd,
            #[inline(always)]
            || self.finish_here::<POWERS>(end, horizon),
        );
    }

    #[inline(always)]
    fn finish_here<const POWERS: bool>(&mut self, end: &Place<R>, horizon: R) {
        let mut time = end.piece.zero();
        let mut open = self.accepted & end.found;
        let mut steep = R::Mask::none();
        for _ in 0..MAX_STEPS {
            let basis = self.motion.modes.basis(time);
            let [value, slope, curve] =
                [1, 2, 3].each(|order: usize| self.motion.head[order].at(&basis));
            let step = third_order(value, slope, curve);
            time = R::select(open, time + step, time);
            // Else it may be a pair of zeros, or none.
            let here = slope.abs().gt(R::splat(STEEP) * curve.abs());
            steep = (steep & !open) | (here & open);
            open = open & !step.abs().lt(R::splat(SETTLED_ZERO));
            if !open.any() {
                break;
            }
        }
        let past = time - end.piece.from;
        let slack = R::splat(1e-9);
        self.accepted = self.accepted
            & end.found
            & !open
            & steep
            & (self.motion.modes.slow() * time * time).gt(R::splat(SLOWEST))
            & past.ge(-slack)
            & past.le(end.piece.width + slack)
            & time.lt(horizon);
        self.end = time;
        self.at_end = self.motion.modes.basis(time);
        let before = self.motion.modes.basis(end.piece.from);
        let left = self.node::<POWERS>(&before, end.piece.from);
        let right = self.node::<POWERS>(&self.at_end, time);
        let step = Step {
            left: &left,
            right: &right,
        };
        self.look::<POWERS>(self.accepted, &step);
    }

    /// The other metrics.
    #[inline(always)]
    pub fn rest(&mut self, peaks: &GroupPeaks<R>) -> GroupRest<R> {
        let length = self.motion.modes.length;
        let velocity = self.motion.head[0];
        let gained = velocity.at(&self.at_end) - velocity.at_contact();
        let put_off = if self.humps {
            R::Mask::none()
        } else {
            self.accepted & (self.valley.found | self.shelf)
        };
        self.accepted = self.accepted & !put_off;
        let powers = self.powers();
        let [average, clip] = self.held(&peaks.top);
        let injury = self.injuries();
        GroupRest {
            mean: gained / (self.end * length * length),
            injury,
            average,
            clip,
            manipulator_power: powers[0] / length,
            foam_power: powers[1] / length,
            accepted: self.accepted,
            put_off,
        }
    }
}

/// A function of every entry of a short array, in line: the standard `map` becomes a function of
/// its own for entries this wide.
trait Each<T> {
    type Of<U>;
    fn each<U>(self, map: impl FnMut(T) -> U) -> Self::Of<U>;
}

macro_rules! each {
    ($count:literal: $($entry:ident),+) => {
        impl<T> Each<T> for [T; $count] {
            type Of<U> = [U; $count];
            #[inline(always)]
            fn each<U>(self, mut map: impl FnMut(T) -> U) -> [U; $count] {
                let [$($entry),+] = self;
                [$(map($entry)),+]
            }
        }
    };
}
each!(2: a, b);
each!(3: a, b, c);
each!(4: a, b, c, d);
each!(5: a, b, c, d, e);

/// Pairs of two arrays, one by one.
trait MapWith<R> {
    fn map_with(self, other: Self, map: impl Fn(R, R) -> R) -> Self;
}

impl<R: Copy, const N: usize> MapWith<R> for [R; N] {
    #[inline(always)]
    fn map_with(mut self, other: Self, map: impl Fn(R, R) -> R) -> Self {
        for (mine, theirs) in self.iter_mut().zip(other) {
            *mine = map(*mine, theirs);
        }
        self
    }
}

/// Step to a zero from value, slope and curvature near it, of third order.
#[inline(always)]
fn third_order<R: Real>(value: R, slope: R, curve: R) -> R {
    let newton = value / slope;
    let bend = R::splat(0.5) * newton * curve / slope;
    let mild = bend.abs().lt(R::splat(0.5));
    -(newton / R::select(mild, R::splat(1.0) - bend, R::splat(1.0)))
}

/// Value and two derivatives of a product.
#[inline(always)]
fn product<R: Real>([f, f1, f2]: [R; 3], [g, g1, g2]: [R; 3]) -> [R; 3] {
    let cross = f1 * g1;
    [f * g, f1 * g + f * g1, f2 * g + cross + cross + f * g2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::{Foam, HEAD_MINIMUM, MANIPULATOR_1, System, Target};
    use pulp::Scalar;

    #[test]
    fn a_map_of_foams_has_the_usual_shape() {
        let nodes = 60;
        let mut refused = 0;
        let mut space = Workspace::new();
        for row in 0..nodes * nodes {
            let system = System {
                manipulator: MANIPULATOR_1,
                foam: Foam {
                    stiffness: 10e3 + 50e3 * f64::from(row % nodes) / f64::from(nodes),
                    damping: 200.0 * f64::from(row / nodes) / f64::from(nodes),
                    thickness: 0.0254,
                    linear_range: 0.02,
                },
                head: Target::Free(HEAD_MINIMUM),
            };
            let group = Group {
                plant: Plant::of(&system),
                closing_speed: 1.25,
                manipulator_speed: 1.25,
                horizon: 0.2,
                cell_angle: CELL_ANGLE,
                humps: true,
            };
            let mut solved = group.solve::<_, true>(Scalar, &mut space, true);
            let peaks = solved.peaks();
            refused += i32::from(!solved.rest(&peaks).accepted);
        }
        // One in a hundred costs about as much as all the others.
        assert!(refused * 500 < nodes * nodes, "{refused}");
    }
}
