//! All obstacles of a scenario, and where they are many, what a look at all of them needs, side by side.

use std::ops::Deref;

use super::PlacedObstacle;
use crate::lanes::{Lanes, Number, Real, Vector2};
use crate::world::motion::Piece;

/// Obstacles that are looked at side by side.
pub(crate) const GROUP: usize = 4;
pub(crate) type Group = Lanes<GROUP>;

/// Fewest obstacles for which it pays to tell the far ones from the near ones.
const FEWEST: usize = 16;

/// Obstacles in their order.
#[derive(Clone, Debug, Default)]
pub(crate) struct Obstacles {
    all: Vec<PlacedObstacle>,
    /// Nothing where they are few.
    groups: Vec<ObstacleGroup>,
    stand_from: f64,
}

/// Obstacles side by side; behind the last one stand some that are nowhere.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ObstacleGroup {
    /// Motion of discs that are always present and move straight on, or stand: when it begins in s, the place then
    /// in m and the velocity in m/s. No numbers in place of others.
    start: Group,
    position: [Group; 2],
    pub velocity: [Group; 2],
    /// Radius of these discs in m.
    pub radius: Group,
    /// Distance at which the robot touches them, in m.
    pub reach: Group,
    /// Largest speed in m/s, infinite where there is none.
    pub speed: Group,
    /// No number of their contours at the start is larger, in m; infinite for those that come or go.
    pub size: Group,
}

impl Obstacles {
    /// What a look at all of them needs, side by side; nothing where they are few.
    pub fn groups(&self) -> &[ObstacleGroup] {
        &self.groups
    }

    /// Instant from which none of them moves any more, in s; infinite if there is none.
    pub fn stand_from(&self) -> f64 {
        self.stand_from
    }

    /// Distance at which the robot touches each of them, in m.
    pub fn reaches(&self) -> Vec<f64> {
        self.numbers(|group| group.reach, |placed| placed.contact_distance)
    }

    /// Largest speed of each in m/s, infinite if there is none.
    pub fn speed_bounds(&self) -> Vec<f64> {
        self.numbers(|group| group.speed, PlacedObstacle::fastest)
    }

    fn numbers(
        &self,
        of_group: fn(&ObstacleGroup) -> Group,
        of: fn(&PlacedObstacle) -> f64,
    ) -> Vec<f64> {
        if self.groups.is_empty() {
            return self.all.iter().map(of).collect();
        }
        let mut numbers = Vec::with_capacity(self.groups.len() * GROUP);
        for group in &self.groups {
            let group = of_group(group);
            let lanes: [f64; GROUP] = std::array::from_fn(|lane| group.lane(lane));
            numbers.extend_from_slice(&lanes);
        }
        numbers.truncate(self.all.len());
        numbers
    }

    /// The obstacles by themselves.
    pub fn into_vec(self) -> Vec<PlacedObstacle> {
        self.all
    }
}

impl From<Vec<PlacedObstacle>> for Obstacles {
    fn from(all: Vec<PlacedObstacle>) -> Self {
        let last =
            |time: f64, placed: &PlacedObstacle| time.max(placed.obstacle.motion.stands_from());
        let many = if all.len() < FEWEST {
            &[]
        } else {
            all.as_slice()
        };
        Self {
            groups: many.chunks(GROUP).map(ObstacleGroup::of).collect(),
            stand_from: all.iter().fold(0.0, last),
            all,
        }
    }
}

impl Extend<PlacedObstacle> for Obstacles {
    fn extend<T: IntoIterator<Item = PlacedObstacle>>(&mut self, more: T) {
        let mut all = std::mem::take(&mut self.all);
        all.extend(more);
        *self = all.into();
    }
}

impl Deref for Obstacles {
    type Target = [PlacedObstacle];

    fn deref(&self) -> &[PlacedObstacle] {
        &self.all
    }
}

impl<'a> IntoIterator for &'a Obstacles {
    type Item = &'a PlacedObstacle;
    type IntoIter = std::slice::Iter<'a, PlacedObstacle>;

    fn into_iter(self) -> Self::IntoIter {
        self.all.iter()
    }
}

impl PartialEq for Obstacles {
    /// All else follows from the obstacles.
    fn eq(&self, other: &Self) -> bool {
        self.all == other.all
    }
}

