//! Worlds of people and robots.

pub(crate) mod gym;
pub(crate) mod metrics;
pub(crate) mod run;

use std::sync::Arc;

use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use vff_core::crowd::agent::{Agent, FIRST_ROBOT, direction_of};
use vff_core::crowd::neighbors::circle;
use vff_core::crowd::neighbors::grid::Period;
use vff_core::crowd::pedestrian::{Groupings, PersonDecision, Walker};
use vff_core::crowd::snapshot::{CrowdSetting, Models, Snapshot};
use vff_core::crowd::walls::Wall;
use vff_core::crowd::world::{
    PersonSetup, RobotSetup, Route, RouteEnd, SourceSetup, Traits, Waypoint,
};
use vff_core::crowd::{
    Diverged, Model, Simulation, Task, Trajectories, certify_all, simulate_worlds,
};
use vff_core::lanes::Vector2;
use vff_core::run::pursuit::Pursuer;
use vff_core::world::motion::Motion;
use vff_core::world::shape::PlacedShape;

use crate::arrays::fields;
use crate::errors::{CoreError, CoreResult};
use crate::keywords::{Keywords, taken};
use crate::laws::Law;
use crate::parameters::{Measurement, Obstacle, mover_of, outline_of};
use crate::robots::as_built::AsBuilt;
use crate::watch::{Report, watched};

/// A model of people.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct CrowdModel(Model);

#[pymethods]
impl CrowdModel {
    /// A model by name; `cutoff` is infinite for none.
    #[new]
    #[pyo3(signature = (name, **given))]
    fn new(name: &str, given: Option<Keywords<'_>>) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let model = Model::named(name, &given).map_err(CoreError::from)?;
        given.done()?;
        Ok(Self(model))
    }

    /// Largest step in s.
    #[getter]
    fn largest_step(&self) -> f64 {
        self.0.largest_step()
    }

    /// Largest speed as a multiple of the wanted one, infinite for none.
    #[getter]
    fn cap(&self) -> f64 {
        self.0.cap()
    }

    /// Whether a decision is an acceleration, not a velocity.
    #[getter]
    fn is_force(&self) -> bool {
        self.0.is_force()
    }
}

/// The elements of a route: points, or lines between two of them.
fn route_of(given: Vec<Vec<[f64; 2]>>) -> PyResult<Vec<Waypoint>> {
    let elements = given.into_iter().map(|element| match element[..] {
        [point] => Ok(Waypoint::Point(point)),
        [start, end] => Ok(Waypoint::Line([start, end])),
        _ => Err(PyValueError::new_err("a route has points and lines")),
    });
    elements.collect()
}

/// Traits of people from Python's keywords.
fn traits_of(given: &Keywords<'_>) -> PyResult<Traits> {
    let ends = [
        ("stay", RouteEnd::Stay),
        ("leave", RouteEnd::Leave),
        ("repeat", RouteEnd::Repeat),
    ];
    let rule = "be \"stay\", \"leave\" or \"repeat\"";
    Ok(taken!(given: Traits {
        radius, desired_speed, awareness, distracted_share, model = 0,
        route = Route {
            points: route_of(given.take("route")?)?,
            end: given.word("at_end", rule, &ends)?,
            arrival_radius: given.take("arrival_radius")?,
        },
    }))
}

/// The way of a person who reacts to nobody, if there is one: that of an obstacle, or a recording of instants and
/// positions.
fn recording_of(given: &Keywords<'_>) -> PyResult<Option<Motion>> {
    if let Some(obstacle) = given.take::<Option<PyRef<'_, Obstacle>>>("mover")? {
        return Ok(Some(obstacle.core().motion.clone()));
    }
    let recorded: Option<(Vec<f64>, Vec<[f64; 2]>)> = given.take("recording")?;
    let motion = recorded.map(|(time, position)| Motion::recorded(&time, &position));
    let motion = motion.transpose();
    Ok(motion.map_err(|error| CoreError::from(error.within("recording")))?)
}

/// A person at the start.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct CrowdPerson(PersonSetup, Model);

