//! Worlds of people and robots, and their rules.

use std::sync::Arc;

use crate::crowd::agent::SHORTEST;
use crate::crowd::metrics::ObservedBody;
use crate::crowd::models::Model;
use crate::crowd::neighbors::grid::Period;
use crate::crowd::tasks::Task;
use crate::crowd::walls::Wall;
use crate::run::AnyLaw;
use crate::run::as_built::AsBuilt;
use crate::run::pursuit::Pursuer;
use navigation_world::sensing::measurement::Measurement;
use navigation_world::world::footprint::Footprint;
use navigation_world::world::motion::Motion;
use navigation_world::world::scenario::Mover;
use numeric::error::{
    Failure, Given, Result, at_most, finite, finite_pair, not_negative, positive,
};
use numeric::lanes::Vector2;

/// Largest deviation of a control period from a whole number of steps, relative.
const WHOLE: f64 = 1e-9;

/// Most people of a world, from the start and from sources.
pub const MOST_PEOPLE: usize = 1_000_000;

/// Most robots of a world.
pub const MOST_ROBOTS: usize = 10_000;

/// Most pairs of a robot under a law and somebody whom it may see: 300 bytes each.
pub const MOST_SIGHTINGS: usize = 10_000_000;

/// Most steps of a world.
const MOST_STEPS: f64 = 1e7;

/// Behavior of a person at the end of the route.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RouteEnd {
    /// Stands there for good, and remains a neighbor.
    Stay,
    /// Is no longer there.
    Leave,
    /// Starts again with the first point.
    Repeat,
}

/// An element of a route.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Waypoint {
    /// A point in m, which is reached within the arrival radius.
    Point([f64; 2]),
    /// A line between two points in m, which is passed where the center crosses it.
    Line([[f64; 2]; 2]),
}

impl Waypoint {
    /// Where somebody of a radius in m at a place goes: of a line to the nearest point, shortened by the radius at both
    /// ends.
    #[inline]
    pub(super) fn target(&self, place: Vector2<f64>, radius: f64) -> Vector2<f64> {
        let [start, end] = match *self {
            Self::Point(point) => return point.into(),
            Self::Line(ends) => ends.map(Vector2::from),
        };
        let along = end - start;
        let length = along.norm();
        let most = length - radius;
        if most <= radius {
            return start + along * 0.5;
        }
        let axis = along / length;
        start + axis * axis.dot(&(place - start)).clamp(radius, most)
    }

    /// Whether this is a line.
    #[must_use]
    pub fn is_line(&self) -> bool {
        matches!(self, Self::Line(_))
    }

    /// Whether a motion crosses a line, or ends on it.
    pub(super) fn is_crossed(&self, from: Vector2<f64>, to: Vector2<f64>) -> bool {
        let Self::Line(ends) = *self else {
            return false;
        };
        let [start, end] = ends.map(Vector2::from);
        let along = end - start;
        let length = along.norm();
        let axis = along / length;
        let (before, after) = (axis.perp(&(from - start)), axis.perp(&(to - start)));
        let within = |place: Vector2<f64>| (0.0..=length).contains(&axis.dot(&(place - start)));
        if after.abs() <= SHORTEST {
            return within(to);
        }
        let crossed = before * after <= 0.0;
        crossed && within(from + (to - from) * (before / (before - after)))
    }
}

/// Where a person walks.
#[derive(Clone, Debug, PartialEq)]
pub struct Route {
    /// Elements, one after the other; nobody goes anywhere without one.
    pub points: Vec<Waypoint>,
    /// Behavior after the last one.
    pub end: RouteEnd,
    /// Distance in m at which a point is reached.
    pub arrival_radius: f64,
}

impl Route {
    /// Straight to a place, and to stay there.
    #[must_use]
    pub fn to(goal: [f64; 2]) -> Self {
        Self {
            points: vec![Waypoint::Point(goal)],
            end: RouteEnd::Stay,
            arrival_radius: 0.3,
        }
    }

