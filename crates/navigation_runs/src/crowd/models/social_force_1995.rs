//! Social force model of Helbing and Molnar, Physical Review E 51 (1995) 4282.
//!
//! A neighbor repels with a potential `V0 exp(-b/sigma)` whose lines are ellipses along the way `y` that the
//! neighbor takes within `dt_s`: `2 b = sqrt((d + |r - y|)^2 - |y|^2)`. The force is its exact gradient.

use crate::crowd::agent::SHORTEST;
use crate::crowd::agent_lanes::{AgentLanes, Pair, Vectors};
use crate::crowd::models::parameters::Parameters;
use crate::crowd::neighbors::others::Each;
use crate::crowd::neighbors::{Neighbors, Unnoticed};
use crate::crowd::pedestrian::{
    Around, Pedestrian, PersonDecision, Room, Walker, awareness_of, deciding, drive, drives,
};
use crate::crowd::velocity_programs::LaneRoom;
use crate::crowd::walls::pushes;
use navigation_world::arguments::{Arguments, Named};
use numeric::elementary::decay;
use numeric::error::Result;
use numeric::lanes::{Planar, Real, Truth, Vector2};

type Vector = Vector2<f64>;

/// Squared axis `2 b` below which somebody stands on the way of the neighbor, in m^2.
const ON_THE_WAY: f64 = 1e-12;

/// Parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SocialForce1995 {
    /// `tau` in s.
    pub relaxation_time: f64,
    /// `V0` in m^2/s^2.
    pub strength: f64,
    /// `sigma` in m.
    pub range: f64,
    /// `dt_s` in s.
    pub step_time: f64,
    /// `U0` in m^2/s^2.
    pub wall_strength: f64,
    /// `R` in m.
    pub wall_range: f64,
    /// `phi`, half the angle of view, in rad.
    pub view_angle: f64,
    /// `c`, weight of what is out of view.
    pub behind: f64,
    /// Distance in m beyond which nobody acts; infinite for none.
    pub cutoff: f64,
}

impl Named for SocialForce1995 {
    const NAME: &'static str = "social_force_1995";

    fn made_of(given: &dyn Arguments) -> Result<Self> {
        let given = Parameters(given);
        Ok(Self {
            relaxation_time: given.positive("relaxation_time")?,
            strength: given.not_negative("strength")?,
            range: given.positive("range")?,
            step_time: given.not_negative("step_time")?,
            wall_strength: given.not_negative("wall_strength")?,
            wall_range: given.positive("wall_range")?,
            view_angle: given.not_negative("view_angle")?,
            behind: given.not_negative("behind")?,
            cutoff: given.cutoff()?,
        })
    }
}

/// Neighbors as a person sees them, side by side.
#[derive(Clone, Copy, Debug)]
struct NeighborView<R> {
    /// From the neighbor to the person, in m.
    offset: Vector2<R>,
    distance: R,
    normal: Vector2<R>,
    /// Way `y` that the neighbor takes, in m.
    way: Vector2<R>,
}

impl SocialForce1995 {
    /// Forces of neighbors, before weights.
    #[inline(always)]
    fn push<R: Real>(&self, seen: &NeighborView<R>) -> Vector2<R> {
        let NeighborView {
            offset,
            distance,
            normal,
            way,
        } = *seen;
        let unit = self.strength / self.range;
        let apart = offset - way;
        let far = Planar::<R>::length(apart);
        let sum = distance + far;
        let squared = sum * sum - way.dot(&way);
        let axis = R::splat(0.5) * squared.sqrt();
        let decay = decay(-axis / R::splat(self.range));
        let size = R::splat(unit) * decay * sum / (R::splat(4.0) * axis);
        let mut push = (normal + Planar::<R>::over(apart, far)) * size;
        let shortest = R::splat(SHORTEST);
        let (met, reached) = (distance.lt(shortest), far.lt(shortest));
        let passing = squared.lt(R::splat(ON_THE_WAY));
        if (met | reached | passing).any() {
            // Those who meet exactly head-on pass on their right.
            let side = R::splat(4.0) * distance * far;
            let aside = way.left_normal() * (R::splat(unit) / side.sqrt());
            push = Planar::<R>::select(passing, aside, push);
            push = Planar::<R>::select(reached, Vector2::zeros(), push);
            push = Planar::<R>::select(met, normal * R::splat(unit), push);
        }
        push
    }

    /// Forces of neighbors by whether somebody who wants to go in a direction sees them; `cosine` of half the angle
    /// of view.
    #[inline(always)]
    fn viewed<R: Real>(
        &self,
        push: Vector2<R>,
        ahead: Vector2<R>,
        (weight, cosine): (R, f64),
    ) -> Vector2<R> {
        let seen = (-ahead.dot(&push)).ge(Planar::<R>::length(push) * R::splat(cosine));
        let view = R::select(seen, R::splat(1.0), R::splat(self.behind));
        push * (weight * view)
    }

