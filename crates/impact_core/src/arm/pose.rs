//! The kernel: one pose of an arm, its mass matrix, and the mobility of points on it.
//!
//! The matrix is eliminated here and not by the linear algebra library: `L D L^T` needs no roots, its
//! loops have a length that is known when the program is compiled, and a lost pivot shows at which
//! joint the matrix is singular.

use nalgebra::{Matrix3, Point3, SMatrix, SVector, Vector3};
use numeric::error::{Failure, Given, Result};

use super::body::Symmetric;
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
    inertia: Symmetric,
}

/// One pose of an arm with at most `N` free joints; columns without a joint are those of the unit
/// matrix.
pub struct Pose<'a, const N: usize> {
    arm: &'a Arm,
    frames: Vec<Frame>,
    /// The lower triangle of the mass matrix until it is eliminated, then `L` below the diagonal.
    masses: SMatrix<f64, N, N>,
    /// Reciprocals of `D`.
    pivots: SVector<f64, N>,
}

/// A pose with a singular mass matrix.
#[derive(Debug)]
pub struct Singular {
    /// Column of the mass matrix.
    pub column: usize,
}

impl<'a, const N: usize> Pose<'a, N> {
    /// A pose that has not been set yet.
    #[must_use]
    pub fn new(arm: &'a Arm) -> Self {
        Self {
            arm,
            frames: vec![Frame::default(); arm.segments.len()],
            masses: SMatrix::identity(),
            pivots: SVector::repeat(1.0),
        }
    }

    /// Moves the arm to values of its joints.
    ///
    /// # Errors
    /// The mass matrix is singular.
    pub fn set(&mut self, joints: &[f64]) -> std::result::Result<(), Singular> {
        self.place(joints);
        self.eliminate()
    }

    /// Moves the arm; of its mass matrix the lower triangle, row after row without zeros, and the force (N) or torque (N m)
    /// of its weight on each free joint, for an acceleration of gravity along -z.
    #[must_use]
    pub fn dynamics(&mut self, joints: &[f64], gravity: f64) -> [Vec<f64>; 2] {
        self.place(joints);
        let free = self.arm.free;
        let rows = (0..free).flat_map(|row| (0..=row).map(move |column| (row, column)));
        let masses = rows.map(|place| self.masses[place]).collect();
        let down = Vector3::new(0.0, 0.0, -gravity);
        let mut weights = vec![0.0; free];
        for (segment, frame) in self.arm.segments.iter().zip(&self.frames) {
            if let Some(column) = segment.column {
                let moment = frame.moment.cross(&down);
                let own = component(segment, frame, &(down * frame.mass), &moment);
                weights[column] += segment.multiplier * own;
            }
        }
        [masses, weights]
    }

    /// Moves the arm, without its mass matrix.
    fn place(&mut self, joints: &[f64]) {
        self.place_segments(joints);
        self.gather();
        self.fill();
    }

    /// Rotations and origins of all segments from the base outwards.
    fn place_segments(&mut self, joints: &[f64]) {
        for (index, segment) in self.arm.segments.iter().enumerate() {
            let value = if segment.of_base {
                0.0
            } else {
                segment.multiplier * joints[segment.source] + segment.addend
            };
            let (placed, rest) = self.frames.split_at_mut(index);
            let (mut rotation, mut origin) = match segment.parent {
                Some(parent) => {
                    let parent = &placed[parent];
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
            rest[0] = Frame {
                rotation,
                origin,
                axis,
                mass: segment.mass,
                moment: rotation * segment.moment,
                inertia: segment.inertia.turned(&rotation),
            };
        }
    }

    /// Adds to every segment what hangs on it, from the ends inwards.
    fn gather(&mut self) {
        for (index, segment) in self.arm.segments.iter().enumerate().rev() {
            let Some(parent) = segment.parent else {
                continue;
            };
            let (inner, rest) = self.frames.split_at_mut(index);
            let (inner, outer) = (&mut inner[parent], &rest[0]);
            let away = outer.origin - inner.origin;
            // Moved from the origin of the outer segment to that of the inner one.
            let middle = outer.moment + away * (0.5 * outer.mass);
            inner.inertia.add(&outer.inertia);
            inner.inertia.add(&Symmetric::moved(&middle, &away));
            inner.mass += outer.mass;
            inner.moment += outer.moment + away * outer.mass;
        }
    }

    /// Joint-space mass matrix by the composite-rigid-body algorithm; joints that share a column
    /// because one mimics the other are folded: `G^T M G`. The lower triangle is what is read.
    fn fill(&mut self) {
        self.masses.fill(0.0);
        for column in self.arm.free..N {
            self.masses[(column, column)] = 1.0;
        }
        for (segment, frame) in self.arm.segments.iter().zip(&self.frames) {
            let Some(column) = segment.column else {
                continue;
            };
            // Force, and moment about the origin, that accelerate all beyond the joint by one.
            let (force, mut moment) = match segment.kind {
                JointKind::Turning => (
                    frame.axis.cross(&frame.moment),
                    frame.inertia.times(&frame.axis),
                ),
                JointKind::Sliding => (frame.axis * frame.mass, frame.moment.cross(&frame.axis)),
            };
            let own = component(segment, frame, &force, &moment) + segment.armature;
            self.masses[(column, column)] += segment.multiplier * segment.multiplier * own;
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
                    // Both of the two equal entries, where one joint mimics the other.
                    let times = if row == column { 2.0 } else { 1.0 };
                    self.masses[(row.max(column), row.min(column))] += times * coupled;
                }
            }
        }
    }

