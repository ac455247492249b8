//! The batch beside single impacts.

use impact_core::batch::{BatchOptions, FieldSet, MetricColumns, Width, metrics_batch};
use impact_core::columns::{Column, Columns, HeadColumns};
use impact_core::criteria::{metrics, searched};
use impact_core::metrics::{CRITERIA, MetricOptions, Status};

/// Agreement of the two searches, relative: rounding, and what a Newton step is stopped at.
const AGREEMENT: f64 = 1e-11;

/// Numbers between 0 and 1 by a multiplicative generator.
fn uniform(seed: &mut u64) -> f64 {
    *seed = seed
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1_u64 << 53) as f64
}

struct Inputs(Vec<Vec<f64>>);

impl Inputs {
    fn random(rows: usize) -> Self {
        let mut seed = 7;
        let ranges = [
            [1.0, 60.0],
            [0.0, 600.0],
            [1e3, 4e4],
            [2e3, 8e4],
            [0.0, 400.0],
            [3.0, 7.0],
            [0.0, 200.0],
            [0.0, 8e3],
            [0.1, 3.0],
        ];
        Self(
            ranges
                .iter()
                .map(|[low, high]| {
                    (0..rows)
                        .map(|_| low + (high - low) * uniform(&mut seed))
                        .collect()
                })
                .collect(),
        )
    }

    fn columns(&self) -> Columns<'_> {
        let c = |index: usize| Column::Array(&self.0[index]);
        Columns {
            manipulator_mass: c(0),
            manipulator_damping: c(1),
            manipulator_stiffness: c(2),
            foam_stiffness: c(3),
            foam_damping: c(4),
            linear_range: Column::Value(0.02),
            head: HeadColumns::Free {
                mass: c(5),
                damping: c(6),
                stiffness: c(7),
            },
            closing_speed: c(8),
            manipulator_speed: None,
        }
    }
}

fn run(inputs: &Inputs, options: &BatchOptions) -> MetricColumns {
    metrics_batch(&inputs.columns(), options, &|| false, &|_| ()).unwrap()
}

#[test]
fn rows_equal_single_impacts() {
    compare(&Inputs::random(4000));
}

#[test]
#[ignore = "takes minutes"]
fn a_million_rows_equal_single_impacts() {
    compare(&Inputs::random(1_000_000));
}

/// Compares every field of a batch with the general search.
fn compare(inputs: &Inputs) {
    let batch = run(inputs, &BatchOptions::default());
    let mut worst = 0.0_f64;
    for row in 0..batch.rows {
        let system = inputs.columns().system(row);
        let options = MetricOptions::default();
        let one = searched(&system, inputs.0[8][row], &options).unwrap();
        let single = metrics(&system, inputs.0[8][row], &options).unwrap();
        let bits = |value: f64| value.to_bits();
        let columns = batch.loads.each_ref().map(|column| bits(column[row]));
        assert_eq!(single.loads.map(bits), columns, "row {row}");
        assert_eq!(
            Status::ALL[usize::from(batch.status[row])],
            one.status,
            "row {row}: {} for {}, {system:?}",
            batch.max_compression[row],
            one.max_compression,
        );
        for (name, many, one) in [
            (
                "a",
                batch.peak_head_acceleration[row],
                one.peak_head_acceleration,
            ),
            (
                "mean",
                batch.mean_head_acceleration_g[row],
                one.mean_head_acceleration_g,
            ),
            ("f", batch.peak_contact_force[row], one.peak_contact_force),
            ("eps", batch.max_compression[row], one.max_compression),
            ("t", batch.impact_duration[row], one.impact_duration),
            ("hic15", batch.hic15[row], one.hic15),
            ("hic36", batch.hic36[row], one.hic36),
            ("average", batch.average_3ms_g[row], one.average_3ms_g),
            ("clip", batch.clip_3ms_g[row], one.clip_3ms_g),
            (
                "pr",
                batch.peak_power_manipulator[row],
                one.peak_power_manipulator,
            ),
            ("pf", batch.peak_power_foam[row], one.peak_power_foam),
        ] {
            if many.to_bits() == one.to_bits() || (many.is_nan() && one.is_nan()) {
                continue;
            }
            let error = (many / one - 1.0).abs();
            worst = worst.max(error);
            assert!(
                error < AGREEMENT,
                "{name} of row {row}: {many} for {one}, {system:?}"
            );
        }
    }
    println!("worst {worst:e}");
}

#[test]
fn bits_do_not_depend_on_width_threads_or_fields() {
    let inputs = Inputs::random(2500);
    let base = run(&inputs, &BatchOptions::default());
    for (threads, width) in [
        (1, Width::One),
        (2, Width::One),
        (1, Width::Four),
        (2, Width::Four),
        (1, Width::Eight),
        (2, Width::Eight),
    ] {
        let options = BatchOptions {
            threads: Some(threads),
            width: Some(width),
            ..BatchOptions::default()
        };
        assert_eq!(format!("{:?}", run(&inputs, &options)), format!("{base:?}"));
    }
    let some: [FieldSet; 4] = [
        FieldSet::peaks(),
        FieldSet::of(|criterion| criterion.name.starts_with("hic")),
        FieldSet::of(|criterion| criterion.name.ends_with("_g")),
        FieldSet::of(|_| false),
    ];
    let alone = CRITERIA.map(|only| FieldSet::of(|criterion| criterion.name == only.name));
    for fields in some.into_iter().chain(alone) {
        for width in [Width::One, Width::Four, Width::Eight] {
            let options = BatchOptions {
                fields,
                width: Some(width),
                ..BatchOptions::default()
            };
            let few = run(&inputs, &options);
            assert_eq!(few.status, base.status);
            let all = base.loads.each_ref().into_array();
            for (place, (few, all)) in few.loads.into_array().iter().zip(all).enumerate() {
                for (row, (few, all)) in few.iter().zip(all).enumerate() {
                    let name = CRITERIA[place].name;
                    assert_eq!(few.to_bits(), all.to_bits(), "{name} of row {row}");
                }
            }
        }
    }
}

#[test]
fn impacts_without_a_release_equal_the_general_search() {
    let mut inputs = Inputs::random(4000);
    // Necks that hardly hold the head, so that the torso carries it along.
    for damping in &mut inputs.0[6] {
        *damping *= 3.0;
    }
    for stiffness in &mut inputs.0[7] {
        *stiffness *= 0.05;
    }
    let batch = run(&inputs, &BatchOptions::default());
    let lasting = (batch.status.iter())
        .filter(|&&status| Status::ALL[usize::from(status)] == Status::NoRelease)
        .count();
    assert!(lasting > 400, "{lasting}");
    compare(&inputs);
}

#[test]
fn bad_rows_are_told_and_do_not_spoil_others() {
    let mut inputs = Inputs::random(9);
    inputs.0[0][2] = -1.0;
    inputs.0[3][4] = f64::NAN;
    inputs.0[8][6] = 0.0;
    inputs.0[8][7] = f64::INFINITY;
    let batch = run(&inputs, &BatchOptions::default());
    let word = |row: usize| Status::ALL[usize::from(batch.status[row])].word();
    for (row, expected) in [
        (2, "invalid_parameter"),
        (4, "invalid_parameter"),
        (6, "no_impact"),
        (7, "invalid_parameter"),
    ] {
        assert_eq!(word(row), expected);
        assert!(batch.hic15[row].is_nan() && batch.impact_duration[row].is_nan());
    }
    for row in [0, 1, 3, 5, 8] {
        assert!(batch.hic15[row] > 0.0);
    }
}
