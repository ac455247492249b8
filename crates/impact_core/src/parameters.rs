//! Manipulator, foam, head and the system they make.

use crate::error::{Failure, Given, Result, not_negative, positive};

/// Standard acceleration of gravity, in m/s^2.
pub const GRAVITY: f64 = 9.806_65;

/// Manipulator at the impact point: a mass, a damper and a spring to a moving set-point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Manipulator {
    /// Effective mass `M_r`, in kg.
    pub mass: f64,
    /// Effective damping `C_r`, in N s/m.
    pub damping: f64,
    /// Effective stiffness `K_r`, in N/m.
    pub stiffness: f64,
}

/// Head on a neck that stands on a heavy torso.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Head {
    /// Mass of the head `M_h`, in kg.
    pub mass: f64,
    /// Damping of the neck `C_h`, in N s/m.
    pub damping: f64,
    /// Stiffness of the neck `K_h`, in N/m.
    pub stiffness: f64,
}

/// Foam between manipulator and head: a spring and a damper side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foam {
    /// Stiffness `K_c`, in N/m.
    pub stiffness: f64,
    /// Damping `C_c`, in N s/m.
    pub damping: f64,
    /// Thickness `T_u`, in m.
    pub thickness: f64,
    /// Largest compression `lambda` of the linear range, in m; at most the thickness.
    pub linear_range: f64,
}

/// Head that the foam hits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// A head that can move.
    Free(Head),
    /// A head against a wall.
    Constrained,
}

/// Manipulator, foam and head.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct System {
    /// The manipulator.
    pub manipulator: Manipulator,
    /// The foam.
    pub foam: Foam,
    /// The head.
    pub head: Target,
}

/// Direct-drive manipulator of Table 3.1.
pub const MANIPULATOR_1: Manipulator = Manipulator {
    mass: 9.6,
    damping: 250.0,
    stiffness: 20.0e3,
};

/// Puma 560 of Table 3.1.
pub const MANIPULATOR_2: Manipulator = Manipulator {
    mass: 49.4,
    damping: 111.0,
    stiffness: 14.4e3,
};

/// Foam 1 of Table 3.3.
pub const FOAM_1: Foam = Foam::of_source(24.3e3, 71.9);
/// Foam 2 of Table 3.3 as printed.
pub const FOAM_2: Foam = Foam::of_source(13.8e3, 43.8);
/// Foam 3 of Table 3.3.
pub const FOAM_3: Foam = Foam::of_source(60.6e3, 113.6);

/// Lightest head on the softest neck, for accelerations.
pub const HEAD_MINIMUM: Head = Head {
    mass: 4.4,
    damping: 46.0,
    stiffness: 3.0e3,
};

/// Heaviest head on the hardest neck, for forces and compressions.
pub const HEAD_MAXIMUM: Head = Head {
    mass: 5.3,
    damping: 130.0,
    stiffness: 5.0e3,
};

/// Head of the experimental apparatus of chapter 4.
pub const HEAD_APPARATUS: Head = Head {
    mass: 4.4,
    damping: 0.0,
    stiffness: 4.0e3,
};

impl Manipulator {
    /// Returns the manipulator if its values are valid.
    ///
    /// # Errors
    /// Names the number that is out of range.
    pub fn checked(self) -> Result<Self> {
        positive("mass", self.mass)?;
        not_negative("damping", self.damping)?;
        not_negative("stiffness", self.stiffness)?;
        Ok(self)
    }
}

impl Head {
    /// Returns the head if its values are valid.
    ///
    /// # Errors
    /// Names the number that is out of range.
    pub fn checked(self) -> Result<Self> {
        positive("mass", self.mass)?;
        not_negative("damping", self.damping)?;
        not_negative("stiffness", self.stiffness)?;
        Ok(self)
    }
}

impl Foam {
    /// A foam of the source: 25.4 mm thick, linear up to 20 mm.
    const fn of_source(stiffness: f64, damping: f64) -> Self {
        Self {
            stiffness,
            damping,
            thickness: 0.0254,
            linear_range: 0.02,
        }
    }

    /// Returns the foam if its values are valid.
    ///
    /// # Errors
    /// Names the number that is out of range.
    pub fn checked(self) -> Result<Self> {
        not_negative("stiffness", self.stiffness)?;
        not_negative("damping", self.damping)?;
        positive("thickness", self.thickness)?;
        positive("linear_range", self.linear_range)?;
        if self.linear_range > self.thickness {
            let rule = format!("be at most the thickness of {} m", self.thickness);
            let failure = Failure::invalid("linear_range", rule, Given::Number(self.linear_range));
            return Err(failure.mended_by(
                "give the thickness as well, or leave linear_range out for the smaller of 0.02 m \
                 and 0.8 of the thickness",
            ));
        }
        Ok(self)
    }
}

impl System {
    /// Returns the system if its parts are valid.
    ///
    /// # Errors
    /// Names the number that is out of range.
    pub fn checked(self) -> Result<Self> {
        self.manipulator
            .checked()
            .map_err(|error| error.within("manipulator"))?;
        self.foam.checked().map_err(|error| error.within("foam"))?;
        if let Target::Free(head) = self.head {
            head.checked().map_err(|error| error.within("head"))?;
        }
        Ok(self)
    }
}
