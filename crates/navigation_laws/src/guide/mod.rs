//! The guide: a plan through a static map, the local goal that a law gets of it, and the takeover
//! that leaves local minima.
//!
//! The plan is the cost-to-go of every node of a grid, computed once for a map and a goal by
//! Dijkstra's algorithm; it has no local minimum. Nodes and links keep the radius of the robot and
//! a margin from the map, so a path with `rho + m_p + h/sqrt(2)` of room is always found: rounded
//! to nodes, every point of it moves by half a diagonal of a cell at most.

mod detour;
mod guidance;
mod nodes;
mod pace;
mod plan;
mod search;
mod standing;
mod takeover;

use nalgebra::Vector2;

use crate::Stop;
use crate::guide::nodes::Nodes;
pub use detour::Detour;
pub use guidance::{Guidance, PlansAround};
use navigation_world::world::map::StaticMap;
use navigation_world::world::scenario::Scenario;
pub use nodes::MOST_NODES;
use numeric::error::{Failure, Given, Result, finite_pair, not_negative, positive};
pub use pace::Pace;
pub use plan::{LocalGoal, Plan, PlanView};
pub use standing::Standing;
pub use takeover::{Takeover, TakeoverOptions, TakeoverRule};

/// How far around map, start and goal the default box reaches beyond the radius of the robot, in m.
const ROOM: f64 = 1.0;

/// How much dearer a way is where a robot that is no disc only just fits.
const NARROW: f64 = 4.0;

/// Room in m beside the circle around such a robot from which on it turns freely.
const TURNING_ROOM: f64 = 0.03;

/// Options of the guide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guide {
    /// Spacing `h` of the nodes in m.
    pub spacing: f64,
    /// Margin `m_p` that the plan keeps beyond the radius of the robot, in m.
    pub margin: f64,
    /// How far ahead along the path the local goal may lie, in m.
    pub look_ahead: f64,
    /// Lower and upper corner of the box of the nodes, in m; by default map, start and goal with
    /// the radius of the robot and 1 m around, or the grids outside of which nothing is known, where ways
    /// stay.
    pub bounds: Option<[[f64; 2]; 2]>,
}

impl Default for Guide {
    fn default() -> Self {
        Self {
            spacing: 0.05,
            margin: 0.005,
            look_ahead: 3.0,
            bounds: None,
        }
    }
}

/// Room that a robot needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RobotRoom {
    /// Least distance of its middle from the map in m: its radius, or half of the width of one that is no disc.
    pub least: f64,
    /// Radius in m of the circle around it, in which it can turn.
    pub turning: f64,
}

impl From<f64> for RobotRoom {
    /// Of a disc with a radius in m.
    fn from(radius: f64) -> Self {
        Self {
            least: radius,
            turning: radius,
        }
    }
}

impl From<&Scenario> for RobotRoom {
    fn from(scenario: &Scenario) -> Self {
        Self {
            least: scenario.least_room(),
            turning: scenario.robot.radius,
        }
    }
}

impl RobotRoom {
    /// Clearance in m from which on the robot has all the room that it needs.
    #[must_use]
    pub fn free(&self) -> f64 {
        self.turning + TURNING_ROOM
    }

    /// Whether there are places where it fits and cannot turn: it is no disc.
    #[must_use]
    pub fn turns(&self) -> bool {
        self.turning > self.least
    }

    /// How much dearer a way is at a clearance in m: `4 max(0, (r_c + 0.03 - c)/(r_c + 0.03 - rho))`, nothing for a disc.
    #[must_use]
    pub fn narrowness(&self, clearance: f64) -> f64 {
        if !self.turns() {
            return 0.0;
        }
        NARROW * ((self.free() - clearance) / (self.free() - self.least)).max(0.0)
    }
}

