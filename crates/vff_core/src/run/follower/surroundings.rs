//! Obstacles around the follower at one time.

use nalgebra::Vector2;

use crate::run::follower::scene::FollowerScene;
use crate::world::frame::Frame;
use crate::world::shape::{PlacedShape, SLACK};

/// A touch of an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// Index of the obstacle.
    pub obstacle: usize,
    /// Direction of the nearest point from the front of the robot, counterclockwise, in rad.
    pub bearing: f64,
}

/// What is known of the motion of an obstacle.
struct Track {
    /// Piece of the motion that was the last one.
    cursor: usize,
    /// When it stands for good, in s.
    stands_from: f64,
    /// Whether it does.
    stands: bool,
    /// No point of it is farther from its center, in m.
    extent: f64,
}

/// Obstacles at one time.
pub(super) struct Surroundings {
    /// The obstacles.
    pub shapes: Vec<PlacedShape>,
    /// How each of them moves.
    tracks: Vec<Track>,
    leader_cursor: usize,
    /// Those that a sensor may see.
    pub near: Vec<PlacedShape>,
    /// Squared distance of the nearest one from the center, in m^2, if it is less than ever before or
    /// within the horizon.
    pub least: f64,
    nearest: usize,
    /// No sensor can see anything that is farther from the center, in m.
    horizon: f64,
}

impl Surroundings {
    /// The obstacles of a scene at its start, for sensors up to a horizon in m.
    pub fn of(scene: &FollowerScene, horizon: f64) -> Self {
        Self {
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
                    Track {
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
    #[inline]
    pub fn look(
        &mut self,
        scene: &FollowerScene,
        time: f64,
        pose: &Frame,
        least_before: f64,
    ) -> Vector2<f64> {
        self.near.clear();
        self.least = f64::INFINITY;
        let horizon = self.horizon * self.horizon;
        // No root where the horizon is farther anyway: a step takes less than 100 ns.
        let heeded = if SLACK * SLACK * least_before > horizon {
            SLACK * least_before.sqrt()
        } else {
            self.horizon
        };
        let tracks = self.tracks.iter_mut().zip(&mut self.shapes);
        for (index, (obstacle, (track, shape))) in scene.obstacles.iter().zip(tracks).enumerate() {
            if !track.stands {
                shape.center = obstacle.motion.at(time, &mut track.cursor).position.into();
                track.stands = time >= track.stands_from;
            }
            let away = shape.center - pose.position;
            let within = heeded + track.extent;
            if away.dot(&away) > within * within {
                continue;
            }
            let to = shape.nearest(pose.position);
            let square = to.dot(&to);
            if square < self.least {
                self.least = square;
                self.nearest = index;
            }
            if square <= horizon {
                self.near.push(*shape);
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
    pub fn contact(&self, pose: &Frame) -> Touch {
        let nearest = self.shapes.get(self.nearest);
        let to = nearest.map_or(Vector2::zeros(), |shape| shape.nearest(pose.position));
        let to = pose.inward(to);
        Touch {
            obstacle: self.nearest,
            bearing: to.y.atan2(to.x),
        }
    }
}
