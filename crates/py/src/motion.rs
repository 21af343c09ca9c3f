//! One motion at a time.

use hersey_core::drag::Mode;
use hersey_core::motion::{
    self, Drive, Drivetrain, HeatBalance, Heater, Integrator, Schedule, Span, Start, System,
};
use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;
use pyo3::types::PyString;

use crate::drag::Law;
use crate::ensemble::KINDS;
use crate::errors::{raised, refused};
use crate::interrupt::interruptible;

/// Times, values, and cubics between the times unless the values are joined by straight lines.
pub type ScheduleArguments = (Vec<f64>, Vec<f64>, Option<Vec<[f64; 4]>>);

/// The changes of mode, as lists of one length.
#[pyclass(frozen, get_all, module = "hersey._core")]
pub struct Events {
    time: Vec<f64>,
    from_mode: Vec<Py<PyString>>,
    to_mode: Vec<Py<PyString>>,
    guard: Vec<Py<PyString>>,
    stretch: Vec<f64>,
    belt_speed: Vec<f64>,
}

impl Events {
    fn new(py: Python<'_>, events: &[motion::Event]) -> Self {
        let names = |of: fn(&motion::Event) -> &'static str| named(py, events.iter().map(of));
        Self {
            time: events.iter().map(|e| e.time).collect(),
            from_mode: names(|e| mode_name(e.from)),
            to_mode: names(|e| mode_name(e.to)),
            guard: names(|e| e.guard.name()),
            stretch: events.iter().map(|e| e.stretch).collect(),
            belt_speed: events.iter().map(|e| e.belt_speed).collect(),
        }
    }
}

/// Names of which there are few, each made once.
fn named(py: Python<'_>, names: impl Iterator<Item = &'static str>) -> Vec<Py<PyString>> {
    let mut known: Vec<(&str, Py<PyString>)> = Vec::new();
    names
        .map(|name| {
            let place = known.iter().position(|(each, _)| *each == name).unwrap_or_else(|| {
                known.push((name, PyString::intern(py, name).unbind()));
                known.len() - 1
            });
            known[place].1.clone_ref(py)
        })
        .collect()
}

/// Where the work of the drive went.
#[pyclass(frozen, get_all, module = "hersey._core")]
pub struct Energy {
    work: f64,
    dissipated: f64,
    slipped: f64,
    /// Of what was dissipated, what has not heated the film: the contact gave it and has not got it back.
    owed: f64,
    stored: f64,
    residual: f64,
}

/// Motion at equally spaced times.
#[pyclass(frozen, get_all, module = "hersey._core")]
pub struct Trajectory {
    time: Py<PyArray1<f64>>,
    belt_speed: Py<PyArray1<f64>>,
    stretch: Py<PyArray1<f64>>,
    mode_index: Py<PyArray1<u8>>,
    slipping: Py<PyArray1<bool>>,
    /// Temperatures of film and roll, if they are states.
    temperature: Option<[Py<PyArray1<f64>>; 2]>,
    events: Py<Events>,
    energy: Py<Energy>,
    steps: usize,
}

/// What the motion settles to.
#[pyclass(frozen, get_all, module = "hersey._core")]
pub struct Cycle {
    kind: &'static str,
    frequency: f64,
    slip_duration: f64,
    stick_duration: f64,
    speed_min: f64,
    speed_max: f64,
    stretch_min: f64,
    stretch_max: f64,
    grip_slip_duration: f64,
    drag_work: f64,
    laps_per_period: usize,
    laps: usize,
}

/// Where a motion starts.
#[pyclass(frozen, get_all, module = "hersey._core")]
pub struct State {
    belt_speed: f64,
    stretch: f64,
}

/// Stiffness, mass, and the force up to which the roll grips the belt, if that is known.
pub type TrainArguments = (f64, f64, Option<f64>);

pub fn drivetrain_from((stiffness, mass, grip): TrainArguments) -> PyResult<Drivetrain> {
    let train = Drivetrain::new(stiffness, mass).map_err(raised)?;
    grip.map_or(Ok(train), |grip| train.with_grip(grip).map_err(raised))
}

pub fn mode_name(mode: Mode) -> &'static str {
    match mode {
        Mode::Ehl => "ehl",
        Mode::Mixed => "mixed",
        Mode::Microslip => "microslip",
        Mode::Stuck => "stuck",
    }
}

pub fn schedule_from(
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
    .map_err(raised)
}

/// Heat capacities, exchange, losses, surroundings, heater (its power, or temperature, most power and gain), what is taken
/// from each body, temperatures at the start, and zero of the temperature scale of the drag law.
pub type HeatArguments = (
    [f64; 2],
    f64,
    [f64; 2],
    f64,
    (Option<ScheduleArguments>, Option<(f64, f64, f64)>),
    (ScheduleArguments, ScheduleArguments),
    [f64; 2],
    f64,
);

