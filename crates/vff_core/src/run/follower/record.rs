//! One run with everything recorded.

use crate::error::Result;
use crate::run::follower::episode::{Follower, Observer, Outcome, Sample};
use crate::run::follower::scene::Scene;

/// Samples of a run: one row each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    /// In s.
    pub time: Vec<f64>,
    /// In m.
    pub position: Vec<[f64; 2]>,
    /// In rad, counterclockwise from x, from -pi to pi.
    pub heading: Vec<f64>,
    /// In m/s.
    pub virtual_velocity: Vec<[f64; 2]>,
    /// (left, right), in m/s.
    pub wheel_speed: Vec<[f64; 2]>,
    /// In m.
    pub target: Vec<[f64; 2]>,
    /// In m.
    pub source: Vec<[f64; 2]>,
    /// In N.
    pub attraction: Vec<[f64; 2]>,
    /// In N.
    pub repulsion: Vec<[f64; 2]>,
    /// Sensors of a sample side by side, in m; infinite without echo.
    pub readings: Vec<f64>,
    /// Shifts of the obstacles from their first places, side by side, in m.
    pub shifts: Vec<[f64; 2]>,
    /// Distances between body and obstacles, side by side, in m.
    pub clearance: Vec<f64>,
}

/// Writes a recording.
struct Recorder<'a> {
    recording: Recording,
    scene: &'a Scene,
    body_radius: f64,
}

impl Observer for Recorder<'_> {
    fn sample(&mut self, sample: &Sample<'_>) {
        let rows = &mut self.recording;
        let [x, y] = sample.pose.direction;
        rows.time.push(sample.time);
        rows.position.push(sample.pose.position);
        rows.heading.push(y.atan2(x));
        rows.virtual_velocity.push(sample.virtual_velocity);
        rows.wheel_speed.push(sample.wheels);
        rows.target.push(sample.target);
        rows.source.push(sample.source);
        rows.attraction.push(sample.attraction);
        rows.repulsion.push(sample.repulsion);
        rows.readings.extend_from_slice(sample.readings);
        for (mover, shape) in self.scene.obstacles.iter().zip(sample.shapes) {
            rows.shifts.push(mover.shift(sample.time));
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
    scene: &Scene,
    seed: u64,
    interrupted: &(dyn Fn() -> bool + Sync),
) -> Result<(Outcome, Recording)> {
    let mut recorder = Recorder {
        recording: Recording::default(),
        scene,
        body_radius: follower.settings().drive.body_radius,
    };
    let outcome = follower.run(scene, seed, &mut recorder, interrupted)?;
    Ok((outcome, recorder.recording))
}
