//! Planners as laws: robots in lanes, each with a planner of its own, and the numbers that a
//! search may choose.

use crate::field_d_star::{FieldDStar, FieldDStarPlanner};
use crate::planning::{Planner, ScenePlanner};
use crate::reciprocal::{ReciprocalAvoidance, ReciprocalPlanner};
use crate::tree::{RapidlyExploringRandomTree, TreePlanner};
use crate::velocity_obstacle::{Selection, VelocityObstacle, VelocityObstaclePlanner};
use crate::{Command, LaneFamily, LaneLaw, Law, LawFamily, Situation, force_toward};
use navigation_world::arguments::{Arguments, Named};
use navigation_world::world::scenario::{PlacedObstacle, Scenario};
use numeric::error::{Failure, Given, Result, not_negative, positive};
use numeric::lanes::Real;

/// A planner up to its numbers.
pub trait PlannerFamily: Send + Sync {
    /// The planner at work.
    type Planner: Planner;
    /// Words for the numbers, in their order.
    fn number_names(&self) -> &'static [&'static str];
    /// Its own numbers, in that order.
    fn numbers(&self) -> Vec<f64>;
    /// Passes numbers that the planner allows.
    ///
    /// # Errors
    /// Names the number that is not allowed.
    fn check_numbers(&self, numbers: &[f64]) -> Result<()>;
    /// The planner with its numbers in one scenario.
    ///
    /// # Errors
    /// The planner cannot work in the scenario with these numbers.
    fn planner(&self, numbers: &[f64], scenario: &Scenario) -> Result<Self::Planner>;
}

/// A family of planners as a family of laws: the force `m (v* - V)/interval` reaches the desired
/// velocity at the next sample, as far as the limits of the robot allow.
#[derive(Clone, Copy, Debug)]
pub struct Planned<F>(pub F);

impl<F: Named> Named for Planned<F> {
    const NAME: &'static str = F::NAME;

    fn made_of(given: &dyn Arguments) -> Result<Self> {
        F::made_of(given).map(Self)
    }
}

/// A planner as the law of one robot.
struct PlannerLaw<P> {
    planner: P,
    mass: f64,
}

impl<P: Planner> Law<f64> for PlannerLaw<P> {
    fn thinks(&self) -> bool {
        true
    }

    fn command(&mut self, situation: &Situation<'_, f64>) -> Command<f64> {
        let wanted = self.planner.desired_velocity(situation);
        Command::plain(force_toward(wanted.into(), situation, self.mass))
    }

    fn felt_within(&self, obstacle: &PlacedObstacle) -> f64 {
        self.planner.felt_within(obstacle)
    }

    fn aim(&mut self, goal: [f64; 2]) {
        self.planner.aim(goal);
    }

    fn can_aim(&self) -> bool {
        self.planner.can_aim()
    }
}

/// Planners of robots side by side, one a lane.
pub struct LanePlanners<P> {
    planners: Vec<P>,
    mass: f64,
}

impl<R: Real, P: ScenePlanner> Law<R> for LanePlanners<P> {
    #[inline(always)]
    fn command(&mut self, situation: &Situation<'_, R>) -> Command<R> {
        let wanted = P::desired_velocities(&mut self.planners, situation);
        Command::plain(force_toward(wanted, situation, self.mass))
    }
}

impl<R: Real, P: ScenePlanner> LaneLaw<R> for LanePlanners<P> {
    fn is_told_of_all(&self) -> bool {
        true
    }
}

impl<F: PlannerFamily> LawFamily for Planned<F> {
    fn gain_names(&self) -> &'static [&'static str] {
        self.0.number_names()
    }

    fn gains(&self) -> Vec<f64> {
        self.0.numbers()
    }

    fn chooses_velocities(&self) -> bool {
        true
    }

    fn free_gains(&self) -> &'static [usize] {
        // Any number of a planner may change its way without obstacles.
        const ALL: [usize; 8] = [0, 1, 2, 3, 4, 5, 6, 7];
        &ALL[..self.0.number_names().len()]
    }

    fn check_gains(&self, gains: &[f64]) -> Result<()> {
        self.0.check_numbers(gains)
    }

    fn at_work(
        &self,
        gains: &[f64],
        scenario: &Scenario,
        _record: bool,
    ) -> Result<Box<dyn Law<f64>>> {
        Ok(Box::new(PlannerLaw {
            planner: self.0.planner(gains, scenario)?,
            mass: scenario.robot.mass,
        }))
    }
}

impl<F: PlannerFamily<Planner: ScenePlanner>> LaneFamily for Planned<F> {
    const MIXES_GAINS: bool = false;
    const MOST_OBSTACLES: usize = 32;
    const DISCS_ONLY: bool = true;

    type Law<R: Real, const RECORD: bool> = LanePlanners<F::Planner>;

    fn with_gains<R: Real, const RECORD: bool>(
        &self,
        gains: &[R],
        scenario: &Scenario,
    ) -> Result<Self::Law<R, RECORD>> {
        let numbers: Vec<f64> = gains.iter().map(|gain| gain.lane(0)).collect();
        let planner = |_| self.0.planner(&numbers, scenario);
        Ok(LanePlanners {
            planners: (0..R::WIDTH).map(planner).collect::<Result<_>>()?,
            mass: scenario.robot.mass,
        })
    }

    fn enter<R: Real, const RECORD: bool>(
        &self,
        law: &mut Self::Law<R, RECORD>,
        lane: usize,
        gains: &[R],
        scenario: &Scenario,
    ) -> Result<()> {
        let numbers: Vec<f64> = gains.iter().map(|gain| gain.lane(lane)).collect();
        law.planners[lane] = self.0.planner(&numbers, scenario)?;
        Ok(())
    }
}

