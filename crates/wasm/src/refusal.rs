//! Why there is no answer, as JSON.

use std::fmt::Write;

use hersey_core::Error;
use hersey_core::wire::Unreadable;

/// Why there is no answer.
pub enum Refusal {
    /// The core says so.
    Core(Error),
    /// A value that the law needs is missing.
    Unreadable(Unreadable),
    /// The question is not one of those that the function takes; a fault of the page.
    Malformed(&'static str),
}

impl From<Error> for Refusal {
    fn from(error: Error) -> Self {
        Self::Core(error)
    }
}

impl From<Unreadable> for Refusal {
    fn from(error: Unreadable) -> Self {
        match error {
            Unreadable::Impossible(error) => Self::Core(error),
            other => Self::Unreadable(other),
        }
    }
}

impl Refusal {
    /// `message` and, of the core's, the fields that it has; numbers that are infinite or none are left out.
    pub fn json(&self) -> String {
        match self {
            Self::Malformed(what) => format!("{{\"message\":{}}}", quoted(what)),
            Self::Unreadable(why) => format!(
                "{{\"message\":{},\"quantity\":{}}}",
                quoted(&why.to_string()),
                quoted(why.field().unwrap_or_default())
            ),
            Self::Core(error) => of_core(error),
        }
    }
}

#[allow(clippy::cast_precision_loss)] // a number of steps, to be read
fn of_core(error: &Error) -> String {
    let mut text = format!("{{\"message\":{}", quoted(&error.to_string()));
    for (name, word) in [("quantity", error.quantity()), ("unit", error.unit())] {
        if let Some(word) = word {
            let _ = write!(text, ",\"{name}\":{}", quoted(word));
        }
    }
    let steps = error.steps().map(|steps| steps as f64);
    let numbers = [
        ("value", error.value()),
        ("limit", error.limit()),
        ("time", error.time()),
        ("steps", steps),
    ];
    for (name, number) in numbers {
        if let Some(number) = number.filter(|number| number.is_finite()) {
            let _ = write!(text, ",\"{name}\":{number:e}");
        }
    }
    let _ = write!(text, ",\"unfinished\":{}}}", error.is_unfinished());
    text
}

pub fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}