    fn check(&self) -> Result<()> {
        for (index, point) in self.points.iter().enumerate() {
            // The name is made where it is needed: episodes of learners start often.
            match point {
                Waypoint::Point(point) => {
                    if !point.iter().all(|value| value.is_finite()) {
                        finite_pair(&format!("route[{index}]"), *point)?;
                    }
                }
                Waypoint::Line(ends) => check_line(index, ends)?,
            }
        }
        if self.points.is_empty() && self.end != RouteEnd::Stay {
            let rule = "hold a point unless its end is \"stay\"";
            let given = Given::Found("an empty route".into());
            return Err(Failure::invalid("route", rule, given));
        }
        positive("arrival_radius", self.arrival_radius)?;
        Ok(())
    }
}

/// Refuses a line whose ends are not two places.
fn check_line(index: usize, ends: &[[f64; 2]; 2]) -> Result<()> {
    for (end, point) in ends.iter().enumerate() {
        finite_pair(&format!("route[{index}][{end}]"), *point)?;
    }
    let length = (Vector2::from(ends[1]) - Vector2::from(ends[0])).norm();
    if length > SHORTEST && length.is_finite() {
        return Ok(());
    }
    let name = format!("route[{index}]");
    let found = format!("a line of {length} m");
    let failure = Failure::invalid(&name, "have two ends apart", Given::Found(found.into()));
    Err(failure.mended_by("give a point (x, y) instead of a line"))
}

/// Traits of people, at the start or when they come.
#[derive(Clone, Debug, PartialEq)]
pub struct Traits {
    /// Radius in m.
    pub radius: f64,
    /// Wanted speed in m/s; drawn where `None`.
    pub desired_speed: Option<f64>,
    /// Share by which robots are taken into account.
    pub awareness: f64,
    /// Share of people whose awareness is 0.
    pub distracted_share: f64,
    /// Number of the model.
    pub model: usize,
    /// Where to.
    pub route: Route,
}

impl Traits {
    fn check(&self) -> Result<()> {
        positive("radius", self.radius)?;
        if let Some(speed) = self.desired_speed {
            not_negative("desired_speed", speed)?;
        }
        share("awareness", self.awareness)?;
        share("distracted_share", self.distracted_share)?;
        self.route.check()
    }
}

/// A person at the start.
#[derive(Clone, Debug, PartialEq)]
pub struct PersonSetup {
    /// Position in m.
    pub start: [f64; 2],
    /// Velocity in m/s.
    pub velocity: [f64; 2],
    /// When the person appears, in s.
    pub enters: f64,
    /// The way of a person who follows a recording and reacts to nobody.
    pub recorded: Option<Motion>,
    /// Attack of a person who sees the first robot and wants it to do wrong, and reacts to nobody else.
    pub pursuer: Option<Pursuer>,
    /// Members of a group have its number.
    pub group: Option<u32>,
    /// The rest.
    pub traits: Traits,
}

impl PersonSetup {
    /// Returns nothing if the values are in range.
    ///
    /// # Errors
    /// Names the value that is not.
    pub fn check(&self) -> Result<()> {
        finite_pair("start", self.start)?;
        finite_pair("velocity", self.velocity)?;
        not_negative("enters", self.enters)?;
        self.traits.check()
    }
}

/// Where people come from.
#[derive(Clone, Debug, PartialEq)]
pub struct SourceSetup {
    /// Lower left corner of a rectangle in m.
    pub low: [f64; 2],
    /// Upper right corner in m.
    pub high: [f64; 2],
    /// People per second.
    pub rate: f64,
    /// Whether they come at equal intervals, not at random.
    pub regular: bool,
    /// Traits of the people.
    pub traits: Traits,
}

