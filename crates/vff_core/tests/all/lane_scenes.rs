//! Different scenes side by side have the rows of scenes one after the other, bit for bit.

use crate::bitwise::computed;
use crate::fields::field;
use crate::pairs::{BORENSTEIN_KOREN, GE_CUI, KHATIB, MASOUD};
use vff_core::laws::field::stabilizing::{Cap, Stabilizing};
use vff_core::laws::pairwise::Pairwise;
use vff_core::laws::planning::family::Planned;
use vff_core::laws::reciprocal::ReciprocalAvoidance;
use vff_core::laws::{BorensteinKoren, GeCui, Khatib, KhatibForm, Masoud};
use vff_core::robots::HolonomicRobot;
use vff_core::run::metrics::Weights;
use vff_core::run::{
    AnyLaw, BatchOptions, BatchTable, Instructions, Integrator, Options, Outcome, Width, run_batch,
};
use vff_core::sensing::measurement::{Distribution, Measurement, Noisy};
use vff_core::world::motion::{Motion, Segment};
use vff_core::world::obstacle::{Limits, Obstacle, Shape};
use vff_core::world::scenario::{Rules, Scenario};

/// Numbers from 0 to 1 that differ from scene to scene.
struct Draws(u64);

impl Draws {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / f64::from(1_u32 << 31)
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    fn pair(&mut self, low: f64, high: f64) -> [f64; 2] {
        [self.between(low, high), self.between(low, high)]
    }
}

/// Somebody who walks on, stands, stops, speeds up, turns, or is recorded.
fn motion(draws: &mut Draws) -> Motion {
    let (start, velocity) = (
        [draws.between(1.0, 6.0), draws.between(-2.0, 2.0)],
        draws.pair(-1.0, 1.0),
    );
    let along = |time: f64| [start[0] + time * velocity[0], start[1] + time * velocity[1]];
    match (draws.next() * 6.0).floor() {
        0.0 => Motion::at_rest(start),
        1.0 => Motion::moving(start, velocity, draws.pair(-0.1, 0.1), None).unwrap(),
        2.0 => Motion::moving(start, velocity, [0.0; 2], Some(along(3.0))).unwrap(),
        3.0 => {
            let segment = |draws: &mut Draws| Segment {
                duration: draws.between(0.5, 3.0),
                velocity: draws.pair(-1.0, 1.0),
                acceleration: draws.pair(-0.2, 0.2),
            };
            let segments: Vec<Segment> = (0..3).map(|_| segment(draws)).collect();
            Motion::piecewise(start, &segments).unwrap()
        }
        4.0 => {
            let begin = draws.between(-1.0, 4.0);
            let times = [begin, begin + 1.3, begin + 4.0];
            Motion::recorded(&times, &[start, along(1.0), draws.pair(0.0, 5.0)]).unwrap()
        }
        _ => Motion::moving(start, velocity, [0.0; 2], None).unwrap(),
    }
}

fn scene(draws: &mut Draws, rules: Rules, points: usize) -> Option<Scenario> {
    let count = (draws.next() * 13.0).floor();
    let mut obstacles = Vec::new();
    while (obstacles.len() as f64) < count {
        let limits = Limits {
            max_speed: Some(1.0),
            ..Limits::default()
        };
        let radius = draws.between(0.05, 0.4);
        obstacles.push(Obstacle::disc(radius, motion(draws), limits).unwrap());
    }
    if draws.next() < 0.05 {
        let wall = Obstacle::rectangle([3.0, 2.0], [1.0, 0.2], 0.3, Limits::default());
        obstacles.push(wall.unwrap());
    }
    for _ in 0..points {
        let place = [draws.between(1.0, 6.0), draws.between(-2.0, 2.0)];
        // Without extent: a robot keeps off it as off a point of a map.
        let point = Obstacle {
            shape: Shape::Disc { radius: 0.0 },
            motion: Motion::at_rest(place),
            limits: Limits::default(),
        };
        obstacles.insert(obstacles.len() / 2, point);
    }
    let robot = HolonomicRobot {
        max_speed: if draws.next() < 0.2 { 1.1 } else { 0.7 },
        ..HolonomicRobot::default()
    };
    let ends = [draws.pair(-0.5, 0.5), [7.0, draws.between(-1.0, 1.0)]];
    let scene = Scenario::new(robot, ends[0], ends[1], obstacles, rules)
        .ok()
        .filter(|scene| scene.with_free_goal().is_ok())?;
    let measured = draws.next() < 0.1;
    let noise = Measurement::new(0.01, Distribution::Uniform, Noisy::Both).unwrap();
    scene.measured(measured.then_some(noise), 5).ok()
}

/// Scenes of 0 to 13 obstacles whose number fits no width.
fn scenes(seed: u64, rules: Rules, count: usize) -> Vec<Scenario> {
    scenes_with(seed, rules, (count, 0))
}

/// The same with points that stand.
fn scenes_with(seed: u64, rules: Rules, (count, points): (usize, usize)) -> Vec<Scenario> {
    let mut draws = Draws(seed);
    let mut found = Vec::new();
    while found.len() < count {
        found.extend(scene(&mut draws, rules, points));
    }
    found
}

fn bits(table: &BatchTable) -> Vec<(String, Vec<u64>)> {
    let row = |row: usize| {
        let counts = [
            table.entered_active[row],
            table.contacts_moving[row],
            table.contacts_standing[row],
            table.force_evaluations[row],
        ];
        let mut numbers = [
            &table.end_time,
            &table.arrival_time,
            &table.energy,
            &table.path_length,
            &table.min_clearance,
            &table.performance_total,
            &table.performance_arrival_time,
            &table.performance_avoidance,
            &table.performance_energy_saving,
        ]
        .map(|column| column[row])
        .to_vec();
        numbers.extend(&table.min_distance[row * table.obstacles..(row + 1) * table.obstacles]);
        let words = format!("{:?} {counts:?}", table.outcome[row]);
        (words, numbers.into_iter().map(computed).collect())
    };
    (0..table.len()).map(row).collect()
}

