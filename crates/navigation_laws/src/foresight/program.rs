//! A program in space and time: what the way from a node costs at a stage.

use crate::foresight::ground::Ground;
use crate::foresight::prediction::{Foreknown, Prediction};
use crate::foresight::{Foresight, Scene};
use crate::guide::RobotRoom;
use numeric::lanes::Vector2;

/// Length of the longest move in nodes, rounded up.
pub(super) const FARTHEST_MOVE: f64 = 2.24;

/// Way to the goal in m at which the robot is there.
const THERE: f64 = 0.1;

/// Stages over which the way onward is looked at.
const ONWARD: usize = 3;

/// Cells of the longest move along an axis.
const MOVE: usize = 2;

/// Costs in s from all nodes of a grid around the robot, at all stages.
#[derive(Clone, Debug)]
pub(super) struct Program {
    spacing: f64,
    preferred: f64,
    stages: usize,
    /// Nodes from the middle to the rim.
    half: usize,
    ground: Ground,
    /// Costs of the stages, each for the whole grid; those of stage 0 are not needed.
    costs: Vec<Vec<f64>>,
    /// Least cost of three nodes in a row, and of five.
    rows: [Vec<f64>; 2],
}

impl Program {
    /// A grid for stages, a preferred speed in m/s, and so many cells that the first velocity can lead over.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // bounded by the caller
    pub fn new(settings: &Foresight, preferred: f64, reach: f64) -> Self {
        let half = MOVE * (settings.stages - 1) + reach as usize;
        let count = (2 * half + 1) * (2 * half + 1);
        Self {
            spacing: preferred * settings.step / FARTHEST_MOVE,
            preferred,
            stages: settings.stages,
            half,
            ground: Ground::new(count),
            costs: vec![vec![0.0; count]; settings.stages],
            rows: [vec![0.0; count], vec![0.0; count]],
        }
    }

    fn across(&self) -> usize {
        2 * self.half + 1
    }

    /// Nodes from the middle to the rim of a stage.
    fn rim(&self, stage: usize) -> usize {
        self.half - MOVE * (self.stages - stage)
    }

    /// Computes the costs of all stages from the last to the first.
    pub fn solve(
        &mut self,
        settings: &Foresight,
        scene: &Scene<'_>,
        prediction: &Prediction,
        robot: RobotRoom,
        processor: pulp::Arch,
    ) {
        let across = self.across();
        self.ground.look(scene, robot, across, self.spacing);
        processor.dispatch(
            #[inline(always)]
            || self.sweep(settings, scene.robot.position, prediction),
        );
    }

    #[inline(always)]
    fn sweep(&mut self, settings: &Foresight, origin: Vector2<f64>, prediction: &Prediction) {
        for stage in (1..=self.stages).rev() {
            let mut costs = std::mem::take(&mut self.costs[stage - 1]);
            self.risk(settings, stage, origin, prediction, &mut costs);
            if stage == self.stages {
                self.end(&mut costs);
            } else {
                self.step(settings.step, stage, &mut costs);
            }
            self.costs[stage - 1] = costs;
        }
    }

    /// Price of being near people and in narrow places at a stage.
    #[inline(always)]
    fn risk(
        &self,
        settings: &Foresight,
        stage: usize,
        origin: Vector2<f64>,
        prediction: &Prediction,
        costs: &mut [f64],
    ) {
        let (across, rim) = (self.across(), self.rim(stage));
        for row in self.half - rim..=self.half + rim {
            let begin = row * across + self.half - rim;
            let narrow = &self.ground.narrowness[begin..][..=2 * rim];
            for (cost, more) in costs[begin..].iter_mut().zip(narrow) {
                *cost = settings.step * more;
            }
        }
        for (index, person) in prediction.people.iter().enumerate() {
            let places = prediction.places(index);
            let (at, last) = (2 * stage, 2 * self.stages);
            let middle = |other: usize| (places[at] + places[other]) * 0.5;
            let ends = [middle(at - 1), middle((at + 1).min(last))].map(|place| place - origin);
            self.person(settings, stage, person, ends, costs);
        }
    }

