//! What the motion settles to at a constant drive speed, found by detecting the periodic orbit.
//!
//! A lap runs from one crossing of a section to the next: the release from the stuck phase while the
//! belt sticks, otherwise the moment when belt speed rises through drive speed. The orbit has closed
//! once two laps in a row start at the same state.

use super::event::{Event, Guard};
use super::hybrid::Motion;
use super::piece::Piece;
use super::system::{Drivetrain, Integrator, Start, System};
use crate::drag::{Closure, Drag, Mode};
use crate::error::{Error, above};

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
    /// Work against drag per lap; zero in steady sliding, which has no laps.
    pub drag_work: f64,
    /// Laps simulated.
    pub laps: usize,
}

/// Laps after which an orbit that has not closed is reported as unsettled.
const MAX_LAPS: usize = 20_000;
/// The same for smooth closures, whose laps cost a hundred times as much.
const MAX_SMOOTH_LAPS: usize = 200;
/// Pieces without a lap after which the motion is judged where it stands.
const MAX_PIECES_PER_LAP: usize = 1_000_000;
/// Relative change of the section state between laps at which an orbit has closed.
const CLOSED: f64 = 1e-9;
/// The same for smooth closures, in tolerances: their steps are of low order and leave more noise.
const CLOSED_SMOOTH: f64 = 100.0;
/// Swing of the belt speed, relative to the drive speed, below which it counts as steady.
const STEADY: f64 = 1e-7;
/// Swing, relative to the drive speed, below which a lap on the falling branch is still growing out of rounding.
const GROWING: f64 = 1e-6;

/// How long a motion is followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Span {
    /// Until the orbit has closed, or died out.
    UntilClosed,
    /// For this time; the last whole lap counts.
    Lasting(f64),
}

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
    settle(train, drag, drive_speed, start, Span::UntilClosed, tolerance)
}

/// What the motion settles to, or its last whole lap, at constant `drive_speed` from `start`.
///
/// # Errors
/// As for [`stick_slip`].
pub fn settle(
    train: &Drivetrain,
    drag: &Drag,
    drive_speed: f64,
    start: Start,
    span: Span,
    tolerance: f64,
) -> Result<StickSlipCycle, Error> {
    let until = match span {
        Span::UntilClosed => f64::INFINITY,
        Span::Lasting(duration) => above("duration", duration, 0.0)?,
    };
    let lasting = until.is_finite();
    let mut whole: Option<StickSlipCycle> = None;
    let system = System::at_speed(*train, drag, drive_speed)?;
    let mut motion = Motion::new(&system, start, tolerance, Integrator::Adaptive)?;
    let k = train.stiffness();
    let smooth = drag.closure().is_smooth();
    let (near, most_laps) =
        if smooth { (CLOSED_SMOOTH * tolerance, MAX_SMOOTH_LAPS) } else { (CLOSED, MAX_LAPS) };
    let mut lap = Lap::starting_at(0.0);
    let mut previous: Option<Section> = None;
    let mut pace = Pace::default();
    let (mut pieces, mut laps, mut overtakings) = (0, 0, 0);
    loop {
        if motion.time() >= until {
            let unfinished =
                || lap.cycle(CycleKind::Unsettled, motion.time(), laps, drive_speed, k, None);
            return Ok(whole.unwrap_or_else(unfinished));
        }
        let (piece, event) = motion.advance(until - motion.time())?;
        lap.add(&piece, smooth);
        pieces += 1;
        let still = piece.duration.is_infinite() || is_steady(&piece, train, drag, drive_speed);
        if still || pieces > MAX_PIECES_PER_LAP {
            let kind = if still { CycleKind::SteadySliding } else { CycleKind::Unsettled };
            let steady = still.then(|| steady_stretch(&piece, train, drag, drive_speed));
            return Ok(lap.cycle(kind, motion.time(), laps, drive_speed, k, steady));
        }
        let found = release(event, smooth, train).or_else(|| overtaking(&piece, drive_speed));
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
        if lasting {
            let kind = if section.stuck { CycleKind::StickSlip } else { CycleKind::Oscillation };
            if previous.is_some_and(|p| p.stuck == section.stuck) {
                whole = Some(lap.cycle(kind, section.time, laps, drive_speed, k, None));
            }
            previous = Some(section);
            lap = Lap::starting_at(section.time);
            lap.add_rest_of(&piece, section.time);
            continue;
        }
        let grown = section.stuck || lap.speed.1 - lap.speed.0 > GROWING * drive_speed.abs();
        let closed = grown && previous.is_some_and(|p| section.repeats(&p, drag, train, near));
        if closed || laps >= most_laps {
            let kind = match (closed, section.stuck) {
                (false, _) => CycleKind::Unsettled,
                (true, true) => CycleKind::StickSlip,
                (true, false) => CycleKind::Oscillation,
            };
            return Ok(lap.cycle(kind, section.time, laps, drive_speed, k, None));
        }
        if !section.stuck
            && let Some(pull) = pace.ahead(section.pull, drag.force(drive_speed))
        {
            motion.resume(section.time, drive_speed, pull);
            (previous, lap) = (None, Lap::starting_at(section.time));
            continue;
        }
        if section.stuck {
            pace = Pace::default();
        }
        previous = Some(section);
        lap = Lap::starting_at(section.time);
        lap.add_rest_of(&piece, section.time);
    }
}

