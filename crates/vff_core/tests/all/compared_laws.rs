//! Laws of other authors: published figures, lanes, and what their forces must do.

use crate::configurations::{crossing, law, limits, obstacles};
use crate::pairs::{BORENSTEIN_KOREN, GE_CUI, KHATIB, MASOUD};
use vff_core::lanes::{Planar, Vector2};
use vff_core::laws::field::stabilizing::Stabilizing;
use vff_core::laws::field_d_star::FieldDStar;
use vff_core::laws::pairwise::{Pairwise, PairwiseFamily, PairwiseField, PairwiseLaw};
use vff_core::laws::planning::family::Planned;
use vff_core::laws::reciprocal::ReciprocalAvoidance;
use vff_core::laws::tree::RapidlyExploringRandomTree;
use vff_core::laws::velocity_obstacle::VelocityObstacle;
use vff_core::laws::{
    BorensteinKoren, GeCui, Khatib, KhatibForm, Law, Masoud, Scan, Situation, Stop,
};
use vff_core::robots::HolonomicRobot;
use vff_core::run::metrics::Weights;
use vff_core::run::{
    AnyLaw, BatchOptions, Instructions, Options, Outcome, RunSummary, Width, run_batch, simulate,
};
use vff_core::world::geometry::{Body, RobotState};
use vff_core::world::motion::{BodyState, Motion};
use vff_core::world::obstacle::{Obstacle, Regions, Shape};
use vff_core::world::scenario::{Rules, Scenario};

/// Relative.
const TIME: f64 = 0.01;
/// In m.
const DISTANCE: f64 = 0.003;
/// Relative: some roundings.
const ROUNDING: f64 = 1e-14;

fn run<F>(scenario: &Scenario, field: F) -> RunSummary
where
    F: PairwiseFamily,
    AnyLaw: From<Pairwise<F>>,
{
    let (run, _) = simulate(scenario, Pairwise(field), &Options::default(), &|| false).unwrap();
    run
}

/// Position and velocity.
type Disc = ([f64; 2], [f64; 2]);

/// Force on a robot at the origin, goal 10 m along x, from discs of 0.1 m.
fn force(field: impl PairwiseField<f64>, velocity: [f64; 2], discs: &[Disc]) -> [f64; 2] {
    let robot = HolonomicRobot::default();
    let rules = Rules::default();
    let scenario = Scenario::new(robot, [0.0; 2], [10.0, 0.0], Vec::new(), rules).unwrap();
    let bodies: Vec<Body> = discs
        .iter()
        .map(|&(position, velocity)| Body {
            shape: Shape::Disc { radius: 0.1 },
            regions: Regions {
                critical_radius: 0.4,
                active_radius: 0.8,
            },
            state: BodyState {
                position,
                velocity,
                acceleration: [0.0; 2],
                present: true,
            },
        })
        .collect();
    let mut law = PairwiseLaw::new(field, &scenario);
    let robot = RobotState {
        position: Vector2::splat([0.0; 2]),
        velocity: Vector2::splat(velocity),
    };
    let interval = 0.06;
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
    law.command(&situation).force.lane(0)
}

fn assert_force(actual: [f64; 2], expected: [f64; 2]) {
    let difference = (actual[0] - expected[0]).hypot(actual[1] - expected[1]);
    let scale = expected[0].hypot(expected[1]);
    assert!(
        difference <= ROUNDING * scale,
        "{actual:?} is not {expected:?}"
    );
}

#[test]
fn masoud_gives_its_figures() {
    for (number, time, distances) in [
        (1, 6.34, &[0.696][..]),
        (2, 7.15, &[1.037]),
        (3, 7.66, &[0.708, 0.633]),
        (4, 7.62, &[1.248, 0.708, 0.690]),
    ] {
        let run = run(&crossing(obstacles(number), Rules::default()), MASOUD);
        assert_eq!(run.outcome, Outcome::Arrived);
        let arrival = run.arrival_time.unwrap();
        assert!(
            (arrival / time - 1.0).abs() <= TIME,
            "c{number}: T {arrival}"
        );
        for (actual, expected) in run.min_distance.iter().zip(distances) {
            assert!(
                (actual - expected).abs() <= DISTANCE,
                "c{number}: d {actual}"
            );
        }
    }
}

#[test]
fn masoud_touches_the_person_who_walks_parallel() {
    let walk = Motion::moving([0.6, 1.2], [1.0, 0.0], [0.0; 2], Some([4.0, 1.2])).unwrap();
    let person = Obstacle::disc(0.4, walk, limits(0.8, 2.1)).unwrap();
    let run = run(&crossing(vec![person], Rules::default()), MASOUD);
    assert_eq!(run.outcome, Outcome::Collided);
    let contact = run.contact[0].unwrap();
    // The figure is printed to 0.01 s, which is the motion step.
    assert!((contact.time - 2.73).abs() < 0.005, "{}", contact.time);
}

