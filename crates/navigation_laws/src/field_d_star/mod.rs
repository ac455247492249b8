//! Field D* of Ferguson and Stentz (2006): a path of least cost over a grid, repaired when the
//! robot or an obstacle moves.

pub mod cost;
pub mod extraction;
pub mod queue;
pub mod search;
mod surroundings;

pub use search::IncrementalSearch;

use crate::Situation;
use crate::planning::Planner;
use crate::planning::footprint::Footprint;
use crate::planning::grid::{GridFrame, OccupancyGrid};
use crate::planning::path::{PathStatus, point_ahead, velocity_towards};
use navigation_world::arguments::{Arguments, Named};
use navigation_world::world::scenario::Scenario;
use numeric::error::{Result, not_negative, positive};

/// Parameters. The source gives none of them; the defaults are choices of this implementation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldDStar {
    /// Side of a cell in m. A cell is blocked as soon as an obstacle reaches into it, so coarse
    /// cells close narrow gaps; the effort grows with the inverse square.
    pub resolution: f64,
    /// Distance kept from obstacles besides the radii, in m: at least what the robot deviates
    /// from the path, about a third of `look_ahead` at a right angle.
    pub margin: f64,
    /// Moving obstacles block the way that they take within this time at their present velocity,
    /// in s.
    pub horizon: f64,
    /// How far the grid extends beyond start and goal, in m; there is no way outside.
    pub room: f64,
    /// Distance along the path of the point that the robot heads for, in m: at least what it
    /// moves in a control period.
    pub look_ahead: f64,
}

impl Default for FieldDStar {
    fn default() -> Self {
        Self {
            resolution: 0.1,
            margin: 0.05,
            horizon: 1.0,
            room: 3.0,
            look_ahead: 0.1,
        }
    }
}

impl FieldDStar {
    /// Passes parameters that are in range.
    ///
    /// # Errors
    /// Names the value that is not.
    pub fn checked(self) -> Result<Self> {
        positive("resolution", self.resolution)?;
        not_negative("margin", self.margin)?;
        not_negative("horizon", self.horizon)?;
        positive("room", self.room)?;
        positive("look_ahead", self.look_ahead)?;
        Ok(self)
    }
}

impl Named for FieldDStar {
    const NAME: &'static str = "field_d_star";

    fn made_of(given: &dyn Arguments) -> Result<Self> {
        Ok(Self {
            resolution: given.number("resolution")?,
            margin: given.number("margin")?,
            horizon: given.number("horizon")?,
            room: given.number("room")?,
            look_ahead: given.number("look_ahead")?,
        })
    }
}

/// The planner at work in one scenario.
///
/// It drives at full speed towards a point a little ahead on the path of least cost. A robot in
/// a blocked cell, or beside the grid, heads for the nearest free cell and plans from there. If
/// the goal is blocked or no way leads to it, the robot stops and waits, unless it stands in a
/// blocked cell: that it still leaves. It knows present positions and velocities only; a
/// rectangle does not move. Obstacles whose state is not finite are left out, and a robot whose
/// state is not finite is told to stop.
#[derive(Clone, Debug)]
pub struct FieldDStarPlanner {
    parameters: FieldDStar,
    origin: [f64; 2],
    /// Distance of the robot's center from an obstacle's surface, in m.
    growth: f64,
    max_speed: f64,
    /// Walls of the map.
    walls: Vec<Footprint>,
    grid: OccupancyGrid,
    search: IncrementalSearch,
    /// Path ahead in cells.
    path: Vec<[f64; 2]>,
    status: PathStatus,
}

impl FieldDStarPlanner {
    /// The planner for one scenario.
    ///
    /// # Errors
    /// A parameter is out of range, or the grid would be too large.
    pub fn new(parameters: FieldDStar, scenario: &Scenario) -> Result<Self> {
        let parameters = parameters.checked()?;
        let origin = scenario.goal;
        let start = relative(scenario.start, origin);
        let frame = GridFrame::new(start, parameters.room, parameters.resolution)?;
        let sides = [frame.columns, frame.rows];
        let first = frame.cell(frame.in_cells(start));
        let growth = scenario.robot.radius + parameters.margin;
        let corners = [[0.0; 2], sides.map(|count| count as f64)];
        let corners = corners.map(|corner| frame.in_meters(corner));
        let walls = scenario.map.as_ref();
        Ok(Self {
            walls: walls.map_or_else(Vec::new, |map| {
                Footprint::of_map(map, origin, growth, corners)
            }),
            parameters,
            origin,
            growth,
            max_speed: scenario.robot.max_speed,
            grid: OccupancyGrid::new(frame),
            search: IncrementalSearch::new(sides, frame.goal, first)?,
            path: Vec::new(),
            status: PathStatus::Unplanned,
        })
    }

    /// Result of the last step.
    #[must_use]
    pub fn status(&self) -> PathStatus {
        self.status
    }

