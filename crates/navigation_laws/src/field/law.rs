//! Virtual force field with a stabilizing force: attraction, repulsion, detour and braking.

use crate::field::attractive::attractive_force;
use crate::field::detour::Turning;
use crate::field::gains::{GainLanes, Gains};
use crate::field::lyapunov;
use crate::field::repulsive::Repulsion;
use crate::field::side::{self, DetourSide, SideRules};
use crate::field::stabilizing::{Dissipation, Dissipative, Stabilizing};
use crate::field::terms::{FieldTerms, ObstacleTerms};
use crate::{Command, LaneFamily, LaneLaw, Law, LawFamily, Situation};
use navigation_world::world::geometry::{Approach, Body, Offset, RobotState};
use navigation_world::world::scenario::{PlacedObstacle, Scenario};
use numeric::error::{Failure, Given, Result, not_negative};
use numeric::lanes::{Mask, Planar, Real, Truth, Vector2};

/// The law of Zeng (2011), chapter 5: gains and options.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VirtualForceField {
    /// Gains.
    pub gains: Gains,
    /// Mode of the stabilizing force.
    pub stabilizing: Stabilizing,
    /// Rules for the side of detours.
    pub rules: SideRules,
}

impl VirtualForceField {
    /// Checks gains and hysteresis.
    ///
    /// # Errors
    /// Names the value that is not allowed.
    pub fn new(gains: Gains, stabilizing: Stabilizing, rules: SideRules) -> Result<Self> {
        gains.checked()?;
        let angle = rules.hysteresis;
        if angle != f64::INFINITY && !(0.0..std::f64::consts::PI).contains(&angle) {
            let rule = "be an angle from 0 to below pi";
            return Err(Failure::invalid(
                "side_hysteresis",
                rule,
                Given::Number(angle),
            ));
        }
        Ok(Self {
            gains,
            stabilizing,
            rules,
        })
    }
}

impl LawFamily for VirtualForceField {
    fn gain_names(&self) -> &'static [&'static str] {
        &[
            "attractive_gain",
            "repulsive_gain",
            "detour_gain",
            "gain_ratio",
        ]
    }

    fn gains(&self) -> Vec<f64> {
        self.gains.in_order().to_vec()
    }

    fn free_gains(&self) -> &'static [usize] {
        &[0, 3]
    }

    fn terms(&self, scenario: &Scenario, situation: &Situation<'_, f64>) -> Option<FieldTerms> {
        let gains = GainLanes::<f64>::gather(self.gains, &[]);
        Some(ForceFieldLaw::<f64, true>::new(self, gains, scenario).terms(situation))
    }

    fn keeps_to_regions(&self) -> bool {
        // The stabilizing force acts on the sum of the obstacles, so on none outside.
        true
    }

    fn check_gains(&self, gains: &[f64]) -> Result<()> {
        for (name, gain) in self.gain_names().iter().zip(gains) {
            not_negative(name, *gain)?;
        }
        Ok(())
    }

    fn at_work(
        &self,
        gains: &[f64],
        scenario: &Scenario,
        record: bool,
    ) -> Result<Box<dyn Law<f64>>> {
        Ok(if record {
            Box::new(self.with_gains::<f64, true>(gains, scenario)?)
        } else {
            Box::new(self.with_gains::<f64, false>(gains, scenario)?)
        })
    }
}

impl LaneFamily for VirtualForceField {
    const LYAPUNOV: bool = true;

    type Law<R: Real, const RECORD: bool> = ForceFieldLaw<R, RECORD>;

    fn with_gains<R: Real, const RECORD: bool>(
        &self,
        gains: &[R],
        scenario: &Scenario,
    ) -> Result<ForceFieldLaw<R, RECORD>> {
        Ok(ForceFieldLaw::new(self, GainLanes::of(gains), scenario))
    }

    fn enter<R: Real, const RECORD: bool>(
        &self,
        law: &mut ForceFieldLaw<R, RECORD>,
        lane: usize,
        gains: &[R],
        scenario: &Scenario,
    ) -> Result<()> {
        law.gains = GainLanes::of(gains);
        law.goal.set_lane(lane, scenario.goal);
        let count = law.latched.len().max(scenario.obstacles.len());
        law.latched.resize(count, R::zero());
        for side in &mut law.latched {
            side.set(lane, 0.0);
        }
        Ok(())
    }
}

