//! Records of a run while it lasts.

use crate::run::options::Kept;
use navigation_laws::Command;
use navigation_world::world::geometry::Body;
use navigation_world::world::scenario::Scenario;
use numeric::lanes::{Planar, Real, Vector2};

/// Listens to a run.
pub trait Recorder<R: Real> {
    /// Set for a recorder of the state at every step.
    const EVERY_STEP: bool = false;
    /// A force was computed; `running`: for whom it counts.
    fn sample(&mut self, _command: &Command<R>, _running: R::Mask) {}
    /// State at the start of a step.
    fn row(
        &mut self,
        _time: f64,
        _position: Vector2<R>,
        _velocity: Vector2<R>,
        _currents: &[R; 3],
        _command: &Command<R>,
        _bodies: &[Body<R>],
    ) {
    }
    /// A run begins in a lane.
    fn enter(&mut self, _lane: usize) {}
    /// Share of the control periods over which the Lyapunov function did not grow.
    fn descent_share(&self, _lane: usize) -> f64 {
        f64::NAN
    }
}

/// Keeps nothing.
impl<R: Real> Recorder<R> for () {}

/// Counts the control periods over which the Lyapunov function did not grow.
#[derive(Clone, Debug)]
pub struct DescentCounter<R> {
    last: R,
    periods: R,
    descents: R,
}

impl<R: Real> Default for DescentCounter<R> {
    fn default() -> Self {
        Self {
            last: R::splat(f64::NAN),
            periods: R::zero(),
            descents: R::zero(),
        }
    }
}

impl<R: Real> Recorder<R> for DescentCounter<R> {
    fn enter(&mut self, lane: usize) {
        self.last.set(lane, f64::NAN);
        self.periods.set(lane, 0.0);
        self.descents.set(lane, 0.0);
    }

    fn sample(&mut self, command: &Command<R>, running: R::Mask) {
        let value = command.lyapunov;
        // False where either value is NaN.
        let fell = value.le(self.last);
        let counted = running & (fell | self.last.lt(value));
        let one = R::splat(1.0);
        self.periods = R::select(counted, self.periods + one, self.periods);
        self.descents = R::select(running & fell, self.descents + one, self.descents);
        self.last = value;
    }

    fn descent_share(&self, lane: usize) -> f64 {
        self.descents.lane(lane) / self.periods.lane(lane)
    }
}

/// Columns of a recorded run; vectors of the plane are interleaved, obstacles vary fastest. Columns
/// that were not kept are empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trajectory {
    /// Instants in s.
    pub time: Vec<f64>,
    /// Positions in m.
    pub position: Vec<f64>,
    /// Velocities in m/s.
    pub velocity: Vec<f64>,
    /// Commanded forces in N.
    pub force: Vec<f64>,
    /// Stabilizing forces in N.
    pub stabilizing: Vec<f64>,
    /// Lyapunov function in N^2.
    pub lyapunov: Vec<f64>,
    /// Motor currents in A.
    pub wheel_current: Vec<f64>,
    /// Obstacle positions in m; NaN while absent.
    pub obstacle_position: Vec<f64>,
    /// Distances `d` in m; NaN while absent.
    pub distance: Vec<f64>,
}

/// Keeps one run.
#[derive(Clone, Debug)]
pub struct TrajectoryRecorder {
    columns: Trajectory,
    command: Command<f64>,
    wanted: Wanted,
    /// Motion steps between two rows, and until the next one.
    every: usize,
    left: usize,
}

/// Which columns are kept.
#[derive(Clone, Copy, Debug)]
#[allow(clippy::struct_excessive_bools)] // independent of each other
struct Wanted {
    force: bool,
    stabilizing: bool,
    lyapunov: bool,
    wheel_current: bool,
    obstacle_position: bool,
    distance: bool,
}

impl TrajectoryRecorder {
    /// Recorder of everything for a scenario.
    #[must_use]
    pub fn new(scenario: &Scenario) -> Self {
        Self::keeping(Kept::default(), scenario)
    }

