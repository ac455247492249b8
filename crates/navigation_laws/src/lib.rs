//! Navigation laws behind one interface.
//!
//! Equations of the force field follow L. Zeng, "Design and control of human-friendly robots",
//! doctoral thesis, Canada, 2011, chapters 5 to 7 and appendices B to D, with their misprints
//! corrected; each module names its own sources. SI units and radians throughout.

#![forbid(unsafe_code)]

/// Laws that act pair by pair, by their files: [`pairwise`] compiles one time loop for all of them, and
/// the registry of runs makes each by its name.
#[macro_export]
#[doc(hidden)]
macro_rules! pairwise_laws {
    ($list:ident) => {
        $list! {
            masoud::Masoud,
            ge_cui::GeCui,
            khatib::Khatib,
            borenstein_koren::BorensteinKoren,
        }
    };
}

/// The other laws by their files: planners, and laws of their own. Each with how its runs are made.
#[macro_export]
#[doc(hidden)]
macro_rules! other_laws {
    ($list:ident) => {
        $list! {
            Own, impedance::ImpedanceFamily, one_by_one;
            Planned, velocity_obstacle::VelocityObstacle, one_by_one;
            Planned, reciprocal::ReciprocalAvoidance, side_by_side;
            Planned, field_d_star::FieldDStar, one_by_one;
            Planned, tree::RapidlyExploringRandomTree, one_by_one;
            Steered, dynamic_window::DynamicWindow, one_by_one;
            Steered, dwb::DWB, one_by_one;
            Steered, pure_pursuit::RegulatedPurePursuit, one_by_one;
            Steered, path_integral::PathIntegral, one_by_one;
        }
    };
}

pub mod arc_rollouts;
mod borenstein_koren;
pub mod dwb;
pub mod dynamic_window;
pub mod escape;
pub mod field;
pub mod field_d_star;
pub mod filters;
pub mod foresight;
mod ge_cui;
pub mod guide;
pub mod impedance;
mod khatib;
pub mod local_planning;
mod masoud;
pub mod pairwise;
pub mod path_integral;
pub mod planning;
pub mod pure_pursuit;
pub mod reciprocal;
pub mod reflex;
pub mod safe;
pub mod shield;
pub mod trace;
pub mod tree;
pub mod velocity_obstacle;
pub mod yielding;

pub use borenstein_koren::BorensteinKoren;
pub use field::law::{ForceFieldLaw, VirtualForceField};
pub use field::terms::{FieldTerms, ObstacleTerms};
pub use ge_cui::GeCui;
pub use khatib::{Khatib, KhatibForm};
pub use masoud::Masoud;

pub use numeric::error::Stop;

use crate::local_planning::TwistPlanner;
use crate::trace::{Examined, Trace};
use navigation_world::robots::differential::Twist;
use navigation_world::sensing::sensor::{LidarScan, Sensor};
use navigation_world::world::geometry::{Body, RobotState};
use navigation_world::world::map::StaticMap;
use navigation_world::world::scenario::{PlacedObstacle, Scenario};
use numeric::error::{Failure, Given, Result};
use numeric::lanes::{Real, Vector2};
use unknown_places::explore::Explorer;
use unknown_places::unseen::Belief;

/// Scans since the last decision of a law.
#[derive(Clone, Copy, Debug, Default)]
pub struct Scan<'a> {
    /// Beams and people that the scan shows, for laws that reckon with people whom nobody sees.
    pub shown: Shown<'a>,
    /// Scans of this sample, for laws that make their own map.
    pub lidars: Lidars<'a>,
    /// How much more time than the clock tells may have gone by since then, in s.
    pub more: f64,
}

/// Content of a scan.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Shown<'a> {
    /// Nothing was scanned.
    #[default]
    Nothing,
    /// All obstacles up to a range in m, hidden or not: the law itself scans the map that it knows with them in it.
    All {
        /// In m.
        range: f64,
    },
    /// Ends in m of beams that a lidar measured; those that read nothing end where they begin.
    Beams {
        /// Position of the lidar in m.
        from: [f64; 2],
        /// Ends of the beams in m.
        ends: &'a [[f64; 2]],
    },
}

impl Scan<'static> {
    /// A scan by the law itself, which is shown everything.
    pub const ALL: Self = Self {
        shown: Shown::All {
            range: f64::INFINITY,
        },
        lidars: Lidars(&[]),
        more: 0.0,
    };
}

/// Lidars among the sensors of a robot.
#[derive(Clone, Copy, Default)]
pub struct Lidars<'a>(pub &'a [Box<dyn Sensor>]);

impl<'a> Lidars<'a> {
    /// Last scan of each lidar, in the order of the sensors.
    pub fn scans(self) -> impl Iterator<Item = LidarScan<'a>> {
        self.0.iter().filter_map(|sensor| sensor.scan())
    }
}

