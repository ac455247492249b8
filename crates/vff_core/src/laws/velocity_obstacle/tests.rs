use super::parts::{Forbidden, NO_LINE, Part};
use super::remaining::Remaining;
use super::*;
use crate::laws::Stop;
use crate::robots::HolonomicRobot;
use crate::world::geometry::{Body, RobotState};
use crate::world::motion::Motion;
use crate::world::obstacle::{Limits, Obstacle};
use crate::world::scenario::{PlacedObstacle, Rules};

/// Control period, in s.
const INTERVAL: f64 = 0.06;

/// Numbers between two bounds, the same in every run.
pub(crate) struct Draws(pub(crate) u64);

impl Draws {
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
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

/// Discs that move straight on around a robot, farther away than given and within a square.
pub(crate) fn crowd_around(
    draws: &mut Draws,
    count: usize,
    [clear, spread, fast]: [f64; 3],
    max_acceleration: f64,
) -> Scenario {
    let mut obstacles = Vec::new();
    while obstacles.len() < count {
        let mut pair = |size: f64| [draws.between(-size, size), draws.between(-size, size)];
        let (start, velocity) = (pair(spread), pair(fast));
        if start[0].hypot(start[1]) > clear {
            let motion = Motion::moving(start, velocity, [0.0; 2], None).unwrap();
            obstacles.push(Obstacle::disc(0.1, motion, Limits::default()).unwrap());
        }
    }
    let robot = HolonomicRobot {
        max_acceleration,
        ..HolonomicRobot::default()
    };
    Scenario::new(robot, [0.0; 2], [9.0, 1.0], obstacles, Rules::default()).unwrap()
}

fn bodies_at(scenario: &Scenario, time: f64) -> Vec<Body> {
    let body = |placed: &PlacedObstacle| Body {
        shape: placed.obstacle.shape,
        regions: placed.regions,
        state: placed.obstacle.motion.at(time, &mut 0),
    };
    scenario.obstacles.iter().map(body).collect()
}

fn situation(bodies: &[Body], robot: RobotState<f64>, time: f64) -> Situation<'_, f64> {
    Situation {
        time,
        bodies,
        ages: &[],
        robot,
        heading: 0.0,
        interval: INTERVAL,
        stop: Stop::never(),
    }
}

/// The best of all candidates, one after the other.
fn best_of_all(
    planner: &VelocityObstaclePlanner,
    situation: &Situation<'_, f64>,
) -> Option<Vector> {
    best_of(planner, situation, |_| true)
}

