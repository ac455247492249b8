//! DWB, the local planner of Nav2 that scores sampled twists by critics, with the names and defaults of its files; distances
//! are exact, not those of cells.

use crate::local_planning::{
    AxisLimits, Gaps, Inflation, LocalView, Mode, PeopleMotion, Pose, TwistChoice, TwistFamily,
    TwistPlanner, finite_number, numbers,
};
use navigation_world::arguments::{Arguments, Named};
use numeric::error::{Failure, Given, Result, at_most, not_negative, positive};
use numeric::lanes::Vector2;

/// Half the side of the robot's local map, in m.
const LOCAL_MAP: f64 = 1.5;
/// A squared speed may exceed the limit by this, in m^2/s^2.
const SPARE: f64 = 1e-5;
/// Scores nearer than this are equal.
const EQUAL: f64 = 1e-12;
/// Most samples of an axis.
const MOST_SAMPLES: usize = 1000;
/// Most steps of a trajectory.
const MOST_STEPS: f64 = 1e5;
/// Less than what rounding adds to a gap, in m: poses are skipped only where they are farther away.
const ROUNDING: f64 = 1e-9;

/// Parameters by their names in Nav2.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)] // named and explained by Nav2, and by the class in Python
pub struct DWB {
    pub min_vel_x: f64,
    pub max_vel_x: f64,
    pub min_vel_y: f64,
    pub max_vel_y: f64,
    pub max_vel_theta: f64,
    pub min_speed_xy: f64,
    pub max_speed_xy: f64,
    pub min_speed_theta: f64,
    pub acc_lim_x: f64,
    pub acc_lim_y: f64,
    pub acc_lim_theta: f64,
    pub decel_lim_x: f64,
    pub decel_lim_y: f64,
    pub decel_lim_theta: f64,
    pub sim_time: f64,
    pub linear_granularity: f64,
    pub angular_granularity: f64,
    pub obstacle_scale: f64,
    pub path_dist_scale: f64,
    pub goal_dist_scale: f64,
    pub path_align_scale: f64,
    pub goal_align_scale: f64,
    pub forward_point_distance: f64,
    pub cost_scaling_factor: f64,
    pub inflation_radius: f64,
    pub vx_samples: usize,
    pub vy_samples: usize,
    pub vtheta_samples: usize,
    pub prediction: PeopleMotion,
}

numbers!(DWB {
    max_vel_x, max_vel_theta, max_speed_xy, acc_lim_x, acc_lim_theta, sim_time, obstacle_scale,
    path_dist_scale, goal_dist_scale, path_align_scale, goal_align_scale, forward_point_distance,
    cost_scaling_factor, inflation_radius,
} beside {
    min_vel_x: finite_number, min_vel_y: finite_number, max_vel_y: finite_number,
    min_speed_xy: finite_number, min_speed_theta: finite_number, acc_lim_y: finite_number,
    decel_lim_x: finite_number, decel_lim_y: finite_number, decel_lim_theta: finite_number,
    linear_granularity: finite_number, angular_granularity: finite_number, vx_samples: Arguments::count,
    vy_samples: Arguments::count, vtheta_samples: Arguments::count, prediction: PeopleMotion::given,
});

impl Named for DWB {
    const NAME: &'static str = "dwb";

    fn made_of(given: &dyn Arguments) -> Result<Self> {
        Self::given(given)
    }
}

impl TwistFamily for DWB {
    type Planner = DwbPlanner;

    fn planner(&self, _seed: u64) -> DwbPlanner {
        DwbPlanner::new(*self)
    }
}

