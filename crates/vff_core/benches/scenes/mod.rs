//! Scenes that the benches share; no bench uses all of them.

#![allow(dead_code, reason = "each bench uses its part")]

use vff_core::laws::VirtualForceField;
use vff_core::laws::field::gains::Gains;
use vff_core::laws::field::side::SideRules;
use vff_core::laws::field::stabilizing::{Cap, Stabilizing};
use vff_core::robots::HolonomicRobot;
use vff_core::run::metrics::Weights;
use vff_core::run::{BatchOptions, Instructions, Options};
use vff_core::world::motion::Motion;
use vff_core::world::obstacle::{Limits, Obstacle};
use vff_core::world::scenario::{Rules, Scenario};

fn limits(active: f64, critical: f64) -> Limits {
    Limits {
        active_radius: Some(active),
        critical_radius: Some(critical),
        max_speed: None,
    }
}

fn scenario(obstacles: Vec<Obstacle>) -> Scenario {
    let rules = Rules {
        time_limit: 20.0,
        ..Rules::default()
    };
    Scenario::new(
        HolonomicRobot::default(),
        [3.9, 0.6],
        [0.0, 0.6],
        obstacles,
        rules,
    )
    .unwrap()
}

/// Configurations 1 to 4: a disc, a walking person, a rectangle and a disc, all three.
pub fn configuration(number: usize) -> Scenario {
    let walk = Motion::moving([0.6, 0.6], [1.0, 0.0], [0.0; 2], Some([4.0, 0.6])).unwrap();
    let person = Obstacle::disc(0.4, walk, limits(2.1, 0.8)).unwrap();
    let table = Obstacle::rectangle([2.3, 0.0], [1.4, 0.6], 0.0, limits(0.8, 0.4)).unwrap();
    let disc = |center| Obstacle::disc_at_rest(center, 0.1, limits(0.8, 0.4)).unwrap();
    scenario(match number {
        1 => vec![disc([2.45, 0.595])],
        2 => vec![person],
        3 => vec![table, disc([2.45, 1.4])],
        _ => vec![person, table, disc([2.45, 1.4])],
    })
}

/// Configuration 4.
pub fn configuration_4() -> Scenario {
    configuration(4)
}

/// Three slowly moving discs whose active regions cover the whole way: nothing can be skipped.
pub fn always_active() -> Scenario {
    let disc = |center, velocity| {
        let motion = Motion::moving(center, velocity, [0.0; 2], None).unwrap();
        Obstacle::disc(0.1, motion, limits(7.0, 0.4)).unwrap()
    };
    scenario(vec![
        disc([2.0, 3.2], [0.06, 0.0]),
        disc([2.4, -2.1], [-0.06, 0.0]),
        disc([5.5, 0.2], [0.0, 0.06]),
    ])
}

/// Runs on one thread.
pub fn one_thread() -> BatchOptions {
    BatchOptions {
        run: Options::default(),
        weights: Weights::EQUAL,
        descent: false,
        threads: Some(1),
        width: None,
        instructions: Instructions::Widest,
    }
}

/// The law in a mode of the stabilizing force.
pub fn law(mode: &str) -> VirtualForceField {
    let stabilizing = match mode {
        "off" => Stabilizing::Off,
        "capped" => Stabilizing::Capped(Cap::Momentum(0.1)),
        _ => Stabilizing::Full,
    };
    let rules = SideRules {
        pass_behind: true,
        hysteresis: f64::INFINITY,
    };
    VirtualForceField::new(set(20.0, 17.0), stabilizing, rules).unwrap()
}

fn set(repulsive: f64, detour: f64) -> Gains {
    Gains {
        attractive: 3.0,
        repulsive,
        detour,
        ratio: 0.25,
    }
}

/// Neighbouring gain sets that share `K_1` and `b`.
pub fn sets(count: u32) -> Vec<Gains> {
    (0..count)
        .map(|k| {
            set(
                15.0 + 10.0 * f64::from(k) / f64::from(count),
                15.0 + f64::from(k % 16),
            )
        })
        .collect()
}
