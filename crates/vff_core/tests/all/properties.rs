//! What holds for every state and every run: symmetries, continuity, the Lyapunov identity, limits.

use std::f64::consts::{PI, TAU};

use crate::configurations::{crossing, gains, law, limits, obstacles};
use crate::worlds::{Frame, Kind, State, any_law, any_state, length, minus, plus, times};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use vff_core::error::Failure;
use vff_core::laws::field::side::SideRules;
use vff_core::laws::field::stabilizing::{Cap, Stabilizing};
use vff_core::laws::{FieldTerms, VirtualForceField};
use vff_core::robots::HolonomicRobot;
use vff_core::run::{Integrator, Options, Trajectory, simulate, terms_at};
use vff_core::world::obstacle::Obstacle;
use vff_core::world::scenario::{Rules, Scenario};

/// Of the sum of the magnitudes of the terms: at the smallest `d - r3` of the generated states,
/// 5 mm, coordinates of 20 m carry 1e-12 into a force.
const SYMMETRY: f64 = 1e-10;
/// Of `max(1, |dV/dt|)`: truncation and rounding of the numerical derivative at the step below.
const IDENTITY: f64 = 1e-5;
/// In m/s over one step of the numerical derivative.
const VELOCITY_CHANGE: f64 = 3e-4;
/// Relative: a few roundings of a limited vector.
const ROUNDING: f64 = 1e-12;

fn cases(cases: u32) -> ProptestConfig {
    // The same cases every time: a test says the same of the same code.
    ProptestConfig {
        cases,
        rng_seed: RngSeed::Fixed(20_110),
        max_global_rejects: 20 * cases,
        ..ProptestConfig::default()
    }
}

fn terms(scenario: &Scenario, law: &VirtualForceField, state: &State) -> FieldTerms {
    terms_at(scenario, law, state.position, state.velocity, state.time).unwrap()
}

/// Sum of the magnitudes of the terms in N.
fn scale(terms: &FieldTerms) -> f64 {
    let own = |obstacle: &vff_core::laws::ObstacleTerms| {
        length(obstacle.repulsive) + length(obstacle.detour)
    };
    length(terms.attractive) + terms.obstacles.iter().map(own).sum::<f64>()
}

/// The terms in another frame are the terms seen from there.
fn assert_moves_with(
    frame: &Frame,
    state: &State,
    law: &VirtualForceField,
) -> Result<(), TestCaseError> {
    let moved = state.seen_from(frame);
    let (Some(here), Some(there)) = (state.scenario(), moved.scenario()) else {
        return Err(TestCaseError::reject("the goal is inside an active region"));
    };
    prop_assume!(!state.is_in_line());
    let (here, there) = (terms(&here, law, state), terms(&there, law, &moved));
    let allowed = SYMMETRY * scale(&here);
    let off = |a, b| length(minus(frame.direction(a), b));
    prop_assert!(off(here.attractive, there.attractive) <= allowed);
    prop_assert!(off(here.total, there.total) <= allowed);
    for (one, other) in here.obstacles.iter().zip(&there.obstacles) {
        prop_assert_eq!(one.region, other.region);
        prop_assert_eq!(f64::from(one.side) * frame.hand, f64::from(other.side));
        prop_assert!(off(one.repulsive, other.repulsive) <= allowed);
        prop_assert!(off(one.detour, other.detour) <= allowed);
    }
    Ok(())
}

