//! Core calls that Python may interrupt.
//!
//! The core asks now and then whether to stop. A call on the thread of Python looks for a signal itself, no more often
//! than `PATIENCE`; threads of its own look at a flag that the thread of Python sets.

use std::cell::{Cell, OnceCell};
use std::time::{Duration, Instant};

use hersey_core::Error;
use hersey_core::work::Work;
use numpy::ndarray::Dimension;
use numpy::{PyReadonlyArray, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::errors::raised;

/// How often progress is told and an interrupt noticed.
pub const PATIENCE: Duration = Duration::from_millis(50);

/// Numbers that are copied between two looks for a signal.
const AT_ONCE: usize = 1 << 18;

/// Look for a signal on a thread that has let go of the interpreter.
#[allow(clippy::redundant_closure_for_method_calls)] // the method is not general enough in its lifetime
fn signalled() -> PyResult<()> {
    Python::attach(|py| py.check_signals())
}

/// The numbers of an array in the order of its last axis; what a signal raises ends it.
pub fn copied<D: Dimension>(
    py: Python<'_>,
    array: &PyReadonlyArray<'_, f64, D>,
) -> PyResult<Vec<f64>> {
    let (view, mut numbers) = (array.as_array(), Vec::with_capacity(array.len()));
    let mut rest = view.iter();
    while numbers.len() < view.len() {
        py.check_signals()?;
        numbers.extend(rest.by_ref().take(AT_ONCE));
    }
    Ok(numbers)
}

/// What `computation` makes of so much work, without the interpreter's lock; what a signal raises ends it.
pub fn interruptible<R: Send>(
    py: Python<'_>,
    allowed: u64,
    computation: impl FnOnce(&Work) -> Result<R, Error> + Send,
) -> PyResult<R> {
    py.detach(|| {
        let (looked, interrupt) = (Cell::new(Instant::now()), OnceCell::new());
        let stop = || {
            if interrupt.get().is_none() && looked.get().elapsed() >= PATIENCE {
                looked.set(Instant::now());
                if let Err(raised) = signalled() {
                    // it is empty until here, and then no more
                    let _ = interrupt.set(raised);
                }
            }
            interrupt.get().is_some()
        };
        let result = computation(&Work::new(allowed, &stop));
        // a signal that came too late to stop the work is raised all the same
        interrupt.into_inner().map_or_else(|| result.map_err(raised), Err)
    })
}
