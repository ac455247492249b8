//! Numbers in vectors of the processor, where it has them.

use std::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, MulAssign, Neg, Not, Sub, SubAssign};

use pulp::{Simd, bytemuck};

use super::{Number, Truth};

/// Numbers side by side in vectors of the processor.
///
/// Arrays leave it to the compiler what becomes a vector, and of comparisons little does. A number
/// of this kind exists only where the processor has the vectors: it carries the proof of it.
#[derive(Clone, Copy, Debug)]
pub struct Packed<S: Simd> {
    simd: S,
    numbers: S::f64s,
}

/// Truths side by side in vectors of the processor.
#[derive(Clone, Copy, Debug)]
pub struct PackedMask<S: Simd> {
    simd: S,
    truths: S::m64s,
}

impl<S: Simd> Packed<S> {
    /// A number with one value in every lane.
    #[inline(always)]
    pub fn splat(simd: S, value: f64) -> Self {
        Self {
            simd,
            numbers: simd.splat_f64s(value),
        }
    }
}

#[inline(always)]
fn lanes<S: Simd>(numbers: &S::f64s) -> &[f64] {
    bytemuck::cast_slice(std::slice::from_ref(numbers))
}

#[inline(always)]
fn lanes_mut<S: Simd>(numbers: &mut S::f64s) -> &mut [f64] {
    bytemuck::cast_slice_mut(std::slice::from_mut(numbers))
}

// Operations of the processor are written out: a function passed to another one is not compiled into it,
// nor for the instructions of its caller.
macro_rules! operator {
    ($operator:ident, $method:ident, $assignment:ident, $assign:ident, $of_simd:ident) => {
        impl<S: Simd> $operator for Packed<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self {
                    numbers: self.simd.$of_simd(self.numbers, other.numbers),
                    ..self
                }
            }
        }
        impl<S: Simd> $operator<f64> for Packed<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                self.$method(self.like(other))
            }
        }
        impl<S: Simd> $assignment for Packed<S> {
            #[inline(always)]
            fn $assign(&mut self, other: Self) {
                *self = self.$method(other);
            }
        }
    };
}
operator!(Add, add, AddAssign, add_assign, add_f64s);
operator!(Sub, sub, SubAssign, sub_assign, sub_f64s);
operator!(Mul, mul, MulAssign, mul_assign, mul_f64s);

impl<S: Simd> Div for Packed<S> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        Self {
            numbers: self.simd.div_f64s(self.numbers, other.numbers),
            ..self
        }
    }
}

impl<S: Simd> Neg for Packed<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self {
            numbers: self.simd.neg_f64s(self.numbers),
            ..self
        }
    }
}

impl<S: Simd> Number for Packed<S> {
    type Mask = PackedMask<S>;
    const WIDTH: usize = S::F64_LANES;

