//! Decisions of everybody from the same snapshot.

use crate::crowd::agent::Agent;
use crate::crowd::models::Model;
use crate::crowd::neighbors::{Grid, Neighbors, Period};
use crate::crowd::pedestrian::{Around, Fellows, Pedestrian, Room, Walker};
use crate::crowd::walls::Wall;
use crate::lanes::Vector2;

/// What is the same for everybody.
#[derive(Clone, Copy, Debug)]
pub struct Setting<'a> {
    /// What stands.
    pub walls: &'a [Wall],
    /// Who belongs together.
    pub company: &'a dyn Fellows,
    /// Lengths after which the world repeats itself.
    pub period: Period,
    /// Farthest distance in m at which anybody acts, the size of the cells.
    pub reach: f64,
    /// How long decisions hold, in s.
    pub step: f64,
}

/// Who is where at an instant, and room for decisions.
#[derive(Clone, Debug, Default)]
pub struct Snapshot {
    present: Vec<Agent>,
    people: Grid,
    robots: Grid,
    room: Room,
}

impl Snapshot {
    /// Decides for everybody: `walkers` by number, `None` for people who are absent. Decisions come back under
    /// the same number, in m/s^2 or m/s; headings change in place.
    pub fn decide<'m>(
        &mut self,
        setting: &Setting<'_>,
        walkers: &mut [Option<Walker>],
        robots: &[Agent],
        model_of: impl Fn(usize) -> &'m Model,
        decisions: &mut Vec<Vector2<f64>>,
    ) {
        self.present.clear();
        let present = walkers.iter().flatten();
        self.present.extend(present.map(|walker| walker.agent));
        let Setting { reach, period, .. } = *setting;
        self.people.fill(&self.present, reach, period);
        self.robots.fill(robots, reach, period);
        let around = Around {
            neighbors: Neighbors {
                people: &self.people,
                robots: &self.robots,
            },
            walls: setting.walls,
            company: setting.company,
            step: setting.step,
        };
        decisions.clear();
        decisions.resize(walkers.len(), Vector2::zeros());
        for agent in self.people.agents() {
            let number = agent.number as usize;
            if let Some(walker) = walkers[number].as_mut().filter(|walker| walker.decides) {
                let model = model_of(number);
                decisions[number] = model.decide(walker, &around, &mut self.room);
            }
        }
    }
}
