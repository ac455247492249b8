//! Virtual impedance and follower: conversion of arguments and results.

pub mod echoes;
pub mod runs;
pub mod steps;

use numpy::PyReadonlyArray1;
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::lanes::Vector2;
use vff_core::laws::impedance::collision::Pairing;
use vff_core::laws::impedance::{
    Attraction, BankOptions, Form, Impedance, RateFilter, Rotation, Speed, clamped_foot,
    collision_point, foot, printed_foot,
};
use vff_core::robots::differential::{Integration, VelocityDrive};
use vff_core::run::follower::{FixNoise, Fixes, Settings, VelocityRule};
use vff_core::world::frame::Frame;
use vff_core::world::motion::Motion;
use vff_core::world::obstacle::Obstacle;

use crate::arrays::fields;
use crate::errors::{CoreError, CoreResult};
use crate::keywords::{Keywords, taken, word};
use crate::robots::sensing::Vision;
use echoes::{EchoShape, Sonar};

type Column<'py> = PyReadonlyArray1<'py, f64>;
type Rows<'py> = PyReadonlyArray2<'py, f64>;

/// Pairs of a contiguous array of two columns.
fn pairs(values: &[f64]) -> impl Iterator<Item = Vector2<f64>> + '_ {
    values
        .chunks_exact(2)
        .map(|pair| Vector2::new(pair[0], pair[1]))
}

/// Obstacle that moves or stands.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct Mover(pub Obstacle);

#[pymethods]
impl Mover {
    #[new]
    #[pyo3(signature = (*, shape, velocity, start, stop))]
    fn new(shape: &EchoShape, velocity: [f64; 2], start: f64, stop: f64) -> CoreResult<Self> {
        let motion = Motion::between(shape.0.center.into(), velocity, [start, stop])?;
        Ok(Self(Obstacle::seen(shape.0, motion)?))
    }
}

/// Repulsion from collision vectors.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct VirtualImpedance {
    /// The law.
    pub law: Impedance,
    /// From readings to forces.
    pub bank: BankOptions,
}

#[pymethods]
impl VirtualImpedance {
    #[new]
    #[pyo3(signature = (**given))]
    fn new(given: Option<Keywords<'_>>) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let law = taken!(given: Impedance {
            stiffness, damping, safe_distance, speed_limit, reference_stiffness, reference_damping,
            clamp,
            ..Impedance {
                form: given.word("form", FORM, &FORMS)?,
                ..Impedance::default()
            },
        });
        let speeds = [("closing", Speed::Closing), ("norm", Speed::Norm)];
        let bank = BankOptions {
            pairing: taken!(given: Pairing { gap as pairing_gap, share as pairing_share }),
            rate: taken!(given: RateFilter {
                speed = given.word("speed", "be \"closing\" or \"norm\"", &speeds)?,
                time_constant as filter_time, largest as largest_rate, outlives_gaps,
            }),
            rotation: given.word("rotation", ROTATION, &ROTATIONS)?,
            translated_by: given.take("translated_by")?,
        };
        given.done()?;
        Ok(Self {
            law: law.checked().map_err(CoreError::from)?,
            bank: bank.checked().map_err(CoreError::from)?,
        })
    }
}

/// Forms of the law.
const FORMS: [(&str, Form); 4] = [
    ("off", Form::Off),
    ("conventional", Form::Conventional),
    ("active", Form::Active),
    ("twice_scaled", Form::ActiveTwiceScaled),
];
const FORM: &str = "be one of \"off\", \"conventional\", \"active\", \"twice_scaled\"";

/// Turns of vectors of the robot into the world.
const ROTATIONS: [(&str, Rotation); 2] = [
    ("heading", Rotation::ByHeading),
    ("printed", Rotation::Printed),
];
const ROTATION: &str = "be \"heading\" or \"printed\"";

/// Points of echoes: sensors (m), angles of their axes (rad) and readings (m).
#[pyfunction]
pub fn collision_points<'py>(
    py: Python<'py>,
    sensor: Rows<'py>,
    angle: Column<'py>,
    reading: Column<'py>,
) -> PyResult<Bound<'py, PyDict>> {
    let axes = pairs(sensor.as_slice()?).zip(angle.as_slice()?);
    let poses = axes.map(|(place, angle)| Frame::at(place.into(), *angle));
    let both = poses.zip(reading.as_slice()?);
    let points: Vec<f64> = both
        .flat_map(|(pose, reading)| <[f64; 2]>::from(collision_point(&pose, *reading)))
        .collect();
    let count = points.len() / 2;
    Ok(fields! { py;
        array [count, 2] point = points;
    })
}

/// Vectors of the robot in the directions of the world, by headings in rad.
#[pyfunction]
pub fn vectors_to_world<'py>(
    py: Python<'py>,
    vector: Rows<'py>,
    heading: Column<'py>,
    rotation: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyDict>> {
    let rotation = word("rotation", rotation, ROTATION, &ROTATIONS)?;
    let both = pairs(vector.as_slice()?).zip(heading.as_slice()?);
    let turned: Vec<f64> = both
        .flat_map(|(vector, heading)| {
            <[f64; 2]>::from(rotation.to_world(&Frame::at([0.0; 2], *heading), vector))
        })
        .collect();
    let count = turned.len() / 2;
    Ok(fields! { py;
        array [count, 2] vector = turned;
    })
}

