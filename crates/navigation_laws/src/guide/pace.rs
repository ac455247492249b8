//! Speeds that people whom nobody sees leave a robot on its way.

use nalgebra::Vector2;
use std::sync::{Arc, OnceLock};

use crate::guide::nodes::{LINKS, Nodes};
use unknown_places::map::walk_while;
use unknown_places::unseen::Ground;

/// A way is at most so many times dearer where the robot has to be slow.
const DEAREST: f64 = 20.0;

/// People who appear farther away are taken to appear there, in m.
const FARTHEST: f64 = 4.0;

/// Beams that tell what is seen from a node.
const BEAMS: u32 = 360;

/// How many times dearer ways are at the nodes, against each link, as far as they were asked for.
type Factors = Vec<OnceLock<Box<[f64; 16]>>>;

/// How fast a robot is that expects somebody behind every corner.
#[derive(Clone, Debug)]
pub struct Pace {
    /// Cells of the place.
    pub ground: Arc<Ground>,
    /// Distance in m at which somebody may be who appears while the robot rests.
    pub apart: f64,
    /// Largest speed of people in m/s.
    pub person_speed: f64,
    /// Largest speed of the robot in m/s.
    pub max_speed: f64,
    /// Its deceleration in m/s^2.
    pub deceleration: f64,
    /// Control period in s.
    pub period: f64,
    /// How many times dearer ways are at the nodes of a guide, as far as they were asked for; plans that are made anew share
    /// them.
    pub known: Arc<OnceLock<Factors>>,
}

impl Pace {
    /// Speed in m/s at which it comes to rest before somebody who appears so far away, in m, is near.
    #[must_use]
    pub fn speed(&self, away: f64) -> f64 {
        let room = (away - self.apart).max(0.0);
        let slope = self.person_speed / self.deceleration + self.period;
        let root = (slope * slope + 2.0 * room / self.deceleration).sqrt();
        (self.deceleration * (root - slope)).min(self.max_speed)
    }

    /// Distance in m from which on nobody who appears slows the robot down.
    fn enough(&self) -> f64 {
        let slope = self.person_speed / self.deceleration + self.period;
        self.apart + self.max_speed * (self.max_speed / (2.0 * self.deceleration) + slope)
    }

    /// How many times dearer it is at a node of a guide to go against a link.
    pub(super) fn factor(&self, nodes: &Nodes, node: usize, link: usize) -> f64 {
        let made = || (0..nodes.count()).map(|_| OnceLock::new()).collect();
        let make = || Box::new(self.factors(nodes.place(node)));
        match self.known.get_or_init(made).get(node) {
            Some(known) => known.get_or_init(make)[link],
            None => make()[link],
        }
    }

    /// How many times dearer a way is at a place, against the direction of each link.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // cells around a place
    fn factors(&self, place: Vector2<f64>) -> [f64; 16] {
        let ground = &*self.ground;
        let (enough, middle) = (self.enough(), ground.in_cells(place));
        let farthest = enough.min(FARTHEST);
        let reach = farthest / ground.cell();
        let wide = reach.ceil() as i64 + 2;
        let first = middle.map(|axis| axis.floor() as i64 - wide);
        let side = 2 * wide + 1;
        let mut seen = vec![false; (side * side) as usize];
        let mut cells = Vec::new();
        let index = |[column, row]: [i64; 2]| {
            let [column, row] = [column - first[0], row - first[1]];
            let within = column >= 0 && row >= 0 && column < side && row < side;
            within.then_some((row * side + column) as usize)
        };
        for beam in 0..BEAMS {
            let (sin, cos) = (f64::from(beam) * std::f64::consts::TAU / f64::from(BEAMS)).sin_cos();
            let end = [
                middle[0] + cos * (reach + 1.0),
                middle[1] + sin * (reach + 1.0),
            ];
            walk_while(middle, end, |cell| {
                let free = ground
                    .cell_at(cell)
                    .is_some_and(|cell| !ground.occupied().contains(cell));
                if let (true, Some(place)) = (free, index(cell))
                    && !std::mem::replace(&mut seen[place], true)
                {
                    cells.push(cell);
                }
                free
            });
        }
        let mut nearest = [f64::INFINITY; 16];
        let beside = |[column, row]: [i64; 2]| {
            [[-1, 0], [1, 0], [0, -1], [0, 1]].map(|[x, y]| [column + x, row + y])
        };
        for cell in cells.into_iter().flat_map(beside) {
            let hidden = index(cell).is_some_and(|place| !seen[place])
                && ground
                    .cell_at(cell)
                    .is_some_and(|cell| ground.walkable().contains(cell));
            if !hidden {
                continue;
            }
            let offset = [0, 1].map(|axis| cell[axis] as f64 + 0.5 - middle[axis]);
            let away = offset[0].hypot(offset[1]) * ground.cell();
            for (least, (x, y, _)) in nearest.iter_mut().zip(LINKS) {
                // Ways lead to the goal, from which the links are searched.
                if offset[0] * x as f64 + offset[1] * y as f64 <= 0.0 {
                    *least = least.min(away);
                }
            }
        }
        nearest.map(|away| {
            let away = away.min(farthest);
            if away >= enough {
                1.0
            } else {
                (self.max_speed / self.speed(away)).min(DEAREST)
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use navigation_world::world::map::MapShapes;

    #[test]
    fn a_way_into_an_opening_is_dear_and_one_away_from_it_is_not() {
        let mut shapes = MapShapes::new();
        shapes.polyline(&[[-5.0, -1.0], [5.0, -1.0]], 0.05).unwrap();
        shapes
            .polyline(&[[-5.0, 1.0], [0.0, 1.0], [0.0, 4.0]], 0.05)
            .unwrap();
        shapes
            .polyline(&[[1.0, 4.0], [1.0, 1.0], [5.0, 1.0]], 0.05)
            .unwrap();
        let bounds = [[-5.0, -1.5], [5.0, 4.5]];
        let pace = Pace {
            ground: Arc::new(Ground::of_map(&shapes.map(), bounds, 0.05, 0.15).unwrap()),
            apart: 0.7,
            person_speed: 1.6,
            max_speed: 1.2,
            deceleration: 2.0,
            period: 0.05,
            known: Arc::default(),
        };
        // The first link leads in +x: its way comes from there, and the third one the other way.
        let before = pace.factors(Vector2::new(-0.6, 0.3));
        assert!(before[2] > 1.5 && before[0] == 1.0, "{before:?}");
        assert_eq!(pace.factors(Vector2::new(-3.0, 0.0)), [1.0; 16]);
        assert_eq!(pace.speed(0.7), 0.0);
        let room = pace.speed(1.5) * pace.speed(1.5) / 4.0 + pace.speed(1.5) * (0.8 + 0.05);
        assert!((room - 0.8).abs() < 1e-12);
    }
}
