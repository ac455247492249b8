//! Model of Moussaid et al., Proceedings of the Royal Society B 276 (2009) 2755, with the groups of Moussaid et al.,
//! `PLoS` ONE 5 (2010) e10047.
//!
//! The angle between line of sight and interaction direction is wrapped into (-pi, pi] before the bias `epsilon B` is
//! added: other programs leave it out and turn people the wrong way.

use std::f64::consts::PI;

use crate::crowd::agent::SHORTEST;
use crate::crowd::neighbors::Unnoticed;
use crate::crowd::pedestrian::{Around, Pedestrian, Room, Walker, drive};
use crate::crowd::walls::pushes;
use crate::lanes::{Planar, Vector2};

type Vector = Vector2<f64>;

/// Parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moussaid {
    /// `tau` in s.
    pub relaxation_time: f64,
    /// `A` in m/s^2.
    pub strength: f64,
    /// `gamma`.
    pub gamma: f64,
    /// `n`, how narrow the turning is.
    pub n: f64,
    /// `n'`, how narrow the slowing is.
    pub n_prime: f64,
    /// `lambda`, weight of the relative velocity, in s/m.
    pub velocity_weight: f64,
    /// `epsilon`, bias to one side.
    pub side_bias: f64,
    /// Push of walls in m/s^2.
    pub wall_strength: f64,
    /// Range of walls in m.
    pub wall_range: f64,
    /// `beta_1` in 1/(s rad).
    pub gaze: f64,
    /// `beta_2` in m/s^2.
    pub cohesion: f64,
    /// `beta_3` in m/s^2.
    pub separation: f64,
    /// `phi`, half the angle of view in groups, in rad.
    pub view_angle: f64,
    /// `d0`, distance that members of a group keep, in m.
    pub contact_distance: f64,
    /// Distance in m beyond which nobody acts; infinite for none.
    pub cutoff: f64,
}

impl Moussaid {
    /// Acceleration by somebody at distance `d` in direction `-n`, with the velocity relative to him in m/s.
    #[inline(always)]
    #[must_use]
    pub fn push(&self, normal: Vector, distance: f64, relative: Vector) -> Vector {
        let sight = -normal;
        let interaction = relative * self.velocity_weight + sight;
        let length = interaction.norm();
        if length < SHORTEST {
            return Vector::zeros();
        }
        let along = interaction / length;
        let reach = self.gamma * length;
        let mut angle = sight.perp(&along).atan2(sight.dot(&along));
        if angle <= -PI {
            angle = PI;
        }
        let theta = angle + self.side_bias * reach;
        let bell = |narrow: f64| {
            let argument = narrow * reach * theta;
            (-argument * argument).exp()
        };
        let size = self.strength * (-distance / reach).exp();
        let side = if theta == 0.0 { 0.0 } else { theta.signum() };
        (along.left_normal() * (side * bell(self.n)) - along * bell(self.n_prime)) * size
    }

    /// Acceleration by the group of a person.
    fn group(&self, own: &Walker, around: &Around<'_>) -> Vector {
        let found = around.company.company(&own.agent, self.contact_distance);
        if found.members < 2 {
            return Vector::zeros();
        }
        let members = found.members as f64;
        let center = found.ways / members;
        let mut force = found.crowding * self.separation;
        let away = center.norm();
        if away > 0.5 * (members - 1.0) {
            force += center * (self.cohesion / away);
        }
        let others = found.ways / (members - 1.0);
        let ahead = own.agent.direction;
        if others.norm() > 0.0 && ahead != Vector::zeros() {
            let angle = ahead.perp(&others).abs().atan2(ahead.dot(&others));
            let turned = (angle - self.view_angle).max(0.0);
            force -= own.agent.velocity * (self.gaze * turned);
        }
        force
    }
}

impl Pedestrian for Moussaid {
    #[inline]
    fn decide(&self, own: &mut Walker, around: &Around<'_>, _room: &mut Room) -> Vector {
        let mut force = drive(own, self.relaxation_time);
        let velocity = own.agent.velocity;
        let limits = (self.cutoff, own.awareness);
        around
            .neighbors
            .each(&own.agent, limits, Unnoticed::Skipped, |neighbor| {
                let relative = velocity - neighbor.agent.velocity;
                let push = self.push(neighbor.normal, neighbor.distance, relative);
                force += push * neighbor.weight;
            });
        force += pushes(around.walls, own.agent.position, |near| {
            near.normal * (self.wall_strength * (-near.distance / self.wall_range).exp())
        });
        force + self.group(own, around)
    }
}
