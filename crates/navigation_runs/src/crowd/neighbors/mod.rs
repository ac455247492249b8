//! Who is near whom, people and robots.

pub mod circle;
pub mod grid;
pub mod mutual;
pub mod nearest;
pub mod others;
pub mod pairs;

use crate::crowd::agent::Agent;
use crate::crowd::neighbors::grid::{FEW, Grid, Period};
use crate::crowd::neighbors::others::{Each, Others, WIDTH};
use numeric::lanes::Real;

/// Whether robots that a person does not notice are looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unnoticed {
    /// They are left out.
    Skipped,
    /// They are told of with weight 0, as bodies that can be touched.
    Told,
}

/// The others around everybody.
#[derive(Clone, Copy, Debug)]
pub struct Neighbors<'a> {
    /// People.
    pub people: &'a Grid,
    /// Robots. They have a grid of their own, so that robots that nobody notices change no bit of a sum.
    pub robots: &'a Grid,
}

impl<'a> Neighbors<'a> {
    /// Whether there are so few people and robots that each may be compared with each.
    #[must_use]
    pub fn are_few(&self) -> bool {
        self.people.agents().len().max(self.robots.agents().len()) <= FEW
    }

    /// Everybody within a distance in m of a person with an awareness of robots, people first; `list`: room for
    /// the numbers of everybody.
    #[inline(always)]
    pub fn near(
        &self,
        own: &'a Agent,
        (cutoff, awareness): (f64, f64),
        unnoticed: Unnoticed,
        list: &'a mut Vec<u32>,
    ) -> Near<'a> {
        let (people, robots) = (self.people, self.robots);
        let everybody = people.agents().len() + robots.agents().len();
        if list.len() < everybody {
            list.resize(everybody, 0);
        }
        let reach = cutoff * cutoff;
        let first = people.find(own, reach, list);
        let (near, rest) = list.split_at_mut(first);
        let mut second = 0;
        if !robots.agents().is_empty() && (awareness > 0.0 || unnoticed == Unnoticed::Told) {
            second = robots.find(own, reach, rest);
        }
        Near {
            own,
            period: people.period,
            kinds: [
                NeighborKind {
                    agents: people.agents(),
                    near,
                    weight: 1.0,
                },
                NeighborKind {
                    agents: robots.agents(),
                    near: &rest[..second],
                    weight: awareness,
                },
            ],
        }
    }
}

/// People or robots near a person.
#[derive(Clone, Copy, Debug)]
struct NeighborKind<'a> {
    agents: &'a [Agent],
    near: &'a [u32],
    weight: f64,
}

/// Neighbors of a person.
#[derive(Clone, Debug)]
pub struct Near<'a> {
    own: &'a Agent,
    period: Period,
    kinds: [NeighborKind<'a>; 2],
}

impl<'a> Near<'a> {
    /// How many there are.
    #[inline(always)]
    #[must_use]
    pub fn len(&self) -> usize {
        self.kinds[0].near.len() + self.kinds[1].near.len()
    }

    /// Whether there is nobody.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// One of them, with its weight.
    #[inline(always)]
    #[must_use]
    pub fn get(&self, index: usize) -> (&'a Agent, f64) {
        let people = self.kinds[0].near.len();
        let (kind, index) = if index < people {
            (&self.kinds[0], index)
        } else {
            (&self.kinds[1], index - people)
        };
        (&kind.agents[kind.near[index] as usize], kind.weight)
    }

    /// Some of them in an order of their own, side by side; at least one, at most [`WIDTH`].
    #[inline(always)]
    #[must_use]
    pub fn among(&self, indices: &[u32]) -> Others<'a> {
        let count = indices.len().min(WIDTH);
        let found: [_; WIDTH] =
            std::array::from_fn(|lane| self.get(indices[lane.min(count - 1)] as usize));
        let agents = found.map(|(agent, _)| agent);
        Others::new(
            self.own,
            self.period,
            agents,
            count,
            Each::from_fn(|lane| found[lane].1),
        )
    }
}

impl<'a> Iterator for Near<'a> {
    type Item = Others<'a>;

    /// The next ones side by side: people, then robots.
    #[inline(always)]
    fn next(&mut self) -> Option<Others<'a>> {
        let [people, robots] = &mut self.kinds;
        let kind = if people.near.is_empty() {
            robots
        } else {
            people
        };
        let count = kind.near.len().min(WIDTH);
        let (now, later) = kind.near.split_at(count);
        kind.near = later;
        let last = count.checked_sub(1)?;
        let agents = std::array::from_fn(|lane| &kind.agents[now[lane.min(last)] as usize]);
        Some(Others::new(
            self.own,
            self.period,
            agents,
            count,
            Each::splat(kind.weight),
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::crowd::agent::SHORTEST;
    use numeric::lanes::{Number, Planar, Vector2};

    type Vector = Vector2<f64>;

    #[test]
    fn each_lane_is_what_a_pair_alone_gives() {
        let mut stream = numeric::random::Stream::new(3, 0);
        let period = Period([4.0, 0.0]);
        let draw = |number: u32| Agent {
            position: Vector::new(stream.uniform(-6.0, 6.0), stream.uniform(-2.0, 2.0)),
            velocity: Vector::new(stream.uniform(-1.0, 1.0), 0.0),
            direction: Vector::x(),
            radius: stream.uniform(0.1, 0.4),
            number,
        };
        let mut agents: Vec<Agent> = (0..60).map(draw).collect();
        agents[9].position = agents[8].position;
        let (mut people, robots) = (Grid::default(), Grid::default());
        people.fill(&agents, 1.2, period);
        let neighbors = Neighbors {
            people: &people,
            robots: &robots,
        };
        let mut list = Vec::new();
        for own in &agents {
            let near = neighbors.near(own, (1.2, 1.0), Unnoticed::Skipped, &mut list);
            let (mut seen, mut sum) = (Vec::new(), Vector::zeros());
            let mut expected = Vector::repeat(-0.0);
            for others in near {
                others.add(others.normal, &mut sum);
                for (lane, other) in others.agents[..others.count].iter().enumerate() {
                    let offset = period.wrap(own.position - other.position);
                    let normal = if offset.norm() < SHORTEST {
                        Vector::new(if own.number < other.number { 1.0 } else { -1.0 }, 0.0)
                    } else {
                        offset / offset.norm()
                    };
                    assert_eq!(others.distance.lane(lane), offset.norm());
                    assert_eq!(others.offset.lane(lane), <[f64; 2]>::from(offset));
                    assert_eq!(others.normal.lane(lane), <[f64; 2]>::from(normal));
                    assert_eq!(others.velocity().lane(lane)[0], other.velocity.x);
                    assert_eq!(others.radius().lane(lane), other.radius);
                    expected += normal;
                    seen.push(other.number);
                }
            }
            assert_eq!(sum, expected);
            let met = |other: &&Agent| {
                let offset = period.wrap(own.position - other.position);
                other.number != own.number && offset.dot(&offset) <= 1.2 * 1.2
            };
            seen.sort_unstable();
            let all: Vec<u32> = agents
                .iter()
                .filter(met)
                .map(|other| other.number)
                .collect();
            assert_eq!(seen, all);
        }
    }
}
