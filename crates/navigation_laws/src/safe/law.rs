//! Safe navigation at work on one robot.

use crate::filters::{Filter, FilterStatus, Filtered, Sighted};
use crate::foresight::Foreseer;
use crate::guide::{Detour, Guidance, LocalGoal, RobotRoom, Takeover};
use crate::safe::settings::SafeNavigation;
use crate::safe::surroundings::Surroundings;
use crate::safe::watch::Watch;
use crate::shield::{
    BodyCommand, Course, Decision, Deviation, Guard, OutlineGuard, ShieldLimits, Status,
    TwistGuard, TwistState, TwistView, Verifier, View, braking_periods,
};
use crate::trace::{Examined, Trace};
use crate::yielding::{Outlook, Yielder};
use crate::{Command, Law, Situation, Unwatched};
use navigation_world::robots::differential::{DifferentialLimits, Twist};
use navigation_world::robots::drives::velocity_of;
use navigation_world::world::geometry::RobotState;
use navigation_world::world::scenario::Scenario;
use numeric::error::{Failure, Given, Result};
use numeric::lanes::Vector2;

/// A velocity beyond a limit by less than this share of it is within: the robot shortens it itself.
const ROUNDING: f64 = 1e-9;

/// Parts of a plan between the instants that are told.
const PARTS_OF_PLAN: u32 = 24;

/// A law with its parts.
pub struct SafeLaw {
    law: Box<dyn Law<f64>>,
    filter: Option<Filter>,
    max_turn_rate: f64,
    pub(super) guard: Option<Guard>,
    /// The shield of a robot with two wheels.
    twist_guard: Option<TwistGuard>,
    /// Verifies for a robot that is no disc.
    outline: Option<OutlineGuard>,
    /// The plan that the robot executes: it was verified, or nothing was and it brakes.
    course: Option<Course>,
    yielder: Option<Yielder>,
    foreseer: Option<Foreseer>,
    pub(super) guidance: Option<Guidance>,
    /// When a guide without a map leads around who stands.
    pub(super) detour: Option<Detour>,
    /// When the robot heads for its (local) goal by itself.
    takeover: Option<Takeover>,
    pub(super) limits: ShieldLimits,
    /// Largest speed of the law in m/s.
    preferred: f64,
    mass: f64,
    pub(super) goal: Vector2<f64>,
    /// Goal that moves, in place of that of the plan while it is seen.
    pub(super) moving: Option<Vector2<f64>>,
    /// Way of the guide to the goal, for laws that ask for it.
    way: Vec<Vector2<f64>>,
    pub(super) around: Surroundings,
    /// People whom nobody sees, if they are reckoned with.
    pub(super) watch: Option<Watch>,
    /// State of the robot as measured in the last control period.
    measured: RobotState<f64>,
    trace: Trace,
}

/// The robot as its plan has it at the time, from which every plan starts, or as it was measured where there is none
/// or a measurement refutes it.
#[derive(Clone, Copy, Debug)]
struct Present {
    robot: RobotState<f64>,
    turn_rate: f64,
    /// Time of the plan in s; `None` where it was measured.
    since: Option<f64>,
    off: Option<Deviation>,
}

/// Where the robot is to go now.
#[derive(Clone, Copy, Debug)]
struct Destination {
    /// The goal or a local one; `None` where the plan leads nowhere.
    local: Option<LocalGoal>,
    taken_over: bool,
}

