//! The force that a soft film takes from the belt: shear by sliding, and the part that pressure drives.
//!
//! The belt is the moving wall. With it at U over a heater at rest the shear stress on it is
//! `eta U/h + (h/2) dp/dx`; on the heater the second term has the other sign. About the axis of the roll the
//! pressures have no moment: those of the parabola point at the axis, and those of the deflection cancel in pairs
//! (its kernel is even). The torque of the drive is therefore R times the integral of that stress over inlet and
//! nip, and both parts add.
//!
//! Near its edge the dry pressure is `p = K sqrt(x) (1 + c x/a)`. The inlet has the length
//! `l = (eta u E*^2/K^3)^0.4`, the film the scale `h_i = (eta u)^0.6 E*^0.2 K^-0.8`. As `int p' dx = 0`, half the
//! integral of `h p'` is that of `(h - h_c) p'`: an amount of `h_i K sqrt(l)` from either edge, and between them,
//! where `h - h_c = h_c^3 p'/(12 eta u)`, a logarithm of `a/l` whose factor follows from the film alone,
//! `(h_c/h_i)^3/48`. The shear is `eta U 2a/h_c` and a share of the order of `l/a`. The other constants are fitted to
//! 512 numerical solutions (`reynolds`), a/t 0.1 to 3, Poisson's ratio 0.4 to 0.5, l/a from 0.004 until the inlet is
//! a quarter of nip or layer; none is of a fuser. Fresh ones of that range are met within 1.6 % (99 in 100 within
//! 1.1 %), and 1,024 of fusers (17 mPa s to 3 Pa s, 0.02 to 0.4 m/s) within 0.6 %.

use super::film::{LineContact, constant, inlet_length};
use crate::error::{Error, above, finite};

/// The inlet is short, and the constants hold, up to this share of the half-width and of the thickness.
const SHORT: f64 = 0.25;

/// `h_i/(R U^0.6 W^-0.2)` of Hertz's contact, `(4 pi)^0.2`.
const HALF_SPACE: f64 = 1.658_983_141_635_484_5;

/// What pressure looks like at the edge of a nip on a layer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edge {
    /// Slope over that of a half-space contact of the same width.
    pub slope: f64,
    /// c in `p = K sqrt(x) (1 + c x/a)`: -1/4 on a half-space.
    pub curvature: f64,
    /// Half-width of the nip, m.
    pub half_width: f64,
    /// Thickness of the layer, m.
    pub thickness: f64,
}

/// The parts of the force on the belt.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Traction {
    /// Shear over `eta U/h_c` times the dry nip, with the central film of the soft law.
    pub shear_factor: f64,
    /// Half the integral of film thickness times pressure gradient, per length, N/m.
    pub rolling: f64,
}

/// The force on a belt that slides over a heater at rest, with twice the mean speed; flooded and isoviscous.
///
/// Where the inlet is longer than a quarter of nip or layer the shares are those of that length.
///
/// # Errors
/// If a value is not positive, or a part no finite number.
pub fn soft_traction(contact: &LineContact, edge: Edge) -> Result<Traction, Error> {
    above("viscosity", contact.viscosity, 0.0)?;
    above("entrainment speed", contact.speed, 0.0)?;
    above("radius", contact.radius, 0.0)?;
    let modulus = 0.5 * above("effective modulus", contact.modulus, 0.0)?;
    let slope = above("slope of pressure at the edge", edge.slope, 0.0)?;
    let half = above("half-width", edge.half_width, 0.0)?;
    above("thickness of the layer", edge.thickness, 0.0)?;
    let length = inlet_length(contact, slope, half) / half;
    let k = slope * 0.5 * modulus / contact.radius * (2.0 * half).sqrt();
    let scale = (contact.viscosity * contact.speed).powf(0.8) * modulus.powf(0.6) * k.powf(-0.4);
    let short = length.min(SHORT * (edge.thickness / half).min(1.0));
    let depth = -short.ln();
    let bend = (edge.curvature + 0.25).max(0.0);
    let shear_factor =
        1.0 + short * (0.339 + 0.455 * short + bend * (2.427 - 6.026 * short).max(0.0));
    let film = constant::HERREBRUGH_CENTRE / HALF_SPACE;
    let rolling = film.powi(3) / 48.0 * depth + 5.377 - 4.664 * short * depth
        + bend * (3.517 - 0.377 * depth).max(0.0);
    Ok(Traction {
        shear_factor: finite("factor on the shear", shear_factor)?,
        rolling: finite("rolling force", rolling * scale)?,
    })
}