/// Which lanes an obstacle concerns.
struct NearLanes<R: Real> {
    offset: Offset<R>,
    active: R::Mask,
    critical: R::Mask,
}

impl<R: Real> NearLanes<R> {
    #[inline(always)]
    fn new(body: &Body<R>, robot: &RobotState<R>) -> Self {
        let offset = body.offset(robot.position);
        let (r2, r3) = (body.regions.active_radius, body.regions.critical_radius);
        let here = body.state.present;
        let active = offset.distance_squared.lt(r2 * r2) & here;
        let critical = offset.distance_squared.le(r3 * r3) & here;
        Self {
            offset,
            active,
            critical,
        }
    }
}

/// Forces and geometry of one obstacle in one evaluation.
#[derive(Clone, Copy, Debug)]
struct ObstacleForces<R: Real> {
    index: usize,
    approach: Approach<R>,
    side: R,
    detour: DetourSide<R>,
    turning: Turning<R>,
    repulsion: Repulsion<R>,
    repulsive: Vector2<R>,
    detouring: Vector2<R>,
}

/// The law at work on robots side by side. `RECORD`: the Lyapunov function is wanted too.
#[derive(Clone, Debug)]
pub struct ForceFieldLaw<R: Real, const RECORD: bool> {
    gains: GainLanes<R>,
    stabilizing: Stabilizing,
    rules: SideRules,
    goal: Vector2<R>,
    mass: f64,
    max_deceleration: f64,
    control_period: f64,
    /// Side of each obstacle at the sample before, 0 outside its active region.
    latched: Vec<R>,
    slots: Vec<ObstacleForces<R>>,
    dissipation: Dissipation<R>,
}

impl<R: Real, const RECORD: bool> ForceFieldLaw<R, RECORD> {
    /// The law for one scenario.
    #[must_use]
    pub fn new(law: &VirtualForceField, gains: GainLanes<R>, scenario: &Scenario) -> Self {
        let count = scenario.obstacles.len();
        Self {
            gains,
            stabilizing: law.stabilizing,
            rules: law.rules,
            goal: Vector2::splat(scenario.goal),
            mass: scenario.robot.mass,
            max_deceleration: scenario.robot.deceleration(),
            control_period: scenario.rules.control_period,
            latched: vec![R::zero(); count],
            slots: Vec::new(),
            dissipation: Dissipation::zero(),
        }
    }

    /// Adds repulsion and detour of every obstacle to a sum, and Omega where the stabilizing force
    /// asks for it; tells the lanes inside a critical region. False if a side hangs on the other
    /// obstacles; the sums are void then.
    #[inline(always)]
    fn add_up(
        &mut self,
        situation: &Situation<'_, R>,
        total: &mut Vector2<R>,
        critical: &mut R::Mask,
    ) -> bool {
        let robot = &situation.robot;
        let stabilizes = self.stabilizing != Stabilizing::Off;
        let state = self.dissipative(robot);
        let mut dissipation = Dissipation::zero();
        for body in situation.bodies {
            let near = NearLanes::new(body, robot);
            if !near.active.any() {
                continue;
            }
            *critical = *critical | near.critical;
            let approach = Approach::new(body, near.offset, near.active, robot, self.goal);
            let side = side::decide(&self.rules, body, &approach, robot, self.goal);
            let open = near.active & side.abs().lt(R::splat(0.5));
            if open.any() {
                return false;
            }
            let detour = side::latch(&self.rules, &approach, side, R::zero());
            let repulsion = Repulsion::new(&approach);
            let turning = Turning::new(&approach, &detour);
            let repulsive = repulsion.force(&self.gains, &approach);
            let detouring = turning.force(&self.gains, &approach);
            let both = *total + (repulsive + detouring);
            *total = Vector2::select(near.active, both, *total);
            if stabilizes {
                let seen = (&approach, &repulsion, &turning, &detour);
                dissipation.add(&self.gains, &state, body, seen);
            }
        }
        if stabilizes {
            self.dissipation = dissipation;
        }
        true
    }

