//! Protective separation distance between a person and a robot, and its inverse.
//!
//! With constant deceleration `a` from the speed `v` to a target speed `v_t` (0 for a stop)
//!
//! `S = v_h (T_r + (v - v_t)/a) + v T_r + (v^2 - v_t^2)/2a + C + Z`
//!
//! with the speed `v_h` of the person, the reaction time `T_r`, the intrusion distance `C` and the
//! uncertainty `Z = Z_d + Z_r` of both positions (the form of ISO/TS 15066:2016 with constant
//! speeds). Measured stopping times and distances take the place of `a`.

use numeric::error::{Failure, Given, Result, not_negative, positive};

/// Inputs of the protective separation distance beside the speed of the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Separation {
    /// Speed of the person towards the robot (m/s).
    pub human_speed: f64,
    /// Time before the robot begins to brake (s).
    pub reaction_time: f64,
    /// Distance that a part of the body reaches before it is detected, `C` (m).
    pub intrusion: f64,
    /// Uncertainty of the positions of person and robot together (m).
    pub uncertainty: f64,
    /// Speed to which the robot slows down (m/s).
    pub target_speed: f64,
}

impl Separation {
    /// Returns the numbers if each of them is finite and not negative.
    ///
    /// # Errors
    /// One of them is not.
    pub fn checked(self) -> Result<Self> {
        not_negative("human_speed", self.human_speed)?;
        not_negative("reaction_time", self.reaction_time)?;
        not_negative("intrusion", self.intrusion)?;
        not_negative("uncertainty", self.uncertainty)?;
        not_negative("target_speed", self.target_speed)?;
        Ok(self)
    }

    /// Distance for a robot that brakes with a constant deceleration (m).
    ///
    /// # Errors
    /// The speed is negative, not finite or below the target speed, the deceleration not positive.
    pub fn distance(&self, robot_speed: f64, deceleration: f64) -> Result<f64> {
        positive("deceleration", deceleration)?;
        let (v, target) = (self.speed_to_target(robot_speed)?, self.target_speed);
        let braking = (v - target) / deceleration;
        // (v^2 - v_t^2)/2a as a product, without the cancellation of the squares.
        Ok(self.with_stop(v, braking, 0.5 * (v + target) * braking))
    }

    /// Largest speed that the distance to a person allows (m/s): the target speed where it is too
    /// short for more.
    ///
    /// # Errors
    /// The distance is negative or not finite, or the deceleration is not positive.
    pub fn speed(&self, distance: f64, deceleration: f64) -> Result<f64> {
        positive("deceleration", deceleration)?;
        not_negative("distance", distance)?;
        let (a, target) = (deceleration, self.target_speed);
        let half = self.reaction_time + self.human_speed / a;
        let constant = self.human_speed * (self.reaction_time - target / a)
            - target * target / (2.0 * a)
            + self.intrusion
            + self.uncertainty
            - distance;
        // v^2/2a + half v + constant = 0, by the form of the root that loses no digits.
        let discriminant = half * half - 2.0 * constant / a;
        if constant >= 0.0 || discriminant <= 0.0 {
            return Ok(target);
        }
        Ok((-2.0 * constant / (half + discriminant.sqrt())).max(target))
    }

    fn speed_to_target(&self, robot_speed: f64) -> Result<f64> {
        not_negative("robot_speed", robot_speed)?;
        if robot_speed < self.target_speed {
            let rule = format!("be at least target_speed ({:?})", self.target_speed);
            return Err(Failure::invalid(
                "robot_speed",
                rule,
                Given::Number(robot_speed),
            ));
        }
        Ok(robot_speed)
    }

    /// Distance with a stop of known time and length.
    fn with_stop(&self, speed: f64, time: f64, length: f64) -> f64 {
        self.human_speed * (self.reaction_time + time)
            + speed * self.reaction_time
            + length
            + self.intrusion
            + self.uncertainty
    }
}

/// Measured stops by speed: times and distances that do not fall as the speed grows, linear in between.
#[derive(Clone, Debug, PartialEq)]
pub struct StoppingCurve {
    speed: Vec<f64>,
    time: Vec<f64>,
    distance: Vec<f64>,
}

/// Measured stops over speed, load and extension of the arm.
#[derive(Clone, Debug)]
pub struct StoppingTable {
    /// Values of the three axes, each increasing.
    pub axes: [Vec<f64>; 3],
    /// Times (s), the extension varying fastest.
    pub time: Vec<f64>,
    /// Distances (m), likewise.
    pub distance: Vec<f64>,
}

const AXES: [&str; 3] = ["speed", "load", "extension"];