    /// The grid as last seen.
    #[must_use]
    pub fn grid(&self) -> &OccupancyGrid {
        &self.grid
    }

    /// The costs as last repaired.
    #[must_use]
    pub fn search(&self) -> &IncrementalSearch {
        &self.search
    }

    /// The whole path from the robot to the goal in m; empty if there is none.
    pub fn whole_path(&mut self, situation: &Situation<'_, f64>) -> Vec<[f64; 2]> {
        if !self.plan(situation, f64::INFINITY) {
            return Vec::new();
        }
        self.path
            .iter()
            .map(|point| {
                let [x, y] = self.grid.frame().in_meters(*point);
                [x + self.origin[0], y + self.origin[1]]
            })
            .collect()
    }

    /// Plans the path for so many cells; whether there is one to follow.
    fn plan(&mut self, situation: &Situation<'_, f64>, enough: f64) -> bool {
        self.path.clear();
        self.status = PathStatus::Unplanned;
        let position = situation.robot.position;
        let position = relative([position.x, position.y], self.origin);
        let point = self.grid.frame().in_cells(position);
        if !point.iter().all(|part| part.is_finite()) {
            return false;
        }
        self.look(situation);
        let Some((cell, entry)) = nearest_free(&self.grid, point) else {
            self.status = PathStatus::NoPath;
            return false;
        };
        let leaving = entry != point;
        if leaving {
            self.path.push(point);
        }
        self.search.go_to(cell);
        self.status = if self.grid.goal_is_blocked() {
            PathStatus::GoalBlocked
        } else {
            self.search.repair_until(situation.stop);
            if self.search.start_costs().contains(&f64::INFINITY) {
                PathStatus::NoPath
            } else if leaving {
                PathStatus::Leaving
            } else {
                PathStatus::Found
            }
        };
        if matches!(self.status, PathStatus::Found | PathStatus::Leaving) {
            // Costs fall along the path, so it ends at the goal only.
            extraction::extract(&self.search, entry, enough, &mut self.path);
            return true;
        }
        if leaving {
            self.path.push(entry);
        }
        leaving
    }

    /// Brings grid and costs up to date.
    fn look(&mut self, situation: &Situation<'_, f64>) {
        let (origin, growth, horizon) = (self.origin, self.growth, self.parameters.horizon);
        let bodies = situation
            .bodies
            .iter()
            .map(|body| Footprint::of(body, origin, growth, horizon));
        let footprints = self.walls.iter().copied().map(Some).chain(bodies);
        let changed = self.grid.update(footprints).len();
        for number in 0..changed {
            let cell = self.grid.changed()[number];
            self.search.set_blocked(cell, self.grid.is_blocked(cell));
        }
    }
}

impl Planner for FieldDStarPlanner {
    fn desired_velocity(&mut self, situation: &Situation<'_, f64>) -> [f64; 2] {
        let ahead = self.parameters.look_ahead / self.parameters.resolution;
        if !self.plan(situation, ahead) {
            return [0.0; 2];
        }
        match (self.path.first(), point_ahead(&self.path, ahead)) {
            (Some(&from), Some(to)) => velocity_towards(from, to, self.max_speed),
            _ => [0.0; 2],
        }
    }

    fn can_aim(&self) -> bool {
        false
    }
}

fn relative(position: [f64; 2], origin: [f64; 2]) -> [f64; 2] {
    [position[0] - origin[0], position[1] - origin[1]]
}

/// The free cell nearest to a point, in cells, and its point nearest to that; rings of cells
/// around the point's own cell are looked through outwards.
fn nearest_free(grid: &OccupancyGrid, point: [f64; 2]) -> Option<([usize; 2], [f64; 2])> {
    let frame = *grid.frame();
    let sides = [frame.columns, frame.rows];
    let within = [0, 1].map(|i| point[i].clamp(0.0, sides[i] as f64));
    let home = frame.cell(within);
    let mut best: Option<(f64, [usize; 2], [f64; 2])> = None;
    for ring in 0..=frame.columns.max(frame.rows) {
        // Cells of a ring are at least so far away.
        let least = ring.saturating_sub(1) as f64;
        if best.is_some_and(|(known, ..)| known <= least) {
            break;
        }
        let span = |i: usize| home[i].saturating_sub(ring)..=(home[i] + ring).min(sides[i] - 1);
        for row in span(1) {
            let whole_row = row.abs_diff(home[1]) == ring;
            for column in span(0) {
                let on_ring = whole_row || column.abs_diff(home[0]) == ring;
                if !on_ring || grid.is_blocked([column, row]) {
                    continue;
                }
                let low = [column as f64, row as f64];
                let entry = [0, 1].map(|i| within[i].clamp(low[i], low[i] + 1.0));
                let away = (entry[0] - within[0]).hypot(entry[1] - within[1]);
                if best.is_none_or(|(known, ..)| away < known) {
                    best = Some((away, [column, row], entry));
                }
            }
        }
    }
    best.map(|(_, cell, entry)| (cell, entry))
}
