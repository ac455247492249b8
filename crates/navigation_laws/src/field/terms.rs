//! Every term of the force at one state.

use navigation_world::world::geometry::Body;
use numeric::lanes::Vector2;

/// Terms of one obstacle at one state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObstacleTerms {
    /// Repulsive force in N.
    pub repulsive: [f64; 2],
    /// Detour force in N.
    pub detour: [f64; 2],
    /// Region: `free`, `active`, `critical` or `absent`.
    pub region: &'static str,
    /// Side of the detour, 0 when not active.
    pub side: i8,
}

impl ObstacleTerms {
    /// An obstacle without force.
    #[must_use]
    pub fn idle(region: &'static str) -> Self {
        Self {
            repulsive: [0.0; 2],
            detour: [0.0; 2],
            region,
            side: 0,
        }
    }

    /// An obstacle that does not act at a place.
    pub(super) fn without_force(body: &Body, position: Vector2<f64>) -> Self {
        let squared = body.offset(position).distance_squared;
        let region = if !body.state.present {
            "absent"
        } else if squared <= body.regions.critical_radius * body.regions.critical_radius {
            "critical"
        } else if squared < body.regions.active_radius * body.regions.active_radius {
            "active"
        } else {
            "free"
        };
        Self::idle(region)
    }
}

/// Every term at one state.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldTerms {
    /// Attractive force in N.
    pub attractive: [f64; 2],
    /// Terms of each obstacle.
    pub obstacles: Vec<ObstacleTerms>,
    /// Stabilizing force in N.
    pub stabilizing: [f64; 2],
    /// Commanded force in N.
    pub total: [f64; 2],
    /// Omega in N^2/s; NaN for laws without it.
    pub omega: f64,
    /// Lyapunov function in N^2 and its derivative in N^2/s; `None` inside a critical region.
    pub lyapunov: Option<(f64, f64)>,
}

impl FieldTerms {
    /// No force, before any is added.
    pub(super) fn without_force(bodies: &[Body], position: Vector2<f64>) -> Self {
        let idle = |body| ObstacleTerms::without_force(body, position);
        Self {
            attractive: [0.0; 2],
            obstacles: bodies.iter().map(idle).collect(),
            stabilizing: [0.0; 2],
            total: [0.0; 2],
            omega: 0.0,
            lyapunov: None,
        }
    }

    /// Whether the place is in a critical region.
    pub(super) fn are_critical(&self) -> bool {
        let mut obstacles = self.obstacles.iter();
        obstacles.any(|obstacle| obstacle.region == "critical")
    }
}
