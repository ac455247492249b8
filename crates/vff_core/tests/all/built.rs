//! Robots as built: the ideal one is the point mass, and the others reach the goal.

use crate::configurations::{crossing, law, limits, obstacles};
use crate::pairs::MASOUD;
use proptest::prelude::*;
use vff_core::laws::field::stabilizing::Stabilizing;
use vff_core::laws::pairwise::Pairwise;
use vff_core::robots::DifferentialDriveRobot;
use vff_core::robots::differential::{Nonlinear, Tracking, VirtualTorque};
use vff_core::robots::wheels::{Slip, differential_wheels, holonomic_wheels};
use vff_core::run::as_built::{
    AsBuilt, ManyOptions, SteeringLaw, evaluate_as_built, run_many_as_built, simulate_as_built,
};
use vff_core::run::metrics::Weights;
use vff_core::run::{AnyLaw, Options, Outcome, simulate};
use vff_core::sensing::measurement::{Distribution, Measurement, Noisy};
use vff_core::sensing::{Estimator, PositionError, SensorOptions, Vision};
use vff_core::world::motion::Motion;
use vff_core::world::obstacle::Obstacle;
use vff_core::world::scenario::{Rules, Scenario};

/// Gains of chapters 6 and 7.
const NEW: [f64; 4] = [3.0, 20.0, 17.0, 0.25];

fn field() -> AnyLaw {
    law(NEW, Stabilizing::Off).into()
}

fn laws() -> [AnyLaw; 2] {
    [field(), Pairwise(MASOUD).into()]
}

fn never() -> bool {
    false
}

fn noise(noisy: Noisy) -> Measurement {
    Measurement::new(0.025, Distribution::Uniform, noisy).unwrap()
}

/// A camera with the frame rate of the source and errors of 4 mm in the mean.
fn vision() -> Vision {
    Vision {
        period: 1.0 / 16.7,
        delay: 0.0,
        error: PositionError::Plane {
            distribution: Distribution::Gaussian,
            scale: 0.0032,
        },
        drop_probability: 0.0,
        estimator: Estimator::Differences,
        compensated: false,
    }
}

/// A vector turned about the origin.
fn turned([x, y]: [f64; 2], angle: f64) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    [x * cos - y * sin, x * sin + y * cos]
}

/// Configurations n1 to n4 of chapter 7, turned about the origin; the robot looks at its goal.
fn chapter_7(number: usize, angle: f64) -> Scenario {
    let to = |point| turned(point, angle);
    let person = |stop| {
        let walk = Motion::moving(to([0.2, 0.6]), to([1.0, 0.0]), [0.0; 2], Some(to(stop)));
        Obstacle::disc(0.4, walk.unwrap(), limits(0.8, 2.5)).unwrap()
    };
    let disc = |center| Obstacle::disc_at_rest(to(center), 0.1, limits(0.4, 0.65)).unwrap();
    let table =
        || Obstacle::rectangle(to([2.3, 0.2]), [1.4, 0.6], angle, limits(0.3, 0.55)).unwrap();
    let obstacles = match number {
        1 => vec![disc([2.16, 0.6])],
        2 => vec![person([4.0, 0.6])],
        3 => vec![table(), disc([2.16, 1.5])],
        _ => vec![person([3.9, 0.6]), table(), disc([2.16, 1.5])],
    };
    let rules = Rules {
        heading: std::f64::consts::PI + angle,
        ..Rules::default()
    };
    let robot = DifferentialDriveRobot::default();
    Scenario::for_differential(robot, to([3.99, 0.6]), to([0.0, 0.6]), obstacles, rules).unwrap()
}

#[test]
fn ideal_robot_is_the_point_mass_bit_for_bit() {
    for number in 1..=4 {
        let exact = crossing(obstacles(number), Rules::default());
        let kinds = [
            None,
            Some(noise(Noisy::Obstacles)),
            Some(noise(Noisy::Robot)),
            Some(noise(Noisy::Both)),
        ];
        for (seed, measurement) in (0..).zip(kinds) {
            let scenario = exact.clone().measured(measurement, seed).unwrap();
            for law in laws() {
                let plain = simulate(&scenario, &law, &Options::default(), &never).unwrap();
                let built =
                    simulate_as_built(&scenario, &law, &AsBuilt::default(), &never).unwrap();
                // Bits by what is printed: NaN, where nothing is, equals nothing.
                assert_eq!(format!("{:?}", plain.0), format!("{:?}", built.0));
                assert_eq!(format!("{:?}", plain.1), format!("{:?}", built.1.motion));
                let used = built.1.energy_used.last().unwrap();
                assert!((used - built.0.energy).abs() < 1e-12 * used);
            }
        }
    }
}

#[test]
fn two_wheel_robot_passes_every_configuration() {
    let wheels = Some(differential_wheels().to_vec());
    for number in 1..=4 {
        let scenario = chapter_7(number, 0.0);
        for wheels in [None, wheels.clone()] {
            let built = AsBuilt {
                wheels,
                ..AsBuilt::default()
            };
            let (run, path) = simulate_as_built(&scenario, &field(), &built, &never).unwrap();
            println!(
                "n{number} wheels {}: {:?} T {:?} L {:.2} d {:?}",
                built.wheels.is_some(),
                run.outcome,
                run.arrival_time,
                run.energy,
                run.min_distance
            );
            assert_eq!(run.outcome, Outcome::Arrived);
            assert_eq!(path.wheel_speed.len(), 2 * path.heading.len());
        }
    }
}

