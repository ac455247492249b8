//! Knowledge of the law of a robot about people, other robots and walls.

use std::collections::VecDeque;

use crate::crowd::agent::Agent;
use crate::crowd::models::Model;
use crate::crowd::people::{PersonState, Purpose, fastest, stream_of};
use crate::crowd::walls::Wall;
use crate::crowd::world::{CrowdWorld, Traits, count_of};
use navigation_laws::{Scan, Shown};
use navigation_world::sensing::measurement::{Measurement, Noise};
use navigation_world::world::geometry::{Body, RobotState};
use navigation_world::world::motion::{BodyState, Motion};
use navigation_world::world::obstacle::{Limits, Obstacle};
use navigation_world::world::scenario::{PlacedObstacle, Scenario};
use navigation_world::world::shape::{PlacedShape, Shape};
use numeric::error::Result;
use numeric::lanes::{Planar, Vector2};

type Vector = Vector2<f64>;

/// Thickness in m with which laws are shown segments of walls.
const THICKNESS: f64 = 1e-3;

/// Somebody or something that laws are told of, before its regions are known.
pub(super) struct KnownBody {
    pub obstacle: Obstacle,
    /// Largest speed in m/s, `None` for no bound.
    pub bound: Option<f64>,
    pub stands: bool,
}

/// Who has a place in the list of obstacles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Slot {
    Person(usize),
    Robot(usize),
    /// Somebody from a source, or nobody for now.
    Guest(u32, Option<usize>),
    Wall,
}

/// Past positions of somebody, with noise.
#[derive(Clone, Debug)]
struct NoisyPast {
    noise: Noise,
    last: Option<Vector>,
    past: VecDeque<Vector>,
}

/// Errors and age of what a robot sees.
#[derive(Clone, Debug)]
struct Blur {
    /// Age in steps of the world.
    age: f64,
    own: Option<NoisyPast>,
    others: Option<Vec<NoisyPast>>,
}

/// View of one robot.
pub(super) struct Sight {
    slots: Vec<Slot>,
    /// Places for people of each source.
    guests: usize,
    range: f64,
    /// Whether walls hide others.
    occlusion: bool,
    index: usize,
    blur: Option<Blur>,
    /// The obstacles as measured last.
    pub bodies: Vec<Body>,
    /// The robot as measured last.
    pub own: RobotState<f64>,
}

/// A person or robot who moves: its regions are sized for a speed, and it is never taken for furniture.
fn mover(place: [f64; 2], radius: f64, speed: f64, bound: Option<f64>) -> Result<KnownBody> {
    let limits = Limits {
        max_speed: Some(speed),
        ..Limits::default()
    };
    Ok(KnownBody {
        obstacle: Obstacle::disc(radius, Motion::at_rest(place), limits)?,
        bound,
        stands: false,
    })
}

fn person(traits: &Traits, speed: f64, model: &Model, place: [f64; 2]) -> Result<KnownBody> {
    let most = model.cap() * speed;
    let bound = most.is_finite().then_some(most);
    mover(place, traits.radius, bound.unwrap_or(speed), bound)
}

/// Walls as what stands: discs, rectangles, and segments as thin rectangles.
fn standing(wall: &Wall) -> Vec<KnownBody> {
    let known = |shape: PlacedShape| KnownBody {
        obstacle: Obstacle {
            shape: shape.shape,
            motion: Motion::at_rest(shape.center.into()),
            limits: Limits::default(),
        },
        bound: Some(0.0),
        stands: true,
    };
    match wall {
        Wall::Solid(shape) => vec![known(*shape)],
        Wall::Polyline(points) => {
            let segment = |ends: &[Vector]| {
                let mut shape = PlacedShape::wall(ends[0].into(), ends[1].into());
                if let Shape::Rectangle {
                    half_length,
                    half_width,
                    ..
                } = &mut shape.shape
                {
                    *half_length = half_length.max(0.5 * THICKNESS);
                    *half_width = 0.5 * THICKNESS;
                }
                known(shape)
            };
            points.windows(2).map(segment).collect()
        }
    }
}

