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
    /// The motion takes more steps than anybody would wait for.
    TooLong {
        /// Steps taken.
        steps: usize,
        /// Model time reached.
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
                    "after {steps} steps the motion has reached time {time:e} only: values too far apart"
                )
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

impl std::error::Error for Error {}

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
