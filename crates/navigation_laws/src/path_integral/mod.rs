//! Model predictive path integral control of Williams et al., "Information theoretic MPC for model-based reinforcement
//! learning", ICRA 2017, with the critics, names and defaults of Nav2 where it has them; distances are exact, not those of
//! cells. Draws are a function of seed, call, sample and step.

mod rollouts;

use rollouts::{Rollouts, samples_in_lanes};

use crate::local_planning::{
    Inflation, LocalView, Mode, PeopleMotion, TwistChoice, TwistFamily, TwistPlanner,
    finite_number, numbers,
};
use navigation_world::arguments::{Arguments, Named};
use numeric::error::{Failure, Given, Result, at_most, not_negative, positive};

/// Most samples, steps, and both together.
const MOST_SAMPLES: usize = 1 << 16;
const MOST_STEPS: usize = 1000;
const MOST_DRAWS: usize = 1 << 23;

/// Parameters by their names in Nav2; the weights are those of its critics.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)] // named and explained by Nav2, and by the class in Python
pub struct PathIntegral {
    pub vx_min: f64,
    pub vx_max: f64,
    pub vy_max: f64,
    pub wz_max: f64,
    pub ax_max: f64,
    pub ay_max: f64,
    pub az_max: f64,
    pub vx_std: f64,
    pub vy_std: f64,
    pub wz_std: f64,
    pub model_dt: f64,
    pub temperature: f64,
    pub gamma: f64,
    pub cost_weight: f64,
    pub goal_weight: f64,
    pub path_align_weight: f64,
    pub path_follow_weight: f64,
    pub path_angle_weight: f64,
    pub prefer_forward_weight: f64,
    pub cost_scaling_factor: f64,
    pub inflation_radius: f64,
    pub batch_size: usize,
    pub time_steps: usize,
    pub prediction: PeopleMotion,
}

numbers!(PathIntegral {
    vx_max, wz_max, vx_std, wz_std, temperature, gamma, cost_weight, goal_weight, path_align_weight,
    path_follow_weight, path_angle_weight, prefer_forward_weight,
} beside {
    vx_min: finite_number, vy_max: finite_number, ax_max: finite_number, ay_max: finite_number,
    az_max: finite_number, vy_std: finite_number, model_dt: finite_number,
    cost_scaling_factor: finite_number, inflation_radius: finite_number, batch_size: Arguments::count,
    time_steps: Arguments::count, prediction: PeopleMotion::given,
});

impl Named for PathIntegral {
    const NAME: &'static str = "path_integral";

    fn made_of(given: &dyn Arguments) -> Result<Self> {
        Self::given(given)
    }
}

impl TwistFamily for PathIntegral {
    type Planner = PathIntegralPlanner;

    #[allow(clippy::cast_possible_truncation)] // both halves count
    fn planner(&self, seed: u64) -> PathIntegralPlanner {
        PathIntegralPlanner::new(*self, (seed ^ (seed >> 32)) as u32)
    }
}

/// Forward and to the left in m/s, turn rate in rad/s.
type Control = [f64; 3];

impl PathIntegral {
    fn checked(self) -> Result<Self> {
        for (name, value) in [
            ("wz_max", self.wz_max),
            ("ax_max", self.ax_max),
            ("ay_max", self.ay_max),
            ("az_max", self.az_max),
            ("vx_std", self.vx_std),
            ("vy_std", self.vy_std),
            ("wz_std", self.wz_std),
            ("model_dt", self.model_dt),
            ("temperature", self.temperature),
            ("cost_scaling_factor", self.cost_scaling_factor),
        ] {
            positive(name, value)?;
        }
        for (name, value) in [
            ("vy_max", self.vy_max),
            ("gamma", self.gamma),
            ("cost_weight", self.cost_weight),
            ("goal_weight", self.goal_weight),
            ("path_align_weight", self.path_align_weight),
            ("path_follow_weight", self.path_follow_weight),
            ("path_angle_weight", self.path_angle_weight),
            ("prefer_forward_weight", self.prefer_forward_weight),
            ("inflation_radius", self.inflation_radius),
        ] {
            not_negative(name, value)?;
        }
        if self.vx_max < self.vx_min {
            let rule = format!("be at least vx_min, {}", self.vx_min);
            return Err(Failure::invalid("vx_max", rule, Given::Number(self.vx_max)));
        }
        for (name, count, most) in [
            ("batch_size", self.batch_size, MOST_SAMPLES),
            ("time_steps", self.time_steps, MOST_STEPS),
        ] {
            positive(name, count as f64)?;
            at_most(name, count, most)?;
        }
        at_most(
            "draws (batch_size times time_steps)",
            self.batch_size * self.time_steps,
            MOST_DRAWS,
        )?;
        Ok(self)
    }

