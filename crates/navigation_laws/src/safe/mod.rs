//! Safe navigation: a law among walls and people with a way out of local minima, a velocity that
//! gives way, and a shield. It is itself a law.
//!
//! `wanted = law -> takeover -> yielding -> shield -> u`, `F = m (u - V)/T`. A wanted velocity that
//! every part keeps is the law's own command, bit for bit.

mod boundary;
mod foresight;
mod law;
mod plans;
mod settings;
mod surroundings;
mod watch;

pub use law::SafeLaw;
pub use plans::Plans;
pub use settings::SafeNavigation;

use crate::{FieldTerms, Law, LawFamily, Situation};
use navigation_world::world::map::StaticMap;
use navigation_world::world::scenario::Scenario;
use numeric::error::Result;

impl LawFamily for SafeNavigation {
    fn gain_names(&self) -> &'static [&'static str] {
        self.law.gain_names()
    }

    fn gains(&self) -> Vec<f64> {
        self.law.gains()
    }

    fn free_gains(&self) -> &'static [usize] {
        self.law.free_gains()
    }

    fn terms(&self, scenario: &Scenario, situation: &Situation<'_, f64>) -> Option<FieldTerms> {
        self.law.terms(scenario, situation)
    }

    fn chooses_velocities(&self) -> bool {
        self.foresight.is_some() || self.law.chooses_velocities()
    }

    fn map(&self) -> Option<&StaticMap> {
        self.map.as_ref().or_else(|| self.law.map())
    }

    fn scans(&self) -> bool {
        self.shield.is_some_and(|shield| shield.unseen.is_some())
    }

    fn takes_any_goal(&self) -> bool {
        // Whoever is pushed away makes no progress, and heads for the goal by himself.
        self.takeover || self.foresight.is_some() || self.law.takes_any_goal()
    }

    fn steers_by_velocity(&self) -> bool {
        let wheeled = self.filter.is_some_and(|filter| filter.is_for_wheels());
        self.shield.is_some() || wheeled || self.law.steers_by_velocity()
    }

    fn check_gains(&self, gains: &[f64]) -> Result<()> {
        self.law.check_gains(gains)
    }

    fn at_work(
        &self,
        gains: &[f64],
        scenario: &Scenario,
        record: bool,
    ) -> Result<Box<dyn Law<f64>>> {
        Ok(Box::new(SafeLaw::new(self, gains, scenario, record)?))
    }
}
