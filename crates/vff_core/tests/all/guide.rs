//! The guide: check values, completeness of the plan, arrival by local goals, what is refused.

use std::f64::consts::PI;

use crate::planning::barn;
use nalgebra::Vector2;
use proptest::prelude::*;
use vff_core::error::Failure;
use vff_core::laws::Stop;
use vff_core::laws::guide::{Detour, Guidance, Guide, Plan, PlansAround, Takeover, TakeoverRule};
use vff_core::world::map::{MapShapes, StaticMap};
use vff_core::world::shape::PlacedShape;

type Point = Vector2<f64>;

fn walls(walls: &[[[f64; 2]; 2]]) -> StaticMap {
    let mut shapes = MapShapes::new();
    for wall in walls {
        shapes.polyline(wall, 0.0).unwrap();
    }
    shapes.map()
}

fn trap() -> StaticMap {
    walls(&[
        [[3.0, -1.5], [3.0, 1.5]],
        [[1.0, 1.5], [3.0, 1.5]],
        [[1.0, -1.5], [3.0, -1.5]],
    ])
}

fn trap_plan() -> Plan {
    let guide = Guide {
        margin: 0.05,
        bounds: Some([[-2.0, -4.0], [6.0, 4.0]]),
        ..Guide::default()
    };
    let ends = [[0.0, 0.0], [5.0, 0.0]];
    guide.plan(&trap(), 0.2, ends, Stop::never()).unwrap()
}

#[test]
fn costs_in_the_trap_are_the_check_values() {
    let plan = trap_plan();
    for (place, expected) in [
        ([0.0, 0.0], 7.2675),
        ([2.6, 0.5], 8.1187),
        ([3.5, 1.9], 2.4501),
    ] {
        let cost = plan.cost(place.into()).unwrap();
        assert!((cost - expected).abs() < 5e-5, "{place:?}: {cost}");
    }
    assert_eq!(plan.cost(Point::new(40.0, 0.0)), None);
    // Nothing is seen from within a wall.
    assert_eq!(plan.cost(Point::new(3.0, 0.0)), None);
}

/// Goes straight to one local goal after the other; returns the length of the way.
fn follow(plan: &Plan, start: Point, radius: f64) -> f64 {
    let mut position = start;
    let mut length = 0.0;
    let mut cost = f64::INFINITY;
    for _ in 0..10_000 {
        let view = plan.view(position).expect("a plan everywhere on the way");
        assert!(view.cost < cost, "the cost falls at {position:?}");
        cost = view.cost;
        let goal = plan.local_goal(position, &view);
        assert!(plan.map().segment_clearance(position, goal.point) >= radius - 1e-9);
        length += (goal.point - position).norm();
        if goal.is_goal {
            return length;
        }
        // Half of the way, so that new local goals are seen from places between the nodes.
        position += (goal.point - position) * 0.5;
        length -= (goal.point - position).norm();
    }
    panic!("no arrival");
}

#[test]
fn local_goals_lead_out_of_the_trap() {
    let plan = trap_plan();
    let length = follow(&plan, Point::new(2.6, 0.5), 0.2);
    assert!((5.0..8.2).contains(&length), "{length}");
    let path = plan.path(Point::new(2.6, 0.5));
    assert_eq!(path.first(), Some(&Point::new(2.6, 0.5)));
    assert_eq!(path.last(), Some(&Point::new(5.0, 0.0)));
}

#[test]
fn local_goals_lie_within_the_look_ahead_and_laws_get_them_far_enough() {
    let plan = trap_plan();
    let place = Point::new(2.6, 0.5);
    let goal = plan.local_goal(place, &plan.view(place).unwrap());
    let distance = (goal.point - place).norm();
    assert!(!goal.is_goal && distance < 3.0);
    let far = goal.for_law(place) - place;
    assert!((far.norm() - distance.max(2.0)).abs() < 1e-12);
    assert!(far.perp(&(goal.point - place)).abs() < 1e-12);
}

