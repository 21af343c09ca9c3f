//! One motion at a time.

use hersey_core::drag::Mode;
use hersey_core::motion::{
    self, Drive, Drivetrain, Integrator, Schedule, Span, Start, StickSlipCycle, System,
};
use numpy::{IntoPyArray, PyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::drag::Law;
use crate::ensemble::KINDS;
use crate::value_error;

/// Times, values, and cubics between the times unless the values are joined by straight lines.
type ScheduleArguments = (Vec<f64>, Vec<f64>, Option<Vec<[f64; 4]>>);
/// (time, from, to, guard, stretch, belt speed)
type EventRow = (f64, &'static str, &'static str, &'static str, f64, f64);
/// (time, belt speed, stretch, mode index, events, (work, dissipated, stored, residual), steps)
type TrajectoryColumns<'py> = (
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<u8>>,
    Vec<EventRow>,
    (f64, f64, f64, f64),
    usize,
);
/// (kind, frequency, slip duration, stick duration, speed min, max, stretch min, max, drag work, laps)
type CycleRow = (&'static str, f64, f64, f64, f64, f64, f64, f64, f64, usize);

pub fn mode_name(mode: Mode) -> &'static str {
    match mode {
        Mode::Ehl => "ehl",
        Mode::Mixed => "mixed",
        Mode::Microslip => "microslip",
        Mode::Stuck => "stuck",
    }
}

fn schedule_from(
    name: &'static str,
    (times, values, cubics): ScheduleArguments,
) -> PyResult<Schedule> {
    match cubics {
        None => Schedule::linear(name, &times, &values),
        Some(cubics) => {
            let last = values.last().copied().unwrap_or(f64::NAN);
            Schedule::piecewise(name, &times, &cubics, last)
        }
    }
    .map_err(value_error)
}

/// Motion at equally spaced times.
#[pyfunction]
#[allow(clippy::too_many_arguments)] // the Python layer names them all
pub fn simulate<'py>(
    py: Python<'py>,
    train: (f64, f64),
    drag: &Law,
    drive: (&str, ScheduleArguments),
    temperature: Option<ScheduleArguments>,
    start: (f64, f64),
    duration: f64,
    samples: usize,
    tolerance: f64,
    integrator: &str,
) -> PyResult<TrajectoryColumns<'py>> {
    let train = Drivetrain::new(train.0, train.1).map_err(value_error)?;
    let drive = match drive {
        ("speed", schedule) => Drive::Speed(schedule_from("drive_speed", schedule)?),
        (_, schedule) => Drive::Force(schedule_from("drive_torque", schedule)?),
    };
    let temperature = temperature.map(|t| schedule_from("temperature", t)).transpose()?;
    let system = System::new(train, &drag.0, drive, temperature).map_err(value_error)?;
    let start = Start { belt_speed: start.0, stretch: start.1 };
    let integrator = match integrator {
        "adaptive" => Integrator::Adaptive,
        "dormand-prince" => Integrator::DormandPrince,
        other => return Err(PyValueError::new_err(format!("unknown integrator '{other}'"))),
    };
    let run = py
        .detach(|| motion::simulate(&system, start, duration, samples, tolerance, integrator))
        .map_err(value_error)?;
    let modes: Vec<u8> = run.mode.iter().map(|m| *m as u8).collect();
    let events = run
        .events
        .iter()
        .map(|e| {
            (e.time, mode_name(e.from), mode_name(e.to), e.guard.name(), e.stretch, e.belt_speed)
        })
        .collect();
    let energy = run.energy;
    Ok((
        run.time.into_pyarray(py),
        run.belt_speed.into_pyarray(py),
        run.stretch.into_pyarray(py),
        modes.into_pyarray(py),
        events,
        (energy.work, energy.dissipated, energy.stored, energy.residual()),
        run.steps,
    ))
}

/// What the motion settles to, or its last whole lap within `duration`.
#[pyfunction]
pub fn stick_slip(
    py: Python<'_>,
    train: (f64, f64),
    drag: &Law,
    drive_speed: f64,
    start: (f64, f64),
    duration: Option<f64>,
    tolerance: f64,
) -> PyResult<CycleRow> {
    let train = Drivetrain::new(train.0, train.1).map_err(value_error)?;
    let start = Start { belt_speed: start.0, stretch: start.1 };
    let span = duration.map_or(Span::UntilClosed, Span::Lasting);
    let cycle = py
        .detach(|| motion::settle(&train, &drag.0, drive_speed, start, span, tolerance))
        .map_err(value_error)?;
    let StickSlipCycle { kind, laps, .. } = cycle;
    Ok((
        KINDS[kind as usize],
        cycle.frequency,
        cycle.slip_duration,
        cycle.stick_duration,
        cycle.speed_min,
        cycle.speed_max,
        cycle.stretch_min,
        cycle.stretch_max,
        cycle.drag_work,
        laps,
    ))
}