#[pymethods]
impl CrowdPerson {
    #[new]
    #[pyo3(signature = (model, **given))]
    fn new(model: &CrowdModel, given: Option<Keywords<'_>>) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let person = taken!(given: PersonSetup {
            start, velocity, enters, recorded = recording_of(&given)?, group, pursuer = None,
            traits = traits_of(&given)?,
        });
        given.done()?;
        person.check().map_err(CoreError::from)?;
        Ok(Self(person, model.0))
    }

    /// A person of a radius in m who pursues a robot on its way between two places, drawn from a seed; at most as fast
    /// as a speed in m/s, and at least `free` m from the robot at the start.
    #[staticmethod]
    #[pyo3(signature = (model, drawn, ends, *, radius, speed, free))]
    fn pursuing(
        model: &CrowdModel,
        drawn: (u64, u64),
        ends: [[f64; 2]; 2],
        radius: f64,
        speed: f64,
        free: f64,
    ) -> PyResult<Self> {
        let pursuer = Pursuer::random(drawn.0, drawn.1, ends, free, speed);
        let traits = Traits {
            radius,
            desired_speed: Some(speed),
            awareness: 1.0,
            distracted_share: 0.0,
            model: 0,
            route: Route::to(pursuer.start),
        };
        let person = PersonSetup {
            start: pursuer.start,
            velocity: [0.0; 2],
            enters: 0.0,
            recorded: None,
            pursuer: Some(pursuer),
            group: None,
            traits,
        };
        person.check().map_err(CoreError::from)?;
        Ok(Self(person, model.0))
    }

    /// Where the person is at the start, in m.
    #[getter]
    fn start(&self) -> [f64; 2] {
        self.0.start
    }
}

/// Where people come from.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct CrowdSource(SourceSetup, Model);

#[pymethods]
impl CrowdSource {
    #[new]
    #[pyo3(signature = (model, **given))]
    fn new(model: &CrowdModel, given: Option<Keywords<'_>>) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let source =
            taken!(given: SourceSetup { low, high, rate, regular, traits = traits_of(&given)? });
        given.done()?;
        source.check().map_err(CoreError::from)?;
        Ok(Self(source, model.0))
    }
}

/// The task of a robot, if there is one.
fn task_of(given: &Keywords<'_>) -> PyResult<Option<Task>> {
    let tasks = [
        ("", None),
        ("behind", Some(Task::Behind)),
        ("ahead", Some(Task::Ahead)),
        ("beside", Some(Task::Beside)),
    ];
    given.word("task", "be \"behind\", \"ahead\" or \"beside\"", &tasks)
}

/// A robot at the start.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct CrowdRobot {
    setup: RobotSetup,
    /// True for a law that runs under the interpreter.
    python: bool,
}

#[pymethods]
impl CrowdRobot {
    #[new]
    #[pyo3(signature = (robot, law, measurement, built, **given))]
    fn new(
        robot: &Bound<'_, PyAny>,
        law: Option<&Law>,
        measurement: Option<&Measurement>,
        built: Option<&AsBuilt>,
        given: Option<Keywords<'_>>,
    ) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let setup = taken!(given: RobotSetup {
            mover = mover_of(robot)?, footprint = outline_of(robot), start, goal, heading, control_period, arrival_tolerance,
            sensing_range, occlusion, task = task_of(&given)?, measurement = measurement.map(Measurement::core),
            built = built.map(|built| built.run(0.01, false)),
            law = law.map(|law| law.any.clone()),
        });
        given.done()?;
        setup.check().map_err(CoreError::from)?;
        let python = law.is_some_and(Law::is_python);
        Ok(Self { setup, python })
    }
}

/// Wall of a world.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct CrowdWall(Wall);

#[pymethods]
impl CrowdWall {
    /// Segments from point to point.
    #[staticmethod]
    fn polyline(points: Vec<[f64; 2]>) -> CoreResult<Self> {
        Ok(Self(Wall::polyline(points)?))
    }

    /// A disc or a rectangle that stands still.
    #[staticmethod]
    fn solid(obstacle: &Obstacle) -> CoreResult<Self> {
        let obstacle = obstacle.core();
        let shape: PlacedShape = obstacle.at(0.0, &mut 0);
        Ok(Self(Wall::solid(shape)?))
    }
}

/// The number of a model among those of a world.
fn number_of(models: &mut Vec<Model>, model: Model) -> usize {
    let known = models.iter().position(|known| *known == model);
    known.unwrap_or_else(|| {
        models.push(model);
        models.len() - 1
    })
}

/// A world.
#[pyclass(frozen, module = "hrsafety._hrsafety")]
pub struct CrowdWorld {
    core: Arc<vff_core::crowd::CrowdWorld>,
    python: bool,
}

