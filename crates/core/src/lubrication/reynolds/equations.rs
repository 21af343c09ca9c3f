//! The discrete equations of a lubricated line contact, and Newton's method on all of them together.
//!
//! Lengths along the film are in units of a, pressure in w/a (w the load per length), film thickness in a^2/R. The
//! unknowns are the pressures between inlet and outlet, the place of the outlet and the rigid approach. On every cell
//! the flow that passes is that of the outlet,
//!
//! ```text
//! rho H - rho H^3 / (Lambda eta) dP/dX = rho_0 H_outlet,    Lambda = 12 eta_0 u R^2 / (a^2 w),
//! ```
//!
//! which holds the Swift-Stieber condition dP/dX = 0 at the outlet, and the pressure carries the load.

use super::dense::{Factors, Matrix, dot, factors_work};
use super::elasticity::{Influence, Kernel, influence_work};
use super::fluid::Fluid;
use crate::error::Error;
use crate::work::Work;

/// Newton steps of one solution.
const STEPS: usize = 30;
/// Relative error of the flow at which Newton's method ends,
const TOLERANCE: f64 = 1e-10;
/// and below which it may end where rounding stops it.
const FLOOR: f64 = 1e-6;
/// A film may shrink to this share of itself in one step.
const SHRINKAGE: f64 = 0.15;
/// Shortest share of a Newton step that is tried.
const SHORTEST: f64 = 1.0 / 256.0;

/// One case in scaled form.
#[derive(Debug, Clone)]
pub struct Equations {
    /// Places of the nodes as shares of the way from inlet to outlet.
    pub shares: Vec<f64>,
    /// Distance of the inlet upstream of the axis of the roll.
    pub inlet: f64,
    /// Speed parameter Lambda.
    pub speed: f64,
    /// Deflection per integral of pressure and kernel: 2 w R / (pi E* a^2).
    pub compliance: f64,
    /// Kernel of the elastic surface, in units of a.
    pub kernel: Kernel,
    /// The lubricant.
    pub fluid: Fluid,
    /// Unit of pressure w/a, Pa.
    pub pressure: f64,
}

/// Pressures at the nodes, the outlet and the approach: a point in the space of unknowns.
#[derive(Debug, Clone)]
pub struct Unknowns {
    /// Pressure at each node; zero at the first and the last.
    pub pressure: Vec<f64>,
    /// Place of the outlet.
    pub outlet: f64,
    /// Film thickness less parabola and deflection.
    pub offset: f64,
}

/// Nodes and film that belong to a point.
#[derive(Debug, Clone)]
pub struct Film {
    /// Places of the nodes.
    pub x: Vec<f64>,
    /// Film thickness at the nodes.
    pub thickness: Vec<f64>,
    /// Deflection integrals.
    influence: Influence,
}

/// A converged point.
#[derive(Debug, Clone)]
pub struct Solution {
    /// The unknowns.
    pub unknowns: Unknowns,
    /// Their film.
    pub film: Film,
    /// Factors of the Jacobian at the last step but one.
    pub factors: Factors,
    /// Newton steps taken.
    pub steps: usize,
    /// Greatest error of flow over the flow.
    pub residual: f64,
}

impl Film {
    /// Greatest error of flow, or of load, over the film at the outlet.
    fn error(&self, residual: &[f64]) -> f64 {
        greatest(residual) / self.thickness[self.x.len() - 1]
    }
}

impl Unknowns {
    /// This point moved by `share` of `step`.
    #[must_use]
    pub fn moved(&self, step: &[f64], share: f64) -> Self {
        let n = self.pressure.len() - 1;
        let mut moved = self.clone();
        for (p, d) in moved.pressure[1..n].iter_mut().zip(step) {
            *p += share * d;
        }
        moved.outlet += share * step[n - 1];
        moved.offset += share * step[n];
        moved
    }
}

impl Equations {
    /// Places of the nodes for an outlet.
    #[must_use]
    pub fn nodes(&self, outlet: f64) -> Vec<f64> {
        self.shares.iter().map(|s| s * outlet - (1.0 - s) * self.inlet).collect()
    }

