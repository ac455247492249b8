//! Shapes of links, as far as they are primitives: what volume a body has for its mass.
//!
//! Shapes take part in no mass but that of a link whose mass alone is given. They are read to tell whether masses may be real, so that a shape which
//! cannot be read is not known, and no error.

use nalgebra::{Isometry3, Matrix3, Translation3, UnitQuaternion, Vector3};
use roxmltree::Node;

use super::body::Body;
use super::element::elements;

/// Volume and extent of a shape of primitives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Size {
    /// Sum of the volumes of its primitives (m^3).
    pub volume: f64,
    /// Diagonal of the box around it, along the axes of the link (m).
    pub diagonal: f64,
    /// Whether nothing else is seen of the link: beside a mesh, primitives may be parts of it, such as soles of feet.
    pub whole: bool,
}

/// Size of a link: of its collision shape if that is made of primitives, else of what is seen of it; none where
/// both have other parts, or there are none.
#[must_use]
pub fn size(link: Node<'_, '_>) -> Option<Size> {
    let seen = of_kind(link, "visual");
    let whole = seen.is_some() || !elements(link).any(|each| each.tag_name().name() == "visual");
    let found = of_kind(link, "collision").or(seen)?;
    Some(Size { whole, ..found })
}

fn of_kind(link: Node<'_, '_>, kind: &str) -> Option<Size> {
    let (mut volume, mut found) = (0.0, false);
    let mut corners = [
        Vector3::repeat(f64::INFINITY),
        Vector3::repeat(f64::NEG_INFINITY),
    ];
    for part in elements(link).filter(|each| each.tag_name().name() == kind) {
        let Primitive {
            volume: own,
            half,
            place,
            ..
        } = primitive(part)?;
        volume += own;
        found = true;
        let middle = place.translation.vector;
        corners = [
            corners[0].inf(&(middle - half)),
            corners[1].sup(&(middle + half)),
        ];
    }
    let diagonal = (corners[1] - corners[0]).norm();
    (found && volume > 0.0 && volume.is_finite() && diagonal.is_finite()).then_some(Size {
        volume,
        diagonal,
        whole: true,
    })
}

/// A body of 1 kg that fills the collision shape of a link evenly, if that is made of primitives.
#[must_use]
pub fn solid(link: Node<'_, '_>) -> Option<Body> {
    let mut whole = Body::default();
    for part in elements(link).filter(|each| each.tag_name().name() == "collision") {
        let found = primitive(part)?;
        let own = Body {
            mass: found.volume,
            center: Vector3::zeros(),
            inertia: Matrix3::from_diagonal(&(found.moments * found.volume)),
        };
        whole = whole.joined(&own.placed(&found.place));
    }
    let body = Body {
        mass: 1.0,
        inertia: whole.inertia / whole.mass,
        ..whole
    };
    (whole.mass > 0.0).then_some(body)?.finite().ok()
}

/// One primitive.
struct Primitive {
    volume: f64,
    /// Half of the extents along the axes of the link.
    half: Vector3<f64>,
    place: Isometry3<f64>,
    /// Principal moments of 1 kg of it, along its own axes.
    moments: Vector3<f64>,
}

fn primitive(part: Node<'_, '_>) -> Option<Primitive> {
    let geometry = elements(part).find(|each| each.tag_name().name() == "geometry")?;
    let form = elements(geometry).next()?;
    let place = place(part)?;
    let turn: Matrix3<f64> = place.rotation.to_rotation_matrix().into_inner();
    let positive = |name: &str| -> Option<f64> {
        let value = form.attribute(name)?.trim().parse::<f64>().ok()?;
        (value > 0.0 && value.is_finite()).then_some(value)
    };
    let axis: Vector3<f64> = turn.column(2).into();
    let kind = form.tag_name().name();
    let (volume, half, moments) = if kind == "box" {
        let edges = vector(form.attribute("size")?).filter(|edges| edges.min() > 0.0)?;
        let squares = edges.component_mul(&edges);
        let moments = (Vector3::repeat(squares.sum()) - squares) / 12.0;
        (edges.product(), turn.abs() * edges * 0.5, moments)
    } else if kind == "sphere" {
        let radius = positive("radius")?;
        let moment = 0.4 * radius * radius;
        (
            ball(radius),
            Vector3::repeat(radius),
            Vector3::repeat(moment),
        )
    } else if kind == "cylinder" || kind == "capsule" {
        let (radius, length) = (positive("radius")?, positive("length")?);
        let tube = std::f64::consts::PI * radius * radius * length;
        let half = axis.abs() * (0.5 * length);
        let across = axis.map(|along| radius * (1.0 - along * along).max(0.0).sqrt());
        let [wide, long] = rod_moments(radius, length);
        if kind == "capsule" {
            let whole = tube + ball(radius);
            let [tube, ends] = [tube / whole, ball(radius) / whole];
            let square = radius * radius;
            // Both half balls, with their centers 3/8 of the radius beyond the tube.
            let away = 0.4 * square + 0.25 * length * length + 0.375 * length * radius;
            let moments = [tube * wide + ends * away, tube * long + ends * 0.4 * square];
            let moments = Vector3::new(moments[0], moments[0], moments[1]);
            (whole, half.add_scalar(radius), moments)
        } else {
            (tube, half + across, Vector3::new(wide, wide, long))
        }
    } else {
        return None;
    };
    Some(Primitive {
        volume,
        half,
        place,
        moments,
    })
}

