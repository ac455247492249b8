//! The response as two pairs of roots: everything on it is a sum of four functions of time.
//!
//! A pair of roots is a factor `s^2 + 2 alpha s + beta` of the characteristic polynomial. With
//! `delta = beta - alpha^2`, positive for complex roots and negative for real ones, it gives
//!
//! ```text
//! C(t) = exp(-alpha t) cos(sqrt(delta) t)        C' = -alpha C - delta S
//! S(t) = exp(-alpha t) sin(sqrt(delta) t) / sqrt(delta)    S' = C - alpha S
//! ```
//!
//! so equal roots within a pair need nothing special. Two pairs that come close do: such impacts
//! are refused.

use super::apart::{apart, inlined};
use super::arithmetic::{Each, MapWith};
use super::factors::{Split, factors};
use crate::series::Plant;
use numeric::elementary::{cosine_and_sine, exponential};
use numeric::lanes::{Number, Truth};
use pulp::Simd;

/// Least resultant of the pairs over the fourth power of the fastest root's modulus; rounding
/// errors grow by the square root of its inverse.
const LEAST_RESULTANT: f64 = 3e-5;
/// Nearly equal real roots in a pair, over its squared modulus: their difference is rounding.
const NEARLY_EQUAL: f64 = 1e-5;

/// Two pairs of roots, times in cells.
#[derive(Clone, Copy)]
pub struct Modes<S, R: Number> {
    /// Instructions that may be used.
    simd: S,
    /// Length of a cell, in s.
    pub length: R,
    /// Cells per second.
    pub rate: R,
    /// `alpha` of both pairs.
    decay: [R; 2],
    /// `beta`.
    modulus: [R; 2],
    /// One over it.
    per_modulus: [R; 2],
    /// `delta`.
    square: [R; 2],
    /// Root of its absolute value.
    frequency: [R; 2],
    /// One over it.
    period: [R; 2],
    /// Pairs of real roots.
    real: [R::Mask; 2],
    /// Faster one of real roots.
    faster: [R; 2],
    /// Slower one of real roots, `alpha` of complex ones.
    slower: [R; 2],
}

/// `C` and `S` of both pairs at a time.
pub type Basis<R> = [R; 4];

/// A sum of the four functions.
#[derive(Clone, Copy, Debug)]
pub struct Wave<R>(pub [R; 4]);

impl<R: Number> Wave<R> {
    /// Value of the wave.
    #[inline(always)]
    pub fn at(&self, basis: &Basis<R>) -> R {
        let [p, q, r, s] = self.0;
        let first = p.mul_add(basis[0], q * basis[1]);
        r.mul_add(basis[2], s.mul_add(basis[3], first))
    }

    /// Values of waves from one of them on. A loop: closures would become functions of their own,
    /// without the instructions of their caller.
    #[inline(always)]
    pub fn values<const N: usize>(waves: &[Self], first: usize, basis: &Basis<R>) -> [R; N] {
        let mut values = [basis[0]; N];
        for (value, wave) in values.iter_mut().zip(&waves[first..first + N]) {
            *value = wave.at(basis);
        }
        values
    }

    /// Value of the wave at first contact.
    #[inline(always)]
    pub fn at_contact(&self) -> R {
        self.0[0] + self.0[2]
    }

    #[inline(always)]
    fn by_pairs(self, pair: impl Fn(usize, R, R) -> [R; 2]) -> Self {
        let [p, q, r, s] = self.0;
        let ([p, q], [r, s]) = (pair(0, p, q), pair(1, r, s));
        Self([p, q, r, s])
    }
}

impl<S: Simd, R: Number> Modes<S, R> {
    /// Squared modulus of the slower pair.
    #[inline(always)]
    pub fn slow(&self) -> R {
        self.modulus[1]
    }

