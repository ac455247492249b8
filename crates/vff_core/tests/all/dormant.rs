//! A run that leaves far obstacles alone has the bits of a run that looks at all of them at every motion
//! step, which recorded runs do.

use crate::bitwise::computed;
use crate::draws::Draws;
use crate::fields::field;
use crate::pairs::{BORENSTEIN_KOREN, GE_CUI, KHATIB, MASOUD};
use vff_core::laws::field::stabilizing::{Cap, Stabilizing};
use vff_core::laws::impedance::{Attraction, Form, Impedance, ImpedanceFamily};
use vff_core::laws::pairwise::Pairwise;
use vff_core::laws::planning::family::Planned;
use vff_core::laws::reciprocal::ReciprocalAvoidance;
use vff_core::laws::velocity_obstacle::VelocityObstacle;
use vff_core::laws::{BorensteinKoren, GeCui, Khatib, Masoud};
use vff_core::robots::HolonomicRobot;
use vff_core::run::metrics::Weights;
use vff_core::run::{
    AnyLaw, BatchOptions, Instructions, Integrator, Options, Outcome, Width, run_batch, simulate,
};
use vff_core::sensing::measurement::{Distribution, Measurement, Noisy};
use vff_core::world::motion::{Motion, Segment};
use vff_core::world::obstacle::{Limits, Obstacle};
use vff_core::world::scenario::{Rules, Scenario};

fn pair(draws: &mut Draws, low: f64, high: f64) -> [f64; 2] {
    [draws.between(low, high), draws.between(low, high)]
}

/// Somebody who stands, walks on, stops, starts and stops, speeds up, turns, comes back, or is recorded.
fn motion(draws: &mut Draws, reach: f64) -> Motion {
    let speed = if draws.below(4) == 0 { 4.0 } else { 1.0 };
    let start = pair(draws, -reach, reach);
    let velocity = pair(draws, -speed, speed);
    let along = |time: f64| [start[0] + time * velocity[0], start[1] + time * velocity[1]];
    match draws.below(8) {
        0 => Motion::at_rest(start),
        1 => Motion::moving(start, velocity, pair(draws, -0.1, 0.1), None).unwrap(),
        2 => Motion::moving(start, velocity, [0.0; 2], Some(along(3.0))).unwrap(),
        3 => {
            let from = draws.between(0.0, 5.0);
            let until = from + draws.between(0.0, 5.0);
            Motion::between(start, velocity, [from, until]).unwrap()
        }
        kind @ (4 | 5) => {
            let gain = if kind == 4 { 0.0 } else { 0.2 };
            let segment = |draws: &mut Draws| Segment {
                duration: draws.between(0.5, 3.0),
                velocity: pair(draws, -speed, speed),
                acceleration: pair(draws, -gain, gain),
            };
            let segments: Vec<Segment> = (0..5).map(|_| segment(draws)).collect();
            Motion::piecewise(start, &segments).unwrap()
        }
        6 => {
            let begin = draws.between(-1.0, 4.0);
            let times = [begin, begin + 1.3, begin + 4.0];
            Motion::recorded(&times, &[start, along(1.0), pair(draws, 0.0, 5.0)]).unwrap()
        }
        _ => Motion::moving(start, velocity, [0.0; 2], None).unwrap(),
    }
}