    /// Nodes and film of a point.
    ///
    /// # Errors
    /// If `work` ends before.
    pub fn film(&self, point: &Unknowns, work: &Work) -> Result<Film, Error> {
        let x = self.nodes(point.outlet);
        let influence = self.kernel.influence(&x, work)?;
        let thickness = x
            .iter()
            .enumerate()
            .map(|(i, &x)| {
                let deflection = dot(influence.hats.row(i), &point.pressure);
                point.offset + 0.5 * x * x + self.compliance * deflection
            })
            .collect();
        Ok(Film { x, thickness, influence })
    }

    /// What is left of each equation: flow on each cell, then the load.
    #[must_use]
    pub fn residual(&self, point: &Unknowns, film: &Film) -> Vec<f64> {
        let n = film.x.len() - 1;
        let out = film.thickness[n] * self.fluid.density_ratio(0.0).0;
        let mut residual: Vec<f64> = (0..n).map(|k| self.cell(k, point, film).flow - out).collect();
        residual.push(load(&film.x, &point.pressure) - 1.0);
        residual
    }

    /// Flow through cell `k` and its derivatives to what lies around it.
    fn cell(&self, k: usize, point: &Unknowns, film: &Film) -> Cell {
        let (x, h, p) = (&film.x, &film.thickness, &point.pressure);
        let weights = wedge_weights(x, k);
        let first = k.max(1) - 1;
        let mut cell = Cell { first, ..Cell::default() };
        for (c, &weight) in weights.iter().enumerate() {
            let (density, slope) = self.fluid.density_ratio(self.pressure * p[first + c]);
            cell.flow += weight * density * h[first + c];
            cell.by_film[c] = weight * density;
            cell.by_pressure[c] = weight * slope * self.pressure * h[first + c];
        }
        let middle = 0.5 * (h[k] + h[k + 1]);
        let mean = self.pressure * 0.5 * (p[k] + p[k + 1]);
        let (density, density_slope) = self.fluid.density_ratio(mean);
        let (viscosity, viscosity_slope) = self.fluid.viscosity_ratio(mean);
        let conductance = density * middle.powi(3) / (self.speed * viscosity);
        let gradient = (p[k + 1] - p[k]) / (x[k + 1] - x[k]);
        cell.pressure_flow = conductance * gradient;
        cell.flow -= cell.pressure_flow;
        let by_film = -0.5 * 3.0 * conductance / middle * gradient;
        let relative = density_slope / density - viscosity_slope / viscosity;
        let by_mean = -0.5 * self.pressure * relative * conductance * gradient;
        let by_gradient = conductance / (x[k + 1] - x[k]);
        let here = k - first;
        cell.by_film[here] += by_film;
        cell.by_film[here + 1] += by_film;
        cell.by_pressure[here] += by_mean + by_gradient;
        cell.by_pressure[here + 1] += by_mean - by_gradient;
        cell
    }

    /// Derivatives of film and of the places of the nodes to that of the outlet.
    fn by_outlet(&self, point: &Unknowns, film: &Film) -> Vec<f64> {
        let span = point.outlet + self.inlet;
        let deflection: Vec<f64> =
            (0..film.x.len()).map(|i| dot(film.influence.hats.row(i), &point.pressure)).collect();
        let growth = film.influence.by_growth(&film.x, &point.pressure, &deflection);
        film.x
            .iter()
            .zip(&self.shares)
            .zip(&growth)
            .map(|((x, share), growth)| x * share + self.compliance * growth / span)
            .collect()
    }

    /// Derivatives of the residual to pressures, outlet and offset.
    fn jacobian(&self, point: &Unknowns, film: &Film) -> Matrix {
        let n = film.x.len() - 1;
        let span = point.outlet + self.inlet;
        let mut jacobian = Matrix::zeros(n + 1);
        let by_outlet = self.by_outlet(point, film);
        let out = self.fluid.density_ratio(0.0).0;
        let hats = |i: usize| &film.influence.hats.row(i)[1..n];
        for k in 0..n {
            let cell = self.cell(k, point, film);
            let row = jacobian.row_mut(k);
            for (entry, deflection) in row.iter_mut().zip(hats(n)) {
                *entry = -self.compliance * out * deflection;
            }
            row[n - 1] = cell.pressure_flow / span - out * by_outlet[n];
            row[n] = -out;
            for (c, by_film) in cell.by_film.iter().enumerate().filter(|(_, b)| **b != 0.0) {
                let factor = self.compliance * by_film;
                for (entry, deflection) in row.iter_mut().zip(hats(cell.first + c)) {
                    *entry += factor * deflection;
                }
                row[n - 1] += by_film * by_outlet[cell.first + c];
                row[n] += by_film;
            }
            for (c, by_pressure) in cell.by_pressure.iter().enumerate() {
                let node = cell.first + c;
                if (1..n).contains(&node) {
                    row[node - 1] += by_pressure;
                }
            }
        }
        let row = jacobian.row_mut(n);
        for j in 1..n {
            row[j - 1] = 0.5 * (film.x[j + 1] - film.x[j - 1]);
        }
        row[n - 1] = load(&film.x, &point.pressure) / span;
        jacobian
    }

