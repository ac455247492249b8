//! Whether a velocity is free: no contact within the horizon, and none on the way to it.

use super::{Cone, Vector, VelocityObstaclePlanner};
use crate::Situation;
use crate::planning::outline::Outline;
use numeric::lanes::Planar;

/// Instants of a control period at which the way to a new velocity is checked.
const INSTANTS: u32 = 6;

/// Room for rounding in bounds, relative and in m: well above all roundings.
const ROOM: f64 = 1e-6;

/// Whether an obstacle is farther away than it and the robot, which goes no farther than given, come in
/// a period: without a root, and where in doubt it is not.
pub(super) fn is_far(now: &Outline, farthest: f64, period: f64) -> bool {
    let Some(center) = now.center() else {
        return false;
    };
    let [x, y] = now.velocity.lane(0);
    let reach = now.radius + farthest + (x.abs() + y.abs()) * period;
    center.dot(&center) > reach * reach * (1.0 + ROOM) + ROOM
}

impl Cone {
    pub(super) fn time_to_contact(&self, velocity: Vector) -> f64 {
        let relative = velocity - self.outline.velocity;
        match self.legs {
            // Most are far beside, which takes no root.
            Some(legs) if !legs.may_hold(relative) || !legs.hold(relative) => f64::INFINITY,
            _ => self.outline.time_to_contact(relative),
        }
    }
}

impl VelocityObstaclePlanner {
    pub(super) fn time_to_contact(&self, velocity: Vector) -> f64 {
        let times = self.cones.iter().map(|cone| cone.time_to_contact(velocity));
        times.fold(f64::INFINITY, f64::min)
    }

    /// More than the robot goes within a control period in m, whichever velocity it is to reach.
    pub(super) fn farthest(&self, situation: &Situation<'_, f64>) -> f64 {
        let period = situation.interval;
        let change = self.max_acceleration * period;
        (self.max_speed + change) * period * (1.0 + ROOM)
    }

    /// Whether a reachable velocity is free.
    pub(super) fn free(&self, situation: &Situation<'_, f64>, velocity: Vector) -> bool {
        self.free_of(0..self.cones.len(), situation, velocity)
    }

    /// Test of a velocity that only some cones may forbid.
    #[inline]
    pub(super) fn free_of(
        &self,
        mut cones: impl Iterator<Item = usize>,
        situation: &Situation<'_, f64>,
        velocity: Vector,
    ) -> bool {
        let late = |cone: &Cone| {
            let time = cone.time_to_contact(velocity);
            time == f64::INFINITY || time > self.settings.horizon
        };
        // What forbids a velocity mostly forbids its neighbors.
        let known = self.cones.get(self.blocking.get());
        if known.is_some_and(|cone| !late(cone)) {
            return false;
        }
        if let Some(blocking) = cones.find(|index| !late(&self.cones[*index])) {
            self.blocking.set(blocking);
            return false;
        }
        !self.touches_on_the_way(situation, velocity)
    }

    /// Whether the way to a new velocity itself touches an obstacle, or comes closer to one whose
    /// margin is broken already.
    fn touches_on_the_way(&self, situation: &Situation<'_, f64>, velocity: Vector) -> bool {
        let robot = &situation.robot;
        let change = velocity - robot.velocity;
        let period = situation.interval;
        let farthest = (self.max_speed + change.dot(&change).sqrt()) * period;
        let touches = |now: &Outline| {
            let (point, inside) = now.nearest(Vector::zeros());
            let distance = if inside {
                0.0
            } else {
                point.dot(&point).sqrt()
            };
            let speed = now.velocity.dot(&now.velocity).sqrt();
            if distance - now.radius > farthest + speed * period {
                return false;
            }
            let kept = now.radius.min(distance);
            (1..=INSTANTS).any(|instant| {
                let share = f64::from(instant) / f64::from(INSTANTS);
                let steady = (robot.velocity - now.velocity) * (share * period);
                let bent = 0.5 * share * share + (self.settings.ramp - 0.5) * share;
                let way = steady + change * (bent * period);
                let (point, inside) = now.nearest(way);
                let offset = way - point;
                inside || offset.dot(&offset) < kept * kept
            })
        };
        self.close.iter().any(touches)
    }
}
