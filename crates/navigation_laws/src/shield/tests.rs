use super::*;

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

/// A row of the check values of plans.
struct Row {
    limits: [f64; 4],
    latency: f64,
    velocity: [f64; 2],
    wanted: [f64; 2],
    person: ([f64; 2], f64, f64, f64),
}

const ROWS: [Row; 3] = [
    Row {
        limits: [0.7, 10.0, 0.06, 0.3],
        latency: 0.0,
        velocity: [0.0, 0.0],
        wanted: [0.078_256, 0.2163],
        person: ([0.560_601, 0.553_135], 0.4, 0.0, 1.0),
    },
    Row {
        limits: [1.5, 10.0, 0.1, 0.2],
        latency: 0.1,
        velocity: [0.661_018, 0.561_128],
        wanted: [-0.558_781, 0.970_084],
        person: ([-0.700_91, 0.936_106], 0.3, 0.0, 2.0),
    },
    Row {
        limits: [1.0, 2.0, 0.05, 0.3],
        latency: 0.0,
        velocity: [0.639_862, 0.252_829],
        wanted: [0.087_349, 0.329_504],
        person: ([0.246_78, 0.777_323], 0.4, 0.0, 2.0),
    },
];

impl Row {
    fn guard(&self) -> Guard {
        let [max_speed, max_acceleration, period, radius] = self.limits;
        let limits = ShieldLimits {
            radius,
            max_speed,
            max_acceleration,
            period,
        };
        Guard::new(EXACT, limits).unwrap()
    }

    fn person(&self) -> Person {
        let (position, radius, position_error, max_speed) = self.person;
        Person {
            position_error,
            max_speed,
            latency: self.latency,
            ..Person::disc(position, radius)
        }
    }

    fn robot(&self) -> RobotState<f64> {
        RobotState {
            position: Vector2::zeros(),
            velocity: self.velocity.into(),
        }
    }
}

fn near(vector: Vector2<f64>, [x, y]: [f64; 2], within: f64) -> bool {
    (vector - Vector2::new(x, y)).norm() <= within
}

#[test]
fn plans_of_the_specification() {
    let clipped = [
        [0.078_256, 0.2163],
        [-0.287_114, 0.879_004],
        [0.540_811, 0.266_575],
    ];
    let gaps = [-0.049_887, -0.023_325, -0.776_913];
    let changes = [Some(0.219_028), Some(0.236_326), None];
    for (index, row) in ROWS.iter().enumerate() {
        let (guard, people) = (row.guard(), [row.person()]);
        let view = View {
            robot: row.robot(),
            people: &people,
            walls: StaticObstacles::NONE,
            hidden: None,
        };
        let reached = guard.clipped(&view.robot, row.wanted.into());
        assert!(near(reached, clipped[index], 1e-6));
        assert!((guard.gap(&view, reached) - gaps[index]).abs() < 2e-4);
        let decision = guard.decide(&view, row.wanted.into());
        let Some(change) = changes[index] else {
            assert_eq!(decision.status, Status::Braking);
            assert!(near(decision.velocity, [0.548_453, 0.216_711], 1e-6));
            continue;
        };
        assert_eq!(decision.status, Status::Changed);
        let found = (decision.velocity - reached).norm();
        assert!(
            (found - change).abs() < 0.01 * guard.limits.max_speed,
            "{index}: {found}"
        );
        assert!(guard.gap(&view, decision.velocity) > 0.0);
    }
}

/// A robot among two people, drawn at random.
fn drawn(stream: &mut numeric::random::Stream) -> (Guard, RobotState<f64>, Vec<Person>) {
    let limits = ShieldLimits {
        radius: stream.uniform(0.15, 0.35),
        max_speed: stream.uniform(0.5, 1.5),
        max_acceleration: stream.uniform(2.0, 10.0),
        period: stream.uniform(0.05, 0.1),
    };
    let guard = Guard::new(EXACT, limits).unwrap();
    let mut polar = |most: f64| {
        let (sin, cos) = stream.uniform(0.0, std::f64::consts::TAU).sin_cos();
        Vector2::new(cos, sin) * (most * stream.unit().sqrt())
    };
    let robot = RobotState {
        position: Vector2::zeros(),
        velocity: polar(limits.max_speed),
    };
    let people = (0..2).map(|_| {
        let away = polar(0.6);
        let away = away * (1.0 + 0.7 / away.norm());
        Person {
            max_speed: 1.0,
            ..Person::disc(away.into(), 0.3)
        }
    });
    (guard, robot, people.collect())
}

