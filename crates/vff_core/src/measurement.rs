//! Noisy and late position measurements at the control period, with backward-difference velocities.

use std::collections::VecDeque;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use crate::error::{Failure, Given, Result, not_negative};
use crate::forces::geometry::{Body, RobotState};
use crate::lanes::{Planar, Real, Vector2};
use crate::motion::BodyState;
use crate::scenario::{PlacedObstacle, Scenario};

/// A Gaussian error is drawn again beyond this many standard deviations.
const GAUSSIAN_BOUND: f64 = 8.0;

/// Longest latency in s: it bounds the memory of past positions.
const MAX_LATENCY: f64 = 60.0;

/// Share of a motion step below which a latency counts as whole steps: typed numbers are rounded.
const WHOLE_STEPS: f64 = 1e-9;

/// Kind of measurement error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Distribution {
    /// Uniform in x and y each.
    Uniform,
    /// Normal in x and y each.
    Gaussian,
}

/// What is measured with an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Noisy {
    /// Positions of moving obstacles.
    Obstacles,
    /// Position of the robot.
    Robot,
    /// Both.
    Both,
}

/// Error and age of the measured positions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement {
    /// Half width or standard deviation in m.
    scale: f64,
    distribution: Distribution,
    noisy: Noisy,
    /// Age of the positions in s.
    latency: f64,
}

impl Measurement {
    /// A measurement error.
    ///
    /// # Errors
    /// The scale is negative or not finite.
    pub fn new(scale: f64, distribution: Distribution, noisy: Noisy) -> Result<Self> {
        Ok(Self {
            scale: not_negative("scale", scale)?,
            distribution,
            noisy,
            latency: 0.0,
        })
    }

    /// The same measurement of the positions of some time ago.
    ///
    /// # Errors
    /// The latency is negative, not finite or above a minute.
    pub fn late(self, latency: f64) -> Result<Self> {
        if not_negative("latency", latency)? > MAX_LATENCY {
            let rule = format!("be at most {MAX_LATENCY} s");
            return Err(Failure::invalid("latency", rule, Given::Number(latency))
                .mended_by("give seconds, as 0.1 for 100 ms"));
        }
        Ok(Self { latency, ..self })
    }

    /// Whether the robot is measured.
    #[must_use]
    pub fn of_robot(&self) -> bool {
        self.noisy != Noisy::Obstacles
    }

    /// Whether an obstacle is measured: one at rest is known exactly.
    #[must_use]
    pub fn of_obstacle(&self, stationary: bool) -> bool {
        self.noisy != Noisy::Robot && !stationary
    }

    /// Age of the measured positions in s.
    #[must_use]
    pub fn latency(&self) -> f64 {
        self.latency
    }

    /// Largest distance of a measured position from the one that is measured, in m.
    #[must_use]
    pub fn error_bound(&self) -> f64 {
        match self.distribution {
            Distribution::Uniform => std::f64::consts::SQRT_2 * self.scale,
            Distribution::Gaussian => GAUSSIAN_BOUND * self.scale,
        }
    }
}

/// Errors of one measured body, a stream of its own.
#[derive(Clone, Debug)]
pub(crate) struct Noise {
    generator: ChaCha8Rng,
    measurement: Measurement,
}