pub fn heat_from(arguments: HeatArguments) -> PyResult<HeatBalance> {
    let (capacity, exchange, loss, surroundings, heater, load, start, temperature_zero) = arguments;
    let heater = match heater {
        (Some(power), _) => Heater::Power(schedule_from("heater power", power)?),
        (None, Some((setpoint, most, gain))) => Heater::Controlled { setpoint, most, gain },
        (None, None) => Heater::Power(Schedule::constant(0.0)),
    };
    let load =
        [schedule_from("load of the film", load.0)?, schedule_from("load of the roll", load.1)?];
    Ok(HeatBalance {
        capacity,
        exchange,
        loss,
        surroundings,
        heater,
        load,
        start,
        temperature_zero,
    })
}

/// Motion at equally spaced times.
#[pyfunction]
#[pyo3(signature = (train, drag, drive, temperature, start, duration, samples, tolerance, integrator, most_steps, heat=None))]
#[allow(clippy::too_many_arguments)] // the Python layer names them all
pub fn simulate(
    py: Python<'_>,
    train: TrainArguments,
    drag: &Law,
    drive: (&str, ScheduleArguments),
    temperature: Option<ScheduleArguments>,
    start: (f64, f64),
    duration: f64,
    samples: usize,
    tolerance: f64,
    integrator: &str,
    most_steps: u64,
    heat: Option<HeatArguments>,
) -> PyResult<Trajectory> {
    let train = drivetrain_from(train)?;
    let drive = match drive {
        ("speed", schedule) => Drive::Speed(schedule_from("drive_speed", schedule)?),
        (_, schedule) => Drive::Force(schedule_from("drive_torque", schedule)?),
    };
    let temperature = temperature.map(|t| schedule_from("temperature", t)).transpose()?;
    let system = match heat {
        Some(heat) => System::with_heat(train, &drag.0, drive, heat_from(heat)?),
        None => System::new(train, &drag.0, drive, temperature),
    };
    let system = system.map_err(raised)?;
    let start = Start { belt_speed: start.0, stretch: start.1 };
    let integrator = match integrator {
        "adaptive" => Integrator::Adaptive,
        "dormand-prince" => Integrator::DormandPrince,
        other => return Err(refused("integrator", format!("unknown integrator '{other}'"))),
    };
    let run = interruptible(py, most_steps, |work| {
        motion::simulate(&system, start, duration, samples, tolerance, integrator, work)
    })?;
    let modes: Vec<u8> = run.mode.iter().map(|m| *m as u8).collect();
    let motion::Energy { work, dissipated, slipped, owed, stored, .. } = run.energy;
    let residual = run.energy.residual();
    Ok(Trajectory {
        time: run.time.into_pyarray(py).unbind(),
        belt_speed: run.belt_speed.into_pyarray(py).unbind(),
        stretch: run.stretch.into_pyarray(py).unbind(),
        mode_index: modes.into_pyarray(py).unbind(),
        slipping: run.slipping.into_pyarray(py).unbind(),
        temperature: (!run.temperature.is_empty()).then(|| {
            [0, 1].map(|i| PyArray1::from_iter(py, run.temperature.iter().map(|t| t[i])).unbind())
        }),
        events: Py::new(py, Events::new(py, &run.events))?,
        energy: Py::new(py, Energy { work, dissipated, slipped, owed, stored, residual })?,
        steps: run.steps,
    })
}

/// What the motion settles to, or its last whole lap within `duration`.
#[pyfunction]
#[allow(clippy::too_many_arguments)] // the Python layer names them all
pub fn stick_slip(
    py: Python<'_>,
    train: TrainArguments,
    drag: &Law,
    drive_speed: f64,
    start: (f64, f64),
    duration: Option<f64>,
    tolerance: f64,
    most_steps: u64,
) -> PyResult<Cycle> {
    let train = drivetrain_from(train)?;
    let start = Start { belt_speed: start.0, stretch: start.1 };
    let span = duration.map_or(Span::UntilClosed, Span::Lasting);
    let cycle = interruptible(py, most_steps, |work| {
        motion::settle(&train, &drag.0, drive_speed, start, span, tolerance, work)
    })?;
    Ok(Cycle {
        kind: KINDS[cycle.kind as usize],
        frequency: cycle.frequency,
        slip_duration: cycle.slip_duration,
        stick_duration: cycle.stick_duration,
        speed_min: cycle.speed_min,
        speed_max: cycle.speed_max,
        stretch_min: cycle.stretch_min,
        stretch_max: cycle.stretch_max,
        grip_slip_duration: cycle.grip_slip_duration,
        drag_work: cycle.drag_work,
        laps_per_period: cycle.laps_per_period,
        laps: cycle.laps,
    })
}

/// Sliding at a speed with the spring stretched to match, and nudged off that balance if asked for.
#[pyfunction]
pub fn steady_start(
    train: TrainArguments,
    drag: &Law,
    speed: f64,
    nudged: bool,
) -> PyResult<State> {
    let train = drivetrain_from(train)?;
    let steady = Start::steady(&train, &drag.0, speed).map_err(raised)?;
    let Start { belt_speed, stretch } = if nudged { steady.nudged() } else { steady };
    Ok(State { belt_speed, stretch })
}
