//! The plan that a robot executes: kept as it was verified, never computed again from what is measured.

use crate::shield::ShieldLimits;
use crate::shield::plan::braking_periods;
use crate::shield::twist::{TwistLimits, TwistState};
use navigation_world::robots::differential::Twist;
use navigation_world::world::geometry::RobotState;
use numeric::lanes::Vector2;

/// A time that differs from a period by less than this share of it is a period.
const ROUNDING: f64 = 1e-9;

/// Steps in which the way of a robot with two wheels is summed up.
const STEPS: u32 = 16;

/// A plan with the instant of its begin: two rates (a velocity, or speed and turn rate) change evenly within a
/// control period, and then fall together to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Course {
    begun: f64,
    position: Vector2<f64>,
    heading: f64,
    before: Vector2<f64>,
    command: Vector2<f64>,
    period: f64,
    /// Time of braking in s.
    braking: f64,
    wheels: bool,
}

impl Course {
    /// Of a robot that takes up a velocity from a time in s on.
    #[must_use]
    pub fn of_velocity(
        begun: f64,
        robot: &RobotState<f64>,
        command: Vector2<f64>,
        limits: &ShieldLimits,
    ) -> Self {
        Self {
            begun,
            position: robot.position,
            heading: 0.0,
            before: robot.velocity,
            command,
            period: limits.period,
            braking: braking_periods(command.norm(), limits) * limits.period,
            wheels: false,
        }
    }

    /// Of a robot with two wheels that takes up a twist from a time in s on.
    #[must_use]
    pub fn of_twist(begun: f64, robot: &TwistState, command: Twist, limits: &TwistLimits) -> Self {
        Self {
            begun,
            position: robot.position,
            heading: robot.heading,
            before: Vector2::new(robot.twist.speed, robot.twist.turn_rate),
            command: Vector2::new(command.speed, command.turn_rate),
            period: limits.period,
            braking: limits.braking_periods(command) * limits.period,
            wheels: true,
        }
    }

    /// Plan that begins at another time in s.
    #[must_use]
    pub fn begun(self, begun: f64) -> Self {
        Self { begun, ..self }
    }

    /// Whether the rates are speed and turn rate.
    #[must_use]
    pub fn has_wheels(&self) -> bool {
        self.wheels
    }

    /// Control period in s.
    #[must_use]
    pub fn period(&self) -> f64 {
        self.period
    }

    /// Time of the plan at a time in s: negative before it began.
    #[must_use]
    pub fn since(&self, now: f64) -> f64 {
        let since = now - self.begun;
        let rounding = ROUNDING * self.period;
        // A late sample by rounding is none.
        if (since - self.period).abs() <= rounding {
            self.period
        } else {
            since
        }
    }

