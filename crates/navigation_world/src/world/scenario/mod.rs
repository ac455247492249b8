//! A scenario: robot, start, goal, obstacles and the rules of a run.

mod placed;

use std::sync::Arc;

pub use placed::PlacedObstacle;
use placed::{place, place_all};

use crate::robots::{DifferentialDriveRobot, HolonomicRobot};
use crate::sensing::measurement::Measurement;
use crate::sensing::scanner::Scanner;
use crate::world::footprint::Footprint;
use crate::world::frame::Frame;
use crate::world::map::StaticMap;
use crate::world::obstacle::Obstacle;
use crate::world::region::{RobotLimits, Sensing};
use numeric::error::{Failure, Given, Result, finite, finite_pair, positive};

/// The rules of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rules {
    /// Control period `T_s` in s.
    pub control_period: f64,
    /// Longest simulated time in s.
    pub time_limit: f64,
    /// Radius of the circle around the goal that counts as arrival, in m.
    pub arrival_tolerance: f64,
    /// Time at rest after which the robot has stopped for good, in s.
    pub rest_time: f64,
    /// Heading of the robot in rad.
    pub heading: f64,
}

impl Default for Rules {
    fn default() -> Self {
        Self {
            control_period: 0.06,
            time_limit: 60.0,
            arrival_tolerance: 0.12,
            rest_time: 5.0,
            heading: 0.0,
        }
    }
}

/// The robot of a scenario.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mover {
    /// A point mass.
    Holonomic(HolonomicRobot),
    /// A two-wheel robot: its regions include the time that it needs to turn, and a law drives the
    /// robot that it follows.
    Differential(DifferentialDriveRobot),
}

/// Scenario of a simulation: a robot on its way to a goal among obstacles. [`Scenario::new`] checks every field; a
/// field that is set afterwards is not checked again.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// Robot that a law drives: the robot, or the one that a two-wheel robot follows.
    pub robot: HolonomicRobot,
    /// Two-wheel robot that follows, if it is one.
    pub differential: Option<DifferentialDriveRobot>,
    /// Outline of the robot, if it is no disc; its radius is then that of the circle around it.
    pub footprint: Option<Arc<Footprint>>,
    /// Start of the robot in m.
    pub start: [f64; 2],
    /// Goal of the robot in m.
    pub goal: [f64; 2],
    /// Obstacles with their regions.
    pub obstacles: Vec<PlacedObstacle>,
    /// Control period, limits of time, tolerances.
    pub rules: Rules,
    /// Noise and latency of measured positions; they are exact where it is `None`.
    pub measurement: Option<Measurement>,
    /// Seed of every random stream of the run.
    pub seed: u64,
    /// Walls that planners of whole paths know.
    pub map: Option<StaticMap>,
    /// Walls beside the obstacles: touched, seen by sensors, and not told of to laws.
    pub walls: Option<StaticMap>,
    /// Lidars whose scans a law is told.
    pub lidars: Arc<[Scanner]>,
    /// Why laws that keep to regions cannot reach the goal, if they cannot.
    pub blocked: Option<Box<Failure>>,
}

impl Scenario {
    /// Checks everything and computes the regions that were not given.
    ///
    /// # Errors
    /// A value is out of range, start and goal are within the arrival tolerance, the robot would
    /// start in contact with an obstacle, or a critical radius is below
    /// the distance at which robot and obstacle touch.
    pub fn new(
        robot: HolonomicRobot,
        start: [f64; 2],
        goal: [f64; 2],
        obstacles: Vec<Obstacle>,
        rules: Rules,
    ) -> Result<Self> {
        Self::sensed(
            Mover::Holonomic(robot),
            [start, goal],
            obstacles,
            rules,
            None,
        )
    }

    /// Scenario with a map that planners of whole paths keep out of; other laws see the
    /// boundary points that they are told of.
    #[must_use]
    pub fn with_map(mut self, map: StaticMap) -> Self {
        self.map = Some(map);
        self
    }

    /// Scenario of a two-wheel robot: its regions include the time that it needs to turn, and a
    /// law drives the robot that it follows.
    ///
    /// # Errors
    /// Fails like [`Self::new`].
    pub fn for_differential(
        robot: DifferentialDriveRobot,
        start: [f64; 2],
        goal: [f64; 2],
        obstacles: Vec<Obstacle>,
        rules: Rules,
    ) -> Result<Self> {
        let robot = Mover::Differential(robot);
        Self::sensed(robot, [start, goal], obstacles, rules, None)
    }

    /// Scenario of any robot whose regions are sized for noisy or late measurements.
    ///
    /// # Errors
    /// Fails like [`Self::new`].
    pub fn sensed(
        robot: Mover,
        ends: [[f64; 2]; 2],
        obstacles: Vec<Obstacle>,
        rules: Rules,
        measurement: Option<Measurement>,
    ) -> Result<Self> {
        Self::shaped((robot, None), ends, obstacles, rules, measurement)
    }

