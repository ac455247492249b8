//! Runs of one task: gain sets in scenes, and the lanes that are compiled for a law.

use pulp::Simd;

pub(crate) use crate::run::lanes::kernel::{Group, RunJob};
use crate::run::lanes::kernel::{LawInLanes, run_lanes};
use crate::run::lanes::scenes::agree;
use crate::run::outcome::RunTotals;
use crate::run::record::{DescentCounter, Recorder};
use crate::run::walls::Maps;
use navigation_laws::{LaneFamily, LaneLaw};
use navigation_world::world::obstacle::Shape;
use navigation_world::world::scenario::{PlacedObstacle, Scenario};
use numeric::error::Result;
use numeric::lanes::{Lanes, Vectors};

/// Robots side by side.
type Eight = Lanes<8>;

/// Receives each run: its index, its totals, and its least distance to an obstacle.
pub(crate) type Keep<'a> = &'a mut dyn FnMut(usize, &RunTotals, &dyn Fn(usize) -> f64);

/// The lanes that are compiled for a family of laws.
pub(crate) trait LaneKernel: Send + Sync {
    /// Whether the law has a Lyapunov function.
    fn has_lyapunov(&self) -> bool;
    /// Whether runs side by side may have different gains.
    fn mixes_gains(&self) -> bool;
    /// Whether two runs may be side by side.
    fn fit(&self, one: &RunJob<'_>, other: &RunJob<'_>) -> bool;
    /// Whether lanes pay for the obstacles of a run.
    fn pay(&self, job: &RunJob<'_>) -> bool;
    /// Makes runs that fit side by side.
    fn run(&self, group: &Group<'_>, maps: &Maps, vectors: Vectors, keep: Keep<'_>) -> Result<()>;
}

impl<F: LaneFamily> LaneKernel for F {
    fn has_lyapunov(&self) -> bool {
        F::LYAPUNOV
    }

    fn mixes_gains(&self) -> bool {
        F::MIXES_GAINS
    }

    fn fit(&self, one: &RunJob<'_>, other: &RunJob<'_>) -> bool {
        (F::MIXES_GAINS || one.gains == other.gains) && agree(one.scenario, other.scenario)
    }

    fn pay(&self, job: &RunJob<'_>) -> bool {
        let is_disc = |placed: &PlacedObstacle| matches!(placed.obstacle.shape, Shape::Disc { .. });
        job.scenario.obstacle_count() <= F::MOST_OBSTACLES
            && (!F::DISCS_ONLY || job.scenario.obstacles.iter().all(is_disc))
    }

    fn run(&self, group: &Group<'_>, maps: &Maps, vectors: Vectors, keep: Keep<'_>) -> Result<()> {
        if F::LYAPUNOV && group.plan.descent {
            side_by_side::<F, DescentCounter<Eight>, true>(self, (group, maps), vectors, keep)
        } else {
            side_by_side::<F, (), false>(self, (group, maps), vectors, keep)
        }
    }
}

fn side_by_side<F: LaneFamily, C: Recorder<Eight> + Default, const RECORD: bool>(
    family: &F,
    (group, maps): (&Group<'_>, &Maps),
    vectors: Vectors,
    keep: Keep<'_>,
) -> Result<()> {
    let mut enter = |law: &mut Option<Box<F::Law<Eight, RECORD>>>,
                     lane: usize,
                     gains: &[Eight],
                     scenario: &Scenario| {
        if let Some(law) = law {
            return family.enter(law, lane, gains, scenario);
        }
        *law = Some(Box::new(family.with_gains(gains, scenario)?));
        Ok(())
    };
    // A job knows no family: families with the same law share its code.
    let job = LaneJob {
        group,
        maps,
        law: LawInLanes {
            enter: &mut enter,
            told_of_all: LaneLaw::is_told_of_all,
        },
        recorder: C::default(),
        keep,
    };
    Simd::vectorize(vectors, job)
}

/// Runs side by side, to be made with the instructions of the processor.
struct LaneJob<'a, 'b, L, C> {
    group: &'a Group<'b>,
    maps: &'a Maps,
    law: LawInLanes<'a, Eight, L>,
    recorder: C,
    keep: Keep<'a>,
}

impl<L: LaneLaw<Eight>, C: Recorder<Eight>> pulp::NullaryFnOnce for LaneJob<'_, '_, L, C> {
    type Output = Result<()>;

    #[inline(always)]
    fn call(mut self) -> Self::Output {
        let recorder = &mut self.recorder;
        run_lanes(
            self.group,
            self.maps,
            self.law,
            recorder,
            |index, runs, lane, recorder| {
                let totals = runs.totals(lane, recorder);
                (self.keep)(index, &totals, &|obstacle| {
                    runs.min_distance(obstacle, lane)
                });
            },
        )
    }
}
