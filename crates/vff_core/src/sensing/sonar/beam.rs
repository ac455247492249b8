//! Beam of an ultrasonic sensor: a fan of rays.

use crate::error::{Failure, Given, Result};
use crate::sensing::sonar::shapes::Shape;
use numeric::error::at_most;

/// Most rays of a beam.
pub const MOST_RAYS: usize = 100_000;

/// Where a sensor is, and where it looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Position, in m.
    pub position: [f64; 2],
    /// Unit vector of its axis.
    pub direction: [f64; 2],
}

impl Pose {
    /// At a position, with its axis at an angle in rad from x.
    #[must_use]
    pub fn at(position: [f64; 2], angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self {
            position,
            direction: [cos, sin],
        }
    }

    /// A vector given along and to the left of this axis.
    #[inline]
    #[must_use]
    pub fn outward(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [c, s] = self.direction;
        [c * x - s * y, s * x + c * y]
    }

    /// Components of a vector along and to the left of this axis.
    #[inline]
    #[must_use]
    pub fn inward(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [c, s] = self.direction;
        [c * x + s * y, c * y - s * x]
    }

    /// Pose of something that is mounted on this one.
    #[inline]
    #[must_use]
    pub fn carrying(&self, mounted: &Self) -> Self {
        let [x, y] = self.outward(mounted.position);
        Self {
            position: [self.position[0] + x, self.position[1] + y],
            direction: self.outward(mounted.direction),
        }
    }
}

/// Rays evenly spread over the width of a beam; a single ray lies on its axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Beam {
    /// Full angle, in rad.
    width: f64,
    /// Unit vectors of the rays from right to left, x along the axis.
    rays: Vec<[f64; 2]>,
    /// Normals of the right and the left edge, outward.
    edges: [[f64; 2]; 2],
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
            [cos, sin]
        };
        let (sin, cos) = (0.5 * width).sin_cos();
        Ok(Self {
            width,
            rays: (0..rays).map(ray).collect(),
            edges: [[-sin, -cos], [-sin, cos]],
        })
    }

    /// Full angle, in rad.
    #[must_use]
    pub fn width(&self) -> f64 {
        self.width
    }

    /// Unit vectors of the rays from right to left, x along the axis.
    #[must_use]
    pub fn rays(&self) -> &[[f64; 2]] {
        &self.rays
    }

    /// Distance along every ray, in m; infinite where nothing is met.
    #[must_use]
    pub fn every_ray(&self, pose: &Pose, shapes: &[Shape]) -> Vec<f64> {
        let along = |ray: &[f64; 2]| {
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
    pub fn nearest(&self, pose: &Pose, shapes: &[Shape], reach: f64) -> f64 {
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
    fn nearest_of(&self, pose: &Pose, shape: &Shape, reach: f64) -> f64 {
        let to = shape.nearest(pose.position);
        let square = to[0] * to[0] + to[1] * to[1];
        if square > reach * reach {
            return f64::INFINITY;
        }
        if square == 0.0 {
            return 0.0;
        }
        let to = pose.inward(to);
        let cast = |ray: &[f64; 2]| shape.cast(pose.position, pose.outward(*ray));
        let beside = if to[0] > 0.0 {
            let right = self
                .rays
                .partition_point(|ray| ray[0] * to[1] - ray[1] * to[0] > 0.0);
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
