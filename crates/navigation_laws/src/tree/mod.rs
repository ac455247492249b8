//! Extended rapidly-exploring random tree of Bruce and Veloso (2002): a new tree at every control
//! step, grown towards the goal, towards points of earlier paths, or anywhere; and a check that
//! the robot can still stop, after Bruce and Veloso (2006).

pub mod buckets;
pub mod growth;
pub mod safety;

use crate::planning::Planner;
use crate::planning::footprint::Footprint;
use crate::planning::path::{PathStatus, distance, length, point_ahead, velocity_towards};
use crate::{Situation, Stop};
use navigation_world::arguments::{Arguments, Named};
use navigation_world::world::geometry::Body;
use navigation_world::world::scenario::Scenario;
use numeric::error::{Failure, Given, Result, not_negative, positive};

use growth::{DRAWS_PER_LOOK, Growth, Tree, is_free, shorten};
use safety::Stopping;

/// Directions in which a way out of an obstacle's clearance is looked for.
const DIRECTIONS: u32 = 32;

/// Share of the length of an edge by which a way out is lengthened until it is long enough.
const WAY_OUT: f64 = 0.25;

/// Parameters. The source gives none of them; the defaults are choices of this implementation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RapidlyExploringRandomTree {
    /// Length of an edge in m.
    pub step: f64,
    /// Probability of growing towards the goal.
    pub goal_probability: f64,
    /// Probability of growing towards a point of an earlier path.
    pub waypoint_probability: f64,
    /// Number of points of earlier paths that are remembered.
    pub waypoints: usize,
    /// Points drawn for one tree, an upper bound of its nodes.
    pub draws: usize,
    /// Keep to what is left of the last path while it is free and not longer than the new one;
    /// without, the path changes at random from step to step.
    pub keeps_path: bool,
    /// Distance kept from obstacles besides the radii, in m.
    pub margin: f64,
    /// Moving obstacles block the way that they take within this time at their present velocity,
    /// in s.
    pub horizon: f64,
    /// How far points are drawn beyond start and goal, in m.
    pub room: f64,
    /// Distance along the path of the point that the robot heads for, in m.
    pub look_ahead: f64,
    /// Velocities tried when the wanted one leaves no room to stop; 0 drops the check.
    pub safety_draws: usize,
}

impl Default for RapidlyExploringRandomTree {
    fn default() -> Self {
        Self {
            step: 0.2,
            goal_probability: 0.1,
            waypoint_probability: 0.6,
            waypoints: 50,
            draws: 2000,
            keeps_path: true,
            margin: 0.05,
            horizon: 1.0,
            room: 3.0,
            look_ahead: 0.1,
            safety_draws: 32,
        }
    }
}

impl RapidlyExploringRandomTree {
    /// Passes parameters that are in range.
    ///
    /// # Errors
    /// Names the value that is not.
    pub fn checked(self) -> Result<Self> {
        positive("step", self.step)?;
        for (name, value, others) in [
            ("goal_probability", self.goal_probability, 0.0),
            (
                "waypoint_probability",
                self.waypoint_probability,
                self.goal_probability,
            ),
        ] {
            not_negative(name, value)?;
            if value + others > 1.0 {
                let rule = "leave a sum of the probabilities of at most 1";
                return Err(Failure::invalid(name, rule, Given::Number(value)));
            }
        }
        if self.draws == 0 {
            let rule = "be at least 1";
            return Err(Failure::invalid("draws", rule, Given::Count(0)));
        }
        not_negative("margin", self.margin)?;
        not_negative("horizon", self.horizon)?;
        positive("room", self.room)?;
        positive("look_ahead", self.look_ahead)?;
        Ok(self)
    }
}

impl Named for RapidlyExploringRandomTree {
    const NAME: &'static str = "rapidly_exploring_random_tree";

    fn made_of(given: &dyn Arguments) -> Result<Self> {
        Ok(Self {
            step: given.number("step")?,
            goal_probability: given.number("goal_probability")?,
            waypoint_probability: given.number("waypoint_probability")?,
            waypoints: given.count("waypoints")?,
            draws: given.count("draws")?,
            keeps_path: given.flag("keeps_path")?,
            margin: given.number("margin")?,
            horizon: given.number("horizon")?,
            room: given.number("room")?,
            look_ahead: given.number("look_ahead")?,
            safety_draws: given.count("safety_draws")?,
        })
    }
}

