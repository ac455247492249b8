//! A few people who avoid each other reciprocally, each pair of them looked at once.

use crate::crowd::mutual::Known;
use crate::crowd::pairs::Each;
use crate::crowd::pedestrian::{Around, Room, Walker, awareness_of, deciding};
use crate::crowd::reciprocal_people::{Meeting, ReciprocalPeople, away, permitted};
use crate::lanes::{Mask, Planar, Real, Vector2};
use crate::laws::planning::half_planes::HalfPlane;

type Vector = Vector2<f64>;

impl ReciprocalPeople {
    /// Decides for a few people in a world that does not repeat itself: two of them who do not touch change their
    /// velocities by opposite vectors.
    #[inline(always)]
    pub(super) fn decide_together(
        &self,
        walkers: &[Option<Walker>],
        around: &Around<'_>,
        room: &mut Room,
        decisions: &mut [Vector],
    ) {
        self.meet(walkers, around, room);
        for (place, own) in deciding(around.neighbors.people.agents(), walkers) {
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
                let Known {
                    change, direction, ..
                } = known[*index as usize];
                planes.push(HalfPlane {
                    point: own.agent.velocity + change,
                    direction,
                });
            }
            decisions[own.agent.number as usize] = permitted(own, hard, around.step, room);
        }
    }

    /// Finds how everybody keeps off the others.
    #[inline(always)]
    fn meet(&self, walkers: &[Option<Walker>], around: &Around<'_>, room: &mut Room) {
        let neighbors = &around.neighbors;
        let (people, robots) = (neighbors.people.agents(), neighbors.robots.agents());
        let awareness = awareness_of(people, walkers);
        let Room { pairs, mutual, .. } = room;
        mutual.open(people.len(), robots.len());
        pairs.open(neighbors);
        while pairs.find(neighbors, self.cutoff, awareness) {
            for pair in pairs.side_by_side() {
                let meeting = Meeting {
                    way: -away(pair.offset, pair.distance, pair.normal),
                    relative: pair.relative,
                    touch: pairs.touch(&pair) + Each::splat(2.0 * self.margin),
                };
                let share = Each::splat(0.5) * pair.weight;
                let (direction, change) = meeting.avoided(self.horizon, around.step);
                let mut sides = [(change * share, direction), (-change * share, -direction)];
                if meeting.touching().any() {
                    let reversed = meeting.reversed();
                    let (direction, change) = reversed.avoided(self.horizon, around.step);
                    sides[1] = (change * share, direction);
                }
                for lane in 0..pair.count {
                    let places = pair.places.map(|places| places[lane] as usize);
                    let distance = pair.distance.lane(lane);
                    for (side, (change, direction)) in sides.iter().enumerate() {
                        let known = Known {
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
