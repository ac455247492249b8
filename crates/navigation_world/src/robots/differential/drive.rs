//! Pose, limits and motion of a robot that cannot move sideways.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector2;

use crate::robots::DifferentialDriveRobot;
use crate::world::frame::Frame;
use numeric::error::{Result, finite, finite_pair, positive};

/// Half turns below this have `sin(x)/x = 1 - x^2/6` to the last bit, in rad.
const SMALL_TURN: f64 = 1e-4;

/// Angle wrapped into `(-pi, pi]`, in rad.
#[must_use]
pub fn wrapped(angle: f64) -> f64 {
    if -PI < angle && angle <= PI {
        return angle;
    }
    let turned = (angle + PI).rem_euclid(TAU);
    // The remainder lies in [0, 2 pi); its zero is the half turn itself.
    if turned == 0.0 { PI } else { turned - PI }
}

/// `sin(x)/x`, 1 at 0.
#[must_use]
pub(crate) fn sine_ratio(angle: f64) -> f64 {
    if angle.abs() < SMALL_TURN {
        1.0 - angle * angle / 6.0
    } else {
        angle.sin() / angle
    }
}

/// Where a robot is and where it looks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pose {
    /// Position `P_r` in m.
    pub position: [f64; 2],
    /// Heading `phi` in rad; counts whole turns.
    pub heading: f64,
}

impl Pose {
    /// Returns the pose if its numbers are finite.
    ///
    /// # Errors
    /// Names the number that is not.
    pub fn checked(self) -> Result<Self> {
        finite_pair("position", self.position)?;
        finite("heading", self.heading)?;
        Ok(self)
    }

    /// Pose after driving for `duration` s at a constant twist: the exact arc. Its chord of
    /// `v T sin(w T/2)/(w T/2)` points along the heading at half time.
    #[must_use]
    pub fn after(&self, twist: Twist, duration: f64) -> Self {
        let (chord, half_turn) = twist.chord(duration, Integration::Arc);
        let (sin, cos) = (self.heading + half_turn).sin_cos();
        Self {
            position: [
                self.position[0] + chord * cos,
                self.position[1] + chord * sin,
            ],
            heading: self.heading + twist.turn_rate * duration,
        }
    }
}

/// Motion along and around: what two wheels can give.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Twist {
    /// Forward speed `v` in m/s.
    pub speed: f64,
    /// Turn rate `omega` in rad/s, counter-clockwise.
    pub turn_rate: f64,
}

impl Twist {
    /// Returns the twist if its numbers are finite.
    ///
    /// # Errors
    /// Names the number that is not.
    pub fn checked(self) -> Result<Self> {
        finite("speed", self.speed)?;
        finite("turn_rate", self.turn_rate)?;
        Ok(self)
    }
}

/// How far a robot comes with a constant twist.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Integration {
    /// Along the exact arc.
    #[default]
    Arc,
    /// Along the chord of the arc, with the length of the arc taken for that of the chord: too far
    /// by a share of `(w T)^2/24`.
    Chord,
}

impl Twist {
    /// Length of the chord after `duration` s in m, and the angle between it and the first
    /// heading, which is half of the turn, in rad.
    #[inline]
    #[must_use]
    pub fn chord(&self, duration: f64, integration: Integration) -> (f64, f64) {
        let half_turn = 0.5 * self.turn_rate * duration;
        let length = self.speed * duration;
        match integration {
            Integration::Arc => (length * sine_ratio(half_turn), half_turn),
            Integration::Chord => (length, half_turn),
        }
    }

    /// A frame after `duration` s.
    #[inline]
    #[must_use]
    pub fn moved(&self, frame: &Frame, duration: f64, integration: Integration) -> Frame {
        let (chord, half_turn) = self.chord(duration, integration);
        let (sin, cos) = half_turn.sin_cos();
        let turn = Vector2::new(cos, sin);
        let half = Frame {
            position: frame.position,
            direction: frame.outward(turn),
        };
        Frame {
            position: frame.position + half.direction * chord,
            direction: half.outward(turn),
        }
    }
}

/// Limits of a two-wheel robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DifferentialLimits {
    /// Largest `|v|` in m/s.
    pub max_speed: f64,
    /// Largest `d|v|/dt` in m/s^2.
    pub max_acceleration: f64,
    /// Largest `-d|v|/dt` in m/s^2.
    pub max_deceleration: f64,
    /// Largest `|omega|` in rad/s.
    pub max_turn_rate: f64,
    /// Largest `|d omega/dt|` in rad/s^2.
    pub max_angular_acceleration: f64,
}