proptest! {
    #![proptest_config(cases(1500))]

    #[test]
    fn forces_turn_with_the_world(state in any_state(Kind::Any), law in any_law(), angle in -PI..PI) {
        let frame = Frame { angle, shift: [0.0; 2], hand: 1.0 };
        assert_moves_with(&frame, &state, &law)?;
    }

    #[test]
    fn forces_shift_with_the_world(
        state in any_state(Kind::Any), law in any_law(), shift in prop::array::uniform2(-10.0..10.0),
    ) {
        assert_moves_with(&Frame { angle: 0.0, shift, hand: 1.0 }, &state, &law)?;
    }

    #[test]
    fn forces_and_sides_are_mirrored_with_the_world(
        state in any_state(Kind::Any), law in any_law(), angle in -PI..PI,
    ) {
        assert_moves_with(&Frame { angle, shift: [0.0; 2], hand: -1.0 }, &state, &law)?;
    }

    /// With `h = r2 - d`: `|F| <= (K_3 (1/c + b |ddot|/c^2) + K_5 (pi + b |Phidot|)) h^2`.
    #[test]
    fn obstacle_forces_vanish_as_the_square_of_the_depth(
        bearing in -PI..PI, speed in 0.1..0.7, course in -PI..PI, exponent in 1..9_i32,
        law in any_law(), others in prop::array::uniform2(-1.0..1.0),
    ) {
        let (critical, active, depth) = (0.5, 1.5, 10f64.powi(-exponent) * 0.5);
        let motion = vff_core::world::motion::Motion::moving([0.0; 2], others, [0.0; 2], None).unwrap();
        let disc = Obstacle::disc(0.1, motion, limits(critical, active)).unwrap();
        let goal = [-3.0, 1.0];
        let state = State::beside(times(active - depth, [bearing.cos(), bearing.sin()]),
            times(speed, [course.cos(), course.sin()]), goal, vec![disc]);
        let inside = terms(&state.scenario().unwrap(), &law, &state);
        let closing = speed + length(others);
        let margin = active - depth - critical;
        let rate = closing / (active - depth) + length(others) / length(goal);
        let set = law.gains;
        let repulsion = set.repulsive * (1.0 / margin + set.ratio * closing / (margin * margin));
        let detour = set.detour * (PI + set.ratio * rate);
        // r2 - d carries the rounding of d.
        let square = (depth + 1e-15) * (depth + 1e-15);
        let force = length(inside.obstacles[0].repulsive) + length(inside.obstacles[0].detour);
        prop_assert_eq!(inside.obstacles[0].region, "active");
        prop_assert!(force <= (repulsion + detour) * square * (1.0 + 1e-9));
    }

    #[test]
    fn forces_are_continuous_at_the_active_radius(
        bearing in -PI..PI, speed in 0.1..0.7, course in -PI..PI, law in any_law(),
    ) {
        // Omega falls as the depth: some 1e5 N^2/s per metre over a v_L of at least 0.1 N/s.
        const DEPTH: f64 = 1e-10;
        const JUMP: f64 = 1e-3;
        let disc = Obstacle::disc_at_rest([0.0; 2], 0.1, limits(0.5, 1.5)).unwrap();
        let at = |distance: f64| {
            let place = times(distance, [bearing.cos(), bearing.sin()]);
            let velocity = times(speed, [course.cos(), course.sin()]);
            let state = State::beside(place, velocity, [-3.0, 1.0], vec![disc.clone()]);
            terms(&state.scenario().unwrap(), &law, &state)
        };
        let (inside, outside) = (at(1.5 - DEPTH), at(1.5 + DEPTH));
        prop_assert_eq!((inside.obstacles[0].region, outside.obstacles[0].region), ("active", "free"));
        prop_assert!(length(minus(inside.total, outside.total)) < JUMP);
        let (inside, outside) = (inside.lyapunov.unwrap(), outside.lyapunov.unwrap());
        prop_assert!((inside.0 / outside.0 - 1.0).abs() < 1e-6);
    }

    #[test]
    fn repulsion_vanishes_at_the_active_radius(
        radius in 0.7..3.0, axis in 0..4_usize, velocity in prop::array::uniform2(-0.7..0.7), law in any_law(),
    ) {
        let disc = Obstacle::disc_at_rest([0.0; 2], 0.1, limits(0.5, radius)).unwrap();
        let axes = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
        let direction = axes[axis];
        let state = State::beside(times(radius, direction), velocity, [5.0, 5.0], vec![disc]);
        let border = terms(&state.scenario().unwrap(), &law, &state);
        prop_assert_eq!(border.obstacles[0].region, "free");
        prop_assert_eq!(border.obstacles[0].repulsive, [0.0; 2]);
        prop_assert_eq!(border.obstacles[0].detour, [0.0; 2]);
        prop_assert_eq!(border.total, border.attractive);
    }

    #[test]
    fn braking_never_reverses(
        share in 0.0..1.0, bearing in -PI..PI, exponent in -12.0..1.0, course in -PI..PI, law in any_law(),
    ) {
        let disc = Obstacle::disc_at_rest([0.0; 2], 0.1, limits(0.8, 1.5)).unwrap();
        let velocity = times(10f64.powf(exponent), [course.cos(), course.sin()]);
        let place = times(0.31 + 0.48 * share, [bearing.cos(), bearing.sin()]);
        let state = State::beside(place, velocity, [-5.0, 1.0], vec![disc]);
        let scenario = state.scenario().unwrap();
        let brake = terms(&scenario, &law, &state);
        let robot = HolonomicRobot::default();
        prop_assert_eq!(brake.obstacles[0].region, "critical");
        let across = brake.total[0] * velocity[1] - brake.total[1] * velocity[0];
        prop_assert!(across.abs() <= ROUNDING * length(brake.total) * length(velocity));
        let change = times(scenario.control_period() / robot.mass, brake.total);
        let left = (velocity[0] * change[0] + velocity[1] * change[1]) / length(velocity) + length(velocity);
        prop_assert!(left >= -ROUNDING * length(velocity) && left < length(velocity));
        let most = robot.max_acceleration * robot.mass;
        prop_assert!(length(brake.total) <= most * (1.0 + ROUNDING));
    }
}