    /// The solution from a first guess, or nothing if Newton's method stalls.
    ///
    /// # Errors
    /// If `work` ends before.
    pub fn solve(&self, guess: Unknowns, work: &Work) -> Result<Option<Solution>, Error> {
        let mut point = guess;
        let mut film = self.film(&point, work)?;
        if !film.thickness.iter().all(|h| *h > 0.0) {
            return Ok(None);
        }
        let mut residual = self.residual(&point, &film);
        let mut before = f64::INFINITY;
        for steps in 1..=STEPS {
            let error = film.error(&residual);
            let Some(factors) = Factors::new(self.jacobian(&point, &film), work)? else {
                return Ok(None);
            };
            let mut step: Vec<f64> = residual.iter().map(|r| -r).collect();
            factors.solve(&mut step);
            let next = self.descend(&point, &film, &residual, &step, work)?;
            let after = next.as_ref().map_or(error, |(_, film, left)| film.error(left));
            if after < TOLERANCE || (error < FLOOR && after > 0.1 * error.min(before)) {
                if let Some(next) = next {
                    (point, film, _) = next;
                }
                let residual = after;
                return Ok(Some(Solution { unknowns: point, film, factors, steps, residual }));
            }
            before = error;
            let Some(next) = next else { return Ok(None) };
            (point, film, residual) = next;
        }
        Ok(None)
    }

    /// The point that the longest admissible share of `step` leads to.
    fn descend(
        &self,
        point: &Unknowns,
        film: &Film,
        residual: &[f64],
        step: &[f64],
        work: &Work,
    ) -> Result<Option<(Unknowns, Film, Vec<f64>)>, Error> {
        let before = norm(residual);
        let mut share = 1.0;
        while share >= SHORTEST {
            let moved = point.moved(step, share);
            if moved.outlet > -0.5 * self.inlet && moved.outlet < self.inlet {
                let next = self.film(&moved, work)?;
                let open = next
                    .thickness
                    .iter()
                    .zip(&film.thickness)
                    .all(|(new, old)| *new > SHRINKAGE * old);
                if open {
                    let left = self.residual(&moved, &next);
                    let after = norm(&left);
                    let small = next.error(&left) < TOLERANCE;
                    if after <= before * (1.0 - 0.1 * share) || small {
                        return Ok(Some((moved, next, left)));
                    }
                }
            }
            share *= 0.5;
        }
        Ok(None)
    }
}

/// Work of one Newton step on so many nodes, about.
#[must_use]
pub fn newton_work(nodes: usize) -> u64 {
    factors_work(nodes) + 2 * influence_work(nodes)
}

/// Flow through a cell, and its derivatives to film and pressure at three nodes from `first` on.
#[derive(Default)]
struct Cell {
    first: usize,
    flow: f64,
    /// The part driven by pressure, against the speed.
    pressure_flow: f64,
    by_film: [f64; 3],
    by_pressure: [f64; 3],
}

/// Weights at the node before cell `k` and its two that give the value in its middle: the mean of the parabola through
/// the three and the line through the first two, so exact for lines; on the first cell the mean of its two. The node
/// upstream keeps neighbours from taking turns where pressure hardly drives flow.
fn wedge_weights(x: &[f64], k: usize) -> [f64; 3] {
    if k == 0 {
        return [0.5, 0.5, 0.0];
    }
    let (before, left, right) = (x[k - 1], x[k], x[k + 1]);
    let middle = 0.5 * (left + right);
    let parabola = [
        (middle - left) * (middle - right) / ((before - left) * (before - right)),
        (middle - before) * (middle - right) / ((left - before) * (left - right)),
        (middle - before) * (middle - left) / ((right - before) * (right - left)),
    ];
    let ahead = (middle - left) / (left - before);
    let line = [-ahead, 1.0 + ahead, 0.0];
    std::array::from_fn(|c| 0.5 * (parabola[c] + line[c]))
}

