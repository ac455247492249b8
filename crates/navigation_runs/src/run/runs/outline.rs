//! Distances and contacts of a robot with an outline, also between two motion steps.
//!
//! Within a motion step its place and its heading change evenly. No step is passed over: the gap between two bodies
//! changes by no more than they move, so that it is looked at again before it can be closed.

use std::sync::Arc;

use super::LaneState;
use super::touch::ContactState;
use crate::run::outcome::{CONTACT_SPEED, Contact, DECIDED_OVERLAP};
use crate::run::scene::{World, body_at};
use navigation_world::world::footprint::{
    BodyMotion, Footprint, Separation, TOUCH, first_closed, turned,
};
use navigation_world::world::frame::Frame;
use navigation_world::world::geometry::Body;
use navigation_world::world::scenario::PlacedObstacle;
use navigation_world::world::shape::PlacedShape;
use numeric::lanes::{Real, Vector2};

/// Looks at a contact within a motion step.
const LOOKS: u32 = 4;

/// The outline of a robot, and its heading.
#[derive(Clone, Debug)]
pub(super) struct OutlineState {
    footprint: Arc<Footprint>,
    radius: f64,
    /// In rad, at the start and at the end of the motion step.
    heading: [f64; 2],
}

/// A motion step of a robot with an outline, or the part of it that belongs to the run.
struct BodyStep {
    from: Vector2<f64>,
    to: Vector2<f64>,
    heading: f64,
    turn: f64,
    /// In s.
    begin: f64,
    end: f64,
}

impl BodyStep {
    fn pose(&self, share: f64) -> Frame {
        let place = self.from + (self.to - self.from) * share;
        Frame::at(place.into(), self.heading + self.turn * share)
    }

    fn time(&self, share: f64) -> f64 {
        self.begin + (self.end - self.begin) * share
    }

    /// Motion in coordinates of the body at a share of the step.
    fn motion(&self, share: f64) -> BodyMotion {
        let duration = self.end - self.begin;
        if duration <= 0.0 {
            return BodyMotion::REST;
        }
        BodyMotion {
            velocity: self.pose(share).inward(self.to - self.from) / duration,
            turn_rate: self.turn / duration,
        }
    }
}

impl OutlineState {
    /// Of a robot with an outline and the radius of the circle around it in m, at a heading in rad.
    pub fn new(footprint: Arc<Footprint>, radius: f64, heading: f64) -> Self {
        Self {
            footprint,
            radius,
            heading: [heading; 2],
        }
    }

    /// Way in m that no point of it exceeds in a step.
    fn most(&self, step: &BodyStep) -> f64 {
        (step.to - step.from).norm() + step.turn.abs() * self.radius
    }
}

impl<W: World, R: Real> LaneState<W, R> {
    /// Tells the heading of a robot with an outline at the end of a motion step, in rad.
    pub fn face(&mut self, heading: f64) {
        if let Some(outline) = &mut self.outline {
            outline.heading = [outline.heading[1], heading];
        }
    }

    /// Least distances and contacts of a robot with an outline in a motion step that began at a place and a time in s;
    /// without them at the start.
    #[inline(never)]
    pub(super) fn watch_outline(
        &mut self,
        bodies: &[Body<R>],
        since: Option<(Vector2<f64>, f64)>,
        time: f64,
    ) {
        let Some(outline) = self.outline.take() else {
            return;
        };
        let place = Vector2::new(self.position.x.lane(0), self.position.y.lane(0));
        let (from, begin) = since.unwrap_or((place, time));
        let whole = turned(outline.heading);
        // Who arrives within a step has turned only a part of it.
        let share = if since.is_some() {
            ((time - begin) / self.clock.step).min(1.0)
        } else {
            0.0
        };
        let step = BodyStep {
            from,
            to: place,
            heading: outline.heading[usize::from(since.is_none())],
            turn: if since.is_some() { whole * share } else { 0.0 },
            begin,
            end: time,
        };
        let world = self.scenario.clone();
        for slot in 0..bodies.len() {
            let index = self.obstacle(slot);
            if let Some(placed) = world.of_lane(0).obstacles.get(index) {
                self.meet_outline(&outline, &step, (index, placed));
            }
        }
        if let Some(walls) = &mut self.walls {
            let speed = |share: f64| {
                let motion = step.motion(share);
                motion
                    .velocity
                    .norm()
                    .max(motion.turn_rate.abs() * outline.radius)
            };
            let gap = |share: f64, most: f64| {
                walls.clearance_of(&outline.footprint, &step.pose(share), most)
            };
            let most = outline.most(&step);
            let least = walls.least.lane(0).max(0.0);
            let at_end = gap(1.0, least.max(most));
            let met = first_closed(most, |share| gap(share, most + TOUCH + 1.0));
            self.touched |= walls.note(
                if met.is_some() { 0.0 } else { at_end },
                met.map(|share| (step.time(share), speed(share))),
            );
        }
        self.outline = Some(outline);
    }

