//! Obstacles that are too far away to be felt or touched for a while: they are not looked at before
//! they may be, and their least distances are found afterwards from the path of the robot. A law that
//! feels obstacles from anywhere is told of those that it asks for; else they are left alone as well.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::Runs;
use super::at_ends::AtEnds;
use super::bounds::{Bounds, FEWEST_PERIODS, FirstLook, without_alarm};
use super::path::{Passage, Path};
use super::relevant::Relevant;
use crate::lanes::{Planar, Real, Truth};
use crate::run::options::Clock;
use crate::run::scene::{Scene, body_at};
use crate::world::scenario::{PlacedObstacle, Scenario};

/// Fewest dormant obstacles for which it pays to look at the mean velocities of the robot.
const FEWEST_FOR_MEANS: usize = 32;

/// Most positions of the robot that are kept.
const LONGEST_PATH: usize = 1 << 14;

/// Mark of an obstacle that is looked at.
const AWAKE: usize = usize::MAX;

/// The dormant obstacles of one run.
#[derive(Clone, Debug)]
pub(crate) struct Dormant {
    clock: Clock,
    bounds: Bounds,
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
    /// Whether a scenario has so many obstacles that it pays.
    pub fn pays(scenario: &Scenario) -> bool {
        !scenario.obstacles.groups().is_empty()
    }

    /// Robots that have not seen the obstacles yet look at them, for a law that feels each within a distance in m;
    /// the scene at the start, without those that are far away.
    pub fn begin<'a, R: Real>(
        runs: &mut Runs<&'a Scenario, R>,
        steps: usize,
        felt_within: impl Fn(&PlacedObstacle) -> f64,
    ) -> (Self, Scene<&'a Scenario>) {
        let scenario = runs.scenario;
        let count = scenario.obstacle_count();
        let finite = |felt: &f64| *felt < f64::INFINITY;
        let mut felt = Vec::with_capacity(count);
        felt.extend(
            scenario
                .obstacles
                .iter()
                .map(felt_within)
                .take_while(finite),
        );
        let told_all = felt.len() < count;
        if told_all {
            felt.clear();
        }
        let first = FirstLook::at(scenario, &runs.clock, &felt);
        let mut dormant = Self {
            clock: runs.clock,
            bounds: first.bounds,
            since: vec![1; count],
            alarms: BinaryHeap::new(),
            path: Path::from(scenario.start),
            relevant: told_all.then(|| Relevant::new(scenario)),
        };
        let distances = first.least.into_iter();
        runs.min_distance_squared = distances.map(R::splat).collect();
        let mut scene = Scene::of(scenario, Vec::new(), (steps, false));
        for index in first.near {
            let body = body_at(&scenario.obstacles[index], 0.0, &mut 0);
            runs.watch(index, &body, 0.0, runs.running, None);
            let distance = runs.min_distance_squared[index].lane(0).sqrt();
            if !dormant.sleeps(index, 0, distance) {
                dormant.since[index] = AWAKE;
                scene.insert(scene.told.len(), index, &body);
            }
        }
        runs.watched.truncate(scene.told.len());
        runs.awake = Some(scene.told.clone());
        (dormant, scene)
    }

    /// What the law is told of, where that is not what is looked at.
    pub fn relevant(&mut self) -> Option<&mut Relevant> {
        self.relevant.as_mut()
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
            let far = squared > self.bounds.alone(index);
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
        let until = step.saturating_add(self.bounds.steps(index, distance));
        // Most need no alarm.
        if until >= without_alarm(&self.clock, step) {
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
            AtEnds {
                path: &self.path,
                clock: &self.clock,
                means: &self.path.means(),
                groups: runs.scenario.obstacles.groups(),
                bounds: &self.bounds,
                since: &mut self.since,
                least: &mut runs.min_distance_squared,
            }
            .find();
        }
        for index in 0..self.since.len() {
            let since = self.since[index];
            if since != AWAKE && since <= self.path.last() {
                self.count(index, runs);
                self.since[index] = self.path.last() + 1;
            }
        }
    }

    /// Counts the steps so far in which an obstacle was dormant: the least of the distances that a look
    /// at each of them would have found. The path has been measured.
    fn count<R: Real>(&mut self, index: usize, runs: &mut Runs<&Scenario, R>) {
        let (first, last) = (self.since[index] - 1, self.path.last());
        if first >= last {
            return;
        }
        let [stride, margin] = self.bounds.stride_and_margin(index);
        let least = runs.min_distance_squared[index].lane(0);
        let mut passage = Passage {
            path: &self.path,
            placed: &runs.scenario.obstacles[index],
            clock: &self.clock,
            stride,
            margin,
            nearest: least.sqrt(),
            least,
        };
        passage.look(first, last);
        runs.min_distance_squared[index] = R::splat(passage.least);
    }
}