/// Position and velocity after a time under the total force, the limits of the robot ignored.
fn moved(scenario: &Scenario, law: &VirtualForceField, state: &State, h: f64) -> State {
    let rate = |at: &State| times(1.0 / scenario.mass(), terms(scenario, law, at).total);
    let stage = |share: f64, velocity: [f64; 2], rate: [f64; 2]| {
        let mut later = state.clone();
        later.position = plus(state.position, times(share * h, velocity));
        later.velocity = plus(state.velocity, times(share * h, rate));
        later.time += share * h;
        later
    };
    let first = rate(state);
    let b = stage(0.5, state.velocity, first);
    let second = rate(&b);
    let c = stage(0.5, b.velocity, second);
    let third = rate(&c);
    let d = stage(1.0, c.velocity, third);
    let fourth = rate(&d);
    let mean = |w: [f64; 2], x: [f64; 2], y: [f64; 2], z: [f64; 2]| {
        times(1.0 / 6.0, plus(plus(w, z), times(2.0, plus(x, y))))
    };
    let velocity = mean(state.velocity, b.velocity, c.velocity, d.velocity);
    stage(1.0, velocity, mean(first, second, third, fourth))
}

proptest! {
    #![proptest_config(cases(300))]

    /// Against a central difference along the motion; it holds for discs as long as no side changes.
    #[test]
    fn lyapunov_derivative_is_that_of_the_value(state in any_state(Kind::Discs), law in any_law()) {
        let Some(scenario) = state.scenario() else {
            return Err(TestCaseError::reject("the goal is inside an active region"));
        };
        let here = terms(&scenario, &law, &state);
        let seen = |terms: &FieldTerms| -> Vec<_> {
            terms.obstacles.iter().map(|obstacle| (obstacle.region, obstacle.side)).collect()
        };
        let h = VELOCITY_CHANGE / (1.0 + length(here.total) / scenario.mass());
        let mut difference = 0.0;
        for (steps, weight) in [(-2.0, 1.0), (-1.0, -8.0), (1.0, 8.0), (2.0, -1.0)] {
            let there = terms(&scenario, &law, &moved(&scenario, &law, &state, steps * h));
            prop_assume!(seen(&here) == seen(&there));
            difference += weight * there.lyapunov.unwrap().0;
        }
        let (value, derivative) = here.lyapunov.unwrap();
        let numerical = difference / (12.0 * h);
        let allowed = IDENTITY * derivative.abs().max(1.0) + 4.0 * f64::EPSILON * value / h;
        prop_assert!((numerical - derivative).abs() <= allowed, "{} is not {}", numerical, derivative);
    }
}

fn options(rk4: bool, hold: bool) -> Options {
    Options {
        integrator: if rk4 {
            Integrator::Rk4
        } else {
            Integrator::SemiImplicitEuler
        },
        step: 0.02,
        hold,
        ..Options::default()
    }
}

/// Rows of a column of vectors.
fn rows(column: &[f64]) -> impl Iterator<Item = [f64; 2]> {
    column.chunks(2).map(|row| [row[0], row[1]])
}

