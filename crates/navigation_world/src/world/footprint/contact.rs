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

/// Bodies touch at this distance, in m.
pub const TOUCH: f64 = 1e-9;

/// Least share of a step between two looks: what bodies that slide along each other overlap less than they move in it is
/// no contact.
const LEAST_SHARE: f64 = 1.0 / 65536.0;

/// First share of a step at which a gap in m is closed, if it is; it changes at most by `most` in the step, in m.
pub fn first_closed(most: f64, gap: impl Fn(f64) -> f64) -> Option<f64> {
    let mut share = 0.0;
    loop {
        let left = gap(share);
        if left <= TOUCH {
            return Some(share);
        }
        if share >= 1.0 || left > most * (1.0 - share) {
            return None;
        }
        share = (share + (left / most).max(LEAST_SHARE)).min(1.0);
    }
}

/// The least angle from one heading to another in rad.
#[must_use]
pub fn turned([from, to]: [f64; 2]) -> f64 {
    let turn = (to - from).rem_euclid(std::f64::consts::TAU);
    if turn > std::f64::consts::PI {
        turn - std::f64::consts::TAU
    } else {
        turn
    }
}

/// A point of a side that moves along it moves toward nobody: what rounding adds to that, as a share of its speed.
const ALONG: f64 = 1e-9;

impl Separation {
    /// Speed of the touching point of a body that moves, and its part toward the other one, in m/s.
    #[must_use]
    pub fn speeds(&self, motion: &super::BodyMotion) -> [f64; 2] {
        let velocity = motion.at(self.place);
        let (speed, toward) = (velocity.norm(), velocity.dot(&self.outward));
        let along = toward.abs() <= ALONG * speed;
        [speed, if along { 0.0 } else { toward }]
    }
}

/// Way of a body past a robot in a step in which both move straight and the robot turns evenly.
#[derive(Clone, Copy, Debug)]
pub struct PassingWay {
    /// From the robot to the center of the body at both ends of the step, in m.
    pub offsets: [Vector2<f64>; 2],
    /// Headings of the robot at both ends, in rad.
    pub headings: [f64; 2],
    /// Outline of the other body; a disc or a rectangle that keeps its heading.
    pub shape: Shape,
}

/// A contact in a step.
#[derive(Clone, Copy, Debug)]
pub struct PassingContact {
    /// Shares of the step at which it begins, and at which it ends or the bodies first overlap deeply.
    pub shares: [f64; 2],
    /// Whether they do.
    pub deep: bool,
    /// Touching points then: speed and its part toward the body, in m/s.
    pub speeds: [[f64; 2]; 2],
}

/// Looks at a step in which bodies are near.
const LOOKS: u32 = 64;

impl PassingWay {
    fn at(&self, outline: &Footprint, share: f64) -> (Frame, Separation) {
        let [from, to] = self.offsets;
        let heading = self.headings[0] + turned(self.headings) * share;
        let frame = Frame::at([0.0; 2], heading);
        let other = PlacedShape {
            center: from + (to - from) * share,
            shape: self.shape,
        };
        (frame, outline.separation(&frame, &other))
    }

    /// Distance of the surfaces at a share of the step in m; negative where they overlap.
    #[must_use]
    pub fn gap(&self, outline: &Footprint, share: f64) -> f64 {
        self.at(outline, share).1.distance
    }

    /// Most that the gap changes in the step, in m.
    fn most(&self, outline: &Footprint) -> f64 {
        let [from, to] = self.offsets;
        (to - from).norm() + turned(self.headings).abs() * outline.outer_radius()
    }

    fn looks(first: f64) -> impl DoubleEndedIterator<Item = f64> {
        (0..=LOOKS).map(move |look| first + (1.0 - first) * f64::from(look) / f64::from(LOOKS))
    }

    /// Least distance of the surfaces in the step in m; negative where they overlap.
    #[must_use]
    pub fn least(&self, outline: &Footprint) -> f64 {
        let ends = [0.0, 1.0].map(|share| self.gap(outline, share));
        let (near, most) = (ends[0].min(ends[1]), self.most(outline));
        // Nothing between is nearer than this; who is that far off need not be looked at.
        if near - 0.5 * most > 1.0 {
            return near - 0.5 * most;
        }
        let gaps = Self::looks(0.0).map(|share| self.gap(outline, share));
        let least = gaps.fold(near, f64::min) - 0.5 * most / f64::from(LOOKS);
        if least > 0.0 || first_closed(most, |share| self.gap(outline, share)).is_some() {
            least
        } else {
            least.max(0.0)
        }
    }

    /// Speed of the nearest point of a robot that moves at a velocity in m/s in a step of `duration` s at a share of it, and
    /// its part toward the body, in m/s.
    #[must_use]
    pub fn speeds(
        &self,
        outline: &Footprint,
        (velocity, duration): (Vector2<f64>, f64),
        share: f64,
    ) -> [f64; 2] {
        let (frame, found) = self.at(outline, share);
        found.speeds(&super::BodyMotion {
            velocity: frame.inward(velocity),
            turn_rate: turned(self.headings) / duration,
        })
    }

    /// The contact of the step with a robot that moves at a velocity in m/s in a step of `duration` s, if there is one;
    /// deep is an overlap of `depth` m.
    #[must_use]
    pub fn contact(
        &self,
        outline: &Footprint,
        (velocity, duration): (Vector2<f64>, f64),
        depth: f64,
    ) -> Option<PassingContact> {
        let gap = |share: f64| self.gap(outline, share);
        let begin = first_closed(self.most(outline), gap)?;
        let decided = Self::looks(begin).find(|share| gap(*share) <= -depth);
        let last = Self::looks(begin).rev().find(|share| gap(*share) <= TOUCH);
        let end = decided.or(last).unwrap_or(begin);
        let speeds = [begin, end].map(|share| self.speeds(outline, (velocity, duration), share));
        Some(PassingContact {
            shares: [begin, end],
            deep: decided.is_some(),
            speeds,
        })
    }
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