impl StoppingTable {
    /// Returns the table if it may be one of measured stops.
    ///
    /// # Errors
    /// An axis is empty or does not increase, a number is negative or not finite, or a stop from a
    /// higher speed is shorter.
    pub fn checked(self) -> Result<Self> {
        for (name, axis) in AXES.iter().zip(&self.axes) {
            if axis.is_empty() {
                return Err(Failure::invalid(*name, "have values", Given::Count(0)));
            }
            for (index, value) in axis.iter().enumerate() {
                let place = format!("{name}[{index}]");
                not_negative(&place, *value)?;
                if index > 0 && *value <= axis[index - 1] {
                    let rule = format!("exceed the value before it ({:?})", axis[index - 1]);
                    return Err(Failure::invalid(place, rule, Given::Number(*value)));
                }
            }
        }
        let width = self.axes[1].len() * self.axes[2].len();
        let count = self.axes[0].len() * width;
        for (name, values) in [("time", &self.time), ("distance", &self.distance)] {
            if values.len() != count {
                let rule = format!("have {count} values, one for each speed, load and extension");
                return Err(Failure::invalid(
                    name,
                    rule,
                    Given::Count(values.len() as u64),
                ));
            }
            for (index, value) in values.iter().enumerate() {
                let place = || self.place(name, index);
                not_negative(&place(), *value)?;
                if index >= width && *value < values[index - width] {
                    let before = values[index - width];
                    let rule = format!("not fall as the speed grows (from {before:?})");
                    return Err(Failure::invalid(place(), rule, Given::Number(*value)));
                }
            }
        }
        Ok(self)
    }

    /// Name of a value with its indices.
    fn place(&self, name: &str, index: usize) -> String {
        let [_, loads, extensions] = [0, 1, 2].map(|axis| self.axes[axis].len());
        let (speed, rest) = (index / (loads * extensions), index % (loads * extensions));
        format!(
            "{name}[{speed}, {}, {}]",
            rest / extensions,
            rest % extensions
        )
    }

    /// Stops at one load and extension, linear between those measured.
    ///
    /// # Errors
    /// They are outside the table.
    pub fn at(&self, load: f64, extension: f64) -> Result<StoppingCurve> {
        let near = [(1, load), (2, extension)].map(|(axis, value)| self.between(axis, value));
        let [loads, extensions] = near;
        let ((load, over_load), (extension, over_extension)) = (loads?, extensions?);
        let [_, rows, columns] = [0, 1, 2].map(|axis| self.axes[axis].len());
        let read = |values: &[f64], speed: usize| {
            let value = |row: usize, column: usize| {
                let (row, column) = (row.min(rows - 1), column.min(columns - 1));
                values[(speed * rows + row) * columns + column]
            };
            let along = |row| {
                mixed(
                    value(row, extension),
                    value(row, extension + 1),
                    over_extension,
                )
            };
            mixed(along(load), along(load + 1), over_load)
        };
        let all = |values: &[f64]| {
            (0..self.axes[0].len())
                .map(|speed| read(values, speed))
                .collect()
        };
        Ok(StoppingCurve {
            speed: self.axes[0].clone(),
            time: all(&self.time),
            distance: all(&self.distance),
        })
    }

    /// The measured value below a given one, and which share of the way to the next it has gone.
    fn between(&self, axis: usize, value: f64) -> Result<(usize, f64)> {
        let known = &self.axes[axis];
        inside(AXES[axis], known, value)?;
        let lower = known.partition_point(|each| *each <= value).max(1) - 1;
        match known.get(lower + 1) {
            Some(upper) => Ok((lower, (value - known[lower]) / (upper - known[lower]))),
            None => Ok((lower, 0.0)),
        }
    }
}

/// Refuses a value outside an axis of a table: nothing is known there.
fn inside(name: &str, axis: &[f64], value: f64) -> Result<()> {
    let (first, last) = (axis[0], axis[axis.len() - 1]);
    if value >= first && value <= last {
        return Ok(());
    }
    let rule = format!("be within the measured stops, {first:?} to {last:?} (outside_table)");
    let failure = Failure::invalid(name, rule, Given::Number(value));
    Err(failure.mended_by("measure more stops: nothing is extrapolated"))
}

fn mixed(one: f64, other: f64, share: f64) -> f64 {
    one + (other - one) * share
}

