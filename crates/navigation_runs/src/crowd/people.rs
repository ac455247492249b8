//! The people of a world as they are now, and what is drawn for each.

use numeric::order::sort_indices;
use numeric::random::Stream;
use smallvec::SmallVec;

use crate::crowd::agent::{Agent, SHORTEST, direction_of};
use crate::crowd::divergence::is_finite;
use crate::crowd::models::Model;
use crate::crowd::neighbors::grid::Period;
use crate::crowd::pedestrian::{Company, Fellows, Walker, company_of};
use crate::crowd::rescue::set_back;
use crate::crowd::walls::Wall;
use crate::crowd::world::{PersonSetup, Route, RouteEnd, Traits, Waypoint};
use navigation_world::world::motion::Motion;
use numeric::lanes::Vector2;

type Vector = Vector2<f64>;

/// Mean, standard deviation and bounds of walking speeds in m/s, Weidmann (1993).
const SPEED: [f64; 4] = [1.34, 0.26, 0.5, 2.2];

/// Purpose of a draw; each has streams of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Purpose {
    Speed = 1,
    Distraction = 2,
    Arrivals = 3,
    Place = 4,
    Measurement = 5,
    Law = 6,
}

/// The stream of an agent or source for a purpose.
pub(super) fn stream_of(seed: u64, purpose: Purpose, number: u64) -> Stream {
    Stream::new(seed, ((purpose as u64) << 48) | number)
}

/// Where a person is on the route.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Presence {
    /// Not yet there.
    Expected,
    /// On the way.
    Walking,
    /// At the end, for good.
    Staying,
    /// No longer there.
    Left,
}

/// A person now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PersonState {
    /// Position in m.
    pub position: Vector,
    /// Velocity in m/s.
    pub velocity: Vector,
    /// Direction of the last decision, of models that keep it.
    pub heading: Vector,
    /// Radius in m.
    pub radius: f64,
    /// Wanted speed in m/s.
    pub desired_speed: f64,
    /// Share by which robots are taken into account.
    pub awareness: f64,
    /// Whether the person is there.
    pub presence: Presence,
    /// Number of the model.
    pub model: u32,
    /// The source it came from, if it did.
    pub source: Option<u32>,
    /// Group, if it belongs to one.
    pub group: Option<u32>,
    /// Next point of the route by number.
    pub next: u32,
    /// Lines of the route from the next one on that were crossed since the last instant.
    pub crossed: u32,
    /// Whether the next element of the route is a line.
    pub to_line: bool,
    /// Where that is, in m: of a line the point to go to.
    pub target: Vector,
    /// Squared distance at which it is reached, in m^2.
    pub arrival_squared: f64,
    /// Whether the person follows a recording and reacts to nobody.
    pub recorded: bool,
    /// When the end of the route was reached, in s; NaN before.
    pub arrival_time: f64,
    /// Where that was, in m; NaN before.
    pub arrival_position: Vector,
}

/// Something of each person of a world. For as many as learners mostly put into one it lies beside the rest of the
/// world, so that a thousand worlds that are stepped in turn come from memory in one stream.
pub(super) type OfPeople<T> = SmallVec<[T; 5]>;

impl PersonState {
    /// A person with a number at a place.
    #[allow(clippy::cast_possible_truncation)] // models and sources are few
    pub(super) fn new(traits: &Traits, place: Vector, seed: u64, number: usize) -> Self {
        let distracted = traits.distracted_share > 0.0
            && stream_of(seed, Purpose::Distraction, number as u64).unit()
                < traits.distracted_share;
        let drawn = || drawn_speed(&mut stream_of(seed, Purpose::Speed, number as u64));
        let first = traits.route.points.first();
        Self {
            position: place,
            velocity: Vector::zeros(),
            heading: Vector::x(),
            radius: traits.radius,
            desired_speed: traits.desired_speed.unwrap_or_else(drawn),
            awareness: if distracted { 0.0 } else { traits.awareness },
            presence: if traits.route.points.is_empty() {
                Presence::Staying
            } else {
                Presence::Walking
            },
            model: traits.model as u32,
            source: None,
            group: None,
            next: 0,
            crossed: 0,
            to_line: first.is_some_and(Waypoint::is_line),
            target: first.map_or(place, |first| first.target(place, traits.radius)),
            arrival_squared: traits.route.arrival_radius * traits.route.arrival_radius,
            recorded: false,
            arrival_time: f64::NAN,
            arrival_position: Vector::repeat(f64::NAN),
        }
    }