    /// By how much a wave grows over the time from first contact to another one, of which the functions
    /// are given: a wave again.
    #[inline(always)]
    pub fn growth(&self, wave: Wave<R>, by: &Basis<R>) -> Wave<R> {
        wave.by_pairs(
            #[inline(always)]
            |pair, p, q| {
                let (c, s) = (by[2 * pair], by[2 * pair + 1]);
                [
                    p.mul_add(c, q * s) - p,
                    q.mul_add(c, -(p * (self.square[pair] * s))) - q,
                ]
            },
        )
    }

    /// Derivative of a wave.
    #[inline(always)]
    pub fn slope(&self, wave: Wave<R>) -> Wave<R> {
        wave.by_pairs(
            #[inline(always)]
            |pair, p, q| {
                let (decay, square) = (self.decay[pair], self.square[pair]);
                [(-decay).mul_add(p, q), -square.mul_add(p, decay * q)]
            },
        )
    }

    /// The functions a little later, to the second power of the step.
    #[inline(always)]
    pub fn advanced(&self, basis: &Basis<R>, step: R) -> Basis<R> {
        let mut advanced = *basis;
        for pair in 0..2 {
            let (decay, square) = (self.decay[pair], self.square[pair]);
            let slope = inlined(
                #[inline(always)]
                |[c, s]: [R; 2]| [-decay.mul_add(c, square * s), (-decay).mul_add(s, c)],
            );
            let now = [basis[2 * pair], basis[2 * pair + 1]];
            let first = slope(now);
            let second = slope(first);
            for part in 0..2 {
                let mean = (step * 0.5).mul_add(second[part], first[part]);
                advanced[2 * pair + part] = step.mul_add(mean, now[part]);
            }
        }
        advanced
    }

    /// Waves of which each is the derivative of the one before it, of which some are known.
    #[inline(always)]
    fn derivatives<const KNOWN: usize, const N: usize>(
        &self,
        known: [Wave<R>; KNOWN],
    ) -> [Wave<R>; N] {
        let mut waves = [known[KNOWN - 1]; N];
        waves[..KNOWN].copy_from_slice(&known);
        for order in KNOWN..N {
            waves[order] = self.slope(waves[order - 1]);
        }
        waves
    }

    /// Integral of a wave that has no constant part.
    #[inline(always)]
    pub fn integral(&self, wave: Wave<R>) -> Wave<R> {
        wave.by_pairs(
            #[inline(always)]
            |pair, p, q| {
                let decay = self.decay[pair];
                let integrated = -decay.mul_add(p, q) * self.per_modulus[pair];
                [integrated, decay.mul_add(integrated, p)]
            },
        )
    }

    /// The four functions at a time.
    #[inline(always)]
    pub fn basis(&self, time: R) -> Basis<R> {
        apart(
            self.simd,
            #[inline(always)]
            || self.basis_here(time),
        )
    }

    #[inline(always)]
    fn basis_here(&self, time: R) -> Basis<R> {
        let mut basis = [time; 4];
        for pair in 0..2 {
            let (real, frequency) = (self.real[pair], self.frequency[pair]);
            let decay = exponential::<true, R>(-(self.slower[pair] * time));
            let [cosine, sine] = cosine_and_sine(frequency * time);
            let mut scaled = [decay * cosine, decay * sine];
            if real.any() {
                let fast = exponential::<true, R>(-(self.faster[pair] * time));
                scaled = [(decay + fast) * 0.5, (decay - fast) * 0.5].map_with(
                    scaled,
                    #[inline(always)]
                    |real_roots, other| R::select(real, real_roots, other),
                );
            }
            basis[2 * pair] = scaled[0];
            basis[2 * pair + 1] = scaled[1] * self.period[pair];
        }
        basis
    }

    /// The functions at a time, turned on by as much as they turn from first contact to another.
    #[inline(always)]
    pub fn turned(&self, basis: &Basis<R>, by: &Basis<R>) -> Basis<R> {
        let turn = inlined(
            #[inline(always)]
            |pair: usize| {
                let (c, s) = (basis[2 * pair], basis[2 * pair + 1]);
                let (by_c, by_s) = (by[2 * pair], by[2 * pair + 1]);
                [
                    c.mul_add(by_c, -(s * (self.square[pair] * by_s))),
                    s.mul_add(by_c, c * by_s),
                ]
            },
        );
        let ([a, b], [c, d]) = (turn(0), turn(1));
        [a, b, c, d]
    }
}

