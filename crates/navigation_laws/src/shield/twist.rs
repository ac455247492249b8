//! The shield of a robot with two wheels: it commands a speed and a turn rate.

mod plan;

pub use plan::{TwistLimits, TwistState};

use crate::foresight::{Driven, Target};
use crate::shield::hidden::Hidden;
use crate::shield::person::Person;
use crate::shield::walls::StaticObstacles;
use crate::shield::{Shield, ShieldLimits, Status};
use navigation_world::robots::differential::{DifferentialLimits, Twist};
use navigation_world::robots::drives::MOST_TURN;
use numeric::error::Result;
use numeric::lanes::Vector2;
use numeric::order::sort_pairs;
use plan::{STILL, TwistPlan, unit};

/// Speeds and turn rates that are tried on each side.
const STEPS: i32 = 6;

/// Weight of turning otherwise than wanted against driving at another speed, each as a share of its
/// limit.
const TURN_WEIGHT: f64 = 0.25;

/// Most steps in which a quarter of a foreseen way is summed up.
const MOST_STEPS: f64 = 4.0;

/// Price of the time that a turn takes: a robot that turns at once is sooner there than one that drives backwards.
const HEADING_WEIGHT: f64 = 1.5;

/// The shield of a robot with two wheels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwistGuard {
    /// Assumptions of the shield.
    pub shield: Shield,
    /// Limits of the robot.
    pub limits: TwistLimits,
}

/// A robot with two wheels among people and walls.
#[derive(Clone, Copy, Debug)]
pub struct TwistView<'a> {
    /// The robot.
    pub robot: TwistState,
    /// People.
    pub people: &'a [Person],
    /// Static obstacles.
    pub walls: StaticObstacles<'a>,
    /// People whom nobody sees, if they are reckoned with.
    pub hidden: Option<Hidden<'a>>,
}

impl TwistGuard {
    /// The shield of a robot with limits and a radius in m.
    ///
    /// # Errors
    /// Names the number that is not allowed.
    pub fn new(shield: Shield, drive: DifferentialLimits, limits: &ShieldLimits) -> Result<Self> {
        let radius = limits.radius + shield.checked()?.around();
        let drive = DifferentialLimits {
            max_turn_rate: drive.max_turn_rate.min(MOST_TURN / limits.period),
            ..drive.checked()?
        };
        Ok(Self {
            shield,
            limits: TwistLimits {
                radius,
                drive,
                period: limits.period,
            },
        })
    }

    /// The shield of a robot that was measured to be off its plan: it may be as far off again.
    #[must_use]
    pub fn doubled(&self) -> Self {
        let radius = self.limits.radius + self.shield.position_tracking;
        Self {
            shield: self.shield.doubled(),
            limits: TwistLimits {
                radius,
                ..self.limits
            },
        }
    }

    /// The twist toward a wanted velocity: `v = |u| cos(beta)`, `omega = beta/T`, within all limits.
    /// Backwards only where the robot gives way; otherwise it turns first.
    #[must_use]
    pub fn toward(&self, robot: &TwistState, wanted: Vector2<f64>, backwards: bool) -> Twist {
        let ahead = unit(robot.heading);
        let along = wanted.dot(&ahead);
        let mut angle = ahead.perp(&wanted).atan2(along);
        let mut speed = along;
        if along < 0.0 {
            if backwards {
                angle -= std::f64::consts::PI.copysign(angle);
            } else {
                speed = 0.0;
            }
        }
        if wanted.norm() < STILL {
            angle = 0.0;
        }
        let wish = Twist {
            speed,
            turn_rate: angle / self.limits.period,
        };
        let drive = &self.limits.drive;
        drive.toward(robot.twist, wish, self.limits.period)
    }

    /// Way of a robot that turns toward a velocity and keeps it for a time in s.
    #[must_use]
    pub fn driven(&self, robot: &TwistState, target: &Target, time: f64) -> Driven {
        let mut guard = *self;
        let part = 0.25 * time;
        let steps = (part / self.limits.period).round().clamp(1.0, MOST_STEPS);
        guard.limits.period = part / steps;
        let mut state = *robot;
        let (mut places, mut headings) = ([Vector2::zeros(); 4], [0.0; 4]);
        for (place, heading) in places.iter_mut().zip(&mut headings) {
            let mut left = steps;
            while left > 0.0 {
                let twist = guard.toward(&state, target.velocity, target.backwards);
                let mean = |from: f64, to: f64| 0.5 * (from + to) * guard.limits.period;
                let turn = mean(state.twist.turn_rate, twist.turn_rate);
                let way = mean(state.twist.speed, twist.speed);
                state.position += unit(state.heading + 0.5 * turn) * way;
                state.heading += turn;
                state.twist = twist;
                left -= 1.0;
            }
            (*place, *heading) = (state.position, state.heading);
        }
        Driven {
            places,
            headings,
            turn_price: Some(HEADING_WEIGHT / self.limits.drive.max_turn_rate),
        }
    }

