//! Bands of drive speed and the cycles that bound them.

use hersey_core::Error;
use hersey_core::drag::Drag;
use hersey_core::motion::Drivetrain;
use hersey_core::stability::{self, Method, Swing};
use hersey_core::work::{MOST_STEPS, Work};
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;

use crate::drag::{ClosureArguments, Law, beside_from, closure_from, two_branches};
use crate::ensemble::{column, each, failures, in_chunks};
use crate::errors::{Failure, raised_at};
use crate::interrupt::{copied, interruptible};
use crate::motion::{TrainArguments, drivetrain_from};

/// Belts that one thread takes at a time.
const CHUNK: usize = 64;

/// Edges of the behaviour over drive speed.
#[pyclass(frozen, get_all, module = "hersey._core")]
pub struct Band {
    lower: f64,
    transition: f64,
    upper: f64,
    stalls: bool,
    /// Not a number where the fold was found by simulation.
    speed_max: f64,
    lower_accuracy: f64,
    upper_accuracy: f64,
    half_laps: bool,
    deeper: bool,
    laps: usize,
}

/// The same of many belts, as arrays; not a number or zero where it failed.
#[pyclass(frozen, get_all, module = "hersey._core")]
pub struct Bands {
    lower: Py<PyArray1<f64>>,
    transition: Py<PyArray1<f64>>,
    upper: Py<PyArray1<f64>>,
    stalls: Py<PyArray1<bool>>,
    speed_max: Py<PyArray1<f64>>,
    lower_accuracy: Py<PyArray1<f64>>,
    upper_accuracy: Py<PyArray1<f64>>,
    half_laps: Py<PyArray1<bool>>,
    deeper: Py<PyArray1<bool>>,
    laps: Py<PyArray1<u32>>,
    failures: Vec<Py<Failure>>,
}

impl Bands {
    fn new(py: Python<'_>, found: &[Result<stability::Band, Error>]) -> PyResult<Self> {
        let number = |of: fn(&stability::Band) -> f64| column(py, found, of);
        let flag = |of: fn(&stability::Band) -> bool| {
            PyArray1::from_iter(py, found.iter().map(|r| r.as_ref().is_ok_and(of))).unbind()
        };
        let laps = found.iter().map(|r| r.as_ref().map_or(0, |b| few(b.laps)));
        Ok(Self {
            lower: number(|b| b.lower),
            transition: number(|b| b.transition),
            upper: number(|b| b.upper),
            stalls: flag(|b| b.stalls),
            speed_max: number(|b| b.speed_max),
            lower_accuracy: number(|b| b.lower_accuracy),
            upper_accuracy: number(|b| b.upper_accuracy),
            half_laps: flag(|b| b.method == Method::HalfLaps),
            deeper: flag(|b| b.deeper),
            laps: PyArray1::from_iter(py, laps).unbind(),
            failures: failures(py, found)?,
        })
    }
}

fn few(laps: usize) -> u32 {
    u32::try_from(laps).unwrap_or(u32::MAX)
}

/// The band of one belt, for any law; its lower edge is not a number unless it is asked for.
#[pyfunction]
pub fn band(
    py: Python<'_>,
    train: TrainArguments,
    drag: &Law,
    lower: bool,
    tolerance: f64,
    most_steps: u64,
) -> PyResult<Band> {
    let belt = [(drivetrain_from(train)?, drag.0.clone())];
    let found = interruptible(py, most_steps, |work| {
        stability::bands(&belt, lower, tolerance, work).and_then(|mut bands| bands.remove(0))
    })?;
    Ok(Band {
        lower: found.lower,
        transition: found.transition,
        upper: found.upper,
        stalls: found.stalls,
        speed_max: found.speed_max,
        lower_accuracy: found.lower_accuracy,
        upper_accuracy: found.upper_accuracy,
        half_laps: found.method == Method::HalfLaps,
        deeper: found.deeper,
        laps: found.laps,
    })
}

/// The band of each parameter set: stiffness, mass, transition force, transition speed, EHL exponent, mixed
/// exponent and stick speed, each of the same length.
#[pyfunction]
#[allow(clippy::too_many_arguments)] // the Python layer names them all
pub fn bands<'py>(
    py: Python<'py>,
    parameters: [PyReadonlyArray1<'py, f64>; 7],
    closure: ClosureArguments<'_>,
    beside: Option<[PyReadonlyArray1<'py, f64>; 3]>,
    grip: Option<f64>,
    lower: bool,
    tolerance: f64,
    threads: usize,
    progress: Option<Py<PyAny>>,
    most_steps: u64,
) -> PyResult<Bands> {
    let columns: Vec<Vec<f64>> =
        parameters.iter().map(|column| copied(py, column)).collect::<PyResult<_>>()?;
    let closure = closure_from(closure)?;
    let common = beside_from(py, beside)?;
    let belt = |i: usize| -> Result<(Drivetrain, Drag), Error> {
        let [k, m, force, speed, ehl, mixed, stick] = std::array::from_fn(|c| columns[c][i]);
        let drag = two_branches([force, speed, ehl, mixed, stick], closure, common(i))?;
        let train = Drivetrain::new(k, m)?;
        let train = grip.map_or(Ok(train), |grip| train.with_grip(grip))?;
        Ok((train, drag))
    };
    let belts = each(py, columns[0].len(), |i| belt(i).map_err(|error| (i, error)))?
        .map_err(|(i, error)| raised_at("set", i, error))?;
    let bands =
        |belts: &[(Drivetrain, Drag)], work: &Work| stability::bands(belts, lower, tolerance, work);
    let found = in_chunks(py, &belts, CHUNK, threads, progress, most_steps, bands)?;
    Bands::new(py, &found)
}

/// Laps that never stick, by their slowest speeds; not a number where there is none.
#[pyclass(frozen, get_all, module = "hersey._core")]
pub struct Swings {
    slowest: Py<PyArray1<f64>>,
    fastest: Py<PyArray1<f64>>,
    drive_speed: Py<PyArray1<f64>>,
    stable: Py<PyArray1<bool>>,
}

/// The swing of each slowest speed; none if the drag does not fall below the transition and rise above, or has
/// bristles.
#[pyfunction]
pub fn swings(
    py: Python<'_>,
    train: TrainArguments,
    drag: &Law,
    slowest: PyReadonlyArray1<'_, f64>,
    tolerance: f64,
) -> PyResult<Option<Swings>> {
    let train = drivetrain_from(train)?;
    let slowest = copied(py, &slowest)?;
    let found = interruptible(py, MOST_STEPS, |work| {
        stability::swings(&train, &drag.0, &slowest, tolerance, work)
    })?;
    let swings = |found: Vec<Swing>| {
        let number = |of: fn(&Swing) -> f64| PyArray1::from_iter(py, found.iter().map(of)).unbind();
        Swings {
            slowest: number(|s| s.slowest),
            fastest: number(|s| s.fastest),
            drive_speed: number(|s| s.drive_speed),
            stable: PyArray1::from_iter(py, found.iter().map(|s| s.stable)).unbind(),
        }
    };
    Ok(found.map(swings))
}
