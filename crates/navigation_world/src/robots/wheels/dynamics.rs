//! Motion of one wheel under a held current, with viscous friction and friction that sticks.

use super::reference::WheelWish;
use numeric::error::{Result, not_negative, positive};

/// Speeds below this stand for standstill, so that the wanted friction has no sign, in rad/s.
const STANDSTILL: f64 = 1e-9;
/// Largest product of decay and time for which a series replaces a difference that would cancel.
const SHORT: f64 = 0.1;

/// Dynamics of one wheel, each term as the motor current that balances it:
/// `J/K theta'' = i - B/K theta' - tau/K sgn(theta')`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelDynamics {
    /// Inertia `J/K` in A s^2.
    pub inertia: f64,
    /// Viscous friction `B/K` in A s.
    pub viscous_friction: f64,
    /// Static friction `tau/K` in A: the most that it takes, moving or not.
    pub static_friction: f64,
}

/// Angle and speed of a wheel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WheelState {
    /// Angle in rad.
    pub angle: f64,
    /// Speed in rad/s.
    pub speed: f64,
}

impl WheelDynamics {
    /// Dynamics from `K/J` in rad/(A s^2), `B/J` in 1/s and `tau/J` in rad/s^2, the form of
    /// (D.2.6) and (E.2.6).
    #[must_use]
    pub fn from_accelerations(gain: f64, decay: f64, friction: f64) -> Self {
        Self {
            inertia: 1.0 / gain,
            viscous_friction: decay / gain,
            static_friction: friction / gain,
        }
    }

    /// Passes dynamics with a positive inertia and friction that does not push.
    ///
    /// # Errors
    /// Names the value that is out of range.
    pub fn checked(self) -> Result<Self> {
        positive("inertia", self.inertia)?;
        not_negative("viscous_friction", self.viscous_friction)?;
        not_negative("static_friction", self.static_friction)?;
        Ok(self)
    }

    /// Acceleration for a unit of current `K/J`, in rad/(A s^2).
    #[must_use]
    pub fn gain(&self) -> f64 {
        1.0 / self.inertia
    }

    /// Decay of the speed `B/J`, in 1/s.
    #[must_use]
    pub fn decay(&self) -> f64 {
        self.viscous_friction / self.inertia
    }

    /// Current that overcomes friction in the wanted direction, in A; zero at standstill.
    #[must_use]
    pub fn compensation(&self, speed: f64) -> f64 {
        if speed.abs() < STANDSTILL {
            0.0
        } else {
            self.static_friction.copysign(speed)
        }
    }

    /// Current that a perfect follower takes, in A, (D.3.2) and (E.3.2).
    #[must_use]
    pub fn ideal_current(&self, wish: &WheelWish) -> f64 {
        self.inertia * wish.acceleration
            + self.viscous_friction * wish.speed
            + self.compensation(wish.speed)
    }

    /// State after a time in s under a held current in A, exact.
    #[must_use]
    pub fn advance(&self, state: WheelState, current: f64, duration: f64) -> WheelState {
        HeldStep::new(self, duration).advance(state, current)
    }
}

/// Coefficients of the solution for one duration, computed once.
#[derive(Clone, Copy, Debug)]
pub(super) struct HeldStep {
    duration: f64,
    gain: f64,
    decay: f64,
    /// Deceleration by static friction `tau/J`, in rad/s^2.
    friction: f64,
    response: Response,
}

/// Speed and angle after a time: `speed = kept v + rise a`, `angle = rise v + lift a`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Response {
    pub(super) kept: f64,
    pub(super) rise: f64,
    pub(super) lift: f64,
}

impl Response {
    /// Response of `theta'' = a - k theta'`: `e^-kt`, `(1 - e^-kt)/k`, `(kt - 1 + e^-kt)/k^2`.
    pub(super) fn new(decay: f64, time: f64) -> Self {
        let exponent = decay * time;
        let lost = -(-exponent).exp_m1();
        if exponent > SHORT {
            return Self {
                kept: 1.0 - lost,
                rise: lost / decay,
                lift: (exponent - lost) / (decay * decay),
            };
        }
        // lift = t^2 (1/2 - x/6 + x^2/24 - ...), rise = t - k lift.
        let (mut term, mut sum) = (0.5, 0.0);
        for order in 3..14 {
            sum += term;
            term *= -exponent / f64::from(order);
        }
        let lift = sum * time * time;
        Self {
            kept: 1.0 - lost,
            rise: time - decay * lift,
            lift,
        }
    }

    fn apply(&self, state: WheelState, acceleration: f64) -> WheelState {
        WheelState {
            angle: state.angle + (self.rise * state.speed + self.lift * acceleration),
            speed: self.kept * state.speed + self.rise * acceleration,
        }
    }
}