impl std::fmt::Debug for Lidars<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_list().entries(self.scans()).finish()
    }
}

/// Measured state from which a law decides. `B`: numbers of the scene, which robots side by
/// side share, or which each of them has for itself.
#[derive(Clone, Copy, Debug)]
pub struct Situation<'a, R: Real> {
    /// When, in s.
    pub time: R,
    /// Obstacles as measured.
    pub bodies: &'a [Body<R>],
    /// How old what is known of each of them is, in s; all of it is of now where this is empty.
    pub ages: &'a [f64],
    /// Robots as measured, one a lane.
    pub robot: RobotState<R>,
    /// Heading of the robots as measured, in rad.
    pub heading: f64,
    /// How long the force will act, in s.
    pub interval: f64,
    /// Scan since the last command.
    pub scan: Scan<'a>,
    /// Whether to stop.
    pub stop: Stop<'a>,
}

/// Command of a law.
#[derive(Clone, Copy, Debug)]
pub struct Command<R> {
    /// Force in N, before the limits of the robot.
    pub force: Vector2<R>,
    /// Stabilizing force within it, in N.
    pub stabilizing: Vector2<R>,
    /// Lyapunov function in N^2, NaN where it is not defined or was not asked for.
    pub lyapunov: R,
}

/// Force in N that reaches a desired velocity at the next sample, `m (v* - V)/interval`, as far as
/// the limits of the robots allow.
#[inline(always)]
pub fn force_toward<R: Real>(
    desired: Vector2<R>,
    situation: &Situation<'_, R>,
    mass: f64,
) -> Vector2<R> {
    let change = desired - situation.robot.velocity;
    change * R::splat(mass / situation.interval)
}

impl<R: Real> Command<R> {
    /// A force that is no sum of terms.
    #[inline(always)]
    pub fn plain(force: Vector2<R>) -> Self {
        Self {
            force,
            stabilizing: Vector2::zeros(),
            lyapunov: R::splat(f64::NAN),
        }
    }
}

/// Knowledge of a law about those whom it does not see.
#[derive(Clone, Debug)]
pub struct Unwatched<'a> {
    /// Where they can be.
    pub belief: &'a Belief,
    /// Who is tracked, in the order of the obstacles.
    pub tracked: Vec<bool>,
    /// Who was where nobody was reckoned with: for them an assumption about people who are not seen is refuted.
    pub unexpected: &'a [usize],
}

impl Unwatched<'_> {
    /// Centers in m of the cells where those can be who are not tracked.
    #[must_use]
    pub fn places(&self) -> Vec<[f64; 2]> {
        let (cells, ground) = (self.belief.cells(), self.belief.ground());
        cells
            .iter()
            .map(|cell| ground.center(cell).into())
            .collect()
    }
}

/// A law for robots side by side; it may remember what it needs between two samples.
pub trait Law<R: Real>: Send {
    /// Whether a command takes so long that the caller is asked at each of them whether to stop.
    fn thinks(&self) -> bool {
        false
    }

    /// Force for the time until the next sample.
    fn command(&mut self, situation: &Situation<'_, R>) -> Command<R>;

    /// Distance `d` from an obstacle in m beyond which it changes no command, whatever it does, so that
    /// the law need not be told of it; infinite where there is none, and for laws that remember obstacles
    /// by their places in the list.
    fn felt_within(&self, _obstacle: &PlacedObstacle) -> f64 {
        f64::INFINITY
    }

    /// Heads for another goal from now on, in m: a local one on the way to that of the scenario.
    /// Laws that plan the whole way themselves keep theirs.
    fn aim(&mut self, _goal: [f64; 2]) {}

    /// Whether the law uses the way that a guide plans.
    fn follows(&self) -> bool {
        false
    }

    /// Takes the way from the robot to the goal, in m, that a guide plans; an empty one is the straight one.
    fn lead(&mut self, _way: &[Vector2<f64>]) {}

    /// Whether [`Self::aim`] changes where it heads.
    fn can_aim(&self) -> bool {
        true
    }

    /// Twist of the last command, of a law that steers two wheels by it and not by the velocity that its force reaches.
    fn twist(&self) -> Option<Twist> {
        None
    }

    /// Record of the parts around the law in the last control period, if there are any.
    fn trace(&self) -> Option<Trace> {
        None
    }

    /// Where those can be whom nobody sees, if the law reckons with them.
    fn unseen(&self) -> Option<Unwatched<'_>> {
        None
    }

    /// Explored map of the law, if it makes its own map of scans.
    fn explored(&self) -> Option<&Explorer> {
        None
    }

    /// Plan behind the command of the last control period of a robot without wheels, if there is a shield.
    fn examined(&self) -> Option<Examined> {
        None
    }
}

