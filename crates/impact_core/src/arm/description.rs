//! Links and joints of a URDF, each element checked by itself.

use nalgebra::{Isometry3, Matrix3, Translation3, UnitQuaternion, Vector3};
use numeric::error::{Failure, Given, Result, at_most};
use roxmltree::{Document, Node, ParsingOptions};

use super::body::Body;
use super::element::{Element, elements};
use super::foreign;
use super::shape::{self, Size};

/// Most bytes of a URDF: a thousand times what an arm needs.
pub const MOST_BYTES: usize = 1 << 25;

/// Most links, and most joints.
pub const MOST_LINKS: usize = 10_000;

/// A link: its name and its inertia in its own frame.
#[derive(Clone, Debug)]
pub struct LinkText {
    /// Name.
    pub name: String,
    /// Inertia in the frame of the link; none without `inertial`. Whether a rigid body may have it is not checked.
    pub body: Body,
    /// Whether the link has a shape to see or to touch.
    pub shaped: bool,
    /// Size of that shape, if it is of primitives.
    pub size: Option<Size>,
    /// A body of 1 kg that fills the collision shape, if that is of primitives.
    pub solid: Option<Body>,
}

/// Type of a joint's motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointType {
    /// About its axis.
    Turning,
    /// Along its axis.
    Sliding,
    /// Not at all.
    Fixed,
}

/// A joint that follows another one.
#[derive(Clone, Debug)]
pub struct Mimic {
    /// Name of the other one.
    pub joint: String,
    /// Factor of its value.
    pub multiplier: f64,
    /// Offset of its value.
    pub offset: f64,
}

/// A joint.
#[derive(Clone, Debug)]
pub struct JointText {
    /// Name.
    pub name: String,
    /// Type of its motion.
    pub kind: JointType,
    /// Names of the links that it connects.
    pub parent: String,
    /// The link that it moves.
    pub child: String,
    /// Pose of its frame in that of the parent, at zero.
    pub origin: Isometry3<f64>,
    /// Unit axis in its frame.
    pub axis: Vector3<f64>,
    /// Least and largest value; none where the joint may take any.
    pub limits: Option<[f64; 2]>,
    /// The joint that it follows.
    pub mimic: Option<Mimic>,
}

/// All that matters here of a URDF.
#[derive(Clone, Debug)]
pub struct Description {
    /// Name of the robot, empty without one.
    pub name: String,
    /// Links in the order of the file.
    pub links: Vec<LinkText>,
    /// Joints in the order of the file.
    pub joints: Vec<JointText>,
    /// Attributes that URDF does not have and that change nothing.
    pub passed_over: Vec<String>,
    /// Joints and links with an angle of more than a turn in an `rpy`.
    pub turned: Vec<String>,
}

/// Angles of more than this are no directions in radians (rad): one turn, and rounding.
const TURN: f64 = 6.3;

const ROBOT: [&str; 5] = ["link", "joint", "material", "transmission", "gazebo"];
const LINK: [&str; 4] = ["inertial", "visual", "collision", "contact"];
const JOINT: [&str; 9] = [
    "parent",
    "child",
    "origin",
    "axis",
    "limit",
    "dynamics",
    "calibration",
    "mimic",
    "safety_controller",
];
const LIMIT: [&str; 7] = [
    "lower",
    "upper",
    "effort",
    "velocity",
    "acceleration",
    "deceleration",
    "jerk",
];

impl Description {
    /// Reads a URDF.
    ///
    /// # Errors
    /// It is no XML, no URDF, or an element of it breaks a rule, which the error names.
    pub fn read(text: &str) -> Result<Self> {
        at_most("urdf", text.len(), MOST_BYTES)?;
        let options = || ParsingOptions {
            nodes_limit: 1 << 22,
            ..ParsingOptions::default()
        };
        let declared;
        let document = match Document::parse_with_options(text, options()) {
            Err(roxmltree::Error::UnknownNamespace(..)) if !foreign::is_xacro(text) => {
                declared = foreign::declared(text);
                Document::parse_with_options(&declared, options())
            }
            read => read,
        };
        let document = document.map_err(|error| no_xml(&error, text))?;
        let root = document.root_element();
        if root.tag_name().name() != "robot" {
            return Err(foreign::refused(root.tag_name().name()));
        }
        refuse_xacro(&document)?;
        Element::root(root).spelled(&ROBOT)?;
        let all =
            |kind: &'static str| elements(root).filter(move |each| each.tag_name().name() == kind);
        at_most("number of links", all("link").count(), MOST_LINKS)?;
        at_most("number of joints", all("joint").count(), MOST_LINKS)?;
        if all("link").count() == 0 && (all("group").count() > 0 || all("group_state").count() > 0)
        {
            return Err(foreign::refused("srdf"));
        }
        let mut notes = Vec::new();
        Ok(Self {
            name: root.attribute("name").unwrap_or_default().to_owned(),
            links: all("link")
                .map(|node| link(node, &mut notes))
                .collect::<Result<_>>()?,
            joints: all("joint")
                .map(|node| joint(node, &mut notes))
                .collect::<Result<_>>()?,
            passed_over: notes,
            turned: turned(root),
        })
    }
}

