//! Makes an arm of what a URDF says and of what it does not hold.

use nalgebra::{Isometry3, Matrix3, Rotation3, Vector3};
use numeric::error::{Failure, Given, Result, not_negative};

use super::body::{Body, LEAST_GYRATION, ROUNDING, Symmetric};
use super::description::{Description, JointType, LinkText, about};
use super::model::{Arm, ArmJoint, JointKind, Link, MOST_MOVING, Projected, Segment, sized};
use super::pose;
use super::sources::{BASE_JOINTS, Base};
use super::survey::Survey;
use super::tree::Tree;

/// Up to this share of its trace an inertia that no rigid body has is replaced by the nearest one unasked.
const MOST_VIOLATION: f64 = 0.1;

/// Below this share of the moving mass the inertia of a link hardly counts.
const SMALL_SHARE: f64 = 0.01;

/// Something that a link carries.
#[derive(Clone, Debug)]
pub struct Payload {
    /// The link.
    pub link: String,
    /// Mass, center of mass in the frame of the link, inertia about it along its axes.
    pub body: Body,
}

/// Data of an arm that a URDF does not hold.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Payloads of the arm.
    pub payloads: Vec<Payload>,
    /// Reflected motor inertia `n^2 J_m` by joint (kg m^2, or kg where the joint slides).
    pub armature: Vec<(String, f64)>,
    /// Joints that keep their value.
    pub locked: Vec<String>,
    /// Whether any inertia that no rigid body has is replaced by the nearest one.
    pub repair_inertia: bool,
    /// Masses of links whose inertial has none (kg).
    pub link_masses: Vec<(String, f64)>,
    /// Mass of all links that theirs are scaled to (kg).
    pub scaled_to: Option<f64>,
    /// Base that the root rolls on.
    pub base: Option<Base>,
}

/// Names of the joints of a URDF that take values, in the order of the file.
///
/// # Errors
/// It is no URDF, or its links do not form a tree.
pub fn joint_names(text: &str) -> Result<Vec<String>> {
    let description = Description::read(text)?;
    let tree = Tree::of(&description)?;
    let own = description.joints.into_iter().enumerate();
    Ok(own
        .filter(|(index, joint)| joint.kind != JointType::Fixed && tree.source[*index].0 == *index)
        .map(|(_, joint)| joint.name)
        .collect())
}

impl Arm {
    /// Makes an arm of what a URDF says.
    ///
    /// # Errors
    /// An element of the URDF or an option breaks a rule, which the error names.
    pub fn from_urdf(text: &str, options: &Options) -> Result<Self> {
        let mut description = Description::read(text)?;
        description.give_masses(&options.link_masses)?;
        if let Some(plate) = options.scaled_to {
            description.scale_to(plate)?;
        }
        if let Some(base) = &options.base {
            description.put_on(base)?;
        }
        let tree = Tree::of(&description)?;
        let mut builder = Builder::new(&description, &tree, options)?;
        builder.hang()?;
        let mut arm = builder.finish()?;
        arm.survey.largest_own = sized!(arm, SIZE => pose::largest_own::<SIZE>(&arm));
        arm.load(&options.payloads)?;
        sized!(arm, SIZE => pose::refuse_massless::<SIZE>(&arm))?;
        Ok(arm)
    }

    /// Adds what the arm carries.
    fn load(&mut self, payloads: &[Payload]) -> Result<()> {
        for (index, payload) in payloads.iter().enumerate() {
            let owner = if payloads.len() == 1 {
                "payload".to_owned()
            } else {
                format!("payload[{index}]")
            };
            let link = self
                .link(&payload.link)
                .map_err(|failure| failure.within(&owner))?;
            let link = &self.links[link];
            let body = payload
                .body
                .checked()
                .map_err(|failure| failure.within(&owner))?;
            let Some(segment) = link.segment else {
                let rule = "name a link that a joint moves";
                let given = Given::Word(payload.link.clone());
                return Err(Failure::invalid("link", rule, given).within(&owner));
            };
            self.segments[segment].add(&body.placed(&link.frame));
            self.payload_mass += body.mass;
        }
        Ok(())
    }
}

/// An arm while it is made.
struct Builder<'a> {
    description: &'a Description,
    tree: &'a Tree,
    options: &'a Options,
    /// Index among the joints that take values, by joint of the file.
    value: Vec<Option<usize>>,
    joints: Vec<ArmJoint>,
    segments: Vec<Segment>,
    /// Segment of each link, and its pose there.
    places: Vec<(Option<usize>, Isometry3<f64>)>,
}

