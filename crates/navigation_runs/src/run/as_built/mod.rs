//! Robots as built: a law that sees what is measured, and wheels that do what they can.
//!
//! A law is asked once a control period, as in [`super::simulate`]; between two samples the robot
//! moves as a point mass, on wheels with controllers of their own, or as a two-wheel robot that
//! follows the point mass which the law drives. With ideal motion and exact sensing a run is that
//! of [`super::simulate`], bit for bit.

pub(super) mod history;
mod many;
mod run;
pub(crate) mod sight;

pub use history::AsBuiltTrajectory;
pub use many::{Histories, ManyOptions, ManyRuns, run_many_as_built};
pub use navigation_world::robots::drives::{PoseFusion, SteeringLaw};
pub(super) use run::clock_of;
pub(crate) use run::robot_under;
pub use run::{evaluate_as_built, simulate_as_built};

use crate::run::any_law::AnyLaw;
use navigation_world::robots::drives::Start;
use navigation_world::robots::wheels::{OmniKinematics, Slip, WheelDrive};
use navigation_world::sensing::SensorOptions;
use navigation_world::world::scenario::Scenario;
use numeric::error::{Failure, Given, Result, positive};

/// How a robot is built, beside what its scenario says.
#[derive(Clone, Debug, PartialEq)]
pub struct AsBuilt {
    /// Motion step in s, at which a two-wheel robot is also steered.
    pub step: f64,
    /// End the run at the first contact.
    pub stop_on_contact: bool,
    /// Wheels with controllers, as many as the robot has; ideal ones otherwise.
    pub wheels: Option<Vec<WheelDrive>>,
    /// Kinematics of the wheels of a holonomic robot.
    pub omni: OmniKinematics,
    /// Slip of wheels with controllers.
    pub slip: Slip,
    /// How a two-wheel robot is steered.
    pub steering_law: SteeringLaw,
    /// Sensors. What one of them tells of, the robot or the obstacles, is known by sensors alone;
    /// what none tells of is known exactly.
    pub sensors: Vec<SensorOptions>,
    /// How far a measured pose corrects the one from the wheels.
    pub fusion: PoseFusion,
}

impl Default for AsBuilt {
    /// Ideal wheels, and what the scenario measures.
    fn default() -> Self {
        Self {
            step: 0.01,
            stop_on_contact: false,
            wheels: None,
            omni: OmniKinematics::default(),
            slip: Slip::default(),
            steering_law: SteeringLaw::default(),
            sensors: Vec::new(),
            fusion: PoseFusion::default(),
        }
    }
}

impl AsBuilt {
    /// Returns the options if they suit a scenario.
    ///
    /// # Errors
    /// The step is not positive, the number of wheels is not that of the robot, or both cameras and
    /// a measurement are given.
    fn suiting(&self, scenario: &Scenario) -> Result<&Self> {
        positive("step", self.step)?;
        let driven = if scenario.differential.is_some() {
            2
        } else {
            3
        };
        if let Some(wheels) = self.wheels.as_ref().filter(|wheels| wheels.len() != driven) {
            let rule = "hold one wheel for each of the robot: 3 of a holonomic one, 2 of the other";
            let given = Given::Count(wheels.len() as u64);
            return Err(Failure::invalid("wheels", rule, given));
        }
        if self.sensors.iter().any(SensorOptions::is_camera) && scenario.measurement.is_some() {
            let rule = "be None where a camera measures";
            let given = Given::Found("a Measurement".into());
            return Err(Failure::invalid("measurement", rule, given));
        }
        Ok(self)
    }

    /// Where a run of the robot starts.
    pub(crate) fn start_in(&self, scenario: &Scenario) -> Start {
        Start {
            point: scenario.robot,
            position: scenario.start,
            heading: scenario.rules.heading,
            goal: scenario.goal,
            step: self.step,
            period: scenario.rules.control_period,
        }
    }

    /// Copy without errors of measurement; a law that makes its own map of scans keeps lidars that see nothing.
    fn seeing_all(&self, law: &AnyLaw) -> Self {
        let blind = |sensor: &SensorOptions| match sensor {
            SensorOptions::Lidar(lidar) if law.maps_its_scans() => {
                Some(SensorOptions::Lidar(lidar.ideal_without_map()))
            }
            _ => None,
        };
        Self {
            sensors: self.sensors.iter().filter_map(blind).collect(),
            ..self.clone()
        }
    }
}