impl SourceSetup {
    /// Returns nothing if the values are in range.
    ///
    /// # Errors
    /// Names the value that is not.
    pub fn check(&self) -> Result<()> {
        finite_pair("low", self.low)?;
        finite_pair("high", self.high)?;
        if self.high[0] < self.low[0] || self.high[1] < self.low[1] {
            let rule = "not be below or left of low";
            return Err(Failure::invalid("high", rule, Given::Pair(self.high)));
        }
        positive("rate", self.rate)?;
        self.traits.check()
    }
}

/// A robot at the start.
#[derive(Clone)]
pub struct RobotSetup {
    /// Kinematics of the robot.
    pub mover: Mover,
    /// Outline, if it is no disc; its radius is then that of the circle around it.
    pub footprint: Option<Arc<Footprint>>,
    /// Position in m.
    pub start: [f64; 2],
    /// Goal in m.
    pub goal: [f64; 2],
    /// Heading in rad.
    pub heading: f64,
    /// Time between two commands in s.
    pub control_period: f64,
    /// Distance from the goal in m at which it has arrived.
    pub arrival_tolerance: f64,
    /// Distance in m up to which it sees people and robots.
    pub sensing_range: f64,
    /// Whether walls hide people and robots from it.
    pub occlusion: bool,
    /// Where it is to be beside the first person, whose law's goal moves then.
    pub task: Option<Task>,
    /// Errors of what it sees.
    pub measurement: Option<Measurement>,
    /// Wheels and sensors, if it is not ideal; their step is that of the world.
    pub built: Option<AsBuilt>,
    /// Law of the robot; commands from outside where `None`.
    pub law: Option<AnyLaw>,
}

impl RobotSetup {
    /// Radius in m.
    #[must_use]
    pub fn radius(&self) -> f64 {
        match &self.mover {
            Mover::Holonomic(robot) => robot.radius,
            Mover::Differential(robot) => robot.radius,
        }
    }

    /// Mass in kg.
    #[must_use]
    pub fn mass(&self) -> f64 {
        match &self.mover {
            Mover::Holonomic(robot) => robot.mass,
            Mover::Differential(robot) => robot.mass,
        }
    }

    /// Largest speed in m/s.
    #[must_use]
    pub fn max_speed(&self) -> f64 {
        match &self.mover {
            Mover::Holonomic(robot) => robot.max_speed,
            Mover::Differential(robot) => robot.max_speed,
        }
    }

    /// Returns nothing if the values are in range.
    ///
    /// # Errors
    /// Names the value that is not.
    pub fn check(&self) -> Result<()> {
        match &self.mover {
            Mover::Holonomic(robot) => robot.checked().map(|_| ())?,
            Mover::Differential(robot) => robot.checked().map(|_| ())?,
        }
        finite_pair("start", self.start)?;
        finite_pair("goal", self.goal)?;
        finite("heading", self.heading)?;
        positive("arrival_tolerance", self.arrival_tolerance)?;
        positive("sensing_range", self.sensing_range)?;
        positive("control_period", self.control_period)?;
        Ok(())
    }

    /// Its sensors at a step of the world in s, if it is not ideal.
    pub(super) fn sensing(&self, step: f64) -> Option<AsBuilt> {
        let built = self.built.as_ref()?;
        Some(AsBuilt {
            step,
            ..built.clone()
        })
    }

    /// Steps of the world between two commands.
    pub(super) fn steps(&self, step: f64) -> Result<usize> {
        let whole = (self.control_period / step).round();
        if whole >= 1.0 && (whole * step - self.control_period).abs() <= WHOLE * self.control_period
        {
            return Ok(count_of(whole));
        }
        let rule = format!("be a multiple of the step of the world, {step} s");
        let given = Given::Number(self.control_period);
        Err(Failure::invalid("control_period", rule, given))
    }
}