    #[inline(always)]
    fn like(self, value: f64) -> Self {
        Self::splat(self.simd, value)
    }
    #[inline(always)]
    fn like_each(mut self, mut value: impl FnMut(usize) -> f64) -> Self {
        for (lane, number) in lanes_mut::<S>(&mut self.numbers).iter_mut().enumerate() {
            *number = value(lane);
        }
        self
    }
    #[inline(always)]
    fn write(self, to: &mut [f64]) {
        let lanes = lanes::<S>(&self.numbers);
        if to.len() == lanes.len() {
            to.copy_from_slice(lanes);
        } else {
            to.copy_from_slice(&lanes[..to.len()]);
        }
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        Self {
            numbers: self
                .simd
                .mul_add_f64s(self.numbers, factor.numbers, addend.numbers),
            ..self
        }
    }
    #[inline(always)]
    fn truth(self, value: bool) -> PackedMask<S> {
        // Also where masks are bits.
        let other = if value { 2.0 } else { 0.0 };
        self.like(1.0).lt(self.like(other))
    }
    #[inline(always)]
    fn lane(self, index: usize) -> f64 {
        lanes::<S>(&self.numbers)[index]
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self {
            numbers: self.simd.sqrt_f64s(self.numbers),
            ..self
        }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self {
            numbers: self.simd.abs_f64s(self.numbers),
            ..self
        }
    }
    #[inline(always)]
    fn power_of_two(mut self) -> Self {
        for number in lanes_mut::<S>(&mut self.numbers) {
            *number = number.power_of_two();
        }
        self
    }
    #[inline(always)]
    fn lt(self, other: Self) -> PackedMask<S> {
        PackedMask {
            simd: self.simd,
            truths: self.simd.less_than_f64s(self.numbers, other.numbers),
        }
    }
    #[inline(always)]
    fn le(self, other: Self) -> PackedMask<S> {
        PackedMask {
            simd: self.simd,
            truths: self
                .simd
                .less_than_or_equal_f64s(self.numbers, other.numbers),
        }
    }
    // One instruction where a comparison and a choice are two: x86 gives the second number, too, where either is NaN.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self {
            numbers: self.simd.min_f64s(self.numbers, other.numbers),
            ..self
        }
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self {
            numbers: self.simd.max_f64s(self.numbers, other.numbers),
            ..self
        }
    }
    #[inline(always)]
    fn select(mask: PackedMask<S>, then: Self, otherwise: Self) -> Self {
        Self {
            numbers: then
                .simd
                .select_f64s(mask.truths, then.numbers, otherwise.numbers),
            ..then
        }
    }
}

macro_rules! mask_operator {
    ($operator:ident, $method:ident, $of_simd:ident) => {
        impl<S: Simd> $operator for PackedMask<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self {
                    truths: self.simd.$of_simd(self.truths, other.truths),
                    ..self
                }
            }
        }
    };
}
mask_operator!(BitAnd, bitand, and_m64s);
mask_operator!(BitOr, bitor, or_m64s);

impl<S: Simd> Not for PackedMask<S> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self {
            truths: self.simd.not_m64s(self.truths),
            ..self
        }
    }
}

impl<S: Simd> PackedMask<S> {
    /// Whether a truth takes as much room as a number, all ones or all zeros; else it takes a bit.
    const WIDE: bool = size_of::<S::m64s>() == size_of::<S::u64s>();

    /// Truths as numbers; only where they are that wide.
    #[inline(always)]
    fn numbers(&self) -> &[u64] {
        bytemuck::cast_slice(bytemuck::bytes_of(&self.truths))
    }
}

impl<S: Simd> Truth for PackedMask<S> {
    #[inline(always)]
    fn any(self) -> bool {
        if !Self::WIDE {
            return self.bits() != 0;
        }
        let mut joined = 0;
        for &truth in self.numbers() {
            joined |= truth;
        }
        joined != 0
    }
    #[inline(always)]
    fn lane(self, index: usize) -> bool {
        if Self::WIDE {
            self.numbers()[index] != 0
        } else {
            self.bits() >> index & 1 == 1
        }
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        let mut bits = 0;
        if Self::WIDE {
            for (lane, &truth) in self.numbers().iter().enumerate() {
                bits |= ((truth >> 63) as u32) << lane;
            }
        } else {
            for (place, &byte) in bytemuck::bytes_of(&self.truths).iter().enumerate() {
                bits |= u32::from(byte) << (8 * place);
            }
        }
        bits
    }
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use super::*;
    use crate::elementary::{cosine_and_sine, exponential};
    use pulp::x86::{V3, V3_512b, V4};

