//! Contacts with obstacles, also between two motion steps, and who came toward whom.

use super::LaneState;
use crate::run::outcome::{CONTACT_SPEED, Contact};
use crate::run::scene::{World, body_at};
use crate::run::way::Way;
use navigation_world::world::geometry::Body;
use navigation_world::world::motion::JUMP_SPEED;
use navigation_world::world::scenario::PlacedObstacle;
use numeric::lanes::{Number, Planar, Real, Truth, Vector2};

type Vector = Vector2<f64>;

/// A contact so soon after an obstacle appears in the scene is counted apart, in s.
const APPEARING: f64 = 0.2;

/// Contacts of a robot with an obstacle.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ContactState {
    /// First contact.
    pub first: Option<Contact>,
    /// Whether the obstacle appeared in the scene where the robot was, and touched it then.
    pub apart: bool,
    /// Whether that contact lasts.
    pub appearing: bool,
    /// Whether they have overlapped by [`crate::run::DECIDED_OVERLAP`].
    pub decided: bool,
}

/// Where robots were at the start of a motion step, and when, in s.
#[derive(Clone, Copy)]
pub(super) struct Since<R> {
    pub place: Vector2<R>,
    pub time: R,
}

/// Distances beyond which robots do not touch obstacles within the motion step that ends there, squared, in m^2.
pub(super) fn alert_squared(reach: f64, speed_bound: f64, own: f64, step: f64) -> f64 {
    let speed = Number::min(speed_bound, JUMP_SPEED) + own;
    let alert = reach + speed * step + super::BOUND_MARGIN;
    alert * alert
}

impl<W: World, R: Real> LaneState<W, R> {
    /// Contacts of lanes whose robots are near an obstacle at an instant, or have touched it in the motion step that
    /// ends then: robot and obstacle move straight at constant speed in it.
    #[cold]
    #[inline(never)]
    pub(super) fn meet(
        &mut self,
        index: usize,
        (body, time): (&Body<R>, R),
        near: R::Mask,
        since: Option<&Since<R>>,
    ) {
        let offset = body.offset(self.position);
        let world = self.scenario.clone();
        let reaches = self.reach[index];
        for lane in (0..R::WIDTH).filter(|lane| near.lane(*lane)) {
            let slot = index * R::WIDTH + lane;
            let Some(placed) = world.of_lane(lane).obstacles.get(index) else {
                continue;
            };
            let mut touch = self.touches[slot];
            let (time, reach) = (time.lane(lane), reaches.lane(lane));
            let squared = offset.distance_squared.lane(lane);
            let touching = squared <= reach * reach;
            if touch.appearing {
                (touch.appearing, touch.decided) = (touching, false);
                self.touches[slot] = touch;
                continue;
            }
            if touch.decided {
                continue;
            }
            let since =
                since.map(|since| (Vector::from(since.place.lane(lane)), since.time.lane(lane)));
            let way = way_of(placed, since, (self.position.lane(lane).into(), time));
            let met = way.contact(reach, touching);
            let Some(met) = met else { continue };
            if touch.first.is_none() && self.appears(placed, time) {
                (touch.apart, touch.appearing) = (true, touching);
                self.touches[slot] = touch;
                continue;
            }
            let velocity = Vector::from(self.velocity.lane(lane));
            let toward = |offset: Vector| velocity.dot(&offset) < 0.0;
            let [first, last] = if touching && !met.decided {
                // The instant itself counts.
                [offset.vector.lane(lane).into(); 2]
            } else {
                met.shares.map(|share| way.offset(share))
            };
            let speed = self.speed.lane(lane);
            let moves = CONTACT_SPEED < velocity.dot(&velocity).sqrt();
            let at_fault = moves && (toward(first) || toward(last));
            if let Some(contact) = &mut touch.first {
                contact.at_fault |= at_fault;
            } else {
                let time = since
                    .filter(|_| !touching)
                    .map_or(time, |(_, from)| from + met.shares[0] * (time - from));
                touch.first = Some(Contact {
                    time,
                    speed,
                    toward: speed > CONTACT_SPEED && toward(first),
                    at_fault,
                });
                self.touched = true;
            }
            if !touching {
                let least = &mut self.min_distance_squared[index];
                let passed = met.least * met.least;
                *least = least.replace(lane, least.lane(lane).min(passed));
            }
            touch.decided = met.decided;
            self.touches[slot] = touch;
        }
    }

    /// Whether an obstacle has come into the scene so shortly before an instant that nobody is to blame.
    pub(super) fn appears(&self, placed: &PlacedObstacle, time: f64) -> bool {
        let (from, _) = placed.obstacle.motion.presence();
        let step = self.clock.step;
        // The first instant that shows it.
        from > 0.0 && time <= (from / step - 1e-9).ceil() * step + APPEARING
    }
}

/// From a place and an instant to another one; only the end of it where there is no start, or where the obstacle
/// was absent or has jumped.
fn way_of(
    placed: &PlacedObstacle,
    since: Option<(Vector, f64)>,
    (place, time): (Vector, f64),
) -> Way {
    let center = |body: Body| Vector::from(body.state.position);
    let to = place - center(body_at(placed, time, &mut 0));
    let from = since.and_then(|(place, from)| {
        let body = body_at(placed, from, &mut 0);
        let goes_on = body.state.present && !placed.obstacle.motion.jumps([from, time]);
        goes_on.then(|| place - center(body))
    });
    Way {
        shape: placed.obstacle.shape,
        from: from.unwrap_or(to),
        to,
    }
}
