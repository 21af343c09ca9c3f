//! Series of a film whose inlet moves in as asperities press (`lubrication::mixed::inlet`).
//!
//! With `n = -d ln F/d ln lambda`, `N = dn/d ln lambda = n (1 + n - lambda^2) - 5/2 lambda^2`, the roundness k, `t = 1 - v`,
//! `root = k + 2 (1-k) v`, `u = k/root`, `z = v (k + (1-k) v)/root`, the weight w of asperities in the film and the
//! rate `r = lambda'/lambda`:
//!
//! `r [t + w/2 (n (u^2 t + z) + t N/(n+m))] = n_f t (1 - w/6) X'/X`, `n' = N r`, `t' = 2 n z r`,
//! `w' = 2 q (1-w) (r - n_f X'/X)`, and of the pressure P over the largest, `(1-P)' = n P r` and `c = (1-P)^(p_max/p_mean)`.

use super::polynomial::{INVERSE, ORDER, Polynomial};
use super::recurrence::{product, series_from};
use crate::lubrication::mixed::{Inlet, OFFSET, SHARPNESS, Sharing, peak};

/// Weight of asperities below which the film is alone, to the last digit.
const ALONE: f64 = 1e-25;

/// The series, as far as they are known.
pub(super) struct InletSeries {
    film_exponent: f64,
    roundness: f64,
    peak: f64,
    alone: bool,
    steepness: Polynomial,
    /// t: distance of the film's region from the edge of the dry one.
    inside: Polynomial,
    weight: Polynomial,
    pressure: Polynomial,
    room: Polynomial,
    /// `lambda^2`, N and `N/(n+m)`.
    square: Polynomial,
    turning: Polynomial,
    bent: Polynomial,
    /// v, u, `u^2`, z and `u^2 t + z`.
    outside: Polynomial,
    inverse: Polynomial,
    squared: Polynomial,
    falling: Polynomial,
    sloped: Polynomial,
    /// `n (u^2 t + z) + t N/(n+m)`, the bracket of the rate, `t (1 - w/6)` and the rate r.
    inner: Polynomial,
    resisting: Polynomial,
    driven: Polynomial,
    rate: Polynomial,
    /// `n r`, the rates of `1 - P` and of c.
    released: Polynomial,
    fallen: Polynomial,
    opening: Polynomial,
}

/// Coefficient `j` of `top/bottom`, of which those below are known.
fn quotient(top: f64, bottom: &Polynomial, quotient: &Polynomial, j: usize) -> f64 {
    let known: f64 = (0..j).map(|i| quotient[i] * bottom[j - i]).sum();
    (top - known) / bottom[0]
}

impl InletSeries {
    pub(super) fn starting(law: &Sharing, state: &Inlet, weight: f64) -> Self {
        let zero = [0.0; ORDER + 1];
        Self {
            film_exponent: law.film_exponent,
            roundness: law.roundness,
            peak: peak(law.roundness),
            alone: weight < ALONE,
            steepness: series_from(state.steepness),
            inside: series_from(state.inside),
            weight: series_from(weight),
            pressure: series_from(state.pressure),
            room: series_from(state.room),
            square: zero,
            turning: zero,
            bent: zero,
            outside: zero,
            inverse: zero,
            squared: zero,
            falling: zero,
            sloped: zero,
            inner: zero,
            resisting: zero,
            driven: zero,
            rate: zero,
            released: zero,
            fallen: zero,
            opening: zero,
        }
    }

    /// Find coefficient `n > 0` of lambda and film; `growth` is the rate of `X` over it, known up to `n - 1`.
    pub(super) fn advance(
        &mut self,
        n: usize,
        lambda: &mut Polynomial,
        film: &mut Polynomial,
        growth: &Polynomial,
    ) {
        let (j, per) = (n - 1, INVERSE[n]);
        if self.alone {
            self.rate[j] = self.film_exponent * growth[j];
            lambda[n] = product(&self.rate, lambda, j) * per;
            return;
        }
        self.find_rate(j, lambda, growth);
        lambda[n] = product(&self.rate, lambda, j) * per;
        self.steepness[n] = product(&self.turning, &self.rate, j) * per;
        self.released[j] = product(&self.steepness, &self.rate, j);
        self.inside[n] = 2.0 * product(&self.falling, &self.released, j) * per;
        let raised = |i: usize| self.rate[i] - self.film_exponent * growth[i];
        let left = |i: usize| if i == 0 { 1.0 - self.weight[0] } else { -self.weight[i] };
        let weighed: f64 = (0..=j).map(|i| left(i) * raised(j - i)).sum();
        self.weight[n] = 2.0 * SHARPNESS * weighed * per;
        self.fallen[j] = product(&self.released, &self.pressure, j);
        self.room[n] = self.fallen[j] * per;
        self.pressure[n] = -self.room[n];
        // c' (1-P) = peak c (1-P)'
        let opened = self.peak * product(film, &self.fallen, j);
        self.opening[j] = quotient(opened, &self.room, &self.opening, j);
        film[n] = self.opening[j] * per;
    }

    fn find_rate(&mut self, j: usize, lambda: &Polynomial, growth: &Polynomial) {
        let k = self.roundness;
        let at_start = |value: f64| if j == 0 { value } else { 0.0 };
        self.square[j] = product(lambda, lambda, j);
        let bend = |i: usize| {
            let whole = self.steepness[i] - self.square[i];
            if i == 0 { 1.0 + whole } else { whole }
        };
        let turned: f64 = (0..=j).map(|i| self.steepness[j - i] * bend(i)).sum();
        self.turning[j] = turned - 2.5 * self.square[j];
        let offset = {
            let mut offset = self.steepness;
            offset[0] += OFFSET;
            offset
        };
        self.bent[j] = quotient(self.turning[j], &offset, &self.bent, j);
        self.outside[j] = at_start(1.0) - self.inside[j];
        let squared = product(&self.outside, &self.outside, j);
        let pressed = k * self.outside[j] + (1.0 - k) * squared;
        let root: Polynomial = std::array::from_fn(|i| {
            2.0 * (1.0 - k) * self.outside[i] + if i == 0 { k } else { 0.0 }
        });
        self.inverse[j] = quotient(at_start(k), &root, &self.inverse, j);
        self.falling[j] = quotient(pressed, &root, &self.falling, j);
        self.squared[j] = product(&self.inverse, &self.inverse, j);
        self.sloped[j] = product(&self.squared, &self.inside, j) + self.falling[j];
        let inner =
            product(&self.steepness, &self.sloped, j) + product(&self.inside, &self.bent, j);
        self.inner[j] = inner;
        self.resisting[j] = self.inside[j] + 0.5 * product(&self.weight, &self.inner, j);
        self.driven[j] = self.inside[j] - product(&self.inside, &self.weight, j) / 6.0;
        let driven = self.film_exponent * product(&self.driven, growth, j);
        self.rate[j] = quotient(driven, &self.resisting, &self.rate, j);
    }
}
