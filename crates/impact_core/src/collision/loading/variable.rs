//! Variables of integration in the plane of `d` and `eps'`.

use numeric::lanes::Real;

use super::plane::Point;
use crate::covering::Pad;

/// Largest power of a substitution.
const MOST_POWER: i32 = 16;
/// Powers that are tried for a whole product with an exponent.
const FEW: i32 = 8;
/// Share of a variable that stands for none: rates have a limit there that is no number at zero itself.
const NOWHERE: f64 = 1e-16;

/// A variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Variable {
    /// `x` of `d = origin + first x^power`; the state is `(eps'/v)^2` and the time.
    Depth {
        /// `d` at `x = 0`, in m.
        origin: f64,
        /// Rise of `d` up to `x = 1`, in m.
        first: f64,
        /// The power.
        power: i32,
    },
    /// `w` of `eps' = unit (y^2^doublings - 1)`, `y = 1 + range (1 - w^2)`; the state is `d` and the time.
    Pace {
        /// Speed, in m/s.
        unit: f64,
        /// Squarings of `y`.
        doublings: u32,
        /// Fall of `y` up to `w = 1`.
        range: f64,
    },
}

/// `d` itself.
pub const DEPTH: Variable = Variable::Depth {
    origin: 0.0,
    first: 1.0,
    power: 1,
};

impl Variable {
    /// The variable from the touch on, in which a force that starts with an exponent is smooth.
    #[must_use]
    pub fn from_touch(size: f64, exponent: f64) -> Self {
        Self::Depth {
            origin: 0.0,
            first: size,
            power: smooth_power(exponent),
        }
    }

    /// The variable from a kink of the law on in which the force of a cylinder is smooth, a half power of what follows
    /// the kink.
    #[must_use]
    pub fn from_half_power(kink: f64, size: f64) -> Self {
        Self::Depth {
            origin: kink,
            first: size,
            power: 2,
        }
    }

    /// The variable towards the turn. Over `eps'` the rate factor `(1 + eps'/(T e0))^n` is singular at `-T e0`, which
    /// may be near the turn, and `d` starts like a root of `v - eps'`, at the touch or at a half power; over `w` both are
    /// far.
    #[must_use]
    pub fn to_turn(pad: &Pad, speed: f64) -> Self {
        let unit = pad.covering.thickness * pad.covering.rate.reference;
        let ratio = speed / unit;
        let doublings = match ratio {
            ..2.0 => {
                return Self::Pace {
                    unit: speed,
                    doublings: 0,
                    range: 1.0,
                };
            }
            2.0..30.0 => 1,
            30.0..1000.0 => 2,
            _ => 3,
        };
        Self::Pace {
            unit,
            doublings,
            range: rooted(1.0 + ratio, doublings) - 1.0,
        }
    }

    /// `d` at its start, in m, or the fall of `y`.
    pub(super) fn start(self) -> f64 {
        match self {
            Self::Depth { origin, .. } => origin,
            Self::Pace { range, .. } => range,
        }
    }

    /// Compression or speed that it is over.
    pub(super) fn unit(self) -> f64 {
        match self {
            Self::Depth { first, .. } => first,
            Self::Pace { unit, .. } => unit,
        }
    }

    /// Whether steps over both are of one kind, so that they can be taken side by side.
    pub(super) fn is_like(self, other: Self) -> bool {
        match (self, other) {
            (Self::Depth { power, .. }, Self::Depth { power: own, .. }) => power == own,
            (Self::Pace { doublings, .. }, Self::Pace { doublings: own, .. }) => doublings == own,
            _ => false,
        }
    }

    /// Rate of `d` at a point.
    pub(super) fn deepening(self, point: &Point) -> f64 {
        match self {
            Self::Depth { first, power, .. } => deepened(first, power, point.at)[1],
            Self::Pace { .. } => point.rates[0],
        }
    }

    /// How far the nearest singularity of the rate factor is, as far as it is known.
    pub(super) fn room(self, at: f64) -> f64 {
        match self {
            Self::Depth { .. } => 1.0,
            Self::Pace { range, .. } => (1.0 + 1.0 / range).sqrt() - at,
        }
    }

