//! Rows of a task, several side by side.

use super::{BatchOptions, Block, Width, code};
use crate::columns::{Columns, HeadColumns};
use crate::criteria::Impact;
use crate::fast::apart::apart;
use crate::fast::{CELL_ANGLE, FINE_CELL_ANGLE, Side, Walk, Workspace, one_row};
use crate::metrics::{FREE_HORIZON, Metrics, Status};
use numeric::lanes::{Lanes, Mask, Real};
use pulp::{Simd, WithSimd};

/// Fills a block.
pub(super) fn fill(columns: &Columns<'_>, options: &BatchOptions, block: &mut Block<'_>) {
    if matches!(columns.head, HeadColumns::Constrained) {
        for place in 0..block.status.len() {
            block.put(place, &alone(columns, options, block.first + place));
        }
        return;
    }
    let processor = match options.width {
        Some(Width::One) => pulp::Arch::Scalar,
        Some(Width::Eight) | None => pulp::Arch::new(),
    };
    processor.dispatch(SideBySide {
        columns,
        options,
        block,
    });
}

/// Rows of a task side by side, compiled once for each instruction set; the widest one that the
/// processor has is chosen at run time. The arithmetic is the same, bit for bit.
struct SideBySide<'a, 'b> {
    columns: &'a Columns<'a>,
    options: &'a BatchOptions,
    block: &'a mut Block<'b>,
}

impl WithSimd for SideBySide<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self {
            columns,
            options,
            block,
        } = self;
        // A number of every row takes two vectors of the processor; with more, registers run out.
        // Without vectors there are no lanes.
        if S::IS_SCALAR {
            by_width::<_, f64>(simd, columns, options, block);
        } else {
            by_width::<_, Lanes<8>>(simd, columns, options, block);
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
    if options.fields.searches().only_peaks() {
        apart(
            simd,
            #[inline(always)]
            || groups::<S, R, false>(simd, columns, options, block),
        );
    } else {
        apart(
            simd,
            #[inline(always)]
            || groups::<S, R, true>(simd, columns, options, block),
        );
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
        horizon: options.horizon.unwrap_or(FREE_HORIZON),
        cell_angle: CELL_ANGLE,
        humps: R::WIDTH == 1,
        searches: options.fields.searches(),
    };
    for place in (0..rows).step_by(R::WIDTH) {
        let count = R::WIDTH.min(rows - place);
        let first = block.first + place;
        // Lanes that are left over repeat the last row.
        let row = |lane: usize| first + lane.min(count - 1);
        let found = Side::<R>::of::<S, ALL>(simd, &mut space, columns, walk, row);
        let rows = place..place + count;
        found.store(
            block.loads.as_mut().map(|column| &mut **column),
            rows,
            options.gravity,
        );
        for lane in 0..count {
            block.status[place + lane] = code(found.status(lane));
        }
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

/// Deferred rows, side by side.
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
        horizon: options.horizon.unwrap_or(FREE_HORIZON),
        cell_angle: CELL_ANGLE,
        humps: true,
        searches: options.fields.searches(),
    };
    for places in put_off.chunks(R::WIDTH) {
        let row = |lane: usize| block.first + places[lane.min(places.len() - 1)];
        let found = Side::<R>::of::<S, ALL>(simd, space, columns, walk, row);
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
    let walk = Walk {
        horizon: options.horizon.unwrap_or(FREE_HORIZON),
        cell_angle: FINE_CELL_ANGLE,
        humps: true,
        searches: options.fields.searches(),
    };
    let only_peaks = walk.searches.only_peaks();
    let fine = match (&columns.head, only_peaks) {
        (HeadColumns::Constrained, _) => None,
        (_, false) => one_row::<true>(columns, walk, options.gravity, row),
        (_, true) => one_row::<false>(columns, walk, options.gravity, row),
    };
    if let Some(metrics) = fine {
        return metrics;
    }
    let Ok(impact) = Impact::new(&system, closing_speed, options.horizon) else {
        return Metrics::none(Status::TooStiff);
    };
    impact
        .findings_of(manipulator_speed, walk.searches)
        .metrics(&system, options.gravity)
}
