//! The time loop: one kernel for one robot and for robots side by side.

use crate::error::{NavigationError, Result};
use crate::forces::geometry::{Body, RobotState};
use crate::lanes::{Mask, Real, Vec2};
use crate::laws::{Command, Law, Situation};
use crate::measurement::Sensor;
use crate::robots::WheelModel;
use crate::scenario::Scenario;
use crate::simulate::Interrupted;
use crate::simulate::options::{Clock, Integrator, Options};
use crate::simulate::record::Recorder;

/// A robot slower than this is at rest, in m/s.
const REST_SPEED: f64 = 1e-3;

/// A robot faster than this at a contact was moving, in m/s.
pub const CONTACT_SPEED: f64 = 0.05;

/// Room for rounding where a distance bound spares work, in m.
const BOUND_MARGIN: f64 = 1e-6;

/// Samples between two questions whether to stop; about a millisecond.
const SAMPLES_PER_QUESTION: usize = 512;

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Reached the goal without a contact.
    Arrived,
    /// Touched an obstacle, whatever came after.
    Collided,
    /// Ran out of time.
    TimedOut,
    /// Stood still for good.
    Stopped,
}

/// First contact with an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// When, in s.
    pub time: f64,
    /// Speed of the robot then, in m/s.
    pub speed: f64,
}

/// What is left of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct RunSummary {
    /// How it ended.
    pub outcome: Outcome,
    /// When it ended, in s.
    pub end_time: f64,
    /// First entry into the circle around the goal, in s.
    pub arrival_time: Option<f64>,
    /// Electrical loss in J.
    pub energy: f64,
    /// Length of the path in m.
    pub path_length: f64,
    /// Least distance `d` to each obstacle in m; infinite if it was never present.
    pub min_distance: Vec<f64>,
    /// First contact with each obstacle.
    pub contact: Vec<Option<Contact>>,
    /// Share of the control periods over which the Lyapunov function did not grow, if counted.
    pub descent_share: f64,
    /// Number of samples of the force.
    pub force_evaluations: u64,
}

/// Obstacles over time.
struct Scene<'a> {
    scenario: &'a Scenario,
    bodies: Vec<Body>,
    cursors: Vec<usize>,
}

impl<'a> Scene<'a> {
    fn new(scenario: &'a Scenario) -> Self {
        let bodies = scenario
            .obstacles
            .iter()
            .map(|placed| Body {
                shape: placed.obstacle.shape,
                regions: placed.regions,
                state: placed.obstacle.motion.at(0.0, &mut 0),
            })
            .collect();
        Self { scenario, bodies, cursors: vec![0; scenario.obstacles.len()] }
    }

    #[inline(always)]
    fn advance(&mut self, time: f64) {
        for (index, placed) in self.scenario.obstacles.iter().enumerate() {
            if !placed.stationary {
                self.bodies[index].state = placed.obstacle.motion.at(time, &mut self.cursors[index]);
            }
        }
    }
}

/// State of the runs of one lane group.
struct Runs<'a, R: Real> {
    scenario: &'a Scenario,
    clock: Clock,
    goal: Vec2<R>,
    wheels: WheelModel,
    position: Vec2<R>,
    velocity: Vec2<R>,
    speed: R,
    wheel_speeds: [R; 3],
    currents: [R; 3],
    squared_current: R,
    path: R,
    running: R::Mask,
    /// Change of velocity in one step of the held force, in m/s.
    push: Vec2<R>,
    /// Whether any robot can arrive before the next sample.
    near_goal: bool,
    /// Whether the least distance to each obstacle can change before the next sample.
    watched: Vec<bool>,
    /// Last sample at which each robot was not at rest, in s.
    moved: R,
    end_time: R,
    arrival_time: R,
    stopped: R::Mask,
    force_evaluations: R,
    min_distance_squared: Vec<R>,
    contact_time: Vec<R>,
    contact_speed: Vec<R>,
}

