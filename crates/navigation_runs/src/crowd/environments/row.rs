//! One environment of many, with the rows of the arrays that its results are written to.

use crate::crowd::environments::one::{Environment, Shared, State};
use crate::crowd::environments::settings::{Autoreset, EnvironmentSettings};
use crate::crowd::metrics::{ROBOT_METRICS, RobotMetrics};
use numeric::error::Result;

/// Numbers of a row of metrics.
pub(super) const METRICS: usize = ROBOT_METRICS.len();

/// The results of one environment.
pub(super) struct Row<'a> {
    pub environment: &'a mut Environment,
    pub observation: &'a mut [f32],
    pub final_observation: &'a mut [f32],
    pub seen: &'a mut [i64; 2],
    pub reward: &'a mut f64,
    pub state: &'a mut u8,
    pub started: &'a mut bool,
    pub clearance: &'a mut f64,
    pub wall_rescues: &'a mut i64,
    pub metrics: &'a mut [f64; METRICS],
}

impl Row<'_> {
    pub fn show(&mut self, settings: &EnvironmentSettings, shared: &mut Shared) {
        let seen = self.environment.observe(settings, shared, self.observation);
        self.seen[0] = count(seen);
        *self.state = self.environment.state().code();
        *self.wall_rescues = self.rescues();
    }

    fn rescues(&self) -> i64 {
        let rescues = self.environment.simulation().wall_rescues();
        rescues.try_into().unwrap_or(i64::MAX)
    }

    /// Starts the next episode where one has ended in the step before; else tells the robot what to do. Whether
    /// the world is to be moved.
    pub fn begin(
        &mut self,
        settings: &EnvironmentSettings,
        action: [f64; 2],
        shared: &mut Shared,
    ) -> Result<bool> {
        *self.started = false;
        if self.environment.state() == State::Running {
            self.environment.begin(settings, action);
            return Ok(true);
        }
        self.environment.reset(settings, None)?;
        self.show(settings, shared);
        (*self.reward, *self.clearance) = (0.0, f64::INFINITY);
        *self.started = true;
        Ok(false)
    }

    /// Writes what the step has brought.
    pub fn end(&mut self, settings: &EnvironmentSettings, shared: &mut Shared) -> Result<()> {
        let step = self.environment.end(settings);
        let rescues = self.rescues();
        (*self.reward, *self.clearance) = (step.reward, step.clearance);
        if step.state != State::Running {
            if let Some(found) = self.environment.metrics(settings) {
                *self.metrics = RobotMetrics::into_array(found);
            }
            if settings.autoreset == Autoreset::SameStep {
                let last = &mut *self.final_observation;
                let seen = self.environment.observe(settings, shared, last);
                self.seen[1] = count(seen);
                self.environment.reset(settings, None)?;
                *self.started = true;
            }
        }
        self.show(settings, shared);
        (*self.state, *self.wall_rescues) = (step.state.code(), rescues);
        Ok(())
    }
}

/// A number of people as arrays have it.
fn count(people: usize) -> i64 {
    people.try_into().unwrap_or(i64::MAX)
}
