//! Many motions in one call, on as many threads as asked for.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc;

use hersey_core::Error;
use hersey_core::drag::Closure;
use hersey_core::motion::{Belt, Drivetrain, Outcome, Span, Start, StickSlipCycle, ensemble};
use hersey_core::work::Work;
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;

use crate::drag::{ClosureArguments, CommonArguments, beside_from, closure_from, two_branches};
use crate::errors::{Failure, raised, raised_at};
use crate::interrupt::{PATIENCE, copied, interruptible};

/// Names behind the indices of kinds; the last is for motion that cannot be continued.
pub const KINDS: [&str; 7] =
    ["steady_sliding", "oscillation", "stick_slip", "unsettled", "stalled", "grip_slip", "failed"];

/// Index of motion that cannot be continued.
const FAILED: u8 = 6;

/// Belts that one thread takes at a time.
const CHUNK: usize = 512;

/// More threads than this are no use to anybody.
const MOST_THREADS: usize = 256;

/// What each parameter set settles to: arrays of one length, and the failures.
#[pyclass(frozen, get_all, module = "hersey._core")]
pub struct Sweep {
    kind_index: Py<PyArray1<u8>>,
    frequency: Py<PyArray1<f64>>,
    slip_duration: Py<PyArray1<f64>>,
    stick_duration: Py<PyArray1<f64>>,
    speed_min: Py<PyArray1<f64>>,
    speed_max: Py<PyArray1<f64>>,
    stretch_min: Py<PyArray1<f64>>,
    stretch_max: Py<PyArray1<f64>>,
    grip_slip_duration: Py<PyArray1<f64>>,
    drag_work: Py<PyArray1<f64>>,
    laps: Py<PyArray1<u32>>,
    failures: Vec<Py<Failure>>,
}

impl Sweep {
    fn new(py: Python<'_>, results: &[Outcome]) -> PyResult<Self> {
        let kind = |r: &Outcome| r.as_ref().map_or(FAILED, |c| c.kind as u8);
        let laps = |r: &Outcome| {
            r.as_ref().map_or(0, |cycle| u32::try_from(cycle.laps).unwrap_or(u32::MAX))
        };
        let column = |of: fn(&StickSlipCycle) -> f64| column(py, results, of);
        Ok(Self {
            kind_index: PyArray1::from_iter(py, results.iter().map(kind)).unbind(),
            frequency: column(|c| c.frequency),
            slip_duration: column(|c| c.slip_duration),
            stick_duration: column(|c| c.stick_duration),
            speed_min: column(|c| c.speed_min),
            speed_max: column(|c| c.speed_max),
            stretch_min: column(|c| c.stretch_min),
            stretch_max: column(|c| c.stretch_max),
            grip_slip_duration: column(|c| c.grip_slip_duration),
            drag_work: column(|c| c.drag_work),
            laps: PyArray1::from_iter(py, results.iter().map(laps)).unbind(),
            failures: failures(py, results)?,
        })
    }
}

/// One number of each result; not a number where there is none.
pub fn column<T>(
    py: Python<'_>,
    results: &[Result<T, Error>],
    of: fn(&T) -> f64,
) -> Py<PyArray1<f64>> {
    PyArray1::from_iter(py, results.iter().map(|r| r.as_ref().map_or(f64::NAN, of))).unbind()
}

/// The results that are errors.
pub fn failures<T>(py: Python<'_>, results: &[Result<T, Error>]) -> PyResult<Vec<Py<Failure>>> {
    let errors = results.iter().enumerate().filter_map(|(i, r)| Some((i, r.as_ref().err()?)));
    errors.map(|(i, error)| Py::new(py, Failure::new(py, i, error)?)).collect()
}

