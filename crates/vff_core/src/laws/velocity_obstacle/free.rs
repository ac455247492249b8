//! Whether a velocity is free: no contact within the horizon, and none on the way to it.

use super::cones::find_near;
use super::{Cone, ConeBase, Vector, VelocityObstaclePlanner};
use crate::lanes::Planar;
use crate::laws::Situation;
use crate::laws::planning::outline::{Outline, entry};

/// Instants of a control period at which the way to a new velocity is checked.
const INSTANTS: u32 = 6;

/// Room for rounding in bounds, relative and in m: well above all roundings.
const ROOM: f64 = 1e-6;

/// Whether a disc, given by center and radius, is farther away than it and the robot, which goes no farther than given, come in
/// a period: without a root, and where in doubt it is not.
#[inline]
pub(super) fn is_far(
    (center, radius): (Vector, f64),
    velocity: Vector,
    (farthest, period): (f64, f64),
) -> bool {
    let [x, y] = velocity.lane(0);
    let reach = radius + farthest + (x.abs() + y.abs()) * period;
    center.dot(&center) > reach * reach * (1.0 + ROOM) + ROOM
}

impl Cone {
    /// Whether a velocity leads far beside it, as most do: without a root.
    #[inline(always)]
    pub(super) fn is_beside(&self, velocity: Vector) -> bool {
        let legs = self.legs.as_ref();
        legs.is_some_and(|legs| !legs.may_hold(velocity - self.tip))
    }

    pub(super) fn time_to_contact(&self, velocity: Vector, edged: &[Outline]) -> f64 {
        let relative = velocity - self.tip;
        if let Some(legs) = &self.legs
            && !legs.hold(relative)
        {
            return f64::INFINITY;
        }
        match self.base {
            ConeBase::Disc(center, radius) if self.legs.is_some() => {
                entry(center, radius, relative)
            }
            ConeBase::Disc(center, radius) => {
                Outline::disc(center, radius, self.tip).time_to_contact(relative)
            }
            ConeBase::Edges(place) => edged[place].time_to_contact(relative),
        }
    }
}

impl VelocityObstaclePlanner {
    pub(super) fn time_to_contact(&self, velocity: Vector) -> f64 {
        let times = self.cones.iter();
        let times = times.filter(|cone| !cone.is_beside(velocity));
        let times = times.map(|cone| cone.time_to_contact(velocity, &self.edged));
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
        self.is_late(situation, velocity, || {
            find_near(&self.legs, velocity, |index| self.forbids(index, velocity))
        })
    }

    /// The same for a velocity that only some cones may forbid.
    #[inline]
    pub(super) fn free_of(
        &self,
        mut cones: impl Iterator<Item = usize>,
        situation: &Situation<'_, f64>,
        velocity: Vector,
    ) -> bool {
        self.is_late(situation, velocity, || {
            cones.find(|index| self.forbids(*index, velocity))
        })
    }

    /// Whether a cone forbids a velocity.
    #[inline]
    fn forbids(&self, index: usize, velocity: Vector) -> bool {
        let Some(cone) = self
            .cones
            .get(index)
            .filter(|cone| !cone.is_beside(velocity))
        else {
            return false;
        };
        let time = cone.time_to_contact(velocity, &self.edged);
        let late = time == f64::INFINITY || time > self.settings.horizon;
        !late
    }

    /// Whether nothing forbids a velocity, given how to find a cone that does.
    #[inline]
    fn is_late(
        &self,
        situation: &Situation<'_, f64>,
        velocity: Vector,
        find: impl FnOnce() -> Option<usize>,
    ) -> bool {
        // What forbids a velocity mostly forbids its neighbors.
        if self.forbids(self.blocking.get(), velocity) {
            return false;
        }
        if let Some(blocking) = find() {
            self.blocking.set(blocking);
            return false;
        }
        !self.touches_on_the_way(situation, velocity)
    }

    /// Whether the way to a new velocity itself touches an obstacle, or comes closer to one whose
    /// margin is broken already.
    fn touches_on_the_way(&self, situation: &Situation<'_, f64>, velocity: Vector) -> bool {
        if self.close.is_empty() {
            return false;
        }
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
