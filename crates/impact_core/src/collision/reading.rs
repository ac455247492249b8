//! Golden cases as collisions.

use std::sync::Arc;

use serde_json::Value;

use super::{Braking, Collision, Region, SupportedBody};
use crate::covering::{
    Bottoming, Covering, GibsonAshby, Material, Pad, Rate, Shape, Table, Unloading,
};
use crate::error::{Failure, Given, Result};

/// A number of a case, or what stands for an absent one.
pub fn number_or(value: &Value, name: &str, absent: f64) -> f64 {
    value[name].as_f64().unwrap_or(absent)
}

fn unknown(name: &str, word: &str) -> Failure {
    Failure::invalid(name, "be known", Given::Word(word.to_owned()))
}

fn numbers(value: &Value) -> Vec<f64> {
    let each = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
    value
        .as_array()
        .map(|array| array.iter().map(each).collect())
        .unwrap_or_default()
}

fn material(value: &Value) -> Result<Material> {
    let of = |name: &str| number_or(value, name, f64::NAN);
    Ok(match value["law"].as_str().unwrap_or("") {
        "linear" => Material::Linear { modulus: of("E") },
        "gibson_ashby" => Material::GibsonAshby(GibsonAshby::new([
            of("E"),
            of("plateau"),
            of("e_D"),
            number_or(value, "D", 2.3),
            number_or(value, "m", 1.0),
        ])),
        "rusch" => Material::Rusch {
            a: of("a"),
            p: of("p"),
            b: of("b"),
            q: of("q"),
        },
        "avalle" => Material::Avalle {
            plateau: of("A"),
            modulus: of("E"),
            m: of("m"),
            b: of("B"),
            n: of("n"),
        },
        "table" => Material::Table(Arc::new(Table::new(
            numbers(&value["strain"]),
            numbers(&value["stress"]),
        )?)),
        other => return Err(unknown("law", other)),
    })
}

/// The covering of a case; a covering without thickness is 10 mm thick.
pub fn pad(value: &Value) -> Result<Pad> {
    let of = |name: &str| number_or(value, name, f64::NAN);
    let shape = match value["shape"].as_str().unwrap_or("") {
        "flat" => Shape::Flat { area: of("area") },
        "sphere" => Shape::Curved {
            radii: [of("radius"); 2],
        },
        "cylinder" => Shape::Cylinder {
            radius: of("radius"),
            length: of("length"),
        },
        other => return Err(unknown("shape", other)),
    };
    let rate = numbers(&value["rate"]);
    let unloading = numbers(&value["unloading"]);
    let bottom = numbers(&value["bottom"]);
    let covering = Covering {
        material: material(&value["material"])?,
        thickness: number_or(value, "thickness", 0.01),
        shape,
        damping: number_or(value, "damping", 0.0),
        rate: rate.get(..3).map_or(Rate::default(), |rate| Rate {
            base: rate[0],
            slope: rate[1],
            reference: rate[2],
        }),
        unloading: unloading
            .get(..2)
            .map_or(Unloading::default(), |pair| Unloading {
                retained: pair[0],
                exponent: pair[1],
            }),
        bottoming: bottom
            .get(..2)
            .map_or(Bottoming::default(), |pair| Bottoming {
                strain: pair[0],
                stiffness: pair[1],
            }),
    };
    covering.prepared()
}

/// The region of a case.
pub fn region(value: &Value) -> Region {
    match (value["k"].as_f64(), value["n"].as_f64()) {
        (None, _) => Region::Rigid,
        (Some(stiffness), Some(exponent)) => Region::Power {
            stiffness,
            exponent,
        },
        (Some(stiffness), None) => Region::Spring {
            stiffness,
            cubic: number_or(value, "k3", 0.0),
        },
    }
}

/// A case as a collision.
pub fn collision<'a>(input: &Value, pad: Option<&'a Pad>, tolerance: f64) -> Collision<'a> {
    let of = |name: &str| number_or(input, name, 0.0);
    let stop = numbers(&input["stop"]);
    Collision {
        robot: SupportedBody {
            mass: of("robot_mass"),
            damping: of("robot_damping"),
            stiffness: of("robot_stiffness"),
        },
        body: SupportedBody {
            mass: number_or(input, "body_mass", f64::INFINITY),
            damping: of("body_damping"),
            stiffness: of("body_stiffness"),
        },
        region: region(&input["region"]),
        pad,
        closing_speed: of("closing_speed"),
        stop: stop.get(..2).map(|pair| Braking {
            time: pair[0],
            deceleration: pair[1],
        }),
        driven: None,
        horizon: number_or(input, "horizon", 0.2),
        tolerance,
    }
}
