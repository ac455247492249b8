use super::*;

fn model() -> DropModel {
    DropModel {
        mass: 1.54,
        stiffness: 24_250.0,
        damping_ratio: 0.112,
        friction: 2.0,
        height: 0.045,
        gravity: 9.80665,
        contact: DropContact::Unilateral,
    }
}

fn times(count: u32) -> Vec<f64> {
    (0..count).map(|k| f64::from(k) * 1e-3).collect()
}

/// Slide by small steps of the equation of motion, with the sign of the speed.
fn stepped(model: &DropModel, count: usize) -> Vec<f64> {
    let parts = 4000;
    let step = 1e-3 / f64::from(parts);
    let damping = 2.0 * model.damping_ratio * (model.mass * model.stiffness).sqrt();
    let (mut position, mut velocity, mut surface) = (model.height, 0.0_f64, 0.0_f64);
    let mut result = vec![position];
    while result.len() < count {
        for _ in 0..parts {
            let force = -model.stiffness * position - damping * velocity;
            let touching = match model.contact {
                DropContact::Unilateral => position <= surface && force > 0.0,
                DropContact::Attached => position < 0.0,
            };
            let push = if touching { force } else { 0.0 };
            let drive = push - model.mass * model.gravity;
            let friction = if velocity.abs() < 1e-6 && drive.abs() <= model.friction {
                velocity = 0.0;
                drive
            } else {
                model.friction * velocity.signum()
            };
            velocity += step * (drive - friction) / model.mass;
            position += step * velocity;
            surface = if touching {
                position
            } else {
                surface * (1.0 - step * model.stiffness / damping)
            };
        }
        result.push(position);
    }
    result
}

#[test]
fn free_fall_is_a_parabola() {
    let fall = drop_trajectory(&times(80), &model(), &|| false).unwrap();
    for (time, position) in times(80).iter().zip(fall) {
        let expected = 0.045 - 0.5 * (9.80665 - 2.0 / 1.54) * time * time;
        assert!((position - expected).abs() < 1e-15);
    }
}

#[test]
fn closed_forms_follow_the_equation_of_motion() {
    for contact in [DropContact::Unilateral, DropContact::Attached] {
        for damping_ratio in [0.02, 0.112, 0.6, 1.4] {
            let model = DropModel {
                damping_ratio,
                contact,
                ..model()
            };
            let exact = drop_trajectory(&times(400), &model, &|| false).unwrap();
            let steps = stepped(&model, 400);
            for (k, (exact, stepped)) in exact.iter().zip(&steps).enumerate() {
                // First-order steps of 0.25 us.
                assert!(
                    (exact - stepped).abs() < 2e-6,
                    "{model:?} {k} {exact} {stepped}"
                );
            }
        }
    }
}

#[test]
fn without_loss_every_bounce_returns_to_its_height() {
    let model = DropModel {
        damping_ratio: 0.0,
        friction: 0.0,
        ..model()
    };
    let fine: Vec<f64> = (0..200_000).map(|k| f64::from(k) * 1e-5).collect();
    let path = drop_trajectory(&fine, &model, &|| false).unwrap();
    let late = path[100_000..].iter().fold(0.0_f64, |high, y| high.max(*y));
    assert!((late - model.height).abs() < 1e-9, "{late}");
}

#[test]
fn friction_holds_the_slide_at_the_end() {
    let path = drop_trajectory(&[0.0, 0.01, 30.0, 31.0], &model(), &|| false).unwrap();
    assert_eq!(path[2], path[3]);
    assert!((24_250.0 * path[3] + 1.54 * 9.80665).abs() <= 2.0);
    let stuck = DropModel {
        friction: 20.0,
        ..model()
    };
    assert_eq!(
        drop_trajectory(&[0.0, 5.0], &stuck, &|| false),
        Ok(vec![0.045; 2])
    );
}
