//! Limits of contacts along a path.

use std::f64::consts::PI;

use nalgebra::Vector3;
use numeric::parallel::Work;
use proptest::prelude::*;

use super::{WORK, close, limit, limits, path_of, planar, six, straight, time, tip};
use crate::arm::{Arm, Options};
use crate::program::contact::{ContactNormal, MassRule, PathContact, PointLimit, SpeedTable};
use crate::program::retime::{MotionLimits, Reason, Verification, retime};
use crate::program::rows::Waypoints;
use crate::program::{draws, spline};

#[test]
fn a_turn_at_a_speed_of_the_tip() {
    let ([l1, l2], bend): ([f64; 2], f64) = ([0.4, 0.3], 0.9);
    let cap = PointLimit {
        speed: 0.3,
        ..limit(0)
    };
    let contact = tip(
        planar([l1, l2], [1.0; 2]),
        "l2",
        [l2, 0.0, 0.0],
        vec![limit(0), cap],
        vec![],
    );
    let values = [0.0, bend, 1.0, bend];
    let path = spline::through(&[0.0, 1.0], &values, 2)
        .unwrap()
        .refined(&[4000])
        .unwrap();
    let (velocity, acceleration) = ([2.0; 2], [5.0; 2]);
    let all = MotionLimits {
        contact: Some(&contact),
        ..limits(&velocity, &acceleration)
    };
    let found = retime(&path, &all, WORK).unwrap();
    close(&found, 2.201_004_930_325);
    assert_eq!(found.reasons[2000], Reason::Contact(1));
    assert_eq!(found.contacts[0], Some(1));
}

#[test]
fn allowed_speeds_are_those_of_the_energy_less_that_of_the_human() {
    let arm = planar([0.3, 0.2], [2.0, 1.0]);
    let energy = PointLimit {
        energy: 0.5,
        body_mass: 2.0,
        human_speed: 0.1,
        ..limit(0)
    };
    let table = SpeedTable::new(vec![0.5, 1.5, f64::INFINITY], vec![0.9, 0.4, 0.2]).unwrap();
    let far = PointLimit {
        table: Some(0),
        range: [2.0, 3.0],
        ..limit(0)
    };
    let contact = tip(
        arm,
        "l2",
        [0.2, 0.0, 0.0],
        vec![
            energy,
            far,
            PointLimit {
                speed: 0.0,
                ..limit(0)
            },
        ],
        vec![table],
    );
    // Across the second link with the tip mass of 1 kg: reduced mass 2/3 kg with the body.
    let joints = [0.3, PI / 2.0, 0.3, PI / 2.0, 0.3, PI / 2.0];
    let waypoints = Waypoints {
        joints: &joints,
        rates: &[0.0, 1.0, 0.0, 1.0, 0.0, 0.0],
        places: &[0.0, 2.0, 2.5],
        check_limits: true,
    };
    let found = contact.allowed(&waypoints, true, WORK).unwrap();
    let expected = (2.0 * 0.5 / (2.0_f64 / 3.0)).sqrt() - 0.1;
    assert!((found.every[0] - expected).abs() < 1e-12);
    assert_eq!(found.every[1], f64::INFINITY);
    assert!(
        (found.every[4] - 0.4).abs() < 1e-12,
        "clamped, 1 kg: the slower neighbor"
    );
    assert_eq!(found.lowest, [0.0, 0.0, f64::INFINITY]);
    assert_eq!(found.governs, [Some(2), Some(2), None]);
}

#[test]
fn tables_give_the_slower_neighbor_and_nothing_above() {
    let table = SpeedTable::new(vec![1.0, 2.0, 4.0], vec![0.5, 0.6, 0.1]).unwrap();
    let found = [0.5, 1.5, 3.0, 4.0, 4.1].map(|mass| table.speed(mass));
    assert_eq!(found, [0.5, 0.5, 0.1, 0.1, 0.0]);
    assert!(SpeedTable::new(vec![2.0, 1.0], vec![0.1, 0.1]).is_err());
    assert!(SpeedTable::new(vec![1.0], vec![f64::NAN]).is_err());
}

