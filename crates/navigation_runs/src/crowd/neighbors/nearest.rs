//! The nearest of those who are near a person.

use crate::crowd::neighbors::Near;
use crate::crowd::neighbors::others::{Each, WIDTH};
use numeric::lanes::{Lanes, Number, Real, Zero};

/// Up to so many are ranked by comparing everybody with everybody.
const MOST_RANKED: usize = 48;

/// Up to so many are ranked side by side.
const FEW: usize = 8;

/// Room for an order by distance.
#[derive(Clone, Debug, Default)]
pub struct Nearest {
    distances: Vec<f64>,
    /// Who comes first, second and so on.
    order: Vec<u32>,
    /// Ranks of very few candidates.
    few: [u32; FEW],
}

impl Nearest {
    /// The nearest of those who are near, at most so many, by distance, then by number.
    #[inline(always)]
    pub fn of(&mut self, near: &Near<'_>, most: usize) -> &[u32] {
        self.distances.clear();
        for others in near.clone() {
            let distances: [f64; WIDTH] = std::array::from_fn(|lane| others.distance.lane(lane));
            self.distances.extend_from_slice(&distances[..others.count]);
        }
        self.first(most, |index| near.get(index as usize).0.number)
    }

    /// The nearest of so many at distances in m, at most so many, by distance, then by number.
    #[inline(always)]
    pub fn at(
        &mut self,
        (count, distance): (usize, impl Fn(usize) -> f64),
        most: usize,
        number: impl Fn(u32) -> u32,
    ) -> &[u32] {
        if count <= FEW && self.rank_few(count, &distance) {
            return &self.few[..most.min(count)];
        }
        self.distances.clear();
        self.distances.extend((0..count).map(distance));
        self.first(most, number)
    }

    /// Ranks very few candidates like [`Self::rank`].
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // small counts
    fn rank_few(&mut self, count: usize, distance: impl Fn(usize) -> f64) -> bool {
        let mut own = [f64::INFINITY; FEW];
        for (lane, own) in own.iter_mut().enumerate().take(count) {
            *own = distance(lane);
        }
        let lanes = Lanes::<FEW>::from_fn(|lane| own[lane]);
        let mut nearer = Lanes::<FEW>::zero();
        for other in &own[..count] {
            let before = Lanes::splat(*other).lt(lanes);
            nearer += Lanes::select(before, Lanes::splat(1.0), Lanes::zero());
        }
        // Those equally far share a place and leave another one free.
        let mut taken = 0_u32;
        for lane in 0..count {
            let place = nearer.lane(lane) as usize;
            self.few[place] = lane as u32;
            taken |= 1 << place;
        }
        taken.count_ones() as usize == count
    }

    #[inline(always)]
    fn first(&mut self, most: usize, number: impl Fn(u32) -> u32) -> &[u32] {
        let count = self.distances.len();
        if count > MOST_RANKED || !self.rank(count) {
            self.sort(count, most, &number);
        }
        self.order.truncate(most.min(count));
        &self.order
    }

    /// Ranks by distance alone, without a branch; `false` if two are equally far.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // small counts
    fn rank(&mut self, count: usize) -> bool {
        // Lanes that are left over come last, beyond everybody.
        let padded = count.next_multiple_of(WIDTH);
        self.distances.resize(padded, f64::INFINITY);
        self.order.clear();
        self.order.resize(padded, u32::MAX);
        for (block, own) in self.distances.as_chunks::<WIDTH>().0.iter().enumerate() {
            let own = Each::from_fn(|lane| own[lane]);
            let mut nearer = Each::zero();
            for other in &self.distances[..count] {
                let before = Each::splat(*other).lt(own);
                nearer += Each::select(before, Each::splat(1.0), Each::zero());
            }
            for lane in 0..WIDTH.min(count - block * WIDTH) {
                self.order[nearer.lane(lane) as usize] = (block * WIDTH + lane) as u32;
            }
        }
        self.order[..count].iter().all(|index| *index != u32::MAX)
    }

    /// Sorts by distance, then by number.
    #[allow(clippy::cast_possible_truncation)] // at most a million agents
    #[cold]
    fn sort(&mut self, count: usize, most: usize, number: &dyn Fn(u32) -> u32) {
        let Self {
            distances, order, ..
        } = self;
        order.clear();
        order.extend(0..count as u32);
        let by_distance = |a: &u32, b: &u32| {
            let ordered = distances[*a as usize].total_cmp(&distances[*b as usize]);
            ordered.then_with(|| number(*a).cmp(&number(*b)))
        };
        if most < count {
            order.select_nth_unstable_by(most, by_distance);
            order.truncate(most);
        }
        order.sort_unstable_by(by_distance);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::crowd::agent::{Agent, FIRST_ROBOT};
    use crate::crowd::neighbors::grid::{Grid, Period};
    use crate::crowd::neighbors::{Neighbors, Unnoticed};
    use numeric::lanes::Vector2;

    fn agent(number: u32, x: f64) -> Agent {
        Agent {
            position: Vector2::new(x, 0.0),
            velocity: Vector2::zeros(),
            direction: Vector2::zeros(),
            radius: 0.2,
            number,
        }
    }

    /// Numbers of the nearest of somebody at zero.
    fn nearest_of(people: &[Agent], robots: &[Agent], most: usize) -> Vec<u32> {
        let (mut crowd, mut machines) = (Grid::default(), Grid::default());
        crowd.fill(people, f64::INFINITY, Period::default());
        machines.fill(robots, f64::INFINITY, Period::default());
        let neighbors = Neighbors {
            people: &crowd,
            robots: &machines,
        };
        let (own, mut list) = (agent(1 << 20, 0.0), Vec::new());
        let limits = (f64::INFINITY, 1.0);
        let near = neighbors.near(&own, limits, Unnoticed::Skipped, &mut list);
        let mut nearest = Nearest::default();
        let order = nearest.of(&near, most).iter();
        order
            .map(|index| near.get(*index as usize).0.number)
            .collect()
    }

    #[test]
    fn they_come_by_distance_then_by_number() {
        let mut stream = numeric::random::Stream::new(5, 0);
        for count in [0_u32, 1, 3, 4, 5, 9, 47, 48, 49, 200] {
            // Some are equally far: half of the distances are whole numbers.
            let mut draw = |number: u32| {
                let x = stream.uniform(-9.0, 9.0);
                agent(
                    number,
                    if number.is_multiple_of(2) {
                        x.round()
                    } else {
                        x
                    },
                )
            };
            let all: Vec<Agent> = (0..count).map(&mut draw).collect();
            let robots: Vec<Agent> = (0..2).map(|index| draw(FIRST_ROBOT + index)).collect();
            let mut expected: Vec<Agent> = all.iter().chain(&robots).copied().collect();
            expected.sort_by(|a, b| {
                let far = |agent: &Agent| agent.position.x.abs();
                far(a).total_cmp(&far(b)).then(a.number.cmp(&b.number))
            });
            let expected: Vec<u32> = expected.iter().map(|agent| agent.number).collect();
            for most in [0, 1, 4, 10, 1000] {
                let found = nearest_of(&all, &robots, most);
                assert_eq!(
                    found,
                    expected[..most.min(expected.len())],
                    "{count} {most}"
                );
            }
        }
    }
}
