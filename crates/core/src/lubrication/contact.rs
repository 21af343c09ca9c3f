//! Moduli, Hertz's contacts, rubber hardness.

use std::f64::consts::PI;

use crate::error::{Error, above, at_least, at_most, below};

/// Elastic constants of a body; rigid if the modulus is infinite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solid {
    /// Young's modulus, Pa.
    pub modulus: f64,
    /// Poisson's ratio.
    pub poisson_ratio: f64,
}

impl Solid {
    /// (1 - nu^2)/E, 1/Pa.
    fn compliance(&self) -> Result<f64, Error> {
        poisson(self.poisson_ratio)?;
        if self.modulus == f64::INFINITY {
            return Ok(0.0);
        }
        Ok((1.0 - self.poisson_ratio.powi(2)) / above("modulus", self.modulus, 0.0)?)
    }
}

/// A Poisson's ratio from 0 to 0.5.
pub(crate) fn poisson(ratio: f64) -> Result<f64, Error> {
    at_most("Poisson's ratio", at_least("Poisson's ratio", ratio, 0.0)?, 0.5)
}

/// Effective modulus E' = 2/[(1-nu1^2)/E1 + (1-nu2^2)/E2], Pa.
///
/// # Errors
/// If a constant is out of range, or both bodies are rigid.
pub fn effective_modulus(one: Solid, other: Solid) -> Result<f64, Error> {
    let compliance = one.compliance()? + other.compliance()?;
    Ok(2.0 / above("compliance of the bodies together", compliance, 0.0)?)
}

/// Reduced radius 1/(1/R1 + 1/R2), m; a plane has an infinite radius, a hollow a negative one.
///
/// # Errors
/// If the bodies fit into each other without a gap.
pub fn reduced_radius(one: f64, other: f64) -> Result<f64, Error> {
    let curvature = above("sum of the curvatures", 1.0 / one + 1.0 / other, 0.0)?;
    Ok(1.0 / curvature)
}

/// Young's modulus of rubber (Pa) of a Shore A hardness, by Gent.
///
/// `E = 0.0981e6 (56 + 7.62336 S)/(0.137505 (254 - 2.54 S))` (A. N. Gent, Rubber Chem. Technol. 31 (1958)
/// 896); rules differ by 20 to 30 %.
///
/// # Errors
/// If the hardness is not between 20 and 80, where the rule holds.
pub fn shore_a_modulus(hardness: f64) -> Result<f64, Error> {
    at_most("Shore A hardness", at_least("Shore A hardness", hardness, 20.0)?, 80.0)?;
    Ok(1e6 * 0.0981 * (56.0 + 7.62336 * hardness) / (0.137_505 * (254.0 - 2.54 * hardness)))
}

/// Half-width or radius of a contact and its greatest pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hertz {
    /// Half-width of a line, or radius of a point contact, m.
    pub half_width: f64,
    /// Pa.
    pub pressure_max: f64,
}

/// Hertz's line contact: load per length (N/m), reduced radius (m), effective modulus E' (Pa).
///
/// # Errors
/// If a value is not positive.
pub fn hertz_line(load: f64, radius: f64, modulus: f64) -> Result<Hertz, Error> {
    positive(load, radius, modulus)?;
    let half_width = (8.0 * load * radius / (PI * modulus)).sqrt();
    Ok(Hertz { half_width, pressure_max: 2.0 * load / (PI * half_width) })
}

/// Hertz's contact of spheres: load (N), reduced radius (m), effective modulus E' (Pa).
///
/// # Errors
/// If a value is not positive.
pub fn hertz_point(load: f64, radius: f64, modulus: f64) -> Result<Hertz, Error> {
    positive(load, radius, modulus)?;
    let half_width = (1.5 * load * radius / modulus).cbrt();
    Ok(Hertz { half_width, pressure_max: 1.5 * load / (PI * half_width * half_width) })
}

fn positive(load: f64, radius: f64, modulus: f64) -> Result<(), Error> {
    above("load", load, 0.0)?;
    below("radius", above("radius", radius, 0.0)?, f64::INFINITY)?;
    above("effective modulus", modulus, 0.0)?;
    Ok(())
}
