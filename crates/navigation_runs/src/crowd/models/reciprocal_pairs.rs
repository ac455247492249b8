//! A few people who avoid each other reciprocally, each pair of them looked at once.

use crate::crowd::agent_lanes::{self, AgentLanes};
use crate::crowd::models::reciprocal_people::{DiscPair, ReciprocalPeople, away, permitted};
use crate::crowd::neighbors::mutual::KnownPair;
use crate::crowd::neighbors::pairs::Each;
use crate::crowd::pedestrian::{Around, PersonDecision, Room, Walker, awareness_of, deciding};
use crate::crowd::velocity_programs::{LaneRoom, VelocityGoal, VelocityPrograms};
use navigation_laws::planning::half_planes::HalfPlane;
use numeric::lanes::{Number, Planar, Real, Truth, Vector2};

/// Change of the velocity of one of two, and the direction of the line of permitted velocities.
type Side<R> = (Vector2<R>, Vector2<R>);

impl ReciprocalPeople {
    /// Decides for a few people in a world that does not repeat itself: two of them who do not touch change their
    /// velocities by opposite vectors.
    #[inline(always)]
    pub(super) fn decide_in_pairs(
        &self,
        walkers: &[Walker],
        around: &Around<'_>,
        room: &mut Room,
        decisions: &mut [PersonDecision],
    ) {
        self.meet(walkers, around, room);
        for (place, own) in deciding(walkers) {
            let hard = self.keep_off_walls(own, around, room);
            let Room {
                nearest,
                pairs,
                planes,
                mutual,
                ..
            } = &mut *room;
            let known = mutual.row(place);
            let distance = |index: usize| known[index].distance;
            let number_of = |index: u32| pairs.number(known[index as usize].other);
            for index in nearest.at((known.len(), distance), self.max_neighbors, number_of) {
                let KnownPair {
                    change, direction, ..
                } = known[*index as usize];
                planes.push(HalfPlane {
                    point: own.agent.velocity + change,
                    direction,
                });
            }
            let order = permitted(own, hard, around.step, room);
            decisions[own.agent.number as usize] = PersonDecision::of(own, order);
        }
    }

    /// Changes of the velocities of the two of each pair, and directions of their lines.
    #[inline(always)]
    fn sides<R: Real>(&self, discs: &DiscPair<R>, weight: R, step: f64) -> [Side<R>; 2] {
        let share = R::splat(0.5) * weight;
        let (direction, change) = discs.avoided(self.horizon, step);
        let mut sides = [(change * share, direction), (-change * share, -direction)];
        if discs.touching().any() {
            let (direction, change) = discs.reversed().avoided(self.horizon, step);
            sides[1] = (change * share, direction);
        }
        sides
    }

    /// Decides for the people of worlds side by side.
    #[inline(always)]
    pub(super) fn decide_pairs_in_lanes(
        &self,
        agents: &AgentLanes,
        room: &mut LaneRoom,
        decisions: &mut Vec<agent_lanes::Vectors>,
    ) {
        let LaneRoom { step, programs, .. } = room;
        let step = *step;
        self.constrain_in_lanes(agents, step, programs);
        for (person, intention) in agents.intentions.iter().enumerate() {
            let own = &agents.all[person];
            let speed = intention
                .desired_speed
                .min(intention.to_go / Real::splat(step));
            let objective = VelocityGoal {
                max_speed: intention.desired_speed,
                wanted: own.direction * speed,
            };
            let who = (person, own.velocity);
            let most = self.max_neighbors;
            decisions.push(programs.nearest(who, most, &objective));
        }
    }

    /// Finds how everybody of worlds side by side keeps off the others.
    #[inline(always)]
    fn constrain_in_lanes(&self, agents: &AgentLanes, step: f64, programs: &mut VelocityPrograms) {
        programs.open(agents.people());
        for &places in &agents.pairs {
            let Some(pair) = agents.pair(places, self.cutoff) else {
                continue;
            };
            let [first, second] = [places.0, places.1].map(|place| agents.all[place].radius);
            let discs = DiscPair {
                way: -away(pair.offset, pair.distance, |_| true),
                relative: pair.relative,
                touch: first + second + 2.0 * self.margin,
            };
            let sides = self.sides(&discs, pair.weight, step);
            let distance = Each::select(pair.near, pair.distance, Each::splat(f64::INFINITY));
            let [mine, theirs] = sides;
            programs.constrain(places.0, mine, (distance, pair.near));
            programs.constrain(places.1, theirs, (distance, pair.near));
        }
    }

    /// Finds how everybody keeps off the others.
    #[inline(always)]
    fn meet(&self, walkers: &[Walker], around: &Around<'_>, room: &mut Room) {
        let neighbors = &around.neighbors;
        let (people, robots) = (neighbors.people.agents(), neighbors.robots.agents());
        let awareness = awareness_of(walkers);
        let Room { pairs, mutual, .. } = room;
        mutual.open(people.len(), robots.len());
        pairs.open(neighbors);
        while pairs.find(neighbors, self.cutoff, awareness) {
            for pair in pairs.side_by_side() {
                let lower = |lane: usize| pairs.first_is_lower(pair.places, lane);
                let discs = DiscPair {
                    way: -away(pair.offset, pair.distance, lower),
                    relative: pair.relative,
                    touch: pairs.touch(&pair) + Each::splat(2.0 * self.margin),
                };
                let sides = self.sides(&discs, pair.weight, around.step);
                for lane in 0..pair.count {
                    let places = pair.places.map(|places| places[lane] as usize);
                    let distance = pair.distance.lane(lane);
                    for (side, (change, direction)) in sides.iter().enumerate() {
                        let known = KnownPair {
                            change: change.lane(lane).into(),
                            direction: direction.lane(lane).into(),
                            distance,
                            other: places[1 - side],
                        };
                        mutual.push(places[side], known);
                    }
                }
            }
        }
    }
}
