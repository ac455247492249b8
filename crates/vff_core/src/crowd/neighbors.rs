//! Who is near whom: a uniform grid, or everybody where few are present.

use std::ops::Range;

use crate::crowd::agent::{Agent, SHORTEST};
use crate::lanes::{LaneMask, Lanes, Mask, Planar, Real, Vector2, Zero};

type Vector = Vector2<f64>;

/// Up to so many agents are looked at one by one.
const FEW: usize = 24;

/// Cells of a grid beside four an agent.
const SPARE_CELLS: f64 = 1024.0;

/// Differences of positions in a world that repeats itself, or not.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Period(pub [f64; 2]);

impl Period {
    /// A difference of positions wrapped into [-L/2, L/2).
    #[inline(always)]
    #[must_use]
    pub fn wrap(&self, mut way: Vector) -> Vector {
        let [x, y] = self.0;
        if x > 0.0 {
            way.x -= x * (way.x / x + 0.5).floor();
        }
        if y > 0.0 {
            way.y -= y * (way.y / y + 0.5).floor();
        }
        way
    }
}

/// Cells along one axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Axis {
    /// Size of a cell in m.
    size: f64,
    /// Number of the first cell, as multiples of the size.
    first: f64,
    count: usize,
    /// Length after which the world repeats itself, 0 if it does not.
    period: f64,
}

impl Axis {
    /// Of a world that does not repeat itself, between two coordinates.
    fn between(low: f64, high: f64, size: f64) -> Self {
        let first = (low / size).floor();
        Self {
            size,
            first,
            count: whole((high / size).floor() - first).saturating_add(1),
            period: 0.0,
        }
    }

    /// Of one that does: cells at least as large as wanted, one if there were less than three.
    fn around(period: f64, size: f64) -> Self {
        let count = whole((period / size).floor()).clamp(1, MOST_AROUND);
        let count = if count < 3 { 1 } else { count };
        Self {
            size: period / count as f64,
            first: 0.0,
            count,
            period,
        }
    }

    #[inline]
    fn cell(&self, place: f64) -> usize {
        let place = if self.period > 0.0 {
            place - self.period * (place / self.period).floor()
        } else {
            place
        };
        whole((place / self.size).floor() - self.first).min(self.count - 1)
    }

    /// The cells beside one and itself, in order.
    #[inline]
    fn beside(&self, cell: usize) -> impl Iterator<Item = usize> + use<> {
        let count = self.count;
        let (low, high) = if self.period == 0.0 {
            (cell.saturating_sub(1), (cell + 1).min(count - 1))
        } else if count == 1 {
            (0, 0)
        } else {
            (cell + count - 1, cell + count + 1)
        };
        (low..=high).map(move |index| if index >= count { index % count } else { index })
    }
}

/// Most cells along an axis of a world that repeats itself.
const MOST_AROUND: usize = 1 << 10;

/// A count of cells.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates, and is bounded after
fn whole(count: f64) -> usize {
    count as usize
}

/// Agents by the cells they are in.
#[derive(Clone, Debug, Default)]
pub struct Grid {
    axes: [Axis; 2],
    period: Period,
    /// First agent of every cell, and the number of agents.
    starts: Vec<u32>,
    /// Cell of every agent as they came.
    cells: Vec<u32>,
    /// The agents, sorted by cell, then number.
    agents: Vec<Agent>,
    /// Their coordinates and numbers, side by side.
    x: Vec<f64>,
    y: Vec<f64>,
    numbers: Vec<u32>,
    all_pairs: bool,
}

impl Grid {
    /// Sorts agents, given by rising number, into cells of a size in m; infinite: everybody is looked at.
    pub fn fill(&mut self, agents: &[Agent], reach: f64, period: Period) {
        self.period = period;
        self.all_pairs = agents.len() <= FEW || !reach.is_finite();
        self.agents.clear();
        self.agents.extend_from_slice(agents);
        if !self.all_pairs {
            self.sort(agents, reach);
        }
        let (x, y, numbers) = (&mut self.x, &mut self.y, &mut self.numbers);
        x.clear();
        x.extend(self.agents.iter().map(|agent| agent.position.x));
        y.clear();
        y.extend(self.agents.iter().map(|agent| agent.position.y));
        numbers.clear();
        numbers.extend(self.agents.iter().map(|agent| agent.number));
    }

