//! The kernel: one pose of an arm, its mass matrix, and the mobility of points on it.

use nalgebra::allocator::Allocator;
use nalgebra::{
    Cholesky, DMatrix, DefaultAllocator, Dim, Dyn, Matrix3, OMatrix, Point3, U3, Vector3,
};
use numeric::error::{Failure, Given, Result};

use super::mobility::Mobility;
use super::model::{Arm, JointKind, Segment};

/// A pivot of the mass matrix below this share of its diagonal is rounding error.
const LEAST_PIVOT: f64 = 1e-12;

/// A moment of inertia below this share of the trace is rounding error.
const LEAST_MOMENT: f64 = 1e-13;

/// A segment in the world, and what it carries on it.
#[derive(Clone, Copy, Default)]
struct Frame {
    rotation: Matrix3<f64>,
    origin: Vector3<f64>,
    /// Axis of its joint.
    axis: Vector3<f64>,
    /// Mass, first moment and inertia about the origin of the segment and all that hangs on it.
    mass: f64,
    moment: Vector3<f64>,
    inertia: Matrix3<f64>,
}

/// One pose of an arm with as many free joints as the dimension says.
pub struct Pose<'a, D: Dim>
where
    DefaultAllocator: Allocator<D, D> + Allocator<D, U3>,
{
    arm: &'a Arm,
    size: D,
    frames: Vec<Frame>,
    /// Diagonal of the mass matrix.
    diagonal: Vec<f64>,
    factor: Option<Cholesky<f64, D>>,
}

/// Why a pose has no mass matrix that could be inverted.
pub struct Singular {
    /// Column of the mass matrix.
    pub column: usize,
}

