//! People who avoid each other reciprocally, van den Berg, Guy, Lin and Manocha (2011), as `RVO2` does it.
//!
//! The half-planes of discs stand here in the form that needs no outline; [`navigation_laws::reciprocal::avoiding`] is
//! the same for any shape. Half-planes of walls are never violated.

use crate::crowd::agent::SHORTEST;
use crate::crowd::agent_lanes::{AgentLanes, Vectors};
use crate::crowd::models::parameters::Parameters;
use crate::crowd::neighbors::Unnoticed;
use crate::crowd::neighbors::others::{Each, WIDTH, apart};
use crate::crowd::pedestrian::{Around, Pedestrian, PersonDecision, Room, Walker};
use crate::crowd::velocity_programs::LaneRoom;
use navigation_laws::planning::half_planes::HalfPlane;
use navigation_world::arguments::{Arguments, Named};
use numeric::error::{Result, at_most};
use numeric::lanes::{Planar, Real, Truth, Vector2};

type Vector = Vector2<f64>;

/// Most neighbors that a person avoids.
const MOST_NEIGHBORS: usize = 1 << 16;

/// Parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReciprocalPeople {
    /// `tau`, time without contact with others, in s.
    pub horizon: f64,
    /// Horizon for walls in s.
    pub wall_horizon: f64,
    /// Nearest neighbors that are avoided.
    pub max_neighbors: usize,
    /// Added to each radius, in m.
    pub margin: f64,
    /// Distance in m beyond which nobody acts; infinite for none.
    pub cutoff: f64,
}

impl Named for ReciprocalPeople {
    const NAME: &'static str = "reciprocal_avoidance";

    fn made_of(given: &dyn Arguments) -> Result<Self> {
        let given = Parameters(given);
        Ok(Self {
            horizon: given.positive("horizon")?,
            wall_horizon: given.positive("wall_horizon")?,
            max_neighbors: at_most(
                "max_neighbors",
                given.0.count("max_neighbors")?,
                MOST_NEIGHBORS,
            )?,
            margin: given.not_negative("margin")?,
            cutoff: given.cutoff()?,
        })
    }
}

/// Pairs of discs that are to avoid each other, side by side.
#[derive(Clone, Copy, Debug)]
pub struct DiscPair<R> {
    /// From the own center to the other one, in m.
    pub way: Vector2<R>,
    /// Velocity relative to the other, in m/s.
    pub relative: Vector2<R>,
    /// Sum of the radii in m.
    pub touch: R,
}

impl<R: Real> DiscPair<R> {
    /// Direction of the line and change `u` of the relative velocity that avoids a contact within the horizon, or,
    /// of touching discs, ends it within a step, both in s.
    #[inline(always)]
    #[must_use]
    pub fn avoided(&self, horizon: f64, step: f64) -> (Vector2<R>, Vector2<R>) {
        let Self {
            way,
            relative,
            touch,
        } = *self;
        let squared = way.dot(&way);
        let from_front = relative - way.over(R::splat(horizon));
        let along = from_front.dot(&way);
        let ahead =
            along.lt(R::zero()) & (touch * touch * from_front.dot(&from_front)).lt(along * along);
        let leg = (squared - touch * touch).sqrt();
        let left = R::zero().lt(way.x * from_front.y - way.y * from_front.x);
        let (to_left, to_right) = (
            Vector2::new(way.x * leg - way.y * touch, way.x * touch + way.y * leg),
            Vector2::new(way.x * leg + way.y * touch, way.y * leg - way.x * touch),
        );
        let to_right = Vector2::new(-to_right.x, -to_right.y);
        let side = <Vector2<R> as Planar<R>>::select(left, to_left, to_right);
        let mut direction = side.over(squared);
        let mut change = direction * relative.dot(&direction) - relative;
        let touching = self.touching();
        if ahead.any() {
            let front = self.front(from_front, R::splat(1.0 / horizon));
            direction = <Vector2<R> as Planar<R>>::select(ahead, front.0, direction);
            change = <Vector2<R> as Planar<R>>::select(ahead, front.1, change);
        }
        if touching.any() {
            let within = relative - way.over(R::splat(step));
            let front = self.front(within, R::splat(1.0 / step));
            direction = <Vector2<R> as Planar<R>>::select(touching, front.0, direction);
            change = <Vector2<R> as Planar<R>>::select(touching, front.1, change);
        }
        (direction, change)
    }

    /// Whether the discs touch. If not, the answer for the other one is the opposite.
    #[inline(always)]
    #[must_use]
    pub fn touching(&self) -> R::Mask {
        self.way.dot(&self.way).le(self.touch * self.touch)
    }

    /// View of the other one of the pair on these discs.
    #[inline(always)]
    #[must_use]
    pub fn reversed(&self) -> Self {
        Self {
            way: -self.way,
            relative: -self.relative,
            touch: self.touch,
        }
    }

    /// At the rounded front of the velocity obstacle.
    #[inline(always)]
    fn front(&self, away: Vector2<R>, per_time: R) -> (Vector2<R>, Vector2<R>) {
        let length = away.length();
        let still = length.le(R::zero());
        let along_x = Vector2::new(R::one(), R::zero());
        let unit = <Vector2<R> as Planar<R>>::select(still, along_x, away.over(length));
        let direction = Vector2::new(unit.y, -unit.x);
        (direction, unit * (self.touch * per_time - length))
    }
}

