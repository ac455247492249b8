//! Closed forms of the motion between two events.

/// Damping ratio from which both roots of the foam are apart by more than rounding.
const ROOTS_APART: f64 = 1.1;

/// Motion between two events; times count from the start of the stretch.
#[derive(Clone, Copy)]
pub(super) enum DropMotion {
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

impl DropMotion {
    /// Position and velocity.
    pub(super) fn at(&self, time: f64) -> (f64, f64) {
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
