//! The result of a batch as columns.

use numeric::threads::{each_piece, map};

use crate::run::metrics::Performance;
use crate::run::outcome::{ContactCounts, Outcome, RunTotals};
use navigation_world::world::scenario::Scenario;

/// A run with its score.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cell {
    pub run: RunTotals,
    pub performance: Performance,
}

impl Cell {
    /// A run that is still to be made.
    pub fn unset() -> Self {
        Self {
            run: RunTotals {
                outcome: Outcome::TimedOut,
                end_time: f64::NAN,
                arrival_time: f64::NAN,
                energy: f64::NAN,
                path_length: f64::NAN,
                contacts: ContactCounts::default(),
                map_clearance: f64::INFINITY,
                descent_share: f64::NAN,
                force_evaluations: 0,
            },
            performance: Performance {
                total: 0.0,
                arrival_time: 0.0,
                avoidance: 0.0,
                energy_saving: 0.0,
            },
        }
    }
}

/// A vector of one value, written by all cores: for many runs it is tens of megabytes.
fn filled<T: Copy + Send + Sync>(value: T, count: usize) -> Vec<T> {
    map(count, |_| value)
}

/// Columns of a batch; row `g * scenarios + s` is gain set `g` in scenario `s`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BatchTable {
    /// How the runs ended.
    pub outcome: Vec<Outcome>,
    /// When they ended, in s.
    pub end_time: Vec<f64>,
    /// First entry into the circle around the goal, in s; NaN without arrival.
    pub arrival_time: Vec<f64>,
    /// Electrical loss in J.
    pub energy: Vec<f64>,
    /// Length of the path in m.
    pub path_length: Vec<f64>,
    /// Least distance `d` to each obstacle in m, the obstacles fastest; infinite if it was never
    /// present, NaN beyond the obstacles of the row's scenario.
    pub min_distance: Vec<f64>,
    /// Number of obstacles in a row of `min_distance`.
    pub obstacles: usize,
    /// Least distance of the surfaces over all obstacles and maps in m; infinite without any.
    pub min_clearance: Vec<f64>,
    /// Number of obstacles whose active region the robot entered.
    pub entered_active: Vec<i64>,
    /// Number of obstacles touched while the robot was moving.
    pub contacts_moving: Vec<i64>,
    /// Number of these toward which it moved then.
    pub contacts_toward: Vec<i64>,
    /// Number of those that touched it while it moved, but not toward them.
    pub contacts_away: Vec<i64>,
    /// Number of obstacles touched while the robot stood.
    pub contacts_standing: Vec<i64>,
    /// Number of obstacles toward which the robot moved from the first touch until they overlapped by
    /// [`crate::run::DECIDED_OVERLAP`]; every contact with the maps counts.
    pub contacts_at_fault: Vec<i64>,
    /// Number of obstacles that appeared in the scene where the robot was, counted apart from all others.
    pub contacts_apart: Vec<i64>,
    /// Number of contacts with the maps, 1 or 0, which the others hold, too.
    pub wall_contacts: Vec<i64>,
    /// `H`.
    pub performance_total: Vec<f64>,
    /// `H_T`.
    pub performance_arrival_time: Vec<f64>,
    /// `H_D`.
    pub performance_avoidance: Vec<f64>,
    /// `H_E`.
    pub performance_energy_saving: Vec<f64>,
    /// Share of the control periods over which the Lyapunov function did not grow, if counted.
    pub descent_share: Vec<f64>,
    /// Number of samples of the force.
    pub force_evaluations: Vec<i64>,
}

