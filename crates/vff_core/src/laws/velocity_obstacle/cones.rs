//! Velocities that obstacles forbid.

use super::Vector;
use crate::lanes::{Lanes, Mask, Planar, Real, Vector2};
use crate::laws::planning::outline::Legs;

/// Discs that are looked at side by side.
const GROUP: usize = 4;
type Group = Lanes<GROUP>;

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

/// Draws the legs of all discs.
pub(super) fn draw_legs(cones: &mut [Cone]) {
    pulp::Arch::new().dispatch(Drawing(cones));
}

/// Draws the legs of discs side by side, compiled for the instructions of the processor; their bits are the same
/// for all.
struct Drawing<'a>(&'a mut [Cone]);

impl pulp::NullaryFnOnce for Drawing<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for group in self.0.chunks_mut(GROUP) {
            draw_group(group);
        }
    }
}

#[inline(always)]
fn draw_group(cones: &mut [Cone]) {
    let disc = |lane: usize| match cones.get(lane).map(|cone| cone.base) {
        Some(ConeBase::Disc(center, radius)) => [center.x, center.y, radius],
        // In place of what is no disc.
        _ => [1.0, 0.0, 0.0],
    };
    let discs: [[f64; 3]; GROUP] = std::array::from_fn(disc);
    let [x, y, radius] = [0, 1, 2].map(|of| Group::from_fn(|lane| discs[lane][of]));
    let center = Vector2::new(x, y);
    let touched = center.dot(&center).le(radius * radius);
    let legs = Legs::of_disc(center, radius);
    for (lane, cone) in cones.iter_mut().enumerate() {
        if matches!(cone.base, ConeBase::Disc(..)) && !touched.lane(lane) {
            cone.legs = Some(Legs {
                left: legs.left.lane(lane).into(),
                right: legs.right.lane(lane).into(),
                left_reach: legs.left_reach.lane(lane),
                right_reach: legs.right_reach.lane(lane),
            });
        }
    }
}
