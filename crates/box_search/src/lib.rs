//! Search over boxes: coarse-to-fine grid, constrained local search, global methods, sets of
//! best compromises.
//!
//! The searches know a [`Problem`] and nothing of robots. Every result is the same, bit for bit, for any
//! number of threads, and after an interruption that was resumed.

#![forbid(unsafe_code)]

mod archive;
mod ask_tell;
mod blocks;
mod evaluated;
mod front;
mod global;
mod grid;
mod local;
mod observe;
mod pareto;
mod problem;
mod procedure;
mod search_state;
mod solvers;
mod stage;

pub use blocks::evaluate_all;
pub use evaluated::Evaluated;
pub use front::{Front, FrontOptions, FrontRound, front_search};
pub use global::{GlobalMethod, GlobalOptions, GlobalSearch, global_search};
pub use grid::{GridOptions, Round};
pub use local::{LocalMethod, LocalOptions, LocalSearch, LocalStatus, local_search};
pub use observe::{Control, Observer, Report};
pub use pareto::{hypervolume, non_dominated};
pub use problem::{Bounds, Candidate, Evaluation, FEASIBILITY, Problem, Score};
pub use procedure::{Search, SearchOptions, search};
pub use search_state::SearchState;
pub use stage::Stage;