/// The best of all candidates but the crossings of some lines.
fn best_of(
    planner: &VelocityObstaclePlanner,
    situation: &Situation<'_, f64>,
    counts: impl Fn((&Line, &Line, Vector)) -> bool,
) -> Option<Vector> {
    let reachable = planner.reachable(situation);
    let aim = planner.direction_to_goal(situation);
    let wanted = planner.wanted(situation, aim);
    let mut candidates = planner.first_candidates(situation, aim).to_vec();
    let lines: Vec<Line> = planner.lines().map(|(_, line)| line).collect();
    for (index, line) in lines.iter().enumerate() {
        candidates.extend(line.own(wanted, &reachable).into_iter().flatten());
        let crossings = lines[..index].iter();
        candidates.extend(crossings.filter_map(|other| {
            let crossing = line.crossing(other);
            crossing.filter(|velocity| counts((line, other, *velocity)))
        }));
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
            let bodies = bodies_at(&scenario, time);
            let situation = situation(&bodies, robot, time);
            planner.look(&situation, settings.margin);
            let chosen = planner.select(0, &situation);
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
fn crossings_behind_the_tips_count_where_something_is_near() {
    let mut draws = Draws(0x9e37_79b9_7f4a_7c15);
    let (mut near, mut behind) = (0, 0);
    for case in 0..120 {
        let scenario = crowd_around(&mut draws, 24, [0.4, 1.5, 0.8], [0.4, 10.0][case % 2]);
        let mut planner = VelocityObstaclePlanner::new(VelocityObstacle::default(), &scenario);
        let mut robot = RobotState {
            position: Vector2::zeros(),
            velocity: Vector2::zeros(),
        };
        for period in 0..12 {
            let bodies = bodies_at(&scenario, INTERVAL * f64::from(period));
            let situation = situation(&bodies, robot, INTERVAL * f64::from(period));
            planner.look(&situation, 0.01);
            let chosen = planner.select(0, &situation);
            let wanted = best_of_all(&planner, &situation);
            assert_eq!(chosen, wanted, "case {case}, period {period}");
            let ahead = |(one, other, velocity): (&Line, &Line, Vector)| {
                one.is_ahead(velocity) && other.is_ahead(velocity)
            };
            if best_of(&planner, &situation, ahead) != wanted {
                assert!(!planner.close.is_empty(), "case {case}, period {period}");
                behind += 1;
            }
            near += usize::from(!planner.close.is_empty());
            robot.velocity = wanted.unwrap_or(robot.velocity);
            robot.position += robot.velocity * INTERVAL;
        }
    }
    assert!(near > 200 && behind > 1, "{near} {behind}");
}

#[test]
fn what_is_taken_away_is_forbidden_or_worth_less() {
    let mut draws = Draws(0x1234_5678_9abc_def1);
    let (mut taken, mut wide, mut held) = (0, 0, 0);
    for case in 0..160 {
        let count = [4, 13, 40, 80][case % 4];
        let scenario = crowd(&mut draws, count);
        let settings = VelocityObstacle {
            margin: [0.0, 0.01, 0.3][case % 3],
            ..VelocityObstacle::default()
        };
        let mut planner = VelocityObstaclePlanner::new(settings, &scenario);
        let time = draws.between(0.0, 3.0);
        let robot = RobotState {
            position: Vector2::new(draws.between(0.0, 6.0), draws.between(-1.0, 1.0)),
            velocity: Vector2::new(draws.between(-0.4, 0.6), draws.between(-0.4, 0.4)),
        };
        planner.max_acceleration = [0.5, 10.0][case / 4 % 2];
        let bodies = bodies_at(&scenario, time);
        let situation = situation(&bodies, robot, time);
        planner.look(&situation, settings.margin);
        let reachable = planner.reachable(&situation);
        let aim = planner.direction_to_goal(&situation);
        planner.draw_lines(aim);
        let wanted = best_of_all(&planner, &situation);
        let mut remaining = Remaining::default();
        let mut best = Best::new(&planner, &situation, (reachable, aim), Box::default());
        // Some searches know a free velocity before.
        if case % 5 > 0 {
            best.offer((0, 2), Vector::zeros());
        }
        let soonest = planner.wanted(&situation, aim);
        if !best.take_away(&mut remaining, soonest) {
            continue;
        }
        taken += 1;
        let caps = &remaining.caps;
        wide += usize::from(caps.iter().any(|cap| cap.radius > 0.1));
        let left = |velocity: Vector| caps.iter().any(|cap| cap.may_hold(velocity));
        assert!(wanted.is_none_or(left), "case {case}");
        for draw in 0..600 {
            let (around, spread) = match wanted {
                Some(best) if draw % 3 == 0 => (best, [1e-7, 1e-5, 1e-3][draw / 3 % 3]),
                _ => (robot.velocity, 1.5 * reachable.change.min(0.7)),
            };
            let (x, y) = (
                draws.between(-spread, spread),
                draws.between(-spread, spread),
            );
            let velocity = around + Vector::new(x, y);
            let counts = reachable.holds(velocity) && velocity.dot(&aim) >= best.floor();
            if counts && planner.free(&situation, velocity) {
                assert!(left(velocity), "case {case}: {velocity:?}");
                held += 1;
            }
        }
    }
    assert!(
        taken > 120 && wide < 40 && held > 200,
        "{taken} {wide} {held}"
    );
}

#[test]
fn a_cone_leaves_all_of_a_part_that_it_does_not_forbid() {
    let mut draws = Draws(0x9e37_79b9_7f4a_7c15);
    let (mut inside, mut outside) = (0, 0);
    for _ in 0..2_000 {
        let mut place =
            |size: f64| Vector::new(draws.between(-size, size), draws.between(-size, size));
        let (center, tip, corner) = (place(3.0), place(1.0), place(0.5));
        let mut part = Part::quadrangle([
            corner,
            corner + Vector::new(0.4, 0.0),
            corner + Vector::new(0.4, 0.3),
            corner + Vector::new(0.0, 0.3),
        ]);
        for _ in 0..3 {
            let angle = place(3.2).x;
            let along = Vector::new(angle.cos(), angle.sin());
            let least = along.dot(&(corner + Vector::new(0.2, 0.15))) - 0.1;
            part = part.beyond(along, least, NO_LINE);
        }
        let mut cone = [Cone {
            tip,
            legs: None,
            base: ConeBase::Disc(center, 0.4),
        }];
        cones::draw_legs(&mut cone, &mut Vec::new());
        let Some(forbidden) = Forbidden::of(&cone[0], 0, 2.0) else {
            continue;
        };
        let left = forbidden.taken_from(&part);
        for _ in 0..20 {
            let shares = part
                .corners()
                .iter()
                .map(|_| draws.between(0.0, 1.0).powi(4));
            let shares: Vec<f64> = shares.collect();
            let total: f64 = shares.iter().sum();
            let corners = part.corners().iter().zip(&shares);
            let velocity: Vector = corners
                .map(|(corner, share)| corner * (share / total))
                .sum();
            let kept = left.iter().any(|part| holds(part, velocity));
            let time = cone[0].time_to_contact(velocity, &[]);
            if time == f64::INFINITY {
                assert!(kept, "{velocity:?}");
                outside += 1;
            } else if forbidden.holds(velocity) {
                assert!(!kept, "{velocity:?}");
                inside += 1;
            }
        }
    }
    assert!(inside > 2_000 && outside > 10_000, "{inside} {outside}");
}

/// Whether a velocity is in a part, up to roundings.
fn holds(part: &Part, velocity: Vector) -> bool {
    let corners = part.corners();
    let count = corners.len();
    let mut edges = (0..count).map(|index| (corners[index], corners[(index + 1) % count]));
    let left_of = |(from, to): (Vector, Vector)| (to - from).perp(&(velocity - from)) >= -1e-12;
    count > 0 && edges.all(left_of)
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