    /// Sorts by cells.
    fn sort(&mut self, agents: &[Agent], reach: f64) {
        self.lay(agents, reach);
        let cells = self.axes[0].count * self.axes[1].count;
        self.starts.clear();
        self.starts.resize(cells + 1, 0);
        self.cells.clear();
        for agent in agents {
            let cell = self.cell(agent.position);
            self.cells.push(cell);
            self.starts[cell as usize + 1] += 1;
        }
        for cell in 0..cells {
            self.starts[cell + 1] += self.starts[cell];
        }
        for (agent, cell) in agents.iter().zip(&self.cells) {
            let next = &mut self.starts[*cell as usize];
            self.agents[*next as usize] = *agent;
            *next += 1;
        }
        // Every start has become the next one.
        self.starts.rotate_right(1);
        self.starts[0] = 0;
    }

    /// Chooses the cells.
    fn lay(&mut self, agents: &[Agent], reach: f64) {
        let mut low = Vector::repeat(f64::INFINITY);
        let mut high = -low;
        for agent in agents {
            low = low.inf(&agent.position);
            high = high.sup(&agent.position);
        }
        let most = 4.0 * agents.len() as f64 + SPARE_CELLS;
        let mut size = reach;
        loop {
            let axis = |index: usize| match self.period.0[index] {
                length if length > 0.0 => Axis::around(length, size),
                _ => Axis::between(low[index], high[index], size),
            };
            self.axes = [axis(0), axis(1)];
            let cells = self.axes[0].count as f64 * self.axes[1].count as f64;
            if cells <= most {
                return;
            }
            size *= (cells / most).sqrt().max(2.0);
        }
    }

    #[inline]
    #[allow(clippy::cast_possible_truncation)] // at most 4 N + 1024 cells
    fn cell(&self, place: Vector) -> u32 {
        let [x, y] = &self.axes;
        (y.cell(place.y) * x.count + x.cell(place.x)) as u32
    }

    /// The agents in the order in which they are best looked at.
    #[must_use]
    pub fn agents(&self) -> &[Agent] {
        &self.agents
    }

    /// Writes who is within a distance of somebody, whose square is given, to the front of a list that has room for
    /// everybody; returns how many there are.
    #[inline(always)]
    fn find(&self, own: &Agent, reach: f64, found: &mut [u32]) -> usize {
        if self.all_pairs {
            return self.keep(0..self.agents.len(), (own, reach), found, 0);
        }
        let [x, y] = &self.axes;
        let (column, row) = (x.cell(own.position.x), y.cell(own.position.y));
        let mut count = 0;
        for row in y.beside(row) {
            if x.period == 0.0 {
                let first = row * x.count + column.saturating_sub(1);
                let last = row * x.count + (column + 1).min(x.count - 1);
                let range = self.starts[first] as usize..self.starts[last + 1] as usize;
                count = self.keep(range, (own, reach), found, count);
                continue;
            }
            for column in x.beside(column) {
                let cell = row * x.count + column;
                let range = self.starts[cell] as usize..self.starts[cell + 1] as usize;
                count = self.keep(range, (own, reach), found, count);
            }
        }
        count
    }

    /// Adds those of a range to a list that has so many already; without a branch, as nobody knows who is near.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation)] // at most a million agents
    fn keep(
        &self,
        range: Range<usize>,
        (own, reach): (&Agent, f64),
        found: &mut [u32],
        mut count: usize,
    ) -> usize {
        let places = self.x[range.clone()].iter().zip(&self.y[range.clone()]);
        let numbered = places.zip(&self.numbers[range.clone()]);
        for (((x, y), number), index) in numbered.zip(range.start as u32..) {
            let offset = self.period.wrap(own.position - Vector::new(*x, *y));
            let (far, another) = (offset.dot(&offset) > reach, *number != own.number);
            found[count] = index;
            count += usize::from(!far & another);
        }
        count
    }
}

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
        let everybody = people.agents.len() + robots.agents.len();
        if list.len() < everybody {
            list.resize(everybody, 0);
        }
        let reach = cutoff * cutoff;
        let first = people.find(own, reach, list);
        let (near, rest) = list.split_at_mut(first);
        let mut second = 0;
        if !robots.agents.is_empty() && (awareness > 0.0 || unnoticed == Unnoticed::Told) {
            second = robots.find(own, reach, rest);
        }
        Near {
            own,
            period: people.period,
            kinds: [
                Kind {
                    agents: &people.agents,
                    near,
                    weight: 1.0,
                },
                Kind {
                    agents: &robots.agents,
                    near: &rest[..second],
                    weight: awareness,
                },
            ],
        }
    }
}

