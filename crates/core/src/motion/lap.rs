//! One lap of a periodic motion: where it begins and ends, what happens on it, and where the laps are heading.

use super::event::{Event, Guard};
use super::piece::Piece;
use super::stick_slip_cycle::{CycleKind, StickSlipCycle};
use super::system::Drivetrain;
use crate::drag::{Closure, Drag, Mode};

/// State where a lap ends and the next begins.
#[derive(Debug, Clone, Copy)]
pub(super) struct Section {
    pub time: f64,
    pub stuck: bool,
    belt_speed: f64,
    pub pull: f64,
    /// Force of the bristles, if there are any.
    bristles: f64,
}

impl Section {
    pub(super) fn repeats(
        &self,
        previous: &Self,
        drag: &Drag,
        train: &Drivetrain,
        near: f64,
    ) -> bool {
        let speed_scale = drag.stick_speed().max(self.belt_speed.abs());
        let pull_scale = self.pull.abs().max(speed_scale * train.impedance());
        self.stuck == previous.stuck
            && (self.belt_speed - previous.belt_speed).abs() <= near * speed_scale
            && (self.pull - previous.pull).abs() <= near * pull_scale
            && (self.bristles - previous.bristles).abs() <= near * pull_scale
    }

    /// The same with what the bristles remember, after a lap during which the belt stuck, or did not.
    pub(super) fn with_memory(mut self, piece: &Piece, stuck: bool) -> Self {
        if let Closure::LuGre { bristle_stiffness, .. } = piece.flow.drag.closure() {
            let deflection = piece.state(self.time - piece.time)[2];
            self.bristles = bristle_stiffness * deflection * piece.start.direction;
        }
        self.stuck = stuck;
        self
    }
}

/// The last laps' pulls where the belt overtakes the drive, to shorten a long approach.
///
/// The map from one overtaking to the next has one variable and cannot swap two orbits, so every state
/// between here and where the laps are heading leads there too: part of the way can be skipped.
#[derive(Default)]
pub(super) struct Extrapolation {
    pulls: Vec<f64>,
}

impl Extrapolation {
    /// Laps looked at.
    const LAPS: usize = 4;
    /// Share of the way to the expected limit that is skipped.
    const SKIPPED: f64 = 0.7;
    /// Growth of a swing away from an unstable orbit that is skipped at once.
    const GROWTH: f64 = 1.2;
    /// Laps that shrink faster than this need no help.
    const SLOW: f64 = 0.8;

    /// A pull further along the way of the laps, if they are slow and steady enough to foresee.
    pub(super) fn ahead(&mut self, pull: f64, steady_pull: f64) -> Option<f64> {
        if self.pulls.len() == Self::LAPS {
            self.pulls.remove(0);
        }
        self.pulls.push(pull);
        let [a, b, c, d] = self.pulls[..] else { return None };
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
pub(super) fn release(event: Option<Event>, smooth: bool, train: &Drivetrain) -> Option<Section> {
    let released = |e: &Event| {
        (e.from == Mode::Stuck && e.to != Mode::Stuck)
            || (smooth && e.from == Mode::Microslip && e.guard == Guard::StickSpeed)
    };
    let Event { time, belt_speed, stretch, .. } = event.filter(released)?;
    let pull = train.stiffness() * stretch;
    Some(Section { time, stuck: true, belt_speed, pull, bristles: 0.0 })
}

/// The belt has come up to the drive that slipped on it.
pub(super) fn gripping_again(event: Option<Event>, train: &Drivetrain) -> Option<Section> {
    let Event { time, belt_speed, stretch, .. } =
        event.filter(|e| e.guard == Guard::GripRegained && e.from != Mode::Stuck)?;
    let pull = train.stiffness() * stretch;
    Some(Section { time, stuck: false, belt_speed, pull, bristles: 0.0 })
}

/// The same where the piece ends just there.
pub(super) fn at_drive_speed(piece: &Piece, drive_speed: f64) -> Section {
    let pull = piece.at(piece.duration).1;
    let time = piece.time + piece.duration;
    Section { time, stuck: false, belt_speed: drive_speed, pull, bristles: 0.0 }
}

/// The section of motion without sticking: the belt overtakes the drive.
pub(super) fn overtaking(piece: &Piece, drive_speed: f64) -> Option<Section> {
    let elapsed = piece.overtaking(drive_speed)?;
    let (belt_speed, pull) = piece.at(elapsed);
    let time = piece.time + elapsed;
    Some(Section { time, stuck: false, belt_speed, pull, bristles: 0.0 })
}

/// Extremes and durations of the lap under way.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lap {
    begin: f64,
    pub stick_duration: f64,
    /// Time during which the roll slips on the belt, what the pull does on the belt meanwhile, and its impulse.
    slipping: (f64, f64, f64),
    pub speed: (f64, f64),
    pull: (f64, f64),
    /// Integral of the pull over time.
    impulse: f64,
}

impl Lap {
    pub(super) fn starting_at(time: f64) -> Self {
        let none = (f64::INFINITY, f64::NEG_INFINITY);
        let (stick_duration, slipping, impulse) = (0.0, (0.0, 0.0, 0.0), 0.0);
        Self { begin: time, stick_duration, slipping, speed: none, pull: none, impulse }
    }

