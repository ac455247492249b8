//! Stabilizing force: what makes the Lyapunov function descend.

use crate::field::detour::Turning;
use crate::field::gains::GainLanes;
use crate::field::repulsive::Repulsion;
use crate::field::side::DetourSide;
use navigation_world::world::geometry::{Approach, Body, at_rest};
use numeric::error::{Failure, Given, Result, not_negative};
use numeric::lanes::{Planar, Real, Truth, Vector2};

/// Below this `|v_L|` the direction of the force is lost and it is zero, in N/s.
const NO_DIRECTION: f64 = 1e-6;

/// The cap with the fewest contacts among recorded, random and noisy people; see
/// `docs/validation.md`.
const DEFAULT_CAP: Cap = Cap::Force(10.0);

/// Largest magnitude of a capped stabilizing force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cap {
    /// A force in N.
    Force(f64),
    /// A share of `m |V| / T_s`, the force that would stop the robot within a control period.
    Momentum(f64),
}

impl Cap {
    /// Returns the cap if it is finite and not negative.
    ///
    /// # Errors
    /// It is not.
    pub fn checked(self) -> Result<Self> {
        match self {
            Self::Force(force) => not_negative("stabilizing_force_cap", force)?,
            Self::Momentum(share) => not_negative("stabilizing_momentum_cap", share)?,
        };
        Ok(self)
    }
}

/// Whether and how the stabilizing force acts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stabilizing {
    /// Not at all.
    Off,
    /// With a largest magnitude.
    Capped(Cap),
    /// The force without a limit.
    Full,
}

impl Stabilizing {
    /// Mode by its word, with the cap that was given.
    ///
    /// # Errors
    /// The word is unknown, a cap is given for another mode than `capped`, or two caps are given.
    pub fn named(mode: &str, force: Option<f64>, momentum: Option<f64>) -> Result<Self> {
        let cap = match (force, momentum) {
            (Some(_), Some(share)) => {
                let rule = "be absent when stabilizing_force_cap is given";
                let given = Given::Number(share);
                return Err(Failure::invalid("stabilizing_momentum_cap", rule, given));
            }
            (Some(force), None) => Some(Cap::Force(force).checked()?),
            (None, Some(share)) => Some(Cap::Momentum(share).checked()?),
            (None, None) => None,
        };
        match (mode, cap) {
            ("capped", cap) => Ok(Self::Capped(cap.unwrap_or(DEFAULT_CAP))),
            ("off", None) => Ok(Self::Off),
            ("full", None) => Ok(Self::Full),
            ("off" | "full", Some(_)) => {
                let rule = "be \"capped\" when a cap is given";
                Err(Failure::invalid(
                    "stabilizing",
                    rule,
                    Given::Word(mode.into()),
                ))
            }
            _ => {
                let rule = "be \"off\", \"capped\" or \"full\"";
                Err(Failure::invalid(
                    "stabilizing",
                    rule,
                    Given::Word(mode.into()),
                ))
            }
        }
    }
}

/// Sums over the active obstacles that Omega needs.
#[derive(Clone, Copy, Debug)]
pub struct Dissipation<R> {
    /// Omega in N^2/s, without the terms of the attraction alone (there are none).
    pub omega: R,
    /// `sum of l` in N/s.
    pub rate: Vector2<R>,
    /// `sum of f` in N.
    pub force: Vector2<R>,
}

/// State of the robot that Omega depends on.
#[derive(Clone, Copy, Debug)]
pub struct Dissipative<R> {
    /// Mass in kg.
    pub mass: f64,
    /// `E` in m.
    pub to_goal: Vector2<R>,
    /// `V` in m/s.
    pub velocity: Vector2<R>,
}

impl<R: Real> Dissipation<R> {
    /// No active obstacle.
    #[inline(always)]
    #[must_use]
    pub fn zero() -> Self {
        Self {
            omega: R::zero(),
            rate: Vector2::zeros(),
            force: Vector2::zeros(),
        }
    }

