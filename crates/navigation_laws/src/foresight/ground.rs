//! Costs of the ways from the nodes of the grid, infinite where the robot cannot be, and of narrow nodes.

use crate::foresight::{ROOM, Scene};
use crate::guide::RobotRoom;
use numeric::lanes::Vector2;

/// Distance of the surface from walls that nodes keep, in m.
const NODE_ROOM: f64 = 0.03;

/// Nodes across a block of which one clearance may be enough.
const BLOCK: usize = 4;

/// Costs of the nodes of a square grid around the robot, row by row.
#[derive(Clone, Debug)]
pub(super) struct Ground {
    /// Way to the goal in m.
    pub way: Vec<f64>,
    /// How much longer a stage counts there, as the guide makes narrow ways dearer.
    pub narrowness: Vec<f64>,
}

impl Ground {
    /// Of a grid with so many nodes.
    pub fn new(count: usize) -> Self {
        Self {
            way: vec![0.0; count],
            narrowness: vec![0.0; count],
        }
    }

    /// Looks at the nodes of a scene.
    pub fn look(&mut self, scene: &Scene<'_>, robot: RobotRoom, across: usize, spacing: f64) {
        let middle = (across / 2) as f64;
        let lower = scene.robot.position - Vector2::repeat(middle * spacing);
        let place =
            |column: usize, row: usize| lower + Vector2::new(column as f64, row as f64) * spacing;
        let cost = |place: Vector2<f64>| match scene.plan {
            Some(plan) => plan.cost_around(place),
            None => (scene.goal - place).norm(),
        };
        for (row, ways) in self.way.chunks_exact_mut(across).enumerate() {
            for (column, way) in ways.iter_mut().enumerate() {
                *way = cost(place(column, row));
            }
        }
        self.narrowness.fill(0.0);
        if scene.walls.is_empty() {
            return;
        }
        let least = robot.least + NODE_ROOM;
        let most = if robot.turns() { robot.free() } else { least };
        let half = 0.5 * (BLOCK - 1) as f64 * spacing;
        let around = std::f64::consts::SQRT_2 * half + 1e-9;
        for first_row in (0..across).step_by(BLOCK) {
            for first in (0..across).step_by(BLOCK) {
                let center = place(first, first_row) + Vector2::repeat(half);
                if scene.walls.clearance_up_to(center, most + around) >= most + around {
                    continue;
                }
                for row in first_row..(first_row + BLOCK).min(across) {
                    for column in first..(first + BLOCK).min(across) {
                        let node = row * across + column;
                        let mut at = place(column, row);
                        let mut clearance = scene.walls.clearance_up_to(at, most);
                        if clearance < least && robot.turns() {
                            // A way between walls is narrower than the grid is fine.
                            (at, clearance) = aside(scene, at, [clearance, least, most], spacing);
                            self.way[node] = cost(at);
                            if clearance < robot.least + ROOM {
                                self.way[node] = f64::INFINITY;
                            }
                        } else if clearance < least {
                            self.way[node] = f64::INFINITY;
                        }
                        self.narrowness[node] = robot.narrowness(clearance);
                    }
                }
            }
        }
    }
}

/// The place within half a cell of a node that is farther from the wall, with its clearance.
fn aside(
    scene: &Scene<'_>,
    node: Vector2<f64>,
    [clearance, least, most]: [f64; 3],
    spacing: f64,
) -> (Vector2<f64>, f64) {
    let short = least - clearance;
    let there = (short <= 0.5 * spacing)
        .then(|| scene.walls.away(node, most))
        .flatten()
        .map(|away| node + away * short);
    there.map_or((node, clearance), |there| {
        (there, scene.walls.clearance_up_to(there, most))
    })
}
