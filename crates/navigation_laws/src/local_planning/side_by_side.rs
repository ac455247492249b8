//! Gaps of places side by side, for laws that try many motions.

use super::{Gaps, PeopleMotion};
use navigation_world::world::shape::Shape;
use numeric::lanes::{LaneMask, Lanes, Mask, Number, Planar, Real, Truth, Vector2};

/// Places side by side.
pub(crate) const WIDTH: usize = 8;
pub(crate) type Each = Lanes<WIDTH>;
pub(crate) type EachVector = Vector2<Each>;
type EachTruth = LaneMask<WIDTH>;

/// A rectangle in every lane.
struct WideShape {
    shape: Shape<Each>,
    center: EachVector,
    velocity: EachVector,
}

/// A person in every lane.
struct WidePerson {
    position: EachVector,
    velocity: EachVector,
    radius: f64,
}

/// Gaps to people and walls in every lane.
pub(crate) struct LaneGaps<'a> {
    gaps: &'a Gaps<'a>,
    people: Vec<WidePerson>,
    shapes: Vec<WideShape>,
    moving: bool,
    most: Each,
    radius: Each,
}

impl<'a> LaneGaps<'a> {
    /// Gaps with what people are taken to do; all that is at least so many m away counts as that far.
    pub fn new(gaps: &'a Gaps<'a>, prediction: PeopleMotion, most: f64) -> Self {
        let wide = |vector: Vector2<f64>| EachVector::splat(vector.into());
        let people = gaps.people.iter().map(|person| WidePerson {
            position: wide(person.position),
            velocity: wide(person.velocity),
            radius: person.radius,
        });
        let mut people: Vec<WidePerson> = people.collect();
        people.sort_by(|one, other| one.radius.total_cmp(&other.radius));
        let shapes = gaps.walls.shapes.iter().map(|wall| {
            let mut shape = Shape::Disc {
                radius: Each::splat(0.0),
            };
            for lane in 0..WIDTH {
                shape.set_lane(lane, &wall.placed.shape);
            }
            WideShape {
                shape,
                center: wide(wall.placed.center),
                velocity: wide(wall.velocity),
            }
        });
        Self {
            gaps,
            people,
            shapes: shapes.collect(),
            moving: prediction == PeopleMotion::ConstantVelocity,
            most: Each::splat(most + gaps.radius),
            radius: Each::splat(gaps.radius),
        }
    }

    /// The gaps of places at times in s; in lanes that are not asked for they may be larger.
    #[inline(always)]
    pub fn at(&self, places: EachVector, times: Each, asked: EachTruth) -> Each {
        let mut least = self.most;
        let beyond = Each::splat(f64::INFINITY);
        // Of people with the same radius the nearest counts: one root for all of them, and one for all walls.
        for alike in self
            .people
            .chunk_by(|one, other| one.radius == other.radius)
        {
            let mut squared = beyond;
            for person in alike {
                let mut to = places - person.position;
                if self.moving {
                    to -= person.velocity * times;
                }
                squared = to.dot(&to).min(squared);
            }
            least = (squared.sqrt() - Each::splat(alike[0].radius)).min(least);
        }
        let mut squared = beyond;
        for wall in &self.shapes {
            let mut to = places - wall.center;
            if self.moving {
                to -= wall.velocity * times;
            }
            let off = wall.shape.offset(to);
            squared = off.dot(&off).min(squared);
        }
        least = squared.sqrt().min(least);
        if let Some(map) = self.gaps.walls.map {
            for lane in 0..WIDTH {
                if asked.lane(lane) {
                    let known = least.lane(lane);
                    let place = Vector2::from(places.lane(lane));
                    least.set(lane, known.min(map.clearance_up_to(place, known.max(0.0))));
                }
            }
        }
        least - self.radius
    }
}

/// All lanes, or none.
#[inline(always)]
pub(crate) fn all(truth: bool) -> EachTruth {
    EachTruth::splat(truth)
}