/// Words of a planner's numbers with values that break a rule.
fn above_zero_or_infinite(name: &str, value: f64) -> Result<()> {
    if value > 0.0 {
        return Ok(());
    }
    let rule = "be positive, or infinite";
    Err(Failure::invalid(name, rule, Given::Number(value)))
}

impl PlannerFamily for VelocityObstacle {
    type Planner = VelocityObstaclePlanner;

    fn number_names(&self) -> &'static [&'static str] {
        &["margin", "horizon", "risk_weight", "sector"]
    }

    fn numbers(&self) -> Vec<f64> {
        let (mut risk, mut sector) = (1.0, 1.0);
        match self.selection {
            Selection::ToGoal => {}
            Selection::Fastest { sector: own } => sector = own,
            Selection::TimeAndRisk { risk: own } => risk = own,
        }
        vec![self.margin, self.horizon, risk, sector]
    }

    fn check_numbers(&self, numbers: &[f64]) -> Result<()> {
        not_negative("margin", numbers[0])?;
        above_zero_or_infinite("horizon", numbers[1])?;
        not_negative("risk_weight", numbers[2])?;
        if !(0.0..=std::f64::consts::PI).contains(&numbers[3]) {
            let rule = "be an angle from 0 to pi";
            let given = Given::Number(numbers[3]);
            return Err(Failure::invalid("sector", rule, given));
        }
        Ok(())
    }

    fn planner(&self, numbers: &[f64], scenario: &Scenario) -> Result<VelocityObstaclePlanner> {
        let selection = match self.selection {
            Selection::ToGoal => Selection::ToGoal,
            Selection::Fastest { .. } => Selection::Fastest { sector: numbers[3] },
            Selection::TimeAndRisk { .. } => Selection::TimeAndRisk { risk: numbers[2] },
        };
        let settings = VelocityObstacle {
            margin: numbers[0],
            horizon: numbers[1],
            selection,
            ..*self
        };
        Ok(VelocityObstaclePlanner::new(settings, scenario))
    }
}

impl PlannerFamily for ReciprocalAvoidance {
    type Planner = ReciprocalPlanner;

    fn number_names(&self) -> &'static [&'static str] {
        &["horizon", "margin", "turn", "reach"]
    }

    fn numbers(&self) -> Vec<f64> {
        vec![self.horizon, self.margin, self.turn, self.reach]
    }

    fn check_numbers(&self, numbers: &[f64]) -> Result<()> {
        positive("horizon", numbers[0])?;
        not_negative("margin", numbers[1])?;
        not_negative("turn", numbers[2])?;
        positive("reach", numbers[3])?;
        Ok(())
    }

    fn planner(&self, numbers: &[f64], scenario: &Scenario) -> Result<ReciprocalPlanner> {
        let settings = ReciprocalAvoidance {
            horizon: numbers[0],
            margin: numbers[1],
            turn: numbers[2],
            reach: numbers[3],
            share: self.share,
        };
        Ok(ReciprocalPlanner::new(settings, scenario))
    }
}

impl FieldDStar {
    /// A planner with these numbers.
    fn of_numbers(numbers: &[f64]) -> Result<Self> {
        Self {
            resolution: numbers[0],
            margin: numbers[1],
            horizon: numbers[2],
            room: numbers[3],
            look_ahead: numbers[4],
        }
        .checked()
    }
}

impl PlannerFamily for FieldDStar {
    type Planner = FieldDStarPlanner;

    fn number_names(&self) -> &'static [&'static str] {
        &["resolution", "margin", "horizon", "room", "look_ahead"]
    }

    fn numbers(&self) -> Vec<f64> {
        vec![
            self.resolution,
            self.margin,
            self.horizon,
            self.room,
            self.look_ahead,
        ]
    }

    fn check_numbers(&self, numbers: &[f64]) -> Result<()> {
        Self::of_numbers(numbers).map(|_| ())
    }

    fn planner(&self, numbers: &[f64], scenario: &Scenario) -> Result<FieldDStarPlanner> {
        FieldDStarPlanner::new(Self::of_numbers(numbers)?, scenario)
    }
}

impl RapidlyExploringRandomTree {
    /// Planner with other numbers.
    fn with_numbers(self, numbers: &[f64]) -> Result<Self> {
        Self {
            step: numbers[0],
            goal_probability: numbers[1],
            waypoint_probability: numbers[2],
            margin: numbers[3],
            horizon: numbers[4],
            room: numbers[5],
            look_ahead: numbers[6],
            ..self
        }
        .checked()
    }
}

impl PlannerFamily for RapidlyExploringRandomTree {
    type Planner = TreePlanner;

    fn number_names(&self) -> &'static [&'static str] {
        &[
            "step",
            "goal_probability",
            "waypoint_probability",
            "margin",
            "horizon",
            "room",
            "look_ahead",
        ]
    }

    fn numbers(&self) -> Vec<f64> {
        vec![
            self.step,
            self.goal_probability,
            self.waypoint_probability,
            self.margin,
            self.horizon,
            self.room,
            self.look_ahead,
        ]
    }

    fn check_numbers(&self, numbers: &[f64]) -> Result<()> {
        self.with_numbers(numbers).map(|_| ())
    }

    fn planner(&self, numbers: &[f64], scenario: &Scenario) -> Result<TreePlanner> {
        TreePlanner::new(self.with_numbers(numbers)?, scenario)
    }
}
