//! Metrics of robots among people: episodes are converted once, and scored side by side.

use std::sync::Arc;

use nalgebra::Vector2;
use numeric::parallel::each_run;
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::crowd::metrics::{
    self, DeclaredMetric, EXTREMES, Kind, KnownArrival, MetricRules, ObservedBody, Paths,
    ROBOT_METRICS, WORLD_METRICS, Whole, Without,
};
use vff_core::crowd::neighbors::grid::Period;
use vff_core::crowd::walls::Wall;
use vff_core::world::footprint;
use vff_core::world::shape::PlacedShape;

use crate::arrays::Fields;
use crate::errors::CoreError;
use crate::keywords::{Keywords, taken};
use crate::robots::footprint::Footprint;
use crate::watch::{Report, spread};

type Rows<'py> = PyReadonlyArray2<'py, f64>;

/// Positions of an array with two columns.
fn points(rows: &Rows<'_>) -> PyResult<Vec<Vector2<f64>>> {
    let (pairs, _) = rows.as_slice()?.as_chunks::<2>();
    Ok(pairs.iter().map(|pair| Vector2::from(*pair)).collect())
}

/// Arrivals of an array with rows of time and place.
fn arrivals(rows: &Rows<'_>) -> PyResult<Vec<KnownArrival>> {
    let (known, _) = rows.as_slice()?.as_chunks::<3>();
    let arrival = |[time, x, y]: &[f64; 3]| KnownArrival {
        time: *time,
        place: Vector2::new(*x, *y),
    };
    Ok(known.iter().map(arrival).collect())
}

/// Name, kind, unit and meaning of each metric of a robot, and of a world.
#[pyfunction]
pub fn crowd_metric_names() -> [Vec<[&'static str; 4]>; 2] {
    let row =
        |metric: &DeclaredMetric| [metric.name, metric.kind.word(), metric.unit, metric.meaning];
    [
        ROBOT_METRICS.iter().map(row).collect(),
        WORLD_METRICS.iter().map(row).collect(),
    ]
}

/// Sizes and bounds of metrics from Python's keywords.
fn rules(given: &Keywords<'_>) -> PyResult<MetricRules> {
    let goal: [f64; 2] = given.take("goal")?;
    Ok(taken!(given: MetricRules {
        step, goal = goal.into(), robot_radius, arrival_tolerance, person_tolerance, max_speed,
        shortest_length, period = Period(given.take("period")?),
    }))
}

/// Segments as rows (x, y, x, y), discs as (x, y, radius), rectangles as (x, y, length, width, heading).
fn walls(given: &Keywords<'_>) -> PyResult<Vec<Wall>> {
    let (segments, discs): (Rows<'_>, Rows<'_>) = (given.take("segments")?, given.take("discs")?);
    let rectangles: Rows<'_> = given.take("rectangles")?;
    let mut all = Vec::new();
    for [x0, y0, x1, y1] in segments.as_slice()?.as_chunks::<4>().0 {
        all.push(Wall::polyline(vec![[*x0, *y0], [*x1, *y1]]));
    }
    for [x, y, radius] in discs.as_slice()?.as_chunks::<3>().0 {
        all.push(Wall::solid(PlacedShape::disc([*x, *y], *radius)));
    }
    for [x, y, length, width, heading] in rectangles.as_slice()?.as_chunks::<5>().0 {
        let shape = PlacedShape::turned([*x, *y], [*length, *width], *heading);
        all.push(Wall::solid(shape));
    }
    let checked: numeric::error::Result<Vec<Wall>> = all.into_iter().collect();
    Ok(checked.map_err(CoreError::from)?)
}

/// One robot among people, with its own arrays.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct CrowdEpisode {
    robot: Vec<Vector2<f64>>,
    people: Vec<Vector2<f64>>,
    radii: Vec<f64>,
    groups: Vec<i64>,
    walls: Vec<Wall>,
    without: Option<Vec<Vector2<f64>>>,
    goals: Vec<Vector2<f64>>,
    arrivals: Option<[Vec<KnownArrival>; 2]>,
    body: Option<(Arc<footprint::Footprint>, Vec<f64>)>,
    rules: MetricRules,
}

#[pymethods]
impl CrowdEpisode {
    #[new]
    #[pyo3(signature = (**given))]
    fn new(given: Option<Keywords<'_>>) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let rows = |name: &str| points(&given.take::<Rows<'_>>(name)?);
        let without: Option<Rows<'_>> = given.take("people_without")?;
        let [with, alone]: [Option<Rows<'_>>; 2] = [
            given.take("person_arrivals")?,
            given.take("person_arrivals_without")?,
        ];
        let radii: PyReadonlyArray1<'_, f64> = given.take("person_radius")?;
        let groups: PyReadonlyArray1<'_, i64> = given.take("groups")?;
        let outline: Option<PyRef<'_, Footprint>> = given.take("footprint")?;
        let headings: PyReadonlyArray1<'_, f64> = given.take("heading")?;
        let headings = headings.as_slice()?.to_vec();
        let body = outline.map(|outline| (Arc::new(outline.0.clone()), headings));
        let episode = Self {
            body,
            robot: rows("position")?,
            people: rows("people")?,
            radii: radii.as_slice()?.to_vec(),
            groups: groups.as_slice()?.to_vec(),
            walls: walls(&given)?,
            without: without.as_ref().map(points).transpose()?,
            goals: rows("person_goals")?,
            arrivals: match (with, alone) {
                (Some(with), Some(alone)) => Some([arrivals(&with)?, arrivals(&alone)?]),
                _ => None,
            },
            rules: rules(&given)?,
        };
        given.done()?;
        let count = episode.radii.len();
        Paths::new("people", &episode.people, count).map_err(CoreError::from)?;
        if let Some(people) = &episode.without {
            Paths::new("people_without", people, count).map_err(CoreError::from)?;
        }
        episode.view().check().map_err(CoreError::from)?;
        Ok(episode)
    }
}

