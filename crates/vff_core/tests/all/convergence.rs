//! Order of the integrators where the motion is smooth, and what a seed decides.

use crate::configurations::{crossing, law, limits, obstacles};
use vff_core::laws::VirtualForceField;
use vff_core::laws::field::stabilizing::Stabilizing;
use vff_core::robots::HolonomicRobot;
use vff_core::run::{Integrator, Options, Trajectory, simulate};
use vff_core::sensing::measurement::{Distribution, Measurement, Noisy};
use vff_core::world::motion::Motion;
use vff_core::world::obstacle::Obstacle;
use vff_core::world::scenario::{Rules, Scenario};

/// Largest deviation of a measured order; the next term of the error is smaller by the step.
const ORDER: f64 = 0.2;
/// Steps in s, each half of the one before.
const STEPS: [f64; 4] = [0.05, 0.025, 0.0125, 0.00625];
/// Time at which runs are compared, in s; before the goal is passed.
const END: f64 = 0.4;
const GAINS: [f64; 4] = [30.0, 20.0, 17.0, 0.25];
const START: [f64; 2] = [0.2, -0.15];

fn scenario(obstacles: Vec<Obstacle>) -> Scenario {
    let rules = Rules {
        time_limit: END,
        arrival_tolerance: 1e-3,
        ..Rules::default()
    };
    Scenario::new(HolonomicRobot::default(), START, [0.0; 2], obstacles, rules).unwrap()
}

fn off() -> VirtualForceField {
    law(GAINS, Stabilizing::Off)
}

/// A run with no force held that touches no limit of the robot.
fn run(scenario: &Scenario, integrator: Integrator, step: f64) -> Trajectory {
    let options = Options {
        integrator,
        step,
        hold: false,
        ..Options::default()
    };
    let (run, path) = simulate(scenario, off(), &options, &|| false).unwrap();
    assert!((run.end_time - END).abs() < 1e-12);
    let robot = HolonomicRobot::default();
    for row in 0..path.time.len() {
        let norm = |values: &[f64]| values[2 * row].hypot(values[2 * row + 1]);
        assert!(norm(&path.velocity) < robot.max_speed);
        assert!(norm(&path.force) < robot.max_acceleration * robot.mass);
    }
    path
}

/// Position and velocity in the last row.
fn end(path: &Trajectory) -> [f64; 4] {
    let last = path.position.len() - 2;
    let (position, velocity) = (&path.position[last..], &path.velocity[last..]);
    [position[0], position[1], velocity[0], velocity[1]]
}

fn distance(a: [f64; 4], b: [f64; 4]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b) * (a - b))
        .sum::<f64>()
        .sqrt()
}

/// Free motion from rest, `m E'' + b K_1 E' + K_1 E = 0`, underdamped.
fn exact() -> [f64; 4] {
    let [stiffness, _, _, ratio] = GAINS;
    let square = stiffness / HolonomicRobot::default().mass;
    let decay = 0.5 * ratio * square;
    let frequency = (square - decay * decay).sqrt();
    let (sin, cos) = (frequency * END).sin_cos();
    let envelope = (-decay * END).exp();
    let place = envelope * (cos + decay / frequency * sin);
    let speed = -envelope * square / frequency * sin;
    [
        START[0] * place,
        START[1] * place,
        START[0] * speed,
        START[1] * speed,
    ]
}

fn assert_order(errors: &[f64], expected: f64) {
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!(
            (order - expected).abs() < ORDER,
            "order {order} of {errors:?}"
        );
    }
}

#[test]
fn free_run_converges_to_the_damped_oscillation() {
    let scenario = scenario(Vec::new());
    for (integrator, order) in [(Integrator::Rk4, 4.0), (Integrator::SemiImplicitEuler, 1.0)] {
        let errors = STEPS.map(|step| distance(end(&run(&scenario, integrator, step)), exact()));
        assert_order(&errors, order);
    }
}

#[test]
fn run_inside_active_regions_keeps_the_order() {
    // Accelerating, moving and standing: a stage that saw them at a wrong time would cost an order.
    let body = |center, velocity, acceleration, radii: [f64; 2]| {
        let motion = Motion::moving(center, velocity, acceleration, None).unwrap();
        Obstacle::disc(0.1, motion, limits(radii[0], radii[1])).unwrap()
    };
    let scenario = scenario(vec![
        body([-0.7, -0.9], [0.3, 0.2], [0.4, -0.6], [0.3, 1.35]),
        body([0.9, 0.6], [-0.2, 0.1], [0.0, 0.0], [0.3, 1.2]),
        body([0.9, -0.9], [0.0, 0.0], [0.0, 0.0], [0.4, 1.25]),
    ]);
    for (integrator, order) in [(Integrator::Rk4, 4.0), (Integrator::SemiImplicitEuler, 1.0)] {
        let ends = STEPS.map(|step| {
            let path = run(&scenario, integrator, step);
            for distances in path.distance.chunks(scenario.obstacle_count()) {
                for (distance, placed) in distances.iter().zip(scenario.obstacles()) {
                    let regions = placed.regions;
                    assert!((regions.critical_radius..regions.active_radius).contains(distance));
                }
            }
            end(&path)
        });
        let changes: Vec<f64> = ends.windows(2).map(|w| distance(w[0], w[1])).collect();
        assert!(changes[0] > 1e-9, "rounding would hide the order");
        assert_order(&changes, order);
    }
}

fn noisy_run(noisy: Noisy, distribution: Distribution, seed: u64) -> Trajectory {
    let measurement = Measurement::new(0.01, distribution, noisy).unwrap();
    let scenario = crossing(obstacles(4), Rules::default())
        .measured(Some(measurement), seed)
        .unwrap();
    simulate(&scenario, off(), &Options::default(), &|| false)
        .unwrap()
        .1
}

#[test]
fn seed_decides_the_noise() {
    for noisy in [Noisy::Obstacles, Noisy::Robot, Noisy::Both] {
        for distribution in [Distribution::Uniform, Distribution::Gaussian] {
            let run = |seed| noisy_run(noisy, distribution, seed).position;
            assert_eq!(run(7), run(7));
            assert_ne!(run(7), run(8));
        }
    }
}

#[test]
fn seed_changes_nothing_without_noise() {
    let run = |seed| {
        let scenario = crossing(obstacles(4), Rules::default())
            .measured(None, seed)
            .unwrap();
        let (summary, path) = simulate(&scenario, off(), &Options::default(), &|| false).unwrap();
        (summary.arrival_time, summary.energy, path.position)
    };
    assert_eq!(run(1), run(2));
}
