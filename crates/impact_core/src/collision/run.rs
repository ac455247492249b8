//! The motion from the first touch to the release.

mod loads;

use numeric::threads::Interrupted;

use super::events::{CollisionEvent, Marks, Sizes, Start, first_event};
use super::injury::injury_of;
use super::loading::Turn;
use super::mechanics::{
    BODY_SPEED, Carried, CollisionState, History, Local, Mechanics, PART, SPEED, TOTAL,
};
use super::outcome::{CollisionStatus, MotionSample, Outcome};
use super::statics::rest_of;
use super::step::{Step, step};
use super::stored::{stored, turns};
use super::{Collision, Region};
use crate::covering::{Kinks, Pad};
use crate::roots::Peak;
use loads::PEAKS;

/// Most steps of a collision.
const MOST_STEPS: usize = 200_000;
/// Steps between two questions whether to stop: some tens of microseconds.
const STEPS_OF_A_LOOK: usize = 64;
/// Compression, over the largest, at which a motion starts that would rest at none.
const FIRST: f64 = 1e-7;
/// Compression, over the largest, that no tolerance sees.
const UNSEEN: f64 = 1e-12;
/// Windows of the head injury criterion, in s.
pub const INJURY_WINDOWS: [f64; 2] = [0.015, 0.036];

/// Results of a collision that are wanted beyond its loads.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wanted {
    /// The motion.
    pub nodes: bool,
    /// The head injury criterion with an acceleration of gravity, in m/s^2.
    pub injury: Option<f64>,
}

/// Loads of a collision that has been checked; one that was interrupted is unfinished.
#[must_use]
pub fn simulate(
    collision: &Collision<'_>,
    wanted: Wanted,
    interrupted: Interrupted<'_>,
) -> Outcome {
    simulate_all(&[collision], wanted, interrupted)
        .pop()
        .unwrap_or_else(|| Outcome::nothing(CollisionStatus::Unfinished))
}

/// Loads of some collisions, each as alone, bit for bit.
#[must_use]
pub fn simulate_all(
    collisions: &[&Collision<'_>],
    wanted: Wanted,
    interrupted: Interrupted<'_>,
) -> Vec<Outcome> {
    let free = |collision: &&&Collision<'_>| collision.closing_speed > 0.0 && !is_held(collision);
    let some: Vec<_> = collisions.iter().filter(free).copied().collect();
    let mut turns = turns(&some).into_iter();
    let each = collisions.iter().map(|collision| {
        if collision.closing_speed <= 0.0 {
            Outcome::nothing(CollisionStatus::NoImpact)
        } else if is_held(collision) {
            Run::<5>::new(collision, wanted).finish(wanted, interrupted)
        } else {
            let turn = turns.next().flatten();
            released(collision, turn.as_ref(), wanted, interrupted)
        }
    });
    each.collect()
}

fn is_held(collision: &Collision<'_>) -> bool {
    collision.robot.is_held() || (collision.body.is_held() && collision.body.mass.is_finite())
}

/// Loads of a collision of free bodies, with its turn if the rate counts.
fn released(
    collision: &Collision<'_>,
    turn: Option<&Turn>,
    wanted: Wanted,
    interrupted: Interrupted<'_>,
) -> Outcome {
    let exact = stored(collision, turn);
    let moving = wanted.nodes || wanted.injury.is_some();
    match exact {
        Some(found) if !moving => found,
        exact => {
            let outcome = moved(collision, wanted, interrupted);
            match exact {
                // The motion was asked for as well: its loads are those without it, bit for bit.
                Some(found) if outcome.status == CollisionStatus::Released => Outcome {
                    injury: outcome.injury,
                    nodes: outcome.nodes,
                    evaluations: outcome.evaluations,
                    ..found
                },
                _ => outcome,
            }
        }
    }
}

/// Loads of a collision of free bodies from its motion in time.
pub fn moved(collision: &Collision<'_>, wanted: Wanted, interrupted: Interrupted<'_>) -> Outcome {
    Run::<3>::new(collision, wanted).finish(wanted, interrupted)
}

/// Whether `d = 0`, or `delta = 0`, stays where it is although the bodies close in.
fn rests_at_touch(collision: &Collision<'_>) -> bool {
    let Some(pad) = collision.pad else {
        return false;
    };
    let [slope, yielding] = [pad.force(0.0)[1], collision.region.force(0.0)[1]];
    slope.is_infinite() || yielding.is_infinite() || (slope == 0.0 && yielding == 0.0)
}

/// `eps` and `d` shortly after the touch of a covering that starts infinitely stiff, whose damper is at rest.
///
/// It relaxes ever faster towards the touch; before `d` is a share of the largest one that no tolerance sees,
/// any error of it is none.
fn relaxed(collision: &Collision<'_>, largest: f64, most: f64) -> Option<[f64; 2]> {
    let pad = collision.pad?;
    if pad.force(0.0)[1].is_finite() {
        return None;
    }
    let part = UNSEEN * largest;
    let total = part + collision.region.deflection(pad.force(part)[0]);
    Some(if total <= most {
        [total, part]
    } else {
        [most, 0.0]
    })
}

struct Run<'a, const N: usize> {
    mechanics: Mechanics<'a, N>,
    past: History,
    marks: Marks,
    sizes: Sizes,
    scales: CollisionState<N>,
    time: f64,
    state: CollisionState<N>,
    rates: CollisionState<N>,
    local: Local,
    peaks: [Peak; PEAKS],
    /// Whether `eps` has peaked since the set point rests.
    peaked: bool,
    /// Whether all loads have peaked.
    done: bool,
    nodes: Option<Vec<MotionSample>>,
    evaluations: usize,
}

