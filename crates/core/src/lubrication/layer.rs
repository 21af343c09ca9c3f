//! A rigid cylinder on an elastic layer bonded to a rigid core: plane strain, frictionless, small strain.
//!
//! With `s = x/a` the pressure is `P sqrt(1-s^2) sum b_n U_2n(s)`, `P = E* a/(2R)`, which vanishes at the edges
//! as a smooth contact must. The slope of the surface projected on Chebyshev polynomials gives linear equations
//! `sum M_mn b_n = delta_m0/2` with
//! `M_mn = delta_mn/2 + (-1)^(m+n) (2n+1) int [g(q) - 1] J_2m+1 J_2n+1 d(omega)/omega`, `q = omega t/a`, where
//! `g = [(3-4nu) sinh 2q - 2q]/[(3-4nu) cosh 2q + 2q^2 + 5 - 12nu + 8nu^2]` is the compliance of the layer over
//! that of a half-space at wavenumber q/t (layered elasticity; K. L. Johnson, Contact Mechanics, ch. 5.8).

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use super::contact::{Solid, effective_modulus, hertz_line, poisson};
use crate::error::{Error, above, at_most};

/// Half-width over thickness up to which the contact is solved.
pub const HALF_WIDTH_MAX: f64 = 40.0;

/// Beyond this q the layer answers as a half-space, to rounding.
const DEEP: f64 = 20.0;

/// Half-width over thickness below which the layer is a half-space, to 1e-9.
const SHALLOW: f64 = 1e-5;

/// Relative tolerance of the half-width.
const TOLERANCE: f64 = 1e-11;

/// Nodes and weights of eight-point Gauss-Legendre quadrature, positive half.
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
];

/// The contact at one half-width, in numbers without units.
#[derive(Debug, Clone, PartialEq)]
pub struct LayerContact {
    /// Half-width over thickness, a/t.
    pub half_width: f64,
    /// Load `w R/(E* t^2)`, w per length.
    pub load: f64,
    /// Pressure at the centre over `E* a/(2R)`, which it is on a half-space.
    pub centre_pressure: f64,
    /// Slope of pressure at the edge over that of a half-space contact of the same width: pressure goes there
    /// as `edge E* a/(2R) sqrt(2(1-|s|))`.
    pub edge: f64,
    /// c of the pressure near the edge, `K sqrt(x) (1 + c x/a)`: -1/4 on a half-space.
    pub curvature: f64,
    coefficients: Vec<f64>,
}

impl LayerContact {
    /// The contact of a half-width over thickness, on rubber of a Poisson's ratio.
    ///
    /// # Errors
    /// If the half-width is not in (0, `HALF_WIDTH_MAX`] or Poisson's ratio not in [0, 0.5].
    pub fn of_width(half_width: f64, poisson_ratio: f64) -> Result<Self, Error> {
        above("half-width over thickness", half_width, 0.0)?;
        at_most("half-width over thickness", half_width, HALF_WIDTH_MAX)?;
        Ok(solve(half_width, poisson(poisson_ratio)?, terms(half_width)))
    }

    /// The contact of a load `w R/(E* t^2)`.
    ///
    /// # Errors
    /// If the load is not positive, or presses the layer wider than `HALF_WIDTH_MAX`.
    pub fn of_load(load: f64, poisson_ratio: f64) -> Result<Self, Error> {
        above("load", load, 0.0)?;
        let hertz = (load / FRAC_PI_4).sqrt();
        let mut contact = Self::of_width(hertz.min(HALF_WIDTH_MAX), poisson_ratio)?;
        let (mut exponent, mut last) = (if hertz < 1.0 { 2.0 } else { 4.0 }, None);
        for _ in 0..60 {
            let (x, y) = (contact.half_width.ln(), (contact.load / load).ln());
            if let Some((x0, y0)) = last {
                let slope: f64 = (y - y0) / (x - x0);
                if slope.is_finite() {
                    exponent = slope.clamp(1.5, 8.0);
                }
            }
            last = Some((x, y));
            let next = (x - y / exponent).exp();
            if contact.half_width >= HALF_WIDTH_MAX && next > HALF_WIDTH_MAX {
                let quantity = "half-width over thickness";
                return Err(Error::TooLarge { quantity, value: next, limit: HALF_WIDTH_MAX });
            }
            if (next / contact.half_width - 1.0).abs() < TOLERANCE {
                break;
            }
            contact = Self::of_width(next.min(HALF_WIDTH_MAX), poisson_ratio)?;
        }
        Ok(contact)
    }