    /// Eliminates the mass matrix in place: `M = L D L^T`.
    #[allow(clippy::needless_range_loop)] // as the indices of the matrices are written
    fn eliminate(&mut self) -> std::result::Result<(), Singular> {
        for column in 0..N {
            let whole = self.masses[(column, column)];
            let mut row = [0.0; N];
            let mut pivot = whole;
            for inner in 0..column {
                let value = self.masses[(column, inner)];
                row[inner] = value * self.pivots[inner];
                pivot -= value * row[inner];
                self.masses[(column, inner)] = row[inner];
            }
            if pivot.is_nan() || pivot <= LEAST_PIVOT * whole {
                return Err(Singular { column });
            }
            self.pivots[column] = pivot.recip();
            for below in column + 1..N {
                let mut value = self.masses[(below, column)];
                for inner in 0..column {
                    value -= self.masses[(below, inner)] * row[inner];
                }
                self.masses[(below, column)] = value;
            }
        }
        Ok(())
    }

    /// Position of a point of a link in the world (m).
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

    /// `L^-1 J^T` of a point by columns of joints, where the mass matrix is `L D L^T`.
    #[allow(clippy::needless_range_loop)] // as the indices of the matrices are written
    fn solved(&self, link: usize, point: &Vector3<f64>) -> [Vector3<f64>; N] {
        let position = self.position(link, point);
        let mut columns = [Vector3::zeros(); N];
        self.each_column(link, &position, |column, moved| columns[column] += moved);
        for column in 0..N {
            let mut solved = columns[column];
            for inner in 0..column {
                solved -= columns[inner] * self.masses[(column, inner)];
            }
            columns[column] = solved;
        }
        columns
    }

    /// Mobility of a point of a link: `L = J M^-1 J^T`.
    #[must_use]
    pub fn mobility(&self, link: usize, point: &Vector3<f64>) -> Mobility {
        let columns = self.solved(link, point);
        let mut mobility = Matrix3::zeros();
        for (solved, pivot) in columns.iter().zip(self.pivots.iter()) {
            mobility += solved * (solved * *pivot).transpose();
        }
        Mobility(mobility)
    }

    /// Columns of `A = J L^-T D^-1/2` of a point: its mobility is `A A^T`, its velocity `A w` with the [`Self::weights`]
    /// `w` of a motion.
    #[must_use]
    pub fn levers(&self, link: usize, point: &Vector3<f64>) -> [Vector3<f64>; N] {
        let mut columns = self.solved(link, point);
        for (column, pivot) in columns.iter_mut().zip(self.pivots.iter()) {
            *column *= pivot.sqrt();
        }
        columns
    }

    /// `w = D^1/2 L^T dq` of a motion: `w^T w` is twice its kinetic energy.
    #[must_use]
    pub fn weights(&self, rates: &[f64]) -> [f64; N] {
        let mut moved = [0.0; N];
        for (joint, rate) in self.arm.joints.iter().zip(rates) {
            if let Some(column) = joint.column {
                moved[column] = *rate;
            }
        }
        std::array::from_fn(|column| {
            let below = column + 1..N;
            let coupled: f64 = below
                .map(|row| self.masses[(row, column)] * moved[row])
                .sum();
            (moved[column] + coupled) / self.pivots[column].sqrt()
        })
    }

    /// Velocity of a point of a link for rates of all joints that take values, locked ones too.
    #[must_use]
    pub fn velocity(&self, link: usize, point: &Vector3<f64>, rates: &[f64]) -> Vector3<f64> {
        self.velocity_and_scale(link, point, rates).0
    }