impl<'a, const N: usize> Run<'a, N> {
    fn new(collision: &'a Collision<'a>, wanted: Wanted) -> Self {
        let speed = collision.closing_speed;
        let energy = 0.5 * collision.reduced_mass() * speed * speed;
        let rest = rest_of(collision.pad, collision.region, energy);
        let length = rest.compression + rest.deflection;
        let mechanics = Mechanics::<N>::new(collision);
        let mut scales = [length; N];
        scales[SPEED] = speed;
        if mechanics.carried != Carried::Nothing {
            scales[PART] = rest.compression;
        }
        if N > BODY_SPEED {
            scales[BODY_SPEED] = speed;
        }
        let past = History {
            loading: true,
            largest_strain: 0.0,
            largest_work: 0.0,
            braking: false,
            stop_time: match (collision.stop, collision.driven) {
                (Some(_), Some(driven)) if driven.detection_force > 0.0 => f64::INFINITY,
                (stop, _) => stop.map_or(f64::INFINITY, |stop| stop.time),
            },
            apart: None,
        };
        let mut state = [0.0; N];
        state[SPEED] = speed;
        let mut time = 0.0;
        if mechanics.carried == Carried::Series && rests_at_touch(collision) {
            state[TOTAL] = FIRST * length;
            time = state[TOTAL] / speed;
            state[PART] = mechanics.share(state[TOTAL], speed, &past);
        }
        if mechanics.carried == Carried::Damped
            && let Some(touched) = relaxed(collision, rest.compression, FIRST * length)
        {
            [state[TOTAL], state[PART]] = touched;
            time = state[TOTAL] / speed;
        }
        let local = mechanics.local(time, &state, &past);
        let rates = mechanics.rates(&state, &local);
        let pad = collision.pad;
        Self {
            marks: Marks {
                kinks: pad.map_or_else(Kinks::new, Pad::kinks),
                piece: 0,
                largest: None,
                end: pad
                    .filter(|pad| pad.covering.material.is_measured())
                    .map(Pad::bound),
            },
            sizes: Sizes {
                length,
                speed,
                force: rest.force,
                sharpness: (1e-3 * collision.tolerance).max(1e-15),
            },
            nodes: (wanted.nodes || wanted.injury.is_some()).then(Vec::new),
            mechanics,
            past,
            scales,
            time,
            state,
            rates,
            local,
            peaks: [Peak::NONE; PEAKS],
            peaked: false,
            done: false,
            evaluations: 1,
        }
    }

    fn finish(mut self, wanted: Wanted, interrupted: Interrupted<'_>) -> Outcome {
        let status = self.travel(interrupted);
        let mut outcome = self.outcome(status);
        if let Some(nodes) = self.nodes {
            if let Some(gravity) = wanted.injury
                && self.mechanics.collision.body.mass.is_finite()
            {
                outcome.injury =
                    INJURY_WINDOWS.map(|width| injury_of(&nodes, width) / gravity.powf(2.5));
            }
            if wanted.nodes {
                outcome.nodes = nodes;
            }
        }
        outcome
    }

