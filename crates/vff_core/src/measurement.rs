//! Noisy position measurements at the control period, with backward-difference velocities.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use crate::error::{Result, not_negative};
use crate::forces::geometry::{Body, RobotState};
use crate::lanes::{Real, Vec2};
use crate::motion::BodyState;
use crate::scenario::Scenario;

/// A Gaussian error is drawn again beyond this many standard deviations.
const GAUSSIAN_BOUND: f64 = 8.0;

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

/// Error of the measured positions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement {
    /// Half width or standard deviation in m.
    scale: f64,
    distribution: Distribution,
    noisy: Noisy,
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
        })
    }

    /// Whether the robot is measured with an error.
    #[must_use]
    pub fn of_robot(&self) -> bool {
        self.noisy != Noisy::Obstacles
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
        last: &mut Option<Vec2<R>>,
    ) -> RobotState<R> {
        let Some(error) = self.robot_error else {
            return robot;
        };
        let position = robot.position + Vec2::splat(error);
        let rate = R::splat(self.period);
        let velocity = last.map_or(robot.velocity, |last| {
            let way = position - last;
            Vec2 {
                x: way.x / rate,
                y: way.y / rate,
            }
        });
        *last = Some(position);
        RobotState { position, velocity }
    }
}

/// What the controller sees of the scene.
#[derive(Clone, Debug)]
pub struct Sensor {
    period: f64,
    robot: Option<Noise>,
    obstacles: Vec<Option<Noise>>,
    last_positions: Vec<Option<[f64; 2]>>,
}

impl Sensor {
    /// Sensor of a scenario, or `None` if everything is known exactly.
    #[must_use]
    pub fn new(scenario: &Scenario) -> Option<Self> {
        let measurement = scenario.measurement?;
        let noisy_robot = measurement.of_robot();
        let noisy_obstacles = measurement.noisy != Noisy::Robot;
        let noise = |stream| Noise::new(measurement, scenario.seed, stream);
        let obstacles = (1..).zip(&scenario.obstacles);
        Some(Self {
            period: scenario.rules.control_period,
            robot: noisy_robot.then(|| noise(0)),
            obstacles: obstacles
                .map(|(stream, placed)| {
                    (noisy_obstacles && !placed.stationary).then(|| noise(stream))
                })
                .collect(),
            last_positions: vec![None; scenario.obstacles.len()],
        })
    }

    /// Measures the obstacles and draws the error of the robot's position.
    pub fn measure(&mut self, actual: &[Body], seen: &mut [Body]) -> Measured {
        for (index, (measured, body)) in seen.iter_mut().zip(actual).enumerate() {
            measured.state = self.obstacle(index, body.state);
        }
        let robot_error = self.robot.as_mut().map(Noise::draw);
        Measured {
            robot_error,
            period: self.period,
        }
    }

    /// Measured state of an obstacle; the first velocity is the true one, the acceleration is
    /// not measured and counts as zero.
    fn obstacle(&mut self, index: usize, state: BodyState) -> BodyState {
        let Some(noise) = &mut self.obstacles[index] else {
            return state;
        };
        let [x, y] = noise.draw();
        if !state.present {
            self.last_positions[index] = None;
            return state;
        }
        let position = [state.position[0] + x, state.position[1] + y];
        let velocity = match self.last_positions[index] {
            Some(last) => [
                (position[0] - last[0]) / self.period,
                (position[1] - last[1]) / self.period,
            ],
            None => state.velocity,
        };
        self.last_positions[index] = Some(position);
        BodyState {
            position,
            velocity,
            acceleration: [0.0; 2],
            present: true,
        }
    }
}