impl<'a> Builder<'a> {
    fn new(description: &'a Description, tree: &'a Tree, options: &'a Options) -> Result<Self> {
        let all = &description.joints;
        let moving = all
            .iter()
            .filter(|joint| joint.kind != JointType::Fixed)
            .count();
        numeric::error::at_most("number of joints that move", moving, MOST_MOVING)?;
        known("locked", &options.locked.iter(), description)?;
        let motors = options.armature.iter().map(|(name, _)| name);
        known("armature", &motors, description)?;
        let mut value = vec![None; all.len()];
        let mut joints = Vec::new();
        let mut free = 0;
        for (index, joint) in all.iter().enumerate() {
            let kind = match joint.kind {
                JointType::Fixed => continue,
                _ if tree.source[index].0 != index => continue,
                JointType::Turning => JointKind::Turning,
                JointType::Sliding => JointKind::Sliding,
            };
            let locked = options.locked.contains(&joint.name);
            value[index] = Some(joints.len());
            joints.push(ArmJoint {
                name: joint.name.clone(),
                kind,
                limits: joint.limits.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]),
                column: (!locked).then_some(free),
            });
            free += usize::from(!locked);
        }
        Ok(Self {
            description,
            tree,
            options,
            value,
            joints,
            segments: Vec::new(),
            places: vec![(None, Isometry3::identity()); description.links.len()],
        })
    }

    /// Hangs every link on its segment.
    fn hang(&mut self) -> Result<()> {
        for &index in &self.tree.order {
            let joint = &self.description.joints[index];
            let (parent, frame) = self.places[self.tree.parent[index]];
            let stands = frame * joint.origin;
            self.places[self.tree.child[index]] = match joint.kind {
                JointType::Fixed => (parent, stands),
                JointType::Turning => self.segment(index, parent, &stands, JointKind::Turning)?,
                JointType::Sliding => self.segment(index, parent, &stands, JointKind::Sliding)?,
            };
        }
        Ok(())
    }

    /// Adds a segment, and returns where the link behind its joint hangs.
    fn segment(
        &mut self,
        index: usize,
        parent: Option<usize>,
        stands: &Isometry3<f64>,
        kind: JointKind,
    ) -> Result<(Option<usize>, Isometry3<f64>)> {
        let joint = &self.description.joints[index];
        let (source, multiplier, addend) = self.tree.source[index];
        let Some(value) = self.value[source] else {
            let given = Given::Word(joint.name.clone());
            return Err(Failure::invalid("joint", "have a value", given));
        };
        let upright = upright(&joint.axis);
        let turned = stands.rotation.to_rotation_matrix() * upright;
        let armature = self
            .options
            .armature
            .iter()
            .filter(|(name, _)| *name == joint.name);
        let mut total = 0.0;
        for (name, given) in armature {
            total += not_negative(&format!("armature[{name:?}]"), *given)?;
        }
        self.segments.push(Segment {
            joint_name: joint.name.clone(),
            parent,
            rotation: turned.into_inner(),
            offset: stands.translation.vector,
            kind,
            of_base: self.options.base.is_some() && BASE_JOINTS.contains(&joint.name.as_str()),
            source: value,
            multiplier,
            addend,
            own_limits: joint.limits.filter(|_| source != index),
            column: self.joints[value].column,
            mass: 0.0,
            moment: Vector3::zeros(),
            inertia: Symmetric::default(),
            armature: total,
        });
        let frame = Isometry3::from_parts(Vector3::zeros().into(), upright.inverse().into());
        Ok((Some(self.segments.len() - 1), frame))
    }

    /// Puts the inertias of the links where they hang.
    fn finish(mut self) -> Result<Arm> {
        let (mut suspicious, mut without_mass) = (Vec::new(), Vec::new());
        let (mut projected, mut not_used) = (Vec::new(), Vec::new());
        let texts = &self.description.links;
        let sum = |chosen: &dyn Fn(usize) -> bool| -> f64 {
            let all = texts.iter().enumerate();
            all.filter(|(index, _)| chosen(*index))
                .fold(0.0, |sum, (_, text)| sum + text.body.mass)
        };
        let moving_mass = sum(&|index| self.places[index].0.is_some());
        let total_mass = sum(&|_| true);
        numeric::error::finite("mass of all links", total_mass)?;
        let mut bodies = Vec::with_capacity(texts.len());
        for (text, (segment, frame)) in texts.iter().zip(&self.places) {
            let Some(segment) = segment else {
                if text.body.violation() > ROUNDING {
                    not_used.push(text.name.clone());
                }
                bodies.push(text.body);
                continue;
            };
            let body = self.possible(text, moving_mass, &mut projected)?;
            self.segments[*segment].add(&body.placed(frame));
            if body
                .gyration()
                .is_some_and(|radius| radius < LEAST_GYRATION)
            {
                suspicious.push(text.name.clone());
            }
            // An `inertial` of no mass is as good as none.
            if text.shaped && body.mass == 0.0 {
                without_mass.push(text.name.clone());
            }
            bodies.push(body);
        }
        let mut parents = vec![None; texts.len()];
        for (child, parent) in self.tree.child.iter().zip(&self.tree.parent) {
            parents[*child] = Some(*parent);
        }
        let links: Vec<Link> = (0..texts.len())
            .map(|index| Link {
                name: texts[index].name.clone(),
                parent: parents[index],
                segment: self.places[index].0,
                frame: self.places[index].1,
                mass: bodies[index].mass,
                moments: bodies[index].principal_moments(),
                off_center: bodies[index].center.norm(),
                shaped: texts[index].shaped,
                size: texts[index].size,
            })
            .collect();
        let survey = Survey::of(&self.segments, &self.joints, &links, &bodies);
        let free = self.joints.iter().filter(|joint| joint.column.is_some());
        Ok(Arm {
            name: self.description.name.clone(),
            free: free.count(),
            joints: self.joints,
            links,
            segments: self.segments,
            moving_mass,
            total_mass,
            payload_mass: 0.0,
            suspicious,
            without_mass,
            has_armature: self.options.armature.iter().any(|(_, value)| *value > 0.0),
            projected,
            not_used,
            passed_over: self.description.passed_over.clone(),
            turned: self.description.turned.clone(),
            survey,
        })
    }

    /// The body of a moving link, with the nearest inertia that a rigid body can have where that is a small change,
    /// or was asked for.
    fn possible(
        &self,
        text: &LinkText,
        moving_mass: f64,
        projected: &mut Vec<Projected>,
    ) -> Result<Body> {
        let violation = text.body.violation();
        if violation <= ROUNDING {
            return Ok(text.body);
        }
        let small = text.body.mass < SMALL_SHARE * moving_mass;
        if !(violation <= MOST_VIOLATION || small || self.options.repair_inertia) {
            let failure = about(text.body.no_rigid_body(), &text.name);
            return Err(failure.mended_by(format!(
                "it is {:.0} % of its trace off: correct it, or give repair_inertia = true for the nearest inertia \
                 that a body can have",
                100.0 * violation
            )));
        }
        let body = text.body.nearest();
        projected.push(Projected {
            link: text.name.clone(),
            violation,
            traces: [text.body.inertia.trace(), body.inertia.trace()],
        });
        Ok(body)
    }
}

/// A rotation that turns the z axis into a unit vector.
fn upright(axis: &Vector3<f64>) -> Rotation3<f64> {
    if *axis == Vector3::z() {
        return Rotation3::identity();
    }
    let aside = match axis.iamin() {
        0 => Vector3::x(),
        1 => Vector3::y(),
        _ => Vector3::z(),
    };
    let x = aside.cross(axis).normalize();
    let y = axis.cross(&x);
    Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[x, y, *axis]))
}

/// Refuses names that no joint has, and names that stand there twice.
fn known<'n>(
    option: &str,
    names: &(impl Iterator<Item = &'n String> + Clone),
    description: &Description,
) -> Result<()> {
    for (index, name) in names.clone().enumerate() {
        let joint = description.joints.iter().find(|joint| joint.name == *name);
        let rule = match joint {
            None => "name joints of the arm",
            Some(joint) if joint.kind == JointType::Fixed => "name joints that move",
            Some(_) if names.clone().take(index).any(|other| other == name) => "name a joint once",
            Some(_) => continue,
        };
        return Err(Failure::invalid(option, rule, Given::Word(name.clone())));
    }
    Ok(())
}
