//! The plan behind a command: take up a velocity within a period, then brake to rest.

use crate::shield::half_disc::Look;
use crate::shield::hidden::{Hidden, HiddenInstant};
use crate::shield::person::Person;
use crate::shield::{ShieldLimits, TrackingError};
use navigation_world::world::geometry::RobotState;
use navigation_world::world::shape::Shape;
use numeric::lanes::Vector2;

/// Slower than this is at rest and looks nowhere, in m/s.
const STILL: f64 = 1e-9;

/// Conservative advancement refuses what comes nearer than this, in m.
const LEAST: f64 = 1e-4;

/// More than [`LEAST`] by more than rounding, in m.
const FAR: f64 = 1e-3;

/// More than rounding adds to a distance, in m.
const SURELY: f64 = 1e-9;

/// Accuracy of a least distance as a share of its largest change: it bounds the steps to find it.
const FINEST: f64 = 1e-6;

/// Instants of a plan that a search for the least distance begins with.
const LOOKS: u32 = 16;

/// Parts of a braking in which the directions of a robot that slows down are bounded by those of its last
/// speed; one is enough where they do not depend on the speed.
const PARTS: u32 = 8;

/// Rounding of a number of periods.
const ROUNDING: f64 = 1e-9;

/// Whole periods in which a robot can brake from a speed.
#[inline]
#[must_use]
pub fn braking_periods(speed: f64, limits: &ShieldLimits) -> f64 {
    (speed / limits.change() - ROUNDING).ceil().max(0.0)
}

/// The velocity after one period of the braking that the last verified plan ends with,
/// `V (N-1)/N`.
#[must_use]
pub fn braking(velocity: Vector2<f64>, limits: &ShieldLimits) -> Vector2<f64> {
    let periods = braking_periods(velocity.norm(), limits);
    if periods <= 1.0 {
        return Vector2::zeros();
    }
    velocity * ((periods - 1.0) / periods)
}

/// Ramp from `V` to `u` within a period `T`, then braking along `u` in whole periods, then rest.
#[derive(Clone, Copy, Debug)]
pub struct BrakingPlan {
    position: Vector2<f64>,
    before: Vector2<f64>,
    command: Vector2<f64>,
    period: f64,
    /// Time of braking in s.
    braking: f64,
    /// The larger of both speeds, in m/s.
    speed: f64,
    /// Largest difference between the velocities of plan and robot, in m/s.
    deviation: f64,
    /// Where the half discs of `V` and of `u` look, in the ramp the union.
    ramp: [Look; 2],
    tracking: TrackingError,
}

impl BrakingPlan {
    /// The plan for a command `u` that is given to a robot, which follows it as its tracking tells.
    #[inline]
    #[must_use]
    pub fn new(
        robot: &RobotState<f64>,
        command: Vector2<f64>,
        limits: &ShieldLimits,
        tracking: TrackingError,
    ) -> Self {
        let (first, second) = (robot.velocity.norm(), command.norm());
        let ahead = [
            robot.velocity * (1.0 / first.max(STILL)),
            command * (1.0 / second.max(STILL)),
        ];
        let speed = first.max(second);
        let slowest = if tracking.absolute == 0.0 {
            speed
        } else {
            slowest(robot.velocity, command)
        };
        let sine = tracking.sine(slowest);
        // A robot that starts from rest, or comes to rest, looks along its other velocity.
        let ahead = match (first < STILL, second < STILL) {
            (true, false) => [ahead[1]; 2],
            (false, true) => [ahead[0]; 2],
            (true, true) | (false, false) => ahead,
        };
        Self {
            position: robot.position,
            before: robot.velocity,
            command,
            period: limits.period,
            braking: braking_periods(second, limits) * limits.period,
            speed,
            deviation: tracking.velocity(speed),
            ramp: ahead.map(|ahead| Look::within(ahead, sine)),
            tracking,
        }
    }

