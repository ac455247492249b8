//! Costs of the ways from the nodes of the grid, infinite where the robot cannot be.

use crate::foresight::Scene;
use numeric::lanes::Vector2;

/// Distance of the surface from walls that nodes keep, in m.
const ROOM: f64 = 0.03;

/// Nodes across a block of which one clearance may be enough.
const BLOCK: usize = 4;

/// Way to the goal in m from every node of a square grid around the robot, row by row.
pub(super) fn costs_to_go(
    scene: &Scene<'_>,
    room: f64,
    across: usize,
    spacing: f64,
    costs: &mut [f64],
) {
    let middle = (across / 2) as f64;
    let lower = scene.robot.position - Vector2::repeat(middle * spacing);
    let place =
        |column: usize, row: usize| lower + Vector2::new(column as f64, row as f64) * spacing;
    for (row, costs) in costs.chunks_exact_mut(across).enumerate() {
        for (column, cost) in costs.iter_mut().enumerate() {
            let place = place(column, row);
            *cost = match scene.plan {
                Some(plan) => plan.cost_around(place),
                None => (scene.goal - place).norm(),
            };
        }
    }
    if scene.walls.is_empty() {
        return;
    }
    let least = room + ROOM;
    let half = 0.5 * (BLOCK - 1) as f64 * spacing;
    let around = std::f64::consts::SQRT_2 * half + 1e-9;
    for first_row in (0..across).step_by(BLOCK) {
        for first in (0..across).step_by(BLOCK) {
            let center = place(first, first_row) + Vector2::repeat(half);
            if scene.walls.clearance_up_to(center, least + around) >= least + around {
                continue;
            }
            for row in first_row..(first_row + BLOCK).min(across) {
                for column in first..(first + BLOCK).min(across) {
                    let cost = &mut costs[row * across + column];
                    if cost.is_finite()
                        && scene.walls.clearance_up_to(place(column, row), least) < least
                    {
                        *cost = f64::INFINITY;
                    }
                }
            }
        }
    }
}
