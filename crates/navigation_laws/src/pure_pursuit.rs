//! Regulated pure pursuit of Macenski, Singh, Martin and Gines, "Regulated pure pursuit for robot path tracking", Autonomous
//! Robots 47, 2023, with the names and defaults of Nav2; distances are exact, not those of cells.

use crate::local_planning::{
    LocalView, Mode, PeopleMotion, Pose, TwistChoice, TwistFamily, TwistPlanner, finite_number,
    numbers, wrap,
};
use navigation_world::arguments::{Arguments, Named};
use numeric::error::{Failure, Given, Result, not_negative, positive};
use numeric::lanes::Vector2;

/// Squared distance in m^2 up to which a point has no curvature.
const NEAR: f64 = 0.001;
/// Way between two poses that are examined, in m.
const PROJECTED: f64 = 0.05;
/// Most of them.
const MOST_POSES: f64 = 1e5;

/// Parameters by their names in Nav2.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs, clippy::struct_excessive_bools)] // named and explained by Nav2, and by the class in Python
pub struct RegulatedPurePursuit {
    pub desired_linear_vel: f64,
    pub lookahead_dist: f64,
    pub min_lookahead_dist: f64,
    pub max_lookahead_dist: f64,
    pub lookahead_time: f64,
    pub curvature_lookahead_dist: f64,
    pub rotate_to_heading_angular_vel: f64,
    pub rotate_to_heading_min_angle: f64,
    pub max_angular_accel: f64,
    pub min_approach_linear_velocity: f64,
    pub approach_velocity_scaling_dist: f64,
    pub regulated_linear_scaling_min_radius: f64,
    pub regulated_linear_scaling_min_speed: f64,
    pub cost_scaling_dist: f64,
    pub cost_scaling_gain: f64,
    pub inflation_radius: f64,
    pub max_allowed_time_to_collision_up_to_carrot: f64,
    pub use_velocity_scaled_lookahead_dist: bool,
    pub use_fixed_curvature_lookahead: bool,
    pub use_regulated_linear_velocity_scaling: bool,
    pub use_cost_regulated_linear_velocity_scaling: bool,
    pub use_rotate_to_heading: bool,
    pub use_collision_detection: bool,
    pub allow_reversing: bool,
    pub prediction: PeopleMotion,
}

numbers!(RegulatedPurePursuit {
    desired_linear_vel, lookahead_dist, lookahead_time, curvature_lookahead_dist,
    rotate_to_heading_angular_vel, rotate_to_heading_min_angle, max_angular_accel,
    min_approach_linear_velocity, approach_velocity_scaling_dist, regulated_linear_scaling_min_radius,
    regulated_linear_scaling_min_speed, cost_scaling_dist, cost_scaling_gain,
} beside {
    min_lookahead_dist: finite_number, max_lookahead_dist: finite_number, inflation_radius: finite_number,
    max_allowed_time_to_collision_up_to_carrot: finite_number,
    use_velocity_scaled_lookahead_dist: Arguments::flag, use_fixed_curvature_lookahead: Arguments::flag,
    use_regulated_linear_velocity_scaling: Arguments::flag,
    use_cost_regulated_linear_velocity_scaling: Arguments::flag, use_rotate_to_heading: Arguments::flag,
    use_collision_detection: Arguments::flag, allow_reversing: Arguments::flag,
    prediction: PeopleMotion::given,
});

impl Named for RegulatedPurePursuit {
    const NAME: &'static str = "regulated_pure_pursuit";

    fn made_of(given: &dyn Arguments) -> Result<Self> {
        Self::given(given)
    }
}

impl TwistFamily for RegulatedPurePursuit {
    type Planner = Self;

    fn planner(&self, _seed: u64) -> Self {
        *self
    }
}

impl RegulatedPurePursuit {
    fn checked(self) -> Result<Self> {
        for (name, value) in [
            ("desired_linear_vel", self.desired_linear_vel),
            ("lookahead_dist", self.lookahead_dist),
            ("min_lookahead_dist", self.min_lookahead_dist),
            ("lookahead_time", self.lookahead_time),
            ("curvature_lookahead_dist", self.curvature_lookahead_dist),
            (
                "rotate_to_heading_angular_vel",
                self.rotate_to_heading_angular_vel,
            ),
            ("max_angular_accel", self.max_angular_accel),
            (
                "regulated_linear_scaling_min_radius",
                self.regulated_linear_scaling_min_radius,
            ),
            (
                "approach_velocity_scaling_dist",
                self.approach_velocity_scaling_dist,
            ),
            ("cost_scaling_dist", self.cost_scaling_dist),
            ("cost_scaling_gain", self.cost_scaling_gain),
            (
                "max_allowed_time_to_collision_up_to_carrot",
                self.max_allowed_time_to_collision_up_to_carrot,
            ),
        ] {
            positive(name, value)?;
        }
        for (name, value) in [
            (
                "rotate_to_heading_min_angle",
                self.rotate_to_heading_min_angle,
            ),
            (
                "min_approach_linear_velocity",
                self.min_approach_linear_velocity,
            ),
            (
                "regulated_linear_scaling_min_speed",
                self.regulated_linear_scaling_min_speed,
            ),
            ("inflation_radius", self.inflation_radius),
        ] {
            not_negative(name, value)?;
        }
        let fastest = self
            .desired_linear_vel
            .max(self.regulated_linear_scaling_min_speed);
        let poses = fastest * self.max_allowed_time_to_collision_up_to_carrot / PROJECTED;
        if poses > MOST_POSES {
            let rule = format!(
                "lead over at most {MOST_POSES} poses, one every {PROJECTED} m, at the largest speed"
            );
            let given = Given::Number(self.max_allowed_time_to_collision_up_to_carrot);
            let name = "max_allowed_time_to_collision_up_to_carrot";
            return Err(Failure::invalid(name, rule, given));
        }
        if self.max_lookahead_dist < self.min_lookahead_dist {
            let rule = format!(
                "be at least min_lookahead_dist, {}",
                self.min_lookahead_dist
            );
            let given = Given::Number(self.max_lookahead_dist);
            return Err(Failure::invalid("max_lookahead_dist", rule, given));
        }
        if self.use_rotate_to_heading && self.allow_reversing {
            let rule = "be False beside use_rotate_to_heading: a robot that turns to its way does not drive back";
            return Err(Failure::invalid(
                "allow_reversing",
                rule,
                Given::Word("True".into()),
            ));
        }
        Ok(self)
    }