impl CrowdEpisode {
    /// Borrowed view for the core; the values have been checked.
    fn view(&self) -> metrics::ObservedEpisode<'_> {
        let count = self.radii.len();
        metrics::ObservedEpisode {
            robot: &self.robot,
            people: Paths::known(&self.people, count),
            radii: &self.radii,
            groups: &self.groups,
            walls: &self.walls,
            without: self.without.as_ref().map(|people| Without {
                people: Paths::known(people, count),
                goals: &self.goals,
                arrivals: self
                    .arrivals
                    .as_ref()
                    .map(|known| known.each_ref().map(Vec::as_slice)),
            }),
            body: self
                .body
                .as_ref()
                .map(|(outline, headings)| ObservedBody { outline, headings }),
            rules: self.rules,
        }
    }
}

/// A column of each metric.
pub fn metric_columns<'py>(
    py: Python<'py>,
    list: &[DeclaredMetric],
    value: impl Fn(usize) -> Vec<f64>,
) -> PyResult<Bound<'py, PyDict>> {
    let fields = Fields::new(py);
    for (index, metric) in list.iter().enumerate() {
        let values = value(index);
        match metric.kind {
            Kind::Number => fields.vector(metric.name, values)?,
            Kind::Flag => {
                let flags = values.into_iter().map(|value| value != 0.0).collect();
                fields.vector::<bool>(metric.name, flags)?;
            }
            Kind::Count => {
                // Counts are whole and far below 2^53.
                #[allow(clippy::cast_possible_truncation)]
                let counts = values.into_iter().map(|value| value as i64).collect();
                fields.vector::<i64>(metric.name, counts)?;
            }
        }
    }
    Ok(fields.finish())
}

/// Metrics of every episode, and extremes that tell which of them need a closer look.
#[pyfunction]
#[pyo3(signature = (episodes, threads, progress))]
pub fn crowd_metrics<'py>(
    py: Python<'py>,
    episodes: Vec<PyRef<'py, CrowdEpisode>>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Bound<'py, PyDict>, Bound<'py, PyDict>)> {
    let episodes: Vec<&CrowdEpisode> = episodes.iter().map(|episode| &**episode).collect();
    let report = Report::new(progress.as_ref(), episodes.len());
    let rows = spread(py, report, threads, |work| {
        each_run(episodes.len(), work, |index| {
            let (found, extremes) = metrics::evaluate_with_extremes(&episodes[index].view());
            Ok((found.into_array(), extremes.into_array()))
        })
    })?;
    let columns = metric_columns(py, &ROBOT_METRICS, |metric| {
        rows.iter().map(|row| row.0[metric]).collect()
    })?;
    let extremes = Fields::new(py);
    for (index, name) in EXTREMES.into_iter().enumerate() {
        extremes.vector(name, rows.iter().map(|row| row.1[index]).collect())?;
    }
    Ok((columns, extremes.finish()))
}

/// Metrics of a world, from the positions of all people and robots.
#[pyfunction]
#[pyo3(signature = (**given))]
pub fn crowd_world_metrics<'py>(
    py: Python<'py>,
    given: Option<Keywords<'py>>,
) -> PyResult<Bound<'py, PyDict>> {
    let given = given.unwrap_or_default();
    let rows = |name: &str| points(&given.take::<Rows<'_>>(name)?);
    let (people, robots, goals) = (rows("people")?, rows("robots")?, rows("person_goals")?);
    let radii: PyReadonlyArray1<'_, f64> = given.take("robot_radius")?;
    let radii = radii.as_slice()?.to_vec();
    let times: Option<PyReadonlyArray1<'_, f64>> = given.take("person_arrival_time")?;
    let times = match &times {
        Some(times) => Some(times.as_slice()?),
        None => None,
    };
    let rules = taken!(given: MetricRules {
        step, person_tolerance, period = Period(given.take("period")?), ..MetricRules::of_people(),
    });
    let time_limit = given.take("time_limit")?;
    given.done()?;
    let world = Whole {
        people: Paths::new("people", &people, goals.len()).map_err(CoreError::from)?,
        goals: &goals,
        arrival_times: times,
        robots: Paths::new("robots", &robots, radii.len()).map_err(CoreError::from)?,
        radii: &radii,
        time_limit,
        rules,
    };
    let found = metrics::evaluate_world(&world).map_err(CoreError::from)?;
    let row = found.into_array();
    metric_columns(py, &WORLD_METRICS, |metric| vec![row[metric]])
}