/// Sends a law to a goal that moves, in m.
///
/// # Errors
/// The law cannot head for another goal.
pub fn send(law: &mut dyn Law<f64>, goal: Vector2<f64>) -> Result<()> {
    if !law.can_aim() {
        let rule = "head for a goal that moves";
        let given = Given::Found("a law that plans the whole way to the goal of the robot".into());
        return Err(Failure::invalid("law", rule, given));
    }
    law.aim(goal.into());
    Ok(())
}

/// A law for robots side by side, each with a scene and gains of its own.
pub trait LaneLaw<R: Real>: Law<R> {
    /// Whether the law receives all obstacles, by their places in the list. Other laws receive only those in whose
    /// active regions the robots are.
    fn is_told_of_all(&self) -> bool {
        false
    }
}

/// A law up to its gains: what runs, and a search over gains, need to know of it.
pub trait LawFamily: Send + Sync {
    /// Words for the gains, in their order.
    fn gain_names(&self) -> &'static [&'static str];
    /// Its own gains, in that order.
    fn gains(&self) -> Vec<f64>;
    /// Gains that act on a robot without obstacles, ascending.
    fn free_gains(&self) -> &'static [usize];
    /// Every force term at one state with its own gains; `None` for laws that are no sum of terms.
    fn terms(&self, _scenario: &Scenario, _situation: &Situation<'_, f64>) -> Option<FieldTerms> {
        None
    }
    /// True for a law that chooses a velocity, and so knows no regions.
    fn chooses_velocities(&self) -> bool {
        false
    }
    /// True for a law that can reach a goal in the active region of an obstacle that stands.
    fn takes_any_goal(&self) -> bool {
        self.chooses_velocities()
    }
    /// True for a law that steers a robot with two wheels by velocities, not by a point mass to follow.
    fn steers_by_velocity(&self) -> bool {
        false
    }
    /// Whether the law scans its map by itself, for people whom it does not see.
    fn scans(&self) -> bool {
        false
    }
    /// Whether it makes its own map of the scans of the robot's lidars.
    fn maps_its_scans(&self) -> bool {
        false
    }
    /// Map that the law knows, beside the obstacles of a scenario: runs count contacts with it.
    fn map(&self) -> Option<&StaticMap> {
        None
    }
    /// Whether a robot feels obstacles in their active regions only, and is braked to a halt in
    /// their critical regions; a search then need not follow runs whose end is known.
    fn keeps_to_regions(&self) -> bool {
        false
    }
    /// The law as it chooses twists, for one that does, with the seed of its draws.
    fn twist_planner(&self, _seed: u64) -> Option<Box<dyn TwistPlanner>> {
        None
    }
    /// Returns the gains if the law allows them.
    ///
    /// # Errors
    /// Names the gain that is not allowed.
    fn check_gains(&self, gains: &[f64]) -> Result<()>;
    /// The law with gains for one robot in a scenario. `record`: the Lyapunov function is wanted too.
    ///
    /// # Errors
    /// The law cannot work in the scenario with some of these gains.
    fn at_work(
        &self,
        gains: &[f64],
        scenario: &Scenario,
        record: bool,
    ) -> Result<Box<dyn Law<f64>>>;
}

/// A law up to its gains whose robots are stepped side by side.
pub trait LaneFamily: LawFamily {
    /// True for a law with a Lyapunov function, whose descent is counted.
    const LYAPUNOV: bool = false;
    /// Whether lanes may have different gains.
    const MIXES_GAINS: bool = true;
    /// Most obstacles of a scene beside others: a run by itself leaves those that are far away alone.
    const MOST_OBSTACLES: usize = usize::MAX;
    /// Whether lanes take every obstacle for a disc: scenes with others are run by themselves.
    const DISCS_ONLY: bool = false;
    /// The law for robots side by side. `RECORD`: the Lyapunov function is wanted too.
    type Law<R: Real, const RECORD: bool>: LaneLaw<R> + 'static;
    /// The law with the gains of every lane in one scenario.
    ///
    /// # Errors
    /// The law cannot work in the scenario with some of these gains.
    fn with_gains<R: Real, const RECORD: bool>(
        &self,
        gains: &[R],
        scenario: &Scenario,
    ) -> Result<Self::Law<R, RECORD>>;
    /// A run begins in a lane of a law at work, with its gains among those of all lanes. The scenarios of all lanes
    /// have the same robot and the same rules.
    ///
    /// # Errors
    /// The law cannot work in the scenario with these gains.
    fn enter<R: Real, const RECORD: bool>(
        &self,
        law: &mut Self::Law<R, RECORD>,
        lane: usize,
        gains: &[R],
        scenario: &Scenario,
    ) -> Result<()>;
}
