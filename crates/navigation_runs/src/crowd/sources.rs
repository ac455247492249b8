//! People who come while a world is under way.

use numeric::random::Stream;

use crate::crowd::neighbors::grid::Period;
use crate::crowd::people::{OfPeople, PersonState, Purpose, stream_of};
use crate::crowd::robots::CrowdRobot;
use crate::crowd::world::{CrowdWorld, SourceSetup};
use numeric::lanes::Vector2;

/// A source at work.
#[derive(Clone, Debug)]
pub(super) struct Source {
    arrivals: Stream,
    /// When the next person is due, in s.
    next: f64,
    /// People who are due and found no room.
    waiting: usize,
    /// Where they try to enter.
    places: Stream,
}

impl Source {
    pub fn new(setup: &SourceSetup, seed: u64, index: usize) -> Self {
        let mut source = Self {
            arrivals: stream_of(seed, Purpose::Arrivals, index as u64),
            next: 0.0,
            waiting: 0,
            places: stream_of(seed, Purpose::Place, index as u64),
        };
        source.wait(setup);
        source
    }

    /// Draws when the next person is due.
    fn wait(&mut self, setup: &SourceSetup) {
        let share = if setup.regular {
            1.0
        } else {
            -(1.0 - self.arrivals.unit()).ln()
        };
        self.next += share / setup.rate;
    }

    /// Lets everybody enter who is due at a time in s and finds room.
    #[allow(clippy::cast_possible_truncation)] // sources are few
    pub fn admit(
        &mut self,
        world: &CrowdWorld,
        index: usize,
        time: f64,
        people: &mut OfPeople<PersonState>,
        robots: &[CrowdRobot],
    ) {
        let setup = &world.sources[index];
        while self.next <= time {
            self.waiting += 1;
            self.wait(setup);
        }
        for _ in 0..self.waiting {
            let draw = |stream: &mut Stream, axis: usize| {
                stream.uniform(setup.low[axis], setup.high[axis])
            };
            let x = draw(&mut self.places, 0);
            let place = Vector2::new(x, draw(&mut self.places, 1));
            if !is_free(world, (place, setup.traits.radius), people, robots) {
                continue;
            }
            self.waiting -= 1;
            let number = people.len();
            let mut person = PersonState::new(&setup.traits, place, world.seed, number);
            person.source = Some(index as u32);
            people.push(person);
        }
    }
}

/// Whether a disc touches nobody, no robot and no wall.
fn is_free(
    world: &CrowdWorld,
    (place, radius): (Vector2<f64>, f64),
    people: &[PersonState],
    robots: &[CrowdRobot],
) -> bool {
    let period: &Period = &world.period;
    let off_people = people.iter().all(|person| {
        let way = period.wrap(place - person.position);
        !person.is_present() || way.norm() >= radius + person.radius
    });
    off_people
        && robots
            .iter()
            .all(|robot| robot.gap(place, radius, period) >= 0.0)
        && world
            .walls
            .iter()
            .all(|wall| wall.clearance(place) >= radius)
}
