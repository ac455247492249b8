//! Events of a collision: values that fall below zero.

use super::Collision;
use super::mechanics::{Carried, CollisionState, History, Local, Mechanics, SPEED, TOTAL};
use super::step::{Step, step};
use crate::covering::Kinks;

/// Event within a step of a collision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CollisionEvent {
    /// The bodies part.
    Release,
    /// `eps` turns.
    Turn,
    /// A kink of the covering's force, or its bottoming: the next one above, or below.
    Kink {
        /// Whether the compression rises through the kink.
        upwards: bool,
    },
    /// The compression passes the largest one so far.
    Largest,
    /// The measured points end.
    End,
    /// The force is noticed.
    Noticed,
    /// The bodies meet again.
    Meeting,
}

/// Every event.
const EVENTS: [CollisionEvent; 8] = [
    CollisionEvent::Release,
    CollisionEvent::Turn,
    CollisionEvent::Kink { upwards: true },
    CollisionEvent::Kink { upwards: false },
    CollisionEvent::Largest,
    CollisionEvent::End,
    CollisionEvent::Noticed,
    CollisionEvent::Meeting,
];

/// Compressions that matter, and on which side of them the motion is.
#[derive(Clone, Debug)]
pub struct Marks {
    /// Kinks in order.
    pub kinks: Kinks,
    /// Number of kinks below.
    pub piece: usize,
    /// Largest compression at a reversal, if unloading differs, and whether the motion is below it.
    pub largest: Option<(f64, bool)>,
    /// End of measured points.
    pub end: Option<f64>,
}

/// Sizes of compression, speed and force, for tolerances.
#[derive(Clone, Copy, Debug)]
pub struct Sizes {
    /// Length, in m.
    pub length: f64,
    /// Speed, in m/s.
    pub speed: f64,
    /// Force, in N.
    pub force: f64,
    /// Tolerance of the place of events, over these sizes.
    pub sharpness: f64,
}

impl Marks {
    /// Value of an event and its rate; infinite where it cannot happen.
    fn value<const N: usize>(
        &self,
        event: CollisionEvent,
        mechanics: &Mechanics<'_, N>,
        past: &History,
        (state, local): (&CollisionState<N>, &Local),
    ) -> [f64; 2] {
        const NEVER: [f64; 2] = [f64::INFINITY, 0.0];
        let depth = [local.compression, local.compression_rate];
        let above = |mark: f64| [depth[0] - mark, depth[1]];
        let below = |mark: f64| [mark - depth[0], -depth[1]];
        if let Some(parted) = past.apart {
            return match event {
                CollisionEvent::Meeting => [parted - state[TOTAL], -state[SPEED]],
                _ => NEVER,
            };
        }
        match event {
            CollisionEvent::Release => release(mechanics, state, local),
            CollisionEvent::Turn => {
                let sign = if past.loading { 1.0 } else { -1.0 };
                [sign * state[SPEED], sign * local.acceleration]
            }
            CollisionEvent::Kink { upwards: true } => {
                self.kinks.get(self.piece).copied().map_or(NEVER, below)
            }
            CollisionEvent::Kink { upwards: false } => match self.piece.checked_sub(1) {
                Some(index) => above(self.kinks[index]),
                None => NEVER,
            },
            CollisionEvent::Largest => match self.largest {
                Some((mark, true)) => below(mark),
                Some((mark, false)) => above(mark),
                None => NEVER,
            },
            CollisionEvent::End => self.end.map_or(NEVER, below),
            CollisionEvent::Noticed => match mechanics.collision.driven {
                Some(driven) if past.stop_time.is_infinite() => {
                    [driven.detection_force - local.force, -local.force_rate]
                }
                _ => NEVER,
            },
            CollisionEvent::Meeting => NEVER,
        }
    }
}

/// Quantity whose zero is the release, and its rate.
fn release<const N: usize>(
    mechanics: &Mechanics<'_, N>,
    state: &CollisionState<N>,
    local: &Local,
) -> [f64; 2] {
    let collision: &Collision<'_> = mechanics.collision;
    match mechanics.carried {
        Carried::Nothing if collision.pad.is_some_and(|pad| pad.covering.damping > 0.0) => {
            [local.force, local.force_rate]
        }
        Carried::Nothing | Carried::Series => [state[TOTAL], state[SPEED]],
        Carried::Damped => [local.deflection, local.deflection_rate],
    }
}

/// Start of a step, with state, rates and forces.
pub struct Start<'a, const N: usize> {
    /// Time, in s.
    pub time: f64,
    /// State.
    pub state: &'a CollisionState<N>,
    /// Its derivative.
    pub rates: &'a CollisionState<N>,
    /// Forces there.
    pub local: &'a Local,
}

