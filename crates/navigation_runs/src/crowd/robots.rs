//! The robots of a world at work: what drives and moves each of them.

use crate::crowd::agent::{Agent, FIRST_ROBOT, direction_of};
use crate::crowd::divergence::is_finite;
use crate::crowd::neighbors::grid::Period;
use crate::crowd::people::{PersonState, Purpose, stream_of};
use crate::crowd::sight::{KnownBody, Sight};
use crate::crowd::tasks::Escort;
use crate::crowd::world::{CrowdWorld, count_of};
use crate::run::as_built::sight::BuiltSensors;
use crate::run::as_built::{AsBuilt, robot_under};
use crate::run::navigation::MeasuredState;
use crate::run::{AnyLaw, Interrupted, Request};
use navigation_laws::Law;
use navigation_laws::trace::{Examined, Trace};
use navigation_laws::{Scan, Situation, Stop, force_toward, send};
use navigation_world::robots::drives::{MotorDrive, PointMass, Reading};
use navigation_world::world::geometry::RobotState;
use navigation_world::world::scenario::{Rules, Scenario};
use numeric::error::Result;
use numeric::lanes::Vector2;
use unknown_places::explore::Explorer;

/// Places for people of each source at first.
const GUESTS: usize = 16;

/// Longest motion step of a robot as built in s: its wheels are controlled more often than people decide.
const BUILT_STEP: f64 = 0.01;

/// Kinematics of a robot.
enum Chassis {
    /// A robot that accelerates in any direction; nobody asks here for the currents of its motors.
    Point(PointMass),
    /// One with motors, and its motion steps in each of the world.
    Motors(Box<dyn MotorDrive>, usize),
}

/// Sensors of a robot as built.
struct RobotSensors {
    sensors: BuiltSensors,
    reading: Reading,
}

/// Eyes and law of a robot: apart from it, for robots that are told what to do and observed by nobody have none.
struct Pilot {
    /// `None`: it does what it is told, or stands.
    law: Option<Box<dyn Law<f64>>>,
    /// Bodies that the law sees, or that sensors can measure.
    sight: Sight,
    sensing: Option<RobotSensors>,
    /// Task beside the first person.
    escort: Option<Escort>,
    /// State of the robot as measured last, with step and time in s of the sample.
    sample: Option<(usize, f64, MeasuredState)>,
}

impl Pilot {
    /// A law that knows what it can see of a scenario.
    fn new(
        law: Option<&AnyLaw>,
        mut sight: Sight,
        scenario: &Scenario,
        built: Option<&AsBuilt>,
    ) -> Result<Self> {
        sight.size(scenario);
        let sensing = match built {
            Some(built) => Some(RobotSensors {
                sensors: BuiltSensors::new(scenario, built, &sight.bodies)?,
                reading: Reading::at(&built.start_in(scenario)),
            }),
            None => None,
        };
        let known = match &sensing {
            Some(sensing) => sensing.sensors.known(scenario),
            None => scenario,
        };
        Ok(Self {
            law: law.map(|law| law.with_own_gains(known)).transpose()?,
            sight,
            sensing,
            escort: None,
            sample: None,
        })
    }

    /// Measures once at a sample; `heading` in rad is what the robot itself takes it for.
    fn measure(
        &mut self,
        world: &CrowdWorld,
        people: &[PersonState],
        robots: &[Agent],
        (step, time): (usize, f64),
        (heading, interval): (f64, f64),
    ) -> MeasuredState {
        if let Some((_, _, known)) = self.sample.filter(|(last, ..)| *last == step) {
            return known;
        }
        let sight = &mut self.sight;
        sight.look(people, robots, world, interval);
        let known = if let Some(RobotSensors { sensors, reading }) = &mut self.sensing {
            MeasuredState::of(&sensors.look(time, reading, heading, &sight.bodies))
        } else {
            MeasuredState {
                clear: sight.clear(),
                ..MeasuredState::exactly(sight.own)
            }
        };
        self.sample = Some((step, time, known));
        known
    }
}

/// A situation with obstacles as they were measured last.
fn shown<'a>(
    situation: Situation<'a, f64>,
    sight: &'a Sight,
    sensing: Option<&'a RobotSensors>,
) -> Situation<'a, f64> {
    let bodies = &sight.bodies;
    Situation {
        bodies: sensing.map_or(bodies, |sensing| sensing.sensors.bodies(bodies)),
        ages: sensing.map_or(&[], |sensing| sensing.sensors.ages()),
        scan: match sensing {
            Some(sensing) if sensing.sensors.tells() => sensing.sensors.scan(),
            _ => sight.scan(),
        },
        ..situation
    }
}