    /// When the robot rests, in s.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.period + self.braking
    }

    /// Whether the robot neither moves nor takes up a velocity.
    fn rests(&self) -> bool {
        self.speed < STILL
    }

    /// Position at a time within the plan, in m.
    #[inline]
    #[must_use]
    pub fn position(&self, time: f64) -> Vector2<f64> {
        if time <= self.period {
            let gained = (self.command - self.before) * (0.5 * time / self.period);
            return self.position + (self.before + gained) * time;
        }
        let turn = self.position + (self.before + self.command) * (0.5 * self.period);
        if self.braking == 0.0 {
            return turn;
        }
        let braked = (time - self.period).min(self.braking);
        turn + self.command * (braked - 0.5 * braked * braked / self.braking)
    }

    /// Velocity at a time within the plan, in m/s.
    #[inline]
    #[must_use]
    pub fn velocity(&self, time: f64) -> Vector2<f64> {
        if time < self.period {
            return self.before + (self.command - self.before) * (time / self.period);
        }
        let braked = time - self.period;
        if braked < self.braking {
            self.command * (1.0 - braked / self.braking)
        } else if braked == 0.0 {
            self.command
        } else {
            Vector2::zeros()
        }
    }

    /// Until when the present part of the plan lasts, in s, and where the robot looks in it.
    fn part(&self, time: f64) -> (f64, Look) {
        // A robot whose directions are bounded alike at all speeds has one part.
        if self.tracking.absolute == 0.0 {
            return (f64::INFINITY, self.ramp[1]);
        }
        let share = |part: u32| f64::from(part) / f64::from(PARTS);
        let until = |part: u32| self.period + self.braking * share(part);
        let part = (1..PARTS).find(|part| time < until(*part)).unwrap_or(PARTS);
        let slowest = self.command.norm() * (1.0 - share(part));
        let look = self.ramp[1].widened(self.tracking.sine(slowest));
        (until(part), look)
    }

    /// `g`: distance between the half discs ahead at a time and everywhere that somebody can be
    /// then, in m, and until when that is so without a jump, in s.
    #[inline]
    fn clearance(&self, person: &Person, radius: f64, time: f64) -> (f64, f64) {
        let place = self.position(time);
        let alike = self.tracking.absolute == 0.0;
        let ramps = time < self.period || (alike && time == self.period);
        let (until, look) = if ramps && !alike {
            (self.period, self.ramp[1])
        } else {
            self.part(time)
        };
        let ahead = person.clearance(place, radius, &look, time);
        let [first, second] = &self.ramp;
        if !ramps || first == second {
            return (ahead, until);
        }
        (
            ahead.min(person.clearance(place, radius, first, time)),
            until,
        )
    }

    /// A time that is later, but not beyond the next one at which the half discs jump.
    fn later(time: f64, by: f64, until: f64) -> f64 {
        let next = time + by;
        if time < until && until < next {
            // Past it by more than rounding.
            until + until * f64::EPSILON
        } else {
            next
        }
    }

    /// Largest rate of [`Self::clearance`] in m/s.
    fn rate(&self, person: &Person) -> f64 {
        self.speed + self.deviation + person.rate(self.end())
    }

    /// Whether a disc cannot come near even to the circle that the robot can fill: a bound that spares
    /// most people the steps along the plan, and refuses nobody.
    fn out_of_reach(&self, person: &Person, radius: f64) -> bool {
        let end = self.end();
        let most = radius + self.speed * end + person.reach(end) + FAR;
        let offset = person.placed.center - self.position;
        matches!(person.placed.shape, Shape::Disc { .. }) && offset.norm_squared() > most * most
    }

    /// Whether somebody can be ahead when the robot comes to rest: then [`Self::avoids`] is false, because no
    /// step of it passes an instant at which `g` is negative.
    pub(super) fn is_met_at_end(&self, person: &Person, limits: &ShieldLimits) -> bool {
        let radius = limits.radius + person.radius();
        !self.rests() && self.clearance(person, radius, self.end()).0 < -SURELY
    }

    /// Whether nobody can be ahead at any time of the plan; `grown`: what is added to the radius
    /// at its end, in m.
    #[inline]
    pub(super) fn avoids(&self, person: &Person, limits: &ShieldLimits, grown: f64) -> bool {
        if self.rests() {
            return true;
        }
        let radius = limits.radius + person.radius();
        let (rate, end) = (self.rate(person), self.end());
        if rate == f64::INFINITY {
            // He can be anywhere at once.
            return false;
        }
        if self.out_of_reach(person, radius + grown) {
            return true;
        }
        let mut time = 0.0;
        loop {
            let (clearance, until) = self.clearance(person, radius, time);
            if clearance < LEAST {
                return false;
            }
            time = Self::later(time, clearance / rate, until);
            if time > end {
                return grown == 0.0 || self.clearance(person, radius + grown, end).0 > 0.0;
            }
        }
    }

    /// Least `g` over the plan in m, or `most` if that is less, to `accuracy` m (at the finest a millionth of what `g`
    /// can change by) and never above it by more; `most` for a robot that rests.
    #[must_use]
    pub fn gap(&self, person: &Person, limits: &ShieldLimits, accuracy: f64, most: f64) -> f64 {
        if self.rests() {
            return most;
        }
        let radius = limits.radius + person.radius();
        let (rate, end) = (self.rate(person), self.end());
        if rate == f64::INFINITY {
            return f64::NEG_INFINITY;
        }
        let accuracy = accuracy.max(FINEST * rate * end);
        // Right after the ramp only the direction of the command counts. Steps are long where `g` is far above what is
        // known to be the least, so some instants are looked at before.
        let looks = (0..=LOOKS).map(|look| end * f64::from(look) / f64::from(LOOKS));
        let looks = looks.chain([self.period]);
        let mut least = looks
            .map(|time| self.clearance(person, radius, time).0)
            .fold(most, f64::min);
        let mut time = 0.0;
        while time <= end {
            let (clearance, until) = self.clearance(person, radius, time);
            least = least.min(clearance);
            time = Self::later(time, (clearance - least + accuracy) / rate, until);
        }
        least
    }

    /// Whether nobody who is not seen can be ahead at any time of the plan, of a robot of a radius in m.
    pub(super) fn avoids_hidden(&self, hidden: &Hidden<'_>, radius: f64) -> bool {
        if self.rests() || hidden.lets_creep(self.speed) {
            return true;
        }
        let end = self.end();
        let parts = (end / hidden.unseen.sampling).ceil().max(1.0);
        let step = end / parts;
        let instant = |part: f64| {
            let time = part * step;
            let last = part == parts;
            HiddenInstant {
                time,
                half: 0.5 * step,
                position: self.position(time),
                way: 0.5 * step * (self.speed + self.deviation),
                radius: radius + if last { hidden.grown } else { 0.0 },
            }
        };
        let clear = |at: &HiddenInstant| {
            // Later the robot is slower, and looks no less far around.
            let (_, look) = self.part(at.time + at.half);
            let ramps = at.time - at.half <= self.period;
            hidden.is_clear(at, |offset| {
                let along = |look: &Look| look.toward(offset).dot(&offset);
                let braked = along(&look);
                if ramps {
                    self.ramp.iter().map(along).fold(braked, f64::max)
                } else {
                    braked
                }
            })
        };
        // Where it ends is the farthest from where it was verified last.
        let mut part = parts;
        while part >= 0.0 {
            if !clear(&instant(part)) {
                return false;
            }
            part -= 1.0;
        }
        true
    }

    /// Chords of the way with what the way deviates from them, in m: ramp in four, braking in one.
    pub(super) fn chords(&self) -> impl Iterator<Item = ([Vector2<f64>; 2], f64)> + '_ {
        let change = self.command - self.before;
        let straight =
            self.before.perp(&self.command) == 0.0 && self.before.dot(&self.command) >= 0.0;
        let deviation = if straight {
            0.0
        } else {
            (change.norm() + self.deviation) * self.period / 128.0
        };
        let ramp = (0..4).map(move |quarter| {
            let at = |part: f64| self.position(0.25 * part * self.period);
            let part = f64::from(quarter);
            ([at(part), at(part + 1.0)], deviation)
        });
        let braking = [self.position(self.period), self.position(self.end())];
        ramp.chain((self.braking > 0.0).then_some((braking, 0.0)))
    }
}

/// Least speed on the straight line from one velocity to another, in m/s.
fn slowest(from: Vector2<f64>, to: Vector2<f64>) -> f64 {
    let change = to - from;
    let square = change.norm_squared();
    if square == 0.0 {
        return from.norm();
    }
    let share = (-from.dot(&change) / square).clamp(0.0, 1.0);
    (from + change * share).norm()
}
