//! One start-up of a drive: from when on the belt slides for good, and how hard the spring pulls until then.
//!
//! The motion is followed no further than needed: it ends where the roll loses its grip, where the belt is held too
//! late, and where it slides so steadily that it never leaves the rising branch again.

use std::f64::consts::TAU;

use super::cycle::{Span, settle, swing_that_dies_out};
use super::event::Guard;
use super::hybrid::Motion;
use super::piece::Piece;
use super::stick_slip_cycle::CycleKind;
use super::system::{Integrator, Start, System};
use crate::drag::{Drag, Mode};
use crate::error::{Error, above};
use crate::work::Work;

/// Laps followed after the last ramp at first, laps without sticking that end the start-up, doublings at most.
pub(super) const WATCH: f64 = 3.0;
const CALM: f64 = 1.5;
const DOUBLINGS: usize = 6;

/// What is asked of a start-up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StartUp {
    /// Drive speed after the ramps.
    pub target: f64,
    /// When the last ramp ends.
    pub ramps: f64,
    /// The motion is followed at least so long.
    pub until: f64,
    /// A belt that is held at this time or later is too late.
    pub latest: f64,
    /// Whether the greatest pull is asked for.
    pub peak: bool,
}

/// How a start-up ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// The belt slides with the drive for good.
    Slides,
    /// The spring pulls harder than the roll grips.
    GripLost,
    /// The belt is held when it should have slid.
    Late,
    /// The belt still sticks now and then, though it would come to slide.
    Sticking,
    /// The motion settles to something else.
    Settles(CycleKind),
}

/// What came of a start-up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Started {
    /// How it ended.
    pub ending: Ending,
    /// When the belt was last let go; infinite if it is held.
    pub released: f64,
    /// Greatest magnitude of the pull, if it was asked for.
    pub peak: f64,
}

/// Follow `system` from rest.
///
/// # Errors
/// If a value is out of range, the motion switches mode without end, or `work` ends before it.
pub fn start_up(
    system: &System,
    asked: &StartUp,
    tolerance: f64,
    work: &Work,
) -> Result<Started, Error> {
    above("target", asked.target, 0.0)?;
    let lap = TAU * system.train.time_scale();
    let still = system.temperature.is_none() && system.heat.is_none();
    let mut motion = Motion::new(system, Start::REST, tolerance, Integrator::Adaptive, work)?;
    let (mut held, mut released, mut peak) = (true, f64::INFINITY, 0.0_f64);
    let mut judged = asked.peak || !still;
    let mut watch = WATCH * lap;
    let mut piece = motion.no_piece();
    for _ in 0..DOUBLINGS {
        let end = (asked.ramps + watch).max(asked.until);
        while motion.time() < end {
            let event = motion.advance(end - motion.time(), &mut piece)?;
            if asked.peak {
                peak = peak.max(greatest_pull(&piece));
            }
            if event.is_some_and(|e| e.guard == Guard::GripLost) {
                return Ok(Started { ending: Ending::GripLost, released, peak });
            }
            if let Some(event) = event {
                held = holds(event.to);
                if holds(event.from) {
                    released = event.time;
                }
            }
            if motion.time() >= asked.latest && (held || released >= asked.latest) {
                return Ok(Started { ending: Ending::Late, released, peak });
            }
            if motion.time() < asked.ramps || !still {
                continue;
            }
            if held && !judged {
                // the drive moves as it will, and a belt that is held begins anew
                judged = true;
                let kind = settled(&motion, asked.target, tolerance, work)?;
                if kind != CycleKind::SteadySliding {
                    return Ok(Started { ending: Ending::Settles(kind), released, peak });
                }
            }
            if !held && motion.time() >= asked.until {
                let swing =
                    swing_that_dies_out(motion.phase(), &system.train, &system.drag, asked.target);
                let most = if asked.peak { peak } else { system.train.grip() };
                if swing.is_some_and(|hardest| hardest <= most) {
                    return Ok(Started { ending: Ending::Slides, released, peak });
                }
            }
        }
        let kind = settled(&motion, asked.target, tolerance, work)?;
        if kind != CycleKind::SteadySliding {
            return Ok(Started { ending: Ending::Settles(kind), released, peak });
        }
        if !held && motion.time() - released >= CALM * lap {
            return Ok(Started { ending: Ending::Slides, released, peak });
        }
        watch *= 2.0;
    }
    Ok(Started { ending: Ending::Sticking, released, peak })
}

pub(super) fn holds(mode: Mode) -> bool {
    matches!(mode, Mode::Stuck | Mode::Microslip)
}

/// What the motion settles to from now on, at the temperature that it has reached.
fn settled(motion: &Motion, target: f64, tolerance: f64, work: &Work) -> Result<CycleKind, Error> {
    let (system, phase) = (motion.now.system, motion.phase());
    let drag: Drag = match motion.now.temperature_law() {
        Some((course, _)) => system.drag.at(course[0])?,
        None => system.drag.clone(),
    };
    let start = Start {
        belt_speed: phase.direction * phase.speed,
        stretch: phase.direction * phase.pull / system.train.stiffness(),
    };
    let work = work.apart(work.allowed());
    let cycle = settle(&system.train, &drag, target, start, Span::UntilClosed, tolerance, &work)?;
    Ok(cycle.kind)
}

/// Greatest magnitude of the pull along a piece.
pub(super) fn greatest_pull(piece: &Piece) -> f64 {
    let pull = |elapsed: f64| piece.at(elapsed).1.abs();
    let turning = piece.turning_points()[1];
    pull(0.0).max(pull(piece.duration)).max(turning.map_or(0.0, pull))
}