    /// Pressure at `s = x/a` over `E* a/(2R)`.
    #[must_use]
    pub fn pressure(&self, s: f64) -> f64 {
        if s.abs() >= 1.0 {
            return 0.0;
        }
        let angle = s.acos();
        let mut order = 1.0;
        let mut sum = 0.0;
        for b in &self.coefficients {
            sum += b * (order * angle).sin();
            order += 2.0;
        }
        sum
    }
}

/// A roll pressed into the layer, SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LayerNip {
    /// Width of the nip, m.
    pub width: f64,
    /// Pressure at its centre, Pa.
    pub pressure_max: f64,
    /// Slope of pressure at the edge over that of a half-space contact of the same width.
    pub edge: f64,
    /// c of the pressure near the edge, `K sqrt(x) (1 + c x/a)`: -1/4 on a half-space.
    pub curvature: f64,
    /// Width over that of the half-space contact of the same load.
    pub width_over_hertz: f64,
}

/// The nip of a load per length (N/m) on a roll of reduced radius (m) with a `rubber` of some thickness (m).
///
/// # Errors
/// If a value is not positive, or the nip is wider than `2 HALF_WIDTH_MAX` thicknesses.
pub fn nip(load: f64, radius: f64, thickness: f64, rubber: Solid) -> Result<LayerNip, Error> {
    let rigid = Solid { modulus: f64::INFINITY, poisson_ratio: 0.5 };
    let effective = effective_modulus(rubber, rigid)?;
    let half = hertz_line(load, radius, effective)?.half_width;
    let star = 0.5 * effective;
    let scaled = load * radius / (star * thickness * thickness);
    let found = LayerContact::of_load(scaled, rubber.poisson_ratio)?;
    let width = found.half_width * thickness;
    Ok(LayerNip {
        width: 2.0 * width,
        pressure_max: found.centre_pressure * star * width / (2.0 * radius),
        edge: found.edge,
        curvature: found.curvature,
        width_over_hertz: width / half,
    })
}

/// Terms that resolve the pressure to 1e-9: more where the contact is wide against the layer.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a small positive number
fn terms(half_width: f64) -> usize {
    10 + (4.0 * half_width) as usize
}

fn relative_compliance(q: f64, nu: f64) -> f64 {
    // Numerator and denominator over cosh 2q, free of cancellation near 0 by the series of sinh 2q - 2q.
    let kappa = 3.0 - 4.0 * nu;
    let z = 2.0 * q;
    let excess = if z < 0.5 {
        let z2 = z * z;
        z * z2 / 6.0
            * (1.0 + z2 / 20.0 * (1.0 + z2 / 42.0 * (1.0 + z2 / 72.0 * (1.0 + z2 / 110.0))))
    } else {
        z.sinh() - z
    };
    let top = (kappa - 1.0) * z + kappa * excess;
    top / (kappa * z.cosh() + 2.0 * q * q + 5.0 - 12.0 * nu + 8.0 * nu * nu)
}

#[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn solve(half_width: f64, nu: f64, terms: usize) -> LayerContact {
    if half_width < SHALLOW {
        let load = FRAC_PI_4 * half_width * half_width;
        return LayerContact {
            half_width,
            load,
            centre_pressure: 1.0,
            edge: 1.0,
            curvature: -0.25,
            coefficients: vec![1.0],
        };
    }
    let mut matrix = vec![0.0; terms * terms];
    let mut bessel = vec![0.0; terms];
    // Panels resolve both the layer's answer (width 2 in q) and the waves of the Bessel functions.
    let panels = (DEEP / 2.0).max((DEEP * half_width / PI).ceil());
    let width = DEEP / panels;
    for panel in 0..panels as usize {
        for (node, weight) in GAUSS {
            for side in [-node, node] {
                let q = width * (panel as f64 + 0.5 + 0.5 * side);
                odd_bessel(q * half_width, &mut bessel);
                let factor = 0.5 * width * weight * (relative_compliance(q, nu) - 1.0) / q;
                for m in 0..terms {
                    let row = factor * bessel[m];
                    for n in m..terms {
                        matrix[m * terms + n] += row * bessel[n];
                    }
                }
            }
        }
    }
    for m in 0..terms {
        for n in 0..m {
            matrix[m * terms + n] = matrix[n * terms + m];
        }
    }
    for m in 0..terms {
        for n in 0..terms {
            let sign = if (m + n) % 2 == 0 { 1.0 } else { -1.0 };
            matrix[m * terms + n] *= sign * (2 * n + 1) as f64;
        }
        matrix[m * terms + m] += 0.5;
    }
    let mut right = vec![0.0; terms];
    right[0] = 0.5;
    eliminate(&mut matrix, &mut right);
    let centre =
        right.iter().enumerate().map(|(n, b)| if n % 2 == 0 { *b } else { -b }).sum::<f64>();
    let edge = right.iter().enumerate().map(|(n, b)| (2 * n + 1) as f64 * b).sum::<f64>();
    // sin((2n+1) theta) with theta^2 = 2 d + d^2/3 at the distance d of the edge, 1 - cos(theta)
    let third =
        right.iter().enumerate().map(|(n, b)| ((2 * n + 1) as f64).powi(3) * b).sum::<f64>();
    LayerContact {
        half_width,
        load: 0.5 * FRAC_PI_2 * half_width * half_width * right[0],
        centre_pressure: centre,
        edge,
        curvature: 1.0 / 12.0 - third / (3.0 * edge),
        coefficients: right,
    }
}

