//! From the film under a rigid roll down to the speed asked for.
//!
//! At high speed the film is so thick that neither deflection nor pressure matters to it, and Martin's solution of the
//! rigid roll is near. From there the speed falls step by step, each solution being the guess for the next, on a
//! coarse grid that follows the pressure; the last one is carried to the fine grid.

use std::f64::consts::PI;

use super::elasticity::{Kernel, layer_factor};
use super::equations::{Equations, Solution, Unknowns, load, newton_work};
use super::fluid::Fluid;
use super::grid::{density, equidistributed, interpolated};
use super::{Foundation, LineContact};
use crate::error::Error;
use crate::work::Work;

/// Cells of the coarse grid.
const COARSE: usize = 112;
/// h = 4.893 eta u R / w under a rigid roll (Martin 1916).
const MARTIN: f64 = 4.893;
/// Outlet over root of 2 R h of the same.
const MARTIN_OUTLET: f64 = 0.475_1;
/// Greatest deflection over film at the start.
const RIGID: f64 = 0.1;
/// First and greatest step in the logarithm of speed.
const SPEED_STEPS: (f64, f64) = (1.0, 2.5);
/// First and greatest step in pressure coefficient times pressure.
const THICKENING_STEPS: (f64, f64) = (1.0, 4.0);
/// Least step, over the first.
const LEAST: f64 = 1e-3;
/// Grids on the way to the fine one, in each attempt.
const BETWEEN: [u32; 3] = [1, 3, 8];
/// Newton steps on the fine grid, and on all between, before a film is given up.
const FINE_STEPS: u64 = 60;
/// Newton steps below which the next step in speed may be longer.
const EASY: usize = 7;
/// The inlet lies where the gap is that many times the film; a rigid film loses about 2 over it.
const INLET_GAP: f64 = 2e4;
/// Distance of the inlet at least, in units of a.
const INLET_LEAST: f64 = 4.5;

/// A solution with what scales it.
#[derive(Debug, Clone)]
pub struct Path {
    /// The equations solved.
    pub equations: Equations,
    /// Their solution.
    pub solution: Solution,
    /// Unit of length a, m.
    pub length: f64,
    /// Newton steps in all.
    pub steps: usize,
    /// Solutions on the way.
    pub stations: usize,
}

/// Solve a contact on a coarse grid and on one of so many cells.
///
/// # Errors
/// If the way down, or `work`, ends before the speed asked for.
pub fn follow(contact: &LineContact, cells: usize, work: &Work) -> Result<[Path; 2], Error> {
    let way = work.apart(work.allowed());
    let scaling = Scaling::new(contact, &way);
    let factor = scaling.start();
    let mut here = scaling.first(factor)?;
    let fall = factor.ln();
    if fall > 0.0 {
        let slowing = |share: f64| Station { factor: factor.powf(1.0 - share), thickening: 0.0 };
        here = scaling.march(here, slowing, SPEED_STEPS.0 / fall, SPEED_STEPS.1 / fall)?;
    }
    let exponent = contact.fluid.pressure_viscosity * here.greatest_pressure();
    if exponent > 0.0 {
        let thickening = |share: f64| Station { factor: 1.0, thickening: share };
        let (first, longest) = THICKENING_STEPS;
        here = scaling.march(here, thickening, first / exponent, longest / exponent)?;
    }
    // once more on the coarse grid, so that its nodes follow the last pressure, where that can be done
    let last = Station { factor: 1.0, thickening: 1.0 };
    if let Some(again) = scaling.onwards(&here, last, COARSE)? {
        here = again;
    }
    let fine_work = work.apart(work.allowed().saturating_add(FINE_STEPS * newton_work(cells + 1)));
    let fine = Scaling { work: &fine_work, ..scaling }.refine(here.clone(), last, cells)?;
    Ok([here, fine])
}

/// A case on the way: multiple of the speed and share of the pressure coefficient.
#[derive(Debug, Clone, Copy)]
struct Station {
    factor: f64,
    thickening: f64,
}

