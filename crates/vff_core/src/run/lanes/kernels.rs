//! The widths that the loop is compiled for, law by law.

use crate::error::Result;
use crate::lanes::{Lanes, Vectors};
use crate::laws::{LawFamily, SceneLaw};
use crate::run::lanes::group::{Group, Keep, SceneGroup};
use crate::run::plan::Width;
use crate::run::record::DescentCounter;

/// Kernels that are compiled for a law.
pub(crate) trait Kernels<F: LawFamily>: 'static {
    /// Whether there is one for scenes side by side.
    const SCENES: bool = false;
    /// Most obstacles of a scene beside others: one by itself leaves those that are far away alone.
    const MOST_OBSTACLES: usize = usize::MAX;
    /// Whether there is one for gain sets side by side.
    const LANES: bool = false;
    /// Whether the law has a Lyapunov function, whose descent is counted.
    const LYAPUNOV: bool = false;
    /// Runs gain sets side by side, if there is such a kernel.
    fn run_lanes(
        _law: &F,
        _group: &Group<'_>,
        _lanes: (Vectors, Width),
        _keep: Keep<'_>,
    ) -> Result<()> {
        Ok(())
    }
    /// Runs scenes side by side, if there is such a kernel.
    fn run_scenes(_law: &F, _group: &SceneGroup<'_>, _keep: Keep<'_>) -> Result<()> {
        Ok(())
    }
}

/// One, four and eight gain sets side by side, with and without the Lyapunov function.
pub(crate) struct EveryWidth;

impl<F: LawFamily> Kernels<F> for EveryWidth
where
    F::Law<Lanes<8>, false>: SceneLaw<Lanes<8>>,
{
    const SCENES: bool = true;
    const LANES: bool = true;
    const LYAPUNOV: bool = true;

    fn run_scenes(law: &F, group: &SceneGroup<'_>, keep: Keep<'_>) -> Result<()> {
        group.side_by_side(law, keep)
    }

    fn run_lanes(
        law: &F,
        group: &Group<'_>,
        (vectors, width): (Vectors, Width),
        keep: Keep<'_>,
    ) -> Result<()> {
        type Counter = DescentCounter<Lanes<8>>;
        // One job for each kind of run: in one body an unoptimized build would need more stack
        // than a thread has.
        match (width, group.plan.descent) {
            (Width::Four, false) => {
                group.side_by_side::<F, Lanes<4>, (), false>(vectors, law, keep)
            }
            (_, false) => group.side_by_side::<F, Lanes<8>, (), false>(vectors, law, keep),
            (_, true) => group.side_by_side::<F, Lanes<8>, Counter, true>(vectors, law, keep),
        }
    }
}

/// One and eight gain sets side by side, for laws without a Lyapunov function.
pub(crate) struct OneAndEight;

impl<F: LawFamily> Kernels<F> for OneAndEight
where
    F::Law<Lanes<8>, false>: SceneLaw<Lanes<8>>,
{
    const SCENES: bool = true;
    const LANES: bool = true;

    fn run_scenes(law: &F, group: &SceneGroup<'_>, keep: Keep<'_>) -> Result<()> {
        group.side_by_side(law, keep)
    }

    fn run_lanes(
        law: &F,
        group: &Group<'_>,
        (vectors, _): (Vectors, Width),
        keep: Keep<'_>,
    ) -> Result<()> {
        group.side_by_side::<F, Lanes<8>, (), false>(vectors, law, keep)
    }
}

/// Gain sets one after the other, and scenes of a few obstacles side by side.
pub(crate) struct OneAndScenes;

impl<F: LawFamily> Kernels<F> for OneAndScenes
where
    F::Law<Lanes<8>, false>: SceneLaw<Lanes<8>>,
{
    const SCENES: bool = true;
    const MOST_OBSTACLES: usize = 32;

    fn run_scenes(law: &F, group: &SceneGroup<'_>, keep: Keep<'_>) -> Result<()> {
        group.side_by_side(law, keep)
    }
}

/// One after the other, for laws that think longer than a robot moves.
pub(crate) struct One;

impl<F: LawFamily> Kernels<F> for One {}