/// Integral of the pressure, linear between the nodes.
#[must_use]
pub fn load(x: &[f64], pressure: &[f64]) -> f64 {
    (1..x.len()).map(|i| 0.5 * (x[i] - x[i - 1]) * (pressure[i] + pressure[i - 1])).sum()
}

fn greatest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |a, v| if v.is_nan() { f64::INFINITY } else { a.max(v.abs()) })
}

fn norm(values: &[f64]) -> f64 {
    dot(values, values).sqrt()
}

#[cfg(test)]
mod tests {
    use super::super::elasticity::Foundation;
    use super::super::fluid::Thickening;
    use super::*;

    fn case(foundation: Foundation) -> (Equations, Unknowns) {
        let cells = 24;
        let shares: Vec<f64> =
            (0..=cells).map(|i| (f64::from(i) / f64::from(cells)).powf(0.8)).collect();
        let fluid = Fluid {
            viscosity: 0.1,
            pressure_viscosity: 2e-8,
            thickening: Thickening::Barus,
            compressible: true,
        };
        let kernel = Kernel::new(foundation);
        let equations = Equations {
            shares,
            inlet: 4.0,
            speed: 0.4,
            compliance: 0.5,
            kernel,
            fluid,
            pressure: 4e7,
        };
        let nodes = equations.nodes(1.1);
        let bump = |x: f64| 0.6 * (1.0 - (x / 1.1).powi(2)).max(0.0).sqrt() + 0.01 * (x + 4.0);
        let mut pressure: Vec<f64> = nodes.iter().map(|x| bump(*x)).collect();
        (pressure[0], pressure[24]) = (0.0, 0.0);
        (equations, Unknowns { pressure, outlet: 1.1, offset: 1.3 })
    }

    #[test]
    fn the_jacobian_is_the_slope_of_the_residual() {
        for foundation in
            [Foundation::HalfSpace, Foundation::Layer { thickness: 1.5, poisson: 0.45 }]
        {
            let (equations, point) = case(foundation);
            let film = equations.film(&point, &Work::default()).unwrap();
            let jacobian = equations.jacobian(&point, &film);
            let n = film.x.len() - 1;
            for column in 0..=n {
                let mut step = vec![0.0; n + 1];
                step[column] = 1.0;
                let by = 1e-6;
                let residual = |share: f64| {
                    let moved = point.moved(&step, share);
                    let film = equations.film(&moved, &Work::default()).unwrap();
                    equations.residual(&moved, &film)
                };
                for (row, (up, down)) in residual(by).iter().zip(residual(-by)).enumerate() {
                    let slope = (up - down) / (2.0 * by);
                    let found = jacobian.row(row)[column];
                    let near = 1e-6 * (1.0 + slope.abs());
                    assert!((found - slope).abs() < near, "{row} {column}: {found} {slope}");
                }
            }
        }
    }

    #[test]
    fn a_wedge_is_weighed_exactly_for_lines() {
        let x = [0.0, 0.3, 1.0, 1.2];
        assert_eq!(wedge_weights(&x, 0).map(f64::to_bits), [0.5, 0.5, 0.0].map(f64::to_bits));
        for k in [1, 2] {
            let weights = wedge_weights(&x, k);
            let middle = 0.5 * (x[k] + x[k + 1]);
            let mean = |of: fn(f64) -> f64| -> f64 {
                weights.iter().zip(&x[k - 1..]).map(|(w, x)| w * of(*x)).sum()
            };
            assert!((mean(|_| 1.0) - 1.0).abs() < 1e-14 && (mean(|x| x) - middle).abs() < 1e-14);
            // of a parabola the half that the line misses: (x - a)(x - b)/2 at the middle, a and b the first two
            let missed = 0.5 * (middle - x[k - 1]) * (middle - x[k]);
            assert!((mean(|x| x * x) - (middle * middle - missed)).abs() < 1e-14, "{k}");
        }
    }

    #[test]
    fn load_and_norms() {
        assert!((load(&[0.0, 1.0, 3.0], &[0.0, 2.0, 1.0]) - 4.0).abs() < 1e-15);
        assert_eq!(greatest(&[1.0, -3.0, 2.0]).to_bits(), 3_f64.to_bits());
        assert!(greatest(&[1.0, f64::NAN]).is_infinite());
        assert!((norm(&[3.0, -4.0]) - 5.0).abs() < 1e-15);
    }
}
