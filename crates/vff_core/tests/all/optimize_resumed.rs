//! Searches that are stopped and resumed, and what they report on the way.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::functions::{Bowls, Function, global, grid, rippled, unit_box};
use vff_core::search::{
    Control, FrontOptions, GlobalMethod, GlobalOptions, LocalOptions, LocalStatus, Observer,
    Report, SearchOptions, SearchState, Stage, front_search, global_search, search,
};

/// Stops at a report and keeps the state of that moment, through its stored form.
struct Stop {
    at: u64,
    reports: AtomicU64,
    stored: Mutex<Option<Vec<u8>>>,
}

impl Stop {
    fn at(at: u64) -> Self {
        Self {
            at,
            reports: AtomicU64::new(0),
            stored: Mutex::new(None),
        }
    }

    fn state(&self) -> Option<SearchState> {
        let stored = self.stored.lock().unwrap();
        stored
            .as_ref()
            .map(|bytes| SearchState::from_bytes(bytes).unwrap())
    }
}

impl Observer for Stop {
    fn report(&self, report: &Report<'_>, state: &dyn Fn() -> SearchState) -> Control {
        assert!(report.done <= report.total);
        if self.reports.fetch_add(1, Ordering::Relaxed) + 1 == self.at {
            *self.stored.lock().unwrap() = Some(state().to_bytes());
            return Control::Stop;
        }
        Control::Continue
    }
}

#[test]
fn a_resumed_search_is_the_uninterrupted_one() {
    let options = SearchOptions {
        local: Some(LocalOptions {
            starts: 3,
            ..LocalOptions::default()
        }),
        ..grid(&[9, 9, 9], 2, 40)
    };
    let whole = search(
        &Function::new(3, 1, rippled),
        &unit_box(3),
        &options,
        &(),
        None,
    )
    .unwrap();
    assert!(
        whole
            .local
            .iter()
            .all(|search| search.status == LocalStatus::Converged)
    );
    let mut interrupted = 0;
    for at in [1, 7, 46, 47, 60, 140, 141] {
        let problem = Function::new(3, 1, rippled);
        let stop = Stop::at(at);
        let part = search(&problem, &unit_box(3), &options, &stop, None).unwrap();
        let Some(state) = stop.state() else {
            continue;
        };
        interrupted += u64::from(part.interrupted);
        let rest = search(&problem, &unit_box(3), &options, &(), Some(&state)).unwrap();
        assert_eq!(rest, whole, "stopped at report {at}");
    }
    assert!(interrupted >= 4);
}

#[test]
fn resuming_computes_nothing_twice() {
    let options = grid(&[9, 9, 9], 1, 40);
    let problem = Function::new(3, 1, rippled);
    let stop = Stop::at(20);
    search(&problem, &unit_box(3), &options, &stop, None).unwrap();
    // One thread more may have been at work on a block when the search was stopped.
    let state = stop.state().unwrap();
    let before = problem.calls.swap(0, Ordering::Relaxed);
    let rest = search(&problem, &unit_box(3), &options, &(), Some(&state)).unwrap();
    let after = problem.calls.load(Ordering::Relaxed);
    assert!(before + after <= rest.evaluations + 2 * 16);
    assert!(after < rest.evaluations);
}

#[test]
fn a_resumed_global_search_and_front_are_the_uninterrupted_ones() {
    for method in [GlobalMethod::DifferentialEvolution, GlobalMethod::CmaEs] {
        let problem = Function::new(3, 1, rippled);
        let options = GlobalOptions {
            evaluations: 3000,
            ..global(method, 2)
        };
        let whole = global_search(&problem, &unit_box(3), &options, &(), None).unwrap();
        let stop = Stop::at(150);
        let part = global_search(&problem, &unit_box(3), &options, &stop, None).unwrap();
        assert!(part.interrupted && part.evaluations < 3000);
        let state = stop.state().unwrap();
        let rest = global_search(&problem, &unit_box(3), &options, &(), Some(&state)).unwrap();
        assert_eq!(rest, whole);
    }
    let options = FrontOptions {
        shape: vec![16, 16],
        refinements: 3,
        threads: Some(2),
    };
    let whole = front_search(&Bowls, &unit_box(2), &options, &(), None).unwrap();
    let stop = Stop::at(18);
    let part = front_search(&Bowls, &unit_box(2), &options, &stop, None).unwrap();
    assert!(part.interrupted);
    let state = stop.state().unwrap();
    let rest = front_search(&Bowls, &unit_box(2), &options, &(), Some(&state)).unwrap();
    assert_eq!(rest, whole);
}

#[test]
fn a_state_of_another_search_or_a_damaged_one_is_refused() {
    let problem = Function::new(3, 1, rippled);
    let options = grid(&[9, 9, 9], 1, 40);
    let stop = Stop::at(5);
    search(&problem, &unit_box(3), &options, &stop, None).unwrap();
    let state = stop.state().unwrap();
    let other = grid(&[9, 9, 8], 1, 40);
    assert!(search(&problem, &unit_box(3), &other, &(), Some(&state)).is_err());
    let bytes = state.to_bytes();
    assert_eq!(SearchState::from_bytes(&bytes).unwrap(), state);
    for cut in [0, 7, 8, 30, bytes.len() - 9, bytes.len() - 1] {
        assert!(SearchState::from_bytes(&bytes[..cut]).is_err());
    }
    let mut flipped = bytes.clone();
    flipped[bytes.len() / 2] ^= 1;
    assert!(SearchState::from_bytes(&flipped).is_err());
}

#[test]
fn reports_tell_stages_in_their_order() {
    struct Stages(Mutex<Vec<(Stage, u64)>>);
    impl Observer for Stages {
        fn report(&self, report: &Report<'_>, _: &dyn Fn() -> SearchState) -> Control {
            assert!(report.best.is_some());
            self.0.lock().unwrap().push((report.stage, report.done));
            Control::Continue
        }
    }
    let stages = Stages(Mutex::new(Vec::new()));
    let options = SearchOptions {
        local: Some(LocalOptions {
            starts: 2,
            ..LocalOptions::default()
        }),
        ..grid(&[5, 5, 5], 1, 9)
    };
    let problem = Function::new(3, 1, rippled);
    search(&problem, &unit_box(3), &options, &stages, None).unwrap();
    let stages = stages.0.into_inner().unwrap();
    assert!(stages.is_sorted());
    assert!(stages.contains(&(Stage::Grid { round: 1 }, 125)));
    assert_eq!(stages.last(), Some(&(Stage::Local, 2)));
}
