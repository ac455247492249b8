//! Properties of worlds of people and robots.

use std::f64::consts::TAU;
use std::sync::Arc;

use nalgebra::{Rotation2, Vector2};
use numeric::random::Stream;
use vff_core::crowd::models::collision_free_speed::CollisionFreeSpeed;
use vff_core::crowd::models::moussaid::Moussaid;
use vff_core::crowd::models::reciprocal_people::ReciprocalPeople;
use vff_core::crowd::models::social_force_1995::SocialForce1995;
use vff_core::crowd::models::social_force_2000::SocialForce2000;
use vff_core::crowd::neighbors::grid::Period;
use vff_core::crowd::walls::Wall;
use vff_core::crowd::world::{
    PersonSetup, RobotSetup, Route, RouteEnd, SourceSetup, Traits, Waypoint,
};
use vff_core::crowd::{CrowdWorld, Diverged, Model, Simulation, simulate_worlds};
use vff_core::laws::planning::family::Planned;
use vff_core::laws::reciprocal::ReciprocalAvoidance;
use vff_core::laws::safe::SafeNavigation;
use vff_core::laws::shield::Shield;
use vff_core::robots::HolonomicRobot;
use vff_core::run::{AnyLaw, Request};
use vff_core::world::motion::Motion;
use vff_core::world::scenario::Mover;

type Vector = Vector2<f64>;

const STEP: f64 = 0.05;

fn first() -> Model {
    Model::SocialForce1995(SocialForce1995 {
        relaxation_time: 0.5,
        strength: 2.1,
        range: 0.3,
        step_time: 2.0,
        wall_strength: 10.0,
        wall_range: 0.2,
        view_angle: 100.0_f64.to_radians(),
        behind: 0.5,
        cutoff: 5.0,
    })
}

fn pressing() -> Model {
    Model::SocialForce2000(SocialForce2000 {
        relaxation_time: 0.5,
        mass: 80.0,
        strength: 2000.0,
        range: 0.08,
        stiffness: 1.2e5,
        friction: 2.4e5,
        anisotropy: 1.0,
        wall_strength: 2000.0,
        cutoff: 2.5,
    })
}

fn behavioral(side_bias: f64) -> Model {
    Model::Moussaid(Moussaid {
        relaxation_time: 0.54,
        strength: 4.5,
        gamma: 0.35,
        n: 2.0,
        n_prime: 3.0,
        velocity_weight: 2.0,
        side_bias,
        wall_strength: 3.0,
        wall_range: 0.1,
        gaze: 4.0,
        cohesion: 3.0,
        separation: 1.0,
        view_angle: TAU / 4.0,
        contact_distance: 0.55,
        cutoff: 8.0,
    })
}

fn speed() -> Model {
    Model::CollisionFreeSpeed(CollisionFreeSpeed {
        time_gap: 1.0,
        strength: 8.0,
        range: 0.1,
        wall_strength: 5.0,
        wall_range: 0.02,
        cutoff: 3.0,
    })
}

fn reciprocal() -> Model {
    Model::ReciprocalAvoidance(ReciprocalPeople {
        horizon: 5.0,
        wall_horizon: 0.5,
        max_neighbors: 10,
        margin: 0.01,
        cutoff: 10.0,
    })
}

fn all_models() -> [Model; 5] {
    [
        first(),
        pressing(),
        behavioral(0.005),
        speed(),
        reciprocal(),
    ]
}

fn person(start: Vector, goal: Vector) -> PersonSetup {
    PersonSetup {
        start: start.into(),
        velocity: [0.0; 2],
        enters: 0.0,
        recorded: None,
        pursuer: None,
        group: None,
        traits: Traits {
            radius: 0.25,
            desired_speed: Some(1.3),
            awareness: 1.0,
            distracted_share: 0.0,
            model: 0,
            route: Route::to(goal.into()),
        },
    }
}