    /// Least distance and contact with an obstacle.
    fn meet_outline(
        &mut self,
        outline: &OutlineState,
        step: &BodyStep,
        (index, placed): (usize, &PlacedObstacle),
    ) {
        let motion = &placed.obstacle.motion;
        let at = |time: f64| body_at(placed, time, &mut 0).state;
        let last = at(step.end);
        if !last.present {
            return;
        }
        let first = at(step.begin);
        let goes_on = first.present && !motion.jumps([step.begin, step.end]);
        let to = Vector2::from(last.position);
        let from = if goes_on { first.position.into() } else { to };
        let separation = |share: f64| {
            let center = from + (to - from) * share;
            let shape = PlacedShape {
                center,
                shape: placed.obstacle.shape,
            };
            outline.footprint.separation(&step.pose(share), &shape)
        };
        let at_end = separation(1.0);
        let most = outline.most(step) + (to - from).norm();
        let touch = self.touches[index * R::WIDTH];
        let touching = at_end.distance <= TOUCH;
        let met = if touch.decided || touch.appearing {
            None
        } else {
            first_closed(most, |share| separation(share).distance)
        };
        let passed = met.map_or(f64::INFINITY, |_| 0.0);
        let gap = at_end.distance.min(passed);
        let reach = self.reach[index].lane(0);
        let distance = (gap + reach).max(0.0);
        let least = &mut self.min_distance_squared[index];
        *least = least.replace(0, least.lane(0).min(distance * distance));
        let state = self.touched_by((step, placed), (touch, touching, met), separation);
        self.touches[index * R::WIDTH] = state;
    }

    /// State of the contacts with an obstacle after a step.
    fn touched_by(
        &mut self,
        (step, placed): (&BodyStep, &PlacedObstacle),
        (mut touch, touching, met): (ContactState, bool, Option<f64>),
        separation: impl Fn(f64) -> Separation,
    ) -> ContactState {
        if touch.appearing {
            (touch.appearing, touch.decided) = (touching, false);
            return touch;
        }
        let Some(share) = met else {
            touch.decided &= touching;
            return touch;
        };
        if touch.first.is_none() && self.appears(placed, step.end) {
            (touch.apart, touch.appearing) = (true, touching);
            return touch;
        }
        // From the first touch of the step on until they leave each other or overlap deeply.
        let mut at_fault = false;
        let mut decided = false;
        let [speed, toward] = separation(share).speeds(&step.motion(share));
        for part in 0..=LOOKS {
            let now = share + (1.0 - share) * f64::from(part) / f64::from(LOOKS);
            let found = separation(now);
            if found.distance > TOUCH {
                continue;
            }
            if found.distance < -DECIDED_OVERLAP {
                decided = true;
                break;
            }
            let [fast, nearer] = found.speeds(&step.motion(now));
            at_fault |= fast > CONTACT_SPEED && nearer > 0.0;
        }
        if let Some(contact) = &mut touch.first {
            contact.at_fault |= at_fault;
        } else {
            touch.first = Some(Contact {
                time: step.time(share),
                speed,
                toward: speed > CONTACT_SPEED && toward > 0.0,
                at_fault,
            });
            self.touched = true;
        }
        touch.decided = decided;
        touch
    }
}
