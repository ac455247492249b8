//! A robot that is no disc, as it is observed: exact distances from its outline, also between instants.

use navigation_world::world::footprint::{Footprint, first_closed, turned};
use navigation_world::world::frame::Frame;
use navigation_world::world::shape::PlacedShape;
use numeric::lanes::Vector2;

use crate::crowd::walls::Wall;

type Point = Vector2<f64>;

/// Outline of a robot, and its heading at every instant in rad.
#[derive(Clone, Copy, Debug)]
pub struct ObservedBody<'a> {
    /// Outline in coordinates of the body.
    pub outline: &'a Footprint,
    /// Headings in rad.
    pub headings: &'a [f64],
}

impl ObservedBody<'_> {
    fn frame(&self, instant: usize, share: f64) -> Frame {
        let next = (instant + 1).min(self.headings.len() - 1);
        let turn = turned([self.headings[instant], self.headings[next]]);
        Frame::at([0.0; 2], self.headings[instant] + share * turn)
    }

    /// Distance of a place, given from the robot, from the outline at an instant in m; negative inside.
    #[must_use]
    pub fn distance(&self, instant: usize, place: Point) -> f64 {
        let frame = self.frame(instant, 0.0);
        self.outline.signed_distance(frame.inward(place))
    }

    /// Most that a point of the outline moves by turning in the step from an instant, in m.
    fn swing(&self, instant: usize) -> f64 {
        let next = (instant + 1).min(self.headings.len() - 1);
        let turn = turned([self.headings[instant], self.headings[next]]);
        turn.abs() * self.outline.outer_radius()
    }

    /// Whether a disc of a radius in m, that moves between two places given from the robot, touches the outline in the step
    /// from an instant.
    #[must_use]
    pub fn meets(&self, instant: usize, [from, to]: [Point; 2], radius: f64) -> bool {
        let most = (to - from).norm() + self.swing(instant);
        let gap = |share: f64| {
            let place = self
                .frame(instant, share)
                .inward(from + (to - from) * share);
            self.outline.signed_distance(place) - radius
        };
        first_closed(most, gap).is_some()
    }

    /// Direction of a place given from the robot, outward of the outline at an instant, and the velocity in m/s that
    /// turning in a step of `step` s gives to the nearest point of the outline.
    #[must_use]
    pub fn toward(&self, instant: usize, place: Point, step: f64) -> [Point; 2] {
        let frame = self.frame(instant, 0.0);
        let nearest = self
            .outline
            .separation(&frame, &PlacedShape::disc(place.into(), 0.0));
        let next = (instant + 1).min(self.headings.len() - 1);
        let rate = turned([self.headings[instant], self.headings[next]]) / step;
        let arm = frame.outward(nearest.place);
        let turning = Point::new(-arm.y, arm.x) * rate;
        [frame.outward(nearest.outward), turning]
    }

    /// Least distance from a wall in m in the step to an instant that began at a place, at its end, or zero where it is
    /// touched before; negative inside.
    #[must_use]
    pub fn gap_on_way(&self, wall: &Wall, instant: usize, [from, to]: [Point; 2]) -> f64 {
        let before = instant.saturating_sub(1);
        let at = |share: f64| {
            let mut frame = self.frame(before, share);
            frame.position = from + (to - from) * share;
            self.gap(wall, &frame)
        };
        let mut last = self.frame(instant, 0.0);
        last.position = to;
        let gap = self.gap(wall, &last);
        let most = (to - from).norm() + self.swing(before);
        if instant == 0 || gap <= 0.0 || first_closed(most, at).is_none() {
            gap
        } else {
            // Touched on the way only.
            -f64::MIN_POSITIVE
        }
    }

    fn gap(&self, wall: &Wall, pose: &Frame) -> f64 {
        match wall {
            Wall::Polyline(points) => points
                .windows(2)
                .map(|ends| {
                    let wall = PlacedShape::wall(ends[0].into(), ends[1].into());
                    self.outline.separation(pose, &wall).distance
                })
                .fold(f64::INFINITY, f64::min),
            Wall::Solid(shape) => self.outline.separation(pose, shape).distance,
        }
    }
}
