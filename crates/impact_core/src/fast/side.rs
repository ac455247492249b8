//! Rows of numbers side by side, from their columns to their criteria.

use std::ops::Range;

use super::{CELL_ANGLE, FINE_CELL_ANGLE, Group, GroupPeaks, GroupRest, Workspace};
use crate::columns::{Column, Columns, HeadColumns};
use crate::metrics::Searches;
use crate::metrics::{FREE_HORIZON, Loads, MetricOptions, Metrics, Status};
use crate::parameters::{System, Target};
use crate::series::Plant;
use numeric::lanes::{Mask, Real};
use pulp::{Scalar, Simd};

/// How the responses of rows side by side are walked along.
#[derive(Clone, Copy)]
pub struct Walk {
    /// Time until which a release counts, in s.
    pub horizon: f64,
    /// Length of a cell times the fastest root.
    pub cell_angle: f64,
    /// Whether rows with two humps or a shelf are followed.
    pub humps: bool,
    /// What is wanted besides peaks.
    pub searches: Searches,
}

/// Metrics of rows side by side.
pub struct Side<R: Real> {
    peaks: GroupPeaks<R>,
    rest: Option<GroupRest<R>>,
    /// Lanes that need no general search.
    pub accepted: R::Mask,
    /// Lanes whose compression stays in the linear range.
    within: R::Mask,
}

/// Gathers a column for rows side by side.
#[inline(always)]
fn gather<R: Real>(column: &Column<'_>, row: impl Fn(usize) -> usize) -> R {
    match column {
        Column::Value(value) => R::splat(*value),
        Column::Array(values) => R::from_fn(|lane| values[row(lane)]),
    }
}

impl<R: Real> Side<R> {
    /// Solves rows side by side.
    #[inline(always)]
    pub fn of<S: Simd, const ALL: bool>(
        simd: S,
        space: &mut Workspace<R>,
        columns: &Columns<'_>,
        walk: Walk,
        row: impl Fn(usize) -> usize,
    ) -> Self {
        let one = |column: &Column<'_>| gather::<R>(column, &row);
        let arm = [
            one(&columns.manipulator_mass),
            one(&columns.manipulator_damping),
            one(&columns.manipulator_stiffness),
        ];
        let foam = [one(&columns.foam_stiffness), one(&columns.foam_damping)];
        let head = match &columns.head {
            HeadColumns::Free {
                mass,
                damping,
                stiffness,
            } => [one(mass), one(damping), one(stiffness)],
            HeadColumns::Constrained => [R::splat(f64::INFINITY); 3],
        };
        let range = one(&columns.linear_range);
        let closing_speed = one(&columns.closing_speed);
        let manipulator_speed = columns
            .manipulator_speed
            .as_ref()
            .map_or(closing_speed, one);
        let (zero, largest) = (R::zero(), R::splat(f64::MAX));
        let mut valid = manipulator_speed.abs().le(largest);
        for value in [arm[0], head[0], range, closing_speed] {
            valid = valid & value.gt(zero) & value.le(largest);
        }
        for value in [arm[1], arm[2], head[1], head[2], foam[0], foam[1]] {
            valid = valid & value.ge(zero) & value.le(largest);
        }
        let over = |[mass, damping, stiffness]: [R; 3]| {
            let inverse = R::splat(1.0) / mass;
            [inverse, damping * inverse, stiffness * inverse]
        };
        let group = Group {
            plant: Plant {
                manipulator: over(arm),
                head: over(head),
                foam,
            },
            closing_speed,
            manipulator_speed,
            horizon: walk.horizon,
            cell_angle: walk.cell_angle,
            humps: walk.humps,
            searches: walk.searches,
        };
        let mut solved = group.solve::<S, ALL>(simd, space, valid);
        let peaks = solved.peaks();
        let rest = ALL.then(|| solved.rest(&peaks));
        Self {
            accepted: rest.as_ref().map_or(peaks.accepted, |rest| rest.accepted),
            within: peaks.compression.le(range),
            peaks,
            rest,
        }
    }

    /// Whether a lane is left for later.
    #[inline(always)]
    pub fn is_put_off(&self, lane: usize) -> bool {
        self.rest
            .as_ref()
            .is_some_and(|rest| rest.put_off.lane(lane))
    }

