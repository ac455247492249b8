//! Velocities that obstacles forbid.

use super::Vector;
use super::lines::Cap;
use crate::lanes::{Lanes, Mask, Number, Planar, Real, Truth, Vector2, Zero};
use crate::laws::planning::outline::Legs;

/// Discs that are looked at side by side.
pub(super) const GROUP: usize = 4;
pub(super) type Group = Lanes<GROUP>;

/// Velocities that one obstacle forbids, as seen where the robot turns into its new velocity.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cone {
    /// Velocity of the obstacle in m/s.
    pub tip: Vector,
    /// Rays that bound them; none where the obstacle is touched.
    pub legs: Option<Legs>,
    pub base: ConeBase,
}

/// Outline of an obstacle: that of a disc is small, and most are discs.
#[derive(Clone, Copy, Debug)]
pub(super) enum ConeBase {
    /// Center relative to the robot, and radius, in m.
    Disc(Vector, f64),
    /// Place among the outlines with edges.
    Edges(usize),
}

/// Legs of cones side by side, in the order of the cones; numbers that are none where a cone has none.
#[derive(Clone, Copy, Debug)]
pub(super) struct LegGroup {
    pub tip: Vector2<Group>,
    pub left: Vector2<Group>,
    pub right: Vector2<Group>,
}

impl LegGroup {
    /// How far velocities are within each leg, in m/s.
    #[inline(always)]
    fn within(&self, velocity: Vector) -> [Group; 2] {
        let relative = Vector2::splat([velocity.x, velocity.y]) - self.tip;
        [-self.left.perp(&relative), self.right.perp(&relative)]
    }

    /// How far velocities are from the tips along each leg, in m/s.
    #[inline(always)]
    fn along(&self, velocity: Vector) -> [Group; 2] {
        let relative = Vector2::splat([velocity.x, velocity.y]) - self.tip;
        [self.left.dot(&relative), self.right.dot(&relative)]
    }
}

/// Draws the legs of all discs; those of all cones go side by side as well.
pub(super) fn draw_legs(cones: &mut [Cone], legs: &mut Vec<LegGroup>) {
    legs.clear();
    pulp::Arch::new().dispatch(Drawing(cones, legs));
}

/// The cone whose legs a velocity is farthest within.
pub(super) fn deepest(legs: &[LegGroup], velocity: Vector) -> Option<usize> {
    pulp::Arch::new().dispatch(Deepest(legs, velocity))
}

/// Finds the first of the cones that may forbid a velocity of which something is true.
pub(super) fn find_near(
    legs: &[LegGroup],
    velocity: Vector,
    is_so: impl Fn(usize) -> bool,
) -> Option<usize> {
    pulp::Arch::new().dispatch(Finding(legs, velocity, is_so))
}

/// Notes the cones that may forbid velocities of any of some discs, and the places of the legs on which some of
/// these lie, or on the whole lines through them.
pub(super) fn sort_out(
    (cones, legs): (&[Cone], &[LegGroup]),
    (caps, whole): (&[Cap], bool),
    (near, lines): (&mut Vec<usize>, &mut Vec<usize>),
) {
    near.clear();
    lines.clear();
    pulp::Arch::new().dispatch(Sorting {
        cones,
        legs,
        caps,
        whole,
        near,
        lines,
    });
}

/// Draws the legs of discs side by side, compiled for the instructions of the processor; their bits are the same
/// for all.
struct Drawing<'a>(&'a mut [Cone], &'a mut Vec<LegGroup>);

impl pulp::NullaryFnOnce for Drawing<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for group in self.0.chunks_mut(GROUP) {
            self.1.push(draw_group(group));
        }
    }
}

#[inline(always)]
fn draw_group(cones: &mut [Cone]) -> LegGroup {
    let disc = |lane: usize| match cones.get(lane).map(|cone| cone.base) {
        Some(ConeBase::Disc(center, radius)) => [center.x, center.y, radius],
        // In place of what is no disc.
        _ => [1.0, 0.0, 0.0],
    };
    let discs: [[f64; 3]; GROUP] = [disc(0), disc(1), disc(2), disc(3)];
    let [x, y, radius] = [0, 1, 2].map(|of| Group::from_fn(|lane| discs[lane][of]));
    let center = Vector2::new(x, y);
    let touched = center.dot(&center).le(radius * radius);
    let legs = Legs::of_disc(center, radius);
    let tip = |lane: usize| {
        cones
            .get(lane)
            .map_or(Vector2::new(0.0, 0.0), |cone| cone.tip)
    };
    let tips: [Vector; GROUP] = [tip(0), tip(1), tip(2), tip(3)];
    let mut side_by_side = LegGroup {
        tip: Vector2::new(
            Group::from_fn(|lane| tips[lane].x),
            Group::from_fn(|lane| tips[lane].y),
        ),
        left: legs.left,
        right: legs.right,
    };
    for (lane, cone) in cones.iter_mut().enumerate() {
        if matches!(cone.base, ConeBase::Disc(..)) && !touched.lane(lane) {
            cone.legs = Some(Legs {
                left: legs.left.lane(lane).into(),
                right: legs.right.lane(lane).into(),
                left_reach: legs.left_reach.lane(lane),
                right_reach: legs.right_reach.lane(lane),
            });
        } else {
            let nothing = Vector2::new(f64::NAN, f64::NAN);
            let own = cone
                .legs
                .map_or([nothing; 2], |legs| [legs.left, legs.right]);
            side_by_side.set(lane, own);
        }
    }
    for lane in cones.len()..GROUP {
        side_by_side.set(lane, [Vector2::new(f64::NAN, f64::NAN); 2]);
    }
    side_by_side
}

