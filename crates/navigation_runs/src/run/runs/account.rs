//! Account of a motion step: arrival, contacts, least distances, energy, path.

use super::touch::Since;
use super::{BOUND_MARGIN, LaneState};
use crate::run::options::Clock;
use crate::run::scene::{World, body_at};
use navigation_world::world::geometry::Body;
use numeric::lanes::{Mask, Planar, Real, Truth, Vector2};

impl<W: World, R: Real> LaneState<W, R> {
    /// Counts a sample of the force.
    #[inline(always)]
    pub fn count_sample(&mut self) {
        let one = R::splat(1.0);
        self.force_evaluations += R::select(self.running, one, R::zero());
    }

    /// Accounts for a motion step from `before`, after which the obstacles are as given. `record`:
    /// the currents are looked at afterwards.
    #[inline(always)]
    pub fn account(&mut self, bodies: &[Body<R>], before: Vector2<R>, time: R, record: bool) {
        let speeds = self.wheels.speeds(self.velocity);
        let currents = self.wheels.currents(&self.wheel_speeds, &speeds);
        self.wheel_speeds = speeds;
        if record {
            self.currents = currents;
        }
        let [first, second, third] = currents;
        let squared = first * first + second * second + third * third;
        let way = self.speed * R::splat(self.clock.step);
        let since = Since {
            place: before,
            time: time - R::splat(self.clock.step),
        };
        if self.near_goal {
            let to_goal = self.goal - self.position;
            let tolerance = self.scenario.common().rules.arrival_tolerance;
            let near = to_goal.dot(&to_goal).le(R::splat(tolerance * tolerance));
            let arrived = self.running & near;
            if arrived.any() {
                self.arrive(&since, time, arrived, squared, way);
            }
        }
        self.squared_current += R::select(self.running, squared, R::zero());
        self.path += R::select(self.running, way, R::zero());
        // Nothing asks for one lane where robots are side by side, or the compiler would take their numbers
        // apart in every step.
        if R::WIDTH == 1 && self.outline.is_some() {
            let since = (before.lane(0).into(), since.time.lane(0));
            let end = self.end_time.lane(0);
            let end = if end.is_nan() { time.lane(0) } else { end };
            self.watch_outline(bodies, Some(since), end);
            return;
        }
        for (slot, body) in bodies.iter().enumerate() {
            if self.watched[slot] {
                self.watch(self.obstacle(slot), body, time, self.running, Some(&since));
            }
        }
        if self.walls.is_some() {
            self.watch_walls(Some(&since), time, self.running);
        }
    }

    /// Least distance and contact of some lanes with the maps.
    #[inline(never)]
    pub(super) fn watch_walls(&mut self, since: Option<&Since<R>>, time: R, lanes: R::Mask) {
        if let Some(walls) = &mut self.walls {
            let since = since.map(|since| (since.place, since.time));
            self.touched |= walls.watch((self.position, time), since, self.speed, lanes);
        }
    }

    /// Least distance and contact of some lanes with an obstacle; `since`: the start of the motion step.
    #[inline(always)]
    pub(super) fn watch(
        &mut self,
        index: usize,
        body: &Body<R>,
        time: R,
        lanes: R::Mask,
        since: Option<&Since<R>>,
    ) {
        let here = body.state.present;
        if !here.any() {
            return;
        }
        let lanes = lanes & here;
        let offset = body.offset(self.position);
        let squared = offset.distance_squared;
        let least = &mut self.min_distance_squared[index];
        *least = R::select(lanes, squared, R::splat(f64::INFINITY)).min(*least);
        let near = lanes & squared.le(self.alert[index]);
        if near.any() {
            self.meet(index, (body, time), near, since);
        }
    }

    /// Finds out what cannot happen before the next sample, so that it need not be looked for:
    /// nothing moves farther than its largest speed takes it.
    #[inline(always)]
    pub fn look_ahead(&mut self, bodies: &[Body<R>]) {
        let Clock {
            interval,
            steps_per_sample,
            ..
        } = self.clock;
        if steps_per_sample == 1 {
            return;
        }
        let common = self.scenario.common();
        let own = common.robot.max_speed;
        let to_goal = self.goal - self.position;
        let reach = common.rules.arrival_tolerance + own * interval + BOUND_MARGIN;
        let near = to_goal.dot(&to_goal).lt(R::splat(reach * reach));
        self.near_goal = (near & self.running).any();
        for (slot, body) in bodies.iter().enumerate() {
            let index = self.obstacle(slot);
            let speed = self.speed_bound[index];
            let way = (R::splat(own) + speed) * R::splat(interval) + R::splat(BOUND_MARGIN);
            // Within a contact the robot may turn toward the obstacle, however near they have been.
            let reach = self.reach[index];
            let least = self.min_distance_squared[index].sqrt().max(reach) + way;
            let squared = body.offset(self.position).distance_squared;
            let near = squared.lt(least * least) | !body.state.present;
            self.watched[slot] = (near & self.running).any();
        }
    }

    /// Ends the runs of lanes that entered the circle around the goal in this step, at the
    /// instant of entry, linear inside the step.
    #[cold]
    #[inline(never)]
    fn arrive(&mut self, since: &Since<R>, time: R, arrived: R::Mask, squared: R, way: R) {
        let tolerance = self.scenario.common().rules.arrival_tolerance;
        let (before, after) = (since.place, self.position);
        let length = |vector: Vector2<R>| vector.dot(&vector).sqrt();
        let (from, to) = (length(self.goal - before), length(self.goal - after));
        let share = (from - R::splat(tolerance)) / (from - to);
        let entry = before + (after - before) * share;
        self.position = Vector2::select(arrived, entry, after);
        self.squared_current += R::select(arrived, squared * share, R::zero());
        self.path += R::select(arrived, way * share, R::zero());
        for lane in (0..R::WIDTH).filter(|lane| arrived.lane(*lane)) {
            let step = self.clock.step;
            let instant = (time.lane(lane) - step) + share.lane(lane) * step;
            self.arrival_time = self.arrival_time.replace(lane, instant);
            self.end_time = self.end_time.replace(lane, instant);
            if self.outline.is_some() {
                continue;
            }
            // Only this lane is watched at its own instant.
            let others = (0..R::WIDTH).filter(|other| *other != lane);
            let only = others.fold(R::Mask::splat(true), Mask::without);
            let world = self.scenario.clone();
            for (index, placed) in world.of_lane(lane).obstacles.iter().enumerate() {
                let body = body_at(placed, instant, &mut 0).widened();
                self.watch(index, &body, R::splat(instant), only, Some(since));
            }
            self.watch_walls(Some(since), R::splat(instant), only);
        }
        self.running = self.running & !arrived;
    }

    /// Whether any robot that runs is in the active region of an obstacle.
    #[inline(always)]
    pub fn feels_any(&self, bodies: &[Body<R>]) -> bool {
        bodies.iter().any(|body| {
            let reach = body.regions.active_radius;
            let squared = body.offset(self.position).distance_squared;
            (body.state.present & squared.lt(reach * reach) & self.running).any()
        })
    }
}
