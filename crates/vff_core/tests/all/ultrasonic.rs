//! A law that knows obstacles by their echoes alone.

use std::f64::consts::TAU;

use vff_core::laws::VirtualForceField;
use vff_core::laws::field::gains::Gains;
use vff_core::laws::field::side::SideRules;
use vff_core::laws::field::stabilizing::Stabilizing;
use vff_core::robots::{DifferentialDriveRobot, HolonomicRobot};
use vff_core::run::as_built::{AsBuilt, AsBuiltTrajectory, simulate_as_built};
use vff_core::run::{AnyLaw, Outcome, RunSummary};
use vff_core::sensing::measurement::Distribution;
use vff_core::sensing::sonar::{Beam, Firing, Ranging, SonarArray};
use vff_core::sensing::{Estimator, PositionError, RobotSensor, SensorOptions, Ultrasonic, Vision};
use vff_core::world::frame::Frame;
use vff_core::world::motion::Motion;
use vff_core::world::obstacle::{Limits, Obstacle};
use vff_core::world::scenario::{Rules, Scenario};
use vff_core::world::shape::PlacedShape;

/// The field that keeps a side once taken: echoes of one body lie on both sides of the way.
fn field() -> AnyLaw {
    let rules = SideRules {
        pass_behind: true,
        hysteresis: 3.05,
    };
    let gains = Gains::of([3.0, 20.0, 17.0, 0.25]);
    VirtualForceField::new(gains, Stabilizing::Off, rules)
        .unwrap()
        .into()
}

fn array(axes: &[f64], firing: Firing) -> SonarArray {
    let mount = |axis: &f64| Frame::at([0.15 * axis.cos(), 0.15 * axis.sin()], *axis);
    let ranging = Ranging {
        noise: 0.0,
        ..Ranging::default()
    };
    let beam = Beam::new(0.4, 13).unwrap();
    SonarArray::new(axes.iter().map(mount).collect(), beam, ranging, firing).unwrap()
}

fn sonar(sensors: u32, firing: Firing) -> Ultrasonic {
    let axes: Vec<f64> = (0..sensors)
        .map(|index| TAU * f64::from(index) / f64::from(sensors))
        .collect();
    Ultrasonic {
        array: array(&axes, firing),
        max_speed: 0.0,
        assumed_speed: 0.0,
    }
}

fn with(ultrasonic: Vec<Ultrasonic>) -> AsBuilt {
    AsBuilt {
        sensors: ultrasonic
            .into_iter()
            .map(SensorOptions::Ultrasonic)
            .collect(),
        ..AsBuilt::default()
    }
}

fn scenario(obstacles: Vec<Obstacle>) -> Scenario {
    let robot = HolonomicRobot::default();
    Scenario::new(robot, [0.0, 0.0], [4.0, 0.0], obstacles, Rules::default()).unwrap()
}

fn post() -> Obstacle {
    Obstacle::disc_at_rest([2.0, 0.05], 0.15, Limits::default()).unwrap()
}

fn run(scenario: &Scenario, built: &AsBuilt) -> (RunSummary, AsBuiltTrajectory) {
    simulate_as_built(scenario, &field(), built, &|| false).unwrap()
}

#[test]
fn the_field_goes_around_what_it_knows_by_echoes() {
    let scenario = scenario(vec![post()]);
    let ring = Ultrasonic {
        max_speed: 0.3,
        ..sonar(16, Firing::Together)
    };
    let (summary, _) = run(&scenario, &with(vec![ring]));
    assert_eq!(summary.outcome, Outcome::Arrived);
    assert!(summary.contact[0].is_none());
    assert!(summary.min_distance[0] < 1.0, "{:?}", summary.min_distance);
}

#[test]
fn what_gives_no_echo_is_not_known() {
    // A single sensor that looks back: the post ahead is driven into, as with no post at all.
    // Behind the robot it gives an echo.
    let blind = Ultrasonic {
        array: array(&[TAU / 2.0], Firing::Together),
        max_speed: 0.0,
        assumed_speed: 0.0,
    };
    let (summary, rows) = run(&scenario(vec![post()]), &with(vec![blind.clone()]));
    let contact = summary.contact[0].unwrap();
    let (_, free) = run(&scenario(Vec::new()), &with(vec![blind]));
    let shared = 2 * rows
        .motion
        .time
        .partition_point(|time| *time <= contact.time);
    assert!(shared > 400, "{contact:?}");
    assert_eq!(
        rows.motion.position[..shared],
        free.motion.position[..shared]
    );
}

