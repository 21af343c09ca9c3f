//! Where a belt that overtakes the drive overtakes it again.

use super::cycle::swing_that_dies_out;
use super::hybrid::Motion;
use super::lap::{gripping_again, overtaking};
use super::system::{Integrator, Start, System};
use crate::drag::Mode;
use crate::error::Error;
use crate::work::Work;

/// Pieces without a lap after which there is none.
const MOST_PIECES: usize = 100_000;
/// Share of the lap's time scale within which the belt is still where it began.
const BEGUN: f64 = 1e-6;

/// What becomes of a belt that overtakes the drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Return {
    /// It overtakes the drive again, after this time and with this pull, and did not slow down to the stick speed.
    Slid(f64, f64),
    /// The same, but it did.
    Stuck(f64, f64),
    /// It is held, or creeps on below the stick speed, or has come to it and is followed no further.
    Held,
    /// It comes to slide with the drive.
    Dies,
}

/// The next return of a belt that overtakes the constant `drive_speed` of `system` with `pull`; one that sticks is followed
/// no further unless `through` says so.
pub(crate) fn next_return(
    system: &System,
    drive_speed: f64,
    pull: f64,
    through: bool,
    tolerance: f64,
    work: &Work,
) -> Result<Return, Error> {
    let (train, drag) = (&system.train, &system.drag);
    let start = Start { belt_speed: drive_speed, stretch: pull / train.stiffness() };
    let mut motion = Motion::new(system, start, tolerance, Integrator::Adaptive, work)?;
    let begun = BEGUN * train.time_scale();
    let mut stuck = false;
    let mut piece = motion.no_piece();
    for _ in 0..MOST_PIECES {
        let event = motion.advance(f64::INFINITY, &mut piece)?;
        let found = overtaking(&piece, drive_speed).or_else(|| gripping_again(event, train));
        if let Some(section) = found.filter(|section| section.time > begun) {
            let (time, pull) = (section.time, section.pull);
            return Ok(if stuck { Return::Stuck(time, pull) } else { Return::Slid(time, pull) });
        }
        if event.is_some_and(|event| matches!(event.to, Mode::Stuck | Mode::Microslip)) {
            stuck = true;
            if !through {
                return Ok(Return::Held);
            }
        }
        if piece.duration.is_infinite() {
            return Ok(if stuck { Return::Held } else { Return::Dies });
        }
        if !stuck && swing_that_dies_out(motion.phase(), train, drag, drive_speed).is_some() {
            return Ok(Return::Dies);
        }
    }
    Ok(if stuck { Return::Held } else { Return::Dies })
}
