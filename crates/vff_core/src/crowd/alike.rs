//! People of several worlds that are alike, decided side by side: each world is a lane, and everybody is compared
//! with everybody.
//!
//! Learners step a thousand small worlds by turns. In lanes of their own no list of pairs has to be made, and what
//! five people compare fills all lanes. Every decision has the bits of [`Snapshot`](crate::crowd::snapshot::Snapshot).

use crate::crowd::agent::{Agent, SHORTEST};
use crate::crowd::grid::Period;
use crate::crowd::models::Model;
use crate::crowd::others::parted;
use crate::crowd::people::{PersonState, Presence};
use crate::crowd::permits::Permits;
use crate::crowd::simulation::Simulation;
use crate::crowd::world::{CrowdWorld, PersonSetup};
use crate::lanes::{LaneMask, Lanes, Mask, Planar, Real, Vector2, Zero};
use crate::laws::planning::half_planes::Solver;

/// How many worlds are looked at side by side.
pub(super) const WIDTH: usize = 8;
/// Most people and robots who are compared with each other without lists.
pub(super) const FEW: usize = 12;
/// Fewest worlds that are worth the lanes.
const WORTH: usize = 3;

/// A number of each world.
pub(super) type Each = Lanes<WIDTH>;
/// A vector of each world.
pub(super) type Vectors = Vector2<Each>;

/// One person or robot of each world.
#[derive(Clone, Copy, Debug)]
pub(super) struct Figure {
    /// Position in m.
    pub position: Vectors,
    /// Velocity in m/s.
    pub velocity: Vectors,
    /// Where a person wants to go, where a robot moves: of length 1, or zero.
    pub direction: Vectors,
    /// Radius in m.
    pub radius: Each,
}

/// What one person of each world wants.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wish {
    /// Speed `v0` in m/s.
    pub desired_speed: Each,
    /// Share by which robots are taken into account.
    pub awareness: Each,
    /// Next point of the route in m.
    target: Vectors,
    /// Distance from it in m.
    pub to_go: Each,
    /// Whether the person is on the way, not at the end of it.
    pub walks: LaneMask<WIDTH>,
}

/// Two of each world.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    /// From the second to the first, in m.
    pub offset: Vectors,
    /// Velocity of the first relative to the second, in m/s.
    pub relative: Vectors,
    /// Their distance in m.
    pub distance: Each,
    /// Direction from the second to the first, of length 1.
    pub normal: Vectors,
    /// 1 for two people, the share by which the first is aware of the second if that is a robot.
    pub weight: Each,
    /// Where they act on each other.
    pub near: LaneMask<WIDTH>,
}

/// Everybody in some worlds.
#[derive(Clone, Debug, Default)]
pub(super) struct Figures {
    /// People, then robots.
    pub all: Vec<Figure>,
    /// What the people want.
    pub wishes: Vec<Wish>,
}

/// Room for the decisions of worlds side by side.
#[derive(Clone, Debug, Default)]
pub(super) struct Alike {
    figures: Figures,
    decisions: Vec<Vectors>,
    room: Room,
}

/// Room that models need, used again and again.
#[derive(Clone, Debug, Default)]
pub(super) struct Room {
    /// Ways that everybody takes.
    pub ways: Vec<Vectors>,
    /// Half-planes of permitted velocities.
    pub permits: Permits,
    /// Linear programs without a solution.
    pub solver: Solver,
}

/// The model of everybody in a world whose people can decide side by side with those of others that differ from it
/// by places and wishes only: few people under one model that looks at pairs, who stay, and nothing else.
pub(super) fn model_of(world: &CrowdWorld) -> Option<&Model> {
    let number = world.people.first()?.traits.model;
    let alone = |person: &PersonSetup| {
        person.recorded.is_none() && person.group.is_none() && person.traits.model == number
    };
    let plain = world.walls.is_empty()
        && world.sources.is_empty()
        && world.period == Period::default()
        && world.people.len() + world.robots.len() <= FEW
        && world.people.iter().all(alone);
    let model = world.models.get(number).filter(|_| plain)?;
    match model {
        Model::SocialForce1995(_) | Model::Moussaid(_) | Model::ReciprocalAvoidance(_) => {
            Some(model)
        }
        Model::SocialForce2000(_) | Model::CollisionFreeSpeed(_) => None,
    }
}

