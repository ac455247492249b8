//! Gaps of places side by side, for laws that try many motions.

use super::{Gaps, PeopleMotion};
use navigation_world::world::map::{Capsule, StaticMap};
use navigation_world::world::shape::Shape;
use numeric::lanes::{LaneMask, Lanes, Mask, Number, Planar, Real, Truth, Vector2};

/// Places side by side.
pub(crate) const WIDTH: usize = 8;
pub(crate) type Each = Lanes<WIDTH>;
pub(crate) type EachVector = Vector2<Each>;
type EachTruth = LaneMask<WIDTH>;

/// Most walls of a map that are looked at one after the other for all lanes, instead of for each lane in its index.
const MOST_WALLS: usize = 16;

/// A wall without a radius in every lane.
struct WideWall {
    from: EachVector,
    to: EachVector,
    along: EachVector,
    /// Square of its length in m^2.
    square: Each,
}

impl WideWall {
    fn of(wall: &Capsule) -> Self {
        let along = wall.to - wall.from;
        Self {
            from: EachVector::splat(wall.from.into()),
            to: EachVector::splat(wall.to.into()),
            along: EachVector::splat(along.into()),
            square: Each::splat(along.dot(&along)),
        }
    }

    /// Way from its nearest point to places.
    #[inline(always)]
    fn off(&self, places: EachVector) -> EachVector {
        let share = (places - self.from).dot(&self.along) / self.square;
        let share = share.max(Each::splat(0.0));
        // The end itself, not a number close to it.
        let inner = self.from + self.along * share;
        places - EachVector::select(share.ge(Each::splat(1.0)), self.to, inner)
    }
}

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
    /// Walls of the map, if it holds nothing else and few of them.
    walls: Option<Vec<WideWall>>,
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
            walls: gaps.walls.map.and_then(few_walls),
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
        for wall in self.walls.iter().flatten() {
            let off = wall.off(places);
            squared = off.dot(&off).min(squared);
        }
        least = squared.sqrt().min(least);
        if let Some(map) = self.gaps.walls.map.filter(|_| self.walls.is_none()) {
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

/// The walls of a map that holds nothing else and few of them.
fn few_walls(map: &StaticMap) -> Option<Vec<WideWall>> {
    let walls = map.bare_walls().filter(|walls| walls.len() <= MOST_WALLS)?;
    Some(walls.iter().map(WideWall::of).collect())
}

/// All lanes, or none.
#[inline(always)]
pub(crate) fn all(truth: bool) -> EachTruth {
    EachTruth::splat(truth)
}

#[cfg(test)]
mod tests {
    use super::*;
    use navigation_world::world::map::MapShapes;

    #[test]
    fn walls_side_by_side_are_as_far_as_one_after_the_other() {
        let mut shapes = MapShapes::new();
        let corner = [[0.0, 0.0], [2.0, 0.3], [2.0, 1.7], [-0.4, 3.1]];
        shapes.polyline(&corner, 0.0).unwrap();
        let map = shapes.map();
        let gaps = Gaps {
            radius: 0.25,
            people: &[],
            walls: crate::local_planning::Walls {
                shapes: &[],
                map: Some(&map),
            },
        };
        let prediction = PeopleMotion::Static;
        let wide = LaneGaps::new(&gaps, prediction, f64::INFINITY);
        assert!(wide.walls.is_some());
        for step in 0..200_u32 {
            let along = 0.03 * f64::from(step) - 1.5;
            let place = |lane: usize| Vector2::new(along, 0.7 * lane as f64 - 1.2 + 0.2 * along);
            let places = EachVector::new(
                Each::from_fn(|lane| place(lane).x),
                Each::from_fn(|lane| place(lane).y),
            );
            let found = wide.at(places, Each::splat(0.0), all(true));
            for lane in 0..WIDTH {
                let alone = gaps.at(place(lane), 0.0, prediction);
                assert_eq!(found.lane(lane).to_bits(), alone.to_bits());
            }
        }
    }

    #[test]
    fn a_map_of_anything_else_is_asked_for_each_lane() {
        let mut shapes = MapShapes::new();
        shapes.polyline(&[[0.0, 0.0], [2.0, 0.3]], 0.0).unwrap();
        shapes.disc([4.0, 0.0], 0.5).unwrap();
        assert!(few_walls(&shapes.map()).is_none());
    }
}
