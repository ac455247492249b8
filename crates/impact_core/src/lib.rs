//! Impact of a manipulator with a foam covering on a human head, neck and torso.
//!
//! Equations follow L. Zeng, "Design and control of human-friendly robots", doctoral thesis,
//! Canada, 2011, chapters 3 and 4 and appendix A, with their misprints corrected.
//! SI units and radians throughout.

#![forbid(unsafe_code)]

pub use numeric::error;

pub mod allowed;
pub mod arm;
pub mod bare;
pub mod batch;
pub mod collision;
pub mod columns;
pub mod contact;
pub mod covering;
pub mod criteria;
pub mod dual;
pub mod fast;
pub mod foam_design;
pub mod gradients;
pub mod identify;
pub mod joint;
pub mod metrics;
pub mod parameters;
pub mod program;
mod quantile;
pub mod response;
pub mod roots;
pub mod separation;
pub mod series;
pub mod signal;
pub mod windows;
