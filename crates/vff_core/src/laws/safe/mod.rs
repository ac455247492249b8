//! Safe navigation: a law among walls and people with a way out of local minima, a velocity that
//! gives way, and a shield. It is itself a law.
//!
//! `wanted = law -> takeover -> yielding -> shield -> u`, `F = m (u - V)/T`. A wanted velocity that
//! every part keeps is the law's own command, bit for bit.

mod boundary;
mod law;
mod plans;
mod settings;
mod surroundings;

pub use law::SafeLaw;
pub use plans::Plans;
pub use settings::SafeNavigation;

use crate::error::Result;
use crate::lanes::{Real, Vector2};
use crate::laws::trace::Trace;
use crate::laws::{Command, FieldTerms, Law, LawFamily, Situation};
use crate::world::map::StaticMap;
use crate::world::scenario::Scenario;

/// Robots side by side, each with a law and its parts.
pub struct SafeLanes(Vec<SafeLaw>);

impl<R: Real> Law<R> for SafeLanes {
    fn thinks(&self) -> bool {
        true
    }

    fn command(&mut self, situation: &Situation<'_, R>) -> Command<R> {
        let mut force = Vector2::<R>::zeros();
        let mut stabilizing = Vector2::<R>::zeros();
        let mut lyapunov = R::splat(f64::NAN);
        for (lane, law) in self.0.iter_mut().enumerate() {
            let command = law.command(&situation.of_lane(lane));
            let put = |target: &mut Vector2<R>, vector: Vector2<f64>| {
                target.x = target.x.replace(lane, vector.x);
                target.y = target.y.replace(lane, vector.y);
            };
            put(&mut force, command.force);
            put(&mut stabilizing, command.stabilizing);
            lyapunov = lyapunov.replace(lane, command.lyapunov);
        }
        Command {
            force,
            stabilizing,
            lyapunov,
        }
    }

    fn aim(&mut self, goal: [f64; 2]) {
        for law in &mut self.0 {
            law.aim(goal);
        }
    }

    fn trace(&self) -> Option<Trace> {
        self.0.first().map(|law| *law.trace())
    }
}

impl LawFamily for SafeNavigation {
    type Law<R: Real, const RECORD: bool> = SafeLanes;

    fn gain_names(&self) -> &'static [&'static str] {
        self.law.gain_names()
    }

    fn gains(&self) -> Vec<f64> {
        self.law.gains()
    }

    fn free_gains(&self) -> &'static [usize] {
        self.law.erased().free_gains()
    }

    fn terms(&self, scenario: &Scenario, situation: &Situation<'_, f64>) -> Option<FieldTerms> {
        self.law.erased().terms(scenario, situation)
    }

    fn chooses_velocities(&self) -> bool {
        self.law.erased().chooses_velocities()
    }

    fn map(&self) -> Option<&StaticMap> {
        self.map.as_ref().or_else(|| self.law.erased().map())
    }

    fn takes_any_goal(&self) -> bool {
        // Whoever is pushed away makes no progress, and heads for the goal by himself.
        self.takeover || self.law.erased().takes_any_goal()
    }

    fn steers_by_velocity(&self) -> bool {
        self.shield.is_some()
    }

    fn check_gains(&self, gains: &[f64]) -> Result<()> {
        self.law.erased().check_gains(gains)
    }

    fn with_gains<R: Real, const RECORD: bool>(
        &self,
        gains: &[R],
        scenario: &Scenario,
    ) -> Result<SafeLanes> {
        let of_lane = |lane| {
            let gains: Vec<f64> = gains.iter().map(|gain| gain.lane(lane)).collect();
            SafeLaw::new(self, &gains, scenario, RECORD)
        };
        Ok(SafeLanes(
            (0..R::WIDTH).map(of_lane).collect::<Result<_>>()?,
        ))
    }
}