fn scene(draws: &mut Draws, measured: bool) -> Option<Scenario> {
    let reach = [6.0, 15.0, 80.0][draws.below(3)];
    let count = 16 + draws.below(50);
    let mut obstacles = Vec::new();
    for _ in 0..count {
        let limits = Limits {
            max_speed: Some(1.0),
            ..Limits::default()
        };
        let radius = draws.between(0.05, 0.4);
        obstacles.push(Obstacle::disc(radius, motion(draws, reach), limits).unwrap());
        if draws.below(6) == 0 {
            let (center, sides) = (pair(draws, -reach, reach), pair(draws, 0.2, 4.0));
            let turn = draws.between(-3.0, 3.0);
            let wall = Obstacle::rectangle(center, sides, turn, Limits::default());
            obstacles.push(wall.unwrap());
        }
    }
    let robot = HolonomicRobot {
        max_speed: if draws.below(2) == 0 { 1.1 } else { 0.7 },
        ..HolonomicRobot::default()
    };
    let rules = Rules {
        // No whole number of control periods.
        time_limit: draws.between(5.0, 25.0),
        rest_time: 2.0,
        ..Rules::default()
    };
    let scene = Scenario::new(
        robot,
        pair(draws, -0.5, 0.5),
        [draws.between(3.0, 12.0), draws.between(-1.0, 1.0)],
        obstacles,
        rules,
    );
    let scene = scene.ok().filter(|scene| scene.with_free_goal().is_ok())?;
    let noise = Measurement::new(0.01, Distribution::Uniform, Noisy::Both).unwrap();
    scene.measured(measured.then_some(noise), 5).ok()
}

fn scenes(seed: u64, count: usize) -> Vec<Scenario> {
    let mut draws = Draws::new(seed);
    let mut found = Vec::new();
    while found.len() < count {
        let measured = draws.below(10) == 0;
        found.extend(scene(&mut draws, measured));
    }
    found
}

/// Runs one by one and recorded runs; returns how they ended.
fn assert_same(law: impl Into<AnyLaw>, scenes: &[Scenario], run: Options) -> Vec<Outcome> {
    let law = law.into();
    let options = BatchOptions {
        run,
        weights: Weights::EQUAL,
        descent: false,
        threads: Some(1),
        width: Some(Width::One),
        instructions: Instructions::Widest,
    };
    let points = law.gains();
    let table = run_batch(scenes, &law, &points, &options, &|| false, &|_| ()).unwrap();
    for (row, scene) in scenes.iter().enumerate() {
        let (summary, _) = simulate(scene, &law, &run, &|| false).unwrap();
        let first = row * table.obstacles;
        let found = &table.min_distance[first..first + scene.obstacle_count()];
        for (index, (own, all)) in found.iter().zip(&summary.min_distance).enumerate() {
            let bits = [own, all].map(|distance| computed(*distance));
            assert_eq!(
                bits[0], bits[1],
                "scene {row}, obstacle {index}: {own}, {all}"
            );
        }
        assert_eq!(table.outcome[row], summary.outcome, "scene {row}");
        assert_eq!(
            table.force_evaluations[row].cast_unsigned(),
            summary.force_evaluations
        );
        let touched = summary.contact.iter().flatten();
        let at_fault = touched.clone().filter(|touch| touch.at_fault).count();
        let contacts = table.contacts_moving[row] + table.contacts_standing[row];
        assert_eq!(
            usize::try_from(contacts).unwrap(),
            touched.count(),
            "scene {row}"
        );
        assert_eq!(
            usize::try_from(table.contacts_at_fault[row]).unwrap(),
            at_fault,
            "scene {row}"
        );
        let arrival = summary.arrival_time.unwrap_or(f64::NAN);
        for (own, all) in [
            (table.end_time[row], summary.end_time),
            (table.arrival_time[row], arrival),
            (table.energy[row], summary.energy),
            (table.path_length[row], summary.path_length),
        ] {
            assert_eq!(computed(own), computed(all), "scene {row}");
        }
    }
    table.outcome
}

#[test]
fn every_mode_of_the_field() {
    let scenes = scenes(1, 60);
    for (stabilizing, hysteresis) in [
        (Stabilizing::Off, f64::INFINITY),
        (Stabilizing::Capped(Cap::Momentum(0.1)), f64::INFINITY),
        (Stabilizing::Full, 0.4),
    ] {
        let law = field(stabilizing, hysteresis);
        let ends = assert_same(law, &scenes, Options::default());
        for outcome in [Outcome::Arrived, Outcome::Collided, Outcome::TimedOut] {
            assert!(ends.contains(&outcome), "{outcome:?}");
        }
    }
}

