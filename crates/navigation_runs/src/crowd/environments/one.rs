//! One environment: an episode of a world, one step of the driven robot at a time.

use crate::crowd::environments::history::History;
use crate::crowd::environments::layout::seed_of;
use crate::crowd::environments::observation::{Ranking, observe};
use crate::crowd::environments::settings::{Action, EnvironmentSettings};
use crate::crowd::metrics::{ObservedBody, RobotMetrics, nearest_between};
use crate::crowd::neighbors::grid::Period;
use crate::crowd::people::OfPeople;
use crate::crowd::simulation::{DecisionRoom, Simulation};
use crate::crowd::world_lanes::WorldLanes;
use crate::run::Request;
use navigation_world::robots::differential::Twist;
use navigation_world::world::scenario::Mover;
use numeric::error::Result;
use numeric::lanes::Vector2;

type Vector = Vector2<f64>;

/// Surfaces that overlap by more are in contact, in m.
const TOUCH: f64 = 1e-6;
/// Gap below which a robot is uncomfortably near, in m, and how it is rewarded, as in `CrowdNav`.
const DISCOMFORT: f64 = 0.2;
const DISCOMFORT_REWARD: f64 = 0.5;
const ARRIVAL_REWARD: f64 = 1.0;
const CONTACT_REWARD: f64 = -0.25;
/// Rounding of a time against its limit, relative to a step.
const ROUNDING: f64 = 1e-9;

/// How an episode stands after a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// It is under way.
    Running,
    /// The robot is at its goal.
    Arrived,
    /// It has touched somebody or a wall.
    Collided,
    /// The time is over.
    TimedOut,
    /// A state is no longer finite.
    Diverged,
}

impl State {
    /// All of them; the place of one is its code.
    pub const ALL: [Self; 5] = [
        Self::Running,
        Self::Arrived,
        Self::Collided,
        Self::TimedOut,
        Self::Diverged,
    ];

    /// The word for it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Running => "running",
            Self::Arrived => "arrived",
            Self::Collided => "collided",
            Self::TimedOut => "timed_out",
            Self::Diverged => "diverged",
        }
    }

    /// Its code.
    #[must_use]
    pub fn code(self) -> u8 {
        match self {
            Self::Running => 0,
            Self::Arrived => 1,
            Self::Collided => 2,
            Self::TimedOut => 3,
            Self::Diverged => 4,
        }
    }
}

/// Result of a step.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// How the episode stands.
    pub state: State,
    /// The reward.
    pub reward: f64,
    /// Least distance to the people within the step, in m; infinite without any.
    pub clearance: f64,
}

/// Room that environments on one thread share, so that it stays in the cache.
#[derive(Default)]
pub struct Shared {
    ranking: Ranking,
    pub(super) decisions: Box<DecisionRoom>,
    pub(super) lanes: WorldLanes,
}

/// One environment.
pub struct Environment {
    simulation: Simulation,
    seed: u64,
    /// Number of the next episode.
    next: u64,
    /// Where the robot looks, in rad, if its action turns it.
    heading: f64,
    state: State,
    /// Steps of the world in one of the robot.
    steps: usize,
    history: History,
    /// Distance from the goal before the step, and least gap in it, in m.
    distance: f64,
    clearance: f64,
    /// Least gap to walls in the step, in m, and where the robot was at the last instant.
    wall_gap: f64,
    place: Vector,
    /// Heading of the robot in rad at the last looks at people and at walls.
    headings: [f64; 2],
    /// From the robot to the people at the last instant; NaN for who was absent.
    ways: OfPeople<Vector>,
}

impl Environment {
    /// An environment at the start of its first episode.
    ///
    /// # Errors
    /// The world breaks a rule, or there is no room for everybody.
    pub fn new(settings: &EnvironmentSettings, seed: u64) -> Result<Self> {
        let mut world = settings.world.clone();
        world.seed = seed_of(seed, 0);
        settings.layout.draw(&mut world)?;
        let steps = (world.robots[0].control_period / world.step).round();
        // Checked to be a small whole number by the world.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let steps = steps as usize;
        let mut environment = Self {
            simulation: Simulation::new(world, false)?,
            seed,
            next: 0,
            heading: 0.0,
            state: State::Running,
            steps,
            history: History::default(),
            distance: f64::NAN,
            clearance: f64::INFINITY,
            wall_gap: f64::INFINITY,
            place: Vector::zeros(),
            headings: [0.0; 2],
            ways: OfPeople::new(),
        };
        environment.open(settings);
        Ok(environment)
    }