impl ReciprocalPeople {
    /// Half-planes of the nearest neighbors, behind those of walls.
    #[inline(always)]
    fn keep_off_others(&self, own: &Walker, around: &Around<'_>, room: &mut Room) {
        let me = own.agent;
        let limits = (self.cutoff, own.awareness);
        let Room {
            near: list,
            nearest,
            planes,
            ..
        } = room;
        let near = around.neighbors.near(&me, limits, Unnoticed::Skipped, list);
        let velocity: Vector2<Each> = Planar::<Each>::splat(me.velocity.into());
        let nearest = nearest.of(&near, self.max_neighbors);
        for block in nearest.chunks(WIDTH) {
            let others = near.among(block);
            let lower = |lane: usize| me.number < others.agents[lane].number;
            let away = away(others.offset, others.distance, lower);
            let touch = Each::splat(me.radius) + others.radius() + Each::splat(2.0 * self.margin);
            let discs = DiscPair {
                way: Vector2::new(-away.x, -away.y),
                relative: velocity - others.velocity(),
                touch,
            };
            let (direction, change) = discs.avoided(self.horizon, around.step);
            let point = velocity + change * (Each::splat(0.5) * others.weight);
            planes.extend((0..others.count).map(|lane| HalfPlane {
                point: point.lane(lane).into(),
                direction: direction.lane(lane).into(),
            }));
        }
    }

    /// Half-planes of walls; returns how many there are.
    pub(in crate::crowd) fn keep_off_walls(
        &self,
        own: &Walker,
        around: &Around<'_>,
        room: &mut Room,
    ) -> usize {
        let reach = self.wall_horizon * own.desired_speed;
        let radius = own.agent.radius + self.margin;
        room.planes.clear();
        for wall in around.walls {
            wall.each_part(own.agent.position, |near| {
                let gap = near.distance - radius;
                if gap <= reach {
                    let time = if gap < 0.0 {
                        around.step
                    } else {
                        self.wall_horizon
                    };
                    room.planes.push(HalfPlane {
                        point: near.normal * (-gap / time),
                        direction: -near.normal.left_normal(),
                    });
                }
            });
        }
        room.planes.len()
    }
}

/// The permitted velocity nearest to the wanted one.
#[inline(always)]
pub(in crate::crowd) fn permitted(own: &Walker, hard: usize, step: f64, room: &mut Room) -> Vector {
    let speed = own.desired_speed.min(own.to_go / step);
    let wanted = if own.stays {
        Vector::zeros()
    } else {
        own.agent.direction * speed
    };
    room.solver
        .nearest(&room.planes, hard, own.desired_speed, wanted)
}

/// Offsets, of those at one place tiny ones, as [`apart`] has it; of others no normal is needed.
#[inline(always)]
pub(in crate::crowd) fn away<R: Real>(
    offset: Vector2<R>,
    distance: R,
    lower: impl Fn(usize) -> bool,
) -> Vector2<R> {
    let together = distance.lt(R::splat(SHORTEST));
    if !together.any() {
        return offset;
    }
    Planar::<R>::select(together, apart(lower) * R::splat(SHORTEST), offset)
}

impl Pedestrian for ReciprocalPeople {
    const LARGEST_STEP: f64 = 0.25;
    const CAP: f64 = 1.0;
    const IS_FORCE: bool = false;
    const LANES: bool = true;

    #[inline(always)]
    fn decide(&self, own: &mut Walker, around: &Around<'_>, room: &mut Room) -> Vector {
        let hard = self.keep_off_walls(own, around, room);
        self.keep_off_others(own, around, room);
        permitted(own, hard, around.step, room)
    }

    #[inline(always)]
    fn decide_together(
        &self,
        walkers: &[Walker],
        around: &Around<'_>,
        room: &mut Room,
        decisions: &mut [PersonDecision],
    ) -> bool {
        let few = around.neighbors.are_few();
        if few {
            self.decide_in_pairs(walkers, around, room, decisions);
        }
        few
    }

    #[inline(always)]
    fn decide_in_lanes(
        &self,
        agents: &AgentLanes,
        room: &mut LaneRoom,
        decisions: &mut Vec<Vectors>,
    ) {
        self.decide_pairs_in_lanes(agents, room, decisions);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use navigation_laws::planning::outline::Outline;
    use navigation_laws::reciprocal::avoiding;

    #[test]
    fn half_planes_of_discs_are_those_of_outlines() {
        let mut stream = numeric::random::Stream::new(11, 0);
        let mut draw =
            |size: f64| Vector::new(stream.uniform(-size, size), stream.uniform(-size, size));
        for _ in 0..2000 {
            let (way, own, other) = (draw(3.0), draw(1.5), draw(1.5));
            let discs = DiscPair {
                way,
                relative: own - other,
                touch: 0.6,
            };
            let (direction, change) = discs.avoided(5.0, 0.25);
            let plane = avoiding(&Outline::disc(way, 0.6, other), own, 5.0, 0.25, 0.5);
            assert!((plane.direction - direction).norm() < 1e-9, "{discs:?}");
            assert!(
                (plane.point - own - change * 0.5).norm() < 1e-9,
                "{discs:?}"
            );
        }
    }
}