    /// The criteria; NaN where they were not asked for.
    #[inline(always)]
    fn loads(&self, gravity: f64) -> Loads<R> {
        let (peaks, per_g) = (&self.peaks, R::splat(gravity));
        let nothing = R::splat(f64::NAN);
        let loads = Loads {
            peak_head_acceleration: peaks.head_acceleration,
            peak_head_acceleration_g: peaks.head_acceleration / per_g,
            mean_head_acceleration_g: nothing,
            peak_contact_force: peaks.contact_force,
            max_compression: peaks.compression,
            impact_duration: peaks.duration,
            hic15: nothing,
            hic36: nothing,
            average_3ms_g: nothing,
            clip_3ms_g: nothing,
            peak_power_manipulator: nothing,
            peak_power_foam: nothing,
        };
        let Some(rest) = &self.rest else {
            return loads;
        };
        // T mean^2.5 with the mean in g.
        let scale = R::splat(gravity * gravity * gravity.sqrt());
        Loads {
            mean_head_acceleration_g: rest.mean / per_g,
            hic15: rest.injury[0] / scale,
            hic36: rest.injury[1] / scale,
            average_3ms_g: rest.average / per_g,
            clip_3ms_g: rest.clip / per_g,
            peak_power_manipulator: rest.manipulator_power,
            peak_power_foam: rest.foam_power,
            ..loads
        }
    }

    /// What the row of an accepted lane means.
    #[inline(always)]
    pub fn status(&self, lane: usize) -> Status {
        if self.within.lane(lane) {
            Status::Released
        } else {
            Status::BeyondLinearRange
        }
    }

    /// Metrics of a lane.
    #[inline(always)]
    pub fn lane(&self, lane: usize, gravity: f64) -> Metrics {
        Metrics {
            loads: self.loads(gravity).map(|value| value.lane(lane)),
            status: self.status(lane),
        }
    }

    /// Writes the first lanes into columns, those that are there.
    #[inline(always)]
    pub fn store(&self, columns: Loads<&mut [f64]>, rows: Range<usize>, gravity: f64) {
        columns.each_with(self.loads(gravity), |column, value| {
            let cells = column.get_mut(rows.clone()).into_iter().flatten();
            for (lane, cell) in cells.enumerate() {
                *cell = value.lane(lane);
            }
        });
    }
}

/// Metrics of one impact if its response has the usual shape; numbers are in range.
pub(crate) fn usual(
    system: &System,
    closing_speed: f64,
    options: &MetricOptions,
) -> Option<Metrics> {
    let head = match system.head {
        Target::Free(head) => HeadColumns::Free {
            mass: Column::Value(head.mass),
            damping: Column::Value(head.damping),
            stiffness: Column::Value(head.stiffness),
        },
        Target::Constrained => return None,
    };
    let columns = Columns {
        manipulator_mass: Column::Value(system.manipulator.mass),
        manipulator_damping: Column::Value(system.manipulator.damping),
        manipulator_stiffness: Column::Value(system.manipulator.stiffness),
        foam_stiffness: Column::Value(system.foam.stiffness),
        foam_damping: Column::Value(system.foam.damping),
        linear_range: Column::Value(system.foam.linear_range),
        head,
        closing_speed: Column::Value(closing_speed),
        manipulator_speed: options.manipulator_speed.map(Column::Value),
    };
    let horizon = options.horizon.unwrap_or(FREE_HORIZON);
    [CELL_ANGLE, FINE_CELL_ANGLE]
        .into_iter()
        .find_map(|cell_angle| {
            let walk = Walk {
                horizon,
                cell_angle,
                humps: true,
                searches: Searches::ALL,
            };
            one_row::<true>(&columns, walk, options.gravity, 0)
        })
}

/// Metrics of one row if its response has the usual shape in cells of some length.
#[inline(never)]
pub(crate) fn one_row<const ALL: bool>(
    columns: &Columns<'_>,
    walk: Walk,
    gravity: f64,
    row: usize,
) -> Option<Metrics> {
    let mut space = Workspace::new();
    let found = Side::<f64>::of::<_, ALL>(Scalar, &mut space, columns, walk, |_| row);
    found.accepted.then(|| found.lane(0, gravity))
}