impl SafeLaw {
    /// The law at work in a scenario; `record`: the Lyapunov function is wanted too.
    pub(super) fn new(
        family: &SafeNavigation,
        gains: &[f64],
        scenario: &Scenario,
        record: bool,
    ) -> Result<Self> {
        let inner = family.inner(scenario)?;
        let robot = &scenario.robot;
        let wheels = scenario.differential.as_ref();
        let limits = ShieldLimits {
            radius: robot.radius,
            max_speed: wheels.map_or(robot.max_speed, |wheels| wheels.max_speed),
            max_acceleration: robot.guaranteed_acceleration(),
            period: scenario.rules.control_period,
        };
        let zero = Vector2::zeros();
        let twist_guard = family.shield.zip(wheels).map(|(shield, wheels)| {
            TwistGuard::new(shield, DifferentialLimits::from(wheels), &limits)
        });
        let unseen = family.shield.is_some_and(|shield| shield.unseen.is_some());
        if scenario.footprint.is_some() && unseen {
            let rule =
                "be left out for a robot with a footprint, whose turns its plans do not verify";
            let given = Given::Found("unseen".into());
            return Err(Failure::invalid("unseen", rule, given)
                .mended_by("give the disc around the robot as its radius"));
        }
        let outlined = family.shield.zip(scenario.footprint.clone());
        let outline = outlined.map(|(shield, outline)| OutlineGuard {
            shield,
            outline,
            wheels: wheels.is_some(),
        });
        let twist_guard = twist_guard.transpose()?;
        // Without a shield nothing verifies the outline beside walls.
        let room = match &outline {
            Some(_) => RobotRoom::from(scenario),
            None => robot.radius.into(),
        };
        let [_, way] = horizon(&limits, twist_guard.as_ref(), 0.0);
        let watch = Watch::new(family, scenario, way)?;
        let pace = watch.as_ref().and_then(|watch| watch.pace(&limits));
        let guidance = family.guidance(scenario, pace)?;
        let mapped = guidance.is_some() && family.map.is_some();
        let rule = family.rule.rule(mapped, inner.robot.max_speed);
        Ok(Self {
            watch,
            outline,
            twist_guard,
            course: None,
            filter: family.filter_for(scenario)?,
            max_turn_rate: wheels
                .map_or(0.0, |wheels| DifferentialLimits::from(wheels).max_turn_rate),
            guard: family
                .shield
                .map(|shield| Guard::new(shield, limits))
                .transpose()?,
            yielder: family
                .yielding
                .map(|yielding| Yielder::new(yielding, limits))
                .transpose()?,
            foreseer: family
                .foresight
                .map(|foresight| Foreseer::new(foresight, limits, inner.robot.max_speed, room))
                .transpose()?,
            takeover: family.takeover.then(|| Takeover::new(rule)),
            detour: (guidance.is_some() && !mapped).then(Detour::default),
            guidance,
            limits,
            preferred: inner.robot.max_speed,
            mass: robot.mass,
            goal: scenario.goal.into(),
            moving: None,
            way: Vec::new(),
            around: Surroundings::new(family, &inner),
            law: family.law.at_work(gains, &inner, record)?,
            measured: RobotState {
                position: scenario.start.into(),
                velocity: zero,
            },
            trace: Trace {
                wanted: zero,
                command: zero,
                taken_over: false,
                status: Status::Kept,
                course: None,
                off_plan: None,
                shield: family.shield,
            },
        })
    }
}

impl Law<f64> for SafeLaw {
    fn thinks(&self) -> bool {
        true
    }

    fn command(&mut self, situation: &Situation<'_, f64>) -> Command<f64> {
        self.set_period(situation.interval);
        let Some(mut watch) = self.watch.take() else {
            return self.command_among(situation);
        };
        let speed = situation.robot.velocity.norm();
        let until = horizon(&self.limits, self.twist_guard.as_ref(), speed);
        let radius = self
            .guard
            .map_or(self.limits.radius, |guard| guard.doubled().limits.radius);
        let bodies = watch.look(situation, until, radius).to_vec();
        self.watch = Some(watch);
        self.command_among(&Situation {
            bodies: &bodies,
            ..*situation
        })
    }

    /// Heads for another goal from now on; with a guide in a map it keeps to its plan while it does not see that goal.
    fn aim(&mut self, goal: [f64; 2]) {
        if self.guidance.is_some() && self.detour.is_none() {
            self.moving = Some(goal.into());
        } else {
            self.goal = goal.into();
            self.law.aim(goal);
        }
    }

    fn can_aim(&self) -> bool {
        self.foreseer.is_some() || self.law.can_aim()
    }

    fn trace(&self) -> Option<Trace> {
        Some(self.trace)
    }

    fn unseen(&self) -> Option<Unwatched<'_>> {
        self.watch.as_ref().map(Watch::unwatched)
    }

    fn examined(&self) -> Option<Examined> {
        let plain = self.twist_guard.is_none() && self.outline.is_none();
        let guard = self.guard.filter(|_| plain)?;
        let (robot, command) = (self.measured, self.trace.command);
        let plan = guard.plan(&robot, command);
        let share = |part: u32| f64::from(part) / f64::from(PARTS_OF_PLAN);
        let instants = (0..=PARTS_OF_PLAN).map(|part| plan.end() * share(part));
        let time: Vec<f64> = instants.collect();
        let view = View {
            robot,
            people: &self.around.people,
            walls: self.around.walls(),
            hidden: self.watch.as_ref().map(Watch::hidden),
        };
        Some(Examined {
            margin: guard.gap(&view, command),
            position: time.iter().map(|at| plan.position(*at).into()).collect(),
            reach: self.around.reaches(plan.end()),
            foreseen: self.foreseer.as_ref().map(Foreseer::foreseen),
            time,
        })
    }
}

