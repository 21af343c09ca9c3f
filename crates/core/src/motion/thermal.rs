//! How the law of drag moves while the temperature does: the factors of its forces and speeds as series.

use super::polynomial::{INVERSE, ORDER, POWERS, Polynomial};
use super::recurrence::{Recurrence, composed, product};
use crate::drag::{SpeedLaw, TemperatureLaw};
use crate::error::Error;
use crate::lubrication::viscosity::{self, GAS_CONSTANT};

/// How forces and speeds of the law move during a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct ThermalFactors {
    /// Factor of every force of the contact from the stick speed on.
    pub force: Polynomial,
    /// Factor of those below the stick speed.
    pub below: Polynomial,
    /// Factor of every speed.
    pub speed: Polynomial,
    /// Inverse of the factor of every speed.
    pub slowness: Polynomial,
    /// Factor of boundary friction, where the law knows it apart.
    pub boundary: Polynomial,
    /// Factor of the rest of the drive.
    pub rest: Polynomial,
}

impl ThermalFactors {
    /// From the course of the temperature, and the share of boundary friction in the drag at the stick speed.
    ///
    /// # Errors
    /// If a viscosity has ended at the temperature.
    #[inline(never)]
    pub(super) fn new(
        law: &TemperatureLaw,
        boundary_share: f64,
        temperature: &Polynomial,
    ) -> Result<Self, Error> {
        let t = *temperature;
        // from one number, the same to the last bit wherever the law is asked
        let first = law.speed_factor(t[0])?;
        let (speed, slowness) = match &law.speed {
            SpeedLaw::Power(exponent) => {
                (power(&t, law.reference, *exponent), power(&t, law.reference, -exponent))
            }
            SpeedLaw::Viscosity(viscosity) => {
                let eta = viscosity_series(viscosity, &t)?;
                let eta = eta.map(|c| c / eta[0]);
                (composed(Recurrence::power(-1.0, 1.0), &eta, 1.0), eta)
            }
        };
        let (speed, slowness) = (speed.map(|c| c * first), slowness.map(|c| c / first));
        let factor = law.force_factor(t[0]);
        let linear = |slope: f64| -> Polynomial {
            let mut c = t.map(|c| slope * c);
            c[0] += 1.0 - slope * law.reference;
            c
        };
        let force = power(&t, law.reference, law.force_exponent).map(|c| c * factor);
        let boundary = linear(law.boundary_slope);
        let mut with_boundary = boundary.map(|c| boundary_share * c);
        with_boundary[0] = 1.0 + boundary_share * (boundary[0] - 1.0);
        Ok(Self {
            force,
            below: std::array::from_fn(|n| product(&force, &with_boundary, n)),
            speed,
            slowness,
            boundary,
            rest: linear(law.rest_slope),
        })
    }
}

/// Series of `(t/t_0)^exponent`, its first coefficient one.
fn power(t: &Polynomial, reference: f64, exponent: f64) -> Polynomial {
    let ratio = t.map(|c| c / reference);
    composed(Recurrence::power(exponent, ratio[0]), &ratio, 1.0)
}

/// Viscosity along a temperature in K.
fn viscosity_series(law: &viscosity::TemperatureLaw, t: &Polynomial) -> Result<Polynomial, Error> {
    let first = law.viscosity(t[0])?;
    let exponential = |slope: f64, zero: f64| {
        let mut above = *t;
        above[0] -= zero;
        let inverse = composed(Recurrence::power(-1.0, above[0]), &above, 1.0 / above[0]);
        composed(Recurrence::exponential(-1.0 / slope), &inverse, first)
    };
    Ok(match *law {
        viscosity::TemperatureLaw::Arrhenius { activation_energy, .. } => {
            exponential(activation_energy / GAS_CONSTANT, 0.0)
        }
        viscosity::TemperatureLaw::Vogel { slope, zero, .. } => exponential(slope, zero),
        viscosity::TemperatureLaw::Walther { a, b, density } => {
            walther_series(a, b, density, first, t)
        }
    })
}

/// Walther's `Z` is an exponential of a power of the temperature; `nu` follows from `Z' = (1 + dE/dnu) nu'` with
/// `Z = nu + 0.7 + E`, `E = exp(-1.47 - 1.84 nu - 0.51 nu^2)`.
fn walther_series(a: f64, b: f64, density: f64, first: f64, t: &Polynomial) -> Polynomial {
    let outer = std::f64::consts::LN_10 * 10f64.powf(a - b * t[0].log10());
    let exponent = composed(Recurrence::power(-b, t[0]), t, outer);
    let z = composed(Recurrence::exponential(-1.0), &exponent, outer.exp());
    let unit = density * viscosity::CENTISTOKES;
    let (mut nu, mut tail) = ([0.0; ORDER + 1], [0.0; ORDER + 1]);
    // rate of ln E in nu, and 1 + dE/dnu
    let (mut fall, mut steep) = ([0.0; ORDER + 1], [0.0; ORDER + 1]);
    nu[0] = first / unit;
    tail[0] = (-1.47 - 1.84 * nu[0] - 0.51 * nu[0] * nu[0]).exp();
    for n in 0..ORDER {
        fall[n] = -1.02 * nu[n] - if n == 0 { 1.84 } else { 0.0 };
        steep[n] = product(&tail, &fall, n) + if n == 0 { 1.0 } else { 0.0 };
        let sum: f64 = (1..=n).map(|i| POWERS[i] * nu[i] * steep[n + 1 - i]).sum();
        nu[n + 1] = (POWERS[n + 1] * z[n + 1] - sum) * INVERSE[n + 1] / steep[0];
        let grown: f64 =
            (0..=n).map(|i| POWERS[i + 1] * nu[i + 1] * product(&tail, &fall, n - i)).sum();
        tail[n + 1] = grown * INVERSE[n + 1];
    }
    nu.map(|c| c * unit)
}
