//! Encounters with people who were hidden: at an instant of a run, the worst of many places where somebody can be whom
//! the robot does not see, by a trial in which it does not react; then he comes for it, and it does.

use std::sync::Arc;

use nalgebra::Vector2;

use super::{Encounter, Lurker, Pursued, Pursuer, encounter};
use crate::run::Interrupted;
use crate::run::any_law::AnyLaw;
use crate::run::as_built::AsBuilt;
use crate::run::outcome::CONTACT_SPEED;
use navigation_world::world::scenario::Scenario;
use numeric::error::{Failure, Given, Result, positive};
use numeric::random::Stream;
use std::f64::consts::FRAC_1_SQRT_2;
use unknown_places::unseen::{Ground, Unseen};

/// Control periods in which people of a trial keep to the ways to where the robot was.
const LOOKED: usize = 4;

/// Places from which the worst is chosen.
const STARTS: u32 = 48;

/// A robot under a law in a map, where people may be hidden.
pub struct HiddenHunt<'a> {
    /// Where; the person takes the place of its last obstacle.
    pub scenario: &'a Scenario,
    /// Law that drives the robot, and knows a map.
    pub law: &'a AnyLaw,
    /// Robot as it is built.
    pub built: &'a AsBuilt,
    /// Size of the person and of the cells.
    pub unseen: Unseen,
    /// Largest speed of the person in m/s.
    pub max_speed: f64,
    /// Time between two encounters, and how long each lasts, in s.
    pub every: f64,
    /// In s.
    pub lasting: f64,
}

/// Somebody who comes out of hiding, and what came of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HiddenEncounter {
    /// When, in s.
    pub time: f64,
    /// From where, in m.
    pub start: [f64; 2],
    /// Result of it.
    pub found: Encounter,
}

/// Where people can hide at an instant.
struct Hiding {
    /// In s.
    time: f64,
    /// First and last row of a trial.
    rows: [usize; 2],
    /// In m.
    places: Vec<[f64; 2]>,
}