/// Joints and links whose place, or that of whose inertia, is turned by more than a turn about an axis.
fn turned(root: Node<'_, '_>) -> Vec<String> {
    let beyond = |origin: Node<'_, '_>| {
        let angles = origin.attribute("rpy").unwrap_or_default();
        let mut angles = angles
            .split_ascii_whitespace()
            .filter_map(|each| each.parse::<f64>().ok());
        origin.has_tag_name("origin") && angles.any(|angle| angle.abs() > TURN)
    };
    let owners = elements(root).filter(|each| matches!(each.tag_name().name(), "joint" | "link"));
    let found = owners.filter(|owner| {
        let inertials = elements(*owner).filter(|each| each.has_tag_name("inertial"));
        elements(*owner).any(beyond) || inertials.flat_map(elements).any(beyond)
    });
    let named = |owner: Node<'_, '_>| {
        let name = owner.attribute("name").unwrap_or_default();
        format!("{} {name:?}", owner.tag_name().name())
    };
    found.map(named).collect()
}

fn no_xml(error: &roxmltree::Error, text: &str) -> Failure {
    let found = Given::Found(error.to_string().into());
    let failure = Failure::invalid("urdf", "be well-formed XML without a document type", found);
    match error {
        roxmltree::Error::UnknownNamespace(..) if foreign::is_xacro(text) => {
            failure.mended_by("expand xacro first: xacro robot.urdf.xacro > robot.urdf")
        }
        _ => failure,
    }
}

/// Refuses macros that are not expanded.
fn refuse_xacro(document: &Document<'_>) -> Result<()> {
    for node in document.descendants().filter(Node::is_element) {
        // By the name of its space, or by the prefix that such files give it.
        let of_xacro = node.tag_name().namespace().is_some_and(|space| {
            space.contains("xacro") || node.lookup_prefix(space) == Some("xacro")
        });
        let macros = node
            .attributes()
            .find(|each| each.value().contains("${") || each.value().contains("$("));
        let found = match macros {
            Some(attribute) => format!("{}=\"{}\"", attribute.name(), attribute.value()),
            None if of_xacro => format!("<xacro:{}>", node.tag_name().name()),
            None => continue,
        };
        let line = document.text_pos_at(node.range().start).row;
        let place = format!("{} in line {line}", node.tag_name().name());
        let failure = Failure::invalid(place, "hold no macros of xacro", Given::Word(found));
        return Err(failure.mended_by(foreign::EXPAND));
    }
    Ok(())
}

fn link(node: Node<'_, '_>, notes: &mut Vec<String>) -> Result<LinkText> {
    let (element, name) = Element::named(node)?;
    element.spelled(&LINK)?;
    let inertial = element.child("inertial")?;
    let mut children = node.children();
    let shaped =
        children.any(|child| child.has_tag_name("visual") || child.has_tag_name("collision"));
    let body = match inertial {
        Some(inertial) => body(&inertial, notes).map_err(|failure| about(failure, &name))?,
        None => Body::default(),
    };
    Ok(LinkText {
        name,
        body,
        shaped,
        size: shape::size(node),
        solid: shape::solid(node),
    })
}

/// Puts the name of its link before what only knows that a number is wrong.
pub(super) fn about(failure: Failure, link: &str) -> Failure {
    match failure {
        Failure::InvalidParameter(ref invalid) if invalid.name.starts_with("link") => failure,
        other => other.within(&format!("link {link:?}")),
    }
}

fn body(inertial: &Element<'_, '_>, notes: &mut Vec<String>) -> Result<Body> {
    inertial.spelled(&["origin", "mass", "inertia"])?;
    let mass = inertial.needed("mass")?;
    mass.only(&["value"], notes)?;
    let inertia = inertial.needed("inertia")?;
    inertia.only(&["ixx", "ixy", "ixz", "iyy", "iyz", "izz"], notes)?;
    let [xx, xy, xz] = ["ixx", "ixy", "ixz"].map(|name| inertia.number(name));
    let [yy, yz, zz] = ["iyy", "iyz", "izz"].map(|name| inertia.number(name));
    let (xx, xy, xz, yy, yz, zz) = (xx?, xy?, xz?, yy?, yz?, zz?);
    for (name, other, value) in [("iyx", "ixy", xy), ("izx", "ixz", xz), ("izy", "iyz", yz)] {
        let across = inertia.number_or(name, value)?;
        if (across - value).abs() > 1e-6 * (xx.abs() + yy.abs() + zz.abs()) {
            let rule = format!("be equal to {other} ({value:?})");
            return Err(inertia.refused(name, rule, Given::Number(across)));
        }
    }
    let own = Body {
        mass: mass.number("value")?,
        center: Vector3::zeros(),
        inertia: Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz),
    };
    Ok(own.finite()?.placed(&origin(inertial, notes)?))
}