#[pymethods]
impl CrowdWorld {
    #[new]
    #[pyo3(signature = (people, robots, sources, walls, **given))]
    fn new(
        people: Vec<PyRef<'_, CrowdPerson>>,
        robots: Vec<PyRef<'_, CrowdRobot>>,
        sources: Vec<PyRef<'_, CrowdSource>>,
        walls: Vec<PyRef<'_, CrowdWall>>,
        given: Option<Keywords<'_>>,
    ) -> PyResult<Self> {
        let given = given.unwrap_or_default();
        let mut models = Vec::new();
        let people = people.iter().map(|person| {
            let mut setup = person.0.clone();
            setup.traits.model = number_of(&mut models, person.1);
            setup
        });
        let people = people.collect();
        let sources = sources.iter().map(|source| {
            let mut setup = source.0.clone();
            setup.traits.model = number_of(&mut models, source.1);
            setup
        });
        let core = taken!(given: vff_core::crowd::CrowdWorld {
            people = people, sources = sources.collect(),
            robots = robots.iter().map(|robot| robot.setup.clone()).collect(),
            walls = walls.iter().map(|wall| wall.0.clone()).collect(), untold, models = models,
            period = Period(given.take("period")?), step, time_limit, seed,
        });
        given.done()?;
        Ok(Self {
            core: Arc::new(core.checked().map_err(CoreError::from)?),
            python: robots.iter().any(|robot| robot.python),
        })
    }

    /// Distance of each place from the nearest wall in m, negative inside, and the index of that wall.
    fn nearest_walls(&self, places: Vec<[f64; 2]>) -> Vec<(f64, usize)> {
        let nearest = |place: [f64; 2]| {
            let walls = self.core.walls.iter().enumerate();
            let gaps = walls.map(|(index, wall)| (wall.clearance(Vector2::from(place)), index));
            gaps.fold((f64::INFINITY, 0), |least, gap| {
                if gap.0 < least.0 { gap } else { least }
            })
        };
        places.into_iter().map(nearest).collect()
    }
}

impl CrowdWorld {
    /// World of the core.
    pub fn core(&self) -> &vff_core::crowd::CrowdWorld {
        &self.core
    }
}

/// Fields of what was recorded.
fn fields_of<'py>(
    py: Python<'py>,
    ended: &Simulation,
    mut found: Trajectories,
) -> PyResult<Bound<'py, PyDict>> {
    let (instants, people, robots) = (found.time.len(), found.people(), ended.robots().len());
    let flat = |vectors: &[Vector2<f64>]| -> Vec<f64> {
        vectors.iter().flat_map(|each| [each.x, each.y]).collect()
    };
    let places = [&found.robot_position, &found.robot_velocity].map(|vectors| flat(vectors));
    let time = std::mem::take(&mut found.time);
    let robot_heading = std::mem::take(&mut found.robot_heading);
    let ([robot_position, robot_velocity], [position, velocity]) = (places, found.into_people());
    let column = |of: &dyn Fn(usize) -> f64| (0..people).map(of).collect::<Vec<f64>>();
    let all = ended.people();
    let ends: Vec<_> = all[..people]
        .iter()
        .map(|each| each.arrival_position)
        .collect();
    let of_robots = |value: fn(&vff_core::crowd::robots::CrowdRobot) -> f64| -> Vec<f64> {
        ended.robots().iter().map(value).collect()
    };
    let robot_arrival_time = of_robots(vff_core::crowd::robots::CrowdRobot::arrival_time);
    let robot_energy = of_robots(vff_core::crowd::robots::CrowdRobot::energy);
    let diverged = ended.divergence().map(|found| {
        let (kind, number) = match found.agent {
            Diverged::Person(number) => ("person", number),
            Diverged::Robot(number) => ("robot", number),
        };
        (found.time, kind, number)
    });
    Ok(fields! { py;
        vector time = time;
        array [instants, robots, 2] robot_position = robot_position;
        array [instants, robots, 2] robot_velocity = robot_velocity;
        array [instants, robots] robot_heading = robot_heading;
        array [instants, people, 2] position = position;
        array [instants, people, 2] velocity = velocity;
        vector radius = column(&|index| all[index].radius);
        vector desired_speed = column(&|index| all[index].desired_speed);
        vector awareness = column(&|index| all[index].awareness);
        vector person_arrival_time = column(&|index| all[index].arrival_time);
        array [people, 2] person_arrival_position = flat(&ends);
        vector robot_arrival_time = robot_arrival_time;
        vector robot_energy = robot_energy;
        value wall_rescues = ended.wall_rescues();
        value max_person_speed = ended.max_person_speed();
        value diverged = diverged;
    })
}

/// Everything that happens in each of some worlds.
#[pyfunction]
#[pyo3(signature = (worlds, *, threads, progress))]
pub fn crowd_simulate<'py>(
    py: Python<'py>,
    worlds: Vec<PyRef<'py, CrowdWorld>>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let python = worlds.iter().any(|world| world.python);
    let cores: Vec<_> = worlds.iter().map(|world| Arc::clone(&world.core)).collect();
    let threads = if python { Some(1) } else { threads };
    let report = Report::new(progress.as_ref(), cores.len());
    let work = |control: &crate::watch::Control<'_>| {
        simulate_worlds(&cores, threads, &|| control.interrupted(), &|more| {
            control.count(more);
        })
    };
    let ended = if python || threads == Some(1) {
        crate::watch::here(py, report, work)?
    } else {
        watched(py, report, work)?
    };
    let fields = ended.into_iter().map(|mut each| {
        let found = each.take_recorded().unwrap_or_default();
        fields_of(py, &each, found)
    });
    fields.collect()
}

