//! A polynomial of fourth degree as the product of two factors.

use numeric::lanes::Number;

/// Newton steps for the sum of the squared moduli of both pairs.
const RESOLVENT_STEPS: usize = 8;
/// Newton steps for the factors.
const FACTOR_STEPS: usize = 3;
/// Last of these steps, relative; its square is the error.
const SETTLED_FACTOR: f64 = 1e-7;

/// `s^2 + first s + last`, as `[first, last]`.
pub(super) type Factor<R> = [R; 2];

/// `(p3 s^3 + p2 s^2 + p1 s + p0) / (f g)` as the sum of `(A s + B) / f` and of the same over `g`.
pub(super) struct Split<R> {
    pub(super) factors: [Factor<R>; 2],
    pub(super) resultant: R,
    over: R,
}

impl<R: Number> Split<R> {
    #[inline(always)]
    pub(super) fn new(factors: [Factor<R>; 2]) -> Self {
        let [[a, b], [c, d]] = factors;
        let (p, q) = (c - a, d - b);
        let resultant = q * (q - p * a) + p * p * b;
        Self {
            factors,
            resultant,
            over: resultant.like(1.0) / resultant,
        }
    }

    /// `[A, B]` of both fractions, from `[p3, p2, p1, p0]`.
    #[inline(always)]
    pub(super) fn of(&self, [p3, p2, p1, p0]: [R; 4]) -> [[R; 2]; 2] {
        let [[a, b], [c, d]] = self.factors;
        let (p, q) = (c - a, d - b);
        let slope = q - p * a;
        // What is left by the division by the first factor.
        let lead = p2 - p3 * a;
        let r1 = p1 - p3 * b - lead * a;
        let r0 = p0 - lead * b;
        let first = [
            (q * r1 - p * r0) * self.over,
            (slope * r0 + p * b * r1) * self.over,
        ];
        // And by the second one.
        let lead = p2 - p3 * c;
        let r1 = p1 - p3 * d - lead * c;
        let r0 = p0 - lead * d;
        let second = [
            (p * r0 - q * r1) * self.over,
            ((p * c - q) * r0 - p * d * r1) * self.over,
        ];
        [first, second]
    }
}

/// Factors of `s^4 + q1 s^3 + q2 s^2 + q3 s + q4` with positive coefficients, no root of it to the
/// right of the imaginary axis; the first one has the larger last coefficient. Lanes without
/// `settled` are wrong.
#[inline(always)]
pub(super) fn factors<R: Number>([q1, q2, q3, q4]: [R; 4]) -> (Split<R>, R::Mask) {
    // The sum of the last coefficients is the largest root of a cubic, from above which Newton
    // steps fall without fail; at q2 the cubic is the determinant of Routh and Hurwitz.
    let linear = q1 * q3 - q4 * 4.0;
    let constant = q2 * 4.0 * q4 - q3 * q3 - q1 * q1 * q4;
    let mut sum = q2;
    for _ in 0..RESOLVENT_STEPS {
        let value = ((sum - q2) * sum + linear) * sum + constant;
        let slope = (sum * 3.0 - q2 - q2) * sum + linear;
        sum -= value / slope;
    }
    let difference = (sum * sum - q4 * 4.0).max(sum.like(0.0)).sqrt();
    let b = (sum + difference) * 0.5;
    let d = q4 / b;
    let c = (q3 - q1 * d) / (b - d);
    let mut split = Split::new([[q1 - c, b], [c, d]]);
    let mut settled = sum.truth(false);
    for _ in 0..FACTOR_STEPS {
        let [[a, b], [c, d]] = split.factors;
        let missing = [
            q1 - (a + c),
            q2 - (b + a * c + d),
            q3 - (a * d + b * c),
            q4 - b * d,
        ];
        let [[da, db], [dc, dd]] = split.of(missing);
        let limit = sum.like(SETTLED_FACTOR);
        let first = (da * da).le(limit * limit * b) & db.abs().le(limit * b);
        let second = (dc * dc).le(limit * limit * d) & dd.abs().le(limit * d);
        settled = first & second;
        split = Split::new([[a + da, b + db], [c + dc, d + dd]]);
    }
    (split, settled)
}
