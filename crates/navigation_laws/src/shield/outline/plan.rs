//! The plan behind a command: poses, motions and sweeps of an outline until rest.

use crate::shield::TrackingError;
use crate::shield::outline::{BodyCommand, OutlineGuard};
use navigation_world::world::footprint::{BodyMotion, Sweep};
use navigation_world::world::frame::Frame;
use numeric::lanes::Vector2;

/// Slower than this, in m/s of any point, is at rest.
const STILL: f64 = 1e-9;

/// Longest time between two instants that are looked at, in s.
const LONGEST: f64 = 0.02;

/// Most parts of a ramp, and of a braking; fewest of each.
const PARTS: [usize; 2] = [64, 4];

/// Arcs that stand for a ramp.
const ARCS: usize = 4;

/// An instant of a plan.
#[derive(Clone, Copy, Debug)]
pub(super) struct Instant {
    pub time: f64,
    pub frame: Frame,
}

/// Part of a plan in which the room ahead is the union of those of the same motions at all poses.
#[derive(Clone, Debug)]
pub(super) struct Part {
    pub instants: Vec<Instant>,
    pub motions: Vec<BodyMotion>,
    /// Set for the part that ends at rest.
    pub ends: bool,
}

/// A plan of a robot that does not stay at rest.
#[derive(Clone, Debug)]
pub(super) struct BodyPlan {
    command: BodyCommand,
    parts: Vec<Part>,
    sweeps: Vec<(Frame, Sweep, bool)>,
    tracking: TrackingError,
}

/// A pose by its angle.
#[derive(Clone, Copy)]
struct OutlinePose {
    position: Vector2<f64>,
    heading: f64,
}

impl OutlinePose {
    fn frame(&self) -> Frame {
        Frame::at(self.position.into(), self.heading)
    }

    /// After a motion over a time in s, on the exact arc.
    fn after(&self, motion: &BodyMotion, time: f64) -> Self {
        let half = 0.5 * motion.turn_rate * time;
        let chord = if half.abs() < 1e-4 {
            1.0 - half * half / 6.0
        } else {
            half.sin() / half
        };
        let middle = Frame::at([0.0; 2], self.heading + half);
        Self {
            position: self.position + middle.outward(motion.velocity) * (time * chord),
            heading: self.heading + 2.0 * half,
        }
    }
}

/// The motion at a share of the way from one to another.
fn between(from: &BodyMotion, to: &BodyMotion, share: f64) -> BodyMotion {
    BodyMotion {
        velocity: from.velocity + (to.velocity - from.velocity) * share,
        turn_rate: from.turn_rate + (to.turn_rate - from.turn_rate) * share,
    }
}

/// Whether no point of a body within a radius moves.
fn rests(motion: &BodyMotion, radius: f64) -> bool {
    motion.velocity.norm() + motion.turn_rate.abs() * radius < STILL
}

/// Instants of a time in which the motion changes evenly, from the first on.
fn instants(
    (start, begin): (OutlinePose, f64),
    [from, to]: [&BodyMotion; 2],
    duration: f64,
) -> (Vec<Instant>, OutlinePose) {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // bounded
    let parts = ((duration / LONGEST).ceil().min(PARTS[0] as f64) as usize).max(PARTS[1]);
    let part = duration / parts as f64;
    let mut pose = start;
    let mut found = vec![Instant {
        time: begin,
        frame: pose.frame(),
    }];
    for index in 0..parts {
        let mean = between(from, to, (index as f64 + 0.5) / parts as f64);
        pose = pose.after(&mean, part);
        found.push(Instant {
            time: begin + (index + 1) as f64 * part,
            frame: pose.frame(),
        });
    }
    (found, pose)
}

impl BodyPlan {
    /// `None` for a robot that rests and stays at rest.
    pub fn new(guard: &OutlineGuard, command: &BodyCommand) -> Option<Self> {
        let radius = guard.outline.outer_radius();
        let (before, after) = (&command.before, &command.after);
        let still = [rests(before, radius), rests(after, radius)];
        if still == [true, true] {
            return None;
        }
        // A robot that starts from rest, or comes to rest, moves as its other motion tells; slow ones deviate most.
        let slow = guard.shield.velocity_tracking.absolute > 0.0;
        let moving = [before, after].into_iter().zip(still);
        let moving = moving.filter(|(_, still)| slow || !still);
        let ramped: Vec<BodyMotion> = moving
            .flat_map(|(motion, _)| guard.motions(motion))
            .collect();
        let start = OutlinePose {
            position: command.position,
            heading: command.heading,
        };
        let (ramp, turn) = instants((start, 0.0), [before, after], command.period);
        let mut sweeps = Vec::with_capacity(ARCS + 1);
        let mut pose = start;
        for arc in 0..ARCS {
            let mean = between(before, after, (arc as f64 + 0.5) / ARCS as f64);
            let time = command.period / ARCS as f64;
            sweeps.push((pose.frame(), sweep(&mean, time), true));
            pose = pose.after(&mean, time);
        }
        let braking = command.braking.max(0.0);
        let mut parts = vec![Part {
            instants: ramp,
            motions: ramped,
            ends: braking == 0.0 || still[1],
        }];
        if braking > 0.0 && !still[1] {
            let (instants, _) =
                instants((turn, command.period), [after, &BodyMotion::REST], braking);
            parts.extend(guard.braking_parts(after, instants));
            sweeps.push((pose.frame(), sweep(after, 0.5 * braking), false));
        }
        Some(Self {
            command: *command,
            parts,
            sweeps,
            tracking: guard.shield.velocity_tracking,
        })
    }

