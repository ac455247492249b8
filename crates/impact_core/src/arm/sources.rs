//! Masses and joints of an arm that its URDF does not hold: masses of links alone, a type plate, a base on wheels.

use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};
use numeric::error::{Failure, Given, Result, finite, not_negative, positive};

use super::body::Body;
use super::description::{Description, JointText, JointType, LinkText};
use super::shape::rod_moments;

/// Radius of a link without a shape, as a share of its length.
const SLENDER: f64 = 0.1;
/// Joints of a base: two ways that it drives, and its turn.
pub const BASE_JOINTS: [&str; 3] = ["base_x", "base_y", "base_turn"];

/// A base on wheels under the root of a URDF.
#[derive(Clone, Copy, Debug)]
pub struct Base {
    /// Whether the base also moves to its left.
    pub omni: bool,
    /// Mass beside that of the root, in the origin of the root (kg).
    pub mass: f64,
    /// Moment of inertia about the vertical through that (kg m^2); none: it is taken not to turn.
    pub inertia: Option<f64>,
    /// Middle of the axle in the frame of the root (m).
    pub axle: [f64; 2],
    /// Direction ahead, about the vertical from x (rad).
    pub heading: f64,
}

impl Description {
    /// Gives masses to links that have none.
    ///
    /// # Errors
    /// A link is not known, has a mass, or stands there twice; a mass is out of range.
    pub fn give_masses(&mut self, masses: &[(String, f64)]) -> Result<()> {
        for (index, (name, mass)) in masses.iter().enumerate() {
            let option = format!("link_masses[{name:?}]");
            let mass = positive(&option, *mass)?;
            let refused = |rule: &'static str| {
                Failure::invalid("link_masses", rule, Given::Word(name.clone()))
            };
            let Some(place) = self.links.iter().position(|link| link.name == *name) else {
                return Err(refused("name links of the arm"));
            };
            if masses[..index].iter().any(|(other, _)| other == name) {
                return Err(refused("name a link once"));
            }
            if self.links[place].body.mass > 0.0 {
                return Err(refused("name links whose inertial has no mass"));
            }
            let shape = self.links[place].solid.unwrap_or_else(|| self.rod(name));
            self.links[place].body = shape.weighing(mass);
        }
        Ok(())
    }

    /// A solid cylinder of 1 kg from the joint of a link to the middle of the next ones, a point without any.
    fn rod(&self, link: &str) -> Body {
        let next: Vec<Vector3<f64>> = self
            .joints
            .iter()
            .filter(|joint| joint.parent == link)
            .map(|joint| joint.origin.translation.vector)
            .collect();
        let end = next.iter().sum::<Vector3<f64>>() / next.len().max(1) as f64;
        let length = end.norm();
        if length == 0.0 {
            return Body {
                mass: 1.0,
                ..Body::default()
            };
        }
        let [across, along] = rod_moments(SLENDER * length, length);
        let axis = end / length;
        Body {
            mass: 1.0,
            center: 0.5 * end,
            inertia: Matrix3::identity() * across + axis * axis.transpose() * (along - across),
        }
    }

    /// Multiplies masses and inertias so that all links weigh as much as the type plate says.
    ///
    /// # Errors
    /// No link has a mass.
    pub fn scale_to(&mut self, plate: f64) -> Result<()> {
        let total: f64 = self.links.iter().map(|link| link.body.mass).sum();
        if total.is_nan() || total <= 0.0 {
            let rule = "have links with masses for mass_source \"scaled\"";
            return Err(Failure::invalid("urdf", rule, Given::Number(total)));
        }
        let factor = plate / total;
        for link in &mut self.links {
            link.body.mass *= factor;
            link.body.inertia *= factor;
        }
        Ok(())
    }

    /// Puts the root on a base that rolls: links and joints before it. Those that cannot move are fixed.
    ///
    /// # Errors
    /// A number is out of range, a name is taken, or there is no single root.
    pub fn put_on(&mut self, base: &Base) -> Result<()> {
        not_negative("base_mass", base.mass)?;
        for value in [base.axle[0], base.axle[1], base.heading] {
            finite("base_axle, base_heading", value)?;
        }
        let is_root =
            |link: &&mut LinkText| !self.joints.iter().any(|joint| joint.child == link.name);
        let Some(root) = self.links.iter_mut().find(is_root) else {
            return Ok(()); // a loop, which the tree tells
        };
        let turn = base
            .inertia
            .map(|given| positive("base_inertia", given))
            .transpose()?;
        root.body = root.body.joined(&Body {
            mass: base.mass,
            center: Vector3::zeros(),
            inertia: Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, turn.unwrap_or(0.0))),
        });
        // A vertical moment alone is none of a rigid body; how it tilts does not matter on a floor.
        let upright = turn.unwrap_or(0.0);
        root.body.inertia += Matrix3::from_diagonal(&Vector3::new(upright, upright, 0.0));
        let root = root.name.clone();
        let axle = Vector3::new(base.axle[0], base.axle[1], 0.0);
        let axle = if base.omni { Vector3::zeros() } else { axle };
        let moving = [true, base.omni, turn.is_some()];
        let ahead = Rotation3::from_axis_angle(&Vector3::z_axis(), base.heading);
        let axes = [ahead * Vector3::x(), ahead * Vector3::y(), Vector3::z()];
        // The turn comes first, about the axle; the ways behind it start there.
        let mut before = "base_floor".to_owned();
        self.links.push(self.unseen(&before)?);
        for (step, index) in [2, 0, 1].into_iter().enumerate() {
            let name = BASE_JOINTS[index];
            let child = if step == 2 {
                root.clone()
            } else {
                let link = self.unseen(&format!("{name}_link"))?;
                self.links.push(link);
                format!("{name}_link")
            };
            let offset = [axle, Vector3::zeros(), -axle][step];
            let kind = match (moving[index], index) {
                (false, _) => JointType::Fixed,
                (true, 2) => JointType::Turning,
                _ => JointType::Sliding,
            };
            if self.joints.iter().any(|joint| joint.name == name) {
                return Err(taken("joint", name));
            }
            self.joints.push(JointText {
                name: name.to_owned(),
                kind,
                parent: before,
                child: child.clone(),
                origin: Isometry3::from_parts(
                    Translation3::from(offset),
                    UnitQuaternion::identity(),
                ),
                axis: axes[index],
                limits: None,
                mimic: None,
            });
            before = child;
        }
        Ok(())
    }

    /// A link without a mass and a shape.
    fn unseen(&self, name: &str) -> Result<LinkText> {
        if self.links.iter().any(|link| link.name == name) {
            return Err(taken("link", name));
        }
        Ok(LinkText {
            name: name.to_owned(),
            body: Body::default(),
            shaped: false,
            size: None,
            solid: None,
        })
    }
}

