use std::sync::Arc;

use super::{BodyCommand, OutlineGuard};
use crate::shield::person::{KnownVelocity, Person};
use crate::shield::walls::StaticObstacles;
use crate::shield::{Shield, TrackingError, TwistState};
use navigation_world::robots::differential::Twist;
use navigation_world::world::footprint::{BodyMotion, Footprint};
use navigation_world::world::frame::Frame;
use navigation_world::world::map::{MapShapes, StaticMap};
use navigation_world::world::shape::PlacedShape;
use numeric::lanes::Vector2;
use numeric::random::Stream;

const PERIOD: f64 = 0.05;

fn guard(wheels: bool, tracking: TrackingError) -> OutlineGuard {
    let (a, b) = (0.254, 0.215);
    let corners = [[a, b], [-a, b], [-a, -b], [a, -b]];
    OutlineGuard {
        shield: Shield {
            latency: 0.05,
            position_tracking: 0.0,
            velocity_tracking: tracking,
            ..Shield::default()
        },
        outline: Arc::new(Footprint::polygon(&corners).unwrap()),
        wheels,
    }
}

/// Numbers from -1 to 1.
struct Drawn(Stream);

impl Drawn {
    fn next(&mut self) -> f64 {
        2.0 * self.0.unit() - 1.0
    }

    fn pair(&mut self, most: f64) -> Vector2<f64> {
        Vector2::new(self.next(), self.next()) * most
    }

    fn command(&mut self, wheels: bool) -> BodyCommand {
        let mut motion = |most: f64| {
            if wheels {
                BodyMotion::from([self.next() * most, self.next() * 2.0 * most])
            } else {
                BodyMotion {
                    velocity: self.pair(most),
                    turn_rate: 0.0,
                }
            }
        };
        let (before, after) = (motion(1.0), motion(1.0));
        BodyCommand {
            position: Vector2::zeros(),
            heading: 3.0 * self.next(),
            before,
            after,
            period: PERIOD,
            braking: 0.1 + 0.3 * self.next().abs(),
        }
    }
}

/// Poses and motions of a plan, by small steps.
fn states(command: &BodyCommand) -> Vec<(f64, Frame, BodyMotion)> {
    const STEPS: u32 = 400;
    let end = command.period + command.braking;
    let (mut place, mut heading) = (command.position, command.heading);
    let mut found = Vec::new();
    let step = end / f64::from(STEPS);
    let motion_at = |time: f64| {
        let mix = |share: f64, from: &BodyMotion, to: &BodyMotion| BodyMotion {
            velocity: from.velocity + (to.velocity - from.velocity) * share,
            turn_rate: from.turn_rate + (to.turn_rate - from.turn_rate) * share,
        };
        if time < command.period {
            mix(time / command.period, &command.before, &command.after)
        } else {
            let braked = (time - command.period) / command.braking;
            mix(braked.min(1.0), &command.after, &BodyMotion::REST)
        }
    };
    for index in 0..=STEPS {
        let time = f64::from(index) * step;
        let frame = Frame::at(place.into(), heading);
        found.push((time, frame, motion_at(time)));
        let middle = motion_at(time + 0.5 * step);
        let halfway = Frame::at([0.0; 2], heading + 0.5 * middle.turn_rate * step);
        place += halfway.outward(middle.velocity) * step;
        heading += middle.turn_rate * step;
    }
    found
}

/// Points of an outline with normals there: along the sides, and around the corners.
fn contour(outline: &Footprint) -> Vec<(Vector2<f64>, Vector2<f64>)> {
    let corners = outline.corners();
    let count = corners.len();
    let normal = |index: usize| {
        let along = (corners[(index + 1) % count] - corners[index % count]).normalize();
        Vector2::new(along.y, -along.x)
    };
    let mut found = Vec::new();
    for index in 0..count {
        let way = corners[(index + 1) % count] - corners[index];
        for part in 0..=12 {
            found.push((
                corners[index] + way * (f64::from(part) / 12.0),
                normal(index),
            ));
        }
        let [from, to] = [normal(index + count - 1), normal(index)];
        for part in 1..6 {
            let share = f64::from(part) / 6.0;
            found.push((
                corners[index],
                (from * (1.0 - share) + to * share).normalize(),
            ));
        }
    }
    found
}

fn bearing(people: f64) -> TrackingError {
    TrackingError {
        absolute: 0.0,
        relative: people,
    }
}

#[test]
fn nobody_can_be_touched_by_a_part_that_moves_toward_him_in_a_verified_plan() {
    let mut drawn = Drawn(Stream::new(7, 1));
    let mut verified = [0, 0];
    for trial in 0..700 {
        let wheels = trial % 2 == 0;
        let guard = guard(wheels, bearing(0.0));
        let command = drawn.command(wheels);
        let mut person = Person::disc(drawn.pair(1.6).into(), 0.3);
        person.max_speed = 1.0 + drawn.next();
        if trial % 3 == 0 {
            person.known = Some(KnownVelocity {
                velocity: drawn.pair(0.6 * person.max_speed),
                error: 0.1,
                acceleration: 1.0,
            });
        }
        if !guard.verified(&command, &[person], &StaticObstacles::NONE) {
            continue;
        }
        verified[usize::from(wheels)] += 1;
        for (time, frame, motion) in states(&command) {
            for (place, normal) in contour(&guard.outline) {
                if motion.at(place).dot(&normal) <= 1e-6 {
                    continue;
                }
                let center = frame.position + frame.outward(place + normal * 0.3);
                let reach = person.reach(time);
                let away = (center - person.placed.center).norm();
                let mut beyond = away - reach;
                if let Some(known) = person.known {
                    let age = 0.05 + time;
                    let there = person.placed.center + known.velocity * age;
                    let spread = (known.error + 0.5 * known.acceleration * age) * age;
                    beyond = beyond.max((center - there).norm() - spread);
                }
                assert!(beyond > -1e-6, "{command:?} {time} {place:?} {beyond}");
            }
        }
    }
    assert!(verified.iter().all(|count| *count > 40), "{verified:?}");
}

