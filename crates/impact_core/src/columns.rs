//! Numbers of many impacts: the same for all rows, or one for each.

use crate::error::{Failure, Given, Result};
use crate::parameters::{Foam, Head, Manipulator, System, Target};

/// One input of every row.
#[derive(Clone, Copy, Debug)]
pub enum Column<'a> {
    /// One number for every row.
    Value(f64),
    /// A number for each row.
    Array(&'a [f64]),
}

impl Column<'_> {
    /// Number of a row.
    #[inline(always)]
    #[must_use]
    pub fn at(&self, row: usize) -> f64 {
        match self {
            Self::Value(value) => *value,
            Self::Array(values) => values[row],
        }
    }
}

/// Heads of every row.
#[derive(Clone, Copy, Debug)]
pub enum HeadColumns<'a> {
    /// Heads that can move.
    Free {
        /// `M_h`, in kg.
        mass: Column<'a>,
        /// `C_h`, in N s/m.
        damping: Column<'a>,
        /// `K_h`, in N/m.
        stiffness: Column<'a>,
    },
    /// Heads against a wall.
    Constrained,
}

/// Inputs of a batch; arrays are of one length.
#[derive(Clone, Copy, Debug)]
pub struct Columns<'a> {
    /// `M_r`, in kg.
    pub manipulator_mass: Column<'a>,
    /// `C_r`, in N s/m.
    pub manipulator_damping: Column<'a>,
    /// `K_r`, in N/m.
    pub manipulator_stiffness: Column<'a>,
    /// `K_c`, in N/m.
    pub foam_stiffness: Column<'a>,
    /// `C_c`, in N s/m.
    pub foam_damping: Column<'a>,
    /// `lambda`, in m.
    pub linear_range: Column<'a>,
    /// The heads.
    pub head: HeadColumns<'a>,
    /// `v_c`, in m/s.
    pub closing_speed: Column<'a>,
    /// `v_r`, in m/s; the closing speed when `None`.
    pub manipulator_speed: Option<Column<'a>>,
}

impl<'a> Columns<'a> {
    fn all(&self) -> impl Iterator<Item = Column<'a>> {
        let head = match self.head {
            HeadColumns::Free {
                mass,
                damping,
                stiffness,
            } => vec![mass, damping, stiffness],
            HeadColumns::Constrained => Vec::new(),
        };
        [
            self.manipulator_mass,
            self.manipulator_damping,
            self.manipulator_stiffness,
            self.foam_stiffness,
            self.foam_damping,
            self.linear_range,
            self.closing_speed,
        ]
        .into_iter()
        .chain(head)
        .chain(self.manipulator_speed)
    }

    /// Number of rows; 1 without an array.
    ///
    /// # Errors
    /// Two arrays have different lengths.
    pub fn rows(&self) -> Result<usize> {
        let mut rows = None;
        for column in self.all() {
            if let Column::Array(values) = column {
                if rows.is_some_and(|rows| rows != values.len()) {
                    let given = Given::Count(values.len() as u64);
                    return Err(Failure::invalid("columns", "have one length", given));
                }
                rows = Some(values.len());
            }
        }
        Ok(rows.unwrap_or(1))
    }

    /// System of a row.
    #[must_use]
    pub fn system(&self, row: usize) -> System {
        System {
            manipulator: Manipulator {
                mass: self.manipulator_mass.at(row),
                damping: self.manipulator_damping.at(row),
                stiffness: self.manipulator_stiffness.at(row),
            },
            foam: Foam {
                stiffness: self.foam_stiffness.at(row),
                damping: self.foam_damping.at(row),
                // Rows have none; crushed foams are found from the compression where it is known.
                thickness: f64::MAX,
                linear_range: self.linear_range.at(row),
            },
            head: match self.head {
                HeadColumns::Free {
                    mass,
                    damping,
                    stiffness,
                } => Target::Free(Head {
                    mass: mass.at(row),
                    damping: damping.at(row),
                    stiffness: stiffness.at(row),
                }),
                HeadColumns::Constrained => Target::Constrained,
            },
        }
    }

    /// Closing speed and speed of the manipulator of a row.
    #[must_use]
    pub fn speeds(&self, row: usize) -> [f64; 2] {
        let closing = self.closing_speed.at(row);
        let manipulator = self
            .manipulator_speed
            .map_or(closing, |column| column.at(row));
        [closing, manipulator]
    }
}
