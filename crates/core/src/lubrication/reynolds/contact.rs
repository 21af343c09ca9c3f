//! A roll on an elastic surface: the numbers of a line contact.

use super::{Fluid, Foundation};
use crate::error::{Error, above, at_most, finite};

/// A roll on an elastic surface, flooded with lubricant, in steady motion; SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineContact {
    /// Radius of the roll, or reduced radius 1/(1/R1 + 1/R2), m.
    pub radius: f64,
    /// E* = 1/[(1-nu1^2)/E1 + (1-nu2^2)/E2], Pa; of a layer on its own, E/(1-nu^2).
    pub contact_modulus: f64,
    /// What gives way.
    pub foundation: Foundation,
    /// Load per length, N/m.
    pub load: f64,
    /// Mean of the surface speeds, m/s.
    pub entrainment_speed: f64,
    /// Speed of surface 1 less that of surface 2, m/s.
    pub sliding_speed: f64,
    /// The lubricant.
    pub fluid: Fluid,
}

impl LineContact {
    /// The contact if its numbers can be used.
    ///
    /// # Errors
    /// If a number is out of range, with its name.
    pub fn checked(self) -> Result<Self, Error> {
        above("radius", self.radius, 0.0)?;
        above("effective_modulus", 2.0 * self.contact_modulus, 0.0)?;
        above("load", self.load, 0.0)?;
        above("entrainment_speed", self.entrainment_speed, 0.0)?;
        finite("sliding_speed", self.sliding_speed)?;
        if let Foundation::Layer { thickness, poisson } = self.foundation {
            above("thickness", thickness, 0.0)?;
            above("poisson", poisson, -1.0)?;
            at_most("poisson", poisson, 0.5)?;
        }
        self.fluid.checked()?;
        Ok(self)
    }
}
