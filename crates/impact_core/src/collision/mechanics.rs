//! Forces and rates of a collision.

use super::{Collision, MotionSample, Region};
use crate::covering::{Pad, Shape};

/// Place of `eps` in a state.
pub const TOTAL: usize = 0;
/// Place of `eps'`.
pub const SPEED: usize = 1;
/// Place of `d`, where covering and region share `eps`.
pub const PART: usize = 2;
/// Place of `x_h`, of bodies that something holds.
pub const BODY: usize = 3;
/// Place of `x_h'`.
pub const BODY_SPEED: usize = 4;

/// State: `eps`, `eps'`, `d`, and `x_h`, `x_h'` where a support needs them.
pub type CollisionState<const N: usize> = [f64; N];

/// How covering and region share the compression.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carried {
    /// Nothing to share: one of them is absent.
    Nothing,
    /// `d` follows from `F(d) R U = g(eps - d)`, whose derivative moves it between solutions of the line itself.
    Series,
    /// A damper: `d` is a state of its own.
    Damped,
}

/// History of the motion: its direction, the last reversal, braking, a release.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct History {
    /// Whether `eps` rises.
    pub loading: bool,
    /// Strain at the last reversal of `eps`, the largest so far.
    pub largest_strain: f64,
    /// Work up to that strain.
    pub largest_work: f64,
    /// Whether the set point brakes, or rests.
    pub braking: bool,
    /// Time from which it brakes, in s; infinite while the contact is not noticed.
    pub stop_time: f64,
    /// `eps` at which the bodies parted, while they are apart.
    pub apart: Option<f64>,
}

/// Force and rates at a state.
#[derive(Clone, Copy, Debug, Default)]
pub struct Local {
    /// `f`.
    pub force: f64,
    /// `f'`.
    pub force_rate: f64,
    /// `d`.
    pub compression: f64,
    /// `d'`.
    pub compression_rate: f64,
    /// `delta`.
    pub deflection: f64,
    /// `delta'`.
    pub deflection_rate: f64,
    /// `eps''`.
    pub acceleration: f64,
    /// `x_h''`.
    pub body_acceleration: f64,
    /// By how much `d` is too large for the force of the region, to first order.
    pub mismatch: f64,
}

/// Force of the covering without damper, and its derivatives over `d` and over `eps'`.
struct CoveringForce {
    force: f64,
    slope: f64,
    over_speed: f64,
}

/// A collision ready to move, with `N` = 3 for free bodies and 5 for held ones.
pub struct Mechanics<'a, const N: usize> {
    /// The collision.
    pub collision: &'a Collision<'a>,
    /// Sharing of the compression by covering and region.
    pub carried: Carried,
    robot_share: f64,
    body_share: f64,
    rated: bool,
    retained: bool,
    damping: f64,
}

impl<'a, const N: usize> Mechanics<'a, N> {
    /// Mechanics of a collision.
    pub fn new(collision: &'a Collision<'a>) -> Self {
        let damping = collision.pad.map_or(0.0, |pad| pad.covering.damping);
        let carried = match (collision.pad, collision.region) {
            (None, _) | (_, Region::Rigid) => Carried::Nothing,
            _ if damping > 0.0 => Carried::Damped,
            _ => Carried::Series,
        };
        Self {
            collision,
            carried,
            robot_share: 1.0 / collision.robot.mass,
            body_share: 1.0 / collision.body.mass,
            rated: collision
                .pad
                .is_some_and(|pad| !pad.covering.rate.is_none()),
            retained: collision
                .pad
                .is_some_and(|pad| pad.covering.unloading.retained < 1.0),
            damping,
        }
    }

    /// Whether force, compression and deflection all peak where `eps` turns.
    pub fn is_in_step(&self) -> bool {
        !self.rated && self.damping == 0.0
    }

    /// Whether unloading differs from loading.
    pub fn forgets(&self) -> bool {
        self.retained
    }

    /// Velocity of the body.
    pub fn body_speed(&self, state: &CollisionState<N>) -> f64 {
        if N > BODY_SPEED {
            return state[BODY_SPEED];
        }
        // Momentum is kept: M_h x_h' = mu (v - eps').
        let collision = self.collision;
        collision.reduced_mass() * self.body_share * (collision.closing_speed - state[SPEED])
    }

