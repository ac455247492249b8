//! Scans and a pose in, a verified twist out, once in a control period.

use std::f64::consts::TAU;

use nalgebra::Vector2;
use navigation_world::robots::differential::{DifferentialLimits, Twist};
use navigation_world::robots::{DifferentialDriveRobot, HolonomicRobot};
use navigation_world::world::footprint::Footprint;
use navigation_world::world::frame::Frame;
use numeric::error::{Failure, Given, Result, finite_pair, not_negative, positive};

use super::recovery::Recovery;
use super::rollouts::{Rated, Reach, Rollouts};
use super::verify::{Chassis, Obstacle};
use crate::guide::{GuideOptions, Progress, Search, Size, TimeToGo};
use crate::map::{Cells, MapOptions, RollingMap, Scan};

/// Under the robot and as far around it in m cells are free at the start.
const STANDS: f64 = 0.03;

/// A robot with two wheels.
#[derive(Clone, Debug, PartialEq)]
pub struct Robot {
    /// Outline around the middle of the axle.
    pub footprint: Footprint,
    /// Limits of its speeds.
    pub limits: DifferentialLimits,
    /// Control period in s.
    pub period: f64,
}

/// Sides of the polygon around the disc of a robot without another outline.
const SIDES: u32 = 16;
/// Largest turn rate in rad/s of the course of a disc that moves in any direction.
const FASTEST_TURN: f64 = 3.0;

impl Robot {
    /// A robot with its footprint, or a polygon around its disc, and a control period in s.
    ///
    /// # Errors
    /// The polygon around its disc is too small or too large.
    pub fn of(
        wheels: &DifferentialDriveRobot,
        footprint: Option<&Footprint>,
        period: f64,
    ) -> Result<Self> {
        Ok(Self {
            footprint: footprint
                .map_or_else(|| around_disc(wheels.radius), |own| Ok(own.clone()))?,
            limits: DifferentialLimits::from(wheels),
            period,
        })
    }

    /// A disc that moves in any direction, as one that drives along a course: what it accelerates along the course and
    /// across it stays together within its limit.
    ///
    /// # Errors
    /// The polygon around the disc is too small or too large.
    pub fn on_course(disc: &HolonomicRobot, period: f64) -> Result<Self> {
        let part = std::f64::consts::FRAC_1_SQRT_2;
        let slowest = disc.max_deceleration.map_or(disc.max_acceleration, |most| {
            most.min(disc.max_acceleration)
        });
        let max_turn_rate = (part * slowest / disc.max_speed).min(FASTEST_TURN);
        Ok(Self {
            footprint: around_disc(disc.radius)?,
            limits: DifferentialLimits {
                max_speed: disc.max_speed,
                max_acceleration: part * disc.max_acceleration,
                max_deceleration: part * slowest,
                max_turn_rate,
                max_angular_acceleration: max_turn_rate / period,
            },
            period,
        })
    }
}

/// A polygon around a disc.
fn around_disc(radius: f64) -> Result<Footprint> {
    let step = TAU / f64::from(SIDES);
    let corner = |side: u32| {
        let (sin, cos) = ((f64::from(side) + 0.5) * step).sin_cos();
        [cos, sin].map(|part| radius / (0.5 * step).cos() * part)
    };
    Footprint::polygon(&(0..SIDES).map(corner).collect::<Vec<_>>())
}

/// Options of map, guide and rollouts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExplorerOptions {
    /// Map.
    pub map: MapOptions,
    /// Prices of ways.
    pub guide: GuideOptions,
    /// Distance from everything known in m.
    pub margin: f64,
    /// Control periods between two searches for a way.
    pub replan: usize,
    /// Nodes that a search looks at in a control period.
    pub nodes: usize,
    /// Whether plans are verified.
    pub verify: bool,
    /// Seed of what is driven without progress.
    pub seed: u64,
}

