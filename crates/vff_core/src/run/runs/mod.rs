//! State of the robots of one lane group, and what is counted of their runs.

mod account;
mod dormant;
mod ends;
mod totals;
mod touch;

pub(crate) use dormant::Dormant;

use crate::lanes::{Mask, Planar, Real, Vector2, Zero};
use crate::laws::Command;
use crate::robots::WheelModel;
use crate::run::options::Clock;
use crate::run::scene::World;
use crate::run::walls::{Maps, Walls};
use crate::sensing::sampled::Past;
use crate::world::geometry::Body;
use crate::world::scenario::{PlacedObstacle, Scenario};
use touch::{Touch, alert_squared};

/// Room for rounding where a distance bound spares work, in m.
const BOUND_MARGIN: f64 = 1e-6;

/// State of the robots of one lane group.
///
/// `W` is where they run: one scenario for all, a reference in the kernel and a shared owner in an
/// episode that is stepped from outside, or a scenario for each lane.
#[derive(Clone)]
pub(crate) struct Runs<W: World<R>, R: Real> {
    pub scenario: W,
    pub clock: Clock,
    pub position: Vector2<R>,
    pub velocity: Vector2<R>,
    pub speed: R,
    /// Motor currents in A of the last step, for a recorder.
    pub currents: [R; 3],
    pub running: R::Mask,
    /// The held force, and what it accelerates with, in m/s^2.
    pub command: Command<R>,
    pub acceleration: Vector2<R>,
    /// Change of velocity in one step of the held force, in m/s.
    pub push: Vector2<R>,
    /// Measured position at the sample before, if it was measured with an error.
    pub last_measured: Option<Vector2<R>>,
    /// Positions at the last motion steps, if they are measured late.
    pub past: Option<Past<R>>,
    goal: Vector2<R>,
    wheels: WheelModel,
    wheel_speeds: [R; 3],
    squared_current: R,
    path: R,
    /// Whether any robot can arrive before the next sample.
    near_goal: bool,
    /// Whether the least distance to each obstacle can change, or a contact with it last, before the
    /// next sample.
    pub watched: Vec<bool>,
    /// The obstacles that are looked at, where some are dormant; only runs by themselves leave some alone.
    awake: Option<Vec<usize>>,
    /// Distance in m at which robot and obstacle touch, and the largest speed of each obstacle in
    /// m/s, infinite if there is none.
    reach: Vec<W::Number>,
    speed_bound: Vec<W::Number>,
    /// Square of the distance in m beyond which they do not touch in the motion step before, in m^2.
    alert: Vec<W::Number>,
    /// Instant from which no obstacle moves any more, in s.
    all_stand_from: f64,
    /// Last sample at which each robot was not at rest, in s.
    moved: R,
    end_time: R,
    arrival_time: R,
    stopped: R::Mask,
    /// Whether an obstacle was touched that was not touched before.
    touched: bool,
    force_evaluations: R,
    min_distance_squared: Vec<R>,
    /// Contacts with each obstacle, the lanes fastest.
    touches: Vec<Touch>,
    /// What is counted of walls, where there are any.
    walls: Option<Box<Walls<R>>>,
}

impl<W: World<R>, R: Real> Runs<W, R> {
    /// With the obstacles at the start.
    pub fn new(
        scenario: W,
        clock: Clock,
        bodies: impl ExactSizeIterator<Item = Body<W::Number>>,
        maps: Maps,
    ) -> Self {
        let mut runs = Self::at_start(scenario, clock, bodies.len(), maps);
        for (index, body) in bodies.enumerate() {
            runs.watch(index, &body, W::Number::zero(), runs.running, None);
        }
        runs
    }

