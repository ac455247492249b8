//! Long pieces of a kernel as functions of their own.

use pulp::{Simd, WithSimd};

struct Apart<F>(F);

impl<T, F: FnOnce() -> T> WithSimd for Apart<F> {
    type Output = T;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) -> T {
        (self.0)()
    }
}

/// Does some work in a function of its own that is compiled for the instructions in use. A kernel
/// in one piece takes a compiler minutes.
#[inline(always)]
pub fn apart<S: Simd, T>(simd: S, work: impl FnOnce() -> T) -> T {
    if S::IS_SCALAR {
        baseline(work)
    } else {
        simd.vectorize(Apart(work))
    }
}

/// A function that is compiled into its callers; a longer one would else be one of its own, without their
/// instructions.
#[inline(always)]
pub fn inlined<F>(function: F) -> F {
    function
}

#[inline(never)]
fn baseline<T>(work: impl FnOnce() -> T) -> T {
    work()
}
