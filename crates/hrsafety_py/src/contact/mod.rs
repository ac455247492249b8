//! Contacts within limits: rows of numbers to the core and back.

pub(crate) mod arm;
pub(crate) mod separation;

use std::sync::Arc;

use impact_core::allowed::{
    BOTTOMED, Distribution, Drive, Given, Kind, LOADS, Law, NAMES, Outline, RISING, RegionKind,
    Room, Row, SPEEDS, Setup, SpeedStatus, THICKNESSES, ThicknessStatus, collide_rows,
    differential_mass, exceedance, holonomic_mass, speed_rows, thickness_rows,
};
use impact_core::collision::{CollisionStatus, Wanted};
use impact_core::columns::Column;
use impact_core::covering::Table;
use numeric::error::{Failure, Given as Shown};
use numeric::parallel::Work;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Fields, fields};
use crate::errors::{CoreError, CoreResult};
use crate::impact::many::Numbers;
use crate::keywords::Keywords;
use crate::watch::{Control, Report, spread, watched};

/// Arguments that all rows share, by the names of Python's dictionary.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Shared {
    law: Option<String>,
    strain: Vec<f64>,
    stress: Vec<f64>,
    outline: Option<String>,
    region: String,
    tolerance: f64,
}

fn unknown(name: &str, word: &str) -> CoreError {
    Failure::invalid(name, "be a known word", Shown::Word(word.to_owned())).into()
}

impl Shared {
    fn setup(self) -> CoreResult<Setup> {
        let outline = match self.outline.as_deref() {
            None => None,
            Some("flat") => Some(Outline::Flat),
            Some("curved") => Some(Outline::Curved),
            Some("cylinder") => Some(Outline::Cylinder),
            Some(other) => return Err(unknown("shape", other)),
        };
        let law = match self.law.as_deref() {
            None => None,
            Some("linear") => Some(Law::Linear),
            Some("gibson_ashby") => Some(Law::GibsonAshby),
            Some("rusch") => Some(Law::Rusch),
            Some("avalle") => Some(Law::Avalle),
            Some("table") => {
                let table = Table::new(self.strain, self.stress);
                let named = |failure: Failure| failure.within("covering.material");
                Some(Law::Table(Arc::new(table.map_err(named)?)))
            }
            Some(other) => return Err(unknown("law", other)),
        };
        let region = match self.region.as_str() {
            "rigid" => RegionKind::Rigid,
            "spring" => RegionKind::Spring,
            "power" => RegionKind::Power,
            other => return Err(unknown("region", other)),
        };
        Ok(Setup {
            kind: Kind {
                covering: law.zip(outline),
                region,
            },
            tolerance: self.tolerance,
        })
    }
}

/// Columns in the order of their names.
fn taken<'a>(numbers: &'a [Numbers<'_>], rows: usize) -> PyResult<Given<'a>> {
    let mut columns = [Column::Value(f64::NAN); NAMES.len()];
    for (column, given) in columns.iter_mut().zip(numbers) {
        *column = given.column()?;
    }
    let wrong = columns.iter().any(|column| match column {
        Column::Value(_) => false,
        Column::Array(values) => values.len() != rows,
    });
    if wrong || numbers.len() != NAMES.len() {
        let given = Shown::Count(numbers.len() as u64);
        return Err(CoreError::from(Failure::invalid("columns", "fit the rows", given)).into());
    }
    Ok(Given { columns, rows })
}

/// Names of the numbers of a row, in order.
#[pyfunction]
pub fn contact_names() -> Vec<&'static str> {
    NAMES.to_vec()
}

/// Words of the codes of collisions, speeds and thicknesses.
#[pyfunction]
pub fn contact_words() -> [Vec<&'static str>; 3] {
    [
        CollisionStatus::ALL.map(CollisionStatus::word).to_vec(),
        SpeedStatus::ALL.map(SpeedStatus::word).to_vec(),
        ThicknessStatus::ALL.map(ThicknessStatus::word).to_vec(),
    ]
}

/// Quantity that rows are computed for.
#[derive(Clone, Copy, PartialEq)]
enum RowsOf {
    Collisions,
    Speeds,
    Thicknesses,
}