    /// Scenario of any robot with an outline of its own, whose radius is that of the circle around it.
    ///
    /// # Errors
    /// Fails like [`Self::new`]; in contact is what touches the outline at the heading of the start.
    pub fn shaped(
        (robot, footprint): (Mover, Option<Arc<Footprint>>),
        ends: [[f64; 2]; 2],
        obstacles: Vec<Obstacle>,
        rules: Rules,
        measurement: Option<Measurement>,
    ) -> Result<Self> {
        let sensing = Sensing::by(measurement);
        let known = (&rules, &sensing, footprint);
        match robot {
            Mover::Holonomic(robot) => {
                let limits = robot.checked()?.limits();
                Self::placed(robot, &limits, ends, obstacles, known)
            }
            Mover::Differential(robot) => {
                let limits = robot.checked()?.limits();
                let scenario = Self::placed(robot.reference(), &limits, ends, obstacles, known)?;
                Ok(Self {
                    differential: Some(robot),
                    ..scenario
                })
            }
        }
    }

    fn placed(
        robot: HolonomicRobot,
        limits: &RobotLimits,
        [start, goal]: [[f64; 2]; 2],
        obstacles: Vec<Obstacle>,
        (rules, sensing, footprint): (&Rules, &Sensing, Option<Arc<Footprint>>),
    ) -> Result<Self> {
        finite_pair("start", start)?;
        finite_pair("goal", goal)?;
        positive("control_period", rules.control_period)?;
        positive("time_limit", rules.time_limit)?;
        positive("arrival_tolerance", rules.arrival_tolerance)?;
        positive("rest_time", rules.rest_time)?;
        finite("heading", rules.heading)?;
        if (start[0] - goal[0]).hypot(start[1] - goal[1]) <= rules.arrival_tolerance {
            let rule = "be farther from the start than the arrival tolerance";
            return Err(Failure::invalid("goal", rule, Given::Pair(goal)));
        }
        let body = footprint.as_deref();
        let (obstacles, blocked) =
            place_all((limits, body), [start, goal], obstacles, rules, sensing)?;
        Ok(Self {
            robot,
            differential: None,
            footprint,
            start,
            goal,
            obstacles,
            rules: *rules,
            measurement: sensing.measurement,
            seed: 0,
            map: None,
            walls: None,
            lidars: Arc::default(),
            blocked,
        })
    }

    /// A robot among people and robots who decide as they go, and things that stand: each obstacle
    /// with its largest speed in m/s, `None` for no bound, and whether it stands. Where somebody stands
    /// at the start says nothing of the goal, and the robot may be there already.
    ///
    /// # Errors
    /// A value is out of range.
    pub fn among(
        robot: Mover,
        [start, goal]: [[f64; 2]; 2],
        obstacles: impl Iterator<Item = (Obstacle, Option<f64>, bool)>,
        rules: Rules,
        measurement: Option<Measurement>,
    ) -> Result<Self> {
        let (point, limits, differential) = match robot {
            Mover::Holonomic(robot) => (robot, robot.checked()?.limits(), None),
            Mover::Differential(robot) => {
                (robot.reference(), robot.checked()?.limits(), Some(robot))
            }
        };
        let sensing = Sensing::by(measurement);
        let placed = obstacles.map(|(obstacle, speed_bound, stationary)| {
            Ok(PlacedObstacle {
                stationary,
                speed_bound,
                ..place(&limits, obstacle, rules.control_period, &sensing)?
            })
        });
        Ok(Self {
            robot: point,
            differential,
            footprint: None,
            start,
            goal,
            obstacles: placed.collect::<Result<_>>()?,
            rules,
            measurement,
            seed: 0,
            map: None,
            walls: None,
            lidars: Arc::default(),
            blocked: None,
        })
    }

    /// Scenario with walls that no law is told of; who knows them has a map, or sees them.
    #[must_use]
    pub fn with_walls(mut self, walls: StaticMap) -> Self {
        self.walls = Some(walls);
        self
    }

    /// Scenario with noisy or late measurements drawn from a seed. Regions that were not
    /// given are sized for them.
    ///
    /// # Errors
    /// A critical radius is below the distance at which robot and obstacle touch.
    pub fn measured(mut self, measurement: Option<Measurement>, seed: u64) -> Result<Self> {
        if measurement != self.measurement {
            let (robot, rules) = (self.limits(), self.rules);
            let sensing = Sensing::by(measurement);
            let obstacles = self.obstacles.into_iter();
            let obstacles = obstacles.map(|placed| placed.obstacle);
            let ends = [self.start, self.goal];
            let body = self.footprint.as_deref();
            (self.obstacles, self.blocked) =
                place_all((&robot, body), ends, obstacles, &rules, &sensing)?;
        }
        self.measurement = measurement;
        self.seed = seed;
        Ok(self)
    }

