//! Social force model of Helbing and Molnar, Physical Review E 51 (1995) 4282.
//!
//! A neighbor repels with a potential `V0 exp(-b/sigma)` whose lines are ellipses along the way `y` that the
//! neighbor takes within `dt_s`: `2 b = sqrt((d + |r - y|)^2 - |y|^2)`. The force is its exact gradient.

use crate::crowd::agent::SHORTEST;
use crate::crowd::neighbors::{Other, Unnoticed};
use crate::crowd::pedestrian::{Around, Pedestrian, Room, Walker, drive};
use crate::crowd::walls::pushes;
use crate::lanes::{Planar, Vector2};

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
    /// Force of a neighbor, before weights.
    #[inline(always)]
    fn push(&self, neighbor: &Other<'_>) -> Vector {
        let unit = self.strength / self.range;
        if neighbor.distance < SHORTEST {
            return neighbor.normal * unit;
        }
        let other = neighbor.agent;
        let way = other.direction * (other.velocity.norm() * self.step_time);
        let apart = neighbor.offset - way;
        let far = apart.norm();
        if far < SHORTEST {
            return Vector::zeros();
        }
        let sum = neighbor.distance + far;
        let squared = sum * sum - way.dot(&way);
        if squared < ON_THE_WAY {
            // Those who meet exactly head-on pass on their right.
            return way.left_normal() * (unit / (4.0 * neighbor.distance * far).sqrt());
        }
        let axis = 0.5 * squared.sqrt();
        let size = unit * (-axis / self.range).exp() * sum / (4.0 * axis);
        (neighbor.normal + apart / far) * size
    }
}

impl Pedestrian for SocialForce1995 {
    #[inline]
    fn decide(&self, own: &mut Walker, around: &Around<'_>, _room: &mut Room) -> Vector {
        let cosine = self.view_angle.cos();
        let mut force = drive(own, self.relaxation_time);
        let ahead = own.agent.direction;
        let limits = (self.cutoff, own.awareness);
        around
            .neighbors
            .each(&own.agent, limits, Unnoticed::Skipped, |neighbor| {
                let push = self.push(neighbor);
                let seen = -ahead.dot(&push) >= push.norm() * cosine;
                let view = if seen { 1.0 } else { self.behind };
                force += push * (neighbor.weight * view);
            });
        let wall = self.wall_strength / self.wall_range;
        force
            + pushes(around.walls, own.agent.position, |near| {
                near.normal * (wall * (-near.distance / self.wall_range).exp())
            })
    }
}
