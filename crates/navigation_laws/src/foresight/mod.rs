//! Foresight: a search through space and time among people as they are predicted, whose first velocity the robot takes.
//!
//! Everybody is estimated from what is measured and predicted at a constant velocity along walls. A program in space
//! and time tells what the way from every node of a grid costs at every stage, and the first velocity is the cheapest
//! of many that is verified. The shield decides what is safe; foresight only which of the verified velocities is taken.

mod candidates;
mod estimate;
mod ground;
mod impatience;
mod prediction;
mod program;

#[cfg(test)]
mod tests;

use crate::guide::{Plan, RobotRoom};
use crate::shield::{OutlineGuard, ShieldLimits, StaticObstacles};
use estimate::Estimates;
use impatience::Impatience;
use navigation_world::world::geometry::RobotState;
use numeric::error::{Failure, Given, Result, not_negative, positive};
use numeric::lanes::Vector2;
use prediction::Prediction;
use program::Program;

pub use candidates::{AcceptedTarget, Driven, Target, taken_up};
pub use estimate::Sighting;

/// Most stages of the program.
pub const MOST_STAGES: usize = 50;

/// Most nodes across the grid: memory and time of a decision grow with their square.
const MOST_ACROSS: f64 = 400.0;

/// Discs smaller than this are boundary points and nobody, in m.
const SMALLEST: f64 = 0.05;

/// Distance of the surface from walls below which nobody goes nearer, in m.
const ROOM: f64 = 0.015;

/// How the robot looks ahead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foresight {
    /// Stages `K` of the program.
    pub stages: usize,
    /// Time `dt` of a stage in s.
    pub step: f64,
    /// Distance of the surfaces `y` at which a contact counts by half, in m.
    pub clearance: f64,
    /// Cost of a certain contact, as a multiple of the time that it lasts.
    pub risk_weight: f64,
    /// Distance of the surfaces that is comfortable, in m.
    pub comfort: f64,
    /// Cost of touching without risk, as a multiple of the time.
    pub comfort_weight: f64,
    /// Cost of another velocity than the last one, in s for a change by the largest speed.
    pub change_weight: f64,
    /// Cost of being faster than is preferred, as a multiple of the time.
    pub speed_weight: f64,
    /// Growth of the uncertainty of predicted people, in m/s.
    pub spread: f64,
    /// Acceleration of people between measurements with an error, `q` in m/s^2.
    pub acceleration: f64,
}

impl Default for Foresight {
    fn default() -> Self {
        Self {
            stages: 12,
            step: 0.4,
            clearance: 0.08,
            risk_weight: 40.0,
            comfort: 0.4,
            comfort_weight: 0.6,
            change_weight: 0.1,
            speed_weight: 0.5,
            spread: 0.1,
            acceleration: 1.0,
        }
    }
}

impl Foresight {
    /// Returns it if its numbers are allowed.
    ///
    /// # Errors
    /// Names the number that is not.
    pub fn checked(self) -> Result<Self> {
        if !(2..=MOST_STAGES).contains(&self.stages) {
            let rule = format!("be from 2 to {MOST_STAGES}");
            let given = Given::Number(self.stages as f64);
            return Err(Failure::invalid("stages", rule, given));
        }
        positive("step", self.step)?;
        not_negative("clearance", self.clearance)?;
        positive("risk_weight", self.risk_weight)?;
        positive("comfort", self.comfort)?;
        not_negative("comfort_weight", self.comfort_weight)?;
        not_negative("change_weight", self.change_weight)?;
        not_negative("speed_weight", self.speed_weight)?;
        not_negative("spread", self.spread)?;
        positive("acceleration", self.acceleration)?;
        Ok(self)
    }

    /// Chance of a contact at a gap between surfaces in m, as far as uncertain by `blur` m.
    #[inline(always)]
    fn risk(&self, gap: f64, blur: f64) -> f64 {
        let share = (self.clearance + blur - gap) * (0.5 / blur);
        let share = if share > 0.0 { share } else { 0.0 };
        let share = if share < 1.0 { share } else { 1.0 };
        share * share * (3.0 - 2.0 * share)
    }

    /// Uncertainty of somebody's place after a time in s, with a standard deviation of his velocity in m/s.
    fn blur(&self, time: f64, deviation: f64) -> f64 {
        (LEAST_BLUR + time * self.spread.hypot(deviation)).min(MOST_BLUR)
    }

    /// Gap in m beyond which nobody has a price.
    fn felt(&self, blur: f64) -> f64 {
        self.comfort.max(self.clearance + blur)
    }
}

/// Uncertainty of a predicted place at once and at most, in m.
const LEAST_BLUR: f64 = 0.05;
const MOST_BLUR: f64 = 0.4;

/// Knowledge of the robot at the instant of a decision.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    /// The robot.
    pub robot: RobotState<f64>,
    /// The goal in m.
    pub goal: Vector2<f64>,
    /// Vector to the (local) goal in m.
    pub ahead: Vector2<f64>,
    /// Everybody around.
    pub people: &'a [Sighting],
    /// Error of their positions in m.
    pub position_error: f64,
    /// Static obstacles.
    pub walls: StaticObstacles<'a>,
    /// Shield of a robot that is no disc, and its heading in rad.
    pub outline: Option<(&'a OutlineGuard, f64)>,
    /// Costs of the ways to the goal, if there is a plan.
    pub plan: Option<&'a Plan>,
}