impl<'a, R: Real> Runs<'a, R> {
    fn new(scenario: &'a Scenario, clock: Clock, scene: &Scene<'_>) -> Self {
        let count = scenario.obstacles.len();
        let position = Vec2::splat(scenario.start);
        let velocity = Vec2::zero();
        let wheels = WheelModel::new(&scenario.robot, scenario.rules.heading, clock.step);
        let unset = R::splat(f64::NAN);
        let mut runs = Self {
            scenario,
            clock,
            goal: Vec2::splat(scenario.goal),
            wheels,
            position,
            velocity,
            speed: R::zero(),
            wheel_speeds: wheels.speeds(velocity),
            currents: [R::zero(); 3],
            squared_current: R::zero(),
            path: R::zero(),
            running: R::Mask::splat(true),
            push: Vec2::zero(),
            near_goal: true,
            watched: vec![true; count],
            moved: R::zero(),
            end_time: unset,
            arrival_time: unset,
            stopped: R::Mask::none(),
            force_evaluations: R::zero(),
            min_distance_squared: vec![R::splat(f64::INFINITY); count],
            contact_time: vec![unset; count],
            contact_speed: vec![unset; count],
        };
        runs.watch(&scene.bodies, 0.0, R::Mask::none());
        runs
    }

    /// One motion step after which the robots are where they are at `time`.
    #[inline(always)]
    fn account(&mut self, scene: &mut Scene<'_>, before: Vec2<R>, time: f64) {
        scene.advance(time);
        let speeds = self.wheels.speeds(self.velocity);
        self.currents = self.wheels.currents(&self.wheel_speeds, &speeds);
        self.wheel_speeds = speeds;
        let [first, second, third] = self.currents;
        let squared = first * first + second * second + third * third;
        let way = self.speed * R::splat(self.clock.step);

        if self.near_goal {
            let to_goal = self.goal - self.position;
            let tolerance = self.scenario.rules.arrival_tolerance;
            let near = to_goal.dot(to_goal).le(R::splat(tolerance * tolerance));
            let arrived = self.running & near;
            if arrived.any() {
                self.arrive(scene, before, time, arrived, squared, way);
            }
        }
        self.squared_current += R::select(self.running, squared, R::zero());
        self.path += R::select(self.running, way, R::zero());
        self.watch(&scene.bodies, time, R::Mask::none());
    }

    /// Least distances and contacts of the lanes that run, and of `also`.
    #[inline(always)]
    fn watch(&mut self, bodies: &[Body], time: f64, also: R::Mask) {
        let lanes = self.running | also;
        for (index, body) in bodies.iter().enumerate() {
            if !(self.watched[index] && body.state.present) {
                continue;
            }
            let squared = body.offset(self.position).distance_squared;
            let least = &mut self.min_distance_squared[index];
            *least = R::select(lanes, squared, R::splat(f64::INFINITY)).min(*least);
            let reach = self.scenario.obstacles[index].contact_distance;
            let touching = lanes & squared.le(R::splat(reach * reach));
            if touching.any() {
                self.touch(index, time, touching);
            }
        }
    }

    /// Finds out what cannot happen before the next sample, so that it need not be looked for:
    /// nothing moves farther than its largest speed takes it.
    #[inline(always)]
    fn look_ahead(&mut self, bodies: &[Body]) {
        let Clock { interval, steps_per_sample, .. } = self.clock;
        if steps_per_sample == 1 {
            return;
        }
        let own = self.scenario.robot.max_speed;
        let to_goal = self.goal - self.position;
        let reach = self.scenario.rules.arrival_tolerance + own * interval + BOUND_MARGIN;
        let near = to_goal.dot(to_goal).lt(R::splat(reach * reach));
        self.near_goal = (near & self.running).any();
        for (index, placed) in self.scenario.obstacles.iter().enumerate() {
            let body = &bodies[index];
            self.watched[index] = match placed.speed_bound {
                Some(speed) if body.state.present => {
                    let way = R::splat((own + speed) * interval + BOUND_MARGIN);
                    let least = self.min_distance_squared[index].sqrt() + way;
                    let squared = body.offset(self.position).distance_squared;
                    (squared.lt(least * least) & self.running).any()
                }
                _ => true,
            };
        }
    }