/// What does not change on the way.
struct Scaling<'a> {
    contact: &'a LineContact,
    kernel: Kernel,
    /// Half width of the dry contact, about.
    dry: f64,
    work: &'a Work<'a>,
}

impl<'a> Scaling<'a> {
    fn new(contact: &'a LineContact, work: &'a Work<'a>) -> Self {
        let (kernel, dry) = (Kernel::new(contact.foundation), dry_half_width(contact));
        Self { contact, kernel, dry, work }
    }

    /// Film under a rigid roll at so many times the speed.
    fn martin(&self, factor: f64) -> f64 {
        let c = self.contact;
        MARTIN * c.fluid.viscosity * factor * c.entrainment_speed * c.radius / c.load
    }

    /// Unit of length at so many times the speed.
    fn length(&self, factor: f64) -> f64 {
        self.dry.hypot((2.0 * self.contact.radius * self.martin(factor)).sqrt())
    }

    /// Multiple of the speed at which the roll is nearly rigid.
    fn start(&self) -> f64 {
        let deflection = self.dry * self.dry / self.contact.radius;
        (deflection / (RIGID * self.martin(1.0))).max(1.0)
    }

    /// Solutions from one to the station at share 1, in steps of adapted length.
    fn march(
        &self,
        mut here: Path,
        station: impl Fn(f64) -> Station,
        first: f64,
        longest: f64,
    ) -> Result<Path, Error> {
        let (mut share, mut step) = (0.0, first);
        while share < 1.0 {
            let next = if share + 1.01 * step > 1.0 { 1.0 } else { share + step };
            match self.onwards(&here, station(next), COARSE)? {
                Some(there) => {
                    if there.steps - here.steps < EASY {
                        step = (1.5 * step).min(longest);
                    }
                    (here, share) = (there, next);
                }
                None if step > LEAST * first => step *= 0.4,
                None => return Err(self.lost(station(share))),
            }
        }
        Ok(here)
    }

    /// Equations of a station, for nodes at `shares`.
    fn equations(&self, station: Station, inlet: f64, shares: Vec<f64>) -> Equations {
        let c = self.contact;
        let Station { factor, thickening } = station;
        let a = self.length(factor);
        let speed = factor * c.entrainment_speed;
        Equations {
            shares,
            inlet,
            speed: 12.0 * c.fluid.viscosity * speed * (c.radius / a).powi(2) / c.load,
            compliance: 2.0 * c.load * c.radius / (PI * c.contact_modulus * a * a),
            kernel: self.kernel.scaled(a),
            fluid: Fluid { pressure_viscosity: thickening * c.fluid.pressure_viscosity, ..c.fluid },
            pressure: c.load / a,
        }
    }

    /// The solution near that of a rigid roll.
    fn first(&self, factor: f64) -> Result<Path, Error> {
        let film = self.martin(factor) * self.contact.radius / self.length(factor).powi(2);
        let inlet = inlet_of(film);
        let points: Vec<f64> = (0..=400_u32).map(|i| f64::from(i) / 400.0).collect();
        let outlet = MARTIN_OUTLET * (2.0 * film).sqrt();
        let weights: Vec<f64> =
            points.iter().map(|s| 1.0 / (0.5 + (s * outlet - (1.0 - s) * inlet).abs())).collect();
        let shares = equidistributed(&points, &weights, COARSE);
        let station = Station { factor, thickening: 0.0 };
        let equations = self.equations(station, inlet, shares);
        let nodes = equations.nodes(outlet);
        let guess = Unknowns { pressure: rigid_pressure(&nodes, film), outlet, offset: film };
        let solution = self.solved(&equations, guess, film, station)?;
        let solution = solution.ok_or_else(|| self.lost(station))?;
        let steps = solution.steps;
        Ok(Path { equations, solution, length: self.length(factor), steps, stations: 1 })
    }