    /// One of the world at its start.
    pub(super) fn at_start(setup: &PersonSetup, seed: u64, number: usize) -> Self {
        let mut person = Self {
            velocity: setup.velocity.into(),
            group: setup.group,
            ..Self::new(&setup.traits, setup.start.into(), seed, number)
        };
        if setup.enters > 0.0 {
            person.presence = Presence::Expected;
        }
        if let Some(pursuer) = &setup.pursuer {
            person.recorded = true;
            person.desired_speed = pursuer.max_speed;
            person.presence = Presence::Walking;
        }
        if let Some(motion) = &setup.recorded {
            person.recorded = true;
            person.desired_speed = motion.max_initial_speed();
            person.presence = Presence::Expected;
            person.replay(motion, 0.0);
        }
        person
    }

    /// Where a recording has the person at a time in s.
    #[allow(clippy::cast_possible_truncation)] // recordings have fewer than 2^32 samples
    pub(super) fn replay(&mut self, motion: &Motion, time: f64) {
        let mut cursor = self.next as usize;
        let state = motion.at(time, &mut cursor);
        self.next = cursor as u32;
        let was_there = self.is_present();
        self.presence = match (state.present, was_there || self.presence == Presence::Left) {
            (true, _) => Presence::Walking,
            (false, true) => Presence::Left,
            (false, false) => Presence::Expected,
        };
        self.velocity = state.velocity.into();
        self.position = state.position.into();
    }

    /// Whether something may be done by what is said of the person before the run: most are on their way, and that is
    /// elsewhere in memory.
    #[inline]
    pub(super) fn needs_setup(&self) -> bool {
        match self.presence {
            _ if self.recorded => false,
            Presence::Expected => true,
            Presence::Walking => self.crossed > 0 || !self.is_off_target(),
            Presence::Staying | Presence::Left => false,
        }
    }

    /// Enters if it is time to, in s.
    pub(super) fn enter(&mut self, setup: &PersonSetup, time: f64) {
        if self.presence == Presence::Expected && setup.enters <= time {
            self.presence = if setup.traits.route.points.is_empty() {
                Presence::Staying
            } else {
                Presence::Walking
            };
        }
    }

    /// Whether the person is there.
    #[must_use]
    pub fn is_present(&self) -> bool {
        matches!(self.presence, Presence::Walking | Presence::Staying)
    }

    /// Whether the state is finite.
    #[inline]
    pub(super) fn is_finite(&self) -> bool {
        is_finite(self.position, self.velocity)
    }

    /// Whether the person is there and decides.
    #[inline]
    pub(super) fn decides(&self) -> bool {
        self.is_present() && !self.recorded
    }

    /// The person as one who decides, if there.
    // Where the place alone is asked for, nothing else is computed.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation)] // there are at most a million people
    pub(super) fn walker(&self, number: usize) -> Option<Walker> {
        if !self.is_present() {
            return None;
        }
        let (mut direction, mut to_go) = (Vector::zeros(), 0.0);
        if self.recorded {
            direction = direction_of(self.velocity);
        } else if self.presence == Presence::Walking {
            let way = self.target - self.position;
            to_go = way.norm();
            direction = if to_go < SHORTEST {
                direction
            } else {
                way / to_go
            };
        }
        Some(Walker {
            agent: Agent {
                position: self.position,
                velocity: self.velocity,
                direction,
                radius: self.radius,
                number: number as u32,
            },
            desired_speed: self.desired_speed,
            decides: !self.recorded,
            to_go,
            stays: self.presence != Presence::Walking,
            heading: self.heading,
            awareness: self.awareness,
        })
    }

    /// Moves for a time in s by a decision of the person's model.
    #[inline]
    pub(super) fn move_by(&mut self, decision: Vector, model: &Model, step: f64) {
        self.velocity = if model.is_force() {
            let velocity = self.velocity + decision * step;
            let (speed, most) = (velocity.norm(), model.cap() * self.desired_speed);
            if speed > most {
                velocity * (most / speed)
            } else {
                velocity
            }
        } else {
            decision
        };
        self.position += self.velocity * step;
    }

    /// Sets the person back who came from a place to walls; whether it was necessary.
    #[inline]
    pub(super) fn keep_off(&mut self, walls: &[Wall], from: Vector) -> bool {
        let moved = [from, self.position];
        let rescue = set_back(walls, moved, self.velocity, self.radius);
        if let Some(rescue) = rescue.filter(|_| self.is_finite()) {
            (self.position, self.velocity) = (rescue.position, rescue.velocity);
        }
        rescue.is_some()
    }

