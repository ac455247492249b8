//! Vectors of the processor, which is asked at run time.

/// Vectors with which lanes pay. Without them lanes would take another copy of every kernel for x86
/// processors that are rare: there work is done one after the other, with the same bits.
#[cfg(target_arch = "x86_64")]
pub type Vectors = pulp::x86::V3;
/// What every processor of the family has is enough.
#[cfg(not(target_arch = "x86_64"))]
pub type Vectors = pulp::Scalar;

/// The vectors, if the processor has them; `pulp::Simd::vectorize` compiles work for them.
#[must_use]
pub fn vectors() -> Option<Vectors> {
    #[cfg(target_arch = "x86_64")]
    return Vectors::try_new();
    #[cfg(not(target_arch = "x86_64"))]
    return Some(pulp::Scalar);
}

/// Eight numbers side by side, in vectors.
#[cfg(target_arch = "x86_64")]
pub type Eight = super::Vector<pulp::x86::V3_512b>;
/// Eight numbers side by side.
#[cfg(not(target_arch = "x86_64"))]
pub type Eight = super::Lanes<8>;

/// Eight times the same number.
#[inline(always)]
#[must_use]
pub fn eight(vectors: Vectors, value: f64) -> Eight {
    #[cfg(target_arch = "x86_64")]
    return super::Vector::splat(pulp::x86::V3_512b(vectors), value);
    #[cfg(not(target_arch = "x86_64"))]
    {
        let pulp::Scalar = vectors;
        return super::Real::splat(value);
    }
}
