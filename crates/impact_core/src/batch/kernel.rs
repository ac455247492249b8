//! Rows of a task, several side by side.

use super::{BatchOptions, Block, Column, Columns, FieldSet, HeadColumns, Width, code};
use crate::criteria::{FREE_HORIZON, Impact, MetricOptions, Metrics, Status};
use crate::fast::apart::apart;
use crate::fast::{CELL_ANGLE, FINE_CELL_ANGLE, Group, GroupPeaks, GroupRest, Workspace};
use crate::parameters::{System, Target};
use crate::series::Plant;
use numeric::lanes::{Lanes, Mask, Real};
use pulp::{Scalar, Simd, WithSimd};

/// Fills a block.
pub(super) fn fill(columns: &Columns<'_>, options: &BatchOptions, block: &mut Block<'_>) {
    if matches!(columns.head, HeadColumns::Constrained) {
        for place in 0..block.status.len() {
            block.put(place, &alone(columns, options, block.first + place));
        }
        return;
    }
    let width = options.width.unwrap_or(Width::Eight);
    if width == Width::One {
        by_width::<_, f64>(Scalar, columns, options, block);
        return;
    }
    pulp::Arch::new().dispatch(SideBySide {
        columns,
        options,
        block,
        width,
    });
}

/// Rows of a task side by side, compiled once for each instruction set; the widest one that the
/// processor has is chosen at run time. The arithmetic is the same, bit for bit.
struct SideBySide<'a, 'b> {
    columns: &'a Columns<'a>,
    options: &'a BatchOptions,
    block: &'a mut Block<'b>,
    width: Width,
}

impl WithSimd for SideBySide<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self {
            columns,
            options,
            block,
            width,
        } = self;
        match width {
            Width::One => by_width::<_, f64>(simd, columns, options, block),
            Width::Four => by_width::<_, Lanes<4>>(simd, columns, options, block),
            Width::Eight => by_width::<_, Lanes<8>>(simd, columns, options, block),
            Width::Sixteen => by_width::<_, Lanes<16>>(simd, columns, options, block),
        }
    }
}

#[inline(always)]
fn by_width<S: Simd, R: Real>(
    simd: S,
    columns: &Columns<'_>,
    options: &BatchOptions,
    block: &mut Block<'_>,
) {
    // Bodies of their own: an unoptimized build keeps room on the stack for every call.
    match options.fields {
        FieldSet::All => apart(
            simd,
            #[inline(always)]
            || groups::<S, R, true>(simd, columns, options, block),
        ),
        FieldSet::Peaks => apart(
            simd,
            #[inline(always)]
            || groups::<S, R, false>(simd, columns, options, block),
        ),
    }
}

#[inline(always)]
fn groups<S: Simd, R: Real, const ALL: bool>(
    simd: S,
    columns: &Columns<'_>,
    options: &BatchOptions,
    block: &mut Block<'_>,
) {
    let rows = block.status.len();
    let mut space = Workspace::new();
    // Rows whose response has two humps or a shelf, when others are beside them.
    let mut put_off = Vec::new();
    let walk = Walk {
        cell_angle: CELL_ANGLE,
        humps: R::WIDTH == 1,
    };
    for place in (0..rows).step_by(R::WIDTH) {
        let count = R::WIDTH.min(rows - place);
        let first = block.first + place;
        // Lanes that are left over repeat the last row.
        let row = |lane: usize| first + lane.min(count - 1);
        let found = Side::<R>::of::<S, ALL>(simd, &mut space, columns, options, walk, row);
        found.store(block, place, count, options.gravity);
        for lane in 0..count {
            if found.is_put_off(lane) {
                put_off.push(place + lane);
            } else if !found.accepted.lane(lane) {
                block.put(place + lane, &alone(columns, options, first + lane));
            }
        }
    }
    if !put_off.is_empty() {
        apart(
            simd,
            #[inline(always)]
            || followed::<S, R, ALL>(simd, &mut space, columns, options, block, &put_off),
        );
    }
}

/// Rows that were put off, side by side.
#[inline(always)]
fn followed<S: Simd, R: Real, const ALL: bool>(
    simd: S,
    space: &mut Workspace<R>,
    columns: &Columns<'_>,
    options: &BatchOptions,
    block: &mut Block<'_>,
    put_off: &[usize],
) {
    let walk = Walk {
        cell_angle: CELL_ANGLE,
        humps: true,
    };
    for places in put_off.chunks(R::WIDTH) {
        let row = |lane: usize| block.first + places[lane.min(places.len() - 1)];
        let found = Side::<R>::of::<S, ALL>(simd, space, columns, options, walk, row);
        for (lane, place) in places.iter().enumerate() {
            let metrics = if found.accepted.lane(lane) {
                found.lane(lane, options.gravity)
            } else {
                alone(columns, options, block.first + place)
            };
            block.put(*place, &metrics);
        }
    }
}

/// How the responses of rows side by side are walked along.
#[derive(Clone, Copy)]
struct Walk {
    /// Length of a cell times the fastest root.
    cell_angle: f64,
    /// Whether rows with two humps or a shelf are followed.
    humps: bool,
}

