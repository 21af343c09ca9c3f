//! What the motion settles to at a constant drive speed, found by detecting the periodic orbit.
//!
//! A lap runs from one crossing of a section to the next: the release from the stuck phase while the
//! belt sticks, otherwise the moment when belt speed rises through drive speed. The orbit has closed
//! once two laps in a row start at the same state.

use std::collections::VecDeque;

use super::event::Event;
use super::hybrid::Motion;
use super::lap::{
    Extrapolation, Lap, Section, at_drive_speed, gripping_again, overtaking, release,
};
use super::piece::{Phase, Piece};
use super::stick_slip_cycle::{CycleKind, StickSlipCycle};
use super::system::{Drivetrain, Integrator, Start, System};
use crate::drag::{Closure, Drag, Mode};
use crate::error::{Error, above};
use crate::work::Work;

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
/// Time within which the belt overtakes the drive once, in units of `sqrt(m/k)`.
const ONCE: f64 = 1e-6;
/// Laps after which a motion may repeat itself: one with memory, one that a static force catches after several swings, or
/// one so near to `V*` that rounding decides whether a lap sticks.
const MAX_PERIOD: usize = 16;
/// Swing of the belt speed, relative to the drive speed, below which it counts as steady.
pub(super) const STEADY: f64 = 1e-7;
/// Swing, relative to the drive speed, below which a lap on the falling branch is still growing out of rounding.
const GROWING: f64 = 1e-6;

/// Relative change of the swing from lap to lap from which it is another: where an orbit closes but for less than its
/// steps resolve, a small swing that dies out, or grows, comes back as near as one that stays.
const SAME_SWING: f64 = 1e-3;

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
    settle(train, drag, drive_speed, start, Span::UntilClosed, tolerance, &Work::default())
}

/// What the motion settles to, or its last whole lap, at constant `drive_speed` from `start`.
///
/// # Errors
/// As for [`stick_slip`], or if `work` ends before.
pub fn settle(
    train: &Drivetrain,
    drag: &Drag,
    drive_speed: f64,
    start: Start,
    span: Span,
    tolerance: f64,
    work: &Work,
) -> Result<StickSlipCycle, Error> {
    let until = match span {
        Span::UntilClosed => f64::INFINITY,
        Span::Lasting(duration) => above("duration", duration, 0.0)?,
    };
    let system = System::at_speed(*train, drag, drive_speed)?;
    let mut laps = Laps::starting(&system, drive_speed, start, until, tolerance, work)?;
    loop {
        if let Some(cycle) = laps.go_on()? {
            return Ok(cycle);
        }
    }
}

/// A motion followed lap by lap.
struct Laps<'a> {
    motion: Motion<'a>,
    train: &'a Drivetrain,
    drag: &'a Drag,
    drive_speed: f64,
    /// When the motion ends, if it is not followed until its orbit has closed.
    until: f64,
    smooth: bool,
    /// How far from the drive speed drag is sure to rise with speed; not positive where it falls.
    room: f64,
    /// Relative change between laps at which the orbit has closed.
    near: f64,
    most: usize,
    lap: Lap,
    /// Where the lap under way began, if it began at a section.
    previous: Option<Section>,
    /// Swing of the belt speed in the lap before.
    swing: f64,
    /// Whether the drag remembers, so that laps may repeat in groups; the laps before, each with its begin.
    memory: bool,
    past: VecDeque<(Section, Lap)>,
    /// Whether the lap under way, from overtaking to overtaking, is the one that sticks between some that do not.
    rounding_decides: bool,
    /// The last whole lap, of a motion that has an end.
    whole: Option<StickSlipCycle>,
    extrapolation: Extrapolation,
    /// Pieces since the last lap, and times that the belt overtook the drive.
    pieces: usize,
    overtakings: u32,
    /// When it did last: where the roll slipped until then, or on a corner of the law, that may show twice.
    overtaken: f64,
    count: usize,
}

