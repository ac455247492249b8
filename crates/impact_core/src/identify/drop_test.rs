//! Trajectory of a slide that falls on a foam and bounces (zeng2011, A.1.3 and A.1.4).
//!
//! Every stretch between two events (contact, release, turn, rest) has a closed form; only the
//! events are searched for.

use crate::error::{Failure, Given, Result, finite, not_negative, positive};
use crate::signal::check_time;
use numeric::threads::Interrupted;

/// Events after which a slide counts as resting; only bounces below rounding are that many.
const MOST_STRETCHES: usize = 100_000;
/// Steps of a search, and samples, between two looks whether to stop.
const CHECK: usize = 4096;
/// Step of a search for an event, in radians of the foam's frequency.
const SEARCH_STEP: f64 = 0.4;
/// Least step as a share of the record: below it times are rounded away.
const LEAST_STEP: f64 = 1e-14;
/// Damping ratio from which both roots of the foam are apart by more than rounding.
const ROOTS_APART: f64 = 1.1;

/// When the foam lets go of the slide.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DropContact {
    /// When its force would become a pull; the foam then relaxes on its own.
    Unilateral,
    /// When the slide passes the undeformed surface: the foam sticks to it until then.
    Attached,
}

/// A slide on a rail with friction above a foam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DropModel {
    /// Moving mass `m`, in kg.
    pub mass: f64,
    /// Foam stiffness `K_c`, in N/m.
    pub stiffness: f64,
    /// Foam damping as a ratio, `C = 2 xi sqrt(m K_c)`.
    pub damping_ratio: f64,
    /// Friction of the rail `f`, in N.
    pub friction: f64,
    /// Height above the foam from which it is released at rest, in m.
    pub height: f64,
    /// Acceleration of gravity, in m/s^2.
    pub gravity: f64,
    /// When the foam lets go.
    pub contact: DropContact,
}

impl DropModel {
    fn checked(self) -> Result<Self> {
        positive("mass", self.mass)?;
        positive("stiffness", self.stiffness)?;
        not_negative("damping_ratio", self.damping_ratio)?;
        not_negative("friction", self.friction)?;
        not_negative("height", self.height)?;
        positive("gravity", self.gravity)?;
        Ok(self)
    }

    /// Also passes a foam whose oscillations are resolved by the numbers of the times.
    fn checked_for(self, time: &[f64]) -> Result<Self> {
        let model = self.checked()?;
        let fastest = SEARCH_STEP / (LEAST_STEP * (time[time.len() - 1] - time[0]));
        let most = model.mass * fastest * fastest;
        if model.stiffness > most {
            let rule = format!("be at most {most:.3e} N/m for this mass and duration");
            return Err(Failure::invalid(
                "stiffness",
                rule,
                Given::Number(model.stiffness),
            ));
        }
        Ok(model)
    }
}

/// Position over time, in m, up from the surface of the foam; released at the first time.
///
/// In contact `m y'' + C y' + K y = -(m g + f sign(y'))`, above it gravity and friction only. The
/// slide stays where friction can hold it.
///
/// # Errors
/// A parameter out of range, times that do not rise, numbers so far apart that positions overflow.
pub fn drop_trajectory(time: &[f64], model: &DropModel) -> Result<Vec<f64>> {
    drop_trajectory_until(time, model, &|| false)
}

/// The same unless the caller asks to stop.
///
/// # Errors
/// Also that the caller asked to stop.
pub fn drop_trajectory_until(
    time: &[f64],
    model: &DropModel,
    interrupted: Interrupted<'_>,
) -> Result<Vec<f64>> {
    check_time("time", time)?;
    finite("friction", model.friction)?;
    let path = trajectory_until(time, &model.checked_for(time)?, interrupted)?;
    let Some(place) = path.iter().position(|height| !height.is_finite()) else {
        return Ok(path);
    };
    let rule = format!("give finite positions, also at {:?} s", time[place]);
    let failure = Failure::invalid("model", rule, Given::Number(path[place]));
    Err(failure.mended_by(
        "mass, stiffness, damping_ratio, friction or height is too large or too small by orders of \
         magnitude: they are in kg, N/m, 1, N and m",
    ))
}

