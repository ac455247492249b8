//! Places that a robot has never seen: what its scans show of them, and what they do not.

#![forbid(unsafe_code)]
// Windows have at most 2^20 cells, places are checked to lie in them, and evidence and times are kept in 32 bits.
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss
)]

pub mod explore;
pub mod guide;
pub mod map;
pub mod unseen;
