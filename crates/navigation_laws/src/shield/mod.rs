//! Passive safety around any law: whenever robot and person touch, the robot rests or does not move
//! toward the person.
//!
//! Fraichard (2007), Bouraine, Fraichard and Salhi (2012), Mitsch et al. (2017). A command is given
//! only if the plan behind it, take it up within a period and then brake to rest, stays behind
//! everywhere that people can be by then; if no such command is found, the rest of the last plan is
//! executed. So at every instant the robot executes a piece of a plan that was verified at or before
//! it, whatever people do within their bounds.

mod blind;
mod bound;
mod course;
mod half_disc;
mod hidden;
mod outline;
mod person;
mod plan;
mod reading;
mod search;
mod tracking;
mod twist;
mod verifier;
mod walls;

pub use blind::{BlindCorner, CornerEdge};
pub use bound::speed_bound;
pub use course::Course;
pub use half_disc::half_disc_distance;
pub use hidden::Hidden;
pub use outline::{BodyCommand, OutlineGuard};
pub use person::{KnownVelocity, Person};
pub use plan::{BrakingPlan, braking, braking_periods};
pub use reading::PlanTimes;
pub use tracking::TrackingError;
pub use twist::{TwistGuard, TwistLimits, TwistState, TwistView};
pub use verifier::Verifier;
pub use walls::StaticObstacles;

use navigation_world::world::geometry::RobotState;
use numeric::error::{Failure, Given, Result, not_negative, positive};
use numeric::lanes::Vector2;
use unknown_places::unseen::Unseen;

/// Rounding of speeds, relative.
const SPEED_ROUNDING: f64 = 1e-9;

/// Differences from a plan that rounding explains, in m and m/s.
const OFF_PLAN: f64 = 1e-6;

/// A wanted velocity below this share of the change to it tells no direction.
const RESTING: f64 = 0.07;

/// Sides that differ by less than this share are alike.
const ALIKE: f64 = 1e-9;

/// Walls farther away than this tell no side, in m.
const FARTHEST: f64 = 1e3;

/// Shares of the wanted velocity that are always tried.
const SHARES: [f64; 10] = [0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1, 0.0];

/// A person who is left a way to stop: passive friendly safety.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friendly {
    /// Time `t_r` until he brakes, in s.
    pub reaction_time: f64,
    /// His deceleration `b` in m/s^2.
    pub deceleration: f64,
}

impl Friendly {
    /// How far somebody goes until he stands, in m: `v t_r + v^2/(2 b)`.
    fn stopping_way(&self, speed: f64) -> f64 {
        speed * self.reaction_time + speed * speed / (2.0 * self.deceleration)
    }
}

/// Assumptions of the shield.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shield {
    /// Largest speed of people in m/s; that of the scene where `None`.
    pub person_speed: Option<f64>,
    /// Largest age of a measurement when the command takes effect, in s.
    pub latency: f64,
    /// Largest error of a measured position in m.
    pub position_error: f64,
    /// Largest error of a measured velocity in m/s, and largest acceleration of people in m/s^2;
    /// `None`: only their speed is bounded.
    pub velocity_bounds: Option<[f64; 2]>,
    /// Error `m` of the own pose and of executed motion in m.
    pub margin: f64,
    /// Largest distance of the robot from its plan in m.
    pub position_tracking: f64,
    /// Largest difference of its velocity from that of its plan.
    pub velocity_tracking: TrackingError,
    /// Distance `m_s` that is kept from walls, in m.
    pub wall_margin: f64,
    /// Whether people are left a way to stop.
    pub friendly: Option<Friendly>,
    /// Assumptions about unseen people, if plans are verified against them.
    pub unseen: Option<Unseen>,
}

impl Default for Shield {
    /// Walking speed of ISO 13855.
    fn default() -> Self {
        Self {
            person_speed: Some(1.6),
            latency: 0.0,
            position_error: 0.0,
            velocity_bounds: None,
            margin: 0.005,
            position_tracking: 0.005,
            velocity_tracking: TrackingError::default(),
            wall_margin: 0.005,
            friendly: None,
            unseen: None,
        }
    }
}

