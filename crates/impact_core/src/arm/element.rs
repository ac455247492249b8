//! Elements of a URDF with checked attributes: what is not known and may change a number is refused.

use nalgebra::Vector3;
use numeric::error::{Failure, Given, Result};
use roxmltree::Node;

/// Parts of names of attributes that would change what the numbers beside them mean.
const MEANINGS: [&str; 4] = ["unit", "scale", "quat", "wxyz"];

/// An element with the words that name it in messages, such as `link "hand": inertial`.
#[derive(Clone)]
pub struct Element<'a, 'input> {
    node: Node<'a, 'input>,
    place: String,
}

impl<'a, 'input> Element<'a, 'input> {
    /// The root, named by its kind.
    pub fn root(node: Node<'a, 'input>) -> Self {
        let place = node.tag_name().name().to_owned();
        Self { node, place }
    }

    /// An element that is named by its kind and its attribute `name`.
    pub fn named(node: Node<'a, 'input>) -> Result<(Self, String)> {
        let kind = node.tag_name().name();
        let mut anonymous = Self {
            node,
            place: kind.to_owned(),
        };
        let name = anonymous.word("name").or_else(|_| {
            // A line is counted from the beginning of the text: only for a message.
            let line = node.document().text_pos_at(node.range().start).row;
            anonymous.place = format!("{kind} in line {line}");
            anonymous.word("name")
        })?;
        let place = format!("{kind} {name:?}");
        Ok((Self { node, place }, name))
    }

    /// An error about an attribute.
    pub fn refused(&self, what: &str, rule: impl Into<String>, value: Given) -> Failure {
        let name = if what.is_empty() {
            self.place.clone()
        } else {
            format!("{}: {what}", self.place)
        };
        Failure::invalid(name, rule.into(), value)
    }

    /// Notes attributes outside a list that change nothing. Those that may are refused: any beside known ones of which
    /// one is missing, and units, scales and quaternions.
    pub fn only(&self, known: &[&str], notes: &mut Vec<String>) -> Result<()> {
        let whole = known.iter().all(|each| self.node.has_attribute(*each));
        self.noted(known, notes, |_| whole)
    }

    /// Notes attributes like `only`, where few of the known ones are read, and need not be there: names near one of
    /// those that is missing are refused.
    pub fn only_of(&self, known: &[&str], read: &[&str], notes: &mut Vec<String>) -> Result<()> {
        self.noted(known, notes, |name| {
            let mut missing = read.iter().filter(|each| !self.node.has_attribute(**each));
            !missing.any(|each| near(each, name))
        })
    }

    fn noted(
        &self,
        known: &[&str],
        notes: &mut Vec<String>,
        harmless: impl Fn(&str) -> bool,
    ) -> Result<()> {
        let plain = |name: &roxmltree::Attribute<'_, '_>| name.namespace().is_none();
        for attribute in self.node.attributes().filter(plain) {
            let name = attribute.name();
            if known.contains(&name) {
                continue;
            }
            let lower = name.to_lowercase();
            if !harmless(name) || MEANINGS.iter().any(|word| lower.contains(word)) {
                let rule = format!("have no other attributes than {}", known.join(", "));
                return Err(self.refused("", rule, Given::Word(name.to_owned())));
            }
            notes.push(format!("{name:?} of {}", self.place));
        }
        Ok(())
    }

    /// The one child of a kind, if there is one.
    pub fn child(&self, kind: &str) -> Result<Option<Element<'a, 'input>>> {
        let mut all = elements(self.node).filter(|child| child.tag_name().name() == kind);
        let first = all.next();
        let more = all.count();
        if more > 0 {
            let found = Given::Count(more as u64 + 1);
            return Err(self.refused(kind, "stand there once", found));
        }
        Ok(first.map(|node| Element {
            node,
            place: format!("{}: {kind}", self.place),
        }))
    }

    /// The one child of a kind, which has to be there.
    pub fn needed(&self, kind: &str) -> Result<Element<'a, 'input>> {
        self.child(kind)?.ok_or_else(|| {
            let found = Given::Found(format!("no <{kind}>").into());
            self.refused("", format!("hold <{kind}>"), found)
        })
    }