impl SafeLaw {
    /// Command among obstacles that are seen.
    fn command_among(&mut self, situation: &Situation<'_, f64>) -> Command<f64> {
        self.around
            .look(situation, self.guard.as_ref(), self.yielder.as_ref());
        let heading = self.head(situation);
        let (robot, now) = (situation.robot, self.now(situation));
        self.measured = robot;
        if let (Some(local), Some(guidance)) = (heading.local, &self.guidance) {
            self.law.aim(local.for_law(robot.position).into());
            if self.law.follows() {
                // Straight where the goal itself is ahead: one that moves, or one that no plan leads to.
                self.way.clear();
                if !local.is_goal {
                    guidance.lead(robot.position, &mut self.way);
                }
                self.law.lead(&self.way);
            }
        }
        // Foresight has no use for what the law wants.
        let command = if self.foreseer.is_some() {
            Command::plain(Vector2::zeros())
        } else {
            self.law.command(&Situation {
                bodies: &self.around.bodies,
                ..*situation
            })
        };
        let asked = robot.velocity + command.force * (situation.interval / self.mass);
        let mut wanted = slowed(asked, self.preferred);
        match heading.local {
            None => wanted = Vector2::zeros(),
            Some(local) if heading.taken_over => {
                let (most, acceleration) = (self.preferred, self.limits.max_acceleration);
                let period = situation.interval;
                wanted = local.velocity_from(robot.position, most, acceleration, period);
            }
            Some(_) => {}
        }
        let to_goal = heading.local.map_or(self.goal, |local| local.point) - robot.position;
        let mut foreseer = self.foreseer.take();
        let decision = match self.twist_guard {
            Some(guard) => self.turn(
                &guard,
                situation,
                &now,
                &mut wanted,
                to_goal,
                foreseer.as_mut(),
            ),
            None => self.decide(situation, &now, &mut wanted, to_goal, foreseer.as_mut()),
        };
        self.foreseer = foreseer;
        let decision = self.filtered(situation, wanted, decision);
        self.trace = Trace {
            wanted,
            command: decision.velocity,
            taken_over: heading.taken_over,
            status: decision.status,
            course: self.course,
            off_plan: now.off,
            ..self.trace
        };
        let turned =
            self.twist_guard.is_some() || (self.filter.is_some() && decision.velocity != asked);
        let own = turned || self.foreseer.is_some();
        let kept = decision.status == Status::Kept && wanted == asked && !own;
        if kept || self.lets_through(&heading) {
            return command;
        }
        let change = decision.velocity - robot.velocity;
        Command::plain(change * (self.mass / situation.interval))
    }

    /// Whether no part has a say in what the law commands: the robot itself keeps to its limits, and does what it does
    /// under the law alone.
    fn lets_through(&self, heading: &Destination) -> bool {
        let parts = self.guard.is_some()
            || self.yielder.is_some()
            || self.foreseer.is_some()
            || self.filter.is_some();
        let law_heads = heading.local.is_some() && !heading.taken_over;
        !parts && law_heads && self.preferred >= self.limits.max_speed
    }

    /// Filtered velocity, of the wanted one or of the one that gives way.
    fn filtered(
        &self,
        situation: &Situation<'_, f64>,
        wanted: Vector2<f64>,
        given_way: Decision,
    ) -> Decision {
        let Some(filter) = self.filter else {
            return given_way;
        };
        let gives_way = self.yielder.is_some() || self.foreseer.is_some();
        let wanted = if gives_way {
            given_way.velocity
        } else {
            wanted
        };
        let RobotState { position, velocity } = situation.robot;
        let seen = Sighted {
            position,
            velocity,
            heading: situation.heading,
            radius: self.limits.radius,
            max_speed: self.limits.max_speed,
            max_acceleration: Some(self.limits.max_acceleration),
            max_turn_rate: self.max_turn_rate,
            period: situation.interval,
            people: &self.around.near,
            points: &self.around.nearest_points,
        };
        let found = if let Filter::BarrierUnicycle(rule) = filter {
            let (sin, cos) = situation.heading.sin_cos();
            let speed = wanted.dot(&Vector2::new(cos, sin));
            let turn_rate = wanted.dot(&Vector2::new(-sin, cos)) / rule.ahead;
            let found = rule.filter(&seen, [speed, turn_rate]);
            let twist = Twist {
                speed: found.velocity.x,
                turn_rate: found.velocity.y,
            };
            let velocity = velocity_of(twist, situation.heading, situation.interval);
            Filtered { velocity, ..found }
        } else {
            filter.decide(&seen, wanted, 0.0)
        };
        let status = match found.status {
            FilterStatus::Kept if gives_way => given_way.status,
            FilterStatus::Kept => Status::Kept,
            FilterStatus::Changed => Status::Changed,
            FilterStatus::Infeasible | FilterStatus::Touching | FilterStatus::Stopped => {
                Status::Infeasible
            }
        };
        Decision {
            velocity: found.velocity,
            status,
        }
    }