    #[cold]
    fn touch(&mut self, index: usize, time: f64, touching: R::Mask) {
        for lane in 0..R::WIDTH {
            if touching.lane(lane) && self.contact_time[index].lane(lane).is_nan() {
                let speed = self.speed.lane(lane);
                self.contact_time[index] = self.contact_time[index].replace(lane, time);
                self.contact_speed[index] = self.contact_speed[index].replace(lane, speed);
            }
        }
    }

    /// Ends the runs of lanes that entered the circle around the goal in this step, at the
    /// instant of entry, linear inside the step.
    #[cold]
    #[inline(never)]
    fn arrive(
        &mut self,
        scene: &mut Scene<'_>,
        before: Vec2<R>,
        time: f64,
        arrived: R::Mask,
        squared: R,
        way: R,
    ) {
        let tolerance = self.scenario.rules.arrival_tolerance;
        let after = self.position;
        let length = |vector: Vec2<R>| vector.dot(vector).sqrt();
        let (from, to) = (length(self.goal - before), length(self.goal - after));
        let share = (from - R::splat(tolerance)) / (from - to);
        let all = self.running;
        for lane in 0..R::WIDTH {
            if !arrived.lane(lane) {
                continue;
            }
            let part = share.lane(lane);
            let instant = (time - self.clock.step) + part * self.clock.step;
            scene.advance(instant);
            let entry = before + (after - before).scale(R::splat(part));
            self.position = Vec2 {
                x: after.x.replace(lane, entry.x.lane(lane)),
                y: after.y.replace(lane, entry.y.lane(lane)),
            };
            self.squared_current = self.squared_current.replace(
                lane,
                self.squared_current.lane(lane) + squared.lane(lane) * part,
            );
            self.path = self.path.replace(lane, self.path.lane(lane) + way.lane(lane) * part);
            self.arrival_time = self.arrival_time.replace(lane, instant);
            self.end_time = self.end_time.replace(lane, instant);
            // Only this lane is watched at its own instant.
            self.running = R::Mask::none();
            let others = (0..R::WIDTH).filter(|other| *other != lane);
            let only = others.fold(R::Mask::splat(true), Mask::without);
            self.watch(&scene.bodies, instant, only);
            self.position = Vec2 {
                x: after.x.replace(lane, entry.x.lane(lane)),
                y: after.y.replace(lane, entry.y.lane(lane)),
            };
        }
        self.running = all & !arrived;
        if R::WIDTH == 1 {
            return;
        }
        scene.advance(time);
        self.position = Vec2::select(arrived, self.position, after);
    }

    /// Ends the runs of lanes that have been at rest for too long.
    #[inline(always)]
    fn rest(&mut self, time: f64) {
        let still = self.speed.lt(R::splat(REST_SPEED));
        self.moved = R::select(still, self.moved, R::splat(time));
        let long = R::splat(self.scenario.rules.rest_time).le(R::splat(time) - self.moved);
        let ended = self.running & long;
        if ended.any() {
            self.stopped = self.stopped | ended;
            self.end(ended, time);
        }
    }

    fn end(&mut self, lanes: R::Mask, time: f64) {
        self.end_time = R::select(lanes, R::splat(time), self.end_time);
        self.running = self.running & !lanes;
    }

    fn check_finite(&self, time: f64) -> Result<()> {
        let probe = (self.position.x - self.position.x) + (self.position.y - self.position.y)
            + (self.velocity.x - self.velocity.x) + (self.velocity.y - self.velocity.y);
        let sound = probe.abs().le(R::zero());
        let lost = self.running & !sound;
        match (0..R::WIDTH).find(|lane| lost.lane(*lane)) {
            Some(run) => Err(NavigationError::NonFinite { run, time }),
            None => Ok(()),
        }
    }

