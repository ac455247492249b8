//! All tests of the crate from outside in one binary: what is generic is compiled for them once.

mod batch;
mod foam_design;
mod gradients;
mod nominal;
