//! Vectors of the processor, which is asked at run time.

use pulp::Simd;

use super::Number;

/// Vectors with which lanes pay. Without them lanes would take another copy of every kernel for x86
/// processors that are rare: there work is done one after the other, with the same bits.
#[cfg(target_arch = "x86_64")]
pub type Vectors = pulp::x86::V3;
/// Vectors of the family, which every processor of it has.
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
    /// Result of the work.
    type Output;
    /// Does it, with instructions that it may be compiled for and zero in every lane.
    fn on_eight<S: Simd, R: Number>(self, simd: S, zero: R) -> Self::Output;
}

/// Does work in the widest vectors of the processor, those of 512 bits if they may be used, or returns it
/// where lanes do not pay.
///
/// # Errors
/// The processor has no vectors with which lanes pay.
#[cfg(target_arch = "x86_64")]
pub fn on_eight<W: OnEight>(wide: bool, work: W) -> Result<W::Output, W> {
    use super::Packed;
    use pulp::x86::{V3_512b, V4};
    if let Some(simd) = V4::try_new().filter(|_| wide) {
        return Ok(work.on_eight(simd, Packed::splat(simd, 0.0)));
    }
    let Some(vectors) = vectors() else {
        return Err(work);
    };
    let pair = V3_512b(vectors);
    Ok(work.on_eight(vectors, Packed::splat(pair, 0.0)))
}

/// Does work on eight numbers.
///
/// # Errors
/// None here: what every processor of the family has is enough.
#[cfg(not(target_arch = "x86_64"))]
pub fn on_eight<W: OnEight>(_wide: bool, work: W) -> Result<W::Output, W> {
    let zero: super::Lanes<8> = super::Zero::zero();
    Ok(work.on_eight(pulp::Scalar, zero))
}