impl HeldStep {
    pub(super) fn new(dynamics: &WheelDynamics, duration: f64) -> Self {
        Self {
            duration,
            gain: dynamics.gain(),
            decay: dynamics.decay(),
            friction: dynamics.static_friction / dynamics.inertia,
            response: Response::new(dynamics.decay(), duration),
        }
    }

    /// State at the end. The speed tends to one value, so it passes zero at most once; there the
    /// wheel sticks unless the current overcomes friction the other way.
    #[inline]
    pub(super) fn advance(&self, state: WheelState, current: f64) -> WheelState {
        let drive = self.gain * current;
        if state.speed == 0.0 {
            return self.started(state.angle, drive, &self.response);
        }
        let acceleration = drive - self.friction.copysign(state.speed);
        let moved = self.response.apply(state, acceleration);
        if moved.speed * state.speed > 0.0 {
            return moved;
        }
        let stop = self.stop_time(state.speed, acceleration);
        let angle = Response::new(self.decay, stop)
            .apply(state, acceleration)
            .angle;
        let rest = Response::new(self.decay, (self.duration - stop).max(0.0));
        self.started(angle, drive, &rest)
    }

    /// State after a start from rest.
    fn started(&self, angle: f64, drive: f64, response: &Response) -> WheelState {
        let rest = WheelState { angle, speed: 0.0 };
        if drive.abs() <= self.friction {
            return rest;
        }
        response.apply(rest, drive - self.friction.copysign(drive))
    }

    /// Time until the speed is zero, `ln(1 - k v/a)/k`, for a deceleration.
    fn stop_time(&self, speed: f64, acceleration: f64) -> f64 {
        let straight = -speed / acceleration;
        let bend = self.decay * straight;
        if bend == 0.0 {
            return straight.min(self.duration);
        }
        (straight * bend.ln_1p() / bend).min(self.duration)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wheel() -> WheelDynamics {
        WheelDynamics::from_accelerations(137.0, 0.26, 25.7)
    }

    #[test]
    fn friction_holds_a_wheel_up_to_its_limit() {
        let rest = WheelState {
            angle: 1.5,
            speed: 0.0,
        };
        let most = wheel().static_friction;
        for current in [0.0, 0.1, -0.18, most, -most] {
            assert_eq!(wheel().advance(rest, current, 0.5), rest);
        }
        assert!(wheel().advance(rest, most * (1.0 + 1e-9), 0.5).speed > 0.0);
        assert!(wheel().advance(rest, -most * (1.0 + 1e-9), 0.5).speed < 0.0);
    }

    #[test]
    fn a_wheel_without_friction_coasts_and_accelerates() {
        let free = WheelDynamics {
            inertia: 0.01,
            viscous_friction: 0.0,
            static_friction: 0.0,
        };
        let start = WheelState {
            angle: 0.0,
            speed: 2.0,
        };
        assert_eq!(free.advance(start, 0.0, 3.0).angle, 6.0);
        let pushed = free.advance(start, -0.02, 3.0);
        assert!((pushed.speed + 4.0).abs() < 1e-14 && (pushed.angle + 3.0).abs() < 1e-14);
    }

    #[test]
    fn a_thrown_wheel_stops_where_the_formula_says_and_stays() {
        let start = WheelState {
            angle: 0.0,
            speed: 10.0,
        };
        // v = 0 at t = ln(1 + k v/c)/k; angle there (v - c t)/k.
        let (decay, friction): (f64, f64) = (0.26, 25.7);
        let stop = (decay * 10.0 / friction).ln_1p() / decay;
        let angle = (10.0 - friction * stop) / decay;
        let end = wheel().advance(start, 0.0, 2.0);
        assert_eq!(end.speed, 0.0);
        assert!((end.angle - angle).abs() < 1e-12 && stop < 0.4);
        assert_eq!(wheel().advance(end, 0.0, 2.0), end);
    }

    #[test]
    fn the_response_is_smooth_where_its_forms_meet() {
        let (short, long) = (Response::new(1.0, 0.1), Response::new(1.0, 0.1 + 1e-13));
        assert!((short.lift - long.lift).abs() < 1e-13 && (short.rise - long.rise).abs() < 2e-13);
        let still = Response::new(0.0, 2.0);
        assert_eq!((still.kept, still.rise, still.lift), (1.0, 2.0, 2.0));
    }

    #[test]
    fn the_ideal_current_has_no_friction_at_rest() {
        let mut wish = WheelWish {
            acceleration: 10.0,
            ..WheelWish::default()
        };
        assert_eq!(wheel().ideal_current(&wish), wheel().inertia * 10.0);
        wish.speed = -1.0;
        let expected = (10.0 - 0.26 - 25.7) / 137.0;
        assert!((wheel().ideal_current(&wish) - expected).abs() < 1e-15);
    }
}