    /// Two sets of eight numbers: of any kind, and of moderate size.
    fn numbers(round: u64) -> [[f64; 8]; 2] {
        let mut state = round + 1;
        let mut next = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            state
        };
        let any = std::array::from_fn(|lane| match next() >> 60 {
            0 => f64::NAN,
            1 => [f64::INFINITY, f64::NEG_INFINITY, 0.0, -0.0][lane % 4],
            _ => f64::from_bits(next()),
        });
        let moderate = std::array::from_fn(|_| (next() >> 11) as f64 / (1_u64 << 46) as f64 - 64.0);
        [any, moderate]
    }

    fn same(found: f64, expected: f64) -> bool {
        found.to_bits() == expected.to_bits() || found.is_nan() && expected.is_nan()
    }

    fn lanes_equal_plain_numbers<S: Simd>(simd: S) {
        type Both = fn(f64, f64) -> f64;
        let zero = Packed::splat(simd, 0.0);
        for round in 0..400 {
            let [[a, b], [c, _]] = [numbers(round), numbers(round + 1000)];
            for (a, b) in [(a, b), (b, c), (a, a), (c, a)] {
                let [x, y] = [a, b].map(|values| zero.like_each(|lane| values[lane]));
                let found = [
                    x + y,
                    x - y,
                    x * y,
                    x / y,
                    x.min(y),
                    x.max(y),
                    x + 0.5,
                    x - 0.5,
                    x * 0.5,
                    x.mul_add(y, x),
                ];
                let expected: [Both; 10] = [
                    |a, b| a + b,
                    |a, b| a - b,
                    |a, b| a * b,
                    |a, b| a / b,
                    Number::min,
                    Number::max,
                    |a, _| a + 0.5,
                    |a, _| a - 0.5,
                    |a, _| a * 0.5,
                    |a, b| a.mul_add(b, a),
                ];
                let single = [-x, x.sqrt(), x.abs(), Packed::select(x.lt(y), x, y)];
                let plain: [Both; 4] = [
                    |a, _| -a,
                    |a, _| a.sqrt(),
                    |a, _| a.abs(),
                    |a, b| if a < b { a } else { b },
                ];
                let masks = [
                    x.lt(y),
                    x.le(y),
                    x.gt(y),
                    x.ge(y),
                    !(x.lt(y) | x.ge(y)),
                    x.le(y) & x.ge(y),
                ];
                for lane in 0..8 {
                    let (a, b) = (a[lane], b[lane]);
                    for (index, (found, expected)) in found.iter().zip(expected).enumerate() {
                        assert!(same(found.lane(lane), expected(a, b)), "{index}: {a} {b}");
                    }
                    for (index, (found, expected)) in single.iter().zip(plain).enumerate() {
                        assert!(same(found.lane(lane), expected(a, b)), "{index}: {a} {b}");
                    }
                    let truths = [a < b, a <= b, a > b, a >= b, !(a < b || a >= b), a == b];
                    for (mask, truth) in masks.into_iter().zip(truths) {
                        assert_eq!(mask.lane(lane), truth, "{a} {b}");
                        assert_eq!(mask.bits() >> lane & 1 == 1, truth);
                    }
                }
                for mask in masks {
                    assert_eq!(mask.any(), mask.bits() != 0);
                    assert!(mask.bits() < 256);
                }
            }
            let [_, b] = numbers(round);
            let x = zero.like_each(|lane| b[lane]);
            let ([cosine, sine], growth) = (cosine_and_sine(x), exponential::<true, _>(x));
            let mut written = [0.0; 5];
            growth.write(&mut written);
            for lane in 0..8 {
                let [c, s] = cosine_and_sine(b[lane]);
                assert_eq!([cosine.lane(lane), sine.lane(lane)], [c, s]);
                assert_eq!(growth.lane(lane), exponential::<true, _>(b[lane]));
                assert!(lane > 4 || written[lane] == growth.lane(lane));
            }
        }
        let [yes, no] = [zero.truth(true), zero.truth(false)];
        assert_eq!(
            (yes.bits(), no.bits(), yes.any(), no.any()),
            (255, 0, true, false)
        );
        assert_eq!(zero.like(2.5).lane(7), 2.5);
    }

    #[test]
    fn pairs_of_256_bits_equal_plain_numbers() {
        if let Some(simd) = V3::try_new() {
            lanes_equal_plain_numbers(V3_512b(simd));
        }
    }

    #[test]
    fn vectors_of_512_bits_equal_plain_numbers() {
        if let Some(simd) = V4::try_new() {
            lanes_equal_plain_numbers(simd);
        }
    }
}