impl<'a, D: Dim> Pose<'a, D>
where
    DefaultAllocator: Allocator<D, D> + Allocator<D, U3>,
{
    /// A pose that has not been set yet.
    pub fn new(arm: &'a Arm, size: D) -> Self {
        Self {
            arm,
            size,
            frames: vec![Frame::default(); arm.segments.len()],
            diagonal: vec![0.0; size.value()],
            factor: None,
        }
    }

    /// Moves the arm to values of its joints.
    ///
    /// # Errors
    /// The mass matrix is singular.
    pub fn set(&mut self, joints: &[f64]) -> std::result::Result<(), Singular> {
        self.place_segments(joints);
        self.gather();
        let masses = self.mass_matrix();
        for (column, whole) in self.diagonal.iter_mut().enumerate() {
            *whole = masses[(column, column)];
        }
        let Some(factor) = Cholesky::new(masses) else {
            self.factor = None;
            return Err(self.first_singular());
        };
        for (column, whole) in self.diagonal.iter().enumerate() {
            let root = factor.l_dirty()[(column, column)];
            if root * root <= LEAST_PIVOT * whole {
                return Err(Singular { column });
            }
        }
        self.factor = Some(factor);
        Ok(())
    }

    /// Rotations and origins of all segments from the base outwards.
    fn place_segments(&mut self, joints: &[f64]) {
        for index in 0..self.frames.len() {
            let segment = &self.arm.segments[index];
            let value = segment.multiplier * joints[segment.source] + segment.addend;
            let (mut rotation, mut origin) = match segment.parent {
                Some(parent) => {
                    let parent = &self.frames[parent];
                    let origin = parent.rotation * segment.offset + parent.origin;
                    (parent.rotation * segment.rotation, origin)
                }
                None => (segment.rotation, segment.offset),
            };
            let axis: Vector3<f64> = rotation.column(2).into();
            match segment.kind {
                JointKind::Turning => {
                    let (sine, cosine) = value.sin_cos();
                    let x: Vector3<f64> = rotation.column(0).into();
                    let y: Vector3<f64> = rotation.column(1).into();
                    rotation.set_column(0, &(x * cosine + y * sine));
                    rotation.set_column(1, &(y * cosine - x * sine));
                }
                JointKind::Sliding => origin += axis * value,
            }
            self.frames[index] = Frame {
                rotation,
                origin,
                axis,
                mass: segment.mass,
                moment: rotation * segment.moment,
                inertia: turned(&rotation, &segment.inertia),
            };
        }
    }

    /// Adds to every segment what hangs on it, from the ends inwards.
    fn gather(&mut self) {
        for index in (0..self.frames.len()).rev() {
            let Some(parent) = self.arm.segments[index].parent else {
                continue;
            };
            let outer = self.frames[index];
            let inner = &mut self.frames[parent];
            let away = outer.origin - inner.origin;
            // Moved from the origin of the outer segment to that of the inner one.
            let middle = outer.moment + away * (0.5 * outer.mass);
            let crossed = middle * away.transpose();
            let mut inertia = outer.inertia - crossed - crossed.transpose();
            let square = 2.0 * crossed.trace();
            for axis in 0..3 {
                inertia[(axis, axis)] += square;
            }
            inner.mass += outer.mass;
            inner.moment += outer.moment + away * outer.mass;
            inner.inertia += inertia;
        }
    }

    /// Joint-space mass matrix by the composite-rigid-body algorithm; joints that share a column
    /// because one mimics the other are folded: `G^T M G`.
    fn mass_matrix(&self) -> OMatrix<f64, D, D> {
        let mut masses = OMatrix::<f64, D, D>::zeros_generic(self.size, self.size);
        for (index, segment) in self.arm.segments.iter().enumerate() {
            let Some(column) = segment.column else {
                continue;
            };
            let frame = &self.frames[index];
            // Force, and moment about the origin, that accelerate all beyond the joint by one.
            let (force, mut moment) = match segment.kind {
                JointKind::Turning => (frame.axis.cross(&frame.moment), frame.inertia * frame.axis),
                JointKind::Sliding => (frame.axis * frame.mass, frame.moment.cross(&frame.axis)),
            };
            let own = component(segment, frame, &force, &moment) + segment.armature;
            masses[(column, column)] += segment.multiplier * segment.multiplier * own;
            let mut at = frame.origin;
            let mut next = segment.parent;
            while let Some(inner) = next {
                let (other, stands) = (&self.arm.segments[inner], &self.frames[inner]);
                moment += (at - stands.origin).cross(&force);
                at = stands.origin;
                next = other.parent;
                if let Some(row) = other.column {
                    let both = segment.multiplier * other.multiplier;
                    let coupled = both * component(other, stands, &force, &moment);
                    masses[(row, column)] += coupled;
                    masses[(column, row)] += coupled;
                }
            }
        }
        masses
    }

    /// The column at which the elimination fails, by elimination of ever more columns.
    fn first_singular(&self) -> Singular {
        let masses = self.mass_matrix();
        let size = masses.nrows();
        let lost = (1..=size).find(|count| {
            let part = DMatrix::from_fn(*count, *count, |row, column| masses[(row, column)]);
            part.cholesky().is_none()
        });
        Singular {
            column: lost.unwrap_or(size.max(1)) - 1,
        }
    }

    /// Where a point of a link stands in the world (m).
    #[must_use]
    pub fn position(&self, link: usize, point: &Vector3<f64>) -> Vector3<f64> {
        let link = &self.arm.links[link];
        let inside = (link.frame * Point3::from(*point)).coords;
        match link.segment {
            Some(segment) => {
                let frame = &self.frames[segment];
                frame.rotation * inside + frame.origin
            }
            None => inside,
        }
    }

    /// Calls with the column of each free joint that moves the link, and what it does to a point.
    fn each_column(
        &self,
        link: usize,
        position: &Vector3<f64>,
        mut call: impl FnMut(usize, Vector3<f64>),
    ) {
        let mut next = self.arm.links[link].segment;
        while let Some(index) = next {
            let segment = &self.arm.segments[index];
            next = segment.parent;
            if let Some(column) = segment.column {
                call(column, self.moved(index, position) * segment.multiplier);
            }
        }
    }

    /// Velocity of a point while one joint moves by one.
    fn moved(&self, index: usize, position: &Vector3<f64>) -> Vector3<f64> {
        let frame = &self.frames[index];
        match self.arm.segments[index].kind {
            JointKind::Turning => frame.axis.cross(&(position - frame.origin)),
            JointKind::Sliding => frame.axis,
        }
    }

    /// Mobility of a point of a link.
    #[must_use]
    pub fn mobility(&self, link: usize, point: &Vector3<f64>) -> Mobility {
        let Some(factor) = &self.factor else {
            return Mobility::default();
        };
        let position = self.position(link, point);
        let mut columns = OMatrix::<f64, D, U3>::zeros_generic(self.size, U3);
        self.each_column(link, &position, |column, moved| {
            for axis in 0..3 {
                columns[(column, axis)] += moved[axis];
            }
        });
        // L = J M^-1 J^T = (C^-1 J^T)^T (C^-1 J^T) with M = C C^T.
        factor.l_dirty().solve_lower_triangular_mut(&mut columns);
        Mobility(columns.tr_mul(&columns))
    }

    /// Velocity of a point of a link for rates of all joints that take values, locked ones too.
    #[must_use]
    pub fn velocity(&self, link: usize, point: &Vector3<f64>, rates: &[f64]) -> Vector3<f64> {
        let position = self.position(link, point);
        let mut velocity = Vector3::zeros();
        let mut next = self.arm.links[link].segment;
        while let Some(index) = next {
            let segment = &self.arm.segments[index];
            let rate = segment.multiplier * rates[segment.source];
            velocity += self.moved(index, &position) * rate;
            next = segment.parent;
        }
        velocity
    }
}

