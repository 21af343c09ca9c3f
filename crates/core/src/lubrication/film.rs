//! Film thickness in the four regimes of a line contact, and in elliptic contacts.
//!
//! The groups use the MEAN entrainment speed u = (u1 + u2)/2 and E' = 2/[(1-nu1^2)/E1 + (1-nu2^2)/E2]:
//! `U = eta u/(E' R)`, `W = w/(E' R)`, `G = alpha E'`, `g_V = G W^1.5/U^0.5`, `g_E = W/U^0.5` and
//! `h = R H`, `H W/U` a function of `g_V` and `g_E` alone. A law that is written with the sum of the speeds has
//! other constants.

use std::f64::consts::FRAC_PI_4;

use crate::error::{Error, above, at_least, finite};

/// The constant of each law, with the mean speed and E', and where it comes from.
pub mod constant {
    /// Isoviscous-rigid, `H W/U`: Martin (1916) gives 4.9; 4.895 by integration with Reynolds' exit.
    pub const MARTIN: f64 = 4.9;
    /// Piezoviscous-rigid, minimum, with `g_V^(2/3)`: Blok's 1.66; 1.666 where the reduced pressure reaches
    /// 1/alpha under a rigid cylinder.
    pub const BLOK: f64 = 1.66;
    /// Isoviscous-elastic, minimum, with `g_E^0.8`: Herrebrugh, Hooke; numerical solutions give 3.05.
    pub const HERREBRUGH: f64 = 3.10;
    /// Isoviscous-elastic, centre, with `g_E^0.8`: 0.447 lambda^0.6 a^2/R, `lambda = 12 eta u R^2/(a^3 p_max)`,
    /// from numerical solutions.
    pub const HERREBRUGH_CENTRE: f64 = 3.78;
    /// Piezoviscous-elastic, minimum, with `g_V^0.54 g_E^0.06`: Dowson and Higginson.
    pub const DOWSON_HIGGINSON: f64 = 2.65;
    /// Piezoviscous-elastic, centre, `3.06 U^0.69 G^0.56 W^-0.10`: Dowson and Toyoda (1978).
    pub const DOWSON_TOYODA: f64 = 3.06;
}

/// Which effects make the film.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Regime {
    /// Neither pressure on viscosity nor deformation matters.
    IsoviscousRigid,
    /// Pressure thickens the lubricant, the bodies stay stiff.
    PiezoviscousRigid,
    /// Soft EHL: the bodies yield at pressures that leave viscosity alone.
    IsoviscousElastic,
    /// Hard EHL.
    PiezoviscousElastic,
}

impl Regime {
    /// All, in the order of the arrays below.
    pub const ALL: [Self; 4] = [
        Self::IsoviscousRigid,
        Self::PiezoviscousRigid,
        Self::IsoviscousElastic,
        Self::PiezoviscousElastic,
    ];

    /// Exponent of film thickness in speed times viscosity.
    #[must_use]
    pub fn speed_exponent(self) -> f64 {
        match self {
            Self::IsoviscousRigid => 1.0,
            Self::PiezoviscousRigid => 2.0 / 3.0,
            Self::IsoviscousElastic => 0.6,
            Self::PiezoviscousElastic => 0.7,
        }
    }

    /// Film thickness goes as load to the power of minus this.
    #[must_use]
    pub fn load_exponent(self) -> f64 {
        match self {
            Self::IsoviscousRigid => 1.0,
            Self::PiezoviscousRigid => 0.0,
            Self::IsoviscousElastic => 0.2,
            Self::PiezoviscousElastic => 0.13,
        }
    }
}

/// A line contact under way, SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineContact {
    /// alpha, 1/Pa; 0 for a lubricant that pressure does not thicken.
    pub pressure_viscosity: f64,
    /// eta at the inlet, Pa s.
    pub viscosity: f64,
    /// Mean entrainment speed, m/s.
    pub speed: f64,
    /// Load per length, N/m.
    pub load: f64,
    /// Reduced radius, m.
    pub radius: f64,
    /// Effective modulus E', Pa.
    pub modulus: f64,
}

/// The film by each law, and which holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineFilm {
    /// Viscosity parameter.
    pub g_v: f64,
    /// Elasticity parameter.
    pub g_e: f64,
    /// Minimum film by each law, m, in the order of `Regime::ALL`.
    pub minimum: [f64; 4],
    /// Film at the centre by each law, m.
    pub central: [f64; 4],
    /// The law that holds: the larger of an isoviscous film, elastic where that is thicker, and a piezoviscous one,
    /// rigid where Hertz's half-width would be less than the scale of the thicker rigid film, `a^2 < 2 R h`.
    pub regime: Regime,
}

