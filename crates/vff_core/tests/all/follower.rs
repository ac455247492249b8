//! Whole runs of the follower.

use std::sync::atomic::{AtomicUsize, Ordering};

use nalgebra::Vector2;
use numeric::parallel::Work;
use vff_core::error::Failure;
use vff_core::laws::impedance::{BankOptions, Form, Rotation};
use vff_core::robots::differential::VelocityDrive;
use vff_core::run::follower::{
    FixNoise, Follower, FollowerOutcome, FollowerRecord, FollowerScene, FollowerSteps, Layouts,
    Leader, Setting, Settings, run_batch, touching_layouts,
};
use vff_core::world::frame::Frame;
use vff_core::world::motion::Motion;
use vff_core::world::obstacle::Obstacle;
use vff_core::world::shape::PlacedShape;

const LAYOUTS: usize = 150;

fn quiet(threads: usize) -> Work<'static> {
    Work {
        threads: Some(threads),
        interrupted: &|| false,
        progress: &|_| (),
    }
}

fn recorded(
    follower: &Follower,
    scene: &FollowerScene,
    seed: u64,
) -> (FollowerOutcome, FollowerRecord) {
    let mut steps = FollowerSteps::new(follower, scene.clone(), seed).unwrap();
    steps.run(&|| false).unwrap();
    let (outcome, rows) = steps.recorded();
    (outcome, rows.clone())
}

fn with_form(form: Form) -> Settings {
    let mut settings = Settings::default();
    settings.impedance.form = form;
    settings
}

fn collisions(settings: &Settings, layouts: &Layouts, seeds: &[u64]) -> f64 {
    let outcomes = run_batch(settings, layouts, seeds, quiet(2)).unwrap();
    let touched = outcomes
        .iter()
        .filter(|each| each.contact.is_some())
        .count();
    touched as f64 / seeds.len() as f64
}

fn dynamic() -> (Layouts, Vec<u64>) {
    let layouts = Layouts::of(Setting::OneDynamic);
    let seeds = touching_layouts(&Settings::default(), &layouts, 0, LAYOUTS, quiet(2)).unwrap();
    (layouts, seeds)
}

#[test]
fn deviations_are_those_of_the_table_and_bilinear_between() {
    let noise = FixNoise::default();
    let degrees = |bearing: f64| bearing.to_radians();
    assert_eq!(noise.at(3.0, 0.0), [0.09, degrees(0.15)]);
    assert_eq!(noise.at(2.0, -degrees(60.0)), [0.13, degrees(0.54)]);
    let [range, bearing] = noise.at(1.5, degrees(15.0));
    assert!((range - (0.02 + 0.03 + 0.05 + 0.08) / 4.0).abs() < 1e-12);
    assert!((bearing - degrees((0.08 + 0.2 + 0.05 + 0.34) / 4.0)).abs() < 1e-12);
    assert_eq!(noise.at(9.0, 3.0), noise.at(4.0, degrees(60.0)));
    assert_eq!(noise.at(0.1, 0.0), noise.at(1.0, 0.0));
    assert!(FixNoise::new(vec![1.0, 1.0], vec![0.0], vec![[0.0; 2]; 2]).is_err());
}

#[test]
fn wheels_turn_toward_the_virtual_velocity_and_keep_their_limit() {
    let drive = VelocityDrive::default();
    assert_eq!(drive.wheels(Vector2::new(0.5, 0.0)), [0.5, 0.5]);
    let [left, right] = drive.wheels(Vector2::new(0.0, 0.3));
    assert!(left < 0.0 && (left + right).abs() < 1e-12 && right <= 0.72);
    let turning = 4.0 * std::f64::consts::FRAC_PI_2 * 0.205;
    assert!((right - turning.min(0.72)).abs() < 1e-12);
    // Behind: it turns on the spot and never goes back.
    let [left, right] = drive.wheels(Vector2::new(-0.3, 0.01));
    assert!(left + right >= -1e-12);
    assert_eq!(
        drive.wheels(Vector2::new(0.01, 0.01))[0],
        drive.wheels(Vector2::new(0.01, 0.01))[1]
    );
}

