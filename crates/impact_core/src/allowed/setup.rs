//! Contacts made from rows of numbers.

use numeric::threads::Interrupted;

use super::row::{
    AREA, BACKING, BODY_DAMPING, BODY_MASS, BODY_STIFFNESS, BOTTOMING, CLOSING_SPEED, DAMPING,
    DETECTION_FORCE, FORCE_LIMIT, HORIZON, Kind, LENGTH, Outline, PUSH_LIMIT, RADIUS, RATE_BASE,
    RATE_REFERENCE, RATE_SLOPE, RETAINED, ROBOT_DAMPING, ROBOT_MASS, ROBOT_STIFFNESS, Row,
    SECOND_RADIUS, STOP_DECELERATION, STOP_TIME, THICKNESS, UNLOADING_EXPONENT, given,
};
use super::{
    Allowed, LimitedContact, Limits, SpeedStatus, Stored, Thickness, least_thickness, numeric_speed,
};
use crate::collision::{Braking, Collision, Driven, Outcome, Region, Wanted, simulate};
use crate::covering::{Bottoming, Covering, Material, Pad, Rate, Shape, Unloading};
use crate::error::{Failure, Given as Shown, Result, positive};

/// Contact of rows that differ in their masses only, computed once.
#[derive(Clone, Debug)]
pub struct PreparedContact {
    pad: Option<Pad>,
    /// Energy of the bare region at the force limit in J, NaN without one.
    bare_energy: f64,
    stored: Stored,
    /// Whether the stored energy is all there is.
    at_rest: bool,
    area: Option<f64>,
    limits: Limits,
}

/// Recipe of contacts from rows.
#[derive(Clone, Debug)]
pub struct Setup {
    /// Kinds of covering and region, shared by all rows.
    pub kind: Kind,
    /// Relative tolerance of simulations.
    pub tolerance: f64,
}

impl Setup {
    /// The law of a row, for rows that share its numbers.
    ///
    /// # Errors
    /// A number of the law is out of its range.
    pub fn material(&self, row: &Row) -> Result<Option<Material>> {
        let law = self.kind.covering.as_ref();
        law.map(|(law, _)| row.material(law)).transpose()
    }

    /// The covering of a row.
    ///
    /// # Errors
    /// A number is out of its range.
    pub fn pad(&self, row: &Row, fixed: Option<&Material>) -> Result<Option<Pad>> {
        let Some((law, outline)) = &self.kind.covering else {
            return Ok(None);
        };
        let number = |place: usize| row.0[place];
        let covering = Covering {
            material: match fixed {
                Some(material) => material.clone(),
                None => row.material(law)?,
            },
            thickness: number(THICKNESS),
            shape: match outline {
                Outline::Flat => Shape::Flat { area: number(AREA) },
                Outline::Curved => Shape::Curved {
                    radii: [
                        number(RADIUS),
                        given(number(SECOND_RADIUS)).unwrap_or(number(RADIUS)),
                    ],
                },
                Outline::Cylinder => Shape::Cylinder {
                    radius: number(RADIUS),
                    length: number(LENGTH),
                },
            },
            damping: number(DAMPING),
            rate: Rate {
                base: number(RATE_BASE),
                slope: number(RATE_SLOPE),
                reference: number(RATE_REFERENCE),
            },
            unloading: Unloading {
                retained: number(RETAINED),
                exponent: number(UNLOADING_EXPONENT),
            },
            bottoming: Bottoming {
                strain: number(BOTTOMING),
                stiffness: number(BACKING),
            },
        };
        covering
            .check_numbers()
            .map_err(|failure| failure.within("covering"))?;
        Ok(Some(Pad::new(covering)))
    }

