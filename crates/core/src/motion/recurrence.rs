//! Power series of functions of a series, coefficient by coefficient: products, powers and exponentials.

use super::polynomial::{INVERSE, ORDER, POWERS, Polynomial};

/// How the drag term follows a series `q`: `n f_n = (weight sum i q_i f_{n-i} - back n sum q_i f_{n-i}) inverse`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Recurrence {
    pub(super) weight: f64,
    pub(super) back: f64,
    pub(super) inverse: f64,
}

impl Recurrence {
    /// `f` varies as `q^exponent`, from `q = speed` on.
    pub(crate) fn power(exponent: f64, speed: f64) -> Self {
        Self { weight: exponent + 1.0, back: 1.0, inverse: 1.0 / speed }
    }

    /// `f` varies as `exp(-q/scale)`.
    pub(crate) fn exponential(scale: f64) -> Self {
        Self { weight: -1.0, back: 0.0, inverse: 1.0 / scale }
    }
}

/// Coefficient `n` of the drag term along `q`, whose coefficients times their power are `rate`.
pub(super) fn drag_term(
    law: Recurrence,
    n: usize,
    q: &Polynomial,
    rate: &Polynomial,
    f: &Polynomial,
) -> f64 {
    let weighted: f64 = (1..=n).map(|i| rate[i] * f[n - i]).sum();
    let plain: f64 = (1..=n).map(|i| q[i] * f[n - i]).sum();
    (law.weight * weighted * INVERSE[n] - law.back * plain) * law.inverse
}

/// Coefficient `n` of the product of two series.
pub(super) fn product(a: &Polynomial, b: &Polynomial, n: usize) -> f64 {
    (0..=n).map(|i| a[i] * b[n - i]).sum()
}

/// Series of the function that `law` describes along `q`, from `first` on.
pub(super) fn composed(law: Recurrence, q: &Polynomial, first: f64) -> Polynomial {
    let mut f = [0.0; ORDER + 1];
    f[0] = first;
    let rate = std::array::from_fn(|n| POWERS[n] * q[n]);
    for n in 1..=ORDER {
        f[n] = drag_term(law, n, q, &rate, &f);
    }
    f
}

/// A series of which the first coefficient is known.
pub(super) fn series_from(first: f64) -> Polynomial {
    let mut c = [0.0; ORDER + 1];
    c[0] = first;
    c
}