/// Attraction in N towards offsets in m, for velocities in m/s.
#[pyfunction]
#[pyo3(signature = (offset, velocity, *, stiffness, damping))]
pub fn attraction_forces<'py>(
    py: Python<'py>,
    offset: Rows<'py>,
    velocity: Rows<'py>,
    stiffness: f64,
    damping: f64,
) -> PyResult<Bound<'py, PyDict>> {
    let attraction = Attraction {
        stiffness,
        damping,
        standoff: 0.0,
    };
    let attraction = attraction.checked().map_err(CoreError::from)?;
    let both = pairs(offset.as_slice()?).zip(pairs(velocity.as_slice()?));
    let forces: Vec<f64> = both
        .flat_map(|(offset, velocity)| <[f64; 2]>::from(attraction.force(offset, velocity)))
        .collect();
    let count = forces.len() / 2;
    Ok(fields! { py;
        array [count, 2] force = forces;
    })
}

/// Spring and damper parts (N) at distances (m) and speeds (m/s), and the two scales.
#[pyfunction]
pub fn impedance_forces<'py>(
    py: Python<'py>,
    law: &VirtualImpedance,
    distance: Column<'py>,
    speed: Column<'py>,
) -> PyResult<Bound<'py, PyDict>> {
    let prepared = law.law.prepared();
    let both = distance.as_slice()?.iter().zip(speed.as_slice()?);
    let parts = both.map(|(d, v)| (prepared.spring(*d), prepared.damper(*d, *v)));
    let (spring, damper) = parts.unzip();
    Ok(fields! { py;
        vector spring = spring;
        vector damper = damper;
        value distance_scale = law.law.distance_scale();
        value speed_scale = law.law.speed_scale();
    })
}

/// Point of a line, or segment, between two points that counts as nearest to the origin.
type Foot = fn(Vector2<f64>, Vector2<f64>) -> Vector2<f64>;

/// Feet of perpendiculars from the origin on the lines, or segments, between points.
#[pyfunction]
#[pyo3(signature = (one, other, *, form))]
pub fn collision_feet<'py>(
    py: Python<'py>,
    one: Rows<'py>,
    other: Rows<'py>,
    form: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyDict>> {
    let forms: [(&str, Foot); 3] = [
        ("segment", clamped_foot),
        ("line", foot),
        ("printed", printed_foot),
    ];
    let rule = "be one of \"segment\", \"line\", \"printed\"";
    let of = word("form", form, rule, &forms)?;
    let ends = pairs(one.as_slice()?).zip(pairs(other.as_slice()?));
    let feet: Vec<f64> = ends
        .flat_map(|(one, other)| <[f64; 2]>::from(of(one, other)))
        .collect();
    let count = feet.len() / 2;
    Ok(fields! { py;
        array [count, 2] foot = feet;
    })
}

/// The robot and its ear.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct Follower(pub Settings);

#[pymethods]
impl Follower {
    #[new]
    #[pyo3(signature = (**given))]
    fn new(given: Option<Keywords<'_>>) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let sonar: PyRef<'_, Sonar> = given.take("sonar")?;
        let obstacle_vision: Option<PyRef<'_, Vision>> = given.take("obstacle_vision")?;
        let [
            mass,
            body_radius,
            wheel_base,
            wheel_speed,
            heading_gain,
            least_speed,
        ] = given.take("drive")?;
        let [stiffness, damping, standoff] = given.take("attraction")?;
        let (fix_interval, fix_noise) = (given.take("fix_interval")?, given.take("fix_noise")?);
        let (mirrored_fixes, step) = (given.take("mirrored_fixes")?, given.take("step")?);
        let rules = [
            ("integrated", VelocityRule::Integrated),
            ("reset", VelocityRule::Reset),
        ];
        let rule = "be \"integrated\" or \"reset\"";
        let velocity = given.word("velocity_rule", rule, &rules)?;
        let forms = [("chord", Integration::Chord), ("arc", Integration::Arc)];
        let integration = given.word("integration", "be \"chord\" or \"arc\"", &forms)?;
        given.done()?;
        let settings = Settings {
            drive: VelocityDrive {
                mass,
                body_radius,
                wheel_base,
                wheel_speed,
                heading_gain,
                least_speed,
                integration,
            },
            sensors: sonar.0.clone(),
            obstacle_vision: obstacle_vision.map(|vision| vision.0),
            fixes: Fixes {
                interval: fix_interval,
                noise: if fix_noise {
                    FixNoise::default()
                } else {
                    FixNoise::none()
                },
                mirrored: mirrored_fixes,
            },
            attraction: Attraction {
                stiffness,
                damping,
                standoff,
            },
            velocity,
            step,
            ..Settings::default()
        };
        Ok(Self(settings.checked().map_err(CoreError::from)?))
    }
}

impl Follower {
    /// The robot with a law.
    pub fn with(&self, law: &VirtualImpedance) -> Settings {
        Settings {
            impedance: law.law,
            bank: law.bank,
            ..self.0.clone()
        }
    }
}

/// Standard deviations of range (m) and bearing (rad) of a fix, by Table 2.
#[pyfunction]
pub fn fix_deviations<'py>(
    py: Python<'py>,
    range: Column<'py>,
    bearing: Column<'py>,
) -> PyResult<Bound<'py, PyDict>> {
    let noise = FixNoise::default();
    let both = range.as_slice()?.iter().zip(bearing.as_slice()?);
    let parts = both.map(|(range, bearing)| noise.at(*range, *bearing));
    let (range, bearing) = parts.map(|[range, bearing]| (range, bearing)).unzip();
    Ok(fields! { py;
        vector range = range;
        vector bearing = bearing;
    })
}
