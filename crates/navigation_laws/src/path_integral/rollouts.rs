//! Samples of controls side by side, where they lead, and what they cost.

use super::{Control, PathIntegral};
use crate::local_planning::{Each, EachVector, Inflation, LaneGaps, LocalView, WIDTH, all, wrap};
use numeric::elementary::{cosine_and_sine, fading, logarithm};
use numeric::lanes::{Number, Planar, Real, Truth, Vector2, vectors};
use numeric::philox::side_by_side;

/// Second word of the key of all draws.
const KEY: u32 = 0x4D50_5049;

/// Numbers of Nav2's critics: what a contact costs, costs of the largest cell, distances in m, the angle in rad.
const COLLISION_COST: f64 = 1e6;
const LARGEST_COST: f64 = 254.0;
const NEAR_GOAL: f64 = 0.5;
const GOAL_FROM: f64 = 1.4;
const ALIGN_FROM: f64 = 0.5;
const FOLLOW_FROM: f64 = 1.4;
const FOLLOW_AHEAD: f64 = 0.3;
const ANGLE_AHEAD: f64 = 0.2;
#[allow(clippy::approx_constant)] // as Nav2 writes it
const ANGLE_FROM: f64 = 0.785_398;
/// Every so many poses costs are looked at, and the way is.
const COST_STRIDE: usize = 2;
const ALIGN_STRIDE: usize = 4;

/// Room of the samples, used again and again.
#[derive(Default)]
pub(super) struct Rollouts {
    /// Controls by step, axis and block of samples.
    controls: Vec<Each>,
    blocks: usize,
    /// Costs, last places and headings by blocks.
    costs: Vec<Each>,
    places: Vec<EachVector>,
    headings: Vec<Each>,
    /// Whether a sample is without a contact.
    free: bool,
    weights: Vec<Each>,
}

impl Rollouts {
    /// Sum of the weights of so many samples, which are kept; `None` where each has a contact.
    pub fn weights(&mut self, samples: usize, temperature: f64) -> Option<f64> {
        if !self.free {
            return None;
        }
        let lanes = |index: usize| (index / WIDTH, index % WIDTH);
        let cost = |index: usize| self.costs[lanes(index).0].lane(lanes(index).1);
        let least = (0..samples).map(cost).fold(f64::INFINITY, f64::min);
        let per_cost = Each::splat(1.0 / temperature);
        self.weights.clear();
        let mut sum = 0.0;
        for (block, costs) in self.costs.iter().enumerate() {
            let more = (*costs - Each::splat(least)) * per_cost;
            let weight = fading(-more.max(Each::splat(0.0)));
            let kept = Each::from_fn(|lane| {
                let counts = block * WIDTH + lane < samples;
                if counts && weight.lane(lane) >= 0.0 {
                    weight.lane(lane)
                } else {
                    0.0
                }
            });
            for lane in 0..WIDTH {
                sum += kept.lane(lane);
            }
            self.weights.push(kept);
        }
        // Costs that are no numbers, of places beyond all numbers, count for nothing.
        (sum > 0.0).then_some(sum)
    }

    /// Mean control of a step along an axis, by weights of a sum.
    pub fn mean(&self, sum: f64, (step, axis): (usize, usize)) -> f64 {
        let begun = (step * 3 + axis) * self.blocks;
        let controls = &self.controls[begun..begun + self.blocks];
        let mut total = Each::splat(0.0);
        for (control, weight) in controls.iter().zip(&self.weights) {
            total += *control * *weight;
        }
        (0..WIDTH).map(|lane| total.lane(lane)).sum::<f64>() / sum
    }
}

/// Draws and costs all samples of a call, in vectors of the processor where it has them.
pub(super) fn samples_in_lanes(
    settings: &PathIntegral,
    view: &LocalView<'_>,
    plan: &[Control],
    (seed, call): (u32, u32),
    rollouts: &mut Rollouts,
) {
    let job = Job {
        settings,
        view,
        plan,
        key: [seed, KEY],
        call,
        rollouts,
    };
    match vectors() {
        Some(vectors) => pulp::Simd::vectorize(vectors, job),
        None => job.run(),
    }
}

