//! Meetings, prices, and who is left out of them.

use super::*;

fn limits() -> ShieldLimits {
    ShieldLimits {
        radius: 0.3,
        max_speed: 1.5,
        max_acceleration: 10.0,
        period: 0.1,
    }
}

fn outlook(people: &[Passerby]) -> Outlook<'_> {
    Outlook {
        robot: RobotState {
            position: Vector2::zeros(),
            velocity: Vector2::zeros(),
        },
        wanted: Vector2::new(1.0, 0.0),
        to_goal: Vector2::x(),
        people,
        left_out: false,
        walls: StaticObstacles::NONE,
    }
}

/// Everybody, none of them sorted out, all of them looked at while a velocity is taken up.
fn everybody(people: &[Passerby]) -> Crowd<'_> {
    Crowd {
        people,
        early: people.len(),
        left_out: false,
    }
}

fn passerby(offset: [f64; 2], velocity: [f64; 2]) -> Passerby {
    Passerby {
        offset: offset.into(),
        velocity: velocity.into(),
        touch: 0.6,
    }
}

#[test]
fn the_wanted_velocity_is_kept_where_nobody_comes() {
    let yielder = Yielder::new(Yielding::default(), limits()).unwrap();
    let people = [passerby([0.0, 4.0], [0.0, 1.0])];
    let decided = yielder.decide(&outlook(&people), |_| true);
    assert_eq!(decided, Some(Vector2::new(1.0, 0.0)));
}

#[test]
fn it_gives_way_to_somebody_head_on() {
    let yielder = Yielder::new(Yielding::default(), limits()).unwrap();
    let people = [passerby([3.0, 0.0], [-1.0, 0.0])];
    let decided = yielder.decide(&outlook(&people), |_| true).unwrap();
    assert!(decided.y.abs() > 0.2, "{decided}");
    assert_eq!(yielder.decide(&outlook(&people), |_| false), None);
}

#[test]
fn conflicts_are_those_of_small_steps() {
    let yielder = Yielder::new(Yielding::default(), limits()).unwrap();
    let mut seen = outlook(&[]);
    seen.robot.velocity = Vector2::new(-0.4, 0.9);
    for (offset, velocity, target) in [
        ([2.0, 1.0], [-0.8, 0.3], [1.5, 0.0]),
        ([1.0, -2.0], [0.2, 0.9], [0.3, -0.6]),
        ([4.0, 0.1], [-1.0, 0.0], [0.0, 0.0]),
    ] {
        let people = [passerby(offset, velocity)];
        let target = Vector2::from(target);
        let outlook = Outlook {
            people: &people,
            ..seen
        };
        let conflict = yielder.conflict::<f64>(&outlook, &everybody(&people), target);
        let ramp = (target - seen.robot.velocity).norm() / 10.0;
        let (mut first, mut least) = (5.0_f64, f64::INFINITY);
        for step in 0..=50_000 {
            let time = f64::from(step) * 1e-4;
            let own = (seen.robot.velocity + target) * 0.5 * time.min(ramp)
                + target * (time - ramp).max(0.0);
            let away = people[0].offset + people[0].velocity * time - own;
            let clearance = away.norm() - 0.6;
            least = least.min(clearance);
            if clearance <= 0.15 {
                first = first.min(time);
            }
        }
        assert!((conflict.time - first).abs() < 2e-4, "{conflict:?} {first}");
        assert!(
            (conflict.clearance - least).abs() < 2e-4,
            "{conflict:?} {least}"
        );
    }
}

#[test]
fn lanes_price_as_single_velocities_do() {
    let yielder = Yielder::new(Yielding::default(), limits()).unwrap();
    let people = [
        passerby([2.0, 1.0], [-0.8, 0.3]),
        passerby([1.0, -0.5], [0.1, 0.2]),
    ];
    let (outlook, crowd) = (outlook(&people), everybody(&people));
    for chunk in 0..CHUNKS {
        let candidates = yielder.candidates(&outlook, chunk);
        let together = yielder.price(&yielder.conflict(&outlook, &crowd, candidates));
        for lane in 0..WIDTH {
            let one = Vector2::from(candidates.lane(lane));
            let alone = yielder.price(&yielder.conflict::<f64>(&outlook, &crowd, one));
            assert_eq!(alone.to_bits(), together.lane(lane).to_bits());
        }
    }
}