impl Default for ExplorerOptions {
    fn default() -> Self {
        Self {
            map: MapOptions::default(),
            guide: GuideOptions::default(),
            margin: 0.03,
            replan: 3,
            nodes: 4000,
            verify: true,
            seed: 0,
        }
    }
}

impl ExplorerOptions {
    /// Returns the options if they are allowed.
    ///
    /// # Errors
    /// Names the number that is not.
    pub fn checked(self) -> Result<Self> {
        self.map.checked()?;
        self.guide.checked()?;
        not_negative("margin", self.margin)?;
        for (name, count) in [("replan", self.replan), ("nodes", self.nodes)] {
            if count == 0 {
                return Err(Failure::invalid(name, "be at least 1", Given::Count(0)));
            }
        }
        Ok(self)
    }
}

/// Fate of the commands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// The best one is executed.
    Kept,
    /// Another one than the best is.
    Changed,
    /// None is verified: the plan runs on until rest.
    Braking,
}

/// Command for a control period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decision {
    /// Twist at its end; the present one becomes it at constant rates.
    pub twist: Twist,
    /// Fate of the commands.
    pub status: Status,
    /// Time to the goal in s, where there is a way.
    pub time_to_go: Option<f64>,
    /// Whether the robot drives without progress somewhere else.
    pub recovering: bool,
}

/// A robot at work.
#[derive(Clone, Debug)]
pub struct Explorer {
    chassis: Chassis,
    options: ExplorerOptions,
    map: RollingMap,
    cells: Cells,
    search: Search,
    plan: TimeToGo,
    planned: bool,
    searched: bool,
    since: usize,
    rollouts: Rollouts,
    recovery: Recovery,
    goal: Vector2<f64>,
    /// Twist at the last decision, and the one at the end of its control period.
    from: Twist,
    twist: Twist,
    /// Periods until rest of the plan that is executed.
    left: u32,
    order: Vec<Rated>,
    obstacles: Vec<Obstacle>,
    started: bool,
}

impl Explorer {
    /// A robot at rest that knows nothing.
    ///
    /// # Errors
    /// Names the number that is not allowed, or says that the map is too small for the robot to stop in it.
    pub fn new(robot: &Robot, options: ExplorerOptions, goal: [f64; 2]) -> Result<Self> {
        let limits = robot.limits.checked()?;
        positive("control_period", robot.period)?;
        let options = options.checked()?;
        let chassis = Chassis {
            footprint: robot.footprint.clone(),
            acceleration: limits.max_acceleration.min(limits.max_deceleration),
            turn_acceleration: limits.max_angular_acceleration,
            period: robot.period,
            margin: options.margin,
        };
        let reach = Reach::of(&chassis, limits.max_speed, limits.max_turn_rate);
        let outer = chassis.footprint.outer_radius();
        let fastest = Twist {
            speed: limits.max_speed,
            turn_rate: limits.max_turn_rate,
        };
        let needed = chassis
            .sight(chassis.travel(fastest))
            .max(reach.longest(robot.period) + outer);
        if needed > options.map.reach {
            let rule = format!(
                "be at least {needed:.3} m, within which the robot can come until it stops"
            );
            return Err(Failure::invalid(
                "reach",
                rule,
                Given::Number(options.map.reach),
            ));
        }
        let mut map = RollingMap::new(options.map)?;
        let far = (outer + options.margin + 0.02 + 0.3).max(options.guide.near_distance);
        let size = Size {
            inner: chassis.footprint.inner_radius(),
            outer,
            max_speed: limits.max_speed,
        };
        Ok(Self {
            cells: Cells::new(&mut map, far),
            search: Search::new(options.guide, size, map.size() * map.size()),
            plan: TimeToGo::with_room(map.size() * map.size()),
            map,
            planned: false,
            searched: false,
            since: 0,
            rollouts: Rollouts::new(reach),
            recovery: Recovery::new(robot.period, options.seed),
            goal: finite_pair("goal", goal)?.into(),
            from: Twist::default(),
            twist: Twist::default(),
            left: 0,
            order: Vec::new(),
            obstacles: Vec::new(),
            started: false,
            chassis,
            options,
        })
    }

