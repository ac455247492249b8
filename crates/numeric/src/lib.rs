//! Foundation of all cores: errors with their data, checks of numbers, numbers and vectors side by
//! side, elementary functions of them, streams of random numbers, threads.

#![forbid(unsafe_code)]

pub mod angle;
pub mod elementary;
pub mod error;
pub mod lanes;
pub mod order;
pub mod parallel;
pub mod pcg64;
pub mod philox;
pub mod random;
pub mod threads;