#[test]
fn who_cannot_be_met_has_no_part_in_any_price() {
    let yielder = Yielder::new(Yielding::default(), limits()).unwrap();
    let mut stream = numeric::random::Stream::new(5, 0);
    let (mut kept, mut early, mut all) = (0, 0, 0);
    for _ in 0..400 {
        let mut draw = |most: f64| stream.uniform(-most, most);
        let people: Vec<Passerby> = (0..12)
            .map(|_| passerby([draw(14.0), draw(14.0)], [draw(2.5), draw(2.5)]))
            .collect();
        let mut whole = outlook(&people);
        whole.robot.velocity = Vector2::new(draw(1.0), draw(1.0));
        let mut room = [Passerby::NOBODY; SORTED];
        let near = yielder.near(&whole, &mut room);
        kept += near.people.len();
        early += near.early;
        all += people.len();
        for chunk in 0..CHUNKS {
            let candidates = yielder.candidates(&whole, chunk);
            let one = yielder.price(&yielder.conflict(&whole, &everybody(&people), candidates));
            let other = yielder.price(&yielder.conflict(&whole, &near, candidates));
            for lane in 0..WIDTH {
                assert_eq!(one.lane(lane).to_bits(), other.lane(lane).to_bits());
            }
        }
    }
    assert!(kept > all / 10 && kept < 8 * all / 10, "{kept} of {all}");
    assert!(early > kept / 50 && early < kept / 2, "{early} of {kept}");
}

/// The cheapest candidate that is verified, the first of them where several are, without any short cut.
fn cheapest_of_all(
    yielder: &Yielder,
    outlook: &Outlook<'_>,
    verified: impl Fn(Vector2<f64>) -> bool,
) -> Option<Vector2<f64>> {
    let crowd = everybody(outlook.people);
    let before = outlook.robot.velocity;
    let wanted = yielder.limits.clipped(before, outlook.wanted);
    let alone = yielder.conflict::<f64>(outlook, &crowd, outlook.wanted);
    let Yielding {
        horizon, comfort, ..
    } = yielder.settings;
    if alone.time >= horizon && alone.clearance >= comfort && verified(wanted) {
        return Some(wanted);
    }
    let mut found: Option<(f64, Vector2<f64>)> = None;
    for index in 0..2 + DIRECTIONS * SPEEDS {
        let candidates = yielder.candidates(outlook, index / WIDTH);
        let velocity = Vector2::from(candidates.lane(index % WIDTH));
        let conflict = yielder.conflict::<f64>(outlook, &crowd, velocity);
        let price = yielder.aims(outlook, velocity) + yielder.price(&conflict);
        let command = yielder.limits.clipped(before, velocity);
        if found.is_none_or(|(least, _)| price < least) && verified(command) {
            found = Some((price, command));
        }
    }
    found.map(|(_, command)| command)
}

#[test]
fn the_cheapest_velocity_is_found_with_and_without_short_cuts() {
    let mut stream = numeric::random::Stream::new(8, 0);
    let (mut kept, mut none) = (0, 0);
    for round in 0..600 {
        let mut draw = |most: f64| stream.uniform(-most, most);
        let settings = Yielding {
            comfort: 0.1 + 0.2 * draw(0.4).abs(),
            time_weight: 3.8 + draw(3.8),
            ..Yielding::default()
        };
        let yielder = Yielder::new(settings, limits()).unwrap();
        let people: Vec<Passerby> = (0..12)
            .map(|_| Passerby {
                touch: 0.6 + draw(0.2),
                ..passerby([draw(5.0), draw(5.0)], [draw(1.5), draw(1.5)])
            })
            .collect();
        let mut whole = outlook(&people);
        whole.robot.velocity = Vector2::new(draw(1.0), draw(1.0));
        whole.wanted = Vector2::new(draw(1.0), draw(1.0));
        whole.to_goal = Vector2::new(draw(1.0), draw(1.0)).normalize();
        // Half a plane of velocities in which some are missing.
        let (edge, level) = (Vector2::new(draw(1.0), draw(1.0)), draw(0.3));
        let verified = |velocity: Vector2<f64>| {
            round % 3 == 0 || (velocity.dot(&edge) > level && (velocity.x * 40.0).sin() > -0.8)
        };
        let quick = yielder.decide(&whole, verified);
        let slow = cheapest_of_all(&yielder, &whole, verified);
        let bits = |found: Option<Vector2<f64>>| found.map(|v| [v.x.to_bits(), v.y.to_bits()]);
        assert_eq!(bits(quick), bits(slow), "round {round}");
        kept +=
            u32::from(quick == Some(yielder.limits.clipped(whole.robot.velocity, whole.wanted)));
        none += u32::from(quick.is_none());
    }
    assert!(
        (6..300).contains(&kept) && (1..300).contains(&none),
        "{kept}, {none}"
    );
}