fn world(model: Model, people: Vec<PersonSetup>) -> CrowdWorld {
    CrowdWorld {
        people,
        robots: Vec::new(),
        sources: Vec::new(),
        walls: Vec::new(),
        untold: 0,
        models: vec![model],
        period: Period::default(),
        step: STEP,
        time_limit: 4.0,
        seed: 3,
    }
}

fn avoidance(share: f64) -> AnyLaw {
    AnyLaw::one_by_one(Planned(ReciprocalAvoidance {
        share,
        ..ReciprocalAvoidance::default()
    }))
}

/// A second: crowds in which bodies press on each other enlarge roundings.
fn brief(model: Model, people: Vec<PersonSetup>) -> CrowdWorld {
    CrowdWorld {
        time_limit: 1.0,
        ..world(model, people)
    }
}

fn robot(start: [f64; 2], goal: [f64; 2], law: Option<AnyLaw>) -> RobotSetup {
    RobotSetup {
        mover: Mover::Holonomic(HolonomicRobot::default()),
        footprint: None,
        start,
        goal,
        heading: 0.0,
        control_period: STEP,
        arrival_tolerance: 0.3,
        sensing_range: 10.0,
        occlusion: false,
        task: None,
        measurement: None,
        built: None,
        law,
    }
}

fn ended(world: CrowdWorld) -> Simulation {
    let world = Simulation::new(world, true).unwrap();
    world.completed(&|| false).unwrap()
}

fn places(ended: &Simulation) -> Vec<f64> {
    ended.recorded().unwrap().person_positions()
}

/// People in a square, each on the way to another place in it.
fn scattered(count: usize, side: f64, seed: u64) -> Vec<PersonSetup> {
    let mut stream = Stream::new(seed, 0);
    let mut place = || Vector::new(stream.uniform(0.0, side), stream.uniform(0.0, side));
    let mut people: Vec<PersonSetup> = Vec::new();
    while people.len() < count {
        let start = place();
        let apart = |other: &PersonSetup| (Vector::from(other.start) - start).norm() > 0.6;
        if people.iter().all(apart) {
            people.push(person(start, place()));
        }
    }
    people
}

