//! Gain sets side by side in lanes, lane groups in step, through one scenario.

use std::marker::PhantomData;

use crate::error::{NavigationError, Result};
use crate::lanes::{Lanes, Real};
use crate::laws::{LawFamily, VirtualForceField};
use crate::scenario::Scenario;
use crate::simulate::Interrupted;
use crate::simulate::batch::{Instructions, Width};
use crate::simulate::nominal::key_of;
use crate::simulate::options::Options;
use crate::simulate::outcome::RunTotals;
use crate::simulate::record::{DescentCounter, Recorder};
use crate::simulate::rollout::{Member, run_team};

/// Most gains of a law.
pub(crate) const MAX_GAINS: usize = 8;

/// Gain sets of a task when there are many: groups of eight in step, which share the motion of
/// the obstacles.
const LARGE_TEAM: usize = 64;

/// Gain sets of a task when there are few.
const SMALL_TEAM: usize = 16;

/// Runs from which on the teams are large.
const MANY_RUNS: usize = 4096;

/// How the runs of a task are made.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plan {
    pub run: Options,
    pub width: Width,
    pub instructions: Instructions,
    /// Count the control periods over which the Lyapunov function does not grow.
    pub descent: bool,
    /// End runs that can neither arrive nor touch anything any more, and make the part of the way
    /// that all runs of a task have in common only once. Changes no bit of a run that arrives.
    pub shortcuts: bool,
}

impl Plan {
    /// One run by itself.
    pub fn single(run: Options) -> Self {
        Self {
            run,
            width: Width::One,
            instructions: Instructions::default(),
            descent: false,
            shortcuts: false,
        }
    }

    /// Number of gain sets of a task.
    pub fn team(&self, runs: usize) -> usize {
        match self.width {
            Width::Sixteen if self.descent || runs < MANY_RUNS => SMALL_TEAM,
            Width::Sixteen => LARGE_TEAM,
            width => width.lanes(),
        }
    }
}

/// Receives each run: its index, its totals, and its least distance to an obstacle.
pub(crate) type Keep<'a> = &'a mut dyn FnMut(usize, &RunTotals, &dyn Fn(usize) -> f64);

/// A law of any kind up to its gains.
///
/// The kernels of a law are compiled where it is turned into this, that is in this crate.
pub struct AnyLaw(Box<dyn Driven>);

impl From<VirtualForceField> for AnyLaw {
    fn from(law: VirtualForceField) -> Self {
        Self(Box::new(law))
    }
}

impl AnyLaw {
    pub(crate) fn driven(&self) -> &dyn Driven {
        &*self.0
    }
}

/// A law whose gain sets can be run.
pub(crate) trait Driven: Send + Sync {
    /// Words for the gains, in their order.
    fn gain_names(&self) -> &'static [&'static str];
    /// Gains that act on a robot without obstacles, ascending.
    fn free_gains(&self) -> &'static [usize];
    /// Passes a set of gains that the law allows.
    fn check_gains(&self, gains: &[f64]) -> Result<()>;
    /// Runs gain sets and hands every run over.
    fn run(&self, group: &Group<'_>, keep: Keep<'_>) -> Result<()>;
}

impl<F: LawFamily + Send> Driven for F {
    fn gain_names(&self) -> &'static [&'static str] {
        LawFamily::gain_names(self)
    }

    fn free_gains(&self) -> &'static [usize] {
        LawFamily::free_gains(self)
    }

    fn check_gains(&self, gains: &[f64]) -> Result<()> {
        LawFamily::check_gains(self, gains)
    }

    fn run(&self, group: &Group<'_>, keep: Keep<'_>) -> Result<()> {
        if (group.interrupted)() {
            return Err(NavigationError::Interrupted);
        }
        let exact = group.scenario.measurement.is_none();
        let plan = Plan {
            shortcuts: group.plan.shortcuts && exact && self.keeps_to_regions(),
            ..*group.plan
        };
        let group = &Group {
            plan: &plan,
            ..*group
        };
        // One job for each kind of run: in one body an unoptimized build would need more stack
        // than a thread has.
        match (group.plan.width, group.plan.descent) {
            (Width::One, false) => group.dispatch::<F, f64, (), false>(self, keep),
            (Width::One, true) => group.dispatch::<F, f64, DescentCounter<f64>, true>(self, keep),
            (Width::Four, false) => group.dispatch::<F, Lanes<4>, (), false>(self, keep),
            (Width::Eight | Width::Sixteen, false) => {
                group.dispatch::<F, Lanes<8>, (), false>(self, keep)
            }
            (_, true) => group.dispatch::<F, Lanes<8>, DescentCounter<Lanes<8>>, true>(self, keep),
        }
    }
}

/// Gain sets of one task in one scenario.
pub(crate) struct Group<'a> {
    pub scenario: &'a Scenario,
    /// Gain sets in the order of their names.
    pub points: &'a [f64],
    pub plan: &'a Plan,
    pub interrupted: Interrupted<'a>,
}

impl Group<'_> {
    fn dispatch<F: LawFamily, R: Real, C: Recorder<R> + Default, const RECORD: bool>(
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

/// A law for a lane group; the last gain set fills lanes that are left over.
#[inline(always)]
fn law_of<F: LawFamily, R: Real, const RECORD: bool>(
    law: &F,
    sets: &[f64],
    scenario: &Scenario,
) -> F::Law<R, RECORD> {
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
        let member = |sets: &[f64]| Member {
            law: law_of::<F, R, RECORD>(self.law, sets, group.scenario),
            recorder: C::default(),
        };
        let mut team: Vec<_> = group
            .points
            .chunks(R::WIDTH * dimension)
            .map(member)
            .collect();
        let count = group.points.len() / dimension;
        let led = group.plan.shortcuts && shares_free_gains(self.law, group.points);
        run_team(
            group.scenario,
            (&mut team, led),
            group.plan,
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