#[test]
fn ge_and_cui_hit_the_person_and_keep_their_distances_elsewhere() {
    let hit = run(&crossing(obstacles(2), Rules::default()), GE_CUI);
    assert_eq!(hit.outcome, Outcome::Collided);
    assert!((hit.contact[0].unwrap().time - 3.0).abs() < 0.05);
    for (number, distances) in [(1, &[0.732][..]), (3, &[0.734, 0.748])] {
        let run = run(&crossing(obstacles(number), Rules::default()), GE_CUI);
        for (actual, expected) in run.min_distance.iter().zip(distances) {
            assert!(
                (actual / expected - 1.0).abs() <= 0.01,
                "c{number}: d {actual}"
            );
        }
    }
}

#[test]
fn forces_follow_their_equations() {
    let still = [([0.5, 0.0], [0.0; 2])];
    // D = (-0.5, 0), d = 0.5, gap 0.2, reach 0.5.
    assert_force(force(MASOUD, [0.0; 2], &still), [50.0 - 12.0, -18.0]);
    let steepness = (1.0 / 0.2 - 1.0 / 0.5) / 0.04;
    assert_force(
        force(KHATIB, [0.2, 0.0], &still),
        [3.0 * (10.0 - 0.2) - 0.5 * steepness, 0.0],
    );
    let printed = Khatib {
        form: KhatibForm::Printed,
        ..KHATIB
    };
    let strength = 0.5 * (0.5 - 0.2) / 0.008;
    assert_force(
        force(printed, [0.2, 0.1], &still),
        [
            3.0 * (10.0 - 0.2) - 0.2 * strength,
            -3.0 * 0.1 - 0.1 * strength,
        ],
    );
    assert_force(
        force(BORENSTEIN_KOREN, [0.0; 2], &still),
        [4.0 - 0.7 / 0.2, 0.0],
    );
    let without = BorensteinKoren {
        attracted_inside: false,
        ..BORENSTEIN_KOREN
    };
    assert_force(force(without, [0.0; 2], &still), [-0.7 / 0.2, 0.0]);
    assert_force(force(without, [0.0; 2], &[]), [4.0, 0.0]);
    // ddot = -0.3, betadot = t.(V - V_o)/d with t = (0, -1): -0.4/0.5.
    let (rate, turn) = (-0.3, -0.8);
    let margin: f64 = 0.5 - rate * rate / 20.0;
    let strength = 14.2 / (margin * margin);
    assert_force(
        force(GE_CUI, [0.3, 0.4], &still),
        [
            10.0 - 0.75 * 0.3 - strength * (1.0 - rate / 10.0),
            -0.75 * 0.4 + strength * rate * turn * 0.5,
        ],
    );
}

#[test]
fn forces_add_up_over_the_obstacles_within_reach() {
    let first = ([0.5, 0.1], [0.0, 0.2]);
    let second = ([-0.3, 0.5], [0.1, 0.0]);
    let far = ([3.0, 0.0], [0.0; 2]);
    let velocity = [0.3, -0.2];
    let sum = |field: &dyn Fn(&[Disc]) -> [f64; 2]| {
        let free = field(&[]);
        let (one, two) = (field(&[first]), field(&[second]));
        let both = [one[0] + two[0] - free[0], one[1] + two[1] - free[1]];
        assert_force(field(&[first, second, far]), both);
    };
    sum(&|discs| force(MASOUD, velocity, discs));
    sum(&|discs| force(GE_CUI, velocity, discs));
    sum(&|discs| force(KHATIB, velocity, discs));
    sum(&|discs| force(BORENSTEIN_KOREN, velocity, discs));
}

#[test]
fn forces_stay_finite_where_the_equations_do_not() {
    let on_the_robot = [([0.0; 2], [0.5, 0.0])];
    let touching = [([0.25, 0.0], [0.0; 2])];
    for discs in [&on_the_robot, &touching] {
        for velocity in [[0.0; 2], [0.7, 0.0]] {
            let all = [
                force(MASOUD, velocity, discs),
                force(GE_CUI, velocity, discs),
                force(KHATIB, velocity, discs),
                force(BORENSTEIN_KOREN, velocity, discs),
            ];
            assert!(all.iter().flatten().all(|part| part.is_finite()), "{all:?}");
        }
    }
    // Touching surfaces push the robot away, they never pull it in.
    assert!(force(KHATIB, [0.0; 2], &touching)[0] < 0.0);
    assert!(force(BORENSTEIN_KOREN, [0.0; 2], &touching)[0] < 0.0);
}

