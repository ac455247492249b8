//! Vectors of the processor, which is asked at run time.

use pulp::Simd;

use super::Number;

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

/// Work on eight numbers side by side.
pub trait OnEight {
    /// What it gives.
    type Output;
    /// Does it, with instructions that may be used and zero in every lane.
    fn on_eight<S: Simd, R: Number>(self, simd: S, zero: R) -> Self::Output;
}

/// Does work compiled for the widest vectors of the processor, or returns it where lanes do not pay.
///
/// # Errors
/// The processor has no vectors with which lanes pay.
#[cfg(target_arch = "x86_64")]
pub fn on_eight<W: OnEight>(work: W) -> Result<W::Output, W> {
    use pulp::x86::{V3_512b, V4};
    if let Some(simd) = V4::try_new() {
        return Ok(with_vectors(simd, work));
    }
    match vectors() {
        Some(simd) => Ok(with_vectors(V3_512b(simd), work)),
        None => Err(work),
    }
}

/// Does work on eight numbers.
///
/// # Errors
/// None here: what every processor of the family has is enough.
#[cfg(not(target_arch = "x86_64"))]
pub fn on_eight<W: OnEight>(work: W) -> Result<W::Output, W> {
    let zero: super::Lanes<8> = super::Zero::zero();
    Ok(work.on_eight(pulp::Scalar, zero))
}

/// Does work with vectors that hold eight numbers.
#[cfg(target_arch = "x86_64")]
pub fn with_vectors<S: Simd, W: OnEight>(simd: S, work: W) -> W::Output {
    struct In<S, W>(S, W);
    impl<V: Simd, W: OnEight> pulp::WithSimd for In<V, W> {
        type Output = W::Output;

        #[inline(always)]
        fn with_simd<S: Simd>(self, _same: S) -> W::Output {
            let Self(simd, work) = self;
            work.on_eight(simd, super::Vector::splat(simd, 0.0))
        }
    }
    const { assert!(S::F64_LANES == 8) };
    simd.vectorize(In(simd, work))
}
