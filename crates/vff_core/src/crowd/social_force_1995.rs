//! Social force model of Helbing and Molnar, Physical Review E 51 (1995) 4282.
//!
//! A neighbor repels with a potential `V0 exp(-b/sigma)` whose lines are ellipses along the way `y` that the
//! neighbor takes within `dt_s`: `2 b = sqrt((d + |r - y|)^2 - |y|^2)`. The force is its exact gradient.

use crate::crowd::agent::SHORTEST;
use crate::crowd::neighbors::Unnoticed;
use crate::crowd::others::{Each, Others};
use crate::crowd::pedestrian::{Around, Pedestrian, Room, Walker, drive};
use crate::crowd::walls::pushes;
use crate::lanes::{Mask, Planar, Real, Vector2};
use numeric::elementary::exp;

type Vector = Vector2<f64>;

/// Squared axis `2 b` below which somebody stands on the way of the neighbor, in m^2.
const ON_THE_WAY: f64 = 1e-12;

/// Parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SocialForce1995 {
    /// `tau` in s.
    pub relaxation_time: f64,
    /// `V0` in m^2/s^2.
    pub strength: f64,
    /// `sigma` in m.
    pub range: f64,
    /// `dt_s` in s.
    pub step_time: f64,
    /// `U0` in m^2/s^2.
    pub wall_strength: f64,
    /// `R` in m.
    pub wall_range: f64,
    /// `phi`, half the angle of view, in rad.
    pub view_angle: f64,
    /// `c`, weight of what is out of view.
    pub behind: f64,
    /// Distance in m beyond which nobody acts; infinite for none.
    pub cutoff: f64,
}

impl SocialForce1995 {
    /// Forces of neighbors, before weights.
    #[inline(always)]
    fn push(&self, others: &Others<'_>) -> Vector2<Each> {
        let unit = self.strength / self.range;
        let speed = Planar::<Each>::length(others.velocity());
        let way = others.direction() * (speed * Each::splat(self.step_time));
        let apart = others.offset - way;
        let far = Planar::<Each>::length(apart);
        let sum = others.distance + far;
        let squared = sum * sum - way.dot(&way);
        let axis = Each::splat(0.5) * squared.sqrt();
        let decay = exp(-axis / Each::splat(self.range));
        let size = Each::splat(unit) * decay * sum / (Each::splat(4.0) * axis);
        let mut push = (others.normal + Planar::<Each>::over(apart, far)) * size;
        let shortest = Each::splat(SHORTEST);
        let (met, reached) = (others.distance.lt(shortest), far.lt(shortest));
        let passing = squared.lt(Each::splat(ON_THE_WAY));
        if (met | reached | passing).any() {
            // Those who meet exactly head-on pass on their right.
            let side = Each::splat(4.0) * others.distance * far;
            let aside = way.left_normal() * (Each::splat(unit) / side.sqrt());
            push = Planar::<Each>::select(passing, aside, push);
            push = Planar::<Each>::select(reached, Vector2::zeros(), push);
            push = Planar::<Each>::select(met, others.normal * Each::splat(unit), push);
        }
        push
    }
}

impl Pedestrian for SocialForce1995 {
    #[inline(always)]
    fn decide(&self, own: &mut Walker, around: &Around<'_>, room: &mut Room) -> Vector {
        let cosine = Each::splat(self.view_angle.cos());
        let mut force = drive(own, self.relaxation_time);
        let ahead: Vector2<Each> = Planar::<Each>::splat(own.agent.direction.into());
        let limits = (self.cutoff, own.awareness);
        let neighbors = around.neighbors;
        for others in neighbors.near(&own.agent, limits, Unnoticed::Skipped, &mut room.near) {
            let push = self.push(&others);
            let seen = (-ahead.dot(&push)).ge(Planar::<Each>::length(push) * cosine);
            let view = Each::select(seen, Each::splat(1.0), Each::splat(self.behind));
            others.add(push * (others.weight * view), &mut force);
        }
        let wall = self.wall_strength / self.wall_range;
        force
            + pushes(around.walls, own.agent.position, |near| {
                near.normal * (wall * (-near.distance / self.wall_range).exp())
            })
    }
}