    /// Price of being near somebody who is between two places in m from the robot.
    #[inline(always)]
    fn person(
        &self,
        settings: &Foresight,
        stage: usize,
        person: &Foreknown,
        [from, to]: [Vector2<f64>; 2],
        costs: &mut [f64],
    ) {
        let (across, rim, spacing) = (self.across(), self.rim(stage), self.spacing);
        let blur = settings.blur(stage as f64 * settings.step, person.deviation);
        let felt = person.touch + settings.felt(blur);
        let Some([left, right]) = self.nodes(from.x.min(to.x) - felt, from.x.max(to.x) + felt, rim)
        else {
            return;
        };
        let Some([below, above]) =
            self.nodes(from.y.min(to.y) - felt, from.y.max(to.y) + felt, rim)
        else {
            return;
        };
        let way = to - from;
        let square = way.norm_squared();
        let share = if square > 0.0 {
            way / square
        } else {
            Vector2::zeros()
        };
        let heavy = settings.risk_weight * settings.step;
        let light = settings.comfort_weight * settings.step;
        for row in below..=above {
            let y = (row as f64 - self.half as f64) * spacing - from.y;
            let costs = &mut costs[row * across..][left..=right];
            for (column, cost) in costs.iter_mut().enumerate() {
                let x = ((left + column) as f64 - self.half as f64) * spacing - from.x;
                let along = x * share.x + y * share.y;
                let along = if along > 0.0 { along } else { 0.0 };
                let along = if along < 1.0 { along } else { 1.0 };
                let (aside, beyond) = (x - way.x * along, y - way.y * along);
                let gap = (aside * aside + beyond * beyond).sqrt() - person.touch;
                let near = if gap > 0.0 { gap } else { 0.0 };
                let short = 1.0 - near / settings.comfort;
                let short = if short > 0.0 { short } else { 0.0 };
                *cost += heavy * settings.risk(gap, blur) + light * (short * short);
            }
        }
    }

    /// First and last node between two coordinates in m from the robot, within a rim.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // within the grid
    fn nodes(&self, from: f64, to: f64, rim: usize) -> Option<[usize; 2]> {
        let rim = rim as f64;
        let (first, last) = ((from / self.spacing).ceil(), (to / self.spacing).floor());
        if !(first <= last && first <= rim && last >= -rim) {
            return None;
        }
        let index = |cell: f64| (cell + self.half as f64) as usize;
        Some([index(first.max(-rim)), index(last.min(rim))])
    }

    /// Costs of the last stage from the price of being near people.
    #[inline(always)]
    fn end(&self, costs: &mut [f64]) {
        for (cost, way) in costs.iter_mut().zip(&self.ground.way) {
            let far = way / self.preferred;
            let risk = if *way > THERE { *cost } else { 0.0 };
            *cost = far + risk;
        }
    }

    /// Costs of a stage from the price of being near people, and the costs of the next one.
    #[inline(always)]
    fn step(&mut self, step: f64, stage: usize, costs: &mut [f64]) {
        let (across, half, rim) = (self.across(), self.half, self.rim(stage));
        let next = &self.costs[stage];
        let beyond = rim + MOVE;
        let [threes, fives] = &mut self.rows;
        for row in half - beyond..=half + beyond {
            let begin = row * across + half - beyond;
            let next = &next[begin..][..=2 * beyond];
            // The rim of the rows is not asked for.
            let threes = &mut threes[begin..][..=2 * beyond];
            least(&mut threes[1..2 * beyond], next, &next[1..], &next[2..]);
            let fives = &mut fives[begin..][..=2 * beyond];
            let threes = &threes[1..2 * beyond];
            least(
                &mut fives[2..2 * beyond - 1],
                threes,
                &threes[1..],
                &threes[2..],
            );
        }
        for row in half - rim..=half + rim {
            let begin = row * across + half - rim;
            let count = 2 * rim + 1;
            let two = MOVE * across;
            let lines = [
                &threes[begin - two..][..count],
                &fives[begin - across..][..count],
                &fives[begin..][..count],
                &fives[begin + across..][..count],
                &threes[begin + two..][..count],
            ];
            let ground = &self.ground.way[begin..][..count];
            let costs = &mut costs[begin..][..count];
            for (index, (cost, way)) in costs.iter_mut().zip(ground).enumerate() {
                let mut after = lines[0][index];
                for line in &lines[1..] {
                    let other = line[index];
                    after = if other < after { other } else { after };
                }
                let all = step + *cost + after;
                let all = if *way <= THERE { 0.0 } else { all };
                *cost = if *way == f64::INFINITY {
                    f64::INFINITY
                } else {
                    all
                };
            }
        }
    }

