//! A motion seen only where the belt overtakes the drive.

use super::event::Event;
use super::hybrid::Motion;
use super::lap::overtaking;
use super::piece::Piece;
use super::system::{Integrator, Start, System};
use crate::drag::Mode;
use crate::error::Error;
use crate::work::Work;

/// Pieces without the belt overtaking the drive, after which it is taken not to do so again.
const MOST_PIECES: usize = 100_000;
/// Share of the time scale within which the belt overtakes the drive once.
const ONCE: f64 = 1e-6;

/// The belt overtakes the drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Overtaking {
    /// Pull of the spring.
    pub pull: f64,
    /// Whether the belt has been below the stick speed since the last time, or the start.
    pub stuck: bool,
    /// Least belt speed since then, at the ends of the steps.
    pub slowest: f64,
}

/// The motion from one overtaking to the next.
pub(crate) struct Overtakings<'a> {
    motion: Motion<'a>,
    drive_speed: f64,
    once: f64,
    last: f64,
}

impl<'a> Overtakings<'a> {
    pub(crate) fn from(
        system: &'a System,
        drive_speed: f64,
        start: Start,
        tolerance: f64,
        work: &'a Work<'a>,
    ) -> Result<Self, Error> {
        let motion = Motion::new(system, start, tolerance, Integrator::Adaptive, work)?;
        let once = ONCE * system.train.time_scale();
        Ok(Self { motion, drive_speed, once, last: 0.0 })
    }

    /// The next overtaking, if there is one.
    pub(crate) fn next(&mut self) -> Result<Option<Overtaking>, Error> {
        let below = |mode| matches!(mode, Mode::Stuck | Mode::Microslip);
        let (mut stuck, mut slowest) = (false, f64::INFINITY);
        let mut piece = self.motion.no_piece();
        for _ in 0..MOST_PIECES {
            let event = self.motion.advance(f64::INFINITY, &mut piece)?;
            stuck |= below(piece.start.mode);
            slowest = slowest.min(piece.start.direction * piece.start.speed);
            if let Some((time, pull)) = self.met(&piece, event)
                && time > self.last + self.once
            {
                self.last = time;
                return Ok(Some(Overtaking { pull, stuck, slowest }));
            }
            if piece.duration.is_infinite() {
                return Ok(None);
            }
        }
        Ok(None)
    }

    /// Time and pull where the belt overtakes the drive in this piece, or at its end on a corner of the law.
    #[allow(clippy::float_cmp)] // a corner is met by assigning its speed
    fn met(&self, piece: &Piece, event: Option<Event>) -> Option<(f64, f64)> {
        if let Some(section) = overtaking(piece, self.drive_speed) {
            return Some((section.time, section.pull));
        }
        let corner = event.filter(|e| e.belt_speed == self.drive_speed)?;
        let rises = piece.start.direction > 0.0 && piece.start.speed < self.drive_speed;
        rises.then(|| (corner.time, piece.at(piece.duration).1))
    }
}
