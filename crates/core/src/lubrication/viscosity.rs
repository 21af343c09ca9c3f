//! Viscosity against temperature, pressure and shear rate.

use crate::error::{Error, above, at_least, at_most, finite};
use crate::wire::{Unreadable, exactly, kinds};

/// Molar gas constant, J/(mol K) (exact in SI since 2019).
pub const GAS_CONSTANT: f64 = 8.314_462_618_153_24;

/// One square millimetre per second (one centistokes), m^2/s.
pub(crate) const CENTISTOKES: f64 = 1e-6;

/// How viscosity falls as a lubricant warms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TemperatureLaw {
    /// `eta = prefactor exp(activation_energy/(R T))`.
    Arrhenius {
        /// Pa s.
        prefactor: f64,
        /// J/mol.
        activation_energy: f64,
    },
    /// Vogel-Fulcher-Tammann: `eta = prefactor exp(slope/(T - zero))`.
    Vogel {
        /// Pa s.
        prefactor: f64,
        /// K.
        slope: f64,
        /// K.
        zero: f64,
    },
    /// Walther, as ASTM D341: `lg lg Z = a - b lg T` with
    /// `Z = nu + 0.7 + exp(-1.47 - 1.84 nu - 0.51 nu^2)`, nu in mm^2/s.
    Walther {
        /// Intercept.
        a: f64,
        /// Slope.
        b: f64,
        /// kg/m^3.
        density: f64,
    },
}

kinds! {
    /// The laws of viscosity by their words: what all ways into the core know of them stands here and in `form`.
    ViscosityKind of "temperature_law" {
        /// As of `TemperatureLaw`, here and below.
        Arrhenius = "arrhenius",
        /// Vogel-Fulcher-Tammann.
        Vogel = "vogel",
        /// ASTM D341.
        Walther = "walther",
    }
}

/// What a law of viscosity is made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Form {
    /// Points through which it goes.
    pub points: usize,
    /// Whether it is one of kinematic viscosity, so that it needs a density.
    pub kinematic: bool,
    /// Its coefficients, in SI.
    pub coefficients: &'static [&'static str],
}

impl ViscosityKind {
    /// What a law of this kind is made of.
    #[must_use]
    pub const fn form(self) -> Form {
        let (points, kinematic, coefficients): (_, _, &[_]) = match self {
            Self::Arrhenius => (2, false, &["prefactor", "activation_energy"]),
            Self::Vogel => (3, false, &["prefactor", "slope", "zero"]),
            Self::Walther => (2, true, &["a", "b", "density"]),
        };
        Form { points, kinematic, coefficients }
    }
}

/// A temperature (K) and the viscosity there.
pub type Point = (f64, f64);

fn checked(points: &[Point]) -> Result<(), Error> {
    for (i, (temperature, viscosity)) in points.iter().enumerate() {
        above("temperature of a viscosity", *temperature, 0.0)?;
        above("viscosity", *viscosity, 0.0)?;
        if i > 0 && *temperature <= points[i - 1].0 {
            let quantity = "sequence of temperatures of the viscosities";
            return Err(Error::Backwards { quantity, index: i, value: *temperature });
        }
        if i > 0 && *viscosity >= points[i - 1].1 {
            let quantity = "viscosity at the higher temperature";
            return Err(Error::NotBelow { quantity, value: *viscosity, limit: points[i - 1].1 });
        }
    }
    Ok(())
}

impl TemperatureLaw {
    /// The Arrhenius law through two points of dynamic viscosity (Pa s), in ascending temperature (K).
    ///
    /// # Errors
    /// If a value is not positive, or viscosity does not fall with temperature.
    pub fn arrhenius(points: [Point; 2]) -> Result<Self, Error> {
        checked(&points)?;
        let [(t1, eta1), (t2, eta2)] = points;
        let slope = (eta1 / eta2).ln() / (1.0 / t1 - 1.0 / t2);
        let prefactor = eta1 * (-slope / t1).exp();
        Ok(Self::Arrhenius { prefactor, activation_energy: slope * GAS_CONSTANT })
    }