    /// Sum like [`Self::add_up`], with the sides of every rule and the terms kept in the slots.
    #[inline(always)]
    fn sum_in_full(&mut self, situation: &Situation<'_, R>) -> (Vector2<R>, R::Mask) {
        let critical = self.fill_slots(situation);
        self.break_ties();
        // Without a stabilizing force only a record of the terms shows Omega.
        let dissipates = RECORD || self.stabilizing != Stabilizing::Off;
        let robot = self.dissipative(&situation.robot);
        let mut total = Vector2::zeros();
        self.dissipation = Dissipation::zero();
        if self.rules.hysteresis.is_finite() {
            self.latched.fill(R::zero());
        }
        for slot in &mut self.slots {
            let latched = &mut self.latched[slot.index];
            let both = total + (slot.repulsive + slot.detouring);
            total = Vector2::select(slot.approach.active, both, total);
            *latched = R::select(slot.approach.active, slot.detour.side, R::zero());
            if dissipates {
                let seen = (&slot.approach, &slot.repulsion, &slot.turning, &slot.detour);
                self.dissipation
                    .add(&self.gains, &robot, &situation.bodies[slot.index], seen);
            }
        }
        (total, critical)
    }

    #[inline(always)]
    fn fill_slots(&mut self, situation: &Situation<'_, R>) -> R::Mask {
        let mut critical = R::Mask::none();
        self.slots.clear();
        for (index, body) in situation.bodies.iter().enumerate() {
            let robot = &situation.robot;
            let near = NearLanes::new(body, robot);
            if !near.active.any() {
                continue;
            }
            critical = critical | near.critical;
            let approach = Approach::new(body, near.offset, near.active, robot, self.goal);
            let side = side::decide(&self.rules, body, &approach, robot, self.goal);
            let detour = side::latch(&self.rules, &approach, side, self.latched[index]);
            let repulsion = Repulsion::new(&approach);
            let turning = Turning::new(&approach, &detour);
            self.slots.push(ObstacleForces {
                index,
                approach,
                side: detour.side,
                detour,
                turning,
                repulsion,
                repulsive: repulsion.force(&self.gains, &approach),
                detouring: turning.force(&self.gains, &approach),
            });
        }
        critical
    }

    /// Decides the sides left open, in the order of the list.
    #[inline(always)]
    fn break_ties(&mut self) {
        let half = R::splat(0.5);
        let open = |slot: &ObstacleForces<R>| slot.approach.active & slot.side.abs().lt(half);
        if !self.slots.iter().any(|slot| open(slot).any()) {
            return;
        }
        let mut others = Vector2::zeros();
        let mut magnitudes = R::zero();
        for slot in &self.slots {
            let decided = slot.approach.active & half.lt(slot.side.abs());
            let force = slot.detouring;
            others = Vector2::select(decided, others + force, others);
            let longer = magnitudes + force.dot(&force).sqrt();
            magnitudes = R::select(decided, longer, magnitudes);
        }
        for slot in &mut self.slots {
            let tied = open(slot);
            if !tied.any() {
                continue;
            }
            let chosen = side::tie_break(slot.approach.outward, others, magnitudes);
            slot.side = R::select(tied, chosen, slot.side);
            let detour = side::latch(&self.rules, &slot.approach, slot.side, R::zero());
            slot.detour.side = R::select(tied, detour.side, slot.detour.side);
            slot.detour.turn = R::select(tied, detour.turn, slot.detour.turn);
            // Neither way round is shorter: the chosen one counts as the shortest.
            slot.detour.descent = R::select(tied, R::splat(1.0), slot.detour.descent);
            slot.turning = Turning::new(&slot.approach, &slot.detour);
            slot.detouring = slot.turning.force(&self.gains, &slot.approach);
            let force = slot.detouring;
            others = Vector2::select(tied, others + force, others);
            magnitudes = R::select(tied, magnitudes + force.dot(&force).sqrt(), magnitudes);
        }
    }

    #[inline(always)]
    fn dissipative(&self, robot: &RobotState<R>) -> Dissipative<R> {
        let to_goal = self.goal - robot.position;
        Dissipative {
            mass: self.mass,
            to_goal,
            velocity: robot.velocity,
        }
    }