/// The planner at work in one scenario.
///
/// It drives at full speed towards a point a little ahead on its path. A robot within the
/// clearance of an obstacle, or in its way, takes the shortest way out and plans from there. If
/// the goal is blocked, or the draws find no path and the last one is no longer free, it stops
/// and waits, unless it is within a clearance: that it still leaves. If the wanted velocity leaves
/// no room to stop, it takes the drawn velocity nearest to it that does, and brakes if there is
/// none. It knows present
/// positions and velocities only; a rectangle does not move. Obstacles whose state is not finite
/// are left out, and a robot whose state is not finite is told to stop.
#[derive(Clone, Debug)]
pub struct TreePlanner {
    parameters: RapidlyExploringRandomTree,
    origin: [f64; 2],
    /// Distance of the robot's center from an obstacle's surface, in m.
    growth: f64,
    max_speed: f64,
    stopping: Stopping,
    tree: Tree,
    /// Walls of the map.
    walls: Vec<Footprint>,
    footprints: Vec<Footprint>,
    bodies: Vec<Body>,
    /// Path that is followed, relative to the goal.
    path: Vec<[f64; 2]>,
    /// Path of the new tree.
    fresh: Vec<[f64; 2]>,
    status: PathStatus,
}

impl TreePlanner {
    /// The planner for one scenario, whose seed it takes.
    ///
    /// # Errors
    /// A parameter is out of range.
    pub fn new(parameters: RapidlyExploringRandomTree, scenario: &Scenario) -> Result<Self> {
        let parameters = parameters.checked()?;
        let origin = scenario.goal;
        let start = [scenario.start[0] - origin[0], scenario.start[1] - origin[1]];
        let growth = Growth {
            low: start.map(|part| part.min(0.0) - parameters.room),
            high: start.map(|part| part.max(0.0) + parameters.room),
            step: parameters.step,
            goal_probability: parameters.goal_probability,
            waypoint_probability: parameters.waypoint_probability,
            draws: parameters.draws,
            waypoints: parameters.waypoints,
        };
        let grown = scenario.robot.radius + parameters.margin;
        let walls = scenario.map.as_ref();
        Ok(Self {
            walls: walls.map_or_else(Vec::new, |map| {
                Footprint::of_map(map, origin, grown, [growth.low, growth.high])
            }),
            parameters,
            origin,
            growth: grown,
            max_speed: scenario.robot.max_speed,
            stopping: Stopping {
                radius: scenario.robot.radius,
                max_acceleration: scenario.robot.guaranteed_acceleration(),
            },
            tree: Tree::new(growth, scenario.seed),
            footprints: Vec::with_capacity(scenario.obstacle_count()),
            bodies: Vec::with_capacity(scenario.obstacle_count()),
            path: Vec::new(),
            fresh: Vec::new(),
            status: PathStatus::Unplanned,
        })
    }

    /// Result of the last step.
    #[must_use]
    pub fn status(&self) -> PathStatus {
        self.status
    }

    /// The last tree.
    #[must_use]
    pub fn tree(&self) -> &Tree {
        &self.tree
    }

    /// Ground that the last plan kept out of, relative to the goal.
    #[must_use]
    pub fn footprints(&self) -> &[Footprint] {
        &self.footprints
    }

    /// The whole path from the robot to the goal in m; empty if there is none.
    pub fn whole_path(&mut self, situation: &Situation<'_, f64>) -> Vec<[f64; 2]> {
        self.plan(situation);
        let [x, y] = self.origin;
        let back = |point: &[f64; 2]| [point[0] + x, point[1] + y];
        self.path.iter().map(back).collect()
    }

    /// Plans a path; there is none when the robot has to stop.
    fn plan(&mut self, situation: &Situation<'_, f64>) {
        let position = situation.robot.position;
        let position = [position.x - self.origin[0], position.y - self.origin[1]];
        self.footprints.clear();
        if !position.iter().all(|part| part.is_finite()) {
            self.status = PathStatus::Unplanned;
            self.path.clear();
            return;
        }
        let (origin, growth, horizon) = (self.origin, self.growth, self.parameters.horizon);
        let footprint = |body| Footprint::of(body, origin, growth, horizon);
        self.footprints.extend_from_slice(&self.walls);
        self.footprints
            .extend(situation.bodies.iter().filter_map(footprint));
        let held = |point| self.footprints.iter().any(|ground| ground.holds(point));
        let leaving = held(position);
        self.status = if held([0.0; 2]) {
            PathStatus::GoalBlocked
        } else if leaving {
            PathStatus::Leaving
        } else {
            PathStatus::Found
        };
        let entry = if leaving {
            self.way_out(position)
        } else {
            Some(position)
        };
        match entry {
            Some(entry) if self.status != PathStatus::GoalBlocked => {
                self.plan_from(entry, situation.stop);
            }
            _ => self.path.clear(),
        }
        if self.path.is_empty() && self.status != PathStatus::GoalBlocked {
            self.status = PathStatus::NoPath;
        }
        if let Some(entry) = entry.filter(|_| leaving) {
            if self.path.is_empty() {
                self.path.push(entry);
            }
            self.path.insert(0, position);
        }
    }

