//! State of the robots of one lane group, and what is counted of their runs.

use crate::error::{Failure, Result};
use crate::lanes::{Mask, Planar, Real, Vector2, Wide, Zero};
use crate::laws::Command;
use crate::robots::WheelModel;
use crate::run::options::Clock;
use crate::run::outcome::{CONTACT_SPEED, Contact, Outcome, RunSummary, RunTotals};
use crate::run::record::Recorder;
use crate::run::scene::{World, body_at};
use crate::run::walls::{Maps, Walls};
use crate::sensing::sampled::Past;
use crate::world::geometry::Body;
use crate::world::scenario::{PlacedObstacle, Scenario};

/// A robot slower than this is at rest, in m/s.
const REST_SPEED: f64 = 1e-3;

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
    /// Distance in m at which robot and obstacle touch, and the largest speed of each obstacle in
    /// m/s, infinite if there is none.
    reach: Vec<W::Number>,
    speed_bound: Vec<W::Number>,
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
    contact_time: Vec<R>,
    contact_speed: Vec<R>,
    /// One where the robot moved toward the obstacle at some instant of a contact.
    at_fault: Vec<R>,
    /// What is counted of walls, where there are any.
    walls: Option<Box<Walls<R>>>,
}

impl<W: World<R>, R: Real> Runs<W, R> {
    pub fn new(scenario: W, clock: Clock, bodies: &[Body<W::Number>], maps: Maps) -> Self {
        let mut runs = Self::at_start(scenario, clock, bodies.len(), maps);
        for (index, body) in bodies.iter().enumerate() {
            runs.watch(index, body, W::Number::zero(), runs.running);
        }
        runs.watch_walls(R::zero(), runs.running);
        runs.remember();
        runs
    }

