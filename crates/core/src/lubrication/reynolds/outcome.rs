//! Film, friction and exponents of a solution, in the units of the contact.

use super::LineContact;
use super::continuation::Path;
use super::equations::{Equations, Film, Unknowns, load};
use crate::error::Error;
use crate::work::Work;

/// Step in the logarithm of speed or load, along the tangent, of the exponents; times the film over a^2/R.
const STEP: f64 = 1e-3;

/// The film of a line contact.
#[derive(Debug, Clone, PartialEq)]
pub struct LineSolution {
    /// Place along the film, from the axis of the roll downstream, m.
    pub x: Vec<f64>,
    /// Pressure, Pa.
    pub pressure: Vec<f64>,
    /// Film thickness, m.
    pub film_thickness: Vec<f64>,
    /// The numbers that are followed when the speed changes.
    pub summary: Summary,
    /// Greatest pressure at a node, Pa.
    pub greatest_pressure: f64,
    /// Place of the outlet, where the film ruptures, m.
    pub outlet: f64,
    /// Film less parabola and deflection, m; for a half space it belongs to the scale a of the logarithm.
    pub offset: f64,
    /// Half width of the dry contact (for a layer: about) with the length of a rigid film, m.
    pub length: f64,
    /// Integral of the pressure over the load, less 1.
    pub load_residual: f64,
    /// Greatest error of flow over the flow.
    pub flow_residual: f64,
    /// Relative error of the least film that the difference to the coarse grid speaks for.
    pub grid_error: f64,
    /// Newton steps in all.
    pub iterations: usize,
    /// Solutions from the start to the speed asked for.
    pub stations: usize,
    /// Derivatives of the logarithms to that of speed, speeds of both surfaces growing alike.
    pub by_speed: Exponents,
    /// Derivatives of the logarithms to that of load.
    pub by_load: Exponents,
}

/// Films and forces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary {
    /// Film thickness under the axis of the roll, m.
    pub central: f64,
    /// Least film thickness, m.
    pub minimum: f64,
    /// Shear by the sliding speed, per length, N/m.
    pub couette: f64,
    /// Half the integral of film thickness times pressure gradient, per length, N/m.
    pub poiseuille: f64,
}

/// Exponents of a power law that touches at this point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exponents {
    /// Of the film under the axis.
    pub central: f64,
    /// Of the least film.
    pub minimum: f64,
    /// Of the traction on surface 1.
    pub traction_1: f64,
    /// Of the traction on surface 2; not a number without sliding.
    pub traction_2: f64,
}

impl Summary {
    /// Shear force on surface 1 along the motion, per length, N/m; its torque is what the drive feels.
    #[must_use]
    pub fn traction_1(&self) -> f64 {
        -self.couette - self.poiseuille
    }

    /// Shear force on surface 2 along the motion, per length, N/m.
    #[must_use]
    pub fn traction_2(&self) -> f64 {
        self.couette - self.poiseuille
    }
}

/// The solution in the units of the contact, and its error by that on a coarser grid.
///
/// # Errors
/// If `work` ends before.
pub fn outcome(
    contact: &LineContact,
    coarse: &Path,
    path: &Path,
    work: &Work,
) -> Result<LineSolution, Error> {
    let a = path.length;
    let thickness = a * a / contact.radius;
    let Path { equations, solution, .. } = path;
    let (point, film) = (&solution.unknowns, &solution.film);
    let pressure: Vec<f64> = point.pressure.iter().map(|p| p * equations.pressure).collect();
    let least = film.thickness.iter().fold(1.0_f64, |a, h| a.min(*h));
    let exponents = |speed: f64, load: f64| exponents(contact, path, speed, load, work);
    Ok(LineSolution {
        x: film.x.iter().map(|x| x * a).collect(),
        greatest_pressure: pressure.iter().fold(0.0, |top, p| top.max(*p)),
        pressure,
        film_thickness: film.thickness.iter().map(|h| h * thickness).collect(),
        grid_error: grid_error(contact, coarse, path),
        summary: summary(contact, equations, a, point, film),
        outlet: point.outlet * a,
        offset: point.offset * thickness,
        length: a,
        load_residual: load(&film.x, &point.pressure) - 1.0,
        flow_residual: solution.residual,
        iterations: path.steps,
        stations: path.stations,
        by_speed: exponents(STEP * least, 0.0)?,
        by_load: exponents(0.0, STEP * least)?,
    })
}

/// Error of the least film, second order in the distance of the nodes, from two grids.
#[allow(clippy::cast_precision_loss)] // counts of nodes
fn grid_error(contact: &LineContact, coarse: &Path, fine: &Path) -> f64 {
    let least = |path: &Path| {
        let solution = &path.solution;
        summary(contact, &path.equations, path.length, &solution.unknowns, &solution.film).minimum
    };
    let ratio = fine.equations.shares.len() as f64 / coarse.equations.shares.len() as f64;
    let gain = (ratio * ratio - 1.0).abs().max(0.5);
    (least(coarse) / least(fine) - 1.0).abs() / gain
}

