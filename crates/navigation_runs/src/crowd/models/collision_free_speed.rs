//! Collision-free speed model of Tordeux, Chraibi and Seyfried, Traffic and Granular Flow '15 (2016) 225, with the
//! numbers of `JuPedSim`. People behind walls count, too.

use crate::crowd::agent::SHORTEST;
use crate::crowd::models::parameters::Parameters;
use crate::crowd::neighbors::Unnoticed;
use crate::crowd::neighbors::others::Each;
use crate::crowd::pedestrian::{Around, Pedestrian, Room, SeenBody, Walker};
use crate::crowd::walls::pushes;
use navigation_world::arguments::{Arguments, Named};
use numeric::elementary::exp;
use numeric::error::Result;
use numeric::lanes::{Number, Planar, Real, Vector2, Zero};

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

impl Named for CollisionFreeSpeed {
    const NAME: &'static str = "collision_free_speed";

    fn made_of(given: &dyn Arguments) -> Result<Self> {
        let given = Parameters(given);
        Ok(Self {
            time_gap: given.positive("time_gap")?,
            strength: given.not_negative("strength")?,
            range: given.positive("range")?,
            wall_strength: given.not_negative("wall_strength")?,
            wall_range: given.positive("wall_range")?,
            cutoff: given.cutoff()?,
        })
    }
}

impl CollisionFreeSpeed {
    /// Direction in which a person walks: `e` turned by the others, who are kept.
    #[inline(always)]
    fn heading(&self, own: &Walker, around: &Around<'_>, room: &mut Room) -> Vector {
        let me = &own.agent;
        let mut sum = me.direction;
        let limits = (self.cutoff, own.awareness);
        let (neighbors, Room { near, ahead, .. }) = (around.neighbors, room);
        ahead.clear();
        for others in neighbors.near(me, limits, Unnoticed::Skipped, near) {
            let touch = Each::splat(me.radius) + others.radius();
            let overlap = touch - others.distance;
            let size = Each::splat(self.strength) * exp(overlap / Each::splat(self.range));
            others.add(others.normal * (others.weight * size), &mut sum);
            let gap = (others.distance - touch) / others.weight;
            ahead.push(SeenBody {
                offset: others.offset,
                gap: Each::select(others.present(), gap, Each::splat(f64::INFINITY)),
                touch,
            });
        }
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
}

/// Way in m that is free ahead.
#[inline(always)]
fn spacing(ahead: Vector, bodies: &[SeenBody]) -> f64 {
    let ahead: Vector2<Each> = Planar::<Each>::splat(ahead.into());
    let mut least = Each::splat(f64::INFINITY);
    for body in bodies {
        let before = (-ahead.dot(&body.offset)).ge(Each::zero());
        let across = ahead.x * body.offset.y - ahead.y * body.offset.x;
        let met = before & across.abs().le(body.touch);
        least = Each::select(met, body.gap, Each::splat(f64::INFINITY)).min(least);
    }
    let lanes = (0..Each::WIDTH).map(|lane| least.lane(lane));
    lanes.fold(f64::INFINITY, f64::min)
}

impl Pedestrian for CollisionFreeSpeed {
    const LARGEST_STEP: f64 = 0.05;
    const CAP: f64 = 1.0;
    const IS_FORCE: bool = false;

    #[inline(always)]
    fn decide(&self, own: &mut Walker, around: &Around<'_>, room: &mut Room) -> Vector {
        if own.stays {
            return Vector::zeros();
        }
        own.heading = self.heading(own, around, room);
        let speed = spacing(own.heading, &room.ahead) / self.time_gap;
        own.heading * speed.max(0.0).min(own.desired_speed)
    }
}
