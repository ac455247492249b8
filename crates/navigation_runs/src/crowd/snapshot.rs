//! Decisions of everybody from the same snapshot.

use crate::crowd::agent::Agent;
use crate::crowd::models::Model;
use crate::crowd::neighbors::Neighbors;
use crate::crowd::neighbors::grid::{Grid, Period};
use crate::crowd::pedestrian::{Around, Fellows, PersonDecision, Room, Walker};
use crate::crowd::walls::Wall;
use numeric::lanes::vectors;

/// Inputs of decisions that all people share.
#[derive(Clone, Copy, Debug)]
pub struct CrowdSetting<'a> {
    /// Walls of the world.
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

/// Which models people have.
#[derive(Clone, Copy)]
pub enum Models<'a, 'm> {
    /// All the same one.
    Shared(&'m Model),
    /// By their numbers.
    // Not one copy of all models for each caller.
    Of(&'a dyn Fn(usize) -> &'m Model),
}

impl<'m> Models<'_, 'm> {
    /// The model of a person by number.
    #[inline(always)]
    fn of(&self, number: usize) -> &'m Model {
        match self {
            Self::Shared(model) => model,
            Self::Of(model_of) => model_of(number),
        }
    }

    /// The model of everybody, if all have the same one.
    #[inline(always)]
    fn shared(&self, people: &[Agent]) -> Option<&'m Model> {
        if let Self::Shared(model) = self {
            return Some(model);
        }
        let mut models = people.iter().map(|agent| self.of(agent.number as usize));
        let model = models.next()?;
        models
            .all(|other| std::ptr::eq(other, model))
            .then_some(model)
    }
}

/// Who is where at an instant, and room for decisions.
#[derive(Clone, Debug, Default)]
pub struct Snapshot {
    people: Grid,
    robots: Grid,
    /// People who are present, in the order of their grid.
    placed: Vec<Walker>,
    room: Room,
}

impl Snapshot {
    /// Decides for everybody: how many people there may be, and who they are by number, `None` for people who are
    /// absent. Decisions come back under the same number.
    #[allow(clippy::cast_possible_truncation)] // at most a million people
    pub fn decide(
        &mut self,
        setting: &CrowdSetting<'_>,
        (count, walker_of): (usize, impl Fn(usize) -> Option<Walker>),
        robots: &[Agent],
        models: Models<'_, '_>,
        decisions: &mut Vec<PersonDecision>,
    ) {
        let CrowdSetting { reach, period, .. } = *setting;
        let present = (0..count).filter_map(|number| {
            let position = walker_of(number)?.agent.position;
            Some((number as u32, position))
        });
        self.people.order(present, reach, period);
        self.placed.clear();
        self.placed.reserve(count);
        self.people.seat(|number| {
            // Who came first is still there.
            let walker = walker_of(number).unwrap_or_default();
            self.placed.push(walker);
            walker.agent
        });
        self.robots.fill(robots, reach, period);
        decisions.clear();
        decisions.resize(count, PersonDecision::default());
        self.decide_placed(setting, models, decisions);
    }

    /// Decides once all people have a place; compiled once for every kind of groups.
    #[inline(never)]
    fn decide_placed(
        &mut self,
        setting: &CrowdSetting<'_>,
        models: Models<'_, '_>,
        decisions: &mut [PersonDecision],
    ) {
        let Self {
            people,
            robots,
            placed,
            room,
        } = self;
        let around = Around {
            neighbors: Neighbors { people, robots },
            walls: setting.walls,
            company: setting.company,
            step: setting.step,
        };
        let job = DecisionJob {
            around: &around,
            placed,
            models,
            decisions,
            room,
        };
        match vectors() {
            Some(vectors) => pulp::Simd::vectorize(vectors, job),
            None => job.one_by_one(),
        }
    }
}

/// The decisions of everybody: with vectors those of pairs together, else one by one with the same bits.
struct DecisionJob<'a, 'm> {
    around: &'a Around<'a>,
    placed: &'a mut [Walker],
    models: Models<'a, 'm>,
    decisions: &'a mut [PersonDecision],
    room: &'a mut Room,
}

impl pulp::NullaryFnOnce for DecisionJob<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let together = self.mutual().is_some_and(|model| {
            model.decide_together(self.placed, self.around, self.room, self.decisions)
        });
        if !together {
            self.one_by_one();
        }
    }
}