#[test]
fn a_locked_joint_may_not_move() {
    let options = Options {
        locked: vec!["j1".into()],
        ..Options::default()
    };
    let text = "<robot name=\"r\"><link name=\"a\"/><link name=\"b\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" \
                ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial></link><link name=\"c\"><inertial><mass \
                value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial></link>\
                <joint name=\"j1\" type=\"continuous\"><parent link=\"a\"/><child link=\"b\"/><axis xyz=\"0 0 1\"/>\
                </joint><joint name=\"j2\" type=\"continuous\"><parent link=\"b\"/><child link=\"c\"/><axis \
                xyz=\"0 0 1\"/></joint></robot>";
    let contact = tip(
        Arm::from_urdf(text, &options).unwrap(),
        "c",
        [0.1, 0.0, 0.0],
        vec![limit(0)],
        vec![],
    );
    let (velocity, acceleration) = ([1.0; 2], [1.0; 2]);
    let all = MotionLimits {
        contact: Some(&contact),
        ..limits(&velocity, &acceleration)
    };
    assert!(retime(&straight(&[0.0, 1.0], 10), &all, WORK).is_ok());
    let refused = retime(&straight(&[1.0, 1.0], 10), &all, WORK).unwrap_err();
    assert!(refused.to_string().contains("locked joint"));
    let waypoints = Waypoints {
        joints: &[0.0; 2],
        rates: &[1.0, 0.0],
        places: &[0.0],
        check_limits: true,
    };
    assert!(contact.motions(&waypoints, WORK).is_err());
    let [values, rates] = draws::draws(&contact.arm, &[1.0, 2.0], 100, 7).unwrap();
    assert!(
        values
            .chunks(2)
            .all(|row| row[0] == 0.0 && row[1].abs() <= PI)
    );
    assert!(
        rates
            .chunks(2)
            .all(|row| row[0] == 0.0 && (row[1].abs() - 2.0).abs() < 1e-12)
    );
}

#[test]
fn steps_of_tables_on_long_intervals_are_kept() {
    let values: Vec<f64> = (0..24)
        .map(|index| 1.5 * (1.3 * f64::from(index)).sin())
        .collect();
    let masses: Vec<f64> = (0..40).map(|index| 0.1 * 1.3_f64.powi(index)).collect();
    let speeds = masses.iter().map(|mass| mass.powf(-0.5)).collect();
    let steps = SpeedTable::new(masses, speeds).unwrap();
    let row = PointLimit {
        table: Some(0),
        ..limit(0)
    };
    let contact = tip(six(), "l6", [0.0, 0.0, 0.2], vec![row], vec![steps]);
    let (velocity, acceleration) = ([2.0; 6], [5.0; 6]);
    let all = MotionLimits {
        contact: Some(&contact),
        ..limits(&velocity, &acceleration)
    };
    for parts in 2..12 {
        let found = retime(&path_of(&values, 6, parts), &all, WORK).unwrap();
        assert_eq!(found.status, Verification::Verified, "{parts}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn contacts_are_kept_between_the_nodes(
        values in prop::collection::vec(-1.5..1.5, 24),
        energy in 0.05..2.0,
        worst in any::<bool>(),
    ) {
        let arm = six();
        let points = vec![
            (arm.link("l6").unwrap(), Vector3::new(0.0, 0.0, 0.2)),
            (arm.link("l3").unwrap(), Vector3::new(0.1, 0.0, 0.0)),
        ];
        let rows = vec![
            PointLimit { energy, ..limit(0) },
            PointLimit { energy: 0.5 * energy, body_mass: 1.5, human_speed: 0.01, ..limit(1) },
            PointLimit { speed: 0.25, ..limit(0) },
        ];
        let normal = if worst { ContactNormal::Worst } else { ContactNormal::Motion };
        let contact = PathContact::new(arm, points, rows, vec![], (MassRule::Larger, normal, 3.0)).unwrap();
        let path = path_of(&values, 6, 30);
        let (velocity, acceleration) = ([2.0; 6], [5.0; 6]);
        let without = limits(&velocity, &acceleration);
        let with = MotionLimits { contact: Some(&contact), ..without };
        let found = retime(&path, &with, WORK).unwrap();
        prop_assert_eq!(found.status, Verification::Verified);
        prop_assert!(found.shares.iter().all(|shares| shares[2] <= 1.0 + 1e-6));
        prop_assert!(time(&found) >= time(&retime(&path, &without, WORK).unwrap()) * (1.0 - 1e-9));
        let threads = retime(&path, &with, Work { threads: Some(2), ..WORK }).unwrap();
        prop_assert_eq!(&threads.squares, &found.squares);
        // At other places than those that the motion was checked at.
        for index in 0..path.intervals() {
            let piece = path.piece(index);
            let (mut joints, mut rates) = (vec![0.0; 6], vec![0.0; 6]);
            for place in 0..4 {
                let share = (f64::from(place) + 0.37) / 4.0;
                piece.place(share * piece.length, &mut joints);
                piece.rates(share * piece.length, &mut rates);
                let square = found.squares[index] * (1.0 - share) + found.squares[index + 1] * share;
                let speed = square.sqrt();
                for rate in &mut rates {
                    *rate *= speed;
                }
                let waypoints = Waypoints { joints: &joints, rates: &rates, places: &[0.5], check_limits: false };
                let row = contact.allowed(&waypoints, false, WORK).unwrap();
                for (speed, lowest) in row.speed.iter().zip(&row.lowest) {
                    prop_assert!(speed <= &(lowest * (1.0 + 1e-3)));
                }
            }
        }
    }
}
