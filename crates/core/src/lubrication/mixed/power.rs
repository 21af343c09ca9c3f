//! Other contacts: the film is made under its share of the load, `lambda = lambda_free (1 - s)^(-b)`
//! (K. L. Johnson, J. A. Greenwood and S. Y. Poon, Wear 19 (1972) 91; E. R. M. Gelinck and D. J. Schipper,
//! Tribol. Int. 33 (2000) 175).
//!
//! With the share of the film `c = (lambda_free/lambda)^(1/b)` that is one equation, `stiffness F(lambda) +
//! c(lambda) = 1`. Both terms fall with lambda and are convex, so Newton's method from below climbs to the one root
//! without a bracket.

use super::Sharing;
use super::integral::asperity_integral;

/// Share of the asperities at a lambda, and its derivative.
pub(super) fn asperities(law: &Sharing, lambda: f64) -> (f64, f64) {
    let (integral, slope) = asperity_integral(lambda);
    (law.stiffness * integral, law.stiffness * slope)
}

/// Share of the film where the film alone is `free`; 1 less the other share would lose its digits towards rest.
pub(crate) fn film(law: &Sharing, free: f64, lambda: f64) -> f64 {
    (free / lambda).powf(1.0 / law.load_exponent)
}

/// The lambda at which both shares make the whole load.
pub(super) fn solved(law: &Sharing, dry: f64, free: f64) -> f64 {
    let mut lambda = free.max(dry);
    for _ in 0..80 {
        let (share, slope) = asperities(law, lambda);
        let film = film(law, free, lambda);
        let step = (share + film - 1.0) / (film / (law.load_exponent * lambda) - slope);
        lambda += step;
        if step <= 2.0 * f64::EPSILON * lambda {
            break;
        }
    }
    lambda
}