    /// The solution at another multiple of the speed or on another grid, guessed from one nearby.
    fn onwards(&self, from: &Path, station: Station, cells: usize) -> Result<Option<Path>, Error> {
        let factor = station.factor;
        let film = &from.solution.film;
        let lowest = film.thickness.iter().fold(f64::INFINITY, |a, h| a.min(*h));
        let change = from.length / self.length(factor);
        let ratio = factor * self.contact.entrainment_speed / from.speed(self.contact);
        let least = lowest * change * change * ratio.powf(0.6);
        let inlet = inlet_of(least);
        // places and pressures in the new units, with a new inlet
        let mut x: Vec<f64> = film.x.iter().map(|x| x * change).collect();
        let mut p = from.solution.unknowns.pressure.clone();
        let mut weights = density(&x, &p, &film.thickness);
        refit(&mut x, &mut p, &mut weights, inlet);
        let shares = equidistributed(&x, &weights, cells);
        let equations = self.equations(station, inlet, shares);
        let outlet = x[x.len() - 1];
        let nodes = equations.nodes(outlet);
        let mut pressure = interpolated(&x, &p, &nodes);
        let carried = load(&nodes, &pressure);
        for p in &mut pressure {
            *p /= carried;
        }
        pressure[0] = 0.0;
        let guess = Unknowns { pressure, outlet, offset: 0.0 };
        let Some(solution) = self.solved(&equations, guess, least, station)? else {
            return Ok(None);
        };
        let steps = from.steps + solution.steps;
        let stations = from.stations + 1;
        Ok(Some(Path { equations, solution, length: self.length(factor), steps, stations }))
    }

    /// The solution of a station from a guess, its offset such that its least film is `least`.
    fn solved(
        &self,
        equations: &Equations,
        guess: Unknowns,
        least: f64,
        station: Station,
    ) -> Result<Option<Solution>, Error> {
        settled(equations, guess, least, self.work)
            .and_then(|guess| equations.solve(guess, self.work))
            .map_err(|error| self.given_up(error, station))
    }

    /// The solution on a grid of so many cells, over grids between where it is not reached at once.
    fn refine(&self, mut here: Path, last: Station, cells: usize) -> Result<Path, Error> {
        for between in BETWEEN {
            let first = here.equations.shares.len() - 1;
            let grids = (1..=between).map(|k| {
                let share = f64::from(k) / f64::from(between);
                part(first, cells, share)
            });
            let mut reached = true;
            for grid in grids {
                let Some(next) = self.onwards(&here, last, grid)? else {
                    reached = false;
                    break;
                };
                here = next;
            }
            if reached {
                return Ok(here);
            }
        }
        Err(self.lost(last))
    }

    fn lost(&self, station: Station) -> Error {
        let (quantity, value) = self.reached(station);
        Error::NotConverged { quantity, value }
    }

    /// The end of the work as one at this station.
    fn given_up(&self, error: Error, station: Station) -> Error {
        let Error::WorkSpent { steps } = error else { return error };
        let (quantity, value) = self.reached(station);
        Error::GivenUp { quantity, value, steps }
    }

    /// What is led to its value at a station.
    fn reached(&self, Station { factor, thickening }: Station) -> (&'static str, f64) {
        let pressure_viscosity = thickening * self.contact.fluid.pressure_viscosity;
        if pressure_viscosity > 0.0 {
            return ("pressure_viscosity", pressure_viscosity);
        }
        ("entrainment_speed", factor * self.contact.entrainment_speed)
    }
}

impl Path {
    fn greatest_pressure(&self) -> f64 {
        self.equations.pressure * self.solution.unknowns.pressure.iter().fold(0.0, |a, p| p.max(a))
    }

    /// Entrainment speed that this is the solution of.
    #[must_use]
    pub fn speed(&self, contact: &LineContact) -> f64 {
        let scale = (self.length / contact.radius).powi(2);
        self.equations.speed * scale * contact.load / (12.0 * contact.fluid.viscosity)
    }
}

/// Distance of the inlet for a film.
fn inlet_of(film: f64) -> f64 {
    (2.0 * INLET_GAP * film).sqrt().max(INLET_LEAST)
}

