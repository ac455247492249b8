//! Numbers with exact partial derivatives, carried through the series of the response.

use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use numeric::lanes::{Number, One, Real, Zero};

/// A value and its partial derivatives with respect to `N` parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<const N: usize> {
    /// The value.
    pub value: f64,
    /// The derivatives.
    pub partial: [f64; N],
}

impl<const N: usize> Dual<N> {
    /// A constant.
    #[must_use]
    pub fn constant(value: f64) -> Self {
        Self {
            value,
            partial: [0.0; N],
        }
    }

    /// The parameter with an index.
    #[must_use]
    pub fn parameter(value: f64, index: usize) -> Self {
        let mut partial = [0.0; N];
        partial[index] = 1.0;
        Self { value, partial }
    }

    /// A function of this number with its value and slope there.
    fn chain(self, value: f64, slope: f64) -> Self {
        Self {
            value,
            partial: self.partial.map(|partial| slope * partial),
        }
    }

    fn joined(self, other: Self, value: f64, slopes: [f64; 2]) -> Self {
        let partial = std::array::from_fn(|index| {
            slopes[0] * self.partial[index] + slopes[1] * other.partial[index]
        });
        Self { value, partial }
    }
}

impl<const N: usize> Add for Dual<N> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.joined(other, self.value + other.value, [1.0, 1.0])
    }
}

impl<const N: usize> AddAssign for Dual<N> {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<const N: usize> SubAssign for Dual<N> {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<const N: usize> MulAssign for Dual<N> {
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl<const N: usize> Zero for Dual<N> {
    fn zero() -> Self {
        Self::constant(0.0)
    }
    fn is_zero(&self) -> bool {
        *self == Self::zero()
    }
}

impl<const N: usize> One for Dual<N> {
    fn one() -> Self {
        Self::constant(1.0)
    }
}

impl<const N: usize> Sub for Dual<N> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.joined(other, self.value - other.value, [1.0, -1.0])
    }
}

impl<const N: usize> Mul for Dual<N> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.joined(other, self.value * other.value, [other.value, self.value])
    }
}

impl<const N: usize> Div for Dual<N> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        self.joined(other, value, [1.0 / other.value, -value / other.value])
    }
}

impl<const N: usize> Neg for Dual<N> {
    type Output = Self;
    fn neg(self) -> Self {
        self.chain(-self.value, -1.0)
    }
}

impl<const N: usize> Add<f64> for Dual<N> {
    type Output = Self;
    fn add(self, other: f64) -> Self {
        self.chain(self.value + other, 1.0)
    }
}

impl<const N: usize> Sub<f64> for Dual<N> {
    type Output = Self;
    fn sub(self, other: f64) -> Self {
        self.chain(self.value - other, 1.0)
    }
}

impl<const N: usize> Mul<f64> for Dual<N> {
    type Output = Self;
    fn mul(self, other: f64) -> Self {
        self.chain(self.value * other, other)
    }
}

/// Comparisons look at values only.
impl<const N: usize> Number for Dual<N> {
    type Mask = bool;
    const WIDTH: usize = 1;

    fn like(self, value: f64) -> Self {
        Self::constant(value)
    }
    fn like_each(self, mut value: impl FnMut(usize) -> f64) -> Self {
        Self::constant(value(0))
    }
    fn write(self, to: &mut [f64]) {
        to.copy_from_slice(&[self.value][..to.len()]);
    }
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        self * factor + addend
    }
    fn truth(self, value: bool) -> bool {
        value
    }
    fn lane(self, _index: usize) -> f64 {
        self.value
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, 0.5 / root)
    }
    fn abs(self) -> Self {
        self.chain(self.value.abs(), 1.0_f64.copysign(self.value))
    }
    fn power_of_two(self) -> Self {
        Self::constant(self.value.power_of_two())
    }
    fn lt(self, other: Self) -> bool {
        self.value < other.value
    }
    fn le(self, other: Self) -> bool {
        self.value <= other.value
    }
    fn select(mask: bool, then: Self, otherwise: Self) -> Self {
        if mask { then } else { otherwise }
    }
}

impl<const N: usize> Real for Dual<N> {
    fn splat(value: f64) -> Self {
        Self::constant(value)
    }
    fn from_fn(mut value: impl FnMut(usize) -> f64) -> Self {
        Self::constant(value(0))
    }
    fn replace(self, _index: usize, value: f64) -> Self {
        Self::constant(value)
    }
    fn copysign(self, sign: Self) -> Self {
        let value = self.value.copysign(sign.value);
        let slope = if value == self.value { 1.0 } else { -1.0 };
        self.chain(value, slope)
    }
}
