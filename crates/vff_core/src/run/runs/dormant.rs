//! Obstacles that are too far away to be felt or touched for a while: they are not looked at before
//! they may be, and their least distances are found afterwards from the path of the robot. A law that
//! feels obstacles from anywhere is told of those that it asks for; else they are left alone as well.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::at_ends::AtEnds;
use super::path::{Passage, Path};
use super::relevant::Relevant;
use super::{BOUND_MARGIN, Runs};
use crate::lanes::{Mask, Planar, Real};
use crate::run::options::Clock;
use crate::run::scene::{Scene, body_at};
use crate::world::scenario::{PlacedObstacle, Scenario};

/// Fewest obstacles for which it pays to tell the far ones from the near ones.
const FEWEST: usize = 16;

/// Fewest control periods for which it pays to leave an obstacle alone.
const FEWEST_PERIODS: usize = 8;

/// Fewest dormant obstacles for which it pays to look at the mean velocities of the robot.
const FEWEST_FOR_MEANS: usize = 32;

/// Most positions of the robot that are kept.
const LONGEST_PATH: usize = 1 << 14;

/// Room for rounding: as a share of a way, and of the largest numbers that distances are made of.
const SHARE: f64 = 1e-9;
const ROUNDING: f64 = 1e-12;

/// Mark of an obstacle that is looked at.
const AWAKE: usize = usize::MAX;

/// What bounds the distance to an obstacle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bound {
    /// Distance in m beyond which it is neither felt nor touched, and room for rounding in it.
    felt: f64,
    pub(super) margin: f64,
    /// Most by which the distance changes in a motion step, in m.
    stride: f64,
    /// Square of the distance beyond which it may be left alone, in m^2.
    alone: f64,
}

/// The dormant obstacles of one run.
#[derive(Clone, Debug)]
pub(crate) struct Dormant {
    clock: Clock,
    bounds: Vec<Bound>,
    /// First motion step whose distance to each obstacle is not counted yet, at least the second.
    since: Vec<usize>,
    /// Steps at which dormant obstacles are looked at, with their indices; none for those that sleep to
    /// the end.
    alarms: BinaryHeap<Reverse<(usize, usize)>>,
    path: Path,
    /// What a law is told of that feels some obstacles from anywhere.
    relevant: Option<Relevant>,
}

impl Dormant {
    /// For a law that feels each obstacle within a distance in m; `None` where there are few obstacles.
    pub fn new(
        scenario: &Scenario,
        clock: Clock,
        felt_within: impl Fn(&PlacedObstacle) -> f64,
    ) -> Option<Self> {
        let obstacles = &scenario.obstacles;
        if obstacles.len() < FEWEST {
            return None;
        }
        let felt: Vec<f64> = obstacles.iter().map(felt_within).collect();
        let told_all = felt.contains(&f64::INFINITY);
        let felt = felt.iter().map(|felt| if told_all { 0.0 } else { *felt });
        let bound = |(placed, felt)| Bound::of(placed, scenario, &clock, felt);
        Some(Self {
            clock,
            bounds: obstacles.iter().zip(felt).map(bound).collect(),
            since: vec![AWAKE; obstacles.len()],
            alarms: BinaryHeap::new(),
            path: Path::from(scenario.start),
            relevant: told_all.then(|| Relevant::new(scenario)),
        })
    }

    /// What the law is told of, where that is not what is looked at.
    pub fn relevant(&mut self) -> Option<&mut Relevant> {
        self.relevant.as_mut()
    }