impl DWB {
    fn checked(self) -> Result<Self> {
        for (axis, limits) in ["x", "y"].into_iter().zip(self.axes()) {
            let names = ["min_vel_", "max_vel_", "acc_lim_", "decel_lim_"]
                .map(|name| format!("{name}{axis}"));
            limits.checked(names.each_ref().map(String::as_str))?;
        }
        positive("max_vel_theta", self.max_vel_theta)?;
        self.axes()[2].checked([
            "max_vel_theta",
            "max_vel_theta",
            "acc_lim_theta",
            "decel_lim_theta",
        ])?;
        for (name, value) in [
            ("sim_time", self.sim_time),
            ("linear_granularity", self.linear_granularity),
            ("angular_granularity", self.angular_granularity),
            ("max_speed_xy", self.max_speed_xy),
            ("cost_scaling_factor", self.cost_scaling_factor),
        ] {
            positive(name, value)?;
        }
        for (name, value) in [
            ("min_speed_xy", self.min_speed_xy),
            ("min_speed_theta", self.min_speed_theta),
            ("obstacle_scale", self.obstacle_scale),
            ("path_dist_scale", self.path_dist_scale),
            ("goal_dist_scale", self.goal_dist_scale),
            ("path_align_scale", self.path_align_scale),
            ("goal_align_scale", self.goal_align_scale),
            ("forward_point_distance", self.forward_point_distance),
            ("inflation_radius", self.inflation_radius),
        ] {
            not_negative(name, value)?;
        }
        for (name, samples) in [
            ("vx_samples", self.vx_samples),
            ("vy_samples", self.vy_samples),
            ("vtheta_samples", self.vtheta_samples),
        ] {
            positive(name, samples as f64)?;
            at_most(name, samples, MOST_SAMPLES)?;
        }
        let fastest = self.max_speed_xy * self.sim_time / self.linear_granularity;
        let turning = self.max_vel_theta * self.sim_time / self.angular_granularity;
        let steps = fastest.max(turning);
        if steps > MOST_STEPS {
            let rule = format!("have at most {MOST_STEPS} steps of the granularities");
            return Err(Failure::invalid("sim_time", rule, Given::Number(steps)));
        }
        Ok(self)
    }

    /// Limits along x, y and of the turn rate.
    fn axes(&self) -> [AxisLimits; 3] {
        let axis = |least, most, acceleration, deceleration| AxisLimits {
            least,
            most,
            acceleration,
            deceleration,
        };
        let turn = self.max_vel_theta;
        [
            axis(
                self.min_vel_x,
                self.max_vel_x,
                self.acc_lim_x,
                self.decel_lim_x,
            ),
            axis(
                self.min_vel_y,
                self.max_vel_y,
                self.acc_lim_y,
                self.decel_lim_y,
            ),
            axis(-turn, turn, self.acc_lim_theta, self.decel_lim_theta),
        ]
    }

    /// Whether a twist is one of the trajectories.
    fn allows(&self, [x, y, turn_rate]: [f64; 3]) -> bool {
        let squared = x * x + y * y;
        let too_fast = squared > self.max_speed_xy * self.max_speed_xy + SPARE;
        let zero = squared == 0.0 && turn_rate == 0.0;
        let slow = squared.sqrt() < self.min_speed_xy && turn_rate.abs() < self.min_speed_theta;
        !(too_fast || zero || slow)
    }

    /// Steps of the trajectory of a twist.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // bounded when it was checked
    fn steps(&self, [x, y, turn_rate]: [f64; 3]) -> usize {
        let ahead = x.hypot(y) * self.sim_time / self.linear_granularity;
        let turned = turn_rate.abs() * self.sim_time / self.angular_granularity;
        ahead.max(turned).ceil().max(1.0) as usize
    }
}

/// Directions of the robot after every step towards a turn rate, in so many steps.
#[derive(Clone, Debug, Default)]
struct TurnRates {
    steps: usize,
    fronts: Vec<Vector2<f64>>,
    heading: f64,
}

impl TurnRates {
    /// Turns towards a rate, if it is not known yet.
    fn turn(
        &mut self,
        limits: &AxisLimits,
        pose: &Pose,
        [from, to]: [f64; 2],
        (steps, step): (usize, f64),
    ) {
        if self.steps == steps {
            return;
        }
        self.steps = steps;
        self.fronts.clear();
        let (mut heading, mut rate) = (pose.heading, from);
        for _ in 0..steps {
            let (sine, cosine) = heading.sin_cos();
            self.fronts.push(Vector2::new(cosine, sine));
            rate = limits.toward(rate, to, step);
            heading += rate * step;
        }
        self.heading = heading;
    }
}

/// The planner at work.
pub struct DwbPlanner {
    settings: DWB,
    axes: [AxisLimits; 3],
    samples: [Vec<f64>; 3],
    turnings: Vec<TurnRates>,
}

/// Places that the critics look at.
struct Targets {
    /// Where the way leaves the local map.
    local: Vector2<f64>,
    /// Point ahead of the goal.
    ahead: Vector2<f64>,
    /// Whether the robot is far enough from the goal to keep to the direction of the way.
    aligns: bool,
}

impl DwbPlanner {
    /// With parameters.
    #[must_use]
    pub fn new(settings: DWB) -> Self {
        Self {
            axes: settings.axes(),
            settings,
            samples: Default::default(),
            turnings: Vec::new(),
        }
    }

