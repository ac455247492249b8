//! A two-wheel robot that takes up a commanded velocity: its part along the heading at once, its
//! direction by turning within the control period.

use nalgebra::Vector2;

use crate::robots::differential::Twist;
use crate::robots::drives::Start;

/// Slower velocities have no direction, in m/s.
const STILL: f64 = 1e-12;

/// Speed that tells the direction of a robot that turns in place, in m/s.
const TOKEN: f64 = 1e-7;

/// Largest turn within a control period that a velocity tells a robot with a heading, in rad: below a right angle.
pub const MOST_TURN: f64 = 1.5;

/// The velocity that commands a twist to a robot with a heading, for a control period in s; of faster turns
/// [`MOST_TURN`].
#[must_use]
pub fn velocity_of(twist: Twist, heading: f64, period: f64) -> Vector2<f64> {
    let turn = (twist.turn_rate * period).clamp(-MOST_TURN, MOST_TURN);
    if twist.speed.abs() < TOKEN && twist.turn_rate == 0.0 {
        return Vector2::zeros();
    }
    let speed = if twist.speed.abs() < TOKEN {
        TOKEN
    } else {
        twist.speed
    };
    let (sin, cos) = (heading + turn).sin_cos();
    Vector2::new(cos, sin) * (speed / turn.cos())
}

/// The twist that a velocity commands; one behind the robot commands it backwards.
pub(crate) fn twist_of(velocity: Vector2<f64>, heading: f64, period: f64) -> Twist {
    if velocity.norm() < STILL {
        return Twist::default();
    }
    let (sin, cos) = heading.sin_cos();
    let ahead = Vector2::new(cos, sin);
    let speed = velocity.dot(&ahead);
    let mut angle = ahead.perp(&velocity).atan2(speed);
    if speed < 0.0 {
        angle -= std::f64::consts::PI.copysign(angle);
    }
    Twist {
        // What only tells the direction is no motion: a robot that turns in place stays there.
        speed: if speed.abs() < 2.0 * TOKEN {
            0.0
        } else {
            speed
        },
        turn_rate: angle / period,
    }
}

/// Takes up twists evenly within control periods.
#[derive(Clone, Copy, Debug)]
pub(super) struct VelocitySteering {
    mass: f64,
    period: f64,
    /// Share of a control period that a motion step is.
    share: f64,
    from: Twist,
    target: Twist,
    /// Share of the control period that is over.
    over: f64,
}

impl VelocitySteering {
    pub fn new(start: &Start) -> Self {
        Self {
            mass: start.point.mass,
            period: start.period,
            share: start.step / start.period,
            from: Twist::default(),
            target: Twist::default(),
            over: 0.0,
        }
    }

    /// Twist of the velocity that a force reaches.
    pub fn reached_by(&self, force: Vector2<f64>, heading: f64, now: Twist) -> Twist {
        let (sin, cos) = heading.sin_cos();
        let velocity = Vector2::new(cos, sin) * now.speed + force * (self.period / self.mass);
        twist_of(velocity, heading, self.period)
    }

    /// Takes up a twist from the present one on.
    pub fn hold(&mut self, now: Twist, target: Twist) {
        (self.from, self.target, self.over) = (now, target, 0.0);
    }

    /// Twist to have after the next motion step.
    pub fn command(&mut self) -> Twist {
        self.over = (self.over + self.share).min(1.0);
        let part = |from: f64, to: f64| from + (to - from) * self.over;
        Twist {
            speed: part(self.from.speed, self.target.speed),
            turn_rate: part(self.from.turn_rate, self.target.turn_rate),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_velocity_tells_every_twist() {
        for (speed, turn_rate) in [(0.5, 1.0), (-0.3, 2.0), (0.7, -4.0), (0.2, 0.0), (0.0, 3.0)] {
            let twist = Twist { speed, turn_rate };
            let told = twist_of(velocity_of(twist, 0.8, 0.06), 0.8, 0.06);
            assert!((told.speed - speed).abs() < 1e-15, "{told:?}");
            assert!((told.turn_rate - turn_rate).abs() < 1e-9, "{told:?}");
        }
        let rest = velocity_of(Twist::default(), 0.8, 0.06);
        assert_eq!(twist_of(rest, 0.8, 0.06), Twist::default());
    }
}
