//! Pairs of agents who are near each other, each looked at once for both of them.
//!
//! Where a model pushes two people apart by opposite vectors, half of the work is enough. Pairs of many people fill
//! the lanes together; each person still meets the others in the order of [`Neighbors::near`], so that no sum
//! changes a bit.

use std::ops::Range;

use crate::crowd::agent::Agent;
use crate::crowd::neighbors::Neighbors;
use crate::crowd::neighbors::grid::{FEW, Period};
use crate::crowd::neighbors::others::parted;
use numeric::lanes::{Lanes, Planar, Real, Vector2};

type Vector = Vector2<f64>;

/// How many pairs are looked at side by side.
pub const WIDTH: usize = 8;

/// Pairs that are kept before they are looked at.
const ENOUGH: usize = 256;

/// A number of each pair.
pub type Each = Lanes<WIDTH>;

/// Places of one of the two of some pairs: people as in their grid, then robots, who are always second.
pub type Places = [u32; WIDTH];

/// Some pairs side by side; the last one also fills the lanes that are left over.
#[derive(Clone, Copy, Debug)]
pub struct Pairs<'a> {
    /// Who they are.
    pub places: [&'a Places; 2],
    /// How many pairs there are.
    pub count: usize,
    /// From the second to the first, in m.
    pub offset: Vector2<Each>,
    /// Velocity of the first relative to the second, in m/s.
    pub relative: Vector2<Each>,
    /// Their distance in m.
    pub distance: Each,
    /// Direction from the second to the first, of length 1.
    pub normal: Vector2<Each>,
    /// 1 for two people, the share by which the first is aware of the second if that is a robot.
    pub weight: Each,
}

impl Pairs<'_> {
    /// Adds what belongs to the first of each pair to the sum at his place, and its opposite to that of the second.
    #[inline(always)]
    pub fn add(&self, vectors: Vector2<Each>, sums: &mut [Vector]) {
        let [first, second] = self.places;
        for (lane, (first, second)) in first.iter().zip(second).enumerate().take(self.count) {
            let vector = Vector::from(vectors.lane(lane));
            sums[*first as usize] += vector;
            sums[*second as usize] -= vector;
        }
    }

    /// Adds what belongs to each of the two of a pair to the sum at his place.
    #[inline(always)]
    pub fn add_both(&self, [ones, others]: [Vector2<Each>; 2], sums: &mut [Vector]) {
        let [first, second] = self.places;
        for (lane, (first, second)) in first.iter().zip(second).enumerate().take(self.count) {
            sums[*first as usize] += Vector::from(ones.lane(lane));
            sums[*second as usize] += Vector::from(others.lane(lane));
        }
    }

    /// A vector of one of the two of each pair by their places.
    #[inline(always)]
    #[must_use]
    pub fn gathered(&self, which: usize, vectors: &[Vector]) -> Vector2<Each> {
        let places = self.places[which];
        let (mut x, mut y) = ([0.0; WIDTH], [0.0; WIDTH]);
        for (lane, place) in places.iter().enumerate() {
            let vector = &vectors[*place as usize];
            (x[lane], y[lane]) = (vector.x, vector.y);
        }
        Vector2::new(Each::from_fn(|lane| x[lane]), Each::from_fn(|lane| y[lane]))
    }
}

/// Position in m and velocity in m/s.
type Motion = [f64; 4];

/// Pairs of a snapshot, some at a time.
#[derive(Clone, Debug, Default)]
pub struct PairQueue {
    /// Places of the two of each pair that is still to be looked at.
    first: Vec<u32>,
    second: Vec<u32>,
    weight: Vec<f64>,
    /// How many are waiting, and how many of them have been shown.
    waiting: usize,
    shown: usize,
    /// How many people have been asked whom they meet, people first, then robots.
    row: usize,
    motions: Vec<Motion>,
    numbers: Vec<u32>,
    radii: Vec<f64>,
}

impl PairQueue {
    /// Starts with a snapshot of a world that does not repeat itself: only there are differences of positions the
    /// opposite of each other.
    #[inline(always)]
    pub fn open(&mut self, neighbors: &Neighbors<'_>) {
        debug_assert!(neighbors.people.period == Period::default());
        (self.waiting, self.shown, self.row) = (0, 0, 0);
        let (people, robots) = (neighbors.people.agents(), neighbors.robots.agents());
        let everybody = people.len() + robots.len();
        self.motions.clear();
        self.motions.reserve(everybody);
        self.numbers.clear();
        self.numbers.reserve(everybody);
        self.radii.clear();
        self.radii.reserve(everybody);
        for agent in people.iter().chain(robots) {
            let Agent {
                position, velocity, ..
            } = agent;
            self.motions
                .push([position.x, position.y, velocity.x, velocity.y]);
            self.numbers.push(agent.number);
            self.radii.push(agent.radius);
        }
        let room = ENOUGH.max(FEW * (2 * FEW)) + WIDTH + people.len().max(robots.len());
        if self.first.len() < room {
            self.first.resize(room, 0);
            self.second.resize(room, 0);
            self.weight.resize(room, 1.0);
        }
    }