/// Pose of an element: `rpy` turns about the fixed axes x, y, z in this order.
fn origin(owner: &Element<'_, '_>, notes: &mut Vec<String>) -> Result<Isometry3<f64>> {
    let Some(origin) = owner.child("origin")? else {
        return Ok(Isometry3::identity());
    };
    origin.only(&["xyz", "rpy"], notes)?;
    let place = origin.vector_or("xyz", Vector3::zeros())?;
    let turn = origin.vector_or("rpy", Vector3::zeros())?;
    let turned = UnitQuaternion::from_euler_angles(turn.x, turn.y, turn.z);
    Ok(Isometry3::from_parts(Translation3::from(place), turned))
}

fn joint(node: Node<'_, '_>, notes: &mut Vec<String>) -> Result<JointText> {
    let (element, name) = Element::named(node)?;
    element.spelled(&JOINT)?;
    let word = element.word("type")?;
    let kind = match word.as_str() {
        "revolute" | "continuous" => JointType::Turning,
        "prismatic" => JointType::Sliding,
        "fixed" => JointType::Fixed,
        "floating" | "planar" => {
            let rule = "be revolute, continuous, prismatic or fixed: the base stands still here";
            return Err(element.refused("type", rule, Given::Word(word)));
        }
        _ => {
            let rule = "be \"revolute\", \"continuous\", \"prismatic\" or \"fixed\"";
            return Err(element.refused("type", rule, Given::Word(word)));
        }
    };
    Ok(JointText {
        kind,
        parent: linked(&element, "parent", notes)?,
        child: linked(&element, "child", notes)?,
        origin: origin(&element, notes)?,
        axis: axis(&element, kind, notes)?,
        limits: limits(&element, &word, notes)?,
        mimic: mimic(&element, notes)?,
        name,
    })
}

fn linked(joint: &Element<'_, '_>, end: &str, notes: &mut Vec<String>) -> Result<String> {
    let end = joint.needed(end)?;
    end.only(&["link"], notes)?;
    end.word("link")
}

/// Unit axis, x by default.
fn axis(joint: &Element<'_, '_>, kind: JointType, notes: &mut Vec<String>) -> Result<Vector3<f64>> {
    let Some(axis) = joint.child("axis")? else {
        return Ok(Vector3::x());
    };
    if kind == JointType::Fixed {
        return Ok(Vector3::x());
    }
    axis.only(&["xyz"], notes)?;
    let given = axis.vector_or("xyz", Vector3::x())?;
    // Scaled first, so that the square of a small or large number is a number.
    let largest = given.amax();
    if largest == 0.0 {
        let found = Given::Word("0 0 0".to_owned());
        return Err(axis.refused("xyz", "not be zero where the joint moves", found));
    }
    Ok((given / largest).normalize())
}

fn limits(
    joint: &Element<'_, '_>,
    kind: &str,
    notes: &mut Vec<String>,
) -> Result<Option<[f64; 2]>> {
    let Some(limit) = joint.child("limit")? else {
        return Ok(None);
    };
    limit.only_of(&LIMIT, &["lower", "upper"], notes)?;
    let [lower, upper] = [
        limit.number_or("lower", 0.0)?,
        limit.number_or("upper", 0.0)?,
    ];
    if !matches!(kind, "revolute" | "prismatic") {
        return Ok(None);
    }
    if lower > upper {
        let rule = format!("be at least lower ({lower:?})");
        return Err(limit.refused("upper", rule, Given::Number(upper)));
    }
    Ok(Some([lower, upper]))
}

fn mimic(joint: &Element<'_, '_>, notes: &mut Vec<String>) -> Result<Option<Mimic>> {
    let Some(mimic) = joint.child("mimic")? else {
        return Ok(None);
    };
    mimic.only(&["joint", "multiplier", "offset"], notes)?;
    Ok(Some(Mimic {
        joint: mimic.word("joint")?,
        multiplier: mimic.number_or("multiplier", 1.0)?,
        offset: mimic.number_or("offset", 0.0)?,
    }))
}

#[cfg(test)]
mod tests {
    use super::Description;

    #[test]
    fn attributes_that_change_nothing_are_noted_and_others_refused() {
        let read = |inner: &str| {
            let text = format!(
                r#"<robot name="r"><link name="a"><inertial><mass value="1"/>
                <inertia ixx="1" ixy="0.1" ixz="0" iyy="1" iyz="0" izz="1" {inner}/></inertial></link></robot>"#
            );
            Description::read(&text).map(|read| read.passed_over)
        };
        assert_eq!(read(""), Ok(vec![]));
        let noted = r#""iyx" of link "a": inertial: inertia"#;
        assert_eq!(read(r#"iyx="0.1""#), Ok(vec![noted.to_owned()]));
        assert!(read(r#"iyx="0.2""#).is_err());
        assert!(read(r#"unit="g""#).is_err());
        assert!(read(r#"note="new""#).is_ok());
    }
}