proptest! {
    #![proptest_config(cases(150))]

    #[test]
    fn runs_keep_the_limits_and_lose_energy(
        state in any_state(Kind::Any), law in any_law(), rk4 in any::<bool>(), hold in any::<bool>(),
    ) {
        let Some(scenario) = state.scenario() else {
            return Err(TestCaseError::reject("the goal is inside an active region"));
        };
        let options = options(rk4, hold);
        let (run, path) = simulate(&scenario, law, &options, &|| false).unwrap();
        let robot = HolonomicRobot::default();
        let velocities: Vec<_> = rows(&path.velocity).collect();
        for velocity in &velocities {
            prop_assert!(length(*velocity) <= robot.max_speed * (1.0 + ROUNDING));
        }
        for pair in velocities.windows(2) {
            let change = length(minus(pair[1], pair[0])) / options.step;
            prop_assert!(change <= robot.max_acceleration * (1.0 + 1e-10));
        }
        prop_assert!(run.energy >= 0.0 && run.energy.is_finite());
        let positions: Vec<_> = rows(&path.position).collect();
        let way = length(minus(positions[positions.len() - 1], positions[0]));
        // The path is counted with the speed at the end of each step; a chord is never longer
        // for the integrator whose steps are that speed.
        prop_assert!(rk4 || run.path_length >= way - 1e-9);
        for (column, least) in run.min_distance.iter().enumerate() {
            let held = path.distance.iter().skip(column).step_by(run.min_distance.len());
            prop_assert!(held.fold(f64::INFINITY, |a, b| a.min(*b)) >= *least);
        }
    }

    /// A person walks into the robot: it stops on its course and stays.
    #[test]
    fn braking_run_keeps_its_course(offset in -0.3..0.3, speed in 1.2..3.0, law in any_law()) {
        let motion = vff_core::world::motion::Motion::moving([0.5, 0.6 + offset], [speed, 0.0], [0.0; 2], None);
        let person = Obstacle::disc(0.4, motion.unwrap(), limits(0.8, 1.0)).unwrap();
        let scenario = crossing(vec![person], Rules { time_limit: 4.0, ..Rules::default() });
        let (_, path) = simulate(&scenario, law, &options(false, true), &|| false).unwrap();
        let velocities: Vec<_> = rows(&path.velocity).collect();
        let mut braked = false;
        // Three steps a control period; the region is looked at when it begins.
        for first in (0..path.time.len().saturating_sub(4)).step_by(3) {
            if path.distance[first] > 0.8 {
                continue;
            }
            braked = true;
            for step in first..first + 3 {
                let (before, after) = (velocities[step], velocities[step + 1]);
                let dot = before[0] * after[0] + before[1] * after[1];
                let cross = before[0] * after[1] - before[1] * after[0];
                prop_assert!(length(after) <= length(before) * (1.0 + ROUNDING));
                prop_assert!(dot >= -1e-15);
                prop_assert!(cross.abs() <= 1e-15);
            }
        }
        prop_assert!(braked);
    }
}

/// Ordinary, huge, tiny and zero numbers.
fn wild() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -5.0..5.0,
        1 => (-300..300_i32, -1.0..1.0).prop_map(|(exponent, share)| share * 10f64.powi(exponent)),
        1 => Just(0.0),
        1 => prop::num::f64::NORMAL,
    ]
}

fn wild_obstacle() -> impl Strategy<Value = Option<Obstacle>> {
    let numbers = prop::array::uniform9(wild());
    (numbers, any::<[bool; 3]>()).prop_map(|(n, [round, sized, stops])| {
        let mut limits = limits(n[0].abs(), n[0].abs() + n[1].abs());
        if !sized {
            (limits.critical_radius, limits.active_radius) = (None, None);
        }
        if round {
            let stop = stops.then(|| plus([n[2], n[3]], [n[4], n[5]]));
            let acceleration = if stops { [0.0; 2] } else { [n[6], n[7]] };
            let motion = vff_core::world::motion::Motion::moving(
                [n[2], n[3]],
                [n[4], n[5]],
                acceleration,
                stop,
            );
            Obstacle::disc(n[8].abs(), motion.ok()?, limits).ok()
        } else {
            Obstacle::rectangle([n[2], n[3]], [n[4].abs(), n[5].abs()], n[6], limits).ok()
        }
    })
}

