//! Belts whose drag is a smooth curve: their folds and cycles, many at once.

use hersey_core::Error;
use hersey_core::drag::{Closure, Curve, Rest};
use hersey_core::motion::Drivetrain;
use hersey_core::stability::{self, CurveBelt, CurveCycle, CurveFold, CurveStart};
use hersey_core::work::Work;
use numpy::{PyArray1, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::ensemble::{column, each, failures, in_chunks};
use crate::errors::{Failure, raised_at, refused};
use crate::interrupt::copied;

/// Belts that one thread takes at a time.
const CHUNK: usize = 128;
/// Closures by their index.
const CLOSURES: [Closure; 3] = [Closure::Retained, Closure::Stiction, Closure::Stribeck];

/// Where many belts change their behaviour, as arrays; not a number where it failed.
#[pyclass(frozen, get_all, module = "hersey._core")]
pub struct CurveFolds {
    transition: Py<PyArray1<f64>>,
    upper: Py<PyArray1<f64>>,
    holding: Py<PyArray1<f64>>,
    stalls: Py<PyArray1<bool>>,
    failures: Vec<Py<Failure>>,
}

/// What becomes of many belts that are started, as arrays; of a cycle not a number where a belt ends sliding.
#[pyclass(frozen, get_all, module = "hersey._core")]
pub struct CurveStarts {
    first_peak: Py<PyArray1<f64>>,
    stalls: Py<PyArray1<bool>>,
    sticks: Py<PyArray1<bool>>,
    period: Py<PyArray1<f64>>,
    pull_max: Py<PyArray1<f64>>,
    pull_min: Py<PyArray1<f64>>,
    stuck: Py<PyArray1<f64>>,
    slope: Py<PyArray1<f64>>,
    failures: Vec<Py<Failure>>,
}

/// Curves of `ln F` over evenly spaced `ln v`, one a row, from the first on.
type Curves<'py> = (f64, f64, PyReadonlyArray2<'py, f64>);
/// Stiffness, mass, stick speed, static ratio, force and damping of the rest of the drive, index of the closure.
type Columns<'py> = [PyReadonlyArray1<'py, f64>; 7];

fn belts_of(
    py: Python<'_>,
    curves: &Curves<'_>,
    columns: &Columns<'_>,
    grip: Option<f64>,
) -> PyResult<Vec<CurveBelt>> {
    let (first, step, values) = curves;
    let values_of = copied(py, values)?;
    let points = values.shape()[1];
    let columns: Vec<Vec<f64>> =
        columns.iter().map(|column| copied(py, column)).collect::<PyResult<_>>()?;
    let sets = columns[0].len();
    if values.shape()[0] != sets || columns.iter().any(|column| column.len() != sets) {
        return Err(refused("curves", "curves and parameters differ in number".to_owned()));
    }
    let belt = |i: usize| -> Result<CurveBelt, Error> {
        let [k, m, stick_speed, static_ratio, force, damping, closure] =
            std::array::from_fn(|c| columns[c][i]);
        let train = Drivetrain::new(k, m)?;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // an index
        let closure = CLOSURES[(closure as usize).min(CLOSURES.len() - 1)];
        Ok(CurveBelt {
            train: grip.map_or(Ok(train), |grip| train.with_grip(grip))?,
            curve: Curve::new(*first, *step, &values_of[i * points..(i + 1) * points])?,
            stick_speed,
            closure,
            static_ratio,
            rest: Rest { force, damping },
        })
    };
    each(py, sets, |i| belt(i).map_err(|error| (i, error)))?
        .map_err(|(i, error)| raised_at("set", i, error))
}

