use super::*;
use nalgebra::Vector2;
use navigation_world::world::map::{MapShapes, StaticMap};
use numeric::random::Stream;
use serde_json::Value;
use std::f64::consts::TAU;
use std::sync::Arc;

fn cases() -> Value {
    let text = include_str!("../../../../tests/golden/unknown_places_cases.json");
    serde_json::from_str::<Value>(text).unwrap()["unknown"]["belief"].clone()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

/// The corridor of the cases with a corner.
fn corner(cell: f64, core: f64) -> Arc<Ground> {
    let size = [(4.0 / cell).round() as usize, (3.0 / cell).round() as usize];
    let free = |[column, row]: [usize; 2]| {
        let (x, y) = ((column as f64 + 0.5) * cell, (row as f64 + 0.5) * cell);
        let along = (0.1..3.9).contains(&x) && (0.1..1.3).contains(&y);
        along || ((2.4..3.9).contains(&x) && (1.3..2.9).contains(&y))
    };
    let occupied = CellSet::of(size, |place| !free(place));
    Arc::new(Ground::of_cells([0.0; 2], cell, core, occupied).unwrap())
}

fn scan(belief: &mut Belief, from: Vector2<f64>) {
    let sensing = Sensing::default();
    belief.see(from, sensing.ends(from, 0.0, sensing.range, &[]), 0.0);
}

#[test]
fn belief_and_arrivals_are_those_of_the_cases() {
    let cases = cases();
    let ground = corner(0.05, 0.15);
    assert_eq!(
        ground.walkable().count() as u64,
        cases["walkable"].as_u64().unwrap()
    );
    let exact = &cases["exact_walk"];
    let tolerance = number(&exact["tolerance_cells"]);
    let mut belief = Belief::new(ground);
    let mut place = Vector2::zeros();
    let steps = cases["steps"].as_array().unwrap().iter();
    for (step, found) in steps.zip(exact["steps"].as_array().unwrap()) {
        place = Vector2::new(number(&step["robot"][0]), number(&step["robot"][1]));
        belief.grow(1.6 * 0.05);
        scan(&mut belief, place);
        assert!((belief.budget() - number(&step["budget"])).abs() < 1e-9);
        let cells = belief.cells().count() as f64;
        assert!(
            (cells - number(&found["cells"])).abs() <= tolerance,
            "{cells} {found}"
        );
        let first = belief.cells().iter().next().unwrap();
        assert_eq!(first[1] as u64, found["first"][0].as_u64().unwrap());
        assert_eq!(first[0] as u64, found["first"][1].as_u64().unwrap());
    }
    let mut arrivals = Arrivals::default();
    arrivals.find(&belief, place, [3.0, 1.5], 1.6);
    for row in exact["tau_from_scan_s"].as_array().unwrap() {
        let found = arrivals.at(Vector2::new(number(&row[0]), number(&row[1])));
        let wanted = number(&row[2]);
        if wanted > 1e8 {
            assert_eq!(found, f64::INFINITY);
        } else {
            // A cell of the tolerance beside it.
            assert!((found - wanted).abs() < 0.012, "{found} {wanted}");
        }
    }
}

/// Whether the core of somebody keeps off the walls of the corridor, also around the edge between its two parts.
fn has_room(place: Vector2<f64>) -> bool {
    let inside = |[x0, y0, x1, y1]: [f64; 4]| {
        place.x >= x0 && place.x <= x1 && place.y >= y0 && place.y <= y1
    };
    let along = inside([0.25, 0.25, 3.75, 1.15]) || inside([2.55, 0.25, 3.75, 2.75]);
    let edge = (place - Vector2::new(2.4, 1.3)).norm() >= 0.15 && inside([2.4, 1.15, 2.55, 1.3]);
    along || edge
}

/// Whether a beam meets the core of somebody before a wall.
fn is_seen(
    ground: &Ground,
    robot: Vector2<f64>,
    person: Vector2<f64>,
    ends: &[Vector2<f64>],
) -> bool {
    let core = navigation_world::world::shape::PlacedShape::disc(person.into(), 0.15);
    ends.iter().any(|end| {
        let along = (end - robot).normalize();
        let met = core.cast(robot, along);
        let free = |way: f64| {
            let count = 160;
            (0..=count).all(|part| {
                let place = robot + along * (way * f64::from(part) / f64::from(count));
                let cell = ground.holding(place);
                cell.is_some_and(|cell| !ground.occupied().contains(cell))
            })
        };
        met < 8.0 && free(met)
    })
}

/// Somebody who walks in free space with corners and rests, and is not seen: the cells that a robot sees empty he
/// leaves out, and those within `least` m of the beams. Returns in how many of the steps the belief did not hold him, and in how
/// many he was hidden.
fn hidden(seed: u64, (speed, walls): (f64, bool), (cell, least): (f64, f64)) -> [usize; 2] {
    let ground = corner(cell, 0.15);
    let mut stream = Stream::new(seed, 1);
    let mut person = Vector2::new(stream.uniform(2.6, 3.7), stream.uniform(2.0, 2.7));
    let mut belief = Belief::new(ground.clone());
    let [mut lost, mut unseen] = [0, 0];
    let mut direction = stream.uniform(0.0, TAU);
    for step in 0..160 {
        if step % 7 == 0 {
            direction = stream.uniform(0.0, TAU);
        }
        let robot = Vector2::new(
            0.5 + 0.01 * f64::from(step),
            0.5 + 0.3 * f64::from(step % 2),
        );
        let (sin, cos) = direction.sin_cos();
        let next = person + Vector2::new(cos, sin) * (speed * 0.05);
        if has_room(next) {
            person = next;
        }
        belief.grow(1.6 * 0.05);
        // Beams with him in them: whoever ends one is tracked, and this run is over.
        let sensing = Sensing::default();
        let ends: Vec<Vector2<f64>> = sensing.ends(robot, 0.0, sensing.range, &[]).collect();
        let mut seen = false;
        if walls {
            seen = is_seen(&ground, robot, person, &ends);
            belief.see(robot, ends.into_iter(), least);
        } else {
            // Whoever sees through walls takes out too much.
            let open = CellSet::empty(ground.size());
            let open = Arc::new(Ground::of_cells([0.0; 2], cell, 0.15, open).unwrap());
            let mut through = Belief::new(open);
            through.see(robot, ends.into_iter(), 0.0);
            for cell in ground.walkable().iter() {
                if !through.cells().contains(cell) {
                    belief.cells.remove(cell);
                }
            }
        }
        if seen {
            break;
        }
        unseen += 1;
        lost += usize::from(!belief.covers(person));
    }
    [lost, unseen]
}

/// Somebody who comes as near to the robot as he can without being seen, and gives way to its beams at full speed. Returns in how
/// many of the steps the belief did not hold him, and in how many he was hidden.
fn lurking(seed: u64, cell: f64, least: f64) -> [usize; 2] {
    let ground = corner(cell, 0.15);
    let mut stream = Stream::new(seed, 2);
    let mut person = Vector2::new(stream.uniform(2.6, 3.7), stream.uniform(2.0, 2.7));
    let (from, way) = (stream.uniform(0.4, 1.4), stream.uniform(0.4, 1.0));
    let mut belief = Belief::new(ground.clone());
    let [mut lost, mut unseen] = [0, 0];
    for step in 0..60 {
        // To and fro, so that what is hidden from it moves to and fro, too.
        let phase = 0.11 * f64::from(step);
        let robot = Vector2::new(from + way * (1.0 - phase.cos()), 0.6 + 0.3 * phase.sin());
        let sensing = Sensing::default();
        let ends: Vec<Vector2<f64>> = sensing.ends(robot, 0.0, sensing.range, &[]).collect();
        let turns = (0..16).flat_map(|turn| [1.0, 0.5, 0.2].map(|share| (turn, share)));
        let steps = turns.map(|(turn, share)| {
            let (sin, cos) = (f64::from(turn) * TAU / 16.0).sin_cos();
            Vector2::new(cos, sin) * (1.6 * 0.05 * share)
        });
        let steps = steps.chain([Vector2::zeros()]);
        let places = steps
            .map(|step| person + step)
            .filter(|place| has_room(*place) && !is_seen(&ground, robot, *place, &ends));
        let away = |place: &Vector2<f64>| (place - robot).norm();
        let Some(next) = places.min_by(|one, other| away(one).total_cmp(&away(other))) else {
            break;
        };
        person = next;
        belief.grow(1.6 * 0.05);
        belief.see(robot, ends.into_iter(), least);
        unseen += 1;
        lost += usize::from(!belief.covers(person));
    }
    [lost, unseen]
}

#[test]
fn somebody_hidden_is_within_eta_of_the_belief_at_every_step() {
    for cell in [0.05, 0.025] {
        let exact = Unseen {
            cell,
            pose_error: 0.0,
            ..Unseen::default()
        };
        let mut steps = 0;
        for seed in 0..40 {
            let [lost, unseen] = hidden(seed, (1.6, true), (cell, exact.kept_by_beams()));
            assert_eq!(lost, 0, "{seed}");
            steps += unseen;
        }
        assert!(steps > 1500, "{steps}");
    }
}

#[test]
fn whoever_lurks_beside_the_beams_is_within_eta_of_the_belief() {
    for cell in [0.05, 0.025] {
        let least = 0.15;
        let found: Vec<[usize; 2]> = (0..5).map(|seed| lurking(seed, cell, least)).collect();
        assert!(found.iter().all(|[lost, _]| *lost == 0), "{found:?}");
        assert!(
            found.iter().map(|[_, unseen]| unseen).sum::<usize>() > 150,
            "{found:?}"
        );
    }
}

#[test]
fn whoever_takes_out_more_than_what_a_core_would_have_ended_loses_who_lurks() {
    let beyond: usize = (0..5).map(|seed| lurking(seed, 0.025, 0.2)[0]).sum();
    assert!(beyond > 0);
}

#[test]
fn cells_around_others_are_those_within_the_radius() {
    let size = [150, 70];
    let mut stream = Stream::new(5, 1);
    let drawn = CellSet::of(size, |_| stream.uniform(0.0, 1.0) < 0.003);
    for radius in [0.0, 1.0, 1.5, 3.4, 90.0] {
        let mut found = CellSet::of(size, |_| true);
        found.remove_around(&drawn, radius);
        let brute = CellSet::of(size, |[column, row]| {
            drawn.iter().all(|[x, y]| {
                let away = [x as f64 - column as f64, y as f64 - row as f64];
                away[0] * away[0] + away[1] * away[1] > radius * radius
            })
        });
        assert_eq!(found, brute, "{radius}");
    }
}

#[test]
fn whoever_breaks_an_assumption_leaves_the_belief() {
    let runs = |speed: f64| {
        let ground = corner(0.05, 0.15);
        let mut belief = Belief::new(ground.clone());
        belief.cells = CellSet::empty(ground.size());
        let mut place = Vector2::new(0.4, 0.7);
        belief.add(place, 0.0);
        (0..30).all(|_| {
            place.x += speed * 0.05;
            belief.grow(1.6 * 0.05);
            belief.covers(place)
        })
    };
    assert!(runs(1.6) && !runs(1.8));
    let through: usize = (0..10)
        .map(|seed| hidden(seed, (1.6, false), (0.05, 0.0))[0])
        .sum();
    assert!(through > 100);
}

#[test]
fn cells_that_a_core_can_hide_beside_a_beam_in_are_refused() {
    let coarse = Unseen {
        cell: 0.062,
        ..Unseen::default()
    };
    assert!(coarse.checked().is_err());
    let fine = Unseen {
        cell: 0.06,
        ..Unseen::default()
    };
    assert!(fine.checked().is_ok());
    let astray = Unseen {
        heading_error: 0.01,
        ..Unseen::default()
    };
    assert!(astray.trusted_range() < 2.5 && Unseen::default().trusted_range() == 8.0);
}

#[test]
fn growth_is_that_of_eight_neighbors_across_words() {
    let size = [150, 70];
    let walls = CellSet::of(size, |[column, row]| column == 64 && row != 30);
    let within = CellSet::of(size, |place| !walls.contains(place));
    let mut found = CellSet::of(size, |place| {
        place == [63, 30] || place == [149, 0] || place == [0, 69]
    });
    let mut beside = Vec::new();
    for _ in 0..5 {
        let before = found.clone();
        found.spread(&within, &mut beside);
        let brute = CellSet::of(size, |[column, row]| {
            within.contains([column, row])
                && (row.saturating_sub(1)..=(row + 1).min(69)).any(|row| {
                    (column.saturating_sub(1)..=(column + 1).min(149))
                        .any(|column| before.contains([column, row]))
                })
        });
        assert_eq!(found, brute);
    }
    assert!(found.contains([66, 32]));
    assert_eq!(found.iter().count(), found.count());
}

fn room() -> StaticMap {
    let mut shapes = MapShapes::new();
    let corners = [[0.0, 0.0], [6.0, 0.0], [6.0, 4.0], [0.0, 4.0], [0.0, 0.0]];
    shapes.polyline(&corners, 0.05).unwrap();
    shapes.polyline(&[[3.0, 0.0], [3.0, 2.5]], 0.05).unwrap();
    shapes.map()
}

#[test]
fn somebody_is_seen_by_a_beam_that_meets_him_first() {
    let (map, sensing) = (room(), Sensing::default());
    let pose = (Vector2::new(1.0, 1.0), 0.0);
    let sees =
        |place: [f64; 2], others: &[_]| sensing.sees(&map, pose, (place.into(), 0.3), others);
    assert!(sees([2.0, 3.0], &[]) && !sees([5.0, 1.0], &[]));
    let other = navigation_world::world::shape::PlacedShape::disc([1.5, 2.0], 0.4);
    assert!(!sees([2.0, 3.0], &[other]));
    let ahead = Sensing {
        field_of_view: 1.0,
        ..sensing
    };
    assert!(ahead.sees(&map, pose, (Vector2::new(2.5, 1.0), 0.3), &[]));
    assert!(!ahead.sees(&map, pose, (Vector2::new(0.4, 1.0), 0.3), &[]));
    let short = Sensing {
        range: 0.5,
        ..sensing
    };
    assert!(!short.sees(&map, pose, (Vector2::new(2.5, 1.0), 0.3), &[]));
}

#[test]
fn whoever_was_tracked_and_is_lost_is_reckoned_with() {
    let ground = Arc::new(Ground::of_map(&room(), [[-0.2, -0.2], [6.2, 4.2]], 0.05, 0.15).unwrap());
    let mut belief = Belief::new(ground.clone());
    let from = Vector2::new(1.5, 2.0);
    let sensing = Sensing::default();
    belief.see(from, sensing.ends(from, 0.0, sensing.range, &[]), 0.0);
    let place = Vector2::new(1.0, 1.0);
    assert!(!belief.covers(place) && belief.covers(Vector2::new(5.0, 1.0)));
    belief.add(place, 0.1);
    assert!(belief.covers(place) && belief.covers(Vector2::new(1.05, 1.05)));
    let mut arrivals = Arrivals::default();
    arrivals.find(&belief, from, [2.0, 9.0], 1.6);
    assert_eq!(arrivals.at(place), arrivals.at(Vector2::new(1.05, 1.0)));
    assert!(!arrivals.nobody_near(place, 0.2, 0.0, |_| true));
    assert!(arrivals.nobody_near(place, 0.2, 0.0, |_| false));
    // Beyond its window nothing is promised.
    assert!(!arrivals.nobody_near(Vector2::new(5.9, 2.0), 0.2, -9.0, |_| true));
}

#[test]
fn arrivals_bound_straight_ways_from_below() {
    let ground =
        Arc::new(Ground::of_map(&StaticMap::default(), [[0.0; 2], [5.0; 2]], 0.05, 0.15).unwrap());
    let mut belief = Belief::new(ground);
    belief.cells = CellSet::empty([100, 100]);
    belief.cells.insert([50, 50]);
    let mut arrivals = Arrivals::default();
    let middle = Vector2::new(2.525, 2.525);
    arrivals.find(&belief, middle, [2.4, 9.0], 1.6);
    let eta = belief.eta();
    let mut stream = Stream::new(3, 0);
    for _ in 0..2000 {
        let place = middle + Vector2::new(stream.uniform(-2.2, 2.2), stream.uniform(-2.2, 2.2));
        let straight = (place - middle).norm();
        let found = arrivals.at(place);
        // Anybody within eta of the belief, straight to any point of the cell.
        assert!(found <= ((straight - eta) / 1.6).max(0.0) + 1e-9);
        assert!(found >= (straight / 1.0275 - eta - 0.0708) / 1.6 - 1e-9);
    }
}
