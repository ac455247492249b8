//! Arithmetic on numbers side by side, and on values with their derivatives.

use numeric::lanes::Number;

/// A function of every entry of a short array, in line: the standard `map` becomes a function of
/// its own for entries this wide.
pub(super) trait Each<T> {
    type Of<U>;
    fn each<U>(self, map: impl FnMut(T) -> U) -> Self::Of<U>;
}

macro_rules! each {
    ($count:literal: $($entry:ident),+) => {
        impl<T> Each<T> for [T; $count] {
            type Of<U> = [U; $count];
            #[inline(always)]
            fn each<U>(self, mut map: impl FnMut(T) -> U) -> [U; $count] {
                let [$($entry),+] = self;
                [$(map($entry)),+]
            }
        }
    };
}
each!(2: a, b);
each!(3: a, b, c);
each!(4: a, b, c, d);
each!(5: a, b, c, d, e);

/// Pairs of two arrays, one by one.
pub(super) trait MapWith<R> {
    fn map_with(self, other: Self, map: impl Fn(R, R) -> R) -> Self;
}

impl<R: Copy, const N: usize> MapWith<R> for [R; N] {
    #[inline(always)]
    fn map_with(mut self, other: Self, map: impl Fn(R, R) -> R) -> Self {
        for (mine, theirs) in self.iter_mut().zip(other) {
            *mine = map(*mine, theirs);
        }
        self
    }
}

/// Step to a zero from value, slope and curvature near it, of third order.
#[inline(always)]
pub(super) fn third_order<R: Number>(value: R, slope: R, curve: R) -> R {
    let one = slope.like(1.0);
    let inverse = one / slope;
    let newton = value * inverse;
    let bend = newton * 0.5 * curve * inverse;
    let mild = bend.abs().lt(slope.like(0.5));
    -(newton / R::select(mild, one - bend, one))
}

/// Binomial coefficients.
const BINOMIAL: [[f64; 5]; 5] = [
    [1.0, 0.0, 0.0, 0.0, 0.0],
    [1.0, 1.0, 0.0, 0.0, 0.0],
    [1.0, 2.0, 1.0, 0.0, 0.0],
    [1.0, 3.0, 3.0, 1.0, 0.0],
    [1.0, 4.0, 6.0, 4.0, 1.0],
];

/// Value and derivatives of a product, by the rule of Leibniz.
#[inline(always)]
pub(super) fn product<R: Number, const N: usize>(f: [R; N], g: [R; N]) -> [R; N] {
    let mut derivatives = [f[0].like(0.0); N];
    for (order, (derivative, row)) in derivatives.iter_mut().zip(BINOMIAL).enumerate() {
        for (left, factor) in row.into_iter().enumerate().take(order + 1) {
            *derivative = (f[left] * factor).mul_add(g[order - left], *derivative);
        }
    }
    derivatives
}
