//! What the motion settles to at a constant drive speed, found by detecting the periodic orbit.
//!
//! A lap runs from one crossing of a section to the next: the release from the stuck phase while the
//! belt sticks, otherwise the moment when belt speed rises through drive speed. The orbit has closed
//! once two laps in a row start at the same state.

use super::hybrid::{Event, Motion, Piece};
use super::polynomial::{Polynomial, first_crossing, subtracted_from};
use super::{Drivetrain, Start, checked_tolerance};
use crate::drag::{Drag, Mode};
use crate::error::{Error, finite};

/// What the motion settles to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CycleKind {
    /// The belt moves at drive speed.
    SteadySliding,
    /// The belt speed swings about drive speed without sticking.
    Oscillation,
    /// The belt sticks and slips.
    StickSlip,
    /// No periodic motion was reached within the laps allowed.
    Unsettled,
}

/// The settled motion; of `Unsettled` motion, its last lap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StickSlipCycle {
    /// Which of the outcomes it is.
    pub kind: CycleKind,
    /// Laps per unit time; zero in steady sliding.
    pub frequency: f64,
    /// Time slipping per lap.
    pub slip_duration: f64,
    /// Time stuck per lap.
    pub stick_duration: f64,
    /// Least belt speed.
    pub speed_min: f64,
    /// Greatest belt speed.
    pub speed_max: f64,
    /// Least spring stretch.
    pub stretch_min: f64,
    /// Greatest spring stretch.
    pub stretch_max: f64,
    /// Laps simulated.
    pub laps: usize,
}

/// Laps after which an orbit that has not closed is reported as unsettled.
const MAX_LAPS: usize = 20_000;
/// Pieces without a lap after which the motion is judged where it stands.
const MAX_PIECES_PER_LAP: usize = 1_000_000;
/// Relative change of the section state between laps at which an orbit has closed.
const CLOSED: f64 = 1e-9;
/// Swing of the belt speed, relative to the drive speed, below which it counts as steady.
const STEADY: f64 = 1e-7;
/// Swing, relative to the drive speed, below which a lap on the falling branch is still growing out of rounding.
const GROWING: f64 = 1e-6;

/// What the motion settles to at constant `drive_speed` from `start`.
///
/// # Errors
/// If a value is not finite or out of range, or the motion switches mode without end.
pub fn stick_slip(
    train: &Drivetrain,
    drag: &Drag,
    drive_speed: f64,
    start: Start,
    tolerance: f64,
) -> Result<StickSlipCycle, Error> {
    finite("drive_speed", drive_speed)?;
    let mut motion =
        Motion::new(train, drag, drive_speed, start.checked()?, checked_tolerance(tolerance)?);
    let mut lap = Lap::starting_at(0.0);
    let mut previous: Option<Section> = None;
    let (mut pieces, mut laps, mut overtakings) = (0, 0, 0);
    loop {
        let (piece, event) = motion.advance(f64::INFINITY)?;
        lap.add(&piece, drive_speed);
        pieces += 1;
        let still = piece.duration.is_infinite() || is_steady(&piece, train, drag, drive_speed);
        if still || pieces > MAX_PIECES_PER_LAP {
            let kind = if still { CycleKind::SteadySliding } else { CycleKind::Unsettled };
            let steady = still.then(|| steady_stretch(&piece, train, drag, drive_speed));
            return Ok(lap.cycle(kind, motion.time(), laps, drive_speed, steady));
        }
        let found = release(event).or_else(|| overtaking(&piece, drive_speed));
        let Some(section) = found.filter(|s| s.stuck || lap.stick_duration == 0.0) else {
            continue;
        };
        // every slip after a release overtakes the drive once; a second time means that it did not stick
        overtakings += u32::from(!section.stuck);
        if !section.stuck && overtakings < 2 && previous.is_some_and(|p| p.stuck) {
            continue;
        }
        (pieces, overtakings) = (0, 0);
        laps += 1;
        let grown = section.stuck || lap.speed.1 - lap.speed.0 > GROWING * drive_speed.abs();
        let closed = grown && previous.is_some_and(|p| section.repeats(&p, drag, train));
        if closed || laps >= MAX_LAPS {
            let kind = match (closed, section.stuck) {
                (false, _) => CycleKind::Unsettled,
                (true, true) => CycleKind::StickSlip,
                (true, false) => CycleKind::Oscillation,
            };
            return Ok(lap.cycle(kind, section.time, laps, drive_speed, None));
        }
        previous = Some(section);
        lap = Lap::starting_at(section.time);
        lap.add_rest_of(&piece, section.time, drive_speed);
    }
}

/// State where a lap ends and the next begins.
#[derive(Debug, Clone, Copy)]
struct Section {
    time: f64,
    stuck: bool,
    belt_speed: f64,
    stretch: f64,
}

impl Section {
    fn repeats(&self, previous: &Self, drag: &Drag, train: &Drivetrain) -> bool {
        let speed_scale = drag.stick_speed().max(self.belt_speed.abs());
        let stretch_scale = self.stretch.abs().max(speed_scale * train.time_scale());
        self.stuck == previous.stuck
            && (self.belt_speed - previous.belt_speed).abs() <= CLOSED * speed_scale
            && (self.stretch - previous.stretch).abs() <= CLOSED * stretch_scale
    }
}

