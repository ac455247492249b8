//! Certificates that a world can be solved: sets of places that a patient robot can have reached at an instant.
//!
//! People walk as they would without robots. Places are nodes of a lattice; from one instant to the next the robot comes
//! as far as its speed allows, and only to nodes that are free. Whoever knows the future arrives on such a way though
//! nobody gives way.

use std::sync::Arc;

use crate::crowd::simulation::Simulation;
use crate::crowd::world::{CrowdWorld, count_of};
use crate::run::Interrupted;
use numeric::error::{Failure, Given, Result};
use numeric::lanes::Vector2;
use numeric::threads;

type Vector = Vector2<f64>;

/// Distance of the nodes in m.
const SPACING: f64 = 0.05;
/// Time between two sets in s; people are looked at half of it before and after.
const INTERVAL: f64 = 0.2;
/// Sets in a second.
const RATE: f64 = 5.0;
/// Steps of the lattice by which a node is reached within an interval: 0.16 m, at 0.8 m/s.
const REACH: isize = 3;
/// Columns to either side that are reached in rows 0 to 3 away.
const COLUMNS: [u8; 4] = [3, 3, 2, 1];
/// Clearance from walls and from people in m, beyond the radii.
const WALL_ROOM: f64 = 0.08;
const PERSON_ROOM: f64 = 0.05;
/// A node is at the goal within this distance in m.
const AT_GOAL: f64 = 0.3;
/// Room beyond walls, start and goal in m.
const AROUND: f64 = 3.0;
/// Most nodes.
const MOST_NODES: f64 = 2e7;
/// Most bits of all sets: 500 MB.
const MOST_BITS: f64 = 4e9;

/// The way of a robot that arrives as early as possible.
#[derive(Clone, Debug, PartialEq)]
pub struct Certificate {
    /// Time of arrival in s.
    pub arrival: f64,
    /// Places every 0.2 s, in m.
    pub path: Vec<[f64; 2]>,
}

/// Nodes around a start, a bit each.
struct Lattice {
    start: Vector,
    /// Nodes left of and below the start.
    before: [usize; 2],
    columns: usize,
    rows: usize,
    /// Words of a row.
    words: usize,
}

impl Lattice {
    fn new(world: &CrowdWorld, start: Vector, goal: Vector) -> Result<Self> {
        let (mut low, mut high) = (start.inf(&goal), start.sup(&goal));
        for wall in &world.walls {
            for point in wall.corners() {
                (low, high) = (low.inf(&point), high.sup(&point));
            }
        }
        let counts = |way: Vector| [way.x, way.y].map(|way| ((way + AROUND) / SPACING).ceil());
        let (before, after) = (counts(start - low), counts(high - start));
        let sides = [0, 1].map(|axis| before[axis] + after[axis] + 1.0);
        if sides[0] * sides[1] > MOST_NODES {
            let rule = format!(
                "span at most {MOST_NODES} nodes of {SPACING} m with start, goal and walls"
            );
            return Err(Failure::invalid(
                "world",
                rule,
                Given::Number(sides[0] * sides[1]),
            ));
        }
        let [columns, rows] = sides.map(count_of);
        Ok(Self {
            start,
            before: before.map(count_of),
            columns,
            rows,
            words: columns.div_ceil(64),
        })
    }

    fn place(&self, column: usize, row: usize) -> Vector {
        let along = |index: usize, before: usize| (index as f64 - before as f64) * SPACING;
        self.start + Vector::new(along(column, self.before[0]), along(row, self.before[1]))
    }

    /// No node.
    fn none(&self) -> Vec<u64> {
        vec![0; self.rows * self.words]
    }

    /// Word and bit of a node.
    fn bit(&self, column: usize, row: usize) -> (usize, u64) {
        (row * self.words + column / 64, 1 << (column % 64))
    }

    /// Column and row of the lowest bit of a word.
    fn node(&self, word: usize, bits: u64) -> (usize, usize) {
        let bit = bits.trailing_zeros() as usize;
        (word % self.words * 64 + bit, word / self.words)
    }

    fn holds(&self, set: &[u64], column: usize, row: usize) -> bool {
        let (word, bit) = self.bit(column, row);
        set[word] & bit != 0
    }

