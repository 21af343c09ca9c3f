//! Normal deflection of an elastic surface under a line of pressure, in plane strain.
//!
//! A pressure p moves the surface by `2/(pi E*)` times the integral of `p(x') K(x - x')`, with E* = E/(1 - nu^2).
//! For a half space K = -ln|x|. For a layer of thickness t bonded to a rigid base the compliance against
//! wavenumber k (layered elasticity; Johnson, Contact Mechanics, 1985, ch. 5.8) gives, with kappa = k t,
//!
//! ```text
//! K(x) = int_0^inf T(kappa) cos(kappa x/t) / kappa dkappa
//! T    = [(3-4nu) sinh 2kappa - 2kappa] / [(3-4nu) cosh 2kappa + 2kappa^2 + 5 - 12nu + 8nu^2]
//! ```
//!
//! Pressure is piecewise linear between nodes. The deflection under such a hat is exact: the second divided
//! difference of F, where F'' = K.

use super::dense::{Matrix, dot};
use crate::error::Error;
use crate::work::Work;

/// Nodes whose influence on another takes as long as one step of work.
const INFLUENCES: usize = 25;

/// Distance between tabulated points of the layer, in thicknesses.
const SPACING: f64 = 0.05;
/// Points of the table.
const POINTS: usize = 641;
/// Its last distance; farther away the deflection has died out (as exp(-0.74 x/t) or faster).
const END: f64 = 32.0;
/// A hat is far away beyond that many of its widths,
const FAR: f64 = 16.0;
/// and fine below that share of the length of the kernel.
const FINE: f64 = 0.15;
/// Rate of the exponential that takes over the slow part of 1 - T.
const RATE: f64 = 2.0;
/// Greatest wavenumber of the quadrature; T differs from 1 by kappa^2 exp(-2 kappa).
const GREATEST: f64 = 20.0;
/// Gauss-Legendre panels of the quadrature.
const PANELS: u32 = 80;
/// Abscissas and weights of Gauss-Legendre quadrature with ten points on [-1, 1], the positive half.
const GAUSS: [(f64, f64); 5] = [
    (0.148_874_338_981_631_21, 0.295_524_224_714_752_87),
    (0.433_395_394_129_247_2, 0.269_266_719_309_996_35),
    (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
    (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
    (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
];

/// What gives way under the pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Foundation {
    /// A half space.
    HalfSpace,
    /// A layer bonded to a rigid base.
    Layer {
        /// Thickness.
        thickness: f64,
        /// Poisson ratio, at most 1/2.
        poisson: f64,
    },
}

/// T of a layer: its compliance over that of the half space, at wavenumber times thickness.
#[must_use]
pub fn layer_factor(kappa: f64, poisson: f64) -> f64 {
    if kappa > 300.0 {
        return 1.0;
    }
    let stiff = 3.0 - 4.0 * poisson;
    let double = 2.0 * kappa;
    (stiff * double.sinh() - double)
        / (stiff * double.cosh() + 2.0 * kappa * kappa + 5.0 + poisson * (8.0 * poisson - 12.0))
}

/// Deflection integrals of a film's nodes.
#[derive(Debug, Clone)]
pub struct Influence {
    /// At each node (row) under the unit hat of each node (column; zero at both ends).
    pub hats: Matrix,
    /// Derivative of F at the distance of two nodes, times that distance.
    stretch: Matrix,
}

/// The kernel K and its twice integrated F.
#[derive(Debug, Clone)]
pub struct Kernel {
    /// Length that corresponds to 1: the thickness of the layer, or that of the coordinate.
    length: f64,
    /// F + x^2/2 ln x - 3x^2/4 with four derivatives, for a layer.
    table: Vec<[f64; 5]>,
}

impl Kernel {
    /// The kernel of a foundation.
    #[must_use]
    pub fn new(foundation: Foundation) -> Self {
        match foundation {
            Foundation::HalfSpace => Self { length: 1.0, table: Vec::new() },
            Foundation::Layer { thickness, poisson } => {
                Self { length: thickness, table: layer_table(poisson) }
            }
        }
    }

    /// The same kernel for coordinates in units of `length`.
    #[must_use]
    pub fn scaled(&self, length: f64) -> Self {
        let length = if self.table.is_empty() { 1.0 } else { self.length / length };
        Self { length, table: self.table.clone() }
    }

    /// F at a distance, in coordinates, and its derivative times the distance.
    fn twice_integrated(&self, distance: f64) -> [f64; 2] {
        if distance == 0.0 {
            return [0.0, 0.0];
        }
        let x = distance.abs() / self.length;
        let square = self.length * self.length;
        let half_space = |x: f64| {
            let log = x.ln();
            [x * x * (0.75 - 0.5 * log), x * x * (1.0 - log)]
        };
        let [value, stretch] = if self.table.is_empty() {
            half_space(x)
        } else if x < END {
            let [value, stretch] = half_space(x);
            let [more, slope, _] = self.correction(x, 0);
            [value + more, stretch + x * slope]
        } else {
            let [value, stretch] = half_space(END);
            let slope = self.table[POINTS - 1][1] + stretch / END;
            [value + self.table[POINTS - 1][0] + slope * (x - END), x * slope]
        };
        [square * value, square * stretch]
    }

    /// Fifth-degree Hermite interpolation of a column of the table: value and two derivatives.
    #[inline(always)]
    #[allow(clippy::inline_always)] // most of a film's work is here
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // below POINTS, not negative
    fn correction(&self, x: f64, column: usize) -> [f64; 3] {
        let place = x / SPACING;
        let index = (place as usize).min(POINTS - 2);
        let t = place - f64::from(index as u32);
        let of = |i: usize| {
            let row = &self.table[i];
            let curve = 0.5 * row[column + 2] * SPACING * SPACING;
            (row[column], row[column + 1] * SPACING, curve)
        };
        let ((a, da, dda), (b, db, ddb)) = (of(index), of(index + 1));
        let gap = b - a - da - dda;
        let slope = db - da - 2.0 * dda;
        let bend = ddb - dda;
        let c = 10.0 * gap - 4.0 * slope + bend;
        let d = -15.0 * gap + 7.0 * slope - 2.0 * bend;
        let e = 6.0 * gap - 3.0 * slope + bend;
        [
            a + t * (da + t * (dda + t * (c + t * (d + t * e)))),
            (da + t * (2.0 * dda + t * (3.0 * c + t * (4.0 * d + t * 5.0 * e)))) / SPACING,
            (2.0 * dda + t * (6.0 * c + t * (12.0 * d + t * 20.0 * e))) / (SPACING * SPACING),
        ]
    }

    /// The deflection integral under a hat of unit height and widths `left` and `right`, far from it: `distance` is
    /// that of the node from the top, positive downstream. An expansion in moments, free of cancellation.
    fn far(&self, distance: f64, left: f64, right: f64) -> f64 {
        let x = distance.abs() / self.length;
        if !self.table.is_empty() && x > END {
            return 0.0;
        }
        let side = -distance.signum();
        let (l, r) = (left / self.length, right / self.length);
        let (l2, r2) = (l * l, r * r);
        let moments = [
            0.5 * (l + r),
            side * (r2 - l2) / 6.0,
            (r2 * r + l2 * l) / 24.0,
            side * (r2 * r2 - l2 * l2) / 120.0,
            (r2 * r2 * r + l2 * l2 * l) / 720.0,
        ];
        let inverse = 1.0 / x;
        let i2 = inverse * inverse;
        let log = -moments[0] * x.ln() - moments[1] * inverse + moments[2] * i2
            - 2.0 * moments[3] * i2 * inverse
            + 6.0 * moments[4] * i2 * i2;
        if self.table.is_empty() {
            return log;
        }
        let [k, dk, ddk] = self.correction(x, 2);
        self.length * (log + moments[0] * k + moments[1] * dk + moments[2] * ddk)
    }

    /// Deflection integrals for `nodes`.
    ///
    /// # Errors
    /// If `work` ends before.
    pub fn influence(&self, nodes: &[f64], work: &Work) -> Result<Influence, Error> {
        let n = nodes.len();
        let (mut twice, mut stretch) = (Matrix::zeros(n), Matrix::zeros(n));
        for i in 0..n {
            work.take(row_work(i))?;
            for j in 0..i {
                let [value, slope] = self.twice_integrated(nodes[i] - nodes[j]);
                twice.row_mut(i)[j] = value;
                twice.row_mut(j)[i] = value;
                stretch.row_mut(i)[j] = slope;
                stretch.row_mut(j)[i] = slope;
            }
        }
        let mut hats = Matrix::zeros(n);
        for i in 0..n {
            work.take(row_work(n))?;
            let (f, row) = (twice.row(i), hats.row_mut(i));
            for j in 1..n - 1 {
                let (left, right) = (nodes[j] - nodes[j - 1], nodes[j + 1] - nodes[j]);
                let distance = nodes[i] - nodes[j];
                let wide = left.max(right);
                row[j] = if wide < FINE * self.length && distance.abs() > FAR * wide {
                    self.far(distance, left, right)
                } else {
                    (f[j + 1] - f[j]) / right - (f[j] - f[j - 1]) / left
                };
            }
        }
        Ok(Influence { hats, stretch })
    }
}

impl Influence {
    /// Derivative of the deflection integrals when the distances of all nodes grow alike, per relative growth.
    #[must_use]
    pub fn by_growth(&self, nodes: &[f64], pressure: &[f64], deflection: &[f64]) -> Vec<f64> {
        let n = nodes.len() - 1;
        let slope = |k: usize| (pressure[k + 1] - pressure[k]) / (nodes[k + 1] - nodes[k]);
        let kinks: Vec<f64> = (0..=n)
            .map(|k| {
                let before = if k > 0 { slope(k - 1) } else { 0.0 };
                let after = if k < n { slope(k) } else { 0.0 };
                after - before
            })
            .collect();
        (0..=n).map(|i| dot(self.stretch.row(i), &kinks) - deflection[i]).collect()
    }
}

/// Work of the influence of so many nodes on one.
fn row_work(nodes: usize) -> u64 {
    (1 + nodes / INFLUENCES) as u64
}

/// Work of the influence of so many nodes on each other, about.
#[must_use]
pub fn influence_work(nodes: usize) -> u64 {
    2 * nodes as u64 * row_work(nodes)
}

/// F of the layer less that of the half space, and four derivatives, at the points of the table.
fn layer_table(poisson: f64) -> Vec<[f64; 5]> {
    let mut table: Vec<[f64; 5]> =
        (0..POINTS).map(|i| exponential_part(SPACING * count(i))).collect();
    let half = 0.5 * GREATEST / f64::from(PANELS);
    for panel in 0..PANELS {
        let middle = half * f64::from(2 * panel + 1);
        for (abscissa, weight) in GAUSS {
            for sign in [-1.0, 1.0] {
                let k = middle + sign * half * abscissa;
                let s = (layer_factor(k, poisson) - 1.0 + (-RATE * k).exp()) / k;
                add_wave(&mut table, k, half * weight * s);
            }
        }
    }
    table
}

/// Add `(1 - cos kx)/k^2` and its derivatives, times `weight`.
fn add_wave(table: &mut [[f64; 5]], k: f64, weight: f64) {
    let (turn_sin, turn_cos) = (k * SPACING).sin_cos();
    let (mut sin, mut cos) = (0.0, 1.0);
    for entry in table {
        entry[0] += weight * (1.0 - cos) / (k * k);
        entry[1] += weight * sin / k;
        entry[2] += weight * cos;
        entry[3] -= weight * k * sin;
        entry[4] -= weight * k * k * cos;
        (sin, cos) = (sin * turn_cos + cos * turn_sin, cos * turn_cos - sin * turn_sin);
    }
}

/// Twice integrated, once integrated and twice differentiated `ln(x^2 + c^2)/2`: what `1 - exp(-c kappa)` adds to `ln x`.
fn exponential_part(x: f64) -> [f64; 5] {
    let c = RATE;
    let square = x * x + c * c;
    let log = square.ln();
    let angle = (x / c).atan();
    let start = 0.25 * c * c * ((c * c).ln() - 1.0);
    [
        0.25 * square * (log - 1.0) - 0.5 * x * x + c * x * angle
            - 0.5 * c * c * (log - (c * c).ln())
            - start,
        0.5 * x * log - x + c * angle,
        0.5 * log,
        x / square,
        (c * c - x * x) / (square * square),
    ]
}

fn count(i: usize) -> f64 {
    f64::from(u32::try_from(i).unwrap_or(u32::MAX))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Deflection integral of a hat by quadrature of -ln|x| and, for a layer, of the table's own second derivative.
    fn hat(kernel: &Kernel, at: f64, nodes: [f64; 3]) -> f64 {
        let count = 20_000;
        let sum = |from: f64, to: f64, of: &dyn Fn(f64) -> f64| -> f64 {
            let step = (to - from) / f64::from(count);
            (0..count).map(|i| step * of(from + (f64::from(i) + 0.5) * step)).sum()
        };
        let [a, b, c] = nodes;
        let k = |x: f64| {
            let scaled = (at - x).abs() / kernel.length;
            let more = if kernel.table.is_empty() { 0.0 } else { kernel.correction(scaled, 2)[0] };
            kernel.length * (more - scaled.ln()) / kernel.length
        };
        sum(a, b, &|x| k(x) * (x - a) / (b - a)) + sum(b, c, &|x| k(x) * (c - x) / (c - b))
    }

    #[test]
    fn hats_are_the_integrals_of_the_kernel() {
        let half_space = Kernel::new(Foundation::HalfSpace);
        let layer = Kernel::new(Foundation::Layer { thickness: 1.0, poisson: 0.45 });
        let nodes = [-2.0, -1.2, -0.7, 0.0, 0.3, 1.1];
        for kernel in [half_space, layer] {
            let hats = kernel.influence(&nodes, &Work::default()).unwrap().hats;
            for (i, at) in nodes.iter().enumerate() {
                for j in 1..nodes.len() - 1 {
                    let known = hat(&kernel, *at, [nodes[j - 1], nodes[j], nodes[j + 1]]);
                    let found = hats.row(i)[j];
                    assert!((found - known).abs() < 2e-4, "{i} {j}: {found} {known}");
                }
                assert_eq!((hats.row(i)[0], hats.row(i)[5]), (0.0, 0.0));
            }
        }
    }

    #[test]
    fn far_hats_go_over_into_near_ones() {
        for (kernel, distance) in [
            (Kernel::new(Foundation::HalfSpace), 2.0),
            (Kernel::new(Foundation::Layer { thickness: 1.0, poisson: 0.48 }), 2.0),
            (Kernel::new(Foundation::Layer { thickness: 2.0, poisson: 0.3 }), 3.0),
        ] {
            let (left, right) = (0.11, 0.07);
            for distance in [distance, -distance] {
                let f = |x: f64| kernel.twice_integrated(x)[0];
                let near = (f(distance - right) - f(distance)) / right
                    - (f(distance) - f(distance + left)) / left;
                let far = kernel.far(distance, left, right);
                assert!((far - near).abs() < 1e-6, "{distance}: {far} {near}");
            }
        }
        // beyond the table a layer is not moved at all
        let layer = Kernel::new(Foundation::Layer { thickness: 1.0, poisson: 0.3 });
        assert!(layer.far(33.0, 0.1, 0.1).abs() < f64::MIN_POSITIVE);
        let [value, stretch] = layer.twice_integrated(40.0);
        let [at_end, slope] = layer.twice_integrated(END);
        assert!((value - at_end - slope / END * 8.0).abs() < 1e-9);
        assert!((stretch / 40.0 - slope / END).abs() < 1e-9);
    }

    #[test]
    fn the_table_is_its_own_derivatives() {
        let kernel = Kernel::new(Foundation::Layer { thickness: 1.0, poisson: 0.4 });
        for x in [0.13, 0.51, 1.77, 5.2, 20.01] {
            for column in [0, 2] {
                let by = 1e-4;
                let [_, slope, bend] = kernel.correction(x, column);
                let [low, mid, high] = [x - by, x, x + by].map(|x| kernel.correction(x, column)[0]);
                assert!((slope - (high - low) / (2.0 * by)).abs() < 1e-6, "{x} {column}");
                assert!((bend - (high - 2.0 * mid + low) / (by * by)).abs() < 1e-4, "{x} {column}");
            }
            let [value, slope, _] = kernel.correction(x, 1);
            let [_, first, second] = kernel.correction(x, 0);
            assert!((value - first).abs() < 1e-8 && (slope - second).abs() < 1e-6, "{x}");
        }
    }

    #[test]
    fn a_kernel_in_other_units_is_the_same() {
        let kernel = Kernel::new(Foundation::Layer { thickness: 2e-3, poisson: 0.45 });
        let scaled = kernel.scaled(1e-3);
        assert!((scaled.length - 2.0).abs() < 1e-15);
        let [value, _] = kernel.twice_integrated(3e-3);
        let [other, _] = scaled.twice_integrated(3.0);
        assert!((value / 1e-6 / other - 1.0).abs() < 1e-12);
        assert_eq!(
            Kernel::new(Foundation::HalfSpace).scaled(7.0).length.to_bits(),
            1_f64.to_bits()
        );
    }
}