    fn column(&self, pad: &Pad, compression: f64, speed: f64, past: &History) -> CoveringForce {
        let [force, slope] = pad.force(compression);
        let mut column = CoveringForce {
            force,
            slope,
            over_speed: 0.0,
        };
        if !self.rated && !self.retained {
            return column;
        }
        let thickness = pad.covering.thickness;
        let strain = compression / thickness;
        if self.retained && strain < past.largest_strain {
            let [factor, change] = pad.unloading_factor(strain, past.largest_work);
            column.slope = slope * factor + force * change / thickness;
            column.force *= factor;
        }
        if self.rated && past.loading && speed >= 0.0 {
            let [factor, over_speed, over_strain] = pad.rate_factor(speed, strain);
            column.over_speed = column.force * over_speed;
            column.slope = column.slope * factor + column.force * over_strain / thickness;
            column.force *= factor;
        }
        column
    }

    fn accelerations(
        &self,
        time: f64,
        state: &CollisionState<N>,
        force: f64,
        past: &History,
    ) -> [f64; 2] {
        let collision = self.collision;
        if N <= BODY_SPEED {
            let body = force * self.body_share;
            return [-force * (self.robot_share + self.body_share), body];
        }
        let [set_point, set_speed] = set_point(collision, time, past);
        let body_speed = state[BODY_SPEED];
        let place = state[TOTAL] + state[BODY];
        let speed = state[SPEED] + body_speed;
        let robot = &collision.robot;
        let body = &collision.body;
        let mut drive = robot.damping * (speed - set_speed) + robot.stiffness * (place - set_point);
        if let Some(driven) = collision.driven {
            drive = drive.clamp(-driven.push_limit, driven.push_limit);
        }
        let push = force + drive;
        let held = force - body.damping * body_speed - body.stiffness * state[BODY];
        let body_acceleration = held * self.body_share;
        [
            -push * self.robot_share - body_acceleration,
            body_acceleration,
        ]
    }

    /// Force and rates.
    #[inline]
    pub fn local(&self, time: f64, state: &CollisionState<N>, past: &History) -> Local {
        let (total, speed, part) = (state[TOTAL], state[SPEED], state[PART]);
        let region = self.collision.region;
        let mut local = Local::default();
        let move_by = |local: &mut Local, force: f64| {
            local.force = force;
            [local.acceleration, local.body_acceleration] =
                self.accelerations(time, state, force, past);
        };
        if past.apart.is_some() {
            move_by(&mut local, 0.0);
            return local;
        }
        let Some(pad) = self.collision.pad else {
            let [force, slope] = region.force(total);
            move_by(&mut local, force);
            local.force_rate = slope * speed;
            (local.deflection, local.deflection_rate) = (total, speed);
            return local;
        };
        match self.carried {
            Carried::Nothing => {
                let column = self.column(pad, total, speed, past);
                move_by(&mut local, column.force + self.damping * speed);
                local.force_rate = steep(column.slope, speed)
                    + (column.over_speed + self.damping) * local.acceleration;
                (local.compression, local.compression_rate) = (total, speed);
            }
            Carried::Series => {
                let column = self.column(pad, part, speed, past);
                let [force, yielding] = region.force(total - part);
                // An error of `d` weighs less in the softer of both.
                let soft = column.slope < yielding;
                move_by(&mut local, if soft { column.force } else { force });
                let late = column.over_speed * local.acceleration;
                let sum = column.slope + yielding;
                local.compression_rate = if column.slope.is_infinite() || sum == 0.0 {
                    0.0
                } else if yielding.is_infinite() {
                    speed
                } else {
                    (yielding * speed - late) / sum
                };
                local.deflection_rate = speed - local.compression_rate;
                local.force_rate = if soft {
                    steep(column.slope, local.compression_rate) + late
                } else {
                    steep(yielding, local.deflection_rate)
                };
                local.mismatch = if yielding.is_infinite() {
                    // A region that starts infinitely stiff has no first order: it yields by what the force asks.
                    region.deflection(column.force)
                } else if sum > 0.0 && sum.is_finite() {
                    (column.force - force) / sum
                } else {
                    0.0
                };
                (local.compression, local.deflection) = (part, total - part);
            }
            Carried::Damped => {
                let [force, yielding] = region.force(total - part);
                move_by(&mut local, force);
                let column = self.column(pad, part, speed, past);
                local.compression_rate = (force - column.force) / self.damping;
                local.deflection_rate = speed - local.compression_rate;
                local.force_rate = steep(yielding, local.deflection_rate);
                (local.compression, local.deflection) = (part, total - part);
            }
        }
        local
    }

