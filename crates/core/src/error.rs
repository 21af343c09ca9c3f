//! The closed list of ways an input can be wrong.

use std::fmt;

/// A value that the physics cannot work with, or a motion that cannot be continued.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Error {
    /// The quantity is infinite or not a number.
    NotFinite {
        /// Name of the quantity, as the user knows it.
        quantity: &'static str,
        /// The offending value.
        value: f64,
    },
    /// The quantity must be greater than `limit`.
    TooSmall {
        /// Name of the quantity, as the user knows it.
        quantity: &'static str,
        /// The offending value.
        value: f64,
        /// What it must exceed.
        limit: f64,
    },
    /// The quantity must not be greater than `limit`.
    TooLarge {
        /// Name of the quantity, as the user knows it.
        quantity: &'static str,
        /// The offending value.
        value: f64,
        /// What it must not exceed.
        limit: f64,
    },
    /// The quantity must be less than `limit`.
    NotBelow {
        /// Name of the quantity, as the user knows it.
        quantity: &'static str,
        /// The offending value.
        value: f64,
        /// What it must stay below.
        limit: f64,
    },
    /// The quantity must fall somewhere before it rises, and does not.
    NotFalling {
        /// Name of the quantity, as the user knows it.
        quantity: &'static str,
    },
    /// There are too few values.
    TooFew {
        /// What there is too little of.
        quantity: &'static str,
        /// How many are needed.
        needed: usize,
    },
    /// A sequence that must ascend does not.
    Backwards {
        /// Name of the sequence.
        quantity: &'static str,
        /// Position of the value that is not greater than the one before.
        index: usize,
        /// That value.
        value: f64,
    },
    /// The motion takes more steps than are allowed.
    TooLong {
        /// Steps allowed.
        steps: u64,
        /// Model time reached.
        time: f64,
    },
    /// The work takes more steps than are allowed.
    WorkSpent {
        /// Steps allowed.
        steps: u64,
    },
    /// A numerical solution takes more steps than are allowed.
    GivenUp {
        /// Name of the quantity that was led to its value step by step.
        quantity: &'static str,
        /// The value that it had reached.
        value: f64,
        /// Steps allowed.
        steps: u64,
    },
    /// The caller does not wait for the end.
    Stopped,
    /// No step of the motion ends in a number.
    Stalled {
        /// Model time at which it happens.
        time: f64,
    },
    /// Events pile up at one instant.
    Chattering {
        /// The guard that keeps firing.
        guard: &'static str,
        /// Model time at which it happens.
        time: f64,
    },
    /// A numerical solution is out of reach.
    NotConverged {
        /// Name of the quantity that was led to its value step by step.
        quantity: &'static str,
        /// The value at which there is no way on.
        value: f64,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { quantity, value } => {
                write!(f, "{quantity} is {value}: a finite number is needed")
            }
            Self::TooSmall { quantity, value, limit } => {
                write!(f, "{quantity} is {value}: it must be greater than {limit}")
            }
            Self::TooLarge { quantity, value, limit } => {
                write!(f, "{quantity} is {value}: it must not exceed {limit}")
            }
            Self::NotBelow { quantity, value, limit } => {
                write!(f, "{quantity} is {value}: it must be less than {limit}")
            }
            Self::NotFalling { quantity } => {
                write!(f, "{quantity} rises at all speeds: without a transition nothing sticks")
            }
            Self::TooFew { quantity, needed } => {
                write!(f, "too few {quantity}: at least {needed} are needed")
            }
            Self::Backwards { quantity, index, value } => {
                write!(
                    f,
                    "{quantity} runs backwards: entry {index} is {value}, not above the one before"
                )
            }
            Self::TooLong { steps, time } => {
                write!(
                    f,
                    "after {steps} steps, all that are allowed, the motion has reached time {time:e} only: {MORE}"
                )
            }
            Self::WorkSpent { steps } => {
                write!(f, "no end after {steps} steps, all that are allowed: {MORE}")
            }
            Self::GivenUp { quantity, value, steps } => {
                write!(
                    f,
                    "after {steps} steps, all that are allowed, the solution has come to {quantity} {value:e} \
                     only: try a lighter load or a faster film"
                )
            }
            Self::Stopped => write!(f, "stopped before the end"),
            Self::Stalled { time } => {
                write!(f, "no step from time {time:e} on ends in a number: values too far apart")
            }
            Self::Chattering { guard, time } => {
                write!(f, "the motion switches without end at time {time:e} (guard: {guard})")
            }
            Self::NotConverged { quantity, value } => {
                write!(
                    f,
                    "no solution found beyond {quantity} {value:e}: try more nodes, a lighter load or a faster film"
                )
            }
        }
    }
}