    /// Braking along `-V` with `min(d_max, |V|/interval)`, which never reverses the robot.
    #[inline(always)]
    fn braking(&self, velocity: Vector2<R>, interval: f64) -> Vector2<R> {
        let speed = velocity.dot(&velocity).sqrt();
        let deceleration = (speed / R::splat(interval)).min(R::splat(self.max_deceleration));
        let force = velocity * (R::splat(-self.mass) * deceleration / speed);
        Vector2::select(speed.gt(R::zero()), force, Vector2::zeros())
    }

    /// Lyapunov function of the slots of the last full evaluation.
    #[inline(always)]
    fn lyapunov(&self, robot: &RobotState<R>) -> R {
        let to_goal = self.goal - robot.position;
        let mut value = lyapunov::free_part(&self.gains, self.mass, to_goal, robot.velocity);
        for slot in &self.slots {
            let (approach, repulsion, turning) = (&slot.approach, &slot.repulsion, &slot.turning);
            let part =
                lyapunov::obstacle_part(&self.gains, self.mass, approach, repulsion, turning);
            value = R::select(approach.active, value + part, value);
        }
        value
    }
}

impl<R: Real, const RECORD: bool> LaneLaw<R> for ForceFieldLaw<R, RECORD> {
    fn is_told_of_all(&self) -> bool {
        self.rules.hysteresis.is_finite()
    }
}

impl<R: Real, const RECORD: bool> Law<R> for ForceFieldLaw<R, RECORD> {
    #[inline(always)]
    fn command(&mut self, situation: &Situation<'_, R>) -> Command<R> {
        let robot = &situation.robot;
        let stabilizes = self.stabilizing != Stabilizing::Off;
        let remembers = self.rules.hysteresis.is_finite();
        let (mut obstacles, mut critical) = (Vector2::zeros(), R::Mask::none());
        if RECORD || remembers || !self.add_up(situation, &mut obstacles, &mut critical) {
            (obstacles, critical) = self.sum_in_full(situation);
        }
        let attraction = attractive_force(&self.gains, self.goal - robot.position, robot.velocity);
        let mut command = Command {
            force: attraction + obstacles,
            stabilizing: Vector2::zeros(),
            lyapunov: R::splat(f64::NAN),
        };
        if stabilizes {
            let state = self.dissipative(robot);
            let period = self.control_period;
            let force = self
                .dissipation
                .force(self.stabilizing, &self.gains, &state, period);
            command.stabilizing = Vector2::select(critical, Vector2::zeros(), force);
            command.force += force;
        }
        if critical.any() {
            let braking = self.braking(robot.velocity, situation.interval);
            command.force = Vector2::select(critical, braking, command.force);
        }
        if RECORD {
            let value = self.lyapunov(robot);
            command.lyapunov = R::select(critical, R::splat(f64::NAN), value);
        }
        command
    }

    fn felt_within(&self, obstacle: &PlacedObstacle) -> f64 {
        if self.rules.hysteresis.is_finite() {
            return f64::INFINITY;
        }
        obstacle.regions.active_radius
    }

    fn aim(&mut self, goal: [f64; 2]) {
        self.goal = Vector2::splat(goal);
    }
}

impl ForceFieldLaw<f64, true> {
    /// Every term of one evaluation.
    pub fn terms(&mut self, situation: &Situation<'_, f64>) -> FieldTerms {
        let command = self.command(situation);
        let robot = &situation.robot;
        let mut terms = FieldTerms::without_force(situation.bodies, robot.position);
        terms.stabilizing = command.stabilizing.lane(0);
        terms.total = command.force.lane(0);
        if terms.are_critical() {
            return terms;
        }
        terms.omega = self.dissipation.omega;
        terms.attractive =
            attractive_force(&self.gains, self.goal - robot.position, robot.velocity).lane(0);
        for slot in &self.slots {
            terms.obstacles[slot.index] = ObstacleTerms {
                repulsive: slot.repulsive.lane(0),
                detour: slot.detouring.lane(0),
                region: "active",
                side: if slot.side > 0.0 { 1 } else { -1 },
            };
        }
        let direction = self.dissipation.direction(&self.gains, robot.velocity);
        // dV2/dt = -b |v_L|^2 - v_L.F_L + Omega (5.5.6).
        let derivative = -self.gains.ratio * direction.dot(&direction)
            - direction.dot(&command.stabilizing)
            + self.dissipation.omega;
        terms.lyapunov = Some((command.lyapunov, derivative));
        terms
    }
}
