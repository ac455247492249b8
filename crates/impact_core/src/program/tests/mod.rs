//! Arms and paths that the tests share.

mod contacts;
mod masses;
mod motions;
mod zones;

use nalgebra::Vector3;
use numeric::parallel::Work;

use super::contact::{ContactNormal, MassRule, PathContact, PointLimit, SpeedTable};
use super::masses::PointMotion;
use super::path::JointPath;
use super::retime::{MotionLimits, Retimed, Verification};
use super::spline;
use crate::arm::pose::Pose;
use crate::arm::{Arm, Options};

const WORK: Work<'static> = Work {
    threads: Some(1),
    interrupted: &|| false,
    progress: &|_| (),
};

/// A joint and the link behind it: axis, offset of the joint, mass and center of the link.
type ChainPart<'a> = (&'a str, [f64; 3], f64, [f64; 3]);

/// A chain of joints.
fn chain(parts: &[ChainPart<'_>], inertia: f64) -> Arm {
    let part = |(index, (axis, offset, mass, center)): (usize, &ChainPart<'_>)| {
        let (next, [x, y, z], [a, b, c]) = (index + 1, offset, center);
        format!(
            "<link name=\"l{next}\"><inertial><origin xyz=\"{a} {b} {c}\"/><mass value=\"{mass}\"/><inertia \
             ixx=\"{inertia}\" ixy=\"0\" ixz=\"0\" iyy=\"{inertia}\" iyz=\"0\" izz=\"{inertia}\"/></inertial></link>\
             <joint name=\"j{next}\" type=\"continuous\"><parent link=\"l{index}\"/><child link=\"l{next}\"/><origin \
             xyz=\"{x} {y} {z}\"/><axis xyz=\"{axis}\"/></joint>"
        )
    };
    let parts: String = parts.iter().enumerate().map(part).collect();
    let text = format!("<robot name=\"chain\"><link name=\"l0\"/>{parts}</robot>");
    Arm::from_urdf(&text, &Options::default()).unwrap()
}

/// Point masses at elbow and tip of a planar arm.
fn planar(lengths: [f64; 2], masses: [f64; 2]) -> Arm {
    let [l1, l2] = lengths;
    chain(
        &[
            ("0 0 1", [0.0; 3], masses[0], [l1, 0.0, 0.0]),
            ("0 0 1", [l1, 0.0, 0.0], masses[1], [l2, 0.0, 0.0]),
        ],
        0.0,
    )
}

/// Six axes with compact links.
fn six() -> Arm {
    let axes = ["0 0 1", "0 1 0", "0 1 0", "0 1 0", "0 0 1", "0 1 0"];
    let parts: Vec<_> = axes
        .iter()
        .enumerate()
        .map(|(index, axis)| {
            let mass = 8.0 / (1.0 + index as f64);
            (*axis, [0.05, 0.1, 0.2], mass, [0.02, -0.03, 0.1])
        })
        .collect();
    chain(&parts, 0.02)
}

fn motion<const N: usize>(
    arm: &Arm,
    link: &str,
    point: [f64; 3],
    joints: &[f64],
    rates: &[f64],
) -> PointMotion {
    let mut pose = Pose::<N>::new(arm);
    pose.set(joints).unwrap();
    let point = Vector3::from(point);
    PointMotion::of(
        &pose,
        (arm.link(link).unwrap(), &point),
        rates,
        &pose.weights(rates),
    )
}

/// A straight line of the joints over `0..=1`.
fn straight(moves: &[f64], parts: usize) -> JointPath {
    let values: Vec<f64> = [0.0; 8][..moves.len()]
        .iter()
        .chain(moves)
        .copied()
        .collect();
    let path = spline::through(&[0.0, 1.0], &values, moves.len()).unwrap();
    path.refined(&[parts]).unwrap()
}

fn limits<'a>(velocity: &'a [f64], acceleration: &'a [f64]) -> MotionLimits<'a> {
    MotionLimits {
        velocity,
        acceleration,
        stops: &[],
        path_speed: None,
        contact: None,
    }
}

fn time(found: &Retimed) -> f64 {
    found.times.last().copied().unwrap()
}

/// Within the closed form and 0.2 % above.
fn close(found: &Retimed, expected: f64) {
    let ratio = time(found) / expected;
    assert!((1.0 - 1e-9..1.002).contains(&ratio), "{ratio}");
    assert_eq!(found.status, Verification::Verified);
}

fn limit(point: usize) -> PointLimit {
    PointLimit {
        point,
        energy: f64::INFINITY,
        body_mass: f64::INFINITY,
        human_speed: 0.0,
        speed: f64::INFINITY,
        table: None,
        range: [f64::NEG_INFINITY, f64::INFINITY],
    }
}

fn tip(
    arm: Arm,
    link: &str,
    point: [f64; 3],
    all: Vec<PointLimit>,
    tables: Vec<SpeedTable>,
) -> PathContact {
    let points = vec![(arm.link(link).unwrap(), Vector3::from(point))];
    PathContact::new(
        arm,
        points,
        all,
        tables,
        (MassRule::Directional, ContactNormal::Motion, 10.0),
    )
    .unwrap()
}

fn path_of(values: &[f64], joints: usize, parts: usize) -> JointPath {
    let count = values.len() / joints;
    let knots: Vec<f64> = (0..count)
        .map(|knot| knot as f64 / (count - 1) as f64)
        .collect();
    let path = spline::through(&knots, values, joints).unwrap();
    path.refined(&vec![parts; count - 1]).unwrap()
}