#[test]
fn a_circle_closes() {
    let drive = VelocityDrive::default();
    let mut pose = Frame::at([0.0, 0.0], 0.4);
    let steps = 10_000;
    // Once around: the wheels differ by omega times their distance.
    let step = 1e-3;
    let omega = std::f64::consts::TAU / (f64::from(steps) * step);
    let wheels = [0.3 - 0.205 * omega, 0.3 + 0.205 * omega];
    for _ in 0..steps {
        pose = drive.moved(&pose, wheels, step);
    }
    assert!(pose.position.norm() < 1e-9);
    assert!((pose.angle() - 0.4).abs() < 1e-9);
}

#[test]
fn it_follows_a_leader_at_its_standoff() {
    let mut settings = Settings::default();
    settings.fixes.noise = FixNoise::none();
    let scene = Layouts::of(Setting::Tracking).scene(0).unwrap();
    let follower = Follower::new(&settings).unwrap();
    let (outcome, rows) = recorded(&follower, &scene, 0);
    assert!(outcome.contact.is_none());
    assert_eq!(outcome.least_clearance, f64::INFINITY);
    // It overshoots its standoff and does not go back.
    assert!((0.4..1.0).contains(&outcome.source_distance));
    assert_eq!(rows.time.len(), 1041);
    assert!(rows.position.iter().all(|place| place.y.abs() < 1e-12));
    let fastest = rows
        .wheel_speed
        .iter()
        .flatten()
        .fold(0.0_f64, |most, speed| most.max(*speed));
    assert!(fastest <= 0.72 + 1e-12);
}

#[test]
fn mirrored_layout_gives_the_mirrored_run() {
    let mut settings = Settings::default();
    settings.fixes.noise = FixNoise::none();
    settings.sensors.ranging.noise = 0.0;
    // Case II is looked for at the right first: a mirrored run needs a box that one pair sees.
    settings.bank.pairing.gap = 0.0;
    settings.bank.pairing.share = 0.0;
    let follower = Follower::new(&settings).unwrap();
    let run = |side: f64| {
        let place = [2.0, 0.35 * side];
        let body = PlacedShape::upright(place, [0.5, 0.6]);
        let scene = FollowerScene {
            leader: Leader::going([1.2, 0.0], [6.0, 0.0], 0.3).unwrap(),
            obstacles: vec![Obstacle::seen(body, Motion::at_rest(place)).unwrap()],
            duration: 15.0,
        };
        recorded(&follower, &scene, 0)
    };
    let ((one, rows), (other, mirrored)) = (run(1.0), run(-1.0));
    assert!((one.path_length - other.path_length).abs() < 1e-6);
    for (here, there) in rows.position.iter().zip(&mirrored.position) {
        assert!((here[0] - there[0]).abs() < 1e-6 && (here[1] + there[1]).abs() < 1e-6);
    }
    assert!(rows.position.iter().any(|place| place.y.abs() > 0.05));
}

#[test]
fn a_record_is_the_run_and_a_batch_is_its_runs() {
    let (layouts, seeds) = dynamic();
    let settings = Settings::default();
    let follower = Follower::new(&settings).unwrap();
    let one = run_batch(&settings, &layouts, &seeds, quiet(1)).unwrap();
    let three = run_batch(&settings, &layouts, &seeds, quiet(3)).unwrap();
    assert_eq!(one, three);
    for (seed, outcome) in seeds.iter().zip(&one).take(20) {
        let (found, rows) = recorded(&follower, &layouts.scene(*seed).unwrap(), *seed);
        assert_eq!(found, *outcome);
        let least = rows.clearance.iter().copied().fold(f64::INFINITY, f64::min);
        assert!((least - outcome.least_clearance).abs() < 1e-12);
    }
}

#[test]
fn a_force_from_outside_takes_the_place_of_the_law() {
    let (layouts, seeds) = dynamic();
    let follower = Follower::new(&Settings::default()).unwrap();
    let scene = layouts.scene(seeds[0]).unwrap();
    let start = || FollowerSteps::new(&follower, scene.clone(), seeds[0]).unwrap();
    let (mut free, mut told, mut still) = (start(), start(), start());
    for _ in 0..40 {
        free.period(None, &|| false).unwrap();
        let rows = told.recorded().1;
        assert_eq!(rows, still.recorded().1);
        let refused = told.period(Some(Vector2::new(f64::NAN, 0.0)), &|| false);
        assert!(matches!(refused, Err(Failure::NonFinite(_))));
        assert_eq!(told.recorded().1, still.recorded().1);
        told.period(Some(Vector2::new(0.0, 5.0)), &|| false)
            .unwrap();
        still
            .period(Some(Vector2::new(0.0, 5.0)), &|| false)
            .unwrap();
    }
    assert_eq!(free.time(), told.time());
    let lateral = |steps: &FollowerSteps| steps.percept().pose.position.y;
    assert!(lateral(&told) > lateral(&free) + 0.05);
    assert_eq!(lateral(&told).to_bits(), lateral(&still).to_bits());
}