    /// Notes which lines of the route the person crossed who came from a place, and where the next one is nearest.
    pub(super) fn look_at_lines(&mut self, route: &Route, from: Vector) {
        let count = route.points.len();
        let repeats = route.end == RouteEnd::Repeat;
        for _ in self.crossed as usize..count {
            let ahead = self.next as usize + self.crossed as usize;
            if ahead >= count && !repeats {
                break;
            }
            if !route.points[ahead % count].is_crossed(from, self.position) {
                break;
            }
            self.crossed += 1;
        }
        self.target = route.points[self.next as usize].target(self.position, self.radius);
    }

    /// Whether the next element of the route is reached.
    fn has_reached_next(&mut self) -> bool {
        if self.crossed > 0 {
            self.crossed -= 1;
            return true;
        }
        if self.to_line {
            // On the line there is no direction to it.
            return (self.target - self.position).norm() < SHORTEST;
        }
        !self.is_off_target()
    }

    /// Whether the next point is not reached.
    fn is_off_target(&self) -> bool {
        let way = self.target - self.position;
        way.dot(&way) > self.arrival_squared
    }

    /// Looks at the next points of the route at a time in s.
    #[inline]
    pub(super) fn follow(&mut self, route: &Route, time: f64) {
        if self.presence != Presence::Walking {
            return;
        }
        for _ in 0..route.points.len() {
            if !self.has_reached_next() {
                return;
            }
            self.next += 1;
            let ended = self.next as usize == route.points.len();
            if ended {
                self.next = 0;
            }
            if !ended || route.end == RouteEnd::Repeat {
                let next = &route.points[self.next as usize];
                self.to_line = next.is_line();
                self.target = next.target(self.position, self.radius);
            } else {
                self.presence = if route.end == RouteEnd::Leave {
                    Presence::Left
                } else {
                    Presence::Staying
                };
                self.crossed = 0;
                self.arrival_time = time;
                self.arrival_position = self.position;
                return;
            }
        }
    }
}

/// A walking speed: normal, and again if it is out of bounds.
fn drawn_speed(stream: &mut Stream) -> f64 {
    let [mean, deviation, least, most] = SPEED;
    loop {
        for normal in stream.normals() {
            let speed = mean + deviation * normal;
            if (least..=most).contains(&speed) {
                return speed;
            }
        }
    }
}

/// Largest speed in m/s that people of these traits want.
pub(super) fn fastest(traits: &Traits) -> f64 {
    traits.desired_speed.unwrap_or(SPEED[3])
}

/// The groups of a world.
#[derive(Clone, Debug, Default)]
pub(super) struct Groups {
    /// Members of every group by number.
    members: Vec<Vec<u32>>,
    /// Place of the group of every person in that list.
    of: Vec<Option<u32>>,
}

impl Groups {
    /// Of people at the start.
    #[allow(clippy::cast_possible_truncation)] // there are at most a million people
    pub fn fill(&mut self, people: &[PersonState]) {
        self.of.clear();
        self.members.clear();
        if people.iter().all(|person| person.group.is_none()) {
            return;
        }
        let named = people.iter().filter_map(|person| person.group);
        let mut names: Vec<usize> = named.map(|name| name as usize).collect();
        sort_indices(&mut names, &mut Ord::cmp);
        names.dedup();
        self.members.resize(names.len(), Vec::new());
        for (number, person) in (0_u32..).zip(people) {
            let place = person
                .group
                .and_then(|name| names.binary_search(&(name as usize)).ok());
            if let Some(place) = place {
                self.members[place].push(number);
            }
            self.of.push(place.map(|place| place as u32));
        }
    }
}

/// Groups as their members are now.
#[derive(Debug)]
pub(super) struct Companions<'a> {
    pub groups: &'a Groups,
    pub people: &'a [PersonState],
    pub period: Period,
}

impl Fellows for Companions<'_> {
    fn any(&self) -> bool {
        !self.groups.members.is_empty()
    }

    fn company(&self, own: &Agent, near: f64) -> Company {
        let group = self.groups.of.get(own.number as usize).copied().flatten();
        let Some(group) = group else {
            return Company::default();
        };
        let members = self.groups.members[group as usize].iter();
        let present = members.map(|number| (*number, &self.people[*number as usize]));
        let present = present.filter(|(_, person)| person.is_present());
        let places = present.map(|(number, person)| (number, person.position));
        company_of(own, places, near, self.period)
    }
}