    /// Robots at their starts, before the first look at the obstacles.
    pub fn at_start(world: W, clock: Clock, count: usize, maps: Maps) -> Self {
        let scenario = world.common();
        let velocity = Vector2::zeros();
        let wheels = WheelModel::new(&scenario.robot, scenario.rules.heading, clock.step);
        let unset = R::splat(f64::NAN);
        let (reach, speed_bound) = (world.reaches(count), world.speed_bounds(count));
        let bounds = reach.iter().zip(&speed_bound);
        let own = scenario.robot.max_speed;
        let alert = bounds.map(|(reach, bound)| alert_squared(*reach, *bound, own, clock.step));
        let mut runs = Self {
            clock,
            position: Vector2::splat(scenario.start),
            velocity,
            speed: R::zero(),
            currents: [R::zero(); 3],
            running: R::Mask::splat(true),
            command: Command {
                force: Vector2::zeros(),
                stabilizing: Vector2::zeros(),
                lyapunov: R::splat(f64::NAN),
            },
            acceleration: Vector2::zeros(),
            push: Vector2::zeros(),
            last_measured: None,
            past: Past::new(scenario, clock.step),
            goal: Vector2::splat(scenario.goal),
            wheels,
            wheel_speeds: wheels.speeds(velocity),
            squared_current: R::zero(),
            path: R::zero(),
            near_goal: true,
            watched: vec![true; count],
            awake: None,
            alert: alert.collect(),
            reach,
            speed_bound,
            all_stand_from: world.stands_from(),
            moved: R::zero(),
            end_time: unset,
            arrival_time: unset,
            stopped: R::Mask::none(),
            touched: false,
            force_evaluations: R::zero(),
            min_distance_squared: vec![R::splat(f64::INFINITY); count],
            touches: vec![Touch::default(); count * R::WIDTH],
            walls: Walls::new(maps, scenario.robot.radius).map(Box::new),
            scenario: world,
        };
        runs.watch_walls(None, R::zero(), runs.running);
        runs.remember();
        runs
    }

    /// A lane takes another scenario, whose robot is at its start.
    pub fn enter(&mut self, lane: usize, scenario: &Scenario) {
        let ([x, y], [goal_x, goal_y]) = (scenario.start, scenario.goal);
        let set = |number: &mut R, value: f64| number.set(lane, value);
        set(&mut self.position.x, x);
        set(&mut self.position.y, y);
        set(&mut self.goal.x, goal_x);
        set(&mut self.goal.y, goal_y);
        set(&mut self.velocity.x, 0.0);
        set(&mut self.velocity.y, 0.0);
        let standing = self.wheels.speeds(Vector2::<f64>::zeros());
        for (speed, standing) in self.wheel_speeds.iter_mut().zip(standing) {
            set(speed, standing);
        }
        for number in [
            &mut self.speed,
            &mut self.squared_current,
            &mut self.path,
            &mut self.moved,
            &mut self.force_evaluations,
        ] {
            set(number, 0.0);
        }
        set(&mut self.end_time, f64::NAN);
        set(&mut self.arrival_time, f64::NAN);
        for index in 0..self.watched.len() {
            let (reach, bound) = reach_and_bound(scenario.obstacles.get(index));
            self.reach[index].set(lane, reach);
            self.speed_bound[index].set(lane, bound);
            let alert = alert_squared(reach, bound, scenario.robot.max_speed, self.clock.step);
            self.alert[index].set(lane, alert);
            self.touches[index * R::WIDTH + lane] = Touch::default();
            set(&mut self.min_distance_squared[index], f64::INFINITY);
        }
    }

    /// The runs of some lanes begin, with the obstacles as given.
    pub fn begin(&mut self, lanes: R::Mask, world: W, bodies: &[Body<W::Number>]) {
        self.running = self.running | lanes;
        self.stopped = self.stopped & !lanes;
        (self.near_goal, self.scenario) = (true, world);
        self.watched.fill(true);
        for (index, body) in bodies.iter().enumerate() {
            self.watch(index, body, W::Number::zero(), lanes, None);
        }
    }

    /// Obstacle of a place in the scene.
    #[inline(always)]
    fn obstacle(&self, slot: usize) -> usize {
        match &self.awake {
            Some(awake) if R::WIDTH == 1 => awake[slot],
            _ => slot,
        }
    }

    /// An obstacle comes into the scene.
    fn wake(&mut self, slot: usize, index: usize) {
        if let Some(awake) = &mut self.awake {
            awake.insert(slot, index);
            self.watched.insert(slot, true);
        }
    }

    /// An obstacle leaves the scene.
    fn fall_asleep(&mut self, slot: usize) {
        if let Some(awake) = &mut self.awake {
            awake.remove(slot);
            self.watched.remove(slot);
        }
    }

    /// Keeps the present positions for robots that are measured late.
    pub fn remember(&mut self) {
        if let Some(past) = &mut self.past {
            past.push(self.position);
        }
    }
}

/// Distance in m at which the robot touches an obstacle of a lane, and the largest speed of that in
/// m/s, infinite if there is none; both 0 where the lane has no such obstacle.
fn reach_and_bound(placed: Option<&PlacedObstacle>) -> (f64, f64) {
    placed.map_or((0.0, 0.0), |placed| {
        (placed.contact_distance, placed.fastest())
    })
}