impl<'a> Laps<'a> {
    fn starting(
        system: &'a System,
        drive_speed: f64,
        start: Start,
        until: f64,
        tolerance: f64,
        work: &'a Work<'a>,
    ) -> Result<Self, Error> {
        let smooth = system.drag.closure().is_smooth();
        let (near, most) =
            if smooth { (CLOSED_SMOOTH * tolerance, MAX_SMOOTH_LAPS) } else { (CLOSED, MAX_LAPS) };
        // bristles remember: their force lags behind the speed, and can feed a swing
        let memory = system.drag.closure().has_memory();
        let room = if memory { 0.0 } else { system.drag.rises_about(drive_speed.abs()) };
        Ok(Self {
            motion: Motion::new(system, start, tolerance, Integrator::Adaptive, work)?,
            train: &system.train,
            drag: &system.drag,
            drive_speed,
            until,
            smooth,
            room,
            near,
            most,
            lap: Lap::starting_at(0.0),
            previous: None,
            swing: f64::NAN,
            memory,
            past: VecDeque::new(),
            rounding_decides: false,
            whole: None,
            extrapolation: Extrapolation::default(),
            pieces: 0,
            overtakings: 0,
            overtaken: f64::NEG_INFINITY,
            count: 0,
        })
    }

    /// One piece further; the cycle, once it is known.
    fn go_on(&mut self) -> Result<Option<StickSlipCycle>, Error> {
        let now = self.motion.time();
        if now >= self.until {
            return Ok(self.whole.or_else(|| Some(self.cycle(CycleKind::Unsettled, now))));
        }
        let mut piece = self.motion.no_piece();
        let event = self.motion.advance(self.until - now, &mut piece)?;
        self.lap.add(&piece, self.smooth);
        self.pieces += 1;
        if let Some(end) = self.end_without_lap(&piece, event.is_none()) {
            return Ok(Some(end));
        }
        let Some(section) = self.section(event, &piece) else { return Ok(None) };
        (self.pieces, self.overtakings) = (0, 0);
        if self.memory || !section.stuck {
            self.lap.leave_rest_of(&piece, section.time);
        }
        self.count += 1;
        if self.until.is_finite() {
            self.keep_whole(&section);
            self.begin_lap(section, &piece);
            return Ok(None);
        }
        if self.rounding_decides {
            return Ok(Some(self.cycle(CycleKind::StickSlip, section.time)));
        }
        if let Some(kind) = self.verdict(&section) {
            return Ok(Some(self.cycle(kind, section.time)));
        }
        if let Some(period) = self.closed_period(&section) {
            return Ok(Some(period));
        }
        if !self.rounding_decides && !self.skip_ahead(&section) {
            self.begin_lap(section, &piece);
        }
        Ok(None)
    }

    /// What the motion is if it slides steadily from this piece on, or makes no laps at all.
    fn end_without_lap(&self, piece: &Piece, uneventful: bool) -> Option<StickSlipCycle> {
        // nothing ends a stall but an event; that of a motion that is not followed for ever is cut off
        let held = piece.start.mode == Mode::Stuck && uneventful;
        let endless = piece.duration.is_infinite() || held;
        if piece.start.slipping && (endless || has_come_to_slip(piece)) {
            let (belt_speed, pull) = piece.at(0.0);
            let stretch = pull / self.train.stiffness();
            let stuck = matches!(piece.start.mode, Mode::Stuck | Mode::Microslip);
            return Some(StickSlipCycle::slipping(belt_speed, stuck, stretch, self.count));
        }
        let still = piece.duration.is_infinite()
            || is_steady(&piece.start, self.train, self.drag, self.drive_speed, self.room);
        if still {
            let stretch = steady_stretch(piece, self.train, self.drag, self.drive_speed);
            return Some(StickSlipCycle::steady(self.drive_speed, stretch, self.count));
        }
        let lost = self.pieces > MAX_PIECES_PER_LAP;
        lost.then(|| self.cycle(CycleKind::Unsettled, self.motion.time()))
    }

    /// The section at which the lap ends with this piece, if it does.
    fn section(&mut self, event: Option<Event>, piece: &Piece) -> Option<Section> {
        if self.memory {
            // bristles swing below the stick speed, and leave it many times a lap
            let found = self.overtaking(piece)?;
            return Some(found.with_memory(piece, self.lap.stick_duration > 0.0));
        }
        let found = release(event, self.smooth, self.train)
            .or_else(|| self.overtaking(piece))
            .or_else(|| gripping_again(event, self.train))
            .filter(|s| s.stuck || s.time - self.overtaken > ONCE * self.train.time_scale());
        if let Some(section) = found.filter(|s| !s.stuck) {
            self.overtaken = section.time;
        }
        if self.rounding_decides {
            return found.filter(|s| !s.stuck);
        }
        let section = found.filter(|s| s.stuck || self.lap.stick_duration == 0.0)?;
        // every slip after a release overtakes the drive once; a second time means that it did not stick
        self.overtakings += u32::from(!section.stuck);
        let within_slip = !section.stuck && self.overtakings < 2;
        (!within_slip || self.previous.is_none_or(|p| !p.stuck)).then_some(section)
    }