fn assert_same(law: &AnyLaw, scenes: &[Scenario], points: &[f64], run: Options) -> BatchTable {
    let table = |width, threads: usize, instructions| {
        let options = BatchOptions {
            run,
            weights: Weights::EQUAL,
            descent: false,
            threads: Some(threads),
            width,
            instructions,
        };
        run_batch(scenes, law, points, &options, &|| false, &|_| ()).unwrap()
    };
    let (baseline, widest) = (Instructions::Baseline, Instructions::Widest);
    let first = table(Some(Width::One), 1, baseline);
    let expected = bits(&first);
    for (width, threads, instructions) in [
        (None, 1, widest),
        (None, 3, baseline),
        (Some(Width::Four), 2, widest),
        (Some(Width::Eight), 8, widest),
        (Some(Width::Sixteen), 1, baseline),
    ] {
        let rows = bits(&table(width, threads, instructions));
        for (index, (many, one)) in rows.iter().zip(&expected).enumerate() {
            assert_eq!(many, one, "row {index}, {width:?}, {threads} threads");
        }
    }
    first
}

fn rules() -> Rules {
    Rules {
        // No whole number of control periods.
        time_limit: 14.03,
        rest_time: 2.0,
        heading: 0.3,
        ..Rules::default()
    }
}

#[test]
fn every_mode_of_the_field() {
    let scenes = scenes(1, rules(), 61);
    for (stabilizing, hysteresis) in [
        (Stabilizing::Off, f64::INFINITY),
        (Stabilizing::Capped(Cap::Force(10.0)), f64::INFINITY),
        (Stabilizing::Capped(Cap::Momentum(0.1)), 1.2),
        (Stabilizing::Full, 0.4),
    ] {
        let law: AnyLaw = field(stabilizing, hysteresis).into();
        let table = assert_same(&law, &scenes, &[3.0, 20.0, 17.0, 0.25], Options::default());
        for outcome in [Outcome::Arrived, Outcome::Collided, Outcome::TimedOut] {
            assert!(table.outcome.contains(&outcome), "{outcome:?}");
        }
    }
}

#[test]
fn every_way_to_step() {
    let scenes = scenes(2, rules(), 45);
    let law: AnyLaw = field(Stabilizing::Off, f64::INFINITY).into();
    let sets = [
        3.0, 20.0, 17.0, 0.25, 4.3, 20.3, 240.7, 0.68, 0.0, 0.0, 0.0, 0.0,
    ];
    for run in [
        Options {
            step: 0.06,
            ..Options::default()
        },
        Options {
            step: 0.03,
            stop_on_contact: true,
            ..Options::default()
        },
        Options {
            step: 0.02,
            integrator: Integrator::Rk4,
            ..Options::default()
        },
        Options {
            hold: false,
            step: 0.05,
            ..Options::default()
        },
    ] {
        let noiseless: Vec<Scenario> = scenes
            .iter()
            .map(|scene| scene.clone().measured(None, 0).unwrap())
            .collect();
        let table = assert_same(&law, &noiseless, &sets, run);
        assert_eq!(table.len(), 3 * scenes.len());
    }
}

#[test]
fn every_law_of_forces() {
    let scenes = scenes(3, rules(), 37);
    let khatib = |form| Khatib {
        repulsive: 0.3,
        ratio: 0.25,
        form,
        ..KHATIB
    };
    let koren = |attracted_inside| BorensteinKoren {
        repulsive: 1.0,
        attracted_inside,
        ..BORENSTEIN_KOREN
    };
    let masoud = Masoud {
        repulsive: 5.0,
        detour: 5.0,
        ..MASOUD
    };
    let ge_cui = GeCui {
        attractive: 3.0,
        repulsive: 0.3,
        ratio: 0.25,
        ..GE_CUI
    };
    let laws: [AnyLaw; 6] = [
        Pairwise(khatib(KhatibForm::Gradient)).into(),
        Pairwise(khatib(KhatibForm::Printed)).into(),
        Pairwise(koren(true)).into(),
        Pairwise(koren(false)).into(),
        Pairwise(masoud).into(),
        Pairwise(ge_cui).into(),
    ];
    for law in laws {
        let points = law.gains();
        assert_same(
            &law,
            &scenes,
            &points,
            Options {
                step: 0.03,
                ..Options::default()
            },
        );
    }
}

#[test]
fn reciprocal_avoidance() {
    let scenes = scenes(11, rules(), 61);
    let pointed = scenes_with(5, rules(), (41, 3));
    let keen = ReciprocalAvoidance {
        horizon: 5.0,
        share: 0.5,
        reach: 1.5,
        margin: 0.2,
        turn: 0.1,
    };
    let mut touched = 0;
    for (law, scenes) in [
        (ReciprocalAvoidance::default(), &scenes),
        (ReciprocalAvoidance::default(), &pointed),
        (keen, &scenes),
        (keen, &pointed),
    ] {
        let law: AnyLaw = Planned(law).into();
        let points = law.gains();
        for stop_on_contact in [false, true] {
            let run = Options {
                step: 0.03,
                stop_on_contact,
                ..Options::default()
            };
            let table = assert_same(&law, scenes, &points, run);
            let collided = |outcome: &&Outcome| **outcome == Outcome::Collided;
            touched += table.outcome.iter().filter(collided).count();
        }
    }
    // Robots that touch something leave it by another half-plane.
    assert!(touched > 3, "{touched}");
}