    /// Times at which the law of motion changes, the horizon last.
    fn breaks(&self) -> Vec<(f64, bool)> {
        let collision = self.mechanics.collision;
        let mut breaks = Vec::with_capacity(3);
        if let Some(stop) = collision.stop {
            let start = self.past.stop_time;
            let rest = start + collision.closing_speed / stop.deceleration;
            breaks.extend([(start, true), (rest, true)]);
        }
        breaks.retain(|(time, _)| *time < collision.horizon);
        breaks.push((collision.horizon, false));
        breaks
    }

    fn travel(&mut self, interrupted: Interrupted<'_>) -> CollisionStatus {
        let mut next = self.breaks().into_iter();
        let Some((mut until, mut changes)) = next.next() else {
            return CollisionStatus::Horizon;
        };
        let mut length = 0.05 * self.sizes.length / self.sizes.speed;
        for index in 0..MOST_STEPS {
            if index % STEPS_OF_A_LOOK == 0 && interrupted() {
                return CollisionStatus::Unfinished;
            }
            while self.time >= until {
                if !changes {
                    return CollisionStatus::Horizon;
                }
                self.past.braking = true;
                let Some(following) = next.next() else {
                    return CollisionStatus::Horizon;
                };
                (until, changes) = following;
                self.refresh();
            }
            let left = until - self.time;
            let last = length >= left * (1.0 - 1e-12);
            let tried = if last { left } else { length };
            let taken = step(
                &self.mechanics,
                &self.past,
                self.time,
                &self.state,
                &self.rates,
                tried,
            );
            self.evaluations += 6;
            let excess = self.excess(&taken);
            if excess > 1.0 {
                let factor = if excess.is_finite() {
                    (0.9 * excess.powf(-0.2)).max(0.2)
                } else {
                    0.2
                };
                length = tried * factor;
                if length < 1e-14 * self.sizes.length / self.sizes.speed {
                    return CollisionStatus::Unfinished;
                }
                continue;
            }
            let start = Start {
                time: self.time,
                state: &self.state,
                rates: &self.rates,
                local: &self.local,
            };
            let whole = (taken, tried);
            let (event, taken, used) = first_event(
                &self.mechanics,
                &self.past,
                &self.marks,
                &self.sizes,
                &start,
                whole,
            );
            let end = if event.is_none() && last {
                until
            } else {
                self.time + used
            };
            self.accept(taken, used, end, event);
            match event {
                Some(CollisionEvent::Release) if self.mechanics.collision.driven.is_none() => {
                    return CollisionStatus::Released;
                }
                Some(CollisionEvent::End) => return CollisionStatus::BeyondData,
                Some(CollisionEvent::Noticed) => {
                    let stop = self.mechanics.collision.stop;
                    self.past.stop_time = self.time + stop.map_or(0.0, |stop| stop.time);
                    next = self.breaks().into_iter();
                    let Some(following) = next.next() else {
                        return CollisionStatus::Horizon;
                    };
                    (until, changes) = following;
                }
                Some(event) => {
                    self.pass(event);
                    if self.is_past_its_peaks(event) {
                        return CollisionStatus::Horizon;
                    }
                }
                None => (),
            }
            let growth = (0.9 * excess.max(1e-10).powf(-0.2)).min(5.0);
            if event.is_none() && !last || growth < 1.0 {
                length = tried * growth;
            } else if event.is_some() {
                // What was a good length before an event often is too long behind it.
                length = length.min(tried * growth).max(used);
            }
        }
        CollisionStatus::Unfinished
    }

    /// Whether the loads of a drive that rests have been their largest: from then on energy is only lost, so that no later
    /// peak is above the first one. A covering whose force depends on its rate is followed to the horizon.
    fn is_past_its_peaks(&mut self, event: CollisionEvent) -> bool {
        let collision = self.mechanics.collision;
        let (Some(stop), Some(_), None) = (collision.stop, collision.driven, &self.nodes) else {
            return false;
        };
        let rest = self.past.stop_time + collision.closing_speed / stop.deceleration;
        let clamped = collision.body.mass == f64::INFINITY && self.mechanics.is_in_step();
        if !clamped || self.time < rest {
            return false;
        }
        let turned = event == CollisionEvent::Turn;
        self.done =
            self.peaked && (event == CollisionEvent::Release || turned && self.past.loading);
        self.peaked |= turned && !self.past.loading;
        self.done
    }

