//! A static force that grows while the belt stands.

/// How the force that breaks a belt at rest away grows with the time at rest, with its logarithm.
///
/// E. Rabinowicz, J. Appl. Phys. 22 (1951) 1373; J. H. Dieterich, J. Geophys. Res. 77 (1972) 3690:
/// `A (1 + growth ln(1 + t/time))`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Strengthening {
    /// Relative growth per e-fold of time.
    pub growth: f64,
    /// Time from which on it grows.
    pub time: f64,
}

impl Strengthening {
    /// Factor of the static force after `rest` at rest.
    pub(crate) fn at(&self, rest: f64) -> f64 {
        1.0 + self.growth * (rest / self.time).ln_1p()
    }
}