    /// Whether a twist that can be reached within a period is verified.
    #[must_use]
    pub fn verified(&self, view: &TwistView<'_>, command: Twist) -> bool {
        let tracking = self.shield.velocity_tracking;
        let plan = TwistPlan::new(&view.robot, command, &self.limits, tracking);
        let radius = self.limits.radius;
        let avoids = |person: &Person| plan.avoids(person, radius, self.shield.grown(person));
        let apart = view.people.iter().all(avoids) && self.off_walls(&view.walls, &plan);
        let hidden = view.hidden.as_ref();
        apart && hidden.is_none_or(|hidden| plan.avoids_hidden(hidden, radius))
    }

    fn off_walls(&self, walls: &StaticObstacles<'_>, plan: &TwistPlan) -> bool {
        if walls.is_empty() || plan.speed < STILL {
            return true;
        }
        let touching = self.limits.radius - self.shield.around();
        plan.keeps(walls, touching, touching + self.shield.wall_margin)
    }

    /// The verified twist nearest to a wanted one, or the rest of the last plan.
    #[must_use]
    pub fn decide(&self, view: &TwistView<'_>, wanted: Twist) -> (Twist, Status) {
        self.decide_by(&view.robot, wanted, |twist| self.verified(view, twist))
    }

    /// The admitted twist nearest to a wanted one, or the rest of the last plan.
    #[must_use]
    pub fn decide_by(
        &self,
        robot: &TwistState,
        wanted: Twist,
        admits: impl Fn(Twist) -> bool,
    ) -> (Twist, Status) {
        if admits(wanted) {
            return (wanted, Status::Kept);
        }
        let tried = self.candidates(robot, wanted);
        let priced = tried.iter().enumerate();
        let mut order: Vec<(f64, usize)> = priced.map(|(place, tried)| (tried.0, place)).collect();
        sort_pairs(&mut order);
        let mut twists = order.iter().map(|(_, place)| tried[*place].1);
        match twists.find(|twist| admits(*twist)) {
            Some(twist) => (twist, Status::Changed),
            None => (self.limits.braking(robot.twist), Status::Braking),
        }
    }

    /// Reachable twists with what each differs from the wanted one.
    fn candidates(&self, robot: &TwistState, wanted: Twist) -> Vec<(f64, Twist)> {
        let drive = &self.limits.drive;
        let period = self.limits.period;
        let price = |twist: Twist| {
            (twist.speed - wanted.speed).abs() / drive.max_speed
                + TURN_WEIGHT * (twist.turn_rate - wanted.turn_rate).abs() / drive.max_turn_rate
        };
        let reach = [
            drive.max_acceleration.max(drive.max_deceleration) * period,
            drive.max_angular_acceleration * period,
        ];
        let share = |step: i32| f64::from(step) / f64::from(STEPS);
        let mut found = Vec::new();
        for slower in -STEPS..=STEPS {
            for turn in -STEPS..=STEPS {
                found.push(Twist {
                    speed: robot.twist.speed + reach[0] * share(slower),
                    turn_rate: robot.twist.turn_rate + reach[1] * share(turn),
                });
            }
        }
        let rests = (0..=10).map(|part| Twist {
            speed: wanted.speed * (1.0 - 0.1 * f64::from(part)),
            ..wanted
        });
        found.extend(rests);
        let creep = self.shield.unseen.map_or(0.0, |unseen| unseen.creep_speed);
        found.extend((creep > 0.0).then(|| Twist {
            speed: wanted.speed.clamp(-creep, creep),
            ..wanted
        }));
        found.push(Twist::default());
        found.push(robot.twist);
        found.push(self.limits.braking(robot.twist));
        let reached = |wish: Twist| drive.toward(robot.twist, wish, period);
        let priced = |wish: Twist| (price(reached(wish)), reached(wish));
        found.into_iter().map(priced).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shield::TrackingError;
    use navigation_world::world::shape::PlacedShape;

    /// For a robot that does exactly what is planned.
    const EXACT: Shield = Shield {
        person_speed: Some(1.6),
        latency: 0.0,
        position_error: 0.0,
        velocity_bounds: None,
        margin: 0.005,
        position_tracking: 0.0,
        velocity_tracking: TrackingError::EXACT,
        wall_margin: 0.005,
        friendly: None,
        unseen: None,
    };

    fn guard() -> TwistGuard {
        let limits = ShieldLimits {
            radius: 0.2,
            max_speed: 0.7,
            max_acceleration: 10.0,
            period: 0.06,
        };
        TwistGuard::new(EXACT, DifferentialLimits::default(), &limits).unwrap()
    }

    fn state(speed: f64) -> TwistState {
        TwistState {
            position: Vector2::zeros(),
            heading: 0.0,
            twist: Twist {
                speed,
                turn_rate: 0.0,
            },
        }
    }

    fn view(state: TwistState, people: &[Person]) -> TwistView<'_> {
        TwistView {
            robot: state,
            people,
            walls: StaticObstacles::NONE,
            hidden: None,
        }
    }