impl BatchTable {
    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.outcome.len()
    }

    /// Whether there is no row.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.outcome.is_empty()
    }

    /// Columns of rows that lie anywhere: each has its cell and the distances to its obstacles.
    pub(crate) fn of_rows<'a>(
        scenarios: &'a [Scenario],
        rows: usize,
        place: impl Fn(usize) -> (&'a Cell, &'a [f64]) + Sync,
    ) -> Self {
        let source = RowSource {
            scenarios,
            rows,
            place,
        };
        let obstacles = scenarios.iter().map(Scenario::obstacle_count).max();
        let obstacles = obstacles.unwrap_or(0);
        Self {
            outcome: source.column(|cell| cell.run.outcome),
            end_time: source.column(|cell| cell.run.end_time),
            arrival_time: source.column(|cell| cell.run.arrival_time),
            energy: source.column(|cell| cell.run.energy),
            path_length: source.column(|cell| cell.run.path_length),
            min_distance: source.distances(obstacles),
            obstacles,
            min_clearance: source.clearances(),
            entered_active: source.of_distances(entered_active),
            contacts_moving: source.column(|cell| i64::from(cell.run.contacts.moving())),
            contacts_toward: source.column(|cell| i64::from(cell.run.contacts.toward)),
            contacts_away: source.column(|cell| i64::from(cell.run.contacts.away)),
            contacts_standing: source.column(|cell| i64::from(cell.run.contacts.standing)),
            contacts_at_fault: source.column(|cell| i64::from(cell.run.contacts.at_fault)),
            contacts_apart: source.column(|cell| i64::from(cell.run.contacts.apart)),
            wall_contacts: source.column(|cell| i64::from(cell.run.contacts.walls)),
            performance_total: source.column(|cell| cell.performance.total),
            performance_arrival_time: source.column(|cell| cell.performance.arrival_time),
            performance_avoidance: source.column(|cell| cell.performance.avoidance),
            performance_energy_saving: source.column(|cell| cell.performance.energy_saving),
            descent_share: source.column(|cell| cell.run.descent_share),
            force_evaluations: source.column(|cell| cell.run.force_evaluations.cast_signed()),
        }
    }
}

/// Where the columns come from.
struct RowSource<'a, P> {
    scenarios: &'a [Scenario],
    rows: usize,
    /// Cell and distances of a row.
    place: P,
}

impl<'a, P: Fn(usize) -> (&'a Cell, &'a [f64]) + Sync> RowSource<'a, P> {
    fn column<T: Send>(&self, value: impl Fn(&Cell) -> T + Sync) -> Vec<T> {
        let place = &self.place;
        map(self.rows, |row| value(place(row).0))
    }

    /// Least distances of a row, and its scenario.
    fn of_row(&self, row: usize) -> (&'a Scenario, &'a [f64]) {
        let place = &self.place;
        (&self.scenarios[row % self.scenarios.len()], place(row).1)
    }

    fn of_distances<T: Send>(&self, value: fn(&Scenario, &[f64]) -> T) -> Vec<T> {
        let of_row = |row| {
            let (scenario, distances) = self.of_row(row);
            value(scenario, distances)
        };
        map(self.rows, of_row)
    }

    /// Least distances of the surfaces over all obstacles and maps.
    fn clearances(&self) -> Vec<f64> {
        let mut least = self.of_distances(min_clearance);
        for (row, least) in least.iter_mut().enumerate() {
            *least = least.min((self.place)(row).0.run.map_clearance);
        }
        least
    }

    fn distances(&self, width: usize) -> Vec<f64> {
        if width == 0 {
            return Vec::new();
        }
        let mut matrix = filled(f64::NAN, self.rows * width);
        each_piece(&mut matrix, width, |row, target| {
            let (_, distances) = self.of_row(row);
            target[..distances.len()].copy_from_slice(distances);
        });
        matrix
    }
}

/// Least distance of the surfaces in m.
pub(crate) fn min_clearance(scenario: &Scenario, distances: &[f64]) -> f64 {
    let pairs = distances.iter().zip(&scenario.obstacles);
    let clearance = pairs.map(|(distance, placed)| distance - placed.contact_distance);
    clearance.fold(f64::INFINITY, f64::min)
}

/// Number of obstacles whose active region was entered.
fn entered_active(scenario: &Scenario, distances: &[f64]) -> i64 {
    let pairs = distances.iter().zip(&scenario.obstacles);
    let inside = pairs.filter(|(distance, placed)| **distance < placed.regions.active_radius);
    inside.map(|_| 1).sum()
}
