//! Obstacles around the follower at one time.

use nalgebra::Vector2;

use crate::run::follower::scene::FollowerScene;
use crate::world::frame::Frame;
use crate::world::shape::PlacedShape;

/// A touch of an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// Index of the obstacle.
    pub obstacle: usize,
    /// Direction of the nearest point from the front of the robot, counterclockwise, in rad.
    pub bearing: f64,
}

/// Obstacles at one time.
pub(super) struct Surroundings {
    /// The obstacles.
    pub shapes: Vec<PlacedShape>,
    /// Pieces of the motions that were the last ones.
    cursors: Vec<usize>,
    leader_cursor: usize,
    /// Those that a sensor may see.
    pub near: Vec<PlacedShape>,
    /// Squared distance of the nearest one from the center, in m^2.
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
            cursors: vec![0; scene.obstacles.len()],
            leader_cursor: 0,
            near: Vec::with_capacity(scene.obstacles.len() + 1),
            least: f64::INFINITY,
            nearest: 0,
            horizon,
        }
    }

    /// Puts the obstacles where they are; returns the place of the source in m.
    #[inline]
    pub fn look(&mut self, scene: &FollowerScene, time: f64, pose: &Frame) -> Vector2<f64> {
        self.near.clear();
        self.least = f64::INFINITY;
        let horizon = self.horizon * self.horizon;
        let cursors = self.cursors.iter_mut();
        for (index, (obstacle, cursor)) in scene.obstacles.iter().zip(cursors).enumerate() {
            let shape = obstacle.at(time, cursor);
            let to = shape.nearest(pose.position);
            let square = to.dot(&to);
            if square < self.least {
                self.least = square;
                self.nearest = index;
            }
            if square <= horizon {
                self.near.push(shape);
            }
            self.shapes[index] = shape;
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