    #[test]
    fn who_is_ahead_only_while_the_robot_turns_back_is_ahead() {
        let mut guard = guard();
        guard.limits.drive = DifferentialLimits {
            max_turn_rate: 12.0,
            max_angular_acceleration: 400.0,
            ..guard.limits.drive
        };
        // The heading is 0 at both ends of the ramp, and 0.18 rad between them.
        let twist = |turn_rate| Twist {
            speed: 0.7,
            turn_rate,
        };
        let robot = TwistState {
            twist: twist(12.0),
            ..state(0.7)
        };
        let mut beside = Person::disc([-0.025, 0.505], 0.3);
        beside.max_speed = 0.0;
        assert!(!guard.verified(&view(robot, &[beside]), twist(-12.0)));
        let mut behind = Person::disc([-0.2, 0.505], 0.3);
        behind.max_speed = 0.0;
        assert!(guard.verified(&view(robot, &[behind]), twist(-12.0)));
    }

    #[test]
    fn who_stands_within_the_margin_of_a_wall_leaves_on_a_curve_and_comes_no_nearer() {
        let guard = guard();
        let kept = guard.limits.radius - EXACT.margin + EXACT.wall_margin;
        for short in [-2e-5, 2e-5, 4e-3] {
            let pillar = [PlacedShape::disc([0.0, -0.1 - kept + short], 0.1)];
            let walls = StaticObstacles {
                shapes: &pillar,
                map: None,
            };
            for direction in -8..=8 {
                for turn in -4..=4 {
                    let heading = f64::from(direction) * 0.19;
                    let twist = Twist {
                        speed: 0.5,
                        turn_rate: f64::from(turn),
                    };
                    let robot = TwistState {
                        heading,
                        twist,
                        ..state(0.5)
                    };
                    let view = TwistView {
                        walls,
                        ..view(robot, &[])
                    };
                    let plan = TwistPlan::new(&robot, twist, &guard.limits, TrackingError::EXACT);
                    let start = walls.clearance_up_to(robot.position, 9.0);
                    let nearest = plan.ramp.iter().map(|node| node.position);
                    let nearest = nearest.map(|place| walls.clearance_up_to(place, 9.0));
                    let nearest = nearest.fold(f64::INFINITY, f64::min);
                    if guard.verified(&view, twist) {
                        assert!(nearest >= start.min(kept) - 2e-9);
                    }
                    if heading > 0.4 && turn >= 0 && heading < 1.0 {
                        assert!(guard.verified(&view, twist), "{short} {heading} {turn}");
                    }
                }
            }
        }
    }

    #[test]
    fn turning_in_place_is_rest() {
        let people = [Person::disc([0.65, 0.0], 0.4)];
        let turning = Twist {
            speed: 0.0,
            turn_rate: 3.0,
        };
        let (guard, view) = (guard(), view(state(0.0), &people));
        assert!(guard.verified(&view, turning));
        let driving = Twist {
            speed: 0.3,
            turn_rate: 0.0,
        };
        assert!(!guard.verified(&view, driving));
        assert_ne!(guard.decide(&view, driving).1, Status::Kept);
    }

    #[test]
    fn it_may_back_away_from_somebody_ahead() {
        let people = [Person::disc([0.65, 0.0], 0.4)];
        let (guard, view) = (guard(), view(state(0.0), &people));
        let away = guard.toward(&view.robot, Vector2::new(-0.4, 0.0), true);
        assert!((away.speed + 0.4).abs() < 1e-12 && away.turn_rate == 0.0);
        assert!(guard.verified(&view, away));
        let turned = guard.toward(&view.robot, Vector2::new(-0.4, 0.01), false);
        assert!(turned.speed == 0.0 && turned.turn_rate > 0.0);
    }

    #[test]
    fn a_straight_plan_is_that_of_the_holonomic_robot() {
        let twists = guard();
        let limits = ShieldLimits {
            radius: 0.2,
            max_speed: 0.7,
            max_acceleration: 10.0,
            period: 0.06,
        };
        let plain = crate::shield::Guard::new(EXACT, limits).unwrap();
        for away in [0.9, 1.0, 1.1, 1.2, 1.4, 1.6] {
            for speed in [0.1, 0.3, 0.5, 0.7] {
                let people = [Person::disc([away, 0.1], 0.4)];
                let command = Vector2::new(speed, 0.0);
                let robot = navigation_world::world::geometry::RobotState {
                    position: Vector2::zeros(),
                    velocity: Vector2::new(0.2, 0.0),
                };
                let view = view(state(0.2), &people);
                let twist = Twist {
                    speed,
                    turn_rate: 0.0,
                };
                let other = crate::shield::View {
                    robot,
                    people: &people,
                    walls: StaticObstacles::NONE,
                    hidden: None,
                };
                // Bounds between nodes may refuse more, never less.
                if twists.verified(&view, twist) {
                    assert!(plain.gap(&other, command) > -1e-3);
                }
                if plain.gap(&other, command) > 0.02 {
                    assert!(twists.verified(&view, twist));
                }
            }
        }
    }
}