impl<'m> DecisionJob<'_, 'm> {
    /// The model of everybody, if all have the same one and the world does not repeat itself.
    #[inline(always)]
    fn mutual(&self) -> Option<&'m Model> {
        let people = self.around.neighbors.people;
        let plain = people.period == Period::default();
        plain.then(|| self.models.shared(people.agents())).flatten()
    }

    #[inline(always)]
    fn one_by_one(self) {
        for own in self.placed.iter_mut().filter(|own| own.decides) {
            let number = own.agent.number as usize;
            let order = self.models.of(number).decide(own, self.around, self.room);
            self.decisions[number] = PersonDecision::of(own, order);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::crowd::agent::{FIRST_ROBOT, direction_of};
    use crate::crowd::models::of_pairs;
    use crate::crowd::pedestrian::Groupings;
    use numeric::lanes::Vector2;
    use numeric::random::Stream;

    type Vector = Vector2<f64>;

    fn drawn(stream: &mut Stream, number: u32, side: f64) -> Agent {
        let mut draw =
            |size: f64| Vector::new(stream.uniform(-size, size), stream.uniform(-size, size));
        Agent {
            position: draw(side),
            velocity: draw(1.0),
            direction: direction_of(draw(1.0)),
            radius: 0.25,
            number,
        }
    }

    /// People, of whom some are absent, at one place, at rest or follow a recording, and robots.
    fn scene(stream: &mut Stream, count: u32, robots: u32) -> (Vec<Option<Walker>>, Vec<Agent>) {
        let side = f64::from(count).sqrt() * 0.7;
        let mut walkers: Vec<Option<Walker>> = (0..count)
            .map(|number| {
                Some(Walker {
                    agent: drawn(stream, number, side),
                    desired_speed: 1.3,
                    decides: number % 7 != 5,
                    to_go: 3.0,
                    stays: number % 5 == 4,
                    heading: Vector::x(),
                    awareness: f64::from(number % 3) * 0.5,
                })
            })
            .collect();
        if count > 4 {
            // The first walks to the place of the second within a step; the others stand where he is.
            let motions = [[0.0, 1.0], [0.25, 0.0], [0.0; 2], [0.0; 2]];
            for (walker, [x, speed]) in walkers.iter_mut().flatten().zip(motions) {
                walker.agent.position = Vector::new(x, 0.0);
                walker.agent.velocity = Vector::new(speed, 0.0);
            }
            walkers[4] = None;
        }
        let robots = (0..robots).map(|index| drawn(stream, FIRST_ROBOT + index, side));
        (walkers, robots.collect())
    }

    #[test]
    fn pairs_looked_at_once_decide_as_everybody_alone() {
        let mut stream = Stream::new(17, 0);
        let walls = [Wall::polyline(vec![[-1.0, 0.5], [1.0, 0.7]]).unwrap()];
        let (mut once, mut alone) = (Snapshot::default(), Snapshot::default());
        for count in (0..30).chain([60, 300]) {
            for (robots, model) in [0, 1, 3, 30]
                .into_iter()
                .flat_map(|robots| of_pairs(2.0, 10).map(|model| (robots, model)))
            {
                let (walkers, robots) = scene(&mut stream, count, robots);
                let groups: Vec<Option<u32>> =
                    (0..count).map(|n| (n % 4 == 1).then_some(n / 8)).collect();
                let agents: Vec<Agent> = walkers
                    .iter()
                    .flatten()
                    .map(|walker| walker.agent)
                    .collect();
                let company = Groupings {
                    agents: &agents,
                    of: &groups,
                    period: Period::default(),
                };
                let setting = CrowdSetting {
                    walls: &walls,
                    company: &company,
                    period: Period::default(),
                    reach: model.cutoff(),
                    step: 0.25,
                };
                let decide = |snapshot: &mut Snapshot, models: Models<'_, '_>| {
                    let mut decisions = Vec::new();
                    let people = (walkers.len(), |number: usize| walkers[number]);
                    snapshot.decide(&setting, people, &robots, models, &mut decisions);
                    decisions
                };
                let (of_one, another) = (|_: usize| &model, model);
                let of_two = |number: usize| [&model, &another][number % 2];
                let expected = decide(&mut alone, Models::Of(&of_two));
                for models in [Models::Of(&of_one), Models::Shared(&model)] {
                    let found = decide(&mut once, models);
                    assert_eq!(found, expected, "{count} {}", robots.len());
                }
                assert_eq!(expected.len(), count as usize);
            }
        }
    }
}