    /// Scenario with a slower robot; regions that were not given are sized for it.
    ///
    /// # Errors
    /// Fails like [`Self::new`].
    pub fn slowed(&self, max_speed: f64) -> Result<Self> {
        let mut slowed = self.clone();
        slowed.robot.max_speed = positive("max_speed", max_speed)?;
        let limits = RobotLimits {
            max_speed,
            ..self.limits()
        };
        let sensing = Sensing::by(self.measurement);
        let obstacles = self.obstacles.iter().map(|placed| placed.obstacle.clone());
        let ends = [self.start, self.goal];
        (slowed.obstacles, slowed.blocked) = place_all(
            (&limits, self.footprint.as_deref()),
            ends,
            obstacles,
            &self.rules,
            &sensing,
        )?;
        Ok(slowed)
    }

    /// Limits that size the regions.
    pub(crate) fn limits(&self) -> RobotLimits {
        let holonomic = self.robot.limits();
        self.differential.map_or(holonomic, |robot| robot.limits())
    }

    /// Copy of the scenario with other noise.
    #[must_use]
    pub fn reseeded(mut self, seed: u64) -> Self {
        self.seed = seed;
        self
    }

    /// Copy of the scenario without obstacles and without noise: the scene of the nominal run.
    #[must_use]
    pub fn nominal(&self) -> Self {
        Self {
            robot: self.robot,
            differential: self.differential,
            footprint: self.footprint.clone(),
            start: self.start,
            goal: self.goal,
            obstacles: Vec::new(),
            rules: self.rules,
            measurement: None,
            seed: 0,
            map: self.map.clone(),
            walls: None,
            lidars: Arc::default(),
            blocked: None,
        }
    }

    /// Whether [`Self::nominal`] of both is the same.
    #[must_use]
    pub fn same_way(&self, other: &Self) -> bool {
        self.start == other.start
            && self.goal == other.goal
            && self.robot == other.robot
            && self.differential == other.differential
            && self.footprint == other.footprint
            && self.rules == other.rules
    }

    /// Returns nothing if a law that keeps to regions can reach the goal.
    ///
    /// # Errors
    /// The goal lies in the active region of a stationary obstacle.
    pub fn with_free_goal(&self) -> Result<()> {
        self.blocked.clone().map_or(Ok(()), |failure| Err(*failure))
    }

    /// Number of obstacles.
    #[must_use]
    pub fn obstacle_count(&self) -> usize {
        self.obstacles.len()
    }

    /// The obstacles with their regions.
    #[must_use]
    pub fn obstacles(&self) -> &[PlacedObstacle] {
        &self.obstacles
    }

    /// Instant from which no obstacle moves any more, in s; infinite if there is none.
    #[must_use]
    pub fn stands_from(&self) -> f64 {
        self.obstacles.iter().fold(0.0, |time, placed| {
            time.max(placed.obstacle.motion.stands_from())
        })
    }

    /// Control period in s.
    #[must_use]
    pub fn control_period(&self) -> f64 {
        self.rules.control_period
    }

    /// The point mass that a law drives: the robot, or the one that a two-wheel robot follows.
    #[must_use]
    pub fn point_mass(&self) -> &HolonomicRobot {
        &self.robot
    }

    /// Seed of noise and of laws that draw.
    #[must_use]
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// Start in m.
    #[must_use]
    pub fn start(&self) -> [f64; 2] {
        self.start
    }

    /// Goal in m.
    #[must_use]
    pub fn goal(&self) -> [f64; 2] {
        self.goal
    }

    /// Heading of the robot in rad.
    #[must_use]
    pub fn heading(&self) -> f64 {
        self.rules.heading
    }

    /// The two-wheel robot, if it is one.
    #[must_use]
    pub fn differential(&self) -> Option<&DifferentialDriveRobot> {
        self.differential.as_ref()
    }

    /// Least distance in m of a plain way through its middle: half the width of a robot with two wheels, the inner
    /// radius of another outline, the radius of a disc.
    #[must_use]
    pub fn least_room(&self) -> f64 {
        match &self.footprint {
            Some(outline) if self.differential.is_some() => outline.half_width(),
            Some(outline) => outline.inner_radius(),
            None => self.robot.radius,
        }
    }

    /// Distance in m of the robot from a map at a place, with the heading of the start; zero where they meet.
    #[must_use]
    pub fn distance_from(&self, map: &StaticMap, place: [f64; 2]) -> f64 {
        let Some(outline) = &self.footprint else {
            return (map.clearance(place.into()) - self.robot.radius).max(0.0);
        };
        let pose = Frame::at(place, self.rules.heading);
        outline.clearance(&pose, map, f64::INFINITY)
    }

    /// Returns the scenario if its robot moves as a point mass.
    ///
    /// # Errors
    /// The robot has two wheels.
    pub fn of_point_mass(&self) -> Result<()> {
        if self.footprint.is_some() {
            let rule = "be a disc here, where robots move as point masses";
            let given = Given::Found("a robot with a footprint".into());
            return Err(Failure::invalid("robot", rule, given));
        }
        if self.differential.is_none() {
            return Ok(());
        }
        let rule = "be a HolonomicRobot here, where robots move as point masses";
        let given = Given::Found("a DifferentialDriveRobot".into());
        Err(Failure::invalid("robot", rule, given))
    }

    /// Mass of the robot in kg.
    #[must_use]
    pub fn mass(&self) -> f64 {
        self.robot.mass
    }
}