    /// The nodes within reach of a set; bits beyond the last column are those of no free node.
    fn reached(&self, set: &[u64]) -> Vec<u64> {
        let mut wide = vec![0_u64; set.len()];
        for row in 0..self.rows {
            let line = &set[row * self.words..(row + 1) * self.words];
            if line.iter().all(|word| *word == 0) {
                continue;
            }
            for away in 0..=REACH {
                for side in if away == 0 {
                    &[0_isize][..]
                } else {
                    &[-1, 1][..]
                } {
                    let Some(other) = row.checked_add_signed(side * away) else {
                        continue;
                    };
                    if other < self.rows {
                        let target = &mut wide[other * self.words..(other + 1) * self.words];
                        spread(line, COLUMNS[away.unsigned_abs()], target);
                    }
                }
            }
        }
        wide
    }

    /// Columns and rows of the nodes in a square around a place, and their distances from it in m.
    fn around(&self, place: Vector, half: f64) -> impl Iterator<Item = ((usize, usize), f64)> + '_ {
        let way = place - self.start;
        let range = |along: f64, before: usize, count: usize| {
            let first = ((along - half) / SPACING).floor() + before as f64;
            let last = ((along + half) / SPACING).ceil() + before as f64;
            (last >= 0.0).then(|| count_of(first.max(0.0))..=count_of(last).min(count - 1))
        };
        let columns = range(way.x, self.before[0], self.columns);
        let rows = range(way.y, self.before[1], self.rows);
        let both = columns.zip(rows).into_iter();
        both.flat_map(move |(columns, rows)| {
            rows.flat_map(move |row| {
                let node = move |column| (column, row);
                columns.clone().map(node)
            })
        })
        .map(move |(column, row)| ((column, row), (self.place(column, row) - place).norm()))
    }

    /// Takes the nodes away that are nearer to a place than a distance.
    fn clear_disc(&self, set: &mut [u64], place: Vector, least: f64) {
        for ((column, row), distance) in self.around(place, least) {
            if distance < least {
                let (word, bit) = self.bit(column, row);
                set[word] &= !bit;
            }
        }
    }

    /// A node of a set within reach of a node.
    fn before(&self, set: &[u64], column: usize, row: usize) -> Option<(usize, usize)> {
        for down in -REACH..=REACH {
            let wide = isize::from(COLUMNS[down.unsigned_abs()]);
            for left in -wide..=wide {
                let other = column
                    .checked_add_signed(left)
                    .zip(row.checked_add_signed(down));
                if let Some((column, row)) =
                    other.filter(|(column, row)| *column < self.columns && *row < self.rows)
                    && self.holds(set, column, row)
                {
                    return Some((column, row));
                }
            }
        }
        None
    }
}

/// Nodes that are far enough from the walls, of those that were asked for.
struct OpenNodes {
    known: Vec<u64>,
    open: Vec<u64>,
}

impl OpenNodes {
    fn new(lattice: &Lattice) -> Self {
        Self {
            known: lattice.none(),
            open: lattice.none(),
        }
    }

    /// Keeps of a set what is open, by a rule for places.
    fn keep(&mut self, lattice: &Lattice, set: &mut [u64], rule: impl Fn(Vector) -> bool) {
        let all = set.iter_mut().zip(&mut self.known).zip(&mut self.open);
        for (word, ((set, known), open)) in all.enumerate() {
            let mut asked = *set & !*known;
            while asked != 0 {
                let bit = asked & asked.wrapping_neg();
                let (column, row) = lattice.node(word, bit);
                if column < lattice.columns && rule(lattice.place(column, row)) {
                    *open |= bit;
                }
                asked &= !bit;
            }
            *known |= *set;
            *set &= *open;
        }
    }
}

/// Adds a row of bits, and those up to some columns away, to another row.
fn spread(line: &[u64], columns: u8, target: &mut [u64]) {
    for (index, word) in line.iter().enumerate() {
        let left = if index > 0 { line[index - 1] } else { 0 };
        let right = line.get(index + 1).copied().unwrap_or(0);
        let mut wide = *word;
        for shift in 1..=columns {
            wide |= word << shift | left >> (64 - shift) | word >> shift | right << (64 - shift);
        }
        target[index] |= wide;
    }
}

/// The certificates of many worlds, spread over threads.
///
/// # Errors
/// Errors of [`certify`], with the index of the world.
pub fn certify_all(
    worlds: &[Arc<CrowdWorld>],
    threads: Option<usize>,
    interrupted: Interrupted<'_>,
) -> Result<Vec<Option<Certificate>>> {
    threads::on_threads(threads, || {
        threads::try_map(worlds.len(), |index| {
            let found = certify(&worlds[index], interrupted);
            found.map_err(|error| error.within(&format!("worlds[{index}]")))
        })
    })
}