fn taken(kind: &str, name: &str) -> Failure {
    let rule = format!("not be the name of a {kind} of the URDF on a base that rolls");
    Failure::invalid(format!("{kind} name"), rule, Given::Word(name.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::{Base, Description};
    use crate::arm::{Arm, Options};

    fn read(inner: &str) -> Description {
        Description::read(&format!("<robot name='r'>{inner}</robot>")).unwrap()
    }

    #[test]
    fn a_link_without_a_shape_is_a_rod() {
        let mut found = read(
            "<link name='a'/><link name='b'/><joint name='j' type='revolute'><parent link='a'/>
            <child link='b'/><origin xyz='0 0 0.4'/></joint>",
        );
        found.give_masses(&[("a".to_owned(), 4.0)]).unwrap();
        let body = found.links[0].body;
        assert!((body.center.z - 0.2).abs() < 1e-15);
        let expected = [0.054_933_333_333_33, 0.054_933_333_333_33, 0.0032];
        for (place, moment) in expected.into_iter().enumerate() {
            assert!((body.inertia[(place, place)] - moment).abs() < 1e-12);
        }
        assert!(found.give_masses(&[("a".to_owned(), 4.0)]).is_err());
        assert!(found.give_masses(&[("c".to_owned(), 4.0)]).is_err());
    }

    #[test]
    fn a_shape_of_primitives_is_filled() {
        let cylinder = "<link name='a'><collision><origin xyz='0 0 0.2'/><geometry>
            <cylinder radius='0.04' length='0.4'/></geometry></collision></link>";
        let capsule = cylinder.replace("cylinder", "capsule");
        let ball = "<link name='a'><collision><geometry><sphere radius='0.1'/></geometry></collision></link>";
        let mass = |text: &str| {
            let mut found = read(text);
            found.give_masses(&[("a".to_owned(), 4.0)]).unwrap();
            found.links[0].body
        };
        assert!(
            (mass(cylinder).inertia[(0, 0)] - 4.0 * (3.0 * 0.0016 + 0.16) / 12.0).abs() < 1e-12
        );
        assert!((mass(ball).inertia[(2, 2)] - 4.0 * 0.004).abs() < 1e-12);
        // A short capsule is nearly a ball.
        let round = mass(&capsule.replace("0.4'/>", "1e-9'/>")).inertia;
        assert!((round - nalgebra::Matrix3::identity() * (4.0 * 0.4 * 0.0016)).amax() < 1e-9);
        assert!(mass(&capsule).inertia[(0, 0)] > mass(cylinder).inertia[(0, 0)]);
    }

    #[test]
    fn a_base_that_rolls_has_its_joints_before_the_root() {
        let text = "<robot name='r'><link name='a'/><link name='b'><inertial><mass value='3'/>
            <inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>
            <joint name='j' type='continuous'><parent link='a'/><child link='b'/></joint></robot>";
        for (omni, inertia, free) in [
            (false, None, 2),
            (false, Some(2.0), 3),
            (true, None, 3),
            (true, Some(2.0), 4),
        ] {
            let base = Base {
                omni,
                mass: 40.0,
                inertia,
                axle: [0.1, 0.0],
                heading: 0.3,
            };
            let options = Options {
                base: Some(base),
                ..Options::default()
            };
            let arm = Arm::from_urdf(text, &options).unwrap();
            assert_eq!(arm.free, free);
            assert_eq!(arm.moving_mass, 43.0);
            assert_eq!(arm.joints[0].name, "j");
        }
    }
}
