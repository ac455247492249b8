//! Forces and rates at a place of the plane of `d` and `eps'`.

use super::variable::{Variable, deepened, slowed};
use super::{Loading, Region};

/// Forces at a place of the plane.
#[derive(Clone, Copy)]
pub(super) struct Forces {
    pub(super) force: f64,
    pub(super) over_depth: f64,
    pub(super) over_speed: f64,
    /// `1 + delta' f_d`.
    pub(super) share: f64,
    /// `mu eps' + f delta' f_v`.
    pub(super) inertia: f64,
}

/// A place of the plane, seen over a variable.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub(super) depth: f64,
    pub(super) speed: f64,
    /// Rates of both.
    pub(super) change: [f64; 2],
    /// Rates of the state.
    pub(super) rates: [f64; 2],
    pub(super) forces: Forces,
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

impl Loading<'_> {
    #[inline]
    fn forces(&self, depth: f64, speed: f64) -> Forces {
        // A kink belongs to the piece that is passed.
        let inside = depth.max(self.piece[0]).min(self.piece[1]);
        let Scales {
            per_thickness,
            per_unit,
            ..
        } = self.scales;
        let [at_rest, slope] = self.pad.force_by(inside, per_thickness);
        let rate = self.pad.covering.rate;
        let inner = 1.0 + speed * per_unit;
        let exponent = rate.base + rate.slope * (inside * per_thickness);
        let logarithm = inner.ln();
        let factor = (exponent * logarithm).exp();
        let force = at_rest * factor;
        let over_depth = factor * (slope + at_rest * rate.slope * logarithm * per_thickness);
        let over_speed = force * exponent * per_unit / inner;
        let inertia = self.mass * speed;
        let yielding = match self.collision.region {
            Region::Rigid => {
                return Forces {
                    force,
                    over_depth,
                    over_speed,
                    share: 1.0,
                    inertia,
                };
            }
            Region::Spring { cubic: 0.0, .. } => self.scales.yielding,
            other => 1.0 / other.force(other.deflection(force))[1],
        };
        Forces {
            force,
            over_depth,
            over_speed,
            share: 1.0 + yielding * over_depth,
            inertia: inertia + force * yielding * over_speed,
        }
    }

    /// Place of the plane, its change over a variable, the forces there and the rates of the state.
    #[inline]
    pub(super) fn place(&self, variable: Variable, at: f64, state: [f64; 2]) -> Place {
        match variable {
            Variable::Depth {
                origin,
                first,
                power,
            } => {
                let [beyond, change] = deepened(first, power, at);
                let depth = origin + beyond;
                let speed = self.collision.closing_speed * state[0].sqrt();
                let forces = self.forces(depth, speed);
                let ratio = change * forces.share / forces.inertia;
                let slower = ratio * forces.force;
                let lost = -2.0 * self.scales.per_energy * speed * slower;
                Place {
                    depth,
                    speed,
                    change: [change, -slower],
                    rates: [lost, self.mass * ratio],
                    forces,
                }
            }
            Variable::Pace {
                unit,
                doublings,
                range,
            } => {
                let [speed, change] = slowed([unit, range], doublings, at);
                let forces = self.forces(state[0], speed);
                let ratio = -change / forces.force;
                let deeper = ratio * forces.inertia / forces.share;
                Place {
                    depth: state[0],
                    speed,
                    change: [deeper, change],
                    rates: [deeper, ratio * self.mass],
                    forces,
                }
            }
        }
    }

    pub(super) fn point(&self, variable: Variable, at: f64, state: [f64; 2]) -> Point {
        let Place {
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