struct Job<'a, 'v> {
    settings: &'a PathIntegral,
    view: &'a LocalView<'v>,
    plan: &'a [Control],
    key: [u32; 2],
    call: u32,
    rollouts: &'a mut Rollouts,
}

impl pulp::NullaryFnOnce for Job<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.run();
    }
}

/// Costs of gaps that are open.
#[inline(always)]
fn cost(inflation: &Inflation, radius: f64, gap: Each) -> Each {
    let near = gap.le(Each::splat(inflation.inflation_radius - radius));
    let cost = fading(gap * Each::splat(-inflation.cost_scaling_factor)) * 252.0;
    Each::select(near, cost, Each::splat(0.0))
}

/// Number between 0 and 1 of a random word, in every lane.
#[inline(always)]
fn unit(words: [u32; WIDTH]) -> Each {
    let mut numbers = [0.0; WIDTH];
    for (number, word) in numbers.iter_mut().zip(words) {
        *number = (f64::from(word) + 0.5) * (1.0 / 4_294_967_296.0);
    }
    Each::from_fn(|lane| numbers[lane])
}

/// Length and direction of two draws of a standard normal distribution.
#[inline(always)]
fn polar(length: [u32; WIDTH], turn: [u32; WIDTH]) -> [Each; 2] {
    let length = (logarithm(unit(length)) * -2.0).sqrt();
    let [cosine, sine] = cosine_and_sine(unit(turn) * std::f64::consts::TAU);
    [length * cosine, length * sine]
}

impl Rollouts {
    /// Makes room for samples of so many steps, in blocks.
    fn clear(&mut self, steps: usize, blocks: usize) {
        self.blocks = blocks;
        self.controls.clear();
        self.controls.resize(3 * steps * blocks, Each::splat(0.0));
        self.costs.clear();
        self.places.clear();
        self.headings.clear();
        self.free = false;
    }
}

/// Draws of a standard normal distribution for every lane: forward, to the left if there is any, turning.
#[inline(always)]
fn normals([first, second, third, fourth]: [[u32; WIDTH]; 4], sideways: bool) -> [Each; 3] {
    let [ahead, turning] = polar(first, second);
    let left = if sideways {
        polar(third, fourth)[0]
    } else {
        Each::splat(0.0)
    };
    [ahead, left, turning]
}

#[inline(always)]
fn within(value: Each, least: Each, most: Each) -> Each {
    value.max(least).min(most)
}