    /// Largest error over its tolerance.
    fn excess(&self, taken: &Step<N>) -> f64 {
        let collision = self.mechanics.collision;
        if let Some(pad) = collision.pad
            && !pad.covering.material.is_measured()
            && taken.local.compression >= pad.bound()
        {
            return f64::INFINITY;
        }
        let mut worst = 0.0_f64;
        for (error, scale) in taken.error.iter().zip(&self.scales) {
            if *scale > 0.0 {
                let share = error.abs() / (collision.tolerance * scale);
                if share.is_nan() {
                    return f64::INFINITY;
                }
                worst = worst.max(share);
            }
        }
        worst
    }

    fn accept(&mut self, mut taken: Step<N>, used: f64, end: f64, event: Option<CollisionEvent>) {
        if event == Some(CollisionEvent::Turn) {
            // The side before the turn: what belongs to rising compression still counts.
            taken.state[SPEED] = 0.0;
            taken.local = self.mechanics.local(end, &taken.state, &self.past);
            taken.rates = self.mechanics.rates(&taken.state, &taken.local);
        }
        if used > 0.0 {
            self.peaks_within(&taken, used, end);
        }
        if let Some(nodes) = &mut self.nodes {
            nodes.push(
                self.mechanics
                    .node(self.time, &self.state, &self.local, &self.past),
            );
            nodes.push(
                self.mechanics
                    .node(end, &taken.state, &taken.local, &self.past),
            );
        }
        self.time = end;
        self.state = taken.state;
        self.rates = taken.rates;
        self.local = taken.local;
        self.settle();
        for (scale, entry) in self.scales.iter_mut().zip(&self.state) {
            *scale = scale.max(entry.abs());
        }
    }

    /// Brings `d` back to where the forces of covering and region are equal.
    fn settle(&mut self) {
        if self.mechanics.carried != Carried::Series {
            return;
        }
        let least = 1e-2 * self.sizes.sharpness.max(1e-13) * self.scales[PART];
        for _ in 0..8 {
            let mismatch = self.local.mismatch;
            if mismatch.is_nan() || mismatch.abs() <= least {
                break;
            }
            let (part, total) = (self.state[PART], self.state[TOTAL]);
            let moved = part - mismatch;
            // Steps out of [0, eps] are halved.
            self.state[PART] = if moved < 0.0 {
                0.5 * part.max(0.0)
            } else if moved > total {
                0.5 * (part + total)
            } else {
                moved
            };
            self.refresh();
            self.evaluations += 1;
        }
    }

    /// The motion behind an event.
    fn pass(&mut self, event: CollisionEvent) {
        match event {
            CollisionEvent::Turn => {
                self.past.loading = !self.past.loading;
                if !self.past.loading && self.mechanics.forgets() {
                    self.remember();
                }
            }
            CollisionEvent::Kink { upwards: true } => self.marks.piece += 1,
            CollisionEvent::Kink { upwards: false } => self.marks.piece -= 1,
            CollisionEvent::Largest => {
                if let Some((_, below)) = &mut self.marks.largest {
                    *below = !*below;
                }
            }
            CollisionEvent::Release => self.past.apart = Some(self.state[TOTAL]),
            CollisionEvent::Meeting => self.meet(),
            CollisionEvent::End | CollisionEvent::Noticed => (),
        }
        self.refresh();
    }

    /// The touch after a release: compression rises from where it was.
    fn meet(&mut self) {
        self.past.apart = None;
        self.past.loading = true;
        let mechanics = &self.mechanics;
        if mechanics.carried == Carried::Series && rests_at_touch(mechanics.collision) {
            self.state[TOTAL] = self.state[TOTAL].max(FIRST * self.sizes.length);
            let (total, speed) = (self.state[TOTAL], self.state[SPEED]);
            self.state[PART] = mechanics.share(total, speed, &self.past);
        }
    }

    /// Keeps the strain of a reversal if it is the largest so far.
    fn remember(&mut self) {
        let Some(pad) = self.mechanics.collision.pad else {
            return;
        };
        let strain = self.local.compression / pad.covering.thickness;
        if strain > self.past.largest_strain {
            self.past.largest_strain = strain;
            self.past.largest_work = pad.covering.material.work(strain);
            self.marks.largest = Some((self.local.compression, false));
        }
    }

    fn refresh(&mut self) {
        self.local = self.mechanics.local(self.time, &self.state, &self.past);
        self.rates = self.mechanics.rates(&self.state, &self.local);
    }
}