/// Results of many rows: `kind` is ``"collide"``, ``"speed"`` or ``"thickness"``.
#[pyfunction]
#[pyo3(signature = (kind, shared, numbers, rows, **given))]
pub fn contact_rows<'py>(
    py: Python<'py>,
    kind: &str,
    shared: Shared,
    numbers: Vec<Numbers<'py>>,
    rows: usize,
    given: Option<Keywords<'py>>,
) -> PyResult<Bound<'py, PyDict>> {
    let options = given.unwrap_or_default();
    let gravity: Option<f64> = options.take("gravity")?;
    let (threads, progress): (Option<usize>, Option<Py<PyAny>>) =
        (options.take("threads")?, options.take("progress")?);
    options.done()?;
    let setup = shared.setup()?;
    let given = taken(&numbers, rows)?;
    let wanted = Wanted {
        nodes: false,
        injury: gravity,
    };
    let (names, kind): (&[&str], _) = match kind {
        "collide" => (&LOADS, RowsOf::Collisions),
        "speed" => (&SPEEDS, RowsOf::Speeds),
        "thickness" => (&THICKNESSES, RowsOf::Thicknesses),
        other => return Err(unknown("kind", other).into()),
    };
    // Zeros are not written before a thread fills its part.
    let columns: Vec<_> = names
        .iter()
        .map(|_| PyArray1::<f64>::zeros(py, rows, false))
        .collect();
    let codes = [0, 1].map(|_| PyArray1::<u8>::zeros(py, rows, false));
    {
        let held = columns.iter().map(|column| Ok(column.try_readwrite()?));
        let mut held: Vec<_> = held.collect::<PyResult<_>>()?;
        let numbers = held.iter_mut().map(|column| Ok(column.as_slice_mut()?));
        let (mut status, mut word) = (codes[0].try_readwrite()?, codes[1].try_readwrite()?);
        let room = Room {
            numbers: numbers.collect::<PyResult<_>>()?,
            status: status.as_slice_mut()?,
            word: word.as_slice_mut()?,
        };
        let work = |control: &Control<'_>| {
            let work = Work {
                threads,
                interrupted: &|| control.interrupted(),
                progress: &|more| control.count(more),
            };
            match kind {
                RowsOf::Collisions => collide_rows(&setup, &given, wanted, (work, room)),
                RowsOf::Speeds => speed_rows(&setup, &given, work, room),
                RowsOf::Thicknesses => thickness_rows(&setup, &given, work, room),
            }
        };
        watched(py, Report::new(progress.as_ref(), rows), work)?;
    }
    let fields = Fields::new(py);
    for (name, column) in names.iter().zip(columns) {
        fields.value(name, column)?;
    }
    let word = codes[1].try_readonly()?;
    let word = word.as_slice()?;
    fields.value("status_code", &codes[0])?;
    let has = |bit: u8| word.iter().map(|code| code & bit != 0).collect();
    fields.vector::<bool>("rising", has(RISING))?;
    if kind == RowsOf::Collisions {
        fields.vector::<bool>("bottomed", has(BOTTOMED))?;
    } else {
        let governs = word.iter().map(|code| code & !RISING).collect();
        fields.vector::<u8>("governs_code", governs)?;
    }
    Ok(fields.finish())
}

fn single(numbers: Vec<f64>) -> CoreResult<Row> {
    let count = numbers.len() as u64;
    let row: [f64; NAMES.len()] = numbers
        .try_into()
        .map_err(|_| Failure::invalid("numbers", "fit the names", Shown::Count(count)))?;
    Ok(Row(row))
}

/// One collision with its motion; a number that is out of range is an error.
#[pyfunction]
#[pyo3(signature = (shared, numbers, *, gravity))]
pub fn contact_simulate(
    py: Python<'_>,
    shared: Shared,
    numbers: Vec<f64>,
    gravity: Option<f64>,
) -> PyResult<Bound<'_, PyDict>> {
    let setup = shared.setup()?;
    let row = single(numbers)?;
    let wanted = Wanted {
        nodes: true,
        injury: gravity,
    };
    let found = watched(py, Report::none(), |control: &Control<'_>| {
        setup.collide(&row, None, wanted, &|| control.interrupted())
    })?;
    let fields = Fields::new(py);
    fields.value("status", found.status.word())?;
    for (name, value) in LOADS.into_iter().zip(found.loads()) {
        fields.value(name, value)?;
    }
    fields.value("rising", found.rising)?;
    fields.value("bottomed", found.bottomed)?;
    // Every step is there with both of its ends.
    let last = found.nodes.len().saturating_sub(1);
    let kept = || {
        let nodes = found.nodes.iter().enumerate();
        nodes
            .filter(move |(index, _)| index % 2 == 0 || *index == last)
            .map(|(_, node)| node)
    };
    fields.vector("time", kept().map(|node| node.time).collect())?;
    fields.vector("force", kept().map(|node| node.force).collect())?;
    let total = kept().map(|node| node.total_compression).collect();
    fields.vector("total_compression", total)?;
    let depth = kept().map(|node| node.covering_compression).collect();
    fields.vector("covering_compression", depth)?;
    let deflection = kept().map(|node| node.body_deflection).collect();
    fields.vector("body_deflection", deflection)?;
    let acceleration = kept().map(|node| node.body_acceleration).collect();
    fields.vector("body_acceleration", acceleration)?;
    Ok(fields.finish())
}

/// One allowed speed; a number that is out of range is an error.
#[pyfunction]
pub fn contact_speed(
    py: Python<'_>,
    shared: Shared,
    numbers: Vec<f64>,
) -> PyResult<Bound<'_, PyDict>> {
    let setup = shared.setup()?;
    let row = single(numbers)?;
    let (found, bare) = watched(py, Report::none(), |control: &Control<'_>| {
        setup.allowed(&row, None, &mut None, &|| control.interrupted())
    })?;
    Ok(fields! { py;
        value found: speed, speeds, further, rising;
        value governs = found.governs.word();
        value status = found.status.word();
        value bare_speed_force = bare;
        value covering_compression = found.compression;
    })
}

