//! Lubricated line contact solved numerically: Reynolds' equation, elastic surface and load together.
//!
//! | module         | responsibility                                                          |
//! |----------------|-------------------------------------------------------------------------|
//! | `fluid`        | viscosity and density against pressure                                  |
//! | `elasticity`   | deflection of a half space or a bonded layer under piecewise linear pressure |
//! | `grid`         | nodes where pressure and film bend                                      |
//! | `dense`        | linear equations                                                        |
//! | `equations`    | the discrete equations and Newton's method                              |
//! | `continuation` | from the film of a rigid roll down to the speed asked for               |
//! | `outcome`      | film, friction and exponents of a solution                              |
//!
//! A rigid roll of radius R runs against an elastic surface: film = offset + x^2/(2R) + deflection. The speed u is the
//! mean of the two surface speeds, E* = E/(1 - nu^2) the modulus (E' = 2 E* in the film formulas). Surface 1 is the
//! roll, surface 2 what it runs against; x points the way the lubricant goes.

pub mod continuation;
pub mod dense;
pub mod elasticity;
pub mod equations;
pub mod fluid;
pub mod grid;
pub mod outcome;

pub use elasticity::Foundation;
pub use fluid::{Fluid, Thickening};
pub use outcome::{Exponents, LineSolution, Summary};

use crate::error::{Error, above, at_least, at_most, finite};
use crate::work::Work;

/// Fewest nodes that give a film.
pub const LEAST_NODES: f64 = 50.0;
/// Most nodes: beyond, memory and patience end.
pub const MOST_NODES: f64 = 4001.0;

/// A roll on an elastic surface, flooded with lubricant, in steady motion; SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineContact {
    /// Radius of the roll, or reduced radius 1/(1/R1 + 1/R2), m.
    pub radius: f64,
    /// E* = 1/[(1-nu1^2)/E1 + (1-nu2^2)/E2], Pa; of a layer on its own, E/(1-nu^2).
    pub contact_modulus: f64,
    /// What gives way.
    pub foundation: Foundation,
    /// Load per length, N/m.
    pub load: f64,
    /// Mean of the surface speeds, m/s.
    pub entrainment_speed: f64,
    /// Speed of surface 1 less that of surface 2, m/s.
    pub sliding_speed: f64,
    /// The lubricant.
    pub fluid: Fluid,
}

impl LineContact {
    /// The contact if its numbers can be used.
    ///
    /// # Errors
    /// If a number is out of range, with its name.
    pub fn checked(self) -> Result<Self, Error> {
        above("radius", self.radius, 0.0)?;
        above("effective_modulus", 2.0 * self.contact_modulus, 0.0)?;
        above("load", self.load, 0.0)?;
        above("entrainment_speed", self.entrainment_speed, 0.0)?;
        finite("sliding_speed", self.sliding_speed)?;
        if let Foundation::Layer { thickness, poisson } = self.foundation {
            above("thickness", thickness, 0.0)?;
            above("poisson", poisson, -1.0)?;
            at_most("poisson", poisson, 0.5)?;
        }
        self.fluid.checked()?;
        Ok(self)
    }

    /// Pressure, film and friction on a grid of that many nodes.
    ///
    /// # Errors
    /// If a number is out of range, the equations cannot be solved, or `work` ends before: what it allows is for the
    /// way on the coarse grid, from which that on the fine one follows.
    pub fn solve(self, nodes: usize, work: &Work) -> Result<LineSolution, Error> {
        let contact = self.checked()?;
        #[allow(clippy::cast_precision_loss)] // a count for the message
        let count = nodes as f64;
        at_least("nodes", count, LEAST_NODES)?;
        at_most("nodes", count, MOST_NODES)?;
        let [coarse, fine] = continuation::follow(&contact, nodes - 1, work)?;
        outcome::outcome(&contact, &coarse, &fine, &work.apart(u64::MAX))
    }
}
