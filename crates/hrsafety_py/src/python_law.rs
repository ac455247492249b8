//! A law that is written in Python: it runs under the interpreter, in the thread of its caller.

use std::cell::RefCell;
use std::sync::Arc;

use numeric::error::{Failure, Given, Result};
use pyo3::prelude::*;
use vff_core::lanes::{Planar, Vector2};
use vff_core::laws::{Command, Law, LawFamily, Situation, force_toward};
use vff_core::robots::HolonomicRobot;
use vff_core::robots::differential::Twist;
use vff_core::robots::drives::velocity_of;
use vff_core::world::scenario::Scenario;

use crate::run::situation::situation_fields;

thread_local! {
    /// Error that a law raised; the core knows of it only that the force is not a number.
    static RAISED: RefCell<Option<PyErr>> = const { RefCell::new(None) };
}

/// Takes what a law raised in this thread.
pub fn raised() -> Option<PyErr> {
    RAISED.take()
}

/// The kernels take gain sets one after the other, so it has one number, which nobody reads.
const NUMBERS: [&str; 1] = ["none"];

/// Kind of the answers of a law.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Answer {
    /// A force in N.
    Force,
    /// A velocity in m/s.
    Velocity,
    /// Speed ahead in m/s and turn rate in rad/s.
    Twist,
}

/// The law: a callable that begins an episode and returns one that is asked in every period.
pub struct PythonLaw {
    /// Takes robot, start, goal and seed.
    pub begin: Arc<Py<PyAny>>,
    /// Kind of its answers.
    pub answer: Answer,
}

impl LawFamily for PythonLaw {
    fn gain_names(&self) -> &'static [&'static str] {
        &NUMBERS
    }

    fn gains(&self) -> Vec<f64> {
        vec![0.0]
    }

    fn free_gains(&self) -> &'static [usize] {
        &[0]
    }

    fn takes_any_goal(&self) -> bool {
        true
    }

    fn steers_by_velocity(&self) -> bool {
        self.answer == Answer::Twist
    }

    fn check_gains(&self, _gains: &[f64]) -> Result<()> {
        Ok(())
    }

    fn at_work(
        &self,
        _gains: &[f64],
        scenario: &Scenario,
        _record: bool,
    ) -> Result<Box<dyn Law<f64>>> {
        if self.answer == Answer::Twist && scenario.differential.is_none() {
            let rule = "have two wheels under a law that answers twists";
            let given = Given::Found("a robot without them".into());
            return Err(Failure::invalid("robot", rule, given));
        }
        Ok(Box::new(AtWork {
            begin: Arc::clone(&self.begin),
            asked: None,
            answer: self.answer,
            robot: point_mass(scenario.point_mass()),
            ends: (scenario.start(), scenario.goal()),
            aim: None,
            seed: scenario.seed(),
        }))
    }
}

/// Mass, radius, largest speed, acceleration and deceleration of a point mass.
pub type PointMass = (f64, f64, f64, f64, f64);

/// The point mass that a law drives.
pub fn point_mass(robot: &HolonomicRobot) -> PointMass {
    (
        robot.mass,
        robot.radius,
        robot.max_speed,
        robot.max_acceleration,
        robot.deceleration(),
    )
}

/// The law at work in one scenario.
pub struct AtWork {
    begin: Arc<Py<PyAny>>,
    /// Law under the interpreter, from its first command on.
    asked: Option<Py<PyAny>>,
    answer: Answer,
    robot: PointMass,
    ends: ([f64; 2], [f64; 2]),
    /// Local goal on the way, in m, where a guide gives one.
    aim: Option<[f64; 2]>,
    seed: u64,
}

impl AtWork {
    fn answered(&mut self, situation: &Situation<'_, f64>) -> PyResult<[f64; 2]> {
        let aim = self.aim;
        Python::attach(|py| {
            let fields = situation_fields(py, situation)?;
            let slot = &mut self.asked;
            let asked = if let Some(asked) = slot {
                asked
            } else {
                let (start, goal) = self.ends;
                let arguments = (self.robot, start, goal, self.seed);
                slot.insert(self.begin.call1(py, arguments)?)
            };
            asked.call1(py, (fields, aim))?.extract(py)
        })
    }

    fn force(&mut self, situation: &Situation<'_, f64>) -> [f64; 2] {
        // After an error the run is over, and the interpreter is left alone.
        if RAISED.with_borrow(Option::is_some) {
            return [f64::NAN; 2];
        }
        let answer = match self.answered(situation) {
            Ok(answer) => answer,
            Err(error) => {
                RAISED.set(Some(error));
                return [f64::NAN; 2];
            }
        };
        let velocity = match self.answer {
            Answer::Force => return answer,
            Answer::Velocity => Vector2::splat(answer),
            Answer::Twist => {
                let [speed, turn_rate] = answer;
                let twist = Twist { speed, turn_rate };
                velocity_of(twist, situation.heading, situation.interval)
            }
        };
        let (mass, ..) = self.robot;
        force_toward(velocity, situation, mass).lane(0)
    }
}

impl Law<f64> for AtWork {
    fn thinks(&self) -> bool {
        true
    }

    fn command(&mut self, situation: &Situation<'_, f64>) -> Command<f64> {
        Command::plain(self.force(situation).into())
    }

    fn aim(&mut self, goal: [f64; 2]) {
        self.aim = Some(goal);
    }
}