    /// Where the force is not held, it acts for a motion step only.
    fn set_period(&mut self, period: f64) {
        self.limits.period = period;
        if let Some(guard) = &mut self.guard {
            guard.limits.period = period;
        }
        if let Some(guard) = &mut self.twist_guard {
            guard.limits.period = period;
        }
        if let Some(yielder) = &mut self.yielder {
            yielder.limits.period = period;
        }
        if let Some(foreseer) = &mut self.foreseer {
            foreseer.limits.period = period;
        }
    }

    /// The (local) goal, and whether the robot heads for it by itself.
    fn head(&mut self, situation: &Situation<'_, f64>) -> Destination {
        let (time, position) = (situation.time, situation.robot.position);
        let mut again = false;
        if let Some(guidance) = &mut self.guidance {
            let people = self.around.standing(situation.bodies);
            again = guidance.observe(time, position, people);
        }
        let Some(guidance) = self.guidance.as_ref().filter(|_| self.detour.is_none()) else {
            return self.head_without_map(time, position);
        };
        let seen = |goal: &Vector2<f64>| guidance.plan().sees(position, *goal);
        if let Some(goal) = self.moving.filter(seen) {
            return Destination {
                local: Some(LocalGoal::goal(goal)),
                taken_over: false,
            };
        }
        let found = guidance.local_goal(position);
        let mut heading = Destination {
            local: found.map(|(_, local)| local),
            taken_over: false,
        };
        if let Some(takeover) = &mut self.takeover {
            if again {
                takeover.restart();
            }
            let cost = found.map(|(view, _)| view.cost);
            if takeover.observe(time, cost) {
                let plan = guidance.plan();
                let sees = |point| plan.sees(position, point);
                heading.taken_over = true;
                heading.local = takeover.target(heading.local, sees);
            }
        }
        heading
    }

    /// The goal itself; where the robot is stuck behind others who stand, the way around them.
    fn head_without_map(&mut self, time: f64, position: Vector2<f64>) -> Destination {
        let around = self
            .detour
            .as_mut()
            .zip(self.guidance.as_ref())
            .and_then(|(detour, guidance)| detour.observe(time, position, guidance));
        let cost = (self.goal - position).norm();
        let takeover = self.takeover.as_mut();
        Destination {
            local: around.or(Some(LocalGoal::goal(self.goal))),
            taken_over: takeover.is_some_and(|takeover| takeover.observe(time, Some(cost))),
        }
    }

    /// The velocity of yielding, if it is on and something is verified.
    fn give_way(
        &self,
        robot: &RobotState<f64>,
        wanted: Vector2<f64>,
        to_goal: Vector2<f64>,
        verified: impl FnMut(Vector2<f64>) -> bool,
    ) -> Option<Vector2<f64>> {
        let outlook = Outlook {
            robot: *robot,
            wanted,
            to_goal: to_goal / to_goal.norm().max(f64::MIN_POSITIVE),
            people: &self.around.passersby,
            left_out: false,
            walls: self.around.walls(),
        };
        self.yielder.as_ref()?.decide(&outlook, verified)
    }

    /// The robot at the time: where it was measured, with the velocity of its plan.
    fn now(&self, situation: &Situation<'_, f64>) -> Present {
        let measured = Present {
            robot: situation.robot,
            turn_rate: 0.0,
            since: None,
            off: None,
        };
        let Some((guard, course)) = self.guard.as_ref().zip(self.course) else {
            return measured;
        };
        let since = course.since(situation.time);
        if since < 0.0 {
            return measured;
        }
        let turn_rate = course.twist(since).map_or(0.0, |twist| twist.turn_rate);
        let off = guard.shield.refuted(&course, since, &situation.robot);
        if off.is_some() {
            return Present {
                turn_rate,
                off,
                ..measured
            };
        }
        Present {
            robot: RobotState {
                velocity: course.velocity(since),
                ..situation.robot
            },
            turn_rate,
            since: Some(since),
            off,
        }
    }

