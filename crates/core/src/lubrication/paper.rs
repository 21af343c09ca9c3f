//! Eqs. 5-10 of "Belt Fuser Torque" (NIP31, 2015), exactly as the paper has them.
//!
//! Conventions: `speed` is the mean entrainment speed ubar = (u1 + u2)/2 in m/s, the sliding speed is
//! U = 2 ubar (heater at rest); `modulus` is E' = 2/[(1-nu1^2)/E1 + (1-nu2^2)/E2]; `load` is the whole load N
//! and `length` the length L of the roll. Eqs. 8-10 are regressions whose exponents do not cancel the unit of
//! length exactly: they hold in metres.

use crate::error::{Error, above};

/// What the paper's chain takes, SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nip {
    /// Pressure-viscosity coefficient alpha, 1/Pa.
    pub pressure_viscosity: f64,
    /// Viscosity eta, Pa s.
    pub viscosity: f64,
    /// Mean entrainment speed ubar, m/s.
    pub speed: f64,
    /// Load N, N.
    pub load: f64,
    /// Roll length L, m.
    pub length: f64,
    /// Rubber thickness h, m.
    pub thickness: f64,
    /// Reduced radius R, m: that of the roll where the heater is flat.
    pub radius: f64,
    /// Effective modulus E', Pa.
    pub modulus: f64,
}

impl Nip {
    /// The nip, checked.
    ///
    /// # Errors
    /// If a value is not positive and finite.
    pub fn checked(self) -> Result<Self, Error> {
        above("pressure-viscosity coefficient", self.pressure_viscosity, 0.0)?;
        above("viscosity", self.viscosity, 0.0)?;
        above("entrainment speed", self.speed, 0.0)?;
        above("load", self.load, 0.0)?;
        above("roll length", self.length, 0.0)?;
        above("rubber thickness", self.thickness, 0.0)?;
        above("radius", self.radius, 0.0)?;
        above("effective modulus", self.modulus, 0.0)?;
        Ok(self)
    }

    /// Eq. 5, film thickness (m): `1.6 alpha^0.6 (eta ubar)^0.7 E'^0.03 R^0.43 (N/L)^-0.13`.
    #[must_use]
    pub fn film_thickness(&self) -> f64 {
        1.6 * self.pressure_viscosity.powf(0.6)
            * (self.viscosity * self.speed).powf(0.7)
            * self.modulus.powf(0.03)
            * self.radius.powf(0.43)
            * (self.load / self.length).powf(-0.13)
    }

    /// Eq. 6, shear stress (Pa): `eta U/delta` with the film of Eq. 5.
    #[must_use]
    pub fn shear_stress(&self) -> f64 {
        self.viscosity * 2.0 * self.speed / self.film_thickness()
    }

    /// Eq. 7, torque (N m): `eta U/delta nip L R` with the film of Eq. 5 and the nip of Eq. 8.
    #[must_use]
    pub fn torque(&self) -> f64 {
        self.shear_stress() * self.nip_width() * self.length * self.radius
    }

    /// Eq. 8, nip width (m), recovered from Eqs. 5, 7 and 9: `2.115 (N R/(L E'))^0.32 h^0.37`.
    #[must_use]
    pub fn nip_width(&self) -> f64 {
        2.115
            * (self.load * self.radius / (self.length * self.modulus)).powf(0.32)
            * self.thickness.powf(0.37)
    }

    /// Eq. 9, torque (N m):
    /// `2.644 alpha^-0.6 (eta ubar)^0.3 N^0.45 L^0.55 h^0.37 R^0.89 E'^-0.35`.
    #[must_use]
    pub fn torque_in_full(&self) -> f64 {
        2.644
            * self.pressure_viscosity.powf(-0.6)
            * (self.viscosity * self.speed).powf(0.3)
            * self.load.powf(0.45)
            * self.length.powf(0.55)
            * self.thickness.powf(0.37)
            * self.radius.powf(0.89)
            * self.modulus.powf(-0.35)
    }

    /// Eq. 10, damping as torque over ubar (N s): Eq. 9 with `eta^0.3 ubar^-0.7` for `(eta ubar)^0.3`.
    #[must_use]
    pub fn damping(&self) -> f64 {
        2.644
            * self.pressure_viscosity.powf(-0.6)
            * self.viscosity.powf(0.3)
            * self.speed.powf(-0.7)
            * self.load.powf(0.45)
            * self.length.powf(0.55)
            * self.thickness.powf(0.37)
            * self.radius.powf(0.89)
            * self.modulus.powf(-0.35)
    }
}

/// Ratios of nip width to rubber thickness within which Eq. 8 is within 16 % of the exact contact, for
/// Poisson's ratio from 0.45 to 0.5 and rubber of some millimetres.
pub const NIP_RATIO_RANGE: (f64, f64) = (1.0, 4.0);