    /// Plans from a free point; no path if neither the new tree nor the last path gives one.
    fn plan_from(&mut self, entry: [f64; 2], stop: Stop<'_>) {
        let found = self
            .tree
            .grow(entry, &self.footprints, &mut self.fresh, stop);
        if found {
            shorten(&mut self.fresh, &self.footprints);
        }
        let kept = (self.parameters.keeps_path || !found) && self.follow_last(entry);
        if found && !(kept && length(&self.path) <= length(&self.fresh)) {
            std::mem::swap(&mut self.path, &mut self.fresh);
        } else if !kept {
            self.path.clear();
        }
    }

    /// The nearest free point, of several the one nearest to the goal.
    fn way_out(&self, position: [f64; 2]) -> Option<[f64; 2]> {
        let to_goal = distance(position, [0.0; 2]);
        let ahead = if to_goal > 0.0 {
            position.map(|part| -part / to_goal)
        } else {
            [1.0, 0.0]
        };
        let growth = self.tree.growth();
        let widest = distance(growth.low, growth.high);
        let mut way = 0.0;
        while way < widest {
            way += WAY_OUT * self.parameters.step;
            let mut best: Option<(f64, [f64; 2])> = None;
            for number in 0..DIRECTIONS {
                let turn = std::f64::consts::TAU * f64::from(number) / f64::from(DIRECTIONS);
                let (sine, cosine) = turn.sin_cos();
                let point = [
                    position[0] + way * (cosine * ahead[0] - sine * ahead[1]),
                    position[1] + way * (cosine * ahead[1] + sine * ahead[0]),
                ];
                let left = distance(point, [0.0; 2]);
                let nearer = best.is_none_or(|(known, _)| left < known);
                if nearer && !self.footprints.iter().any(|ground| ground.holds(point)) {
                    best = Some((left, point));
                }
            }
            if let Some((_, point)) = best {
                return Some(point);
            }
        }
        None
    }

    /// Starts the last path at the robot; whether all of it is free.
    fn follow_last(&mut self, position: [f64; 2]) -> bool {
        // A mere way out of a clearance does not end at the goal.
        if self.path.len() < 2 || self.path.last() != Some(&[0.0; 2]) {
            return false;
        }
        // The robot may have passed the first points: it heads for the last one in sight.
        let Some(next) = (1..self.path.len())
            .rev()
            .find(|&number| is_free([position, self.path[number]], &self.footprints))
        else {
            return false;
        };
        self.path.drain(..next - 1);
        self.path[0] = position;
        let free = |leg: &[[f64; 2]]| is_free([leg[0], leg[1]], &self.footprints);
        self.path.windows(2).all(free)
    }

    /// A velocity that leaves room to stop: the wanted one if it does, otherwise the nearest of
    /// those drawn, otherwise zero.
    fn safe(&mut self, situation: &Situation<'_, f64>, wanted: [f64; 2]) -> [f64; 2] {
        let draws = self.parameters.safety_draws;
        self.bodies.clear();
        let known = |body: &&Body| {
            let state = &body.state;
            let mut parts = state.position.iter().chain(&state.velocity);
            parts.all(|part| part.is_finite())
        };
        self.bodies
            .extend(situation.bodies.iter().filter(known).copied());
        let situation = Situation {
            bodies: &self.bodies,
            ..*situation
        };
        if draws == 0 || self.stopping.is_safe(&situation, wanted) {
            return wanted;
        }
        let mut best: Option<(f64, [f64; 2])> = None;
        for draw in 1..=draws {
            if draw % DRAWS_PER_LOOK == 0 && situation.stop.asked() {
                break;
            }
            let chance = self.tree.chance();
            // Uniform over the disc of speeds.
            let speed = self.max_speed * chance.unit().sqrt();
            let (sine, cosine) = (std::f64::consts::TAU * chance.unit()).sin_cos();
            let drawn = [speed * cosine, speed * sine];
            let away = distance(drawn, wanted);
            let nearer = best.is_none_or(|(known, _)| away < known);
            if nearer && self.stopping.is_safe(&situation, drawn) {
                best = Some((away, drawn));
            }
        }
        best.map_or([0.0; 2], |(_, velocity)| velocity)
    }
}

impl Planner for TreePlanner {
    fn desired_velocity(&mut self, situation: &Situation<'_, f64>) -> [f64; 2] {
        self.plan(situation);
        let ahead = point_ahead(&self.path, self.parameters.look_ahead);
        let wanted = match (self.path.first(), ahead) {
            (Some(&from), Some(to)) => velocity_towards(from, to, self.max_speed),
            _ => [0.0; 2],
        };
        if self.status == PathStatus::Unplanned {
            return wanted;
        }
        self.safe(situation, wanted)
    }

    fn can_aim(&self) -> bool {
        false
    }
}