/// The section of sticking motion: the release from the stuck phase.
fn release(event: Option<Event>) -> Option<Section> {
    let Event { time, belt_speed, stretch, .. } = event.filter(|e| e.from == Mode::Stuck)?;
    Some(Section { time, stuck: true, belt_speed, stretch })
}

/// The section of motion without sticking: the belt overtakes the drive.
fn overtaking(piece: &Piece, drive_speed: f64) -> Option<Section> {
    let slower = subtracted_from(piece.start.direction * drive_speed, &piece.speed);
    if piece.start.mode == Mode::Stuck || slower[0] <= 0.0 {
        return None;
    }
    let elapsed = first_crossing(&slower, piece.duration)?;
    let (belt_speed, stretch) = piece.at(elapsed);
    Some(Section { time: piece.time + elapsed, stuck: false, belt_speed, stretch })
}

/// Whether the belt slides with the drive for good.
///
/// On a rising branch the energy of the deviation, `m (u - v)^2/2 + k (s - s*)^2/2`, falls at the rate
/// `(F(u) - F(v)) (u - v) >= 0`; once it is too small to carry the belt down to the transition speed, the belt
/// never leaves the branch again and the deviation dies out.
fn is_steady(piece: &Piece, train: &Drivetrain, drag: &Drag, drive_speed: f64) -> bool {
    let (belt_speed, stretch) = piece.at(0.0);
    if piece.start.creeping {
        return (belt_speed - drive_speed).abs() <= STEADY * drag.stick_speed();
    }
    let margin = drive_speed.abs() - drag.transition_speed();
    if piece.start.mode != Mode::Ehl || margin < 0.0 {
        return false;
    }
    let rising = drag.force_exponent(Mode::Ehl) >= 0.0;
    let reach =
        if rising { margin.max(STEADY * drive_speed.abs()) } else { STEADY * drive_speed.abs() };
    let off = stretch - drag.force(drive_speed) / train.stiffness();
    let energy = train.mass() * (belt_speed - drive_speed).powi(2) + train.stiffness() * off * off;
    energy < train.mass() * reach * reach
}

/// Spring stretch of steady motion at the drive speed.
fn steady_stretch(piece: &Piece, train: &Drivetrain, drag: &Drag, drive_speed: f64) -> f64 {
    if piece.start.mode == Mode::Ehl {
        drag.force(drive_speed) / train.stiffness()
    } else {
        piece.at(0.0).1
    }
}

/// Extremes and durations of the lap under way.
struct Lap {
    begin: f64,
    stick_duration: f64,
    speed: (f64, f64),
    stretch: (f64, f64),
}

impl Lap {
    fn starting_at(time: f64) -> Self {
        let none = (f64::INFINITY, f64::NEG_INFINITY);
        Self { begin: time, stick_duration: 0.0, speed: none, stretch: none }
    }

    fn add(&mut self, piece: &Piece, drive_speed: f64) {
        if piece.start.mode == Mode::Stuck {
            self.stick_duration += piece.duration;
        }
        self.add_rest_of(piece, piece.time, drive_speed);
    }

    /// Take in the extremes of `piece` from `time` on: its ends, and its turning points.
    fn add_rest_of(&mut self, piece: &Piece, time: f64, drive_speed: f64) {
        let begin = time - piece.time;
        let acceleration = derivative(&piece.speed);
        let stretching = subtracted_from(piece.start.direction * drive_speed, &piece.speed);
        let turning = [acceleration, stretching].map(|rate| {
            let rising = if rate[0] < 0.0 { rate.map(|c| -c) } else { rate };
            first_crossing(&rising, piece.duration).filter(|t| *t >= begin)
        });
        let moments = [Some(begin), Some(piece.duration), turning[0], turning[1]];
        for elapsed in moments.into_iter().flatten().filter(|t| t.is_finite()) {
            let (belt_speed, stretch) = piece.at(elapsed);
            self.speed = (self.speed.0.min(belt_speed), self.speed.1.max(belt_speed));
            self.stretch = (self.stretch.0.min(stretch), self.stretch.1.max(stretch));
        }
    }

    fn cycle(
        &self,
        kind: CycleKind,
        end: f64,
        laps: usize,
        drive_speed: f64,
        steady: Option<f64>,
    ) -> StickSlipCycle {
        let duration = end - self.begin;
        let periodic = kind != CycleKind::SteadySliding && duration.is_finite() && duration > 0.0;
        let (speed, stretch) = match steady {
            Some(stretch) => ((drive_speed, drive_speed), (stretch, stretch)),
            None => (self.speed, self.stretch),
        };
        StickSlipCycle {
            kind,
            frequency: if periodic { 1.0 / duration } else { 0.0 },
            slip_duration: if periodic { duration - self.stick_duration } else { 0.0 },
            stick_duration: if periodic { self.stick_duration } else { 0.0 },
            speed_min: speed.0,
            speed_max: speed.1,
            stretch_min: stretch.0,
            stretch_max: stretch.1,
            laps,
        }
    }
}

#[allow(clippy::cast_precision_loss)] // powers are at most ORDER
fn derivative(c: &Polynomial) -> Polynomial {
    let mut out = [0.0; super::polynomial::ORDER + 1];
    for (i, ci) in c.iter().enumerate().skip(1) {
        out[i - 1] = ci * i as f64;
    }
    out
}