impl StoppingCurve {
    /// Distance for a robot that stops as measured (m). The whole stop counts also where the robot
    /// only slows down: nothing is known about how long that takes.
    ///
    /// # Errors
    /// The speed is below the target speed, or outside the table.
    pub fn separation(&self, rules: &Separation, robot_speed: f64) -> Result<f64> {
        let speed = rules.speed_to_target(robot_speed)?;
        inside("robot_speed", &self.speed, speed)?;
        let upper = self.speed.partition_point(|each| *each < speed).max(1);
        let lower = upper - 1;
        let upper = upper.min(self.speed.len() - 1);
        let width = self.speed[upper] - self.speed[lower];
        let share = if width > 0.0 {
            (speed - self.speed[lower]) / width
        } else {
            0.0
        };
        let time = mixed(self.time[lower], self.time[upper], share);
        let length = mixed(self.distance[lower], self.distance[upper], share);
        Ok(rules.with_stop(speed, time, length))
    }

    /// Largest measured speed that the distance to a person allows (m/s), and whether more might be
    /// allowed beyond the table.
    ///
    /// # Errors
    /// The distance is negative or not finite.
    pub fn speed(&self, rules: &Separation, distance: f64) -> Result<(f64, bool)> {
        not_negative("distance", distance)?;
        let needed = |index: usize| {
            rules.with_stop(self.speed[index], self.time[index], self.distance[index])
        };
        let last = self.speed.len() - 1;
        // The distance grows with the speed: how many of the measured speeds are allowed.
        let (mut allowed, mut too_fast) = (0, self.speed.len());
        while allowed < too_fast {
            let middle = usize::midpoint(allowed, too_fast);
            if needed(middle) <= distance {
                allowed = middle + 1;
            } else {
                too_fast = middle;
            }
        }
        if allowed == 0 {
            return Ok((rules.target_speed, false));
        }
        let index = allowed - 1;
        if index == last {
            return Ok((self.speed[last].max(rules.target_speed), true));
        }
        let (near, far) = (needed(index), needed(index + 1));
        let share = (distance - near) / (far - near);
        let speed = mixed(self.speed[index], self.speed[index + 1], share);
        Ok((speed.max(rules.target_speed), false))
    }
}

/// Ways of a person into a guarded zone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Guard {
    /// Through a light curtain that detects hands: its detection capability (m).
    Curtain(f64),
    /// Through a field that only bodies enter.
    Body,
    /// Along a field parallel to the floor at a height (m).
    Floor(f64),
}

/// Least distance of a guard, and how it came about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuardDistance {
    /// Least distance (m).
    pub distance: f64,
    /// The first result, before the lower speed of approach was tried (m).
    pub first: f64,
    /// Speed of approach (m/s).
    pub approach_speed: f64,
    /// Intrusion distance (m).
    pub intrusion: f64,
}

/// Largest detection capability of a curtain that detects hands (m).
pub const HAND_DETECTION: f64 = 0.04;

/// Least distance of any guard (m): the floor that manuals of makers print for ISO 13855.
pub const LEAST_GUARD_DISTANCE: f64 = 0.1;

/// Greatest height of a field parallel to the floor (m): below a higher one people pass.
pub const HIGHEST_FIELD: f64 = 1.0;

/// Least distance `S = K T + C` between a guard and what it guards, for a stop within `T` (s), never below
/// [`LEAST_GUARD_DISTANCE`].
///
/// # Errors
/// A number is not positive, a curtain detects no hands, or a field lies above [`HIGHEST_FIELD`].
pub fn guard_distance(time: f64, guard: Guard) -> Result<GuardDistance> {
    positive("stopping_time", time)?;
    let at = |approach_speed: f64, intrusion: f64| approach_speed * time + intrusion;
    let (walking, reaching) = (1.6, 2.0);
    let (approach_speed, intrusion) = match guard {
        Guard::Curtain(capability) => {
            positive("capability", capability)?;
            if capability > HAND_DETECTION {
                let rule = "be at most 0.04 for a curtain that detects hands";
                let failure = Failure::invalid("capability", rule, Given::Number(capability));
                return Err(failure.mended_by("leave it out for a field that only bodies enter"));
            }
            let intrusion = (8.0 * (capability - 0.014)).max(0.0);
            let first = at(reaching, intrusion);
            if first > 0.5 {
                return Ok(GuardDistance {
                    distance: at(walking, intrusion).max(0.5),
                    first,
                    approach_speed: walking,
                    intrusion,
                });
            }
            (reaching, intrusion)
        }
        Guard::Body => (walking, 0.85),
        Guard::Floor(height) => {
            not_negative("height", height)?;
            if height > HIGHEST_FIELD {
                let rule = "be at most 1 for a field parallel to the floor: people pass below a higher one";
                let failure = Failure::invalid("height", rule, Given::Number(height));
                return Err(failure.mended_by("give it in meters, or lower the field"));
            }
            (walking, (1.2 - 0.4 * height).max(0.85))
        }
    };
    let first = at(approach_speed, intrusion);
    Ok(GuardDistance {
        distance: first.max(LEAST_GUARD_DISTANCE),
        first,
        approach_speed,
        intrusion,
    })
}

