//! State of the robots of one lane group, and what is counted of their runs.

mod account;
mod dormant;
mod ends;
mod outline;
mod totals;
mod touch;

pub(crate) use dormant::Dormant;

use crate::run::options::Clock;
use crate::run::scene::World;
use crate::run::walls::{Maps, WallContacts};
use navigation_laws::Command;
use navigation_world::robots::WheelModel;
use navigation_world::sensing::sampled::Past;
use navigation_world::world::geometry::Body;
use navigation_world::world::scenario::{PlacedObstacle, Scenario};
use numeric::lanes::{Mask, Planar, Real, Vector2};
use outline::OutlineState;
use touch::{ContactState, alert_squared};

/// Room for rounding where a distance bound spares work, in m.
const BOUND_MARGIN: f64 = 1e-6;

/// State of the robots of one lane group.
///
/// `W` is where they run: one scenario for all, a reference in the kernel and a shared owner in an
/// episode that is stepped from outside, or a scenario for each lane.
#[derive(Clone)]
pub(crate) struct LaneState<W: World, R: Real> {
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
    reach: Vec<R>,
    speed_bound: Vec<R>,
    /// Square of the distance in m beyond which they do not touch in the motion step before, in m^2.
    alert: Vec<R>,
    /// Instant from which no obstacle moves any more, in s.
    all_stand_from: R,
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
    touches: Vec<ContactState>,
    /// Clearance and contacts of walls, where there are any.
    walls: Option<Box<WallContacts<R>>>,
    /// Of a robot that is no disc: runs of it are stepped by themselves.
    outline: Option<Box<OutlineState>>,
}

impl<W: World, R: Real> LaneState<W, R> {
    /// With the obstacles at the start.
    pub fn new(
        scenario: W,
        clock: Clock,
        bodies: impl ExactSizeIterator<Item = Body<R>>,
        maps: Maps,
    ) -> Self {
        let mut runs = Self::at_start(scenario, clock, bodies.len(), maps);
        if runs.outline.is_some() {
            let bodies: Vec<_> = bodies.collect();
            runs.watch_outline(&bodies, None, 0.0);
            return runs;
        }
        for (index, body) in bodies.enumerate() {
            runs.watch(index, &body, R::zero(), runs.running, None);
        }
        runs
    }

    /// Robots at their starts, before the first look at the obstacles.
    pub fn at_start(world: W, clock: Clock, count: usize, maps: Maps) -> Self {
        let scenario = world.common();
        let wheels = WheelModel::new(&scenario.robot, scenario.rules.heading, clock.step);
        let mut runs = Self {
            clock,
            position: Vector2::zeros(),
            velocity: Vector2::zeros(),
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
            past: Past::new(scenario, clock.step),
            goal: Vector2::zeros(),
            wheels,
            wheel_speeds: [R::zero(); 3],
            squared_current: R::zero(),
            path: R::zero(),
            near_goal: true,
            watched: vec![true; count],
            awake: None,
            reach: vec![R::zero(); count],
            speed_bound: vec![R::zero(); count],
            alert: vec![R::zero(); count],
            all_stand_from: R::zero(),
            moved: R::zero(),
            end_time: R::zero(),
            arrival_time: R::zero(),
            stopped: R::Mask::none(),
            touched: false,
            force_evaluations: R::zero(),
            min_distance_squared: vec![R::zero(); count],
            touches: vec![ContactState::default(); count * R::WIDTH],
            walls: WallContacts::new(maps, scenario.robot.radius).map(Box::new),
            outline: scenario.footprint.clone().map(|footprint| {
                let (radius, heading) = (scenario.robot.radius, scenario.rules.heading);
                Box::new(OutlineState::new(footprint, radius, heading))
            }),
            scenario: world,
        };
        let world = runs.scenario.clone();
        for lane in 0..R::WIDTH {
            runs.take_obstacles(lane, world.of_lane(lane));
            runs.enter(lane, world.of_lane(lane));
        }
        if runs.outline.is_none() {
            runs.watch_walls(None, R::zero(), runs.running);
        }
        runs.remember();
        runs
    }

    /// A lane takes another scenario, whose robot is at its start.
    pub fn enter(&mut self, lane: usize, scenario: &Scenario) {
        for number in self.numbers() {
            number.set(lane, 0.0);
        }
        self.position.set_lane(lane, scenario.start);
        self.goal.set_lane(lane, scenario.goal);
        let standing = self.wheels.speeds(Vector2::<f64>::zeros());
        for (speed, standing) in self.wheel_speeds.iter_mut().zip(standing) {
            speed.set(lane, standing);
        }
        self.end_time.set(lane, f64::NAN);
        self.arrival_time.set(lane, f64::NAN);
        for index in 0..self.reach.len() {
            self.touches[index * R::WIDTH + lane] = ContactState::default();
            self.min_distance_squared[index].set(lane, f64::INFINITY);
        }
        if let Some(past) = &mut self.past {
            past.enter(lane, scenario.start);
        }
        if let Some(walls) = &mut self.walls {
            walls.enter(lane);
        }
    }

    /// Takes sizes and speeds of the obstacles of a lane.
    pub fn take_obstacles(&mut self, lane: usize, scenario: &Scenario) {
        self.all_stand_from.set(lane, scenario.stands_from());
        for index in 0..self.reach.len() {
            let (reach, bound) = reach_and_bound(scenario.obstacles.get(index));
            self.reach[index].set(lane, reach);
            self.speed_bound[index].set(lane, bound);
            let alert = alert_squared(reach, bound, scenario.robot.max_speed, self.clock.step);
            self.alert[index].set(lane, alert);
        }
    }

    /// A lane continues from where the first lane of another group is, in the same scenario.
    pub fn follow(&mut self, lane: usize, leader: &mut Self) {
        for (number, own) in self.numbers().into_iter().zip(leader.numbers()) {
            number.set(lane, own.lane(0));
        }
        let least = self.min_distance_squared.iter_mut();
        for (number, own) in least.zip(&leader.min_distance_squared) {
            number.set(lane, own.lane(0));
        }
        for index in 0..self.reach.len() {
            self.touches[index * R::WIDTH + lane] = leader.touches[index * R::WIDTH];
        }
        if let (Some(walls), Some(own)) = (&mut self.walls, &mut leader.walls) {
            walls.follow(lane, own);
        }
    }

    /// Numbers of every lane that change with time, beside the counts of obstacles and walls.
    fn numbers(&mut self) -> [&mut R; 14] {
        let [first, second, third] = &mut self.wheel_speeds;
        let [position, velocity] = [&mut self.position, &mut self.velocity];
        let [[x, y]] = &mut position.data.0;
        let [[along_x, along_y]] = &mut velocity.data.0;
        [
            x,
            y,
            along_x,
            along_y,
            &mut self.speed,
            first,
            second,
            third,
            &mut self.squared_current,
            &mut self.path,
            &mut self.moved,
            &mut self.end_time,
            &mut self.arrival_time,
            &mut self.force_evaluations,
        ]
    }

    /// The runs of some lanes begin, with the obstacles as given.
    pub fn begin(&mut self, lanes: R::Mask, bodies: &[Body<R>]) {
        for (index, body) in bodies.iter().enumerate() {
            self.watch(index, body, R::zero(), lanes, None);
        }
        self.watch_walls(None, R::zero(), lanes);
    }

    /// The runs of some lanes continue from where they are.
    pub fn start(&mut self, lanes: R::Mask) {
        self.running = self.running | lanes;
        self.stopped = self.stopped & !lanes;
        self.near_goal = true;
        self.watched.fill(true);
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