    /// Where a trajectory ends, and the gap there; `None` where a pose of it is in contact.
    fn end(
        &self,
        view: &LocalView<'_>,
        command: [f64; 3],
        turning: &TurnRates,
        (first, fastest): (f64, f64),
    ) -> Option<(Pose, f64)> {
        let (settings, steps) = (&self.settings, turning.steps);
        let step = settings.sim_time / steps as f64;
        let gap = |place, time| view.gaps.at(place, time, settings.prediction);
        let [mut x, mut y, _] = view.twist;
        let mut place = view.pose.position;
        // No pose is in contact before robot and people have come nearer by this.
        let mut room = first;
        for (index, front) in turning.fronts.iter().enumerate() {
            x = self.axes[0].toward(x, command[0], step);
            y = self.axes[1].toward(y, command[1], step);
            place += (*front * x + Vector2::new(-front.y, front.x) * y) * step;
            room -= ((x * x + y * y).sqrt() + fastest) * step;
            if room <= ROUNDING && index + 1 < steps {
                room = gap(place, (index + 1) as f64 * step);
                if room.is_nan() || room <= 0.0 {
                    return None;
                }
            }
        }
        let left = gap(place, settings.sim_time);
        let pose = Pose {
            position: place,
            heading: turning.heading,
        };
        (left > 0.0).then_some((pose, left))
    }

    /// Score of the end of a trajectory.
    fn score(&self, view: &LocalView<'_>, targets: &Targets, pose: &Pose, gap: f64) -> f64 {
        let settings = &self.settings;
        let inflation = Inflation {
            cost_scaling_factor: settings.cost_scaling_factor,
            inflation_radius: settings.inflation_radius,
        };
        let place = pose.position;
        let ahead = place + pose.front() * settings.forward_point_distance;
        let mut score = settings.obstacle_scale * inflation.cost(gap, view.gaps.radius);
        score += 0.5 * settings.path_dist_scale * view.way.distance(place);
        score += 0.5 * settings.goal_dist_scale * (place - targets.local).norm();
        if targets.aligns {
            score += 0.5 * settings.path_align_scale * view.way.distance(ahead);
        }
        score + 0.5 * settings.goal_align_scale * (ahead - targets.ahead).norm()
    }
}

impl TwistPlanner for DwbPlanner {
    fn choose(&mut self, view: &LocalView<'_>) -> TwistChoice {
        let settings = self.settings;
        let counts = [
            settings.vx_samples,
            settings.vy_samples,
            settings.vtheta_samples,
        ];
        for (axis, samples) in self.samples.iter_mut().enumerate() {
            self.axes[axis].samples(view.twist[axis], settings.sim_time, counts[axis], samples);
        }
        let gaps: &Gaps<'_> = view.gaps;
        let first = gaps.at(view.pose.position, 0.0, settings.prediction);
        if first.is_nan() || first <= 0.0 {
            return TwistChoice::BLOCKED;
        }
        let fastest = gaps.fastest(settings.prediction);
        let (goal, from) = (view.goal(), view.pose.position);
        let local = view.way.leaves_square(from, LOCAL_MAP);
        let to_goal = goal - from;
        let away = to_goal.norm();
        let direction = if away > 0.0 {
            to_goal / away
        } else {
            Vector2::x()
        };
        let targets = Targets {
            local,
            ahead: local + direction * settings.forward_point_distance,
            aligns: away > settings.forward_point_distance,
        };
        let mut turnings = std::mem::take(&mut self.turnings);
        turnings.clear();
        turnings.resize_with(self.samples[2].len(), TurnRates::default);
        let mut best = TwistChoice::BLOCKED;
        for &x in &self.samples[0] {
            for &y in &self.samples[1] {
                for (&turn_rate, turning) in self.samples[2].iter().zip(&mut turnings) {
                    let command = [x, y, turn_rate];
                    if !settings.allows(command) {
                        continue;
                    }
                    let steps = settings.steps(command);
                    let step = settings.sim_time / steps as f64;
                    let rates = [view.twist[2], turn_rate];
                    turning.turn(&self.axes[2], &view.pose, rates, (steps, step));
                    let Some((pose, gap)) = self.end(view, command, turning, (first, fastest))
                    else {
                        continue;
                    };
                    let score = self.score(view, &targets, &pose, gap);
                    if best.score.is_none_or(|known| score < known - EQUAL) {
                        best = TwistChoice {
                            twist: command,
                            score: Some(score),
                            mode: Mode::Track,
                        };
                    }
                }
            }
        }
        self.turnings = turnings;
        best
    }
}