impl Sight {
    /// Sight of a robot of a world, and the scene that its law starts with; `guests`: places for people of each
    /// source.
    pub fn new(
        world: &CrowdWorld,
        people: &[PersonState],
        index: usize,
        guests: usize,
    ) -> Result<(Self, Vec<KnownBody>)> {
        let (mut slots, mut known) = (Vec::new(), Vec::new());
        for (number, (setup, state)) in world.people.iter().zip(people).enumerate() {
            let model = &world.models[setup.traits.model];
            slots.push(Slot::Person(number));
            known.push(match (&setup.recorded, &setup.pursuer) {
                (None, Some(pursuer)) => {
                    let speed = pursuer.max_speed;
                    mover(setup.start, setup.traits.radius, speed, Some(speed))?
                }
                (Some(motion), _) => {
                    let speed = motion.max_initial_speed();
                    mover(
                        setup.start,
                        setup.traits.radius,
                        speed,
                        motion.speed_bound(),
                    )?
                }
                (None, None) => person(&setup.traits, state.desired_speed, model, setup.start)?,
            });
        }
        for (other, setup) in world.robots.iter().enumerate() {
            if other != index {
                let speed = setup.max_speed();
                slots.push(Slot::Robot(other));
                known.push(mover(setup.start, setup.radius(), speed, Some(speed))?);
            }
        }
        for (source, setup) in (0_u32..).zip(&world.sources) {
            let (traits, model) = (&setup.traits, &world.models[setup.traits.model]);
            for _ in 0..guests {
                slots.push(Slot::Guest(source, None));
                known.push(person(traits, fastest(traits), model, setup.low)?);
            }
        }
        let told = world.walls.len().saturating_sub(world.untold);
        for wall in world.walls[..told].iter().flat_map(standing) {
            slots.push(Slot::Wall);
            known.push(wall);
        }
        let robot = &world.robots[index];
        let sight = Self {
            guests,
            range: robot.sensing_range,
            // Who scans by himself finds out whom walls hide: a person whose center is hidden may be seen.
            occlusion: robot.occlusion && !robot.law.as_ref().is_some_and(|law| law.scans()),
            index,
            // A robot as built has sensors, of which its measurement is one.
            blur: robot
                .measurement
                .filter(|_| robot.built.is_none())
                .map(|measurement| Blur::new(measurement, world, index, slots.len())),
            slots,
            bodies: Vec::new(),
            own: RobotState {
                position: robot.start.into(),
                velocity: Vector::zeros(),
            },
        };
        Ok((sight, known))
    }

    /// Takes the regions that the obstacles have for a scenario.
    pub fn size(&mut self, scenario: &Scenario) {
        let body = |placed: &PlacedObstacle| Body {
            shape: placed.obstacle.shape,
            regions: placed.regions,
            state: placed.obstacle.motion.at(0.0, &mut 0),
        };
        self.bodies = scenario.obstacles.iter().map(body).collect();
    }

    /// Gives people from sources a place; `false` if there are too few, then [`Self::new`] with more of them.
    pub fn admit(&mut self, people: &[PersonState]) -> bool {
        if self.guests == 0 {
            return true;
        }
        for slot in &mut self.slots {
            if let Slot::Guest(_, guest) = slot {
                *guest = guest.filter(|number| people[*number].is_present());
            }
        }
        let placed = |slots: &[Slot], number| {
            let here =
                |slot: &Slot| matches!(slot, Slot::Guest(_, Some(guest)) if *guest == number);
            slots.iter().any(here)
        };
        for (number, person) in people.iter().enumerate() {
            let Some(source) = person.source else {
                continue;
            };
            if !person.is_present() || placed(&self.slots, number) {
                continue;
            }
            let Some(index) =
                (0..self.slots.len()).find(|index| self.slots[*index] == Slot::Guest(source, None))
            else {
                return false;
            };
            self.slots[index] = Slot::Guest(source, Some(number));
            if let Some(tracks) = self.blur.as_mut().and_then(|blur| blur.others.as_mut()) {
                tracks[index].last = None;
                tracks[index].past.clear();
            }
        }
        true
    }

