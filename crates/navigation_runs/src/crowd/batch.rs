//! Many worlds, spread over threads.

use std::sync::Arc;

use numeric::threads;

use crate::crowd::record::{MOST_ROWS, size_of_record};
use crate::crowd::simulation::Simulation;
use crate::crowd::world::CrowdWorld;
use crate::run::Interrupted;
use numeric::error::{Failure, Given, Result};

/// Runs worlds to their ends, with everybody's places at every step; `done` is told of each.
///
/// # Errors
/// The number of threads is out of range, a world breaks a rule, named by its index, or the caller asked to stop.
pub fn simulate_worlds(
    worlds: &[Arc<CrowdWorld>],
    threads: Option<usize>,
    interrupted: Interrupted<'_>,
    done: &(dyn Fn(usize) + Sync),
) -> Result<Vec<Simulation>> {
    check_size(worlds)?;
    threads::on_threads(threads, || {
        threads::try_map(worlds.len(), |index| {
            let ended = Simulation::new(Arc::clone(&worlds[index]), true)
                .map_err(|error| error.within(&format!("worlds[{index}]")))?
                .completed(interrupted)?;
            done(1);
            Ok(ended)
        })
    })
}

/// Refuses worlds whose records would not fit into memory together; one that is too long alone is named later.
fn check_size(worlds: &[Arc<CrowdWorld>]) -> Result<()> {
    if worlds.len() < 2 {
        return Ok(());
    }
    let sizes = worlds.iter().map(|world| size_of_record(world));
    let places = sizes.map(|(instants, agents)| instants * agents);
    let total: f64 = places.filter(|places| *places <= MOST_ROWS).sum();
    if total <= MOST_ROWS {
        return Ok(());
    }
    let rule = format!("hold at most {MOST_ROWS} agents times steps together");
    let advice = "run them in several calls, or shorten time_limit";
    Err(Failure::invalid("worlds", rule, Given::Number(total)).mended_by(advice))
}