    /// The cells as they were at the last decision.
    #[must_use]
    pub fn cells(&self) -> &Cells {
        &self.cells
    }

    /// Times to the goal.
    #[must_use]
    pub fn plan(&self) -> Option<&TimeToGo> {
        self.planned.then_some(&self.plan)
    }

    /// How often the robot made no progress.
    #[must_use]
    pub fn recoveries(&self) -> u64 {
        self.recovery.begun()
    }

    /// The twist that its plan has now.
    #[must_use]
    pub fn twist(&self) -> Twist {
        self.twist
    }

    /// Enters a scan, made at the pose of the lidar in it; `robot`: pose of the robot now.
    ///
    /// # Errors
    /// The scan is not allowed.
    pub fn see(&mut self, robot: &Frame, scan: Scan<'_>) -> Result<()> {
        self.follow(robot);
        self.map.enter(scan)
    }

    fn follow(&mut self, robot: &Frame) {
        self.map.follow(robot.position);
        if !self.started {
            self.started = true;
            self.map.stands(&self.chassis.footprint, robot, STANDS);
        }
    }

    /// Decides for the next control period from a pose; all scans until now have been entered.
    pub fn decide(&mut self, robot: &Frame) -> Decision {
        self.follow(robot);
        self.cells.read(&mut self.map);
        self.guide(robot.position);
        let present = self.look(robot);
        let time_to_go = if self.planned {
            self.plan.time(robot.position)
        } else {
            None
        };
        let escape = self.recovery.observe(time_to_go);
        self.order.clear();
        if self.planned {
            let (cells, plan) = (&self.cells, &mut self.plan);
            let rated = self
                .rollouts
                .rate(&self.chassis, cells, plan, robot, self.twist, present);
            self.order
                .extend(rated.iter().filter(|rated| rated.score < f64::INFINITY));
            self.order
                .sort_by(|one, other| one.score.total_cmp(&other.score));
        }
        let mut chosen = None;
        if let Some(wanted) = escape {
            let twist = self.approach(wanted);
            chosen = self.verified(twist).then_some((twist, Status::Changed));
        }
        for at in 0..self.order.len() {
            if chosen.is_some() {
                break;
            }
            let twist = self.order[at].twist;
            let status = if at == 0 {
                Status::Kept
            } else {
                Status::Changed
            };
            chosen = self.verified(twist).then_some((twist, status));
        }
        let (twist, status) = chosen.unwrap_or_else(|| (self.braked(), Status::Braking));
        self.left = match status {
            Status::Braking => self.left.saturating_sub(1),
            _ => self.chassis.periods_to_rest(twist),
        };
        (self.from, self.twist) = (self.twist, twist);
        Decision {
            twist,
            status,
            time_to_go,
            recovering: escape.is_some(),
        }
    }

    /// Lets the plan run on until rest, whatever is known.
    pub fn brake(&mut self) -> Decision {
        let twist = self.braked();
        self.left = self.left.saturating_sub(1);
        (self.from, self.twist) = (self.twist, twist);
        Decision {
            twist,
            status: Status::Braking,
            time_to_go: None,
            recovering: false,
        }
    }

    /// The plan that is executed: times from the last decision in s, and twists between which it changes evenly.
    #[must_use]
    pub fn pieces(&self) -> Vec<(f64, Twist)> {
        let period = self.chassis.period;
        let mut pieces = vec![(0.0, self.from), (period, self.twist)];
        if self.left > 0 {
            pieces.push((period * f64::from(1 + self.left), Twist::default()));
        }
        pieces
    }

