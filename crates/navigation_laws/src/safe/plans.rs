//! Plans of many runs: one for each robot, start and goal.

use std::sync::{Arc, Mutex, PoisonError};

use crate::Stop;
use crate::guide::{Guide, Plan, RobotRoom};
use navigation_world::world::map::{MapShapes, StaticMap};
use numeric::error::Result;

/// Most plans that are kept; a batch of more different ways plans anew.
const MOST_KEPT: usize = 64;

/// Room for the robot, start and goal, bit by bit.
type Key = [u64; 6];

/// Plans that were made, shared by all copies.
#[derive(Clone, Debug, Default)]
pub struct Plans(Arc<Mutex<Vec<(Key, Plan)>>>);

impl Plans {
    /// The plan of a guide in a map, for a robot, from a start to a goal.
    ///
    /// # Errors
    /// Errors of [`Guide::plan`].
    pub(super) fn get(
        &self,
        guide: &Guide,
        map: Option<&StaticMap>,
        robot: RobotRoom,
        ends: [[f64; 2]; 2],
    ) -> Result<Plan> {
        let [[a, b], [c, d]] = ends;
        let key = [robot.least, robot.turning, a, b, c, d].map(f64::to_bits);
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, plan)) = kept.iter().find(|(known, _)| *known == key) {
            return Ok(plan.clone());
        }
        let map = map.cloned().unwrap_or_else(|| MapShapes::new().map());
        let plan = guide.plan(&map, robot, ends, Stop::never())?;
        if kept.len() < MOST_KEPT {
            kept.push((key, plan.clone()));
        }
        Ok(plan)
    }
}
