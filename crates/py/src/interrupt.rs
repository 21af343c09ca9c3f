//! Core calls that Python may interrupt.
//!
//! The core asks now and then whether to stop. A call on the thread of Python looks for a signal itself, no more often
//! than `PATIENCE`; threads of its own look at a flag that the thread of Python sets.

use std::cell::{Cell, OnceCell};
use std::time::{Duration, Instant};

use hersey_core::Error;
use hersey_core::work::Work;
use pyo3::prelude::*;

use crate::errors::raised;

/// How often progress is told and an interrupt noticed.
pub const PATIENCE: Duration = Duration::from_millis(50);

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
                if let Err(raised) = Python::attach(Python::check_signals) {
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
