//! Motion of a belt drawn through a spring by a drive (Eqs. 12-16, 24-30).
//!
//! | module       | responsibility                                                       |
//! |--------------|----------------------------------------------------------------------|
//! | `polynomial` | Taylor polynomials of fixed order; first root in an interval         |
//! | `taylor`     | one slip step as a Taylor series with its own dense output           |
//! | `hybrid`     | modes, guards and located events: the motion as a chain of pieces    |
//! | `trajectory` | the motion sampled at given times, with its event table              |
//! | `cycle`      | what the motion settles to: steady sliding, oscillation, stick-slip  |

mod cycle;
mod hybrid;
mod polynomial;
mod taylor;
mod trajectory;

pub use cycle::{CycleKind, StickSlipCycle, stick_slip};
pub use hybrid::{Event, Guard};
pub use trajectory::{Trajectory, simulate};

use crate::error::{Error, above, at_most, finite};

/// Spring and mass between the drive and the sliding contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drivetrain {
    stiffness: f64,
    mass: f64,
}

impl Drivetrain {
    /// A drivetrain of `stiffness` `k` and moving `mass` `m`.
    ///
    /// # Errors
    /// If either is not finite or not positive.
    pub fn new(stiffness: f64, mass: f64) -> Result<Self, Error> {
        Ok(Self { stiffness: above("stiffness", stiffness, 0.0)?, mass: above("mass", mass, 0.0)? })
    }

    /// Spring stiffness `k`.
    #[must_use]
    pub fn stiffness(&self) -> f64 {
        self.stiffness
    }

    /// Moving mass `m`.
    #[must_use]
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// Time scale `sqrt(m/k)` of the free oscillation.
    #[must_use]
    pub fn time_scale(&self) -> f64 {
        (self.mass / self.stiffness).sqrt()
    }
}

/// Where the motion starts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Start {
    /// Belt speed.
    pub belt_speed: f64,
    /// Spring stretch (drive position minus belt position).
    pub stretch: f64,
}

impl Start {
    /// Belt at rest and spring slack.
    pub const REST: Self = Self { belt_speed: 0.0, stretch: 0.0 };

    pub(crate) fn checked(self) -> Result<Self, Error> {
        finite("start belt_speed", self.belt_speed)?;
        finite("start stretch", self.stretch)?;
        Ok(self)
    }
}

/// Loosest and tightest relative tolerance that the Taylor steps are built for.
const TOLERANCE_RANGE: (f64, f64) = (1e-14, 1e-3);

fn checked_tolerance(tolerance: f64) -> Result<f64, Error> {
    above("tolerance", tolerance, TOLERANCE_RANGE.0 * 0.999)?;
    at_most("tolerance", tolerance, TOLERANCE_RANGE.1)
}
