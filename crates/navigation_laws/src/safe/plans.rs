//! Plans of many runs in one map: one for each guide, robot, start and goal.

use std::sync::{Arc, Mutex, PoisonError};

use crate::Stop;
use crate::guide::{Guide, Pace, Plan, PlansAround, RobotRoom};
use navigation_world::world::map::{MapShapes, StaticMap};
use numeric::error::Result;
use unknown_places::unseen::Ground;

/// Most plans that are kept; beyond them the oldest go.
const MOST_KEPT: usize = 64;

/// Room for the robot, start and goal, and what its pace depends on, bit by bit.
type Key = [u64; 9];

/// Cells of places, with the corners of the places.
type Grounds = Vec<([[u64; 2]; 2], Arc<Ground>)>;

/// Plans that were made in one map, and cells for people who are not seen, shared by all copies.
#[derive(Clone, Debug, Default)]
pub struct Plans {
    alone: Arc<Mutex<Vec<(Key, Guide, Plan)>>>,
    /// Plans around people who stand.
    pub(super) around: PlansAround,
    grounds: Arc<Mutex<Grounds>>,
}

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
        pace: Option<Pace>,
    ) -> Result<Plan> {
        let [[a, b], [c, d]] = ends;
        // The limits of the robot tell how slow it has to be.
        let slow = |pace: &Pace| [pace.max_speed, pace.deceleration, pace.period];
        let [e, f, g] = pace.as_ref().map_or([0.0; 3], slow);
        let key = [robot.least, robot.turning, a, b, c, d, e, f, g].map(f64::to_bits);
        let mut kept = self.alone.lock().unwrap_or_else(PoisonError::into_inner);
        let same = |(known, by, _): &&(Key, Guide, Plan)| *known == key && by == guide;
        if let Some((.., plan)) = kept.iter().find(same) {
            return Ok(plan.clone());
        }
        let map = map.cloned().unwrap_or_else(|| MapShapes::new().map());
        let plan = guide.paced_plan(&map, robot, ends, pace, Stop::never())?;
        if kept.len() == MOST_KEPT {
            kept.remove(0);
        }
        kept.push((key, *guide, plan.clone()));
        Ok(plan)
    }

    /// The cells between two corners in m, which are made once.
    pub(super) fn kept_ground(
        &self,
        bounds: [[f64; 2]; 2],
        make: impl FnOnce() -> Result<Ground>,
    ) -> Result<Arc<Ground>> {
        let key = bounds.map(|corner| corner.map(f64::to_bits));
        let mut kept = self.grounds.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, ground)) = kept.iter().find(|(known, _)| *known == key) {
            return Ok(ground.clone());
        }
        let ground = Arc::new(make()?);
        if kept.len() < MOST_KEPT {
            kept.push((key, ground.clone()));
        }
        Ok(ground)
    }
}
