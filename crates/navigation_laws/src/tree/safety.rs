//! Whether a velocity leaves room to stop.

use crate::Situation;
use crate::planning::outline::Outline;
use numeric::lanes::{Planar, Vector2};

type Vector = Vector2<f64>;

/// Pieces that the braking is cut into.
const PIECES: u32 = 4;

/// Limits of the robot.
#[derive(Clone, Copy, Debug)]
pub struct Stopping {
    /// Radius in m.
    pub radius: f64,
    /// Acceleration in m/s^2 that it has in every direction.
    pub max_acceleration: f64,
}

impl Stopping {
    /// Whether a robot that takes up a velocity as fast as it can, keeps it until the next sample
    /// and then brakes to rest, touches no obstacle that keeps its velocity. An obstacle that
    /// it touches already must be left.
    ///
    /// Braking is checked in pieces of constant velocity; the radius is enlarged by how far the
    /// true way deviates from them, `a dt^2/8` each.
    #[must_use]
    pub fn is_safe(&self, situation: &Situation<'_, f64>, wanted: [f64; 2]) -> bool {
        let robot = &situation.robot;
        let velocity = self.taken_up(robot.velocity, Vector::splat(wanted), situation.interval);
        let speed = velocity.dot(&velocity).sqrt();
        let piece = speed / self.max_acceleration / f64::from(PIECES);
        let slack = self.max_acceleration * piece * piece / 8.0;
        situation
            .bodies
            .iter()
            .filter(|body| body.state.present)
            .all(|body| {
                let mut outline = Outline::new(body, robot.position, self.radius, slack);
                let own = outline.velocity;
                let mut step = |velocity: Vector, time: f64| {
                    let relative = velocity - own;
                    let touched = outline.time_to_contact(relative) <= time && time > 0.0;
                    outline = outline.seen_after(relative * time);
                    !touched
                };
                step(velocity, situation.interval)
                    && (0..PIECES).all(|number| {
                        let left = 1.0 - (f64::from(number) + 0.5) / f64::from(PIECES);
                        step(velocity * left, piece)
                    })
            })
    }

    /// Velocity at the next sample when another one is wanted.
    fn taken_up(&self, from: Vector, wanted: Vector, interval: f64) -> Vector {
        let change = wanted - from;
        let needed = change.dot(&change).sqrt();
        let most = self.max_acceleration * interval;
        if needed <= most {
            wanted
        } else {
            from + change * (most / needed)
        }
    }
}
