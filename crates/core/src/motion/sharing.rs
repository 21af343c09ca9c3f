//! Series of the force of a contact whose load film and asperities share (`lubrication::mixed`).
//!
//! Along the speed all of it obeys differential equations: with `X` the scaled product of viscosity and speed and c the
//! share of the film, `shared_by_inlet` and `shared_by_power` advance lambda and c, by the two laws of the film. So a
//! step costs the integral of Greenwood and Tripp as often as one solution of the law.

use super::polynomial::{INVERSE, ORDER, POWERS, Polynomial};
use super::recurrence::{product, series_from};
use super::shared_by_inlet::InletSeries;
use super::shared_by_power::PowerSeries;
use crate::drag::MixedContact;
use crate::lubrication::mixed::{Inlet, Sharing};

/// The contact at the start of a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct SharingStart<'a> {
    contact: &'a MixedContact,
    film: FilmStart,
}

#[derive(Debug, Clone, Copy)]
enum FilmStart {
    Inlet { state: Inlet, weight: f64 },
    Power { lambda: f64 },
}

impl<'a> SharingStart<'a> {
    /// The contact at a speed of the law.
    #[inline(never)]
    pub(super) fn at(contact: &'a MixedContact, speed: f64) -> Self {
        let product = contact.viscosity * speed;
        let film = if contact.law.sharing().is_soft() {
            let (state, weight) = contact.law.inlet(product);
            FilmStart::Inlet { state, weight }
        } else {
            FilmStart::Power { lambda: contact.law.lambda(product) }
        };
        Self { contact, film }
    }
}

#[allow(clippy::large_enum_variant)] // one of them lives on the stack of a step
enum FilmSeries {
    Inlet(InletSeries),
    Power(PowerSeries),
}

/// The series, as far as they are known.
pub(super) struct SharingSeries {
    law: Sharing,
    /// `X` per speed of the law.
    per_speed: f64,
    lambda: Polynomial,
    /// Share of the film.
    film: Polynomial,
    by: FilmSeries,
    share: Polynomial,
    /// Rate of the speed over the speed.
    growth: Polynomial,
    /// Speed over lambda, and the power of `X` of the rolling part.
    thinness: Polynomial,
    rolled: Polynomial,
}

impl SharingSeries {
    pub(super) fn starting(start: SharingStart, speed: f64) -> Self {
        let SharingStart { contact, film } = start;
        let law = contact.law.sharing();
        let per_speed = contact.viscosity / law.reference;
        let x = per_speed * speed;
        let (lambda, share, film, by) = match film {
            FilmStart::Inlet { state, weight } => {
                let by = InletSeries::starting(&law, &state, weight);
                (state.lambda, state.share(&law), state.film(&law), FilmSeries::Inlet(by))
            }
            FilmStart::Power { lambda } => {
                let (by, share, film) = PowerSeries::starting(&law, lambda, x);
                (lambda, share, film, FilmSeries::Power(by))
            }
        };
        Self {
            law,
            per_speed,
            lambda: series_from(lambda),
            film: series_from(film),
            by,
            share: series_from(share),
            growth: [0.0; ORDER + 1],
            thinness: series_from(speed / lambda),
            rolled: series_from(x.powf(law.rolling_exponent)),
        }
    }

    /// Coefficient `n > 0` of the force along the speed `q`, known up to there; `boundary` is the factor of boundary
    /// friction.
    pub(super) fn force(&mut self, n: usize, q: &Polynomial, boundary: &Polynomial) -> f64 {
        let law = self.law;
        let j = n - 1;
        let rest: f64 = (0..j).map(|i| self.growth[i] * q[j - i]).sum();
        self.growth[j] = (POWERS[n] * q[n] - rest) / q[0];
        let (lambda, film, growth) = (&mut self.lambda, &mut self.film, &self.growth);
        match &mut self.by {
            FilmSeries::Inlet(by) => by.advance(n, lambda, film, growth),
            FilmSeries::Power(by) => by.advance(n, lambda, film, growth),
        }
        self.share[n] = -self.film[n];
        let thin: f64 = (0..n).map(|i| self.thinness[i] * self.lambda[n - i]).sum();
        self.thinness[n] = (q[n] - thin) / self.lambda[0];
        let shear = law.shear * self.per_speed * self.thinness[n];
        law.boundary * product(&self.share, boundary, n) + shear + self.rolling(n)
    }

    fn rolling(&mut self, n: usize) -> f64 {
        let law = self.law;
        if law.rolling == 0.0 {
            return 0.0;
        }
        // r' = exponent r q'/q
        self.rolled[n] =
            law.rolling_exponent * product(&self.rolled, &self.growth, n - 1) * INVERSE[n];
        law.rolling * product(&self.rolled, &self.film, n)
    }
}
