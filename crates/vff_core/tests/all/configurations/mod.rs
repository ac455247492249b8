//! Configurations 1 to 4 of Zeng (2011), chapter 6, and laws by their gains.

use vff_core::laws::VirtualForceField;
use vff_core::laws::field::gains::Gains;
use vff_core::laws::field::side::SideRules;
use vff_core::laws::field::stabilizing::Stabilizing;
use vff_core::robots::HolonomicRobot;
use vff_core::world::motion::Motion;
use vff_core::world::obstacle::{Limits, Obstacle};
use vff_core::world::scenario::{Rules, Scenario};

/// Region radii of an obstacle, both given.
pub fn limits(critical: f64, active: f64) -> Limits {
    Limits {
        critical_radius: Some(critical),
        active_radius: Some(active),
        max_speed: None,
    }
}

/// Obstacles of a configuration.
pub fn obstacles(number: usize) -> Vec<Obstacle> {
    let person = || {
        let walk = Motion::moving([0.6, 0.6], [1.0, 0.0], [0.0; 2], Some([4.0, 0.6])).unwrap();
        Obstacle::disc(0.4, walk, limits(0.8, 2.1)).unwrap()
    };
    let disc = |center| Obstacle::disc_at_rest(center, 0.1, limits(0.4, 0.8)).unwrap();
    let table = || Obstacle::rectangle([2.3, 0.0], [1.4, 0.6], 0.0, limits(0.4, 0.8)).unwrap();
    match number {
        1 => vec![disc([2.45, 0.595])],
        2 => vec![person()],
        3 => vec![table(), disc([2.45, 1.4])],
        _ => vec![person(), table(), disc([2.45, 1.4])],
    }
}

/// From `[3.9, 0.6]` to `[0, 0.6]` past some obstacles.
pub fn crossing(obstacles: Vec<Obstacle>, rules: Rules) -> Scenario {
    let robot = HolonomicRobot::default();
    Scenario::new(robot, [3.9, 0.6], [0.0, 0.6], obstacles, rules).unwrap()
}

/// Gains in the order `K_1, K_3, K_5, b`.
pub fn gains([attractive, repulsive, detour, ratio]: [f64; 4]) -> Gains {
    Gains {
        attractive,
        repulsive,
        detour,
        ratio,
    }
}

/// A law that passes behind moving obstacles and forgets its sides.
pub fn law(set: [f64; 4], stabilizing: Stabilizing) -> VirtualForceField {
    let rules = SideRules {
        pass_behind: true,
        hysteresis: f64::INFINITY,
    };
    VirtualForceField::new(gains(set), stabilizing, rules).unwrap()
}