/// A robot at work.
pub struct CrowdRobot {
    state: RobotState<f64>,
    heading: f64,
    radius: f64,
    goal: Vector2<f64>,
    tolerance: f64,
    arrival_time: f64,
    chassis: Chassis,
    mass: f64,
    pilot: Option<Box<Pilot>>,
    /// Request from outside.
    request: Request,
    /// Steps of the world between two commands.
    every: usize,
    interval: f64,
    /// Electrical loss up to the arrival, in J; of motors that are modeled.
    energy: f64,
}

impl CrowdRobot {
    /// A robot of a world at its start; `part`: time between two motions in s; `motors`: whether the currents of
    /// its motors are looked at; `observed`: whether it has eyes without a law, too.
    pub(super) fn new(
        world: &CrowdWorld,
        people: &[PersonState],
        index: usize,
        (part, motors, observed): (f64, bool, bool),
    ) -> Result<Self> {
        let setup = &world.robots[index];
        let sighted = if setup.law.is_some() || observed {
            Some(Sight::new(world, people, index, guests(world))?)
        } else {
            None
        };
        let (sight, known) =
            sighted.map_or((None, Vec::new()), |(sight, known)| (Some(sight), known));
        let scenario = scenario_of(world, index, known)?;
        let substeps = match &setup.built {
            Some(_) => count_of((part / BUILT_STEP - 1e-9).ceil()).max(1),
            None => 1,
        };
        let built = AsBuilt {
            step: part / substeps as f64,
            ..setup.built.clone().unwrap_or_default()
        };
        let start = built.start_in(&scenario);
        let pilot = match sight {
            Some(sight) => {
                let (law, sensing) = (setup.law.as_ref(), setup.sensing(world.step));
                let mut pilot = Pilot::new(law, sight, &scenario, sensing.as_ref())?;
                pilot.escort = setup.task.map(Escort::new);
                Some(Box::new(pilot))
            }
            None => None,
        };
        let built = match (&setup.law, scenario.differential()) {
            // From outside a robot with two wheels is told velocities and twists.
            (None, Some(_)) => AsBuilt {
                steering_law: crate::run::as_built::SteeringLaw::Velocity,
                ..built
            },
            _ => built,
        };
        let chassis = if scenario.differential().is_none() && setup.built.is_none() && !motors {
            Chassis::Point(PointMass::new(&start))
        } else {
            let drive = robot_under(&scenario, &built, setup.law.as_ref())?;
            Chassis::Motors(drive, substeps)
        };
        let Reading { robot, heading, .. } = Reading::at(&start);
        Ok(Self {
            state: robot,
            heading,
            radius: setup.radius(),
            goal: setup.goal.into(),
            tolerance: setup.arrival_tolerance,
            arrival_time: f64::NAN,
            chassis,
            mass: scenario.mass(),
            pilot,
            request: Request::Law,
            every: setup.steps(world.step)?,
            interval: setup.control_period,
            energy: 0.0,
        })
    }

    /// Position in m and velocity in m/s.
    #[must_use]
    pub fn state(&self) -> RobotState<f64> {
        self.state
    }

    /// Heading in rad.
    #[must_use]
    pub fn heading(&self) -> f64 {
        self.heading
    }

    /// Radius in m.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// When it arrived, in s; NaN before.
    #[must_use]
    pub fn arrival_time(&self) -> f64 {
        self.arrival_time
    }

    /// True once the robot has arrived; it then brakes and stays.
    #[must_use]
    pub fn has_arrived(&self) -> bool {
        !self.arrival_time.is_nan()
    }

    /// Electrical loss up to the arrival, in J, of motors that are modeled.
    #[must_use]
    pub fn energy(&self) -> f64 {
        self.energy
    }

    /// Trace of the parts around the law in the last control period, if there are any.
    #[must_use]
    pub fn trace(&self) -> Option<Trace> {
        self.law()?.trace()
    }

    /// Centers in m of the cells where people can be whom nobody sees, if the law reckons with them.
    #[must_use]
    pub fn unseen_places(&self) -> Option<Vec<[f64; 2]>> {
        Some(self.law()?.unseen()?.places())
    }

    /// Explored map of the law, if it makes its own map of scans.
    #[must_use]
    pub fn explored(&self) -> Option<&Explorer> {
        self.law()?.explored()
    }

    /// Result of the shield in the last control period, if there is a shield.
    #[must_use]
    pub fn examined(&self) -> Option<Examined> {
        self.law()?.examined()
    }

    fn law(&self) -> Option<&dyn Law<f64>> {
        self.pilot.as_ref()?.law.as_deref()
    }

