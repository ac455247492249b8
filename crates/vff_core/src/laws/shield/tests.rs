use super::*;

/// A row of the check values of plans.
struct Row {
    limits: [f64; 4],
    latency: f64,
    velocity: [f64; 2],
    wanted: [f64; 2],
    person: ([f64; 2], f64, f64, f64),
}

const ROWS: [Row; 3] = [
    Row {
        limits: [0.7, 10.0, 0.06, 0.3],
        latency: 0.0,
        velocity: [0.0, 0.0],
        wanted: [0.078_256, 0.2163],
        person: ([0.560_601, 0.553_135], 0.4, 0.0, 1.0),
    },
    Row {
        limits: [1.5, 10.0, 0.1, 0.2],
        latency: 0.1,
        velocity: [0.661_018, 0.561_128],
        wanted: [-0.558_781, 0.970_084],
        person: ([-0.700_91, 0.936_106], 0.3, 0.0, 2.0),
    },
    Row {
        limits: [1.0, 2.0, 0.05, 0.3],
        latency: 0.0,
        velocity: [0.639_862, 0.252_829],
        wanted: [0.087_349, 0.329_504],
        person: ([0.246_78, 0.777_323], 0.4, 0.0, 2.0),
    },
];

impl Row {
    fn guard(&self) -> Guard {
        let [max_speed, max_acceleration, period, radius] = self.limits;
        let limits = Limits {
            radius,
            max_speed,
            max_acceleration,
            period,
        };
        Guard::new(Shield::default(), limits).unwrap()
    }

    fn person(&self) -> Person {
        let (position, radius, position_error, max_speed) = self.person;
        Person {
            position_error,
            max_speed,
            latency: self.latency,
            ..Person::disc(position, radius)
        }
    }

    fn robot(&self) -> RobotState<f64> {
        RobotState {
            position: Vector2::zeros(),
            velocity: self.velocity.into(),
        }
    }
}

fn near(vector: Vector2<f64>, [x, y]: [f64; 2], within: f64) -> bool {
    (vector - Vector2::new(x, y)).norm() <= within
}

#[test]
fn plans_of_the_specification() {
    let clipped = [
        [0.078_256, 0.2163],
        [-0.287_114, 0.879_004],
        [0.540_811, 0.266_575],
    ];
    let gaps = [-0.049_887, -0.023_325, -0.776_913];
    let changes = [Some(0.219_028), Some(0.236_326), None];
    for (index, row) in ROWS.iter().enumerate() {
        let (guard, people) = (row.guard(), [row.person()]);
        let view = View {
            robot: row.robot(),
            people: &people,
            walls: Walls::NONE,
        };
        let reached = guard.clipped(&view.robot, row.wanted.into());
        assert!(near(reached, clipped[index], 1e-6));
        assert!((guard.gap(&view, reached) - gaps[index]).abs() < 2e-4);
        let decision = guard.decide(&view, row.wanted.into());
        let Some(change) = changes[index] else {
            assert_eq!(decision.status, Status::Braking);
            assert!(near(decision.velocity, [0.548_453, 0.216_711], 1e-6));
            continue;
        };
        assert_eq!(decision.status, Status::Changed);
        let found = (decision.velocity - reached).norm();
        assert!(
            (found - change).abs() < 0.01 * guard.limits.max_speed,
            "{index}: {found}"
        );
        assert!(guard.gap(&view, decision.velocity) > 0.0);
    }
}
