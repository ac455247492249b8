//! Obstacles: shape, motion and the radii of their regions.

use nalgebra::Vector2;

use crate::world::motion::Motion;
pub use crate::world::shape::{PlacedShape, Shape};
use numeric::error::{Failure, Given, Result, finite, finite_pair, not_negative, positive};

/// Radii of the regions of an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Regions<B = f64> {
    /// `r_3` in m.
    pub critical_radius: B,
    /// `r_2` in m.
    pub active_radius: B,
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
    /// Any shape on a way of its own, without regions: what sensors see.
    ///
    /// # Errors
    /// Names the value that is not allowed.
    pub fn seen(placed: PlacedShape, motion: Motion) -> Result<Self> {
        Ok(Self {
            shape: placed.checked()?.shape,
            motion,
            limits: Limits::default(),
        })
    }

    /// Point of a scan or an echo: it may move at up to a speed in m/s.
    pub(crate) fn point(max_speed: f64) -> Self {
        Self {
            shape: Shape::Disc { radius: 0.0 },
            motion: Motion::at_rest([0.0; 2]),
            limits: Limits {
                max_speed: Some(max_speed),
                ..Limits::default()
            },
        }
    }

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
        Ok(Self {
            shape: Shape::turned(sides, heading),
            motion: Motion::at_rest(center),
            limits: limits.checked()?,
        })
    }

    /// A rectangle on a way of its own, which keeps its heading in rad.
    ///
    /// # Errors
    /// Names the value that is not allowed.
    pub fn moving_rectangle(
        sides: [f64; 2],
        heading: f64,
        motion: Motion,
        limits: Limits,
    ) -> Result<Self> {
        positive("length", sides[0])?;
        positive("width", sides[1])?;
        finite("heading", heading)?;
        Ok(Self {
            shape: Shape::turned(sides, heading),
            motion,
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

    /// Distance `d` from the center of a disc or the contour of a rectangle to a point, in m.
    #[must_use]
    pub fn distance(&self, center: [f64; 2], point: [f64; 2]) -> f64 {
        let offset = self
            .shape
            .offset(Vector2::from(point) - Vector2::from(center));
        offset.dot(&offset).sqrt()
    }

    /// The shape where it is at an instant. `cursor` is that of [`Motion::at`].
    #[inline]
    #[must_use]
    pub fn at(&self, time: f64, cursor: &mut usize) -> PlacedShape {
        PlacedShape {
            center: self.motion.at(time, cursor).position.into(),
            shape: self.shape,
        }
    }
}