impl HiddenHunt<'_> {
    fn lurker(&self) -> Result<Lurker> {
        let Some(map) = self.law.map() else {
            let rule = "know a map, in which people can hide";
            return Err(Failure::invalid(
                "law",
                rule,
                Given::Found("a law without".into()),
            ));
        };
        let (cell, core) = (self.unseen.cell, self.unseen.person_core);
        let ends = [self.scenario.start, self.scenario.goal].map(Vector2::from);
        let mut corners = [ends[0].inf(&ends[1]), ends[0].sup(&ends[1])];
        if let Some([lower, upper]) = map.bounds() {
            corners = [corners[0].inf(&lower), corners[1].sup(&upper)];
        }
        // Cells all of which have room for the core.
        let ground = Ground::of_map(
            map,
            corners.map(<[f64; 2]>::from),
            cell,
            core + 2.0 * cell * FRAC_1_SQRT_2,
        )?;
        Ok(Lurker::new(
            map.clone(),
            Arc::new(ground),
            core,
            self.max_speed,
        ))
    }

    fn run(
        &self,
        start: [f64; 2],
        lurker: Lurker,
        until: f64,
        rows: Option<&mut Pursued>,
        stop: Interrupted<'_>,
    ) -> Result<Encounter> {
        let mut scenario = self.scenario.clone();
        scenario.rules.time_limit = until.min(scenario.rules.time_limit);
        let pursuer = Pursuer::standing(start);
        encounter(
            &scenario,
            self.law,
            self.built,
            (&pursuer, Some(lurker)),
            rows,
            stop,
        )
    }

    /// An encounter with somebody who appears at a time in s where the robot does not see him, at a place in m.
    ///
    /// # Errors
    /// The law knows no map, or the run fails.
    pub fn encounter(
        &self,
        time: f64,
        start: [f64; 2],
        rows: Option<&mut Pursued>,
        stop: Interrupted<'_>,
    ) -> Result<Encounter> {
        let mut lurker = self.lurker()?;
        lurker.appears = time;
        self.run(start, lurker, time + self.lasting, rows, stop)
    }

    /// The run with nobody in it, then its encounters, of which there are at most so many.
    ///
    /// # Errors
    /// The law knows no map or does not reckon with people who are not seen, or a run fails.
    pub fn encounters(
        &self,
        most: usize,
        seed: u64,
        stop: Interrupted<'_>,
    ) -> Result<(Encounter, Vec<HiddenEncounter>)> {
        positive("person_speed", self.max_speed)?;
        positive("every", self.every)?;
        positive("lasting", self.lasting)?;
        let mut lurker = self.lurker()?;
        let mut rows = Pursued {
            every: Some(self.every),
            ..Pursued::default()
        };
        lurker.appears = f64::INFINITY;
        let alone = self.run(
            self.scenario.start,
            lurker.clone(),
            f64::INFINITY,
            Some(&mut rows),
            stop,
        )?;
        let hiding: Vec<Hiding> = rows
            .hidden
            .iter()
            .filter_map(|(time, places)| self.hiding(&rows, &mut lurker, *time, places))
            .collect();
        let mut found = Vec::new();
        let mut stream = Stream::new(seed, 7);
        // Evenly spread where there are more instants than encounters.
        let count = hiding.len().min(most);
        for index in 0..count {
            let each = &hiding[index * hiding.len() / count];
            let start = worst(&rows, &mut lurker, each, &mut stream);
            lurker.appears = each.time;
            let until = each.time + self.lasting;
            let encounter = self.run(start, lurker.clone(), until, None, stop)?;
            found.push(HiddenEncounter {
                time: each.time,
                start,
                found: encounter,
            });
        }
        Ok((alone, found))
    }

    /// Where somebody can hide at an instant who comes near the robot, if anywhere.
    fn hiding(
        &self,
        rows: &Pursued,
        lurker: &mut Lurker,
        time: f64,
        places: &[[f64; 2]],
    ) -> Option<Hiding> {
        let first = rows.time.iter().position(|row| *row >= time - 1e-9)?;
        let until = time + self.lasting;
        let last = rows.time.iter().rposition(|row| *row <= until)?;
        lurker.look(vector(&rows.position, first), &[]);
        let near = |place: &&[f64; 2]| {
            let place = Vector2::from(**place);
            lurker.way_from(place) <= self.max_speed * self.lasting && lurker.fits(place)
        };
        let places: Vec<[f64; 2]> = places.iter().filter(near).copied().collect();
        (first < last && !places.is_empty()).then_some(Hiding {
            time,
            rows: [first, last],
            places,
        })
    }
}

/// The start from which somebody comes nearest to a robot that does not react, while it moves toward him.
fn worst(rows: &Pursued, lurker: &mut Lurker, hiding: &Hiding, stream: &mut Stream) -> [f64; 2] {
    let [first, last] = hiding.rows;
    lurker.appears = 0.0;
    let drawn = (0..STARTS).map(|_| hiding.places[stream.below(hiding.places.len())]);
    let starts: Vec<[f64; 2]> = drawn.collect();
    let mut people: Vec<(Vector2<f64>, f64)> = starts
        .iter()
        .map(|start| ((*start).into(), f64::INFINITY))
        .collect();
    for row in first..last {
        let (place, velocity) = (vector(&rows.position, row), vector(&rows.velocity, row));
        if (row - first) % LOOKED == 0 {
            let places: Vec<Vector2<f64>> = people.iter().map(|(own, _)| *own).collect();
            lurker.look(place, &places);
        }
        let step = rows.time[row + 1] - rows.time[row];
        for (own, least) in &mut people {
            let offset = *own - place;
            let toward = velocity.norm() > CONTACT_SPEED && velocity.dot(&offset) > 0.0;
            // Who does not come ahead of it counts less than who does.
            let gap = offset.norm() + if toward { 0.0 } else { 10.0 };
            *least = least.min(gap);
            let way = lurker.velocity(hiding.time, *own, place) * step;
            *own = lurker.moved(*own, way);
        }
    }
    let worst = people
        .iter()
        .enumerate()
        .min_by(|one, two| one.1.1.total_cmp(&two.1.1));
    starts[worst.map_or(0, |(index, _)| index)]
}

fn vector(values: &[f64], row: usize) -> Vector2<f64> {
    Vector2::new(values[2 * row], values[2 * row + 1])
}
