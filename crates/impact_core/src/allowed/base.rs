//! Effective mass of a mobile base along a horizontal direction at one of its points.

use crate::error::{Failure, Given, Result, finite_pair, not_negative, positive};

/// Shares of the largest inverse mass below this are none: the base cannot move so.
const NONE: f64 = 1e-9;

/// Length of a direction.
fn unit([x, y]: [f64; 2]) -> Result<[f64; 2]> {
    finite_pair("direction", [x, y])?;
    let length = x.hypot(y);
    if length > 0.0 {
        return Ok([x / length, y / length]);
    }
    let rule = "not be zero";
    Err(Failure::invalid("direction", rule, Given::Pair([x, y])))
}

/// `1/m_u = 1/M + (x u_y - y u_x)^2/I` of a base that is free to move any way, about its center of mass.
///
/// # Errors
/// A number is not positive, or the direction zero.
pub fn holonomic_mass(
    mass: f64,
    inertia: f64,
    point: [f64; 2],
    direction: [f64; 2],
) -> Result<f64> {
    positive("mass", mass)?;
    positive("inertia", inertia)?;
    let [x, y] = finite_pair("point", point)?;
    let [ux, uy] = unit(direction)?;
    let arm = x * uy - y * ux;
    felt(point, 1.0 / (1.0 / mass + arm * arm / inertia))
}

/// A mass, unless the point is so far away that none is left.
fn felt(point: [f64; 2], mass: f64) -> Result<f64> {
    if mass > 0.0 {
        return Ok(mass);
    }
    let rule = "be near enough to the base for a mass above 0";
    Err(Failure::invalid("point", rule, Given::Pair(point)))
}

/// Wheels and balance of a differential drive.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Drive {
    /// Center of mass ahead of the axle, in m.
    pub offset: f64,
    /// Inertia of each wheel with its motor, in kg m^2.
    pub wheel_inertia: f64,
    /// Radius of the wheels, in m.
    pub wheel_radius: f64,
    /// Half of the track, in m.
    pub half_track: f64,
}

/// Effective mass of a differential drive that does not slip, about the middle of its axle; infinite
/// where it cannot move, sideways at its axle. The inertia is about the center of mass.
///
/// # Errors
/// A number is out of its range, or the direction zero.
pub fn differential_mass(
    mass: f64,
    inertia: f64,
    drive: Drive,
    point: [f64; 2],
    direction: [f64; 2],
) -> Result<f64> {
    positive("mass", mass)?;
    positive("inertia", inertia)?;
    crate::error::finite("offset", drive.offset)?;
    not_negative("wheel_inertia", drive.wheel_inertia)?;
    let mut moving = mass;
    let mut turning = inertia + mass * drive.offset * drive.offset;
    if drive.wheel_inertia > 0.0 {
        let radius = positive("wheel_radius", drive.wheel_radius)?;
        let half = positive("half_track", drive.half_track)?;
        let wheels = 2.0 * drive.wheel_inertia / (radius * radius);
        moving += wheels;
        turning += wheels * half * half;
    }
    let [x, y] = finite_pair("point", point)?;
    let [ux, uy] = unit(direction)?;
    let arm = x * uy - y * ux;
    let inverse = ux * ux / moving + arm * arm / turning;
    let largest = 1.0 / moving + (x * x + y * y) / turning;
    // Where the place is too far away for numbers, nothing says that the base cannot give way.
    if largest.is_finite() && inverse <= NONE * largest {
        return Ok(f64::INFINITY);
    }
    felt(point, 1.0 / inverse)
}