    /// Starts the next episode; the first one of another seed if there is one.
    ///
    /// # Errors
    /// There is no room for everybody.
    pub fn reset(&mut self, settings: &EnvironmentSettings, seed: Option<u64>) -> Result<()> {
        if let Some(seed) = seed {
            (self.seed, self.next) = (seed, 0);
        }
        let seed = seed_of(self.seed, self.next);
        let mut drawn = Ok(());
        self.simulation.restart(|world| {
            world.seed = seed;
            drawn = settings.layout.draw(world);
        })?;
        drawn?;
        self.open(settings);
        Ok(())
    }

    fn open(&mut self, settings: &EnvironmentSettings) {
        self.next += 1;
        self.state = State::Running;
        let to_goal = self.to_goal(settings);
        self.heading = to_goal.y.atan2(to_goal.x);
        self.history.clear();
        self.note(settings);
        self.ways.clear();
        let robot = &self.simulation.robots()[0];
        (self.place, self.headings) = (robot.state().position, [robot.heading(); 2]);
        self.look(settings);
    }

    /// How the episode stands.
    #[must_use]
    pub fn state(&self) -> State {
        self.state
    }

    /// The world under way.
    #[must_use]
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// Tells another robot what to do from its next decision on.
    pub(super) fn ask(&mut self, robot: usize, request: Request) {
        self.simulation.ask(robot, request);
    }

    /// Writes what the robot sees; returns how many of the people are there.
    pub fn observe(
        &self,
        settings: &EnvironmentSettings,
        shared: &mut Shared,
        into: &mut [f32],
    ) -> usize {
        let seen = (&self.simulation, &self.ways[..]);
        observe(settings, seen, &mut shared.ranking, into)
    }

    /// Metrics of the episode up to now, if positions are kept.
    #[must_use]
    pub fn metrics(&mut self, settings: &EnvironmentSettings) -> Option<RobotMetrics> {
        settings
            .metrics
            .then(|| self.history.metrics(&self.simulation))
    }

    /// Tells the robot what to do in the next step.
    pub(super) fn begin(&mut self, settings: &EnvironmentSettings, action: [f64; 2]) {
        (self.clearance, self.wall_gap) = (f64::INFINITY, f64::INFINITY);
        self.distance = self.to_goal(settings).norm();
        let request = self.request(settings, action);
        self.simulation.ask(0, request);
    }

    /// The world, to be moved by a step.
    pub(super) fn world(&mut self) -> &mut Simulation {
        &mut self.simulation
    }

    /// Steps of the world in one of the robot.
    pub(super) fn steps(&self) -> usize {
        self.steps
    }

    /// Looks at what a step of the world has brought.
    pub(super) fn account(&mut self, settings: &EnvironmentSettings) {
        let clearance = self.look(settings);
        self.clearance = self.clearance.min(clearance);
        self.look_at_walls(settings);
        self.note(settings);
    }

    /// Ends a step; returns its result.
    pub(super) fn end(&mut self, settings: &EnvironmentSettings) -> Step {
        let clearance = self.clearance;
        let distance = self.to_goal(settings).norm();
        self.state = self.judged(settings, clearance, distance);
        let period = settings.world.robots[0].control_period;
        let progress = settings.rewards.progress * (self.distance - distance);
        let extra = progress + settings.rewards.step;
        let reward = match self.state {
            State::Arrived => ARRIVAL_REWARD + extra,
            State::Collided => CONTACT_REWARD + extra,
            State::Running | State::TimedOut if clearance < DISCOMFORT => {
                -DISCOMFORT_REWARD * (DISCOMFORT - clearance) * period + extra
            }
            State::Running | State::TimedOut => 0.0 + extra,
            State::Diverged => 0.0,
        };
        Step {
            state: self.state,
            reward,
            clearance,
        }
    }

    // The robot, the walls and the period are those of the settings, which all environments read.

    fn to_goal(&self, settings: &EnvironmentSettings) -> Vector {
        let goal = settings.world.robots[0].goal;
        Vector::from(goal) - self.simulation.robots()[0].state().position
    }

    /// Request to the robot, from an action in [-1, 1].
    fn request(&mut self, settings: &EnvironmentSettings, action: [f64; 2]) -> Request {
        let action = Vector::from(action.map(|share| share.clamp(-1.0, 1.0)));
        let setup = &settings.world.robots[0];
        let fastest = setup.max_speed();
        match settings.action {
            Action::Velocity => {
                let length = action.norm();
                let share = if length > 1.0 {
                    action / length
                } else {
                    action
                };
                Request::Velocity((share * fastest).into())
            }
            Action::Acceleration => {
                let force = action * (settings.max_acceleration * setup.mass());
                Request::Force(force.into())
            }
            Action::Unicycle if matches!(setup.mover, Mover::Differential(_)) => {
                Request::Twist(Twist {
                    speed: action.x * fastest,
                    turn_rate: action.y * settings.max_turn_rate,
                })
            }
            Action::Unicycle => {
                self.heading += action.y * settings.max_turn_rate * setup.control_period;
                let (sin, cos) = self.heading.sin_cos();
                Request::Velocity((Vector::new(cos, sin) * (action.x * fastest)).into())
            }
        }
    }