    /// Forces of the two of each pair: the second as the first sees him, `own` way and direction of the first, and
    /// the direction of the second.
    #[inline(always)]
    fn both<R: Real>(
        &self,
        seen: &NeighborView<R>,
        (way, ahead): (Vector2<R>, Vector2<R>),
        back: Vector2<R>,
        limits: (R, f64),
    ) -> [Vector2<R>; 2] {
        let reversed = NeighborView {
            offset: -seen.offset,
            normal: -seen.normal,
            way,
            ..*seen
        };
        [
            self.viewed(self.push(seen), ahead, limits),
            self.viewed(self.push(&reversed), back, limits),
        ]
    }

    /// Adds the forces of all pairs to the sums of their people.
    #[inline(always)]
    fn push_together(
        &self,
        neighbors: &Neighbors<'_>,
        awareness: impl Fn(usize) -> f64 + Copy,
        room: &mut Room,
    ) {
        let cosine = self.view_angle.cos();
        let Room {
            pairs,
            sums,
            ways,
            aheads,
            ..
        } = room;
        pairs.open(neighbors);
        while pairs.find(neighbors, self.cutoff, awareness) {
            for pair in pairs.side_by_side() {
                let seen = NeighborView {
                    offset: pair.offset,
                    distance: pair.distance,
                    normal: pair.normal,
                    way: pair.gathered(1, ways),
                };
                let own = (pair.gathered(0, ways), pair.gathered(0, aheads));
                let limits = (pair.weight, cosine);
                let both = self.both(&seen, own, pair.gathered(1, aheads), limits);
                pair.add_both(both, sums);
            }
        }
    }

    /// Push of the walls.
    #[inline(always)]
    fn walls(&self, place: Vector, around: &Around<'_>) -> Vector {
        let wall = self.wall_strength / self.wall_range;
        pushes(around.walls, place, |near| {
            near.normal * (wall * (-near.distance / self.wall_range).exp())
        })
    }
}

impl Pedestrian for SocialForce1995 {
    const LARGEST_STEP: f64 = 0.1;
    const CAP: f64 = 1.3;
    const IS_FORCE: bool = true;
    const LANES: bool = true;

    #[inline(always)]
    fn decide(&self, own: &mut Walker, around: &Around<'_>, room: &mut Room) -> Vector {
        let cosine = self.view_angle.cos();
        let mut force = drive(own, self.relaxation_time);
        let ahead: Vector2<Each> = Planar::<Each>::splat(own.agent.direction.into());
        let limits = (self.cutoff, own.awareness);
        let neighbors = around.neighbors;
        for others in neighbors.near(&own.agent, limits, Unnoticed::Skipped, &mut room.near) {
            let speed = Planar::<Each>::length(others.velocity());
            let push = self.push(&NeighborView {
                offset: others.offset,
                distance: others.distance,
                normal: others.normal,
                way: others.direction() * (speed * Each::splat(self.step_time)),
            });
            let push = self.viewed(push, ahead, (others.weight, cosine));
            others.add(push, &mut force);
        }
        force + self.walls(own.agent.position, around)
    }

    #[inline(always)]
    fn decide_together(
        &self,
        walkers: &[Walker],
        around: &Around<'_>,
        room: &mut Room,
        decisions: &mut [PersonDecision],
    ) -> bool {
        let neighbors = &around.neighbors;
        let (people, robots) = (neighbors.people.agents(), neighbors.robots.agents());
        let (ways, aheads) = (&mut room.ways, &mut room.aheads);
        ways.clear();
        ways.reserve(people.len() + robots.len());
        aheads.clear();
        aheads.reserve(people.len() + robots.len());
        for agent in people.iter().chain(robots) {
            ways.push(agent.direction * (agent.velocity.norm() * self.step_time));
            aheads.push(agent.direction);
        }
        room.sums.clear();
        room.sums.extend(drives(walkers, self.relaxation_time));
        room.sums.resize(ways.len(), Vector::zeros());
        self.push_together(neighbors, awareness_of(walkers), room);
        for (place, own) in deciding(walkers) {
            let decision = room.sums[place] + self.walls(own.agent.position, around);
            decisions[own.agent.number as usize] = PersonDecision::of(own, decision);
        }
        true
    }

    #[inline(always)]
    fn decide_in_lanes(
        &self,
        agents: &AgentLanes,
        room: &mut LaneRoom,
        decisions: &mut Vec<Vectors>,
    ) {
        let cosine = self.view_angle.cos();
        let ways = &mut room.ways;
        ways.clear();
        for agent in &agents.all {
            let speed = Planar::<_>::length(agent.velocity);
            ways.push(agent.direction * (speed * self.step_time));
        }
        agents.accelerations(
            (self.relaxation_time, self.cutoff),
            #[inline(always)]
            |(one, other): (usize, usize), pair: &Pair| {
                let seen = NeighborView {
                    offset: pair.offset,
                    distance: pair.distance,
                    normal: pair.normal,
                    way: ways[other],
                };
                let [first, second] = [one, other].map(|place| agents.all[place].direction);
                self.both(&seen, (ways[one], first), second, (pair.weight, cosine))
            },
            decisions,
        );
    }
}
