//! The obstacles that a law is told of which feels them from anywhere: all of them, or those that matter for
//! the velocities that it may choose.

use crate::lanes::{Real, Truth};
use crate::laws::outlook::{Attention, Discs, Outlook};
use crate::run::scene::body_at;
use crate::world::geometry::Body;
use crate::world::motion::Piece;
use crate::world::scenario::{GROUP, Group, Obstacles, Scenario};

/// The obstacles of one run.
#[derive(Clone, Debug)]
pub(crate) struct Relevant {
    /// Those that the law is told of, in their order, and as they are at the last sample.
    told: Vec<usize>,
    bodies: Vec<Body>,
    /// How those of them move that move straight on.
    straight: Vec<Option<Piece>>,
    /// Cursors of the motions of all obstacles.
    cursors: Vec<usize>,
}

impl Relevant {
    pub fn new(scenario: &Scenario) -> Self {
        Self {
            told: Vec::new(),
            bodies: Vec::new(),
            straight: Vec::new(),
            cursors: vec![0; scenario.obstacles.len()],
        }
    }

    /// The obstacles at an instant in s, those that the law attends to.
    pub fn at(&mut self, scenario: &Scenario, time: f64, attention: Attention) -> &[Body] {
        let all = scenario.obstacles.len();
        match attention {
            Attention::Within(outlook) => {
                self.told.clear();
                pulp::Arch::new().dispatch(Choice {
                    obstacles: &scenario.obstacles,
                    outlook: &outlook,
                    time,
                    told: &mut self.told,
                });
                self.place(scenario, time);
            }
            Attention::All if self.told.len() < all => {
                self.told.clear();
                self.told.extend(0..all);
                self.place(scenario, time);
            }
            Attention::All | Attention::Same => self.advance(scenario, time),
        }
        &self.bodies
    }

    /// Looks at those anew that the law is told of from now on.
    fn place(&mut self, scenario: &Scenario, time: f64) {
        let cursors = &mut self.cursors;
        let body = |index: &usize| body_at(&scenario.obstacles[*index], time, &mut cursors[*index]);
        self.bodies.clear();
        self.bodies.extend(self.told.iter().map(body));
        let motion = |index: &usize| &scenario.obstacles[*index].obstacle.motion;
        let straight = |index: &usize| motion(index).straight().copied();
        self.straight.clear();
        self.straight.extend(self.told.iter().map(straight));
    }

    /// Moves on to an instant.
    fn advance(&mut self, scenario: &Scenario, time: f64) {
        let bodies = self.bodies.iter_mut().zip(&self.straight);
        for ((body, straight), index) in bodies.zip(&self.told) {
            if let Some(piece) = straight {
                (body.state.position, body.state.velocity) = piece.at(time);
                continue;
            }
            let placed = &scenario.obstacles[*index];
            if !placed.stationary {
                body.state = placed.obstacle.motion.at(time, &mut self.cursors[*index]);
            }
        }
    }
}

/// Chooses the obstacles, compiled for the instructions of the processor; its bits are the same for all.
struct Choice<'a> {
    obstacles: &'a Obstacles,
    outlook: &'a Outlook,
    time: f64,
    told: &'a mut Vec<usize>,
}

