//! Boundary points of a map as obstacles.

use navigation_world::world::motion::Motion;
use navigation_world::world::obstacle::{Limits, Obstacle, Regions, Shape};
use navigation_world::world::scenario::PlacedObstacle;

/// Distance of the surfaces at which a boundary point brakes a force law, in m.
const CRITICAL: f64 = 0.001;

/// Distance of the surfaces within which it acts on a force law, in m.
const INFLUENCE: f64 = 0.3;

/// A boundary point of a map as an obstacle, for a robot of a radius in m.
pub(super) fn boundary_obstacle(robot_radius: f64) -> PlacedObstacle {
    PlacedObstacle {
        obstacle: Obstacle {
            shape: Shape::Disc { radius: 0.0 },
            motion: Motion::at_rest([0.0; 2]),
            limits: Limits::default(),
        },
        regions: Regions {
            critical_radius: robot_radius + CRITICAL,
            active_radius: robot_radius + INFLUENCE,
        },
        contact_distance: robot_radius,
        stationary: true,
        speed_bound: Some(0.0),
    }
}