/// Everything but what says that something is absent or undefined.
fn is_finite(path: &Trajectory) -> bool {
    let columns = [
        &path.time,
        &path.position,
        &path.velocity,
        &path.force,
        &path.stabilizing,
        &path.wheel_current,
    ];
    columns
        .iter()
        .all(|column| column.iter().all(|value| value.is_finite()))
}

proptest! {
    #![proptest_config(cases(3000))]

    /// Every finite input is refused with its name, or runs to finite motion, or says when it no
    /// longer could.
    #[test]
    fn no_finite_scenario_panics_or_gives_nan(
        bodies in prop::collection::vec(wild_obstacle(), 0..4),
        ends in prop::array::uniform4(wild()), numbers in prop::array::uniform6(wild()),
        set in prop::array::uniform4(wild()), modes in any::<[bool; 4]>(), mode in 0..4,
    ) {
        let stabilizing = match mode {
            0 => Stabilizing::Off,
            1 => Stabilizing::Capped(Cap::Force(numbers[0].abs())),
            2 => Stabilizing::Capped(Cap::Momentum(numbers[0].abs())),
            _ => Stabilizing::Full,
        };
        let [rk4, hold, usual, keeps] = modes;
        let side = SideRules { pass_behind: usual, hysteresis: if keeps { 2.5 } else { f64::INFINITY } };
        let law = VirtualForceField::new(gains(set.map(f64::abs)), stabilizing, side).unwrap();
        let rules = Rules { time_limit: 3.0, heading: numbers[1], ..Rules::default() };
        let mut robot = HolonomicRobot::default();
        if !usual {
            robot.mass = numbers[2].abs();
            robot.max_speed = numbers[3].abs();
            robot.max_acceleration = numbers[4].abs();
        }
        let bodies = bodies.into_iter().flatten().collect();
        let Ok(scenario) = Scenario::new(robot, [ends[0], ends[1]], [ends[2], ends[3]], bodies, rules) else {
            return Ok(());
        };
        if let Err(refusal) = scenario.with_free_goal() {
            prop_assert_eq!(simulate(&scenario, law, &options(rk4, hold), &|| false).err(), Some(refusal));
            return Ok(());
        }
        match simulate(&scenario, law, &options(rk4, hold), &|| false) {
            Ok((run, path)) => {
                prop_assert!(is_finite(&path));
                prop_assert!(!run.energy.is_nan() && run.energy >= 0.0);
                prop_assert!(run.end_time.is_finite() && run.path_length >= 0.0);
                prop_assert!(run.min_distance.iter().all(|distance| *distance >= 0.0));
            }
            Err(Failure::NonFinite(lost)) => {
                prop_assert!(lost.run == 0 && (0.0..=3.1).contains(&lost.time));
            }
            Err(other) => prop_assert!(false, "{}", other),
        }
    }

    /// Without extreme numbers nothing has an excuse.
    #[test]
    fn ordinary_scenarios_stay_finite(state in any_state(Kind::Any), law in any_law(), rk4 in any::<bool>()) {
        let Some(scenario) = state.scenario() else {
            return Err(TestCaseError::reject("the goal is inside an active region"));
        };
        let seen = terms(&scenario, &law, &state);
        let (value, derivative) = seen.lyapunov.unwrap();
        prop_assert!(value.is_finite() && value >= 0.0 && derivative.is_finite());
        if rk4 && state.velocity[0] > 0.6 {
            let (_, path) = simulate(&scenario, law, &options(rk4, false), &|| false).unwrap();
            prop_assert!(is_finite(&path));
        }
    }
}

#[test]
fn a_full_turn_of_a_configuration_changes_nothing() {
    let scenario = crossing(obstacles(4), Rules::default());
    let turned = crossing(
        obstacles(4),
        Rules {
            heading: TAU,
            ..Rules::default()
        },
    );
    let law = law([3.0, 20.0, 17.0, 0.25], Stabilizing::Off);
    let run =
        |scenario: &Scenario| simulate(scenario, law, &Options::default(), &|| false).unwrap();
    let ((one, here), (other, there)) = (run(&scenario), run(&turned));
    assert_eq!(here.position, there.position);
    assert!((one.energy / other.energy - 1.0).abs() < ROUNDING);
}
