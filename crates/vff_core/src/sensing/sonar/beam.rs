//! Beam of an ultrasonic sensor: a fan of rays.

use nalgebra::Vector2;

use crate::error::{Failure, Given, Result};
use crate::world::frame::Frame;
use crate::world::shape::PlacedShape;
use numeric::error::at_most;

/// Most rays of a beam.
pub const MOST_RAYS: usize = 100_000;

/// Rays evenly spread over the width of a beam; a single ray lies on its axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Beam {
    /// Full angle, in rad.
    width: f64,
    /// Unit vectors of the rays from right to left, x along the axis.
    rays: Vec<Vector2<f64>>,
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

    /// As `nearest`, of one shape; may be farther than the reach.
    #[inline]
    fn nearest_of(&self, pose: &Frame, shape: &PlacedShape, reach: f64) -> f64 {
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
            let right = self.rays.partition_point(|ray| ray.perp(&to) > 0.0);
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
