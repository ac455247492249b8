//! Velocities at which a rule of selection can have its optimum, and the lines on which they lie.

use super::best::{OWN, Place};
use super::lines::{Line, Reachable, where_circles_meet};
use super::{Selection, Vector, VelocityObstaclePlanner};
use crate::lanes::Planar;
use crate::laws::Situation;

impl VelocityObstaclePlanner {
    /// Draws the lines from standstill on which a rule of selection can have its optimum.
    pub(super) fn draw_lines(&mut self, aim: Vector) {
        let lines = &mut self.ahead;
        lines.clear();
        let mut ahead = |along| {
            let from = Vector::zeros();
            lines.push(Line { from, along });
        };
        ahead(aim);
        if let Selection::Fastest { sector } = self.settings.selection {
            let (sine, cosine) = sector.sin_cos();
            for side in [sine, -sine] {
                ahead(aim * cosine + aim.left_normal() * side);
            }
        }
    }

    /// How many places there are for lines on which a rule of selection can have its optimum: the left and the right
    /// leg of every cone, then the others.
    pub(super) fn line_count(&self) -> usize {
        2 * self.cones.len() + self.ahead.len()
    }

    /// The line at a place; none where a cone has no legs.
    #[inline]
    pub(super) fn line(&self, place: usize) -> Option<Line> {
        let Some(cone) = self.cones.get(place / 2) else {
            return self.ahead.get(place - 2 * self.cones.len()).copied();
        };
        let legs = cone.legs.as_ref()?;
        let along = if place.is_multiple_of(2) {
            legs.left
        } else {
            legs.right
        };
        let from = cone.tip;
        Some(Line { from, along })
    }

    /// The same with no numbers where there is none.
    #[inline]
    pub(super) fn line_or_none(&self, place: usize) -> Line {
        let none = Vector::new(f64::NAN, f64::NAN);
        self.line(place).unwrap_or(Line {
            from: none,
            along: none,
        })
    }

    /// All lines with their places.
    pub(super) fn lines(&self) -> impl Iterator<Item = (usize, Line)> {
        let places = 0..self.line_count();
        places.filter_map(|place| Some((place, self.line(place)?)))
    }

    /// Whether lines count behind the points that they begin at. Where only cones forbid anything, at any time, and
    /// a component of the velocity is wanted, the best velocity is where legs meet, or where one meets a limit;
    /// elsewhere crossings are samples of what other limits leave.
    #[inline]
    pub(super) fn takes_whole_lines(&self) -> bool {
        self.always_takes_whole_lines() || !self.close.is_empty()
    }

    /// The same whatever is near.
    #[inline]
    pub(super) fn always_takes_whole_lines(&self) -> bool {
        self.settings.selection != Selection::ToGoal || self.settings.horizon < f64::INFINITY
    }

    /// Whether a velocity on two lines counts as their crossing.
    #[inline]
    pub(super) fn meet(&self, one: &Line, other: &Line, velocity: Vector) -> bool {
        self.takes_whole_lines() || (one.is_ahead(velocity) && other.is_ahead(velocity))
    }

    /// The velocity that reaches the goal soonest, if nothing is in between.
    pub(super) fn wanted(&self, situation: &Situation<'_, f64>, aim: Vector) -> Vector {
        let to_goal = self.goal - situation.robot.position;
        let soonest = to_goal.dot(&to_goal).sqrt() / situation.interval;
        aim * self.max_speed.min(soonest)
    }

    /// Velocities that may be the best without being on a line: what is wanted, what is driven, rest.
    pub(super) fn first_candidates(
        &self,
        situation: &Situation<'_, f64>,
        aim: Vector,
    ) -> [Vector; 3] {
        let wanted = self.wanted(situation, aim);
        [wanted, situation.robot.velocity, Vector::zeros()]
    }

    /// The farthest reachable velocities toward the goal, and where both limits meet.
    pub(super) fn last_candidates(
        reachable: &Reachable,
        aim: Vector,
    ) -> impl Iterator<Item = Vector> {
        let farthest = reachable
            .circles()
            .map(|(center, radius)| center + aim * radius);
        let meet = where_circles_meet(reachable).into_iter().flatten();
        farthest.into_iter().chain(meet)
    }

    /// Every velocity at which a rule of selection can have its optimum.
    pub(super) fn candidates(&self, situation: &Situation<'_, f64>) -> Vec<Vector> {
        let reachable = self.reachable(situation);
        let aim = self.direction_to_goal(situation);
        let wanted = self.wanted(situation, aim);
        let mut found = self.first_candidates(situation, aim).to_vec();
        let lines: Vec<Line> = self.lines().map(|(_, line)| line).collect();
        for (index, line) in lines.iter().enumerate() {
            if reachable.chord(line).is_none() {
                continue;
            }
            found.extend(line.own(wanted, &reachable).into_iter().flatten());
            let crossings = lines[..index].iter();
            found.extend(crossings.filter_map(|other| line.crossing(other)));
        }
        found.extend(Self::last_candidates(&reachable, aim));
        found
    }

    /// The velocity at a place, if that is on a line.
    pub(super) fn candidate(
        &self,
        (line, number): Place,
        wanted: Vector,
        reachable: &Reachable,
    ) -> Option<Vector> {
        let line = self.line(line.checked_sub(1)?)?;
        match number.checked_sub(OWN) {
            None => line.own(wanted, reachable)[number],
            Some(other) => {
                let other = self.line(other)?;
                let velocity = line.crossing(&other)?;
                self.meet(&line, &other, velocity).then_some(velocity)
            }
        }
    }
}