/// State where a lap ends and the next begins.
#[derive(Debug, Clone, Copy)]
struct Section {
    time: f64,
    stuck: bool,
    belt_speed: f64,
    pull: f64,
}

impl Section {
    fn repeats(&self, previous: &Self, drag: &Drag, train: &Drivetrain, near: f64) -> bool {
        let speed_scale = drag.stick_speed().max(self.belt_speed.abs());
        let impedance = (train.stiffness() * train.mass()).sqrt();
        let pull_scale = self.pull.abs().max(speed_scale * impedance);
        self.stuck == previous.stuck
            && (self.belt_speed - previous.belt_speed).abs() <= near * speed_scale
            && (self.pull - previous.pull).abs() <= near * pull_scale
    }
}

/// The last laps' pulls where the belt overtakes the drive, to shorten a long approach.
///
/// The map from one overtaking to the next has one variable and cannot swap two orbits, so every state
/// between here and where the laps are heading leads there too: part of the way can be skipped.
#[derive(Default)]
struct Pace {
    pulls: Vec<f64>,
}

impl Pace {
    /// Share of the way to the expected limit that is skipped.
    const SKIPPED: f64 = 0.7;
    /// Growth of a swing away from an unstable orbit that is skipped at once.
    const GROWTH: f64 = 1.2;
    /// Laps that shrink faster than this need no help.
    const SLOW: f64 = 0.8;

    /// A pull further along the way of the laps, if they are slow and steady enough to foresee.
    fn ahead(&mut self, pull: f64, steady_pull: f64) -> Option<f64> {
        self.pulls.push(pull);
        let [.., a, b, c, d] = self.pulls[..] else { return None };
        let (ratio, before) = ((d - c) / (c - b), (c - b) / (b - a));
        let steady = (ratio - before).abs() < 0.1 * (1.0 - ratio).abs();
        let growth = ratio - 1.0;
        let noise = 1e-7 * (d - steady_pull).abs();
        if !steady || (d - c).abs() < noise || !(Self::SLOW..1.1).contains(&ratio) || growth == 0.0
        {
            return None;
        }
        let limit = d - (d - c) * ratio / growth;
        let jump = if growth < 0.0 {
            Self::SKIPPED * (limit - d)
        } else {
            (Self::GROWTH - 1.0) * (d - limit)
        };
        let most = 0.5 * (d - steady_pull).abs();
        self.pulls.clear();
        Some(d + jump.clamp(-most, most))
    }
}

/// The section of sticking motion: the release from the stuck phase.
///
/// A smooth closure has no stuck phase: there it is the moment when the belt leaves the creep below `v_s`.
fn release(event: Option<Event>, smooth: bool, train: &Drivetrain) -> Option<Section> {
    let released = |e: &Event| {
        e.from == Mode::Stuck
            || (smooth && e.from == Mode::Microslip && e.guard == Guard::StickSpeed)
    };
    let Event { time, belt_speed, stretch, .. } = event.filter(released)?;
    Some(Section { time, stuck: true, belt_speed, pull: train.stiffness() * stretch })
}

