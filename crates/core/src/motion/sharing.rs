//! Series of the force of a contact whose load film and asperities share (`lubrication::mixed`).
//!
//! Along the speed all of it obeys differential equations: with `X` the scaled product of viscosity and speed,
//! `y` the share of the asperities, `c = 1 - y` that of the film and `w = dy/dlambda`,
//! `lambda'/lambda = n c/(c - b w lambda) X'/X`, `y' = w lambda'` and `w' = (5/2 y - lambda w) lambda'`, the last from the
//! equation of Greenwood and Tripp's integral. So a step costs the integral once.

use super::polynomial::{INVERSE, ORDER, POWERS, Polynomial};
use super::taylor::product;
use crate::drag::MixedContact;
use crate::lubrication::mixed::{Sharing, asperity_integral};

/// The contact at the start of a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct SharingStart<'a> {
    contact: &'a MixedContact,
    lambda: f64,
}

impl<'a> SharingStart<'a> {
    /// The contact at a speed of the law.
    #[inline(never)]
    pub(super) fn at(contact: &'a MixedContact, speed: f64) -> Self {
        Self { contact, lambda: contact.law.lambda(contact.viscosity * speed) }
    }
}

/// The series, as far as they are known.
pub(super) struct SharingSeries {
    law: Sharing,
    /// `X` per speed of the law.
    per_speed: f64,
    lambda: Polynomial,
    share: Polynomial,
    film: Polynomial,
    /// Slope of the share in lambda.
    slope: Polynomial,
    /// Rate of lambda, and `slope lambda`.
    rate: Polynomial,
    steep: Polynomial,
    /// Rate of the speed over the speed.
    growth: Polynomial,
    /// Speed over lambda, and the power of `X` of the rolling part.
    thinness: Polynomial,
    rolled: Polynomial,
}

impl SharingSeries {
    pub(super) fn starting(start: SharingStart, speed: f64) -> Self {
        let SharingStart { contact, lambda } = start;
        let law = contact.law.sharing();
        let per_speed = contact.viscosity / law.reference;
        let (integral, slope) = asperity_integral(lambda);
        let of = |first: f64| {
            let mut c = [0.0; ORDER + 1];
            c[0] = first;
            c
        };
        let x = per_speed * speed;
        // from the film's side, as 1 - share would lose its digits towards rest
        let film = (x.powf(law.film_exponent) / lambda).powf(1.0 / law.load_exponent);
        let zero = [0.0; ORDER + 1];
        Self {
            law,
            per_speed,
            lambda: of(lambda),
            share: of(law.stiffness * integral),
            film: of(film),
            slope: of(law.stiffness * slope),
            rate: zero,
            steep: zero,
            growth: zero,
            thinness: of(speed / lambda),
            rolled: of(x.powf(law.rolling_exponent)),
        }
    }

    /// Coefficient `n > 0` of the force along the speed `q`, known up to there; `boundary` is the factor of boundary
    /// friction.
    pub(super) fn force(&mut self, n: usize, q: &Polynomial, boundary: &Polynomial) -> f64 {
        let law = self.law;
        let j = n - 1;
        let rest: f64 = (0..j).map(|i| self.growth[i] * q[j - i]).sum();
        self.growth[j] = (POWERS[n] * q[n] - rest) / q[0];
        self.steep[j] = product(&self.slope, &self.lambda, j);
        // (c - b w lambda) lambda' = n c lambda q'/q
        let driven: f64 =
            (0..=j).map(|i| product(&self.film, &self.lambda, i) * self.growth[j - i]).sum();
        let resisting = |i: usize| self.film[i] - law.load_exponent * self.steep[i];
        let known: f64 = (0..j).map(|i| self.rate[i] * resisting(j - i)).sum();
        self.rate[j] = (law.film_exponent * driven - known) / resisting(0);
        let curved = |i: usize| 2.5 * self.share[i] - self.steep[i];
        let bent: f64 = (0..=j).map(|i| curved(i) * self.rate[j - i]).sum();
        let per = INVERSE[n];
        let share = product(&self.slope, &self.rate, j) * per;
        self.lambda[n] = self.rate[j] * per;
        self.slope[n] = bent * per;
        (self.share[n], self.film[n]) = (share, -share);
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