    /// The Vogel-Fulcher-Tammann law through three points of dynamic viscosity (Pa s).
    ///
    /// # Errors
    /// If a value is not positive, viscosity does not fall, or it falls ever more steeply in 1/T, which no
    /// such law does.
    pub fn vogel(points: [Point; 3]) -> Result<Self, Error> {
        checked(&points)?;
        let [(t1, eta1), (t2, eta2), (t3, eta3)] = points;
        let falls = (eta1 / eta2).ln() / (eta2 / eta3).ln();
        let ratio = falls * (t3 - t2) / (t2 - t1);
        above(
            "curvature of the viscosities (a Vogel law needs more fall where it is cold)",
            ratio,
            1.0,
        )?;
        let zero = (ratio * t1 - t3) / (ratio - 1.0);
        let slope = (eta1 / eta3).ln() / (1.0 / (t1 - zero) - 1.0 / (t3 - zero));
        let prefactor = eta1 * (-slope / (t1 - zero)).exp();
        finite("prefactor of the Vogel law", prefactor)?;
        Ok(Self::Vogel { prefactor, slope, zero })
    }

    /// Walther's law through two points of kinematic viscosity (m^2/s), at a density (kg/m^3).
    ///
    /// # Errors
    /// If a value is not positive, viscosity does not fall, or is below 0.21 mm^2/s, where the law ends.
    pub fn walther(points: [Point; 2], density: f64) -> Result<Self, Error> {
        checked(&points)?;
        above("density", density, 0.0)?;
        for (_, viscosity) in points {
            at_least("kinematic viscosity in mm^2/s", viscosity / CENTISTOKES, 0.21)?;
        }
        let [(t1, nu1), (t2, nu2)] = points;
        let y = |nu: f64| walther_z(nu / CENTISTOKES).log10().log10();
        let b = (y(nu1) - y(nu2)) / (t2 / t1).log10();
        Ok(Self::Walther { a: y(nu1) + b * t1.log10(), b, density })
    }

    /// The law of a kind through points of dynamic viscosity (Pa s); the density (kg/m^3) is for those that need one.
    ///
    /// # Errors
    /// If there are too few points or too many, the density is needed and missing, or the points do not fit the law.
    pub fn through(
        kind: ViscosityKind,
        points: &[Point],
        density: Option<f64>,
    ) -> Result<Self, Unreadable> {
        let needed = kind.form().points;
        let count = |_| Unreadable::Count { field: "points", found: points.len(), needed };
        Ok(match kind {
            ViscosityKind::Arrhenius => Self::arrhenius(points.try_into().map_err(count)?)?,
            ViscosityKind::Vogel => Self::vogel(points.try_into().map_err(count)?)?,
            ViscosityKind::Walther => {
                let choice = Some(("temperature_law", kind.word()));
                let density = density.ok_or(Unreadable::Missing { field: "density", choice })?;
                let points: [Point; 2] = points.try_into().map_err(count)?;
                Self::walther(points.map(|(t, eta)| (t, eta / density)), density)?
            }
        })
    }

    /// The law of a kind, from its coefficients in the order of its form.
    ///
    /// # Errors
    /// If there are too few or too many.
    pub fn from_coefficients(kind: ViscosityKind, numbers: &[f64]) -> Result<Self, Unreadable> {
        const FIELD: &str = "viscosity_numbers";
        Ok(match kind {
            ViscosityKind::Arrhenius => {
                let [prefactor, activation_energy] = exactly(FIELD, numbers)?;
                Self::Arrhenius { prefactor, activation_energy }
            }
            ViscosityKind::Vogel => {
                let [prefactor, slope, zero] = exactly(FIELD, numbers)?;
                Self::Vogel { prefactor, slope, zero }
            }
            ViscosityKind::Walther => {
                let [a, b, density] = exactly(FIELD, numbers)?;
                Self::Walther { a, b, density }
            }
        })
    }

    /// Its kind.
    #[must_use]
    pub fn kind(&self) -> ViscosityKind {
        match self {
            Self::Arrhenius { .. } => ViscosityKind::Arrhenius,
            Self::Vogel { .. } => ViscosityKind::Vogel,
            Self::Walther { .. } => ViscosityKind::Walther,
        }
    }

    /// Its coefficients, in the order of its form.
    #[must_use]
    pub fn coefficients(&self) -> Vec<f64> {
        match *self {
            Self::Arrhenius { prefactor, activation_energy } => vec![prefactor, activation_energy],
            Self::Vogel { prefactor, slope, zero } => vec![prefactor, slope, zero],
            Self::Walther { a, b, density } => vec![a, b, density],
        }
    }

