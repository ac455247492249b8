//! Beam of an ultrasonic sensor: a fan of rays.

use nalgebra::Vector2;

use crate::world::frame::Frame;
use crate::world::shape::PlacedShape;
use numeric::error::at_most;
use numeric::error::{Failure, Given, Result};

/// Most rays of a beam.
pub const MOST_RAYS: usize = 100_000;

/// Rays per rad from which on a search by halves is faster than a guess.
const MOST_PER_ANGLE: f64 = 400.0;

/// Rays evenly spread over the width of a beam; a single ray lies on its axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Beam {
    /// Full angle, in rad.
    width: f64,
    /// Unit vectors of the rays from right to left, x along the axis.
    rays: Vec<Vector2<f64>>,
    /// Rays per rad, about, and the place of the axis among them, for a first look.
    per_angle: f64,
    middle: f64,
    /// Normals of the right and the left edge, outward.
    edges: [Vector2<f64>; 2],
}

impl Beam {
    /// A beam of a full angle in rad, up to pi.
    ///
    /// # Errors
    /// The width is not from 0 to pi, or there is no ray.
    pub fn new(width: f64, rays: usize) -> Result<Self> {
        if !(0.0..=std::f64::consts::PI).contains(&width) {
            let rule = "be an angle from 0 to pi";
            return Err(Failure::invalid("beam_width", rule, Given::Number(width)));
        }
        if rays == 0 {
            let rule = "be at least 1";
            return Err(Failure::invalid("rays", rule, Given::Count(0)));
        }
        at_most("rays", rays, MOST_RAYS)?;
        let gaps = (rays - 1) as f64;
        let ray = |index: usize| {
            // Twice the offset from the middle is a whole number: left and right are mirrored.
            let share = if rays == 1 {
                0.0
            } else {
                (2.0 * index as f64 - gaps) / gaps
            };
            let (sin, cos) = (0.5 * width * share).sin_cos();
            Vector2::new(cos, sin)
        };
        let (sin, cos) = (0.5 * width).sin_cos();
        Ok(Self {
            width,
            rays: (0..rays).map(ray).collect(),
            per_angle: if width > 0.0 {
                gaps / width
            } else {
                f64::INFINITY
            },
            middle: 0.5 * gaps + 1.0,
            edges: [Vector2::new(-sin, -cos), Vector2::new(-sin, cos)],
        })
    }

    /// Full angle, in rad.
    #[must_use]
    pub fn width(&self) -> f64 {
        self.width
    }

    /// Unit vectors of the rays from right to left, x along the axis.
    #[must_use]
    pub fn rays(&self) -> &[Vector2<f64>] {
        &self.rays
    }

    /// Distance along every ray, in m; infinite where nothing is met.
    #[must_use]
    pub fn every_ray(&self, pose: &Frame, shapes: &[PlacedShape]) -> Vec<f64> {
        let along = |ray: &Vector2<f64>| {
            let direction = pose.outward(*ray);
            shapes
                .iter()
                .map(|shape| shape.cast(pose.position, direction))
                .fold(f64::INFINITY, f64::min)
        };
        self.rays.iter().map(along).collect()
    }

    /// Shortest distance along the rays up to a reach, in m; infinite when nothing is met.
    ///
    /// The distance along a ray to a convex shape grows from its nearest point to either side, so
    /// only the two rays beside that point are cast, none at all if it is out of reach or outside
    /// the edges of the beam.
    #[inline]
    #[must_use]
    pub fn nearest(&self, pose: &Frame, shapes: &[PlacedShape], reach: f64) -> f64 {
        let mut least = reach;
        let mut found = f64::INFINITY;
        if shapes.is_empty() {
            return found;
        }
        let edges = self.edges.map(|edge| pose.outward(edge));
        for shape in shapes {
            if edges.iter().any(|edge| shape.beyond(pose.position, *edge)) {
                continue;
            }
            let distance = self.nearest_of(pose, shape, least);
            if distance <= least {
                least = distance;
                found = distance;
            }
        }
        found
    }

    /// Rays to the right of a vector with its x to the front.
    #[inline]
    fn right_of(&self, to: Vector2<f64>) -> usize {
        let beside = |ray: &Vector2<f64>| ray.perp(&to) > 0.0;
        if to.y.abs() > to.x || self.per_angle > MOST_PER_ANGLE {
            return self.rays.partition_point(beside);
        }
        // An arc tangent within 0.005 rad, and a step or two to what a search by halves would find.
        let angle = to.y * to.x / (to.x * to.x + 0.28 * to.y * to.y);
        let place = angle * self.per_angle + self.middle;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates
        let mut index = (place as usize).min(self.rays.len());
        while index > 0 && !beside(&self.rays[index - 1]) {
            index -= 1;
        }
        while index < self.rays.len() && beside(&self.rays[index]) {
            index += 1;
        }
        index
    }

    /// Distance like `nearest`, to one shape; may be farther than the reach.
    #[inline]
    fn nearest_of(&self, pose: &Frame, shape: &PlacedShape, reach: f64) -> f64 {
        if shape.out_of_reach(pose.position, reach) {
            return f64::INFINITY;
        }
        let to = shape.nearest(pose.position);
        let square = to.dot(&to);
        if square > reach * reach {
            return f64::INFINITY;
        }
        if square == 0.0 {
            return 0.0;
        }
        let to = pose.inward(to);
        let cast = |ray: &Vector2<f64>| shape.cast(pose.position, pose.outward(*ray));
        let beside = if to.x > 0.0 {
            let right = self.right_of(to);
            [right.checked_sub(1), Some(right)]
        } else {
            // Behind the sensor either edge may be the nearer one.
            [Some(0), Some(self.rays.len() - 1)]
        };
        beside
            .into_iter()
            .flatten()
            .filter_map(|index| self.rays.get(index))
            .map(cast)
            .fold(f64::INFINITY, f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_guess_finds_the_ray_that_halving_finds() {
        let widths = [0.0, 1e-3, 0.26, 0.5, 1.2, 2.0, 3.0, std::f64::consts::PI];
        for (width, rays) in widths
            .into_iter()
            .flat_map(|width| [1, 2, 3, 12, 13, 101, 900].map(|rays| (width, rays)))
        {
            let beam = Beam::new(width, rays).unwrap();
            let toward = (0..4001).map(|step| f64::from(step - 2000) * 7.85e-4);
            let along = beam.rays().iter().map(|ray| ray.y.atan2(ray.x));
            for angle in toward.chain(along) {
                let to = Vector2::new(angle.cos(), angle.sin()) * 0.7;
                if to.x > 0.0 {
                    let halved = beam.rays.partition_point(|ray| ray.perp(&to) > 0.0);
                    assert_eq!(beam.right_of(to), halved, "{width} {rays} {angle}");
                }
            }
        }
    }
}