    /// The collision of a row.
    ///
    /// # Errors
    /// A number is out of its range.
    pub fn collision<'a>(&self, row: &Row, pad: Option<&'a Pad>) -> Result<Collision<'a>> {
        let stop = given(row.0[STOP_TIME]).map(|time| Braking {
            time,
            deceleration: row.0[STOP_DECELERATION],
        });
        let driven = given(row.0[DETECTION_FORCE]).map(|detection_force| Driven {
            detection_force,
            push_limit: given(row.0[PUSH_LIMIT]).unwrap_or(f64::INFINITY),
        });
        let collision = Collision {
            robot: row.body([ROBOT_MASS, ROBOT_DAMPING, ROBOT_STIFFNESS]),
            body: row.body([BODY_MASS, BODY_DAMPING, BODY_STIFFNESS]),
            region: row.region(self.kind.region)?,
            pad,
            closing_speed: row.0[CLOSING_SPEED],
            stop,
            driven,
            horizon: row.0[HORIZON],
            tolerance: self.tolerance,
        };
        collision.check()?;
        Ok(collision)
    }

    /// The contact of a row at rest.
    ///
    /// # Errors
    /// A number is out of its range.
    pub fn contact<'a>(&self, row: &Row, pad: Option<&'a Pad>) -> Result<LimitedContact<'a>> {
        row.check_masses()?;
        let region = row.region(self.kind.region)?;
        if pad.is_none() && region == Region::Rigid {
            let given = Shown::Found("none on a rigid region".into());
            return Err(Failure::invalid(
                "covering",
                "be given, or the region yield",
                given,
            ));
        }
        let area = given(row.0[AREA]).filter(|_| pad.is_none());
        if let Some(area) = area {
            positive("area", area)?;
        }
        let limits = row.limits();
        limits.check(pad)?;
        Ok(LimitedContact {
            robot_mass: row.0[ROBOT_MASS],
            body_mass: row.0[BODY_MASS],
            region,
            pad,
            area,
            limits,
        })
    }

    /// Allowed speed of a row from the stored energy.
    ///
    /// # Errors
    /// A number is out of its range.
    pub fn closed_form(&self, row: &Row, fixed: Option<&Material>) -> Result<Allowed> {
        let pad = self.pad(row, fixed)?;
        Ok(self.contact(row, pad.as_ref())?.closed_form())
    }

    /// Allowed speed of a row: from the stored energy where that is exact, by simulation elsewhere; and that
    /// at the force limit without the covering. What was known of a row that differs in its masses
    /// only is used again.
    ///
    /// # Errors
    /// A number is out of its range.
    pub fn allowed(
        &self,
        row: &Row,
        fixed: Option<&Material>,
        known: &mut Option<PreparedContact>,
        interrupted: Interrupted<'_>,
    ) -> Result<(Allowed, f64)> {
        let known = match known {
            Some(known) => {
                row.check_masses()?;
                known
            }
            None => known.insert(self.known(row, fixed)?),
        };
        let mass = crate::collision::reduced_mass(row.0[ROBOT_MASS], row.0[BODY_MASS]);
        let bare = (2.0 * known.bare_energy / mass).sqrt();
        let closed = known.stored.allowed(mass);
        if known.at_rest || closed.status == SpeedStatus::UnboundedMass {
            return Ok((closed, bare));
        }
        let moving = Row({
            let mut numbers = row.0;
            numbers[CLOSING_SPEED] = 1.0;
            numbers
        });
        let collision = self.collision(&moving, known.pad.as_ref())?;
        let limited = (&known.limits, known.area);
        let found = numeric_speed(&collision, limited, closed.speed, interrupted);
        Ok((found, bare))
    }

    /// Part of a contact that does not depend on the masses of its row.
    fn known(&self, row: &Row, fixed: Option<&Material>) -> Result<PreparedContact> {
        let pad = self.pad(row, fixed)?;
        let contact = self.contact(row, pad.as_ref())?;
        let bare_energy = match row.0[FORCE_LIMIT] {
            force if contact.region == Region::Rigid || force.is_nan() => f64::NAN,
            force => contact.region.work(force),
        };
        let elastic = pad
            .as_ref()
            .is_none_or(|pad| pad.covering.damping == 0.0 && pad.covering.rate.is_none());
        let held = [ROBOT_DAMPING, ROBOT_STIFFNESS, BODY_DAMPING, BODY_STIFFNESS];
        let free = held.iter().all(|place| row.0[*place] == 0.0) && row.0[STOP_TIME].is_nan();
        Ok(PreparedContact {
            bare_energy,
            stored: contact.stored(),
            at_rest: elastic && free,
            area: contact.area,
            limits: contact.limits,
            pad,
        })
    }

    /// Least thickness for the closing speed of a row.
    ///
    /// # Errors
    /// A number is out of its range, there is no covering, or it has a damper or a rate.
    pub fn thickness(&self, row: &Row, fixed: Option<&Material>) -> Result<Thickness> {
        let missing = || {
            let given = Shown::Found("none".into());
            Failure::invalid("covering", "be given", given)
        };
        let pad = self.pad(row, fixed)?.ok_or_else(missing)?;
        if pad.covering.damping > 0.0 || !pad.covering.rate.is_none() {
            let rule = "have neither damping nor rate: a least thickness is from stored energy";
            return Err(Failure::invalid(
                "covering",
                rule,
                Shown::Number(pad.covering.damping),
            ));
        }
        let speed = positive("closing_speed", row.0[CLOSING_SPEED])?;
        let contact = self.contact(row, Some(&pad))?;
        Ok(least_thickness(&contact, &pad, speed))
    }

    /// Loads of a row.
    ///
    /// # Errors
    /// A number is out of its range.
    pub fn collide(
        &self,
        row: &Row,
        fixed: Option<&Material>,
        wanted: Wanted,
        interrupted: Interrupted<'_>,
    ) -> Result<Outcome> {
        let pad = self.pad(row, fixed)?;
        let collision = self.moving(row, pad.as_ref())?;
        Ok(simulate(&collision, wanted, interrupted))
    }

    /// The collision of a row that comes to an end.
    ///
    /// # Errors
    /// A number is out of its range.
    pub fn moving<'a>(&self, row: &Row, pad: Option<&'a Pad>) -> Result<Collision<'a>> {
        let collision = self.collision(row, pad)?;
        if collision.reduced_mass().is_infinite() {
            let rule = "be finite against a clamped body";
            return Err(Failure::invalid(
                "robot_mass",
                rule,
                Shown::Number(f64::INFINITY),
            ));
        }
        Ok(collision)
    }
}
