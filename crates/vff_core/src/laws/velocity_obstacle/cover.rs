//! Parts of lines that one obstacle forbids all by itself.

use super::{Cone, Vector};
use crate::laws::planning::outline::Legs;

/// How far within a cone a velocity is at least, relative to 1 m/s and its magnitude: well above all
/// roundings.
const WITHIN: f64 = 1e-6;

/// Share of the horizon within which the contact is at least.
const SOON: f64 = 0.9;

/// The cone of a disc, the nearest one first: it forbids most.
#[derive(Clone, Copy, Debug)]
struct Cover {
    distance_squared: f64,
    legs: Legs,
    velocity: Vector,
    /// Its place among all cones.
    index: usize,
}

/// Cones of the discs that are not touched.
#[derive(Clone, Debug, Default)]
pub(super) struct Covers {
    discs: Vec<Cover>,
}

impl Covers {
    /// Takes the cones of another instant.
    pub fn take(&mut self, cones: &[Cone]) {
        let cover = |(index, cone): (usize, &Cone)| {
            let (center, legs) = (cone.outline.center()?, cone.legs?);
            Some(Cover {
                distance_squared: center.dot(&center),
                legs,
                velocity: cone.outline.velocity,
                index,
            })
        };
        self.discs.clear();
        let discs = cones.iter().enumerate().filter_map(cover);
        self.discs.extend(discs);
        let nearer = |one: &Cover, other: &Cover| {
            let distances = one.distance_squared.total_cmp(&other.distance_squared);
            distances.then(one.index.cmp(&other.index))
        };
        self.discs.sort_unstable_by(nearer);
    }

    /// Whether one of the discs forbids everything between two velocities, and what is as near to that
    /// as roundings are: what a disc forbids is convex.
    pub fn cover(&self, cones: &[Cone], ends: [Vector; 2], horizon: f64) -> bool {
        self.discs.iter().any(|disc| {
            ends.iter().all(|end| disc.holds(*end))
                && (horizon == f64::INFINITY || {
                    let soon =
                        |end: &Vector| cones[disc.index].time_to_contact(*end) <= SOON * horizon;
                    ends.iter().all(soon)
                })
        })
    }
}

impl Cover {
    #[inline]
    fn holds(&self, velocity: Vector) -> bool {
        let relative = velocity - self.velocity;
        let within = WITHIN * (1.0 + relative.x.abs() + relative.y.abs());
        self.legs.left.perp(&relative) < -within && self.legs.right.perp(&relative) > within
    }
}
