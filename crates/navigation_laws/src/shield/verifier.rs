//! Many commands of one instant: what they share is computed once.

use crate::shield::person::Person;
use crate::shield::{Guard, View, walls};
use numeric::lanes::Vector2;

/// Verifies the commands that are tried at one instant.
#[derive(Clone, Copy, Debug)]
pub struct Verifier<'a> {
    guard: &'a Guard,
    view: View<'a>,
    /// Clearance that is kept from walls in m; `None` without any.
    kept: Option<f64>,
    /// Index of who forbade a command last: he is asked first.
    suspect: usize,
}

impl<'a> Verifier<'a> {
    /// Of a robot at an instant.
    #[inline]
    #[must_use]
    pub fn new(guard: &'a Guard, view: View<'a>) -> Self {
        let kept = (!view.walls.is_empty()).then(|| {
            let radius = guard.limits.radius - guard.shield.around();
            let kept = radius + guard.shield.wall_margin;
            // The whole way keeps this distance from walls, or the present one if that is less.
            view.walls.clearance_up_to(view.robot.position, kept) - walls::ROUNDING
        });
        Self {
            guard,
            view,
            kept,
            suspect: 0,
        }
    }

    /// Verifier with fewer people.
    pub(super) fn among<'b>(&self, people: &'b [Person]) -> Verifier<'b>
    where
        'a: 'b,
    {
        Verifier {
            view: View {
                people,
                ..self.view
            },
            suspect: 0,
            ..*self
        }
    }

    /// Whether a command is verified: reachable, behind all people and off all walls.
    #[must_use]
    pub fn admits(&mut self, command: Vector2<f64>) -> bool {
        let (limits, robot) = (&self.guard.limits, &self.view.robot);
        if !limits.reaches(robot.velocity, command) {
            return false;
        }
        let plan = self.guard.plan(robot, command);
        let shield = &self.guard.shield;
        let avoids = |person: &Person| plan.avoids(person, limits, shield.grown(person));
        let people = self.view.people;
        let meets = |who: &Person| plan.is_met_at_end(who, limits) || !avoids(who);
        if people.get(self.suspect).is_some_and(meets) {
            return false;
        }
        if let Some(index) = people.iter().position(|person| !avoids(person)) {
            self.suspect = index;
            return false;
        }
        let off_walls = self.kept.is_none_or(|kept| {
            let apart = |([from, to], deviation): ([Vector2<f64>; 2], f64)| {
                self.view.walls.segment_keeps(from, to, kept + deviation)
            };
            plan.chords().all(apart)
        });
        let hidden = self.view.hidden.as_ref();
        off_walls && hidden.is_none_or(|hidden| plan.avoids_hidden(hidden, limits.radius))
    }
}