    /// Where `d` and `eps'` have some values.
    #[must_use]
    pub fn at(self, depth: f64, speed: f64) -> f64 {
        match self {
            Self::Depth {
                origin,
                first,
                power,
            } => root_of((depth - origin).max(0.0) / first, power),
            Self::Pace {
                unit,
                doublings,
                range,
            } => {
                let y = rooted(1.0 + speed / unit, doublings);
                let square = (range + 1.0 - y) / range;
                if square > 0.0 { square.sqrt() } else { 0.0 }
            }
        }
    }
}

/// Power of `d = first x^power` in which a force that starts with an exponent is smooth.
#[must_use]
pub fn smooth_power(exponent: f64) -> i32 {
    let whole = (1..=FEW).find(|power| {
        let product = f64::from(*power) * exponent;
        product > 0.5 && (product - product.round()).abs() < 1e-9
    });
    // Where there is none, the force starts with three derivatives at least.
    whole.unwrap_or_else(|| {
        let more = (2..MOST_POWER).find(|power| f64::from(*power) * exponent >= 3.0);
        more.unwrap_or(MOST_POWER)
    })
}

/// `d` beyond its origin and its rate over `x`.
#[inline(always)]
#[must_use]
pub fn deepened<R: Real>(first: R, power: i32, x: R) -> [R; 2] {
    let x = x.max(R::splat(NOWHERE));
    if power == 1 {
        return [first * x, first];
    }
    let before = first * (2..power).fold(x, |value, _| value * x);
    [before * x, R::splat(f64::from(power)) * before]
}

/// `eps'` and its rate over `w`.
#[inline(always)]
#[must_use]
pub fn slowed<R: Real>([unit, range]: [R; 2], doublings: u32, at: R) -> [R; 2] {
    let (one, two) = (R::splat(1.0), R::splat(2.0));
    let at = at.max(R::splat(NOWHERE));
    let mut power = one + range * (one - at * at);
    let mut rate = -two * range * at * unit;
    for _ in 0..doublings {
        rate *= two * power;
        power *= power;
    }
    [unit * (power - one), rate]
}

/// `value^(1/power)`.
fn root_of(value: f64, power: i32) -> f64 {
    match power {
        _ if value == 1.0 || value == f64::INFINITY => value,
        1 => value,
        2 => value.sqrt(),
        power => value.powf(1.0 / f64::from(power)),
    }
}

fn rooted(value: f64, halvings: u32) -> f64 {
    (0..halvings).fold(value, |root, _| root.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_a_start_become_whole_or_smooth() {
        for (exponent, power) in [
            (1.0, 1),
            (0.5, 2),
            (1.5, 2),
            (0.4, 5),
            (2.0 / 3.0, 3),
            (0.43, 7),
            (1.43, 3),
            (1e-9, 16),
        ] {
            assert_eq!(smooth_power(exponent), power, "{exponent}");
        }
    }

    #[test]
    fn rates_are_those_of_the_values() {
        let h = 1e-6;
        for (power, x) in [(1, 0.3), (2, 0.4), (5, 0.7)] {
            let [ahead, behind] = [x + h, x - h].map(|x| deepened(0.02, power, x)[0]);
            let rate = deepened(0.02, power, x)[1];
            assert!((rate * 2.0 * h / (ahead - behind) - 1.0).abs() < 1e-8);
            let depth = deepened(0.02, power, x)[0];
            let variable = Variable::Depth {
                origin: 0.01,
                first: 0.02,
                power,
            };
            assert!((variable.at(0.01 + depth, 0.0) - x).abs() < 1e-14);
        }
        for doublings in 0..4 {
            let variable = Variable::Pace {
                unit: 0.01,
                doublings,
                range: 0.8,
            };
            let of = |at| slowed([0.01, 0.8], doublings, at);
            let rate = (of(0.6 + h)[0] - of(0.6 - h)[0]) / (2.0 * h);
            assert!((of(0.6)[1] / rate - 1.0).abs() < 1e-8);
            assert!((variable.at(0.0, of(0.6)[0]) - 0.6).abs() < 1e-13);
            assert_eq!(of(1.0)[0], 0.0);
        }
    }
}
