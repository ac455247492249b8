//! People whom nobody sees, before a plan: nobody of them may come ahead of the robot until it rests.

use navigation_world::world::map::StaticMap;
use numeric::lanes::Vector2;
use std::f64::consts::FRAC_1_SQRT_2;
use unknown_places::unseen::{Arrivals, Unseen};

/// A speed above another one by less than this share is that speed.
const ROUNDING: f64 = 1e-9;

/// When people whom nobody sees can be where.
#[derive(Clone, Copy, Debug)]
pub struct Hidden<'a> {
    /// When somebody can be in the cells around the robot.
    pub arrivals: &'a Arrivals,
    /// Walls, through which nobody touches.
    pub map: &'a StaticMap,
    /// Assumptions about them.
    pub unseen: &'a Unseen,
    /// Age of the latest scan in s when the command takes effect.
    pub latency: f64,
    /// Addition of their stopping way to their radius at the end of a plan, in m.
    pub grown: f64,
}

/// The robot around an instant of its plan.
#[derive(Clone, Copy, Debug)]
pub(super) struct HiddenInstant {
    /// In s.
    pub time: f64,
    /// Time in s to either side that it stands for.
    pub half: f64,
    /// Position in m.
    pub position: Vector2<f64>,
    /// How far from there the robot can be within that time, in m.
    pub way: f64,
    /// Radius of the robot in m, with all that is added to it.
    pub radius: f64,
}

impl Hidden<'_> {
    /// Whether a plan whose largest speed in m/s is given need not reckon with them.
    pub(super) fn lets_creep(&self, speed: f64) -> bool {
        speed <= self.unseen.creep_speed * (1.0 + ROUNDING)
    }

    /// Whether nobody comes ahead of the robot around an instant; `ahead`: how far ahead an offset lies, in m.
    pub(super) fn is_clear(&self, at: &HiddenInstant, ahead: impl Fn(Vector2<f64>) -> f64) -> bool {
        let half = self.unseen.cell * FRAC_1_SQRT_2;
        let reach = at.radius + self.unseen.person_radius + half + at.way;
        let until = self.latency + at.time + at.half;
        self.arrivals
            .nobody_near(at.position, reach, until, |cell| {
                ahead(cell - at.position) >= -(half + at.way) && self.touches(cell, at.position)
            })
    }

    /// Whether somebody in a cell can touch a robot at a place: no wall is between the place and all of the cell.
    fn touches(&self, cell: Vector2<f64>, place: Vector2<f64>) -> bool {
        let half = 0.5 * self.unseen.cell;
        let corners = [
            [0.0, 0.0],
            [-half, -half],
            [half, -half],
            [half, half],
            [-half, half],
        ];
        let mut ways = corners
            .into_iter()
            .map(|corner| cell + Vector2::from(corner));
        ways.any(|from| self.map.segment_clearance(from, place) > 0.0)
    }
}
