//! What is kept of a world while it is under way.

use crate::crowd::people::PersonState;
use crate::crowd::robots::CrowdRobot;
use crate::lanes::Vector2;

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
    person_position: Vec<Vector2<f64>>,
    /// Their velocities in m/s.
    person_velocity: Vec<Vector2<f64>>,
}

impl Trajectories {
    pub(super) fn clear(&mut self) {
        self.time.clear();
        self.robot_position.clear();
        self.robot_velocity.clear();
        self.robot_heading.clear();
        self.counts.clear();
        self.person_position.clear();
        self.person_velocity.clear();
    }

    pub(super) fn push(&mut self, time: f64, people: &[PersonState], robots: &[CrowdRobot]) {
        let absent = Vector2::repeat(f64::NAN);
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
            let shown = |vector| if there { vector } else { absent };
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
        self.filled(&self.person_position)
    }

    /// Their velocities in m/s, likewise.
    #[must_use]
    pub fn person_velocities(&self) -> Vec<f64> {
        self.filled(&self.person_velocity)
    }

    fn filled(&self, rows: &[Vector2<f64>]) -> Vec<f64> {
        let people = self.people();
        let mut all = vec![f64::NAN; 2 * people * self.time.len()];
        let mut first = 0;
        for (row, count) in all.chunks_exact_mut((2 * people).max(1)).zip(&self.counts) {
            for (cell, vector) in row.chunks_exact_mut(2).zip(&rows[first..first + count]) {
                cell.copy_from_slice(vector.as_slice());
            }
            first += count;
        }
        all
    }
}
