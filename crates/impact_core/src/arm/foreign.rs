//! Other formats than URDF: what they are, and how an arm in them becomes a URDF.

use numeric::error::{Failure, Given};

/// Advice for a file with macros.
pub const EXPAND: &str = "expand them first: xacro robot.urdf.xacro > robot.urdf";

/// Most prefixes that are declared for a document.
const MOST_PREFIXES: usize = 64;

/// The error about a root element that is none of URDF.
#[must_use]
pub fn refused(root: &str) -> Failure {
    let advice = match root {
        "sdf" | "gazebo" | "world" | "model" => {
            "this is SDF of Gazebo, which is not read: take the URDF that most such models are made of, or export one, \
             for example through sdformat_urdf of ROS"
        }
        "mujoco" | "mujocoinclude" => {
            "this is MJCF of MuJoCo, which is not read: take the URDF that most such models are made of, or convert \
             it, for example with mjcf-urdf-simple-converter of Python; its armature goes into armature="
        }
        "srdf" => "this is SRDF, which names groups of an arm: take the URDF beside it",
        "COLLADA" => "this is a mesh: take the URDF that names it",
        _ => "take the URDF of the arm: its root element is <robot>",
    };
    let given = Given::Word(root.to_owned());
    let failure = Failure::invalid("root element", "be <robot>", given);
    failure.mended_by(advice)
}

/// Whether a document uses macros of xacro: what is not declared then is an error that says so.
#[must_use]
pub fn is_xacro(text: &str) -> bool {
    text.contains("<xacro:")
}

/// The text with every prefix declared at its root that stands before an element or an attribute: blocks of other
/// programs often come without, and nothing in them is read.
#[must_use]
pub fn declared(text: &str) -> String {
    let Some(at) = root_name_end(text) else {
        return text.to_owned();
    };
    let mut prefixes: Vec<&str> = Vec::new();
    for (colon, _) in text.match_indices(':') {
        let before = &text[..colon];
        let letter = |each: char| each.is_alphanumeric() || matches!(each, '_' | '-' | '.');
        let start = before.rfind(|each| !letter(each)).map_or(0, |place| {
            place + before[place..].chars().next().map_or(1, char::len_utf8)
        });
        let prefix = &before[start..];
        let opens = before[..start].ends_with(['<', '/', ' ', '\t', '\n', '\r']);
        let named = prefix.starts_with(|each: char| each.is_alphabetic() || each == '_');
        let other = !matches!(prefix, "xmlns" | "xml") && !prefixes.contains(&prefix);
        let given = text.contains(&format!("xmlns:{prefix}="));
        if opens && named && other && !given && prefixes.len() < MOST_PREFIXES {
            prefixes.push(prefix);
        }
    }
    let mut spaces = String::new();
    for prefix in prefixes {
        for part in [" xmlns:", prefix, "=\"urn:undeclared:", prefix, "\""] {
            spaces.push_str(part);
        }
    }
    format!("{}{spaces}{}", &text[..at], &text[at..])
}

/// Where the name of the root element ends.
fn root_name_end(text: &str) -> Option<usize> {
    let mut at = 0;
    loop {
        at += text[at..].find('<')?;
        let rest = &text[at..];
        let skipped = if rest.starts_with("<!--") {
            rest.find("-->")? + 3
        } else if rest.starts_with("<?") {
            rest.find("?>")? + 2
        } else if rest.starts_with("<!") {
            return None;
        } else {
            let name =
                rest[1..].find(|each: char| each.is_whitespace() || matches!(each, '>' | '/'))?;
            return Some(at + 1 + name);
        };
        at += skipped;
    }
}

#[cfg(test)]
mod tests {
    use super::declared;
    use roxmltree::Document;

    #[test]
    fn prefixes_of_foreign_blocks_are_declared() {
        let text =
            "<?xml version='1.0'?><!-- <a:b/> -->\n<robot name='r'><drake:joint drake:kind='ball'>
            <sensor:ray/></drake:joint></robot>";
        assert!(Document::parse(text).is_err());
        let mended = declared(text);
        assert!(Document::parse(&mended).is_ok());
        assert_eq!(declared(""), "");
        assert_eq!(declared("<!DOCTYPE a><a:b/>"), "<!DOCTYPE a><a:b/>");
    }
}
