//! Which velocities matter for some control periods, so that runs need not tell of obstacles that can forbid
//! none of them.

use super::lines::{Cap, Reachable};
use super::{Vector, VelocityObstaclePlanner};
use crate::laws::Situation;
use crate::laws::outlook::{Attention, Outlook};

/// Fewest and most control periods for which the obstacles are chosen.
const PERIODS: (f64, f64) = (8.0, 64.0);

/// Least and largest room around the velocities that mattered last, as shares of the largest speed.
const ROOM: (f64, f64) = (4e-3, 0.25);

/// By how much the room grows where it was too small, and shrinks where it was not.
const GROWTH: (f64, f64) = (2.0, 0.25);

/// Least room as a share of the radius of the disc that holds the velocities that mattered last.
const SHARE: f64 = 0.2;

/// By how much the time for which the obstacles are chosen shrinks where the room was too small, and grows where it
/// was not.
const LONGER: (f64, f64) = (0.5, 2.0);

/// How far off its way the robot may be, as a share of the distance that it keeps.
const OFF: f64 = 0.1;

/// Most decisions in a row that mattered on others before all reachable velocities are taken to matter.
const MOST_MISSES: u32 = 8;

/// Room for rounding, relative: well above all roundings.
const ROUNDING: f64 = 1e-6;

/// What a planner is told of.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct View {
    /// Velocities that all obstacles are known for, and since when, in s; all velocities where there is
    /// none.
    outlook: Option<(Outlook, f64)>,
    /// Those that mattered last.
    last: Option<Cap>,
    /// Room around them, in m/s, and for how many control periods the obstacles are chosen.
    room: f64,
    periods: f64,
    /// How often the last decision mattered on others.
    missed: u32,
    /// Whether obstacles behind the robot counted in the last decision.
    behind: bool,
}

impl View {
    /// Whether all obstacles are known for velocities that matter.
    pub fn holds(&self, cap: &Cap, reachable: &Reachable) -> bool {
        let Some((outlook, _)) = &self.outlook else {
            return true;
        };
        let within = |center: Vector, radius: f64| {
            let wide = radius * (1.0 + ROUNDING) + ROUNDING * ROUNDING;
            (center - outlook.center).norm() + wide <= outlook.radius
        };
        let circles = reachable.circles();
        within(cap.center, cap.radius)
            || circles
                .iter()
                .any(|(center, radius)| within(*center, *radius))
    }

    /// Notes the velocities that mattered, and whether all obstacles were known for them.
    pub fn note(&mut self, cap: Cap, told: bool) {
        self.last = Some(cap);
        self.missed = if told { 0 } else { self.missed + 1 };
    }

    /// Begins a decision; one that is made again keeps what it lacked before.
    pub fn begin(&mut self) {
        self.behind &= self.missed > 0;
    }

    /// Whether obstacles behind the robot were left out, which count in this decision: it must be made again.
    pub fn lacks_those_behind(&mut self) -> bool {
        self.behind = true;
        let lacking = self.outlook.is_some_and(|(outlook, _)| !outlook.behind);
        self.missed += u32::from(lacking);
        lacking
    }

    /// Whether the last decision counts for nothing.
    pub fn misses(&self) -> bool {
        self.missed > 0
    }

    /// Whether the robot is where it was to be, not too late.
    fn is_valid(&self, time: f64, place: Vector) -> bool {
        let Some((outlook, begin)) = &self.outlook else {
            return false;
        };
        let passed = time - begin;
        let way = place - outlook.place - outlook.center * passed;
        passed <= outlook.span && way.norm() <= outlook.off
    }

    /// Another room: larger after a miss; else the obstacles are chosen for longer.
    fn adapt(&mut self, max_speed: f64) {
        let (least, most) = (ROOM.0 * max_speed, ROOM.1 * max_speed);
        let growth = if self.missed > 0 { GROWTH.0 } else { GROWTH.1 };
        self.room = (self.room * growth).clamp(least, most);
        let longer = if self.missed > 0 { LONGER.0 } else { LONGER.1 };
        self.periods = (self.periods * longer).clamp(PERIODS.0, PERIODS.1);
    }
}

impl VelocityObstaclePlanner {
    /// Which obstacles matter for the velocities that may be chosen in the next control periods.
    pub(super) fn look_out(&mut self, situation: &Situation<'_, f64>) -> Attention {
        let (robot, period) = (&situation.robot, situation.interval);
        let ahead = (1.0 - self.settings.ramp) * period;
        let place = robot.position + robot.velocity * ahead;
        if robot.velocity.norm() > self.max_speed * (1.0 + ROUNDING) {
            self.view.outlook = None;
            return Attention::All;
        }
        if self.view.missed == 0 && self.view.is_valid(situation.time, place) {
            return Attention::Same;
        }
        self.view.adapt(self.max_speed);
        let Cap { center, radius } = self.expected(situation);
        let span = self.view.periods * period;
        let clearance = self.robot_radius + self.settings.margin;
        // The way in a control period, for what is touched within it.
        let change = self.max_acceleration * period;
        let way = (2.0 * self.max_speed + change) * period * (1.0 + ROUNDING);
        let outlook = Outlook {
            center,
            radius,
            place,
            off: OFF * clearance + (robot.velocity - center).norm() * span,
            ahead,
            span,
            clearance: clearance + ROUNDING,
            way,
            haste: 2.0 * period,
            behind: self.view.behind || self.always_takes_whole_lines(),
        };
        self.view.outlook = Some((outlook, situation.time));
        Attention::Within(outlook)
    }

    /// Velocities that are expected to matter; after many misses all that are reachable.
    fn expected(&self, situation: &Situation<'_, f64>) -> Cap {
        let room = self.view.room;
        if self.view.missed < MOST_MISSES {
            let Cap { center, radius } = self
                .view
                .last
                .unwrap_or_else(|| self.first_guess(situation));
            return Cap {
                center,
                radius: radius + room.max(SHARE * radius),
            };
        }
        let [one, other] = self.reachable(situation).circles();
        let (center, radius) = if one.1 < other.1 { one } else { other };
        let radius = radius * (1.0 + 4.0 * ROUNDING) + ROUNDING;
        Cap { center, radius }
    }

    /// The velocity nearest to what is wanted.
    fn first_guess(&self, situation: &Situation<'_, f64>) -> Cap {
        let velocity = situation.robot.velocity;
        let wanted = self.wanted(situation, self.direction_to_goal(situation));
        let way = wanted - velocity;
        let change = self.max_acceleration * situation.interval;
        let share = (change / way.norm()).min(1.0);
        Cap {
            center: velocity + way * share,
            radius: 0.0,
        }
    }
}