/// Arrival in s and places every 0.2 s.
type ArrivalAndPath = (f64, Vec<[f64; 2]>);

/// When a robot that knows the future arrives in each of some worlds, in s, and its places every 0.2 s; `None` where it
/// cannot.
#[pyfunction]
#[pyo3(signature = (worlds, *, threads))]
pub fn crowd_certificates<'py>(
    py: Python<'py>,
    worlds: Vec<PyRef<'py, CrowdWorld>>,
    threads: Option<usize>,
) -> PyResult<Vec<Option<ArrivalAndPath>>> {
    let cores: Vec<_> = worlds.iter().map(|world| Arc::clone(&world.core)).collect();
    let report = Report::new(None, cores.len());
    let found = watched(py, report, |control: &crate::watch::Control<'_>| {
        certify_all(&cores, threads, &|| control.interrupted())
    })?;
    Ok(found
        .into_iter()
        .map(|one| one.map(|one| (one.arrival, one.path)))
        .collect())
}

/// Starts of people who cross a circle.
#[pyfunction]
pub fn crowd_circle(seed: u64, people: usize) -> Vec<[f64; 2]> {
    circle::starts(seed, people)
}

/// Decisions of everybody at a state, in m/s^2 or m/s; NaN for robots.
#[pyfunction]
#[pyo3(signature = (model, position, velocity, goal, sizes, **given))]
pub fn crowd_decisions<'py>(
    py: Python<'py>,
    model: &CrowdModel,
    position: PyReadonlyArray2<'py, f64>,
    velocity: PyReadonlyArray2<'py, f64>,
    goal: PyReadonlyArray2<'py, f64>,
    sizes: PyReadonlyArray2<'py, f64>,
    given: Option<Keywords<'py>>,
) -> PyResult<Bound<'py, PyDict>> {
    let given = given.unwrap_or_default();
    let robot: PyReadonlyArray1<'py, bool> = given.take("robot")?;
    let heading: PyReadonlyArray2<'py, f64> = given.take("heading")?;
    let walls: Vec<PyRef<'py, CrowdWall>> = given.take("walls")?;
    let group: Vec<Option<u32>> = given.take("group")?;
    let (step, period) = (given.take("step")?, Period(given.take("period")?));
    given.done()?;
    let (position, velocity, goal) = (position.as_array(), velocity.as_array(), goal.as_array());
    let (sizes, robot, heading) = (sizes.as_array(), robot.as_array(), heading.as_array());
    let (mut agents, mut people, mut robots) = (Vec::new(), Vec::new(), Vec::new());
    for (index, number) in (0..position.nrows()).zip(0_u32..) {
        let vector = |rows: &numpy::ndarray::ArrayView2<'_, f64>| {
            Vector2::new(rows[[index, 0]], rows[[index, 1]])
        };
        let (place, speed) = (vector(&position), vector(&velocity));
        let way = vector(&goal) - place;
        let is_robot = robot[index];
        let agent = Agent {
            position: place,
            velocity: speed,
            direction: direction_of(if is_robot { speed } else { way }),
            radius: sizes[[index, 0]],
            number: if is_robot {
                FIRST_ROBOT + number
            } else {
                number
            },
        };
        agents.push(agent);
        if is_robot {
            robots.push(agent);
        }
        people.push((!is_robot).then(|| Walker {
            agent,
            desired_speed: sizes[[index, 1]],
            to_go: way.norm(),
            decides: true,
            stays: way.norm() == 0.0,
            heading: vector(&heading),
            awareness: sizes[[index, 2]],
        }));
    }
    let walls: Vec<Wall> = walls.iter().map(|wall| wall.0.clone()).collect();
    let setting = CrowdSetting {
        walls: &walls,
        company: &Groupings {
            agents: &agents,
            of: &group,
            period,
        },
        period,
        reach: model.0.cutoff(),
        step,
    };
    let mut decisions = Vec::new();
    let mut snapshot = Snapshot::default();
    snapshot.decide(
        &setting,
        (people.len(), |number| people[number]),
        &robots,
        Models::Shared(&model.0),
        &mut decisions,
    );
    let shown = |(decision, person): (&PersonDecision, &Option<Walker>)| match person {
        Some(_) => [decision.order.x, decision.order.y],
        None => [f64::NAN; 2],
    };
    let flat = decisions.iter().zip(&people).flat_map(shown).collect();
    Ok(fields! { py;
        array [decisions.len(), 2] decision = flat;
    })
}
