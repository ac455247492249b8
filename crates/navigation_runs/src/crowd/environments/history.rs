//! Positions of an episode under way, for its metrics.

use crate::crowd::metrics::{self, MetricRules, ObservedBody, Paths, RobotMetrics};
use crate::crowd::simulation::Simulation;
use numeric::lanes::Vector2;

type Vector = Vector2<f64>;

/// Where everybody was at each instant; people who come later have higher numbers.
#[derive(Clone, Debug, Default)]
pub(super) struct History {
    robot: Vec<Vector>,
    headings: Vec<f64>,
    people: Vec<Vector>,
    /// Number of people up to each instant.
    counts: Vec<usize>,
    radii: Vec<f64>,
    groups: Vec<i64>,
}

impl History {
    pub fn clear(&mut self) {
        self.robot.clear();
        self.headings.clear();
        self.people.clear();
        self.counts.clear();
    }

    pub fn push(&mut self, simulation: &Simulation) {
        let absent = Vector::repeat(f64::NAN);
        self.robot.push(simulation.robots()[0].state().position);
        self.headings.push(simulation.robots()[0].heading());
        let places = simulation.people().iter();
        self.people.extend(places.map(|person| {
            if person.is_present() {
                person.position
            } else {
                absent
            }
        }));
        self.counts.push(simulation.people().len());
    }

    /// Metrics of the robot so far.
    pub fn metrics(&mut self, simulation: &Simulation) -> RobotMetrics {
        let (world, people) = (simulation.world(), simulation.people());
        self.radii.clear();
        self.radii.extend(people.iter().map(|person| person.radius));
        self.groups.clear();
        if people.iter().any(|person| person.group.is_some()) {
            let group = |group: Option<u32>| group.map_or(-1, i64::from);
            self.groups
                .extend(people.iter().map(|person| group(person.group)));
        }
        self.make_rectangular(people.len());
        let setup = &world.robots[0];
        metrics::evaluate_checked(&metrics::ObservedEpisode {
            robot: &self.robot,
            people: Paths::known(&self.people, people.len()),
            radii: &self.radii,
            groups: &self.groups,
            walls: &world.walls,
            without: None,
            body: setup.footprint.as_deref().map(|outline| ObservedBody {
                outline,
                headings: &self.headings,
            }),
            rules: MetricRules {
                step: world.step,
                goal: setup.goal.into(),
                robot_radius: setup.radius(),
                arrival_tolerance: setup.arrival_tolerance,
                max_speed: setup.max_speed(),
                period: world.period,
                ..MetricRules::of_people()
            },
        })
    }

    /// Makes room, at every instant, for people who came later.
    fn make_rectangular(&mut self, width: usize) {
        if self.counts.iter().all(|count| *count == width) {
            return;
        }
        let mut all = Vec::with_capacity(width * self.counts.len());
        let mut rest = self.people.as_slice();
        for count in &self.counts {
            let (now, later) = rest.split_at(*count);
            all.extend_from_slice(now);
            all.extend(std::iter::repeat_n(Vector::repeat(f64::NAN), width - count));
            rest = later;
        }
        self.people = all;
        self.counts.fill(width);
    }
}
