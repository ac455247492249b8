//! Records of a run of a robot as built.

use std::sync::Arc;

use crate::run::record::{Recorder, Trajectory, TrajectoryRecorder};
use navigation_laws::Command;
use navigation_world::robots::drives::Reading;
use navigation_world::world::footprint::Footprint;
use navigation_world::world::frame::Frame;
use navigation_world::world::geometry::Body;
use navigation_world::world::scenario::Scenario;
use navigation_world::world::shape::PlacedShape;
use numeric::lanes::Planar;

/// Columns of a recorded run; vectors of the plane and wheels are interleaved.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AsBuiltTrajectory {
    /// Columns of any run; its motor currents are those of ideal wheels and not used.
    pub motion: Trajectory,
    /// Number of wheels.
    pub wheels: usize,
    /// Headings in rad.
    pub heading: Vec<f64>,
    /// Wheel speeds in rad/s.
    pub wheel_speed: Vec<f64>,
    /// Motor currents in A.
    pub wheel_current: Vec<f64>,
    /// Electrical loss up to each instant in J.
    pub energy_used: Vec<f64>,
    /// Positions of the point mass that the law drives, in m.
    pub reference_position: Vec<f64>,
    /// Positions of the robot as the law knows them, in m.
    pub seen_position: Vec<f64>,
}

/// Distance `d` of a disc around a robot that is as far from an obstacle as its outline is; NaN while that is absent.
pub(super) fn distance_of(outline: &Footprint, radius: f64, reading: &Reading, body: &Body) -> f64 {
    if !body.state.present {
        return f64::NAN;
    }
    let pose = Frame::at(reading.robot.position.lane(0), reading.heading);
    let placed = PlacedShape {
        center: body.state.position.into(),
        shape: body.shape,
    };
    let gap = outline.separation(&pose, &placed).distance;
    (gap + radius + body.shape.inner_radius()).max(0.0)
}

/// Listens to a run of a robot as built.
pub trait Listener {
    /// A force was computed from a position in m as the law knows it.
    fn sample(&mut self, _command: &Command<f64>, _seen: [f64; 2]) {}
    /// State at the start of a step.
    fn row(&mut self, _time: f64, _reading: &Reading, _energy: f64, _bodies: &[Body]) {}
    /// State at the end of the run.
    fn end(&mut self, time: f64, reading: &Reading, energy: f64, bodies: &[Body]) {
        self.row(time, reading, energy, bodies);
    }
}

/// Keeps everything.
#[derive(Clone)]
pub struct Everything {
    motion: TrajectoryRecorder,
    command: Command<f64>,
    seen: [f64; 2],
    columns: AsBuiltTrajectory,
    outline: Option<(Arc<Footprint>, f64)>,
}

impl Everything {
    pub fn new(scenario: &Scenario, wheels: usize) -> Self {
        Self {
            motion: TrajectoryRecorder::new(scenario),
            command: Command {
                force: numeric::lanes::Vector2::zeros(),
                stabilizing: numeric::lanes::Vector2::zeros(),
                lyapunov: f64::NAN,
            },
            seen: scenario.start,
            outline: scenario
                .footprint
                .clone()
                .map(|footprint| (footprint, scenario.robot.radius)),
            columns: AsBuiltTrajectory {
                wheels,
                ..AsBuiltTrajectory::default()
            },
        }
    }

    /// The columns.
    pub fn finish(self) -> AsBuiltTrajectory {
        AsBuiltTrajectory {
            motion: self.motion.finish(),
            ..self.columns
        }
    }
}

impl Listener for Everything {
    fn sample(&mut self, command: &Command<f64>, seen: [f64; 2]) {
        self.command = *command;
        self.seen = seen;
    }

    fn row(&mut self, time: f64, reading: &Reading, energy: f64, bodies: &[Body]) {
        let robot = &reading.robot;
        self.motion.row(
            time,
            robot.position,
            robot.velocity,
            &reading.currents,
            &self.command,
            bodies,
        );
        if let Some((outline, radius)) = &self.outline {
            let distances = bodies
                .iter()
                .map(|body| distance_of(outline, *radius, reading, body));
            self.motion.set_distances(distances);
        }
        let columns = &mut self.columns;
        let wheels = columns.wheels;
        columns.heading.push(reading.heading);
        columns
            .wheel_speed
            .extend_from_slice(&reading.wheel_speeds[..wheels]);
        columns
            .wheel_current
            .extend_from_slice(&reading.currents[..wheels]);
        columns.energy_used.push(energy);
        columns
            .reference_position
            .extend([reading.reference.x, reading.reference.y]);
        columns.seen_position.extend(self.seen);
    }
}