    /// Adds an obstacle.
    ///
    /// Omega of (5.5.8), corrected: derived from `dV2/dt` with the Coriolis terms, the mass at
    /// `a_o` and `alphaddot`; for several obstacles with the cross terms `-l_i . f_j`, and with
    /// `sigma` where a rule overrides the shortest turn. `docs/theory/errata.md` lists each
    /// difference to the printed form.
    #[inline(always)]
    pub fn add(
        &mut self,
        gains: &GainLanes<R>,
        robot: &Dissipative<R>,
        body: &Body<R>,
        seen: (&Approach<R>, &Repulsion<R>, &Turning<R>, &DetourSide<R>),
    ) {
        let (approach, repulsion, turning, detour) = seen;
        let (k1, k3, k5) = (gains.attractive, gains.repulsive, gains.detour);
        let m = R::splat(robot.mass);
        let half_m = R::splat(0.5 * robot.mass);
        let two = R::splat(2.0);
        let (u, t) = (approach.outward, approach.outward.left_normal());
        let (a, c, d) = (approach.depth, approach.margin, approach.distance);
        let ddot = approach.range_rate;
        let (betadot, phidot) = (approach.bearing_rate, approach.angle_rate());
        let acceleration: Vector2<R> = Vector2::from(body.state.acceleration);

        let f = u * (k3 * repulsion.potential) + t * (k5 * turning.signed_potential);
        let l = u * (k3 * repulsion.rate) + t * (k5 * turning.signed_rate);
        let edot = -robot.velocity;
        let margin_rate = -two * ddot * (a * a / (c * c * c) + a / (c * c));
        let alphaddot = goal_bearing_acceleration(body, approach);

        let along = k1 * edot.dot(&f) + two * k3 * k3 * ddot * (a / c) * repulsion.potential;
        let stiffening = half_m * k3 * margin_rate * ddot * ddot;
        let turning_power = k5
            * turning.signed_rate
            * (m * acceleration.dot(&t) - k1 * robot.to_goal.dot(&t)
                + m * d * alphaddot
                + two * m * ddot * betadot);
        let repelling_power = k3
            * repulsion.rate
            * (k1 * robot.to_goal.dot(&u) - m * acceleration.dot(&u) + m * d * betadot * betadot);
        let spinning = m * k5 * a * ddot * phidot * phidot * (R::splat(0.5) * a - d);
        let narrowing = two * k5 * k5 * a * a * a * ddot * detour.turn * detour.turn;
        let overridden = (detour.descent - R::splat(1.0))
            * k5
            * k5
            * turning.signed_potential
            * turning.signed_rate;
        let own = -along + stiffening + turning_power - repelling_power + spinning - narrowing
            + overridden;
        let crossed = l.dot(&self.force) + self.rate.dot(&f);

        let active = approach.active;
        self.omega = R::select(active, self.omega + own - crossed, self.omega);
        self.rate = Vector2::select(active, self.rate + l, self.rate);
        self.force = Vector2::select(active, self.force + f, self.force);
    }

    /// `v_L = K_1 Edot + sum of l` in N/s.
    #[inline(always)]
    pub fn direction(&self, gains: &GainLanes<R>, velocity: Vector2<R>) -> Vector2<R> {
        self.rate - velocity * gains.attractive
    }

    /// `F_L = Omega v_L / |v_L|^2` where `Omega > 0` (5.5.9), capped by the mode, in N.
    #[inline(always)]
    pub fn force(
        &self,
        mode: Stabilizing,
        gains: &GainLanes<R>,
        robot: &Dissipative<R>,
        control_period: f64,
    ) -> Vector2<R> {
        if !self.omega.gt(R::zero()).any() {
            return Vector2::zeros();
        }
        let direction = self.direction(gains, robot.velocity);
        let length = direction.dot(&direction).sqrt();
        let acts = self.omega.gt(R::zero()) & R::splat(NO_DIRECTION).le(length);
        let wanted = self.omega / length;
        let magnitude = match mode {
            Stabilizing::Off => return Vector2::zeros(),
            Stabilizing::Full => wanted,
            Stabilizing::Capped(Cap::Force(cap)) => wanted.min(R::splat(cap)),
            Stabilizing::Capped(Cap::Momentum(share)) => {
                let speed = robot.velocity.dot(&robot.velocity).sqrt();
                wanted.min(speed * R::splat(share * robot.mass / control_period))
            }
        };
        Vector2::select(acts, direction * (magnitude / length), Vector2::zeros())
    }
}

/// `alphaddot = [t_W.(-a_o) - 2 Wdot alphadot]/|W|`, `Wdot = u_W.(-V_o)`, in rad/s^2, with the
/// velocity and acceleration of the body.
#[inline(always)]
fn goal_bearing_acceleration<R: Real>(body: &Body<R>, approach: &Approach<R>) -> R {
    let state = &body.state;
    let moving = !(at_rest(state.velocity) & at_rest(state.acceleration));
    if !moving.any() {
        return R::zero();
    }
    let w = approach.to_goal;
    let length_squared = w.dot(&w);
    let turning = w.perp(&Vector2::from(state.acceleration));
    let closing = w.dot(&Vector2::from(state.velocity));
    let value = (R::splat(2.0) * closing * approach.goal_bearing_rate - turning) / length_squared;
    R::select(length_squared.gt(R::zero()) & moving, value, R::zero())
}
