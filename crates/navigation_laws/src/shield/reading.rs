//! At which times of its plan a robot can be that was measured somewhere.

use crate::shield::{Course, Shield};
use navigation_world::world::geometry::RobotState;
use numeric::lanes::Vector2;

/// Halvings of an interval of times: a part in a billion.
const HALVINGS: u32 = 30;

/// Share of an interval that a golden section keeps.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Between which times of its plan a robot can be, in s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanTimes {
    /// The earliest of them.
    pub earliest: f64,
    /// The latest of them; infinite where the robot can be at rest at the end of the plan.
    pub latest: f64,
}

impl Shield {
    /// At which times of a plan, not before one in s, a robot can be as it was measured; `None` where the measurement
    /// refutes them all.
    #[must_use]
    pub fn reading(
        &self,
        course: &Course,
        from: f64,
        robot: &RobotState<f64>,
    ) -> Option<PlanTimes> {
        let fits = |time: f64| self.refuted(course, time, robot).is_none();
        let (ramp, end) = (course.period(), course.end());
        let from = from.max(0.0);
        if from >= end {
            let rest = PlanTimes {
                earliest: from,
                latest: f64::INFINITY,
            };
            return fits(from).then_some(rest);
        }
        let parts = [[from, ramp], [from.max(ramp), end]];
        // A plan that speeds up and brakes can have two times for one measurement.
        let (mut earliest, mut latest) = (f64::INFINITY, f64::NEG_INFINITY);
        for [first, last] in parts.into_iter().filter(|[first, last]| first < last) {
            let mut hold = |found: f64| {
                earliest = earliest.min(farthest(found, first, fits));
                latest = latest.max(farthest(found, last, fits));
            };
            if let Some(found) = self.fitting(course, [first, last], robot) {
                hold(found);
            }
            if fits(last) {
                hold(last);
            }
        }
        if fits(end) {
            latest = f64::INFINITY;
        }
        (earliest < f64::INFINITY).then_some(PlanTimes { earliest, latest })
    }

    /// Any time of a part of a plan that a measurement does not refute, in s: where place and velocity fit best, or
    /// between both.
    fn fitting(
        &self,
        course: &Course,
        [first, last]: [f64; 2],
        robot: &RobotState<f64>,
    ) -> Option<f64> {
        let fits = |time: f64| self.refuted(course, time, robot).is_none();
        let as_fast = by_velocity(course, [first, last], robot);
        let there = by_place(course, [first, last], robot.position);
        let moves_alike = |time: f64| {
            let off = self.refuted(course, time, robot);
            off.is_none_or(|off| off.velocity == 0.0)
        };
        let between = || farthest(as_fast, there, moves_alike);
        let tried = [as_fast, there, first, last].into_iter();
        tried
            .chain(moves_alike(as_fast).then(between))
            .find(|time| fits(*time))
    }
}

/// The time farthest from one that holds toward another one, between which a condition holds no more from some time
/// on.
fn farthest(from: f64, toward: f64, holds: impl Fn(f64) -> bool) -> f64 {
    if holds(toward) {
        return toward;
    }
    let (mut inside, mut outside) = (from, toward);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (inside + outside);
        if holds(middle) {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    inside
}

/// When the velocity of a plan is nearest to a measured one, in a part in which its rates change evenly.
fn by_velocity(course: &Course, [first, last]: [f64; 2], robot: &RobotState<f64>) -> f64 {
    let (mut begin, mut end) = (course.rates(first), course.rates(last));
    let mut wanted = robot.velocity;
    if course.has_wheels() {
        let forward = (begin.x + end.x).signum();
        wanted = Vector2::new(wanted.norm() * forward, 0.0);
        (begin.y, end.y) = (0.0, 0.0);
    }
    let change = end - begin;
    let square = change.norm_squared();
    if square == 0.0 {
        return first;
    }
    let share = (wanted - begin).dot(&change) / square;
    first + (last - first) * share.clamp(0.0, 1.0)
}

/// When the place of a plan is nearest to a measured one.
fn by_place(course: &Course, [first, last]: [f64; 2], place: Vector2<f64>) -> f64 {
    let away = |time: f64| (course.position(time) - place).norm_squared();
    let (mut low, mut high) = (first, last);
    for _ in 0..HALVINGS {
        let part = (high - low) * GOLDEN;
        if away(high - part) <= away(low + part) {
            high = low + part;
        } else {
            low = high - part;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shield::ShieldLimits;

    fn course(before: [f64; 2], command: [f64; 2]) -> Course {
        let limits = ShieldLimits {
            radius: 0.2,
            max_speed: 1.5,
            max_acceleration: 2.0,
            period: 0.1,
        };
        let robot = RobotState {
            position: Vector2::new(0.4, -0.1),
            velocity: Vector2::from(before),
        };
        Course::of_velocity(3.0, &robot, Vector2::from(command), &limits)
    }

    #[test]
    fn it_holds_the_time_at_which_the_robot_was_measured() {
        let shield = Shield::default();
        for (before, command) in [
            ([0.0, 0.0], [0.2, 0.0]),
            ([0.6, 0.0], [0.6, 0.0]),
            ([0.6, 0.1], [0.5, -0.05]),
            ([0.05, 0.0], [0.02, 0.01]),
        ] {
            let course = course(before, command);
            for part in 0..=40 {
                let at = 0.025 * f64::from(part) * course.end();
                for (wrong, off) in [(0.0, 0.0), (0.01, 0.004), (-0.01, -0.004)] {
                    let robot = RobotState {
                        position: course.position(at) + Vector2::new(off, 0.0),
                        velocity: course.velocity(at) * (1.0 + wrong),
                    };
                    for from in [0.0, 0.5 * at, at] {
                        let found = shield.reading(&course, from, &robot).unwrap();
                        assert!(found.earliest <= at + 1e-6 && found.latest >= at - 1e-6);
                    }
                }
            }
        }
    }

    #[test]
    fn a_robot_that_is_elsewhere_is_at_no_time_of_it() {
        let (shield, course) = (Shield::default(), course([0.6, 0.0], [0.6, 0.0]));
        let far = RobotState {
            position: Vector2::new(2.0, 0.0),
            velocity: Vector2::new(0.6, 0.0),
        };
        assert_eq!(shield.reading(&course, 0.0, &far), None);
        let before = RobotState {
            position: course.position(0.02),
            velocity: Vector2::new(0.6, 0.0),
        };
        assert_eq!(shield.reading(&course, 0.1, &before), None);
    }
}