    /// `d` at some `eps` shortly after the touch, where `d = 0` may be a rest that is none: a force that starts like
    /// `d^p`, `p < 1`, or like `delta^n`, `n > 1`. Newton steps on logarithms, in which powers are lines.
    pub fn share(&self, total: f64, speed: f64, past: &History) -> f64 {
        let Some(pad) = self.collision.pad else {
            return 0.0;
        };
        let (mut low, mut high) = (0.0, total);
        let mut x = 0.5 * total;
        for _ in 0..200 {
            let column = self.column(pad, x, speed, past);
            let [force, slope] = self.collision.region.force(total - x);
            if column.force > force {
                high = x;
            } else {
                low = x;
            }
            let rise = x * (column.slope / column.force + slope / force);
            let newton = x * ((force / column.force).ln() / rise).exp();
            if (newton - x).abs() <= 1e-14 * x {
                return x;
            }
            let inside = newton > low && newton < high;
            x = if inside { newton } else { 0.5 * (low + high) };
        }
        x
    }

    /// Derivative of a state.
    #[inline]
    pub fn rates(&self, state: &CollisionState<N>, local: &Local) -> CollisionState<N> {
        let mut rates = [0.0; N];
        rates[TOTAL] = state[SPEED];
        rates[SPEED] = local.acceleration;
        rates[PART] = match self.carried {
            Carried::Nothing => 0.0,
            Carried::Series | Carried::Damped => local.compression_rate,
        };
        if N > BODY_SPEED {
            rates[BODY] = state[BODY_SPEED];
            rates[BODY_SPEED] = local.body_acceleration;
        }
        rates
    }

    /// Pressure at the apex of a curved contact and its rate; NaN of flat ones.
    pub fn apex(&self, state: &CollisionState<N>, local: &Local, past: &History) -> [f64; 2] {
        let Some(pad) = self.collision.pad else {
            return [f64::NAN; 2];
        };
        if matches!(pad.covering.shape, Shape::Flat { .. }) {
            return [f64::NAN; 2];
        }
        let thickness = pad.covering.thickness;
        let strain = local.compression / thickness;
        let [mut stress, mut slope] = pad.covering.material.stress(strain);
        if self.retained && strain < past.largest_strain {
            let [factor, change] = pad.unloading_factor(strain, past.largest_work);
            slope = slope * factor + stress * change;
            stress *= factor;
        }
        let mut late = 0.0;
        if self.rated && past.loading && state[SPEED] >= 0.0 {
            let [factor, over_speed, over_strain] = pad.rate_factor(state[SPEED], strain);
            late = stress * over_speed * local.acceleration;
            slope = slope * factor + stress * over_strain;
            stress *= factor;
        }
        [
            stress,
            steep(slope, local.compression_rate / thickness) + late,
        ]
    }

    /// `x_h'''`.
    pub fn body_jerk(&self, state: &CollisionState<N>, local: &Local) -> f64 {
        if N <= BODY_SPEED {
            return local.force_rate * self.body_share;
        }
        let body = &self.collision.body;
        let held = local.force_rate
            - body.damping * local.body_acceleration
            - body.stiffness * state[BODY_SPEED];
        held * self.body_share
    }

    /// The motion as others see it.
    pub fn node(
        &self,
        time: f64,
        state: &CollisionState<N>,
        local: &Local,
        past: &History,
    ) -> MotionSample {
        MotionSample {
            time,
            total_compression: state[TOTAL],
            closing_speed: state[SPEED],
            covering_compression: local.compression,
            body_deflection: local.deflection,
            force: local.force,
            body_speed: self.body_speed(state),
            body_acceleration: local.body_acceleration,
            body_jerk: self.body_jerk(state, local),
            apex_pressure: self.apex(state, local, past)[0],
        }
    }
}

/// A slope that may be infinite times a rate that may be zero there.
fn steep(slope: f64, rate: f64) -> f64 {
    if rate == 0.0 { 0.0 } else { slope * rate }
}

/// Set point of the robot and its speed.
fn set_point(collision: &Collision<'_>, time: f64, past: &History) -> [f64; 2] {
    let speed = collision.closing_speed;
    let (Some(stop), true) = (collision.stop, past.braking) else {
        return [speed * time, speed];
    };
    let (start, deceleration) = (past.stop_time, stop.deceleration);
    let since = time - start;
    let left = speed - deceleration * since;
    if left <= 0.0 {
        return [speed * start + 0.5 * speed * speed / deceleration, 0.0];
    }
    [
        speed * start + since * (speed - 0.5 * deceleration * since),
        left,
    ]
}
