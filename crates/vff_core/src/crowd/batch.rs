//! Many worlds, spread over threads.

use numeric::threads;

use crate::crowd::simulation::Simulation;
use crate::crowd::world::CrowdWorld;
use crate::error::Result;
use crate::run::Interrupted;

/// Runs worlds to their ends, with everybody's places at every step; `done` is told of each.
///
/// # Errors
/// The number of threads is out of range, a world breaks a rule, named by its index, or the caller asked to stop.
pub fn simulate_worlds(
    worlds: &[CrowdWorld],
    threads: Option<usize>,
    interrupted: Interrupted<'_>,
    done: &(dyn Fn(usize) + Sync),
) -> Result<Vec<Simulation>> {
    threads::on_threads(threads, || {
        threads::try_map(worlds.len(), |index| {
            let ended = Simulation::new(worlds[index].clone(), true)
                .map_err(|error| error.within(&format!("worlds[{index}]")))?
                .completed(interrupted)?;
            done(1);
            Ok(ended)
        })
    })
}
