//! Search for gains: the problem, how a search is watched, what it returns.

pub mod problem;
mod results;
mod scorer;
pub mod searches;
mod watch;
