//! Noisy and late measurements of robots side by side, each in its scene with its seed.

use crate::lanes::{Planar, Real, Truth, Vector2};
use crate::run::lanes::scenes::LaneScenes;
use crate::run::scene::World;
use crate::sensing::sampled::SampledScene;
use crate::world::geometry::{Body, RobotState};
use crate::world::scenario::Scenario;

/// The sensors of one lane.
struct LaneSensor {
    scene: SampledScene,
    /// Measured position at the sample before, if it was measured with an error.
    last: Option<Vector2<f64>>,
    actual: Vec<Body>,
    seen: Vec<Body>,
}

/// The sensors of every lane.
pub(crate) struct LaneSensors<R: Real> {
    lanes: Vec<LaneSensor>,
    /// Obstacles as measured.
    pub seen: Vec<Body<R>>,
}

impl<R: Real> LaneSensors<R> {
    /// Sensors of a scenario in every lane; `None` where everything is known exactly.
    pub fn new(scenario: &Scenario, bodies: &[Body<R>]) -> Option<Self> {
        let lane = |_| LaneSensor::new(scenario);
        Some(Self {
            lanes: (0..R::WIDTH).map(lane).collect::<Option<_>>()?,
            seen: bodies.to_vec(),
        })
    }

    /// A run begins in a lane.
    pub fn enter(&mut self, lane: usize, scenario: &Scenario) {
        if let Some(sensor) = LaneSensor::new(scenario) {
            self.lanes[lane] = sensor;
        }
    }

    /// Measures the obstacles at the time of each lane in s; returns robots in some lanes as measured, from their own
    /// states.
    pub fn measure(
        &mut self,
        (time, lanes): (R, R::Mask),
        scenes: &LaneScenes<'_>,
        bodies: &[Body<R>],
        mut robot: RobotState<R>,
    ) -> RobotState<R> {
        self.seen.clone_from_slice(bodies);
        for (lane, sensor) in self.lanes.iter_mut().enumerate() {
            if !lanes.lane(lane) {
                continue;
            }
            sensor.actual.clear();
            let obstacles = scenes.of_lane(lane).obstacles.iter().zip(bodies);
            sensor.actual.extend(obstacles.map(|(placed, body)| Body {
                shape: placed.obstacle.shape,
                regions: placed.regions,
                state: body.state.of_lane(lane),
            }));
            sensor.seen.clone_from(&sensor.actual);
            let time = time.lane(lane);
            let measured = sensor.scene.measure(time, &sensor.actual, &mut sensor.seen);
            for (body, own) in self.seen.iter_mut().zip(&sensor.seen) {
                body.state.set_lane(lane, &own.state);
            }
            let own = RobotState {
                position: Vector2::from(robot.position.lane(lane)),
                velocity: Vector2::from(robot.velocity.lane(lane)),
            };
            let own = measured.of_robot(own, &mut sensor.last);
            robot.position.set_lane(lane, own.position.into());
            robot.velocity.set_lane(lane, own.velocity.into());
        }
        robot
    }
}

impl LaneSensor {
    fn new(scenario: &Scenario) -> Option<Self> {
        Some(Self {
            scene: SampledScene::new(scenario)?,
            last: None,
            actual: Vec::new(),
            seen: Vec::new(),
        })
    }
}
