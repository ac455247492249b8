//! Outlines that the center of a robot keeps out of: obstacles grown by the robot's radius.

use navigation_world::world::geometry::Body;
use navigation_world::world::obstacle::Shape;
use numeric::lanes::{Planar, Real, Vector2};

type Vector = Vector2<f64>;

/// Directions closer to a line than this, as a sine, count as on it.
const STRAIGHT: f64 = 1e-12;

/// A convex set around corners, rounded by a radius, relative to the robot.
#[derive(Clone, Copy, Debug)]
pub struct Outline {
    corners: [Vector; 4],
    count: usize,
    /// Radius of the rounding: robot, obstacle and margin, in m.
    pub radius: f64,
    /// Velocity in m/s.
    pub velocity: Vector,
}

/// The two rays from the robot that just touch an outline.
#[derive(Clone, Copy, Debug)]
pub struct Legs<R = f64> {
    /// Direction of the ray on the left, of length 1.
    pub left: Vector2<R>,
    /// Direction of the ray on the right, of length 1.
    pub right: Vector2<R>,
    /// Distance of the touching point along the left ray, in m.
    pub left_reach: R,
    /// Distance of the touching point along the right ray, in m.
    pub right_reach: R,
}

impl Outline {
    /// Outline of an obstacle seen from a position.
    #[must_use]
    pub fn new(body: &Body, position: Vector, robot_radius: f64, margin: f64) -> Self {
        let center = Vector::splat(body.state.position) - position;
        let velocity = Vector::splat(body.state.velocity);
        let grown = robot_radius + margin;
        match body.shape {
            Shape::Disc { radius } => Self::disc(center, grown + radius, velocity),
            Shape::Rectangle {
                half_length,
                half_width,
                axis,
            } => {
                let along = axis * half_length;
                let across = axis.left_normal() * half_width;
                let corners = [
                    center + along + across,
                    center - along + across,
                    center - along - across,
                    center + along - across,
                ];
                Self {
                    corners,
                    count: 4,
                    radius: grown,
                    velocity,
                }
            }
        }
    }

    /// A disc.
    #[must_use]
    pub fn disc(center: Vector, radius: f64, velocity: Vector) -> Self {
        Self {
            corners: [center; 4],
            count: 1,
            radius,
            velocity,
        }
    }

    /// Outline relative to a robot that has moved.
    #[must_use]
    pub fn seen_after(mut self, way: Vector) -> Self {
        for corner in &mut self.corners {
            *corner -= way;
        }
        self
    }

    /// Outline at another scale.
    #[must_use]
    pub fn scaled(mut self, factor: f64) -> Self {
        for corner in &mut self.corners {
            *corner *= factor;
        }
        self.radius *= factor;
        self
    }

    /// Center of a disc; `None` for an outline with edges.
    #[inline]
    #[must_use]
    pub fn center(&self) -> Option<Vector> {
        (self.count == 1).then_some(self.corners[0])
    }

    /// Corners, counter-clockwise.
    #[must_use]
    pub fn corners(&self) -> &[Vector] {
        &self.corners[..self.count]
    }