    /// Where the belt overtakes the drive, be it on a corner of the law, where the piece ends.
    #[allow(clippy::float_cmp)] // a corner is met by assigning its speed
    fn overtaking(&self, piece: &Piece) -> Option<Section> {
        overtaking(piece, self.drive_speed).or_else(|| {
            let (Phase { direction, speed, .. }, before) = (self.motion.phase(), piece.start);
            let met = direction * speed == self.drive_speed
                && before.mode != Mode::Stuck
                && before.speed < *speed;
            met.then(|| at_drive_speed(piece, self.drive_speed))
        })
    }

    /// Keep the lap that ends here as the last whole one, if it began at the same kind of section.
    fn keep_whole(&mut self, section: &Section) {
        let kind = if section.stuck { CycleKind::StickSlip } else { CycleKind::Oscillation };
        if self.previous.is_some_and(|p| p.stuck == section.stuck) {
            self.whole = Some(self.cycle(kind, section.time));
        }
    }

    /// What the motion is if its orbit has closed with this lap, or will not.
    fn verdict(&self, section: &Section) -> Option<CycleKind> {
        let swing = self.lap.swing();
        let stays = (swing - self.swing).abs() <= SAME_SWING * swing;
        let grown = section.stuck || (stays && swing > GROWING * self.drive_speed.abs());
        let repeats = |p: Section| section.repeats(&p, self.drag, self.train, self.near);
        let closed = grown && self.previous.is_some_and(repeats);
        match (closed, section.stuck) {
            (false, _) => (self.count >= self.most).then_some(CycleKind::Unsettled),
            (true, true) => Some(CycleKind::StickSlip),
            (true, false) => Some(CycleKind::Oscillation),
        }
    }

    /// The motion as one that repeats itself with this lap after several, if it does.
    fn closed_period(&mut self, section: &Section) -> Option<StickSlipCycle> {
        self.past.push_front((self.previous?, self.lap));
        self.past.truncate(MAX_PERIOD);
        if !(self.memory || section.stuck) {
            return None;
        }
        let repeats = |p: &Section| section.repeats(p, self.drag, self.train, self.near);
        let laps = 1 + self.past.iter().position(|(begin, _)| repeats(begin)).filter(|i| *i > 0)?;
        // a static force that grows at rest releases a belt at a greater pull than that at which it catches one
        if !self.memory && self.drag.strengthening().is_none() {
            // it moves in a plane: a lap from the release that does not stick never sticks later, but for rounding
            self.rounding_decides = true;
            return None;
        }
        let group = self.past.iter().take(laps).map(|(_, lap)| *lap).rev();
        let joined = group.reduce(|all, next| all.joined(&next))?;
        if joined.swing() <= GROWING * self.drive_speed.abs() {
            return None;
        }
        let kind =
            if joined.stick_duration > 0.0 { CycleKind::StickSlip } else { CycleKind::Oscillation };
        let stiffness = self.train.stiffness();
        Some(joined.cycle(kind, section.time, self.count, self.drive_speed, stiffness, laps))
    }

    /// Pass over laps that can be foreseen, if they can.
    fn skip_ahead(&mut self, section: &Section) -> bool {
        if section.stuck {
            self.extrapolation = Extrapolation::default();
            return false;
        }
        let steady_pull = self.drag.force(self.drive_speed);
        let Some(pull) = self.extrapolation.ahead(section.pull, steady_pull) else { return false };
        self.motion.resume(section.time, self.drive_speed, pull);
        (self.previous, self.lap) = (None, Lap::starting_at(section.time));
        self.past.clear();
        true
    }

    /// The next lap, with the rest of the piece in which the last one ended.
    fn begin_lap(&mut self, section: Section, piece: &Piece) {
        (self.previous, self.swing) = (Some(section), self.lap.swing());
        self.lap = Lap::starting_at(section.time);
        self.lap.add_rest_of(piece, section.time);
    }