/// Bessel functions of odd order from 1 on, at x > 0, by Miller's backward recurrence.
#[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn odd_bessel(x: f64, out: &mut [f64]) {
    const HUGE: f64 = 1e250;
    let top = x.max(2.0 * out.len() as f64);
    let start = 2 * ((top + 20.0 + 8.0 * top.cbrt()) / 2.0) as usize;
    let (mut above, mut here, mut norm) = (0.0, 1e-250, 0.0);
    out.fill(0.0);
    for order in (1..=start).rev() {
        // Here is J_order, to a common factor.
        if order % 2 == 0 {
            norm += 2.0 * here;
        } else if order / 2 < out.len() {
            out[order / 2] = here;
        }
        let below = 2.0 * order as f64 / x * here - above;
        (above, here) = (here, below);
        if here.abs() > HUGE {
            here /= HUGE;
            above /= HUGE;
            norm /= HUGE;
            for value in out.iter_mut() {
                *value /= HUGE;
            }
        }
    }
    norm += here;
    for value in out.iter_mut() {
        *value /= norm;
    }
}

/// Gauss's elimination with the largest pivot of each column; the answer replaces the right side.
fn eliminate(matrix: &mut [f64], right: &mut [f64]) {
    let size = right.len();
    for column in 0..size {
        let pivot = (column..size)
            .max_by(|i, j| {
                matrix[i * size + column].abs().total_cmp(&matrix[j * size + column].abs())
            })
            .unwrap_or(column);
        if pivot != column {
            for k in 0..size {
                matrix.swap(pivot * size + k, column * size + k);
            }
            right.swap(pivot, column);
        }
        for row in column + 1..size {
            let factor = matrix[row * size + column] / matrix[column * size + column];
            for k in column..size {
                matrix[row * size + k] -= factor * matrix[column * size + k];
            }
            right[row] -= factor * right[column];
        }
    }
    for row in (0..size).rev() {
        let known: f64 = (row + 1..size).map(|k| matrix[row * size + k] * right[k]).sum();
        right[row] = (right[row] - known) / matrix[row * size + row];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_terms_change_nothing() {
        for nu in [0.0, 0.3, 0.45, 0.49, 0.5] {
            for half_width in [0.01, 0.2, 1.0, 3.0, 10.0, 40.0] {
                let few = solve(half_width, nu, terms(half_width));
                let many = solve(half_width, nu, terms(half_width) * 3 / 2);
                assert!((few.load / many.load - 1.0).abs() < 1e-9, "{nu} {half_width}");
                assert!((few.edge / many.edge - 1.0).abs() < 1e-6, "{nu} {half_width}");
                assert!((few.curvature - many.curvature).abs() < 1e-4 * (1.0 + many.curvature));
            }
        }
    }

    #[test]
    fn bessel_functions_have_their_known_values() {
        let mut out = [0.0; 3];
        for (x, known) in [
            (1.0, [0.440_050_585_744_933_5, 0.019_563_353_982_668_4, 0.000_249_757_730_211_234]),
            (10.0, [0.043_472_746_168_861_4, 0.058_379_379_305_186_8, -0.234_061_528_186_794]),
        ] {
            odd_bessel(x, &mut out);
            for (value, reference) in out.iter().zip(known) {
                assert!((value - reference).abs() < 1e-14, "{x}: {value} {reference}");
            }
        }
        odd_bessel(1e-6, &mut out);
        assert!((out[0] / 5e-7 - 1.0).abs() < 1e-10);
    }
}
