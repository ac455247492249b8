//! Steps of environments, some at a time: their worlds move in turn, and their people side by side.

use crate::crowd::agent_lanes::WIDTH;
use crate::crowd::environments::one::Shared;
use crate::crowd::environments::row::Row;
use crate::crowd::environments::settings::EnvironmentSettings;
use crate::crowd::models::Model;
use crate::crowd::simulation::Simulation;
use crate::run::Interrupted;
use numeric::error::Result;

/// How many environments are stepped at a time.
pub(super) const BLOCK: usize = WIDTH;

/// Inputs and outputs of a step of all environments.
pub(super) struct BlockStep<'a> {
    /// Settings of all environments.
    pub settings: &'a EnvironmentSettings,
    /// The model of the people, if those of several worlds can move together.
    pub model: Option<&'a Model>,
    /// Actions of the robots.
    pub actions: &'a [[f64; 2]],
    /// Whether to stop.
    pub interrupted: Interrupted<'a>,
}

impl BlockStep<'_> {
    /// Steps some environments.
    pub fn step(&self, rows: &mut [(usize, Row<'_>)], shared: &mut Shared) -> Result<()> {
        let mut moving = Vec::with_capacity(rows.len());
        for (index, row) in rows {
            if row.begin(self.settings, self.actions[*index], shared)? {
                moving.push(row);
            }
        }
        let steps = moving.first().map_or(0, |row| row.environment.steps());
        for _ in 0..steps {
            let worlds = moving.iter_mut().map(|row| row.environment.world());
            self.step_worlds(worlds, shared)?;
            for row in &mut moving {
                row.environment.account(self.settings);
            }
        }
        for row in moving {
            row.end(self.settings, shared)?;
        }
        Ok(())
    }

    /// Moves worlds by a step each.
    fn step_worlds<'w>(
        &self,
        worlds: impl ExactSizeIterator<Item = &'w mut Simulation>,
        shared: &mut Shared,
    ) -> Result<()> {
        let mut begun = Vec::with_capacity(worlds.len());
        for world in worlds {
            if world.begin(self.interrupted)? {
                begun.push(world);
            }
        }
        let (mut under_way, mut before) = (begun.len(), 0);
        while under_way > 0 {
            if let Some(model) = self.model {
                let again = under_way == before;
                shared.lanes.advance(model, &mut begun[..under_way], again);
            }
            before = under_way;
            for index in (0..under_way).rev() {
                if !advance(begun[index], shared) {
                    under_way -= 1;
                    begun.swap(index, under_way);
                }
            }
        }
        begun.into_iter().try_for_each(Simulation::end)
    }
}

/// Moves a world once, whose people may have moved.
fn advance(world: &mut Simulation, shared: &mut Shared) -> bool {
    if world.people_have_moved() {
        return world.advance();
    }
    world.exchange_room(&mut shared.decisions);
    let more = world.advance();
    world.exchange_room(&mut shared.decisions);
    more
}