/// A world.
#[derive(Clone)]
pub struct CrowdWorld {
    /// Who is there at the start.
    pub people: Vec<PersonSetup>,
    /// The robots.
    pub robots: Vec<RobotSetup>,
    /// Where more people come from.
    pub sources: Vec<SourceSetup>,
    /// Walls of the world.
    pub walls: Vec<Wall>,
    /// Number of the last walls that laws are not told of: who knows them has a map, or sees them.
    pub untold: usize,
    /// Models of the people.
    pub models: Vec<Model>,
    /// Lengths in m after which the world repeats itself, 0 for none.
    pub period: Period,
    /// Time step in s.
    pub step: f64,
    /// Longest time in s.
    pub time_limit: f64,
    /// Seed of everything that is drawn.
    pub seed: u64,
}

impl CrowdWorld {
    /// Returns the world if it obeys its rules.
    ///
    /// # Errors
    /// Names the argument, with the index of its owner, that does not.
    pub fn checked(self) -> Result<Self> {
        self.check()?;
        Ok(self)
    }

    pub(super) fn check(&self) -> Result<()> {
        positive("step", self.step)?;
        positive("time_limit", self.time_limit)?;
        not_negative("period[0]", self.period.0[0])?;
        not_negative("period[1]", self.period.0[1])?;
        let substeps = (self.time_limit / self.step) * self.parts()? as f64;
        if substeps > MOST_STEPS {
            let rule = format!("be at most {MOST_STEPS} steps long");
            let given = Given::Number(self.time_limit);
            return Err(Failure::invalid("time_limit", rule, given));
        }
        at_most("len(people)", self.people.len(), MOST_PEOPLE)?;
        at_most("len(robots)", self.robots.len(), MOST_ROBOTS)?;
        Self::check_sightings(self.sightings())?;
        for (index, person) in self.people.iter().enumerate() {
            person
                .check()
                .and_then(|()| self.check_model(&person.traits))
                .map_err(|error| error.within(&format!("people[{index}]")))?;
        }
        for (index, source) in self.sources.iter().enumerate() {
            source
                .check()
                .and_then(|()| self.check_model(&source.traits))
                .and_then(|()| self.check_rate(source))
                .map_err(|error| error.within(&format!("sources[{index}]")))?;
        }
        for (index, robot) in self.robots.iter().enumerate() {
            robot
                .check()
                .and_then(|()| self.check_task(robot))
                .and_then(|()| robot.steps(self.step).map(|_| ()))
                .and_then(|()| self.check_contact(index))
                .map_err(|error| error.within(&format!("robots[{index}]")))?;
        }
        Ok(())
    }

    /// Pairs of a robot under a law and somebody whom it may see from the start.
    pub(super) fn sightings(&self) -> usize {
        let under_laws = self.robots.iter().filter(|robot| robot.law.is_some());
        under_laws.count() * (self.people.len() + self.robots.len())
    }

    /// Refuses robots whose memory of so many pairs, of each other and of the people, would not fit.
    pub(super) fn check_sightings(pairs: usize) -> Result<()> {
        if pairs <= MOST_SIGHTINGS {
            return Ok(());
        }
        let rule = format!("see at most {MOST_SIGHTINGS} people and robots together");
        let advice = "take fewer robots under laws, or fewer people";
        Err(Failure::invalid("robots", rule, Given::Count(pairs as u64)).mended_by(advice))
    }

    fn check_model(&self, traits: &Traits) -> Result<()> {
        let models = self.models.len();
        if traits.model < models {
            return Ok(());
        }
        let rule = format!("be below {models}, the number of models");
        let given = Given::Count(traits.model as u64);
        Err(Failure::invalid("model", rule, given))
    }

    /// Refuses a task without a person, or with sensors that do not tell which of the bodies the person is.
    fn check_task(&self, robot: &RobotSetup) -> Result<()> {
        if robot.task.is_none() {
            return Ok(());
        }
        let found = |what: &str| Given::Found(what.to_owned().into());
        if self.people.is_empty() {
            let rule = "be None in a world without people";
            return Err(Failure::invalid("task", rule, found("a task")));
        }
        if robot.built.is_some() {
            let rule = "be None for a robot as built or with sensors";
            return Err(Failure::invalid("task", rule, found("a task")));
        }
        Ok(())
    }

