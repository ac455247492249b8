//! The avoidance test: eight directions, several times each, in many random layouts.

use crate::run::Interrupted;
use crate::run::skirt::robot::{Skirt, SkirtResult, SkirtTravel, run, steps_of};
use crate::run::skirt::scene::{DiscScene, DiscSceneOptions};
use navigation_laws::escape::Direction;
use numeric::error::{Failure, Given, Result};

use numeric::parallel::{Work, each_run};
use numeric::random::Stream;

/// Most runs of a batch: memory for their rows is asked for at once.
const MOST_RUNS: usize = 10_000_000;

/// Most steps of a run, so that it ends.
const MOST_STEPS: usize = 10_000_000;

/// The tests that are made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TestPlan {
    /// How often all directions are tested.
    pub layouts: usize,
    /// Tests of each direction in each of them, every one with discs of its own.
    pub repeats: usize,
    /// How discs are laid out.
    pub scene: DiscSceneOptions,
    /// How the robot moves.
    pub motion: SkirtTravel,
    /// Seed of discs and noise.
    pub seed: u64,
}

/// One test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TestRow {
    /// Result.
    pub course: SkirtResult,
    /// Whether the sensors could see the disc that was the nearest.
    pub nearest_seen: bool,
}

impl TestPlan {
    /// Number of tests.
    #[must_use]
    pub fn runs(&self) -> usize {
        self.layouts
            .saturating_mul(self.repeats)
            .saturating_mul(Direction::ALL.len())
    }

    /// Direction of escape of a test; tests of a direction follow each other.
    #[must_use]
    pub fn direction(&self, index: usize) -> Direction {
        Direction::ALL[index / self.repeats.max(1) % Direction::ALL.len()]
    }

    /// Returns the plan if it can be carried out with a skirt.
    ///
    /// # Errors
    /// A number is out of range.
    pub fn checked(self, skirt: &Skirt) -> Result<Self> {
        for (name, count) in [("layouts", self.layouts), ("repeats", self.repeats)] {
            if count == 0 {
                return Err(Failure::invalid(name, "be at least 1", Given::Count(0)));
            }
        }
        if self.runs() > MOST_RUNS {
            let given = Given::Count(self.layouts as u64);
            let rule = "lead to at most ten million tests";
            return Err(Failure::invalid("layouts", rule, given));
        }
        self.motion.checked()?;
        if steps_of(self.motion.duration, skirt.options().firing_period) > MOST_STEPS {
            let given = Given::Number(self.motion.duration);
            let rule = "be at most ten million firing periods";
            return Err(Failure::invalid("duration", rule, given));
        }
        self.scene.checked(skirt.ring().chassis_radius())?;
        Ok(self)
    }

    /// Course of a test in rad, its discs, and its noise. Discs do not depend on skirt, motion and
    /// noise, so that tests of two skirts on the same chassis can be compared one by one.
    ///
    /// # Errors
    /// There is no room for the discs.
    pub fn test(&self, skirt: &Skirt, index: usize) -> Result<(f64, DiscScene, Stream)> {
        // The robot comes from the side that it is to escape to.
        let course = self.direction(index).angle() + std::f64::consts::PI;
        let stream = 2 * index as u64;
        let chassis = skirt.ring().chassis_radius();
        let mut draws = Stream::new(self.seed, stream);
        let scene = DiscScene::draw(&self.scene, chassis, course, &mut draws)?;
        Ok((course, scene, Stream::new(self.seed, stream + 1)))
    }

    /// Runs one test.
    ///
    /// # Errors
    /// There is no room for the discs, the state became non-finite, or the caller asked to stop.
    pub fn run(
        &self,
        skirt: &Skirt,
        index: usize,
        interrupted: Interrupted<'_>,
    ) -> Result<TestRow> {
        let (course, scene, noise) = self.test(skirt, index)?;
        let start = (course, noise);
        let course = run(skirt, &self.motion, &scene, start, |_| (), interrupted)?;
        let nearest_seen = scene.seen.get(course.nearest).copied().unwrap_or(true);
        Ok(TestRow {
            course,
            nearest_seen,
        })
    }
}

/// Rows of all tests: layouts, directions within them, repeats within those.
///
/// # Errors
/// The plan cannot be, a state became non-finite, or the caller asked to stop.
pub fn test_batch(skirt: &Skirt, plan: &TestPlan, work: Work<'_>) -> Result<Vec<TestRow>> {
    let plan = plan.checked(skirt)?;
    each_run(plan.runs(), work, |index| {
        plan.run(skirt, index, work.interrupted)
    })
}
