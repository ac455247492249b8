//! What all cores stand on: errors with their data, checks of numbers, thread pools.

#![forbid(unsafe_code)]

pub mod error;
pub mod threads;
