//! Noisy and late position measurements at the control period, with backward-difference velocities.

use std::collections::VecDeque;

use crate::sensing::measurement::{Measurement, Noise};
use crate::world::geometry::{Body, RobotState};
use crate::world::motion::{BodyState, Motion};
use crate::world::scenario::{PlacedObstacle, Scenario};
use numeric::lanes::{Planar, Real, Vector2};

/// Share of a motion step below which a latency counts as whole steps: typed numbers are rounded.
const WHOLE_STEPS: f64 = 1e-9;

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
    pub fn of_robot<R: Real>(
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
pub struct Past<R: Real> {
    /// Whole motion steps of the latency.
    whole: usize,
    /// Share of the motion step before.
    share: f64,
    positions: VecDeque<Vector2<R>>,
}

impl<R: Real> Past<R> {
    /// Of robots that are measured late, with the motion step in s.
    #[must_use]
    pub fn new(scenario: &Scenario, step: f64) -> Option<Self> {
        let late = |measured: &Measurement| measured.of_robot() && measured.latency() > 0.0;
        let latency = scenario.measurement.filter(late)?.latency();
        Some(Self::of(latency, step))
    }

    /// Of positions that are measured with a latency in s, with the time between two of them in s.
    #[must_use]
    fn of(latency: f64, step: f64) -> Self {
        let steps = latency / step;
        let near = steps.round();
        let steps = if (steps - near).abs() <= WHOLE_STEPS {
            near
        } else {
            steps
        };
        Self {
            whole: whole_of(steps),
            share: steps - steps.floor(),
            positions: VecDeque::new(),
        }
    }

    /// A run begins in a lane: its robot has always stood at its start.
    pub fn enter(&mut self, lane: usize, start: [f64; 2]) {
        for position in &mut self.positions {
            position.set_lane(lane, start);
        }
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

/// Where an obstacle was some time ago.
#[derive(Clone, Debug)]
enum Earlier {
    /// Known from its motion.
    Planned(Motion),
    /// Known from having been watched: nobody knows before how it moves.
    Watched(Past<f64>),
}

/// How one obstacle is measured.
#[derive(Clone, Debug)]
struct Watched {
    noise: Noise,
    /// Where it is measured late.
    late: Option<Earlier>,
    cursor: usize,
    last_position: Option<[f64; 2]>,
}

/// Scene as the controller sees it through noise and latency.
#[derive(Clone, Debug)]
pub struct SampledScene {
    period: f64,
    latency: f64,
    robot: Option<Noise>,
    obstacles: Vec<Option<Watched>>,
}

impl SampledScene {
    /// Sensors of a scenario, or `None` if everything is known exactly; `step`: time in s between two calls of
    /// [`Self::watch`].
    #[must_use]
    pub fn new(scenario: &Scenario, step: f64) -> Option<Self> {
        let measurement = scenario.measurement?;
        let noise = |stream| Noise::new(measurement, scenario.seed, stream);
        let late = |placed: &PlacedObstacle| {
            let earlier = || {
                if placed.moves_unforeseen() {
                    Earlier::Watched(Past::of(measurement.latency(), step))
                } else {
                    Earlier::Planned(placed.obstacle.motion.clone())
                }
            };
            (measurement.latency() > 0.0).then(earlier)
        };
        let obstacles = (1..).zip(&scenario.obstacles);
        Some(Self {
            period: scenario.rules.control_period,
            latency: measurement.latency(),
            robot: measurement.of_robot().then(|| noise(0)),
            obstacles: obstacles
                .map(|(stream, placed)| {
                    let watched = || Watched {
                        noise: noise(stream),
                        late: late(placed),
                        cursor: 0,
                        last_position: None,
                    };
                    measurement.of_obstacle(placed.stationary).then(watched)
                })
                .collect(),
        })
    }

    /// Keeps where everybody is whose motion nobody knows before, for what is measured late.
    pub fn watch(&mut self, actual: &[Body]) {
        for (watched, body) in self.obstacles.iter_mut().zip(actual) {
            let late = watched.as_mut().and_then(|watched| watched.late.as_mut());
            if let Some(Earlier::Watched(past)) = late {
                if body.state.present {
                    past.push(body.state.position.into());
                } else {
                    past.positions.clear();
                }
            }
        }
    }

    /// Measures the obstacles at a time in s and draws the error of the robot's position.
    pub fn measure(&mut self, time: f64, actual: &[Body], seen: &mut [Body]) -> Measured {
        let (period, latency) = (self.period, self.latency);
        let bodies = seen.iter_mut().zip(actual);
        for ((measured, body), watched) in bodies.zip(&mut self.obstacles) {
            measured.state = match watched {
                None => body.state,
                Some(watched) => {
                    let cursor = &mut watched.cursor;
                    let state = match &watched.late {
                        None => body.state,
                        Some(Earlier::Planned(motion)) => {
                            motion.at_or_before_start(time - latency, cursor)
                        }
                        Some(Earlier::Watched(past)) => BodyState {
                            position: past.delayed(body.state.position.into()).into(),
                            ..body.state
                        },
                    };
                    watched.measure(state, period)
                }
            };
        }
        let robot_error = self.robot.as_mut().map(Noise::draw);
        Measured {
            robot_error,
            period,
        }
    }
}

impl Watched {
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