/// The part of a force and a moment that a joint feels.
fn component(segment: &Segment, frame: &Frame, force: &Vector3<f64>, moment: &Vector3<f64>) -> f64 {
    match segment.kind {
        JointKind::Turning => frame.axis.dot(moment),
        JointKind::Sliding => frame.axis.dot(force),
    }
}

/// `R I R^T`, symmetric.
fn turned(rotation: &Matrix3<f64>, inertia: &Matrix3<f64>) -> Matrix3<f64> {
    rotation * inertia * rotation.transpose()
}

/// Refuses an arm with a joint that moves no inertia in any pose.
///
/// # Errors
/// The mass matrix is singular; the error names a joint.
pub fn refuse_massless(arm: &Arm) -> Result<()> {
    let mut pose = Pose::new(arm, Dyn(arm.free));
    let mut lost = None;
    // Zero, and three poses without symmetry: an arm may be singular at some.
    for step in 0..4 {
        let values: Vec<f64> = (0..arm.joints.len())
            .map(|joint| f64::from(step) * (0.6 + 0.37 * joint as f64).sin())
            .collect();
        match pose.set(&values) {
            Ok(()) => {
                lost = pose.weightless();
                if lost.is_none() {
                    return Ok(());
                }
            }
            Err(Singular { column }) => lost = pose.weightless().or(Some(column)),
        }
    }
    match lost {
        Some(column) => Err(singular(arm, column, "")),
        None => Ok(()),
    }
}

impl<D: Dim> Pose<'_, D>
where
    DefaultAllocator: Allocator<D, D> + Allocator<D, U3>,
{
    /// The column of a joint about whose axis nothing but rounding error turns.
    fn weightless(&self) -> Option<usize> {
        let masses = self.mass_matrix();
        (0..masses.nrows()).find(|column| {
            let own = self.arm.segments.iter().zip(&self.frames);
            let scale: f64 = own
                .filter(|(segment, _)| segment.column == Some(*column))
                .map(|(segment, frame)| match segment.kind {
                    JointKind::Turning => frame.inertia.trace(),
                    JointKind::Sliding => frame.mass,
                })
                .sum();
            let moved = masses[(*column, *column)];
            moved <= LEAST_MOMENT * scale || moved <= 0.0 || moved.is_nan()
        })
    }
}

/// The error about a singular mass matrix.
#[must_use]
pub fn singular(arm: &Arm, column: usize, pose: &str) -> Failure {
    let joint = arm.joints.iter().find(|joint| joint.column == Some(column));
    let name = joint.map_or("", |joint| joint.name.as_str());
    let found = Given::Found(format!("a singular mass matrix{pose}").into());
    Failure::invalid(
        format!("joint {name:?}"),
        "move an inertia of its own",
        found,
    )
    .mended_by("give its links an inertia or the joint an armature, or lock it")
}