    /// Verifier of a robot that is no disc; one that is off its plan may be as far off again.
    fn outline_now(&self, now: &Present) -> Option<OutlineGuard> {
        let outline = self.outline.as_ref()?;
        Some(if now.off.is_some() {
            outline.doubled()
        } else {
            outline.clone()
        })
    }

    /// Yielding, then the shield, for a robot with two wheels.
    fn turn(
        &mut self,
        guard: &TwistGuard,
        situation: &Situation<'_, f64>,
        now: &Present,
        wanted: &mut Vector2<f64>,
        to_goal: Vector2<f64>,
        foreseer: Option<&mut Foreseer>,
    ) -> Decision {
        let guard = if now.off.is_some() {
            guard.doubled()
        } else {
            *guard
        };
        let (robot, heading) = (now.robot, situation.heading);
        let planned = now.since.zip(self.course);
        let (sin, cos) = heading.sin_cos();
        let measured = Twist {
            speed: robot.velocity.dot(&Vector2::new(cos, sin)),
            turn_rate: now.turn_rate,
        };
        let state = TwistState {
            position: robot.position,
            heading,
            twist: planned.map_or(measured, |(since, course)| {
                course.twist(since).unwrap_or(measured)
            }),
        };
        let view = TwistView {
            robot: state,
            people: &self.around.people,
            walls: self.around.walls(),
            hidden: self.watch.as_ref().map(Watch::hidden),
        };
        let outline = self.outline_now(now);
        let (mut twist, status) = match foreseer {
            Some(foreseer) => {
                self.foreseen_twist(foreseer, (&guard, outline.as_ref()), &view, wanted, to_goal)
            }
            None => self.turned((&guard, outline.as_ref()), &view, &robot, *wanted, to_goal),
        };
        match planned {
            Some((since, course)) if status == Status::Braking => {
                // The plan runs on as it was verified.
                twist = course.twist(since + course.period()).unwrap_or_default();
            }
            _ => {
                let begun = situation.time;
                self.course = Some(Course::of_twist(begun, &state, twist, &guard.limits));
            }
        }
        Decision {
            velocity: velocity_of(twist, heading, situation.interval),
            status,
        }
    }

    /// Yielding, then the shield.
    fn decide(
        &mut self,
        situation: &Situation<'_, f64>,
        now: &Present,
        wanted: &mut Vector2<f64>,
        to_goal: Vector2<f64>,
        foreseer: Option<&mut Foreseer>,
    ) -> Decision {
        let robot = &now.robot;
        let guard = self.guard.map(|guard| {
            if now.off.is_some() {
                guard.doubled()
            } else {
                guard
            }
        });
        let outline = self.outline_now(now);
        let outline = outline.as_ref().map(|outline| (outline, situation.heading));
        let mut decision = match foreseer {
            Some(foreseer) => {
                self.foreseen(foreseer, (guard.as_ref(), outline), robot, wanted, to_goal)
            }
            None => self.judged((guard.as_ref(), outline), robot, *wanted, to_goal),
        };
        if guard.is_none() {
            return decision;
        }
        let planned = now.since.zip(self.course);
        match planned {
            Some((since, course)) if decision.status == Status::Braking => {
                // The plan runs on as it was verified.
                decision.velocity = course.rates(since + course.period());
            }
            _ => {
                if now.off.is_some() && decision.status == Status::Braking {
                    let rest = Vector2::zeros();
                    decision.velocity = self.limits.clipped(robot.velocity, rest);
                }
                let command = decision.velocity;
                let begun = situation.time;
                self.course = Some(Course::of_velocity(begun, robot, command, &self.limits));
            }
        }
        decision
    }