impl Noise {
    pub(crate) fn new(measurement: Measurement, seed: u64, stream: u64) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(stream);
        Self {
            generator,
            measurement,
        }
    }

    /// Uniform in [0, 1) with 53 bits.
    pub(crate) fn unit(&mut self) -> f64 {
        (self.generator.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Error of one position in m.
    pub(crate) fn draw(&mut self) -> [f64; 2] {
        let scale = self.measurement.scale;
        match self.measurement.distribution {
            Distribution::Uniform => {
                let x = self.unit();
                let y = self.unit();
                [(2.0 * x - 1.0) * scale, (2.0 * y - 1.0) * scale]
            }
            Distribution::Gaussian => loop {
                // Box and Muller (1958); 1 - unit() is never 0.
                let radius = (-2.0 * (1.0 - self.unit()).ln()).sqrt();
                let (sin, cos) = (std::f64::consts::TAU * self.unit()).sin_cos();
                if radius <= GAUSSIAN_BOUND {
                    return [scale * radius * cos, scale * radius * sin];
                }
            },
        }
    }
}

/// Errors of one sample that every robot in the scene shares.
#[derive(Clone, Copy, Debug)]
pub struct Measured {
    /// Error of the robot's position in m, if it is measured with one.
    pub robot_error: Option<[f64; 2]>,
    /// Time between two samples in s.
    pub period: f64,
}

impl Measured {
    /// State of robots as measured, from their own; the first velocity is the true one.
    #[inline(always)]
    pub(crate) fn of_robot<R: Real>(
        &self,
        robot: RobotState<R>,
        last: &mut Option<Vector2<R>>,
    ) -> RobotState<R> {
        let Some(error) = self.robot_error else {
            return robot;
        };
        let position = robot.position + Vector2::splat(error);
        let rate = R::splat(self.period);
        let velocity = last.map_or(robot.velocity, |last| {
            let way = position - last;
            Vector2::new(way.x / rate, way.y / rate)
        });
        *last = Some(position);
        RobotState { position, velocity }
    }
}

/// Positions of robots at their last motion steps, from which those of some time ago are read.
#[derive(Clone, Debug)]
pub(crate) struct Past<R: Real> {
    /// Whole motion steps of the latency.
    whole: usize,
    /// Share of the motion step before.
    share: f64,
    positions: VecDeque<Vector2<R>>,
}

impl<R: Real> Past<R> {
    /// Of robots that are measured late, with the motion step in s.
    pub fn new(scenario: &Scenario, step: f64) -> Option<Self> {
        let late = |measured: &Measurement| measured.of_robot() && measured.latency > 0.0;
        let steps = scenario.measurement.filter(late)?.latency / step;
        let near = steps.round();
        let steps = if (steps - near).abs() <= WHOLE_STEPS {
            near
        } else {
            steps
        };
        Some(Self {
            whole: whole_of(steps),
            share: steps - steps.floor(),
            positions: VecDeque::new(),
        })
    }

    /// Keeps the positions after a motion step; the first call is for the start of the run.
    pub fn push(&mut self, position: Vector2<R>) {
        if self.positions.len() > self.whole.saturating_add(1) {
            self.positions.pop_front();
        }
        self.positions.push_back(position);
    }

    /// Positions of the latency ago, on the line between two motion steps; the robots stood at
    /// their start before the run.
    pub fn delayed(&self, present: Vector2<R>) -> Vector2<R> {
        let last = self.positions.len().saturating_sub(1);
        let at = |steps: usize| {
            let place = self.positions.get(last.saturating_sub(steps));
            place.copied().unwrap_or(present)
        };
        let later = at(self.whole);
        if self.share == 0.0 {
            return later;
        }
        let earlier = at(self.whole.saturating_add(1));
        later + (earlier - later) * R::splat(self.share)
    }
}

/// A whole, not negative number as a count.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates
fn whole_of(steps: f64) -> usize {
    steps as usize
}

/// How one obstacle is measured.
#[derive(Clone, Debug)]
struct Watched<'a> {
    noise: Noise,
    placed: &'a PlacedObstacle,
    cursor: usize,
    last_position: Option<[f64; 2]>,
}

/// What the controller sees of the scene.
#[derive(Clone, Debug)]
pub struct Sensor<'a> {
    period: f64,
    latency: f64,
    robot: Option<Noise>,
    obstacles: Vec<Option<Watched<'a>>>,
}

impl<'a> Sensor<'a> {
    /// Sensor of a scenario, or `None` if everything is known exactly.
    #[must_use]
    pub fn new(scenario: &'a Scenario) -> Option<Self> {
        let measurement = scenario.measurement?;
        let noise = |stream| Noise::new(measurement, scenario.seed, stream);
        let obstacles = (1..).zip(&scenario.obstacles);
        Some(Self {
            period: scenario.rules.control_period,
            latency: measurement.latency,
            robot: measurement.of_robot().then(|| noise(0)),
            obstacles: obstacles
                .map(|(stream, placed)| {
                    let watched = || Watched {
                        noise: noise(stream),
                        placed,
                        cursor: 0,
                        last_position: None,
                    };
                    measurement.of_obstacle(placed.stationary).then(watched)
                })
                .collect(),
        })
    }

    /// Measures the obstacles at a time in s and draws the error of the robot's position.
    pub fn measure(&mut self, time: f64, actual: &[Body], seen: &mut [Body]) -> Measured {
        let (period, latency) = (self.period, self.latency);
        let bodies = seen.iter_mut().zip(actual);
        for ((measured, body), watched) in bodies.zip(&mut self.obstacles) {
            measured.state = match watched {
                None => body.state,
                Some(watched) if latency > 0.0 => {
                    let motion = &watched.placed.obstacle.motion;
                    let before = motion.at(time - latency, &mut watched.cursor);
                    watched.measure(before, period)
                }
                Some(watched) => watched.measure(body.state, period),
            };
        }
        let robot_error = self.robot.as_mut().map(Noise::draw);
        Measured {
            robot_error,
            period,
        }
    }
}

impl Watched<'_> {
    /// Measured state of an obstacle; the first velocity is the true one, the acceleration is
    /// not measured and counts as zero.
    fn measure(&mut self, state: BodyState, period: f64) -> BodyState {
        let [x, y] = self.noise.draw();
        if !state.present {
            self.last_position = None;
            return state;
        }
        let position = [state.position[0] + x, state.position[1] + y];
        let velocity = match self.last_position {
            Some(last) => [
                (position[0] - last[0]) / period,
                (position[1] - last[1]) / period,
            ],
            None => state.velocity,
        };
        self.last_position = Some(position);
        BodyState {
            position,
            velocity,
            acceleration: [0.0; 2],
            present: true,
        }
    }
}
