//! Series of a film that is made under its share of the load (`lubrication::mixed::power`).
//!
//! With `y` the share of the asperities, `c = 1 - y` that of the film and `w = dy/dlambda`,
//! `lambda'/lambda = n c/(c - b w lambda) X'/X`, `y' = w lambda'` and `w' = (5/2 y - lambda w) lambda'`, the last from the
//! equation of Greenwood and Tripp's integral.

use super::polynomial::{INVERSE, ORDER, Polynomial};
use super::recurrence::{product, series_from};
use crate::lubrication::mixed::{Sharing, asperity_integral, power_film};

/// The series, as far as they are known.
pub(super) struct PowerSeries {
    law: Sharing,
    share: Polynomial,
    /// Slope of the share in lambda.
    slope: Polynomial,
    /// Rate of lambda, and `slope lambda`.
    rate: Polynomial,
    steep: Polynomial,
}

impl PowerSeries {
    /// The series at a lambda and a scaled product, and the shares of asperities and film there.
    pub(super) fn starting(law: &Sharing, lambda: f64, x: f64) -> (Self, f64, f64) {
        let (integral, slope) = asperity_integral(lambda);
        let share = law.stiffness * integral;
        let series = Self {
            law: *law,
            share: series_from(share),
            slope: series_from(law.stiffness * slope),
            rate: [0.0; ORDER + 1],
            steep: [0.0; ORDER + 1],
        };
        (series, share, power_film(law, x.powf(law.film_exponent), lambda))
    }

    /// Find coefficient `n > 0` of lambda and film; `growth` is the rate of `X` over it, known up to `n - 1`.
    pub(super) fn advance(
        &mut self,
        n: usize,
        lambda: &mut Polynomial,
        film: &mut Polynomial,
        growth: &Polynomial,
    ) {
        let law = self.law;
        let j = n - 1;
        self.steep[j] = product(&self.slope, lambda, j);
        // (c - b w lambda) lambda' = n c lambda q'/q
        let driven: f64 = (0..=j).map(|i| product(film, lambda, i) * growth[j - i]).sum();
        let resisting = |i: usize| film[i] - law.load_exponent * self.steep[i];
        let known: f64 = (0..j).map(|i| self.rate[i] * resisting(j - i)).sum();
        self.rate[j] = (law.film_exponent * driven - known) / resisting(0);
        let curved = |i: usize| 2.5 * self.share[i] - self.steep[i];
        let bent: f64 = (0..=j).map(|i| curved(i) * self.rate[j - i]).sum();
        let per = INVERSE[n];
        let share = product(&self.slope, &self.rate, j) * per;
        lambda[n] = self.rate[j] * per;
        self.slope[n] = bent * per;
        (self.share[n], film[n]) = (share, -share);
    }
}