/// The section of motion without sticking: the belt overtakes the drive.
fn overtaking(piece: &Piece, drive_speed: f64) -> Option<Section> {
    let elapsed = piece.overtaking(drive_speed)?;
    let (belt_speed, pull) = piece.at(elapsed);
    Some(Section { time: piece.time + elapsed, stuck: false, belt_speed, pull })
}

/// Whether the belt slides with the drive for good.
///
/// On a rising branch the energy of the deviation, `m (u - v)^2/2 + k (s - s*)^2/2`, falls at the rate
/// `(F(u) - F(v)) (u - v) >= 0`; once it is too small to carry the belt down to the transition speed, the belt
/// never leaves the branch again and the deviation dies out.
fn is_steady(piece: &Piece, train: &Drivetrain, drag: &Drag, drive_speed: f64) -> bool {
    let (belt_speed, pull) = piece.at(0.0);
    if piece.start.creeping {
        return (belt_speed - drive_speed).abs() <= STEADY * drag.stick_speed();
    }
    let margin = drive_speed.abs() - drag.transition_speed();
    if piece.start.mode != Mode::Ehl || margin < 0.0 {
        return false;
    }
    // bristles remember: their force lags behind the speed, and can feed a swing
    let memory = matches!(drag.closure(), Closure::LuGre { .. });
    let rising = drag.rises_from_transition() && !memory;
    let reach =
        if rising { margin.max(STEADY * drive_speed.abs()) } else { STEADY * drive_speed.abs() };
    let off = pull - drag.force(drive_speed);
    let energy = train.mass() * (belt_speed - drive_speed).powi(2) + off * off / train.stiffness();
    energy < train.mass() * reach * reach
}

/// Spring stretch of steady motion at the drive speed.
fn steady_stretch(piece: &Piece, train: &Drivetrain, drag: &Drag, drive_speed: f64) -> f64 {
    if piece.start.mode == Mode::Ehl {
        drag.force(drive_speed) / train.stiffness()
    } else {
        piece.at(0.0).1 / train.stiffness()
    }
}

/// Extremes and durations of the lap under way.
struct Lap {
    begin: f64,
    stick_duration: f64,
    speed: (f64, f64),
    pull: (f64, f64),
    /// Integral of the pull over time.
    impulse: f64,
}

impl Lap {
    fn starting_at(time: f64) -> Self {
        let none = (f64::INFINITY, f64::NEG_INFINITY);
        Self { begin: time, stick_duration: 0.0, speed: none, pull: none, impulse: 0.0 }
    }

    fn add(&mut self, piece: &Piece, smooth: bool) {
        if piece.start.mode == Mode::Stuck || (smooth && piece.start.mode == Mode::Microslip) {
            self.stick_duration += piece.duration;
        }
        self.add_rest_of(piece, piece.time);
    }

    /// Take in `piece` from `time` on: its impulse, and the extremes at its ends and turning points.
    fn add_rest_of(&mut self, piece: &Piece, time: f64) {
        if piece.duration.is_infinite() {
            return;
        }
        let begin = time - piece.time;
        self.impulse += piece.impulse(begin);
        let turning = piece.turning_points().map(|t| t.filter(|t| *t >= begin));
        for elapsed in
            [Some(begin), Some(piece.duration), turning[0], turning[1]].into_iter().flatten()
        {
            let (belt_speed, pull) = piece.at(elapsed);
            self.speed = (self.speed.0.min(belt_speed), self.speed.1.max(belt_speed));
            self.pull = (self.pull.0.min(pull), self.pull.1.max(pull));
        }
    }

    fn cycle(
        &self,
        kind: CycleKind,
        end: f64,
        laps: usize,
        drive_speed: f64,
        stiffness: f64,
        steady: Option<f64>,
    ) -> StickSlipCycle {
        let duration = end - self.begin;
        let periodic = kind != CycleKind::SteadySliding && duration.is_finite() && duration > 0.0;
        let (speed, stretch) = match steady {
            Some(stretch) => ((drive_speed, drive_speed), (stretch, stretch)),
            None => (self.speed, (self.pull.0 / stiffness, self.pull.1 / stiffness)),
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
            // over a closed lap all work of the drive ends in drag
            drag_work: if periodic { drive_speed * self.impulse } else { 0.0 },
            laps,
        }
    }
}
