//! Gain sets side by side in lanes, lane groups in step, through one scenario.

use std::marker::PhantomData;

use crate::error::Result;
use crate::lanes::{Lanes, Real};
use crate::laws::{LawFamily, SceneLaw};
use crate::run::Interrupted;
use crate::run::lane_rollout::run_scenes;
use crate::run::outcome::RunTotals;
use crate::run::plan::{Instructions, MAX_GAINS, Plan, key_of};
use crate::run::record::Recorder;
use crate::run::rollout::{Member, run_team};
use crate::run::walls::Maps;
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
    pub fn dispatch<F: LawFamily, R: Real, C: Recorder<R> + Default, const RECORD: bool>(
        &self,
        law: &F,
        keep: Keep<'_>,
    ) -> Result<()> {
        let processor = match self.plan.instructions {
            Instructions::Widest => pulp::Arch::new(),
            Instructions::Baseline => pulp::Arch::Scalar,
        };
        processor.dispatch(Job::<F, Kind<R, C, RECORD>> {
            group: self,
            law,
            keep,
            kind: PhantomData,
        })
    }
}

/// Scenes of one task for one gain set.
pub(crate) struct SceneGroup<'a> {
    /// Where, all with the same robot and rules.
    pub scenes: &'a [&'a Scenario],
    /// The gain set.
    pub gains: &'a [f64],
    pub plan: &'a Plan,
    pub interrupted: Interrupted<'a>,
}

impl SceneGroup<'_> {
    pub fn dispatch<F: LawFamily>(&self, law: &F, keep: Keep<'_>) -> Result<()>
    where
        F::Law<Lanes<8>, false>: SceneLaw<Lanes<8>>,
    {
        let processor = match self.plan.instructions {
            Instructions::Widest => pulp::Arch::new(),
            Instructions::Baseline => pulp::Arch::Scalar,
        };
        processor.dispatch(SceneJob {
            group: self,
            law,
            keep,
        })
    }
}

/// As [`Job`], for scenes side by side.
struct SceneJob<'a, 'b, 'c, F> {
    group: &'a SceneGroup<'b>,
    law: &'a F,
    keep: Keep<'c>,
}

impl<F: LawFamily> pulp::NullaryFnOnce for SceneJob<'_, '_, '_, F>
where
    F::Law<Lanes<8>, false>: SceneLaw<Lanes<8>>,
{
    type Output = Result<()>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        let group = self.group;
        let fullest = group
            .scenes
            .iter()
            .max_by_key(|scene| scene.obstacle_count());
        let Some(fullest) = fullest else {
            return Ok(());
        };
        let mut law = law_of::<F, Lanes<8>, false>(self.law, group.gains, fullest)?;
        run_scenes(
            group.scenes,
            &mut law,
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

/// Whether gain sets differ only in gains that act near obstacles.
fn shares_free_gains<F: LawFamily>(law: &F, points: &[f64]) -> bool {
    let mut sets = points.chunks_exact(LawFamily::gain_names(law).len());
    let key = |set: &[f64]| key_of(LawFamily::free_gains(law), set);
    let first = sets.next().map(key);
    sets.all(|set| Some(key(set)) == first)
}

/// A task that is compiled once for each instruction set; the widest one that the processor has
/// is chosen at run time. The arithmetic is the same, bit for bit.
struct Job<'a, 'b, 'c, F, K> {
    group: &'a Group<'b>,
    law: &'a F,
    keep: Keep<'c>,
    kind: PhantomData<K>,
}

/// Width, recorder, and whether the Lyapunov function is wanted.
struct Kind<R, C, const RECORD: bool>(PhantomData<(R, C)>);

impl<F: LawFamily, R: Real, C: Recorder<R> + Default, const RECORD: bool> pulp::NullaryFnOnce
    for Job<'_, '_, '_, F, Kind<R, C, RECORD>>
{
    type Output = Result<()>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        let group = self.group;
        let dimension = LawFamily::gain_names(self.law).len();
        let member = |sets: &[f64]| -> Result<_> {
            Ok(Member {
                law: law_of::<F, R, RECORD>(self.law, sets, group.scenario)?,
                recorder: C::default(),
            })
        };
        let mut team: Vec<_> = group
            .points
            .chunks(R::WIDTH * dimension)
            .map(member)
            .collect::<Result<_>>()?;
        let count = group.points.len() / dimension;
        let led = group.plan.shortcuts && shares_free_gains(self.law, group.points);
        run_team(
            group.scenario,
            (&mut team, led),
            (group.plan, &Maps::of_law(group.scenario, self.law.map())),
            group.interrupted,
            |index, runs, lane, recorder| {
                if index < count {
                    let totals = runs.totals(lane, recorder);
                    (self.keep)(index, &totals, &|obstacle| {
                        runs.min_distance(obstacle, lane)
                    });
                }
            },
        )
    }
}
