use super::*;
use crate::{Scan, Stop};
use navigation_world::robots::HolonomicRobot;
use navigation_world::world::geometry::{Body, RobotState};
use navigation_world::world::motion::Motion;
use navigation_world::world::obstacle::{Limits, Obstacle};
use navigation_world::world::scenario::{PlacedObstacle, Rules};

/// Control period, in s.
const INTERVAL: f64 = 0.06;

/// Numbers between two bounds, the same in every run.
struct Draws(pub(crate) u64);

impl Draws {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        low + (high - low) * ((self.0 >> 11) as f64 / (1_u64 << 53) as f64)
    }
}

fn crowd(draws: &mut Draws, count: usize) -> Scenario {
    let limits = Limits {
        critical_radius: Some(0.8),
        active_radius: Some(1.8),
        max_speed: None,
    };
    let obstacles = (0..count).map(|number| {
        // Some stand, so that lines of several cones start at one velocity.
        let speed = if number % 3 == 0 {
            0.0
        } else {
            draws.between(0.0, 1.2)
        };
        let course = draws.between(0.0, 6.3);
        let start = [draws.between(1.0, 9.0), draws.between(-4.0, 4.0)];
        let velocity = [speed * course.cos(), speed * course.sin()];
        let motion = Motion::moving(start, velocity, [0.0; 2], None).unwrap();
        Obstacle::disc(draws.between(0.05, 0.3), motion, limits).unwrap()
    });
    let obstacles = obstacles.collect();
    let robot = HolonomicRobot::default();
    Scenario::new(robot, [0.0; 2], [14.0, 0.0], obstacles, Rules::default()).unwrap()
}

/// The best of all candidates, one after the other.
fn best_of_all(
    planner: &VelocityObstaclePlanner,
    situation: &Situation<'_, f64>,
) -> Option<Vector> {
    let reachable = planner.reachable(situation);
    let aim = planner.direction_to_goal(situation);
    let wanted = planner.wanted(situation, aim);
    let mut candidates = planner.first_candidates(situation, aim).to_vec();
    for (index, line) in planner.lines.iter().enumerate() {
        candidates.extend(line.own(wanted, &reachable).into_iter().flatten());
        let crossings = planner.lines[..index].iter();
        candidates.extend(crossings.filter_map(|other| line.crossing(other)));
    }
    candidates.extend(VelocityObstaclePlanner::last_candidates(&reachable, aim));
    let mut best: Option<((f64, f64), Vector)> = None;
    for velocity in candidates {
        if !reachable.holds(velocity) {
            continue;
        }
        let worth = planner.worth(situation, aim, velocity);
        let better = best.is_none_or(|(known, _)| worth > known);
        if better && planner.free(situation, velocity) {
            best = Some((worth, velocity));
        }
    }
    best.map(|(_, velocity)| velocity)
}

#[test]
fn the_most_promising_lines_give_the_velocity_of_all_candidates() {
    let mut draws = Draws(0x9e37_79b9_7f4a_7c15);
    let selections = [
        Selection::ToGoal,
        Selection::Fastest { sector: 0.8 },
        Selection::TimeAndRisk { risk: 0.5 },
    ];
    let (mut found, mut nothing) = (0, 0);
    for case in 0..120 {
        let count = [1, 8, 20, 40, 80][case % 5];
        let scenario = crowd(&mut draws, count);
        let settings = VelocityObstacle {
            selection: selections[case % 3],
            horizon: if case % 2 == 0 { f64::INFINITY } else { 3.0 },
            margin: if case % 7 < 3 { 0.01 } else { 0.3 },
            ..VelocityObstacle::default()
        };
        let mut planner = VelocityObstaclePlanner::new(settings, &scenario);
        let mut time = draws.between(0.0, 3.0);
        let mut robot = RobotState {
            position: Vector2::new(draws.between(0.0, 6.0), draws.between(-1.0, 1.0)),
            velocity: Vector2::new(draws.between(-0.4, 0.6), draws.between(-0.4, 0.4)),
        };
        // The planner remembers what it chose a control period ago.
        for period in 0..4 {
            let body = |placed: &PlacedObstacle| Body {
                shape: placed.obstacle.shape,
                regions: placed.regions,
                state: placed.obstacle.motion.at(time, &mut 0),
            };
            let bodies: Vec<Body> = scenario.obstacles.iter().map(body).collect();
            let situation = Situation {
                time,
                bodies: &bodies,
                ages: &[],
                robot,
                heading: 0.0,
                interval: INTERVAL,
                scan: Scan::default(),
                stop: Stop::never(),
            };
            planner.look(&situation, settings.margin);
            let chosen = planner.select(&situation);
            let wanted = best_of_all(&planner, &situation);
            let bits = |velocity: Vector| velocity.lane(0).map(f64::to_bits);
            let place = format!("case {case}, period {period}");
            assert_eq!(chosen.map(bits), wanted.map(bits), "{place}");
            if let Some(velocity) = wanted {
                found += 1;
                robot.velocity = velocity;
            } else {
                nothing += 1;
            }
            robot.position += robot.velocity * INTERVAL;
            time += INTERVAL;
        }
    }
    assert!(found > 160 && nothing > 20, "{found} {nothing}");
}

#[test]
fn speeds_whose_squares_are_nearly_nothing_give_numbers() {
    for exponent in (100..=308).chain([320, 323]) {
        for scale in [1.0, 2.2, 4.7, 8.8] {
            let speed: f64 = format!("{scale}e-{exponent}").parse().unwrap();
            let reachable = lines::Reachable {
                velocity: Vector2::new(speed, -0.1 * speed),
                change: 0.025,
                max_speed: 0.7,
            };
            for met in lines::where_circles_meet(&reachable).into_iter().flatten() {
                assert!(met.lane(0).iter().all(|part| part.is_finite()), "{speed}");
            }
            let nothing = Vector2::new(f64::NAN, 0.0);
            assert!(!reachable.holds(nothing));
        }
    }
}
