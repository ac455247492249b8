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
        let resultant = q.mul_add((-p).mul_add(a, q), p * p * b);
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
        let slope = (-p).mul_add(a, q);
        // What is left by the division by the first factor.
        let lead = (-p3).mul_add(a, p2);
        let r1 = (-lead).mul_add(a, (-p3).mul_add(b, p1));
        let r0 = (-lead).mul_add(b, p0);
        let first = [
            q.mul_add(r1, -(p * r0)) * self.over,
            slope.mul_add(r0, p * b * r1) * self.over,
        ];
        // And by the second one.
        let lead = (-p3).mul_add(c, p2);
        let r1 = (-lead).mul_add(c, (-p3).mul_add(d, p1));
        let r0 = (-lead).mul_add(d, p0);
        let second = [
            p.mul_add(r0, -(q * r1)) * self.over,
            p.mul_add(c, -q).mul_add(r0, -(p * d * r1)) * self.over,
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
    let linear = q1.mul_add(q3, q4 * -4.0);
    let constant = (q2 * 4.0).mul_add(q4, -(q3 * q3)) - q1 * q1 * q4;
    let mut sum = q2;
    for _ in 0..RESOLVENT_STEPS {
        let value = (sum - q2).mul_add(sum, linear).mul_add(sum, constant);
        let slope = (sum * 3.0 - q2 - q2).mul_add(sum, linear);
        sum -= value / slope;
    }
    let difference = sum.mul_add(sum, q4 * -4.0).max(sum.like(0.0)).sqrt();
    let b = (sum + difference) * 0.5;
    let d = q4 / b;
    let c = (-q1).mul_add(d, q3) / (b - d);
    let mut split = Split::new([[q1 - c, b], [c, d]]);
    let mut settled = sum.truth(false);
    for _ in 0..FACTOR_STEPS {
        let [[a, b], [c, d]] = split.factors;
        let missing = [
            q1 - (a + c),
            q2 - (a.mul_add(c, b) + d),
            q3 - a.mul_add(d, b * c),
            (-b).mul_add(d, q4),
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