    /// Refuses children whose names are nearly those of a list: a misspelt `inertial` would leave a
    /// link without a mass. Other names are extensions of some program, and are passed over.
    pub fn spelled(&self, known: &[&str]) -> Result<()> {
        for child in elements(self.node) {
            let name = child.tag_name().name();
            if known.contains(&name) {
                continue;
            }
            if let Some(meant) = known.iter().find(|each| near(each, name)) {
                let rule = "hold elements of URDF";
                let failure = self.refused("", rule, Given::Word(name.to_owned()));
                return Err(failure.mended_by(format!("did you mean \"{meant}\"?")));
            }
        }
        Ok(())
    }

    /// A word that has to be there.
    pub fn word(&self, attribute: &str) -> Result<String> {
        match self.node.attribute(attribute) {
            Some(word) if !word.trim().is_empty() => Ok(word.to_owned()),
            Some(word) => {
                let given = Given::Word(word.to_owned());
                Err(self.refused(attribute, "be a name", given))
            }
            None => {
                let found = Given::Found("none".into());
                Err(self.refused(attribute, "be given", found))
            }
        }
    }

    /// A finite number that has to be there.
    pub fn number(&self, attribute: &str) -> Result<f64> {
        let text = self.word(attribute)?;
        self.parsed(attribute, &text)
    }

    /// A finite number, or what it is without the attribute.
    pub fn number_or(&self, attribute: &str, otherwise: f64) -> Result<f64> {
        match self.node.attribute(attribute) {
            Some(text) => self.parsed(attribute, text),
            None => Ok(otherwise),
        }
    }

    /// Three finite numbers, or what they are without the attribute.
    pub fn vector_or(&self, attribute: &str, otherwise: Vector3<f64>) -> Result<Vector3<f64>> {
        let Some(text) = self.node.attribute(attribute) else {
            return Ok(otherwise);
        };
        let numbers: Vec<f64> = text
            .split_ascii_whitespace()
            .map(|part| self.parsed(attribute, part))
            .collect::<Result<_>>()?;
        if let [x, y, z] = numbers[..] {
            return Ok(Vector3::new(x, y, z));
        }
        let given = Given::Word(text.to_owned());
        Err(self.refused(attribute, "be three numbers", given))
    }

    fn parsed(&self, attribute: &str, text: &str) -> Result<f64> {
        match text.trim().parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => {
                let given = Given::Word(text.to_owned());
                Err(self.refused(attribute, "be a finite number", given))
            }
        }
    }
}

/// Children that are elements of the namespace of the root: others belong to other programs.
pub fn elements<'a, 'input>(node: Node<'a, 'input>) -> impl Iterator<Item = Node<'a, 'input>> {
    let root = node.document().root_element().tag_name().namespace();
    node.children()
        .filter(move |child| child.is_element() && child.tag_name().namespace() == root)
}

/// Whether two names differ in at most two letters that are missing, added or changed, short ones
/// in at most one.
fn near(one: &str, other: &str) -> bool {
    let (one, other) = (one.to_lowercase(), other.to_lowercase());
    let most = if one.len() > 4 { 2 } else { 1 };
    if one.len().abs_diff(other.len()) > most {
        return false;
    }
    let letters: Vec<char> = other.chars().collect();
    let mut row: Vec<usize> = (0..=letters.len()).collect();
    for (above, letter) in one.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = above + 1;
        for (place, candidate) in letters.iter().enumerate() {
            let changed = diagonal + usize::from(letter != *candidate);
            diagonal = row[place + 1];
            row[place + 1] = changed.min(diagonal + 1).min(row[place] + 1);
        }
    }
    row[letters.len()] <= most
}

#[cfg(test)]
mod tests {
    use super::near;

    #[test]
    fn misspelt_names_are_near_and_others_are_not() {
        assert!(near("inertial", "inertal"));
        assert!(near("inertial", "Inertial"));
        assert!(near("origin", "orgin"));
        assert!(near("axis", "axi"));
        assert!(!near("link", "limit"));
        assert!(!near("inertial", "visual"));
        assert!(!near("link", "transmission"));
        assert!(!near("joint", "sensor"));
    }
}