/// Runs of gain sets around those of a law: the same bits for any width and number of threads, and
/// those of single runs.
fn batches_agree(law: impl Into<AnyLaw>, points: &[f64], singles: &[AnyLaw]) {
    let law: AnyLaw = law.into();
    let scenarios = [2, 4].map(|number| crossing(obstacles(number), Rules::default()));
    let run = Options::default();
    let batch = |width, threads| {
        let options = BatchOptions {
            run,
            weights: Weights::EQUAL,
            descent: false,
            threads: Some(threads),
            width: Some(width),
            instructions: Instructions::Widest,
        };
        run_batch(&scenarios, &law, points, &options, &|| false, &|_| ()).unwrap()
    };
    let base = batch(Width::One, 1);
    for (width, threads) in [(Width::Four, 1), (Width::Eight, 2), (Width::Sixteen, 2)] {
        assert_eq!(format!("{base:?}"), format!("{:?}", batch(width, threads)));
    }
    let ways = singles
        .iter()
        .flat_map(|law| scenarios.iter().map(move |way| (law, way)));
    for (row, (law, way)) in ways.enumerate() {
        let (single, _) = simulate(way, law, &run, &|| false).unwrap();
        assert_eq!(single.outcome, base.outcome[row]);
        assert_eq!(single.energy.to_bits(), base.energy[row].to_bits());
        assert_eq!(
            single.path_length.to_bits(),
            base.path_length[row].to_bits()
        );
    }
}

#[test]
fn lanes_give_the_bits_of_single_runs() {
    let strengths = [3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0];
    let points: Vec<f64> = strengths
        .iter()
        .flat_map(|k| [*k, 20.0, 17.0, 0.25])
        .collect();
    let field = |attractive| law([attractive, 20.0, 17.0, 0.25], Stabilizing::Off);
    batches_agree(field(3.0), &points, &strengths.map(|k| field(k).into()));
    let masoud = |attractive| Masoud {
        attractive,
        ..MASOUD
    };
    pairs_agree(strengths.map(masoud));
    let ge_cui = |attractive| GeCui {
        attractive,
        ..GE_CUI
    };
    pairs_agree(strengths.map(ge_cui));
    let khatib = |attractive| Khatib {
        attractive,
        ..KHATIB
    };
    pairs_agree(strengths.map(khatib));
    let koren = |attractive| BorensteinKoren {
        attractive,
        ..BORENSTEIN_KOREN
    };
    pairs_agree(strengths.map(koren));
}

/// A law with several gain sets, in a batch and each alone.
fn pairs_agree<F: PairwiseFamily>(fields: [F; 9])
where
    AnyLaw: From<Pairwise<F>>,
{
    let points: Vec<f64> = fields.iter().flat_map(PairwiseFamily::gains).collect();
    batches_agree(
        Pairwise(fields[0]),
        &points,
        &fields.map(|field| Pairwise(field).into()),
    );
}

#[test]
fn planners_run_in_batches_as_they_run_alone() {
    let margins = [0.0, 0.01, 0.1];
    let points: Vec<f64> = margins.iter().flat_map(|m| [*m, 8.0, 1.0, 1.0]).collect();
    let base = VelocityObstacle {
        horizon: 8.0,
        ..VelocityObstacle::default()
    };
    let obstacle = |margin| Planned(VelocityObstacle { margin, ..base }).into();
    batches_agree(Planned(base), &points, &margins.map(obstacle));
    let points: Vec<f64> = margins.iter().flat_map(|m| [2.0, *m, 0.01, 5.0]).collect();
    let base = ReciprocalAvoidance::default();
    let reciprocal = |margin| Planned(ReciprocalAvoidance { margin, ..base }).into();
    batches_agree(Planned(base), &points, &margins.map(reciprocal));
    let points: Vec<f64> = margins
        .iter()
        .flat_map(|m| [0.1, *m, 1.0, 3.0, 0.1])
        .collect();
    let base = FieldDStar::default();
    let grid = |margin| Planned(FieldDStar { margin, ..base }).into();
    batches_agree(Planned(base), &points, &margins.map(grid));
    let points: Vec<f64> = margins
        .iter()
        .flat_map(|m| [0.2, 0.1, 0.6, *m, 1.0, 3.0, 0.1])
        .collect();
    let base = RapidlyExploringRandomTree::default();
    let tree = |margin| Planned(RapidlyExploringRandomTree { margin, ..base }).into();
    batches_agree(Planned(base), &points, &margins.map(tree));
}