impl Default for DifferentialLimits {
    /// The robot of Zeng (2011), chapter 7: 0.7 m/s, 10 m/s^2, `2 V/l` = 5 rad/s for wheels
    /// 0.28 m apart, 70 rad/s^2.
    fn default() -> Self {
        Self {
            max_speed: 0.7,
            max_acceleration: 10.0,
            max_deceleration: 10.0,
            max_turn_rate: 5.0,
            max_angular_acceleration: 70.0,
        }
    }
}

impl From<&DifferentialDriveRobot> for DifferentialLimits {
    fn from(robot: &DifferentialDriveRobot) -> Self {
        Self {
            max_speed: robot.max_speed,
            max_acceleration: robot.max_acceleration,
            max_deceleration: robot.max_deceleration.unwrap_or(robot.max_acceleration),
            max_turn_rate: robot.turn_rate(),
            max_angular_acceleration: robot.turn_acceleration(),
        }
    }
}

impl DifferentialLimits {
    /// Passes limits that are finite and positive.
    ///
    /// # Errors
    /// Names the limit that is not.
    pub fn checked(self) -> Result<Self> {
        positive("max_speed", self.max_speed)?;
        positive("max_acceleration", self.max_acceleration)?;
        positive("max_deceleration", self.max_deceleration)?;
        positive("max_turn_rate", self.max_turn_rate)?;
        positive("max_angular_acceleration", self.max_angular_acceleration)?;
        Ok(self)
    }

    /// The twist with speed and turn rate cut to their limits, each by itself.
    #[must_use]
    pub fn within(&self, twist: Twist) -> Twist {
        Twist {
            speed: twist.speed.clamp(-self.max_speed, self.max_speed),
            turn_rate: twist
                .turn_rate
                .clamp(-self.max_turn_rate, self.max_turn_rate),
        }
    }

    /// The twist with both parts scaled by one factor until they fit: the same path, slower.
    #[must_use]
    pub fn scaled(&self, twist: Twist) -> Twist {
        let factor = (self.max_speed / twist.speed.abs())
            .min(self.max_turn_rate / twist.turn_rate.abs())
            .min(1.0);
        Twist {
            speed: factor * twist.speed,
            turn_rate: factor * twist.turn_rate,
        }
    }

    /// The twist that can be reached from `now` within `duration` s on the way to a wish.
    #[must_use]
    pub fn toward(&self, now: Twist, wish: Twist, duration: f64) -> Twist {
        let wish = self.within(wish);
        let speed = self.speed_change(now.speed, wish.speed, duration);
        let turn = self.max_angular_acceleration * duration;
        Twist {
            speed: now.speed + (wish.speed - now.speed).clamp(-speed, speed),
            turn_rate: now.turn_rate + (wish.turn_rate - now.turn_rate).clamp(-turn, turn),
        }
    }

    /// Most by which the speed changes within `duration` s on the way to a wish, in m/s; what brakes harder
    /// than it accelerates stands before it drives the other way.
    fn speed_change(&self, now: f64, wish: f64, duration: f64) -> f64 {
        let (faster, slower) = (
            self.max_acceleration * duration,
            self.max_deceleration * duration,
        );
        let brakes = now * (wish - now) < 0.0;
        if !brakes {
            faster
        } else if slower > faster {
            slower.min(now.abs()).max(faster)
        } else {
            slower
        }
    }
}

/// A robot with ideal wheels: within its limits it does what it is told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DifferentialDrive {
    /// Where it is.
    pub pose: Pose,
    /// Linear velocity and turn rate.
    pub twist: Twist,
    limits: DifferentialLimits,
}

impl DifferentialDrive {
    /// A robot that moves from a pose with a twist.
    #[must_use]
    pub fn new(limits: &DifferentialLimits, pose: Pose, twist: Twist) -> Self {
        Self {
            pose,
            twist,
            limits: *limits,
        }
    }

    /// Moves for `step` s: the twist first, as far as the limits let it, then the pose along the
    /// exact arc with the new twist.
    pub fn step(&mut self, wish: Twist, step: f64) {
        self.twist = self.limits.toward(self.twist, wish, step);
        self.pose = self.pose.after(self.twist, step);
    }