    /// The scene at the start, without the obstacles that are far away.
    pub fn scene<'a, R: Real>(
        &mut self,
        runs: &mut Runs<&'a Scenario, R>,
        steps: usize,
    ) -> Scene<&'a Scenario> {
        let scenario = runs.scenario;
        let mut scene = Scene::of(scenario, Vec::new(), (steps, false));
        for (index, placed) in scenario.obstacles.iter().enumerate() {
            let distance = runs.min_distance_squared[index].lane(0).sqrt();
            if self.sleeps(index, 0, distance) {
                self.since[index] = 1;
            } else {
                scene.insert(scene.told.len(), index, &body_at(placed, 0.0, &mut 0));
            }
        }
        runs.watched.truncate(scene.told.len());
        runs.awake = Some(scene.told.clone());
        scene
    }

    /// At the sample of a step, for which the scene has begun: wakes obstacles that may be felt soon, and
    /// leaves those alone that are far away.
    pub fn sample<R: Real>(
        &mut self,
        scene: &mut Scene<&Scenario>,
        runs: &mut Runs<&Scenario, R>,
        step: usize,
    ) {
        while let Some(Reverse((alarm, index))) = self.alarms.peek().copied() {
            if alarm > step {
                break;
            }
            self.alarms.pop();
            self.look(index, scene, runs, step);
        }
        let mut slot = 0;
        while slot < scene.told.len() {
            let index = scene.told[slot];
            let offset = scene.frames[0][slot].offset(runs.position);
            let squared = offset.distance_squared.lane(0);
            let far = squared > self.bounds[index].alone;
            if far && self.sleeps(index, step, squared.sqrt()) {
                self.since[index] = step + 1;
                scene.remove(slot);
                runs.fall_asleep(slot);
            } else {
                slot += 1;
            }
        }
    }

    /// Looks at a dormant obstacle at the sample of a step.
    fn look<R: Real>(
        &mut self,
        index: usize,
        scene: &mut Scene<&Scenario>,
        runs: &mut Runs<&Scenario, R>,
        step: usize,
    ) {
        let body = body_at(
            &runs.scenario.obstacles[index],
            self.clock.time(step),
            &mut 0,
        );
        let squared = body.offset(runs.position).distance_squared.lane(0);
        if self.sleeps(index, step, squared.sqrt()) {
            return;
        }
        self.path.measure();
        self.count(index, runs);
        self.since[index] = AWAKE;
        let slot = scene.told.partition_point(|other| *other < index);
        scene.insert(slot, index, &body);
        runs.wake(slot, index);
    }

    /// Whether an obstacle at a distance in m is left alone from a step on; sets its alarm.
    fn sleeps(&mut self, index: usize, step: usize, distance: f64) -> bool {
        let Clock {
            steps_per_sample: period,
            steps: end,
            ..
        } = self.clock;
        // All steps until then are within the bound, and so is the sample then.
        let until = step.saturating_add(self.bounds[index].steps(distance));
        // Most need no alarm.
        if until
            >= end
                .max(step + FEWEST_PERIODS * period)
                .saturating_add(period)
        {
            return true;
        }
        let alarm = until / period * period;
        if alarm < step + FEWEST_PERIODS * period {
            return false;
        }
        if alarm < end {
            self.alarms.push(Reverse((alarm, index)));
        }
        true
    }

    /// The robot has made a motion step; one that has arrived has been looked at where it did.
    #[inline]
    pub fn pass<R: Real>(&mut self, runs: &mut Runs<&Scenario, R>) {
        if !runs.running.any() {
            return;
        }
        self.path.push(runs.position.lane(0));
        if self.path.len() >= LONGEST_PATH {
            self.count_all(runs);
            self.path.forget();
        }
    }

    /// Counts all steps so far.
    #[inline(never)]
    pub fn count_all<R: Real>(&mut self, runs: &mut Runs<&Scenario, R>) {
        let asleep = self.since.iter().filter(|since| **since != AWAKE).count();
        if asleep > 0 {
            self.path.measure();
        }
        if asleep >= FEWEST_FOR_MEANS {
            self.count_at_ends(runs);
        }
        for index in 0..self.since.len() {
            let since = self.since[index];
            if since != AWAKE && since <= self.path.last() {
                self.count(index, runs);
                self.since[index] = self.path.last() + 1;
            }
        }
    }

    /// Counts all steps of those obstacles that have been left alone on all of the path and were nearest at one of
    /// its ends.
    fn count_at_ends<R: Real>(&mut self, runs: &mut Runs<&Scenario, R>) {
        let mut found = Vec::with_capacity(self.since.len());
        AtEnds {
            path: &self.path,
            clock: &self.clock,
            means: &self.path.means(),
            obstacles: &runs.scenario.obstacles,
            since: &self.since,
            bounds: &self.bounds,
            found: &mut found,
        }
        .find();
        for (index, squared) in found {
            let least = &mut runs.min_distance_squared[index];
            *least = least.min(R::splat(squared));
            self.since[index] = self.path.last() + 1;
        }
    }

    /// Counts the steps so far in which an obstacle was dormant: the least of the distances that a look
    /// at each of them would have found. The path has been measured.
    fn count<R: Real>(&mut self, index: usize, runs: &mut Runs<&Scenario, R>) {
        let (first, last) = (self.since[index] - 1, self.path.last());
        if first >= last {
            return;
        }
        let bound = &self.bounds[index];
        let least = runs.min_distance_squared[index].lane(0);
        let mut passage = Passage {
            path: &self.path,
            placed: &runs.scenario.obstacles[index],
            clock: &self.clock,
            stride: bound.stride,
            margin: bound.margin,
            nearest: least.sqrt(),
            least,
        };
        passage.look(first, last);
        runs.min_distance_squared[index] = R::splat(passage.least);
    }
}

impl Bound {
    fn of(placed: &PlacedObstacle, scenario: &Scenario, clock: &Clock, felt: f64) -> Self {
        let motion = &placed.obstacle.motion;
        let always = motion.presence() == (f64::NEG_INFINITY, f64::INFINITY);
        let speed = placed.speed_bound.filter(|_| always);
        let speed = speed.unwrap_or(f64::INFINITY);
        let own = scenario.robot.max_speed;
        let way = (own + speed) * clock.step;
        // No number that is added up is larger than this.
        let [x, y] = motion.at(0.0, &mut 0).position;
        let [start_x, start_y] = scenario.start;
        let robot = start_x.abs() + start_y.abs() + own * scenario.rules.time_limit;
        let obstacle = x.abs() + y.abs() + speed * scenario.rules.time_limit;
        let stride = way * (1.0 + SHARE) + robot * (2.0 * f64::EPSILON);
        let largest = robot + obstacle + placed.obstacle.shape.extent();
        let margin = BOUND_MARGIN + largest * ROUNDING;
        let felt = felt.max(placed.contact_distance);
        let periods = (FEWEST_PERIODS + 1) * clock.steps_per_sample;
        let alone = felt + margin + periods as f64 * stride;
        Self {
            felt,
            margin,
            stride,
            alone: alone * alone,
        }
    }

    /// Motion steps for which an obstacle at a distance in m is neither felt nor touched.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates
    fn steps(&self, distance: f64) -> usize {
        ((distance - self.felt - self.margin) / self.stride) as usize
    }
}
