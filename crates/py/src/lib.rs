//! `hersey._core`: conversion between Python and `hersey-core`, and nothing else.

use hersey_core::drag::{Closure, Drag, Mode};
use hersey_core::motion::{self, CycleKind, Drivetrain, Start};
use numpy::{IntoPyArray, PyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Drag parameters in the order of `Drag::new`, closure by name.
type DragArguments<'a> = (f64, f64, f64, f64, f64, &'a str);
/// (time, from, to, guard, stretch, belt speed)
type EventRow = (f64, &'static str, &'static str, &'static str, f64, f64);
/// (time, belt speed, stretch, mode index, events)
type TrajectoryColumns<'py> = (
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<u8>>,
    Vec<EventRow>,
);
/// (kind, frequency, slip duration, stick duration, speed min, max, stretch min, max, laps)
type CycleRow = (&'static str, f64, f64, f64, f64, f64, f64, f64, usize);

fn mode_name(mode: Mode) -> &'static str {
    match mode {
        Mode::Ehl => "ehl",
        Mode::Mixed => "mixed",
        Mode::Microslip => "microslip",
        Mode::Stuck => "stuck",
    }
}

fn value_error(error: hersey_core::Error) -> PyErr {
    PyValueError::new_err(error.to_string())
}

fn drag_from((force, speed, ehl, mixed, stick, closure): DragArguments) -> PyResult<Drag> {
    let closure = match closure {
        "retained" => Closure::Retained,
        other => return Err(PyValueError::new_err(format!("unknown closure '{other}'"))),
    };
    Drag::new(force, speed, ehl, mixed, stick, closure).map_err(value_error)
}

/// Drag force at each speed.
#[pyfunction]
fn drag_force<'py>(
    py: Python<'py>,
    drag: DragArguments<'_>,
    speed: Vec<f64>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let drag = drag_from(drag)?;
    Ok(speed.into_iter().map(|v| drag.force(v)).collect::<Vec<_>>().into_pyarray(py))
}

/// Drag that a belt at rest can bear.
#[pyfunction]
fn breakaway_force(drag: DragArguments<'_>) -> PyResult<f64> {
    Ok(drag_from(drag)?.breakaway_force())
}

/// Motion at equally spaced times.
#[pyfunction]
#[allow(clippy::too_many_arguments)] // the Python layer names them all
fn simulate<'py>(
    py: Python<'py>,
    train: (f64, f64),
    drag: DragArguments<'_>,
    drive_speed: f64,
    start: (f64, f64),
    duration: f64,
    samples: usize,
    tolerance: f64,
) -> PyResult<TrajectoryColumns<'py>> {
    let train = Drivetrain::new(train.0, train.1).map_err(value_error)?;
    let drag = drag_from(drag)?;
    let start = Start { belt_speed: start.0, stretch: start.1 };
    let run = py
        .detach(|| {
            motion::simulate(&train, &drag, drive_speed, start, duration, samples, tolerance)
        })
        .map_err(value_error)?;
    let modes: Vec<u8> = run.mode.iter().map(|m| *m as u8).collect();
    let events = run
        .events
        .iter()
        .map(|e| {
            (e.time, mode_name(e.from), mode_name(e.to), e.guard.name(), e.stretch, e.belt_speed)
        })
        .collect();
    Ok((
        run.time.into_pyarray(py),
        run.belt_speed.into_pyarray(py),
        run.stretch.into_pyarray(py),
        modes.into_pyarray(py),
        events,
    ))
}

/// What the motion settles to.
#[pyfunction]
fn stick_slip(
    py: Python<'_>,
    train: (f64, f64),
    drag: DragArguments<'_>,
    drive_speed: f64,
    start: (f64, f64),
    tolerance: f64,
) -> PyResult<CycleRow> {
    let train = Drivetrain::new(train.0, train.1).map_err(value_error)?;
    let drag = drag_from(drag)?;
    let start = Start { belt_speed: start.0, stretch: start.1 };
    let cycle = py
        .detach(|| motion::stick_slip(&train, &drag, drive_speed, start, tolerance))
        .map_err(value_error)?;
    let kind = match cycle.kind {
        CycleKind::SteadySliding => "steady_sliding",
        CycleKind::Oscillation => "oscillation",
        CycleKind::StickSlip => "stick_slip",
        CycleKind::Unsettled => "unsettled",
    };
    Ok((
        kind,
        cycle.frequency,
        cycle.slip_duration,
        cycle.stick_duration,
        cycle.speed_min,
        cycle.speed_max,
        cycle.stretch_min,
        cycle.stretch_max,
        cycle.laps,
    ))
}

#[pymodule]
mod _core {
    #[pymodule_export]
    use super::{breakaway_force, drag_force, simulate, stick_slip};

    use pyo3::prelude::*;

    /// The names behind the mode indices of `simulate`, and the version of the crate.
    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        use hersey_core::drag::Mode;
        let modes = [Mode::Ehl, Mode::Mixed, Mode::Microslip, Mode::Stuck].map(super::mode_name);
        module.add("MODES", modes)?;
        module.add("VERSION", env!("CARGO_PKG_VERSION"))
    }
}
