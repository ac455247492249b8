//! Distances and contacts of a pursued robot with an outline.

use super::PursuitParts;
use crate::run::outcome::{CONTACT_SPEED, DECIDED_OVERLAP};
use navigation_world::world::footprint::{Footprint, PassingWay, first_closed, turned};
use navigation_world::world::frame::Frame;
use navigation_world::world::geometry::Body;
use numeric::lanes::Vector2;

impl PursuitParts<'_> {
    /// Distance of an outline from the maps after the motion step from a place, zero where it touched them in it, in m.
    pub(super) fn outline_off_walls(&self, outline: &Footprint, from: Vector2<f64>) -> f64 {
        let (to, turn) = (self.reading.robot.position, turned(self.headings));
        let gap = |share: f64| {
            let place = from + (to - from) * share;
            let pose = Frame::at(place.into(), self.headings[0] + turn * share);
            self.maps.outline_clearance(outline, &pose, f64::INFINITY)
        };
        let most = (to - from).norm() + turn.abs() * outline.outer_radius();
        match first_closed(most, gap) {
            Some(_) => 0.0,
            None => gap(1.0),
        }
    }

    /// Takes down what comes of an obstacle of a robot with an outline, which was seen from it as given before.
    pub(super) fn look_at_outline(
        &mut self,
        index: usize,
        body: &Body,
        before: Vector2<f64>,
        from: Vector2<f64>,
    ) {
        let Some(outline) = self.scenario.footprint.as_deref() else {
            return;
        };
        let robot = self.reading.robot.position;
        let way = PassingWay {
            offsets: [-before, Vector2::from(body.state.position) - robot],
            headings: self.headings,
            shape: body.shape,
        };
        let motion = ((robot - from) / self.step, self.step);
        let met = way.contact(outline, motion, DECIDED_OVERLAP);
        let clearance = way.gap(outline, 1.0);
        let gap = met.map_or(clearance, |_| clearance.min(0.0));
        self.found.least = self.found.least.min(gap);
        let ends = met.map(|met| met.speeds);
        let speeds = ends.unwrap_or_else(|| [way.speeds(outline, motion, 1.0); 2]);
        let followed = &mut self.followed[index];
        if followed.decided {
            return;
        }
        followed.decided = met.is_some_and(|met| met.deep);
        let moves = speeds.iter().any(|[speed, _]| *speed > CONTACT_SPEED);
        if met.is_some() && !followed.touched {
            followed.touched = true;
            let counts = &mut self.found.contacts;
            *match (moves, speeds[0][1] > 0.0) {
                (true, true) => &mut counts.toward,
                (true, false) => &mut counts.away,
                (false, _) => &mut counts.standing,
            } += 1;
        }
        let gap = gap.max(-DECIDED_OVERLAP);
        for [speed, toward] in speeds {
            if toward > 0.0 {
                self.found.least_ahead = self.found.least_ahead.min(gap);
                if speed > CONTACT_SPEED {
                    self.found.least_toward = self.found.least_toward.min(gap);
                }
            }
        }
    }
}
