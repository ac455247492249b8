//! Scenes drawn at random: discs that cross the straight way of a robot, and crowds. Every draw has
//! the bits of the same draw by numpy and Python's floats.

use std::f64::consts::PI;

use numeric::pcg64::Pcg64;

use crate::robots::HolonomicRobot;
use crate::world::motion::Motion;
use crate::world::obstacle::{Limits, Obstacle};
use crate::world::region::{self, Sensing};
use crate::world::scenario::{Mover, Rules, Scenario};
use numeric::error::Result;

/// Time limit in s; also the time that the robot may rest.
const TIME_LIMIT: f64 = 60.0;

/// Distance from start to goal of traffic in m, and the part of it that is crossed.
const WAY: f64 = 10.0;
const MIDDLE: [f64; 2] = [2.0, 8.0];
/// Radius of its discs in m.
const RADIUS: f64 = 0.3;
/// Their speeds in m/s.
const DISC_SPEEDS: [f64; 2] = [0.3, 1.0];
/// Most by which a disc crosses earlier or later than the robot would be there, in s.
const SPREAD: f64 = 4.0;
/// Least angle between the ways of a disc and of the robot, in degrees.
const SHALLOWEST: f64 = 20.0;

/// Side of the square of a crowd in m, and the margin of its inner square.
const SIDE: f64 = 8.0;
const INNER_MARGIN: f64 = 1.0;
/// Radii of a person and of the regions, in m.
const PERSON: f64 = 0.4;
const CRITICAL_RADIUS: f64 = 0.8;
const ACTIVE_RADIUS: f64 = 2.1;
/// Walking speeds in m/s.
const WALKING_SPEEDS: [f64; 2] = [0.5, 1.4];
/// Last instant at which somebody reaches the border, in s.
const LATEST_ENTRY: f64 = 8.0;
/// Share of the people who stop.
const STOPPING_SHARE: f64 = 0.2;
/// Speed that the regions of a person are sized for, in m/s.
const SIZED_SPEED: f64 = 1.0;

fn rules() -> Rules {
    Rules {
        time_limit: TIME_LIMIT,
        rest_time: TIME_LIMIT,
        ..Rules::default()
    }
}

fn from_to([low, high]: [f64; 2], share: f64) -> f64 {
    low + (high - low) * share
}

/// A robot that goes 10 m straight on while discs cross the middle of its way.
///
/// # Errors
/// The robot is not valid.
pub fn random_traffic(count: usize, robot: HolonomicRobot, seed: u64) -> Result<Scenario> {
    let mut draws = Pcg64::new(seed);
    let discs = (0..count).map(|_| crossing(&mut draws, &robot));
    let discs = discs.collect::<Result<_>>()?;
    let ends = [[0.0, 0.0], [WAY, 0.0]];
    let scenario = Scenario::sensed(Mover::Holonomic(robot), ends, discs, rules(), None)?;
    Ok(scenario.reseeded(seed))
}

/// Draws discs until one may be there.
fn crossing(draws: &mut Pcg64, robot: &HolonomicRobot) -> Result<Obstacle> {
    loop {
        let [place, course, speed, instant] = [0; 4].map(|_| draws.unit());
        let place = from_to(MIDDLE, place);
        let course = course_of(course);
        let speed = from_to(DISC_SPEEDS, speed);
        let velocity = [speed * course.cos(), speed * course.sin()];
        let when = place / robot.max_speed + SPREAD * (2.0 * instant - 1.0);
        let start = [place - when * velocity[0], -when * velocity[1]];
        let motion = Motion::moving(start, velocity, [0.0; 2], None)?;
        let disc = Obstacle::disc(RADIUS, motion, Limits::default())?;
        let period = Rules::default().control_period;
        let regions = region::radii(&robot.limits(), &disc, period, None, &Sensing::default())?;
        if distance([0.0; 2], start) > regions.critical_radius {
            return Ok(disc);
        }
    }
}

/// A direction that is not nearly along the way, either way round.
fn course_of(share: f64) -> f64 {
    let shallowest = SHALLOWEST * (PI / 180.0);
    let span = PI - 2.0 * shallowest;
    let double = 2.0 * share;
    let (side, along) = (double.floor(), double.fract());
    shallowest + along * span + PI * side
}

/// A robot that crosses a square of 8 m while people walk through it.
///
/// # Errors
/// The robot is not valid.
pub fn random_crowd(count: usize, robot: Mover, seed: u64) -> Result<Scenario> {
    let mut draws = Pcg64::new(seed);
    let people = (0..count).map(|_| walker(&mut draws));
    let people = people.collect::<Result<_>>()?;
    let scenario = Scenario::sensed(robot, ends(), people, rules(), None)?;
    Ok(scenario.reseeded(seed))
}

/// Start and goal of the robot in a crowd.
fn ends() -> [[f64; 2]; 2] {
    [[0.5, SIDE / 2.0], [SIDE - 0.5, SIDE / 2.0]]
}