#[test]
fn the_search_is_nearly_as_near_as_a_fine_grid() {
    let mut stream = numeric::random::Stream::new(7, 0);
    let (mut changed, mut missed) = (0, 0);
    for _ in 0..360 {
        let (guard, robot, people) = drawn(&mut stream);
        let view = View {
            robot,
            people: &people,
            walls: StaticObstacles::NONE,
            hidden: None,
        };
        let limits = guard.limits;
        let angle = stream.uniform(0.0, std::f64::consts::TAU);
        let wanted = Vector2::new(angle.cos(), angle.sin()) * limits.max_speed;
        let reached = guard.clipped(&robot, wanted);
        let decision = guard.decide(&view, wanted);
        if decision.status == Status::Kept {
            continue;
        }
        let mut least = f64::INFINITY;
        for row in -60..=60 {
            for column in -60..=60 {
                let step =
                    Vector2::new(f64::from(column), f64::from(row)) * (limits.change() / 60.0);
                let velocity = robot.velocity + step;
                if (velocity - reached).norm() < least && guard.verified(&view, velocity) {
                    least = (velocity - reached).norm();
                }
            }
        }
        changed += 1;
        match decision.status {
            Status::Braking => missed += u32::from(least.is_finite()),
            Status::Kept | Status::Changed => {
                let found = (decision.velocity - reached).norm();
                assert!(found <= least + 0.007 * limits.max_speed, "{found} {least}");
            }
            Status::Infeasible => panic!("a status of filters"),
        }
    }
    assert!(changed > 30 && missed <= 1, "{changed} {missed}");
}

#[test]
fn a_world_that_is_turned_or_mirrored_is_decided_alike() {
    let mut stream = numeric::random::Stream::new(9, 0);
    let mut changed = 0;
    for round in 0..600 {
        let (guard, robot, people) = drawn(&mut stream);
        let angle = stream.uniform(0.0, std::f64::consts::TAU);
        let wanted = Vector2::new(angle.cos(), angle.sin()) * guard.limits.max_speed;
        let hand = if round % 2 == 0 { 1.0 } else { -1.0 };
        let (sin, cos) = stream.uniform(0.0, std::f64::consts::TAU).sin_cos();
        let moved = |way: Vector2<f64>| {
            let across = hand * way.y;
            Vector2::new(cos * way.x - sin * across, sin * way.x + cos * across)
        };
        let others: Vec<Person> = people
            .iter()
            .map(|person| Person {
                max_speed: person.max_speed,
                ..Person::disc(moved(person.placed.center).into(), 0.3)
            })
            .collect();
        let decide = |robot: RobotState<f64>, people: &[Person], wanted| {
            let view = View {
                robot,
                people,
                walls: StaticObstacles::NONE,
                hidden: None,
            };
            guard.decide(&view, wanted)
        };
        let here = decide(robot, &people, wanted);
        let there = RobotState {
            position: moved(robot.position),
            velocity: moved(robot.velocity),
        };
        let there = decide(there, &others, moved(wanted));
        changed += u32::from(here.status == Status::Changed);
        assert_eq!(here.status, there.status, "{round}");
        let off = (moved(here.velocity) - there.velocity).norm();
        assert!(off < 1e-9, "{round}: {off}");
    }
    assert!(changed > 30, "{changed}");
}

#[test]
fn braking_continues_a_verified_plan() {
    let mut stream = numeric::random::Stream::new(8, 0);
    for _ in 0..200 {
        let (guard, robot, _) = drawn(&mut stream);
        let limits = guard.limits;
        let periods = braking_periods(robot.velocity.norm(), &limits);
        let slower = braking(robot.velocity, &limits);
        assert!((braking_periods(slower.norm(), &limits) - (periods - 1.0).max(0.0)).abs() < 0.5);
        // The same way: what is left of the old plan is the new one.
        let still = RobotState {
            position: Vector2::zeros(),
            velocity: robot.velocity,
        };
        let old = BrakingPlan::new(&still, robot.velocity, &limits, TrackingError::EXACT);
        let turned = RobotState {
            position: old.position(limits.period),
            velocity: robot.velocity,
        };
        let new = BrakingPlan::new(&turned, slower, &limits, TrackingError::EXACT);
        for part in 0..=10 {
            let time = 0.1 * f64::from(part) * new.end();
            let [one, other] = [old.position(limits.period + time), new.position(time)];
            assert!((one - other).norm() < 1e-12, "{one} {other}");
        }
    }
}

#[test]
fn who_may_have_any_speed_is_ahead_unless_his_velocity_is_known() {
    let limits = ShieldLimits {
        radius: 0.3,
        max_speed: 1.0,
        max_acceleration: 1.0,
        period: 0.1,
    };
    let robot = RobotState {
        position: Vector2::zeros(),
        velocity: Vector2::new(0.5, 0.0),
    };
    for latency in [0.0, 0.1] {
        let anywhere = Person {
            max_speed: f64::INFINITY,
            latency,
            ..Person::disc([5.0, 0.0], 0.3)
        };
        let known = Person {
            known: Some(KnownVelocity {
                velocity: Vector2::new(0.1, 0.0),
                error: 0.1,
                acceleration: 1.0,
            }),
            ..anywhere
        };
        let plan = BrakingPlan::new(&robot, robot.velocity, &limits, TrackingError::EXACT);
        assert!(!plan.avoids(&anywhere, &limits, 0.0));
        assert_eq!(
            plan.gap(&anywhere, &limits, 1e-3, f64::INFINITY),
            f64::NEG_INFINITY
        );
        assert!(plan.avoids(&known, &limits, 0.0));
        let gap = plan.gap(&known, &limits, 1e-3, f64::INFINITY);
        assert!(gap > 3.0 && gap < 5.0, "{gap}");
    }
}

