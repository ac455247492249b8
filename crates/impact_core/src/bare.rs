//! Contact of a robot without a covering and a body region that is a linear spring: the two-body
//! model of ISO/TS 15066.
//!
//! `mu = 1/(1/m_R + 1/m_H)` and `F = v sqrt(mu k)`; a clamped region has an infinite body mass.

/// Reduced mass of robot and body (kg); either of them may be infinite.
#[must_use]
pub fn reduced_mass(robot: f64, body: f64) -> f64 {
    (robot.recip() + body.recip()).recip()
}

/// Peak force of a contact at a closing speed (N) on a region of a spring constant (N/m).
#[must_use]
pub fn peak_force(closing_speed: f64, reduced_mass: f64, stiffness: f64) -> f64 {
    // No speed, no impact: an unbounded mass at rest does not push.
    if closing_speed == 0.0 {
        return 0.0;
    }
    closing_speed * (reduced_mass * stiffness).sqrt()
}

#[cfg(test)]
mod tests {
    use super::{peak_force, reduced_mass};

    #[test]
    fn published_speed_of_a_hand_gives_its_force() {
        // 8.9 kg against a free hand of 0.6 kg and 75 N/mm: 140 N at 0.682 m/s.
        let mu = reduced_mass(8.9, 0.6);
        assert!((peak_force(0.68185, mu, 75e3) - 140.0).abs() < 0.01);
        assert_eq!(reduced_mass(8.9, f64::INFINITY), 8.9);
        assert_eq!(peak_force(0.0, f64::INFINITY, 75e3), 0.0);
        assert_eq!(peak_force(0.1, f64::INFINITY, 75e3), f64::INFINITY);
    }
}