impl LegGroup {
    /// Changes the legs of one lane.
    fn set(&mut self, lane: usize, [left, right]: [Vector; 2]) {
        for (all, own) in [(&mut self.left, left), (&mut self.right, right)] {
            all.x.set(lane, own.x);
            all.y.set(lane, own.y);
        }
    }
}

struct Deepest<'a>(&'a [LegGroup], Vector);

impl pulp::NullaryFnOnce for Deepest<'_> {
    type Output = Option<usize>;

    #[inline(always)]
    fn call(self) -> Option<usize> {
        let mut deepest = Group::zero();
        let mut places = Group::splat(-1.0);
        for (place, group) in self.0.iter().enumerate() {
            let [left, right] = group.within(self.1);
            // Where a number is none, nothing is deeper.
            let depth = Group::select(left.lt(right), left, right);
            let deeper = deepest.lt(depth);
            deepest = Group::select(deeper, depth, deepest);
            places = Group::select(deeper, Group::splat(place as f64), places);
        }
        let mut found: Option<(f64, usize)> = None;
        for lane in 0..GROUP {
            let (depth, place) = (deepest.lane(lane), places.lane(lane));
            if place >= 0.0 && found.is_none_or(|(known, _)| depth > known) {
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
                let index = place as usize * GROUP + lane;
                found = Some((depth, index));
            }
        }
        found.map(|(_, index)| index)
    }
}

struct Finding<'a, F>(&'a [LegGroup], Vector, F);

impl<F: Fn(usize) -> bool> pulp::NullaryFnOnce for Finding<'_, F> {
    type Output = Option<usize>;

    #[inline(always)]
    fn call(self) -> Option<usize> {
        for (place, group) in self.0.iter().enumerate() {
            let [left, right] = group.within(self.1);
            let beside = left.le(Group::zero()) | right.le(Group::zero());
            // Also where a number is not one.
            let near = !beside;
            if near.any() {
                let lanes = (0..GROUP).filter(|lane| near.lane(*lane));
                let mut places = lanes.map(|lane| place * GROUP + lane);
                if let Some(index) = places.find(|index| (self.2)(*index)) {
                    return Some(index);
                }
            }
        }
        None
    }
}

struct Sorting<'a> {
    cones: &'a [Cone],
    legs: &'a [LegGroup],
    caps: &'a [Cap],
    whole: bool,
    near: &'a mut Vec<usize>,
    lines: &'a mut Vec<usize>,
}

impl pulp::NullaryFnOnce for Sorting<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for (place, group) in self.legs.iter().enumerate() {
            let mut near = [<Group as Number>::Mask::none(); 3];
            for cap in self.caps {
                // Also where a number is not one.
                let [left, right] = group.within(cap.center);
                let reach = cap.reach(group.tip);
                let beside = [left.lt(-reach), right.lt(-reach)];
                let within = [left.gt(reach), right.gt(reach)];
                near[0] = near[0] | !(beside[0] | beside[1]);
                let behind = if self.whole {
                    [<Group as Number>::Mask::none(); 2]
                } else {
                    group.along(cap.center).map(|along| along.lt(-reach))
                };
                near[1] = near[1] | !(beside[0] | within[0] | behind[0]);
                near[2] = near[2] | !(beside[1] | within[1] | behind[1]);
            }
            if !(near[0] | near[1] | near[2]).any() {
                continue;
            }
            for lane in 0..GROUP {
                let index = place * GROUP + lane;
                let Some(cone) = self.cones.get(index) else {
                    break;
                };
                if near[0].lane(lane) {
                    self.near.push(index);
                }
                if cone.legs.is_some() {
                    let sides = (0..2).filter(|side| near[1 + side].lane(lane));
                    self.lines.extend(sides.map(|side| 2 * index + side));
                }
            }
        }
    }
}
