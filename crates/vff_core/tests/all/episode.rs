//! An episode that is stepped from outside is the run that goes to its end by itself.

use std::sync::Arc;

use crate::configurations::{crossing, law, obstacles};
use vff_core::lanes::Planar;
use vff_core::laws::field::stabilizing::Stabilizing;
use vff_core::robots::wheels::holonomic_wheels;
use vff_core::run::as_built::{AsBuilt, simulate_as_built};
use vff_core::run::{AnyLaw, Episode, Options, Outcome, Request, simulate};
use vff_core::sensing::measurement::{Distribution, Measurement, Noisy};
use vff_core::world::scenario::{Rules, Scenario};

fn never() -> bool {
    false
}

fn field() -> AnyLaw {
    law([3.0, 20.0, 17.0, 0.25], Stabilizing::Off).into()
}

fn scene(number: usize) -> Arc<Scenario> {
    let noise = Measurement::new(0.025, Distribution::Uniform, Noisy::Both).unwrap();
    let scenario = crossing(obstacles(number), Rules::default());
    Arc::new(scenario.measured(Some(noise), 7).unwrap())
}

#[test]
fn stepped_by_its_law_it_is_the_run_bit_for_bit() {
    let wheels = AsBuilt {
        wheels: Some(holonomic_wheels().to_vec()),
        ..AsBuilt::default()
    };
    for built in [AsBuilt::default(), wheels] {
        for number in 1..=4 {
            let scenario = scene(number);
            let mut episode = Episode::new(Arc::clone(&scenario), Some(&field()), &built).unwrap();
            while !episode.finished() {
                episode.period(Request::Law, &never).unwrap();
            }
            let whole = simulate_as_built(&scenario, &field(), &built, &never).unwrap();
            // Bits by what is printed: NaN equals NaN.
            assert_eq!(format!("{:?}", episode.recorded()), format!("{whole:?}"));
            assert_eq!(episode.outcome(), Some(whole.0.outcome));
        }
    }
}

#[test]
fn forces_of_another_run_give_that_run() {
    let scenario = scene(3);
    let plain = simulate(&scenario, field(), &Options::default(), &never).unwrap();
    let mut episode = Episode::new(Arc::clone(&scenario), None, &AsBuilt::default()).unwrap();
    let mut row = 0;
    while !episode.finished() {
        let force = [plain.1.force[2 * row], plain.1.force[2 * row + 1]];
        episode.period(Request::Force(force), &never).unwrap();
        row += 6;
    }
    assert_eq!(episode.recorded().1.motion.position, plain.1.position);
    assert_eq!(episode.time(), plain.0.end_time);
}

#[test]
fn a_velocity_is_there_at_the_next_sample() {
    let exact = Arc::new(crossing(obstacles(1), Rules::default()));
    let mut episode = Episode::new(exact, None, &AsBuilt::default()).unwrap();
    episode
        .period(Request::Velocity([-0.2, 0.1]), &never)
        .unwrap();
    let [x, y] = episode.situation().robot.velocity.lane(0);
    assert!((x + 0.2).abs() < 1e-15 && (y - 0.1).abs() < 1e-15);
}

#[test]
fn what_cannot_be_done_changes_nothing() {
    let exact = Arc::new(crossing(obstacles(1), Rules::default()));
    let mut episode = Episode::new(exact, None, &AsBuilt::default()).unwrap();
    episode.period(Request::Law, &never).unwrap();
    assert!(episode.period(Request::Force([0.0; 2]), &|| true).is_err());
    let overflow = Request::Force([1e300, 1e300]);
    assert!(episode.period(overflow, &never).is_err());
    assert_eq!((episode.time(), episode.outcome()), (0.0, None));
    let rows = episode.recorded().1.heading.len();
    assert_eq!(rows, 1);
}

#[test]
fn an_episode_that_has_ended_stays_as_it_is() {
    let exact = Arc::new(crossing(obstacles(1), Rules::default()));
    let mut episode = Episode::new(exact, Some(&field()), &AsBuilt::default()).unwrap();
    while !episode.finished() {
        episode.period(Request::Law, &never).unwrap();
    }
    let end = episode.time();
    episode.period(Request::Force([1.0, 0.0]), &never).unwrap();
    assert_eq!(episode.time(), end);
    assert_eq!(episode.outcome(), Some(Outcome::Arrived));
}