#[test]
fn every_way_to_step() {
    let all = scenes(2, 60);
    let exact: Vec<Scenario> = all
        .into_iter()
        .map(|scene| scene.measured(None, 0).unwrap())
        .collect();
    let law = field(Stabilizing::Off, f64::INFINITY);
    let own = Options::default();
    for run in [
        Options { step: 0.06, ..own },
        Options {
            step: 0.03,
            stop_on_contact: true,
            ..own
        },
        Options {
            step: 0.02,
            integrator: Integrator::Rk4,
            ..own
        },
        Options {
            hold: false,
            step: 0.05,
            ..own
        },
        Options {
            hold: false,
            step: 0.05,
            integrator: Integrator::Rk4,
            ..own
        },
    ] {
        assert_same(law, &exact, run);
    }
}

/// So many motion steps that the path is counted and forgotten on the way.
#[test]
fn a_long_way_in_short_steps() {
    let run = Options {
        step: 0.0005,
        ..Options::default()
    };
    assert_same(field(Stabilizing::Off, f64::INFINITY), &scenes(3, 6), run);
}

#[test]
fn every_other_law() {
    let scenes = scenes(4, 40);
    let run = Options {
        step: 0.03,
        ..Options::default()
    };
    let (attractive, ratio) = (3.0, 0.25);
    let khatib = Khatib {
        repulsive: 0.3,
        ratio,
        ..KHATIB
    };
    let koren = BorensteinKoren {
        attractive,
        repulsive: 1.0,
        ..BORENSTEIN_KOREN
    };
    let masoud = Masoud {
        repulsive: 5.0,
        detour: 5.0,
        ..MASOUD
    };
    let ge_cui = GeCui {
        attractive,
        repulsive: 0.3,
        ratio,
        ..GE_CUI
    };
    assert_same(Pairwise(khatib), &scenes, run);
    assert_same(Pairwise(koren), &scenes, run);
    assert_same(Pairwise(masoud), &scenes, run);
    assert_same(Pairwise(ge_cui), &scenes, run);
    assert_same(Planned(ReciprocalAvoidance::default()), &scenes, run);
    assert_same(Planned(VelocityObstacle::default()), &scenes[..10], run);
    let impedance = Impedance {
        form: Form::Active,
        stiffness: 10.0,
        damping: 10.0,
        safe_distance: 1.0,
        speed_limit: 1.0,
        reference_stiffness: 27.0,
        reference_damping: 3.7,
        clamp: true,
    };
    let attraction = Attraction {
        stiffness: 3.0,
        damping: 3.0,
        standoff: 0.0,
    };
    let law = ImpedanceFamily {
        impedance,
        attraction,
        reach: 3.0,
        view: 1.6,
    };
    assert_same(law, &scenes, run);
}

/// Where distances are rounded more.
#[test]
fn far_from_the_origin() {
    let mut draws = Draws::new(5);
    for shift in [1e3, 1e7] {
        let far: Vec<Obstacle> = (0..20)
            .map(|_| {
                let [x, y] = pair(&mut draws, -40.0, 40.0);
                let velocity = pair(&mut draws, -0.3, 0.3);
                let place = [shift + 20.0 + x.abs(), y - shift];
                let motion = Motion::moving(place, velocity, [0.0; 2], None).unwrap();
                Obstacle::disc(0.2, motion, Limits::default()).unwrap()
            })
            .collect();
        let scene = Scenario::new(
            HolonomicRobot::default(),
            [shift, -shift],
            [shift + 5.0, -shift],
            far,
            Rules::default(),
        )
        .unwrap();
        assert_same(
            field(Stabilizing::Off, f64::INFINITY),
            &[scene],
            Options::default(),
        );
    }
}
