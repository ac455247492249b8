//! Velocity obstacles: no contact with anything that keeps its velocity, whichever rule selects.

use crate::draws::Draws;
use crate::pairs::BORENSTEIN_KOREN;
use vff_core::lanes::{Planar, Vector2};
use vff_core::laws::BorensteinKoren;
use vff_core::laws::pairwise::Pairwise;
use vff_core::laws::planning::family::Planned;
use vff_core::laws::velocity_obstacle::{Selection, VelocityObstacle, VelocityObstaclePlanner};
use vff_core::laws::{Scan, Situation, Stop};
use vff_core::robots::HolonomicRobot;
use vff_core::run::metrics::clearances;
use vff_core::run::{AnyLaw, Options, Outcome, RunSummary, simulate};
use vff_core::world::geometry::{Body, RobotState};
use vff_core::world::motion::Motion;
use vff_core::world::obstacle::{Limits, Obstacle};
use vff_core::world::scenario::{Rules, Scenario};

/// Cases of each rule, with all checks of a debug build; `tests/properties/test_velocity_obstacle.py` has ten thousand.
const CASES: usize = 334;
/// Share of them in which a robot that drives straight must touch something.
const TOUCHED_STRAIGHT: f64 = 0.3;
/// Share of them in which the goal must be reached: the rest is boxed in until the time is over.
const ARRIVED: f64 = 0.98;
const START: [f64; 2] = [0.0, 0.0];
const GOAL: [f64; 2] = [6.0, 0.0];
const SPEED: f64 = 0.7;

/// Straight to the goal at full speed: nothing repels.
const STRAIGHT: BorensteinKoren = BorensteinKoren {
    attractive: 100.0,
    repulsive: 0.0,
    ..BORENSTEIN_KOREN
};

fn run(scenario: &Scenario, law: impl Into<AnyLaw>) -> RunSummary {
    let (run, _) = simulate(scenario, law, &Options::default(), &|| false).unwrap();
    run
}

/// One to five discs that pass near the straight way at about the time at which the robot is there.
fn meeting(draws: &mut Draws) -> Option<Scenario> {
    let limits = Limits {
        critical_radius: Some(0.8),
        active_radius: Some(1.8),
        max_speed: None,
    };
    let count = 1 + draws.below(5);
    let obstacles = (0..count).map(|_| {
        let (speed, course) = (draws.between(0.0, 1.0), draws.between(0.0, 6.3));
        let time = draws.between(1.0, 8.0);
        let place = [
            SPEED * time + draws.between(-0.5, 0.5),
            draws.between(-0.5, 0.5),
        ];
        let velocity = [speed * course.cos(), speed * course.sin()];
        let start = [place[0] - velocity[0] * time, place[1] - velocity[1] * time];
        let motion = Motion::moving(start, velocity, [0.0; 2], None).unwrap();
        Obstacle::disc(draws.between(0.1, 0.5), motion, limits).unwrap()
    });
    let obstacles = obstacles.collect();
    let rules = Rules {
        time_limit: 20.0,
        ..Rules::default()
    };
    // Some draws start in contact, or end on an obstacle that stands.
    Scenario::new(HolonomicRobot::default(), START, GOAL, obstacles, rules).ok()
}

/// Whether a reachable velocity exists at the start that never leads to a contact.
fn has_a_way(scenario: &Scenario, selection: Selection) -> bool {
    let exact = VelocityObstacle {
        margin: 0.0,
        selection,
        ..VelocityObstacle::default()
    };
    let body = |placed: &vff_core::world::scenario::PlacedObstacle| Body {
        shape: placed.obstacle.shape,
        regions: placed.regions,
        state: placed.obstacle.motion.at(0.0, &mut 0),
    };
    let bodies: Vec<Body> = scenario.obstacles().iter().map(body).collect();
    let robot = RobotState {
        position: Vector2::splat(START),
        velocity: Vector2::zeros(),
    };
    let interval = scenario.control_period();
    let situation = Situation {
        time: 0.0,
        ages: &[],
        heading: 0.0,
        bodies: &bodies,
        robot,
        interval,
        scan: Scan::default(),
        stop: Stop::never(),
    };
    let mut planner = VelocityObstaclePlanner::new(exact, scenario);
    planner.best_free(&situation).is_some()
}

fn touches_nothing(selection: Selection, seed: u64) {
    let mut draws = Draws::new(seed);
    let (mut cases, mut straight, mut arrived) = (0, 0, 0);
    while cases < CASES {
        let Some(scenario) = meeting(&mut draws) else {
            continue;
        };
        if !has_a_way(&scenario, selection) {
            continue;
        }
        cases += 1;
        straight += usize::from(run(&scenario, Pairwise(STRAIGHT)).outcome == Outcome::Collided);
        let settings = VelocityObstacle {
            selection,
            ..VelocityObstacle::default()
        };
        let run = run(&scenario, Planned(settings));
        let least = clearances(&scenario, &run)
            .into_iter()
            .fold(f64::INFINITY, f64::min);
        assert!(
            run.outcome != Outcome::Collided && least > 0.0,
            "case {cases}: {least} m, {:?}",
            run.contact
        );
        arrived += usize::from(run.outcome == Outcome::Arrived);
    }
    let share = |count: usize| count as f64 / CASES as f64;
    assert!(share(straight) >= TOUCHED_STRAIGHT, "{straight} straight");
    assert!(share(arrived) >= ARRIVED, "{arrived} arrived");
}

#[test]
fn largest_progress_touches_nothing() {
    touches_nothing(Selection::ToGoal, 1);
}

#[test]
fn largest_speed_touches_nothing() {
    touches_nothing(Selection::Fastest { sector: 1.0 }, 2);
}

#[test]
fn least_time_and_risk_touches_nothing() {
    touches_nothing(Selection::TimeAndRisk { risk: 1.0 }, 3);
}