    /// Recorder of some rows and columns for a scenario.
    #[must_use]
    pub fn keeping(kept: Kept, scenario: &Scenario) -> Self {
        let wanted = Wanted {
            force: kept.has("force"),
            stabilizing: kept.has("stabilizing"),
            lyapunov: kept.has("lyapunov"),
            wheel_current: kept.has("wheel_current"),
            obstacle_position: kept.has("obstacle_position"),
            distance: kept.has("distance"),
        };
        // Room for an ordinary run, so that it does not grow in the loop.
        let rows = 1200 / kept.every;
        let room = |wanted: bool, width: usize| -> Vec<f64> {
            Vec::with_capacity(if wanted { width * rows } else { 0 })
        };
        let obstacles = scenario.obstacle_count();
        let columns = Trajectory {
            time: room(true, 1),
            position: room(true, 2),
            velocity: room(true, 2),
            force: room(wanted.force, 2),
            stabilizing: room(wanted.stabilizing, 2),
            lyapunov: room(wanted.lyapunov, 1),
            wheel_current: room(wanted.wheel_current, 3),
            obstacle_position: room(wanted.obstacle_position, 2 * obstacles),
            distance: room(wanted.distance, obstacles),
        };
        let command = Command {
            force: Vector2::zeros(),
            stabilizing: Vector2::zeros(),
            lyapunov: f64::NAN,
        };
        Self {
            columns,
            command,
            wanted,
            every: kept.every,
            left: 0,
        }
    }

    /// State at the end of the run.
    pub fn end(
        &mut self,
        time: f64,
        position: Vector2<f64>,
        velocity: Vector2<f64>,
        currents: &[f64; 3],
        bodies: &[Body],
    ) {
        let command = self.command;
        self.left = 0;
        self.row(time, position, velocity, currents, &command, bodies);
    }

    /// The columns.
    #[must_use]
    pub fn finish(self) -> Trajectory {
        self.columns
    }
}

impl Recorder<f64> for TrajectoryRecorder {
    const EVERY_STEP: bool = true;

    fn sample(&mut self, command: &Command<f64>, _running: bool) {
        self.command = *command;
    }

    fn row(
        &mut self,
        time: f64,
        position: Vector2<f64>,
        velocity: Vector2<f64>,
        currents: &[f64; 3],
        command: &Command<f64>,
        bodies: &[Body],
    ) {
        if self.left > 0 {
            self.left -= 1;
            return;
        }
        self.left = self.every - 1;
        let (columns, wanted) = (&mut self.columns, self.wanted);
        columns.time.push(time);
        columns.position.extend(position.lane(0));
        columns.velocity.extend(velocity.lane(0));
        if wanted.force {
            columns.force.extend(command.force.lane(0));
        }
        if wanted.stabilizing {
            columns.stabilizing.extend(command.stabilizing.lane(0));
        }
        if wanted.lyapunov {
            columns.lyapunov.push(command.lyapunov);
        }
        if wanted.wheel_current {
            columns.wheel_current.extend(currents);
        }
        if wanted.obstacle_position {
            columns
                .obstacle_position
                .extend(bodies.iter().flat_map(place_of));
        }
        if wanted.distance {
            let distances = bodies.iter().map(|body| distance_of(body, position));
            columns.distance.extend(distances);
        }
    }
}

impl TrajectoryRecorder {
    /// Puts other distances into the last row, if they are recorded and it was kept.
    pub fn set_distances(&mut self, distances: impl ExactSizeIterator<Item = f64>) {
        let kept = self.left + 1 == self.every;
        if self.wanted.distance && kept {
            let last = self.columns.distance.len() - distances.len();
            self.columns.distance.truncate(last);
            self.columns.distance.extend(distances);
        }
    }
}

/// Position of an obstacle in m; NaN while it is absent.
fn place_of(body: &Body) -> [f64; 2] {
    if body.state.present {
        body.state.position
    } else {
        [f64::NAN; 2]
    }
}

/// Distance `d` of an obstacle in m; NaN while it is absent.
fn distance_of(body: &Body, position: Vector2<f64>) -> f64 {
    if body.state.present {
        body.offset(position).distance_squared.sqrt()
    } else {
        f64::NAN
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use numeric::lanes::Mask;

    #[test]
    fn counts_only_periods_with_two_values() {
        let mut counter = DescentCounter::<f64>::default();
        for value in [3.0, 2.0, 2.5, f64::NAN, 1.0, 0.5] {
            let command = Command {
                force: Vector2::zeros(),
                stabilizing: Vector2::zeros(),
                lyapunov: value,
            };
            counter.sample(&command, bool::splat(true));
        }
        // 3 -> 2 fell, 2 -> 2.5 grew, 1 -> 0.5 fell.
        assert_eq!(counter.descent_share(0), 2.0 / 3.0);
    }
}
