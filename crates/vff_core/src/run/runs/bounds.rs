//! What bounds the distances to obstacles that may be left alone, side by side, and which of them are left alone
//! from the start to the end.

use super::BOUND_MARGIN;
use crate::lanes::{Number, Real, Truth, Vector2};
use crate::run::options::Clock;
use crate::world::scenario::{GROUP, Group, ObstacleGroup, Scenario};

/// Fewest control periods for which it pays to leave an obstacle alone.
pub(super) const FEWEST_PERIODS: usize = 8;

/// Room for rounding: as a share of a way, and of the largest numbers that distances are made of.
const SHARE: f64 = 1e-9;
const ROUNDING: f64 = 1e-12;

/// An obstacle that is left alone from a step until this one needs no alarm.
pub(super) fn without_alarm(clock: &Clock, step: usize) -> usize {
    let period = clock.steps_per_sample;
    let end = clock.steps.max(step + FEWEST_PERIODS * period);
    end.saturating_add(period)
}

/// What bounds the distances to all obstacles.
#[derive(Clone, Debug)]
pub(super) struct Bounds {
    groups: Vec<Bound>,
}

/// What bounds the distances to obstacles side by side.
#[derive(Clone, Copy, Debug)]
struct Bound {
    /// Distance in m beyond which they are neither felt nor touched, and room for rounding in it.
    felt: Group,
    margin: Group,
    /// Most by which the distance changes in a motion step, in m.
    stride: Group,
    /// Square of the distance beyond which they may be left alone, in m^2.
    alone: Group,
}

/// What the first look at all obstacles finds.
#[derive(Debug)]
pub(super) struct FirstLook {
    pub bounds: Bounds,
    /// Squares of the distances at the start in m^2, infinite where they are looked at one by one.
    pub least: Vec<f64>,
    /// The obstacles that may have to be looked at before the end.
    pub near: Vec<usize>,
}

impl FirstLook {
    /// Looks at the obstacles of a scenario; compiled for the instructions of the processor, its bits are the same
    /// for all. A law feels each within a distance in m, none where no distances are given.
    pub fn at(scenario: &Scenario, clock: &Clock, felt: &[f64]) -> Self {
        pulp::Arch::new().dispatch(Look {
            scenario,
            clock,
            felt,
        })
    }
}

impl Bounds {
    /// Motion steps for which an obstacle at a distance in m is neither felt nor touched.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates
    pub fn steps(&self, index: usize, distance: f64) -> usize {
        let number = |of: fn(&Bound) -> &Group| self.number(index, of);
        let free = distance - number(|bound| &bound.felt) - number(|bound| &bound.margin);
        (free / number(|bound| &bound.stride)) as usize
    }

    /// Square of the distance beyond which an obstacle may be left alone, in m^2.
    pub fn alone(&self, index: usize) -> f64 {
        self.number(index, |bound| &bound.alone)
    }

    /// Most by which the distance to an obstacle changes in a motion step, in m, and room for rounding in it.
    pub fn stride_and_margin(&self, index: usize) -> [f64; 2] {
        let bounds: [fn(&Bound) -> &Group; 2] = [|bound| &bound.stride, |bound| &bound.margin];
        bounds.map(|of| self.number(index, of))
    }

    /// Room for rounding in the distances of a group, in m.
    #[inline(always)]
    pub fn margin(&self, group: usize) -> Group {
        self.groups[group].margin
    }

    #[inline(always)]
    fn number(&self, index: usize, of: fn(&Bound) -> &Group) -> f64 {
        of(&self.groups[index / GROUP]).at(index % GROUP)
    }
}

struct Look<'a> {
    scenario: &'a Scenario,
    clock: &'a Clock,
    felt: &'a [f64],
}

impl Look<'_> {
    #[inline(always)]
    fn bound(&self, group: &ObstacleGroup, felt: Group) -> Bound {
        let number = Group::splat;
        let Scenario {
            robot,
            start: [x, y],
            rules,
            ..
        } = self.scenario;
        let (own, time) = (robot.max_speed, rules.time_limit);
        let way = (number(own) + group.speed) * number(self.clock.step);
        // No number that is added up is larger than this.
        let robot = x.abs() + y.abs() + own * time;
        let largest = number(robot) + group.size + group.speed * number(time);
        let stride = way * number(1.0 + SHARE) + number(robot * (2.0 * f64::EPSILON));
        let margin = number(BOUND_MARGIN) + largest * number(ROUNDING);
        let felt = felt.max(group.reach);
        let periods = (FEWEST_PERIODS + 1) * self.clock.steps_per_sample;
        let alone = felt + margin + number(periods as f64) * stride;
        Bound {
            felt,
            margin,
            stride,
            alone: alone * alone,
        }
    }
}

impl pulp::NullaryFnOnce for Look<'_> {
    type Output = FirstLook;

    #[inline(always)]
    fn call(self) -> FirstLook {
        let all = self.scenario.obstacles.groups();
        let count = self.scenario.obstacles.len();
        let mut groups = Vec::with_capacity(all.len());
        let mut least = Vec::with_capacity(all.len() * GROUP);
        let mut near = Vec::new();
        let start = Vector2::new(
            Group::splat(self.scenario.start[0]),
            Group::splat(self.scenario.start[1]),
        );
        let end = Group::splat(without_alarm(self.clock, 0) as f64);
        for (place, group) in all.iter().enumerate() {
            let first = place * GROUP;
            let felt = |lane: usize| self.felt.get(first + lane).copied().unwrap_or(0.0);
            let bound = self.bound(group, Group::from_fn(felt));
            let seen = start - group.at(Group::splat(0.0));
            let squared = seen.dot(&seen);
            let infinite = Group::splat(f64::INFINITY);
            let known = Group::select(squared.lt(infinite), squared, infinite);
            least.extend((0..GROUP).map(|lane| known.lane(lane)));
            let steps = (squared.sqrt() - bound.felt - bound.margin) / bound.stride;
            let may_be_near = !steps.ge(end);
            if may_be_near.any() {
                let lanes = (0..GROUP.min(count - first)).filter(|lane| may_be_near.lane(*lane));
                near.extend(lanes.map(|lane| first + lane));
            }
            groups.push(bound);
        }
        least.truncate(count);
        FirstLook {
            bounds: Bounds { groups },
            least,
            near,
        }
    }
}
