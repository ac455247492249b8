//! Every term of the force at one state.

use crate::lanes::{Planar, Vector2};
use crate::laws::field::attractive::attractive_force;
use crate::laws::field::law::ForceFieldLaw;
use crate::laws::{Law, Situation};
use crate::world::geometry::Body;

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

impl ForceFieldLaw<f64, true> {
    /// Every term of one evaluation.
    pub fn terms(&mut self, situation: &Situation<'_, f64>) -> FieldTerms {
        let command = self.command(situation);
        let robot = &situation.robot;
        let mut terms = FieldTerms {
            attractive: [0.0; 2],
            obstacles: situation
                .bodies
                .iter()
                .map(|body| idle(body, robot.position))
                .collect(),
            stabilizing: command.stabilizing.lane(0),
            total: command.force.lane(0),
            omega: self.dissipation.omega,
            lyapunov: None,
        };
        if terms
            .obstacles
            .iter()
            .any(|obstacle| obstacle.region == "critical")
        {
            terms.omega = 0.0;
            return terms;
        }
        terms.attractive =
            attractive_force(&self.gains, self.goal - robot.position, robot.velocity).lane(0);
        for slot in &self.slots {
            terms.obstacles[slot.index] = ObstacleTerms {
                repulsive: slot.repulsive.lane(0),
                detour: slot.detouring.lane(0),
                region: "active",
                side: if slot.side > 0.0 { 1 } else { -1 },
            };
        }
        let direction = self.dissipation.direction(&self.gains, robot.velocity);
        // dV2/dt = -b |v_L|^2 - v_L.F_L + Omega (5.5.6).
        let derivative = -self.gains.ratio * direction.dot(&direction)
            - direction.dot(&command.stabilizing)
            + self.dissipation.omega;
        terms.lyapunov = Some((command.lyapunov, derivative));
        terms
    }
}

/// An obstacle without force.
fn idle(body: &Body, position: Vector2<f64>) -> ObstacleTerms {
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
    ObstacleTerms::idle(region)
}