impl Shield {
    /// Returns the shield if its numbers are allowed.
    ///
    /// # Errors
    /// Names the number that is not.
    pub fn checked(self) -> Result<Self> {
        if let Some(speed) = self.person_speed {
            not_negative("person_speed", speed)?;
        }
        not_negative("latency", self.latency)?;
        not_negative("position_error", self.position_error)?;
        if let Some([error, acceleration]) = self.velocity_bounds {
            not_negative("velocity_error", error)?;
            not_negative("person_acceleration", acceleration)?;
        }
        not_negative("margin", self.margin)?;
        not_negative("position_tracking", self.position_tracking)?;
        self.velocity_tracking.checked()?;
        not_negative("wall_margin", self.wall_margin)?;
        if let Some(friendly) = self.friendly {
            not_negative("reaction_time", friendly.reaction_time)?;
            positive("person_deceleration", friendly.deceleration)?;
        }
        if let Some(unseen) = self.unseen {
            unseen.checked().map_err(|error| error.within("unseen"))?;
            if self.person_speed.is_none() {
                let rule = "be given for people who are not seen: no scene tells how fast they are";
                let given = Given::Found("None".into());
                return Err(Failure::invalid("person_speed", rule, given));
            }
        }
        Ok(self)
    }

    /// Margin added to the radius of the robot, in m.
    pub(crate) fn around(&self) -> f64 {
        self.margin + self.position_tracking
    }

    /// Shield with twice the tracking errors.
    fn doubled(&self) -> Self {
        Self {
            position_tracking: 2.0 * self.position_tracking,
            velocity_tracking: self.velocity_tracking.doubled(),
            ..*self
        }
    }

    /// How far a robot was measured to be from a plan at a time of it in s, if that refutes what is assumed:
    /// the plan began where the robot was measured, too.
    #[must_use]
    pub fn refuted(
        &self,
        course: &Course,
        since: f64,
        robot: &RobotState<f64>,
    ) -> Option<Deviation> {
        let velocity = course.velocity(since);
        let most = [
            2.0 * self.margin + self.position_tracking,
            self.velocity_tracking.velocity(velocity.norm()),
        ];
        let found = [
            (robot.position - course.position(since)).norm() - most[0],
            (robot.velocity - velocity).norm() - most[1],
        ];
        let beyond = found.map(|off| if off > OFF_PLAN { off } else { 0.0 });
        let refutes = beyond.iter().any(|off| *off > 0.0);
        refutes.then_some(Deviation {
            position: beyond[0],
            velocity: beyond[1],
        })
    }

    fn grown(&self, person: &Person) -> f64 {
        self.grown_at(person.max_speed)
    }

    /// Addition in m to the radius of a person of a speed in m/s at the end of a plan.
    pub(crate) fn grown_at(&self, speed: f64) -> f64 {
        let way = |friendly: Friendly| friendly.stopping_way(speed);
        self.friendly.map_or(0.0, way)
    }
}

/// Limits of the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShieldLimits {
    /// Radius in m, `rho + m` and the tracking of positions.
    pub radius: f64,
    /// Largest speed in m/s.
    pub max_speed: f64,
    /// Largest acceleration in m/s^2.
    pub max_acceleration: f64,
    /// Control period `T` in s.
    pub period: f64,
}

impl ShieldLimits {
    /// Largest change of velocity in a period, in m/s.
    #[inline]
    #[must_use]
    pub fn change(&self) -> f64 {
        self.max_acceleration * self.period
    }

    /// The velocity shortened to the largest speed.
    #[must_use]
    pub fn slowed(&self, velocity: Vector2<f64>) -> Vector2<f64> {
        let speed = velocity.norm();
        // What is over it by rounding alone the robot itself shortens.
        if speed > self.max_speed * (1.0 + SPEED_ROUNDING) {
            velocity * (self.max_speed / speed)
        } else {
            velocity
        }
    }

    /// The velocity nearest to a wanted one on the straight line to it that is reached within a
    /// period.
    #[must_use]
    pub fn clipped(&self, before: Vector2<f64>, wanted: Vector2<f64>) -> Vector2<f64> {
        let change = wanted - before;
        let length = change.norm();
        if length > self.change() {
            before + change * (self.change() / length)
        } else {
            wanted
        }
    }

    /// Whether a velocity is reached within a period.
    pub(crate) fn reaches(&self, before: Vector2<f64>, velocity: Vector2<f64>) -> bool {
        let within = 1.0 + SPEED_ROUNDING;
        velocity.norm() <= self.max_speed * within
            && (velocity - before).norm() <= self.change() * within
    }

