//! Virtual impedance as a navigation law.

use crate::impedance::attraction::Attraction;
use crate::impedance::law::{Form, Impedance, Prepared};
use crate::{Command, Law, LawFamily, Situation};
use navigation_world::arguments::{Arguments, Named};
use navigation_world::world::geometry::RobotState;
use navigation_world::world::scenario::{PlacedObstacle, Scenario};
use numeric::error::Result;
use numeric::lanes::Vector2;

/// Numbers that a search may choose, in their order.
const GAIN_NAMES: [&str; 6] = [
    "attraction_stiffness",
    "attraction_damping",
    "stiffness",
    "damping",
    "safe_distance",
    "speed_limit",
];

/// A robot slower than this has no direction of motion, in m/s; that of the source's follower.
const STANDING: f64 = 0.02;

/// Distance of surfaces that touch or overlap, in m: the force needs a direction.
const TOUCHING: f64 = 1e-9;

/// The law: attraction to the goal and a collision vector from the robot's surface to the nearest
/// point of every obstacle within reach and view.
#[derive(Clone, Copy, Debug)]
pub struct ImpedanceFamily {
    /// Repulsion.
    pub impedance: Impedance,
    /// Attraction; the target is the goal itself.
    pub attraction: Attraction,
    /// Obstacles whose surface is farther away are not sensed, in m.
    pub reach: f64,
    /// Half of the sector around the direction of motion that is sensed, in rad.
    pub view: f64,
}

impl ImpedanceFamily {
    /// Law with other gains; ratios of the reference coefficients stay.
    fn with(&self, gains: &[f64]) -> Result<Self> {
        let own = &self.impedance;
        let impedance = Impedance {
            stiffness: gains[2],
            damping: gains[3],
            safe_distance: gains[4],
            speed_limit: gains[5],
            reference_stiffness: own.reference_stiffness / own.stiffness * gains[2],
            reference_damping: own.reference_damping / own.damping * gains[3],
            ..*own
        };
        let attraction = Attraction {
            stiffness: gains[0],
            damping: gains[1],
            standoff: 0.0,
        };
        Ok(Self {
            impedance: impedance.checked()?,
            attraction: attraction.checked()?,
            ..*self
        })
    }
}

impl Named for ImpedanceFamily {
    const NAME: &'static str = "virtual_impedance";

    fn made_of(given: &dyn Arguments) -> Result<Self> {
        let (stiffness, damping) = (given.number("stiffness")?, given.number("damping")?);
        let impedance = Impedance {
            form: if given.flag("active")? {
                Form::Active
            } else {
                Form::Conventional
            },
            stiffness,
            damping,
            safe_distance: given.number("safe_distance")?,
            speed_limit: given.number("speed_limit")?,
            reference_stiffness: std::f64::consts::E * stiffness,
            reference_damping: damping / std::f64::consts::E,
            clamp: true,
        };
        let attraction = Attraction {
            stiffness: given.number("attraction_stiffness")?,
            damping: given.number("attraction_damping")?,
            standoff: 0.0,
        };
        Ok(Self {
            impedance,
            attraction,
            reach: given.number("reach")?,
            view: given.number("view")?,
        })
    }
}

impl LawFamily for ImpedanceFamily {
    fn gain_names(&self) -> &'static [&'static str] {
        &GAIN_NAMES
    }

    fn gains(&self) -> Vec<f64> {
        let law = &self.impedance;
        vec![
            self.attraction.stiffness,
            self.attraction.damping,
            law.stiffness,
            law.damping,
            law.safe_distance,
            law.speed_limit,
        ]
    }

    fn free_gains(&self) -> &'static [usize] {
        &[0, 1]
    }

    fn check_gains(&self, gains: &[f64]) -> Result<()> {
        self.with(gains).map(|_| ())
    }

    fn at_work(
        &self,
        gains: &[f64],
        scenario: &Scenario,
        _record: bool,
    ) -> Result<Box<dyn Law<f64>>> {
        let law = self.with(gains)?;
        Ok(Box::new(ImpedanceLaw {
            repulsion: law.impedance.prepared(),
            attraction: law.attraction,
            goal: scenario.goal().into(),
            robot_radius: scenario.point_mass().radius,
            reach: self.reach,
            least_cosine: self.view.cos(),
        }))
    }
}

/// The law at work in one scenario.
pub struct ImpedanceLaw {
    repulsion: Prepared,
    attraction: Attraction,
    goal: Vector2<f64>,
    robot_radius: f64,
    reach: f64,
    /// Cosine of half the sector that is sensed.
    least_cosine: f64,
}

impl ImpedanceLaw {
    /// Force in N.
    fn force(&self, situation: &Situation<'_, f64>) -> Vector2<f64> {
        let RobotState { position, velocity } = situation.robot;
        let offset = self.goal - position;
        let pull = self.attraction.force(offset, velocity);
        // A robot that stands looks to where it is going.
        let speed = velocity.x.hypot(velocity.y);
        let ahead = if speed > STANDING { velocity } else { offset };
        let length = ahead.x.hypot(ahead.y);
        let push = self
            .repulsion
            .force_of_points(situation.bodies.iter().filter_map(|body| {
                let from_obstacle = body.offset(position);
                let distance = from_obstacle.distance_squared.sqrt();
                let contact = self.robot_radius + body.shape.inner_radius();
                let gap = (distance - contact).max(TOUCHING);
                if !body.state.present || gap > self.reach || distance == 0.0 {
                    return None;
                }
                let away = from_obstacle.vector;
                if -away.dot(&ahead) < self.least_cosine * distance * length {
                    return None;
                }
                let moving = Vector2::from(body.state.velocity);
                Some((-away * (gap / distance), moving - velocity))
            }));
        pull + push
    }
}

impl Law<f64> for ImpedanceLaw {
    fn command(&mut self, situation: &Situation<'_, f64>) -> Command<f64> {
        Command::plain(self.force(situation))
    }

    fn felt_within(&self, obstacle: &PlacedObstacle) -> f64 {
        obstacle.contact_distance + self.reach
    }

    fn aim(&mut self, goal: [f64; 2]) {
        self.goal = Vector2::from(goal);
    }
}
