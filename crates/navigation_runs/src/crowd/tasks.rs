//! Tasks of robots beside a person: the goal of the law moves with the person.

use crate::crowd::agent::direction_of;
use numeric::lanes::{Planar, Vector2};

type Vector = Vector2<f64>;

/// Slower people have no direction, in m/s.
const SLOWEST: f64 = 0.05;
/// How far behind, ahead of and beside the person the robot is to be, between the centers, in m.
const BEHIND: f64 = 1.2;
const AHEAD: f64 = 1.5;
const BESIDE: f64 = 1.2;

/// Where the robot is to be, seen from the first person of the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Task {
    /// To follow.
    Behind,
    /// To lead.
    Ahead,
    /// To accompany, on the side on which the robot is.
    Beside,
}

/// A task under way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Escort {
    task: Task,
    /// Direction of the person when last known.
    direction: Vector,
}

impl Escort {
    /// At the start people are taken to walk along x.
    pub fn new(task: Task) -> Self {
        Self {
            task,
            direction: Vector::x(),
        }
    }

    /// The goal of a robot at a position in m, for a person at a position and with a velocity as measured.
    pub fn goal(&mut self, robot: Vector, (person, velocity): (Vector, Vector)) -> Vector {
        if velocity.norm() >= SLOWEST {
            self.direction = direction_of(velocity);
        }
        let along = self.direction;
        match self.task {
            Task::Behind => person - along * BEHIND,
            Task::Ahead => person + along * AHEAD,
            Task::Beside => {
                let left = along.left_normal();
                let side = BESIDE.copysign(left.dot(&(robot - person)));
                person + left * side
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn goals_keep_to_the_direction_of_who_has_stopped() {
        let person = (Vector::new(2.0, 1.0), Vector::new(0.0, 0.8));
        let robot = Vector::new(3.0, 0.0);
        let mut escort = Escort::new(Task::Behind);
        let near = |goal: Vector, x: f64, y: f64| (goal - Vector::new(x, y)).norm() < 1e-12;
        assert!(near(
            escort.goal(robot, (person.0, Vector::zeros())),
            0.8,
            1.0
        ));
        assert!(near(escort.goal(robot, person), 2.0, -0.2));
        assert!(near(
            escort.goal(robot, (person.0, Vector::new(0.04, 0.0))),
            2.0,
            -0.2
        ));
        assert!(near(Escort::new(Task::Ahead).goal(robot, person), 2.0, 2.5));
        assert!(near(
            Escort::new(Task::Beside).goal(robot, person),
            3.2,
            1.0
        ));
        let left = Vector::new(0.0, 0.0);
        assert!(near(Escort::new(Task::Beside).goal(left, person), 0.8, 1.0));
    }
}
