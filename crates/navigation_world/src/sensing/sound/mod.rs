//! Range and bearing of a sound from three microphones in a row.
//!
//! The microphones M1, M2, M3 stand at y = -l, 0, l of a frame with x ahead and y to the left; M3 is
//! the left one. Bearings count from straight ahead, positive to the left. A row cannot tell front
//! from back, so the source is taken to be in front. Equation numbers are those of the paper of 2019
//! on sound-following robots by active virtual impedance; corrected forms are named as such.

// Counts of samples and lags are far below 2^31, and never negative where they are cast.
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss
)]

pub mod batch;
pub mod burst;
pub mod correlation;
pub mod delays;
pub mod fix;
pub mod interpolation;
pub mod microphones;
pub mod recording;
pub mod trials;

/// Whether the caller asks to stop.
pub type Interrupted<'a> = &'a (dyn Fn() -> bool + Sync);
