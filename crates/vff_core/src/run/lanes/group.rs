//! Gain sets side by side in lanes, lane groups in step, through one scenario.

use std::marker::PhantomData;

use pulp::Simd;

use crate::error::Result;
use crate::lanes::{Lanes, Real, Vectors};
use crate::laws::{Law, LawFamily, SceneLaw};
use crate::run::Interrupted;
use crate::run::lanes::rollout::run_scenes;
use crate::run::outcome::RunTotals;
use crate::run::plan::{MAX_GAINS, Plan, key_of};
use crate::run::record::Recorder;
use crate::run::rollout::{Member, run_team};
use crate::run::walls::Maps;
use crate::world::map::StaticMap;
use crate::world::scenario::Scenario;

/// Receives each run: its index, its totals, and its least distance to an obstacle.
pub(crate) type Keep<'a> = &'a mut dyn FnMut(usize, &RunTotals, &dyn Fn(usize) -> f64);

/// Gain sets of one task in one scenario.
pub(crate) struct Group<'a> {
    pub scenario: &'a Scenario,
    /// Gain sets in the order of their names.
    pub points: &'a [f64],
    pub plan: &'a Plan,
    pub interrupted: Interrupted<'a>,
}

impl Group<'_> {
    /// Runs gain sets side by side.
    pub fn side_by_side<F: LawFamily, R: Real, C: Recorder<R> + Default, const RECORD: bool>(
        &self,
        vectors: Vectors,
        law: &F,
        keep: Keep<'_>,
    ) -> Result<()> {
        let known = Known {
            dimension: law.gain_names().len(),
            free_gains: law.free_gains(),
            map: law.map(),
        };
        let sets = self.points.chunks(R::WIDTH * known.dimension);
        // No `collect`: laws of eight lanes are long to move.
        let mut team = Vec::with_capacity(sets.len());
        for sets in sets {
            team.push(Member {
                law: law_of::<F, R, RECORD>(law, sets, self.scenario)?,
                recorder: C::default(),
            });
        }
        // A job knows no family: families with the same law share its code.
        let job = Job {
            group: self,
            team: &mut team,
            law: &known,
            keep,
            width: PhantomData,
        };
        Simd::vectorize(vectors, job)
    }

    /// Runs a team with its laws, made for the gain sets in their order.
    #[inline(always)]
    pub fn run<R: Real, L: Law<R>, C: Recorder<R>>(
        &self,
        team: &mut [Member<L, C>],
        law: &Known<'_>,
        keep: Keep<'_>,
    ) -> Result<()> {
        let count = self.points.len() / law.dimension;
        let led = self.plan.shortcuts && law.shares_free_gains(self.points);
        run_team(
            self.scenario,
            (team, led),
            (self.plan, &Maps::of_law(self.scenario, law.map)),
            self.interrupted,
            |index, runs, lane, recorder| {
                if index < count {
                    let totals = runs.totals(lane, recorder);
                    keep(index, &totals, &|obstacle| {
                        runs.min_distance(obstacle, lane)
                    });
                }
            },
        )
    }
}

/// What runs in a scenario need to know of a law up to its gains.
pub(crate) struct Known<'a> {
    pub dimension: usize,
    pub free_gains: &'a [usize],
    pub map: Option<&'a StaticMap>,
}

impl Known<'_> {
    /// Whether gain sets differ only in gains that act near obstacles.
    fn shares_free_gains(&self, points: &[f64]) -> bool {
        let key = |set: &[f64]| key_of(self.free_gains, set);
        let mut sets = points.chunks_exact(self.dimension);
        let first = sets.next().map(key);
        sets.all(|set| Some(key(set)) == first)
    }
}

/// Scenes of one task for one gain set.
pub(crate) struct SceneGroup<'a> {
    /// Where, all with the same robot and rules.
    pub scenes: &'a [&'a Scenario],
    /// The gain set.
    pub gains: &'a [f64],
    pub plan: &'a Plan,
    pub vectors: Vectors,
    pub interrupted: Interrupted<'a>,
}

impl SceneGroup<'_> {
    /// Runs scenes side by side.
    pub fn side_by_side<F: LawFamily>(&self, law: &F, keep: Keep<'_>) -> Result<()>
    where
        F::Law<Lanes<8>, false>: SceneLaw<Lanes<8>>,
    {
        let count = |scene: &&&Scenario| scene.obstacle_count();
        let Some(fullest) = self.scenes.iter().max_by_key(count) else {
            return Ok(());
        };
        let mut law = law_of::<F, Lanes<8>, false>(law, self.gains, fullest)?;
        let job = SceneJob {
            group: self,
            law: &mut law,
            keep,
        };
        Simd::vectorize(self.vectors, job)
    }
}

/// As [`Job`], for scenes side by side.
struct SceneJob<'a, 'b, 'c, L> {
    group: &'a SceneGroup<'b>,
    law: &'a mut L,
    keep: Keep<'c>,
}

impl<L: SceneLaw<Lanes<8>>> pulp::NullaryFnOnce for SceneJob<'_, '_, '_, L> {
    type Output = Result<()>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        let group = self.group;
        run_scenes(
            group.scenes,
            self.law,
            &group.plan.run,
            group.interrupted,
            |index, runs, lane| {
                let totals = runs.totals(lane, &());
                (self.keep)(index, &totals, &|obstacle| {
                    runs.min_distance(obstacle, lane)
                });
            },
        )
    }
}

/// A law for a lane group; the last gain set fills lanes that are left over.
#[inline(always)]
fn law_of<F: LawFamily, R: Real, const RECORD: bool>(
    law: &F,
    sets: &[f64],
    scenario: &Scenario,
) -> Result<F::Law<R, RECORD>> {
    let dimension = law.gain_names().len();
    let last = sets.len() / dimension - 1;
    let mut gains = [R::zero(); MAX_GAINS];
    for (axis, gain) in gains[..dimension].iter_mut().enumerate() {
        *gain = R::from_fn(|lane| sets[lane.min(last) * dimension + axis]);
    }
    law.with_gains(&gains[..dimension], scenario)
}

/// Gain sets of a task side by side. The arithmetic is the same as of one by itself, bit for bit.
struct Job<'a, 'b, 'c, R, L, C> {
    group: &'a Group<'b>,
    team: &'a mut [Member<L, C>],
    law: &'a Known<'a>,
    keep: Keep<'c>,
    width: PhantomData<R>,
}

impl<R: Real, L: Law<R>, C: Recorder<R>> pulp::NullaryFnOnce for Job<'_, '_, '_, R, L, C> {
    type Output = Result<()>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        self.group.run(self.team, self.law, self.keep)
    }
}
