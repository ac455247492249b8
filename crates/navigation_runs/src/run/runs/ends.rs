//! How runs end that do not arrive: at rest, caught, at a contact, or with numbers that are none.

use super::{BOUND_MARGIN, LaneState};
use crate::run::scene::World;
use navigation_world::world::geometry::Body;
use numeric::error::{Failure, Result};
use numeric::lanes::{Mask, Real, Truth, Vector2};

/// A robot slower than this is at rest, in m/s.
const REST_SPEED: f64 = 1e-3;

impl<W: World, R: Real> LaneState<W, R> {
    /// Ends the runs of lanes that have been at rest for too long.
    #[inline(always)]
    pub fn rest(&mut self, time: R) {
        let still = self.speed.lt(R::splat(REST_SPEED));
        self.moved = R::select(still, self.moved, time);
        let rest_time = self.scenario.common().rules.rest_time;
        let long = R::splat(rest_time).le(time - self.moved);
        let ended = self.running & long;
        if ended.any() {
            self.stopped = self.stopped | ended;
            self.end(ended, time);
        }
    }

    /// Ends the runs of lanes that stand in a critical region for good: obstacle and robot at
    /// rest, and nothing else that moves.
    #[inline(always)]
    pub fn end_hopeless(&mut self, bodies: &[Body<R>], time: R) {
        let still = self.running & self.speed.lt(R::splat(REST_SPEED));
        let still = still & time.ge(self.all_stand_from);
        if still.any() {
            self.end_caught(bodies, time, still);
        }
    }

    #[cold]
    #[inline(never)]
    fn end_caught(&mut self, bodies: &[Body<R>], time: R, still: R::Mask) {
        // Braked within one control period, it goes no farther than that.
        let way = self.speed * R::splat(self.clock.interval) + R::splat(BOUND_MARGIN);
        let mut caught = R::Mask::none();
        for body in bodies {
            let distance = body.offset(self.position).distance_squared.sqrt();
            caught = caught | (distance + way).lt(body.regions.critical_radius);
        }
        let ended = still & caught;
        if ended.any() {
            self.stopped = self.stopped | ended;
            self.end(ended, time);
        }
    }

    /// Ends the runs of lanes that have touched an obstacle.
    #[inline(always)]
    pub fn stop_at_contact(&mut self, time: R) {
        if self.touched {
            self.touched = false;
            self.stop_touched(time);
        }
    }

    #[cold]
    #[inline(never)]
    fn stop_touched(&mut self, time: R) {
        let mut touched = R::Mask::none();
        for (slot, touch) in self.touches.iter().enumerate() {
            if touch.first.is_some() {
                touched.set(slot % R::WIDTH);
            }
        }
        if let Some(walls) = &self.walls {
            touched = touched | walls.contact_time.le(time);
        }
        let ended = self.running & touched;
        if ended.any() {
            self.end(ended, time);
        }
    }

    /// Ends the runs of some lanes.
    pub fn end(&mut self, lanes: R::Mask, time: R) {
        self.end_time = R::select(lanes, time, self.end_time);
        self.running = self.running & !lanes;
    }

    /// When the run of the first lane ended, in s.
    pub fn first_end(&self) -> f64 {
        self.end_time.lane(0)
    }

    #[inline(always)]
    pub fn check_finite(&self, time: R) -> Result<()> {
        // Nothing times a finite number is nothing, and no number times any other.
        let nothing = (self.position + self.velocity * R::zero()) * R::zero();
        self.check((nothing.x + nothing.y).le(R::zero()), time)
    }

    /// A force whose magnitude overflows has no direction left.
    #[inline(always)]
    pub fn check_force(&self, force: Vector2<R>, time: R) -> Result<()> {
        let sound = force.dot(&force).lt(R::splat(f64::INFINITY));
        self.check(sound, time)
    }

    #[inline(always)]
    fn check(&self, sound: R::Mask, time: R) -> Result<()> {
        let lost = self.running & !sound;
        if lost.any() {
            let run = (0..R::WIDTH).find(|lane| lost.lane(*lane)).unwrap_or(0);
            let time = time.lane(run);
            return Err(Failure::non_finite(run, time));
        }
        Ok(())
    }
}
