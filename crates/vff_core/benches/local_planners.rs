//! One decision of the laws that run on robots, among three people and two walls.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use vff_core::lanes::Vector2;
use vff_core::laws::LawFamily;
use vff_core::laws::dwb::DWB;
use vff_core::laws::dynamic_window::DynamicWindow;
use vff_core::laws::filters::Near;
use vff_core::laws::local_planning::{
    Gaps, LocalView, MovingShape, PeopleMotion, Pose, Steered, Walls, Way,
};
use vff_core::laws::path_integral::PathIntegral;
use vff_core::laws::pure_pursuit::RegulatedPurePursuit;
use vff_core::world::shape::PlacedShape;

const PEOPLE: [[f64; 4]; 3] = [
    [2.0, 0.5, -0.8, 0.0],
    [3.0, -0.8, -0.5, 0.3],
    [1.5, 1.2, 0.2, -0.5],
];
const WALLS: [[[f64; 2]; 2]; 2] = [[[-2.0, -1.5], [6.0, -1.5]], [[-2.0, 1.8], [6.0, 1.8]]];

fn measure(criterion: &mut Criterion, name: &str, law: &dyn LawFamily) {
    let people = PEOPLE.map(|[x, y, u, v]| Near {
        position: Vector2::new(x, y),
        velocity: Vector2::new(u, v),
        radius: 0.25,
    });
    let shapes = WALLS.map(|[from, to]| MovingShape {
        placed: PlacedShape::wall(from, to),
        velocity: Vector2::zeros(),
    });
    let gaps = Gaps {
        radius: 0.25,
        people: &people,
        walls: Walls {
            shapes: &shapes,
            map: None,
        },
    };
    let way = Way::new([[0.0, 0.0], [2.5, 0.3], [6.0, 0.0]].map(Vector2::from)).unwrap();
    let mut planner = law.twist_planner(1).unwrap();
    let mut along = 0.0;
    criterion.bench_function(name, |bencher| {
        bencher.iter(|| {
            along = (along + 0.001) % 0.05;
            planner.choose(black_box(&LocalView {
                pose: Pose {
                    position: Vector2::new(along, 0.0),
                    heading: 0.1,
                },
                twist: [0.3, 0.0, 0.1],
                local_goal: way.end(),
                way: &way,
                period: 0.1,
                max_speed: 1.0,
                gaps: &gaps,
            }))
        });
    });
}

fn dynamic_window(prediction: PeopleMotion) -> DynamicWindow {
    DynamicWindow {
        heading: 2.0,
        dist: 0.2,
        velocity: 0.2,
        acceleration: 1.0,
        braking: 1.0,
        turn_acceleration: 3.0,
        turn_braking: 3.0,
        max_turn_rate: 1.5,
        prediction,
    }
}

fn dwb() -> DWB {
    DWB {
        min_vel_x: 0.0,
        max_vel_x: 1.0,
        min_vel_y: 0.0,
        max_vel_y: 0.0,
        max_vel_theta: 1.0,
        min_speed_xy: 0.0,
        max_speed_xy: 1.0,
        min_speed_theta: 0.0,
        acc_lim_x: 2.5,
        acc_lim_y: 0.0,
        acc_lim_theta: 3.2,
        decel_lim_x: -2.5,
        decel_lim_y: 0.0,
        decel_lim_theta: -3.2,
        sim_time: 1.7,
        linear_granularity: 0.05,
        angular_granularity: 0.025,
        obstacle_scale: 0.02,
        path_dist_scale: 32.0,
        goal_dist_scale: 24.0,
        path_align_scale: 32.0,
        goal_align_scale: 24.0,
        forward_point_distance: 0.1,
        cost_scaling_factor: 3.0,
        inflation_radius: 0.55,
        vx_samples: 20,
        vy_samples: 5,
        vtheta_samples: 20,
        prediction: PeopleMotion::Static,
    }
}

fn pure_pursuit() -> RegulatedPurePursuit {
    RegulatedPurePursuit {
        desired_linear_vel: 0.5,
        lookahead_dist: 0.6,
        min_lookahead_dist: 0.3,
        max_lookahead_dist: 0.9,
        lookahead_time: 1.5,
        curvature_lookahead_dist: 0.6,
        rotate_to_heading_angular_vel: 1.8,
        rotate_to_heading_min_angle: 0.785,
        max_angular_accel: 3.2,
        min_approach_linear_velocity: 0.05,
        approach_velocity_scaling_dist: 0.6,
        regulated_linear_scaling_min_radius: 0.9,
        regulated_linear_scaling_min_speed: 0.25,
        cost_scaling_dist: 0.6,
        cost_scaling_gain: 1.0,
        inflation_radius: 0.55,
        max_allowed_time_to_collision_up_to_carrot: 1.0,
        use_velocity_scaled_lookahead_dist: false,
        use_fixed_curvature_lookahead: false,
        use_regulated_linear_velocity_scaling: true,
        use_cost_regulated_linear_velocity_scaling: true,
        use_rotate_to_heading: true,
        use_collision_detection: true,
        allow_reversing: false,
        prediction: PeopleMotion::Static,
    }
}

fn path_integral() -> PathIntegral {
    PathIntegral {
        vx_min: -0.35,
        vx_max: 0.5,
        vy_max: 0.0,
        wz_max: 1.9,
        ax_max: 3.0,
        ay_max: 3.0,
        az_max: 3.5,
        vx_std: 0.2,
        vy_std: 0.2,
        wz_std: 0.4,
        model_dt: 0.1,
        temperature: 0.3,
        gamma: 0.015,
        cost_weight: 3.81,
        goal_weight: 5.0,
        path_align_weight: 10.0,
        path_follow_weight: 5.0,
        path_angle_weight: 2.2,
        prefer_forward_weight: 5.0,
        cost_scaling_factor: 3.0,
        inflation_radius: 0.55,
        batch_size: 256,
        time_steps: 28,
        prediction: PeopleMotion::Static,
    }
}

fn local_planners(criterion: &mut Criterion) {
    let standing = dynamic_window(PeopleMotion::Static);
    let moving = dynamic_window(PeopleMotion::ConstantVelocity);
    measure(criterion, "dynamic_window/static", &Steered(standing));
    measure(criterion, "dynamic_window/moving", &Steered(moving));
    measure(criterion, "dwb/20x20", &Steered(dwb()));
    measure(criterion, "pure_pursuit", &Steered(pure_pursuit()));
    measure(criterion, "path_integral/256x28", &Steered(path_integral()));
}

criterion_group!(benches, local_planners);
criterion_main!(benches);
