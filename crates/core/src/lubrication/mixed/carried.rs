//! Who carries what, by either law.

use super::{
    Inlet, Sharing,
    inlet::{self, Weight},
    power,
};

/// A contact at one product of viscosity and speed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Carried {
    /// ln of the film alone over roughness.
    pub free: f64,
    /// Film over roughness.
    pub lambda: f64,
    /// The least film over roughness, where a law of it is known.
    pub minimum: f64,
    /// Share of the load that asperities carry.
    pub share: f64,
    /// Share of the film, with its digits towards rest.
    pub film: f64,
    /// `-d share/d ln lambda`.
    pub fall: f64,
    /// `d ln lambda/d ln X`.
    pub growth: f64,
    /// `d ln lambda/d ln edge` at one product.
    pub by_edge: f64,
}

impl Carried {
    /// The contact at a scaled product.
    pub(super) fn at_product(law: &Sharing, dry: f64, x: f64) -> Self {
        if law.is_soft() {
            let free = inlet::alone(law, x);
            return Self::of_inlet(law, &Inlet::solved(law, dry, free), free);
        }
        let free = x.powf(law.film_exponent);
        let lambda = power::solved(law, dry, free);
        Self::of_power(law, lambda, power::film(law, free, lambda))
    }

    /// The contact at `lambda = dry (1 + exp(gap))`.
    pub(super) fn at_gap(law: &Sharing, dry: f64, gap: f64) -> Self {
        if law.is_soft() {
            let state = Inlet::at(law, dry, gap);
            return Self::of_inlet(law, &state, state.free());
        }
        let lambda = dry * (1.0 + gap.exp());
        Self::of_power(law, lambda, 1.0 - power::asperities(law, lambda).0)
    }

    /// The scaled product of viscosity and speed.
    pub(super) fn product(&self, law: &Sharing) -> f64 {
        (self.free / law.film_exponent).exp()
    }

    fn of_inlet(law: &Sharing, state: &Inlet, free: f64) -> Self {
        let Weight { weight, .. } = state.weight(free);
        let film = state.film(law);
        Self {
            free,
            lambda: state.lambda,
            minimum: state.minimum(law),
            share: state.share(law),
            film,
            fall: state.fall(law),
            growth: law.film_exponent * state.growth(law, weight),
            by_edge: state.by_edge(law, weight),
        }
    }

    fn of_power(law: &Sharing, lambda: f64, film: f64) -> Self {
        let (share, slope) = power::asperities(law, lambda);
        let fall = -slope * lambda;
        Self {
            free: lambda.ln() + law.load_exponent * film.ln(),
            lambda,
            minimum: f64::NAN,
            share,
            film,
            fall,
            growth: law.film_exponent * film / (film + law.load_exponent * fall),
            by_edge: 0.0,
        }
    }
}
