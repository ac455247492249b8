//! One run with everything recorded, period by period.

use std::sync::Arc;

use nalgebra::Vector2;

use crate::run::Interrupted;
use crate::run::episode::{Episode, Parts};
use crate::run::follower::episode::{Follower, FollowerOutcome, FollowerParts};
use crate::run::follower::sample::{Sample, SampleObserver};
use crate::run::follower::scene::FollowerScene;
use navigation_laws::impedance::following::FollowingLaw;
use navigation_laws::reflex::Percept;
use numeric::error::{Failure, Result};

/// Samples of a run: one row each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FollowerRecord {
    /// In s.
    pub time: Vec<f64>,
    /// In m.
    pub position: Vec<Vector2<f64>>,
    /// In rad, counterclockwise from x, from -pi to pi.
    pub heading: Vec<f64>,
    /// In m/s.
    pub virtual_velocity: Vec<Vector2<f64>>,
    /// (left, right), in m/s.
    pub wheel_speed: Vec<[f64; 2]>,
    /// In m.
    pub target: Vec<Vector2<f64>>,
    /// In m.
    pub source: Vec<Vector2<f64>>,
    /// In N.
    pub attraction: Vec<Vector2<f64>>,
    /// In N.
    pub repulsion: Vec<Vector2<f64>>,
    /// Sensors of a sample side by side, in m; infinite without echo.
    pub readings: Vec<f64>,
    /// Shifts of the obstacles from their first places, side by side, in m.
    pub shifts: Vec<Vector2<f64>>,
    /// Distances between body and obstacles, side by side, in m.
    pub clearance: Vec<f64>,
}

/// Writes a recording.
struct Writer {
    recording: FollowerRecord,
    /// First places of the obstacles, in m.
    first: Vec<Vector2<f64>>,
    body_radius: f64,
}

impl SampleObserver for Writer {
    fn sample(&mut self, sample: &Sample<'_>) {
        let rows = &mut self.recording;
        rows.time.push(sample.time);
        rows.position.push(sample.pose.position);
        rows.heading.push(sample.pose.angle());
        rows.virtual_velocity.push(sample.virtual_velocity);
        rows.wheel_speed.push(sample.wheels);
        rows.target.push(sample.target);
        rows.source.push(sample.source);
        rows.attraction.push(sample.attraction);
        rows.repulsion.push(sample.repulsion);
        rows.readings.extend_from_slice(sample.readings);
        for (first, shape) in self.first.iter().zip(sample.shapes) {
            rows.shifts.push(shape.center - first);
            let distance = shape.distance(sample.pose.position);
            rows.clearance.push(distance - self.body_radius);
        }
    }
}

/// A run of the follower that is stepped from outside and keeps every sample.
pub struct FollowerSteps(Episode<FollowerParts<Arc<FollowingLaw>, Arc<FollowerScene>, Writer>>);

impl FollowerSteps {
    /// A run at its start.
    ///
    /// # Errors
    /// The duration is out of range.
    pub fn new(follower: &Follower, scene: FollowerScene, seed: u64) -> Result<Self> {
        let obstacles = scene.obstacles.iter();
        let firsts = obstacles.map(|obstacle| obstacle.at(0.0, &mut 0).center);
        let writer = Writer {
            recording: FollowerRecord::default(),
            first: firsts.collect(),
            body_radius: follower.settings().drive.body_radius,
        };
        let law = Arc::clone(follower.law());
        let episode = follower.episode(law, Arc::new(scene), seed, writer)?;
        Ok(Self(episode))
    }

    /// One control period under the law, or under a force in N on the virtual mass. The end has a
    /// sample, too, with what the law would do next.
    ///
    /// # Errors
    /// The force or the state is not finite, or the caller asked to stop.
    pub fn period(
        &mut self,
        force: Option<Vector2<f64>>,
        interrupted: Interrupted<'_>,
    ) -> Result<()> {
        if self.0.finished() {
            return Ok(());
        }
        if force.is_some_and(|force| !force.iter().all(|part| part.is_finite())) {
            let (run, time) = (0, self.time());
            return Err(Failure::non_finite(run, time));
        }
        self.0.period(force, interrupted)?;
        if self.0.finished() {
            self.last_sample(interrupted)?;
        }
        Ok(())
    }

    /// The next command of the law stands in the last sample.
    fn last_sample(&mut self, interrupted: Interrupted<'_>) -> Result<()> {
        let time = self.0.stepped();
        self.0.parts.decide(time, None, interrupted).map(|_| ())
    }

    /// Runs to the end under the law.
    ///
    /// # Errors
    /// Errors of [`Self::period`].
    pub fn run(&mut self, interrupted: Interrupted<'_>) -> Result<()> {
        if self.0.finished() {
            return Ok(());
        }
        self.0.finish(interrupted)?;
        self.last_sample(interrupted)
    }

    /// Whether the run has ended.
    #[must_use]
    pub fn finished(&self) -> bool {
        self.0.finished()
    }

    /// Time of the control periods so far, in s.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.0.stepped()
    }

    /// Readings that the law decides by.
    #[must_use]
    pub fn percept(&self) -> Percept<'_> {
        self.0.parts.percept()
    }

    /// The run so far.
    #[must_use]
    pub fn recorded(&self) -> (FollowerOutcome, &FollowerRecord) {
        (self.0.parts.outcome(), &self.0.parts.observer.recording)
    }
}
