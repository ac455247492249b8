//! Rows of a task, several side by side.

use super::{BatchOptions, RowBlock, Width, code};
use crate::columns::{Columns, HeadColumns};
use crate::criteria::Impact;
use crate::fast::apart::apart;
use crate::fast::{CELL_ANGLE, FINE_CELL_ANGLE, MOST_LANES, Rows, Side, Walk, Workspace};
use crate::metrics::{FREE_HORIZON, Metrics, Missing, Status};
use numeric::lanes::{Number, OnEight, Truth, on_eight, vectors};
use pulp::{Scalar, Simd};

/// A row by its place in a block, and what it misses.
type Open = (usize, Missing);

/// Fills a block.
pub(super) fn fill(columns: &Columns<'_>, options: &BatchOptions, block: &mut RowBlock<'_>) {
    if matches!(columns.head, HeadColumns::Constrained) {
        for place in 0..block.status.len() {
            finish_alone(columns, options, block, (place, options.fields.missing()));
        }
        return;
    }
    let rows = SideBySide {
        columns,
        options,
        block,
    };
    let alone = match options.width {
        Some(Width::One) => Err(rows),
        Some(Width::Four) => on_eight(false, rows),
        Some(Width::Eight) | None => on_eight(true, rows),
    };
    if let Err(rows) = alone {
        // Vectors come with fused products and sums, which single numbers use, too.
        match vectors() {
            Some(vectors) => rows.on_eight(vectors, 0.0),
            None => rows.on_eight(Scalar, 0.0),
        }
    }
}

/// Rows side by side, or one after the other. The arithmetic is the same, bit for bit.
struct SideBySide<'a, 'b> {
    columns: &'a Columns<'a>,
    options: &'a BatchOptions,
    block: &'a mut RowBlock<'b>,
}

impl OnEight for SideBySide<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn on_eight<S: Simd, R: Number>(self, simd: S, zero: R) {
        by_width(simd, zero, self.columns, self.options, self.block);
    }
}

#[inline(always)]
fn by_width<S: Simd, R: Number>(
    simd: S,
    zero: R,
    columns: &Columns<'_>,
    options: &BatchOptions,
    block: &mut RowBlock<'_>,
) {
    // Bodies of their own: an unoptimized build keeps room on the stack for every call.
    if options.fields.missing().searches().only_peaks() {
        apart(
            simd,
            #[inline(always)]
            || groups::<S, R, false>(simd, zero, columns, options, block),
        );
    } else {
        apart(
            simd,
            #[inline(always)]
            || groups::<S, R, true>(simd, zero, columns, options, block),
        );
    }
}

#[inline(always)]
fn groups<S: Simd, R: Number, const ALL: bool>(
    simd: S,
    zero: R,
    columns: &Columns<'_>,
    options: &BatchOptions,
    block: &mut RowBlock<'_>,
) {
    let rows = block.status.len();
    let mut space = Workspace::new(simd, zero);
    // Rows whose response has two humps or a shelf, when others are beside them.
    let mut put_off: Vec<Open> = Vec::new();
    let mut refused: Vec<Open> = Vec::new();
    let asked = options.fields.missing();
    let walk = Walk {
        horizon: options.horizon.unwrap_or(FREE_HORIZON),
        cell_angle: CELL_ANGLE,
        humps: R::WIDTH == 1,
        searches: asked.searches(),
    };
    for place in (0..rows).step_by(R::WIDTH) {
        let count = R::WIDTH.min(rows - place);
        let first = block.first + place;
        let rows = if count == R::WIDTH {
            Rows::From(first)
        } else {
            each_of(count, |lane| first + lane)
        };
        let found = Side::of::<S, ALL>(&mut space, columns, walk, rows);
        let rows = place..place + count;
        found.store(
            block.loads.as_mut().map(|column| &mut **column),
            rows.clone(),
            options.gravity,
        );
        for (cell, status) in block.status[rows].iter_mut().zip(found.status()) {
            *cell = code(status);
        }
        let lacking = found.lacking(asked);
        if lacking.any() {
            let known = found.known(options.gravity);
            for lane in (0..count).filter(|&lane| lacking.lane(lane)) {
                let open = (place + lane, asked.without(known[lane]));
                if found.is_put_off(lane) {
                    put_off.push(open);
                } else {
                    refused.push(open);
                }
            }
        }
    }
    let followed = Walk {
        humps: true,
        ..walk
    };
    let finer = Walk {
        cell_angle: FINE_CELL_ANGLE,
        ..followed
    };
    let mut open = Vec::new();
    for (walk, mut more) in [(followed, put_off), (finer, refused)] {
        open.append(&mut more);
        if !open.is_empty() {
            apart(
                simd,
                #[inline(always)]
                || again::<S, R, ALL>(&mut space, columns, options, block, walk, &mut open),
            );
        }
    }
    for open in open {
        finish_alone(columns, options, block, open);
    }
}

/// Rows of the first lanes; those that are left over repeat the last one.
fn each_of(count: usize, row: impl Fn(usize) -> usize) -> Rows {
    Rows::Each(std::array::from_fn(|lane| row(lane.min(count - 1))))
}

/// Looks once more at rows that miss something, side by side; those that still do remain.
#[inline(always)]
fn again<S: Simd, R: Number, const ALL: bool>(
    space: &mut Workspace<S, R>,
    columns: &Columns<'_>,
    options: &BatchOptions,
    block: &mut RowBlock<'_>,
    walk: Walk,
    open: &mut Vec<Open>,
) {
    for rows in open.chunks_mut(R::WIDTH) {
        let places = each_of(rows.len(), |lane| block.first + rows[lane].0);
        let wanted = rows.iter().fold(Missing::NOTHING, |wanted, (_, missing)| {
            wanted.with(*missing)
        });
        let walk = Walk {
            searches: wanted.searches(),
            ..walk
        };
        let found = Side::of::<S, ALL>(space, columns, walk, places);
        let known: [Missing; MOST_LANES] = found.known(options.gravity);
        for ((lane, (place, missing)), known) in rows.iter_mut().enumerate().zip(known) {
            let left = missing.without(known);
            block.put(
                *place,
                &found.lane(lane, options.gravity),
                missing.without(left),
            );
            *missing = left;
        }
    }
    open.retain(|(_, missing)| !missing.is_nothing());
}

/// Finds the missing metrics of a row by the general search.
#[inline(never)]
fn finish_alone(
    columns: &Columns<'_>,
    options: &BatchOptions,
    block: &mut RowBlock<'_>,
    (place, missing): Open,
) {
    let found = alone(columns, options, block.first + place, missing);
    block.put(place, &found, missing);
}

fn alone(columns: &Columns<'_>, options: &BatchOptions, row: usize, missing: Missing) -> Metrics {
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
    let Ok(impact) = Impact::new(&system, closing_speed, options.horizon) else {
        return Metrics::none(Status::TooStiff);
    };
    impact
        .findings_of(manipulator_speed, missing.searches())
        .metrics(&system, options.gravity)
}
