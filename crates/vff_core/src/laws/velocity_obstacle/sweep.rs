//! A sweep over the velocities that may be better than the best one known, from side to side: each cone that forbids
//! all of them up to where it ends is one step, and what lies between two steps is left.

use super::Vector;
use super::best::Best;
use super::cones::{GROUP, Group, LegGroup};
use super::lines::Cap;
use super::parts::{Part, beyond_legs};
use super::remaining::Segment;
use crate::lanes::{Mask, Number, Real, Vector2};

/// A leg along the bottom up to this sine of an angle bounds nothing.
const FLAT: f64 = 1e-3;

/// How far cones are followed to either side, relative to what is swept.
const FAR: f64 = 4.0;

/// Most steps of the last sweep that are tried for the next one of this.
const AHEAD: usize = 3;

/// Most gaps that are left; more are not worth it.
const GAPS: usize = 8;

/// Where cones begin and end at the bottom and at the top, in m/s; no numbers where one forbids nothing for certain.
#[derive(Clone, Copy, Debug)]
struct Span {
    begin: [Group; 2],
    end: [Group; 2],
    /// How far they go within what is swept: the sum of both.
    reach: Group,
}

/// Room for sweeps, kept from one control period to the next.
#[derive(Clone, Debug, Default)]
pub(super) struct Swept {
    spans: Vec<Span>,
    /// Cones that were steps of this sweep, and of the last one, in their order.
    steps: [Vec<usize>; 2],
}

/// A place at the bottom and one at the top: what is on the left of the line between them has been swept.
type Front = [f64; 2];

impl Best<'_> {
    /// Finds discs that hold everything reachable that may be worth enough and that no single disc forbids, if there
    /// are few of them.
    pub fn sweep(&self, swept: &mut Swept, caps: &mut Vec<Cap>) -> bool {
        caps.clear();
        let across = Vector::new(-self.aim.y, self.aim.x);
        let segment = self.segment().filter(|_| self.planner.edged.is_empty());
        let Some(segment) = segment else {
            return false;
        };
        pulp::Arch::new().dispatch(Sweep {
            legs: &self.planner.legs,
            axes: [across, self.aim],
            segment,
            swept,
            caps,
        })
    }
}

struct Sweep<'a> {
    legs: &'a [LegGroup],
    /// Directions to the side and up.
    axes: [Vector; 2],
    segment: Segment,
    swept: &'a mut Swept,
    caps: &'a mut Vec<Cap>,
}

impl pulp::NullaryFnOnce for Sweep<'_> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        let part = self.segment.part(self.axes);
        let sizes = part.corners().iter();
        let sizes = sizes.map(|corner| corner.x.abs() + corner.y.abs());
        let size = sizes.fold(0.0, f64::max);
        let Swept { spans, steps } = &mut *self.swept;
        spans.clear();
        steps.swap(0, 1);
        let [steps, last] = steps;
        steps.clear();
        for group in self.legs {
            spans.push(self.segment.span(group, self.axes, size));
        }
        let end = self.segment.half;
        let mut front = [-end; 2];
        let mut known = last.as_slice();
        // After a gap a cone is found that holds the front.
        for _ in 0..2 * (spans.len() * GROUP + GAPS) {
            if front[0] >= end && front[1] >= end {
                return true;
            }
            // What was a step last mostly is one again.
            let ahead = &known[..known.len().min(AHEAD)];
            let step = ahead
                .iter()
                .position(|index| extends(spans, *index, front, end));
            let step = if let Some(place) = step {
                let index = known[place];
                known = &known[place + 1..];
                Some(index)
            } else {
                farthest(spans, front, end)
            };
            if let Some(index) = step {
                let until = &spans[index / GROUP].end;
                front = [until[0].lane(index % GROUP), until[1].lane(index % GROUP)];
                steps.push(index);
                continue;
            }
            let begin = nearest(spans, front).map_or([end; 2], |index| {
                let begin = &spans[index / GROUP].begin;
                [begin[0].lane(index % GROUP), begin[1].lane(index % GROUP)]
            });
            let next = [front[0].max(begin[0]), front[1].max(begin[1])];
            let gap = self.segment.between(self.axes, [front, begin, next]);
            let gap = gap.within(&part);
            if !gap.corners().is_empty() {
                if self.caps.len() == GAPS {
                    return false;
                }
                self.caps.push(gap.cap());
            }
            front = next;
        }
        false
    }
}

