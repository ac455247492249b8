//! Many layouts over all cores.

use crate::run::follower::episode::{Follower, FollowerOutcome};
use crate::run::follower::layouts::Layouts;
use crate::run::follower::settings::Settings;
use numeric::error::{Failure, Given, Result};
use numeric::parallel::{Work, each_run};

/// Layouts that are looked at for each one that is wanted, at most.
const MOST_TRIED: u64 = 1000;

/// Layouts that are looked at together, at least.
const TOGETHER: usize = 64;

fn outcomes(
    follower: &Follower,
    layouts: &Layouts,
    seeds: &[u64],
    work: Work<'_>,
) -> Result<Vec<FollowerOutcome>> {
    each_run(seeds.len(), work, |index| {
        let seed = seeds[index];
        follower.run(&layouts.scene(seed)?, seed, &mut (), work.interrupted)
    })
}

/// Runs of one follower through the layouts of seeds, in their order.
///
/// # Errors
/// A number is out of range, a state became non-finite, or the caller asked to stop.
pub fn run_batch(
    settings: &Settings,
    layouts: &Layouts,
    seeds: &[u64],
    work: Work<'_>,
) -> Result<Vec<FollowerOutcome>> {
    let layouts = layouts.checked()?;
    outcomes(&Follower::new(settings)?, &layouts, seeds, work)
}

/// The first seeds, from `first` on, in whose layouts the same robot without repulsion touches an
/// obstacle.
///
/// # Errors
/// Errors of [`run_batch`]; or so few layouts of so many touch that they are not worth waiting for.
pub fn touching_layouts(
    settings: &Settings,
    layouts: &Layouts,
    first: u64,
    count: usize,
    work: Work<'_>,
) -> Result<Vec<u64>> {
    let layouts = layouts.checked()?;
    let follower = Follower::unaware(settings)?;
    let quiet = Work {
        progress: &|_| (),
        ..work
    };
    let mut found = Vec::with_capacity(count);
    let mut next = first;
    while found.len() < count {
        let tried = next - first;
        if tried > MOST_TRIED * count as u64 {
            let rule = "leave layouts in which a robot without repulsion touches an obstacle";
            let given = Given::Count(tried);
            return Err(Failure::invalid("layouts", rule, given));
        }
        let seeds: Vec<u64> = (next..next + (count - found.len()).max(TOGETHER) as u64).collect();
        let ends = outcomes(&follower, &layouts, &seeds, quiet)?;
        let touching = seeds.iter().zip(ends);
        found.extend(
            touching
                .filter(|(_, outcome)| outcome.contact.is_some())
                .map(|(seed, _)| *seed),
        );
        next += seeds.len() as u64;
    }
    found.truncate(count);
    Ok(found)
}