impl ObstacleGroup {
    fn of(placed: &[PlacedObstacle]) -> Self {
        let number = |padded: f64, of: &dyn Fn(&PlacedObstacle) -> f64| {
            Group::from_fn(|lane| placed.get(lane).map_or(padded, of))
        };
        let motion = |of: fn(&Piece) -> f64| {
            number(f64::NAN, &|placed| {
                placed.straight_disc().map_or(f64::NAN, of)
            })
        };
        Self {
            start: motion(|piece| piece.start),
            position: [
                motion(|piece| piece.position[0]),
                motion(|piece| piece.position[1]),
            ],
            velocity: [
                motion(|piece| piece.velocity[0]),
                motion(|piece| piece.velocity[1]),
            ],
            radius: number(0.0, &|placed| placed.obstacle.shape.inner_radius()),
            reach: number(0.0, &|placed| placed.contact_distance),
            speed: number(f64::INFINITY, &PlacedObstacle::fastest),
            size: number(0.0, &PlacedObstacle::size),
        }
    }

    /// Where they are at an instant in s.
    #[inline(always)]
    pub fn at(&self, time: Group) -> Vector2<Group> {
        let t = time - self.start;
        let [x, y] = self.position;
        let [u, v] = self.velocity;
        Vector2::new(x + u * t, y + v * t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robots::HolonomicRobot;
    use crate::world::motion::Motion;
    use crate::world::obstacle::{Limits, Obstacle};
    use crate::world::scenario::{Rules, Scenario};

    /// Discs that stand, walk, stop, speed up and come and go, and rectangles.
    fn obstacles(count: usize) -> Obstacles {
        let disc = |motion: Motion| Obstacle::disc(0.2, motion, Limits::default()).unwrap();
        let all = (0..count).map(|index| {
            let (start, velocity) = ([3.0 + index as f64, -2.0], [0.3, 0.1 * index as f64]);
            match index % 6 {
                0 => disc(Motion::at_rest(start)),
                1 => disc(Motion::between(start, velocity, [1.0, 2.0]).unwrap()),
                2 => disc(Motion::moving(start, velocity, [0.1, 0.0], None).unwrap()),
                3 => disc(Motion::recorded(&[0.0, 9.0], &[start, [50.0, 50.0]]).unwrap()),
                4 => Obstacle::rectangle(start, [0.4, 0.9], 0.3, Limits::default()).unwrap(),
                _ => disc(Motion::moving(start, velocity, [0.0; 2], None).unwrap()),
            }
        });
        let (robot, goal) = (HolonomicRobot::default(), [0.0, 90.0]);
        let rules = Rules::default();
        let scenario = Scenario::new(robot, [0.0; 2], goal, all.collect(), rules).unwrap();
        scenario.obstacles
    }

    #[test]
    fn what_is_side_by_side_is_what_the_obstacles_are_one_by_one() {
        let all = obstacles(21);
        assert_eq!(all.groups().len(), 6);
        let (reaches, speeds) = (all.reaches(), all.speed_bounds());
        assert_eq!([reaches.len(), speeds.len()], [21; 2]);
        for (index, placed) in all.iter().enumerate() {
            let (group, lane) = (&all.groups()[index / GROUP], index % GROUP);
            assert_eq!(reaches[index], placed.contact_distance);
            assert_eq!(speeds[index], placed.fastest());
            let comes_or_goes = index % 6 == 3;
            assert_eq!(group.size.lane(lane) == f64::INFINITY, comes_or_goes);
            let straight = matches!(index % 6, 0 | 5);
            let [x, y] = placed.obstacle.motion.at(2.7, &mut 0).position;
            let at = group.at(Group::splat(2.7));
            if straight {
                assert_eq!([at.x.lane(lane), at.y.lane(lane)], [x, y]);
            } else {
                assert!(at.x.lane(lane).is_nan() && at.y.lane(lane).is_nan());
            }
        }
        let padded = all.groups()[5].at(Group::splat(2.7));
        assert!((1..GROUP).all(|lane| padded.x.lane(lane).is_nan()));
    }

    #[test]
    fn obstacles_that_are_added_are_side_by_side_as_well() {
        let (mut some, more) = (obstacles(15), obstacles(17));
        assert!(some.groups().is_empty());
        some.extend(more[15..].iter().cloned());
        assert_eq!(some, more);
        assert_eq!(some.reaches(), more.reaches());
        assert_eq!(some.groups().len(), 5);
        assert_eq!(some.stand_from(), f64::INFINITY);
        assert_eq!(Obstacles::from(more[..1].to_vec()).stand_from(), 0.0);
    }
}
