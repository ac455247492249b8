//! The theorem of the shield, against people who want to be touched.

use numeric::random::Stream;
use vff_core::laws::VirtualForceField;
use vff_core::laws::field::gains::Gains;
use vff_core::laws::field::side::SideRules;
use vff_core::laws::field::stabilizing::Stabilizing;
use vff_core::laws::planning::family::Planned;
use vff_core::laws::reciprocal::ReciprocalAvoidance;
use vff_core::laws::safe::SafeNavigation;
use vff_core::laws::shield::{Friendly, Shield};
use vff_core::laws::velocity_obstacle::VelocityObstacle;
use vff_core::laws::yielding::Yielding;
use vff_core::robots::{DifferentialDriveRobot, HolonomicRobot};
use vff_core::run::AnyLaw;
use vff_core::run::as_built::AsBuilt;
use vff_core::run::pursuit::{Encounter, Pursuer};
use vff_core::search::{Falsification, Property};
use vff_core::sensing::measurement::{Distribution, Measurement, Noisy};
use vff_core::world::motion::Motion;
use vff_core::world::obstacle::{Limits, Obstacle};
use vff_core::world::scenario::{Rules, Scenario};

const PERSON: f64 = 0.4;

fn laws() -> [AnyLaw; 3] {
    let gains = Gains::of([3.0, 20.0, 17.0, 0.25]);
    let rules = SideRules {
        pass_behind: true,
        hysteresis: f64::INFINITY,
    };
    let mode = Stabilizing::named("capped", None, None).unwrap();
    let field = VirtualForceField::new(gains, mode, rules).unwrap();
    [
        field.into(),
        Planned(ReciprocalAvoidance::default()).into(),
        Planned(VelocityObstacle::default()).into(),
    ]
}

/// Somebody far away, whose place a pursuer takes.
fn obstacle(speed: f64) -> Obstacle {
    let motion = Motion::moving([1e4, 1e4], [speed, 0.0], [0.0; 2], None).unwrap();
    Obstacle::disc(PERSON, motion, Limits::default()).unwrap()
}

fn rules(period: f64) -> Rules {
    Rules {
        control_period: period,
        time_limit: 10.0,
        rest_time: 20.0,
        ..Rules::default()
    }
}

/// Limits, errors and latencies of one draw, with a shield that assumes them.
struct Draw {
    scenario: Scenario,
    shield: Shield,
    speed: f64,
    free: f64,
    step: f64,
}

impl Draw {
    fn of(seed: u64, two_wheels: bool) -> Self {
        let mut stream = Stream::new(seed, u64::from(two_wheels));
        let step = 0.01;
        let period = step * (3.0 + 8.0 * stream.unit()).floor();
        let [max_speed, max_acceleration] = [stream.uniform(0.3, 2.0), stream.uniform(1.0, 10.0)];
        let radius = stream.uniform(0.15, 0.4);
        let speed = stream.uniform(0.5, 2.0);
        let (scale, latency) = (stream.uniform(0.0, 0.05), stream.uniform(0.0, 0.2));
        let ends = [[0.0, 0.0], [8.0, 0.5]];
        let people = vec![obstacle(speed)];
        let scenario = if two_wheels {
            let robot = DifferentialDriveRobot {
                radius,
                max_speed,
                max_acceleration,
                ..DifferentialDriveRobot::default()
            };
            Scenario::for_differential(robot, ends[0], ends[1], people, rules(period))
        } else {
            let robot = HolonomicRobot {
                radius,
                max_speed,
                max_acceleration,
                ..HolonomicRobot::default()
            };
            Scenario::new(robot, ends[0], ends[1], people, rules(period))
        };
        let noise = Measurement::new(scale, Distribution::Uniform, Noisy::Obstacles).unwrap();
        let noise = noise.late(latency).unwrap();
        let shield = Shield {
            person_speed: Some(speed),
            latency,
            position_error: noise.error_bound(),
            // Half a motion step at the largest change of velocity.
            margin: 0.5 * max_acceleration * period * step + 1e-6,
            ..Shield::default()
        };
        Self {
            scenario: scenario.unwrap().measured(Some(noise), seed).unwrap(),
            shield,
            speed,
            free: radius + PERSON + 0.3,
            step,
        }
    }