/// The same without checks, for the fit.
///
/// # Errors
/// The caller asked to stop.
pub(super) fn trajectory_until(
    time: &[f64],
    model: &DropModel,
    interrupted: Interrupted<'_>,
) -> Result<Vec<f64>> {
    let end = time[time.len() - 1] - time[0];
    let mut state = State {
        time: 0.0,
        position: model.height,
        velocity: 0.0,
        surface: None,
    };
    let mut flying = true;
    let mut result = Vec::with_capacity(time.len());
    for stretch in 0.. {
        if result.len() == time.len() {
            break;
        }
        let (motion, duration, next_flying) = if stretch > MOST_STRETCHES {
            let position = state.position;
            (Motion::Rest { position }, f64::INFINITY, flying)
        } else if flying {
            flight(model, &state, end, interrupted)?
        } else {
            contact(model, &state, end, interrupted)?
        };
        if stretch % CHECK == 0 && interrupted() {
            return Err(Failure::Interrupted);
        }
        let until = state.time + duration;
        while result.len() < time.len() && (time[result.len()] - time[0] <= until || until >= end) {
            let at = time[result.len()] - time[0] - state.time;
            result.push(motion.at(at).0);
            if result.len().is_multiple_of(CHECK) && interrupted() {
                return Err(Failure::Interrupted);
            }
        }
        let (position, velocity) = motion.at(duration);
        state.advance(
            model,
            motion,
            until,
            [position, velocity],
            [flying, next_flying],
        );
        flying = next_flying;
    }
    Ok(result)
}

/// State at the start of a stretch.
struct State {
    time: f64,
    position: f64,
    velocity: f64,
    /// Time and position at which a relaxing foam was let go.
    surface: Option<(f64, f64)>,
}

impl State {
    fn advance(
        &mut self,
        model: &DropModel,
        motion: Motion,
        until: f64,
        [position, velocity]: [f64; 2],
        [was_flying, flying]: [bool; 2],
    ) {
        self.time = until;
        self.position = position;
        // A stretch that continues in the same medium ends at a turn.
        let turned = was_flying == flying || matches!(motion, Motion::Rest { .. });
        self.velocity = if turned { 0.0 } else { velocity };
        if !was_flying {
            let relaxing = flying && model.contact == DropContact::Unilateral;
            self.surface = relaxing.then_some((until, position));
        }
    }
}

/// Motion between two events; times count from the start of the stretch.
#[derive(Clone, Copy)]
enum Motion {
    /// Held by friction.
    Rest { position: f64 },
    /// Constant acceleration.
    Free {
        position: f64,
        velocity: f64,
        acceleration: f64,
    },
    /// On the foam: oscillation about the position that gravity and friction set.
    Foam {
        center: f64,
        offset: f64,
        velocity: f64,
        decay: f64,
        frequency: f64,
    },
}

impl Motion {
    /// Position and velocity.
    fn at(&self, time: f64) -> (f64, f64) {
        match *self {
            Self::Rest { position } => (position, 0.0),
            Self::Free {
                position,
                velocity,
                acceleration,
            } => (
                position + time * (velocity + 0.5 * acceleration * time),
                velocity + acceleration * time,
            ),
            Self::Foam {
                center,
                offset,
                velocity,
                decay,
                frequency,
            } if decay > ROOTS_APART * frequency => {
                let (position, velocity) = creep([decay, frequency], [offset, velocity], time);
                (center + position, velocity)
            }
            Self::Foam {
                center,
                offset,
                velocity,
                decay,
                frequency,
            } => {
                let (envelope, cosine, sine) = oscillation([decay, frequency], time);
                let push = velocity + decay * offset;
                let pull = frequency * frequency * offset + decay * velocity;
                (
                    center + envelope * (offset * cosine + push * sine),
                    envelope * (velocity * cosine - pull * sine),
                )
            }
        }
    }
}

/// An envelope, and what it is to be multiplied with to give `exp(-d t) cos(w t)` and
/// `exp(-d t) sin(w t) / w` for `w^2 = f^2 - d^2`, which is negative for an overdamped foam; nothing
/// grows, so nothing overflows.
fn oscillation([decay, frequency]: [f64; 2], time: f64) -> (f64, f64, f64) {
    let squared = frequency * frequency - decay * decay;
    let root = squared.abs().sqrt();
    let envelope = (-decay * time).exp();
    if root * time < 1e-8 {
        (envelope, 1.0, time)
    } else if squared > 0.0 {
        (envelope, (root * time).cos(), (root * time).sin() / root)
    } else {
        // The slower root, without the difference of two nearly equal numbers.
        let slow = (-(frequency / (decay + root) * frequency) * time).exp();
        let gap = (-2.0 * root * time).exp_m1();
        (slow, 0.5 * (2.0 + gap), -0.5 * gap / root)
    }
}

/// Offset and velocity of an overdamped foam as the sum of its two exponentials.
fn creep([decay, frequency]: [f64; 2], [offset, velocity]: [f64; 2], time: f64) -> (f64, f64) {
    // Factored, so that squares of large numbers do not overflow.
    let root = decay * ((1.0 - frequency / decay) * (1.0 + frequency / decay)).sqrt();
    let fast = -(decay + root);
    let slow = frequency * (frequency / fast);
    let gap = 2.0 * root;
    let slow_part = (velocity - fast * offset) / gap * (slow * time).exp();
    let fast_part = (slow * offset - velocity) / gap * (fast * time).exp();
    (slow_part + fast_part, slow * slow_part + fast * fast_part)
}