/// Way of the robot and of people that a decision expects, for pictures.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Foreseen {
    /// Time between the instants in s.
    pub step: f64,
    /// Places of the robot at them, in m.
    pub way: Vec<[f64; 2]>,
    /// Number of each person, and the places at them, in m.
    pub people: Vec<(usize, Vec<[f64; 2]>)>,
    /// Number of stages.
    pub stages: usize,
}

/// Foresight at work for one robot; what it needs is kept between decisions.
#[derive(Clone, Debug)]
pub struct Foreseer {
    settings: Foresight,
    /// Limits of the robot.
    pub(crate) limits: ShieldLimits,
    /// Speed that it prefers, in m/s.
    preferred: f64,
    room: RobotRoom,
    estimates: Estimates,
    prediction: Prediction,
    program: Program,
    /// Target of the last decision; at first the robot rests.
    last: Target,
    /// Where the robot was at the last decision, and where its first velocity leads, in m.
    ends: [Vector2<f64>; 2],
    candidates: Vec<candidates::Candidate>,
    impatience: Impatience,
    processor: pulp::Arch,
}

impl Foreseer {
    /// Foresight with the limits of a robot, a speed in m/s that it prefers, and the room that it needs beside walls.
    /// People are kept off the radius of the limits.
    ///
    /// # Errors
    /// Names the number that is not allowed.
    pub fn new(
        settings: Foresight,
        limits: ShieldLimits,
        preferred: f64,
        room: impl Into<RobotRoom>,
    ) -> Result<Self> {
        let settings = settings.checked()?;
        positive("preferred_speed", preferred)?;
        let room: RobotRoom = room.into();
        let reach = candidates::cells_of_first_velocity(limits.max_speed, preferred);
        let across = 2.0 * (2.0 * (settings.stages - 1) as f64 + reach) + 1.0;
        if across > MOST_ACROSS {
            let rule = format!("be so large that the grid has at most {MOST_ACROSS} nodes across");
            let given = Given::Number(preferred);
            return Err(Failure::invalid("preferred_speed", rule, given));
        }
        Ok(Self {
            settings,
            limits,
            preferred,
            room,
            estimates: Estimates::default(),
            prediction: Prediction::default(),
            program: Program::new(&settings, preferred, reach),
            last: Target::forwards(Vector2::zeros()),
            ends: [Vector2::zeros(); 2],
            candidates: Vec::new(),
            impatience: Impatience::new(preferred),
            processor: pulp::Arch::new(),
        })
    }

    /// Settings of foresight.
    #[must_use]
    pub fn settings(&self) -> &Foresight {
        &self.settings
    }

    /// The cheapest target that `take` accepts, with what it makes of it; `None` where it accepts none. `driven` tells
    /// where a target leads.
    pub fn decide<C>(
        &mut self,
        scene: &Scene<'_>,
        wheels: bool,
        driven: impl Fn(&Target) -> Driven,
        mut take: impl FnMut(&Target) -> Option<C>,
    ) -> Option<AcceptedTarget<C>> {
        let period = self.limits.period;
        let (settings, radius) = (self.settings, self.limits.radius);
        self.estimates.observe(scene, settings.acceleration, period);
        let somebody = |each: &&Sighting| each.touch - radius >= SMALLEST;
        let people = scene.people.iter().filter(somebody);
        self.prediction
            .foresee(&settings, people, &self.estimates, scene.walls, radius);
        self.program.solve(
            &settings,
            scene,
            &self.prediction,
            self.room,
            self.processor,
        );
        let place = scene.robot.position;
        self.ends = [place, place];
        let lines_up = self.room.turns() && !scene.walls.is_empty();
        self.impatience.observe(place, period, lines_up);
        let mut cheapest = true;
        let mut choice = |foreseer: &mut Self, target: Target| {
            let Some(command) = take(&target) else {
                cheapest = false;
                return None;
            };
            foreseer.last = target;
            foreseer.ends[1] = driven(&target).places[3];
            Some(AcceptedTarget {
                target: target.velocity,
                command,
                cheapest,
            })
        };
        if scene.ahead.norm() <= self.limits.max_speed * period {
            let straight = Target::forwards(scene.ahead / period);
            if let Some(found) = choice(self, straight) {
                return Some(found);
            }
        }
        self.price(scene, wheels, &driven);
        let mut candidates = std::mem::take(&mut self.candidates);
        let found = std::iter::from_fn(|| candidates::cheapest(&mut candidates))
            .find_map(|target| choice(self, target));
        self.candidates = candidates;
        found
    }

    /// Way and people that the last decision expects.
    #[must_use]
    pub fn foreseen(&self) -> Foreseen {
        Foreseen {
            step: self.settings.step,
            way: self.program.way(self.ends),
            people: self.prediction.ways(),
            stages: self.settings.stages,
        }
    }
}
