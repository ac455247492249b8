//! Rows of a task, several side by side.

use super::{BatchOptions, Block, Width, code};
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
pub(super) fn fill(columns: &Columns<'_>, options: &BatchOptions, block: &mut Block<'_>) {
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
        Some(Width::Eight) | None => on_eight(rows),
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
    block: &'a mut Block<'b>,
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
    block: &mut Block<'_>,
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
    block: &mut Block<'_>,
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
    block: &mut Block<'_>,
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

/// What a row misses, by the general search.
#[inline(never)]
fn finish_alone(
    columns: &Columns<'_>,
    options: &BatchOptions,
    block: &mut Block<'_>,
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

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use super::*;
    use crate::batch::{FieldSet, MetricColumns};
    use crate::columns::Column;
    use numeric::lanes::with_vectors;
    use pulp::x86::{V3, V3_512b, V4};

    const ROWS: usize = 300;

    /// A number of a column from its range.
    fn drawn(column: usize, row: usize) -> f64 {
        const RANGES: [[f64; 2]; 9] = [
            [1.0, 60.0],
            [0.0, 600.0],
            [1e3, 4e4],
            [3.0, 7.0],
            [0.0, 200.0],
            [0.0, 8e3],
            [2e3, 8e4],
            [0.0, 400.0],
            [0.1, 3.0],
        ];
        let share = ((row * 131 + 7 * column) as f64 * 0.618_033_988_749_895).fract();
        let mixed = (share * (37.0 + column as f64)).fract();
        let [low, high] = RANGES[column];
        low + (high - low) * mixed
    }

    fn found(fields: FieldSet, fill: impl Fn(SideBySide<'_, '_>)) -> (Vec<u64>, Vec<u8>) {
        let drawn: [Vec<f64>; 9] =
            std::array::from_fn(|column| (0..ROWS).map(|row| drawn(column, row)).collect());
        let [mass, damping, stiffness, m, c, k, foam, loss, speed] =
            drawn.each_ref().map(|values| Column::Array(values));
        let columns = Columns {
            manipulator_mass: mass,
            manipulator_damping: damping,
            manipulator_stiffness: stiffness,
            foam_stiffness: foam,
            foam_damping: loss,
            linear_range: Column::Value(0.02),
            head: HeadColumns::Free {
                mass: m,
                damping: c,
                stiffness: k,
            },
            closing_speed: speed,
            manipulator_speed: None,
        };
        let options = BatchOptions {
            fields,
            ..BatchOptions::default()
        };
        let mut result = MetricColumns::sized(ROWS, fields).unwrap();
        for mut block in result.blocks() {
            fill(SideBySide {
                columns: &columns,
                options: &options,
                block: &mut block,
            });
        }
        let loads = result.loads.into_array().into_iter().flatten();
        (loads.map(f64::to_bits).collect(), result.status)
    }

    #[test]
    fn every_kind_of_vector_gives_the_bits_of_single_rows() {
        for fields in [FieldSet::all(), FieldSet::peaks()] {
            let single = found(fields, |rows| rows.on_eight(Scalar, 0.0));
            if let Some(simd) = V3::try_new() {
                let pairs = found(fields, |rows| with_vectors(V3_512b(simd), rows));
                assert!(pairs == single, "256 bits");
            }
            if let Some(simd) = V4::try_new() {
                let wide = found(fields, |rows| with_vectors(simd, rows));
                assert!(wide == single, "512 bits");
            }
        }
    }
}
