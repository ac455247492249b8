//! Watching a search, stopping it.

use crate::problem::Candidate;
use crate::search_state::SearchState;
use crate::stage::Stage;

/// How far a search is.
#[derive(Clone, Copy, Debug)]
pub struct Report<'a> {
    /// Part of the search.
    pub stage: Stage,
    /// Evaluations done in it; for the local stage, searches.
    pub done: u64,
    /// Of how many.
    pub total: u64,
    /// Best point so far; `None` before the first one and for several objectives.
    pub best: Option<&'a Candidate>,
}

/// Answer of an observer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Control {
    /// Go on.
    Continue,
    /// Stop, with the best so far.
    Stop,
}

/// Hears of every piece of work done. Calls do not overlap, but come from any thread.
pub trait Observer: Sync {
    /// A piece of work is done. `state` gives all that is needed to resume from here.
    fn report(&self, report: &Report<'_>, state: &dyn Fn() -> SearchState) -> Control;
    /// Whether the search is to stop, asked often between two reports.
    fn stopped(&self) -> bool {
        false
    }
}

/// Does not care.
impl Observer for () {
    fn report(&self, _report: &Report<'_>, _state: &dyn Fn() -> SearchState) -> Control {
        Control::Continue
    }
}