#[test]
fn a_gap_from_a_very_fast_one_takes_a_bounded_number_of_steps() {
    let limits = ShieldLimits {
        radius: 0.3,
        max_speed: 1.0,
        max_acceleration: 1.0,
        period: 0.1,
    };
    let robot = RobotState {
        position: Vector2::zeros(),
        velocity: Vector2::new(0.5, 0.0),
    };
    let fast = Person {
        max_speed: 1e12,
        ..Person::disc([5.0, 0.0], 0.3)
    };
    let plan = BrakingPlan::new(&robot, robot.velocity, &limits, TrackingError::EXACT);
    let least = 4.4 - 1e12 * plan.end();
    let gap = plan.gap(&fast, &limits, 1e-5, f64::INFINITY);
    assert!((gap / least - 1.0).abs() < 1e-5, "{gap} {least}");
}

#[test]
fn what_a_robot_does_within_its_tracking_stays_off_everybody_a_verified_plan_avoids() {
    let mut stream = numeric::random::Stream::new(12, 0);
    let mut refused = 0;
    for round in 0..300 {
        let (exact, robot, people) = drawn(&mut stream);
        let tracking = TrackingError {
            absolute: if round % 2 == 0 {
                0.0
            } else {
                stream.uniform(0.0, 0.2)
            },
            relative: stream.uniform(0.0, 0.3),
        };
        let shield = Shield {
            position_tracking: stream.uniform(0.0, 0.02),
            velocity_tracking: tracking,
            ..EXACT
        };
        let limits = ShieldLimits {
            radius: exact.limits.radius - EXACT.around(),
            ..exact.limits
        };
        let guard = Guard::new(shield, limits).unwrap();
        let view = View {
            robot,
            people: &people,
            walls: StaticObstacles::NONE,
            hidden: None,
        };
        let angle = stream.uniform(0.0, std::f64::consts::TAU);
        let wanted = Vector2::new(angle.cos(), angle.sin()) * limits.max_speed;
        let command = guard.decide(&view, wanted);
        if command.status == Status::Braking {
            refused += 1;
            continue;
        }
        let plan = guard.plan(&robot, command.velocity);
        for part in 0..=400 {
            let time = plan.end() * f64::from(part) / 400.0;
            let planned = plan.velocity(time);
            if planned.norm() < 1e-9 && plan.velocity(0.0).norm() < 1e-9 {
                continue;
            }
            for turn in 0..16 {
                let (sin, cos) = stream.uniform(0.0, std::f64::consts::TAU).sin_cos();
                let aside = Vector2::new(cos, sin);
                let most = tracking.velocity(planned.norm())
                    * if turn % 2 == 0 { 1.0 } else { stream.unit() };
                let velocity = planned + aside * most;
                let place = plan.position(time) + aside * shield.position_tracking;
                if velocity.norm() < 1e-9 {
                    continue;
                }
                for person in &people {
                    let offset = person.placed.center - place;
                    let radius = limits.radius + person.radius();
                    let ahead = velocity / velocity.norm();
                    let free = half_disc_distance(offset, radius, ahead) - person.reach(time);
                    assert!(free > 0.0, "{round} at {time}: {free} {tracking:?}");
                }
            }
        }
    }
    assert!(refused < 200, "{refused}");
}

#[test]
fn a_measurement_beyond_all_that_is_assumed_refutes_the_plan() {
    let limits = ShieldLimits {
        radius: 0.2,
        max_speed: 1.0,
        max_acceleration: 1.0,
        period: 0.1,
    };
    let shield = Shield {
        velocity_tracking: TrackingError {
            absolute: 0.01,
            relative: 0.02,
        },
        ..Shield::default()
    };
    let robot = RobotState {
        position: Vector2::zeros(),
        velocity: Vector2::new(0.5, 0.0),
    };
    let course = Course::of_velocity(0.0, &robot, robot.velocity, &limits);
    let measured = |away: f64, speed: f64| RobotState {
        position: course.position(0.1) + Vector2::new(0.0, away),
        velocity: Vector2::new(speed, 0.0),
    };
    let refuted = |away, speed| shield.refuted(&course, 0.1, &measured(away, speed));
    assert_eq!(refuted(0.0149, 0.519), None);
    let found = refuted(0.1, 0.5).unwrap();
    assert!((found.position - 0.085).abs() < 1e-12 && found.velocity == 0.0);
    let found = refuted(0.0, 0.4).unwrap();
    assert!((found.velocity - 0.08).abs() < 1e-12 && found.position == 0.0);
}
