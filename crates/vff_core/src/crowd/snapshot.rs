//! Decisions of everybody from the same snapshot.

use crate::crowd::agent::Agent;
use crate::crowd::grid::{Grid, Period};
use crate::crowd::models::Model;
use crate::crowd::neighbors::Neighbors;
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
        let Self {
            people,
            robots,
            room,
            ..
        } = self;
        let around = Around {
            neighbors: Neighbors { people, robots },
            walls: setting.walls,
            company: setting.company,
            step: setting.step,
        };
        decisions.clear();
        decisions.resize(walkers.len(), Vector2::zeros());
        pulp::Arch::new().dispatch(Job {
            around: &around,
            walkers,
            model_of,
            decisions,
            room,
        });
    }
}

/// The decisions of everybody, compiled once for each instruction set; their bits are the same for all.
struct Job<'a, F> {
    around: &'a Around<'a>,
    walkers: &'a mut [Option<Walker>],
    model_of: F,
    decisions: &'a mut [Vector2<f64>],
    room: &'a mut Room,
}

impl<'m, F: Fn(usize) -> &'m Model> pulp::NullaryFnOnce for Job<'_, F> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for agent in self.around.neighbors.people.agents() {
            let number = agent.number as usize;
            if let Some(walker) = self.walkers[number]
                .as_mut()
                .filter(|walker| walker.decides)
            {
                let model = (self.model_of)(number);
                self.decisions[number] = model.decide(walker, self.around, self.room);
            }
        }
    }
}