impl Segment {
    /// Where cones forbid velocities up to a size for certain, at the bottom and at the top. Between the two they
    /// forbid what is between what they forbid there.
    #[inline(always)]
    fn span(&self, group: &LegGroup, axes: [Vector; 2], size: f64) -> Span {
        let number = Group::splat;
        let wide = |axis: Vector| Vector2::new(number(axis.x), number(axis.y));
        let ([across, aim], center) = (axes.map(wide), wide(self.center));
        let (beyond, _) = beyond_legs([group.left, group.right], group.tip, number(size));
        let far = number(FAR * self.half);
        let (mut begin, mut end) = ([-far; 2], [far; 2]);
        let mut sound = <Group as Number>::Mask::splat(true);
        for (inward, least) in beyond {
            let (slope, rise) = (inward.dot(&across), inward.dot(&aim));
            let least = least - inward.dot(&center);
            sound = sound & number(FLAT).lt(slope.abs());
            let right = number(0.0).lt(slope);
            let levels = [self.bottom, self.top];
            for (level, height) in levels.into_iter().enumerate() {
                let place = (least - rise * number(height)) / slope;
                begin[level] = begin[level].max(Group::select(right, place, -far));
                end[level] = end[level].min(Group::select(right, far, place));
            }
        }
        let sound = sound & begin[0].lt(end[0]) & begin[1].lt(end[1]);
        let none = number(f64::NAN);
        let last = number(self.half);
        Span {
            begin: [Group::select(sound, begin[0], none), begin[1]],
            end: [Group::select(sound, end[0], none), end[1]],
            reach: end[0].min(last) + end[1].min(last),
        }
    }

    /// What is between a front and where a cone begins, up to the front after that.
    #[inline(always)]
    fn between(&self, axes: [Vector; 2], [front, begin, next]: [Front; 3]) -> Part {
        let place = |side: f64, height: f64| self.velocity(axes, [side, height]);
        let low = [front[0], next[0]].map(|side| place(side, self.bottom));
        let high = [front[1], next[1]].map(|side| place(side, self.top));
        let gap = [begin[0] - front[0], begin[1] - front[1]];
        let corners = if gap[0] >= 0.0 && gap[1] >= 0.0 {
            [low[0], low[1], high[1], high[0]]
        } else {
            // Where the two lines cross nothing is left beyond.
            let crossing = low[0] + (high[0] - low[0]) * (gap[0] / (gap[0] - gap[1]));
            let [one, other] = if gap[0] > gap[1] { low } else { high };
            [one, other, crossing, crossing]
        };
        Part::quadrangle(corners)
    }
}

/// Whether a cone forbids all of a front and extends beyond it.
#[inline(always)]
fn extends(spans: &[Span], index: usize, [low, high]: Front, end: f64) -> bool {
    let lane = index % GROUP;
    spans.get(index / GROUP).is_some_and(|span| {
        let [begin, until] =
            [&span.begin, &span.end].map(|at| [at[0].lane(lane), at[1].lane(lane)]);
        let holds = begin[0] <= low && begin[1] <= high && low <= until[0] && high <= until[1];
        holds && low.min(end) + high.min(end) < span.reach.lane(lane)
    })
}

/// The cone that forbids all of a front and extends farthest.
#[inline(always)]
fn farthest(spans: &[Span], [low, high]: Front, end: f64) -> Option<usize> {
    let known = low.min(end) + high.min(end);
    let [low, high] = [Group::splat(low), Group::splat(high)];
    let (mut most, mut places) = (Group::splat(known), Group::splat(0.0));
    for (place, span) in spans.iter().enumerate() {
        let Span { begin, end, reach } = span;
        let begun = begin[0].le(low) & begin[1].le(high);
        let farther = begun & low.le(end[0]) & high.le(end[1]) & most.lt(*reach);
        most = Group::select(farther, *reach, most);
        places = Group::select(farther, Group::splat(place as f64), places);
    }
    best(known, most, places)
}

/// The cone that extends beyond a front and begins nearest to it.
#[inline(always)]
fn nearest(spans: &[Span], [low, high]: Front) -> Option<usize> {
    let (low, high, zero) = (Group::splat(low), Group::splat(high), Group::splat(0.0));
    let (mut most, mut places) = (Group::splat(f64::NEG_INFINITY), zero);
    for (place, Span { begin, end, .. }) in spans.iter().enumerate() {
        let near = -((begin[0] - low).max(zero) + (begin[1] - high).max(zero));
        let nearer = low.lt(end[0]) & high.lt(end[1]) & most.lt(near);
        most = Group::select(nearer, near, most);
        places = Group::select(nearer, Group::splat(place as f64), places);
    }
    best(f64::NEG_INFINITY, most, places)
}

