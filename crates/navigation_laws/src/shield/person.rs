//! Assumptions of the shield about a person: position, and bounds of the motion.

use crate::shield::half_disc::{Look, half_disc_distance};
use navigation_world::world::shape::{PlacedShape, Shape, into_axes};
use numeric::lanes::Vector2;

/// Bounds on a velocity that is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KnownVelocity {
    /// `w` in m/s.
    pub velocity: Vector2<f64>,
    /// Largest error `e_v` in m/s.
    pub error: f64,
    /// Largest acceleration `a` in m/s^2.
    pub acceleration: f64,
}

/// Somebody, or something that moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Person {
    /// Outline where it was measured, `o`.
    pub placed: PlacedShape,
    /// Largest error `e` of the position in m.
    pub position_error: f64,
    /// Largest speed `v` in m/s.
    pub max_speed: f64,
    /// Age `L` of the measurement when the command takes effect, in s.
    pub latency: f64,
    /// The velocity, if it is known.
    pub known: Option<KnownVelocity>,
}

impl Person {
    /// A disc with a radius in m.
    #[must_use]
    pub fn disc(position: [f64; 2], radius: f64) -> Self {
        Self {
            placed: PlacedShape::disc(position, radius),
            position_error: 0.0,
            max_speed: 1.6,
            latency: 0.0,
            known: None,
        }
    }

    /// Part of the distance that lies inside the outline around [`Self::clearance_from`]'s point.
    pub(super) fn radius(&self) -> f64 {
        self.placed.shape.inner_radius()
    }

    /// Farthest that he can have come from `o` by a time after the command takes effect, in m.
    #[inline(always)]
    pub(crate) fn reach(&self, time: f64) -> f64 {
        self.position_error + self.max_speed * (self.latency + time)
    }

    /// Largest speed at which what is known of him can come nearer until a time, in m/s; infinite where
    /// nothing is known.
    pub(super) fn rate(&self, until: f64) -> f64 {
        let Some(known) = &self.known else {
            return self.max_speed;
        };
        let spread = known.error + known.acceleration * (self.latency + until);
        let rate = known.velocity.norm() + spread;
        // Who may have any speed is where his velocity lets him be.
        if self.max_speed == f64::INFINITY {
            rate
        } else {
            rate.max(self.max_speed)
        }
    }

    /// `g`: distance of the half disc ahead from everywhere that he can be at a time, in m;
    /// negative where he can be inside.
    #[inline(always)]
    pub(super) fn clearance(
        &self,
        place: Vector2<f64>,
        radius: f64,
        look: &Look,
        time: f64,
    ) -> f64 {
        let worst = self.distance(place, radius, look, Vector2::zeros()) - self.reach(time);
        let Some(known) = &self.known else {
            return worst;
        };
        let age = self.latency + time;
        let way = known.velocity * age;
        let spread = self.position_error + (known.error + 0.5 * known.acceleration * age) * age;
        worst.max(self.distance(place, radius, look, way) - spread)
    }

    /// `g` of any set, by its distance from the center when that is moved by a way, in m.
    pub(super) fn beyond(&self, time: f64, distance: impl Fn(Vector2<f64>) -> f64) -> f64 {
        let worst = distance(Vector2::zeros()) - self.reach(time);
        let Some(known) = &self.known else {
            return worst;
        };
        let age = self.latency + time;
        let spread = self.position_error + (known.error + 0.5 * known.acceleration * age) * age;
        worst.max(distance(known.velocity * age) - spread)
    }

    /// Distance of the outline, moved by a way, from the half discs of a look; of rectangles a lower bound.
    #[inline(always)]
    fn distance(&self, place: Vector2<f64>, radius: f64, look: &Look, way: Vector2<f64>) -> f64 {
        let center = self.placed.center + way;
        match self.placed.shape {
            Shape::Disc { .. } => {
                let offset = center - place;
                half_disc_distance(offset, radius, look.toward(offset))
            }
            Shape::Rectangle {
                half_length,
                half_width,
                axis,
            } => {
                // Two sets that hold a half disc: the disc and the half plane.
                let offset = self.placed.shape.offset(place - center);
                let behind = |ahead: Vector2<f64>| {
                    let local = into_axes(ahead, axis);
                    let extent = local.x.abs() * half_length + local.y.abs() * half_width;
                    -(center - place).dot(&ahead) - extent
                };
                let [one, other] = look.ends().map(behind);
                (offset.norm() - radius).max(one.min(other)).max(0.0)
            }
        }
    }
}