    /// Swing of the belt speed.
    pub(super) fn swing(&self) -> f64 {
        self.speed.1 - self.speed.0
    }

    pub(super) fn add(&mut self, piece: &Piece, smooth: bool) {
        if piece.start.mode == Mode::Stuck || (smooth && piece.start.mode == Mode::Microslip) {
            self.stick_duration += piece.duration;
        }
        self.add_rest_of(piece, piece.time);
    }

    /// Take in `piece` from `time` on: its impulse, and the extremes at its ends and turning points.
    pub(super) fn add_rest_of(&mut self, piece: &Piece, time: f64) {
        if piece.duration.is_infinite() {
            return;
        }
        let begin = time - piece.time;
        self.count(piece, begin, 1.0);
        let turning = piece.turning_points().map(|t| t.filter(|t| *t >= begin));
        for elapsed in
            [Some(begin), Some(piece.duration), turning[0], turning[1]].into_iter().flatten()
        {
            let (belt_speed, pull) = piece.at(elapsed);
            self.speed = (self.speed.0.min(belt_speed), self.speed.1.max(belt_speed));
            self.pull = (self.pull.0.min(pull), self.pull.1.max(pull));
        }
    }

    /// Leave out `piece`, its last, from `time` on. Its extremes stay: a closed orbit has passed there before.
    pub(super) fn leave_rest_of(&mut self, piece: &Piece, time: f64) {
        self.count(piece, time - piece.time, -1.0);
    }

    /// Add, or take off, what the pull does over `piece` from `begin` on.
    fn count(&mut self, piece: &Piece, begin: f64, sign: f64) {
        let impulse = sign * piece.impulse(begin);
        self.impulse += impulse;
        if piece.start.slipping {
            let force = piece.start.pull * piece.start.direction;
            self.slipping.0 += sign * (piece.duration - begin);
            self.slipping.1 += sign * (force * piece.way(begin));
            self.slipping.2 += impulse;
        }
    }

    /// This lap and the one after it, as one.
    pub(super) fn joined(self, next: &Self) -> Self {
        let widest = |a: (f64, f64), b: (f64, f64)| (a.0.min(b.0), a.1.max(b.1));
        let (a, b) = (self.slipping, next.slipping);
        Self {
            begin: self.begin,
            stick_duration: self.stick_duration + next.stick_duration,
            slipping: (a.0 + b.0, a.1 + b.1, a.2 + b.2),
            speed: widest(self.speed, next.speed),
            pull: widest(self.pull, next.pull),
            impulse: self.impulse + next.impulse,
        }
    }

    /// The lap as a cycle that ends at `end`.
    pub(super) fn cycle(
        &self,
        kind: CycleKind,
        end: f64,
        laps: usize,
        drive_speed: f64,
        stiffness: f64,
        laps_per_period: usize,
    ) -> StickSlipCycle {
        #[allow(clippy::cast_precision_loss)] // a few
        let share = 1.0 / laps_per_period as f64;
        let duration = share * (end - self.begin);
        let periodic = duration.is_finite() && duration > 0.0;
        StickSlipCycle {
            kind,
            frequency: if periodic { 1.0 / duration } else { 0.0 },
            slip_duration: if periodic { duration - share * self.stick_duration } else { 0.0 },
            stick_duration: if periodic { share * self.stick_duration } else { 0.0 },
            speed_min: self.speed.0,
            speed_max: self.speed.1,
            stretch_min: self.pull.0 / stiffness,
            stretch_max: self.pull.1 / stiffness,
            grip_slip_duration: if periodic { share * self.slipping.0 } else { 0.0 },
            // over a closed lap all work of the drive ends in drag, but for what the slipping roll takes
            drag_work: if periodic {
                share * (drive_speed * (self.impulse - self.slipping.2) + self.slipping.1)
            } else {
                0.0
            },
            laps_per_period,
            laps,
        }
    }
}