    fn summaries(&self, recorder: &impl Recorder<R>) -> Vec<RunSummary> {
        let loss = self.wheels.loss_per_square();
        let set = |value: f64| if value.is_nan() { None } else { Some(value) };
        (0..R::WIDTH)
            .map(|lane| {
                let contact: Vec<_> = self
                    .contact_time
                    .iter()
                    .zip(&self.contact_speed)
                    .map(|(time, speed)| {
                        set(time.lane(lane)).map(|time| Contact { time, speed: speed.lane(lane) })
                    })
                    .collect();
                let arrival_time = set(self.arrival_time.lane(lane));
                let outcome = if contact.iter().any(Option::is_some) {
                    Outcome::Collided
                } else if arrival_time.is_some() {
                    Outcome::Arrived
                } else if self.stopped.lane(lane) {
                    Outcome::Stopped
                } else {
                    Outcome::TimedOut
                };
                let root = |squared: &R| squared.lane(lane).sqrt();
                RunSummary {
                    outcome,
                    end_time: self.end_time.lane(lane),
                    arrival_time,
                    energy: self.squared_current.lane(lane) * loss,
                    path_length: self.path.lane(lane),
                    min_distance: self.min_distance_squared.iter().map(root).collect(),
                    contact,
                    descent_share: recorder.descent_share(lane),
                    force_evaluations: count_of(self.force_evaluations.lane(lane)),
                }
            })
            .collect()
    }
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a counted number of samples
fn count_of(whole: f64) -> u64 {
    whole as u64
}

/// Runs the robots of one lane group through a scenario.
///
/// # Errors
/// An option is out of range, the state of a run became non-finite, or the caller asked to stop.
#[inline(always)]
pub fn run_lanes<R: Real, L: Law<R>>(
    scenario: &Scenario,
    law: &mut L,
    options: &Options,
    recorder: &mut impl Recorder<R>,
    interrupted: Interrupted<'_>,
) -> Result<Vec<RunSummary>> {
    let clock = options.clock(scenario)?;
    let mut scene = Scene::new(scenario);
    let mut sensor = Sensor::<R>::new(scenario);
    let mut seen = scene.bodies.clone();
    let mut runs = Runs::<R>::new(scenario, clock, &scene);
    let mut command = Command {
        force: Vec2::zero(),
        stabilizing: Vec2::zero(),
        lyapunov: R::splat(f64::NAN),
    };
    let mut acceleration = Vec2::zero();
    let mut time = 0.0;
    let (mut until_sample, mut until_question) = (0, SAMPLES_PER_QUESTION);
    for index in 0..clock.steps {
        if until_sample == 0 {
            until_sample = clock.steps_per_sample;
            runs.check_finite(time)?;
            runs.rest(time);
            if !runs.running.any() {
                break;
            }
            until_question -= 1;
            if until_question == 0 {
                until_question = SAMPLES_PER_QUESTION;
                if interrupted() {
                    return Err(NavigationError::Interrupted);
                }
            }
            let robot = observe(&mut sensor, &scene, &mut seen, &runs);
            let bodies = if sensor.is_some() { &seen } else { &scene.bodies };
            command = law.command(&Situation { bodies, robot, interval: clock.interval });
            acceleration = scenario.robot.acceleration(command.force);
            runs.push = acceleration.scale(R::splat(clock.step));
            runs.look_ahead(&scene.bodies);
            let counted = runs.force_evaluations + R::splat(1.0);
            runs.force_evaluations = R::select(runs.running, counted, runs.force_evaluations);
            recorder.sample(&command, runs.running);
        }
        until_sample -= 1;
        recorder.row(time, runs.position, runs.velocity, &runs.currents, &command, &scene.bodies);
        let before = runs.position;
        let later = (index + 1) as f64 * clock.step;
        match options.integrator {
            Integrator::SemiImplicitEuler => semi_implicit_euler(&mut runs),
            Integrator::Rk4 if options.hold => rk4_held(&mut runs, acceleration),
            Integrator::Rk4 => rk4(&mut runs, acceleration, law, &mut scene, (time, later)),
        }
        time = later;
        runs.account(&mut scene, before, time);
        if options.stop_on_contact {
            stop_at_contact(&mut runs, time);
        }
        if !runs.running.any() {
            break;
        }
    }
    runs.check_finite(time)?;
    if runs.running.any() {
        runs.end(runs.running, time);
    }
    let end = runs.end_time.lane(0);
    recorder.row(end, runs.position, runs.velocity, &runs.currents, &command, &scene.bodies);
    Ok(runs.summaries(recorder))
}

/// State of robots and obstacles as the controller knows it.
#[inline(always)]
fn observe<R: Real>(
    sensor: &mut Option<Sensor<R>>,
    scene: &Scene<'_>,
    seen: &mut [Body],
    runs: &Runs<'_, R>,
) -> RobotState<R> {
    let Some(sensor) = sensor else {
        return RobotState { position: runs.position, velocity: runs.velocity };
    };
    for (index, (measured, body)) in seen.iter_mut().zip(&scene.bodies).enumerate() {
        measured.state = sensor.obstacle(index, body.state);
    }
    let (position, velocity) = sensor.robot(runs.position, runs.velocity);
    RobotState { position, velocity }
}

#[inline(always)]
fn semi_implicit_euler<R: Real>(runs: &mut Runs<'_, R>) {
    let robot = &runs.scenario.robot;
    (runs.velocity, runs.speed) = robot.limited_velocity(runs.velocity + runs.push);
    runs.position = runs.position + runs.velocity.scale(R::splat(runs.clock.step));
}

/// Runge-Kutta of order 4 with a held acceleration; the second and third stage coincide.
fn rk4_held<R: Real>(runs: &mut Runs<'_, R>, acceleration: Vec2<R>) {
    let robot = &runs.scenario.robot;
    let limited = |velocity| robot.limited_velocity(velocity).0;
    let step = R::splat(runs.clock.step);
    let half = R::splat(0.5 * runs.clock.step);
    let middle = limited(runs.velocity + acceleration.scale(half));
    let (last, speed) = robot.limited_velocity(runs.velocity + acceleration.scale(step));
    let weighted = limited(runs.velocity) + middle.scale(R::splat(4.0)) + last;
    runs.position = runs.position + weighted.scale(R::splat(runs.clock.step / 6.0));
    (runs.velocity, runs.speed) = (last, speed);
}

/// Runge-Kutta of order 4 with the force evaluated in every stage.
fn rk4<R: Real, L: Law<R>>(
    runs: &mut Runs<'_, R>,
    first: Vec2<R>,
    law: &mut L,
    scene: &mut Scene<'_>,
    (time, later): (f64, f64),
) {
    let robot = &runs.scenario.robot;
    let (start, velocity) = (runs.position, runs.velocity);
    let interval = runs.clock.interval;
    let mut push = |scene: &Scene<'_>, position, velocity| {
        let robot_state = RobotState { position, velocity };
        let situation = Situation { bodies: &scene.bodies, robot: robot_state, interval };
        robot.acceleration(law.command(&situation).force)
    };
    let limited = |velocity| robot.limited_velocity(velocity).0;
    let half = R::splat(0.5 * runs.clock.step);
    let step = R::splat(runs.clock.step);
    let v1 = velocity;
    let v2 = limited(velocity + first.scale(half));
    scene.advance(time + 0.5 * runs.clock.step);
    let second = push(scene, start + v1.scale(half), v2);
    let v3 = limited(velocity + second.scale(half));
    let third = push(scene, start + v2.scale(half), v3);
    let v4 = limited(velocity + third.scale(step));
    scene.advance(later);
    let fourth = push(scene, start + v3.scale(step), v4);
    let sixth = R::splat(runs.clock.step / 6.0);
    let two = R::splat(2.0);
    runs.position = start + (v1 + (v2 + v3).scale(two) + v4).scale(sixth);
    let gain = (first + (second + third).scale(two) + fourth).scale(sixth);
    (runs.velocity, runs.speed) = robot.limited_velocity(velocity + gain);
}

fn stop_at_contact<R: Real>(runs: &mut Runs<'_, R>, time: f64) {
    let mut touched = R::Mask::none();
    for contact in &runs.contact_time {
        touched = touched | contact.le(R::splat(time));
    }
    let ended = runs.running & touched;
    if ended.any() {
        runs.end(ended, time);
    }
}