#[test]
fn a_robot_that_follows_its_plan_to_a_share_is_behind_everybody_too() {
    let mut drawn = Drawn(Stream::new(8, 1));
    let mut verified = 0;
    for trial in 0..300 {
        let wheels = trial % 2 == 0;
        let guard = guard(wheels, bearing(0.1));
        let command = drawn.command(wheels);
        let person = Person::disc(drawn.pair(1.8).into(), 0.3);
        if !guard.verified(&command, &[person], &StaticObstacles::NONE) {
            continue;
        }
        verified += 1;
        for (time, frame, motion) in states(&command) {
            let off = Vector2::new(drawn.next(), drawn.next());
            let off = off / off.norm().max(1.0) * 0.1;
            let really = if wheels {
                BodyMotion::from([
                    motion.velocity.x * (1.0 + off.x),
                    motion.turn_rate * (1.0 + off.y),
                ])
            } else {
                BodyMotion {
                    velocity: motion.velocity + off * motion.velocity.norm(),
                    turn_rate: 0.0,
                }
            };
            for (place, normal) in contour(&guard.outline) {
                if really.at(place).dot(&normal) <= 1e-6 {
                    continue;
                }
                let center = frame.position + frame.outward(place + normal * 0.3);
                let beyond = (center - person.placed.center).norm() - person.reach(time);
                assert!(beyond > -1e-6, "{command:?} {time} {place:?} {beyond}");
            }
        }
    }
    assert!(verified > 30, "{verified}");
}

fn room(drawn: &mut Drawn) -> StaticMap {
    let mut shapes = MapShapes::new();
    for _ in 0..6 {
        let from = drawn.pair(1.2);
        let to = from + drawn.pair(0.5);
        shapes.polyline(&[from.into(), to.into()], 0.02).unwrap();
    }
    shapes.disc(drawn.pair(1.2).into(), 0.1).unwrap();
    shapes.map()
}

#[test]
fn a_verified_plan_keeps_off_walls() {
    let mut drawn = Drawn(Stream::new(9, 1));
    let mut verified = 0;
    for trial in 0..1200 {
        let wheels = trial % 2 == 0;
        let guard = guard(wheels, bearing(0.0));
        let command = drawn.command(wheels);
        let map = room(&mut drawn);
        let table = [PlacedShape::turned(drawn.pair(1.5).into(), [0.4, 0.2], 0.7)];
        let walls = StaticObstacles {
            shapes: &table,
            map: Some(&map),
        };
        let all = states(&command);
        let present = walls.clearance_of(&guard.outline, &all[0].1, 1.0);
        if !guard.verified(&command, &[], &walls) {
            continue;
        }
        verified += 1;
        assert!(present > 0.0);
        let kept = present.min(0.005);
        for (time, frame, _) in &all {
            let gap = walls.clearance_of(&guard.outline, frame, 1.0);
            // The arcs of the ramp stand for it to less than a millimeter.
            assert!(gap > kept - 8e-4, "{command:?} {time} {gap} {kept}");
        }
    }
    assert!(verified > 30, "{verified}");
}

#[test]
fn turning_in_place_is_no_rest() {
    let guard = guard(true, TrackingError::default());
    let robot = TwistState {
        position: Vector2::zeros(),
        heading: 0.0,
        twist: Twist::default(),
    };
    let turning = |turn_rate: f64| {
        let twist = Twist {
            speed: 0.0,
            turn_rate,
        };
        BodyCommand::of_twist(&robot, twist, [PERIOD, PERIOD])
    };
    let beside = [Person::disc([0.0, 0.65], 0.3)];
    assert!(!guard.verified(&turning(1.0), &beside, &StaticObstacles::NONE));
    assert!(guard.verified(&turning(0.0), &beside, &StaticObstacles::NONE));
    let away = [Person::disc([0.0, 1.2], 0.3)];
    assert!(guard.verified(&turning(1.0), &away, &StaticObstacles::NONE));
    // Along a wall that its corner would sweep it may only drive straight.
    let mut shapes = MapShapes::new();
    shapes.polyline(&[[-2.0, 0.24], [2.0, 0.24]], 0.0).unwrap();
    let map = shapes.map();
    let walls = StaticObstacles {
        shapes: &[],
        map: Some(&map),
    };
    assert!(!guard.verified(&turning(3.0), &[], &walls));
    let straight = Twist {
        speed: 0.3,
        turn_rate: 0.0,
    };
    let straight = BodyCommand::of_twist(&robot, straight, [PERIOD, PERIOD]);
    assert!(guard.verified(&straight, &[], &walls));
}

#[test]
fn who_walks_beside_a_robot_that_drives_straight_is_not_ahead() {
    let guard = guard(true, TrackingError::default());
    let robot = TwistState {
        position: Vector2::zeros(),
        heading: 0.0,
        twist: Twist {
            speed: 0.5,
            turn_rate: 0.0,
        },
    };
    let straight = BodyCommand::of_twist(&robot, robot.twist, [PERIOD, PERIOD]);
    let mut person = Person::disc([0.0, 0.54], 0.3);
    person.max_speed = 0.3;
    assert!(guard.verified(&straight, &[person], &StaticObstacles::NONE));
    // A robot of no wheels may drift to its side by its tracking.
    let mut drifting = guard.clone();
    drifting.wheels = false;
    assert!(!drifting.verified(&straight, &[person], &StaticObstacles::NONE));
}