    /// When the robot rests, in s of the plan.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.period + self.braking
    }

    /// Rates at a time of the plan in s: m/s, or m/s and rad/s.
    #[must_use]
    pub fn rates(&self, since: f64) -> Vector2<f64> {
        if since < self.period {
            let share = (since / self.period).max(0.0);
            return self.before + (self.command - self.before) * share;
        }
        if since == self.period {
            return self.command;
        }
        let braked = since - self.period;
        if braked >= self.braking {
            return Vector2::zeros();
        }
        self.command * (1.0 - braked / self.braking)
    }

    /// Integral of the rates from the begin of the plan on.
    fn summed(&self, since: f64) -> Vector2<f64> {
        let ramp = since.clamp(0.0, self.period);
        let change = (self.command - self.before) * (0.5 * ramp / self.period);
        let ramped = (self.before + change) * ramp;
        let braked = (since - self.period).clamp(0.0, self.braking);
        if braked == 0.0 {
            return ramped;
        }
        ramped + self.command * (braked - 0.5 * braked * braked / self.braking)
    }

    /// Heading at a time of the plan, in rad; 0 without wheels.
    #[must_use]
    pub fn heading(&self, since: f64) -> f64 {
        if self.wheels {
            self.heading + self.summed(since).y
        } else {
            0.0
        }
    }

    /// Velocity at a time of the plan, in m/s.
    #[must_use]
    pub fn velocity(&self, since: f64) -> Vector2<f64> {
        let rates = self.rates(since);
        if !self.wheels {
            return rates;
        }
        let (sin, cos) = self.heading(since).sin_cos();
        Vector2::new(cos, sin) * rates.x
    }

    /// Speed and turn rate at a time of the plan.
    #[must_use]
    pub fn twist(&self, since: f64) -> Option<Twist> {
        let rates = self.rates(since);
        self.wheels.then_some(Twist {
            speed: rates.x,
            turn_rate: rates.y,
        })
    }

    /// Position at a time of the plan, in m.
    #[must_use]
    pub fn position(&self, since: f64) -> Vector2<f64> {
        if !self.wheels {
            return self.position + self.summed(since);
        }
        let until = since.clamp(0.0, self.end());
        let step = until / f64::from(STEPS);
        let ways = (0..STEPS).map(|index| {
            let middle = (f64::from(index) + 0.5) * step;
            self.velocity(middle) * step
        });
        ways.fold(self.position, |place, way| place + way)
    }

    /// Rest of the course from a time of the plan on: times from then in s, and rates, which change evenly between
    /// them; the last ones are zero.
    pub fn rest(&self, since: f64) -> impl Iterator<Item = (f64, [f64; 2])> + '_ {
        let corners = [self.period, self.end()];
        let later = corners.into_iter().filter(move |time| *time > since);
        std::iter::once(since)
            .chain(later)
            .map(move |time| (time - since, self.rates(time).into()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shield::TrackingError;
    use crate::shield::plan::BrakingPlan;
    use navigation_world::robots::differential::DifferentialLimits;

    #[test]
    fn it_is_the_plan_that_was_verified_between_period_ends_too() {
        let limits = ShieldLimits {
            radius: 0.2,
            max_speed: 1.0,
            max_acceleration: 1.0,
            period: 0.1,
        };
        let robot = RobotState {
            position: Vector2::new(0.3, -0.2),
            velocity: Vector2::new(0.25, 0.1),
        };
        let command = Vector2::new(0.3003, 0.02);
        let plan = BrakingPlan::new(&robot, command, &limits, TrackingError::EXACT);
        let course = Course::of_velocity(7.0, &robot, command, &limits);
        assert_eq!(course.since(7.0 + 0.1), 0.1);
        assert_eq!(course.rates(course.since(7.1)), command);
        for part in 0..=60 {
            let time = 0.01 * f64::from(part);
            assert!((course.position(time) - plan.position(time)).norm() < 1e-12);
            assert!((course.velocity(time) - plan.velocity(time)).norm() < 1e-12);
        }
        let rest: Vec<(f64, [f64; 2])> = course.rest(0.15).collect();
        assert_eq!(rest.len(), 2);
        assert_eq!(rest[1], (course.end() - 0.15, [0.0; 2]));
    }

    #[test]
    fn a_turn_ends_as_the_plan_has_it() {
        let limits = TwistLimits {
            radius: 0.2,
            drive: DifferentialLimits::default(),
            period: 0.06,
        };
        let state = TwistState {
            position: Vector2::zeros(),
            heading: 0.3,
            twist: Twist::default(),
        };
        let ordered = Twist {
            speed: 0.4,
            turn_rate: 4.0,
        };
        let course = Course::of_twist(0.0, &state, ordered, &limits);
        assert_eq!(course.twist(0.06), Some(ordered));
        assert_eq!(course.rates(60.0), Vector2::zeros());
        let half = course.rates(0.06 + 0.5 * (course.end() - 0.06));
        assert!((half - Vector2::new(0.2, 2.0)).norm() < 1e-12);
        let mut heading = 0.3;
        let step = 1e-4 * course.end();
        for index in 0..10_000 {
            heading += course.rates((f64::from(index) + 0.5) * step).y * step;
        }
        assert!((heading - course.heading(9.0)).abs() < 1e-6);
    }
}
