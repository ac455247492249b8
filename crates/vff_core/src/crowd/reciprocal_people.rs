//! People who avoid each other reciprocally, van den Berg, Guy, Lin and Manocha (2011), as `RVO2` does it.
//!
//! The half-planes of discs stand here in the form that needs no outline; [`crate::laws::reciprocal::avoiding`] is
//! the same for any shape. Half-planes of walls are never violated.

use crate::crowd::agent::{Agent, SHORTEST};
use crate::crowd::neighbors::Unnoticed;
use crate::crowd::pedestrian::{Around, Pedestrian, Room, Walker};
use crate::lanes::{Planar, Vector2};
use crate::laws::planning::half_planes::HalfPlane;

type Vector = Vector2<f64>;

/// Parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReciprocalPeople {
    /// `tau`, time without contact with others, in s.
    pub horizon: f64,
    /// The same with walls, in s.
    pub wall_horizon: f64,
    /// Nearest neighbors that are avoided.
    pub max_neighbors: usize,
    /// Added to each radius, in m.
    pub margin: f64,
    /// Distance in m beyond which nobody acts; infinite for none.
    pub cutoff: f64,
}

/// Two discs that are to avoid each other.
#[derive(Clone, Copy, Debug)]
pub struct Meeting {
    /// From the own center to the other one, in m.
    pub way: Vector,
    /// Velocity relative to the other, in m/s.
    pub relative: Vector,
    /// Sum of the radii in m.
    pub touch: f64,
}

impl Meeting {
    /// Direction of the line and change `u` of the relative velocity that avoids a contact within the horizon, or,
    /// of touching discs, ends it within a step, both in s.
    #[inline]
    #[must_use]
    pub fn avoided(&self, horizon: f64, step: f64) -> (Vector, Vector) {
        let Self {
            way,
            relative,
            touch,
        } = *self;
        let squared = way.dot(&way);
        if squared <= touch * touch {
            return self.front(relative - way / step, 1.0 / step);
        }
        let from_front = relative - way / horizon;
        let along = from_front.dot(&way);
        if along < 0.0 && along * along > touch * touch * from_front.dot(&from_front) {
            return self.front(from_front, 1.0 / horizon);
        }
        let leg = (squared - touch * touch).sqrt();
        let direction = if way.perp(&from_front) > 0.0 {
            Vector::new(way.x * leg - way.y * touch, way.x * touch + way.y * leg) / squared
        } else {
            -Vector::new(way.x * leg + way.y * touch, way.y * leg - way.x * touch) / squared
        };
        (direction, direction * relative.dot(&direction) - relative)
    }

    /// At the rounded front of the velocity obstacle.
    #[inline]
    fn front(&self, away: Vector, per_time: f64) -> (Vector, Vector) {
        let length = away.norm();
        let unit = if length == 0.0 {
            Vector::x()
        } else {
            away / length
        };
        (-unit.left_normal(), unit * (self.touch * per_time - length))
    }
}

impl ReciprocalPeople {
    /// The nearest neighbors in order, ties by number.
    fn gather(&self, own: &Walker, around: &Around<'_>, room: &mut Room) {
        let nearest = &mut room.nearest;
        nearest.clear();
        let limits = (self.cutoff, own.awareness);
        around
            .neighbors
            .each(&own.agent, limits, Unnoticed::Skipped, |neighbor| {
                let before = |entry: &(f64, Agent, f64, Vector)| {
                    entry.0 < neighbor.distance
                        || (entry.0 == neighbor.distance && entry.1.number < neighbor.agent.number)
                };
                let full = nearest.len() >= self.max_neighbors;
                if full && nearest.last().is_none_or(before) {
                    return;
                }
                if full {
                    nearest.pop();
                }
                let place = nearest
                    .iter()
                    .rposition(before)
                    .map_or(0, |index| index + 1);
                let way = if neighbor.distance < SHORTEST {
                    neighbor.normal * -SHORTEST
                } else {
                    -neighbor.offset
                };
                let entry = (neighbor.distance, *neighbor.agent, neighbor.weight, way);
                nearest.insert(place, entry);
            });
    }

    /// Half-planes of walls; returns how many there are.
    fn keep_off_walls(&self, own: &Walker, around: &Around<'_>, room: &mut Room) -> usize {
        let reach = self.wall_horizon * own.desired_speed;
        let radius = own.agent.radius + self.margin;
        room.planes.clear();
        for wall in around.walls {
            wall.each_part(own.agent.position, |near| {
                let gap = near.distance - radius;
                if gap <= reach {
                    let time = if gap < 0.0 {
                        around.step
                    } else {
                        self.wall_horizon
                    };
                    room.planes.push(HalfPlane {
                        point: near.normal * (-gap / time),
                        direction: -near.normal.left_normal(),
                    });
                }
            });
        }
        room.planes.len()
    }
}

impl Pedestrian for ReciprocalPeople {
    #[inline]
    fn decide(&self, own: &mut Walker, around: &Around<'_>, room: &mut Room) -> Vector {
        self.gather(own, around, room);
        let hard = self.keep_off_walls(own, around, room);
        let me = own.agent;
        for (_, other, weight, way) in &room.nearest {
            let meeting = Meeting {
                way: *way,
                relative: me.velocity - other.velocity,
                touch: me.radius + other.radius + 2.0 * self.margin,
            };
            let (direction, change) = meeting.avoided(self.horizon, around.step);
            room.planes.push(HalfPlane {
                point: me.velocity + change * (0.5 * weight),
                direction,
            });
        }
        let speed = own.desired_speed.min(own.to_go / around.step);
        let wanted = if own.stays {
            Vector::zeros()
        } else {
            me.direction * speed
        };
        room.solver
            .nearest(&room.planes, hard, own.desired_speed, wanted)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::planning::outline::Outline;
    use crate::laws::reciprocal::avoiding;

    #[test]
    fn half_planes_of_discs_are_those_of_outlines() {
        let mut stream = numeric::random::Stream::new(11, 0);
        let mut draw =
            |size: f64| Vector::new(stream.uniform(-size, size), stream.uniform(-size, size));
        for _ in 0..2000 {
            let (way, own, other) = (draw(3.0), draw(1.5), draw(1.5));
            let meeting = Meeting {
                way,
                relative: own - other,
                touch: 0.6,
            };
            let (direction, change) = meeting.avoided(5.0, 0.25);
            let plane = avoiding(&Outline::disc(way, 0.6, other), own, 5.0, 0.25, 0.5);
            assert!((plane.direction - direction).norm() < 1e-9, "{meeting:?}");
            assert!(
                (plane.point - own - change * 0.5).norm() < 1e-9,
                "{meeting:?}"
            );
        }
    }
}