/// One least thickness; a number that is out of range is an error.
#[pyfunction]
pub fn contact_thickness(shared: Shared, numbers: Vec<f64>) -> PyResult<(f64, &'static str)> {
    let setup = shared.setup()?;
    let row = single(numbers)?;
    let found = setup.thickness(&row, None).map_err(CoreError::from)?;
    Ok((found.thickness, found.status.word()))
}

/// Force, stored work, stress at the apex and half-widths of a covering at a compression.
#[pyfunction]
pub fn contact_column(
    shared: Shared,
    numbers: Vec<f64>,
    compression: f64,
) -> PyResult<(f64, f64, f64, Option<[f64; 2]>)> {
    let setup = shared.setup()?;
    let row = single(numbers)?;
    let pad = setup.pad(&row, None).map_err(CoreError::from)?;
    let missing = || {
        CoreError::from(Failure::invalid(
            "covering",
            "be given",
            Shown::Found("none".into()),
        ))
    };
    let pad = pad.ok_or_else(missing)?;
    let inside =
        compression >= 0.0 && compression <= pad.bound() && pad.force(compression)[0].is_finite();
    if !inside {
        let rule = format!("be from 0 to below {} m, where the law ends", pad.bound());
        let failure = Failure::invalid("compression", rule, Shown::Number(compression));
        return Err(CoreError::from(failure).into());
    }
    let strain = compression / pad.covering.thickness;
    Ok((
        pad.force(compression)[0],
        pad.work(compression),
        pad.covering.material.stress(strain)[0],
        pad.covering.shape.half_widths(compression),
    ))
}

/// Chance that a speed is not allowed: share, ends of its interval, quantiles of the allowed speed, count.
#[pyfunction]
#[pyo3(signature = (shared, numbers, inputs, **given))]
pub fn contact_exceedance<'py>(
    py: Python<'py>,
    shared: Shared,
    numbers: Vec<f64>,
    inputs: Vec<(String, String, Vec<f64>)>,
    given: Option<Keywords<'py>>,
) -> PyResult<Bound<'py, PyDict>> {
    let given = given.unwrap_or_default();
    let speed: f64 = given.take("speed")?;
    let (draws, seed): (usize, u64) = (given.take("draws")?, given.take("seed")?);
    let (threads, progress): (Option<usize>, Option<Py<PyAny>>) =
        (given.take("threads")?, given.take("progress")?);
    given.done()?;
    let setup = shared.setup()?;
    let row = single(numbers)?;
    let mut uncertain = Vec::with_capacity(inputs.len());
    for (name, kind, values) in &inputs {
        let place = NAMES.iter().position(|known| known == name);
        let place = place.ok_or_else(|| unknown("inputs", name))?;
        uncertain.push((place, distribution(name, kind, values)?));
    }
    let report = Report::new(progress.as_ref(), draws);
    let found = spread(py, report, threads, |work| {
        exceedance(&setup, &row, &uncertain, speed, (draws, seed), work)
    })?;
    Ok(fields! { py;
        value found: probability, quantiles, exceeded, draws;
        value interval = (found.interval.low, found.interval.high);
    })
}

fn distribution(name: &str, kind: &str, values: &[f64]) -> CoreResult<Distribution> {
    let found = match (kind, values) {
        ("normal", [mean, deviation]) => Distribution::Normal([*mean, *deviation]),
        ("lognormal", [median, deviation]) => Distribution::LogNormal([*median, *deviation]),
        ("uniform", [low, high]) => Distribution::Uniform([*low, *high]),
        ("triangular", [low, likely, high]) => Distribution::Triangular([*low, *likely, *high]),
        _ => return Err(unknown(name, kind)),
    };
    Ok(found.checked(name)?)
}

/// Effective mass of a base that moves any way.
#[pyfunction]
#[pyo3(signature = (*, mass, inertia, point, direction))]
pub fn contact_holonomic_mass(
    mass: f64,
    inertia: f64,
    point: [f64; 2],
    direction: [f64; 2],
) -> CoreResult<f64> {
    Ok(holonomic_mass(mass, inertia, point, direction)?)
}

/// Effective mass of a differential drive.
#[pyfunction]
#[pyo3(signature = (*, mass, inertia, drive, point, direction))]
pub fn contact_differential_mass(
    mass: f64,
    inertia: f64,
    drive: [f64; 4],
    point: [f64; 2],
    direction: [f64; 2],
) -> CoreResult<f64> {
    let [offset, wheel_inertia, wheel_radius, half_track] = drive;
    let drive = Drive {
        offset,
        wheel_inertia,
        wheel_radius,
        half_track,
    };
    Ok(differential_mass(mass, inertia, drive, point, direction)?)
}
