//! The motion sampled at given times, with its event table.

use super::hybrid::{Event, Motion};
use super::{Drivetrain, Start, checked_tolerance};
use crate::drag::{Drag, Mode};
use crate::error::{Error, above, finite};

/// Motion at equally spaced times from 0 to the duration.
#[derive(Debug, Clone)]
pub struct Trajectory {
    /// Time of each sample.
    pub time: Vec<f64>,
    /// Belt speed at each sample.
    pub belt_speed: Vec<f64>,
    /// Spring stretch at each sample.
    pub stretch: Vec<f64>,
    /// Mode at each sample.
    pub mode: Vec<Mode>,
    /// Every change of mode.
    pub events: Vec<Event>,
}

/// Motion at constant `drive_speed` from `start` over `duration`, at `samples` equally spaced times.
///
/// Events are located to rounding, and the samples are read from the Taylor polynomials of the steps:
/// neither depends on how densely the output is asked for.
///
/// # Errors
/// If a value is not finite or out of range, or the motion switches mode without end.
pub fn simulate(
    train: &Drivetrain,
    drag: &Drag,
    drive_speed: f64,
    start: Start,
    duration: f64,
    samples: usize,
    tolerance: f64,
) -> Result<Trajectory, Error> {
    finite("drive_speed", drive_speed)?;
    above("duration", duration, 0.0)?;
    let mut motion =
        Motion::new(train, drag, drive_speed, start.checked()?, checked_tolerance(tolerance)?);
    let mut out = Trajectory {
        time: sample_times(duration, samples),
        belt_speed: Vec::with_capacity(samples),
        stretch: Vec::with_capacity(samples),
        mode: Vec::with_capacity(samples),
        events: Vec::new(),
    };
    while motion.time() < duration {
        let (piece, event) = motion.advance(duration - motion.time())?;
        let end = if event.is_none() && motion.time() >= duration {
            f64::INFINITY
        } else {
            piece.time + piece.duration
        };
        for time in &out.time[out.mode.len()..] {
            if *time >= end {
                break;
            }
            let (belt_speed, stretch) = piece.at(time - piece.time);
            out.belt_speed.push(belt_speed);
            out.stretch.push(stretch);
            out.mode.push(piece.start.mode);
        }
        out.events.extend(event);
    }
    Ok(out)
}

#[allow(clippy::cast_precision_loss)] // more samples than 2^53 do not fit in memory
fn sample_times(duration: f64, samples: usize) -> Vec<f64> {
    let last = samples.saturating_sub(1).max(1) as f64;
    (0..samples).map(|i| duration * (i as f64 / last)).collect()
}
