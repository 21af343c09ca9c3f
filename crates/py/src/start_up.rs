//! One course of a drive on many belts.

use hersey_core::Error;
use hersey_core::motion::{
    self, BeltAtRest, Drive, Ending, Schedule, StartUp, Started, Starting, System,
};
use hersey_core::work::Work;
use pyo3::prelude::*;

use crate::drag::Law;
use crate::ensemble::{KINDS, in_chunks};
use crate::errors::refused;
use crate::interrupt::interruptible;
use crate::motion::{
    HeatArguments, ScheduleArguments, TrainArguments, drivetrain_from, heat_from, schedule_from,
};

/// Belts followed before it is asked whether enough of them have failed: first, and then at most.
const FIRST: usize = 16;
const BLOCK: usize = 64;
/// From so many on a block is spread over threads, of which one takes so many at a time.
const SPREAD: usize = 256;
const CHUNK: usize = 64;

/// A belt that is to be started: it remembers what sticking settles to.
#[pyclass(frozen, module = "hersey._core")]
pub struct StartingBelt(BeltAtRest);

#[pymethods]
impl StartingBelt {
    #[new]
    fn new(train: TrainArguments, law: &Law) -> PyResult<Self> {
        Ok(Self(BeltAtRest::new(drivetrain_from(train)?, law.0.clone())))
    }
}

/// When each belt is let go for the last time, its greatest pull, and how it ends.
type Starts = (Vec<f64>, Vec<f64>, Vec<&'static str>);

/// What each belt does under its drive, in order, until more than `allowed` of them do not come to slide.
///
/// One belt, or one drive, stands for all; a drive has the time at which its ramps end. `asked` is target, time followed
/// at least, and time from which a held belt is too late. What is followed does not depend on the number of threads.
#[pyfunction]
#[allow(clippy::too_many_arguments)] // the Python layer names them all
pub fn start_ups(
    py: Python<'_>,
    belts: Vec<Py<StartingBelt>>,
    drives: Vec<(ScheduleArguments, f64)>,
    temperature: Option<ScheduleArguments>,
    heat: Option<HeatArguments>,
    asked: (f64, f64, f64),
    peak: bool,
    allowed: usize,
    tolerance: f64,
    threads: usize,
    most_steps: u64,
) -> PyResult<Starts> {
    let temperature = temperature.map(|t| schedule_from("temperature", t)).transpose()?;
    let heat = heat.map(heat_from).transpose()?;
    let (target, until, latest) = asked;
    let belts: Vec<&BeltAtRest> = belts.iter().map(|belt| &belt.get().0).collect();
    let drives: Vec<(Schedule, f64)> = drives
        .into_iter()
        .map(|(speed, ramps)| Ok((schedule_from("drive_speed", speed)?, ramps)))
        .collect::<PyResult<_>>()?;
    let count = if belts.len() == 1 { drives.len() } else { belts.len() };
    if belts.is_empty() || !(drives.len() == count || drives.len() == 1) {
        return Err(refused("drives", "one for each belt, or one for all".to_owned()));
    }
    let starting = |i: usize| {
        let (drive, ramps) = &drives[if drives.len() == 1 { 0 } else { i }];
        let asked = StartUp { target, ramps: *ramps, until, latest, peak };
        Starting { belt: belts[if belts.len() == 1 { 0 } else { i }], drive, asked }
    };
    let warmed = |i: usize, work: &Work| -> Result<Started, Error> {
        let Starting { belt, drive, asked } = starting(i);
        let (train, drag, drive) = (belt.train, &belt.drag, Drive::Speed(drive.clone()));
        let system = match &heat {
            Some(heat) => System::with_heat(train, drag, drive, heat.clone()),
            None => System::new(train, drag, drive, temperature.clone()),
        }?;
        motion::start_up(&system, &asked, tolerance, &work.apart(work.allowed()))
    };
    let follow_all = |which: &[usize], work: &Work| {
        if temperature.is_some() || heat.is_some() {
            return which.iter().map(|i| warmed(*i, work)).collect();
        }
        let each: Vec<Starting> = which.iter().map(|i| starting(*i)).collect();
        motion::start_ups(&each, tolerance, work)
    };
    let all: Vec<usize> = (0..count).collect();
    let (mut done, mut failed) = (Vec::with_capacity(count), 0);
    let mut block = if allowed < count { FIRST } else { count };
    while done.len() < count && failed <= allowed {
        let next = &all[done.len()..count.min(done.len() + block)];
        let found = if threads > 1 && next.len() >= SPREAD {
            in_chunks(py, next, CHUNK, threads, None, most_steps, follow_all)?
        } else {
            interruptible(py, most_steps, |work| follow_all(next, work))?
        };
        failed += found.iter().filter(|s| s.ending != Ending::Slides).count();
        done.extend(found);
        block = block.max(BLOCK);
    }
    let endings = done.iter().map(|s| name(s.ending)).collect();
    Ok((done.iter().map(|s| s.released).collect(), done.iter().map(|s| s.peak).collect(), endings))
}

fn name(ending: Ending) -> &'static str {
    match ending {
        Ending::Slides => "",
        Ending::GripLost => "grip_lost",
        Ending::Late => "late",
        Ending::Sticking => "still_sticking",
        Ending::Settles(kind) => KINDS[kind as usize],
    }
}
