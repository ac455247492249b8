//! Obstacles around the follower at one time.

use nalgebra::Vector2;

use crate::run::follower::scene::FollowerScene;
use crate::run::way::Way;
use navigation_world::world::frame::Frame;
use navigation_world::world::shape::{PlacedShape, SLACK, Shape};

/// A touch of an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObstacleTouch {
    /// Index of the obstacle.
    pub obstacle: usize,
    /// Direction of the nearest point from the front of the robot, counterclockwise, in rad.
    pub bearing: f64,
}

/// Estimated motion of an obstacle.
struct ObstacleTrack {
    /// Piece of the motion that was the last one.
    cursor: usize,
    /// When it stands for good, in s.
    stands_from: f64,
    /// Set for an obstacle that moves.
    stands: bool,
    /// No point of it is farther from its center, in m.
    extent: f64,
}

/// Obstacles at one time.
pub(super) struct FollowerObstacles {
    /// The obstacles.
    pub shapes: Vec<PlacedShape>,
    /// How each of them moves.
    tracks: Vec<ObstacleTrack>,
    leader_cursor: usize,
    /// Obstacles that a sensor may see.
    pub near: Vec<PlacedShape>,
    /// Squared distance of the nearest one from the center, in m^2, if it is less than ever before or
    /// within the horizon.
    pub least: f64,
    nearest: usize,
    /// From the center to the nearest one where it was touched, in m, if that was between two looks.
    passed: Option<Vector2<f64>>,
    /// Where the robot was at the last look, in m, and when, in s.
    last: Option<(Vector2<f64>, f64)>,
    /// Radius of the body in m.
    body: f64,
    /// No sensor can see anything that is farther from the center, in m.
    horizon: f64,
}

impl FollowerObstacles {
    /// The obstacles of a scene at its start, around a body of a radius in m with sensors up to a horizon in m.
    pub fn of(scene: &FollowerScene, body: f64, horizon: f64) -> Self {
        Self {
            passed: None,
            last: None,
            body,
            shapes: scene
                .obstacles
                .iter()
                .map(|each| each.at(0.0, &mut 0))
                .collect(),
            tracks: scene
                .obstacles
                .iter()
                .map(|each| {
                    let stands_from = each.motion.stands_from();
                    ObstacleTrack {
                        cursor: 0,
                        stands_from,
                        stands: stands_from <= 0.0,
                        extent: SLACK * each.shape.extent(),
                    }
                })
                .collect(),
            leader_cursor: 0,
            near: Vec::with_capacity(scene.obstacles.len() + 1),
            least: f64::INFINITY,
            nearest: 0,
            horizon,
        }
    }

    /// Puts the obstacles where they are; returns the place of the source in m. Who is beyond the
    /// horizon, and farther than the square root of `least_before`, in m^2, is only known to be so.
    ///
    /// Since the last look the robot and the obstacles have moved straight: who was touched on the way is the
    /// nearest one, with the least distance of the way.
    #[inline]
    pub fn look(
        &mut self,
        scene: &FollowerScene,
        time: f64,
        pose: &Frame,
        least_before: f64,
    ) -> Vector2<f64> {
        self.near.clear();
        (self.least, self.passed) = (f64::INFINITY, None);
        let (from, since) = self.last.unwrap_or((pose.position, time));
        self.last = Some((pose.position, time));
        let horizon = self.horizon * self.horizon;
        // No root where the horizon is farther anyway: a step takes less than 100 ns.
        let heeded = if SLACK * SLACK * least_before > horizon {
            SLACK * least_before.sqrt()
        } else {
            self.horizon
        };
        let tracks = self.tracks.iter_mut().zip(&mut self.shapes);
        for (index, (obstacle, (track, shape))) in scene.obstacles.iter().zip(tracks).enumerate() {
            let mut way = Way {
                shape: shape.shape,
                from: from - shape.center,
                to: Vector2::zeros(),
            };
            if !track.stands {
                shape.center = obstacle.motion.at(time, &mut track.cursor).position.into();
                track.stands = time >= track.stands_from;
                if obstacle.motion.jumps([since, time]) {
                    way.from = pose.position - shape.center;
                }
            }
            let away = shape.center - pose.position;
            way.to = -away;
            // At least as long as the way.
            let stride = (way.to - way.from).abs().sum();
            let within = heeded + track.extent + stride;
            if away.dot(&away) > within * within {
                continue;
            }
            let to = shape.nearest(pose.position);
            let square = to.dot(&to);
            if square < self.least {
                (self.least, self.nearest, self.passed) = (square, index, None);
            }
            if square <= horizon {
                self.near.push(*shape);
            }
            let may_touch = self.body + stride;
            if square < may_touch * may_touch
                && stride > 0.0
                && let Some((passed, to)) = touch_between(&way, self.body)
                && passed < self.least
            {
                (self.least, self.nearest, self.passed) = (passed, index, Some(to));
            }
        }
        let leader = &scene.leader;
        let source = leader
            .motion
            .at(time, &mut self.leader_cursor)
            .position
            .into();
        if let Some(shape) = leader.shape {
            self.near.push(PlacedShape {
                center: source,
                shape,
            });
        }
        source
    }

    /// The touch of the nearest obstacle.
    pub fn contact(&self, pose: &Frame) -> ObstacleTouch {
        let nearest = self.shapes.get(self.nearest);
        let to = nearest.map_or(Vector2::zeros(), |shape| shape.nearest(pose.position));
        let to = pose.inward(self.passed.unwrap_or(to));
        ObstacleTouch {
            obstacle: self.nearest,
            bearing: to.y.atan2(to.x),
        }
    }
}

/// A touch of a body of a radius in m on the way past an obstacle, unless they touch where the way ends: the least
/// squared distance in m^2, and the direction of the obstacle where it is first touched.
#[cold]
fn touch_between(way: &Way, body: f64) -> Option<(f64, Vector2<f64>)> {
    let radius = match way.shape {
        Shape::Disc { radius } => radius,
        Shape::Rectangle { .. } => 0.0,
    };
    let reach = radius + body;
    if way.offset(1.0).norm() < reach {
        return None;
    }
    let met = way.contact(reach, false)?;
    let least = (met.least - radius).max(0.0);
    Some((least * least, -way.offset(met.shares[0])))
}
