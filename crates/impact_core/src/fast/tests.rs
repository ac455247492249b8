use super::*;
use crate::parameters::{Foam, HEAD_MINIMUM, MANIPULATOR_1, System, Target};
use pulp::Scalar;

#[test]
fn a_map_of_foams_has_the_usual_shape() {
    let nodes = 60;
    let mut refused = 0;
    let mut space = Workspace::new(Scalar, 0.0);
    for row in 0..nodes * nodes {
        let system = System {
            manipulator: MANIPULATOR_1,
            foam: Foam {
                stiffness: 10e3 + 50e3 * f64::from(row % nodes) / f64::from(nodes),
                damping: 200.0 * f64::from(row / nodes) / f64::from(nodes),
                thickness: 0.0254,
                linear_range: 0.02,
            },
            head: Target::Free(HEAD_MINIMUM),
        };
        let group = Group {
            plant: Plant::of(&system),
            closing_speed: 1.25,
            manipulator_speed: 1.25,
            horizon: 0.2,
            cell_angle: CELL_ANGLE,
            humps: true,
            searches: Searches::ALL,
        };
        let mut solved = group.solve::<_, true>(&mut space, true);
        let peaks = solved.peaks();
        let rest = solved.rest(&peaks);
        let all = [rest.injury, rest.held, peaks.powers];
        refused += i32::from(!all.iter().flatten().all(|known| known.holds));
    }
    // One in a hundred costs about as much as all the others.
    assert!(refused * 500 < nodes * nodes, "{refused}");
}
