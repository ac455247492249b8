//! People of several worlds that are alike decide and move side by side: each world is a lane, and everybody is compared
//! with everybody.
//!
//! Learners step a thousand small worlds by turns. In lanes of their own no list of pairs has to be made, and what
//! five people compare fills all lanes. Every decision has the bits of [`Snapshot`](crate::crowd::snapshot::Snapshot).

use crate::crowd::agent_lanes::{AgentLanes, FEW, Vectors, WIDTH};
use crate::crowd::models::Model;
use crate::crowd::neighbors::grid::Period;
use crate::crowd::people::{PersonState, Presence};
use crate::crowd::simulation::Simulation;
use crate::crowd::velocity_programs::LaneRoom;
use crate::crowd::world::{CrowdWorld, PersonSetup, Waypoint};
use numeric::lanes::{LaneMask, Real, Truth, Vector2, vectors};

/// Fewest worlds that are worth the lanes.
const WORTH: usize = 3;

/// Room for the decisions of worlds side by side.
#[derive(Clone, Debug, Default)]
pub(super) struct WorldLanes {
    agents: AgentLanes,
    decisions: Vec<Vectors>,
    room: LaneRoom,
    /// Whether the agents are those of the last call.
    seated: bool,
}

/// The model of everybody in a world whose people can decide side by side with those of others that differ from it
/// by places and intentions only: few people and robots, the people under one model that looks at pairs, and nothing else.
pub(super) fn model_of(world: &CrowdWorld) -> Option<&Model> {
    let number = world.people.first()?.traits.model;
    let alone = |person: &PersonSetup| {
        person.recorded.is_none() && person.pursuer.is_none()
            && person.group.is_none()
            && person.traits.model == number
            // Where a line is nearest changes with every motion.
            && !person.traits.route.points.iter().any(Waypoint::is_line)
    };
    let plain = world.walls.is_empty()
        && world.sources.is_empty()
        && world.period == Period::default()
        && world.people.len() + world.robots.len() <= FEW
        && world.people.iter().all(alone);
    let model = world.models.get(number)?;
    (plain && model.fits_lanes()).then_some(model)
}

impl WorldLanes {
    /// Decides for the people of worlds that have this [`model_of`] them and moves them, unless there are too few or
    /// somebody is absent. `again`: these are the worlds of the call before, and they have only moved since then.
    pub fn advance<'a>(&mut self, model: &Model, worlds: &mut [&'a mut Simulation], again: bool) {
        let everybody_is_there =
            |world: &&'a mut Simulation| world.people().iter().all(PersonState::is_present);
        let seated = std::mem::take(&mut self.seated);
        if !(WORTH..=WIDTH).contains(&worlds.len()) || !worlds.iter().all(everybody_is_there) {
            return;
        }
        let Some(vectors) = vectors() else { return };
        if !(again && seated) {
            seat(&mut self.agents, worlds);
        }
        self.seated = true;
        seat_robots(&mut self.agents, worlds);
        let job = MotionJob {
            model,
            step: worlds[0].part(),
            lanes: self,
        };
        let finite = pulp::Simd::vectorize(vectors, job);
        for (lane, world) in worlds.iter_mut().enumerate() {
            // Changes nothing but that no bound is checked.
            let lane = lane % WIDTH;
            let people = world.move_people(!finite.lane(lane)).iter_mut();
            for (person, agent) in people.zip(&self.agents.all) {
                let of = |vectors: &Vectors| Vector2::new(vectors.x.at(lane), vectors.y.at(lane));
                (person.position, person.velocity) = (of(&agent.position), of(&agent.velocity));
            }
        }
    }
}

/// Decisions and motion, compiled once for each instruction set; their bits are the same for all.
struct MotionJob<'a> {
    model: &'a Model,
    step: f64,
    lanes: &'a mut WorldLanes,
}

impl pulp::NullaryFnOnce for MotionJob<'_> {
    /// Where everybody is at a finite place.
    type Output = LaneMask<WIDTH>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        let WorldLanes {
            agents,
            decisions,
            room,
            ..
        } = self.lanes;
        agents.look_ahead();
        decisions.clear();
        room.step = self.step;
        self.model.decide_in_lanes(agents, room, decisions);
        let cap = self.model.is_force().then(|| self.model.cap());
        agents.advance(decisions, cap, self.step)
    }
}

/// Puts the people of each world into a lane, those of the last one also into the lanes that are left over.
fn seat(agents: &mut AgentLanes, worlds: &[&mut Simulation]) {
    let people = worlds[0].people().len();
    agents.open(people, worlds[0].bodies().len());
    for lane in 0..WIDTH {
        let world = &worlds[lane.min(worlds.len() - 1)];
        let walkers = agents.all.iter_mut().zip(&mut agents.intentions);
        for ((agent, intention), person) in walkers.zip(world.people()) {
            agent.stand(lane, person.position, person.velocity, person.radius);
            intention.desired_speed.set(lane, person.desired_speed);
            intention.awareness.set(lane, person.awareness);
            if person.presence == Presence::Walking {
                intention.walk(lane, person.target);
            }
        }
    }
}

/// Puts the robots of each world into its lane.
fn seat_robots(agents: &mut AgentLanes, worlds: &[&mut Simulation]) {
    let people = agents.people();
    for lane in 0..WIDTH {
        let world = &worlds[lane.min(worlds.len() - 1)];
        for (agent, body) in agents.all[people..].iter_mut().zip(world.bodies()) {
            agent.stand(lane, body.position, body.velocity, body.radius);
            agent.face(lane, body.direction);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::crowd::models::of_pairs;
    use crate::crowd::world::{RobotSetup, Route, RouteEnd, Traits};
    use crate::run::Request;
    use navigation_world::robots::HolonomicRobot;
    use navigation_world::world::scenario::Mover;
    use numeric::random::Stream;

    fn person(stream: &mut Stream, number: usize) -> PersonSetup {
        let mut draw = |size: f64| [stream.uniform(-size, size), stream.uniform(-size, size)];
        let points = vec![Waypoint::Point(draw(2.0)); usize::from(number % 4 != 3)];
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
            pursuer: None,
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
            footprint: None,
            start: [-3.0, index as f64],
            goal: [20.0, 0.0],
            heading: 0.0,
            control_period: 0.25,
            arrival_tolerance: 0.3,
            sensing_range: 10.0,
            occlusion: false,
            task: None,
            measurement: None,
            built: None,
            law: None,
        });
        CrowdWorld {
            people,
            robots: robots.collect(),
            sources: Vec::new(),
            walls: Vec::new(),
            untold: 0,
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
            for model in of_pairs(cutoff, most) {
                let made: Vec<CrowdWorld> = (0..count)
                    .map(|_| world(&mut stream, model, size))
                    .collect();
                let expected = model_of(&made[0]).is_some();
                assert_eq!(expected, size[0] > 0);
                let start = |world: &CrowdWorld| Simulation::new(world.clone(), false).unwrap();
                let mut alone: Vec<Simulation> = made.iter().map(start).collect();
                let mut beside: Vec<Simulation> = made.iter().map(start).collect();
                let mut lanes = WorldLanes::default();
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
                        lanes.advance(&model, &mut under_way, false);
                        together += under_way
                            .iter_mut()
                            .map(|one| usize::from(one.people_have_moved()))
                            .sum::<usize>();
                        under_way.retain_mut(|world| world.advance() || world.end().is_err());
                    }
                    assert_eq!(told(&alone), told(&beside), "{model:?} {size:?} {step}");
                }
            }
        }
        assert!(together > 4000, "{together}");
    }
}