impl Alike {
    /// Decides for the people of worlds that have this [`model_of`] them, unless there are too few or somebody is
    /// absent.
    pub fn decide<'a>(&mut self, model: &Model, worlds: &mut [&'a mut Simulation]) {
        let everybody_is_there =
            |world: &&'a mut Simulation| world.people().iter().all(PersonState::is_present);
        if !(WORTH..=WIDTH).contains(&worlds.len()) || !worlds.iter().all(everybody_is_there) {
            return;
        }
        self.figures.seat(worlds);
        pulp::Arch::new().dispatch(Job {
            model,
            step: worlds[0].part(),
            alike: self,
        });
        for (lane, world) in worlds.iter_mut().enumerate() {
            let decisions = self.decisions.iter();
            let decided = world.decided();
            decided.clear();
            decided.extend(decisions.map(|each| Vector2::from(Planar::<Each>::lane(*each, lane))));
        }
    }
}

/// Decisions, compiled once for each instruction set; their bits are the same for all.
struct Job<'a> {
    model: &'a Model,
    step: f64,
    alike: &'a mut Alike,
}

impl pulp::NullaryFnOnce for Job<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Alike {
            figures,
            decisions,
            room,
        } = self.alike;
        figures.look_ahead();
        decisions.clear();
        match self.model {
            Model::SocialForce1995(model) => model.decide_alike(figures, &mut room.ways, decisions),
            Model::Moussaid(model) => model.decide_alike(figures, decisions),
            Model::ReciprocalAvoidance(model) => {
                model.decide_alike(figures, self.step, room, decisions);
            }
            Model::SocialForce2000(_) | Model::CollisionFreeSpeed(_) => {}
        }
    }
}

impl Figures {
    /// Puts each world into a lane, the last one also into those that are left over.
    fn seat(&mut self, worlds: &[&mut Simulation]) {
        let (people, robots) = (worlds[0].people().len(), worlds[0].bodies().len());
        self.all.resize(people + robots, Figure::nobody());
        self.wishes.resize(people, Wish::none());
        for lane in 0..WIDTH {
            let world = &worlds[lane.min(worlds.len() - 1)];
            let (walkers, machines) = self.all.split_at_mut(people);
            let walkers = walkers.iter_mut().zip(&mut self.wishes);
            for ((figure, wish), person) in walkers.zip(world.people()) {
                figure.stand(lane, person.position, person.velocity, person.radius);
                wish.be_of(lane, person);
            }
            for (figure, body) in machines.iter_mut().zip(world.bodies()) {
                let Agent {
                    position,
                    velocity,
                    direction,
                    radius,
                    ..
                } = *body;
                figure.stand(lane, position, velocity, radius);
                set(&mut figure.direction, lane, direction);
            }
        }
    }

    /// Finds where everybody wants to go.
    #[inline(always)]
    fn look_ahead(&mut self) {
        for (figure, wish) in self.all.iter_mut().zip(&mut self.wishes) {
            let way = wish.target - figure.position;
            let length = Planar::<Each>::length(way);
            let nowhere = !wish.walks | length.lt(Each::splat(SHORTEST));
            figure.direction = Planar::<Each>::select(
                nowhere,
                Vectors::zeros(),
                Planar::<Each>::over(way, length),
            );
            wish.to_go = Each::select(wish.walks, length, Each::zero());
        }
    }

    /// How many people there are.
    #[inline(always)]
    pub fn people(&self) -> usize {
        self.wishes.len()
    }

    /// Those who may be near a person and come later: people, then robots.
    #[inline(always)]
    pub fn pairs(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let (people, all) = (self.people(), self.all.len());
        let mutual =
            (0..people).flat_map(move |one| (one + 1..people).map(move |other| (one, other)));
        mutual.chain((0..people).flat_map(move |one| (people..all).map(move |robot| (one, robot))))
    }