/// Cells at a share of the way from `first` to `last`, in equal ratios.
#[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss)] // thousands
fn part(first: usize, last: usize, share: f64) -> usize {
    ((first as f64).powf(1.0 - share) * (last as f64).powf(share)).round() as usize
}

/// Cut profiles off at a new inlet, or continue them to it.
fn refit(x: &mut Vec<f64>, p: &mut Vec<f64>, weights: &mut Vec<f64>, inlet: f64) {
    let gone = x.iter().take_while(|x| **x < -inlet).count();
    if gone > 0 {
        let weight = weights[gone];
        for list in [&mut *x, p, weights] {
            list.drain(..gone);
        }
        if x[0] > -inlet {
            x.insert(0, -inlet);
            p.insert(0, 0.0);
            weights.insert(0, weight);
        }
    } else if x[0] > -inlet {
        let weight = weights[0] * x[0] / -inlet;
        x.insert(0, -inlet);
        p.insert(0, 0.0);
        weights.insert(0, weight);
    }
    p[0] = 0.0;
}

/// The guess with the offset that makes its least film `least`.
fn settled(
    equations: &Equations,
    mut guess: Unknowns,
    least: f64,
    work: &Work,
) -> Result<Unknowns, Error> {
    let film = equations.film(&guess, work)?;
    let lowest = film.thickness.iter().fold(f64::INFINITY, |a, h| a.min(*h));
    guess.offset += least - lowest;
    Ok(guess)
}

/// Pressure under a rigid roll, for a load of 1: the integral of `(H - H_outlet)/H^3` upstream from the outlet.
fn rigid_pressure(nodes: &[f64], film: f64) -> Vec<f64> {
    let n = nodes.len() - 1;
    let gap = |x: f64| film + 0.5 * x * x;
    let gradient = |x: f64| (gap(x) - gap(nodes[n])) / gap(x).powi(3);
    let mut pressure = vec![0.0; n + 1];
    for k in (0..n).rev() {
        let (a, b) = (nodes[k], nodes[k + 1]);
        let simpson = (gradient(a) + 4.0 * gradient(0.5 * (a + b)) + gradient(b)) / 6.0;
        pressure[k] = pressure[k + 1] - simpson * (b - a);
    }
    pressure[0] = 0.0;
    let carried = load(nodes, &pressure);
    pressure.iter().map(|p| p / carried).collect()
}