fn largest(one: &[f64], other: &[f64]) -> f64 {
    assert_eq!(one.len(), other.len());
    let pairs = one
        .iter()
        .zip(other)
        .filter(|(a, b)| !(a.is_nan() && b.is_nan()));
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn somebody_alone_reaches_the_wanted_speed_as_the_drive_says() {
    for (model, relaxation_time, parts) in [
        (first(), 0.5, 1),
        (pressing(), 0.5, 5),
        (behavioral(0.005), 0.54, 1),
    ] {
        let alone = vec![person(Vector::zeros(), Vector::new(50.0, 0.0))];
        let mut world = Simulation::new(world(model, alone), false).unwrap();
        for step in 1..=40 {
            world.step(&|| false).unwrap();
            let part = STEP / f64::from(parts);
            let expected = 1.3 * (1.0 - (1.0 - part / relaxation_time).powi(step * parts));
            let velocity = world.people()[0].velocity;
            assert!(
                (velocity - Vector::new(expected, 0.0)).norm() < 1e-13,
                "{velocity:?}"
            );
        }
    }
}

#[test]
fn people_in_single_file_walk_as_their_gaps_allow() {
    for count in [4, 10, 20, 35] {
        let (length, gap) = (20.0, 20.0 / f64::from(count));
        let place = |index| Vector::new(gap * f64::from(index), 0.0);
        let file =
            (0..count).map(|index| person(place(index), place(index) + Vector::new(1e6, 0.0)));
        let mut world = world(speed(), file.collect());
        world.period = Period([length, 0.0]);
        let mut run = Simulation::new(world, false).unwrap();
        run.step(&|| false).unwrap();
        let expected = (gap - 0.5).clamp(0.0, 1.3);
        for person in run.people() {
            assert!(
                (person.velocity.x - expected).abs() < 1e-12,
                "{count}: {:?}",
                person.velocity
            );
        }
    }
}

/// The place of a waypoint that is a point.
fn first_place(waypoint: Waypoint) -> [f64; 2] {
    match waypoint {
        Waypoint::Point(place) => place,
        Waypoint::Line([start, _]) => start,
    }
}

/// Where a route goes first.
fn first_point(route: &Route) -> Vector {
    first_place(route.points[0]).into()
}

#[test]
fn renumbered_turned_and_mirrored_worlds_are_the_same() {
    let mut people = scattered(40, 9.0, 5);
    for person in &mut people {
        // From rest nobody turns to either side, and rounding would decide.
        let way = first_point(&person.traits.route) - Vector::from(person.start);
        person.velocity = (way.normalize() * 1.1).into();
    }
    let mut models = all_models();
    models[2] = behavioral(0.0);
    for model in models {
        let before = places(&ended(brief(model, people.clone())));
        let mut renumbered = people.clone();
        renumbered.reverse();
        let found = places(&ended(brief(model, renumbered)));
        let row = 2 * people.len();
        let reversed = found.chunks_exact(row).flat_map(|row| {
            let pairs = row.chunks_exact(2).rev();
            pairs.flatten().copied().collect::<Vec<_>>()
        });
        let reversed: Vec<f64> = reversed.collect();
        assert!(largest(&before, &reversed) < 1e-9, "{model:?}");
        let turn = Rotation2::new(0.7);
        for mirror in [1.0, -1.0] {
            // Reciprocal people meet ties by turning to one side.
            let moved = |place: [f64; 2]| turn * Vector::new(place[0], mirror * place[1]);
            let mut others = people.clone();
            for person in &mut others {
                person.start = moved(person.start).into();
                person.velocity = moved(person.velocity).into();
                for point in &mut person.traits.route.points {
                    *point = Waypoint::Point(moved(first_place(*point)).into());
                }
            }
            let found = places(&ended(brief(model, others)));
            let back: Vec<f64> = before
                .chunks_exact(2)
                .flat_map(|place| <[f64; 2]>::from(moved([place[0], place[1]])))
                .collect();
            assert!(
                largest(&back, &found) < 1e-9,
                "{model:?}: {}",
                largest(&back, &found)
            );
        }
    }
}

#[test]
fn the_grid_finds_whoever_all_pairs_find() {
    for (model, period) in all_models().into_iter().flat_map(|model| {
        [[0.0; 2], [12.0, 0.0], [12.0, 30.0], [4.0, 4.0]].map(|period| (model, period))
    }) {
        let mut people = scattered(60, 12.0, 8);
        // Somebody far away makes the cells larger.
        people.push(person(Vector::new(-4e7, 3e6), Vector::new(-4e7, 0.0)));
        let mut near = world(model, people.clone());
        near.period = Period(period);
        near.time_limit = 0.2;
        let mut all = near.clone();
        // A model that nobody follows, and that has no cutoff.
        let Model::CollisionFreeSpeed(unlimited) = speed() else {
            unreachable!()
        };
        let cutoff = f64::INFINITY;
        all.models
            .push(Model::CollisionFreeSpeed(CollisionFreeSpeed {
                cutoff,
                ..unlimited
            }));
        let deviation = largest(&places(&ended(near)), &places(&ended(all)));
        assert!(deviation < 1e-11, "{model:?} {period:?}: {deviation:e}");
    }
}

#[test]
fn people_who_do_not_notice_a_robot_walk_as_if_there_were_none() {
    for model in [first(), behavioral(0.005), speed(), reciprocal()] {
        let mut people = scattered(30, 9.0, 2);
        for person in &mut people {
            person.traits.awareness = 0.0;
        }
        let without = places(&ended(world(model, people.clone())));
        let mut with = world(model, people);
        with.robots
            .push(robot([-3.0, -3.0], [12.0, 12.0], Some(avoidance(1.0))));
        let with = places(&ended(with));
        let common = with.len().min(without.len());
        assert_eq!(with[..common], without[..common], "{model:?}");
    }
}

#[test]
fn reciprocal_people_never_touch() {
    let mut stream = Stream::new(1, 0);
    for _ in 0..200 {
        let mut place = || Vector::new(stream.uniform(-4.0, 4.0), stream.uniform(-4.0, 4.0));
        let (one, other) = (place(), place());
        if (one - other).norm() < 0.6 {
            continue;
        }
        let people = vec![person(one, other), person(other, one)];
        let mut world = world(reciprocal(), people);
        world.time_limit = 12.0;
        let found = places(&ended(world));
        for row in found.chunks_exact(4) {
            let way = Vector::new(row[0] - row[2], row[1] - row[3]);
            assert!(way.norm() > 0.5, "{one:?} {other:?}");
        }
    }
}

#[test]
fn forces_of_equal_people_on_each_other_cancel() {
    let mut people = scattered(30, 4.0, 9);
    for person in &mut people {
        person.traits.route = Route::to([50.0, person.start[1]]);
    }
    let mut run = Simulation::new(world(pressing(), people), false).unwrap();
    let momentum = |run: &Simulation| run.people().iter().map(|one| one.velocity).sum::<Vector>();
    // The drive of a motion step is known: the rest comes from others.
    let drives = |run: &Simulation, part: f64| {
        let drive = |(person, setup): (&vff_core::crowd::people::PersonState, &PersonSetup)| {
            let way = first_point(&setup.traits.route) - person.position;
            (way.normalize() * 1.3 - person.velocity) / 0.5 * part
        };
        run.people()
            .iter()
            .zip(&run.world().people)
            .map(drive)
            .sum::<Vector>()
    };
    run.restart(|world| world.step = 0.01).unwrap();
    for _ in 0..20 {
        let expected = momentum(&run) + drives(&run, 0.01);
        run.step(&|| false).unwrap();
        assert!((momentum(&run) - expected).norm() < 1e-9);
    }
}

#[test]
fn threads_and_restarts_change_no_bit() {
    let worlds: Vec<CrowdWorld> = (0..7)
        .map(|seed| {
            let mut world = world(
                all_models()[usize::try_from(seed).unwrap() % 5],
                scattered(30, 8.0, seed),
            );
            world.people[0].traits.desired_speed = None;
            world.seed = seed;
            world
                .robots
                .push(robot([-2.0, 4.0], [10.0, 4.0], Some(avoidance(1.0))));
            world
        })
        .collect();
    let run = |threads| {
        let shared: Vec<Arc<CrowdWorld>> = worlds.iter().cloned().map(Arc::new).collect();
        let ended = simulate_worlds(&shared, Some(threads), &|| false, &|_| ()).unwrap();
        ended.iter().map(places).collect::<Vec<_>>()
    };
    let one = run(1);
    assert_eq!(one, run(2));
    assert_eq!(one, run(7));
    let mut again = Simulation::new(worlds[3].clone(), true).unwrap();
    for _ in 0..9 {
        again.step(&|| false).unwrap();
    }
    again.restart(|world| *world = worlds[5].clone()).unwrap();
    assert_eq!(places(&again.completed(&|| false).unwrap()), one[5]);
}

#[test]
fn sources_let_people_in_where_there_is_room() {
    let mut world = world(speed(), Vec::new());
    let mut traits = person(Vector::zeros(), Vector::new(6.0, 1.0)).traits;
    traits.route.end = RouteEnd::Leave;
    traits.route.arrival_radius = 1.0;
    traits.desired_speed = None;
    world.sources = vec![SourceSetup {
        low: [0.0, 0.0],
        high: [0.5, 2.0],
        rate: 2.0,
        regular: true,
        traits,
    }];
    world.time_limit = 20.0;
    let run = ended(world);
    let people = run.people();
    assert!((35..=39).contains(&people.len()), "{}", people.len());
    let speeds: Vec<f64> = people.iter().map(|person| person.desired_speed).collect();
    assert!(speeds.iter().all(|speed| (0.5..=2.2).contains(speed)));
    assert!(speeds.iter().any(|speed| (speed - speeds[0]).abs() > 0.1));
    assert!(people.iter().filter(|person| !person.is_present()).count() > 10);
    let found = places(&run);
    let row = 2 * people.len();
    for (number, _) in people.iter().enumerate() {
        let mut rows = found
            .chunks_exact(row)
            .map(|row| [row[2 * number], row[2 * number + 1]]);
        let [x, y] = rows.find(|place| !place[0].is_nan()).unwrap();
        assert!((0.0..=0.5).contains(&x) && (0.0..=2.0).contains(&y));
    }
}

#[test]
fn a_state_that_is_not_finite_ends_the_world() {
    let Model::SocialForce2000(model) = pressing() else {
        unreachable!()
    };
    let strong = Model::SocialForce2000(SocialForce2000 {
        stiffness: 1e308,
        ..model
    });
    let people = vec![
        person(Vector::new(3.0, 0.0), Vector::new(9.0, 0.0)),
        person(Vector::zeros(), Vector::new(9.0, 0.0)),
        person(Vector::new(0.1, 0.0), Vector::new(9.0, 0.0)),
    ];
    let run = ended(world(strong, people));
    let found = run.divergence().unwrap();
    assert!(matches!(found.agent, Diverged::Person(1 | 2)));
    assert!(found.time < 0.2 && run.finished());
    assert!(places(&run).iter().all(|place| place.is_finite()));
}

#[test]
fn people_who_would_pass_a_wall_are_set_back_and_counted() {
    let mut rescues = 0;
    for model in all_models() {
        let mut world = world(model, scattered(30, 5.0, 9));
        let room = vec![
            [-0.5, -0.5],
            [5.5, -0.5],
            [5.5, 5.5],
            [-0.5, 5.5],
            [-0.5, -0.5],
        ];
        world.walls = vec![Wall::polyline(room).unwrap()];
        for person in &mut world.people {
            person.traits.route.points = vec![Waypoint::Line([[20.0, -20.0], [20.0, 20.0]])];
        }
        world.time_limit = 10.0;
        let run = ended(world);
        for place in run.recorded().unwrap().person_positions() {
            let kept = -0.5 + 0.1 * run.people()[0].radius - 1e-9;
            assert!(place > kept && place < 5.0 - kept, "{model:?} {place}");
        }
        rescues += run.wall_rescues();
    }
    assert!(rescues > 0);
}

#[test]
fn robots_arrive_among_people_and_each_other() {
    let law = || Some(avoidance(0.5));
    let people = vec![person(Vector::new(4.0, 3.0), Vector::new(4.0, -3.0))];
    let mut world = world(reciprocal(), people);
    world.robots = vec![
        robot([0.0, 0.0], [8.0, 0.0], law()),
        robot([8.0, 0.1], [0.0, 0.1], law()),
    ];
    world.walls = vec![Wall::polyline(vec![[0.0, -4.0], [8.0, -4.0]]).unwrap()];
    world.time_limit = 30.0;
    let run = ended(world);
    let record = run.recorded().unwrap();
    for robot in run.robots() {
        assert!(robot.has_arrived() && robot.arrival_time() > 10.0);
    }
    for pair in record.robot_position.chunks_exact(2) {
        assert!((pair[0] - pair[1]).norm() > 0.4);
    }
    assert!(
        run.time() < 30.0,
        "the world ends when nobody is on the way"
    );
}

#[test]
fn a_shielded_robot_never_drives_into_people() {
    let law = SafeNavigation {
        shield: Some(Shield::default()),
        ..SafeNavigation::bare(avoidance(1.0))
    };
    for seed in 0..5 {
        let mut people = scattered(12, 6.0, seed);
        people.retain(|person| Vector::from(person.start).norm() > 0.8);
        for person in &mut people {
            person.traits.awareness = 0.0;
        }
        let mut world = world(speed(), people);
        world.robots = vec![robot(
            [0.0, 0.0],
            [6.0, 6.0],
            Some(AnyLaw::one_by_one(law.clone())),
        )];
        world.time_limit = 15.0;
        let run = ended(world);
        let record = run.recorded().unwrap();
        let rows = places(&run);
        let row = 2 * run.people().len();
        for (index, row) in rows.chunks_exact(row).enumerate() {
            let (place, velocity) = (record.robot_position[index], record.robot_velocity[index]);
            for person in row.chunks_exact(2) {
                let way = Vector::new(person[0], person[1]) - place;
                let toward = velocity.dot(&way) / way.norm();
                assert!(
                    way.norm() > 0.45 || toward < 1e-9,
                    "seed {seed}: {way:?} {velocity:?}"
                );
            }
        }
    }
}

#[test]
fn a_robot_does_what_it_is_told() {
    let mut world = world(speed(), Vec::new());
    world.robots.push(robot([0.0, 0.0], [5.0, 0.0], None));
    let mut run = Simulation::new(world, false).unwrap();
    run.ask(0, Request::Velocity([0.0, 0.5]));
    for _ in 0..20 {
        run.step(&|| false).unwrap();
    }
    let state = run.robots()[0].state();
    assert!((state.velocity - Vector::new(0.0, 0.5)).norm() < 1e-12);
    assert!((state.position.y - 0.5).abs() < 1e-12 && state.position.x.abs() < 1e-12);
    run.ask(0, Request::Law);
    run.step(&|| false).unwrap();
    assert!(
        run.robots()[0].state().velocity.norm() < 1e-12,
        "without a law it stands"
    );
}

#[test]
fn recorded_people_are_where_the_recording_has_them() {
    let motion = Motion::recorded(&[0.5, 1.5], &[[0.0, 0.0], [1.0, 0.0]]).unwrap();
    let mut people = vec![
        person(Vector::zeros(), Vector::zeros()),
        person(Vector::new(0.5, 0.1), Vector::new(0.5, 3.0)),
    ];
    people[0].recorded = Some(motion);
    people[1].enters = 1.0;
    let run = ended(world(speed(), people));
    let record = run.recorded().unwrap();
    let rows = places(&run);
    for (time, row) in record.time.iter().zip(rows.chunks_exact(4)) {
        let there = (0.5 - 1e-9..=1.5 + 1e-9).contains(time);
        assert_eq!(!row[0].is_nan(), there, "{time}");
        assert!(!there || (row[0] - (time - 0.5)).abs() < 1e-9);
        assert_eq!(row[2].is_nan(), *time < 1.0 - 1e-9);
    }
}

#[test]
fn what_breaks_a_rule_is_refused_by_its_place() {
    let good = || world(speed(), scattered(3, 4.0, 1));
    let words = |world: CrowdWorld| {
        world
            .checked()
            .err()
            .map(|error| error.to_string())
            .unwrap_or_default()
    };
    assert_eq!(words(good()), "");
    let mut bad = good();
    bad.people[2].traits.radius = 0.0;
    assert!(words(bad).starts_with("people[2].radius must be finite and positive"));
    let mut bad = good();
    bad.people[1].traits.awareness = 1.5;
    assert!(words(bad).starts_with("people[1].awareness must be from 0 to 1"));
    let mut bad = good();
    bad.people[0].traits.route.points.clear();
    bad.people[0].traits.route.end = RouteEnd::Repeat;
    assert!(words(bad).starts_with("people[0].route must hold a point"));
    let mut bad = good();
    bad.robots
        .push(robot(bad.people[1].start, [9.0, 9.0], None));
    assert!(words(bad).starts_with("robots[0].start must not be in contact with people[1]"));
    let mut bad = good();
    bad.robots.push(robot([-3.0, -3.0], [9.0, 9.0], None));
    bad.robots[0].control_period = 0.12;
    assert!(words(bad).starts_with("robots[0].control_period must be a multiple of the step"));
    let mut bad = good();
    bad.period = Period([-1.0, 0.0]);
    assert!(words(bad).starts_with("period[0] must"));
}
