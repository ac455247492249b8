//! A pinhole camera with radial distortion, Tsai (1987).
//!
//! World to image: `x = R X + T`, `u = f (x_1, x_2) / x_3` (6.4.4 and Fig. D.6), `u = d (1 + k |d|^2)`,
//! pixel = `C + (S d_1 / s_x, d_2 / s_y)` (6.4.1). The thesis prints `u = d / (1 + k |d|)` in
//! (6.4.2): the radius has to be squared, and the factor stands on the other side in Tsai's model.
//! With it on the printed side the goal (0, 0.6) m would lie outside the picture.

use crate::sensing::rotation;
use nalgebra::{Matrix3, Vector3};
use numeric::error::{Failure, Given, Result, finite, finite_pair, positive};

/// Largest departure of `R R^T` from the identity.
const ORTHONORMAL: f64 = 1e-9;

/// Below this `k |u|^2` an undistorted point has no image: the distorted radius turns back.
const FOLD: f64 = -4.0 / 27.0;

/// Steps after which a bracket has no room left for a double number.
const MAX_STEPS: usize = 100;

/// Distortion between the pinhole and the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Focal length f in m.
    pub focal_length: f64,
    /// Radial distortion k in 1/m^2.
    pub radial_distortion: f64,
    /// Horizontal scale S.
    pub horizontal_scale: f64,
    /// Center of the distortion and of the projection (`C_x`, `C_y`) in pixels.
    pub image_center: [f64; 2],
    /// Width and height of a pixel in m.
    pub pixel_size: [f64; 2],
    /// Width and height of the picture in pixels.
    pub image_size: [u32; 2],
}

impl Lens {
    fn check(&self) -> Result<()> {
        positive("focal_length", self.focal_length)?;
        finite("radial_distortion", self.radial_distortion)?;
        positive("horizontal_scale", self.horizontal_scale)?;
        finite_pair("image_center_px", self.image_center)?;
        for size in self.pixel_size {
            positive("pixel_size", size)?;
        }
        for size in self.image_size {
            positive("image_size_px", f64::from(size))?;
        }
        Ok(())
    }

    /// Pixel of an undistorted point of the image plane in m, if it has one.
    fn pixel(&self, undistorted: [f64; 2]) -> Option<[f64; 2]> {
        let [u, v] = undistorted;
        let ratio = distorted_ratio(self.radial_distortion * (u * u + v * v))?;
        Some([
            self.image_center[0] + self.horizontal_scale * ratio * u / self.pixel_size[0],
            self.image_center[1] + ratio * v / self.pixel_size[1],
        ])
    }

    /// Undistorted point of the image plane in m of a pixel; the inverse of [`Self::pixel`].
    fn undistorted(&self, pixel: [f64; 2]) -> Option<[f64; 2]> {
        let x = (pixel[0] - self.image_center[0]) * self.pixel_size[0] / self.horizontal_scale;
        let y = (pixel[1] - self.image_center[1]) * self.pixel_size[1];
        let bend = self.radial_distortion * (x * x + y * y);
        // Beyond 1 + 3 k |d|^2 = 0 the pixel is the image of no point.
        (1.0 + 3.0 * bend > 0.0).then_some([x * (1.0 + bend), y * (1.0 + bend)])
    }
}

/// Where the camera is: `x = R X + T` from the world to the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraPose {
    /// Rotation R.
    pub rotation: Matrix3<f64>,
    /// Translation T in m.
    pub translation: Vector3<f64>,
}

impl CameraPose {
    /// A pose whose rotation is given by its rows.
    #[must_use]
    pub fn from_rows(rotation: [[f64; 3]; 3], translation: [f64; 3]) -> Self {
        Self {
            // Columns are what nalgebra takes.
            rotation: Matrix3::from(rotation).transpose(),
            translation: translation.into(),
        }
    }

    /// The rows of the rotation.
    #[must_use]
    pub fn rotation_rows(&self) -> [[f64; 3]; 3] {
        self.rotation.transpose().into()
    }

