//! Search for somebody against whom a law breaks a property: many random pursuers, or the worst
//! one that CMA-ES finds.

use crate::run::as_built::AsBuilt;
use crate::run::pursuit::{Encounter, NUMBERS, Pursued, Pursuer, pursue};
use crate::run::{AnyLaw, Interrupted};
use box_search::{
    Bounds, Control, Evaluation, GlobalMethod, GlobalOptions, Observer, Problem, Report,
    SearchState, global_search,
};
use navigation_world::world::scenario::Scenario;
use numeric::error::{Failure, Result, positive};
use numeric::threads::{on_threads, try_map};

/// Property that is to hold; its margin is not negative where it does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Property {
    /// The robot never moves toward somebody whom it touches.
    NotAtFault,
    /// Surfaces never come nearer than so many m.
    Clearance(f64),
    /// The robot arrives within the time limit.
    Arrival,
    /// The robot is never faster than so many m/s.
    Speed(f64),
}

/// A margin in m for distances that never came about.
const FAR: f64 = 100.0;

impl Property {
    /// By how much the property holds, negative where it is broken; a contact at fault breaks it
    /// even where surfaces only touch.
    #[must_use]
    pub fn margin(&self, found: &Encounter) -> f64 {
        match self {
            Self::NotAtFault if found.at_fault() => found.least_toward.min(-1e-12),
            Self::NotAtFault => found.least_toward.min(FAR),
            Self::Clearance(least) => found.least.min(FAR) - least,
            Self::Arrival if found.arrival_time.is_nan() => -found.to_go,
            Self::Arrival => 1.0 / found.arrival_time,
            Self::Speed(most) => most - found.top_speed,
        }
    }
}

/// A robot under a law, and the bounds of who pursues it.
pub struct Falsification<'a> {
    /// Where; the pursuer takes the place of its last obstacle.
    pub scenario: &'a Scenario,
    /// Law that drives the robot.
    pub law: &'a AnyLaw,
    /// Robot as it is built.
    pub built: &'a AsBuilt,
    /// Largest speed of the pursuer in m/s.
    pub max_speed: f64,
    /// Least distance of his center from the robot at the start, in m.
    pub free: f64,
}

impl Falsification<'_> {
    fn ends(&self) -> [[f64; 2]; 2] {
        [self.scenario.start(), self.scenario.goal()]
    }

    /// A pursuer drawn from a seed.
    #[must_use]
    pub fn random(&self, seed: u64, index: u64) -> Pursuer {
        Pursuer::random(seed, index, self.ends(), self.free, self.max_speed)
    }

    /// The pursuer of a point of the search.
    #[must_use]
    pub fn planned(&self, numbers: &[f64; NUMBERS]) -> Pursuer {
        Pursuer::planned(numbers, self.ends(), self.free, self.max_speed)
    }

    /// One episode with noise of its own.
    ///
    /// # Errors
    /// Errors of [`pursue`].
    pub fn episode(
        &self,
        pursuer: &Pursuer,
        seed: u64,
        rows: Option<&mut Pursued>,
        interrupted: Interrupted<'_>,
    ) -> Result<Encounter> {
        positive("person_speed", self.max_speed)?;
        let scenario = self.scenario.clone().reseeded(seed);
        pursue(&scenario, self.law, self.built, pursuer, rows, interrupted)
    }

    /// Episodes against random pursuers.
    ///
    /// # Errors
    /// Errors of [`pursue`].
    pub fn sweep(
        &self,
        episodes: usize,
        seed: u64,
        threads: Option<usize>,
        interrupted: Interrupted<'_>,
        progress: &(dyn Fn(usize) + Sync),
    ) -> Result<Vec<Encounter>> {
        on_threads(threads, || {
            try_map(episodes, |index| {
                let index = index as u64;
                let pursuer = self.random(seed, index);
                let own = seed.wrapping_add(index);
                let found = self.episode(&pursuer, own, None, interrupted);
                progress(1);
                found
            })
        })
    }

    /// The worst pursuer that CMA-ES finds, and the margin against him.
    ///
    /// # Errors
    /// Errors of [`pursue`].
    pub fn worst(
        &self,
        property: Property,
        evaluations: u64,
        seed: u64,
        threads: Option<usize>,
        interrupted: Interrupted<'_>,
        progress: &(dyn Fn(usize) + Sync),
    ) -> Result<Option<([f64; NUMBERS], f64)>> {
        let wanted = Worst {
            hunt: self,
            property,
            seed,
            interrupted,
            progress,
        };
        let bounds = Bounds::new(vec![0.0; NUMBERS], vec![1.0; NUMBERS])?;
        let options = GlobalOptions {
            method: GlobalMethod::CmaEs,
            evaluations,
            islands: 1,
            seed,
            threads,
        };
        let found = global_search(&wanted, &bounds, &options, &wanted, None)?;
        if interrupted() {
            return Err(Failure::Interrupted);
        }
        Ok(found.best.and_then(|best| {
            let numbers = best.point.try_into().ok()?;
            Some((numbers, -best.score.value))
        }))
    }
}

/// The search for the least margin.
struct Worst<'a> {
    hunt: &'a Falsification<'a>,
    property: Property,
    seed: u64,
    interrupted: Interrupted<'a>,
    progress: &'a (dyn Fn(usize) + Sync),
}

impl Problem for Worst<'_> {
    fn dimension(&self) -> usize {
        NUMBERS
    }

    fn evaluate(&self, points: &[f64], into: &mut Evaluation<'_>) -> Result<()> {
        for (point, value) in points.chunks_exact(NUMBERS).zip(into.values.iter_mut()) {
            let numbers: [f64; NUMBERS] = std::array::from_fn(|axis| point[axis]);
            let pursuer = self.hunt.planned(&numbers);
            let found = self
                .hunt
                .episode(&pursuer, self.seed, None, self.interrupted)?;
            *value = -self.property.margin(&found);
            (self.progress)(1);
        }
        Ok(())
    }

    fn block(&self) -> usize {
        1
    }
}

impl Observer for Worst<'_> {
    fn report(&self, _report: &Report<'_>, _state: &dyn Fn() -> SearchState) -> Control {
        if (self.interrupted)() {
            Control::Stop
        } else {
            Control::Continue
        }
    }

    fn stopped(&self) -> bool {
        (self.interrupted)()
    }
}
