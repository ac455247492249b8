//! Places that a robot has never seen: what its scans show of them, and what they do not.

#![forbid(unsafe_code)]

pub mod map;