    /// Longest time until rest, and longest way, from any speed up to `speed`: in s and m.
    pub(crate) fn horizon(&self, speed: f64) -> [f64; 2] {
        let fastest = speed.max(self.max_speed);
        let time = (1.0 + braking_periods(fastest, self)) * self.period;
        [time, fastest * time]
    }
}

/// Treatment of a wanted velocity by the shield.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Verified as it was.
    Kept,
    /// Replaced by the nearest verified one.
    Changed,
    /// Nothing is verified: the rest of the last plan is executed.
    Braking,
    /// Nothing obeys the rule of a filter, which a velocity violates as little as possible, or the robot brakes.
    Infeasible,
}

impl Status {
    /// The status in a word.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Kept => "kept",
            Self::Changed => "changed",
            Self::Braking => "braking",
            Self::Infeasible => "infeasible",
        }
    }
}

/// How far a robot was measured to be from its plan, beyond all that is assumed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deviation {
    /// In m; 0 within what is assumed.
    pub position: f64,
    /// In m/s; 0 within what is assumed.
    pub velocity: f64,
}

/// A command, and how it came about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decision {
    /// Velocity at the next sample in m/s.
    pub velocity: Vector2<f64>,
    /// Treatment of the wanted velocity.
    pub status: Status,
}

/// A robot among people and walls, at one instant.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// The robot.
    pub robot: RobotState<f64>,
    /// People.
    pub people: &'a [Person],
    /// Static obstacles.
    pub walls: StaticObstacles<'a>,
    /// People whom nobody sees, if they are reckoned with.
    pub hidden: Option<Hidden<'a>>,
}

/// The shield of one robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guard {
    /// Assumptions of the shield.
    pub shield: Shield,
    /// Limits of the robot, the radius with the margin and the tracking of the shield.
    pub limits: ShieldLimits,
}

impl Guard {
    /// The shield of a robot with limits of its own, whose radius is grown by the margin here.
    ///
    /// # Errors
    /// Names the number that is not allowed.
    pub fn new(shield: Shield, limits: ShieldLimits) -> Result<Self> {
        positive("max_speed", limits.max_speed)?;
        positive("max_acceleration", limits.max_acceleration)?;
        positive("control_period", limits.period)?;
        let radius = positive("radius", limits.radius)? + shield.checked()?.around();
        Ok(Self {
            shield,
            limits: ShieldLimits { radius, ..limits },
        })
    }

    /// The shield of a robot that was measured to be off its plan: it may be as far off again.
    #[must_use]
    pub fn doubled(&self) -> Self {
        let tracking = self.shield.position_tracking;
        Self {
            shield: self.shield.doubled(),
            limits: ShieldLimits {
                radius: self.limits.radius + tracking,
                ..self.limits
            },
        }
    }

    /// Whether a command is verified: reachable, behind all people and off all walls.
    #[must_use]
    pub fn verified(&self, view: &View<'_>, command: Vector2<f64>) -> bool {
        Verifier::new(self, *view).admits(command)
    }

    /// Least distance between the half disc ahead and everywhere that people can be, over the plan
    /// behind a command, in m.
    #[must_use]
    pub fn gap(&self, view: &View<'_>, command: Vector2<f64>) -> f64 {
        let plan = self.plan(&view.robot, command);
        let people = view.people.iter();
        people.fold(f64::INFINITY, |least, person| {
            plan.gap(person, &self.limits, 1e-5, least)
        })
    }

    /// The plan behind a command.
    #[must_use]
    pub fn plan(&self, robot: &RobotState<f64>, command: Vector2<f64>) -> BrakingPlan {
        BrakingPlan::new(robot, command, &self.limits, self.shield.velocity_tracking)
    }

    /// The wanted velocity as far as the robot can take it up.
    #[must_use]
    pub fn clipped(&self, robot: &RobotState<f64>, wanted: Vector2<f64>) -> Vector2<f64> {
        self.limits
            .clipped(robot.velocity, self.limits.slowed(wanted))
    }