    /// Robots at their starts, before the first look at the obstacles.
    fn at_start(world: W, clock: Clock, count: usize, maps: Maps) -> Self {
        let scenario = world.common();
        let velocity = Vector2::zeros();
        let wheels = WheelModel::new(&scenario.robot, scenario.rules.heading, clock.step);
        let unset = R::splat(f64::NAN);
        Self {
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
            reach: (0..count).map(|index| world.reach(index)).collect(),
            speed_bound: (0..count).map(|index| world.speed_bound(index)).collect(),
            all_stand_from: world.stands_from(),
            moved: R::zero(),
            end_time: unset,
            arrival_time: unset,
            stopped: R::Mask::none(),
            touched: false,
            force_evaluations: R::zero(),
            min_distance_squared: vec![R::splat(f64::INFINITY); count],
            contact_time: vec![unset; count],
            contact_speed: vec![unset; count],
            at_fault: vec![R::zero(); count],
            walls: Walls::new(maps, scenario.robot.radius).map(Box::new),
            scenario: world,
        }
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
            set(&mut self.min_distance_squared[index], f64::INFINITY);
            set(&mut self.contact_time[index], f64::NAN);
            set(&mut self.contact_speed[index], f64::NAN);
            set(&mut self.at_fault[index], 0.0);
        }
    }

    /// The runs of some lanes begin, with the obstacles as given.
    pub fn begin(&mut self, lanes: R::Mask, world: W, bodies: &[Body<W::Number>]) {
        self.running = self.running | lanes;
        self.stopped = self.stopped & !lanes;
        (self.near_goal, self.scenario) = (true, world);
        self.watched.fill(true);
        for (index, body) in bodies.iter().enumerate() {
            self.watch(index, body, W::Number::zero(), lanes);
        }
    }

    /// Keeps the present positions for robots that are measured late.
    pub fn remember(&mut self) {
        if let Some(past) = &mut self.past {
            past.push(self.position);
        }
    }

    /// Counts a sample of the force.
    #[inline(always)]
    pub fn count_sample(&mut self) {
        let one = R::splat(1.0);
        self.force_evaluations += R::select(self.running, one, R::zero());
    }

    /// Accounts for a motion step from `before`, after which the obstacles are as given. `record`:
    /// the currents are looked at afterwards.
    #[inline(always)]
    pub fn account(
        &mut self,
        bodies: &[Body<W::Number>],
        before: Vector2<R>,
        time: W::Number,
        record: bool,
    ) {
        let speeds = self.wheels.speeds(self.velocity);
        let currents = self.wheels.currents(&self.wheel_speeds, &speeds);
        self.wheel_speeds = speeds;
        if record {
            self.currents = currents;
        }
        let [first, second, third] = currents;
        let squared = first * first + second * second + third * third;
        let way = self.speed * R::splat(self.clock.step);
        if self.near_goal {
            let to_goal = self.goal - self.position;
            let tolerance = self.scenario.common().rules.arrival_tolerance;
            let near = to_goal.dot(&to_goal).le(R::splat(tolerance * tolerance));
            let arrived = self.running & near;
            if arrived.any() {
                self.arrive(before, time, arrived, squared, way);
            }
        }
        self.squared_current += R::select(self.running, squared, R::zero());
        self.path += R::select(self.running, way, R::zero());
        for (index, body) in bodies.iter().enumerate() {
            if self.watched[index] {
                self.watch(index, body, time, self.running);
            }
        }
        if self.walls.is_some() {
            self.watch_walls(time.wide(), self.running);
        }
    }

    /// Least distance and contact of some lanes with the maps.
    #[inline(never)]
    fn watch_walls(&mut self, time: R, lanes: R::Mask) {
        if let Some(walls) = &mut self.walls {
            self.touched |= walls.watch(self.position, self.speed, time, lanes);
        }
    }

    /// Least distance and contact of some lanes with an obstacle.
    #[inline(always)]
    fn watch<B: Wide<R>>(&mut self, index: usize, body: &Body<B>, time: B, lanes: R::Mask) {
        let here = B::wide_mask(body.state.present);
        if !here.any() {
            return;
        }
        let lanes = lanes & here;
        let offset = body.offset(self.position);
        let squared = offset.distance_squared;
        let least = &mut self.min_distance_squared[index];
        *least = R::select(lanes, squared, R::splat(f64::INFINITY)).min(*least);
        let reach = self.reach[index];
        let touching = lanes & squared.le((reach * reach).wide());
        if touching.any() {
            self.touch(index, time.wide(), touching, offset.vector);
        }
    }

    /// Finds out what cannot happen before the next sample, so that it need not be looked for:
    /// nothing moves farther than its largest speed takes it.
    #[inline(always)]
    pub fn look_ahead(&mut self, bodies: &[Body<W::Number>]) {
        let Clock {
            interval,
            steps_per_sample,
            ..
        } = self.clock;
        if steps_per_sample == 1 {
            return;
        }
        let common = self.scenario.common();
        let own = common.robot.max_speed;
        let to_goal = self.goal - self.position;
        let reach = common.rules.arrival_tolerance + own * interval + BOUND_MARGIN;
        let near = to_goal.dot(&to_goal).lt(R::splat(reach * reach));
        self.near_goal = (near & self.running).any();
        let number = W::Number::splat;
        for (index, body) in bodies.iter().enumerate() {
            let speed = self.speed_bound[index];
            let way = (number(own) + speed) * number(interval) + number(BOUND_MARGIN);
            // Within a contact the robot may turn toward the obstacle, however near they have been.
            let reach = self.reach[index].wide();
            let least = self.min_distance_squared[index].sqrt().max(reach) + way.wide();
            let squared = body.offset(self.position).distance_squared;
            let here = W::Number::wide_mask(body.state.present);
            let near = squared.lt(least * least) | !here;
            self.watched[index] = (near & self.running).any();
        }
    }

    #[cold]
    fn touch(&mut self, index: usize, time: R, touching: R::Mask, offset: Vector2<R>) {
        let toward = self.velocity.dot(&offset).lt(R::zero());
        let moving = R::splat(CONTACT_SPEED).lt(self.velocity.dot(&self.velocity).sqrt());
        let fault = touching & toward & moving;
        self.at_fault[index] = R::select(fault, R::splat(1.0), self.at_fault[index]);
        for lane in 0..R::WIDTH {
            if touching.lane(lane) && self.contact_time[index].lane(lane).is_nan() {
                let speed = self.speed.lane(lane);
                self.contact_time[index] = self.contact_time[index].replace(lane, time.lane(lane));
                self.contact_speed[index] = self.contact_speed[index].replace(lane, speed);
                self.touched = true;
            }
        }
    }

    /// Ends the runs of lanes that entered the circle around the goal in this step, at the
    /// instant of entry, linear inside the step.
    #[cold]
    #[inline(never)]
    fn arrive(
        &mut self,
        before: Vector2<R>,
        time: W::Number,
        arrived: R::Mask,
        squared: R,
        way: R,
    ) {
        let tolerance = self.scenario.common().rules.arrival_tolerance;
        let after = self.position;
        let length = |vector: Vector2<R>| vector.dot(&vector).sqrt();
        let (from, to) = (length(self.goal - before), length(self.goal - after));
        let share = (from - R::splat(tolerance)) / (from - to);
        let entry = before + (after - before) * share;
        self.position = Vector2::select(arrived, entry, after);
        self.squared_current += R::select(arrived, squared * share, R::zero());
        self.path += R::select(arrived, way * share, R::zero());
        for lane in (0..R::WIDTH).filter(|lane| arrived.lane(*lane)) {
            let step = self.clock.step;
            let instant = (time.wide().lane(lane) - step) + share.lane(lane) * step;
            self.arrival_time = self.arrival_time.replace(lane, instant);
            self.end_time = self.end_time.replace(lane, instant);
            // Only this lane is watched at its own instant.
            let others = (0..R::WIDTH).filter(|other| *other != lane);
            let only = others.fold(R::Mask::splat(true), Mask::without);
            let world = self.scenario.clone();
            for (index, placed) in world.of_lane(lane).obstacles.iter().enumerate() {
                self.watch(index, &body_at(placed, instant, &mut 0), instant, only);
            }
            self.watch_walls(R::splat(instant), only);
        }
        self.running = self.running & !arrived;
    }

    /// Ends the runs of lanes that have been at rest for too long.
    #[inline(always)]
    pub fn rest(&mut self, time: W::Number) {
        let still = self.speed.lt(R::splat(REST_SPEED));
        self.moved = R::select(still, self.moved, time.wide());
        let rest_time = self.scenario.common().rules.rest_time;
        let long = R::splat(rest_time).le(time.wide() - self.moved);
        let ended = self.running & long;
        if ended.any() {
            self.stopped = self.stopped | ended;
            self.end(ended, time);
        }
    }

    /// Whether any robot is in the active region of an obstacle.
    #[inline(always)]
    pub fn feels_any(&self, bodies: &[Body<W::Number>]) -> bool {
        bodies.iter().any(|body| {
            let reach = body.regions.active_radius;
            let squared = body.offset(self.position).distance_squared;
            let here = W::Number::wide_mask(body.state.present);
            (here & squared.lt((reach * reach).wide())).any()
        })
    }

    /// Ends the runs of lanes that stand in a critical region for good: obstacle and robot at
    /// rest, and nothing else that moves.
    #[inline(always)]
    pub fn end_hopeless(&mut self, bodies: &[Body<W::Number>], time: W::Number) {
        let still = self.running & self.speed.lt(R::splat(REST_SPEED));
        let still = still & time.wide().ge(R::splat(self.all_stand_from));
        if still.any() {
            self.end_caught(bodies, time, still);
        }
    }

    #[cold]
    #[inline(never)]
    fn end_caught(&mut self, bodies: &[Body<W::Number>], time: W::Number, still: R::Mask) {
        // Braked within one control period, it goes no farther than that.
        let way = self.speed * R::splat(self.clock.interval) + R::splat(BOUND_MARGIN);
        let mut caught = R::Mask::none();
        for body in bodies {
            let distance = body.offset(self.position).distance_squared.sqrt();
            caught = caught | (distance + way).lt(body.regions.critical_radius.wide());
        }
        let ended = still & caught;
        if ended.any() {
            self.stopped = self.stopped | ended;
            self.end(ended, time);
        }
    }

    /// Ends the runs of lanes that have touched an obstacle.
    #[inline(always)]
    pub fn stop_at_contact(&mut self, time: W::Number) {
        if self.touched {
            self.touched = false;
            self.stop_touched(time);
        }
    }

    #[cold]
    #[inline(never)]
    fn stop_touched(&mut self, time: W::Number) {
        let mut touched = R::Mask::none();
        for contact in &self.contact_time {
            touched = touched | contact.le(time.wide());
        }
        if let Some(walls) = &self.walls {
            touched = touched | walls.contact_time.le(time.wide());
        }
        let ended = self.running & touched;
        if ended.any() {
            self.end(ended, time);
        }
    }

    /// Ends the runs of some lanes.
    pub fn end(&mut self, lanes: R::Mask, time: W::Number) {
        self.end_time = R::select(lanes, time.wide(), self.end_time);
        self.running = self.running & !lanes;
    }

    /// When the run of the first lane ended, in s.
    pub fn first_end(&self) -> f64 {
        self.end_time.lane(0)
    }

    #[inline(always)]
    pub fn check_finite(&self, time: W::Number) -> Result<()> {
        let limit = R::splat(f64::INFINITY);
        let finite = |vector: Vector2<R>| vector.x.abs().lt(limit) & vector.y.abs().lt(limit);
        self.check(finite(self.position) & finite(self.velocity), time)
    }

    /// A force whose magnitude overflows has no direction left.
    #[inline(always)]
    pub fn check_force(&self, force: Vector2<R>, time: W::Number) -> Result<()> {
        let sound = force.dot(&force).lt(R::splat(f64::INFINITY));
        self.check(sound, time)
    }

    #[inline(always)]
    fn check(&self, sound: R::Mask, time: W::Number) -> Result<()> {
        let lost = self.running & !sound;
        if lost.any() {
            let run = (0..R::WIDTH).find(|lane| lost.lane(*lane)).unwrap_or(0);
            let time = time.wide().lane(run);
            return Err(Failure::NonFinite { run, time });
        }
        Ok(())
    }

    /// Least distance `d` to an obstacle in m; infinite if it was never present.
    pub fn min_distance(&self, obstacle: usize, lane: usize) -> f64 {
        self.min_distance_squared[obstacle].lane(lane).sqrt()
    }

    /// First contact with an obstacle.
    fn contact(&self, obstacle: usize, lane: usize) -> Option<Contact> {
        let time = self.contact_time[obstacle].lane(lane);
        let speed = self.contact_speed[obstacle].lane(lane);
        let at_fault = self.at_fault[obstacle].lane(lane) > 0.0;
        (!time.is_nan()).then_some(Contact {
            time,
            speed,
            at_fault,
        })
    }

    /// First contact with a map; the robot is always at fault.
    fn map_contact(&self, lane: usize) -> Option<Contact> {
        let walls = self.walls.as_ref()?;
        let time = walls.contact_time.lane(lane);
        (!time.is_nan()).then_some(Contact {
            time,
            speed: walls.contact_speed.lane(lane),
            at_fault: true,
        })
    }

    /// Least distance of the surfaces from the maps in m; infinite without any.
    fn map_clearance(&self, lane: usize) -> f64 {
        let walls = self.walls.as_ref();
        walls.map_or(f64::INFINITY, |walls| walls.least.lane(lane))
    }

    /// What is left of the run of a lane, whatever the number of obstacles.
    pub fn totals(&self, lane: usize, recorder: &impl Recorder<R>) -> RunTotals {
        let (mut contacts, mut at_fault) = ([0, 0], 0);
        for obstacle in 0..self.scenario.of_lane(lane).obstacle_count() {
            if let Some(touch) = self.contact(obstacle, lane) {
                contacts[usize::from(touch.speed <= CONTACT_SPEED)] += 1;
                at_fault += u32::from(touch.at_fault);
            }
        }
        if let Some(touch) = self.map_contact(lane) {
            contacts[usize::from(touch.speed <= CONTACT_SPEED)] += 1;
            at_fault += 1;
        }
        let arrival_time = self.arrival_time.lane(lane);
        let outcome = if contacts != [0, 0] {
            Outcome::Collided
        } else if !arrival_time.is_nan() {
            Outcome::Arrived
        } else if self.stopped.lane(lane) {
            Outcome::Stopped
        } else {
            Outcome::TimedOut
        };
        RunTotals {
            outcome,
            end_time: self.end_time.lane(lane),
            arrival_time,
            energy: self.squared_current.lane(lane) * self.wheels.loss_per_square(),
            path_length: self.path.lane(lane),
            contacts,
            at_fault,
            map_clearance: self.map_clearance(lane),
            descent_share: recorder.descent_share(lane),
            force_evaluations: count_of(self.force_evaluations.lane(lane)),
        }
    }

    /// Everything that is left of the run of a lane.
    pub fn summary(&self, lane: usize, recorder: &impl Recorder<R>) -> RunSummary {
        let totals = self.totals(lane, recorder);
        let obstacles = 0..self.scenario.of_lane(lane).obstacle_count();
        let distance = |obstacle| self.min_distance(obstacle, lane);
        let contact = |obstacle| self.contact(obstacle, lane);
        RunSummary {
            outcome: totals.outcome,
            end_time: totals.end_time,
            arrival_time: (!totals.arrival_time.is_nan()).then_some(totals.arrival_time),
            energy: totals.energy,
            path_length: totals.path_length,
            min_distance: obstacles.clone().map(distance).collect(),
            contact: obstacles.map(contact).collect(),
            map_contact: self.map_contact(lane),
            map_clearance: totals.map_clearance,
            descent_share: totals.descent_share,
            force_evaluations: totals.force_evaluations,
        }
    }
}

/// Distance in m at which the robot touches an obstacle of a lane, and the largest speed of that in
/// m/s, infinite if there is none; both 0 where the lane has no such obstacle.
fn reach_and_bound(placed: Option<&PlacedObstacle>) -> (f64, f64) {
    placed.map_or((0.0, 0.0), |placed| {
        let bound = placed.speed_bound.unwrap_or(f64::INFINITY);
        (placed.contact_distance, bound)
    })
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a counted number of samples
fn count_of(whole: f64) -> u64 {
    whole as u64
}