    /// Yielding and shield for a wanted velocity of a robot with two wheels.
    fn turned(
        &self,
        (guard, outline): (&TwistGuard, Option<&OutlineGuard>),
        view: &TwistView<'_>,
        robot: &RobotState<f64>,
        wanted: Vector2<f64>,
        to_goal: Vector2<f64>,
    ) -> (Twist, Status) {
        let state = &view.robot;
        let kept = self
            .limits
            .clipped(robot.velocity, self.limits.slowed(wanted));
        // It drives backwards only to give way.
        let twist = |velocity: Vector2<f64>| guard.toward(state, velocity, velocity != kept);
        let verified = |twist: Twist| verified_twist((guard, outline), view, twist);
        match self.give_way(robot, wanted, to_goal, |velocity| verified(twist(velocity))) {
            Some(velocity) if velocity == kept => (twist(velocity), Status::Kept),
            Some(velocity) => (twist(velocity), Status::Changed),
            None => {
                let wish = guard.toward(state, self.limits.slowed(wanted), false);
                guard.decide_by(state, wish, verified)
            }
        }
    }

    /// Command of yielding and shield for a wanted velocity.
    fn judged(
        &self,
        (guard, outline): (Option<&Guard>, Option<(&OutlineGuard, f64)>),
        robot: &RobotState<f64>,
        wanted: Vector2<f64>,
        to_goal: Vector2<f64>,
    ) -> Decision {
        let walls = self.around.walls();
        let view = View {
            robot: *robot,
            people: &self.around.people,
            walls,
            hidden: self.watch.as_ref().map(Watch::hidden),
        };
        let kept = self
            .limits
            .clipped(robot.velocity, self.limits.slowed(wanted));
        let verifier = guard.filter(|_| self.yielder.is_some() && outline.is_none());
        let mut verifier = verifier.map(|guard| Verifier::new(guard, view));
        let verified = |velocity: Vector2<f64>| {
            if let Some(outline) = outline {
                return self.limits.reaches(robot.velocity, velocity)
                    && self.verified_outline(outline, &view, velocity);
            }
            let verifier = verifier.as_mut();
            verifier.is_none_or(|verifier| verifier.admits(velocity))
        };
        if let Some(velocity) = self.give_way(robot, wanted, to_goal, verified) {
            let status = if velocity == kept {
                Status::Kept
            } else {
                Status::Changed
            };
            return Decision { velocity, status };
        }
        if let Some((guard, outline)) = guard.zip(outline) {
            return guard.decide_by(&view, wanted, |velocity| {
                self.verified_outline(outline, &view, velocity)
            });
        }
        match guard {
            Some(guard) => guard.decide(&view, wanted),
            None => Decision {
                velocity: kept,
                status: Status::Kept,
            },
        }
    }

    /// Whether a velocity is verified for the outline of a robot that keeps its heading in rad.
    pub(super) fn verified_outline(
        &self,
        (outline, heading): (&OutlineGuard, f64),
        view: &View<'_>,
        velocity: Vector2<f64>,
    ) -> bool {
        let period = self.limits.period;
        let braking = braking_periods(velocity.norm(), &self.limits) * period;
        let times = [period, braking];
        let command = BodyCommand::of_velocity(&view.robot, heading, velocity, times);
        outline.verified(&command, view.people, &view.walls)
    }
}

/// Whether a twist is verified, for the outline of the robot where it is no disc.
pub(super) fn verified_twist(
    (guard, outline): (&TwistGuard, Option<&OutlineGuard>),
    view: &TwistView<'_>,
    twist: Twist,
) -> bool {
    let Some(outline) = outline else {
        return guard.verified(view, twist);
    };
    let period = guard.limits.period;
    let times = [period, period * guard.limits.braking_periods(twist)];
    let command = BodyCommand::of_twist(&view.robot, twist, times);
    outline.verified(&command, view.people, &view.walls)
}

/// Longest time in s and way in m until a robot of a speed in m/s rests, whatever it is told next.
fn horizon(limits: &ShieldLimits, wheels: Option<&TwistGuard>, speed: f64) -> [f64; 2] {
    let plain = limits.horizon(speed);
    let Some(guard) = wheels else {
        return plain;
    };
    let drive = &guard.limits.drive;
    let fastest = Twist {
        speed: speed.max(drive.max_speed),
        turn_rate: drive.max_turn_rate,
    };
    let time = (1.0 + guard.limits.braking_periods(fastest)) * limits.period;
    [time.max(plain[0]), (time * fastest.speed).max(plain[1])]
}

/// A velocity shortened to a largest speed.
fn slowed(velocity: Vector2<f64>, most: f64) -> Vector2<f64> {
    let speed = velocity.norm();
    if speed > most * (1.0 + ROUNDING) {
        velocity * (most / speed)
    } else {
        velocity
    }
}
