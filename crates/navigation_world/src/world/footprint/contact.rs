//! Distances between an outline at a pose and what is around it, and where they touch.

use nalgebra::Vector2;

use super::sweep::from_segment;
use super::{Footprint, Side, Sweep};
use crate::world::frame::Frame;
use crate::world::map::StaticMap;
use crate::world::shape::{PlacedShape, Shape, into_axes, out_of_axes};

/// How an outline and a shape lie to each other, in coordinates of the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Separation {
    /// Distance of the surfaces in m; of bodies that overlap, minus the least way that parts them.
    pub distance: f64,
    /// Point of the outline that touches, or is nearest.
    pub place: Vector2<f64>,
    /// Unit vector outward from there, toward the shape.
    pub outward: Vector2<f64>,
}

impl Footprint {
    /// Of the outline at a pose and a shape.
    #[must_use]
    pub fn separation(&self, pose: &Frame, placed: &PlacedShape) -> Separation {
        let center = pose.inward(placed.center - pose.position);
        match placed.shape {
            Shape::Disc { radius } => {
                let of_center = self.separation_of_point(center);
                Separation {
                    distance: of_center.distance - radius,
                    ..of_center
                }
            }
            Shape::Rectangle {
                half_length,
                half_width,
                axis,
            } => self.separation_of_rectangle(center, [half_length, half_width], pose.inward(axis)),
        }
    }

    fn separation_of_point(&self, point: Vector2<f64>) -> Separation {
        let beyond = |side: &&Side| side.normal.dot(&(point - side.start));
        let Some(side) = self
            .sides
            .iter()
            .max_by(|one, other| beyond(one).total_cmp(&beyond(other)))
        else {
            return self.nowhere();
        };
        let within = beyond(&side);
        if within <= 0.0 {
            return Separation {
                distance: within,
                place: point - side.normal * within,
                outward: side.normal,
            };
        }
        let nearest = |side: &Side| {
            let share = (point - side.start)
                .dot(&side.along)
                .clamp(0.0, side.length);
            side.start + side.along * share
        };
        let outside = self.sides.iter().filter(|side| beyond(side) > 0.0);
        let places = outside.map(nearest);
        let near = places.min_by(|one, other| {
            (point - one)
                .norm_squared()
                .total_cmp(&(point - other).norm_squared())
        });
        let place = near.unwrap_or(point);
        let way = point - place;
        let distance = way.norm();
        Separation {
            distance,
            place,
            outward: if distance > 0.0 {
                way / distance
            } else {
                side.normal
            },
        }
    }

