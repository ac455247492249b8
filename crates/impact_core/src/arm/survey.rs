//! Signs, without a pose, that an arm may not be real: its reach, parts without a mass, wheels.

use nalgebra::{Matrix3, Vector3};

use super::body::Body;
use super::model::{ArmJoint, JointKind, Link, Segment};

/// A segment that spans more than this to the next joint is a part of the arm, and not a frame (m).
const PART: f64 = 0.05;

/// Axes with a cosine above this are parallel.
const PARALLEL: f64 = 0.999;

/// Signs that an arm may not be real.
#[derive(Clone, Debug, Default)]
pub struct Survey {
    /// Longest way from the first joint through the others to a link or its center of mass (m); slides do not count.
    pub reach: f64,
    /// Names of joints that move a part of the arm without a mass.
    pub massless: Vec<String>,
    /// Joints that look like wheels of the base: they turn without limits about parallel axes, carry no other joint,
    /// and the base has a mass.
    pub wheels: Vec<String>,
    /// Sliding joints of the base of a range above 10 m: a floor that the base moves on.
    pub floors: Vec<String>,
    /// Largest inertia that each free joint moves, without motors and payload (kg m^2, or kg where it slides).
    pub largest_own: Vec<f64>,
}

/// A slide of the base longer than this is a floor (m).
const FLOOR: f64 = 10.0;

impl Survey {
    /// Looks at an arm without payload.
    #[must_use]
    pub fn of(segments: &[Segment], joints: &[ArmJoint], links: &[Link], bodies: &[Body]) -> Self {
        let mut way = vec![0.0; segments.len()];
        let mut next = vec![0.0_f64; segments.len()];
        let mut carries = vec![false; segments.len()];
        for (index, segment) in segments.iter().enumerate() {
            if let Some(parent) = segment.parent {
                let step = segment.offset.norm();
                way[index] = way[parent] + step;
                next[parent] = next[parent].max(step);
                carries[parent] = true;
            }
        }
        let mut reach = 0.0_f64;
        for (link, body) in links.iter().zip(bodies) {
            if let Some(segment) = link.segment {
                let center = (link.frame * nalgebra::Point3::from(body.center)).coords;
                let own = link.frame.translation.vector.norm();
                let own = if body.mass > 0.0 {
                    own.max(center.norm())
                } else {
                    own
                };
                reach = reach.max(way[segment] + own);
            }
        }
        let massless = segments.iter().enumerate();
        let massless = massless
            .filter(|(index, segment)| segment.mass == 0.0 && next[*index] > PART)
            .map(|(_, segment)| segment.joint_name.clone());
        let base_mass: f64 = links
            .iter()
            .filter(|link| link.segment.is_none())
            .map(|link| link.mass)
            .sum();
        let wheels = if base_mass > 0.0 {
            wheels(segments, joints, &carries)
        } else {
            Vec::new()
        };
        Self {
            reach,
            massless: massless.collect(),
            wheels,
            floors: floors(segments, joints),
            largest_own: Vec::new(),
        }
    }
}

fn range(segment: &Segment, joints: &[ArmJoint]) -> f64 {
    let [low, high] = segment.own_limits.unwrap_or(joints[segment.source].limits);
    high - low
}

/// Names of the joints of the largest group of wheels, if it has two or more.
fn wheels(segments: &[Segment], joints: &[ArmJoint], carries: &[bool]) -> Vec<String> {
    let mut turns: Vec<Matrix3<f64>> = Vec::with_capacity(segments.len());
    let mut found: Vec<(Vector3<f64>, &str)> = Vec::new();
    for (segment, carries) in segments.iter().zip(carries) {
        let turn = segment
            .parent
            .map_or(segment.rotation, |parent| turns[parent] * segment.rotation);
        let endless = range(segment, joints).is_infinite();
        if segment.kind == JointKind::Turning && endless && !carries && segment.parent.is_none() {
            found.push((turn.column(2).into(), &segment.joint_name));
        }
        turns.push(turn);
    }
    let group = |axis: &Vector3<f64>| -> Vec<String> {
        let parallel = found
            .iter()
            .filter(|(other, _)| axis.dot(other).abs() > PARALLEL);
        parallel.map(|(_, name)| (*name).to_owned()).collect()
    };
    let largest = found
        .iter()
        .map(|(axis, _)| group(axis))
        .max_by_key(Vec::len);
    largest.filter(|names| names.len() > 1).unwrap_or_default()
}

fn floors(segments: &[Segment], joints: &[ArmJoint]) -> Vec<String> {
    let mut on_floor = vec![false; segments.len()];
    let mut found = Vec::new();
    for (index, segment) in segments.iter().enumerate() {
        let rooted = segment.parent.is_none_or(|parent| on_floor[parent]);
        if rooted && segment.kind == JointKind::Sliding && range(segment, joints) > FLOOR {
            on_floor[index] = true;
            found.push(segment.joint_name.clone());
        }
    }
    found
}