/// What each parameter set settles to.
///
/// `parameters` are stiffness, mass, transition force, transition speed, EHL exponent, mixed exponent, stick
/// speed and drive speed, each of the same length; `steady` starts each sliding, but for a nudge.
#[pyfunction]
#[allow(clippy::too_many_arguments)] // the Python layer names them all
pub fn sweep<'py>(
    py: Python<'py>,
    parameters: [PyReadonlyArray1<'py, f64>; 8],
    closure: ClosureArguments<'_>,
    beside: Option<[PyReadonlyArray1<'py, f64>; 3]>,
    grip: Option<f64>,
    steady: bool,
    duration: Option<f64>,
    tolerance: f64,
    threads: usize,
    progress: Option<Py<PyAny>>,
    most_steps: u64,
) -> PyResult<Sweep> {
    let columns: Vec<Vec<f64>> =
        parameters.iter().map(|column| copied(py, column)).collect::<PyResult<_>>()?;
    let sets = columns[0].len();
    let closure = closure_from(closure)?;
    let common = beside_from(py, beside)?;
    let belt = |i: usize| {
        let set = std::array::from_fn(|c| columns[c][i]);
        belt_of(set, closure, common(i), grip, steady).map_err(|error| (i, error))
    };
    let belts = each(py, sets, belt)?;
    let belts = belts.map_err(|(i, error)| match sets {
        1 => raised(error),
        _ => raised_at("set", i, error),
    })?;
    let span = duration.map_or(Span::UntilClosed, Span::Lasting);
    let follow = |belts: &[Belt], work: &Work| ensemble(belts, span, tolerance, work);
    let results = in_chunks(py, &belts, CHUNK, threads, progress, most_steps, follow)?;
    Sweep::new(py, &results)
}

/// What `make` makes of each of so many sets, or of the first that it refuses.
pub fn each<T: Send, E: Send>(
    py: Python<'_>,
    sets: usize,
    make: impl Fn(usize) -> Result<T, E> + Sync,
) -> PyResult<Result<Vec<T>, E>> {
    interruptible(py, u64::MAX, |work| (0..sets).map(|i| work.take(1).map(|()| make(i))).collect())
}

/// The belt of a parameter set, in the order of `sweep`.
fn belt_of(
    set: [f64; 8],
    closure: Closure,
    common: CommonArguments,
    grip: Option<f64>,
    steady: bool,
) -> Result<Belt, Error> {
    let [k, m, force, speed, ehl, mixed, stick, drive_speed] = set;
    let drag = two_branches([force, speed, ehl, mixed, stick], closure, common)?;
    let train = Drivetrain::new(k, m)?;
    let train = grip.map_or(Ok(train), |grip| train.with_grip(grip))?;
    let start =
        if steady { Start::steady(&train, &drag, drive_speed)?.nudged() } else { Start::REST };
    Ok(Belt { train, drag, drive_speed, start })
}

/// What `computation` makes of `items`, chunk by chunk, spread over `threads`; ends early when Python is interrupted.
///
/// Each chunk is told how many steps the work on one item may take.
pub fn in_chunks<T: Sync, R: Clone + Send>(
    py: Python<'_>,
    items: &[T],
    chunk: usize,
    threads: usize,
    progress: Option<Py<PyAny>>,
    most_steps: u64,
    computation: impl Fn(&[T], &Work) -> Result<Vec<R>, Error> + Sync,
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
            for _ in 0..threads.min(MOST_THREADS).clamp(1, chunks.len().max(1)) {
                let (send, next, cancelled, chunks) = (send.clone(), &next, &cancelled, &chunks);
                let computation = &computation;
                scope.spawn(move || {
                    let stop = || cancelled.load(Ordering::Relaxed);
                    while !cancelled.load(Ordering::Relaxed) {
                        let index = next.fetch_add(1, Ordering::Relaxed);
                        let Some(chunk) = chunks.get(index) else { break };
                        let results = computation(chunk, &Work::new(most_steps, &stop));
                        if send.send((index, results)).is_err() {
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
                            .map_err(raised)
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