impl LineContact {
    /// The film on half-spaces, or on a layer whose `softness` (see `layer_factor`) thins the soft film.
    ///
    /// # Errors
    /// If a value is not positive, or the film is no finite number.
    pub fn film(&self, softness: f64) -> Result<LineFilm, Error> {
        at_least("pressure-viscosity coefficient", self.pressure_viscosity, 0.0)?;
        above("viscosity", self.viscosity, 0.0)?;
        above("entrainment speed", self.speed, 0.0)?;
        above("load", self.load, 0.0)?;
        above("radius", self.radius, 0.0)?;
        above("effective modulus", self.modulus, 0.0)?;
        above("factor of the layer", softness, 0.0)?;
        let u = self.viscosity * self.speed / (self.modulus * self.radius);
        let w = self.load / (self.modulus * self.radius);
        let g = self.pressure_viscosity * self.modulus;
        let (g_v, g_e) = (g * w.powf(1.5) / u.sqrt(), w / u.sqrt());
        let scale = self.radius * u / w;
        let soft = softness * g_e.powf(0.8);
        let blok = constant::BLOK * g_v.powf(2.0 / 3.0);
        let minimum = [
            constant::MARTIN,
            blok,
            constant::HERREBRUGH * soft,
            constant::DOWSON_HIGGINSON * g_v.powf(0.54) * g_e.powf(0.06),
        ];
        let central = [
            constant::MARTIN,
            blok,
            constant::HERREBRUGH_CENTRE * soft,
            constant::DOWSON_TOYODA * u.powf(-0.31) * g.powf(0.56) * w.powf(0.9),
        ];
        for h in minimum {
            finite("film thickness", h * scale)?;
        }
        let isoviscous = usize::from(minimum[2] > minimum[0]) * 2;
        let piezoviscous = if g_e * g_e < FRAC_PI_4 * minimum[0].max(minimum[1]) { 1 } else { 3 };
        let held =
            if minimum[piezoviscous] > minimum[isoviscous] { piezoviscous } else { isoviscous };
        Ok(LineFilm {
            g_v,
            g_e,
            minimum: minimum.map(|h| h * scale),
            central: central.map(|h| h * scale),
            regime: Regime::ALL[held],
        })
    }
}

/// What a bonded layer does to the soft film of a half-space at the same load: a factor.
///
/// The inlet of a soft contact sees only the slope of pressure at the edge: with `p ~ K sqrt(x)` there, the film
/// is a number times `(eta u)^0.6 E*^0.2 K^-0.8`. `edge` is that slope over the one of a half-space contact of the
/// same half-width, `width` the half-width over that of the half-space contact of the same load. It holds while
/// the inlet is short against both layer and contact (`inlet_length`).
#[must_use]
pub fn layer_factor(edge: f64, width: f64) -> f64 {
    (edge * width.sqrt()).powf(-0.8)
}

/// Length (m) over which the film of a soft contact is made: `(eta u E*^2/K^3)^0.4` with the pressure `K sqrt(x)`
/// at the edge, `K = edge E*/(2R) sqrt(2a)`.
#[must_use]
pub fn inlet_length(contact: &LineContact, edge: f64, half_width: f64) -> f64 {
    let modulus = 0.5 * contact.modulus;
    let k = edge * 0.5 * modulus / contact.radius * (2.0 * half_width).sqrt();
    (contact.viscosity * contact.speed * modulus.powi(2) / k.powi(3)).powf(0.4)
}

/// An elliptic contact, fully flooded, entrained along x.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EllipticContact {
    /// alpha, 1/Pa.
    pub pressure_viscosity: f64,
    /// eta, Pa s.
    pub viscosity: f64,
    /// Mean entrainment speed, m/s.
    pub speed: f64,
    /// Load, N.
    pub load: f64,
    /// Reduced radius along the motion, m.
    pub radius: f64,
    /// Effective modulus E', Pa.
    pub modulus: f64,
    /// Ellipticity k.
    pub ellipticity: f64,
}

/// The film of an elliptic contact by each law, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EllipticFilm {
    /// Hard, minimum: `3.63 U^0.68 G^0.49 W^-0.073 (1 - exp(-0.68 k))`, Hamrock and Dowson (1977).
    pub hard_minimum: f64,
    /// Hard, centre: `2.69 U^0.67 G^0.53 W^-0.067 (1 - 0.61 exp(-0.73 k))`, Hamrock and Dowson (1977).
    pub hard_central: f64,
    /// Soft, minimum: `7.43 U^0.65 W^-0.21 (1 - 0.85 exp(-0.31 k))`, Hamrock and Dowson (1978).
    pub soft_minimum: f64,
}

/// Ellipticity of a contact of reduced radii along and across the motion: `1.03 (Ry/Rx)^0.64`.
///
/// # Errors
/// If a radius is not positive.
pub fn ellipticity(along: f64, across: f64) -> Result<f64, Error> {
    above("radius along the motion", along, 0.0)?;
    above("radius across the motion", across, 0.0)?;
    Ok(1.03 * (across / along).powf(0.64))
}

impl EllipticContact {
    /// The film by each law; `U = eta u/(E' R_x)`, `W = load/(E' R_x^2)`.
    ///
    /// # Errors
    /// If a value is not positive.
    pub fn film(&self) -> Result<EllipticFilm, Error> {
        at_least("pressure-viscosity coefficient", self.pressure_viscosity, 0.0)?;
        above("viscosity", self.viscosity, 0.0)?;
        above("entrainment speed", self.speed, 0.0)?;
        above("load", self.load, 0.0)?;
        above("radius", self.radius, 0.0)?;
        above("effective modulus", self.modulus, 0.0)?;
        let k = above("ellipticity", self.ellipticity, 0.0)?;
        let u = self.viscosity * self.speed / (self.modulus * self.radius);
        let w = self.load / (self.modulus * self.radius.powi(2));
        let g = self.pressure_viscosity * self.modulus;
        let hard = u.powf(0.68) * g.powf(0.49) * w.powf(-0.073) * (1.0 - (-0.68 * k).exp());
        let centre =
            u.powf(0.67) * g.powf(0.53) * w.powf(-0.067) * (1.0 - 0.61 * (-0.73 * k).exp());
        let soft = u.powf(0.65) * w.powf(-0.21) * (1.0 - 0.85 * (-0.31 * k).exp());
        Ok(EllipticFilm {
            hard_minimum: 3.63 * self.radius * hard,
            hard_central: 2.69 * self.radius * centre,
            soft_minimum: 7.43 * self.radius * soft,
        })
    }
}
