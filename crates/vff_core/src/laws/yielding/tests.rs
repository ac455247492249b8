//! Meetings, prices, and who is left out of them.

use super::*;

fn limits() -> Limits {
    Limits {
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
        walls: Walls::NONE,
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
fn meetings_are_those_of_small_steps() {
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
        let meeting = yielder.meeting::<f64>(&outlook, target);
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
        assert!((meeting.time - first).abs() < 2e-4, "{meeting:?} {first}");
        assert!(
            (meeting.clearance - least).abs() < 2e-4,
            "{meeting:?} {least}"
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
    let outlook = outlook(&people);
    for chunk in 0..CHUNKS {
        let candidates = yielder.candidates(&outlook, chunk);
        let together = yielder.price(&yielder.meeting(&outlook, candidates));
        for lane in 0..WIDTH {
            let one = Vector2::from(candidates.lane(lane));
            let alone = yielder.price(&yielder.meeting::<f64>(&outlook, one));
            assert_eq!(alone.to_bits(), together.lane(lane).to_bits());
        }
    }
}

#[test]
fn who_cannot_be_met_has_no_part_in_any_price() {
    let yielder = Yielder::new(Yielding::default(), limits()).unwrap();
    let mut stream = numeric::random::Stream::new(5, 0);
    let (mut kept, mut all) = (0, 0);
    for _ in 0..400 {
        let mut draw = |most: f64| stream.uniform(-most, most);
        let people: Vec<Passerby> = (0..12)
            .map(|_| passerby([draw(14.0), draw(14.0)], [draw(2.5), draw(2.5)]))
            .collect();
        let mut whole = outlook(&people);
        whole.robot.velocity = Vector2::new(draw(1.0), draw(1.0));
        let mut room = [Passerby::NOBODY; SORTED];
        let near = yielder.near(&whole, &mut room);
        let sorted = Outlook {
            people: near,
            left_out: near.len() < people.len(),
            ..whole
        };
        kept += near.len();
        all += people.len();
        for chunk in 0..CHUNKS {
            let candidates = yielder.candidates(&whole, chunk);
            let one = yielder.price(&yielder.meeting(&whole, candidates));
            let other = yielder.price(&yielder.meeting(&sorted, candidates));
            for lane in 0..WIDTH {
                assert_eq!(one.lane(lane).to_bits(), other.lane(lane).to_bits());
            }
        }
    }
    assert!(kept > all / 10 && kept < 8 * all / 10, "{kept} of {all}");
}
