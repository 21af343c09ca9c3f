//! What the drag does below the stick speed: the choices, each with its source.

use crate::error::{Error, above, at_least};
use crate::wire::{Unreadable, kinds};

/// Width of the smoothed reversal of `Stribeck`, in stick speeds.
pub(crate) const SMOOTHING: f64 = 0.05;

/// What the belt does near zero speed, where nobody has measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Closure {
    /// The paper's rule (Eqs. 24-27): below the stick speed drag is `A exp(-|v|/v_s)`, and while the
    /// spring cannot overcome it the belt keeps its small speed.
    Retained,
    /// The belt stops dead at the stick speed and is released at `A`. D. Karnopp, "Computer simulation of
    /// stick-slip friction in mechanical dynamic systems", J. Dyn. Syst. Meas. Control 107 (1985).
    Stiction,
    /// Smooth: `A exp(-|v|/v_s) tanh(v/(0.05 v_s))`; the belt never rests, it creeps.
    Stribeck,
    /// Bristles that bend before they slip. C. Canudas de Wit, H. Olsson, K. J. Astrom, P. Lischinsky,
    /// "A new model for control of systems with friction", IEEE Trans. Autom. Control 40 (1995).
    LuGre {
        /// Force per bristle deflection.
        bristle_stiffness: f64,
        /// Force per rate of deflection, fading with speed as `exp(-(v/v_s)^2)`.
        bristle_damping: f64,
    },
}

kinds! {
    /// The closures by their words.
    ClosureKind of "closure" {
        /// As of `Closure`, here and below.
        Retained = "retained",
        /// Stops dead.
        Stiction = "stiction",
        /// Smooth.
        Stribeck = "stribeck",
        /// Bristles.
        LuGre = "lugre",
    }
}

impl Closure {
    /// The closure of a kind, with the stiffness and the damping of the bristles where it has some.
    ///
    /// # Errors
    /// If a number that it needs is not given.
    pub fn of(
        kind: ClosureKind,
        (stiffness, damping): (Option<f64>, Option<f64>),
    ) -> Result<Self, Unreadable> {
        let needed = |field, number: Option<f64>| {
            let choice = Some(("closure", kind.word()));
            number.ok_or(Unreadable::Missing { field, choice })
        };
        Ok(match kind {
            ClosureKind::Retained => Self::Retained,
            ClosureKind::Stiction => Self::Stiction,
            ClosureKind::Stribeck => Self::Stribeck,
            ClosureKind::LuGre => Self::LuGre {
                bristle_stiffness: needed("bristle_stiffness", stiffness)?,
                bristle_damping: needed("bristle_damping", damping)?,
            },
        })
    }

    /// Its kind.
    #[must_use]
    pub fn kind(self) -> ClosureKind {
        match self {
            Self::Retained => ClosureKind::Retained,
            Self::Stiction => ClosureKind::Stiction,
            Self::Stribeck => ClosureKind::Stribeck,
            Self::LuGre { .. } => ClosureKind::LuGre,
        }
    }

    pub(super) fn check(self) -> Result<(), Error> {
        if let Self::LuGre { bristle_stiffness, bristle_damping } = self {
            above("bristle_stiffness", bristle_stiffness, 0.0)?;
            at_least("bristle_damping", bristle_damping, 0.0)?;
        }
        Ok(())
    }

    /// Whether the force is a smooth function through zero speed, so that the belt is never held.
    #[must_use]
    pub fn is_smooth(self) -> bool {
        matches!(self, Self::Stribeck | Self::LuGre { .. })
    }

    /// Whether the force depends on more than the speed and the pull.
    #[must_use]
    pub fn has_memory(self) -> bool {
        matches!(self, Self::LuGre { .. })
    }

    /// Share of the drag that acts at `x` stick speeds, below one.
    pub(crate) fn share(self, x: f64) -> f64 {
        self.smoothed(x).0
    }

    /// Share of the drag that acts at `x` stick speeds, below one, and its slope in `x`.
    pub(super) fn smoothed(self, x: f64) -> (f64, f64) {
        match self {
            Self::Stribeck => {
                let t = (x / SMOOTHING).tanh();
                (t, (1.0 - t * t) / SMOOTHING)
            }
            _ => (1.0, 0.0),
        }
    }
}