    /// How the episode stands at the end of a step.
    fn judged(&self, settings: &EnvironmentSettings, clearance: f64, distance: f64) -> State {
        let (simulation, world) = (&self.simulation, &settings.world);
        let setup = &world.robots[0];
        let touches = |gap: f64| gap < -TOUCH;
        if simulation.divergence().is_some() {
            State::Diverged
        } else if touches(clearance) || touches(self.wall_gap) {
            State::Collided
        } else if distance <= setup.arrival_tolerance {
            State::Arrived
        } else if simulation.time() >= world.time_limit - ROUNDING * world.step {
            State::TimedOut
        } else {
            State::Running
        }
    }

    /// Least gap to people since the last look, in straight relative motion, in m.
    fn look(&mut self, settings: &EnvironmentSettings) -> f64 {
        let period = settings.world.period;
        if period == Period::default() {
            self.look_along(settings, |way| way)
        } else {
            self.look_along(settings, |way| period.wrap(way))
        }
    }

    /// Observes with differences of positions as the world has them.
    #[inline(always)]
    fn look_along(
        &mut self,
        settings: &EnvironmentSettings,
        wrap: impl Fn(Vector) -> Vector,
    ) -> f64 {
        let robot = &self.simulation.robots()[0];
        let (place, radius) = (robot.state().position, robot.radius());
        let headings = [self.headings[0], robot.heading()];
        self.headings[0] = headings[1];
        let outline = settings.world.robots[0].footprint.as_deref();
        let body = outline.map(|outline| ObservedBody {
            outline,
            headings: &headings,
        });
        let mut least = f64::INFINITY;
        let people = self.simulation.people();
        self.ways.resize(people.len(), Vector::repeat(f64::NAN));
        for (before, person) in self.ways.iter_mut().zip(people) {
            if !person.is_present() {
                *before = Vector::repeat(f64::NAN);
                continue;
            }
            let way = wrap(person.position - place);
            if let Some(body) = &body {
                let come = before.x.is_nan();
                let from = if come { way } else { way - wrap(way - *before) };
                let gap = body.distance(1, way) - person.radius;
                let passed = gap >= 0.0 && !come && body.meets(0, [from, way], person.radius);
                least = least.min(if passed { -2.0 * TOUCH } else { gap });
                *before = way;
                continue;
            }
            let distance = if before.x.is_nan() {
                way.norm()
            } else {
                nearest_between(way - wrap(way - *before), way)
            };
            *before = way;
            least = least.min(distance - radius - person.radius);
        }
        least
    }

    /// Least gap to walls on the straight way since the last instant.
    fn look_at_walls(&mut self, settings: &EnvironmentSettings) {
        let world = &settings.world;
        let place = self.simulation.robots()[0].state().position;
        // Where the world repeats itself, the robot may have been put to the other side of it.
        let from = place - world.period.wrap(place - self.place);
        let radius = world.robots[0].radius();
        let headings = [self.headings[1], self.simulation.robots()[0].heading()];
        let outline = world.robots[0].footprint.as_deref();
        let body = outline.map(|outline| ObservedBody {
            outline,
            headings: &headings,
        });
        for wall in &world.walls {
            let gap = match &body {
                None => wall.gap_on_way(from, place, radius),
                Some(body) => match body.gap_on_way(wall, 1, [from, place]) {
                    // Touched on the way only.
                    gap if gap < 0.0 => gap.min(-2.0 * TOUCH),
                    gap => gap,
                },
            };
            self.wall_gap = self.wall_gap.min(gap);
        }
        (self.place, self.headings[1]) = (place, headings[1]);
    }

    fn note(&mut self, settings: &EnvironmentSettings) {
        if settings.metrics {
            self.history.push(&self.simulation);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_gap_of_a_step_lies_between_its_ends() {
        let (from, to) = (Vector::new(-1.0, 0.5), Vector::new(1.0, 0.5));
        assert_eq!(nearest_between(from, to), 0.5);
        assert_eq!(nearest_between(to, to), to.norm());
        assert_eq!(nearest_between(to, to * 2.0), to.norm());
    }

    #[test]
    fn a_state_and_its_code_belong_together() {
        for (code, state) in (0_u8..).zip(State::ALL) {
            assert_eq!(state.code(), code);
        }
    }
}
