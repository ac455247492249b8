//! Forces and rates at a place of the plane of `d` and `eps'`.

use numeric::lanes::Real;

use super::variable::{Variable, deepened, slowed};
use super::{Loading, Region};
use crate::covering::{exponential_of, logarithm_of};

/// Forces at a place of the plane.
#[derive(Clone, Copy)]
pub(super) struct Forces<R> {
    force: R,
    over_depth: R,
    over_speed: R,
    /// `1 + delta' f_d`.
    share: R,
    /// `mu eps' + f delta' f_v`.
    inertia: R,
}

/// Point of the plane over a variable.
#[derive(Clone, Copy)]
pub(super) struct PhasePoint<R> {
    pub(super) depth: R,
    pub(super) speed: R,
    /// Rates of both.
    change: [R; 2],
    /// Rates of the state.
    pub(super) rates: [R; 2],
    forces: Forces<R>,
}

/// Reciprocals of sizes.
#[derive(Clone, Copy)]
pub(super) struct Scales {
    /// `1/T`.
    pub(super) per_thickness: f64,
    /// `1/(T e0)`.
    pub(super) per_unit: f64,
    /// `1/v^2`.
    pub(super) per_energy: f64,
    /// `1/k` of a linear region.
    pub(super) yielding: f64,
}

/// A point of the curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    pub(super) at: f64,
    pub(super) state: [f64; 2],
    pub(super) rates: [f64; 2],
    /// `d`.
    pub(super) depth: f64,
    /// `eps'`.
    pub(super) speed: f64,
    /// Rate of `(eps'/v)^2` over `d`.
    pub(super) fall: f64,
    /// Force and apex pressure with their rates over the variable.
    pub(super) loads: [[f64; 2]; 2],
}

/// A variable of collisions side by side.
#[derive(Clone, Copy)]
pub(super) enum LaneVariable<R> {
    Depth { origin: R, first: R, power: i32 },
    Pace { unit: R, doublings: u32, range: R },
}

impl<R: Real> LaneVariable<R> {
    /// Of variables of one kind.
    #[inline(always)]
    pub(super) fn of(first: Variable, each: impl Fn(usize) -> Variable) -> Self {
        let number = |of: fn(Variable) -> f64| R::from_fn(|lane| of(each(lane)));
        match first {
            Variable::Depth { power, .. } => Self::Depth {
                origin: number(Variable::start),
                first: number(Variable::unit),
                power,
            },
            Variable::Pace { doublings, .. } => Self::Pace {
                unit: number(Variable::unit),
                doublings,
                range: number(Variable::start),
            },
        }
    }
}

/// Numbers of collisions side by side.
#[derive(Clone, Copy)]
pub(super) struct Numbers<R> {
    mass: R,
    closing_speed: R,
    per_thickness: R,
    per_unit: R,
    per_energy: R,
    /// Exponent of the rate factor and its slope.
    exponent: [R; 2],
    /// Compressions at the ends of the piece of the law.
    piece: [R; 2],
}

impl<R: Real> Numbers<R> {
    /// Numbers of each lane's collision.
    #[inline(always)]
    pub(super) fn of<'a>(each: impl Fn(usize) -> &'a Loading<'a>) -> Self {
        let number = |of: fn(&Loading<'_>) -> f64| R::from_fn(|lane| of(each(lane)));
        Self {
            mass: number(|of| of.mass),
            closing_speed: number(|of| of.collision.closing_speed),
            per_thickness: number(|of| of.scales.per_thickness),
            per_unit: number(|of| of.scales.per_unit),
            per_energy: number(|of| of.scales.per_energy),
            exponent: [
                number(|of| of.pad.covering.rate.base),
                number(|of| of.pad.covering.rate.slope),
            ],
            piece: [number(|of| of.piece[0]), number(|of| of.piece[1])],
        }
    }