    /// Whether the robot decides at a step of the world; it does not after its arrival.
    pub(super) fn decides_at(&self, step: usize) -> bool {
        self.is_due(step) && !self.has_arrived()
    }

    /// Whether a control period begins at a step of the world.
    pub(super) fn is_due(&self, step: usize) -> bool {
        step.is_multiple_of(self.every)
    }

    /// Situation of the controller, measured at the start of the control period; `None` without sensing.
    pub(super) fn observe(
        &mut self,
        world: &CrowdWorld,
        people: &[PersonState],
        robots: &[Agent],
        (step, time): (usize, f64),
        index: usize,
    ) -> Result<Option<Situation<'_, f64>>> {
        let (heading, interval) = (self.known_heading(), self.interval);
        let begun = step - step % self.every;
        let old = |pilot: &Pilot| pilot.sample.is_none_or(|(last, ..)| last < begun);
        if self.pilot.as_deref().is_some_and(old) {
            self.make_room(world, people, index)?;
            if let Some(pilot) = &mut self.pilot {
                pilot.measure(world, people, robots, (step, time), (heading, interval));
            }
        }
        let seen = self.pilot.as_deref().and_then(|pilot| {
            let (_, time, known) = pilot.sample?;
            let measured = known.fix.and_then(|fix| fix.heading);
            let situation = Situation {
                time,
                bodies: &[],
                ages: &[],
                robot: known.robot,
                heading: measured.unwrap_or(heading),
                interval,
                scan: Scan::default(),
                stop: Stop::never(),
            };
            Some(shown(situation, &pilot.sight, pilot.sensing.as_ref()))
        });
        Ok(seen)
    }

    /// Number of the person whom each obstacle of [`Self::observe`] is; `None` for robots, walls and free places, and
    /// for all that sensors tell of.
    #[must_use]
    pub fn people_seen(&self) -> Vec<Option<usize>> {
        let Some(pilot) = &self.pilot else {
            return Vec::new();
        };
        match &pilot.sensing {
            Some(sensing) if sensing.sensors.tells() => Vec::new(),
            _ => pilot.sight.people().collect(),
        }
    }

    /// Heading in rad as the robot itself takes it.
    fn known_heading(&self) -> f64 {
        match &self.chassis {
            Chassis::Point(_) => self.heading,
            Chassis::Motors(drive, _) => drive.known_heading(),
        }
    }

    /// The robot as others see it.
    #[allow(clippy::cast_possible_truncation)] // there are at most ten thousand robots
    pub(super) fn agent(&self, index: usize) -> Agent {
        let RobotState { position, velocity } = self.state;
        Agent {
            position,
            velocity,
            direction: direction_of(velocity),
            radius: self.radius,
            number: FIRST_ROBOT + index as u32,
        }
    }

    /// Sets the request from the next command on; [`Request::Law`]: the answer of its law, or to stand.
    pub(super) fn ask(&mut self, request: Request) {
        self.request = request;
    }

    /// Keeps what is measured late, and looks whether it has arrived, at a time in s.
    pub(super) fn watch(
        &mut self,
        world: &CrowdWorld,
        people: &[PersonState],
        robots: &[Agent],
        time: f64,
    ) {
        if let Some(pilot) = &mut self.pilot {
            pilot.sight.watch(people, robots);
            if let Some(RobotSensors { sensors, reading }) = &mut pilot.sensing {
                pilot.sight.look(people, robots, world, self.interval);
                sensors.show(time, reading, &pilot.sight.bodies);
            }
        }
        let away = (self.goal - self.state.position).norm();
        if away <= self.tolerance && !self.has_arrived() {
            self.arrival_time = time;
        }
    }

    /// Decides if it is time to; `false` if what it decides is not finite.
    pub(super) fn decide(
        &mut self,
        world: &CrowdWorld,
        people: &[PersonState],
        robots: &[Agent],
        (step, time): (usize, f64),
        (index, interrupted): (usize, Interrupted<'_>),
    ) -> Result<bool> {
        if !self.is_due(step) {
            return Ok(true);
        }
        self.make_room(world, people, index)?;
        let mut known = MeasuredState::exactly(self.state);
        let mut situation = Situation {
            time,
            bodies: &[],
            ages: &[],
            robot: known.robot,
            heading: self.known_heading(),
            interval: self.interval,
            scan: Scan::default(),
            stop: Stop(interrupted),
        };
        let toward =
            |velocity, known: &Situation<'_, f64>| force_toward(velocity, known, self.mass);
        let mut twist = None;
        let force = match (self.request, self.pilot.as_deref_mut()) {
            _ if !self.arrival_time.is_nan() => toward(Vector2::zeros(), &situation),
            (Request::Force(force), _) => force.into(),
            (Request::Velocity(velocity), _) => toward(velocity.into(), &situation),
            (Request::Twist(told), _) => {
                twist = Some(told);
                toward(Vector2::zeros(), &situation)
            }
            (Request::Law, Some(pilot)) if pilot.law.is_some() => {
                let own = (situation.heading, self.interval);
                known = pilot.measure(world, people, robots, (step, time), own);
                let measured = known.fix.and_then(|fix| fix.heading);
                situation.heading = measured.unwrap_or(situation.heading);
                situation.robot = known.robot;
                let (sight, sensing) = (&pilot.sight, pilot.sensing.as_ref());
                let seen = shown(situation, sight, sensing);
                let person = pilot.sight.first_person();
                match &mut pilot.law {
                    Some(law) => {
                        if let Some((escort, person)) = pilot.escort.as_mut().zip(person) {
                            law.aim(escort.goal(known.robot.position, person).into());
                        }
                        if let Some(goal) = sensing.and_then(|sensing| sensing.sensors.goal()) {
                            send(&mut **law, goal)?;
                        }
                        let force = law.command(&seen).force;
                        twist = law.twist();
                        force
                    }
                    None => Vector2::zeros(),
                }
            }
            (Request::Law, _) => toward(Vector2::zeros(), &situation),
        };
        match &mut self.chassis {
            Chassis::Point(point) => point.hold(force),
            Chassis::Motors(drive, _) => drive.hold(&known.order(force, twist)),
        }
        Ok(force.norm().is_finite())
    }

    /// Gives its law more places if people from sources need them: its memory then starts anew.
    fn make_room(
        &mut self,
        world: &CrowdWorld,
        people: &[PersonState],
        index: usize,
    ) -> Result<()> {
        // Without eyes nothing of the world is read.
        let Some(pilot) = self.pilot.as_deref_mut() else {
            return Ok(());
        };
        let kind = world.robots[index].law.as_ref();
        let mut places = guests(world);
        while !pilot.sight.admit(people) {
            places *= 2;
            let (more, known) = Sight::new(world, people, index, places)?;
            let scenario = scenario_of(world, index, known)?;
            let reading = pilot.sensing.as_ref().map(|sensing| sensing.reading);
            let built = world.robots[index].sensing(world.step);
            let escort = pilot.escort;
            *pilot = Pilot::new(kind, more, &scenario, built.as_ref())?;
            pilot.escort = escort;
            if let Some((sensing, reading)) = pilot.sensing.as_mut().zip(reading) {
                sensing.reading = reading;
            }
        }
        Ok(())
    }

    /// Moves by a part of a step.
    pub(super) fn advance(&mut self) {
        match &mut self.chassis {
            Chassis::Point(point) => {
                point.advance();
                self.state = point.state;
            }
            Chassis::Motors(drive, substeps) => {
                let under_way = self.arrival_time.is_nan();
                for _ in 0..*substeps {
                    let reading = drive.step();
                    (self.state, self.heading) = (reading.robot, reading.heading);
                    self.energy += if under_way { reading.loss } else { 0.0 };
                    if let Some(sensing) =
                        self.pilot.as_mut().and_then(|pilot| pilot.sensing.as_mut())
                    {
                        sensing.reading = reading;
                    }
                }
            }
        }
    }

    /// True for a finite state.
    pub(super) fn is_finite(&self) -> bool {
        is_finite(self.state.position, self.state.velocity)
    }

    /// Distance of the surfaces from a disc in m.
    pub(super) fn gap(&self, place: Vector2<f64>, radius: f64, period: &Period) -> f64 {
        period.wrap(self.state.position - place).norm() - self.radius - radius
    }
}

/// Places for people of each source.
fn guests(world: &CrowdWorld) -> usize {
    if world.sources.is_empty() { 0 } else { GUESTS }
}

/// Knowledge of a law about the world before the run.
fn scenario_of(world: &CrowdWorld, index: usize, known: Vec<KnownBody>) -> Result<Scenario> {
    let setup = &world.robots[index];
    let rules = Rules {
        control_period: setup.control_period,
        time_limit: world.time_limit,
        arrival_tolerance: setup.arrival_tolerance,
        heading: setup.heading,
        ..Rules::default()
    };
    let known = known
        .into_iter()
        .map(|one| (one.obstacle, one.bound, one.stands));
    let seed = stream_of(world.seed, Purpose::Law, index as u64).bits();
    let ends = [setup.start, setup.goal];
    Scenario::among(setup.mover, ends, known, rules, setup.measurement).map(|scenario| Scenario {
        footprint: setup.footprint.clone(),
        ..scenario.reseeded(seed)
    })
}