/// The cone in the lane with the largest number, where that is larger than a known one.
#[inline(always)]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // places of groups
fn best(known: f64, numbers: Group, places: Group) -> Option<usize> {
    let mut best = (known, None);
    for lane in 0..GROUP {
        if numbers.lane(lane) > best.0 {
            best = (numbers.lane(lane), Some(lane));
        }
    }
    best.1.map(|lane| places.lane(lane) as usize * GROUP + lane)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::velocity_obstacle::cones::{Cone, ConeBase, draw_legs};
    use crate::laws::velocity_obstacle::tests::Draws;

    /// Cones of so many discs, most of them far away and about ahead, and their legs.
    fn cones(draws: &mut Draws, count: usize, spread: f64) -> (Vec<Cone>, Vec<LegGroup>) {
        let cone = |index: usize| {
            let angle = draws.between(-spread, spread);
            let distance = [2.0, 20.0, 90.0][index % 3] * draws.between(0.5, 1.5);
            let center = Vector::new(angle.cos(), angle.sin()) * distance;
            Cone {
                tip: Vector::new(draws.between(-0.4, 0.4), draws.between(-0.4, 0.4)),
                legs: None,
                base: ConeBase::Disc(center, draws.between(0.1, 0.9)),
            }
        };
        let (mut cones, mut legs): (Vec<Cone>, _) = ((0..count).map(cone).collect(), Vec::new());
        draw_legs(&mut cones, &mut legs);
        (cones, legs)
    }

    /// The part of a circle around rest above a chord.
    fn segment(radius: f64, bottom: f64) -> Segment {
        let half = (radius * radius - bottom * bottom).sqrt();
        Segment {
            center: Vector::zeros(),
            bottom,
            top: radius,
            half,
            side: half * radius / (radius + bottom),
        }
    }

    #[test]
    fn what_a_sweep_does_not_leave_is_forbidden() {
        let mut draws = Draws(0x0dd0_2026_1127_0001);
        let (mut swept, mut caps) = (Swept::default(), Vec::new());
        let (mut finished, mut left, mut taken) = (0, 0, 0);
        for case in 0..3_000 {
            let spread = [0.3, 1.0, 3.0][case % 3];
            let count = 1 + 13 * case % 90;
            let (cones, legs) = cones(&mut draws, count, spread);
            let segment = segment(0.7, draws.between(0.2, 0.699));
            let angle = draws.between(-0.3, 0.3);
            let aim = Vector::new(angle.cos(), angle.sin());
            let axes = [Vector::new(-aim.y, aim.x), aim];
            // The second time it knows its steps.
            for _ in 0..2 {
                caps.clear();
                let done = pulp::Arch::new().dispatch(Sweep {
                    legs: &legs,
                    axes,
                    segment,
                    swept: &mut swept,
                    caps: &mut caps,
                });
                if !done {
                    continue;
                }
                finished += 1;
                for _ in 0..40 {
                    let (across, up) = (draws.between(-1.0, 1.0), draws.between(0.0, 1.0));
                    let height = segment.bottom + (segment.top - segment.bottom) * up;
                    let half = (segment.top * segment.top - height * height)
                        .max(0.0)
                        .sqrt();
                    let velocity = segment.velocity(axes, [across * half, height]);
                    if caps.iter().any(|cap| cap.may_hold(velocity)) {
                        left += 1;
                        continue;
                    }
                    taken += 1;
                    let mut forbidden = cones.iter();
                    let forbidden =
                        forbidden.any(|cone| cone.time_to_contact(velocity, &[]) < f64::INFINITY);
                    assert!(forbidden, "case {case}: {velocity:?}, {caps:?}");
                }
            }
        }
        let counts = [finished, left, taken];
        assert!(counts.iter().all(|count| *count > 1_500), "{counts:?}");
    }

    #[test]
    fn where_two_cones_overlap_above_a_velocity_little_is_left() {
        // Their legs cross at 0.5 m/s straight ahead, and leave a triangle before that.
        let cone = |side: f64| {
            let (half, leg) = (std::f64::consts::FRAC_PI_3, 0.6_f64.atan());
            Cone {
                tip: Vector::new(0.0, 0.3 * side),
                legs: None,
                base: ConeBase::Disc(
                    Vector::new((half - leg).cos(), (half - leg).sin() * side) * 10.0,
                    10.0 * half.sin(),
                ),
            }
        };
        let mut cones = vec![cone(1.0), cone(-1.0)];
        let mut legs = Vec::new();
        draw_legs(&mut cones, &mut legs);
        let cross = 0.5;
        let (mut swept, mut caps) = (Swept::default(), Vec::new());
        let done = pulp::Arch::new().dispatch(Sweep {
            legs: &legs,
            axes: [Vector::new(0.0, 1.0), Vector::new(1.0, 0.0)],
            segment: segment(0.7, cross - 0.01),
            swept: &mut swept,
            caps: &mut caps,
        });
        assert!(done);
        assert_eq!(caps.len(), 1, "{caps:?}");
        assert!(caps[0].radius < 0.03, "{caps:?}");
        assert!(caps[0].may_hold(Vector::new(cross - 0.001, 0.0)));
    }
}