/// Draws people until one may be there.
fn walker(draws: &mut Pcg64) -> Result<Obstacle> {
    let [from, to] = ends();
    loop {
        let [border, x, y, speed, entry_time, stopping] = [0; 6].map(|_| draws.unit());
        let (entry, aim) = (border_point(border), [inner(x), inner(y)]);
        let speed = from_to(WALKING_SPEEDS, speed);
        let way = distance(entry, aim);
        let velocity = [0, 1].map(|axis| speed * (aim[axis] - entry[axis]) / way);
        let delay = LATEST_ENTRY * entry_time;
        let start = [0, 1].map(|axis| entry[axis] - delay * velocity[axis]);
        let stops = stopping < STOPPING_SHARE;
        if distance(start, from) <= CRITICAL_RADIUS {
            continue;
        }
        if stops && distance(aim, from).min(distance(aim, to)) <= ACTIVE_RADIUS {
            continue;
        }
        let motion = Motion::moving(start, velocity, [0.0; 2], stops.then_some(aim))?;
        let limits = Limits {
            active_radius: Some(ACTIVE_RADIUS),
            critical_radius: Some(CRITICAL_RADIUS),
            max_speed: Some(SIZED_SPEED),
        };
        return Obstacle::disc(PERSON, motion, limits);
    }
}

/// The point at a share of the way around the square.
fn border_point(share: f64) -> [f64; 2] {
    let edges = 4.0 * share;
    let offset = SIDE * edges.fract();
    match edges {
        ..1.0 => [offset, 0.0],
        ..2.0 => [SIDE, offset],
        ..3.0 => [SIDE - offset, SIDE],
        _ => [0.0, SIDE - offset],
    }
}

fn inner(share: f64) -> f64 {
    INNER_MARGIN + (SIDE - 2.0 * INNER_MARGIN) * share
}

/// Distance of two points with the bits of Python's `math.dist`: squares without rounding errors, and
/// a correction of the root (`vector_norm` of `CPython`'s `mathmodule.c`).
fn distance(from: [f64; 2], to: [f64; 2]) -> f64 {
    let [x, y] = [0, 1].map(|axis| (from[axis] - to[axis]).abs());
    let largest = x.max(y);
    if largest == 0.0 || !largest.is_finite() {
        return largest;
    }
    let scale = 1.0 / above(largest);
    let mut sum = Compensated {
        sum: 1.0,
        lost: [0.0; 3],
    };
    for value in [x * scale, y * scale] {
        let [high, low] = split(value);
        sum.add(0, high * high);
        sum.add(1, 2.0 * high * low);
        sum.lost[2] += low * low;
    }
    let root = sum.beyond_one().sqrt();
    let [high, low] = split(root);
    sum.add(0, -high * high);
    sum.add(1, -2.0 * high * low);
    sum.add(2, -low * low);
    (root + sum.beyond_one() / (2.0 * root)) / scale
}

/// The power of two just above a positive number, as that of `frexp`.
fn above(value: f64) -> f64 {
    let exponent = (value.to_bits() >> 52).min(2045) + 1;
    f64::from_bits(exponent << 52)
}

/// A number in two halves whose products are exact.
fn split(value: f64) -> [f64; 2] {
    let turned = value * 134_217_729.0;
    let high = turned - (turned - value);
    [high, value - high]
}

/// A sum that keeps what its roundings lose.
struct Compensated {
    sum: f64,
    lost: [f64; 3],
}

impl Compensated {
    fn add(&mut self, part: usize, value: f64) {
        let before = self.sum;
        self.sum += value;
        self.lost[part] += (before - self.sum) + value;
    }

    fn beyond_one(&self) -> f64 {
        self.sum - 1.0 + (self.lost[0] + self.lost[1] + self.lost[2])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_rounded_correctly() {
        // math.dist of Python 3.11
        for (from, to, expected) in [
            ([0.0, 0.0], [3.0, 4.0], 5.0),
            ([0.5, 4.0], [0.1, 7.3], 3.324_154_027_718_932),
            ([1.0, 1.0], [1.0, 1.0], 0.0),
        ] {
            assert_eq!(distance(from, to), expected);
        }
    }

    #[test]
    fn obstacles_are_the_same_in_larger_scenes() {
        let robot = HolonomicRobot::default();
        let few = random_traffic(3, robot, 11).unwrap();
        let many = random_traffic(9, robot, 11).unwrap();
        assert_eq!(few.obstacles(), &many.obstacles()[..3]);
        let mover = Mover::Holonomic(robot);
        let few = random_crowd(3, mover, 11).unwrap();
        let many = random_crowd(9, mover, 11).unwrap();
        assert_eq!(few.obstacles(), &many.obstacles()[..3]);
        assert_ne!(few, random_crowd(3, mover, 12).unwrap());
    }
}