    /// Velocity of the center in m/s.
    #[must_use]
    pub fn velocity(&self) -> [f64; 2] {
        let (sin, cos) = self.pose.heading.sin_cos();
        [self.twist.speed * cos, self.twist.speed * sin]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_turns_stay_and_whole_turns_vanish() {
        assert_eq!(wrapped(PI), PI);
        assert_eq!(wrapped(-PI), PI);
        assert_eq!(wrapped(0.5), 0.5);
        assert!((wrapped(0.5 + 3.0 * TAU) - 0.5).abs() < 1e-14);
        assert!((wrapped(4.0) - (4.0 - TAU)).abs() < 1e-15);
        assert!((wrapped(-4.0) - (TAU - 4.0)).abs() < 1e-15);
    }

    #[test]
    fn a_full_circle_comes_back() {
        let start = Pose {
            position: [1.0, -2.0],
            heading: 0.3,
        };
        let twist = Twist {
            speed: 0.5,
            turn_rate: 2.0,
        };
        let end = start.after(twist, PI);
        assert!((end.position[0] - 1.0).abs() < 1e-15 && (end.position[1] + 2.0).abs() < 1e-15);
        // A quarter of a circle of radius v/omega, in one step and in a thousand.
        let quarter = start.after(twist, 0.25 * PI);
        let mut many = start;
        for _ in 0..1000 {
            many = many.after(twist, 0.25e-3 * PI);
        }
        for axis in 0..2 {
            assert!((quarter.position[axis] - many.position[axis]).abs() < 1e-13);
        }
        let center = [1.0 - 0.25 * 0.3f64.sin(), -2.0 + 0.25 * 0.3f64.cos()];
        let angle = 0.3 + 0.5 * PI;
        assert!((quarter.position[0] - (center[0] + 0.25 * angle.sin())).abs() < 1e-15);
        assert!((quarter.position[1] - (center[1] - 0.25 * angle.cos())).abs() < 1e-15);
    }

    #[test]
    fn a_frame_and_a_pose_move_alike_and_the_chord_goes_too_far() {
        let twist = Twist {
            speed: 0.5,
            turn_rate: 2.0,
        };
        let pose = Pose {
            position: [1.0, -2.0],
            heading: 0.3,
        };
        let frame = Frame::at(pose.position, pose.heading);
        let (exact, there) = (
            twist.moved(&frame, 0.1, Integration::Arc),
            pose.after(twist, 0.1),
        );
        assert!((exact.position - Vector2::from(there.position)).norm() < 1e-15);
        assert!((exact.angle() - there.heading).abs() < 1e-15);
        let chord = twist.moved(&frame, 0.1, Integration::Chord);
        let ways = [exact, chord].map(|end| (end.position - frame.position).norm());
        let excess = ways[1] / ways[0] - 1.0;
        assert!((excess - 0.2 * 0.2 / 24.0).abs() < 1e-5, "{excess}");
        assert_eq!(exact.direction, chord.direction);
    }

    #[test]
    fn both_forms_of_the_sine_ratio_meet() {
        for angle in [0.999_999 * SMALL_TURN, SMALL_TURN, 1.000_001 * SMALL_TURN] {
            assert!((sine_ratio(angle) - angle.sin() / angle).abs() < 2.3e-16);
        }
        assert_eq!(sine_ratio(0.0), 1.0);
    }

    #[test]
    fn limits_bound_speed_and_its_change() {
        let limits = DifferentialLimits::default();
        let wish = Twist {
            speed: 2.0,
            turn_rate: -9.0,
        };
        let mut drive = DifferentialDrive::new(&limits, Pose::default(), Twist::default());
        drive.step(wish, 0.01);
        assert!((drive.twist.speed - 0.1).abs() < 1e-15);
        assert!((drive.twist.turn_rate + 0.7).abs() < 1e-15);
        for _ in 0..20 {
            drive.step(wish, 0.01);
        }
        assert_eq!((drive.twist.speed, drive.twist.turn_rate), (0.7, -5.0));
        let slower = limits.scaled(Twist {
            speed: 0.7,
            turn_rate: 10.0,
        });
        assert!((slower.speed - 0.35).abs() < 1e-15 && (slower.turn_rate - 5.0).abs() < 1e-15);
        assert_eq!(limits.scaled(Twist::default()), Twist::default());
        let thesis = DifferentialLimits::from(&DifferentialDriveRobot::default());
        assert!((thesis.max_turn_rate - limits.max_turn_rate).abs() < 1e-14);
    }
}