#[test]
fn every_kept_layout_touches_without_repulsion() {
    let (layouts, seeds) = dynamic();
    assert_eq!(collisions(&with_form(Form::Off), &layouts, &seeds), 1.0);
    assert!(seeds.is_sorted_by(|one, next| one < next));
    // All of those, and no other one.
    let every: Vec<u64> = (0..=seeds[LAYOUTS - 1]).collect();
    let ends = run_batch(&with_form(Form::Off), &layouts, &every, quiet(2)).unwrap();
    let touching = every.iter().zip(ends);
    let touching = touching.filter(|(_, end)| end.contact.is_some());
    assert!(touching.map(|(seed, _)| *seed).eq(seeds));
    // Nothing ever touches without obstacles.
    let none = Layouts::of(Setting::Tracking);
    let found = touching_layouts(&Settings::default(), &none, 0, 1, quiet(1));
    assert!(matches!(found, Err(Failure::InvalidParameter(_))));
}

#[test]
fn active_law_collides_less_and_printed_forms_collide_more() {
    let (layouts, seeds) = dynamic();
    let active = collisions(&Settings::default(), &layouts, &seeds);
    let conventional = collisions(&with_form(Form::Conventional), &layouts, &seeds);
    assert!(active + 0.15 < conventional, "{active} {conventional}");
    let mut rear = Settings::default();
    rear.sensors.rear = true;
    assert!(collisions(&rear, &layouts, &seeds) < active);
    let twice = collisions(&with_form(Form::ActiveTwiceScaled), &layouts, &seeds);
    assert!(twice > active + 0.2, "{twice}");
    let rotated = Settings {
        bank: BankOptions {
            rotation: Rotation::Printed,
            ..BankOptions::default()
        },
        ..Settings::default()
    };
    let printed = collisions(&rotated, &layouts, &seeds);
    assert!(printed > 0.95, "{printed}");
}

#[test]
fn printed_translation_depends_on_the_origin_of_the_world() {
    let (layouts, seeds) = dynamic();
    let rate = |origin| {
        let mut settings = Settings::default();
        settings.bank.translated_by = Some(origin);
        collisions(&settings, &layouts, &seeds)
    };
    let rates = [[0.0, 0.0], [-10.0, -10.0], [5.0, 5.0]].map(rate);
    let (least, most) = rates
        .iter()
        .fold((1.0_f64, 0.0_f64), |(least, most), rate| {
            (least.min(*rate), most.max(*rate))
        });
    assert!(most - least > 0.3, "{rates:?}");
}

#[test]
fn batch_stops_when_told_and_counts() {
    let (layouts, seeds) = dynamic();
    let done = AtomicUsize::new(0);
    let batch = Work {
        threads: Some(2),
        interrupted: &|| false,
        progress: &|runs| {
            done.fetch_add(runs, Ordering::Relaxed);
        },
    };
    run_batch(&Settings::default(), &layouts, &seeds, batch).unwrap();
    assert_eq!(done.load(Ordering::Relaxed), seeds.len());
    let stopped = Work {
        interrupted: &|| true,
        ..quiet(1)
    };
    let found = run_batch(&Settings::default(), &layouts, &seeds, stopped);
    assert_eq!(found, Err(Failure::Interrupted));
}

#[test]
fn bad_settings_are_refused() {
    let mut settings = Settings::default();
    settings.sensors.rays = 0;
    assert!(Follower::new(&settings).is_err());
    let settings = Settings {
        step: 0.0,
        ..Settings::default()
    };
    assert!(Follower::new(&settings).is_err());
    let mut layouts = Layouts::of(Setting::OneDynamic);
    layouts.speeds = [0.5, 0.2];
    assert!(layouts.checked().is_err());
}