#[test]
fn every_barn_world_has_a_way_that_local_goals_lead_along() {
    let Some(worlds) = barn() else { return };
    let guide = Guide {
        bounds: Some([[-6.0, -0.5], [1.5, 15.0]]),
        ..Guide::default()
    };
    for world in worlds {
        let mut shapes = MapShapes::new();
        for center in world.cylinders {
            shapes.disc(center, world.radius).unwrap();
        }
        let map = shapes.map();
        let ends = [[-2.0, 3.0], [-2.0, 13.0]];
        let plan = guide.plan(&map, 0.22, ends, Stop::never()).unwrap();
        let length = follow(&plan, ends[0].into(), 0.22);
        assert!(
            (10.0 - 1e-9..16.0).contains(&length),
            "{length} in {}",
            world.id
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]
    #[test]
    fn a_way_with_room_is_always_found(
        corners in prop::collection::vec([-3.0..3.0_f64, -3.0..3.0_f64], 2..6),
        discs in prop::collection::vec(([-4.0..4.0_f64, -4.0..4.0_f64], 0.05..1.0_f64), 1..120),
        spacing in prop_oneof![Just(0.05), 0.04..0.15_f64],
    ) {
        // The way that is known: discs that would narrow it shrink, down to nothing.
        let (radius, margin) = (0.2, 0.005);
        let room = radius + margin + spacing * 0.5_f64.sqrt() + 1e-9;
        let way = walls(&corners.windows(2).map(|pair| [pair[0], pair[1]]).collect::<Vec<_>>());
        let mut shapes = MapShapes::new();
        for (center, size) in discs {
            let left = way.clearance(center.into()) - room;
            if left > 1e-3 {
                shapes.disc(center, size.min(left)).unwrap();
            }
        }
        let (map, ends) = (shapes.map(), [corners[0], corners[corners.len() - 1]]);
        let guide = Guide { spacing, margin, ..Guide::default() };
        let plan = guide.plan(&map, radius, ends, Stop::never()).unwrap();
        follow(&plan, ends[0].into(), radius);
    }

    #[test]
    fn a_takeover_alone_arrives_from_everywhere(
        start in [-1.8..5.8_f64, -3.8..3.8_f64],
        speed in 0.2..2.0_f64,
    ) {
        let plan = trap_plan();
        let mut position = Point::from(start);
        prop_assume!(plan.map().clearance(position) >= 0.25);
        prop_assume!(plan.cost(position).is_some());
        let rule = TakeoverRule { progress: 0.3, window: 0.05 };
        let mut takeover = Takeover::new(rule);
        let most = 0.1 * (400.0 + 20.0 / speed);
        let mut time = 0.0;
        while (position - plan.goal()).norm() > 0.05 {
            prop_assert!(time < most, "no arrival");
            let view = plan.view(position).unwrap();
            if takeover.observe(time, Some(view.cost)) {
                let local = plan.local_goal(position, &view);
                let sees = |point| plan.sees(position, point);
                let goal = takeover.target(Some(local), sees).unwrap();
                position += goal.velocity_from(position, speed, 10.0, 0.1) * 0.1;
                prop_assert!(plan.map().clearance(position) >= 0.2 - 1e-9);
            }
            time += 0.1;
        }
    }
}

/// Looks in which any plan of these tests is complete.
const LOOKS: usize = 60;

#[test]
fn a_plan_around_who_stands_is_taken_when_it_is_complete() {
    let map = walls(&[[[2.0, -4.0], [2.0, 0.0]], [[2.0, 1.0], [2.0, 4.0]]]);
    let guide = Guide::default();
    let (start, goal) = ([0.0, 0.5], [4.0, 0.5]);
    let plan = guide.plan(&map, 0.3, [start, goal], Stop::never()).unwrap();
    let guidance = Guidance::new(guide, 0.3, plan);
    let at = Point::from(start);
    let direct = guidance.plan().cost(at).unwrap();
    let people = [Some(PlacedShape::disc([2.0, 0.5], 0.3))];
    // Somebody else who stops and leaves again and again does not keep the plan from being complete.
    let looks = |comes_and_goes: bool| {
        let mut guidance = guidance.clone();
        guidance.observe(0.0, at, people.into_iter());
        (1..LOOKS).find(|look| {
            let other =
                (comes_and_goes && look / 2 % 2 == 0).then(|| PlacedShape::disc([0.0, 3.0], 0.3));
            let time = 2.0 + 2.0 * f64::from(u32::try_from(*look).unwrap());
            let others = people.into_iter().chain([other]);
            guidance.observe(time, at, others) && guidance.plan().cost(at).unwrap() > direct + 1.0
        })
    };
    let needed = looks(false).unwrap();
    assert!(needed > 10, "{needed}");
    assert_eq!(looks(false), Some(needed));
    assert_eq!(looks(true), Some(needed));
}

#[test]
fn a_detour_begins_where_the_robot_stands_and_ends_where_the_straight_way_is_free() {
    let guide = Guide {
        bounds: Some([[-2.0, -4.0], [8.0, 4.0]]),
        ..Guide::default()
    };
    let ends = [[0.0, 0.0], [6.0, 0.0]];
    let map = MapShapes::new().map();
    let plan = guide.plan(&map, 0.3, ends, Stop::never()).unwrap();
    let mut guidance = Guidance::new(guide, 0.3, plan);
    let mut detour = Detour::default();
    // Somebody stands on the way: 2 s long nobody knows, then the robot would have to stand, too.
    let mut led = |time: f64, [x, y]: [f64; 2], person: Option<[f64; 2]>| {
        let people = person.map(|place| PlacedShape::disc(place, 0.5));
        for _ in 0..LOOKS {
            guidance.observe(time, Point::new(x, y), std::iter::once(people));
        }
        let local = detour.observe(time, Point::new(x, y), &guidance);
        local.map(|local| local.point)
    };
    let near = Some([2.0, 0.1]);
    assert_eq!(led(0.0, [0.0, 0.0], near), None);
    assert_eq!(led(1.0, [0.1, 0.0], near), None);
    assert_eq!(led(2.9, [0.15, 0.0], near), None);
    let around = led(3.0, [0.15, 0.0], near).unwrap();
    assert!(around.y < -0.2, "{around}");
    // On the way around the goal is as far away as before, or farther.
    assert!(led(3.5, [0.1, -0.3], near).is_some());
    assert!(led(9.0, [1.0, -0.6], near).is_some());
    assert_eq!(led(9.5, [1.8, -0.95], near), None);
    // Another wait begins anew, and who stands beyond the look-ahead is in nobody's way.
    assert_eq!(led(9.6, [0.1, 0.0], near), None);
    assert!(led(11.6, [0.1, 0.0], near).is_some());
    assert_eq!(led(11.7, [0.1, 0.0], None), None);
    let far = Some([5.0, 0.0]);
    assert_eq!(led(12.0, [0.1, 0.0], far), None);
    assert_eq!(led(30.0, [0.1, 0.0], far), None);
}

#[test]
fn the_plan_leads_around_who_stands_until_he_leaves() {
    // A corridor with two doors; somebody stands in the nearer one.
    let map = walls(&[
        [[2.0, -4.0], [2.0, -2.5]],
        [[2.0, -1.5], [2.0, 0.0]],
        [[2.0, 1.0], [2.0, 4.0]],
        [[-1.0, -4.0], [5.0, -4.0]],
        [[-1.0, 4.0], [5.0, 4.0]],
        [[-1.0, -4.0], [-1.0, 4.0]],
        [[5.0, -4.0], [5.0, 4.0]],
    ]);
    let guide = Guide::default();
    let (start, goal) = ([0.0, 0.5], [4.0, 0.5]);
    let plan = guide.plan(&map, 0.3, [start, goal], Stop::never()).unwrap();
    let mut guidance = Guidance::new(guide, 0.3, plan);
    let at = Point::from(start);
    let direct = guidance.plan().cost(at).unwrap();
    let person = Some(PlacedShape::disc([2.0, 0.5], 0.3));
    let mut look = |time: f64, person| {
        let people = std::iter::once(person);
        // A plan is complete after some looks at the same instant.
        for _ in 0..LOOKS {
            guidance.observe(time, at, people.clone());
        }
        guidance.plan().cost(at).unwrap()
    };
    assert_eq!(look(0.0, person), direct);
    assert!(look(2.0, person) > direct + 1.0);
    assert_eq!(look(2.1, None), direct);
    // A gate across the door is in the way by its outline, one that is drawn back is not.
    let gate = |x: f64, y: f64| Some(PlacedShape::turned([x, y], [0.9, 0.1], 0.5 * PI));
    look(2.2, gate(2.0, 0.5));
    assert!(look(4.3, gate(2.0, 0.5)) > direct + 1.0);
    look(4.4, gate(3.0, 3.0));
    assert_eq!(look(6.5, gate(3.0, 3.0)), direct);
    look(6.6, None);
    // In the way of both doors nobody waits for another plan.
    let mut both = |time: f64| {
        let people = [0.5, -2.0].map(|y| Some(PlacedShape::disc([2.0, y], 0.45)));
        for _ in 0..LOOKS {
            guidance.observe(time, at, people.into_iter());
        }
        guidance.plan().cost(at).unwrap()
    };
    both(7.0);
    assert_eq!(both(9.0), direct);
}

#[test]
fn plans_that_runs_share_are_taken_at_the_look_at_which_each_would_have_made_them() {
    let map = walls(&[[[2.0, -4.0], [2.0, 0.0]], [[2.0, 1.0], [2.0, 4.0]]]);
    let guide = Guide {
        bounds: Some([[-2.0, -6.0], [6.0, 6.0]]),
        ..Guide::default()
    };
    let ends = [[0.0, 0.5], [4.0, 0.5]];
    let plan = guide.plan(&map, 0.3, ends, Stop::never()).unwrap();
    let at = Point::from(ends[0]);
    let costs = |plan: &Plan, plans: &PlansAround, places: &[[f64; 2]]| {
        let mut guidance = Guidance::new(guide, 0.3, plan.clone()).sharing(plans.clone());
        let mut found = Vec::new();
        for (index, place) in places.iter().enumerate() {
            for look in 0..120_u32 {
                let time = 10.0 * index as f64 + 0.25 * f64::from(look);
                let person = Some(PlacedShape::disc(*place, 0.3));
                guidance.observe(time, at, std::iter::once(person));
                found.push(guidance.plan().cost(at).map(f64::to_bits));
            }
        }
        found
    };
    // The middle of the door, another place, and the door again.
    let places = [[2.0, 0.5], [1.0, 0.4], [2.0, 0.5]];
    let alone = costs(&plan, &PlansAround::default(), &places);
    assert!(alone.iter().any(|cost| *cost != alone[0]));
    let shared = PlansAround::default();
    for _ in 0..2 {
        assert_eq!(costs(&plan, &shared, &places), alone);
    }
    // Those of another map are others.
    let open = guide
        .plan(&MapShapes::new().map(), 0.3, ends, Stop::never())
        .unwrap();
    assert_eq!(
        costs(&open, &shared, &places),
        costs(&open, &PlansAround::default(), &places)
    );
}

#[test]
fn a_plan_around_more_people_is_the_same_after_one_around_some_of_them() {
    let map = walls(&[[[2.0, -4.0], [2.0, 0.0]], [[2.0, 1.5], [2.0, 4.0]]]);
    let guide = Guide {
        bounds: Some([[-2.0, -6.0], [6.0, 6.0]]),
        ..Guide::default()
    };
    let ends = [[0.0, 0.5], [4.0, 0.5]];
    let plan = guide.plan(&map, 0.3, ends, Stop::never()).unwrap();
    let people = [
        PlacedShape::disc([2.0, 0.7], 0.3),
        PlacedShape::turned([1.0, 0.5], [0.6, 0.2], 0.4),
        PlacedShape::disc([3.0, -0.5], 0.25),
    ];
    let costs = |plans: &PlansAround, standing: &[PlacedShape]| {
        let mut guidance = Guidance::new(guide, 0.3, plan.clone()).sharing(plans.clone());
        for look in 0..120_u32 {
            let seen = standing.iter().copied().map(Some);
            guidance.observe(0.25 * f64::from(look), ends[0].into(), seen);
        }
        assert!(guidance.leads_around());
        let places = (0..40).map(|index| Point::new(-1.0 + 0.15 * f64::from(index), 0.4));
        let costs = places.map(|place| guidance.plan().cost(place).map(f64::to_bits));
        costs.collect::<Vec<_>>()
    };
    let kept = PlansAround::default();
    for count in 1..=people.len() {
        let standing = &people[..count];
        assert_eq!(
            costs(&kept, standing),
            costs(&PlansAround::default(), standing)
        );
    }
}

#[test]
fn a_robot_outside_of_the_box_finds_its_way_back() {
    let plan = trap_plan();
    let guidance = Guidance::new(Guide::default(), 0.2, plan.clone());
    for place in [[0.0, 5.0], [8.5, 6.5], [-9.0, 0.0], [2.0, -4.5]] {
        let outside = Point::from(place);
        assert!(plan.view(outside).is_none(), "{place:?}");
        let (view, local) = guidance.local_goal(outside).unwrap();
        assert!(plan.sees(outside, local.point));
        // The cost falls on the way back.
        let ahead = outside + (local.point - outside).normalize() * 0.2;
        let (nearer, _) = guidance.local_goal(ahead).unwrap();
        assert!(nearer.cost < view.cost - 0.1, "{place:?}");
    }
    // From within a wall nothing is seen, outside of the box neither.
    assert!(guidance.local_goal(Point::new(3.0, 0.0)).is_none());
}

#[test]
fn what_has_no_plan_is_refused_with_the_reason() {
    let refused = |guide: Guide, map: &StaticMap, ends: [[f64; 2]; 2]| {
        guide
            .plan(map, 0.2, ends, Stop::never())
            .unwrap_err()
            .to_string()
    };
    let map = trap();
    let guide = Guide::default();
    let boxed = Guide {
        bounds: Some([[-2.0, -4.0], [4.0, 4.0]]),
        ..guide
    };
    let ends = [[0.0, 0.0], [5.0, 0.0]];
    assert!(refused(boxed, &map, ends).starts_with("goal must lie within the box"));
    assert!(refused(boxed, &map, [ends[1], ends[0]]).starts_with("start must lie within the box"));
    let near = refused(guide, &map, [[0.0, 0.0], [3.1, 0.0]]);
    assert!(
        near.starts_with("goal must be at least the radius of the robot, 0.2 m"),
        "{near}"
    );
    assert!(refused(guide, &map, [[3.1, 0.0], [0.0, 0.0]]).starts_with("start must be at least"));
    let closed = walls(&[
        [[3.0, -1.5], [3.0, 1.5]],
        [[1.0, 1.5], [3.0, 1.5]],
        [[1.0, -1.5], [3.0, -1.5]],
        [[1.0, -1.5], [1.0, 1.5]],
    ]);
    assert!(refused(guide, &closed, [[2.0, 0.0], [5.0, 0.0]]).contains("reachable from the start"));
    for (wrong, name) in [
        (
            Guide {
                spacing: 0.0,
                ..guide
            },
            "spacing",
        ),
        (
            Guide {
                margin: -1.0,
                ..guide
            },
            "margin",
        ),
        (
            Guide {
                look_ahead: f64::NAN,
                ..guide
            },
            "look_ahead",
        ),
        (
            Guide {
                spacing: 1e-9,
                ..guide
            },
            "spacing must give at most",
        ),
        (
            Guide {
                bounds: Some([[1.0, 0.0], [0.0, 1.0]]),
                ..guide
            },
            "upper corner",
        ),
    ] {
        assert!(refused(wrong, &map, ends).contains(name));
    }
    let stopped = guide.plan(&map, 0.2, ends, Stop(&|| true));
    assert_eq!(stopped.unwrap_err(), Failure::Interrupted);
}