/// The motion of an impact, times in cells.
#[derive(Clone, Copy)]
pub struct LaneMotion<S, R: Number> {
    /// Its roots.
    pub modes: Modes<S, R>,
    /// Velocity of the head against the torso up to a constant, and five derivatives.
    pub head: [Wave<R>; 6],
    /// Compression up to a constant and a ramp, and five derivatives.
    pub compression: [Wave<R>; 6],
    /// The constant and the ramp.
    pub ramp: [R; 2],
    /// Rate of the lag up to a constant, and four derivatives.
    pub lag_rate: [Wave<R>; 5],
    /// The constant.
    pub lag_ramp: R,
    /// `K_c` and `C_c` for rates per cell.
    pub foam: [R; 2],
    /// Lanes whose roots hold.
    pub accepted: R::Mask,
}

impl<S: Simd, R: Number> LaneMotion<S, R> {
    /// The motion of a plant with a closing speed, in m/s, where there is room for it.
    #[inline(always)]
    pub fn fill<'a>(
        room: &'a mut Option<Self>,
        simd: S,
        plant: &Plant<R>,
        closing_speed: R,
        cell_angle: f64,
    ) -> &'a Self {
        apart(
            simd,
            #[inline(always)]
            || room.insert(Self::new_here(simd, plant, closing_speed, cell_angle)),
        )
    }

    #[inline(always)]
    fn new_here(simd: S, plant: &Plant<R>, closing_speed: R, cell_angle: f64) -> Self {
        let [arm_inverse, arm_damping, arm_stiffness] = plant.manipulator;
        let [head_inverse, head_damping, head_stiffness] = plant.head;
        let [foam_stiffness, foam_damping] = plant.foam;
        let both = arm_inverse + head_inverse;
        let quartic = [
            arm_damping + head_damping + foam_damping * both,
            arm_stiffness
                + head_stiffness
                + foam_stiffness * both
                + arm_damping * head_damping
                + foam_damping * (arm_inverse * head_damping + head_inverse * arm_damping),
            arm_stiffness * head_damping
                + head_stiffness * arm_damping
                + foam_damping * (arm_inverse * head_stiffness + head_inverse * arm_stiffness)
                + foam_stiffness * (arm_inverse * head_damping + head_inverse * arm_damping),
            arm_stiffness * head_stiffness
                + foam_stiffness * (arm_inverse * head_stiffness + head_inverse * arm_stiffness),
        ];
        let (split, settled) = apart(
            simd,
            #[inline(always)]
            || factors(quartic),
        );
        let (modes, split, accepted) = modes(simd, &split, cell_angle);
        let length = modes.length;
        let speed = closing_speed * length;
        let foam = [foam_stiffness, foam_damping * modes.rate];
        // (K_c + C_c s) v_c (s^2 + b1 s + b2) / M over the quartic, b of the other body.
        let pushed = inlined(
            #[inline(always)]
            |inverse: R, damping: R, stiffness: R| {
                let scale = inverse * length * length * speed;
                let (b1, b2) = (damping * length, stiffness * length * length);
                let (k, c) = (foam[0] * scale, foam[1] * scale);
                let parts = split.of([c, k + c * b1, k * b1 + c * b2, k * b2]);
                let wave = inlined(
                    #[inline(always)]
                    |[a, b]: [R; 2], decay: R| [a, b - a * decay],
                );
                let [p, q] = wave(parts[0], modes.decay[0]);
                let [r, s] = wave(parts[1], modes.decay[1]);
                Wave([p, q, r, s])
            },
        );
        let head = pushed(head_inverse, arm_damping, arm_stiffness);
        let lag = pushed(arm_inverse, head_damping, head_stiffness);
        let mut closing = head;
        for (index, part) in closing.0.iter_mut().enumerate() {
            *part = -(head.0[index] + lag.0[index]);
        }
        let rate = modes.integral(closing);
        let compression = modes.integral(rate);
        let lag_rate = modes.integral(lag);
        Self {
            modes,
            head: modes.derivatives([modes.integral(head), head]),
            compression: modes.derivatives([compression, rate, closing]),
            ramp: [-compression.at_contact(), speed - rate.at_contact()],
            lag_rate: modes.derivatives([lag_rate, lag]),
            lag_ramp: -lag_rate.at_contact(),
            foam,
            accepted: accepted & settled,
        }
    }

    /// Compression and five derivatives at a time.
    #[inline(always)]
    pub fn compression(&self, basis: &Basis<R>, time: R) -> [R; 6] {
        let mut values = Wave::values(&self.compression, 0, basis);
        values[0] += self.ramp[0] + self.ramp[1] * time;
        values[1] += self.ramp[1];
        values
    }

    /// Contact force and four derivatives from those of the compression.
    #[inline(always)]
    pub fn force(&self, compression: &[R; 6]) -> [R; 5] {
        let mut force = [compression[0]; 5];
        for (order, value) in force.iter_mut().enumerate() {
            *value =
                self.foam[0].mul_add(compression[order], self.foam[1] * compression[order + 1]);
        }
        force
    }
}

