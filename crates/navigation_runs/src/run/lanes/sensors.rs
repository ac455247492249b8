//! Noisy and late measurements of robots side by side, each in its scene with its seed.

use crate::run::lanes::scenes::LaneScenes;
use crate::run::scene::World;
use navigation_world::sensing::sampled::{Measured, SampledScene};
use navigation_world::world::geometry::{Body, RobotState};
use navigation_world::world::motion::BodyState;
use navigation_world::world::scenario::Scenario;
use numeric::lanes::{Planar, Real, Truth, Vector2};

/// Most measured states that are kept for the runs of one scene.
const MOST_STATES: usize = 1 << 18;

/// One scene as measured from its start on, sample by sample.
struct Samples {
    scene: SampledScene,
    errors: Vec<Measured>,
    /// Measured states of all obstacles, one sample after the other.
    states: Vec<BodyState>,
    actual: Vec<Body>,
    seen: Vec<Body>,
}

/// The sensors of every lane.
pub(crate) struct LaneSensors<'a, R: Real> {
    /// Samples of the scene of all runs; every run in it measures the same obstacles with the same errors.
    shared: Option<(&'a Scenario, Samples)>,
    /// Samples of a lane whose scene is its own; only the last one is kept.
    lanes: Vec<Option<Samples>>,
    /// Measured position of each robot at the sample before, if it was measured with an error.
    last: Vec<Option<Vector2<f64>>>,
    /// Obstacles as measured.
    pub seen: Vec<Body<R>>,
}

impl<'a, R: Real> LaneSensors<'a, R> {
    /// Sensors of a scenario in every lane, for runs of at most so many samples; `None` where everything is known
    /// exactly.
    pub fn new(scenario: &'a Scenario, bodies: &[Body<R>], samples: usize) -> Option<Self> {
        let all = Samples::new(scenario)?;
        let fits = samples.saturating_mul(bodies.len().max(1)) <= MOST_STATES;
        Some(Self {
            shared: fits.then_some((scenario, all)),
            lanes: (0..R::WIDTH).map(|_| None).collect(),
            last: vec![None; R::WIDTH],
            seen: bodies.to_vec(),
        })
    }

    /// A run begins in a lane.
    pub fn enter(&mut self, lane: usize, scenario: &Scenario) {
        self.last[lane] = None;
        let shared = self.shared.as_ref();
        let shares = shared.is_some_and(|(common, _)| std::ptr::eq(*common, scenario));
        self.lanes[lane] = if shares { None } else { Samples::new(scenario) };
    }

    /// Measures the obstacles at the time of each lane in s, which is that of a sample with this index; returns robots in
    /// some lanes as measured, from their own states.
    pub fn measure(
        &mut self,
        (time, index, lanes): (R, R, R::Mask),
        scenes: &LaneScenes<'_>,
        bodies: &[Body<R>],
        mut robot: RobotState<R>,
    ) -> RobotState<R> {
        self.seen.clone_from_slice(bodies);
        for lane in (0..R::WIDTH).filter(|lane| lanes.lane(*lane)) {
            let (time, index) = (time.lane(lane), whole(index.lane(lane)));
            let scenario = scenes.of_lane(lane);
            let (errors, states) = match (&mut self.lanes[lane], &mut self.shared) {
                (Some(own), _) => {
                    own.forget();
                    own.sample(0, time, (scenario, lane), bodies)
                }
                (None, Some((_, shared))) => shared.sample(index, time, (scenario, lane), bodies),
                (None, None) => continue,
            };
            for (body, state) in self.seen.iter_mut().zip(states) {
                body.state.set_lane(lane, state);
            }
            let own = RobotState {
                position: Vector2::from(robot.position.lane(lane)),
                velocity: Vector2::from(robot.velocity.lane(lane)),
            };
            let own = errors.of_robot(own, &mut self.last[lane]);
            robot.position.set_lane(lane, own.position.into());
            robot.velocity.set_lane(lane, own.velocity.into());
        }
        robot
    }
}

impl Samples {
    fn new(scenario: &Scenario) -> Option<Self> {
        Some(Self {
            scene: SampledScene::new(scenario, scenario.rules.control_period)?,
            errors: Vec::new(),
            states: Vec::new(),
            actual: Vec::new(),
            seen: Vec::new(),
        })
    }

    fn forget(&mut self) {
        self.errors.clear();
        self.states.clear();
    }

    /// Errors and measured obstacles of a sample, which is one of those kept or the next one; a lane knows where the
    /// obstacles of the scenario are at its time in s.
    fn sample<R: Real>(
        &mut self,
        index: usize,
        time: f64,
        (scenario, lane): (&Scenario, usize),
        bodies: &[Body<R>],
    ) -> (Measured, &[BodyState]) {
        let count = scenario.obstacles.len();
        let errors = if let Some(errors) = self.errors.get(index) {
            *errors
        } else {
            let obstacles = scenario.obstacles.iter().zip(bodies);
            self.actual.clear();
            self.actual.extend(obstacles.map(|(placed, body)| Body {
                shape: placed.obstacle.shape,
                regions: placed.regions,
                state: body.state.of_lane(lane),
            }));
            self.seen.clone_from(&self.actual);
            let errors = self.scene.measure(time, &self.actual, &mut self.seen);
            self.errors.push(errors);
            self.states.extend(self.seen.iter().map(|body| body.state));
            errors
        };
        let start = index * count;
        (errors, &self.states[start..start + count])
    }
}

/// A counted number of samples.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // whole, and not negative
fn whole(samples: f64) -> usize {
    samples as usize
}