#[test]
fn every_steering_reaches_the_goal() {
    let scenario = chapter_7(1, 0.0);
    let torque = SteeringLaw::Torque(VirtualTorque::default());
    let nonlinear = SteeringLaw::Following(Tracking::Nonlinear(Nonlinear::default()));
    for steering_law in [torque, nonlinear] {
        let built = AsBuilt {
            steering_law,
            ..AsBuilt::default()
        };
        let run = simulate_as_built(&scenario, &field(), &built, &never)
            .unwrap()
            .0;
        println!("{:?}: {run:?}", built.steering_law);
        assert!(run.arrival_time.is_some());
    }
}

#[test]
fn omni_wheels_follow_the_point_mass() {
    for number in 1..=4 {
        let scenario = crossing(obstacles(number), Rules::default());
        let built = AsBuilt {
            wheels: Some(holonomic_wheels().to_vec()),
            ..AsBuilt::default()
        };
        let ideal = simulate_as_built(&scenario, &field(), &AsBuilt::default(), &never)
            .unwrap()
            .0;
        let run = simulate_as_built(&scenario, &field(), &built, &never)
            .unwrap()
            .0;
        println!("c{number}: {ideal:?}\n    {run:?}");
        assert_eq!(run.outcome, Outcome::Arrived);
        let (own, other) = (run.arrival_time.unwrap(), ideal.arrival_time.unwrap());
        // The wheels lag the command by their own time constants, well below a control period.
        assert!(
            (own - other).abs() < 0.1 * other,
            "c{number}: {own} {other}"
        );
    }
}

#[test]
fn cameras_and_slip_run() {
    let mut scenario = chapter_7(1, 0.0);
    let built = AsBuilt {
        wheels: Some(differential_wheels().to_vec()),
        slip: Slip {
            creep: 0.02,
            ..Slip::default()
        },
        sensors: vec![
            SensorOptions::RobotCamera(vision()),
            SensorOptions::ObstacleCamera(vision()),
        ],
        ..AsBuilt::default()
    };
    let run = simulate_as_built(&scenario, &field(), &built, &never).unwrap();
    println!("camera: {:?}", run.0);
    assert_ne!(run.0.outcome, Outcome::TimedOut);
    scenario = scenario.measured(Some(noise(Noisy::Both)), 1).unwrap();
    assert!(simulate_as_built(&scenario, &field(), &built, &never).is_err());
}

#[test]
fn wheels_of_another_robot_are_refused() {
    let scenario = chapter_7(1, 0.0);
    let three = AsBuilt {
        wheels: Some(holonomic_wheels().to_vec()),
        ..AsBuilt::default()
    };
    assert!(simulate_as_built(&scenario, &field(), &three, &never).is_err());
    assert!(simulate(&scenario, field(), &Options::default(), &never).is_err());
}

#[test]
fn threads_change_no_bit() {
    let scenario = chapter_7(4, 0.0)
        .measured(Some(noise(Noisy::Both)), 0)
        .unwrap();
    let built = AsBuilt {
        wheels: Some(differential_wheels().to_vec()),
        ..AsBuilt::default()
    };
    let seeds = 0..7;
    let episodes: Vec<Scenario> = seeds
        .map(|seed| scenario.clone().reseeded(seed))
        .chain([chapter_7(1, 0.0)])
        .collect();
    let weights = Weights {
        arrival_time: 0.5,
        avoidance: 0.3,
        energy_saving: 0.2,
    };
    let laws = laws();
    let runs = |threads| {
        let options = ManyOptions {
            weights,
            histories: true,
            threads: Some(threads),
        };
        run_many_as_built(&episodes, &laws, &built, &options, &never, &|_| {}).unwrap()
    };
    let one = runs(1);
    // Bits by what is printed: NaN, where nothing is, equals nothing.
    assert_eq!(format!("{one:?}"), format!("{:?}", runs(2)));
    assert_eq!(format!("{one:?}"), format!("{:?}", runs(5)));
    assert_ne!(one.table.energy[0], one.table.energy[1]);
    for (law, episode) in [(0, 3), (1, 7)] {
        let row = law * episodes.len() + episode;
        let (score, alone, _) =
            evaluate_as_built(&episodes[episode], &laws[law], &built, weights, &never).unwrap();
        assert_eq!(one.table.energy[row], alone.0.energy);
        assert_eq!(one.table.outcome[row], alone.0.outcome);
        assert_eq!(one.table.performance_total[row], score.total);
        assert_eq!(
            format!("{:?}", one.contact[row]),
            format!("{:?}", alone.0.contact)
        );
        assert_eq!(*one.histories[row].time.last().unwrap(), alone.0.end_time);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    #[test]
    fn rotation_changes_nothing(angle in -3.0..3.0f64, number in 1..=3usize) {
        let plain = simulate_as_built(&chapter_7(number, 0.0), &field(), &AsBuilt::default(), &never);
        let other = simulate_as_built(&chapter_7(number, angle), &field(), &AsBuilt::default(), &never);
        let (plain, other) = (plain.unwrap().0, other.unwrap().0);
        // A few hundred samples of a stable loop, each with roundings of 1e-16.
        let times = plain.arrival_time.unwrap() - other.arrival_time.unwrap();
        prop_assert!(times.abs() < 1e-6, "{}", times);
        for (one, two) in plain.min_distance.iter().zip(&other.min_distance) {
            prop_assert!((one - two).abs() < 1e-6, "{} {}", one, two);
        }
    }
}