    fn check(&self) -> Result<()> {
        for entry in &self.rotation {
            finite("rotation", *entry)?;
        }
        for entry in &self.translation {
            finite("translation", *entry)?;
        }
        let departure = rotation::departure(&self.rotation);
        if departure > ORTHONORMAL {
            return Err(Failure::invalid(
                "rotation",
                "be a rotation matrix, to 1e-9 (nearest_rotation makes one of rounded numbers)",
                Given::Number(departure),
            ));
        }
        Ok(())
    }

    /// Coordinates of a point of the world in the camera, in m.
    #[must_use]
    pub fn in_camera(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.rotation * point + self.translation
    }

    /// Position of the camera `-R^T T` in the world, in m.
    #[must_use]
    pub fn position(&self) -> Vector3<f64> {
        -self.rotation.tr_mul(&self.translation)
    }
}

/// A camera that stands still.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    lens: Lens,
    pose: CameraPose,
}

impl Camera {
    /// A camera.
    ///
    /// # Errors
    /// A value is not finite or not positive where it must be, or the rotation is not one.
    pub fn new(lens: Lens, pose: CameraPose) -> Result<Self> {
        lens.check()?;
        pose.check()?;
        Ok(Self { lens, pose })
    }

    /// The lens and the picture.
    #[must_use]
    pub fn lens(&self) -> &Lens {
        &self.lens
    }

    /// Where the camera is.
    #[must_use]
    pub fn pose(&self) -> &CameraPose {
        &self.pose
    }

    /// Pixel of a point of the world in m; none behind the camera or beyond what the lens maps.
    #[must_use]
    pub fn project(&self, point: [f64; 3]) -> Option<[f64; 2]> {
        let [x, y, depth] = self.pose.in_camera(&point.into()).into();
        if depth <= 0.0 {
            return None;
        }
        let scale = self.lens.focal_length / depth;
        self.lens.pixel([scale * x, scale * y])
    }

    /// Whether a pixel lies in the picture; the center of the first one is (0, 0).
    #[must_use]
    pub fn contains(&self, pixel: [f64; 2]) -> bool {
        let inside = |value: f64, size: u32| value >= -0.5 && value < f64::from(size) - 0.5;
        inside(pixel[0], self.lens.image_size[0]) && inside(pixel[1], self.lens.image_size[1])
    }

    /// Point of the world at a known height in m that a pixel shows: its ray meets the plane.
    /// None if the ray is parallel to the plane or meets it behind the camera.
    #[must_use]
    pub fn reconstruct(&self, pixel: [f64; 2], height: f64) -> Option<[f64; 3]> {
        let [u, v] = self.lens.undistorted(pixel)?;
        let ray = Vector3::new(u, v, self.lens.focal_length);
        let (ray, from) = (self.pose.rotation.tr_mul(&ray), self.pose.position());
        let along = (height - from.z) / ray.z;
        let shown = [from.x + along * ray.x, from.y + along * ray.y, height];
        (along.is_finite() && along > 0.0).then_some(shown)
    }
}

/// Ratio s of distorted to undistorted radius: `s + q s^3 = 1` with `q = k |u|^2`; none where the
/// lens maps nothing. Newton steps inside a bracket.
#[must_use]
pub fn distorted_ratio(q: f64) -> Option<f64> {
    if !q.is_finite() || q < FOLD {
        return None;
    }
    let (mut low, mut high) = if q >= 0.0 { (0.0, 1.0) } else { (1.0, 1.5) };
    let mut ratio = 1.0;
    for _ in 0..MAX_STEPS {
        let excess = ratio * (1.0 + q * ratio * ratio) - 1.0;
        if excess == 0.0 {
            return Some(ratio);
        }
        if excess > 0.0 {
            high = ratio;
        } else {
            low = ratio;
        }
        let newton = ratio - excess / (1.0 + 3.0 * q * ratio * ratio);
        let next = if newton > low && newton < high {
            newton
        } else {
            0.5 * (low + high)
        };
        if (next - ratio).abs() <= f64::EPSILON * ratio || next == low || next == high {
            return Some(next);
        }
        ratio = next;
    }
    Some(ratio)
}
