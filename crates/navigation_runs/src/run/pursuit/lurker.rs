//! Somebody hidden behind walls, who comes for the robot on the shortest way.

use std::f64::consts::SQRT_2;
use std::sync::Arc;

use nalgebra::Vector2;
use navigation_world::world::map::StaticMap;
use unknown_places::unseen::Ground;

/// A core may be nearer to a wall by this much, in m: rounding.
const SPARE: f64 = 1e-6;

/// Cells ahead on the way within which a straight way is sought.
const AHEAD: usize = 30;

/// Longest way to the robot that he knows, in m.
const FARTHEST: f64 = 12.0;

/// Somebody whose core keeps off the walls of a map.
#[derive(Clone, Debug)]
pub struct Lurker {
    map: StaticMap,
    /// Cells with room for his core.
    ground: Arc<Ground>,
    core: f64,
    max_speed: f64,
    /// From when on he is there, in s.
    pub appears: f64,
    /// He comes as soon as the robot is so near, in m.
    pub waits: f64,
    /// Ways to the robot in m, where it was last.
    ways: Vec<f64>,
}

impl Lurker {
    /// Somebody of a core in m and a largest speed in m/s among the walls of a map, whose cells have room for the core.
    #[must_use]
    pub fn new(map: StaticMap, ground: Arc<Ground>, core: f64, max_speed: f64) -> Self {
        Self {
            map,
            ground,
            core,
            max_speed,
            appears: 0.0,
            waits: f64::INFINITY,
            ways: Vec::new(),
        }
    }

    /// Whether he is there at a time in s.
    #[must_use]
    pub fn is_there(&self, time: f64) -> bool {
        time >= self.appears - 1e-9
    }

    /// Whether a wall is between two places: nobody touches through it.
    #[must_use]
    pub fn is_behind_wall(&self, one: Vector2<f64>, other: Vector2<f64>) -> bool {
        self.map.segment_clearance(one, other) <= 0.0
    }

    /// Whether he can stand at a place.
    #[must_use]
    pub fn fits(&self, place: Vector2<f64>) -> bool {
        self.map.clearance_up_to(place, 1.0) >= self.core - SPARE
    }

    /// Length in m of his way from a place to the robot; infinite where he does not come.
    #[must_use]
    pub fn way_from(&self, place: Vector2<f64>) -> f64 {
        let cell = self.ground.holding(place);
        let columns = self.ground.size()[0];
        let known = cell.and_then(|[column, row]| self.ways.get(row * columns + column));
        known.copied().unwrap_or(f64::INFINITY)
    }

    /// Learns where the robot is, and the ways to it from places in m, or all that he knows where there are none.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // bounded by the longest way
    pub fn look(&mut self, robot: Vector2<f64>, places: &[Vector2<f64>]) {
        let size = self.ground.size();
        self.ways.clear();
        self.ways.resize(size[0] * size[1], f64::INFINITY);
        let Some(first) = self.ground.holding(robot) else {
            return;
        };
        let index = |[column, row]: [usize; 2]| row * size[0] + column;
        let cells = places
            .iter()
            .filter_map(|place| self.ground.holding(*place));
        let sought: Vec<usize> = cells.map(index).collect();
        self.ways[index(first)] = 0.0;
        // Dijkstra's algorithm with a bucket for each length of a cell: no step is shorter.
        let mut queue = vec![vec![first]];
        let mut level = 0;
        while level < queue.len() {
            let length = level as f64 * self.ground.cell();
            let found = |cell: &usize| self.ways[*cell] < length;
            if length > FARTHEST || (!sought.is_empty() && sought.iter().all(found)) {
                break;
            }
            for cell in std::mem::take(&mut queue[level]) {
                let way = self.ways[index(cell)];
                if way < length - SPARE {
                    continue;
                }
                for (beside, step) in self.beside(cell) {
                    let total = way + step;
                    let known = &mut self.ways[index(beside)];
                    if total < *known && self.ground.walkable().contains(beside) {
                        *known = total;
                        let bucket = (total / self.ground.cell() + SPARE) as usize;
                        if bucket >= queue.len() {
                            queue.resize(bucket + 1, Vec::new());
                        }
                        queue[bucket].push(beside);
                    }
                }
            }
            level += 1;
        }
    }

    fn beside(&self, cell: [usize; 2]) -> impl Iterator<Item = ([usize; 2], f64)> + use<> {
        let (size, side) = (self.ground.size(), self.ground.cell());
        let offsets = (-1..=1).flat_map(|y: isize| (-1..=1).map(move |x: isize| [x, y]));
        offsets.filter_map(move |[x, y]| {
            let found = [
                cell[0].checked_add_signed(x)?,
                cell[1].checked_add_signed(y)?,
            ];
            let within = found[0] < size[0] && found[1] < size[1] && (x != 0 || y != 0);
            let length = if x == 0 || y == 0 { 1.0 } else { SQRT_2 };
            within.then_some((found, length * side))
        })
    }

    /// His velocity in m/s at a place, toward a robot.
    #[must_use]
    pub fn velocity(&self, time: f64, own: Vector2<f64>, robot: Vector2<f64>) -> Vector2<f64> {
        let to = robot - own;
        if !self.is_there(time) || to.norm() > self.waits {
            return Vector2::zeros();
        }
        let toward = |point: Vector2<f64>| {
            (point - own)
                .try_normalize(1e-9)
                .unwrap_or_else(Vector2::zeros)
        };
        if self.is_open(own, robot) {
            return toward(robot) * self.max_speed;
        }
        let columns = self.ground.size()[0];
        // Before he has looked he knows no way.
        let way_at = |[column, row]: [usize; 2]| {
            let known = self.ways.get(row * columns + column);
            known.copied().unwrap_or(f64::INFINITY)
        };
        let Some(mut cell) = self.ground.holding(own) else {
            return Vector2::zeros();
        };
        let mut open = None;
        for _ in 0..AHEAD {
            let near = self
                .beside(cell)
                .map(|(beside, _)| (way_at(beside), beside));
            let Some((way, next)) = near.min_by(|one, two| one.0.total_cmp(&two.0)) else {
                break;
            };
            if !way.is_finite() || way >= way_at(cell) {
                break;
            }
            cell = next;
            let place = self.ground.center(cell);
            if self.is_open(own, place) {
                open = Some(place);
            } else if open.is_some() {
                break;
            }
        }
        open.map_or_else(Vector2::zeros, toward) * self.max_speed
    }

    /// Where he is after a way, which ends at walls.
    #[must_use]
    pub fn moved(&self, place: Vector2<f64>, way: Vector2<f64>) -> Vector2<f64> {
        let next = place + way;
        if way == Vector2::zeros() || self.is_open(place, next) {
            next
        } else {
            place
        }
    }

    fn is_open(&self, from: Vector2<f64>, to: Vector2<f64>) -> bool {
        self.map.segment_keeps(from, to, self.core - SPARE)
    }
}