    fn check_rate(&self, source: &SourceSetup) -> Result<()> {
        if source.rate * self.time_limit <= MOST_PEOPLE as f64 {
            return Ok(());
        }
        let rule = format!("bring at most {MOST_PEOPLE} people within the time limit");
        Err(Failure::invalid("rate", rule, Given::Number(source.rate)))
    }

    /// Refuses a robot that touches somebody, another robot or a wall at the start.
    fn check_contact(&self, index: usize) -> Result<()> {
        let robot = &self.robots[index];
        let place = Vector2::from(robot.start);
        let headings = [robot.heading];
        let body = robot.footprint.as_deref().map(|outline| ObservedBody {
            outline,
            headings: &headings,
        });
        let gap = |other: [f64; 2], radius: f64| {
            let way = self.period.wrap(place - Vector2::from(other));
            match &body {
                None => way.norm() - robot.radius() - radius,
                Some(body) => body.distance(0, -way) - radius,
            }
        };
        let off_wall = |wall: &Wall| match &body {
            None => wall.clearance(place) - robot.radius(),
            Some(body) => body.gap_on_way(wall, 0, [place; 2]),
        };
        let people = self.people.iter().enumerate();
        let people = people.filter(|(_, person)| person.enters <= 0.0);
        let people = people.map(|(other, person)| {
            let gap = gap(person.start, person.traits.radius);
            (gap, "people", other)
        });
        let robots = self.robots[..index].iter().enumerate();
        let robots =
            robots.map(|(other, found)| (gap(found.start, found.radius()), "robots", other));
        let walls = self.walls.iter().enumerate();
        let walls = walls.map(|(other, wall)| (off_wall(wall), "walls", other));
        for (gap, kind, other) in people.chain(robots).chain(walls) {
            if gap < 0.0 {
                let rule = format!("not be in contact with {kind}[{other}]");
                let advice = format!("the bodies overlap by {:.4} m", -gap);
                return Err(
                    Failure::invalid("start", rule, Given::Pair(robot.start)).mended_by(advice)
                );
            }
        }
        Ok(())
    }

    /// Parts of a step in which people decide anew.
    ///
    /// # Errors
    /// There are too many.
    pub(super) fn parts(&self) -> Result<usize> {
        let used = self.people.iter().map(|person| person.traits.model);
        let used = used.chain(self.sources.iter().map(|source| source.traits.model));
        let models = used.filter_map(|index| self.models.get(index));
        let least = models
            .map(Model::largest_step)
            .fold(f64::INFINITY, f64::min);
        let parts = (self.step / least - WHOLE).ceil().max(1.0);
        if parts > MOST_STEPS {
            let rule = "be at most 1e7 steps of the models of people";
            return Err(Failure::invalid("step", rule, Given::Number(self.step)));
        }
        Ok(count_of(parts))
    }

    /// The route of a person with a number, from the start or from a source.
    pub(super) fn route(&self, number: usize, source: Option<u32>) -> &Route {
        match source {
            Some(source) => &self.sources[source as usize].traits.route,
            None => &self.people[number].traits.route,
        }
    }

    /// Farthest distance in m at which people act on each other.
    pub(super) fn reach(&self) -> f64 {
        let reach = self.models.iter().map(Model::cutoff);
        reach.fold(0.0, f64::max)
    }
}

/// Returns a share from 0 to 1.
fn share(name: &str, value: f64) -> Result<f64> {
    if (0.0..=1.0).contains(&value) {
        return Ok(value);
    }
    Err(Failure::invalid(
        name,
        "be from 0 to 1",
        Given::Number(value),
    ))
}

/// A checked, whole, not negative number as a count.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // bounded by the caller
pub(super) fn count_of(whole: f64) -> usize {
    whole as usize
}
