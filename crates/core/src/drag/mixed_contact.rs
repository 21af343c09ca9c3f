//! A contact whose load film and asperities share, as a law of drag.

use crate::error::{Error, above};
use crate::lubrication::mixed::MixedLaw;

/// A contact whose load film and asperities share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MixedContact {
    pub law: MixedLaw,
    pub viscosity: f64,
}

impl MixedContact {
    /// Speed and force of the transition.
    pub(super) fn knot(&self) -> Result<(f64, f64), Error> {
        let transition = self.law.transition().ok_or(Error::NotFalling { quantity: "drag" })?;
        Ok((above("transition_speed", transition.product / self.viscosity, 0.0)?, transition.force))
    }

    /// Speed of the transition with `boundary` times the boundary friction; zero where there is none.
    #[inline(never)]
    pub(crate) fn transition_speed(&self, boundary: f64) -> f64 {
        self.law.transition_product(boundary).map_or(0.0, |product| product / self.viscosity)
    }

    #[inline(never)]
    pub(super) fn force(&self, u: f64) -> f64 {
        self.law.force(self.viscosity * u)
    }

    /// Force and slope at `u`, boundary friction being `boundary` times as large.
    #[inline(never)]
    pub(super) fn force_and_slope(&self, u: f64, boundary: f64) -> (f64, f64) {
        let (force, slope) =
            self.law.with_forces(1.0, boundary).force_and_slope(self.viscosity * u);
        (force, slope * self.viscosity)
    }
}
