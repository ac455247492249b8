//! Pixels of points and their derivatives with respect to the parameters of a camera.

use crate::sensing::camera::{Camera, CameraPose, Lens, distorted_ratio};
use crate::sensing::rotation;
use nalgebra::{Matrix3, Vector3};
use numeric::error::Result;

/// Number of calibrated parameters: f, k, S, `C_x`, `C_y`, a turn (3), T (3).
pub const PARAMETERS: usize = 11;

/// A camera as a function of its calibrated parameters, in the order of [`PARAMETERS`]; the
/// rotation is `turn(w) R_0` with the rotation vector w in rad.
#[derive(Clone, Copy, Debug)]
pub struct LinearizedCamera {
    /// The camera with these parameters.
    pub camera: Camera,
    /// Left Jacobian of the turn.
    left_jacobian: Matrix3<f64>,
}

impl LinearizedCamera {
    /// The camera that differs from a base by parameters; pixel and picture size are the base's.
    ///
    /// # Errors
    /// The parameters make no camera.
    pub fn new(base: &Camera, parameters: &[f64; PARAMETERS]) -> Result<Self> {
        let [f, k, s, cx, cy, w1, w2, w3, t1, t2, t3] = *parameters;
        let lens = Lens {
            focal_length: f,
            radial_distortion: k,
            horizontal_scale: s,
            image_center: [cx, cy],
            ..*base.lens()
        };
        let vector = Vector3::new(w1, w2, w3);
        let pose = CameraPose {
            rotation: rotation::turn(&vector) * base.pose().rotation,
            translation: Vector3::new(t1, t2, t3),
        };
        Ok(Self {
            camera: Camera::new(lens, pose)?,
            left_jacobian: rotation::left_jacobian(&vector),
        })
    }

    /// Pixel of a point and its two rows of derivatives; none where [`Camera::project`] has none,
    /// and at the fold of the lens.
    #[must_use]
    pub fn at(&self, point: [f64; 3]) -> Option<([f64; 2], [[f64; PARAMETERS]; 2])> {
        let pixel = self.camera.project(point)?;
        let (lens, pose) = (self.camera.lens(), self.camera.pose());
        let turned = pose.rotation * Vector3::from(point);
        let [x, y, depth] = pose.in_camera(&point.into()).into();
        let slopes = [x / depth, y / depth];
        let [u, v] = slopes.map(|slope| lens.focal_length * slope);
        let square = u * u + v * v;
        let q = lens.radial_distortion * square;
        let ratio = distorted_ratio(q)?;
        let stiffness = 1.0 + 3.0 * q * ratio * ratio;
        if stiffness <= 0.0 {
            return None;
        }
        let ratio_slope = -ratio.powi(3) / stiffness;
        let scales = [
            lens.horizontal_scale / lens.pixel_size[0],
            1.0 / lens.pixel_size[1],
        ];
        let bend = 2.0 * lens.radial_distortion * ratio_slope;
        let mut rows = [[0.0; PARAMETERS]; 2];
        for (axis, row) in rows.iter_mut().enumerate() {
            let own = [u, v][axis];
            // Derivatives of the distorted coordinate with respect to u, v.
            let mut by_plane = [bend * own * u, bend * own * v];
            by_plane[axis] += ratio;
            row[0] = by_plane[0] * slopes[0] + by_plane[1] * slopes[1];
            row[1] = own * ratio_slope * square;
            let per_depth = lens.focal_length / depth;
            let by_point = Vector3::new(
                per_depth * by_plane[0],
                per_depth * by_plane[1],
                -per_depth * row[0],
            );
            // d x = w x (R X) to first order, so the gradient with respect to w is (R X) x g.
            let by_turn = turned.cross(&by_point);
            let by_vector = self.left_jacobian.tr_mul(&by_turn);
            row[5..8].copy_from_slice(by_vector.as_slice());
            row[8..11].copy_from_slice(by_point.as_slice());
            for entry in row.iter_mut() {
                *entry *= scales[axis];
            }
            row[3 + axis] = 1.0;
        }
        rows[0][2] = ratio * u / lens.pixel_size[0];
        Some((pixel, rows))
    }
}
