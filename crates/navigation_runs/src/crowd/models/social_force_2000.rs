//! Social force model of Helbing, Farkas and Vicsek, Nature 407 (2000) 487.
//!
//! Bodies repel with `A exp(g/B)`, `g = rho_i + rho_j - d`; those that touch (`g > 0`) press with `k g` and rub with
//! `kappa g` times the difference of their velocities along the tangent. Friction at walls brakes, as printed.

use crate::crowd::agent::SHORTEST;
use crate::crowd::models::parameters::Parameters;
use crate::crowd::neighbors::Unnoticed;
use crate::crowd::neighbors::others::Each;
use crate::crowd::pedestrian::{Around, Pedestrian, Room, Walker, drive};
use crate::crowd::walls::pushes;
use navigation_world::arguments::{Arguments, Named};
use numeric::elementary::exp;
use numeric::error::Result;
use numeric::lanes::{Number, Planar, Real, Truth, Vector2, Zero};

type Vector = Vector2<f64>;

/// Parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SocialForce2000 {
    /// `tau` in s.
    pub relaxation_time: f64,
    /// `m` in kg.
    pub mass: f64,
    /// `A` of people, in N.
    pub strength: f64,
    /// `B` in m.
    pub range: f64,
    /// `k` in kg/s^2.
    pub stiffness: f64,
    /// `kappa` in kg/(m s).
    pub friction: f64,
    /// `lambda`, weight of what is behind: 1 for none of the direction.
    pub anisotropy: f64,
    /// `A` of walls, in N.
    pub wall_strength: f64,
    /// Distance in m beyond which nobody acts; infinite for none.
    pub cutoff: f64,
}

impl Named for SocialForce2000 {
    const NAME: &'static str = "social_force_2000";

    fn made_of(given: &dyn Arguments) -> Result<Self> {
        let given = Parameters(given);
        Ok(Self {
            relaxation_time: given.positive("relaxation_time")?,
            mass: given.positive("mass")?,
            strength: given.not_negative("strength")?,
            range: given.positive("range")?,
            stiffness: given.not_negative("stiffness")?,
            friction: given.not_negative("friction")?,
            anisotropy: given.not_negative("anisotropy")?,
            wall_strength: given.not_negative("wall_strength")?,
            cutoff: given.cutoff()?,
        })
    }
}

impl Pedestrian for SocialForce2000 {
    const LARGEST_STEP: f64 = 0.01;
    const CAP: f64 = f64::INFINITY;
    const IS_FORCE: bool = true;

    #[inline(always)]
    fn decide(&self, own: &mut Walker, around: &Around<'_>, room: &mut Room) -> Vector {
        let me = own.agent;
        let speed = me.velocity.norm();
        let ahead = if speed < SHORTEST {
            me.direction
        } else {
            me.velocity / speed
        };
        let mut force = Vector::zeros();
        let ahead: Vector2<Each> = Planar::<Each>::splat(ahead.into());
        let front = Each::splat(self.anisotropy);
        let rest = Each::splat(0.5 * (1.0 - self.anisotropy));
        let limits = (self.cutoff, own.awareness);
        let neighbors = around.neighbors;
        for others in neighbors.near(&me, limits, Unnoticed::Told, &mut room.near) {
            let normal = others.normal;
            let overlap = Each::splat(me.radius) + others.radius() - others.distance;
            let behind = rest * (Each::splat(1.0) - normal.dot(&ahead));
            let size = Each::splat(self.strength) * exp(overlap / Each::splat(self.range));
            let push = normal * (others.weight * size * (front + behind));
            let touching = Each::zero().lt(overlap) & others.present();
            if !touching.any() {
                others.add(push, &mut force);
                continue;
            }
            // Whoever touches acts whether noticed or not.
            for lane in 0..others.count {
                if others.weight.lane(lane) > 0.0 {
                    force += Vector::from(push.lane(lane));
                }
                if touching.lane(lane) {
                    let (normal, overlap) = (Vector::from(normal.lane(lane)), overlap.lane(lane));
                    let tangent = normal.left_normal();
                    let sliding = (others.agents[lane].velocity - me.velocity).dot(&tangent);
                    force += normal * (self.stiffness * overlap);
                    force += tangent * (self.friction * overlap * sliding);
                }
            }
        }
        force += pushes(around.walls, me.position, |near| {
            let overlap = me.radius - near.distance;
            let mut size = self.wall_strength * (overlap / self.range).exp();
            if overlap <= 0.0 {
                return near.normal * size;
            }
            size += self.stiffness * overlap;
            let tangent = near.normal.left_normal();
            let rubbing = self.friction * overlap * me.velocity.dot(&tangent);
            near.normal * size - tangent * rubbing
        });
        drive(own, self.relaxation_time) + force / self.mass
    }
}
