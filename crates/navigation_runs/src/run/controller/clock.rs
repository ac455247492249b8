//! Times that a controller is told, from clocks that are set back.
//!
//! A clock that is set back by less than what went by since the last update looks as if less time had gone by. A robot
//! that moves tells better: its place and velocity are those of its plan at the time that really is. While it rests
//! nothing tells. Whoever was not measured since then can therefore be measured longer ago than the clock has it: by as
//! much as the robot can be farther on in its plan; at rest by a control period if the update comes as regularly as
//! others (one was lost while the clock was set back), otherwise by any time.

use crate::run::controller::Controller;
use crate::run::controller::told::HeldOrder;
use navigation_laws::shield::{Course, PlanTimes, Shield, Status};
use navigation_world::world::geometry::RobotState;

/// A time that is not known to be any shorter, in s.
pub(super) const ANY: f64 = 1e6;

/// An update later than this share of a period after the last one is late.
pub(super) const LATE: f64 = 1.5;

/// An update earlier than this share of the usual time after the last one is not regular.
const EARLY: f64 = 0.9;

/// Who is measured to be no faster rests, in m/s.
const RESTING: f64 = 1e-3;

/// A clock that comes on by less than this share of a period stands.
pub(super) const STANDS: f64 = 0.01;

/// The last update.
#[derive(Clone, Copy, Debug)]
pub(super) struct Last {
    /// When the last one that counted came, in s.
    pub time: f64,
    /// How long after the one before it, in s.
    pub spacing: f64,
    /// Time that the clock showed at the last update of any kind, in s.
    pub clock: f64,
    /// Time that it showed when it was set back last, in s.
    pub restarted: f64,
    /// Set where it was seen to be set back since the last update that counted.
    pub set_back: bool,
    pub order: HeldOrder,
    /// Assumptions of the shield, if there is one.
    pub shield: Option<Shield>,
}

impl Last {
    /// The plan that the robot executes, if a shield has verified it.
    fn verified(&self) -> Option<(Shield, Course)> {
        let course = self.order.course.map(|(course, _)| course);
        self.shield.zip(course)
    }

    /// Whether an update comes as regularly as others.
    fn regular(&self, now: f64, period: f64) -> bool {
        let spacing = now - self.time;
        !self.set_back && spacing <= LATE * period && spacing >= EARLY * self.spacing.min(period)
    }
}

/// An update that counts for nothing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Held {
    /// Time of the plan at which the robot can be at the latest, in s; infinite at its end, `None` where it is not known.
    pub latest: Option<f64>,
    /// By how much the clock was set back at least, in s.
    pub set_back: Option<f64>,
}

/// Treatment of an update.
#[derive(Clone, Copy, Debug)]
pub(super) enum Reckoned {
    /// It counts, and so much more time than the clock tells may have gone by since the last one that did, in s; the
    /// times of its plan at which the robot can be, if it is at any.
    Counts(f64, Option<PlanTimes>),
    /// It counts for nothing.
    Held(Held),
    /// The clock was set back for good, and the plan has ended since, whatever it tells: the update counts, and so much
    /// is to be added to the clock, in s.
    Restarts(f64),
}

impl Controller {
    /// Treatment of an update at a time in s.
    pub(super) fn reckon(&self, now: f64, robot: Option<RobotState<f64>>) -> Reckoned {
        let Some(last) = &self.last else {
            return Reckoned::Counts(0.0, None);
        };
        let verified = last.verified();
        if now <= last.time {
            let reading = verified.zip(robot).and_then(|((shield, course), robot)| {
                shield.reading(&course, course.since(last.time), &robot)
            });
            let latest = reading.map(|reading| reading.latest);
            let running = now - last.restarted;
            let ended = verified.is_some_and(|(_, course)| running >= course.end());
            // Who rests has come to the end of the plan, or was held back from it.
            let rests = verified.zip(robot).is_some_and(|((shield, _), robot)| {
                robot.velocity.norm() <= shield.velocity_tracking.velocity(0.0).max(RESTING)
            });
            if ended && (rests || latest == Some(f64::INFINITY)) {
                return Reckoned::Restarts(last.time - last.restarted);
            }
            return Reckoned::Held(Held {
                latest,
                set_back: (now < last.time).then_some(last.time - now),
            });
        }
        let Some((shield, course)) = verified else {
            return Reckoned::Counts(0.0, None);
        };
        let resting = if last.regular(now, course.period()) {
            course.period()
        } else {
            ANY
        };
        let Some(robot) = robot else {
            return Reckoned::Counts(resting, None);
        };
        let since = course.since(now);
        let Some(reading) = shield.reading(&course, since, &robot) else {
            // It is behind its plan, as by a clock that is set right, or off it at any time: then nothing tells how much
            // time went by, and a clock that was set back does not either.
            let reading = shield.reading(&course, 0.0, &robot);
            let unknown = reading.is_none() && last.set_back;
            return Reckoned::Counts(if unknown { ANY } else { 0.0 }, reading);
        };
        // Who is slower than planned can have slipped; who is ahead has had more time.
        let off = shield.refuted(&course, since, &robot);
        if off.is_some_and(|off| off.position > 0.0) {
            return Reckoned::Held(Held {
                latest: Some(reading.latest),
                set_back: Some(reading.earliest - since),
            });
        }
        let more = if reading.latest == f64::INFINITY {
            resting
        } else {
            reading.latest - since
        };
        Reckoned::Counts(more, Some(reading))
    }

    /// Where nothing is verified for a robot that may be at another time of its plan: the plan runs on from there. It was
    /// verified, and brakes as hard as the robot can; of a robot that is behind it if that comes to rest no later.
    pub(super) fn run_on_if_off(
        &self,
        order: HeldOrder,
        now: f64,
        reading: Option<PlanTimes>,
    ) -> HeldOrder {
        let last = self.last.as_ref().and_then(Last::verified);
        let braking = order.status == Some(Status::Braking) && order.off_plan.is_some();
        let Some(((_, course), reading)) = last.zip(reading).filter(|_| braking) else {
            return order;
        };
        let since = reading.latest.min(course.end());
        let rest = order
            .course
            .map_or(0.0, |(braking, begun)| braking.end() - begun);
        if reading.latest < course.since(now) && course.end() - since > rest {
            return order;
        }
        HeldOrder {
            timing: order.timing,
            off_plan: order.off_plan,
            arrived: order.arrived,
            oldest: order.oldest,
            ..self.rest(Some((course.begun(now - since), since)))
        }
    }
}