/// The way out of a motion that is too long.
const MORE: &str = "values too far apart, or allow more by most_steps";

impl std::error::Error for Error {}

impl Error {
    /// The quantity that is out of range, or at which a solution was lost.
    #[must_use]
    pub fn quantity(&self) -> Option<&'static str> {
        match *self {
            Self::NotFinite { quantity, .. }
            | Self::TooSmall { quantity, .. }
            | Self::TooLarge { quantity, .. }
            | Self::NotBelow { quantity, .. }
            | Self::NotFalling { quantity }
            | Self::TooFew { quantity, .. }
            | Self::Backwards { quantity, .. }
            | Self::GivenUp { quantity, .. }
            | Self::NotConverged { quantity, .. } => Some(quantity),
            Self::TooLong { .. }
            | Self::WorkSpent { .. }
            | Self::Stopped
            | Self::Stalled { .. }
            | Self::Chattering { .. } => None,
        }
    }

    /// Its value.
    #[must_use]
    pub fn value(&self) -> Option<f64> {
        match *self {
            Self::NotFinite { value, .. }
            | Self::TooSmall { value, .. }
            | Self::TooLarge { value, .. }
            | Self::NotBelow { value, .. }
            | Self::Backwards { value, .. }
            | Self::GivenUp { value, .. }
            | Self::NotConverged { value, .. } => Some(value),
            Self::NotFalling { .. }
            | Self::TooFew { .. }
            | Self::TooLong { .. }
            | Self::WorkSpent { .. }
            | Self::Stopped
            | Self::Stalled { .. }
            | Self::Chattering { .. } => None,
        }
    }

    /// What the value must keep to; of too few values, how many are needed.
    #[must_use]
    #[allow(clippy::cast_precision_loss)] // a small number
    pub fn limit(&self) -> Option<f64> {
        match *self {
            Self::TooSmall { limit, .. }
            | Self::TooLarge { limit, .. }
            | Self::NotBelow { limit, .. } => Some(limit),
            Self::TooFew { needed, .. } => Some(needed as f64),
            _ => None,
        }
    }

    /// Model time that a motion had reached when it was given up.
    #[must_use]
    pub fn time(&self) -> Option<f64> {
        match *self {
            Self::TooLong { time, .. } | Self::Stalled { time } | Self::Chattering { time, .. } => {
                Some(time)
            }
            _ => None,
        }
    }

    /// Steps that were allowed, where they did not suffice.
    #[must_use]
    pub fn steps(&self) -> Option<u64> {
        match *self {
            Self::TooLong { steps, .. }
            | Self::WorkSpent { steps }
            | Self::GivenUp { steps, .. } => Some(steps),
            _ => None,
        }
    }

    /// Unit of the value, where the quantity has but one; a motion is in the units that it was given in.
    #[must_use]
    pub fn unit(&self) -> Option<&'static str> {
        let quantity = self.quantity()?;
        UNITS.iter().find(|(names, _)| names.contains(&quantity)).map(|(_, unit)| *unit)
    }

    /// Whether the input was sound and the computation did not come to its end.
    #[must_use]
    pub fn is_unfinished(&self) -> bool {
        matches!(
            self,
            Self::TooLong { .. }
                | Self::WorkSpent { .. }
                | Self::GivenUp { .. }
                | Self::Stopped
                | Self::Stalled { .. }
                | Self::Chattering { .. }
                | Self::NotConverged { .. }
        )
    }

    /// The same of a motion that has reached `time`.
    pub(crate) fn at_time(self, time: f64) -> Self {
        if let Self::WorkSpent { steps } = self { Self::TooLong { steps, time } } else { self }
    }
}

/// Units of the quantities of lubrication, by their names in the errors.
const UNITS: [(&[&str], &str); 11] = [
    (&["viscosity", "viscosity under pressure", "viscosity at the higher temperature"], "Pa*s"),
    (&["pressure-viscosity coefficient", "pressure_viscosity"], "1/Pa"),
    (&["kinematic viscosity in mm^2/s"], "mm^2/s"),
    (&["temperature of a viscosity", "temperature of a Vogel law"], "K"),
    (&["pressure", "modulus", "effective modulus", "effective_modulus"], "Pa"),
    (&["density"], "kg/m^3"),
    (&["relaxation time"], "s"),
    (&["entrainment speed", "entrainment_speed", "sliding speed", "sliding_speed"], "m/s"),
    (&["thermal conductivity"], "W/(m*K)"),
    (&["film thickness", "flooded film", "supplied layer", "rubber thickness"], "m"),
    (&["radius", "roll length", "radius along the motion", "radius across the motion"], "m"),
];