/// People or robots near a person.
#[derive(Clone, Copy, Debug)]
struct Kind<'a> {
    agents: &'a [Agent],
    near: &'a [u32],
    weight: f64,
}

/// How many others are looked at side by side.
pub const WIDTH: usize = 4;

/// A number of each of them.
pub type Each = Lanes<WIDTH>;

/// Those near a person.
#[derive(Clone, Debug)]
pub struct Near<'a> {
    own: &'a Agent,
    period: Period,
    kinds: [Kind<'a>; 2],
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

/// Some who are near a person, side by side; the last one also fills the lanes that are left over.
#[derive(Clone, Copy, Debug)]
pub struct Others<'a> {
    /// Who they are.
    pub agents: [&'a Agent; WIDTH],
    /// How many there are.
    pub count: usize,
    /// `r`, from the neighbor to the person, in m.
    pub offset: Vector2<Each>,
    /// `d = |r|` in m.
    pub distance: Each,
    /// `n = r/d`.
    pub normal: Vector2<Each>,
    /// `w`: 1 for people, the awareness of the person for robots.
    pub weight: Each,
}

impl<'a> Others<'a> {
    #[inline(always)]
    fn new(
        own: &Agent,
        period: Period,
        agents: [&'a Agent; WIDTH],
        count: usize,
        weight: Each,
    ) -> Self {
        let place: Vector2<Each> = Planar::<Each>::splat(own.position.into());
        let mut offset = place - gathered(&agents, |agent| agent.position);
        if period != Period::default() {
            let wrapped: [_; WIDTH] =
                std::array::from_fn(|lane| period.wrap(offset.lane(lane).into()));
            offset = Vector2::new(
                Each::from_fn(|lane| wrapped[lane].x),
                Each::from_fn(|lane| wrapped[lane].y),
            );
        }
        let distance = offset.dot(&offset).sqrt();
        let mut normal = Vector2::new(offset.x / distance, offset.y / distance);
        let together = distance.lt(Each::splat(SHORTEST));
        if together.any() {
            let side = |lane: usize| {
                if own.number < agents[lane].number {
                    1.0
                } else {
                    -1.0
                }
            };
            let apart = Vector2::new(Each::from_fn(side), Each::zero());
            normal = Planar::<Each>::select(together, apart, normal);
        }
        Self {
            agents,
            count,
            offset,
            distance,
            normal,
            weight,
        }
    }

    /// Their velocities in m/s.
    #[inline(always)]
    #[must_use]
    pub fn velocity(&self) -> Vector2<Each> {
        gathered(&self.agents, |agent| agent.velocity)
    }

    /// Where they want to go, or move.
    #[inline(always)]
    #[must_use]
    pub fn direction(&self) -> Vector2<Each> {
        gathered(&self.agents, |agent| agent.direction)
    }

    /// Their radii in m.
    #[inline(always)]
    #[must_use]
    pub fn radius(&self) -> Each {
        Each::from_fn(|lane| self.agents[lane].radius)
    }

    /// Which lanes are theirs.
    #[inline(always)]
    #[must_use]
    pub fn present(&self) -> LaneMask<WIDTH> {
        Each::from_fn(|lane| lane as f64).lt(Each::splat(self.count as f64))
    }

    /// Adds what belongs to each of them to a sum, one after the other.
    #[inline(always)]
    pub fn add(&self, vectors: Vector2<Each>, sum: &mut Vector) {
        // Minus zero changes no bit of a sum.
        let nothing: Vector2<Each> = Planar::<Each>::splat([-0.0; 2]);
        let vectors = Planar::<Each>::select(self.present(), vectors, nothing);
        for lane in 0..WIDTH {
            *sum += Vector::from(vectors.lane(lane));
        }
    }
}

/// A vector of each.
#[inline(always)]
fn gathered(agents: &[&Agent; WIDTH], of: impl Fn(&Agent) -> Vector) -> Vector2<Each> {
    Vector2::new(
        Each::from_fn(|lane| of(agents[lane]).x),
        Each::from_fn(|lane| of(agents[lane]).y),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

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