    fn meet(&self, law: &AnyLaw, index: u64) -> (Encounter, Pursuer) {
        let built = AsBuilt {
            step: self.step,
            ..AsBuilt::default()
        };
        let hunt = Falsification {
            scenario: &self.scenario,
            law,
            built: &built,
            max_speed: self.speed,
            free: self.free,
        };
        let pursuer = hunt.random(11, index);
        let found = hunt.episode(&pursuer, index, None, &|| false).unwrap();
        (found, pursuer)
    }
}

fn shielded(law: AnyLaw, shield: Shield, yields: bool) -> AnyLaw {
    SafeNavigation {
        shield: Some(shield),
        yielding: yields.then(Yielding::default),
        takeover: yields,
        ..SafeNavigation::bare(law)
    }
    .into()
}

#[test]
fn nobody_is_ahead_at_any_instant_whatever_the_limits() {
    let laws = laws();
    for seed in 0..60 {
        for two_wheels in [false, true] {
            let draw = Draw::of(seed, two_wheels);
            for (which, law) in laws.iter().enumerate() {
                let law = shielded(law.clone(), draw.shield, seed % 2 == 0);
                let (found, pursuer) = draw.meet(&law, seed);
                assert!(
                    found.least_ahead > 0.0,
                    "seed {seed}, law {which}, two wheels {two_wheels}: {found:?} {pursuer:?}"
                );
                let limits = draw.scenario.point_mass();
                let most = draw
                    .scenario
                    .differential()
                    .map_or(limits.max_speed, |r| r.max_speed);
                assert!(found.top_speed <= most * (1.0 + 1e-9));
            }
        }
    }
}

#[test]
fn somebody_faster_than_is_assumed_breaks_it() {
    let law = &laws()[1];
    let mut broken = 0;
    for seed in 0..40 {
        let draw = Draw::of(seed, false);
        let shield = Shield {
            person_speed: Some(0.3 * draw.speed),
            latency: 0.0,
            position_error: 0.0,
            ..draw.shield
        };
        let (found, _) = draw.meet(&shielded(law.clone(), shield, false), seed);
        broken += u32::from(found.least_ahead <= 0.0);
    }
    assert!(broken > 0);
}

#[test]
fn a_friendly_shield_keeps_people_their_way_to_stop() {
    let friendly = Friendly {
        reaction_time: 0.3,
        deceleration: 2.0,
    };
    let mut larger = 0;
    for seed in 0..20 {
        let draw = Draw::of(seed, false);
        let shield = Shield {
            friendly: Some(friendly),
            ..draw.shield
        };
        let law = &laws()[1];
        let (plain, _) = draw.meet(&shielded(law.clone(), draw.shield, false), seed);
        let (kept, _) = draw.meet(&shielded(law.clone(), shield, false), seed);
        assert!(kept.least_ahead > 0.0);
        larger += u32::from(kept.least_ahead > plain.least_ahead);
    }
    assert!(larger > 10, "{larger}");
}

#[test]
fn the_search_for_the_worst_person_finds_a_fault_without_a_shield_only() {
    let draw = Draw::of(5, false);
    let built = AsBuilt::default();
    let worst = |law: &AnyLaw| {
        let hunt = Falsification {
            scenario: &draw.scenario,
            law,
            built: &built,
            max_speed: draw.speed,
            free: draw.free,
        };
        let found = hunt.worst(Property::NotAtFault, 120, 1, Some(1), &|| false, &|_| ());
        found.unwrap().unwrap().1
    };
    let orca = &laws()[1];
    assert!(worst(orca) < 0.0);
    assert!(worst(&shielded(orca.clone(), draw.shield, false)) > 0.0);
}

#[test]
fn a_kept_velocity_is_the_laws_own_force() {
    // So fast that no law asks for more.
    let robot = HolonomicRobot {
        max_speed: 5.0,
        ..HolonomicRobot::default()
    };
    let ends = [[0.0, 0.0], [3.0, 0.4]];
    let scenario = Scenario::new(robot, ends[0], ends[1], Vec::new(), rules(0.06)).unwrap();
    for law in laws() {
        let options = vff_core::run::Options::default();
        let run = |law: &AnyLaw| vff_core::run::simulate(&scenario, law, &options, &|| false);
        let (alone, path) = run(&law).unwrap();
        let (guarded, same) = run(&shielded(law.clone(), Shield::default(), false)).unwrap();
        assert_eq!(alone.arrival_time, guarded.arrival_time);
        assert_eq!(path.position, same.position);
    }
}