    /// Finds more pairs within a distance in m, those of people, then robots with the share by which a person is
    /// aware of them, unless it is none; `false` if there are no more.
    #[inline(always)]
    pub fn find(
        &mut self,
        neighbors: &Neighbors<'_>,
        cutoff: f64,
        awareness: impl Fn(usize) -> f64,
    ) -> bool {
        let reach = cutoff * cutoff;
        let (people, robots) = (neighbors.people.agents(), neighbors.robots.agents());
        let rows = if robots.is_empty() { 1 } else { 2 } * people.len();
        self.first.copy_within(self.shown..self.waiting, 0);
        self.second.copy_within(self.shown..self.waiting, 0);
        self.weight.copy_within(self.shown..self.waiting, 0);
        self.waiting -= self.shown;
        if neighbors.are_few() {
            if self.row == 0 {
                self.find_few(people.len(), reach, awareness);
            }
            self.row = rows;
        } else {
            self.find_many(neighbors, (reach, rows), awareness);
        }
        self.shown = self.waiting;
        if self.row < rows {
            self.shown -= self.waiting % WIDTH;
        } else if let Some(last) = self.waiting.checked_sub(1) {
            for list in [&mut self.first, &mut self.second] {
                let last = list[last];
                list[self.waiting..self.waiting + WIDTH].fill(last);
            }
        }
        self.shown > 0
    }

    /// Compares everybody with everybody.
    #[inline(always)]
    fn find_few(&mut self, people: usize, reach: f64, awareness: impl Fn(usize) -> f64) {
        let everybody = self.motions.len();
        for one in 0..people {
            self.see(one, one + 1..people, (reach, 1.0));
        }
        for one in 0..people {
            let weight = if everybody > people {
                awareness(one)
            } else {
                0.0
            };
            if weight > 0.0 {
                self.see(one, people..everybody, (reach, weight));
            }
        }
    }

    /// Keeps whom somebody meets of a range, without a branch.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation)] // few
    fn see(&mut self, one: usize, others: Range<usize>, (reach, weight): (f64, f64)) {
        let [x, y, ..] = self.motions[one];
        let (first, second) = (&mut self.first[..], &mut self.second[..]);
        let (weights, mut count) = (&mut self.weight[..], self.waiting);
        for (other, motion) in (others.start as u32..).zip(&self.motions[others]) {
            let (x, y) = (x - motion[0], y - motion[1]);
            let far = x * x + y * y > reach;
            (first[count], second[count], weights[count]) = (one as u32, other, weight);
            count += usize::from(!far);
        }
        self.waiting = count;
    }

    /// Looks into the cells of the grids, until there are enough.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation)] // at most a million agents
    fn find_many(
        &mut self,
        neighbors: &Neighbors<'_>,
        (reach, rows): (f64, usize),
        awareness: impl Fn(usize) -> f64,
    ) {
        let (people, robots) = (neighbors.people, neighbors.robots);
        let count = people.agents().len();
        while self.waiting < ENOUGH && self.row < rows {
            let found = &mut self.second[self.waiting..];
            let (mut person, mut more, mut weight) = (self.row, 0, 1.0);
            if person < count {
                more = people.find_behind(person, reach, found);
            } else {
                person -= count;
                weight = awareness(person);
                if weight > 0.0 {
                    more = robots.find(&people.agents()[person], reach, found);
                    for place in &mut found[..more] {
                        *place += count as u32;
                    }
                }
            }
            let found = self.waiting..self.waiting + more;
            self.first[found.clone()].fill(person as u32);
            self.weight[found].fill(weight);
            self.waiting += more;
            self.row += 1;
        }
    }

    /// Pairs that were found, side by side.
    #[inline(always)]
    pub fn side_by_side(&self) -> impl Iterator<Item = Pairs<'_>> {
        let blocks = self.shown.div_ceil(WIDTH) * WIDTH;
        let first = self.first[..blocks].as_chunks::<WIDTH>().0;
        let second = self.second[..blocks].as_chunks::<WIDTH>().0;
        let counts = (0..self.shown)
            .step_by(WIDTH)
            .map(|start| (self.shown - start).min(WIDTH));
        let weights = self.weight[..blocks].as_chunks::<WIDTH>().0;
        let places = first.iter().zip(second);
        let places = places.zip(weights).zip(counts);
        places.map(|(((first, second), weight), count)| Pairs {
            weight: Each::from_fn(|lane| weight[lane]),
            count,
            ..self.pairs([first, second])
        })
    }

    /// Sums of the radii of some pairs in m.
    #[inline(always)]
    #[must_use]
    pub fn touch(&self, pairs: &Pairs<'_>) -> Each {
        let [first, second] = pairs.places;
        let radius = |place: u32| self.radii[place as usize];
        Each::from_fn(|lane| radius(first[lane]) + radius(second[lane]))
    }

    /// Whether the first of a pair has the lower number.
    #[inline(always)]
    #[must_use]
    pub fn first_is_lower(&self, [first, second]: [&Places; 2], lane: usize) -> bool {
        self.numbers[first[lane] as usize] < self.numbers[second[lane] as usize]
    }

    /// Number of somebody at a place.
    #[inline(always)]
    #[must_use]
    pub fn number(&self, place: usize) -> u32 {
        self.numbers[place]
    }

    #[inline(always)]
    fn pairs<'a>(&self, places: [&'a Places; 2]) -> Pairs<'a> {
        let [first, second] = places;
        let mut apart = [[0.0; WIDTH]; 4];
        for lane in 0..WIDTH {
            let one = &self.motions[first[lane] as usize];
            let other = &self.motions[second[lane] as usize];
            for part in 0..4 {
                apart[part][lane] = one[part] - other[part];
            }
        }
        let [x, y, vx, vy] = apart.map(|part| Each::from_fn(|lane| part[lane]));
        let offset = Vector2::new(x, y);
        let (distance, normal) = parted(offset, |lane| self.first_is_lower(places, lane));
        Pairs {
            places,
            count: WIDTH,
            weight: Each::splat(1.0),
            offset,
            relative: Vector2::new(vx, vy),
            distance,
            normal,
        }
    }
}