    /// Two who are within a distance in m of each other, if they are in any world.
    #[inline(always)]
    pub fn pair(&self, (one, other): (usize, usize), cutoff: f64) -> Option<Pair> {
        let (first, second) = (&self.all[one], &self.all[other]);
        let offset = first.position - second.position;
        let mut near = !offset.dot(&offset).gt(Each::splat(cutoff * cutoff));
        let mut weight = Each::splat(1.0);
        if other >= self.people() {
            weight = self.wishes[one].awareness;
            near = near & weight.gt(Each::zero());
        }
        if !near.any() {
            return None;
        }
        let (distance, normal) = parted(offset, |_| true);
        Some(Pair {
            offset,
            relative: first.velocity - second.velocity,
            distance,
            normal,
            weight,
            near,
        })
    }

    /// Drives `(v0 e - v)/tau` of everybody, where the sums of forces start.
    #[inline(always)]
    pub fn drives(&self, relaxation_time: f64) -> impl Iterator<Item = Vectors> {
        self.all.iter().zip(&self.wishes).map(move |(own, wish)| {
            let wanted = own.direction * wish.desired_speed;
            Planar::<Each>::over(wanted - own.velocity, Each::splat(relaxation_time))
        })
    }
}

impl Pair {
    /// Adds a vector where the two are near each other.
    #[inline(always)]
    pub fn add(&self, vector: Vectors, sum: &mut Vectors) {
        *sum = Planar::<Each>::select(self.near, *sum + vector, *sum);
    }
}

impl Figure {
    fn nobody() -> Self {
        Self {
            position: Vectors::zeros(),
            velocity: Vectors::zeros(),
            direction: Vectors::zeros(),
            radius: Each::zero(),
        }
    }

    #[inline(always)]
    fn stand(&mut self, lane: usize, position: Vector2<f64>, velocity: Vector2<f64>, radius: f64) {
        set(&mut self.position, lane, position);
        set(&mut self.velocity, lane, velocity);
        self.radius.set(lane, radius);
    }
}

impl Wish {
    fn none() -> Self {
        Self {
            desired_speed: Each::zero(),
            awareness: Each::zero(),
            target: Vectors::zeros(),
            to_go: Each::zero(),
            walks: LaneMask::none(),
        }
    }

    #[inline(always)]
    fn be_of(&mut self, lane: usize, person: &PersonState) {
        self.desired_speed.set(lane, person.desired_speed);
        self.awareness.set(lane, person.awareness);
        set(&mut self.target, lane, person.target);
        self.walks = self.walks.without(lane);
        if person.presence == Presence::Walking {
            self.walks.set(lane);
        }
    }
}

