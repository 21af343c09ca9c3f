//! Lubricated line contact solved numerically: Reynolds' equation, elastic surface and load together.
//!
//! | module         | responsibility                                                          |
//! |----------------|-------------------------------------------------------------------------|
//! | `fluid`        | viscosity and density against pressure                                  |
//! | `elasticity`   | deflection of a half space or a bonded layer under piecewise linear pressure |
//! | `contact`      | the roll, the surface and the lubricant                                 |
//! | `grid`         | nodes where pressure and film bend                                      |
//! | `dense`        | linear equations                                                        |
//! | `equations`    | the discrete equations and Newton's method                              |
//! | `continuation` | from the film of a rigid roll down to the speed asked for               |
//! | `outcome`      | film, friction and exponents of a solution                              |
//!
//! A rigid roll of radius R runs against an elastic surface: film = offset + x^2/(2R) + deflection. The speed u is the
//! mean of the two surface speeds, E* = E/(1 - nu^2) the modulus (E' = 2 E* in the film formulas). Surface 1 is the
//! roll, surface 2 what it runs against; x points the way the lubricant goes.

pub mod contact;
pub mod continuation;
pub mod dense;
pub mod elasticity;
pub mod equations;
pub mod fluid;
pub mod grid;
pub mod outcome;

pub use contact::LineContact;
pub use elasticity::Foundation;
pub use fluid::{Fluid, Thickening};
pub use outcome::{Exponents, LineSolution, Summary};

use crate::error::{Error, at_least, at_most};
use crate::work::Work;

/// Fewest nodes that give a film.
pub const LEAST_NODES: f64 = 50.0;
/// Most nodes: beyond, memory and patience end.
pub const MOST_NODES: f64 = 4001.0;

impl LineContact {
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