    /// Dynamic viscosity (Pa s) at a temperature (K).
    ///
    /// # Errors
    /// If the temperature is not above zero, nor above that where the law diverges.
    pub fn viscosity(&self, temperature: f64) -> Result<f64, Error> {
        above("temperature", temperature, 0.0)?;
        let value = match *self {
            Self::Arrhenius { prefactor, activation_energy } => {
                prefactor * (activation_energy / (GAS_CONSTANT * temperature)).exp()
            }
            Self::Vogel { prefactor, slope, zero } => {
                above("temperature of a Vogel law", temperature, zero)?;
                prefactor * (slope / (temperature - zero)).exp()
            }
            Self::Walther { a, b, density } => {
                let z = 10f64.powf(10f64.powf(a - b * temperature.log10()));
                density * CENTISTOKES * kinematic_of(z)
            }
        };
        finite("viscosity", value)
    }

    /// d ln eta / d ln T at a temperature (K): the local power law of viscosity in absolute temperature.
    ///
    /// # Errors
    /// As `viscosity`.
    pub fn temperature_exponent(&self, temperature: f64) -> Result<f64, Error> {
        const STEP: f64 = 1e-5;
        self.viscosity(temperature)?;
        Ok(match *self {
            Self::Arrhenius { activation_energy, .. } => {
                -activation_energy / (GAS_CONSTANT * temperature)
            }
            Self::Vogel { slope, zero, .. } => -slope * temperature / (temperature - zero).powi(2),
            Self::Walther { .. } => {
                let up = self.viscosity(temperature * (1.0 + STEP))?;
                let down = self.viscosity(temperature * (1.0 - STEP))?;
                (up / down).ln() / ((1.0 + STEP) / (1.0 - STEP)).ln()
            }
        })
    }
}

fn walther_z(nu: f64) -> f64 {
    nu + 0.7 + (-1.47 - 1.84 * nu - 0.51 * nu * nu).exp()
}

/// Kinematic viscosity in mm^2/s of a Z; Newton's method, as Z rises with viscosity.
fn kinematic_of(z: f64) -> f64 {
    let mut nu = (z - 0.7).max(0.0);
    for _ in 0..60 {
        let tail = (-1.47 - 1.84 * nu - 0.51 * nu * nu).exp();
        let step = (nu + 0.7 + tail - z) / (1.0 - tail * (1.84 + 1.02 * nu));
        nu = (nu - step).max(0.0);
        if step.abs() <= 1e-14 * nu {
            break;
        }
    }
    nu
}

/// Barus: `eta exp(alpha p)`; holds up to some 0.3e9 Pa.
///
/// # Errors
/// If a value is not finite or is negative.
pub fn at_pressure(viscosity: f64, coefficient: f64, pressure: f64) -> Result<f64, Error> {
    above("viscosity", viscosity, 0.0)?;
    at_least("pressure-viscosity coefficient", coefficient, 0.0)?;
    at_least("pressure", pressure, 0.0)?;
    finite("viscosity under pressure", viscosity * (coefficient * pressure).exp())
}

/// Shear thinning as Carreau has it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Carreau {
    relaxation_time: f64,
    exponent: f64,
    limit: f64,
}

impl Carreau {
    /// A Newtonian lubricant.
    pub const NONE: Self = Self { relaxation_time: 0.0, exponent: 1.0, limit: 0.0 };

    /// `eta/eta_0 = limit + (1 - limit) [1 + (relaxation_time rate)^2]^((exponent-1)/2)`.
    ///
    /// # Errors
    /// If the time (s) is negative, the exponent is not in (0, 1] or the limit not in [0, 1].
    pub fn new(relaxation_time: f64, exponent: f64, limit: f64) -> Result<Self, Error> {
        at_least("relaxation time", relaxation_time, 0.0)?;
        at_most("Carreau exponent", above("Carreau exponent", exponent, 0.0)?, 1.0)?;
        at_most("share of viscosity left", at_least("share of viscosity left", limit, 0.0)?, 1.0)?;
        Ok(Self { relaxation_time, exponent, limit })
    }

    /// Exponent of the power law at high rates, 1 if Newtonian.
    pub(crate) fn exponent(&self) -> f64 {
        self.exponent
    }

    /// Viscosity at a shear rate (1/s) as a share of that at rest.
    #[must_use]
    pub fn share(&self, rate: f64) -> f64 {
        let thinned = 1.0_f64.hypot(self.relaxation_time * rate).powf(self.exponent - 1.0);
        self.limit + (1.0 - self.limit) * thinned
    }
}
