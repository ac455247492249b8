//! How a run is integrated.

use navigation_world::world::scenario::Scenario;
use numeric::error::{Failure, Given, Result, positive};

/// Largest number of motion steps of one run.
const MAX_STEPS: f64 = 1e8;

/// Largest deviation of a control period from a whole number of steps, relative.
const WHOLE_STEPS: f64 = 1e-9;

/// Motion integrator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Integrator {
    /// Velocity first, then position with the new velocity.
    SemiImplicitEuler,
    /// Runge-Kutta of order 4, the speed limit applied in every stage.
    Rk4,
}

/// Options of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Integrator.
    pub integrator: Integrator,
    /// Motion step in s.
    pub step: f64,
    /// The force is computed every control period and held; otherwise at every step or stage.
    pub hold: bool,
    /// End the run at the first contact.
    pub stop_on_contact: bool,
    /// Rows and columns of a recorded run.
    pub kept: Kept,
}

impl Default for Options {
    fn default() -> Self {
        let integrator = Integrator::SemiImplicitEuler;
        Self {
            integrator,
            step: 0.01,
            hold: true,
            stop_on_contact: false,
            kept: Kept::default(),
        }
    }
}

/// Rows and columns that a recorded run keeps, besides time, position and velocity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kept {
    /// Every so many motion steps, from the start on; the end is kept always.
    pub every: usize,
    /// Which of [`Kept::COLUMNS`].
    columns: [bool; Kept::COLUMNS.len()],
}

impl Kept {
    /// Columns that may be left out.
    pub const COLUMNS: [&'static str; 6] = [
        "force",
        "stabilizing",
        "lyapunov",
        "wheel_current",
        "obstacle_position",
        "distance",
    ];

    /// Every so many rows, and the columns of some names.
    ///
    /// # Errors
    /// No row is kept, or there is no such column.
    pub fn new(every: usize, names: &[String]) -> Result<Self> {
        if every == 0 {
            return Err(Failure::invalid("every", "be positive", Given::Count(0)));
        }
        if let Some(unknown) = names.iter().find(|name| !Self::COLUMNS.contains(&&***name)) {
            let rule = format!("be among {}", Self::COLUMNS.join(", "));
            return Err(Failure::invalid(
                "record",
                rule,
                Given::Word(unknown.clone()),
            ));
        }
        let columns = Self::COLUMNS.map(|column| names.iter().any(|name| name == column));
        Ok(Self { every, columns })
    }

    /// Whether a column is kept.
    pub(crate) fn has(&self, name: &str) -> bool {
        let place = Self::COLUMNS.iter().position(|column| *column == name);
        place.is_some_and(|place| self.columns[place])
    }
}

impl Default for Kept {
    /// Keeps every column of every row.
    fn default() -> Self {
        Self {
            every: 1,
            columns: [true; Self::COLUMNS.len()],
        }
    }
}

/// Steps of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clock {
    /// Motion step in s.
    pub step: f64,
    /// Steps between two samples of the force.
    pub steps_per_sample: usize,
    /// Steps in all.
    pub steps: usize,
    /// Time between two samples of the force, in s.
    pub interval: f64,
}

impl Clock {
    /// Time after a number of steps, in s.
    #[inline(always)]
    pub fn time(&self, steps: usize) -> f64 {
        steps as f64 * self.step
    }
}

impl Options {
    /// Whether the law is asked at every stage of a motion step.
    pub(crate) fn is_staged(&self) -> bool {
        self.integrator == Integrator::Rk4 && !self.hold
    }

    /// Steps for a scenario.
    pub(crate) fn clock(&self, scenario: &Scenario) -> Result<Clock> {
        let step = positive("step", self.step)?;
        let period = scenario.rules.control_period;
        let count = (scenario.rules.time_limit / step - WHOLE_STEPS).ceil();
        if count > MAX_STEPS {
            let rule = "be so long that the time limit is at most 1e8 steps";
            return Err(Failure::invalid("step", rule, Given::Number(step)));
        }
        let (mut steps_per_sample, mut interval) = (1, step);
        if self.hold {
            let whole = (period / step).round();
            if whole < 1.0 || (whole * step - period).abs() > WHOLE_STEPS * period {
                let rule = "divide the control period when the force is held";
                return Err(Failure::invalid("step", rule, Given::Number(step)));
            }
            (steps_per_sample, interval) = (count_of(whole), period);
        } else if scenario.measurement.is_some() {
            let rule = "be true with a measurement, which is taken every control period";
            return Err(Failure::invalid("hold", rule, Given::Found("False".into())));
        }
        Ok(Clock {
            step,
            steps_per_sample,
            steps: count_of(count).max(1),
            interval,
        })
    }
}

/// A checked, whole, not negative number as a count.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at most MAX_STEPS or a period
fn count_of(whole: f64) -> usize {
    whole as usize
}