/// Roots of both factors in units of cells, the factors in these units, and lanes that hold.
#[inline(always)]
fn modes<S: Simd, R: Number>(
    simd: S,
    split: &Split<R>,
    cell_angle: f64,
) -> (Modes<S, R>, Split<R>, R::Mask) {
    let zero = split.resultant.like(0.0);
    let mut fastest = zero;
    for [first, last] in split.factors {
        let alpha = first * 0.5;
        let spread = (alpha * alpha - last).max(zero).sqrt();
        let real = alpha.ge(last.sqrt());
        fastest = fastest.max(R::select(real, alpha + spread, last.sqrt()));
    }
    let length = zero.like(cell_angle) / fastest;
    let rate = fastest * (1.0 / cell_angle);
    let square_length = length * length;
    let scaled = split.factors.each(
        #[inline(always)]
        |[first, last]| [first * length, last * square_length],
    );
    let decay = scaled.each(
        #[inline(always)]
        |[first, _]| first * 0.5,
    );
    let modulus = scaled.each(
        #[inline(always)]
        |[_, last]| last,
    );
    let per_modulus = modulus.each(
        #[inline(always)]
        |modulus| zero.like(1.0) / modulus,
    );
    let square = [0, 1].each(
        #[inline(always)]
        |pair: usize| modulus[pair] - decay[pair] * decay[pair],
    );
    let clear = inlined(
        #[inline(always)]
        |pair: usize| {
            square[pair].gt(modulus[pair] * 1e-20)
                | (-square[pair]).gt(modulus[pair] * NEARLY_EQUAL)
        },
    );
    let scaled = Split::new(scaled);
    let fourth = modulus[0] * LEAST_RESULTANT * modulus[0];
    let accepted = clear(0)
        & clear(1)
        & scaled.resultant.gt(fourth)
        & decay[0].ge(zero)
        & decay[1].ge(zero)
        & modulus[1].gt(zero);
    let frequency = square.each(
        #[inline(always)]
        |value| value.abs().sqrt(),
    );
    let period = frequency.each(
        #[inline(always)]
        |frequency| zero.like(1.0) / frequency,
    );
    let real = square.each(
        #[inline(always)]
        |value| value.lt(zero),
    );
    let faster = decay.map_with(
        frequency,
        #[inline(always)]
        |decay, frequency| decay + frequency,
    );
    // The slower root is the product over the faster one.
    let slower = [0, 1].each(
        #[inline(always)]
        |pair: usize| R::select(real[pair], modulus[pair] / faster[pair], decay[pair]),
    );
    let modes = Modes {
        simd,
        length,
        rate,
        decay,
        modulus,
        per_modulus,
        square,
        frequency,
        period,
        real,
        faster,
        slower,
    };
    (modes, scaled, accepted)
}