impl Job<'_, '_> {
    #[inline(always)]
    fn run(self) {
        let Self { settings, view, .. } = self;
        let steps = settings.time_steps;
        let blocks = settings.batch_size.div_ceil(WIDTH);
        let rollouts = self.rollouts;
        rollouts.clear(steps, blocks);
        let inflation = settings.inflation();
        let radius = view.gaps.radius;
        // Beyond the inflation radius gaps cost nothing.
        let most = inflation.inflation_radius.max(radius) + 1.0;
        let gaps = LaneGaps::new(view.gaps, settings.prediction, most);
        let limits = settings.limits().map(|limits| limits.map(Each::splat));
        let deviations = settings.deviations();
        let sideways = settings.vy_max > 0.0;
        let effort = deviations.map(|deviation| settings.gamma / (deviation * deviation));
        let (goal, length) = (view.goal(), view.way.length());
        let away = (goal - view.pose.position).norm();
        let goal_lanes = EachVector::splat(goal.into());
        let step = settings.model_dt;
        let looked = steps.div_ceil(COST_STRIDE) as f64;
        let aligned = steps.div_ceil(ALIGN_STRIDE).saturating_sub(1);
        for block in 0..blocks {
            let first = u32::try_from(block * WIDTH).unwrap_or(0);
            let mut before = view.twist.map(Each::splat);
            let mut place = EachVector::splat(view.pose.position.into());
            let mut heading = Each::splat(view.pose.heading);
            let zero = Each::splat(0.0);
            let (mut near, mut hit) = (zero, all(false));
            let (mut to_goal, mut backward, mut control_cost) = (zero, zero, zero);
            let (mut along, mut off, mut last_place) = (zero, zero, place);
            for (number, planned) in (0_u32..).zip(self.plan) {
                let index = number as usize;
                let mut samples = [0; WIDTH];
                for (lane, sample) in (0..).zip(&mut samples) {
                    *sample = first + lane;
                }
                let counter = [samples, [number; WIDTH], [self.call; WIDTH], [0; WIDTH]];
                let drawn = normals(side_by_side(counter, self.key), sideways);
                for axis in 0..3 {
                    if axis == 1 && !sideways {
                        continue;
                    }
                    let noise = drawn[axis] * deviations[axis];
                    let control = noise + planned[axis];
                    control_cost += (control - planned[axis]) * (planned[axis] * effort[axis]);
                    rollouts.controls[(index * 3 + axis) * blocks + block] = control;
                    let [most, least, change] = [0, 1, 2].map(|kind: usize| limits[kind][axis]);
                    let now = before[axis];
                    before[axis] = within(within(control, least, most), now - change, now + change);
                }
                let [ahead, left, turn_rate] = before;
                backward += (-ahead).max(zero);
                let [cosine, sine] = cosine_and_sine(heading);
                place.x += (ahead * cosine - left * sine) * step;
                place.y += (ahead * sine + left * cosine) * step;
                heading += turn_rate * step;
                if index.is_multiple_of(COST_STRIDE) {
                    let time = Each::splat((index + 1) as f64 * step);
                    let gap = gaps.at(place, time, all(true));
                    // A gap that is no number is none.
                    let open = gap.gt(zero);
                    hit = hit | !open;
                    near += cost(&inflation, radius, gap);
                }
                if length <= GOAL_FROM {
                    let way = place - goal_lanes;
                    to_goal += way.dot(&way).sqrt();
                }
                if length >= ALIGN_FROM && index.is_multiple_of(ALIGN_STRIDE) {
                    if index > 0 {
                        let way = place - last_place;
                        along += way.dot(&way).sqrt();
                        off += Each::from_fn(|lane| {
                            let at = view.way.at(along.lane(lane));
                            (Vector2::from(place.lane(lane)) - at).norm()
                        });
                    }
                    last_place = place;
                }
            }
            let touched = Each::splat(COLLISION_COST);
            let near = if away < NEAR_GOAL { zero } else { near };
            let mut total =
                Each::select(hit, touched, near) * (settings.cost_weight / LARGEST_COST / looked);
            total += control_cost;
            if length <= GOAL_FROM {
                total += to_goal * (settings.goal_weight / steps as f64);
            }
            if aligned > 0 {
                total += off * (settings.path_align_weight / aligned as f64);
            }
            if away >= NEAR_GOAL {
                total += backward * (settings.prefer_forward_weight * step);
            }
            for lane in 0..WIDTH {
                rollouts.free |= block * WIDTH + lane < settings.batch_size && !hit.lane(lane);
            }
            rollouts.costs.push(total);
            rollouts.places.push(place);
            rollouts.headings.push(heading);
        }
        follow(settings, view, rollouts, (length, away));
    }
}

/// Adds costs of how far the last poses are from where the farthest sample is on the way, and of where they look.
fn follow(
    settings: &PathIntegral,
    view: &LocalView<'_>,
    rollouts: &mut Rollouts,
    (length, away): (f64, f64),
) {
    let samples = settings.batch_size;
    let last = |index: usize| Vector2::from(rollouts.places[index / WIDTH].lane(index % WIDTH));
    let farthest = (0..samples).map(|index| view.way.nearest(last(index)).1);
    let farthest = farthest.fold(0.0, f64::max);
    let ahead = view.way.at(farthest + FOLLOW_AHEAD);
    let look = view.way.at(farthest + ANGLE_AHEAD);
    let follows = length >= FOLLOW_FROM;
    let looks = away >= NEAR_GOAL && view.pose.bearing(look).abs() >= ANGLE_FROM;
    if !follows && !looks {
        return;
    }
    for block in 0..rollouts.costs.len() {
        let (places, headings) = (rollouts.places[block], rollouts.headings[block]);
        rollouts.costs[block] += Each::from_fn(|lane| {
            let place = Vector2::from(places.lane(lane));
            let mut cost = 0.0;
            if follows {
                cost += settings.path_follow_weight * (place - ahead).norm();
            }
            if looks {
                let to = look - place;
                let error = wrap(to.y.atan2(to.x) - headings.lane(lane));
                cost += settings.path_angle_weight * error.abs();
            }
            cost
        });
    }
}
