//! Obstacles: shape, motion and the radii of their regions.

use crate::error::{Failure, Given, Result, finite, finite_pair, not_negative, positive};
use crate::world::motion::Motion;

/// Outline of an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A disc; distances are measured from its centre.
    Disc {
        /// Radius in m.
        radius: f64,
    },
    /// A rectangle at rest; distances are measured from its contour.
    Rectangle {
        /// Half the side along the heading, in m.
        half_length: f64,
        /// Half the side across the heading, in m.
        half_width: f64,
        /// Unit vector of the heading.
        axis: [f64; 2],
    },
}

impl Shape {
    /// Part of the distance `d` that lies inside the obstacle (`rho_obs`), in m.
    #[must_use]
    pub fn inner_radius(&self) -> f64 {
        match self {
            Self::Disc { radius } => *radius,
            Self::Rectangle { .. } => 0.0,
        }
    }
}

/// Radii of the regions of an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Regions {
    /// `r_3` in m.
    pub critical_radius: f64,
    /// `r_2` in m.
    pub active_radius: f64,
}

/// Region radii and the speed they are sized for, as far as given.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// `r_2` in m.
    pub active_radius: Option<f64>,
    /// `r_3` in m.
    pub critical_radius: Option<f64>,
    /// Largest speed of the obstacle that the regions reckon with, in m/s.
    pub max_speed: Option<f64>,
}

impl Limits {
    fn checked(self) -> Result<Self> {
        if let Some(radius) = self.critical_radius {
            not_negative("critical_radius", radius)?;
        }
        if let Some(speed) = self.max_speed {
            not_negative("max_speed", speed)?;
        }
        if let Some(active) = self.active_radius {
            positive("active_radius", active)?;
            if self
                .critical_radius
                .is_some_and(|critical| active <= critical)
            {
                let rule = "be larger than critical_radius";
                return Err(Failure::invalid(
                    "active_radius",
                    rule,
                    Given::Number(active),
                ));
            }
        }
        Ok(self)
    }
}

/// Something in the robot's way.
#[derive(Clone, Debug, PartialEq)]
pub struct Obstacle {
    /// Outline.
    pub shape: Shape,
    /// Motion of the centre.
    pub motion: Motion,
    /// Region radii, as far as given.
    pub limits: Limits,
}

impl Obstacle {
    /// A disc with any motion.
    ///
    /// # Errors
    /// Names the value that is not allowed.
    pub fn disc(radius: f64, motion: Motion, limits: Limits) -> Result<Self> {
        let shape = Shape::Disc {
            radius: positive("radius", radius)?,
        };
        Ok(Self {
            shape,
            motion,
            limits: limits.checked()?,
        })
    }

    /// A disc at rest.
    ///
    /// # Errors
    /// Names the value that is not allowed.
    pub fn disc_at_rest(center: [f64; 2], radius: f64, limits: Limits) -> Result<Self> {
        Self::disc(
            radius,
            Motion::at_rest(finite_pair("center", center)?),
            limits,
        )
    }

    /// A rectangle at rest.
    ///
    /// # Errors
    /// Names the value that is not allowed.
    pub fn rectangle(
        center: [f64; 2],
        sides: [f64; 2],
        heading: f64,
        limits: Limits,
    ) -> Result<Self> {
        finite_pair("center", center)?;
        positive("length", sides[0])?;
        positive("width", sides[1])?;
        finite("heading", heading)?;
        if let Some(speed) = limits.max_speed.filter(|speed| *speed != 0.0) {
            let rule = "be absent or zero for a rectangle, which does not move";
            return Err(Failure::invalid("max_speed", rule, Given::Number(speed)));
        }
        let shape = Shape::Rectangle {
            half_length: 0.5 * sides[0],
            half_width: 0.5 * sides[1],
            axis: [heading.cos(), heading.sin()],
        };
        Ok(Self {
            shape,
            motion: Motion::at_rest(center),
            limits: limits.checked()?,
        })
    }

    /// Speed that the regions are sized for, in m/s.
    #[must_use]
    pub fn max_speed(&self) -> f64 {
        self.limits
            .max_speed
            .unwrap_or_else(|| self.motion.max_initial_speed())
    }

    /// Distance `d` from the centre of a disc or the contour of a rectangle to a point, in m.
    #[must_use]
    pub fn distance(&self, center: [f64; 2], point: [f64; 2]) -> f64 {
        let offset = [point[0] - center[0], point[1] - center[1]];
        match self.shape {
            Shape::Disc { .. } => (offset[0] * offset[0] + offset[1] * offset[1]).sqrt(),
            Shape::Rectangle {
                half_length,
                half_width,
                axis,
            } => {
                let along = offset[0] * axis[0] + offset[1] * axis[1];
                let across = offset[1] * axis[0] - offset[0] * axis[1];
                let beyond = [
                    along - along.clamp(-half_length, half_length),
                    across - across.clamp(-half_width, half_width),
                ];
                (beyond[0] * beyond[0] + beyond[1] * beyond[1]).sqrt()
            }
        }
    }
}