    /// Forces, from force and slope of the columns over compression and strain, and from what the region yields by under a force.
    #[inline(always)]
    fn forces(
        &self,
        [depth, speed]: [R; 2],
        columns: impl Fn(R, R) -> [R; 2],
        yielding: impl Fn(R) -> R,
    ) -> Forces<R> {
        // A kink belongs to the piece that is passed.
        let inside = depth.max(self.piece[0]).min(self.piece[1]);
        let strain = inside * self.per_thickness;
        let [at_rest, slope] = columns(inside, strain);
        let one = R::splat(1.0);
        let inner = one + speed * self.per_unit;
        let [base, more] = self.exponent;
        let exponent = base + more * strain;
        let logarithm = logarithm_of(inner);
        let factor = exponential_of(exponent * logarithm);
        let force = at_rest * factor;
        let over_depth = factor * (slope + at_rest * more * logarithm * self.per_thickness);
        let over_speed = force * exponent * self.per_unit / inner;
        let yielding = yielding(force);
        Forces {
            force,
            over_depth,
            over_speed,
            share: one + yielding * over_depth,
            inertia: self.mass * speed + force * yielding * over_speed,
        }
    }

    /// Place of the plane, its change over a variable, the forces there and the rates of the state.
    #[inline(always)]
    pub(super) fn place(
        &self,
        over: LaneVariable<R>,
        at: R,
        state: [R; 2],
        columns: impl Fn(R, R) -> [R; 2],
        yielding: impl Fn(R) -> R,
    ) -> PhasePoint<R> {
        let ([depth, speed], change) = match over {
            LaneVariable::Depth {
                origin,
                first,
                power,
            } => {
                let [beyond, change] = deepened(first, power, at);
                let speed = self.closing_speed * state[0].sqrt();
                ([origin + beyond, speed], change)
            }
            LaneVariable::Pace {
                unit,
                doublings,
                range,
            } => {
                let [speed, change] = slowed([unit, range], doublings, at);
                ([state[0], speed], change)
            }
        };
        let forces = self.forces([depth, speed], columns, yielding);
        let (change, rates) = match over {
            LaneVariable::Depth { .. } => {
                let ratio = change * forces.share / forces.inertia;
                let slower = ratio * forces.force;
                let lost = -R::splat(2.0) * self.per_energy * speed * slower;
                ([change, -slower], [lost, self.mass * ratio])
            }
            LaneVariable::Pace { .. } => {
                let ratio = -change / forces.force;
                let deeper = ratio * forces.inertia / forces.share;
                ([deeper, change], [deeper, ratio * self.mass])
            }
        };
        PhasePoint {
            depth,
            speed,
            change,
            rates,
            forces,
        }
    }
}

impl Loading<'_> {
    /// Compliance of the region at a force, in m/N.
    #[inline]
    pub(super) fn yielding(&self, force: f64) -> f64 {
        match self.collision.region {
            Region::Rigid | Region::Spring { cubic: 0.0, .. } => self.scales.yielding,
            other => 1.0 / other.force(other.deflection(force))[1],
        }
    }

    /// A place of the plane.
    pub(super) fn place(&self, variable: Variable, at: f64, state: [f64; 2]) -> PhasePoint<f64> {
        let numbers = Numbers::<f64>::of(|_| self);
        let columns = |depth, _| self.pad.force_by(depth, self.scales.per_thickness);
        let over = LaneVariable::of(variable, |_| variable);
        numbers.place(over, at, state, columns, |force| self.yielding(force))
    }

    pub(super) fn point(&self, variable: Variable, at: f64, state: [f64; 2]) -> Point {
        let PhasePoint {
            depth,
            speed,
            change,
            rates,
            forces,
        } = self.place(variable, at, state);
        let rate = forces.over_depth * change[0] + forces.over_speed * change[1];
        let mut loads = [[forces.force, rate], [0.0; 2]];
        if self.curved {
            loads[1] = self.pressure(depth, speed, change);
        }
        let slower = speed * forces.force * forces.share / forces.inertia;
        Point {
            at,
            state,
            rates,
            depth,
            speed,
            fall: -2.0 * self.scales.per_energy * slower,
            loads,
        }
    }

    /// Pressure at the apex and its rate.
    fn pressure(&self, depth: f64, speed: f64, change: [f64; 2]) -> [f64; 2] {
        let thickness = self.pad.covering.thickness;
        let strain = depth.max(self.piece[0]).min(self.piece[1]) / thickness;
        let [stress, slope] = self.pad.covering.material.stress(strain);
        let [factor, over_speed, over_strain] = self.pad.rate_factor(speed, strain);
        let over_depth = (slope * factor + stress * over_strain) / thickness;
        [
            stress * factor,
            over_depth * change[0] + stress * over_speed * change[1],
        ]
    }
}
