//! Steps of collisions side by side.

use numeric::lanes::{Lanes, Real, Truth, vectors};
use pulp::{Simd, WithSimd};

use super::Loading;
use super::plane::{LaneVariable, Numbers};
use super::variable::Variable;
use crate::collision::Region;
use crate::collision::curve::Steps;
use crate::covering::Powers;

/// Collisions side by side.
const WIDTH: usize = 8;
pub(super) type Wide = Lanes<WIDTH>;

/// Collisions that take fewer lanes.
const FEW: usize = 2;

/// A step that a collision asks for.
#[derive(Clone, Copy)]
pub(super) struct StepRequest {
    pub(super) variable: Variable,
    pub(super) at: f64,
    pub(super) state: [f64; 2],
    pub(super) rates: [f64; 2],
    pub(super) length: f64,
    pub(super) scales: [f64; 2],
    /// Exponents of a force that is a sum of powers.
    pub(super) exponents: Option<[f64; 2]>,
}

impl StepRequest {
    /// Whether both steps can be taken side by side.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        self.variable.is_like(other.variable) && self.exponents == other.exponents
    }
}

/// Most steps that are taken side by side.
pub(super) fn most() -> usize {
    if vectors().is_some() { WIDTH } else { FEW }
}

/// Takes steps that are alike, up to [`most`], with their collisions.
pub(super) fn take(steps: &[(&Loading<'_>, StepRequest)], taken: &mut Steps<Wide>) {
    match vectors() {
        Some(vectors) if steps.len() > FEW => Simd::vectorize(vectors, StepGroup(steps, taken)),
        _ => {
            let mut few = Steps::none();
            take_few(steps, &mut few);
            *taken = few.widened();
        }
    }
}

/// Takes steps of few collisions: of one that is alone most lanes would be idle.
#[inline(never)]
pub(super) fn take_few(steps: &[(&Loading<'_>, StepRequest)], taken: &mut Steps<Lanes<FEW>>) {
    fill(steps, taken);
}

/// Steps of many collisions; the arithmetic is the same, bit for bit.
struct StepGroup<'a, 'b>(&'a [(&'a Loading<'b>, StepRequest)], &'a mut Steps<Wide>);

impl WithSimd for StepGroup<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let Self(steps, taken) = self;
        fill(steps, taken);
    }
}

#[inline(always)]
fn fill<R: Real>(steps: &[(&Loading<'_>, StepRequest)], taken: &mut Steps<R>) {
    // Lanes that are left over repeat the last step.
    let last = steps.len() - 1;
    let asked = |lane: usize| &steps[lane.min(last)].1;
    let pair = |of: fn(&StepRequest) -> [f64; 2]| {
        [0, 1].map(|entry| R::from_fn(|lane| of(asked(lane))[entry]))
    };
    let loading = |lane: usize| steps[lane.min(last)].0;
    let numbers = Numbers::<R>::of(loading);
    let over = LaneVariable::<R>::of(asked(0).variable, |lane| asked(lane).variable);
    let columns = ContactLanes::of(steps);
    let at = R::from_fn(|lane| asked(lane).at);
    let start = (at, pair(|of| of.state), pair(|of| of.rates));
    let length = R::from_fn(|lane| asked(lane).length);
    taken.take(
        #[inline(always)]
        |at, state| {
            let place = numbers.place(
                over,
                at,
                state,
                #[inline(always)]
                |depth, strain| columns.forces(depth, strain),
                #[inline(always)]
                |force| columns.yielding(force),
            );
            place.rates
        },
        start,
        length,
        pair(|of| of.scales),
    );
}

/// Coverings and regions side by side.
struct ContactLanes<'a, 'b, R> {
    steps: &'a [(&'a Loading<'b>, StepRequest)],
    /// Exponents and factors, where forces are sums of powers.
    powers: Option<([f64; 2], [R; 2])>,
    per_thickness: R,
    /// Onset and stiffness of the backing.
    backing: [R; 2],
    /// Compliances of the regions, in m/N, if all of them are linear or rigid.
    yielding: Option<R>,
}

impl<'a, 'b, R: Real> ContactLanes<'a, 'b, R> {
    #[inline(always)]
    fn of(steps: &'a [(&'a Loading<'b>, StepRequest)]) -> Self {
        let last = steps.len() - 1;
        let each = |lane: usize| steps[lane.min(last)].0;
        let factor = |place: usize| {
            R::from_fn(|lane| {
                let powers = each(lane).powers.as_ref();
                powers.map_or(0.0, |powers: &Powers| powers.factors[place])
            })
        };
        let linear = |lane: usize| {
            matches!(
                each(lane).collision.region,
                Region::Rigid | Region::Spring { cubic: 0.0, .. }
            )
        };
        Self {
            steps,
            powers: steps[0]
                .1
                .exponents
                .map(|found| (found, [factor(0), factor(1)])),
            per_thickness: R::from_fn(|lane| each(lane).scales.per_thickness),
            backing: [
                R::from_fn(|lane| each(lane).pad.bottom()),
                R::from_fn(|lane| each(lane).pad.covering.bottoming.stiffness),
            ],
            yielding: (0..=last)
                .all(linear)
                .then(|| R::from_fn(|lane| each(lane).scales.yielding)),
        }
    }

    /// Forces and their slopes.
    #[inline(always)]
    fn forces(&self, depth: R, strain: R) -> [R; 2] {
        let Some((exponents, factors)) = self.powers else {
            return self.alone(depth);
        };
        let [mut force, slope] = Powers::sums(exponents, factors, strain);
        let mut slope = slope * self.per_thickness;
        let [bottom, stiffness] = self.backing;
        let beyond = depth.gt(bottom);
        if beyond.any() {
            let more = R::select(beyond, stiffness, R::splat(0.0));
            force += more * R::select(beyond, depth - bottom, R::splat(0.0));
            slope += more;
        }
        [force, slope]
    }

    /// Forces of laws with cases of their own, one after the other.
    #[inline(never)]
    fn alone(&self, depth: R) -> [R; 2] {
        let (mut force, mut slope) = (depth, depth);
        let mut found = [0.0; 2];
        for lane in 0..R::WIDTH {
            if let Some((loading, _)) = self.steps.get(lane) {
                let by = loading.scales.per_thickness;
                found = loading.pad.force_by(depth.lane(lane), by);
            }
            force.set(lane, found[0]);
            slope.set(lane, found[1]);
        }
        [force, slope]
    }

    /// Compliances of the regions at a force, in m/N.
    #[inline(always)]
    fn yielding(&self, force: R) -> R {
        self.yielding.unwrap_or_else(|| self.bent(force))
    }

    #[inline(never)]
    fn bent(&self, force: R) -> R {
        let last = self.steps.len() - 1;
        R::from_fn(|lane| self.steps[lane.min(last)].0.yielding(force.lane(lane)))
    }
}
