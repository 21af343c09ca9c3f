//! What thins a film beside the laws for a flooded, isothermal, Newtonian inlet: a factor each, with validity.

use super::viscosity::Carreau;
use crate::error::{Error, above, at_least, at_most};

/// A factor on film thickness, and whether the rule behind it holds here.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Correction {
    /// Film over flooded, isothermal, Newtonian film.
    pub factor: f64,
    /// Whether the rule holds here.
    pub valid: bool,
}

/// Range of the sharpness of `starvation` for which it was fitted.
pub const SHARPNESS_RANGE: (f64, f64) = (2.0, 5.0);

/// Starvation by the layer that is supplied: `r/(1 + r^gamma)^(1/gamma)`, r the layer over the flooded film.
///
/// Chevalier, Lubrecht, Cann, Colin, Dalmaz (J. Tribol. 120 (1998) 126); Damiens, Venner, Cann, Lubrecht (J.
/// Tribol. 126 (2004) 105). The form is fixed by its limits (flooded: 1, starved: the layer itself); gamma, from 2
/// to 5, rounds the corner.
///
/// # Errors
/// If a thickness is not positive or gamma not in its range.
pub fn starvation(supply: f64, flooded: f64, gamma: f64) -> Result<Correction, Error> {
    above("supplied layer", supply, 0.0)?;
    above("flooded film", flooded, 0.0)?;
    at_least("sharpness of starvation", gamma, SHARPNESS_RANGE.0)?;
    at_most("sharpness of starvation", gamma, SHARPNESS_RANGE.1)?;
    let r = supply / flooded;
    let factor = if r > 1.0 {
        (1.0 + r.powf(-gamma)).powf(-1.0 / gamma)
    } else {
        r * (1.0 + r.powf(gamma)).powf(-1.0 / gamma)
    };
    Ok(Correction { factor, valid: true })
}

/// Heating by shear in the inlet, pure rolling: `3.94/(3.94 + L^0.62)`, `L = eta beta u^2/k` with the mean speed u,
/// `beta = -d ln eta/dT` and k the conductivity of the lubricant (Murch and Wilson, 1975).
///
/// Valid while nothing slides, or while the factor is above 0.99 anyhow: the published extensions to sliding
/// disagree threefold at a slide-to-roll ratio of 2, so none is built in.
///
/// # Errors
/// If a value is not positive, or the slide-to-roll ratio negative.
pub fn inlet_heating(
    viscosity: f64,
    fall: f64,
    speed: f64,
    conductivity: f64,
    slide_to_roll: f64,
) -> Result<Correction, Error> {
    above("viscosity", viscosity, 0.0)?;
    at_least("fall of viscosity with temperature", fall, 0.0)?;
    at_least("entrainment speed", speed, 0.0)?;
    above("thermal conductivity", conductivity, 0.0)?;
    at_least("slide-to-roll ratio", slide_to_roll, 0.0)?;
    let l = viscosity * fall * speed * speed / conductivity;
    let factor = 3.94 / (3.94 + l.powf(0.62));
    Ok(Correction { factor, valid: slide_to_roll == 0.0 || factor > 0.99 })
}

/// Greatest and mean rise of temperature (K) in a film sheared at `sliding` (m/s) between walls of one temperature:
/// `eta U^2/(8 k)` and `eta U^2/(12 k)`.
///
/// # Errors
/// If a value is not positive.
pub fn shear_heating(viscosity: f64, sliding: f64, conductivity: f64) -> Result<(f64, f64), Error> {
    above("viscosity", viscosity, 0.0)?;
    at_least("sliding speed", sliding, 0.0)?;
    above("thermal conductivity", conductivity, 0.0)?;
    let power = viscosity * sliding * sliding / conductivity;
    Ok((power / 8.0, power / 12.0))
}

/// Shear thinning: the film that the viscosity at its own shear rate `U/h` makes, `h = h_0 (eta/eta_0)^n`.
///
/// `exponent` n is that of film thickness in viscosity. Valid while viscosity at that rate is above half.
///
/// # Errors
/// If the film is not positive, the sliding speed negative, or the exponent not in (0, 1].
pub fn shear_thinning(
    newtonian: f64,
    sliding: f64,
    exponent: f64,
    thinning: Carreau,
) -> Result<Correction, Error> {
    above("film thickness", newtonian, 0.0)?;
    at_least("sliding speed", sliding, 0.0)?;
    at_most(
        "exponent of the film in viscosity",
        above("exponent of the film in viscosity", exponent, 0.0)?,
        1.0,
    )?;
    // The film of a guess falls as the guess rises: one crossing, found by halving in logarithms.
    let share = |factor: f64| thinning.share(sliding / (newtonian * factor));
    let least = exponent * share(1.0).ln() / (1.0 - exponent * (1.0 - thinning.exponent()));
    if least == 0.0 {
        return Ok(Correction { factor: 1.0, valid: true });
    }
    let (mut low, mut high) = (2.0 * least, 0.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if exponent * share(middle.exp()).ln() > middle {
            low = middle;
        } else {
            high = middle;
        }
    }
    let factor = (0.5 * (low + high)).exp();
    Ok(Correction { factor, valid: share(factor) > 0.5 })
}
