//! Tree of the links of a description: one root, no loop, every name once.

use std::collections::HashMap;

use numeric::error::{Failure, Given, Result};

use super::description::{Description, JointText, JointType};

/// Links and joints by index.
pub struct Tree {
    /// Joints from the root outwards.
    pub order: Vec<usize>,
    /// Link before each joint.
    pub parent: Vec<usize>,
    /// Link behind each joint.
    pub child: Vec<usize>,
    /// Joint that each joint takes its value from in the end, and how: itself, 1 and 0 without a
    /// `mimic`.
    pub source: Vec<(usize, f64, f64)>,
}

impl Tree {
    /// Checks how a description hangs together.
    ///
    /// # Errors
    /// Names are unknown or stand there twice, a link has two parents, links form a loop, there is
    /// no root or more than one, joints mimic each other in a circle or one that does not move.
    pub fn of(description: &Description) -> Result<Self> {
        let joints = &description.joints;
        let links = by_name(
            "link",
            description.links.iter().map(|link| link.name.as_str()),
        )?;
        let named = by_name("joint", joints.iter().map(|joint| joint.name.as_str()))?;
        let end = |joint: &JointText, what: &str, link: &str| -> Result<usize> {
            links.get(link).copied().ok_or_else(|| {
                let name = format!("joint {:?}: {what}", joint.name);
                Failure::invalid(name, "be the name of a link", Given::Word(link.to_owned()))
            })
        };
        let mut parent = Vec::with_capacity(joints.len());
        let mut child = Vec::with_capacity(joints.len());
        for joint in joints {
            parent.push(end(joint, "parent", &joint.parent)?);
            child.push(end(joint, "child", &joint.child)?);
        }
        let order = outwards(description, &parent, &child)?;
        let source = sources(joints, &named)?;
        Ok(Self {
            order,
            parent,
            child,
            source,
        })
    }
}

fn by_name<'a>(
    kind: &str,
    names: impl Iterator<Item = &'a str>,
) -> Result<HashMap<&'a str, usize>> {
    let mut found = HashMap::new();
    for (index, name) in names.enumerate() {
        if found.insert(name, index).is_some() {
            let rule = format!("be the name of one {kind}");
            let name = Given::Word(name.to_owned());
            return Err(Failure::invalid(format!("{kind} name"), rule, name));
        }
    }
    Ok(found)
}

/// Joints from the root outwards, by the order of the file among those of one link.
fn outwards(description: &Description, parent: &[usize], child: &[usize]) -> Result<Vec<usize>> {
    let (links, joints) = (&description.links, &description.joints);
    let mut inward: Vec<Option<usize>> = vec![None; links.len()];
    let mut outward: Vec<Vec<usize>> = vec![Vec::new(); links.len()];
    for joint in 0..joints.len() {
        if let Some(other) = inward[child[joint]].replace(joint) {
            let name = format!("link {:?}", links[child[joint]].name);
            let found = format!(
                "joints {:?} and {:?}",
                joints[other].name, joints[joint].name
            );
            let rule = "be the child of one joint: loops are not read";
            return Err(Failure::invalid(name, rule, Given::Found(found.into())));
        }
        outward[parent[joint]].push(joint);
    }
    let roots: Vec<usize> = (0..links.len())
        .filter(|link| inward[*link].is_none())
        .collect();
    let [root] = roots[..] else {
        let names: Vec<&str> = roots
            .iter()
            .take(5)
            .map(|link| links[*link].name.as_str())
            .collect();
        let found = match (links.len(), names.len()) {
            (0, _) => "no link".to_owned(),
            (_, 0) => "none: the links form a loop".to_owned(),
            _ => format!("{}: {}", roots.len(), names.join(", ")),
        };
        let rule = "have one link that is no child of a joint";
        return Err(Failure::invalid("robot", rule, Given::Found(found.into())));
    };
    let mut order = Vec::with_capacity(joints.len());
    let mut waiting = vec![root];
    let mut reached = vec![false; links.len()];
    while let Some(link) = waiting.pop() {
        reached[link] = true;
        order.extend(&outward[link]);
        waiting.extend(outward[link].iter().rev().map(|joint| child[*joint]));
    }
    match reached.iter().position(|met| !met) {
        Some(lost) => {
            let name = format!("link {:?}", links[lost].name);
            let found = Given::Found("a loop of links".into());
            Err(Failure::invalid(name, "hang on the root", found))
        }
        None => Ok(order),
    }
}

/// Joint that each joint takes its value from in the end, with factor and offset.
fn sources(joints: &[JointText], named: &HashMap<&str, usize>) -> Result<Vec<(usize, f64, f64)>> {
    let refused = |joint: &JointText, rule: &'static str, value: String| {
        let name = format!("joint {:?}: mimic", joint.name);
        Failure::invalid(name, rule, Given::Word(value))
    };
    let mut found = Vec::with_capacity(joints.len());
    for (index, joint) in joints.iter().enumerate() {
        let (mut at, mut factor, mut addend) = (index, 1.0, 0.0);
        let mut steps = 0;
        while let (Some(mimic), true) = (&joints[at].mimic, joints[at].kind != JointType::Fixed) {
            let Some(next) = named.get(mimic.joint.as_str()).copied() else {
                return Err(refused(&joints[at], "name a joint", mimic.joint.clone()));
            };
            if joints[next].kind == JointType::Fixed {
                return Err(refused(
                    &joints[at],
                    "name a joint that moves",
                    mimic.joint.clone(),
                ));
            }
            steps += 1;
            if steps > joints.len() {
                return Err(refused(
                    joint,
                    "not lead back to itself",
                    mimic.joint.clone(),
                ));
            }
            // value = factor (multiplier x + offset) + addend
            addend += factor * mimic.offset;
            factor *= mimic.multiplier;
            at = next;
        }
        if !(factor.is_finite() && addend.is_finite()) {
            return Err(refused(
                joint,
                "have a finite multiplier and offset",
                joint.name.clone(),
            ));
        }
        found.push((at, factor, addend));
    }
    Ok(found)
}