#[inline(always)]
fn set(vectors: &mut Vectors, lane: usize, vector: Vector2<f64>) {
    vectors.x.set(lane, vector.x);
    vectors.y.set(lane, vector.y);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::crowd::moussaid::Moussaid;
    use crate::crowd::reciprocal_people::ReciprocalPeople;
    use crate::crowd::social_force_1995::SocialForce1995;
    use crate::crowd::world::{RobotSetup, Route, RouteEnd, Traits};
    use crate::robots::HolonomicRobot;
    use crate::run::Request;
    use crate::world::scenario::Mover;
    use numeric::random::Stream;

    fn models(cutoff: f64, max_neighbors: usize) -> [Model; 3] {
        [
            Model::SocialForce1995(SocialForce1995 {
                relaxation_time: 0.5,
                strength: 2.1,
                range: 0.3,
                step_time: 2.0,
                wall_strength: 10.0,
                wall_range: 0.2,
                view_angle: 1.7,
                behind: 0.5,
                cutoff,
            }),
            Model::Moussaid(Moussaid {
                relaxation_time: 0.54,
                strength: 4.5,
                gamma: 0.35,
                n: 2.0,
                n_prime: 3.0,
                velocity_weight: 2.0,
                side_bias: 0.005,
                wall_strength: 3.0,
                wall_range: 0.1,
                gaze: 4.0,
                cohesion: 3.0,
                separation: 1.0,
                view_angle: 1.5,
                contact_distance: 0.55,
                cutoff,
            }),
            Model::ReciprocalAvoidance(ReciprocalPeople {
                horizon: 5.0,
                wall_horizon: 0.5,
                max_neighbors,
                margin: 0.01,
                cutoff,
            }),
        ]
    }

    fn person(stream: &mut Stream, number: usize) -> PersonSetup {
        let mut draw = |size: f64| [stream.uniform(-size, size), stream.uniform(-size, size)];
        let points = vec![draw(2.0); usize::from(number % 4 != 3)];
        let end = match number % 5 {
            _ if points.is_empty() => RouteEnd::Stay,
            1 => RouteEnd::Leave,
            2 => RouteEnd::Repeat,
            _ => RouteEnd::Stay,
        };
        PersonSetup {
            start: if number == 1 { [0.0; 2] } else { draw(2.0) },
            velocity: draw(0.5),
            enters: if number == 4 { 0.6 } else { 0.0 },
            recorded: None,
            group: None,
            traits: Traits {
                radius: 0.25 + 0.05 * draw(1.0)[0],
                desired_speed: Some(if number == 5 { 0.0 } else { 1.0 + draw(0.5)[0] }),
                awareness: 0.5 * (number % 3) as f64,
                distracted_share: 0.3,
                model: 0,
                route: Route {
                    points,
                    end,
                    arrival_radius: 0.3,
                },
            },
        }
    }

    fn world(stream: &mut Stream, model: Model, [people, robots]: [usize; 2]) -> CrowdWorld {
        let mut people: Vec<PersonSetup> = (0..people).map(|n| person(stream, n)).collect();
        if let [first, second, ..] = &mut people[..] {
            // Two at one place, who move alike.
            (second.start, second.velocity) = (first.start, first.velocity);
        }
        let robots = (0..robots).map(|index| RobotSetup {
            mover: Mover::Holonomic(HolonomicRobot::default()),
            start: [-3.0, index as f64],
            goal: [20.0, 0.0],
            heading: 0.0,
            control_period: 0.25,
            arrival_tolerance: 0.3,
            sensing_range: 10.0,
            measurement: None,
            law: None,
        });
        CrowdWorld {
            people,
            robots: robots.collect(),
            sources: Vec::new(),
            walls: Vec::new(),
            models: vec![model],
            period: Period::default(),
            step: 0.25,
            time_limit: 5.0,
            seed: stream.bits(),
        }
    }

    fn states(worlds: &[Simulation]) -> Vec<Vec<PersonState>> {
        worlds.iter().map(|world| world.people().to_vec()).collect()
    }

    /// Whether everybody is the same, NaN included.
    fn told(worlds: &[Simulation]) -> String {
        format!("{:?}", states(worlds))
    }

    #[test]
    fn worlds_side_by_side_move_as_each_alone() {
        let mut stream = Stream::new(29, 0);
        let mut together = 0;
        for round in 0..30 {
            let size = [round % 8, round % 3];
            let (cutoff, most) = ([f64::INFINITY, 1.5][round % 2], [10, 2][round / 2 % 2]);
            let count = 3 + round % (WIDTH - 2);
            for model in models(cutoff, most) {
                let made: Vec<CrowdWorld> = (0..count)
                    .map(|_| world(&mut stream, model, size))
                    .collect();
                let expected = model_of(&made[0]).is_some();
                assert_eq!(expected, size[0] > 0);
                let start = |world: &CrowdWorld| Simulation::new(world.clone(), false).unwrap();
                let mut alone: Vec<Simulation> = made.iter().map(start).collect();
                let mut beside: Vec<Simulation> = made.iter().map(start).collect();
                let mut alike = Alike::default();
                for step in 0..20 {
                    for worlds in [&mut alone, &mut beside] {
                        for world in worlds {
                            world.ask(0, Request::Velocity([0.8, 0.1 * f64::from(step % 3)]));
                        }
                    }
                    for world in &mut alone {
                        world.step(&|| false).unwrap();
                    }
                    let mut under_way: Vec<&mut Simulation> = beside.iter_mut().collect();
                    under_way.retain_mut(|world| world.begin(&|| false).unwrap());
                    while !under_way.is_empty() {
                        alike.decide(&model, &mut under_way);
                        together += under_way
                            .iter_mut()
                            .map(|one| usize::from(!one.decided().is_empty()))
                            .sum::<usize>();
                        under_way.retain_mut(|world| world.travel() || world.end().is_err());
                    }
                    assert_eq!(told(&alone), told(&beside), "{model:?} {size:?} {step}");
                }
            }
        }
        assert!(together > 4000, "{together}");
    }
}