impl pulp::NullaryFnOnce for Choice<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let count = self.obstacles.len();
        let time = Group::splat(self.time);
        for (place, group) in self.obstacles.groups().iter().enumerate() {
            let concerned = self.outlook.concerns(&Discs {
                center: group.at(time),
                velocity: group.velocity.into(),
                radius: group.radius,
            });
            if concerned.any() {
                let first = place * GROUP;
                let lanes = 0..GROUP.min(count - first);
                let chosen = lanes.filter(|lane| concerned.lane(*lane));
                self.told.extend(chosen.map(|lane| first + lane));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::Vector2;
    use crate::laws::planning::Planner;
    use crate::laws::planning::outline::Legs;
    use crate::laws::velocity_obstacle::tests::{Draws, crowd_around};
    use crate::laws::velocity_obstacle::{Selection, VelocityObstacle, VelocityObstaclePlanner};
    use crate::laws::{Situation, Stop};
    use crate::robots::HolonomicRobot;
    use crate::run::scene::bodies_at;
    use crate::world::geometry::RobotState;
    use crate::world::motion::Motion;
    use crate::world::obstacle::{Limits, Obstacle};
    use crate::world::scenario::Rules;

    type Vector = Vector2<f64>;

    /// A place within a radius in m.
    fn within(draws: &mut Draws, radius: f64) -> Vector {
        let angle = draws.between(0.0, std::f64::consts::TAU);
        Vector::new(angle.cos(), angle.sin()) * draws.between(0.0, radius)
    }

    fn scenario(draws: &mut Draws, case: usize) -> Scenario {
        let spread = [4.0, 15.0, 150.0][case % 3];
        let fast = [0.0, 0.5, 6.0][case / 3 % 3];
        let limits = Limits {
            critical_radius: Some(0.9),
            active_radius: Some(1.8),
            max_speed: None,
        };
        let mut obstacles = Vec::new();
        while obstacles.len() < [16, 32, 96][case / 9 % 3] {
            let [x, y] = within(draws, spread).into();
            if x.hypot(y) < 1.0 {
                continue;
            }
            let velocity = within(draws, fast).into();
            let motion = match obstacles.len() % 8 {
                0 => Motion::moving([x, y], velocity, [0.05, -0.02], None),
                1 => Motion::between([x, y], velocity, [0.5, 1.5]),
                2 => Ok(Motion::at_rest([x, y])),
                _ => Motion::moving([x, y], velocity, [0.0; 2], None),
            };
            let radius = draws.between(0.05, 0.4);
            obstacles.push(if obstacles.len() % 16 == 5 {
                Obstacle::rectangle([x, y], [0.4, 0.9], 0.3, limits).unwrap()
            } else {
                Obstacle::disc(radius, motion.unwrap(), limits).unwrap()
            });
        }
        let robot = HolonomicRobot {
            max_acceleration: [0.4, 2.0, 10.0][case / 27],
            ..HolonomicRobot::default()
        };
        Scenario::new(robot, [0.0; 2], [9.0, 1.0], obstacles, Rules::default()).unwrap()
    }

    /// Asserts that a planner which is told of few obstacles decides as one that is told of all; returns how many
    /// the two were told of, and how many the first one with those of decisions that it made again.
    fn assert_same(
        scenario: &Scenario,
        settings: VelocityObstacle,
        periods: u32,
        draws: &mut Draws,
    ) -> [usize; 3] {
        let planner = || VelocityObstaclePlanner::new(settings, scenario);
        let (mut one, mut other) = (planner(), planner());
        let mut relevant = Relevant::new(scenario);
        let (mut position, mut velocity) = (Vector::zeros(), Vector::zeros());
        let [mut told, mut all, mut asked] = [0; 3];
        for period in 0..periods {
            let time = 0.06 * f64::from(period);
            let everything = bodies_at(scenario, time);
            let situation = Situation {
                time,
                bodies: &everything,
                ages: &[],
                robot: RobotState { position, velocity },
                heading: 0.0,
                interval: 0.06,
                stop: Stop::never(),
            };
            let wanted = other.desired_velocity(&situation);
            let chosen = loop {
                let attention = one.attention(&situation);
                let bodies = relevant.at(scenario, time, attention);
                asked += bodies.len();
                let chosen = one.desired_velocity(&Situation {
                    bodies,
                    ..situation
                });
                if !one.overlooks() {
                    break chosen;
                }
            };
            let bits = [chosen, wanted].map(|velocity| velocity.map(f64::to_bits));
            assert_eq!(
                bits[0],
                bits[1],
                "{} obstacles, period {period}",
                everything.len()
            );
            (told, all) = (told + relevant.told.len(), all + everything.len());
            // Robots that are pushed off their way look anew.
            let push = if period % 9 == 8 { 0.3 } else { 0.0 };
            velocity = Vector::from(wanted);
            position += velocity * 0.06 + within(draws, push);
        }
        [told, all, asked]
    }

    #[test]
    fn a_planner_that_is_told_of_few_obstacles_decides_as_one_that_is_told_of_all() {
        let mut draws = Draws(0x9e37_79b9_7f4a_7c15);
        let (mut told, mut all) = (0, 0);
        for case in 0..81 {
            let scenario = scenario(&mut draws, case);
            let settings = VelocityObstacle {
                selection: match case % 5 {
                    3 => Selection::Fastest { sector: 0.8 },
                    4 => Selection::TimeAndRisk { risk: 0.5 },
                    _ => Selection::ToGoal,
                },
                horizon: if case % 4 == 0 { 3.0 } else { f64::INFINITY },
                margin: [0.0, 0.1, 0.4][case % 7 % 3],
                ..VelocityObstacle::default()
            };
            let [few, everything, _] = assert_same(&scenario, settings, 24, &mut draws);
            (told, all) = (told + few, all + everything);
        }
        assert!(3 * told < 2 * all, "{told} of {all}");
    }

    #[test]
    fn obstacles_behind_are_told_of_where_they_count() {
        let mut draws = Draws(0x1234_5678_9abc_def1);
        let (mut told, mut all) = (0, 0);
        for case in 0..400 {
            let (spread, fast) = ([1.5, 3.0, 12.0][case % 3], [0.3, 0.8, 1.5][case / 3 % 3]);
            let (count, limit) = ([16, 24, 48][case / 9 % 3], [0.4, 10.0][case % 2]);
            let scenario = crowd_around(&mut draws, count, [0.4, spread, fast], limit);
            let settings = VelocityObstacle {
                margin: [0.0, 0.1, 0.3][case % 7 % 3],
                ..VelocityObstacle::default()
            };
            let [few, everything, _] = assert_same(&scenario, settings, 12, &mut draws);
            (told, all) = (told + few, all + everything);
        }
        assert!(10 * told < 9 * all, "{told} of {all}");
    }

    #[test]
    fn of_a_ring_of_far_obstacles_little_is_told() {
        let mut draws = Draws(0x9e37_79b9_7f4a_7c15);
        let (mut asked, mut all) = (0, 0);
        for case in 0..24 {
            let away = [60.0, 200.0, 500.0][case % 3];
            let scenario = crowd_around(&mut draws, 300, [away, 2.0 * away, 0.5], 10.0);
            let settings = VelocityObstacle {
                margin: [0.01, 0.4][case % 2],
                ..VelocityObstacle::default()
            };
            let [_, everything, own] = assert_same(&scenario, settings, 12, &mut draws);
            (asked, all) = (asked + own, all + everything);
        }
        assert!(10 * asked < all, "{asked} of {all}");
    }

    #[test]
    fn no_velocity_that_matters_leads_near_a_disc_that_does_not() {
        let mut draws = Draws(0x2545_f491_4f6c_dd1d);
        let (mut left_out, mut left_behind) = (0, 0);
        for case in 0..20_000 {
            let radius = draws.between(0.0, 0.5);
            let outlook = Outlook {
                center: within(&mut draws, 1.0),
                radius: draws.between(0.0, 0.3),
                place: within(&mut draws, 3.0),
                off: draws.between(0.0, 0.2),
                ahead: 0.025,
                span: draws.between(0.0, 4.0),
                clearance: draws.between(0.1, 0.8),
                way: 0.1,
                haste: 0.12,
                behind: case % 2 == 0,
            };
            let center = within(&mut draws, 30.0);
            let velocity = within(&mut draws, 2.0);
            let disc = Discs {
                center,
                velocity,
                radius,
            };
            if outlook.concerns(&disc) {
                continue;
            }
            left_out += 1;
            for _ in 0..20 {
                let time = draws.between(0.0, outlook.span);
                let place = outlook.place + outlook.center * time + within(&mut draws, outlook.off);
                let seen = center + velocity * (time + outlook.ahead) - place;
                let kept = radius + outlook.clearance;
                assert!(seen.norm() > kept + outlook.way + outlook.haste * velocity.norm());
                let legs = Legs::of_disc(seen, kept);
                let relative = outlook.center - velocity;
                let [left, right] = [legs.left, legs.right].map(|leg| leg.perp(&relative));
                assert!(left > 0.0 || right < 0.0);
                // A leg is a ray from standstill relative to the disc on.
                let lines = [left.abs(), right.abs()];
                let rays = [legs.left, legs.right].map(|leg| {
                    let along = leg.dot(&relative).max(0.0);
                    (relative - leg * along).norm()
                });
                let far = |from: [f64; 2]| from.iter().all(|away| *away > outlook.radius);
                assert!(
                    far(if outlook.behind { lines } else { rays }),
                    "case {case}"
                );
                left_behind += usize::from(!far(lines));
            }
        }
        assert!(
            left_out > 2_000 && left_behind > 2_000,
            "{left_out} {left_behind}"
        );
    }

    #[test]
    fn what_is_no_disc_that_moves_straight_on_always_matters() {
        let mut draws = Draws(0x1234_5678_9abc_def1);
        let scenario = scenario(&mut draws, 11);
        let mut relevant = Relevant::new(&scenario);
        let outlook = Outlook {
            center: Vector::new(0.5, 0.0),
            radius: 0.0,
            place: Vector::zeros(),
            off: 0.0,
            ahead: 0.0,
            span: 0.0,
            clearance: 0.0,
            way: 0.0,
            haste: 0.0,
            behind: true,
        };
        relevant.at(&scenario, 0.3, Attention::Within(outlook));
        for (index, placed) in scenario.obstacles.iter().enumerate() {
            if placed.straight_disc().is_none() {
                assert!(relevant.told.contains(&index));
            }
        }
        let count = relevant.told.len();
        assert!(count < scenario.obstacles.len(), "{count}");
        let bodies = relevant.at(&scenario, 0.36, Attention::All).to_vec();
        let wanted = bodies_at(&scenario, 0.36);
        let places = |bodies: &[Body]| -> Vec<[u64; 2]> {
            let bits = |body: &Body| body.state.position.map(f64::to_bits);
            bodies.iter().map(bits).collect()
        };
        assert_eq!(places(&bodies), places(&wanted));
    }
}