    fn separation_of_rectangle(
        &self,
        center: Vector2<f64>,
        half: [f64; 2],
        axis: Vector2<f64>,
    ) -> Separation {
        let corners = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]]
            .map(|[x, y]| center + out_of_axes(Vector2::new(x * half[0], y * half[1]), axis));
        let mut apart = self.nowhere();
        apart.distance = f64::NEG_INFINITY;
        // Along the normal of a side of either the gap is largest between convex bodies that overlap.
        for side in &self.sides {
            let beyond = |corner: &Vector2<f64>| side.normal.dot(&(corner - side.start));
            let gaps = corners.iter().map(|corner| (beyond(corner), *corner));
            let least = gaps.min_by(|one, other| one.0.total_cmp(&other.0));
            if let Some((gap, corner)) = least.filter(|(gap, _)| *gap > apart.distance) {
                apart = Separation {
                    distance: gap,
                    place: corner - side.normal * gap,
                    outward: side.normal,
                };
            }
        }
        for (along, reach) in [
            (Vector2::x(), half[0]),
            (-Vector2::x(), half[0]),
            (Vector2::y(), half[1]),
            (-Vector2::y(), half[1]),
        ] {
            let away = out_of_axes(along, axis);
            let beyond = |corner: &Vector2<f64>| away.dot(&(corner - center)) - reach;
            let gaps = self.corners.iter().map(|corner| (beyond(corner), *corner));
            let least = gaps.min_by(|one, other| one.0.total_cmp(&other.0));
            if let Some((gap, corner)) = least.filter(|(gap, _)| *gap > apart.distance) {
                apart = Separation {
                    distance: gap,
                    place: corner,
                    outward: -away,
                };
            }
        }
        if apart.distance <= 0.0 {
            return apart;
        }
        self.between(&corners, (center, half, axis))
    }

    /// Of the outline and a rectangle that do not overlap.
    fn between(
        &self,
        corners: &[Vector2<f64>; 4],
        (center, half, axis): (Vector2<f64>, [f64; 2], Vector2<f64>),
    ) -> Separation {
        let theirs = corners
            .iter()
            .map(|corner| self.separation_of_point(*corner));
        let own = self.corners.iter().map(|corner| {
            let local = into_axes(corner - center, axis);
            let nearest = Vector2::new(
                local.x.clamp(-half[0], half[0]),
                local.y.clamp(-half[1], half[1]),
            );
            let way = out_of_axes(nearest - local, axis);
            let distance = way.norm();
            Separation {
                distance,
                place: *corner,
                outward: way / distance.max(f64::MIN_POSITIVE),
            }
        });
        let least = theirs
            .chain(own)
            .min_by(|one, other| one.distance.total_cmp(&other.distance));
        least.unwrap_or_else(|| self.nowhere())
    }

    /// An outline always has sides; this is what one without would have.
    fn nowhere(&self) -> Separation {
        Separation {
            distance: f64::INFINITY,
            place: self.corners.first().copied().unwrap_or_default(),
            outward: Vector2::x(),
        }
    }

    /// Distance in m from a map at a pose, zero where they meet; all that is at least `most` away counts as that far.
    #[must_use]
    pub fn clearance(&self, pose: &Frame, map: &StaticMap, most: f64) -> f64 {
        if map.is_inside(pose.position) {
            return 0.0;
        }
        let around = self.outer_radius();
        let mut least = most;
        map.visit_near(pose.position, around + most, |capsule| {
            let ends = [capsule.from, capsule.to].map(|end| pose.inward(end - pose.position));
            if from_segment(Vector2::zeros(), ends) - capsule.radius - around < least {
                let distance = self.distance_from_segment(ends) - capsule.radius;
                least = least.min(distance.max(0.0));
            }
            around + least
        });
        least
    }

    /// Whether the outline stays at least so far from everything of a map while it moves from a pose, in m.
    #[must_use]
    pub fn keeps_off(&self, pose: &Frame, sweep: Sweep, map: &StaticMap, least: f64) -> bool {
        if map.is_inside(pose.position) {
            return false;
        }
        let mut keeps = true;
        let reach = self.outer_radius() + sweep.way.norm() + least.max(0.0);
        map.visit_near(pose.position, reach, |capsule| {
            let ends = [capsule.from, capsule.to].map(|end| pose.inward(end - pose.position));
            if from_segment(Vector2::zeros(), ends) - capsule.radius < reach {
                keeps &= self.swept_segment(ends, sweep) - capsule.radius >= least;
            }
            if keeps { reach } else { -1.0 }
        });
        keeps
    }

    /// Whether the outline stays at least so far from a shape that stands while it moves from a pose, in m.
    #[must_use]
    pub fn keeps_off_shape(
        &self,
        pose: &Frame,
        sweep: Sweep,
        placed: &PlacedShape,
        least: f64,
    ) -> bool {
        let inward = |place: Vector2<f64>| pose.inward(place - pose.position);
        if let Shape::Disc { radius } = placed.shape {
            return self.swept_point(inward(placed.center), sweep) - radius >= least;
        }
        if placed.distance(pose.position) == 0.0 {
            return false;
        }
        let [one, two, three, four] = placed.corners().map(inward);
        // The corners come crosswise.
        let sides = [[one, two], [two, four], [four, three], [three, one]];
        sides
            .iter()
            .all(|side| self.swept_segment(*side, sweep) >= least)
    }
}
