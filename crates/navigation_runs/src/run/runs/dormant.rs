//! Obstacles that are too far away to be felt or touched for a while: they are not looked at before they may be, and
//! their least distances are found afterwards from the path of the robot. A law that feels obstacles from anywhere is
//! told of all of them.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::{BOUND_MARGIN, LaneState};
use crate::run::lanes::scenes::{LaneObstacles, LaneScenes};
use crate::run::options::Clock;
use crate::run::scene::{bodies_at, body_at};
use navigation_world::world::geometry::Body;
use navigation_world::world::scenario::{PlacedObstacle, Scenario};
use numeric::lanes::{Planar, Real, Truth, Vector2};

/// Fewest obstacles for which it pays to tell the far ones from the near ones.
const FEWEST_OBSTACLES: usize = 16;

/// Fewest control periods for which it pays to leave an obstacle alone.
const FEWEST_PERIODS: usize = 8;

/// Most positions of the robot that are kept.
const LONGEST_PATH: usize = 1 << 14;

/// Most motion steps that are looked at one by one.
const FEW_STEPS: usize = 4;

/// Mark of an obstacle that is looked at.
const AWAKE: usize = usize::MAX;

/// Room for rounding: as a share of a way, and of the largest numbers that distances are made of.
const SHARE: f64 = 1e-9;
const ROUNDING: f64 = 1e-12;

/// The dormant obstacles of one run.
pub(crate) struct Dormant<'a, R: Real> {
    scenario: &'a Scenario,
    clock: Clock,
    bounds: Vec<Bound>,
    /// First motion step whose distance to each obstacle is not counted yet, at least the second.
    since: Vec<usize>,
    /// Steps at which dormant obstacles are looked at, with their indices; none for those that sleep to the end.
    alarms: BinaryHeap<Reverse<(usize, usize)>>,
    path: Path,
    /// All obstacles, for a law that feels some of them from anywhere.
    everything: Option<LaneObstacles<R>>,
}

/// Places of the robot after motion steps.
struct Path {
    /// Step of the first place.
    first: usize,
    /// Each in m, and how long the way to it was in m.
    places: Vec<(Vector2<f64>, f64)>,
}

/// Bounds of the distance to an obstacle.
struct Bound {
    /// Distance in m beyond which it is neither felt nor touched, with room for rounding.
    felt: f64,
    /// Room for rounding in a distance, in m.
    margin: f64,
    /// Most by which the distance changes in a motion step, in m; of that what the obstacle itself moves.
    stride: f64,
    own: f64,
}

impl Bound {
    fn of(placed: &PlacedObstacle, felt: f64, scenario: &Scenario, clock: &Clock) -> Self {
        let [x, y] = scenario.start;
        let (own, time) = (scenario.robot.max_speed, scenario.rules.time_limit);
        // No number that is added up is larger than this.
        let robot = x.abs() + y.abs() + own * time;
        let largest = robot + placed.size() + placed.fastest() * time;
        let margin = BOUND_MARGIN + largest * ROUNDING;
        let stride = |speed: f64| speed * clock.step * (1.0 + SHARE) + robot * (2.0 * f64::EPSILON);
        Self {
            felt: felt.max(placed.contact_distance) + margin,
            margin,
            stride: stride(own + placed.fastest()),
            own: stride(placed.fastest()),
        }
    }
}

impl<'a, R: Real> Dormant<'a, R> {
    /// Whether a scenario has so many obstacles that it pays.
    pub fn pays(scenario: &Scenario) -> bool {
        scenario.obstacle_count() >= FEWEST_OBSTACLES
    }

    /// A robot that has not seen the obstacles yet looks at them, for a law that feels each within a distance in m;
    /// those that are far away leave the scene.
    pub fn begin(
        scenario: &'a Scenario,
        runs: &mut LaneState<LaneScenes<'a>, R>,
        scene: &mut LaneObstacles<R>,
        felt_within: impl Fn(&PlacedObstacle) -> f64,
    ) -> Self {
        let clock = runs.clock;
        let obstacles = &scenario.obstacles;
        let mut felt: Vec<f64> = obstacles.iter().map(felt_within).collect();
        let told_all = felt.contains(&f64::INFINITY);
        if told_all {
            felt.fill(0.0);
        }
        let bounds = obstacles.iter().zip(felt);
        let mut dormant = Self {
            scenario,
            clock,
            bounds: bounds
                .map(|(placed, felt)| Bound::of(placed, felt, scenario, &clock))
                .collect(),
            since: vec![AWAKE; obstacles.len()],
            alarms: BinaryHeap::new(),
            path: Path {
                first: 0,
                places: vec![(scenario.start.into(), 0.0)],
            },
            everything: told_all.then(|| scene.clone()),
        };
        scene.clear();
        for (index, body) in bodies_at(scenario, 0.0).iter().enumerate() {
            let distance = runs.min_distance_squared[index].lane(0).sqrt();
            if dormant.sleeps(index, 0, distance) {
                dormant.since[index] = 1;
            } else {
                scene.insert(scene.told.len(), (index, &obstacles[index]), body);
            }
        }
        runs.watched.truncate(scene.told.len());
        runs.awake = Some(scene.told.clone());
        dormant
    }

    /// All obstacles at the sample of a step, where the law is told of more than is looked at.
    pub fn everything(&mut self, time: R, scenes: &LaneScenes<'_>) -> Option<&[Body<R>]> {
        let scene = self.everything.as_mut()?;
        scene.place(time, scenes, |_| true);
        Some(&scene.bodies)
    }