/// A stretch above the foam: the motion, how long it lasts and whether the next one is above too.
fn flight(
    model: &DropModel,
    state: &State,
    end: f64,
    interrupted: Interrupted<'_>,
) -> Result<(Motion, f64, bool)> {
    let drag = model.friction / model.mass;
    let rising = state.velocity > 0.0;
    if !rising && drag >= model.gravity {
        let position = state.position;
        return Ok((Motion::Rest { position }, f64::INFINITY, true));
    }
    let acceleration = if rising {
        -model.gravity - drag
    } else {
        drag - model.gravity
    };
    let motion = Motion::Free {
        position: state.position,
        velocity: state.velocity,
        acceleration,
    };
    let turn = if rising {
        -state.velocity / acceleration
    } else {
        f64::INFINITY
    };
    let rate = 0.5 * model.relaxation_rate();
    let landing = match state.surface {
        // A relaxing surface is below the undeformed one and comes up.
        Some((time, position)) if rate.is_finite() => {
            let above = |at: f64| {
                let surface = position * (2.0 * rate * (time - state.time - at)).exp();
                motion.at(at).0 - surface
            };
            let fall = (2.0 * state.position.abs() / acceleration.abs()).sqrt();
            let step = (0.25 / rate).min(0.25 * turn).min(0.25 * fall.max(1e-4));
            first_root(above, step, turn.min(end - state.time), interrupted)?
        }
        _ if rising => None,
        _ => {
            let speed =
                (state.velocity * state.velocity - 2.0 * acceleration * state.position).sqrt();
            Some((speed + state.velocity) / -acceleration)
        }
    };
    Ok(match landing {
        Some(landing) => (motion, landing, false),
        None if rising => (motion, turn, true),
        None => (motion, f64::INFINITY, true),
    })
}

/// A stretch on the foam.
fn contact(
    model: &DropModel,
    state: &State,
    end: f64,
    interrupted: Interrupted<'_>,
) -> Result<(Motion, f64, bool)> {
    let weight = model.mass * model.gravity;
    let drive = -weight - model.stiffness * state.position;
    let direction = if state.velocity != 0.0 {
        state.velocity.signum()
    } else if drive.abs() <= model.friction {
        let position = state.position;
        return Ok((Motion::Rest { position }, f64::INFINITY, false));
    } else {
        drive.signum()
    };
    let frequency = (model.stiffness / model.mass).sqrt();
    let center = -(weight + model.friction * direction) / model.stiffness;
    let motion = Motion::Foam {
        center,
        offset: state.position - center,
        velocity: state.velocity,
        decay: model.damping_ratio * frequency,
        frequency,
    };
    let step = SEARCH_STEP / frequency;
    let limit = end - state.time;
    let turn = first_root(|at| direction * motion.at(at).1, step, limit, interrupted)?;
    let released = if direction > 0.0 {
        let pull = match model.contact {
            DropContact::Unilateral => 2.0 * model.damping_ratio / frequency,
            DropContact::Attached => 0.0,
        };
        let push = |at: f64| {
            let (position, velocity) = motion.at(at);
            -position - pull * velocity
        };
        first_root(push, step, turn.unwrap_or(limit), interrupted)?
    } else {
        None
    };
    Ok(match (released, turn) {
        (Some(at), _) => (motion, at, true),
        (None, Some(at)) => (motion, at, false),
        (None, None) => (motion, f64::INFINITY, false),
    })
}

impl DropModel {
    /// `K / C` of the foam, in 1/s.
    fn relaxation_rate(&self) -> f64 {
        (self.stiffness / self.mass).sqrt() / (2.0 * self.damping_ratio)
    }
}