/// Half width of the dry contact: Hertz on a half space; on a layer by its compliance at the wavenumber 2/a, which
/// gives Hertz on a thick one.
fn dry_half_width(contact: &LineContact) -> f64 {
    let hertz = (4.0 * contact.load * contact.radius / (PI * contact.contact_modulus)).sqrt();
    let Foundation::Layer { thickness, poisson } = contact.foundation else {
        return hertz;
    };
    let (mut low, mut high) = (1e-6 * hertz, hertz);
    for _ in 0..60 {
        let middle = (low * high).sqrt();
        let softness = layer_factor(2.0 * thickness / middle, poisson);
        if middle * middle < hertz * hertz * softness {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contact(foundation: Foundation) -> LineContact {
        LineContact {
            radius: 0.015,
            contact_modulus: 2e6,
            foundation,
            load: 1000.0,
            entrainment_speed: 0.1,
            sliding_speed: 0.2,
            fluid: Fluid {
                viscosity: 0.1,
                pressure_viscosity: 0.0,
                thickening: crate::lubrication::reynolds::Thickening::Barus,
                compressible: false,
            },
        }
    }

    #[test]
    fn the_dry_contact_is_hertz_on_a_thick_layer_and_narrower_on_a_thin_one() {
        let hertz = (4.0 * 1000.0 * 0.015 / (PI * 2e6)).sqrt();
        let width = |thickness| {
            dry_half_width(&contact(Foundation::Layer { thickness, poisson: 0.45 })) / hertz
        };
        assert!((dry_half_width(&contact(Foundation::HalfSpace)) / hertz - 1.0).abs() < 1e-14);
        assert!((width(1.0) - 1.0).abs() < 1e-6);
        assert!(width(2e-3) < 0.9 && width(2e-3) > 0.4, "{}", width(2e-3));
        // the width squared is that of Hertz times the compliance at the wavenumber 2/a
        let half = width(2e-3) * hertz;
        let softness = layer_factor(2.0 * 2e-3 / half, 0.45);
        assert!((half * half / (hertz * hertz * softness) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_pressure_under_a_rigid_roll_carries_one_and_dies_out() {
        let film: f64 = 0.5;
        let outlet = MARTIN_OUTLET * (2.0 * film).sqrt();
        let nodes: Vec<f64> =
            (0..=2000_u32).map(|i| -60.0 + (60.0 + outlet) * f64::from(i) / 2000.0).collect();
        let pressure = rigid_pressure(&nodes, film);
        assert!((load(&nodes, &pressure) - 1.0).abs() < 1e-12);
        let top = pressure.iter().fold(0.0_f64, |a, p| a.max(*p));
        // Martin's outlet is where pressure, nil far upstream, is nil with its slope
        assert!(pressure[1].abs() < 2e-3 * top, "{}", pressure[1]);
        assert!(pressure[1999] < 2e-3 * top, "{}", pressure[1999]);
        // it is greatest where the gap is that at the outlet: as far before the axis as the outlet is behind it
        let place = nodes[pressure.iter().position(|p| *p >= top).unwrap()];
        assert!((place + outlet).abs() < 0.05, "{place}");
    }

    #[test]
    fn the_start_is_nearly_rigid() {
        let contact = contact(Foundation::HalfSpace);
        let work = Work::default();
        let scaling = Scaling::new(&contact, &work);
        let film = MARTIN * 0.1 * 0.1 * 0.015 / 1000.0;
        assert!((scaling.martin(1.0) / film - 1.0).abs() < 1e-14);
        assert!((scaling.martin(3.0) / film - 3.0).abs() < 1e-13);
        let factor = scaling.start();
        let deflection = scaling.dry * scaling.dry / 0.015;
        assert!((deflection / scaling.martin(factor) / RIGID - 1.0).abs() < 1e-12);
        let length = scaling.dry.hypot((2.0 * 0.015 * film).sqrt());
        assert!((scaling.length(1.0) / length - 1.0).abs() < 1e-14);
        assert!(
            (inlet_of(1.0) - 200.0).abs() < 1e-12 && (inlet_of(1e-9) - INLET_LEAST).abs() < 1e-15
        );
        assert_eq!(
            (part(100, 400, 0.0), part(100, 400, 0.5), part(100, 400, 1.0)),
            (100, 200, 400)
        );
    }

    #[test]
    fn profiles_are_fitted_to_a_new_inlet() {
        let lists =
            || (vec![-4.0, -2.0, 0.0, 1.0], vec![0.0, 0.3, 1.0, 0.0], vec![1.0, 2.0, 3.0, 4.0]);
        let (mut x, mut p, mut w) = lists();
        refit(&mut x, &mut p, &mut w, 8.0);
        assert_eq!(x, [-8.0, -4.0, -2.0, 0.0, 1.0]);
        assert_eq!((p[0], p[1], w[0], w[1]), (0.0, 0.0, 0.5, 1.0));
        let (mut x, mut p, mut w) = lists();
        refit(&mut x, &mut p, &mut w, 3.0);
        assert_eq!((x, p), (vec![-3.0, -2.0, 0.0, 1.0], vec![0.0, 0.3, 1.0, 0.0]));
        assert_eq!(w, [2.0, 2.0, 3.0, 4.0]);
        let (mut x, mut p, mut w) = lists();
        refit(&mut x, &mut p, &mut w, 2.0);
        assert_eq!((x, p, w.len()), (vec![-2.0, 0.0, 1.0], vec![0.0, 1.0, 0.0], 3));
    }
}
