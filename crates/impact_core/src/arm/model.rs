//! An arm that is ready for its kernel: bodies from the base outwards, each moved by one joint.

use nalgebra::{Isometry3, Matrix3, Vector3};
use numeric::error::{Failure, Given, Result};

use super::body::{Body, Symmetric};
use super::shape::Size;
use super::survey::Survey;

/// Type of a joint's motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointKind {
    /// About its axis; values in rad.
    Turning,
    /// Along its axis; values in m.
    Sliding,
}

/// A joint that takes a value of the caller.
#[derive(Clone, Debug)]
pub struct ArmJoint {
    /// Name.
    pub name: String,
    /// Type of its motion.
    pub kind: JointKind,
    /// Least and largest value, infinite without limits.
    pub limits: [f64; 2],
    /// Its column of the mass matrix; none if it is locked.
    pub column: Option<usize>,
}

/// A link and its place on the arm.
#[derive(Clone, Debug)]
pub struct Link {
    /// Name.
    pub name: String,
    /// The link before it; none for the root.
    pub parent: Option<usize>,
    /// The segment that it belongs to; none for what stands still.
    pub segment: Option<usize>,
    /// Pose in the frame of the segment, or in the world.
    pub frame: Isometry3<f64>,
    /// Mass (kg).
    pub mass: f64,
    /// Principal moments of the inertia that it is computed with, the least one first (kg m^2).
    pub moments: [f64; 3],
    /// Distance of its center of mass from its frame (m).
    pub off_center: f64,
    /// Whether the link has a shape.
    pub shaped: bool,
    /// Size of that shape, if it is of primitives.
    pub size: Option<Size>,
}

/// A moving link whose inertia no rigid body has, with the nearest one in its place.
#[derive(Clone, Debug)]
pub struct Projected {
    /// Name.
    pub link: String,
    /// By how much the inertia missed that of a body, as a share of its trace.
    pub violation: f64,
    /// Trace of the inertia before and after (kg m^2).
    pub traces: [f64; 2],
}

/// Links that a joint moves as one body. The axis of the joint is the z axis of its frame.
#[derive(Clone, Debug)]
pub struct Segment {
    /// Name of the joint.
    pub joint_name: String,
    /// The segment before it; none if that stands still.
    pub parent: Option<usize>,
    /// Rotation from its frame at zero to that of the parent.
    pub rotation: Matrix3<f64>,
    /// Its origin at zero in the frame of the parent (m).
    pub offset: Vector3<f64>,
    /// Type of motion of its joint.
    pub kind: JointKind,
    /// Whether the joint is one of a base: its value is a driven way and moves no link, as poses are relative to it.
    pub of_base: bool,
    /// The joint whose value it takes.
    pub source: usize,
    /// Factor of that value.
    pub multiplier: f64,
    /// Offset of that value.
    pub addend: f64,
    /// Limits of its own where it mimics another joint.
    pub own_limits: Option<[f64; 2]>,
    /// Column of the mass matrix; none if the joint is locked.
    pub column: Option<usize>,
    /// Mass (kg).
    pub mass: f64,
    /// First moment in its frame (kg m).
    pub moment: Vector3<f64>,
    /// Inertia about the origin in its frame (kg m^2).
    pub inertia: Symmetric,
    /// Reflected motor inertia.
    pub armature: f64,
}

/// An arm on a base that stands still.
#[derive(Clone, Debug)]
pub struct Arm {
    /// Name in the file.
    pub name: String,
    /// Joints that take values, in the order of the file.
    pub joints: Vec<ArmJoint>,
    /// Links in the order of the file.
    pub links: Vec<Link>,
    /// Bodies that joints move, from the base outwards.
    pub segments: Vec<Segment>,
    /// Joints that are not locked.
    pub free: usize,
    /// Mass of all links that some joint moves, locked or not, without payload (kg).
    pub moving_mass: f64,
    /// Mass of all links, moved or not, without payload (kg).
    pub total_mass: f64,
    /// Mass of the payload (kg).
    pub payload_mass: f64,
    /// Links whose radius of gyration is below 2 mm.
    pub suspicious: Vec<String>,
    /// Links that some joint moves and that have a shape, but no inertia.
    pub without_mass: Vec<String>,
    /// Whether some joint has a motor inertia.
    pub has_armature: bool,
    /// Moving links with another inertia than in the file.
    pub projected: Vec<Projected>,
    /// Links that stand still with an inertia that no rigid body has.
    pub not_used: Vec<String>,
    /// Attributes that URDF does not have and that change nothing.
    pub passed_over: Vec<String>,
    /// Joints and links that are turned by more than a turn.
    pub turned: Vec<String>,
    /// Signs that the arm may not be real.
    pub survey: Survey,
}

impl Arm {
    /// Mass of the robot by ISO/TS 15066: half of the moving mass, and the payload (kg).
    #[must_use]
    pub fn iso_mass(&self) -> f64 {
        0.5 * self.moving_mass + self.payload_mass
    }

    /// The link of a name.
    ///
    /// # Errors
    /// There is none.
    pub fn link(&self, name: &str) -> Result<usize> {
        let found = self.links.iter().position(|link| link.name == name);
        found.ok_or_else(|| {
            Failure::invalid(
                "link",
                "name a link of the arm",
                Given::Word(name.to_owned()),
            )
        })
    }
}

impl Segment {
    /// Adds a body in the frame of the segment.
    pub fn add(&mut self, body: &Body) {
        let Body {
            mass,
            center,
            inertia,
        } = body;
        self.mass += mass;
        self.moment += *mass * center;
        let away = Matrix3::identity() * center.norm_squared() - center * center.transpose();
        self.inertia.add(&Symmetric::of(&(inertia + away * *mass)));
    }
}

/// Calls with a size that the mass matrix fits into, known when the program is compiled. Few of them:
/// columns without a joint cost less than another copy of all code of a pose.
macro_rules! sized {
    ($arm:expr, $size:ident => $call:expr) => {
        match $arm.free {
            0..=4 => {
                const $size: usize = 4;
                $call
            }
            5..=6 => {
                const $size: usize = 6;
                $call
            }
            7 => {
                const $size: usize = 7;
                $call
            }
            8..=16 => {
                const $size: usize = 16;
                $call
            }
            17..=32 => {
                const $size: usize = 32;
                $call
            }
            _ => {
                const $size: usize = $crate::arm::model::MOST_MOVING;
                $call
            }
        }
    };
}

pub(crate) use sized;

/// Most joints that move: their mass matrix is kept whole.
pub const MOST_MOVING: usize = 96;