/// First time at which `value`, positive after the start, becomes zero: steps, then the Illinois
/// variant of the false position.
///
/// # Errors
/// The caller asked to stop.
fn first_root(
    value: impl Fn(f64) -> f64,
    step: f64,
    limit: f64,
    interrupted: Interrupted<'_>,
) -> Result<Option<f64>> {
    let mut low = 0.0;
    let mut at_low = value(low).max(0.0);
    let mut steps = 0_usize;
    while low < limit {
        steps += 1;
        // Steps so small that they vanish in the time never end either.
        if steps.is_multiple_of(CHECK) && interrupted() {
            return Err(Failure::Interrupted);
        }
        let mut high = (low + step).min(limit);
        let mut at_high = value(high);
        if at_high > 0.0 {
            (low, at_low) = (high, at_high);
            continue;
        }
        let mut kept = 0_i8;
        for _ in 0..200 {
            let middle = if at_low > 0.0 {
                (low * at_high - high * at_low) / (at_high - at_low)
            } else {
                // Zero at the start as well: bisect until the positive side is found.
                0.5 * (low + high)
            };
            if !(middle > low && middle < high) || high - low < 1e-15 * high {
                break;
            }
            let at_middle = value(middle);
            if at_middle > 0.0 {
                (low, at_low) = (middle, at_middle);
                at_high *= if kept == 1 { 0.5 } else { 1.0 };
                kept = 1;
            } else {
                (high, at_high) = (middle, at_middle);
                at_low *= if kept == -1 { 0.5 } else { 1.0 };
                kept = -1;
            }
        }
        return Ok(Some(high));
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn model() -> DropModel {
        DropModel {
            mass: 1.54,
            stiffness: 24_250.0,
            damping_ratio: 0.112,
            friction: 2.0,
            height: 0.045,
            gravity: 9.80665,
            contact: DropContact::Unilateral,
        }
    }

    fn times(count: u32) -> Vec<f64> {
        (0..count).map(|k| f64::from(k) * 1e-3).collect()
    }

    /// The same slide by small steps of the equation of motion, with the sign of the speed.
    fn stepped(model: &DropModel, count: usize) -> Vec<f64> {
        let parts = 4000;
        let step = 1e-3 / f64::from(parts);
        let damping = 2.0 * model.damping_ratio * (model.mass * model.stiffness).sqrt();
        let (mut position, mut velocity, mut surface) = (model.height, 0.0_f64, 0.0_f64);
        let mut result = vec![position];
        while result.len() < count {
            for _ in 0..parts {
                let force = -model.stiffness * position - damping * velocity;
                let touching = match model.contact {
                    DropContact::Unilateral => position <= surface && force > 0.0,
                    DropContact::Attached => position < 0.0,
                };
                let push = if touching { force } else { 0.0 };
                let drive = push - model.mass * model.gravity;
                let friction = if velocity.abs() < 1e-6 && drive.abs() <= model.friction {
                    velocity = 0.0;
                    drive
                } else {
                    model.friction * velocity.signum()
                };
                velocity += step * (drive - friction) / model.mass;
                position += step * velocity;
                surface = if touching {
                    position
                } else {
                    surface * (1.0 - step * model.stiffness / damping)
                };
            }
            result.push(position);
        }
        result
    }

    #[test]
    fn free_fall_is_a_parabola() {
        let fall = drop_trajectory(&times(80), &model()).unwrap();
        for (time, position) in times(80).iter().zip(fall) {
            let expected = 0.045 - 0.5 * (9.80665 - 2.0 / 1.54) * time * time;
            assert!((position - expected).abs() < 1e-15);
        }
    }

    #[test]
    fn closed_forms_follow_the_equation_of_motion() {
        for contact in [DropContact::Unilateral, DropContact::Attached] {
            for damping_ratio in [0.02, 0.112, 0.6, 1.4] {
                let model = DropModel {
                    damping_ratio,
                    contact,
                    ..model()
                };
                let exact = drop_trajectory(&times(400), &model).unwrap();
                let steps = stepped(&model, 400);
                for (k, (exact, stepped)) in exact.iter().zip(&steps).enumerate() {
                    // First-order steps of 0.25 us.
                    assert!(
                        (exact - stepped).abs() < 2e-6,
                        "{model:?} {k} {exact} {stepped}"
                    );
                }
            }
        }
    }

    #[test]
    fn without_loss_every_bounce_returns_to_its_height() {
        let model = DropModel {
            damping_ratio: 0.0,
            friction: 0.0,
            ..model()
        };
        let fine: Vec<f64> = (0..200_000).map(|k| f64::from(k) * 1e-5).collect();
        let path = drop_trajectory(&fine, &model).unwrap();
        let late = path[100_000..].iter().fold(0.0_f64, |high, y| high.max(*y));
        assert!((late - model.height).abs() < 1e-9, "{late}");
    }

    #[test]
    fn friction_holds_the_slide_at_the_end() {
        let path = drop_trajectory(&[0.0, 0.01, 30.0, 31.0], &model()).unwrap();
        assert_eq!(path[2], path[3]);
        assert!((24_250.0 * path[3] + 1.54 * 9.80665).abs() <= 2.0);
        let stuck = DropModel {
            friction: 20.0,
            ..model()
        };
        assert_eq!(drop_trajectory(&[0.0, 5.0], &stuck), Ok(vec![0.045; 2]));
    }
}