impl Guide {
    /// Returns the guide if its numbers are allowed.
    ///
    /// # Errors
    /// Names the number that is not allowed.
    pub fn checked(self) -> Result<Self> {
        positive("spacing", self.spacing)?;
        not_negative("margin", self.margin)?;
        positive("look_ahead", self.look_ahead)?;
        if let Some([lower, upper]) = self.bounds {
            finite_pair("lower corner of box", lower)?;
            finite_pair("upper corner of box", upper)?;
            if lower[0] >= upper[0] || lower[1] >= upper[1] {
                let rule = "lie above and to the right of the lower corner of the box";
                return Err(Failure::invalid(
                    "upper corner of box",
                    rule,
                    Given::Pair(upper),
                ));
            }
        }
        Ok(self)
    }

    /// The plan of a robot from everywhere to a goal; there is one from the start.
    ///
    /// # Errors
    /// Start or goal are outside of the box or in contact with the map, there is no way between
    /// them, the box has too many nodes, or the caller asked to stop.
    pub fn plan(
        &self,
        map: &StaticMap,
        robot: impl Into<RobotRoom>,
        ends: [[f64; 2]; 2],
        stop: Stop<'_>,
    ) -> Result<Plan> {
        self.paced_plan(map, robot.into(), ends, None, stop)
    }

    /// The plan in which ways are as dear as a pace makes the robot slow.
    ///
    /// # Errors
    /// Errors of [`Self::plan`].
    pub(crate) fn paced_plan(
        &self,
        map: &StaticMap,
        robot: RobotRoom,
        [start, goal]: [[f64; 2]; 2],
        pace: Option<Pace>,
        stop: Stop<'_>,
    ) -> Result<Plan> {
        let robot_radius = positive("radius", robot.least)?;
        finite_pair("start", start)?;
        finite_pair("goal", goal)?;
        let nodes = self.checked()?.nodes(map, robot_radius, [start, goal])?;
        for (name, place) in [("start", start), ("goal", goal)] {
            if self.bounds.is_none() && !map.knows(place.into()) {
                let rule = "lie within the image of the map: nothing is known of what lies outside";
                let advice =
                    "a box of the guide, or a map with outside=\"free\", allows ways there";
                return Err(Failure::invalid(name, rule, Given::Pair(place)).mended_by(advice));
            }
            check_place(name, place, &nodes, map, robot_radius)?;
        }
        let to = (goal.into(), pace);
        let plan = Plan::new(*self, nodes, map, robot, to, stop)?;
        if plan.view(start.into()).is_none() {
            let rule = "be reachable from the start";
            let advice = "a gap must be wider than the robot by twice the margin; a smaller spacing finds narrower ones";
            return Err(Failure::invalid("goal", rule, Given::Pair(goal)).mended_by(advice));
        }
        Ok(plan)
    }

    fn nodes(&self, map: &StaticMap, robot_radius: f64, places: [[f64; 2]; 2]) -> Result<Nodes> {
        let bounds = self.bounds.map(|corners| corners.map(Vector2::from));
        let [lower, upper] = bounds.unwrap_or_else(|| {
            if let Some(known) = map.known_bounds() {
                return known;
            }
            let [start, goal] = places.map(Vector2::from);
            let [lower, upper] = map.bounds().unwrap_or([start, goal]);
            let room = Vector2::repeat(robot_radius + ROOM);
            [
                lower.inf(&start).inf(&goal) - room,
                upper.sup(&start).sup(&goal) + room,
            ]
        });
        Nodes::new(lower, upper, self.spacing)
    }
}

fn check_place(
    name: &str,
    place: [f64; 2],
    nodes: &Nodes,
    map: &StaticMap,
    robot_radius: f64,
) -> Result<()> {
    if !nodes.around(place.into()) {
        let rule = "lie within the box of the guide";
        let advice = "a larger box, or none, holds it";
        return Err(Failure::invalid(name, rule, Given::Pair(place)).mended_by(advice));
    }
    let clearance = map.clearance(place.into());
    if clearance < robot_radius {
        let rule =
            format!("be at least the radius of the robot, {robot_radius} m, away from the map");
        let advice = format!("the map is {clearance:.4} m away");
        return Err(Failure::invalid(name, rule, Given::Pair(place)).mended_by(advice));
    }
    Ok(())
}