    /// Number of the person in each place of the list of obstacles; `None` for robots, walls and free places.
    pub fn people(&self) -> impl Iterator<Item = Option<usize>> + '_ {
        self.slots.iter().map(|slot| match slot {
            Slot::Person(number) | Slot::Guest(_, Some(number)) => Some(*number),
            Slot::Robot(_) | Slot::Guest(_, None) | Slot::Wall => None,
        })
    }

    /// State of whoever has a place, `None` if nobody has.
    fn state(slot: Slot, people: &[PersonState], robots: &[Agent]) -> Option<(Vector, Vector)> {
        match slot {
            Slot::Person(number) | Slot::Guest(_, Some(number)) => {
                let person = &people[number];
                let there = person.is_present();
                there.then_some((person.position, person.velocity))
            }
            Slot::Robot(other) => Some((robots[other].position, robots[other].velocity)),
            Slot::Guest(_, None) | Slot::Wall => None,
        }
    }

    /// Everybody up to the range of sensing: whom walls hide, a law that scans by itself leaves out.
    pub fn scan(&self) -> Scan<'static> {
        Scan {
            shown: Shown::All { range: self.range },
            ..Scan::ALL
        }
    }

    /// Keeps where everybody is at a step of the world, for what is measured late.
    pub fn watch(&mut self, people: &[PersonState], robots: &[Agent]) {
        let index = self.index;
        let Some(blur) = &mut self.blur else { return };
        let longest = count_of(blur.age) + 2;
        if let Some(own) = &mut blur.own {
            own.keep(robots[index].position, longest);
        }
        for (track, slot) in blur.others.iter_mut().flatten().zip(&self.slots) {
            if let Some((position, _)) = Self::state(*slot, people, robots) {
                track.keep(position, longest);
            }
        }
    }

    /// Measures everything, once in a control period in s.
    pub fn look(
        &mut self,
        people: &[PersonState],
        robots: &[Agent],
        world: &CrowdWorld,
        interval: f64,
    ) {
        let me = robots[self.index];
        for (index, slot) in self.slots.iter().enumerate() {
            if *slot == Slot::Wall {
                continue;
            }
            let found = Self::state(*slot, people, robots);
            let mut state = BodyState {
                position: [0.0; 2],
                velocity: [0.0; 2],
                acceleration: [0.0; 2],
                present: false,
            };
            let tracks = self.blur.as_mut().and_then(|blur| {
                let age = blur.age;
                let tracks = blur.others.as_mut()?;
                Some((&mut tracks[index], age))
            });
            if let Some((mut position, mut velocity)) = found {
                let way = world.period.wrap(position - me.position);
                let there = me.position + way;
                let hidden = || {
                    world
                        .walls
                        .iter()
                        .any(|wall| wall.hides(me.position, there))
                };
                state.present = way.norm() <= self.range && !(self.occlusion && hidden());
                if let Some((track, age)) = tracks {
                    (position, velocity) = track.measure((position, velocity), age, interval);
                }
                let way = world.period.wrap(position - me.position);
                state.position = (me.position + way).into();
                state.velocity = velocity.into();
            } else if let Some((track, _)) = tracks {
                // Noise does not depend on who is there.
                track.noise.draw();
                track.last = None;
            }
            self.bodies[index].state = state;
        }
        self.own = RobotState {
            position: me.position,
            velocity: me.velocity,
        };
        if let Some(blur) = &mut self.blur {
            let age = blur.age;
            if let Some(own) = &mut blur.own {
                let (position, velocity) = own.measure((me.position, me.velocity), age, interval);
                self.own = RobotState { position, velocity };
            }
        }
    }

    /// Place and velocity of the first person as measured; `None` while not seen.
    pub fn first_person(&self) -> Option<(Vector, Vector)> {
        let state = self.bodies.first()?.state;
        let seen = state.present && self.slots.first() == Some(&Slot::Person(0));
        seen.then(|| (state.position.into(), state.velocity.into()))
    }

    /// Whether the robot is outside every active region, as far as it knows.
    pub fn clear(&self) -> bool {
        self.bodies.iter().all(|body| {
            let reach = body.regions.active_radius;
            let squared = body.offset(self.own.position).distance_squared;
            !body.state.present || squared >= reach * reach
        })
    }
}

impl Blur {
    fn new(measurement: Measurement, world: &CrowdWorld, index: usize, slots: usize) -> Self {
        let track = |slot: usize| {
            let number = ((index as u64) << 24) | slot as u64;
            let mut stream = stream_of(world.seed, Purpose::Measurement, number);
            NoisyPast {
                noise: Noise::new(measurement, stream.bits(), 0),
                last: None,
                past: VecDeque::new(),
            }
        };
        Self {
            age: measurement.latency() / world.step,
            own: measurement.of_robot().then(|| track(0)),
            others: measurement
                .of_obstacle(false)
                .then(|| (0..slots).map(|slot| track(slot + 1)).collect()),
        }
    }
}

impl NoisyPast {
    fn keep(&mut self, position: Vector, longest: usize) {
        if self.past.len() >= longest {
            self.past.pop_front();
        }
        self.past.push_back(position);
    }

    /// Position of some steps ago with an error, and velocity from the last two.
    fn measure(
        &mut self,
        (present, velocity): (Vector, Vector),
        age: f64,
        interval: f64,
    ) -> (Vector, Vector) {
        let newest = self.past.len().saturating_sub(1);
        let at = |steps: usize| {
            let place = self.past.get(newest.saturating_sub(steps));
            place.copied().unwrap_or(present)
        };
        let whole = count_of((age + 1e-9).floor());
        let share = (age - whole as f64).max(0.0);
        let position = at(whole) + (at(whole + 1) - at(whole)) * share;
        let position = position + Vector::splat(self.noise.draw());
        let velocity = self
            .last
            .map_or(velocity, |last| (position - last) / interval);
        self.last = Some(position);
        (position, velocity)
    }
}