/// Exponents by a step along the tangent of the solution, which the factored Jacobian gives.
fn exponents(
    contact: &LineContact,
    path: &Path,
    speed: f64,
    load: f64,
    work: &Work,
) -> Result<Exponents, Error> {
    let solution = &path.solution;
    let end = |sign: f64| -> Result<Summary, Error> {
        let contact = LineContact {
            entrainment_speed: contact.entrainment_speed * (sign * speed).exp(),
            sliding_speed: contact.sliding_speed * (sign * speed).exp(),
            load: contact.load * (sign * load).exp(),
            ..*contact
        };
        let equations = Equations {
            speed: path.equations.speed * (sign * (speed - load)).exp(),
            compliance: path.equations.compliance * (sign * load).exp(),
            pressure: path.equations.pressure * (sign * load).exp(),
            ..path.equations.clone()
        };
        let film = equations.film(&solution.unknowns, work)?;
        let mut step: Vec<f64> =
            equations.residual(&solution.unknowns, &film).iter().map(|r| -r).collect();
        solution.factors.solve(&mut step);
        let point = solution.unknowns.moved(&step, 1.0);
        let film = equations.film(&point, work)?;
        Ok(summary(&contact, &equations, path.length, &point, &film))
    };
    let ends = [end(-1.0)?, end(1.0)?];
    let slope =
        |of: fn(&Summary) -> f64| (of(&ends[1]) / of(&ends[0])).ln() / (2.0 * (speed + load));
    Ok(Exponents {
        central: slope(|s| s.central),
        minimum: slope(|s| s.minimum),
        traction_1: slope(Summary::traction_1),
        traction_2: slope(Summary::traction_2),
    })
}

/// Films and forces of a point.
fn summary(
    contact: &LineContact,
    equations: &Equations,
    a: f64,
    point: &Unknowns,
    film: &Film,
) -> Summary {
    let thickness = a * a / contact.radius;
    let (x, h, p) = (&film.x, &film.thickness, &point.pressure);
    let n = x.len() - 1;
    // upstream of the grid the gap opens as x^2
    let mut shear = -x[0] / h[0];
    let mut pressing = 0.0;
    for k in 0..n {
        let middle = 0.5 * (h[k] + h[k + 1]);
        let mean = equations.pressure * 0.5 * (p[k] + p[k + 1]);
        shear += equations.fluid.viscosity_ratio(mean).0 * (x[k + 1] - x[k]) / middle;
        pressing += 0.5 * middle * (p[k + 1] - p[k]);
    }
    Summary {
        central: thickness * parabola(x, h, Some(0.0)),
        minimum: thickness * parabola(x, h, None),
        couette: contact.fluid.viscosity * contact.sliding_speed * shear * a / thickness,
        poiseuille: pressing * equations.pressure * thickness,
    }
}

/// The parabola through three nodes, at a place or at its least.
fn parabola(x: &[f64], h: &[f64], place: Option<f64>) -> f64 {
    let n = x.len() - 1;
    let middle = match place {
        Some(place) => x.partition_point(|x| *x < place),
        None => (0..=n).min_by(|&i, &j| h[i].total_cmp(&h[j])).unwrap_or(1),
    };
    let i = middle.clamp(1, n - 1);
    let (left, right) = (x[i] - x[i - 1], x[i + 1] - x[i]);
    let (before, after) = ((h[i] - h[i - 1]) / left, (h[i + 1] - h[i]) / right);
    let bend = (after - before) / (left + right);
    let slope = before + bend * left;
    let s = place.map_or(-slope / (2.0 * bend), |place| place - x[i]);
    h[i] + s * (slope + s * bend)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_is_read_where_it_is_asked_for() {
        // 2 + 0.5 (x - 0.4)^2 on uneven nodes
        let x = [-1.0, -0.2, 0.1, 0.7, 1.5];
        let h = x.map(|x: f64| 2.0 + 0.5 * (x - 0.4).powi(2));
        assert!((parabola(&x, &h, None) - 2.0).abs() < 1e-14);
        assert!((parabola(&x, &h, Some(0.0)) - 2.08).abs() < 1e-14);
        assert!((parabola(&x, &h, Some(1.2)) - 2.32).abs() < 1e-14);
        assert!((parabola(&x, &h, Some(-3.0)) - 7.78).abs() < 1e-13);
    }

    #[test]
    fn tractions_add_shear_and_pressure_each_with_its_side() {
        let summary = Summary { central: 1.0, minimum: 0.8, couette: 3.0, poiseuille: 0.5 };
        assert!((summary.traction_1() + 3.5).abs() < 1e-15);
        assert!((summary.traction_2() - 2.5).abs() < 1e-15);
    }
}
