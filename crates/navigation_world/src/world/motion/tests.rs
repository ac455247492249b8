use super::*;

#[test]
fn stops_suddenly_where_it_was_told_to() {
    let walk = Motion::moving([0.6, 0.6], [1.0, 0.0], [0.0; 2], Some([4.0, 0.6])).unwrap();
    let mut cursor = 0;
    assert_eq!(walk.at(1.0, &mut cursor).position, [1.6, 0.6]);
    let late = walk.at(10.0, &mut cursor);
    assert_eq!((late.position, late.velocity), ([4.0, 0.6], [0.0, 0.0]));
    assert_eq!(walk.at(1.0, &mut cursor).velocity, [1.0, 0.0]);
    assert!((walk.stands_from() - 3.4).abs() < 1e-12);
    assert!(Motion::at_rest([0.0; 2]).stands_from() <= 0.0);
    let passing = Motion::moving([0.0; 2], [1.0, 0.0], [0.0; 2], None).unwrap();
    assert_eq!(passing.stands_from(), f64::INFINITY);
    assert!(Motion::moving([0.0; 2], [1.0, 0.0], [0.0; 2], Some([-1.0, 0.0])).is_err());
    assert!(Motion::moving([0.0; 2], [0.0, 0.0], [0.0; 2], Some([1.0, 0.0])).is_err());
}

#[test]
fn segments_follow_each_other_without_a_jump() {
    let still = [0.0; 2];
    let segments = [
        Segment {
            duration: 1.0,
            velocity: [1.0, 0.0],
            acceleration: still,
        },
        Segment {
            duration: 1.0,
            velocity: [1.0, 0.0],
            acceleration: [-1.0, 0.0],
        },
        Segment {
            duration: 1.0,
            velocity: still,
            acceleration: [0.0, 1.0],
        },
    ];
    let walk = Motion::piecewise([0.6, 0.0], &segments).unwrap();
    let mut cursor = 0;
    let end = walk.at(5.0, &mut cursor);
    assert_eq!((end.position, end.velocity), ([2.1, 2.5], [0.0, 1.0]));
}

#[test]
fn moves_between_two_instants_only() {
    let walk = Motion::between([1.0, 2.0], [0.5, -0.25], [2.0, 6.0]).unwrap();
    let mut cursor = 0;
    let at = |time, cursor: &mut usize| {
        let state = walk.at(time, cursor);
        (state.position, state.velocity)
    };
    assert_eq!(at(1.0, &mut cursor), ([1.0, 2.0], [0.0, 0.0]));
    assert_eq!(at(4.0, &mut cursor), ([2.0, 1.5], [0.5, -0.25]));
    assert_eq!(at(9.0, &mut cursor), ([3.0, 1.0], [0.0, 0.0]));
    assert_eq!(walk.first_move(), Some(([2.0, 6.0], [0.5, -0.25])));
    let endless = Motion::between([0.0; 2], [1.0, 0.0], [0.0, f64::INFINITY]).unwrap();
    assert_eq!(
        endless.first_move(),
        Some(([0.0, f64::INFINITY], [1.0, 0.0]))
    );
    let never = Motion::between([0.0; 2], [1.0, 0.0], [3.0, 3.0]).unwrap();
    assert!(never.is_stationary() && never.first_move().is_none());
    assert!(Motion::between([0.0; 2], [1.0, 0.0], [3.0, 2.0]).is_err());
    assert!(Motion::between([0.0; 2], [1.0, 0.0], [-1.0, 2.0]).is_err());
}

#[test]
fn a_recording_is_absent_outside_its_samples() {
    let walk = Motion::recorded(&[1.0, 2.0], &[[0.0, 0.0], [0.5, 0.0]]).unwrap();
    let mut cursor = 0;
    assert!(!walk.at(0.9, &mut cursor).present);
    let middle = walk.at(1.5, &mut cursor);
    assert_eq!(
        (middle.position, middle.velocity, middle.present),
        ([0.25, 0.0], [0.5, 0.0], true)
    );
    assert!(walk.at(2.0, &mut cursor).present && !walk.at(2.1, &mut cursor).present);
    assert!(Motion::recorded(&[1.0, 1.0], &[[0.0; 2]; 2]).is_err());
    assert!(Motion::recorded(&[], &[]).is_err());
}