    pub fn parts(&self) -> &[Part] {
        &self.parts
    }

    pub fn sweeps(&self) -> &[(Frame, Sweep, bool)] {
        &self.sweeps
    }

    pub fn start(&self) -> &Frame {
        &self.sweeps[0].0
    }

    /// When the robot rests, in s.
    pub fn end(&self) -> f64 {
        self.command.period + self.command.braking.max(0.0)
    }

    fn speeds(&self) -> [f64; 2] {
        let (before, after) = (&self.command.before, &self.command.after);
        [
            before.velocity.norm().max(after.velocity.norm()),
            before.turn_rate.abs().max(after.turn_rate.abs()),
        ]
    }

    /// Most that the origin moves until rest, in m.
    pub fn way(&self) -> f64 {
        self.speeds()[0] * self.end()
    }

    /// Largest speed in m/s of a point of the body at most so far from the origin, in m.
    pub fn rate(&self, reach: f64) -> f64 {
        let [speed, turn_rate] = self.speeds();
        let deviation = self.tracking.velocity(speed + turn_rate * reach);
        speed + turn_rate * reach + deviation
    }

    /// Most by which the ramp deviates from its arcs, in m, for a body of a radius in m.
    pub fn deviation(&self, radius: f64) -> f64 {
        let (before, after) = (&self.command.before, &self.command.after);
        let straight = before.turn_rate == 0.0
            && after.turn_rate == 0.0
            && before.velocity.perp(&after.velocity) == 0.0
            && before.velocity.dot(&after.velocity) >= 0.0;
        if straight {
            return 0.0;
        }
        let change = (after.velocity - before.velocity).norm()
            + radius * (after.turn_rate - before.turn_rate).abs();
        change * self.command.period / 128.0
    }
}

fn sweep(motion: &BodyMotion, time: f64) -> Sweep {
    Sweep {
        way: motion.velocity * time,
        angle: motion.turn_rate * time,
    }
}

impl OutlineGuard {
    /// Parts of a braking: one where the directions do not depend on the speed, else one for each step, with those of
    /// its last speed.
    fn braking_parts(&self, motion: &BodyMotion, instants: Vec<Instant>) -> Vec<Part> {
        if self.shield.velocity_tracking.absolute == 0.0 {
            return vec![Part {
                motions: self.motions(motion),
                instants,
                ends: true,
            }];
        }
        let steps = instants.len() - 1;
        let step = |index: usize| {
            let left = 1.0 - (index + 1) as f64 / steps as f64;
            Part {
                motions: self.motions(&between(&BodyMotion::REST, motion, left)),
                instants: instants[index..=index + 1].to_vec(),
                ends: index + 1 == steps,
            }
        };
        (0..steps).map(step).collect()
    }
}

/// Motions of a robot that is to have one, as far as it may deviate: every motion that it can have is a sum of them with
/// weights that are not negative, so that the room ahead lies in the union of theirs.
///
/// Two wheels do not slip sideways: speed and turn rate deviate each by its share. Other robots deviate in any direction.
pub(super) fn rays(
    motion: &BodyMotion,
    tracking: TrackingError,
    wheels: bool,
    radius: f64,
) -> Vec<BodyMotion> {
    if tracking == TrackingError::EXACT {
        return vec![*motion];
    }
    if wheels {
        let (speed, turn_rate) = (motion.velocity.x, motion.turn_rate);
        let off = [
            tracking.velocity(speed.abs()),
            tracking.relative * turn_rate.abs() + tracking.absolute / radius,
        ];
        let corner = |along: f64, around: f64| {
            BodyMotion::from([speed + along * off[0], turn_rate + around * off[1]])
        };
        if tracking.absolute == 0.0 && tracking.relative < 1.0 {
            // Only the ratio counts, and a part that is zero stays so.
            let both = speed != 0.0 && turn_rate != 0.0;
            return if both {
                vec![corner(1.0, -1.0), corner(-1.0, 1.0)]
            } else {
                vec![*motion]
            };
        }
        return vec![
            corner(1.0, 1.0),
            corner(1.0, -1.0),
            corner(-1.0, 1.0),
            corner(-1.0, -1.0),
        ];
    }
    let speed = motion.velocity.norm();
    let sine = tracking.sine(speed);
    let towards = |velocity: Vector2<f64>| BodyMotion {
        velocity,
        turn_rate: motion.turn_rate,
    };
    if sine >= 1.0 {
        let most = (speed + tracking.velocity(speed)).max(STILL);
        return [
            Vector2::new(most, 0.0),
            Vector2::new(-most, 0.0),
            Vector2::new(0.0, most),
            Vector2::new(0.0, -most),
        ]
        .map(towards)
        .to_vec();
    }
    let cosine = (1.0 - sine * sine).sqrt();
    let (x, y) = (motion.velocity.x, motion.velocity.y);
    [sine, -sine]
        .map(|sin| towards(Vector2::new(x * cosine - y * sin, y * cosine + x * sin)))
        .to_vec()
}