/// The fold of each belt.
#[pyfunction]
#[allow(clippy::too_many_arguments)] // the Python layer names them all
pub fn curve_folds<'py>(
    py: Python<'py>,
    curves: Curves<'py>,
    columns: Columns<'py>,
    grip: Option<f64>,
    accuracy: f64,
    threads: usize,
    progress: Option<Py<PyAny>>,
    most_steps: u64,
) -> PyResult<CurveFolds> {
    let belts = belts_of(py, &curves, &columns, grip)?;
    let folds = |belts: &[CurveBelt], work: &Work| stability::curve_folds(belts, accuracy, work);
    let found = in_chunks(py, &belts, CHUNK, threads, progress, most_steps, folds)?;
    let number = |of: fn(&CurveFold) -> f64| column(py, &found, of);
    let stalls = found.iter().map(|f| f.as_ref().is_ok_and(|f| f.stalls));
    Ok(CurveFolds {
        transition: number(|f| f.transition),
        upper: number(|f| f.upper),
        holding: number(|f| f.holding),
        stalls: PyArray1::from_iter(py, stalls).unbind(),
        failures: failures(py, &found)?,
    })
}

/// What becomes of each belt, started from rest at its drive speed.
#[pyfunction]
#[allow(clippy::too_many_arguments)] // the Python layer names them all
pub fn curve_starts<'py>(
    py: Python<'py>,
    curves: Curves<'py>,
    columns: Columns<'py>,
    drive_speed: PyReadonlyArray1<'py, f64>,
    grip: Option<f64>,
    accuracy: f64,
    threads: usize,
    most_steps: u64,
) -> PyResult<CurveStarts> {
    let belts = belts_of(py, &curves, &columns, grip)?;
    let speeds = copied(py, &drive_speed)?;
    if speeds.len() != belts.len() {
        return Err(refused("drive_speed", "drive speeds and belts differ in number".to_owned()));
    }
    let pairs: Vec<(CurveBelt, f64)> = belts.into_iter().zip(speeds).collect();
    let starts =
        |pairs: &[(CurveBelt, f64)], work: &Work| stability::curve_starts(pairs, accuracy, work);
    let found = in_chunks(py, &pairs, CHUNK, threads, None, most_steps, starts)?;
    let of_cycle = |of: fn(&CurveCycle) -> f64| {
        let cycles = found.iter().map(|f| f.as_ref().ok().and_then(|f| f.cycle.as_ref()));
        PyArray1::from_iter(py, cycles.map(|c| c.map_or(f64::NAN, of))).unbind()
    };
    let flag = |of: fn(&CurveStart) -> bool| {
        PyArray1::from_iter(py, found.iter().map(|f| f.as_ref().is_ok_and(of))).unbind()
    };
    Ok(CurveStarts {
        first_peak: column(py, &found, |f| f.first_peak),
        stalls: flag(|f| f.stalls),
        sticks: flag(|f| f.cycle.is_some()),
        period: of_cycle(|c| c.period),
        pull_max: of_cycle(|c| c.pull_max),
        pull_min: of_cycle(|c| c.pull_min),
        stuck: of_cycle(|c| c.stuck),
        slope: of_cycle(|c| c.slope),
        failures: failures(py, &found)?,
    })
}

/// What a profile of drive speed does to many belts, as arrays.
#[pyclass(frozen, get_all, module = "hersey._core")]
pub struct CurveStartUps {
    slides: Py<PyArray1<bool>>,
    peak: Py<PyArray1<f64>>,
    released: Py<PyArray1<f64>>,
    failures: Vec<Py<Failure>>,
}

/// What a profile of drive speed, corners of time and speed, does to each belt.
#[pyfunction]
#[allow(clippy::too_many_arguments)] // the Python layer names them all
pub fn curve_start_ups<'py>(
    py: Python<'py>,
    curves: Curves<'py>,
    columns: Columns<'py>,
    profile: Vec<(f64, f64)>,
    grip: Option<f64>,
    accuracy: f64,
    threads: usize,
    most_steps: u64,
) -> PyResult<CurveStartUps> {
    let belts = belts_of(py, &curves, &columns, grip)?;
    let starts = |belts: &[CurveBelt], work: &Work| {
        stability::curve_start_ups(belts, &profile, accuracy, work)
    };
    let found = in_chunks(py, &belts, CHUNK, threads, None, most_steps, starts)?;
    let slides = found.iter().map(|f| f.as_ref().is_ok_and(|f| f.slides));
    Ok(CurveStartUps {
        slides: PyArray1::from_iter(py, slides).unbind(),
        peak: column(py, &found, |f| f.peak),
        released: column(py, &found, |f| f.released),
        failures: failures(py, &found)?,
    })
}