/// The first event within a step, and the step that leads to it.
pub fn first_event<const N: usize>(
    mechanics: &Mechanics<'_, N>,
    past: &History,
    marks: &Marks,
    sizes: &Sizes,
    start: &Start<'_, N>,
    (mut taken, mut length): (Step<N>, f64),
) -> (Option<CollisionEvent>, Step<N>, f64) {
    let mut found = None;
    loop {
        let mut first: Option<(CollisionEvent, f64)> = None;
        for event in EVENTS {
            if found == Some(event) {
                continue;
            }
            let size = size_of(event, mechanics, sizes);
            let end = marks.value(event, mechanics, past, (&taken.state, &taken.local));
            if end[0] >= -4.0 * size {
                continue;
            }
            let before = marks.value(event, mechanics, past, (start.state, start.local));
            let at = if before[0] <= 0.0 {
                0.0
            } else {
                cubic_root(before, end, length)
            };
            if first.is_none_or(|(_, earliest)| at < earliest) {
                first = Some((event, at));
            }
        }
        let Some((event, _)) = first else {
            return (found, taken, length);
        };
        found = Some(event);
        let before = marks.value(event, mechanics, past, (start.state, start.local));
        if before[0] <= 0.0 {
            taken.state = *start.state;
            taken.rates = *start.rates;
            taken.local = *start.local;
            return (found, taken, 0.0);
        }
        let value =
            |taken: &Step<N>| marks.value(event, mechanics, past, (&taken.state, &taken.local));
        let size = size_of(event, mechanics, sizes);
        (taken, length) = located(mechanics, past, start, (taken, length), before, size, value);
    }
}

fn size_of<const N: usize>(
    event: CollisionEvent,
    mechanics: &Mechanics<'_, N>,
    sizes: &Sizes,
) -> f64 {
    let by = match event {
        CollisionEvent::Turn => sizes.speed,
        CollisionEvent::Noticed => sizes.force,
        CollisionEvent::Release if mechanics.carried == Carried::Nothing => {
            if mechanics
                .collision
                .pad
                .is_some_and(|pad| pad.covering.damping > 0.0)
            {
                sizes.force
            } else {
                sizes.length
            }
        }
        _ => sizes.length,
    };
    sizes.sharpness * by
}

/// The shorter step to where a value that falls below zero within the given one is zero.
pub fn located<const N: usize>(
    mechanics: &Mechanics<'_, N>,
    past: &History,
    start: &Start<'_, N>,
    (taken, length): (Step<N>, f64),
    before: [f64; 2],
    size: f64,
    value: impl Fn(&Step<N>) -> [f64; 2],
) -> (Step<N>, f64) {
    let (mut low, mut at_low) = (0.0, before);
    let (mut high, mut at_high) = (length, value(&taken));
    let mut found = (taken, length);
    for round in 0..60 {
        let width = high - low;
        let inside = if round % 4 == 3 {
            0.5 * width
        } else {
            cubic_root(at_low, at_high, width)
        };
        let at = low + inside.clamp(1e-3 * width, (1.0 - 1e-3) * width);
        if at <= low || at >= high {
            break;
        }
        let tried = step(mechanics, past, start.time, start.state, start.rates, at);
        let now = value(&tried);
        found = (tried, at);
        if now[0].abs() <= size {
            break;
        }
        if now[0] > 0.0 {
            (low, at_low) = (at, now);
        } else {
            (high, at_high) = (at, now);
        }
    }
    found
}

/// Where the cubic through two values with their rates, the first above zero and the second below, is zero.
fn cubic_root(first: [f64; 2], last: [f64; 2], length: f64) -> f64 {
    let (a, b) = (first[0], last[0]);
    let (da, db) = (first[1] * length, last[1] * length);
    // A value that is infinite, as the rate of a force may be, or no number, as beyond the end of a law, says nothing of
    // where it is zero.
    let line = a / (a - b);
    let line = if a == f64::INFINITY || line.is_nan() {
        0.5
    } else {
        line
    };
    if !(da.is_finite() && db.is_finite()) {
        return line * length;
    }
    let (mut low, mut high) = (0.0, 1.0);
    let mut x = line;
    for _ in 0..12 {
        let y = 1.0 - x;
        let value = a * (1.0 + 2.0 * x) * y * y + da * x * y * y + b * x * x * (3.0 - 2.0 * x)
            - db * x * x * y;
        let slope = 6.0 * x * y * (b - a) + da * y * (1.0 - 3.0 * x) + db * x * (3.0 * x - 2.0);
        if value > 0.0 {
            low = x;
        } else {
            high = x;
        }
        let newton = x - value / slope;
        let next = if newton > low && newton < high {
            newton
        } else {
            0.5 * (low + high)
        };
        if (next - x).abs() < 1e-12 {
            return next * length;
        }
        x = next;
    }
    x * length
}

#[cfg(test)]
mod tests {
    use super::cubic_root;

    #[test]
    fn values_that_are_no_numbers_are_halved() {
        for last in [[f64::NAN, 1.0], [f64::NAN; 2], [f64::NEG_INFINITY, -1.0]] {
            let root = cubic_root([1.0, -1.0], last, 2.0);
            assert!((0.0..=2.0).contains(&root), "{root}");
        }
        assert_eq!(cubic_root([1.0, -1.0], [f64::NAN; 2], 2.0), 1.0);
    }
}