    /// Distance of the carrot in m.
    fn lookahead(&self, speed: f64) -> f64 {
        if self.use_velocity_scaled_lookahead_dist {
            let ahead = speed.abs() * self.lookahead_time;
            ahead.clamp(self.min_lookahead_dist, self.max_lookahead_dist)
        } else {
            self.lookahead_dist
        }
    }

    /// Turn rate in place towards a bearing.
    fn rotation(&self, bearing: f64, now: f64, period: f64) -> f64 {
        let change = self.max_angular_accel * period;
        let wanted = self.rotate_to_heading_angular_vel.copysign(bearing);
        let rate = wanted.max(now - change).min(now + change);
        // It still has to stop there.
        let most = (2.0 * self.max_angular_accel * bearing.abs()).sqrt();
        if rate.abs() > most {
            most.copysign(bearing)
        } else {
            rate
        }
    }

    /// Speed on a curvature in 1/m, with a gap in m.
    fn speed(&self, view: &LocalView<'_>, curvature: f64, gap: f64) -> f64 {
        let desired = self.desired_linear_vel;
        let mut speed = desired;
        if self.use_regulated_linear_velocity_scaling {
            let tight = self.regulated_linear_scaling_min_radius * curvature.abs();
            if tight > 1.0 {
                speed = speed.min(desired / tight);
            }
        }
        let away = gap + view.gaps.radius;
        if self.use_cost_regulated_linear_velocity_scaling
            && away <= self.inflation_radius
            && away < self.cost_scaling_dist
        {
            speed = speed.min(desired * self.cost_scaling_gain * away / self.cost_scaling_dist);
        }
        speed = speed.max(self.regulated_linear_scaling_min_speed);
        if view.way.length() < self.approach_velocity_scaling_dist {
            let left = (view.goal() - view.pose.position).norm();
            let slow = speed * left / self.approach_velocity_scaling_dist;
            speed = speed.min(slow.max(self.min_approach_linear_velocity));
        }
        speed
    }

    /// Whether a pose of the next second, up to the carrot, is in contact.
    fn collides(
        &self,
        view: &LocalView<'_>,
        [speed, turn_rate]: [f64; 2],
        carrot: f64,
        gap: f64,
    ) -> bool {
        if gap.is_nan() || gap <= 0.0 {
            return true;
        }
        let step = PROJECTED / speed.abs();
        let fastest = view.gaps.fastest(self.prediction);
        let Pose {
            mut position,
            mut heading,
        } = view.pose;
        let mut room = gap;
        let mut index = 1.0;
        while index * step < self.max_allowed_time_to_collision_up_to_carrot {
            let (sine, cosine) = heading.sin_cos();
            position += Vector2::new(cosine, sine) * (speed * step);
            heading += turn_rate * step;
            if (position - view.pose.position).norm() > carrot {
                return false;
            }
            room -= PROJECTED + fastest * step;
            // No pose is in contact before robot and people have come nearer by the gap.
            if room.is_nan() || room <= 1e-9 {
                room = view.gaps.at(position, index * step, self.prediction);
                if room.is_nan() || room <= 0.0 {
                    return true;
                }
            }
            index += 1.0;
        }
        false
    }
}

impl TwistPlanner for RegulatedPurePursuit {
    fn choose(&mut self, view: &LocalView<'_>) -> TwistChoice {
        let (pose, from) = (&view.pose, view.pose.position);
        let carrot = view.way.first_beyond(from, self.lookahead(view.twist[0]));
        let aim = if self.use_fixed_curvature_lookahead {
            view.way.first_beyond(from, self.curvature_lookahead_dist)
        } else {
            carrot
        };
        let seen = pose.inward(aim - from);
        let squared = seen.dot(&seen);
        let curvature = if squared > NEAR {
            2.0 * seen.y / squared
        } else {
            0.0
        };
        let mut bearing = seen.y.atan2(seen.x);
        let to_carrot = pose.inward(carrot - from);
        let backward = self.allow_reversing && to_carrot.x < 0.0;
        if backward {
            bearing = wrap(bearing + std::f64::consts::PI);
        }
        let gap = view.gaps.at(from, 0.0, self.prediction);
        let turns = self.use_rotate_to_heading && bearing.abs() > self.rotate_to_heading_min_angle;
        let (twist, mode) = if turns {
            let rate = self.rotation(bearing, view.twist[2], view.period);
            ([0.0, 0.0, rate], Mode::Rotate)
        } else {
            let speed = self.speed(view, curvature, gap);
            let speed = if backward { -speed } else { speed };
            ([speed, 0.0, speed * curvature], Mode::Track)
        };
        let command = [twist[0], twist[2]];
        if self.use_collision_detection && self.collides(view, command, to_carrot.norm(), gap) {
            return TwistChoice::BLOCKED;
        }
        TwistChoice {
            twist,
            score: None,
            mode,
        }
    }
}