    /// The lap under way as a cycle that ends at `end`.
    fn cycle(&self, kind: CycleKind, end: f64) -> StickSlipCycle {
        self.lap.cycle(kind, end, self.count, self.drive_speed, self.train.stiffness(), 1)
    }
}

/// Whether the belt slides with the drive for good.
///
/// On a rising branch the energy of the deviation, `m (u - v)^2/2 + k (s - s*)^2/2`, falls at the rate
/// `(F(u) - F(v)) (u - v) >= 0`; once it is too small to carry the belt down to the transition speed, the belt
/// never leaves the branch again and the deviation dies out.
///
/// The same holds within `room` about the drive speed: the drag of a table may rise, or fall by less than that of the rest
/// of the drive rises, between points where it falls.
fn is_steady(phase: &Phase, train: &Drivetrain, drag: &Drag, drive_speed: f64, room: f64) -> bool {
    let away = (phase.direction * phase.speed - drive_speed).abs();
    if phase.creeping {
        return away <= STEADY * drag.stick_speed();
    }
    if room <= STEADY * drive_speed.abs() || away >= room {
        return swing_that_dies_out(phase, train, drag, drive_speed).is_some();
    }
    let steady_pull = drag.force(drive_speed);
    let energy = swing_energy(phase, train, drive_speed, steady_pull);
    let stays = energy < train.mass() * room * room && steady_pull.abs() <= train.grip();
    stays || swing_that_dies_out(phase, train, drag, drive_speed).is_some()
}

/// Twice the energy of the deviation from steady sliding, in which the spring pulls so.
fn swing_energy(phase: &Phase, train: &Drivetrain, drive_speed: f64, steady_pull: f64) -> f64 {
    let (belt_speed, pull) = (phase.direction * phase.speed, phase.direction * phase.pull);
    let off = pull - steady_pull;
    train.mass() * (belt_speed - drive_speed).powi(2) + off * off / train.stiffness()
}

/// The most that the spring will ever pull on a belt that slides with the drive for good, by that energy; none if it may not.
pub(super) fn swing_that_dies_out(
    phase: &Phase,
    train: &Drivetrain,
    drag: &Drag,
    drive_speed: f64,
) -> Option<f64> {
    // only the rest of the drive makes drag rise below the transition
    if phase.mode != Mode::Ehl && drag.rest().damping == 0.0 {
        return None;
    }
    let (speed, foot) = (drive_speed.abs(), drag.rising_from());
    // bristles remember: their force lags behind the speed, and can feed a swing
    let memory = drag.closure().has_memory();
    let rising = speed >= foot && !memory;
    let margin = speed - if rising { foot } else { drag.transition_speed() };
    let above = phase.mode == Mode::Ehl || (rising && phase.speed.abs() > foot);
    if !above || margin < 0.0 {
        return None;
    }
    let reach = if rising { margin.max(STEADY * speed) } else { STEADY * speed };
    let steady_pull = drag.force(drive_speed);
    let energy = swing_energy(phase, train, drive_speed, steady_pull);
    let dies = energy < train.mass() * reach * reach && steady_pull.abs() <= train.grip();
    dies.then(|| steady_pull.abs() + (train.stiffness() * energy).sqrt())
}

/// Whether a belt on which the roll slips has come to the speed at which drag is what the grip bears, for good.
fn has_come_to_slip(piece: &Piece) -> bool {
    let Phase { pull, speed, mode, .. } = piece.start;
    let drag = piece.flow.drag;
    if drag.closure().has_memory() && mode == Mode::Microslip {
        // bristles bear what the grip does, and creep no more
        let Closure::LuGre { bristle_stiffness, .. } = drag.closure() else { return false };
        let borne = (bristle_stiffness * piece.start.bristle - pull).abs() <= STEADY * pull.abs();
        return borne && speed <= STEADY * drag.stick_speed();
    }
    let slope = drag.slope(speed);
    mode != Mode::Stuck && slope > 0.0 && (pull - drag.force(speed)).abs() <= STEADY * slope * speed
}

/// Spring stretch of steady motion at the drive speed.
fn steady_stretch(piece: &Piece, train: &Drivetrain, drag: &Drag, drive_speed: f64) -> f64 {
    let settling = piece.start.mode == Mode::Mixed && piece.duration.is_finite();
    if piece.start.mode == Mode::Ehl || settling {
        drag.force(drive_speed) / train.stiffness()
    } else {
        piece.at(0.0).1 / train.stiffness()
    }
}
