//! Observation of a robot: itself, the nearest people, ranges of a lidar.

use crate::crowd::environments::settings::{Axes, EnvironmentSettings};
use crate::crowd::people::PersonState;
use crate::crowd::simulation::Simulation;
use crate::crowd::walls::Wall;
use navigation_world::world::shape::{PlacedShape, cast_on_disc, into_axes, out_of_axes};
use numeric::lanes::Vector2;

type Vector = Vector2<f64>;

/// Bound of every number without a bound of its own.
pub const BOUND: f64 = 100.0;
/// Range of the lidar, in m.
pub const RANGE: f64 = 10.0;

/// Axes of an observation in those of the world: none if they are the same, else the x axis.
#[derive(Clone, Copy)]
struct Turn(Option<Vector>);

impl Turn {
    fn of(axes: Axes, to_goal: Vector) -> Self {
        match axes {
            Axes::World => Self(None),
            Axes::Goal => {
                let distance = to_goal.norm();
                Self((distance > 0.0).then(|| to_goal / distance))
            }
        }
    }

    #[inline(always)]
    fn into_axes(self, vector: Vector) -> [f64; 2] {
        match self.0 {
            None => vector.into(),
            Some(axis) => into_axes(vector, axis).into(),
        }
    }

    fn out_of_axes(self, angle: f64) -> Vector {
        let (sin, cos) = angle.sin_cos();
        let ray = Vector::new(cos, sin);
        self.0.map_or(ray, |axis| out_of_axes(ray, axis))
    }
}

/// Distance and number of a person.
type Ranked = (f64, usize);

/// Up to so many people are ranked by comparing everybody with everybody, without a branch.
const FEW: usize = 8;

/// Room for the order of the people.
#[derive(Clone, Debug, Default)]
pub(super) struct Ranking {
    /// People who are present, by number.
    present: Vec<Ranked>,
    /// The nearest of them in their order.
    nearest: Vec<Ranked>,
}

impl Ranking {
    /// The nearest people of those present by the distance of their centers, then by number; `ways`: to them, NaN to
    /// those who are absent.
    fn nearest(&mut self, people: &[PersonState], ways: &[Vector], most: usize) -> &[Ranked] {
        if !self.rank(ways) {
            self.present.clear();
            let ways = people.iter().zip(ways).enumerate();
            let present = ways.filter(|(_, (person, _))| person.is_present());
            let ranked = present.map(|(number, (_, way))| (way.norm(), number));
            self.present.extend(ranked);
            self.insert(most);
        }
        &self.nearest[..most.min(self.nearest.len())]
    }

    /// Puts a few people at the places of their ranks; whether that is done.
    fn rank(&mut self, ways: &[Vector]) -> bool {
        let (mut distances, mut ranks) = ([0.0; FEW], [0; FEW]);
        if ways.len() > FEW {
            return false;
        }
        for (distance, way) in distances.iter_mut().zip(ways) {
            *distance = way.norm();
            // Those who are absent, or lost at the end of a world that diverges, have no rank.
            if distance.is_nan() {
                return false;
            }
        }
        for later in 1..ways.len() {
            for earlier in 0..later {
                let first = usize::from(distances[earlier] <= distances[later]);
                ranks[later] += first;
                ranks[earlier] += 1 - first;
            }
        }
        self.nearest.resize(ways.len(), (0.0, 0));
        for (number, (distance, rank)) in distances.iter().zip(ranks).take(ways.len()).enumerate() {
            self.nearest[rank] = (*distance, number);
        }
        true
    }

    /// Inserts one after the other among the nearest before.
    fn insert(&mut self, most: usize) {
        self.nearest.clear();
        for one in &self.present {
            let place = self.nearest.partition_point(|other| other.0 <= one.0);
            if place < most {
                self.nearest.truncate(most - 1);
                self.nearest.insert(place, *one);
            }
        }
    }
}

/// Writes an observation; `own` goal and greatest speed are those of the robot that is driven. Returns how many
/// people of it are there. `ways`: from the robot to the people, NaN to those who are absent.
pub(super) fn observe(
    settings: &EnvironmentSettings,
    (simulation, ways): (&Simulation, &[Vector]),
    ranking: &mut Ranking,
    into: &mut [f32],
) -> usize {
    let world = &settings.world;
    let (setup, robot) = (&world.robots[0], &simulation.robots()[0]);
    let state = robot.state();
    let to_goal = Vector::from(setup.goal) - state.position;
    let turn = Turn::of(settings.axes, to_goal);
    let [goal_x, goal_y] = turn.into_axes(to_goal);
    let [speed_x, speed_y] = turn.into_axes(state.velocity);
    let own = [goal_x, goal_y, speed_x, speed_y, setup.max_speed()];
    let (head, rest) = into.split_at_mut(EnvironmentSettings::OWN);
    for (slot, value) in head.iter_mut().zip(own) {
        *slot = bounded(value, -BOUND, BOUND);
    }
    head[5] = bounded(simulation.time() / world.time_limit, 0.0, 1.0);
    let (people, rays) = rest.split_at_mut(EnvironmentSettings::PERSON * settings.people);
    let nearest = ranking.nearest(simulation.people(), ways, settings.people);
    let radius = setup.radius();
    let (there, nobody) = people.split_at_mut(EnvironmentSettings::PERSON * nearest.len());
    nobody.fill(0.0);
    for (slots, (distance, number)) in there
        .chunks_exact_mut(EnvironmentSettings::PERSON)
        .zip(nearest)
    {
        let person: &PersonState = &simulation.people()[*number];
        let [x, y] = turn.into_axes(ways[*number]);
        let [vx, vy] = turn.into_axes(person.velocity - state.velocity);
        let gap = distance - radius - person.radius;
        for (slot, value) in slots.iter_mut().zip([x, y, vx, vy, gap]) {
            *slot = bounded(value, -BOUND, BOUND);
        }
    }
    let count = rays.len() as f64;
    for (index, slot) in rays.iter_mut().enumerate() {
        let angle = std::f64::consts::TAU * index as f64 / count;
        let range = range(simulation, state.position, turn.out_of_axes(angle));
        *slot = bounded(range, 0.0, RANGE);
    }
    nearest.len()
}

/// A number within its bounds, in single precision.
#[allow(clippy::cast_possible_truncation)] // observations are in single precision
fn bounded(value: f64, low: f64, high: f64) -> f32 {
    value.clamp(low, high) as f32
}

/// Distance from the center of the robot along a ray to people, other robots and walls, in m.
fn range(simulation: &Simulation, from: Vector, ray: Vector) -> f64 {
    let period = simulation.world().period;
    let mut least = RANGE;
    for person in simulation
        .people()
        .iter()
        .filter(|person| person.is_present())
    {
        let to = period.wrap(person.position - from);
        least = least.min(cast_on_disc(to, person.radius, ray));
    }
    for robot in &simulation.robots()[1..] {
        let to = period.wrap(robot.state().position - from);
        least = least.min(cast_on_disc(to, robot.radius(), ray));
    }
    for wall in &simulation.world().walls {
        least = least.min(cast_on_wall(wall, from, ray));
    }
    least
}

fn cast_on_wall(wall: &Wall, from: Vector, ray: Vector) -> f64 {
    match wall {
        Wall::Solid(shape) => shape.cast(from, ray),
        Wall::Polyline(points) => {
            let segments = points.windows(2);
            let cast =
                |ends: &[Vector]| PlacedShape::wall(ends[0].into(), ends[1].into()).cast(from, ray);
            segments.map(cast).fold(f64::INFINITY, f64::min)
        }
    }
}