/// Moments of 1 kg of a solid cylinder across its axis and along it.
#[must_use]
pub fn rod_moments(radius: f64, length: f64) -> [f64; 2] {
    let square = radius * radius;
    [(3.0 * square + length * length) / 12.0, 0.5 * square]
}

/// Volume of a sphere (m^3).
fn ball(radius: f64) -> f64 {
    4.0 / 3.0 * std::f64::consts::PI * radius.powi(3)
}

fn place(part: Node<'_, '_>) -> Option<Isometry3<f64>> {
    let Some(origin) = elements(part).find(|each| each.tag_name().name() == "origin") else {
        return Some(Isometry3::identity());
    };
    let read = |name: &str| {
        origin
            .attribute(name)
            .map_or(Some(Vector3::zeros()), vector)
    };
    let (middle, turn) = (read("xyz")?, read("rpy")?);
    let turned = UnitQuaternion::from_euler_angles(turn.x, turn.y, turn.z);
    Some(Isometry3::from_parts(Translation3::from(middle), turned))
}

fn vector(text: &str) -> Option<Vector3<f64>> {
    let numbers: Vec<f64> = text
        .split_ascii_whitespace()
        .map(|part| part.parse::<f64>().ok().filter(|value| value.is_finite()))
        .collect::<Option<_>>()?;
    let [x, y, z] = numbers[..] else { return None };
    Some(Vector3::new(x, y, z))
}

#[cfg(test)]
mod tests {
    use super::size;
    use roxmltree::Document;

    fn of(inner: &str) -> Option<(f64, f64)> {
        let text = format!("<link name='a'>{inner}</link>");
        let document = Document::parse(&text).ok()?;
        size(document.root_element()).map(|found| (found.volume, found.diagonal))
    }

    #[test]
    fn primitives_have_their_volumes_and_the_box_around_them() {
        let shape = |form: &str| format!("<collision><geometry>{form}</geometry></collision>");
        let (volume, diagonal) = of(&shape("<box size='1 2 2'/>")).unwrap();
        assert_eq!((volume, diagonal), (4.0, 3.0));
        let (volume, _) = of(&shape("<cylinder radius='0.09' length='0.5'/>")).unwrap();
        assert!((0.02 / volume - 1.571_900_672_513).abs() < 1e-9);
        let (_, diagonal) = of(&shape("<sphere radius='1'/>")).unwrap();
        assert!((diagonal - 12.0_f64.sqrt()).abs() < 1e-15);
        let turned = "<collision><origin rpy='1.5707963267948966 0 0'/><geometry>
            <cylinder radius='0.1' length='0.6'/></geometry></collision>";
        let (_, diagonal) = of(turned).unwrap();
        assert!((diagonal - (0.2_f64.powi(2) * 2.0 + 0.6_f64.powi(2)).sqrt()).abs() < 1e-12);
    }

    #[test]
    fn shapes_of_other_parts_are_not_known() {
        assert_eq!(of(""), None);
        let mesh = "<collision><geometry><mesh filename='a.stl'/></geometry></collision>";
        assert_eq!(of(mesh), None);
        let seen = "<visual><geometry><sphere radius='0.1'/></geometry></visual>";
        assert!(of(&format!("{mesh}{seen}")).is_some());
        let parts = [
            mesh.replace("collision", "visual"),
            seen.replace("visual", "collision"),
        ];
        let text = format!("<link name='a'>{}</link>", parts.concat());
        let document = Document::parse(&text).unwrap();
        assert!(!size(document.root_element()).unwrap().whole);
        for bad in [
            "<box size='1 2'/>",
            "<box size='1 2 0'/>",
            "<sphere radius='nan'/>",
            "<sphere/>",
        ] {
            assert_eq!(
                of(&format!("<visual><geometry>{bad}</geometry></visual>")),
                None
            );
        }
    }
}
