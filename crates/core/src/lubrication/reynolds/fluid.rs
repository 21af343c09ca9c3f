//! Viscosity and density of the lubricant against pressure.

use crate::error::{Error, above, at_least};

/// Pole pressure of Roelands' law, Pa.
const ROELANDS_PRESSURE: f64 = 1.96e8;
/// Logarithm of the pole viscosity 6.31e-5 Pa s, with its sign turned.
const ROELANDS_VISCOSITY: f64 = 9.67;
/// Greatest logarithm of the viscosity ratio that is followed.
const GREATEST_LOGARITHM: f64 = 600.0;
/// Constants of the Dowson-Higginson density: (5.9e8 + 1.34 p)/(5.9e8 + p).
const DENSITY: (f64, f64) = (5.9e8, 1.34);

/// How viscosity rises with pressure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Thickening {
    /// Barus: exp(alpha p).
    Barus,
    /// Roelands, with the slope alpha at zero pressure.
    Roelands,
}

/// A Newtonian lubricant at constant temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fluid {
    /// Viscosity at zero pressure, Pa s.
    pub viscosity: f64,
    /// Pressure coefficient alpha, 1/Pa; 0 for an isoviscous lubricant.
    pub pressure_viscosity: f64,
    /// The law that alpha belongs to.
    pub thickening: Thickening,
    /// Whether the density follows Dowson and Higginson.
    pub compressible: bool,
}

impl Fluid {
    /// The fluid if its numbers can be used.
    ///
    /// # Errors
    /// If viscosity is not positive, or at or below Roelands' pole with that law, or alpha is negative.
    pub fn checked(self) -> Result<Self, Error> {
        above("viscosity", self.viscosity, 0.0)?;
        at_least("pressure_viscosity", self.pressure_viscosity, 0.0)?;
        if self.thickening == Thickening::Roelands && self.pressure_viscosity > 0.0 {
            above("viscosity", self.viscosity, (-ROELANDS_VISCOSITY).exp())?;
        }
        Ok(self)
    }

    /// Viscosity over that at zero pressure, and its derivative to pressure.
    #[must_use]
    pub fn viscosity_ratio(&self, pressure: f64) -> (f64, f64) {
        let alpha = self.pressure_viscosity;
        if alpha == 0.0 {
            return (1.0, 0.0);
        }
        let (logarithm, slope) = match self.thickening {
            Thickening::Barus => (alpha * pressure, alpha),
            Thickening::Roelands => {
                let depth = self.viscosity.ln() + ROELANDS_VISCOSITY;
                let z = alpha * ROELANDS_PRESSURE / depth;
                let base = (1.0 + pressure / ROELANDS_PRESSURE).max(0.1);
                (depth * (base.powf(z) - 1.0), alpha * base.powf(z - 1.0))
            }
        };
        if logarithm > GREATEST_LOGARITHM {
            return (GREATEST_LOGARITHM.exp(), 0.0);
        }
        let ratio = logarithm.exp();
        (ratio, ratio * slope)
    }

    /// Density over that at zero pressure, and its derivative to pressure.
    #[must_use]
    pub fn density_ratio(&self, pressure: f64) -> (f64, f64) {
        if !self.compressible {
            return (1.0, 0.0);
        }
        let (pole, factor) = DENSITY;
        let pressure = pressure.max(-0.5 * pole);
        let below = pole + pressure;
        ((pole + factor * pressure) / below, pole * (factor - 1.0) / (below * below))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_are_those_of_the_ratios() {
        for thickening in [Thickening::Barus, Thickening::Roelands] {
            let fluid = Fluid {
                viscosity: 0.08,
                pressure_viscosity: 1.8e-8,
                thickening,
                compressible: true,
            };
            for pressure in [0.0, 2e7, 4e8, 1.2e9] {
                let by = 1e-5 * (pressure + 1e6);
                let change = |of: fn(&Fluid, f64) -> (f64, f64)| {
                    let slope =
                        (of(&fluid, pressure + by).0 - of(&fluid, pressure - by).0) / (2.0 * by);
                    slope / of(&fluid, pressure).1
                };
                assert!((change(Fluid::viscosity_ratio) - 1.0).abs() < 1e-5);
                assert!((change(Fluid::density_ratio) - 1.0).abs() < 1e-5);
            }
            // what would leave the range of numbers is held
            assert_eq!(fluid.viscosity_ratio(1e13), (600_f64.exp(), 0.0));
            let plain = Fluid { pressure_viscosity: 0.0, compressible: false, ..fluid };
            assert_eq!(plain.viscosity_ratio(1e9), (1.0, 0.0));
            assert_eq!(plain.density_ratio(1e9), (1.0, 0.0));
        }
    }

    #[test]
    fn roelands_begins_above_its_pole() {
        let fluid = |viscosity, pressure_viscosity, thickening| {
            Fluid { viscosity, pressure_viscosity, thickening, compressible: false }.checked()
        };
        // the pole is at 6.31e-5 Pa s
        assert!(fluid(6.3e-5, 1e-8, Thickening::Roelands).is_err());
        assert!(fluid(6.4e-5, 1e-8, Thickening::Roelands).is_ok());
        assert!(fluid(6.3e-5, 0.0, Thickening::Roelands).is_ok());
        assert!(fluid(6.3e-5, 1e-8, Thickening::Barus).is_ok());
        assert!(fluid(0.0, 1e-8, Thickening::Barus).is_err());
        assert!(fluid(0.1, -1e-8, Thickening::Barus).is_err());
    }
}
