//! Agents in a uniform grid, or in a list where few are present.

use std::ops::Range;

use crate::crowd::agent::Agent;
use numeric::lanes::Vector2;

type Vector = Vector2<f64>;

/// Up to so many agents are looked at one by one.
pub(crate) const FEW: usize = 24;

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
    pub(crate) period: Period,
    /// First agent of every cell, and the number of agents.
    starts: Vec<u32>,
    /// Numbers, positions and cells of the agents as they came.
    came: Vec<u32>,
    spots: Vec<Vector>,
    cells: Vec<u32>,
    /// Their numbers, sorted by cell, then number.
    order: Vec<u32>,
    /// The agents in this order.
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
        let positions = agents.iter().map(|agent| agent.position);
        self.order((0..).zip(positions), reach, period);
        self.seat(|index| agents[index]);
    }

    /// Finds the order of agents at positions, which come with rising numbers.
    pub(crate) fn order(
        &mut self,
        agents: impl Iterator<Item = (u32, Vector)>,
        reach: f64,
        period: Period,
    ) {
        self.period = period;
        let most = agents.size_hint().1.unwrap_or(0);
        self.came.clear();
        self.came.reserve(most);
        self.spots.clear();
        self.spots.reserve(most);
        let (mut low, mut high) = (
            Vector::repeat(f64::INFINITY),
            Vector::repeat(-f64::INFINITY),
        );
        for (number, position) in agents {
            low = low.inf(&position);
            high = high.sup(&position);
            self.came.push(number);
            self.spots.push(position);
        }
        self.all_pairs = self.came.len() <= FEW || !reach.is_finite();
        self.order.clone_from(&self.came);
        if self.all_pairs {
            return;
        }
        self.lay([low, high], reach);
        self.count();
        for (number, cell) in self.came.iter().zip(&self.cells) {
            let next = &mut self.starts[*cell as usize];
            self.order[*next as usize] = *number;
            *next += 1;
        }
        // Every start has become the next one.
        self.starts.rotate_right(1);
        self.starts[0] = 0;
    }

    /// Takes the agents by their numbers to their places. They are read across memory and written one after the
    /// other: the other way round each would wait for several writes.
    pub(crate) fn seat(&mut self, mut agent_of: impl FnMut(usize) -> Agent) {
        let count = self.order.len();
        self.agents.resize(count, Agent::default());
        self.x.resize(count, 0.0);
        self.y.resize(count, 0.0);
        self.numbers.resize(count, 0);
        let columns = self.x.iter_mut().zip(&mut self.y).zip(&mut self.numbers);
        let places = self.agents.iter_mut().zip(columns);
        for (index, (place, ((x, y), number))) in self.order.iter().zip(places) {
            let agent = agent_of(*index as usize);
            (*x, *y, *number) = (agent.position.x, agent.position.y, agent.number);
            *place = agent;
        }
    }

    /// Finds the cells of the positions, and the first place of each cell.
    fn count(&mut self) {
        let cells = self.axes[0].count * self.axes[1].count;
        self.starts.clear();
        self.starts.resize(cells + 1, 0);
        self.cells.clear();
        self.cells.reserve(self.spots.len());
        for position in &self.spots {
            let cell = self.cell(*position);
            self.cells.push(cell);
            self.starts[cell as usize + 1] += 1;
        }
        for cell in 0..cells {
            self.starts[cell + 1] += self.starts[cell];
        }
    }

    /// Chooses the cells between the least and the greatest coordinates.
    fn lay(&mut self, [low, high]: [Vector; 2], reach: f64) {
        let most = 4.0 * self.came.len() as f64 + SPARE_CELLS;
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
    #[inline]
    #[must_use]
    pub fn agents(&self) -> &[Agent] {
        &self.agents
    }

    /// Writes who is within a distance of somebody, whose square is given, to the front of a list that has room for
    /// everybody; returns how many there are.
    #[inline(always)]
    pub(crate) fn find(&self, own: &Agent, reach: f64, found: &mut [u32]) -> usize {
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

    /// Finds neighbors behind the agent at a place, in a world that does not repeat itself.
    #[inline(always)]
    pub(crate) fn find_behind(&self, place: usize, reach: f64, found: &mut [u32]) -> usize {
        let own = &self.agents[place];
        if self.all_pairs {
            return self.keep(place + 1..self.agents.len(), (own, reach), found, 0);
        }
        let [x, y] = &self.axes;
        let (column, row) = (x.cell(own.position.x), y.cell(own.position.y));
        let mut count = 0;
        for row in row..=(row + 1).min(y.count - 1) {
            let first = row * x.count + column.saturating_sub(1);
            let last = row * x.count + (column + 1).min(x.count - 1);
            let start = (self.starts[first] as usize).max(place + 1);
            let range = start..self.starts[last + 1] as usize;
            count = self.keep(range, (own, reach), found, count);
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