    /// Cost at a place in m from the robot after the first stage: between the nodes around that have one.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // checked before
    pub fn cost(&self, place: Vector2<f64>) -> f64 {
        let rim = self.rim(1) as f64;
        let cell = place / self.spacing;
        let lower = cell.map(f64::floor);
        let within = |value: f64| value >= -rim && value < rim;
        if !(within(lower.x) && within(lower.y)) {
            return f64::INFINITY;
        }
        let share = cell - lower;
        let index = |value: f64| (value + self.half as f64) as usize;
        let first = index(lower.y) * self.across() + index(lower.x);
        let costs = &self.costs[0];
        let corners = [
            (costs[first], (1.0 - share.x) * (1.0 - share.y)),
            (costs[first + 1], share.x * (1.0 - share.y)),
            (costs[first + self.across()], (1.0 - share.x) * share.y),
            (costs[first + self.across() + 1], share.x * share.y),
        ];
        let finite = corners.iter().filter(|(cost, _)| cost.is_finite());
        let (all, weight) = finite.fold((0.0, 0.0), |(all, sum), (cost, weight)| {
            (all + cost * weight, sum + weight)
        });
        if weight > 0.0 {
            all / weight
        } else {
            f64::INFINITY
        }
    }

    /// Node nearest to a place in m from the robot after the first stage.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // within the grid
    fn nearest(&self, place: Vector2<f64>) -> [usize; 2] {
        let rim = self.rim(1) as f64;
        let cell = (place / self.spacing).map(|value| value.round().clamp(-rim, rim));
        [cell.x, cell.y].map(|value| (value + self.half as f64) as usize)
    }

    /// Node of a stage to which the cheapest move leads, `None` at the goal and where no move leads on.
    fn next(&self, stage: usize, [column, row]: [usize; 2]) -> Option<[usize; 2]> {
        let across = self.across();
        if self.ground.way[row * across + column] <= THERE {
            return None;
        }
        let (mut least, mut best) = (f64::INFINITY, None);
        for (x, y) in MOVES {
            let to = [column.wrapping_add_signed(x), row.wrapping_add_signed(y)];
            let cost = self.costs[stage - 1][to[1] * across + to[0]];
            if cost < least {
                (least, best) = (cost, Some(to));
            }
        }
        best
    }

    /// Place of a node in m from the robot.
    fn place(&self, [column, row]: [usize; 2]) -> Vector2<f64> {
        let half = self.half as f64;
        Vector2::new(column as f64 - half, row as f64 - half) * self.spacing
    }

    /// Way in m that the cheapest moves lead on, after the first stage, from a place in m from the robot; `None` where
    /// they stay.
    pub fn onward(&self, place: Vector2<f64>) -> Option<Vector2<f64>> {
        let mut node = self.nearest(place);
        for stage in 2..=self.stages.min(1 + ONWARD) {
            match self.next(stage, node) {
                Some(next) => node = next,
                None => break,
            }
        }
        let way = self.place(node) - place;
        (way.norm() > self.spacing).then_some(way)
    }

    /// Places of the cheapest way at the stages, in m: the robot itself, where the first velocity leads, then nodes.
    pub fn way(&self, [origin, end]: [Vector2<f64>; 2]) -> Vec<[f64; 2]> {
        let mut node = self.nearest(end - origin);
        let mut way = vec![origin.into(), end.into()];
        for stage in 2..=self.stages {
            let Some(next) = self.next(stage, node) else {
                break;
            };
            node = next;
            way.push((origin + self.place(node)).into());
        }
        way
    }
}

/// Least of three rows of numbers.
#[inline(always)]
fn least(found: &mut [f64], one: &[f64], two: &[f64], three: &[f64]) {
    for (((least, one), two), three) in found.iter_mut().zip(one).zip(two).zip(three) {
        let both = if one < two { *one } else { *two };
        *least = if *three < both { *three } else { both };
    }
}

/// Moves of a stage in nodes, the farthest first, then by their angle.
const MOVES: [(isize, isize); 21] = [
    (-2, -1),
    (-1, -2),
    (1, -2),
    (2, -1),
    (2, 1),
    (1, 2),
    (-1, 2),
    (-2, 1),
    (0, -2),
    (2, 0),
    (0, 2),
    (-2, 0),
    (-1, -1),
    (1, -1),
    (1, 1),
    (-1, 1),
    (0, -1),
    (1, 0),
    (0, 1),
    (-1, 0),
    (0, 0),
];