#[test]
fn a_camera_and_a_sonar_tell_of_obstacles_together() {
    let person = Motion::moving([2.0, -1.5], [0.0, 0.5], [0.0; 2], None).unwrap();
    let person = Obstacle::disc(0.3, person, Limits::default()).unwrap();
    let scenario = scenario(vec![person]);
    let blind = Ultrasonic {
        array: array(&[TAU / 2.0], Firing::Together),
        max_speed: 0.0,
        assumed_speed: 0.0,
    };
    let camera = Vision {
        period: 0.06,
        delay: 0.0,
        error: PositionError::Plane {
            distribution: Distribution::Gaussian,
            scale: 0.0,
        },
        drop_probability: 0.0,
        estimator: Estimator::Differences,
        compensated: false,
    };
    let seeing = |ultrasonic| {
        let mut built = with(ultrasonic);
        built.sensors.push(SensorOptions::ObstacleCamera(camera));
        built
    };
    let (alone, _) = run(&scenario, &seeing(Vec::new()));
    let (both, _) = run(&scenario, &seeing(vec![blind.clone()]));
    // A sonar that sees nothing changes nothing of what the camera tells.
    assert_eq!(format!("{alone:?}"), format!("{both:?}"));
    let (without, _) = run(&scenario, &with(vec![blind]));
    assert!(without.min_distance[0] < both.min_distance[0]);
}

#[test]
fn a_two_wheel_robot_goes_by_echoes_too() {
    let robot = DifferentialDriveRobot::default();
    let rules = Rules::default();
    let ends = ([0.0, 0.0], [4.0, 0.0]);
    let scenario = Scenario::for_differential(robot, ends.0, ends.1, vec![post()], rules).unwrap();
    let ring = Ultrasonic {
        max_speed: 0.3,
        ..sonar(16, Firing::Together)
    };
    let (summary, _) = run(&scenario, &with(vec![ring]));
    assert_eq!(summary.outcome, Outcome::Arrived);
    assert!(summary.contact[0].is_none());
}

#[test]
fn a_rectangle_that_moves_is_known_by_its_echoes() {
    let beside = |speed: f64| {
        let motion = Motion::moving([2.0, 1.2], [0.0, -speed], [0.0; 2], None).unwrap();
        let body = PlacedShape::upright([2.0, 1.2], [0.5, 0.5]);
        let scenario = scenario(vec![Obstacle::seen(body, motion).unwrap()]);
        let ring = Ultrasonic {
            max_speed: 0.3,
            ..sonar(16, Firing::Together)
        };
        run(&scenario, &with(vec![ring])).0
    };
    let (coming, staying) = (beside(0.2), beside(0.05));
    for summary in [&coming, &staying] {
        assert_eq!(summary.outcome, Outcome::Arrived);
        assert!(summary.contact[0].is_none());
    }
    assert!(coming.path_length > staying.path_length + 0.05);
}

#[test]
fn noise_is_that_of_the_seed() {
    let mut noisy = sonar(12, Firing::Together);
    let ranging = Ranging {
        noise: 0.02,
        ..Ranging::default()
    };
    let mounts = noisy.array.mounts().to_vec();
    let beam = Beam::new(0.4, 13).unwrap();
    noisy.array = SonarArray::new(mounts, beam, ranging, Firing::Together).unwrap();
    let scenario = scenario(vec![post()]);
    let ends = [0, 0, 1].map(|seed| {
        let (summary, _) = run(&scenario.clone().reseeded(seed), &with(vec![noisy.clone()]));
        summary.path_length
    });
    assert_eq!(ends[0], ends[1]);
    assert_ne!(ends[0], ends[2]);
}

#[test]
fn firing_in_turn_and_faster_bodies_need_larger_regions() {
    let scenario = scenario(Vec::new());
    let active = |sonar: &Ultrasonic| sonar.regions(&scenario).unwrap().active_radius;
    let fast = |firing| Ultrasonic {
        max_speed: 1.0,
        ..sonar(12, firing)
    };
    let still = active(&sonar(12, Firing::Together));
    let moving = active(&fast(Firing::Together));
    let in_turn = active(&fast(Firing::InTurn));
    assert!(still < moving && moving < in_turn);
    // 11 control periods at 1 m/s make the distance uncertain.
    let late = 11.0 * scenario.control_period();
    assert!(in_turn - moving >= late);
    // 3 m along the axis of sensors 0.15 m ahead of the center.
    let (_, reach) = sonar(12, Firing::Together)
        .sight(&scenario)
        .unwrap()
        .unwrap();
    assert!((reach - 3.15).abs() < 1e-12);
    let backward = Ultrasonic {
        max_speed: -1.0,
        ..sonar(1, Firing::Together)
    };
    assert!(backward.checked().is_err());
}