    /// People who can be met by any plan; the others need not be looked at.
    fn near<'a>(&self, view: &'a View<'_>) -> impl Iterator<Item = &'a Person> + 'a {
        let [time, way] = self.limits.horizon(view.robot.velocity.norm());
        let (radius, robot) = (self.limits.radius, view.robot.position);
        let grown = self.shield;
        view.people.iter().filter(move |person| {
            let touch = radius + grown.grown(person) + person.reach(time) + way;
            person.placed.distance(robot) <= touch + 1e-3
        })
    }

    /// The verified velocity nearest to the wanted one.
    #[must_use]
    pub fn decide(&self, view: &View<'_>, wanted: Vector2<f64>) -> Decision {
        let wanted = self.clipped(&view.robot, wanted);
        let mut verifier = Verifier::new(self, *view);
        if verifier.admits(wanted) {
            return Decision {
                velocity: wanted,
                status: Status::Kept,
            };
        }
        let near: Vec<Person> = self.near(view).copied().collect();
        let mut verifier = verifier.among(&near);
        self.nearest(view, wanted, |velocity| verifier.admits(velocity))
    }

    /// The admitted velocity nearest to one that the robot can take up and that is not admitted.
    fn nearest(
        &self,
        view: &View<'_>,
        wanted: Vector2<f64>,
        admits: impl FnMut(Vector2<f64>) -> bool,
    ) -> Decision {
        self.project(admits, view, wanted).map_or_else(
            || Decision {
                velocity: braking(view.robot.velocity, &self.limits),
                status: Status::Braking,
            },
            |velocity| Decision {
                velocity,
                status: Status::Changed,
            },
        )
    }

    /// The velocity nearest to the wanted one that somebody else admits of those that the robot can take up.
    #[must_use]
    pub fn decide_by(
        &self,
        view: &View<'_>,
        wanted: Vector2<f64>,
        mut admits: impl FnMut(Vector2<f64>) -> bool,
    ) -> Decision {
        let wanted = self.clipped(&view.robot, wanted);
        if admits(wanted) {
            return Decision {
                velocity: wanted,
                status: Status::Kept,
            };
        }
        let before = view.robot.velocity;
        self.nearest(view, wanted, |velocity| {
            self.limits.reaches(before, velocity) && admits(velocity)
        })
    }

    /// From where the search takes angles: from the direction of slowing down, toward the side on which
    /// people are, or walls where there is nobody. Where both sides are alike the left one comes first.
    fn frame(&self, view: &View<'_>, wanted: Vector2<f64>) -> search::SearchFrame {
        let before = view.robot.velocity;
        let away = before - wanted;
        let slower = if wanted.norm() > RESTING * away.norm() {
            -wanted
        } else {
            away
        };
        let length = slower.norm();
        let axis = if length > 0.0 {
            slower / length
        } else {
            Vector2::x()
        };
        let (mut left, mut all) = (0.0, 0.0);
        for person in view.people {
            let offset = person.placed.center - view.robot.position;
            let square = offset.norm_squared().max(f64::MIN_POSITIVE);
            // Who is near counts most.
            left += axis.perp(&offset) / square;
            all += square.sqrt().recip();
        }
        let beside = Vector2::new(-axis.y, axis.x) * self.limits.radius;
        let room = |place| view.walls.clearance_up_to(place, FARTHEST);
        if left.abs() <= ALIKE * all && !view.walls.is_empty() {
            let place = view.robot.position;
            (left, all) = (room(place - beside) - room(place + beside), beside.norm());
        }
        search::SearchFrame::new(axis, left >= -ALIKE * all)
    }

    /// The verified velocity nearest to one that is reachable but not verified.
    fn project(
        &self,
        mut admits: impl FnMut(Vector2<f64>) -> bool,
        view: &View<'_>,
        wanted: Vector2<f64>,
    ) -> Option<Vector2<f64>> {
        let before = view.robot.velocity;
        let tried = SHARES.iter().map(|share| wanted * *share);
        let creep = self.shield.unseen.map_or(0.0, |unseen| unseen.creep_speed);
        let creep = (creep > 0.0).then(|| wanted * (creep / wanted.norm().max(creep)));
        let tried = tried
            .chain([before, braking(before, &self.limits)])
            .chain(creep);
        let mut first: Option<(f64, Vector2<f64>)> = None;
        for velocity in tried {
            let distance = (velocity - wanted).norm();
            let nearer = first.is_none_or(|(least, _)| distance < least);
            if nearer && admits(velocity) {
                first = Some((distance, velocity));
            }
        }
        let farthest = (wanted - before).norm() + self.limits.change();
        search::nearest(
            self.frame(view, wanted),
            wanted,
            farthest,
            first.map(|(_, velocity)| velocity),
            admits,
        )
    }
}

#[cfg(test)]
mod tests;