#[cfg(test)]
mod tests {
    use super::{Guard, LEAST_GUARD_DISTANCE, Separation, StoppingTable, guard_distance};

    const RULES: Separation = Separation {
        human_speed: 1.6,
        reaction_time: 0.1,
        intrusion: 0.2,
        uncertainty: 0.1,
        target_speed: 0.3,
    };

    #[test]
    fn worked_example_of_slowing_down() {
        let distance = RULES.distance(1.5, 3.0).unwrap_or_default();
        assert!((distance - 1.61).abs() < 1e-12);
        let speed = RULES.speed(1.0, 3.0).unwrap_or_default();
        assert!((speed - 0.910_693_9).abs() < 1e-7);
        // Too close for anything but the target speed.
        assert_eq!(RULES.speed(0.4, 3.0), Ok(0.3));
        assert!(RULES.distance(0.2, 3.0).is_err());
    }

    fn table() -> StoppingTable {
        StoppingTable {
            axes: [vec![0.0, 1.0, 2.0], vec![0.0, 10.0], vec![0.5]],
            time: vec![0.0, 0.0, 0.2, 0.3, 0.5, 0.7],
            distance: vec![0.0, 0.0, 0.1, 0.15, 0.5, 0.7],
        }
    }

    #[test]
    fn measured_stops_are_read_between_and_never_beyond() {
        let Ok(curve) = table().checked().and_then(|table| table.at(5.0, 0.5)) else {
            unreachable!("the table is right")
        };
        let rules = Separation {
            target_speed: 0.0,
            ..RULES
        };
        // Half way in load: 0.25 s and 0.125 m at 1 m/s.
        let expected = 1.6 * (0.1 + 0.25) + 0.1 + 0.125 + 0.3;
        let found = curve.separation(&rules, 1.0).unwrap_or_default();
        assert!((found - expected).abs() < 1e-15);
        assert!(curve.separation(&rules, 2.1).is_err());
        assert!(table().at(11.0, 0.5).is_err());
        assert!(table().at(5.0, 0.4).is_err());
        for speed in [0.0, 0.3, 1.0, 1.7] {
            let distance = curve.separation(&rules, speed).unwrap_or_default();
            let (back, beyond) = curve.speed(&rules, distance).unwrap_or_default();
            assert!((back - speed).abs() < 1e-12 && !beyond);
        }
        assert_eq!(curve.speed(&rules, 100.0), Ok((2.0, true)));
        assert_eq!(curve.speed(&rules, 0.1), Ok((0.0, false)));
    }

    #[test]
    fn stops_that_grow_shorter_are_refused() {
        let mut falling = table();
        falling.distance[4] = 0.05;
        let refused = falling
            .checked()
            .map(|_| ())
            .map_err(|error| error.to_string());
        let words = "distance[2, 0, 0] must not fall as the speed grows (from 0.1), got 0.05";
        assert_eq!(refused, Err(words.to_owned()));
    }

    #[test]
    fn distances_of_guards_are_those_of_the_manuals() {
        let curtain = guard_distance(0.32, Guard::Curtain(0.014));
        let found = curtain.map(|found| (found.first, found.distance));
        assert_eq!(found, Ok((0.64, 0.512)));
        let slow = guard_distance(0.26, Guard::Curtain(0.014)).map(|found| found.distance);
        assert_eq!(slow, Ok(0.5));
        let quick = guard_distance(0.1, Guard::Curtain(0.03)).map(|found| found.distance);
        assert!((quick.unwrap_or_default() - 0.328).abs() < 1e-15);
        let instant = guard_distance(0.02, Guard::Curtain(0.014));
        let found = instant.map(|found| (found.first, found.distance));
        assert_eq!(found, Ok((0.04, LEAST_GUARD_DISTANCE)));
        for height in [1.01, 1.5, 300.0] {
            assert!(guard_distance(0.5, Guard::Floor(height)).is_err());
        }
        let body = guard_distance(0.5, Guard::Body).map(|found| found.distance);
        assert_eq!(body, Ok(0.8 + 0.85));
        let floor = |height| guard_distance(0.5, Guard::Floor(height)).map(|found| found.intrusion);
        assert_eq!(floor(0.0), Ok(1.2));
        assert_eq!(floor(1.0), Ok(0.85));
        assert!(guard_distance(0.1, Guard::Curtain(0.05)).is_err());
    }
}
