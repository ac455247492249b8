//! Recorder of a world while it is under way.

use crate::crowd::people::PersonState;
use crate::crowd::robots::CrowdRobot;
use crate::crowd::world::CrowdWorld;
use numeric::error::{Failure, Given, Result};
use numeric::lanes::Vector2;

/// Share of a step by which a time limit may miss a whole number of them.
const WHOLE: f64 = 1e-9;

/// Most places of agents that records keep together: 3 GB, twice that while those of sources are handed over.
pub(super) const MOST_ROWS: f64 = 1e8;

/// Places for which there is room from the start, where a world has so many: 16 MB of positions.
const ROOM: usize = 1 << 20;

/// Steps of a world to its end, one at least.
pub(super) fn whole_steps(world: &CrowdWorld) -> f64 {
    (world.time_limit / world.step - WHOLE).ceil().max(1.0)
}

/// Instants of a record, and agents at each.
pub(super) fn size_of_record(world: &CrowdWorld) -> (f64, f64) {
    let instants = whole_steps(world) + 1.0;
    let coming = world.sources.iter().map(|source| source.rate);
    let coming = coming.sum::<f64>() * world.time_limit;
    let agents = world.people.len() as f64 + world.robots.len() as f64 + coming;
    (instants, agents)
}

/// Refuses a record that would not fit into memory.
pub(super) fn check_rows(world: &CrowdWorld) -> Result<()> {
    let (instants, agents) = size_of_record(world);
    if instants * agents <= MOST_ROWS {
        return Ok(());
    }
    let rule = format!("be at most {MOST_ROWS} agents times steps");
    let given = Given::Number(world.time_limit);
    Err(
        Failure::invalid("time_limit", rule, given).mended_by(format!(
            "{agents} agents at {instants} instants are {}",
            instants * agents
        )),
    )
}

/// Position and velocity of who is not there.
const ABSENT: [f64; 2] = [f64::NAN; 2];

/// Where everybody was at every step of a world.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trajectories {
    /// Instants in s.
    pub time: Vec<f64>,
    /// Robots of the world.
    pub robots: usize,
    /// Positions of the robots in m, instant by instant.
    pub robot_position: Vec<Vector2<f64>>,
    /// Their velocities in m/s.
    pub robot_velocity: Vec<Vector2<f64>>,
    /// Their headings in rad.
    pub robot_heading: Vec<f64>,
    /// People at the first instant at which there were so many; rows grow as people come.
    counts: Vec<usize>,
    /// Positions of the people in m, instant by instant, NaN for those who have left.
    person_position: Vec<[f64; 2]>,
    /// Their velocities in m/s.
    person_velocity: Vec<[f64; 2]>,
}

impl Trajectories {
    /// Starts anew, in a world that has so many people and instants, or fewer.
    pub(super) fn open(&mut self, people: usize, instants: usize) {
        self.time.clear();
        self.robot_position.clear();
        self.robot_velocity.clear();
        self.robot_heading.clear();
        self.counts.clear();
        let room = people.saturating_mul(instants).min(ROOM);
        for rows in [&mut self.person_position, &mut self.person_velocity] {
            rows.clear();
            rows.reserve_exact(room);
        }
    }

    /// Gives back what was not needed of the room.
    pub(super) fn close(&mut self) {
        self.person_position.shrink_to_fit();
        self.person_velocity.shrink_to_fit();
    }

    pub(super) fn push(&mut self, time: f64, people: &[PersonState], robots: &[CrowdRobot]) {
        self.time.push(time);
        self.robots = robots.len();
        for robot in robots {
            self.robot_position.push(robot.state().position);
            self.robot_velocity.push(robot.state().velocity);
            self.robot_heading.push(robot.heading());
        }
        self.counts.push(people.len());
        for person in people {
            let there = person.is_present();
            let shown = |vector: Vector2<f64>| if there { vector.into() } else { ABSENT };
            self.person_position.push(shown(person.position));
            self.person_velocity.push(shown(person.velocity));
        }
    }

    /// Number of people, those from sources included.
    #[must_use]
    pub fn people(&self) -> usize {
        self.counts.last().copied().unwrap_or(0)
    }

    /// Positions of the people in m, a row of x and y for each instant; NaN for those who are absent.
    #[must_use]
    pub fn person_positions(&self) -> Vec<f64> {
        filled(&self.person_position, &self.counts)
    }

    /// Positions and velocities of the people, moved where the people are the same from the start to the end.
    #[must_use]
    pub fn into_people(self) -> [Vec<f64>; 2] {
        let Self {
            person_position,
            person_velocity,
            ..
        } = self;
        if self.counts.first() == self.counts.last() {
            return [person_position, person_velocity].map(Vec::into_flattened);
        }
        [person_position, person_velocity].map(|rows| filled(&rows, &self.counts))
    }
}

/// Rows of all instants that are as long as the last one, NaN for who has not yet come.
fn filled(rows: &[[f64; 2]], counts: &[usize]) -> Vec<f64> {
    let people = counts.last().copied().unwrap_or(0);
    let mut all = vec![ABSENT; people * counts.len()];
    let mut first = 0;
    for (row, count) in all.chunks_exact_mut(people.max(1)).zip(counts) {
        row[..*count].copy_from_slice(&rows[first..first + count]);
        first += count;
    }
    all.into_flattened()
}