/// The results, each its own, unless the work on one was stopped.
pub(crate) fn unless_stopped<T>(
    results: impl Iterator<Item = Result<T, Error>>,
) -> Result<Vec<Result<T, Error>>, Error> {
    results
        .map(|result| match result {
            Err(Error::Stopped) => Err(Error::Stopped),
            other => Ok(other),
        })
        .collect()
}

/// `value` if it is finite.
pub(crate) fn finite(quantity: &'static str, value: f64) -> Result<f64, Error> {
    if value.is_finite() { Ok(value) } else { Err(Error::NotFinite { quantity, value }) }
}

/// `value` if it is finite and greater than `limit`.
pub(crate) fn above(quantity: &'static str, value: f64, limit: f64) -> Result<f64, Error> {
    if finite(quantity, value)? > limit {
        Ok(value)
    } else {
        Err(Error::TooSmall { quantity, value, limit })
    }
}

/// `value` if it is finite and at most `limit`.
pub(crate) fn at_most(quantity: &'static str, value: f64, limit: f64) -> Result<f64, Error> {
    if finite(quantity, value)? <= limit {
        Ok(value)
    } else {
        Err(Error::TooLarge { quantity, value, limit })
    }
}

/// `value` if it is finite and at least `limit`.
pub(crate) fn at_least(quantity: &'static str, value: f64, limit: f64) -> Result<f64, Error> {
    if finite(quantity, value)? >= limit {
        Ok(value)
    } else {
        Err(Error::TooSmall { quantity, value, limit })
    }
}

/// `value` if it is finite and less than `limit`.
pub(crate) fn below(quantity: &'static str, value: f64, limit: f64) -> Result<f64, Error> {
    if finite(quantity, value)? < limit {
        Ok(value)
    } else {
        Err(Error::NotBelow { quantity, value, limit })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_tells_its_fields() {
        let small = above("viscosity", -1.0, 0.0).unwrap_err();
        assert_eq!(small.quantity(), Some("viscosity"));
        assert_eq!((small.value(), small.limit()), (Some(-1.0), Some(0.0)));
        assert_eq!((small.unit(), small.time()), (Some("Pa*s"), None));
        assert!(!small.is_unfinished());
        let few = Error::TooFew { quantity: "points", needed: 2 };
        assert_eq!((few.value(), few.limit(), few.unit()), (None, Some(2.0), None));
        let long = Error::TooLong { steps: 9, time: 1.5 };
        assert_eq!((long.quantity(), long.time()), (None, Some(1.5)));
        let lost = Error::NotConverged { quantity: "entrainment_speed", value: 0.1 };
        assert_eq!((lost.unit(), lost.value()), (Some("m/s"), Some(0.1)));
        assert!(long.is_unfinished() && lost.is_unfinished() && Error::Stopped.is_unfinished());
        let spent = Error::WorkSpent { steps: 9 };
        assert_eq!((spent.at_time(1.5), small.at_time(1.5)), (long, small));
        let given_up = Error::GivenUp { quantity: "entrainment_speed", value: 0.1, steps: 9 };
        assert_eq!((given_up.unit(), given_up.value()), (Some("m/s"), Some(0.1)));
        let stalled = Error::Stalled { time: 1.5 };
        assert!(stalled.is_unfinished() && stalled.time() == Some(1.5));
        for error in [long, spent, given_up] {
            assert!(error.is_unfinished() && error.steps() == Some(9), "{error}");
            assert!(error.to_string().contains("9 steps"), "{error}");
        }
        assert!(Error::Chattering { guard: "reversal", time: 0.0 }.is_unfinished());
    }

    #[test]
    fn limits_belong_to_one_side() {
        assert!(above("x", 1.0, 1.0).is_err() && above("x", 1.1, 1.0).is_ok());
        assert!(below("x", 1.0, 1.0).is_err() && below("x", 0.9, 1.0).is_ok());
        assert!(at_least("x", 1.0, 1.0).is_ok() && at_least("x", 0.9, 1.0).is_err());
        assert!(at_most("x", 1.0, 1.0).is_ok() && at_most("x", 1.1, 1.0).is_err());
        assert!(at_most("x", f64::NEG_INFINITY, 1.0).is_err() && finite("x", f64::NAN).is_err());
    }
}