    /// At the sample of a step, for which the scene has begun: wakes obstacles that may be felt soon, and leaves
    /// those alone that are far away.
    pub fn sample(
        &mut self,
        scene: &mut LaneObstacles<R>,
        runs: &mut LaneState<LaneScenes<'a>, R>,
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
            let squared = scene.bodies[slot]
                .offset(runs.position)
                .distance_squared
                .lane(0);
            let bound = &self.bounds[index];
            let periods = (FEWEST_PERIODS + 1) * self.clock.steps_per_sample;
            let alone = bound.felt + periods as f64 * bound.stride;
            if squared > alone * alone && self.sleeps(index, step, squared.sqrt()) {
                self.since[index] = step + 1;
                scene.remove(slot);
                runs.fall_asleep(slot);
            } else {
                slot += 1;
            }
        }
    }

    /// Looks at a dormant obstacle at the sample of a step.
    fn look(
        &mut self,
        index: usize,
        scene: &mut LaneObstacles<R>,
        runs: &mut LaneState<LaneScenes<'a>, R>,
        step: usize,
    ) {
        let time = self.clock.time(step);
        let body = body_at(&self.scenario.obstacles[index], time, &mut 0);
        let squared = body.offset(runs.position.lane(0).into()).distance_squared;
        if self.sleeps(index, step, squared.sqrt()) {
            return;
        }
        self.count(index, runs);
        self.since[index] = AWAKE;
        let slot = scene.told.partition_point(|other| *other < index);
        scene.insert(slot, (index, &self.scenario.obstacles[index]), &body);
        runs.wake(slot, index);
    }

    /// Whether an obstacle at a distance in m is left alone from a step on; sets its alarm.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates
    fn sleeps(&mut self, index: usize, step: usize, distance: f64) -> bool {
        let (period, end) = (self.clock.steps_per_sample, self.clock.steps);
        let bound = &self.bounds[index];
        // All steps until then are within the bound, and so is the sample then.
        let until = step.saturating_add(((distance - bound.felt) / bound.stride) as usize);
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
    pub fn pass(&mut self, runs: &mut LaneState<LaneScenes<'a>, R>) {
        if !runs.running.any() {
            return;
        }
        self.path.push(Vector2::from(runs.position.lane(0)));
        if self.path.places.len() >= LONGEST_PATH {
            self.count_all(runs);
            self.path.first = self.path.last();
            self.path.places = self.path.places.split_off(LONGEST_PATH - 1);
        }
    }

    /// Counts all steps so far.
    #[inline(never)]
    pub fn count_all(&mut self, runs: &mut LaneState<LaneScenes<'a>, R>) {
        let last = self.path.last();
        for index in 0..self.since.len() {
            if self.since[index] <= last {
                self.count(index, runs);
                self.since[index] = last + 1;
            }
        }
    }

    /// Counts the steps so far in which an obstacle was dormant: the least of the distances that a look at each of
    /// them would have found.
    fn count(&mut self, index: usize, runs: &mut LaneState<LaneScenes<'a>, R>) {
        let (first, last) = (self.since[index] - 1, self.path.last());
        if first >= last {
            return;
        }
        let least = runs.min_distance_squared[index].lane(0);
        let mut passage = Passage {
            path: &self.path,
            placed: &self.scenario.obstacles[index],
            clock: &self.clock,
            bound: &self.bounds[index],
            cursor: 0,
            nearest: least.sqrt(),
            least,
        };
        // What comes nearer is nearest at last.
        let ends = [last, first].map(|step| (step, passage.distance(step)));
        passage.between(ends[1], ends[0]);
        runs.min_distance_squared[index] = R::splat(passage.least);
    }
}

impl Path {
    fn push(&mut self, place: Vector2<f64>) {
        if let Some((last, way)) = self.places.last() {
            let way = way + (place - last).norm();
            self.places.push((place, way));
        }
    }

    /// Step of the last place.
    fn last(&self) -> usize {
        self.first + self.places.len() - 1
    }
}

/// A part of the path past an obstacle, of which the least distance is wanted.
struct Passage<'a> {
    path: &'a Path,
    placed: &'a PlacedObstacle,
    clock: &'a Clock,
    bound: &'a Bound,
    cursor: usize,
    /// Least distance so far in m, and its square.
    nearest: f64,
    least: f64,
}

impl Passage<'_> {
    /// Distance after a motion step in m.
    fn distance(&mut self, step: usize) -> f64 {
        let body = body_at(self.placed, self.clock.time(step), &mut self.cursor);
        let (place, _) = self.path.places[step - self.path.first];
        let squared = body.offset(place).distance_squared;
        let distance = squared.sqrt();
        if squared < self.least {
            (self.least, self.nearest) = (squared, distance);
        }
        distance
    }

    /// Looks at all steps between two, of known distances in m, of which any may be nearer than the nearest one.
    fn between(&mut self, (first, from): (usize, f64), (last, to): (usize, f64)) {
        let steps = last - first;
        let [begin, end] = [first, last].map(|step| self.path.places[step - self.path.first].1);
        let change = (end - begin) * (1.0 + SHARE) + steps as f64 * self.bound.own;
        let low = 0.5 * (from + to - change);
        if steps <= 1 || low > self.nearest + self.bound.margin {
            return;
        }
        if steps <= FEW_STEPS {
            for step in first + 1..last {
                self.distance(step);
            }
            return;
        }
        let middle = first + steps / 2;
        let middle = (middle, self.distance(middle));
        self.between((first, from), middle);
        self.between(middle, (last, to));
    }
}
