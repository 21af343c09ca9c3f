//! Many motions in one call, on as many threads as asked for.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc;
use std::time::Duration;

use hersey_core::drag::Drag;
use hersey_core::motion::{Belt, Drivetrain, Span, Start, StickSlipCycle, ensemble};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::drag::{ClosureArguments, closure_from};
use crate::value_error;

/// Names behind the indices of kinds; the last is for motion that cannot be continued.
pub const KINDS: [&str; 5] = ["steady_sliding", "oscillation", "stick_slip", "unsettled", "failed"];

/// Belts that one thread takes at a time.
const CHUNK: usize = 512;

/// How often progress is told and an interrupt noticed.
const PATIENCE: Duration = Duration::from_millis(50);

/// (kind index, numbers of shape (8, sets), laps, (index, message) of each failure)
type Columns<'py> = (
    Bound<'py, PyArray1<u8>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray1<u32>>,
    Vec<(usize, String)>,
);

/// What each parameter set settles to.
///
/// `parameters` are stiffness, mass, transition force, transition speed, EHL exponent, mixed exponent, stick
/// speed and drive speed, each of the same length.
#[pyfunction]
#[allow(clippy::too_many_arguments)] // the Python layer names them all
pub fn sweep<'py>(
    py: Python<'py>,
    parameters: [PyReadonlyArray1<'py, f64>; 8],
    closure: ClosureArguments<'_>,
    nudge: Option<f64>,
    duration: Option<f64>,
    tolerance: f64,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Columns<'py>> {
    let columns: Vec<Vec<f64>> =
        parameters.iter().map(|column| column.as_array().iter().copied().collect()).collect();
    let sets = columns[0].len();
    let closure = closure_from(closure)?;
    let belt = |i: usize| -> Result<Belt, hersey_core::Error> {
        let [k, m, force, speed, ehl, mixed, stick, drive] = std::array::from_fn(|c| columns[c][i]);
        let drag = Drag::new(force, speed, ehl, mixed, stick, closure)?;
        let start = nudge.map_or(Start::REST, |nudge| Start {
            belt_speed: drive * (1.0 + nudge),
            stretch: drag.force(drive) / k,
        });
        Ok(Belt { train: Drivetrain::new(k, m)?, drag, drive_speed: drive, start })
    };
    let belts = py.detach(|| {
        (0..sets).map(|i| belt(i).map_err(|error| (i, error))).collect::<Result<Vec<_>, _>>()
    });
    let belts = belts.map_err(|(i, error)| match sets {
        1 => value_error(error),
        _ => PyValueError::new_err(format!("set {i}: {error}")),
    })?;
    let span = duration.map_or(Span::UntilClosed, Span::Lasting);
    let follow = |belts: &[Belt]| ensemble(belts, span, tolerance);
    let results = in_chunks(py, &belts, CHUNK, threads, progress, follow)?;

    let kinds = PyArray1::<u8>::zeros(py, sets, false);
    let numbers = PyArray2::<f64>::zeros(py, [8, sets], false);
    let laps = PyArray1::<u32>::zeros(py, sets, false);
    let mut failures = Vec::new();
    {
        let (mut kinds, mut numbers, mut laps) =
            (kinds.readwrite(), numbers.readwrite(), laps.readwrite());
        let (mut kinds, mut numbers, mut laps) =
            (kinds.as_array_mut(), numbers.as_array_mut(), laps.as_array_mut());
        for (i, result) in results.into_iter().enumerate() {
            let row = match result {
                Ok(cycle) => {
                    kinds[i] = cycle.kind as u8;
                    laps[i] = u32::try_from(cycle.laps).unwrap_or(u32::MAX);
                    row_of(&cycle)
                }
                Err(error) => {
                    kinds[i] = 4;
                    failures.push((i, error.to_string()));
                    [f64::NAN; 8]
                }
            };
            for (c, value) in row.into_iter().enumerate() {
                numbers[[c, i]] = value;
            }
        }
    }
    Ok((kinds, numbers, laps, failures))
}

fn row_of(cycle: &StickSlipCycle) -> [f64; 8] {
    [
        cycle.frequency,
        cycle.slip_duration,
        cycle.stick_duration,
        cycle.speed_min,
        cycle.speed_max,
        cycle.stretch_min,
        cycle.stretch_max,
        cycle.drag_work,
    ]
}

/// What `work` makes of `items`, chunk by chunk, spread over `threads`; ends early when Python is interrupted.
pub fn in_chunks<T: Sync, R: Clone + Send>(
    py: Python<'_>,
    items: &[T],
    chunk: usize,
    threads: usize,
    progress: Option<Py<PyAny>>,
    work: impl Fn(&[T]) -> Result<Vec<R>, hersey_core::Error> + Sync,
) -> PyResult<Vec<R>> {
    let chunks: Vec<&[T]> = items.chunks(chunk).collect();
    let mut done: Vec<Vec<R>> = vec![Vec::new(); chunks.len()];
    let (next, cancelled) = (AtomicUsize::new(0), AtomicBool::new(false));
    let tell = |finished: usize| -> PyResult<()> {
        Python::attach(|py| {
            py.check_signals()?;
            progress
                .as_ref()
                .map_or(Ok(()), |call| call.call1(py, (finished, items.len())).map(drop))
        })
    };
    py.detach(|| {
        std::thread::scope(|scope| {
            let (send, receive) = mpsc::channel();
            for _ in 0..threads.clamp(1, chunks.len().max(1)) {
                let (send, next, cancelled, chunks) = (send.clone(), &next, &cancelled, &chunks);
                let work = &work;
                scope.spawn(move || {
                    while !cancelled.load(Ordering::Relaxed) {
                        let index = next.fetch_add(1, Ordering::Relaxed);
                        let Some(chunk) = chunks.get(index) else { break };
                        if send.send((index, work(chunk))).is_err() {
                            break;
                        }
                    }
                });
            }
            drop(send);
            let (mut finished, mut told) = (0, std::time::Instant::now());
            loop {
                match receive.recv_timeout(PATIENCE) {
                    Ok((index, results)) => {
                        let results = results
                            .map_err(value_error)
                            .inspect_err(|_| cancelled.store(true, Ordering::Relaxed))?;
                        finished += results.len();
                        done[index] = results;
                    }
                    Err(mpsc::RecvTimeoutError::Timeout) => {}
                    Err(mpsc::RecvTimeoutError::Disconnected) => break,
                }
                if told.elapsed() >= PATIENCE {
                    told = std::time::Instant::now();
                    tell(finished).inspect_err(|_| cancelled.store(true, Ordering::Relaxed))?;
                }
            }
            tell(finished)
        })
    })?;
    Ok(done.into_iter().flatten().collect())
}