    /// Notes that a time in s has passed since the last decision, which need not be a control period.
    pub fn advance(&mut self, elapsed: f64) {
        let period = self.chassis.period;
        if (elapsed - period).abs() <= 1e-6 * period {
            return;
        }
        let pieces = self.pieces();
        let end = pieces.last().map_or(0.0, |(end, _)| *end);
        self.left = ((end - elapsed) / period - 1e-6).ceil().max(0.0) as u32;
        let piece = pieces.windows(2).find(|pair| elapsed < pair[1].0);
        self.twist = piece.map_or(
            if self.left > 0 {
                self.twist
            } else {
                Twist::default()
            },
            |pair| {
                let ((start, first), (end, last)) = (pair[0], pair[1]);
                let share = (elapsed - start) / (end - start);
                Twist {
                    speed: first.speed + share * (last.speed - first.speed),
                    turn_rate: first.turn_rate + share * (last.turn_rate - first.turn_rate),
                }
            },
        );
    }

    /// Forgets what was seen, as the pose from which it was seen is not true any more; the plan runs on.
    pub fn forget(&mut self) {
        self.map.clear();
        self.cells.read(&mut self.map);
        self.planned = false;
        self.started = false;
        self.search.stop();
        self.recovery.restart();
    }

    /// The plan as it runs on.
    fn braked(&self) -> Twist {
        if self.left <= 1 {
            return Twist::default();
        }
        let share = f64::from(self.left - 1) / f64::from(self.left);
        Twist {
            speed: self.twist.speed * share,
            turn_rate: self.twist.turn_rate * share,
        }
    }

    /// A twist as near to a wanted one as the robot can get in a period.
    fn approach(&self, wanted: Twist) -> Twist {
        let period = self.chassis.period;
        let toward = |value: f64, to: f64, rate: f64| {
            value + (to - value).clamp(-rate * period, rate * period)
        };
        Twist {
            speed: toward(self.twist.speed, wanted.speed, self.chassis.acceleration),
            turn_rate: toward(
                self.twist.turn_rate,
                wanted.turn_rate,
                self.chassis.turn_acceleration,
            ),
        }
    }

    fn verified(&mut self, twist: Twist) -> bool {
        if !self.options.verify {
            return true;
        }
        match self.chassis.verify(self.twist, twist, &self.obstacles) {
            Ok(()) => true,
            Err(first) => {
                // What stopped one command stops the next one, too.
                self.obstacles.swap(0, first);
                false
            }
        }
    }

    /// Gathers what a plan may touch, and returns the least distance from what is occupied in m.
    fn look(&mut self, robot: &Frame) -> f64 {
        let sight = self.chassis.sight(self.chassis.travel(self.twist));
        let (chassis, obstacles) = (&self.chassis, &mut self.obstacles);
        obstacles.clear();
        let mut present = f64::INFINITY;
        self.cells
            .known_near(robot.position, sight + self.cells.cell(), |known| {
                let obstacle =
                    chassis.obstacle(robot.inward(known.place - robot.position), known.radius);
                if known.radius == 0.0 {
                    present = present.min(obstacle.present());
                }
                obstacles.push(obstacle);
            });
        obstacles.sort_by(|one, other| one.present().total_cmp(&other.present()));
        present
    }

    /// Searches for a way: the first time to its end, then a part of it in every period.
    fn guide(&mut self, place: Vector2<f64>) {
        self.since += 1;
        if !self.search.running() && (!self.planned || self.since >= self.options.replan) {
            self.search.start(&self.cells, self.goal);
            self.since = 0;
        }
        if !self.search.running() {
            return;
        }
        // The first search goes to its end, as the robot stands; others take several periods.
        let nodes = if self.searched {
            self.options.nodes
        } else {
            usize::MAX
        };
        self.searched = true;
        match self.search.go_on(place, nodes) {
            Progress::Running => {}
            Progress::Found => {
                self.search.exchange(&mut self.plan);
                self.planned = true;
            }
            Progress::NoWay => self.planned = false,
        }
    }
}