/// Metrics of rows side by side.
struct Side<R: Real> {
    peaks: GroupPeaks<R>,
    rest: Option<GroupRest<R>>,
    /// Lanes that need no general search.
    accepted: R::Mask,
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
    #[inline(always)]
    fn of<S: Simd, const ALL: bool>(
        simd: S,
        space: &mut Workspace<R>,
        columns: &Columns<'_>,
        options: &BatchOptions,
        Walk { cell_angle, humps }: Walk,
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
            horizon: options.horizon.unwrap_or(FREE_HORIZON),
            cell_angle,
            humps,
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
    fn is_put_off(&self, lane: usize) -> bool {
        self.rest
            .as_ref()
            .is_some_and(|rest| rest.put_off.lane(lane))
    }

    /// Metrics of a lane.
    #[inline(always)]
    fn lane(&self, lane: usize, gravity: f64) -> Metrics {
        let acceleration = self.peaks.head_acceleration.lane(lane);
        let mut metrics = Metrics {
            peak_head_acceleration: acceleration,
            peak_head_acceleration_g: acceleration / gravity,
            peak_contact_force: self.peaks.contact_force.lane(lane),
            max_compression: self.peaks.compression.lane(lane),
            impact_duration: self.peaks.duration.lane(lane),
            ..Metrics::none(if self.within.lane(lane) {
                Status::Released
            } else {
                Status::BeyondLinearRange
            })
        };
        if let Some(rest) = &self.rest {
            let scale = gravity * gravity * gravity.sqrt();
            metrics.mean_head_acceleration_g = rest.mean.lane(lane) / gravity;
            metrics.hic15 = rest.injury[0].lane(lane) / scale;
            metrics.hic36 = rest.injury[1].lane(lane) / scale;
            metrics.average_3ms_g = rest.average.lane(lane) / gravity;
            metrics.clip_3ms_g = rest.clip.lane(lane) / gravity;
            metrics.peak_power_manipulator = rest.manipulator_power.lane(lane);
            metrics.peak_power_foam = rest.foam_power.lane(lane);
        }
        metrics
    }

    /// Writes the first lanes into a block.
    #[inline(always)]
    fn store(&self, block: &mut Block<'_>, place: usize, count: usize, gravity: f64) {
        let put = |column: &mut [f64], value: R| {
            for (lane, cell) in column[place..place + count].iter_mut().enumerate() {
                *cell = value.lane(lane);
            }
        };
        let peaks = &self.peaks;
        let per_g = R::splat(gravity);
        put(block.peak_head_acceleration, peaks.head_acceleration);
        put(
            block.peak_head_acceleration_g,
            peaks.head_acceleration / per_g,
        );
        put(block.peak_contact_force, peaks.contact_force);
        put(block.max_compression, peaks.compression);
        put(block.impact_duration, peaks.duration);
        if let Some(rest) = &self.rest {
            let scale = R::splat(gravity * gravity * gravity.sqrt());
            put(block.mean_head_acceleration_g, rest.mean / per_g);
            put(block.hic15, rest.injury[0] / scale);
            put(block.hic36, rest.injury[1] / scale);
            put(block.average_3ms_g, rest.average / per_g);
            put(block.clip_3ms_g, rest.clip / per_g);
            put(block.peak_power_manipulator, rest.manipulator_power);
            put(block.peak_power_foam, rest.foam_power);
        }
        let [released, beyond] = [Status::Released, Status::BeyondLinearRange].map(code);
        for (lane, status) in block.status[place..place + count].iter_mut().enumerate() {
            *status = if self.within.lane(lane) {
                released
            } else {
                beyond
            };
        }
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
    let batch = BatchOptions {
        horizon: options.horizon,
        gravity: options.gravity,
        ..BatchOptions::default()
    };
    by_itself::<true>(&columns, &batch, CELL_ANGLE, 0)
        .or_else(|| by_itself::<true>(&columns, &batch, FINE_CELL_ANGLE, 0))
}

/// Metrics of one row if its response has the usual shape in cells of some length.
#[inline(never)]
fn by_itself<const ALL: bool>(
    columns: &Columns<'_>,
    options: &BatchOptions,
    cell_angle: f64,
    row: usize,
) -> Option<Metrics> {
    let mut space = Workspace::new();
    let walk = Walk {
        cell_angle,
        humps: true,
    };
    let found = Side::<f64>::of::<_, ALL>(Scalar, &mut space, columns, options, walk, |_| row);
    found.accepted.then(|| found.lane(0, options.gravity))
}

/// One row in finer cells, or by the general search.
#[inline(never)]
fn alone(columns: &Columns<'_>, options: &BatchOptions, row: usize) -> Metrics {
    let system = columns.system(row);
    let [closing_speed, manipulator_speed] = columns.speeds(row);
    let valid =
        system.checked().is_ok() && closing_speed.is_finite() && manipulator_speed.is_finite();
    if !valid {
        return Metrics::none(Status::InvalidParameter);
    }
    if closing_speed <= 0.0 {
        return Metrics::none(Status::NoImpact);
    }
    let fine = match (&columns.head, options.fields) {
        (HeadColumns::Constrained, _) => None,
        (_, FieldSet::All) => by_itself::<true>(columns, options, FINE_CELL_ANGLE, row),
        (_, FieldSet::Peaks) => by_itself::<false>(columns, options, FINE_CELL_ANGLE, row),
    };
    if let Some(metrics) = fine {
        return metrics;
    }
    let Ok(impact) = Impact::new(&system, closing_speed, options.horizon) else {
        return Metrics::none(Status::TooStiff);
    };
    match options.fields {
        FieldSet::All => impact
            .findings(manipulator_speed)
            .metrics(&system, options.gravity),
        FieldSet::Peaks => impact.peaks().metrics(&system, options.gravity),
    }
}
