//! A robot that walks as a person of a model does, on its way to the goal.

use crate::crowd::agent::{Agent, FIRST_ROBOT, direction_of};
use crate::crowd::models::Model;
use crate::crowd::neighbors::grid::Period;
use crate::crowd::pedestrian::{Groupings, PersonDecision, Walker};
use crate::crowd::snapshot::{CrowdSetting, Models, Snapshot};
use crate::crowd::walls::Wall;
use navigation_laws::{Command, Law, LawFamily, Situation, force_toward};
use navigation_world::arguments::{Arguments, Named};
use navigation_world::world::geometry::Body;
use navigation_world::world::obstacle::Shape;
use navigation_world::world::scenario::Scenario;
use navigation_world::world::shape::PlacedShape;
use numeric::error::{Failure, Given, Result, positive};
use numeric::lanes::Vector2;

/// The law: others push as people push each other, by a weight; walls push as they do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SocialForce {
    /// The model.
    pub model: Model,
    /// Weight of people.
    pub people_weight: f64,
    /// Desired speed as a share of the largest one.
    pub speed_share: f64,
}

impl Named for SocialForce {
    const NAME: &'static str = "social_force";

    fn made_of(given: &dyn Arguments) -> Result<Self> {
        let law = Self {
            people_weight: given.number("people_weight")?,
            speed_share: given.number("speed_share")?,
            model: Model::named(&given.word("model")?, given)?,
        };
        law.check_gains(&law.gains())?;
        Ok(law)
    }
}

impl LawFamily for SocialForce {
    fn gain_names(&self) -> &'static [&'static str] {
        &["people_weight", "speed_share"]
    }

    fn gains(&self) -> Vec<f64> {
        vec![self.people_weight, self.speed_share]
    }

    fn free_gains(&self) -> &'static [usize] {
        &[0, 1]
    }

    fn chooses_velocities(&self) -> bool {
        true
    }

    fn check_gains(&self, gains: &[f64]) -> Result<()> {
        positive("people_weight", gains[0])?;
        if positive("speed_share", gains[1])? > 1.0 {
            let rule = "be positive and at most 1";
            return Err(Failure::invalid(
                "speed_share",
                rule,
                Given::Number(gains[1]),
            ));
        }
        Ok(())
    }

    fn at_work(
        &self,
        gains: &[f64],
        scenario: &Scenario,
        _record: bool,
    ) -> Result<Box<dyn Law<f64>>> {
        let tuned = Self {
            people_weight: gains[0],
            speed_share: gains[1],
            ..*self
        };
        Ok(Box::new(RobotAsPerson::new(tuned, scenario)))
    }
}

/// The law at work on one robot.
struct RobotAsPerson {
    law: SocialForce,
    goal: Vector2<f64>,
    mass: f64,
    radius: f64,
    max_speed: f64,
    /// Direction in which it walked last, of models that keep it.
    heading: Vector2<f64>,
    others: Vec<Agent>,
    walls: Vec<Wall>,
    snapshot: Snapshot,
    decisions: Vec<PersonDecision>,
}

impl RobotAsPerson {
    fn new(law: SocialForce, scenario: &Scenario) -> Self {
        let goal = Vector2::from(scenario.goal);
        Self {
            law,
            goal,
            mass: scenario.robot.mass,
            radius: scenario.robot.radius,
            max_speed: scenario.robot.max_speed,
            heading: direction_of(goal - Vector2::from(scenario.start)),
            others: Vec::new(),
            walls: Vec::new(),
            snapshot: Snapshot::default(),
            decisions: Vec::new(),
        }
    }

    /// Others and walls: what has edges and points of walls that stand are walls.
    #[allow(clippy::cast_possible_truncation)] // far fewer bodies than numbers
    fn look(&mut self, bodies: &[Body]) {
        self.others.clear();
        self.walls.clear();
        for (index, body) in bodies.iter().enumerate() {
            if !body.state.present {
                continue;
            }
            let (position, velocity) = (body.state.position.into(), body.state.velocity.into());
            match body.shape {
                Shape::Disc { radius } if radius > 0.0 => self.others.push(Agent {
                    position,
                    velocity,
                    direction: direction_of(velocity),
                    radius,
                    number: FIRST_ROBOT + index as u32,
                }),
                shape => self.walls.push(Wall::Solid(PlacedShape {
                    center: position,
                    shape,
                })),
            }
        }
    }

    /// The velocity in m/s that the model asks for.
    fn wanted(&mut self, situation: &Situation<'_, f64>) -> Vector2<f64> {
        let SocialForce {
            model,
            people_weight,
            speed_share,
        } = self.law;
        let robot = &situation.robot;
        let way = self.goal - robot.position;
        let own = Walker {
            agent: Agent {
                position: robot.position,
                velocity: robot.velocity,
                direction: direction_of(way),
                radius: self.radius,
                number: 0,
            },
            desired_speed: speed_share * self.max_speed,
            decides: true,
            to_go: way.norm(),
            stays: way == Vector2::zeros(),
            heading: self.heading,
            awareness: people_weight,
        };
        let (period, step) = (Period::default(), situation.interval);
        let setting = CrowdSetting {
            walls: &self.walls,
            company: &Groupings {
                agents: &[],
                of: &[],
                period,
            },
            period,
            reach: model.cutoff(),
            step,
        };
        let people = (1, |_: usize| Some(own));
        let models = Models::Shared(&model);
        let decisions = &mut self.decisions;
        self.snapshot
            .decide(&setting, people, &self.others, models, decisions);
        let decision = decisions[0];
        self.heading = decision.heading;
        let velocity = if model.is_force() {
            robot.velocity + decision.order * step
        } else {
            decision.order
        };
        let speed = velocity.norm();
        if speed > self.max_speed {
            velocity * (self.max_speed / speed)
        } else {
            velocity
        }
    }
}

impl Law<f64> for RobotAsPerson {
    fn thinks(&self) -> bool {
        true
    }

    fn command(&mut self, situation: &Situation<'_, f64>) -> Command<f64> {
        self.look(situation.bodies);
        let wanted = self.wanted(situation);
        Command::plain(force_toward(wanted, situation, self.mass))
    }

    fn aim(&mut self, goal: [f64; 2]) {
        self.goal = goal.into();
    }
}
