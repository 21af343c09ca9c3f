//! The wire form: plain values by name, as Python, C, the page and the drive file of a unit hand them to the core.
//!
//! What can be chosen is a closed list of kinds, each with its word (`kinds!`). `drag::DragForm` is a whole drag in this
//! form, `lubrication::viscosity::ViscosityKind` the table of the laws of viscosity.

use std::fmt;

use crate::error::Error;

/// Declares a closed list of kinds with the word of each, in the order in which they are numbered.
macro_rules! kinds {
    ($(#[$doc:meta])* $name:ident of $field:literal { $($(#[$about:meta])* $case:ident = $word:literal),* $(,)? }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum $name { $($(#[$about])* $case),* }

        impl $name {
            /// All of them.
            pub const ALL: [Self; [$($word),*].len()] = [$(Self::$case),*];
            /// Their words.
            pub const WORDS: [&'static str; Self::ALL.len()] = [$($word),*];

            /// The word of this one.
            #[must_use]
            pub const fn word(self) -> &'static str {
                match self { $(Self::$case => $word),* }
            }

            /// The kind of a word.
            ///
            /// # Errors
            /// If there is none, with those that there are.
            pub fn of(word: &str) -> Result<Self, $crate::wire::Unreadable> {
                match word {
                    $($word => Ok(Self::$case),)*
                    _ => Err($crate::wire::unknown($field, word, &Self::WORDS)),
                }
            }
        }
    };
}
pub(crate) use kinds;

/// Values by name; none where a value is not given.
pub trait Values {
    /// A word that says which kind of something it is.
    fn word(&self, field: &str) -> Option<&str>;
    /// A number.
    fn number(&self, field: &str) -> Option<f64>;
    /// A list of numbers.
    fn numbers(&self, field: &str) -> Option<&[f64]>;
}

/// Why values make no object of the core.
#[derive(Debug, Clone, PartialEq)]
pub enum Unreadable {
    /// There is no such kind.
    Unknown {
        /// What is chosen.
        field: &'static str,
        /// The word that was given.
        word: String,
        /// The words that there are.
        known: Vec<&'static str>,
    },
    /// A value that a choice needs is not given.
    Missing {
        /// What is not given.
        field: &'static str,
        /// The field that needs it, and the word that it has; none if it is always needed.
        choice: Option<(&'static str, &'static str)>,
    },
    /// A list has too few numbers, or too many.
    Count {
        /// The list.
        field: &'static str,
        /// How many it has.
        found: usize,
        /// How many are needed.
        needed: usize,
    },
    /// All is given, but the physics cannot work with it.
    Impossible(Error),
}

/// The longest word that is repeated in a message.
const LONGEST: usize = 40;

/// The error of a word that is none of those known.
#[must_use]
pub fn unknown(field: &'static str, word: &str, known: &[&'static str]) -> Unreadable {
    Unreadable::Unknown { field, word: word.chars().take(LONGEST).collect(), known: known.to_vec() }
}

impl Unreadable {
    /// The field that is wrong.
    #[must_use]
    pub fn field(&self) -> Option<&'static str> {
        match self {
            Self::Unknown { field, .. }
            | Self::Missing { field, .. }
            | Self::Count { field, .. } => Some(field),
            Self::Impossible(error) => error.quantity(),
        }
    }
}

impl From<Error> for Unreadable {
    fn from(error: Error) -> Self {
        Self::Impossible(error)
    }
}

impl fmt::Display for Unreadable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown { field, word, known } => {
                write!(f, "{field} '{word}' is not known: {}", alternatives(known))
            }
            Self::Missing { field, choice: Some((choice, word)) } => {
                write!(f, "{choice} '{word}' needs {field}")
            }
            Self::Missing { field, choice: None } => write!(f, "{field} is missing"),
            Self::Count { field, found, needed } => {
                write!(f, "{field} has {found} numbers: {needed} are needed")
            }
            Self::Impossible(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for Unreadable {}

fn alternatives(words: &[&str]) -> String {
    match words {
        [first @ .., last] if !first.is_empty() => format!("{} or {last}", first.join(", ")),
        _ => words.concat(),
    }
}

/// The numbers of a list if there are as many as needed.
pub(crate) fn exactly<const N: usize>(
    field: &'static str,
    numbers: &[f64],
) -> Result<[f64; N], Unreadable> {
    let found = numbers.len();
    numbers.try_into().map_err(|_| Unreadable::Count { field, found, needed: N })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_wrong_is_named() {
        let unknown = unknown("closure", "glue", &["retained", "stiction", "lugre"]);
        assert_eq!(unknown.to_string(), "closure 'glue' is not known: retained, stiction or lugre");
        assert_eq!(unknown.field(), Some("closure"));
        let field = "bristle_damping";
        let missing = Unreadable::Missing { field, choice: Some(("closure", "lugre")) };
        assert_eq!(missing.to_string(), "closure 'lugre' needs bristle_damping");
        assert!(exactly::<2>("numbers", &[1.0, 2.0]).is_ok());
        let count = exactly::<2>("numbers", &[1.0]).unwrap_err();
        assert_eq!(count.to_string(), "numbers has 1 numbers: 2 are needed");
    }
}
