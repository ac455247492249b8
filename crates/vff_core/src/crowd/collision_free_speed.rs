//! Collision-free speed model of Tordeux, Chraibi and Seyfried, Traffic and Granular Flow '15 (2016) 225, with the
//! numbers of `JuPedSim`. People behind walls count, too.

use crate::crowd::agent::SHORTEST;
use crate::crowd::neighbors::Unnoticed;
use crate::crowd::pedestrian::{Around, Pedestrian, Room, Walker};
use crate::crowd::walls::pushes;
use crate::lanes::Vector2;

type Vector = Vector2<f64>;

/// Parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CollisionFreeSpeed {
    /// `T`, time gap to whoever is ahead, in s.
    pub time_gap: f64,
    /// `a` of people.
    pub strength: f64,
    /// `D` of people, in m.
    pub range: f64,
    /// `a` of walls.
    pub wall_strength: f64,
    /// `D` of walls, in m.
    pub wall_range: f64,
    /// Distance in m beyond which nobody acts; infinite for none.
    pub cutoff: f64,
}

impl CollisionFreeSpeed {
    /// Direction in which a person walks: `e` turned by the others.
    fn heading(&self, own: &Walker, around: &Around<'_>) -> Vector {
        let me = &own.agent;
        let mut sum = me.direction;
        let limits = (self.cutoff, own.awareness);
        around
            .neighbors
            .each(me, limits, Unnoticed::Skipped, |neighbor| {
                let overlap = me.radius + neighbor.agent.radius - neighbor.distance;
                let size = self.strength * (overlap / self.range).exp();
                sum += neighbor.normal * (neighbor.weight * size);
            });
        sum += pushes(around.walls, me.position, |near| {
            let overlap = me.radius - near.distance;
            near.normal * (self.wall_strength * (overlap / self.wall_range).exp())
        });
        let length = sum.norm();
        if length < SHORTEST {
            own.heading
        } else {
            sum / length
        }
    }

    /// Way in m that is free ahead.
    fn spacing(&self, own: &Walker, around: &Around<'_>) -> f64 {
        let (me, ahead) = (&own.agent, own.heading);
        let mut least = f64::INFINITY;
        let limits = (self.cutoff, own.awareness);
        around
            .neighbors
            .each(me, limits, Unnoticed::Skipped, |neighbor| {
                let touch = me.radius + neighbor.agent.radius;
                let offset = neighbor.offset;
                if -ahead.dot(&offset) >= 0.0 && ahead.perp(&offset).abs() <= touch {
                    least = least.min((neighbor.distance - touch) / neighbor.weight);
                }
            });
        least
    }
}

impl Pedestrian for CollisionFreeSpeed {
    #[inline]
    fn decide(&self, own: &mut Walker, around: &Around<'_>, _room: &mut Room) -> Vector {
        if own.stays {
            return Vector::zeros();
        }
        own.heading = self.heading(own, around);
        let speed = self.spacing(own, around) / self.time_gap;
        own.heading * speed.max(0.0).min(own.desired_speed)
    }
}