/// The certificate of the first robot of a world; `None` if it cannot arrive within the time limit.
///
/// # Errors
/// There is no robot, the world repeats itself, its step is no part of 0.1 s, it is too large, a rule is broken, or the
/// caller asked to stop.
pub fn certify(world: &CrowdWorld, interrupted: Interrupted<'_>) -> Result<Option<Certificate>> {
    let Some(robot) = world.robots.first() else {
        let given = Given::Count(0);
        return Err(Failure::invalid("robots", "be one robot or more", given));
    };
    if world.period.0 != [0.0; 2] {
        let given = Given::Pair(world.period.0);
        return Err(Failure::invalid(
            "period",
            "be (0, 0) for a certificate",
            given,
        ));
    }
    let steps = (0.5 * INTERVAL / world.step).round();
    if steps < 1.0 || (steps * world.step - 0.5 * INTERVAL).abs() > 1e-9 {
        let rule = format!("divide {} s for a certificate", 0.5 * INTERVAL);
        return Err(Failure::invalid("step", rule, Given::Number(world.step)));
    }
    let (start, goal, radius) = (robot.start.into(), Vector::from(robot.goal), robot.radius());
    let lattice = Lattice::new(world, start, goal)?;
    let bits = lattice.rows as f64 * lattice.words as f64 * 64.0;
    if bits * world.time_limit / INTERVAL > MOST_BITS {
        let rule = "be shorter for a certificate in so large a place";
        return Err(Failure::invalid(
            "time_limit",
            rule,
            Given::Number(world.time_limit),
        ));
    }
    let alone = CrowdWorld {
        robots: Vec::new(),
        ..world.clone()
    };
    let mut ended = Simulation::new(Arc::new(alone), true)?.completed(interrupted)?;
    let record = ended.take_recorded().unwrap_or_default();
    let (people, instants) = (record.people(), record.time.len());
    let radii: Vec<f64> = ended.people().iter().map(|person| person.radius).collect();
    let positions = record.person_positions();
    let half = count_of(steps);
    let room = radius + WALL_ROOM;
    let is_open = |place| world.walls.iter().all(|wall| wall.clearance(place) >= room);
    let mut open = OpenNodes::new(&lattice);
    let mut at_goal = lattice.none();
    for ((column, row), distance) in lattice.around(goal, AT_GOAL) {
        if distance <= AT_GOAL {
            let (word, bit) = lattice.bit(column, row);
            at_goal[word] |= bit;
        }
    }
    let mut first = lattice.none();
    let (word, bit) = lattice.bit(lattice.before[0], lattice.before[1]);
    first[word] = bit;
    let mut sets = vec![first];
    let last = count_of((world.time_limit / INTERVAL + 1e-9).floor());
    loop {
        let number = sets.len() - 1;
        let found = sets[number]
            .iter()
            .zip(&at_goal)
            .position(|(set, goal)| set & goal != 0);
        if let Some(word) = found {
            let node = lattice.node(word, sets[number][word] & at_goal[word]);
            return Ok(Some(way_back(&lattice, &sets, node)));
        }
        if number >= last || sets[number].iter().all(|word| *word == 0) {
            return Ok(None);
        }
        if interrupted() {
            return Err(Failure::Interrupted);
        }
        let mut next = lattice.reached(&sets[number]);
        open.keep(&lattice, &mut next, is_open);
        for instant in (2 * number + 1..=2 * number + 3).map(|part| (part * half).min(instants - 1))
        {
            for (person, own) in radii.iter().enumerate() {
                let at = 2 * (instant * people + person);
                let place = Vector::new(positions[at], positions[at + 1]);
                if !place.x.is_nan() {
                    lattice.clear_disc(&mut next, place, radius + own + PERSON_ROOM);
                }
            }
        }
        sets.push(next);
    }
}

/// The way to a node of the last set.
fn way_back(lattice: &Lattice, sets: &[Vec<u64>], node: (usize, usize)) -> Certificate {
    let mut path = vec![node];
    for set in sets.iter().rev().skip(1) {
        let (column, row) = path[path.len() - 1];
        path.extend(lattice.before(set, column, row));
    }
    let path = path
        .iter()
        .rev()
        .map(|(column, row)| lattice.place(*column, *row).into());
    Certificate {
        arrival: (sets.len() - 1) as f64 / RATE,
        path: path.collect(),
    }
}
