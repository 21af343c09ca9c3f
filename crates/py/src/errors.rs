//! Errors of the core as exceptions of `hersey.errors`, with their fields.

use hersey_core::Error;
use hersey_core::wire::Unreadable;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The exception of an error.
pub fn raised(error: Error) -> PyErr {
    Python::attach(|py| into_raised(exception(py, &error, None)))
}

/// The exception of the error of one of many sets or points; its message names which.
pub fn raised_at(what: &str, index: usize, error: Error) -> PyErr {
    Python::attach(|py| into_raised(exception(py, &error, Some((what, index)))))
}

/// The exception of an argument that is none of those known.
pub fn refused(quantity: &'static str, message: String) -> PyErr {
    Python::attach(|py| {
        let fields = PyDict::new(py);
        into_raised(fields.set_item("quantity", quantity).and_then(|()| {
            let class = py.import("hersey.errors")?.getattr("ParameterError")?;
            class.call((message,), Some(&fields))
        }))
    })
}

/// The exception of values that make no object of the core.
pub fn unreadable(why: Unreadable) -> PyErr {
    match why {
        Unreadable::Impossible(error) => raised(error),
        other => refused(other.field().unwrap_or_default(), other.to_string()),
    }
}

fn into_raised(built: PyResult<Bound<'_, PyAny>>) -> PyErr {
    built.map_or_else(|own| own, PyErr::from_value)
}

/// On which side of its limit a value must lie, as `ParameterError.bound` names it.
fn bound(error: &Error) -> Option<&'static str> {
    match error {
        Error::TooSmall { .. } => Some("above"),
        Error::TooLarge { .. } => Some("at most"),
        Error::NotBelow { .. } => Some("below"),
        _ => None,
    }
}

/// An exception, not yet raised.
pub fn exception<'py>(
    py: Python<'py>,
    error: &Error,
    place: Option<(&str, usize)>,
) -> PyResult<Bound<'py, PyAny>> {
    let name = if error.is_unfinished() { "UnfinishedError" } else { "ParameterError" };
    let fields = PyDict::new(py);
    fields.set_item("quantity", error.quantity())?;
    fields.set_item("value", error.value())?;
    fields.set_item("unit", error.unit())?;
    if error.is_unfinished() {
        fields.set_item("time", error.time())?;
        fields.set_item("steps", error.steps())?;
    } else {
        fields.set_item("limit", error.limit())?;
        fields.set_item("bound", bound(error))?;
    }
    let message = match place {
        None => error.to_string(),
        Some((what, index)) => {
            fields.set_item("index", index)?;
            format!("{what} {index}: {error}")
        }
    };
    py.import("hersey.errors")?.getattr(name)?.call((message,), Some(&fields))
}

/// Why one of many sets has no result.
#[pyclass(frozen, get_all, module = "hersey._core")]
pub struct Failure {
    /// Which set.
    index: usize,
    /// The exception that it would raise alone.
    error: Py<PyAny>,
}

impl Failure {
    pub fn new(py: Python<'_>, index: usize, error: &Error) -> PyResult<Self> {
        Ok(Self { index, error: exception(py, error, None)?.unbind() })
    }
}
