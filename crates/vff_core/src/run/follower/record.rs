//! One run with everything recorded.

use nalgebra::Vector2;

use crate::error::Result;
use crate::run::follower::episode::{Follower, FollowerOutcome, Sample, SampleObserver};
use crate::run::follower::scene::FollowerScene;

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

/// Runs a follower through a scene and keeps every sample.
///
/// # Errors
/// As [`Follower::run`].
pub fn record(
    follower: &Follower,
    scene: &FollowerScene,
    seed: u64,
    interrupted: &(dyn Fn() -> bool + Sync),
) -> Result<(FollowerOutcome, FollowerRecord)> {
    let obstacles = scene.obstacles.iter();
    let firsts = obstacles.map(|obstacle| obstacle.at(0.0, &mut 0).center);
    let mut recorder = Writer {
        recording: FollowerRecord::default(),
        first: firsts.collect(),
        body_radius: follower.settings().drive.body_radius,
    };
    let outcome = follower.run(scene, seed, &mut recorder, interrupted)?;
    Ok((outcome, recorder.recording))
}
