//! Bands of drive speed and the cycles that bound them.

use hersey_core::drag::Drag;
use hersey_core::motion::Drivetrain;
use hersey_core::stability::{self, Band, Method, SlipLap};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::drag::{ClosureArguments, Law, closure_from};
use crate::ensemble::in_chunks;
use crate::value_error;

/// Belts that one thread takes at a time.
const CHUNK: usize = 64;

/// (lower, transition, upper, speed max, lower accuracy, upper accuracy, by half laps, deeper, laps)
type BandRow = (f64, f64, f64, f64, f64, f64, bool, bool, usize);

fn row_of(band: &Band) -> BandRow {
    (
        band.lower,
        band.transition,
        band.upper,
        band.speed_max,
        band.lower_accuracy,
        band.upper_accuracy,
        band.method == Method::HalfLaps,
        band.deeper,
        band.laps,
    )
}

/// The band of one belt, for any law.
#[pyfunction]
pub fn band(py: Python<'_>, train: (f64, f64), drag: &Law, tolerance: f64) -> PyResult<BandRow> {
    let belt = [(Drivetrain::new(train.0, train.1).map_err(value_error)?, drag.0.clone())];
    let found = py
        .detach(|| stability::bands(&belt, true, tolerance))
        .and_then(|mut bands| bands.remove(0))
        .map_err(value_error)?;
    Ok(row_of(&found))
}

/// (numbers of shape (9, sets), in the order of `BandRow`, and the message of each failure)
type Columns<'py> = (Bound<'py, PyArray2<f64>>, Vec<(usize, String)>);

/// The band of each parameter set: stiffness, mass, transition force, transition speed, EHL exponent, mixed
/// exponent and stick speed, each of the same length.
#[pyfunction]
#[allow(clippy::too_many_arguments)] // the Python layer names them all
pub fn bands<'py>(
    py: Python<'py>,
    parameters: [PyReadonlyArray1<'py, f64>; 7],
    closure: ClosureArguments<'_>,
    lower: bool,
    tolerance: f64,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Columns<'py>> {
    let columns: Vec<Vec<f64>> =
        parameters.iter().map(|column| column.as_array().iter().copied().collect()).collect();
    let closure = closure_from(closure)?;
    let belt = |i: usize| -> Result<(Drivetrain, Drag), hersey_core::Error> {
        let [k, m, force, speed, ehl, mixed, stick] = std::array::from_fn(|c| columns[c][i]);
        Ok((Drivetrain::new(k, m)?, Drag::new(force, speed, ehl, mixed, stick, closure)?))
    };
    let sets = columns[0].len();
    let belts = (0..sets)
        .map(|i| belt(i).map_err(|error| PyValueError::new_err(format!("set {i}: {error}"))))
        .collect::<PyResult<Vec<_>>>()?;
    let work = |belts: &[(Drivetrain, Drag)]| stability::bands(belts, lower, tolerance);
    let found = in_chunks(py, &belts, CHUNK, threads, progress, work)?;
    let numbers = PyArray2::<f64>::zeros(py, [9, sets], false);
    let mut failures = Vec::new();
    {
        let mut writable = numbers.readwrite();
        let mut rows = writable.as_array_mut();
        for (i, result) in found.iter().enumerate() {
            let row = match result {
                Ok(band) => columns_of(band),
                Err(error) => {
                    failures.push((i, error.to_string()));
                    let none = f64::NAN;
                    [none, none, none, none, none, none, 0.0, 0.0, 0.0]
                }
            };
            for (c, value) in row.into_iter().enumerate() {
                rows[[c, i]] = value;
            }
        }
    }
    Ok((numbers, failures))
}

#[allow(clippy::cast_precision_loss)] // laps are few
fn columns_of(band: &Band) -> [f64; 9] {
    let (lower, transition, upper, top, near, nearer, half, deeper, laps) = row_of(band);
    let flag = |on: bool| f64::from(u8::from(on));
    [lower, transition, upper, top, near, nearer, flag(half), flag(deeper), laps as f64]
}

/// (drive speed, greatest speed, laps), in transition speeds; not a number where a cycle is not found.
type Cycles<'py> =
    (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<u32>>);

/// Cycles without sticking, from the damping number, the slowest speed and the exponents of drag.
#[pyfunction]
pub fn cycles<'py>(
    py: Python<'py>,
    parameters: [PyReadonlyArray1<'py, f64>; 4],
    tolerance: f64,
) -> Cycles<'py> {
    let columns: Vec<Vec<f64>> =
        parameters.iter().map(|column| column.as_array().iter().copied().collect()).collect();
    let laps: Vec<SlipLap> = (0..columns[0].len())
        .map(|i| SlipLap {
            damping: columns[0][i],
            slowest: columns[1][i],
            mixed: columns[2][i],
            ehl: columns[3][i],
        })
        .collect();
    let found = py.detach(|| stability::cycles(&laps, tolerance));
    let number = |of: fn(&stability::Fold) -> f64| -> Vec<f64> {
        found.iter().map(|fold| fold.as_ref().map_or(f64::NAN, of)).collect()
    };
    let laps: Vec<u32> =
        found.iter().map(|f| f.map_or(0, |f| u32::try_from(f.laps).unwrap_or(u32::MAX))).collect();
    (
        number(|f| f.drive_speed).into_pyarray(py),
        number(|f| f.speed_max).into_pyarray(py),
        laps.into_pyarray(py),
    )
}