    /// Velocity of a point, and the speed of which its rounding error is a share: the point may be on the axis.
    #[must_use]
    pub fn velocity_and_scale(
        &self,
        link: usize,
        point: &Vector3<f64>,
        rates: &[f64],
    ) -> (Vector3<f64>, f64) {
        let position = self.position(link, point);
        let (mut velocity, mut scale) = (Vector3::zeros(), 0.0);
        let mut next = self.arm.links[link].segment;
        while let Some(index) = next {
            let segment = &self.arm.segments[index];
            let rate = segment.multiplier * rates[segment.source];
            velocity += self.moved(index, &position) * rate;
            let reach = match segment.kind {
                JointKind::Turning => position.amax() + self.frames[index].origin.amax(),
                JointKind::Sliding => 1.0,
            };
            scale += reach * rate.abs();
            next = segment.parent;
        }
        (velocity, scale)
    }
}

/// The part of a force and a moment that a joint feels.
fn component(segment: &Segment, frame: &Frame, force: &Vector3<f64>, moment: &Vector3<f64>) -> f64 {
    match segment.kind {
        JointKind::Turning => frame.axis.dot(moment),
        JointKind::Sliding => frame.axis.dot(force),
    }
}

/// Poses in which the inertia that joints move is computed.
const SURVEYED: u32 = 64;

/// The largest inertia that each free joint of an arm moves without motors (kg m^2, or kg where it slides), over zero and
/// further poses between the limits; joints without limits take one turn, or 1 m, around 0.
#[must_use]
pub fn largest_own<const N: usize>(arm: &Arm) -> Vec<f64> {
    let mut bare = arm.clone();
    for segment in &mut bare.segments {
        segment.armature = 0.0;
    }
    let mut pose = Pose::<N>::new(&bare);
    let mut found = vec![0.0_f64; bare.free];
    for step in 0..SURVEYED {
        let values: Vec<f64> = bare
            .joints
            .iter()
            .zip(1_u32..)
            .map(|(joint, number)| {
                let reach = match joint.kind {
                    JointKind::Turning => std::f64::consts::PI,
                    JointKind::Sliding => 0.5,
                };
                let low = if joint.limits[0].is_finite() {
                    joint.limits[0]
                } else {
                    -reach
                };
                let high = if joint.limits[1].is_finite() {
                    joint.limits[1]
                } else {
                    reach
                };
                // Multiples of square roots spread evenly; the first pose is zero where limits allow it.
                let share = (f64::from(step) * f64::from(number + 1).sqrt()).fract();
                if step == 0 {
                    0.0_f64.max(low).min(high)
                } else {
                    low + share * (high - low)
                }
            })
            .collect();
        pose.place(&values);
        for (column, largest) in found.iter_mut().enumerate() {
            *largest = largest.max(pose.masses[(column, column)]);
        }
    }
    found
}

/// Refuses an arm with a joint that moves no inertia in any pose.
///
/// # Errors
/// The mass matrix is singular; the error names a joint.
pub fn refuse_massless<const N: usize>(arm: &Arm) -> Result<()> {
    let mut pose = Pose::<N>::new(arm);
    let mut lost = None;
    // Zero, and three poses without symmetry: an arm may be singular at some.
    for step in 0..4 {
        let values: Vec<f64> = (0..arm.joints.len())
            .map(|joint| f64::from(step) * (0.6 + 0.37 * joint as f64).sin())
            .collect();
        pose.place(&values);
        lost = pose.weightless();
        if lost.is_none() {
            lost = pose.eliminate().err().map(|Singular { column }| column);
        }
        if lost.is_none() {
            return Ok(());
        }
    }
    match lost {
        Some(column) => Err(singular(arm, column, "")),
        None => Ok(()),
    }
}

impl<const N: usize> Pose<'_, N> {
    /// The column of a joint about whose axis nothing but rounding error turns.
    fn weightless(&self) -> Option<usize> {
        (0..self.arm.free).find(|column| {
            let own = self.arm.segments.iter().zip(&self.frames);
            let scale: f64 = own
                .filter(|(segment, _)| segment.column == Some(*column))
                .map(|(segment, frame)| match segment.kind {
                    JointKind::Turning => frame.inertia.trace(),
                    JointKind::Sliding => frame.mass,
                })
                .sum();
            let moved = self.masses[(*column, *column)];
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
    .mended_by(
        "give its links the masses and inertias that they have, masses alone as link_masses, or lock it; an armature \
         alone leaves the arm without mass",
    )
}
