//! How a law of drag varies with temperature.

use crate::error::{Error, above, at_least, finite};
use crate::lubrication::viscosity;

/// What moves the speeds of a law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SpeedLaw {
    /// Speeds as `(T/reference)^exponent`.
    Power(f64),
    /// Speeds as the inverse of a viscosity, since film and transition hang on viscosity times speed; the temperature
    /// is absolute, in K.
    Viscosity(viscosity::TemperatureLaw),
}

/// How a law varies with temperature: its shape over the logarithm of speed stays, and moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TemperatureLaw {
    /// Temperature at which the law is given, in the scale of its exponents.
    pub reference: f64,
    /// Forces of the contact vary as `(T/reference)^force_exponent`.
    pub force_exponent: f64,
    /// Speeds of the law, the stick speed among them.
    pub speed: SpeedLaw,
    /// Relative change of boundary friction per unit of temperature, where the law knows it apart.
    pub boundary_slope: f64,
    /// Relative change of the rest of the drive per unit of temperature.
    pub rest_slope: f64,
}

impl TemperatureLaw {
    /// A law of powers, as two fitted surfaces `B = a T^b w^c` that meet make it.
    #[must_use]
    pub fn powers(reference: f64, force_exponent: f64, speed_exponent: f64) -> Self {
        let speed = SpeedLaw::Power(speed_exponent);
        Self { reference, force_exponent, speed, boundary_slope: 0.0, rest_slope: 0.0 }
    }

    pub(super) fn check(&self) -> Result<(), Error> {
        above("reference_temperature", self.reference, 0.0)?;
        finite("force_temperature_exponent", self.force_exponent)?;
        if let SpeedLaw::Power(exponent) = self.speed {
            finite("speed_temperature_exponent", exponent)?;
        }
        finite("boundary_temperature_slope", self.boundary_slope)?;
        finite("rest_temperature_slope", self.rest_slope)?;
        self.speed_factor(self.reference).map(|_| ())
    }

    /// Factor of the forces of the contact at `temperature`.
    pub(crate) fn force_factor(&self, temperature: f64) -> f64 {
        (temperature / self.reference).powf(self.force_exponent)
    }

    /// Factor of the speeds at `temperature`.
    ///
    /// # Errors
    /// If the temperature is out of the range of the viscosity.
    pub(crate) fn speed_factor(&self, temperature: f64) -> Result<f64, Error> {
        match &self.speed {
            SpeedLaw::Power(exponent) => Ok((temperature / self.reference).powf(*exponent)),
            SpeedLaw::Viscosity(law) => {
                Ok(law.viscosity(self.reference)? / law.viscosity(temperature)?)
            }
        }
    }

    /// Factor of boundary friction at `temperature`.
    ///
    /// # Errors
    /// If it is not positive.
    pub(crate) fn boundary_factor(&self, temperature: f64) -> Result<f64, Error> {
        let factor = 1.0 + self.boundary_slope * (temperature - self.reference);
        above("boundary friction at this temperature", factor, 0.0)
    }

    /// Factor of the rest of the drive at `temperature`.
    ///
    /// # Errors
    /// If it is negative.
    pub(crate) fn rest_factor(&self, temperature: f64) -> Result<f64, Error> {
        let factor = 1.0 + self.rest_slope * (temperature - self.reference);
        at_least("rest of the drive at this temperature", factor, 0.0)
    }
}