    /// Largest speeds along both axes and turn rate, least ones, and largest changes in a step.
    fn limits(&self) -> [[f64; 3]; 3] {
        let step = self.model_dt;
        [
            [self.vx_max, self.vy_max, self.wz_max],
            [self.vx_min, -self.vy_max, -self.wz_max],
            [self.ax_max * step, self.ay_max * step, self.az_max * step],
        ]
    }

    fn deviations(&self) -> [f64; 3] {
        [self.vx_std, self.vy_std, self.wz_std]
    }

    /// Numbers of an axis that are drawn: without a speed to the left there is none.
    fn axes(&self) -> &'static [usize] {
        if self.vy_max > 0.0 {
            &[0, 1, 2]
        } else {
            &[0, 2]
        }
    }

    fn inflation(&self) -> Inflation {
        Inflation {
            cost_scaling_factor: self.cost_scaling_factor,
            inflation_radius: self.inflation_radius,
        }
    }
}

/// The planner at work.
pub struct PathIntegralPlanner {
    settings: PathIntegral,
    seed: u32,
    call: u32,
    /// Controls of the plan `U`.
    plan: Vec<Control>,
    /// The plan with the last decision in it, `U'`.
    decided: Vec<Control>,
    rollouts: Rollouts,
}

impl PathIntegralPlanner {
    /// With parameters and the key of its draws.
    #[must_use]
    pub fn new(settings: PathIntegral, seed: u32) -> Self {
        let plan = vec![[0.0; 3]; settings.time_steps];
        Self {
            decided: plan.clone(),
            plan,
            settings,
            seed,
            call: 0,
            rollouts: Rollouts::default(),
        }
    }

    /// Mean of the samples by their weights, within the limits.
    fn decide(&mut self, view: &LocalView<'_>) -> bool {
        let settings = &self.settings;
        let weights = self
            .rollouts
            .weights(settings.batch_size, settings.temperature);
        let Some(weights) = weights else {
            return false;
        };
        let [most, least, change] = settings.limits();
        let mut before = view.twist;
        for (step, decided) in self.decided.iter_mut().enumerate() {
            let mut limited = [0.0; 3];
            for &axis in settings.axes() {
                let mean = self.rollouts.mean(weights, (step, axis));
                let within = mean.clamp(least[axis], most[axis]);
                let (low, high) = (before[axis] - change[axis], before[axis] + change[axis]);
                limited[axis] = within.max(low).min(high);
            }
            *decided = limited;
            before = limited;
        }
        true
    }
}

impl TwistPlanner for PathIntegralPlanner {
    fn resume(&mut self, plan: &[Control], call: u32) {
        for (own, given) in self.plan.iter_mut().zip(plan) {
            *own = *given;
        }
        self.call = call;
    }

    fn planned(&self) -> &[Control] {
        &self.decided
    }

    fn choose(&mut self, view: &LocalView<'_>) -> TwistChoice {
        let draws = (self.seed, self.call);
        samples_in_lanes(&self.settings, view, &self.plan, draws, &mut self.rollouts);
        self.call = self.call.wrapping_add(1);
        if !self.decide(view) {
            self.plan.fill([0.0; 3]);
            self.decided.fill([0.0; 3]);
            return TwistChoice::BLOCKED;
        }
        self.plan.copy_from_slice(&self.decided);
        if (view.period - self.settings.model_dt).abs() <= 1e-9 * view.period {
            self.plan.rotate_left(1);
            if let [.., before, last] = &mut self.plan[..] {
                *last = *before;
            } else {
                self.plan.copy_from_slice(&self.decided);
            }
        }
        TwistChoice {
            twist: self.decided[0],
            score: None,
            mode: Mode::Track,
        }
    }
}