    /// Edges, counter-clockwise; none for a disc.
    fn edges(&self) -> impl Iterator<Item = (Vector, Vector)> + '_ {
        let count = if self.count == 1 { 0 } else { self.count };
        (0..count).map(|index| (self.corners[index], self.corners[(index + 1) % self.count]))
    }

    /// Point of the set without its rounding that is nearest to a place, and whether the place
    /// lies within that set.
    #[must_use]
    pub fn nearest(&self, place: Vector) -> (Vector, bool) {
        let mut inside = self.count > 1;
        let mut best = (f64::INFINITY, self.corners[0]);
        for (from, to) in self.edges() {
            let (edge, offset) = (to - from, place - from);
            inside &= edge.perp(&offset) >= 0.0;
            let share = (offset.dot(&edge) / edge.dot(&edge)).clamp(0.0, 1.0);
            let point = from + edge * share;
            let gap = (place - point).dot(&(place - point));
            if gap < best.0 {
                best = (gap, point);
            }
        }
        (best.1, inside)
    }

    /// Whether the robot touches it or is inside.
    #[must_use]
    pub fn touches(&self) -> bool {
        let (point, inside) = self.nearest(Vector::zeros());
        inside || touches(point, self.radius)
    }

    /// Rays that just touch it; none from inside.
    #[must_use]
    pub fn legs(&self) -> Option<Legs> {
        if self.touches() {
            return None;
        }
        let mut legs: Option<Legs> = None;
        for &corner in self.corners() {
            let own = Legs::of_disc(corner, self.radius);
            let (left, right, reach) = (own.left, own.right, own.left_reach);
            let Some(known) = &mut legs else {
                legs = Some(own);
                continue;
            };
            if known.left.perp(&left) > 0.0 {
                (known.left, known.left_reach) = (left, reach);
            }
            if known.right.perp(&right) < 0.0 {
                (known.right, known.right_reach) = (right, reach);
            }
        }
        legs
    }

    /// Time in s until a robot at a constant relative velocity touches it; infinite if never, 0
    /// if it is touched already and the robot does not leave.
    #[must_use]
    pub fn time_to_contact(&self, relative: Vector) -> f64 {
        if self.touches() {
            let (point, inside) = self.nearest(Vector::zeros());
            let leaving = !inside && point.dot(&relative) <= 0.0;
            return if leaving { f64::INFINITY } else { 0.0 };
        }
        let mut time = f64::INFINITY;
        for &corner in self.corners() {
            time = time.min(entry(corner, self.radius, relative));
        }
        for (from, to) in self.edges() {
            let edge = to - from;
            let length = edge.dot(&edge).sqrt();
            // Outward normal of a counter-clockwise edge, and the edge moved out by the radius.
            let normal = -edge.left_normal() * (1.0 / length);
            let approach = normal.dot(&relative);
            if approach >= 0.0 {
                continue;
            }
            let until = (normal.dot(&from) + self.radius) / approach;
            let along = edge.dot(&(relative * until - from)) / length;
            if until >= 0.0 && (0.0..=length).contains(&along) {
                time = time.min(until);
            }
        }
        time
    }

    /// Whether a robot at a constant relative velocity never touches it.
    #[must_use]
    pub fn missed_by(&self, relative: Vector) -> bool {
        match self.legs() {
            Some(legs) => !legs.hold(relative),
            None => self.time_to_contact(relative) > 0.0,
        }
    }
}

impl<R: Real> Legs<R> {
    /// Rays that touch a disc, from outside of it.
    #[inline(always)]
    #[must_use]
    pub fn of_disc(center: Vector2<R>, radius: R) -> Self {
        let square = center.dot(&center);
        let reach = (square - radius * radius).sqrt();
        let turned = |sine: R| {
            Vector2::new(
                (center.x * reach - center.y * sine) / square,
                (center.y * reach + center.x * sine) / square,
            )
        };
        Self {
            left: turned(radius),
            right: turned(-radius),
            left_reach: reach,
            right_reach: reach,
        }
    }
}

impl Legs {
    /// Whether a direction may lie between the rays; where it does not, [`Self::hold`] says so, too.
    #[inline]
    #[must_use]
    pub fn may_hold(&self, direction: Vector) -> bool {
        self.left.perp(&direction) < 0.0 && self.right.perp(&direction) > 0.0
    }

    /// Whether a direction lies between the rays; the rays themselves touch and do not count.
    #[must_use]
    pub fn hold(&self, direction: Vector) -> bool {
        let slack = STRAIGHT * direction.dot(&direction).sqrt();
        self.left.perp(&direction) < -slack && self.right.perp(&direction) > slack
    }
}

/// Whether a point at the origin touches a disc or is inside.
#[inline]
fn touches(center: Vector, radius: f64) -> bool {
    center.dot(&center) <= radius * radius
}

/// Time at which a point that starts at the origin enters a disc that it is not in.
pub(crate) fn entry(center: Vector, radius: f64, velocity: Vector) -> f64 {
    let approach = center.dot(&velocity);
    let square = velocity.dot(&velocity);
    let gap = center.dot(&center) - radius * radius;
    let discriminant = approach * approach - square * gap;
    if approach <= 0.0 || discriminant < 0.0 {
        return f64::INFINITY;
    }
    // The smaller root, in the form without cancellation.
    (gap / (approach + discriminant.sqrt())).max(0.0)
}
