//! The motion as a chain of pieces: in each the equation is smooth, between them lies a located event.
//!
//! The belt is followed in the direction it moves: `direction` is the sign of the belt speed and every
//! other quantity is mirrored with it, so that speed `u >= 0` here and one set of guards serves both.

use super::polynomial::{self, ORDER, Polynomial, first_crossing, subtracted_from};
use super::taylor::{Series, SlipDrag, creep_series, slip_series};
use super::{Drivetrain, Start};
use crate::drag::{Drag, Mode};
use crate::error::Error;

/// Longest step in units of `sqrt(m/k)`, about half a period of the free oscillation.
const LONGEST_STEP: f64 = 3.0;

/// Steps after which a motion is given up as too long, some seconds of work.
const MAX_STEPS: usize = 5_000_000;

/// Events without any time passing before the motion is given up as endless switching.
const MAX_EVENTS_AT_ONCE: u32 = 32;

/// Deviation from steady sliding at the transition speed itself, relative, that is lost in rounding.
const ROUNDING: f64 = 1e-12;

/// The condition whose crossing ends a mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Guard {
    /// Belt speed passes the transition speed `v_t`.
    TransitionSpeed,
    /// Belt speed passes the stick speed `v_s`.
    StickSpeed,
    /// Spring force passes the force that drag can hold (Eqs. 25-26).
    HoldingForce,
    /// Belt speed passes zero.
    Reversal,
}

impl Guard {
    /// Name of the guard as documents print it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::TransitionSpeed => "transition_speed",
            Self::StickSpeed => "stick_speed",
            Self::HoldingForce => "holding_force",
            Self::Reversal => "reversal",
        }
    }
}

/// A change of mode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// When it happens.
    pub time: f64,
    /// Mode before.
    pub from: Mode,
    /// Mode after.
    pub to: Mode,
    /// The condition that was crossed.
    pub guard: Guard,
    /// Spring stretch at the event.
    pub stretch: f64,
    /// Belt speed at the event.
    pub belt_speed: f64,
}

/// A moment of the motion, mirrored so that `speed >= 0`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Phase {
    pub mode: Mode,
    /// The motion has just left the stuck phase: spring force and drag are equal.
    pub released: bool,
    /// In microslip: the spring pulls back with just the holding force (see `creep_series`).
    pub creeping: bool,
    pub direction: f64,
    pub stretch: f64,
    pub speed: f64,
}

/// A stretch of smooth motion from `time` on, `duration` long.
#[derive(Debug)]
pub(super) struct Piece {
    pub time: f64,
    pub duration: f64,
    pub start: Phase,
    pub stretch: Polynomial,
    pub speed: Polynomial,
}

impl Piece {
    /// (belt speed, stretch) at `elapsed` time since the start of the piece, signed.
    pub(super) fn at(&self, elapsed: f64) -> (f64, f64) {
        (
            self.start.direction * polynomial::value(&self.speed, elapsed),
            self.start.direction * polynomial::value(&self.stretch, elapsed),
        )
    }
}

/// The motion at constant drive speed, from one piece to the next.
pub(super) struct Motion<'a> {
    train: &'a Drivetrain,
    drag: &'a Drag,
    drive_speed: f64,
    tolerance: f64,
    time: f64,
    phase: Phase,
    events_at_once: u32,
    steps: usize,
}

impl<'a> Motion<'a> {
    pub(super) fn new(
        train: &'a Drivetrain,
        drag: &'a Drag,
        drive_speed: f64,
        start: Start,
        tolerance: f64,
    ) -> Self {
        let toward = if start.belt_speed == 0.0 { start.stretch } else { start.belt_speed };
        let direction = if toward < 0.0 { -1.0 } else { 1.0 };
        let phase = Phase {
            mode: Mode::Stuck,
            released: false,
            creeping: false,
            direction,
            stretch: direction * start.stretch,
            speed: direction * start.belt_speed,
        };
        let mut motion = Self {
            train,
            drag,
            drive_speed,
            tolerance,
            time: 0.0,
            phase,
            events_at_once: 0,
            steps: 0,
        };
        motion.phase.mode = motion.mode_at_start();
        motion
    }

    pub(super) fn time(&self) -> f64 {
        self.time
    }

    /// The next piece, no longer than `longest`, and the event that ends it, if one does.
    pub(super) fn advance(&mut self, longest: f64) -> Result<(Piece, Option<Event>), Error> {
        self.steps += 1;
        if self.steps > MAX_STEPS {
            return Err(Error::TooLong { steps: MAX_STEPS, time: self.time });
        }
        let (mut piece, crossing) = match self.phase.mode {
            Mode::Stuck => self.stuck_piece(longest),
            _ => self.slip_piece(longest),
        };
        let Some((elapsed, guard)) = crossing else {
            self.phase.stretch = polynomial::value(&piece.stretch, piece.duration);
            self.phase.speed = polynomial::value(&piece.speed, piece.duration);
            self.phase.released = false;
            self.time += piece.duration;
            return Ok((piece, None));
        };
        piece.duration = elapsed;
        let before = self.time;
        self.time += elapsed;
        self.phase.stretch = polynomial::value(&piece.stretch, elapsed);
        self.phase.speed = polynomial::value(&piece.speed, elapsed);
        let from = self.phase.mode;
        self.cross(guard);
        self.events_at_once = if self.time > before { 0 } else { self.events_at_once + 1 };
        if self.events_at_once > MAX_EVENTS_AT_ONCE {
            return Err(Error::Chattering { guard: guard.name(), time: self.time });
        }
        let Phase { mode: to, direction, stretch, speed, .. } = self.phase;
        let event = Event {
            time: self.time,
            from,
            to,
            guard,
            stretch: direction * stretch,
            belt_speed: direction * speed,
        };
        Ok((piece, Some(event)))
    }

    /// Drive speed in the mirrored direction.
    fn drive(&self) -> f64 {
        self.phase.direction * self.drive_speed
    }

    fn mode_at_start(&self) -> Mode {
        let Phase { stretch, speed, .. } = self.phase;
        let (v_t, v_s) = (self.drag.transition_speed(), self.drag.stick_speed());
        if speed > v_t {
            return Mode::Ehl;
        }
        if speed < v_s {
            let held = self.spring_force(stretch).abs() <= self.drag.holding_force(speed);
            return if held { Mode::Stuck } else { Mode::Microslip };
        }
        let net_force = self.spring_force(stretch) - self.drag.power_law(speed);
        // on a boundary the motion itself says which side it belongs to: m u' and, where that is nil, u''
        let rising = net_force > 0.0 || (net_force == 0.0 && self.drive() >= speed);
        match (rising, speed >= v_t, speed > v_s) {
            (true, true, _) => Mode::Ehl,
            (true, false, _) | (false, _, true) => Mode::Mixed,
            (false, _, false) => self.mode_below_stick_speed(),
        }
    }

    fn mode_below_stick_speed(&self) -> Mode {
        let holding = self.drag.holding_force(self.drag.stick_speed());
        if self.spring_force(self.phase.stretch).abs() <= holding {
            Mode::Stuck
        } else {
            Mode::Microslip
        }
    }

    fn spring_force(&self, stretch: f64) -> f64 {
        self.train.stiffness() * stretch
    }

    /// Enter the mode behind `guard`, on it exactly.
    fn cross(&mut self, guard: Guard) {
        let crept = self.phase.creeping;
        (self.phase.released, self.phase.creeping) = (false, false);
        self.phase.mode = match (guard, self.phase.mode) {
            (Guard::TransitionSpeed, from) => {
                self.phase.speed = self.drag.transition_speed();
                if from == Mode::Ehl { Mode::Mixed } else { Mode::Ehl }
            }
            (Guard::StickSpeed, from) => {
                self.phase.speed = self.drag.stick_speed();
                if from == Mode::Mixed { self.mode_below_stick_speed() } else { Mode::Mixed }
            }
            (Guard::HoldingForce, Mode::Stuck) => self.released(),
            (Guard::HoldingForce, _) => Mode::Stuck,
            (Guard::Reversal, _) => {
                self.phase.speed = 0.0;
                if crept {
                    self.released()
                } else {
                    self.mirror();
                    Mode::Microslip
                }
            }
        };
    }

    /// Leave the stuck phase with the spring force exactly at the holding force.
    fn released(&mut self) -> Mode {
        let pull = self.drag.holding_force(self.phase.speed) / self.train.stiffness();
        self.phase.stretch = pull.copysign(self.phase.stretch);
        let forward = self.phase.stretch > 0.0;
        if self.phase.speed == 0.0 && !forward {
            self.mirror();
        }
        self.phase.creeping = self.phase.speed > 0.0 && !forward;
        self.phase.released = !self.phase.creeping;
        if forward && self.phase.speed >= self.drag.stick_speed() {
            Mode::Mixed
        } else {
            Mode::Microslip
        }
    }

    fn mirror(&mut self) {
        self.phase.direction = -self.phase.direction;
        self.phase.stretch = -self.phase.stretch;
    }

    /// The belt keeps its speed while the spring stretches: closed form.
    fn stuck_piece(&self, longest: f64) -> (Piece, Option<(f64, Guard)>) {
        let Phase { stretch, speed, .. } = self.phase;
        let rate = self.drive() - speed;
        let limit = self.drag.holding_force(speed) / self.train.stiffness();
        let release = if rate == 0.0 {
            f64::INFINITY
        } else {
            ((limit.copysign(rate) - stretch) / rate).max(0.0)
        };
        let mut piece = self.steady_piece(release.min(longest));
        piece.stretch[1] = rate;
        (piece, (release <= longest).then_some((release, Guard::HoldingForce)))
    }

    /// Whether the belt rests on the corner of the drag law, where rounding would switch modes for ever.
    fn on_the_corner(&self) -> bool {
        let Phase { mode, stretch, speed, .. } = self.phase;
        let v_t = self.drag.transition_speed();
        let force = self.drag.power_law(v_t);
        mode != Mode::Microslip
            && (self.drive() - v_t).abs() <= ROUNDING * v_t
            && (speed - v_t).abs() <= ROUNDING * v_t
            && (self.spring_force(stretch) - force).abs() <= ROUNDING * force
    }

    fn steady_piece(&self, duration: f64) -> Piece {
        let (mut y, mut u) = ([0.0; ORDER + 1], [0.0; ORDER + 1]);
        (y[0], u[0]) = (self.phase.stretch, self.phase.speed);
        Piece { time: self.time, duration, start: self.phase, stretch: y, speed: u }
    }

    fn slip_piece(&self, longest: f64) -> (Piece, Option<(f64, Guard)>) {
        if self.on_the_corner() {
            return (self.steady_piece(longest), None);
        }
        let Phase { stretch, speed, .. } = self.phase;
        let series = self.series();
        let speed_scale = speed.max(self.drag.stick_speed());
        let stretch_scale = stretch.abs().max(speed_scale * self.train.time_scale());
        let duration = series
            .step_size(self.tolerance, stretch_scale, speed_scale)
            .min(LONGEST_STEP * self.train.time_scale())
            .min(longest);
        let crossing = self.first_guard(&series, duration);
        let piece = Piece {
            time: self.time,
            duration,
            start: self.phase,
            stretch: series.stretch,
            speed: series.speed,
        };
        (piece, crossing)
    }

    fn series(&self) -> Series {
        let Phase { mode, creeping, stretch, speed, .. } = self.phase;
        let (k, m) = (self.train.stiffness(), self.train.mass());
        let v_s = self.drag.stick_speed();
        if creeping {
            return creep_series(self.drive(), v_s, stretch, speed);
        }
        let force = match mode {
            _ if self.phase.released => self.spring_force(stretch),
            Mode::Microslip => self.drag.holding_force(speed),
            _ => self.drag.power_law(speed),
        };
        let law = if mode == Mode::Microslip {
            SlipDrag::Exponential { force, speed: v_s }
        } else {
            SlipDrag::Power { force, exponent: self.drag.force_exponent(mode) }
        };
        slip_series(k, m, self.drive(), law, stretch, speed)
    }

    /// The guard that the step crosses first, if it crosses any.
    fn first_guard(&self, series: &Series, duration: f64) -> Option<(f64, Guard)> {
        let (v_t, v_s) = (self.drag.transition_speed(), self.drag.stick_speed());
        let above = |limit: f64| subtracted_from(limit, &series.speed).map(|c| -c);
        let below = |limit: f64| subtracted_from(limit, &series.speed);
        let guards: &[(Polynomial, Guard)] = match self.phase.mode {
            Mode::Ehl => &[(above(v_t), Guard::TransitionSpeed)],
            Mode::Mixed => &[(below(v_t), Guard::TransitionSpeed), (above(v_s), Guard::StickSpeed)],
            Mode::Microslip if self.phase.creeping => &[(above(0.0), Guard::Reversal)],
            Mode::Microslip => &[
                (below(v_s), Guard::StickSpeed),
                (self.excess_force(series), Guard::HoldingForce),
                (above(0.0), Guard::Reversal),
            ],
            Mode::Stuck => &[],
        };
        guards
            .iter()
            .filter_map(|(g, guard)| Some((first_crossing(g, duration)?, *guard)))
            .min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// `|k s| - A exp(-u/v_s)`: what the spring pulls beyond the holding force.
    fn excess_force(&self, series: &Series) -> Polynomial {
        let pull = self.train.stiffness() * self.phase.stretch.signum();
        let mut excess = [0.0; ORDER + 1];
        for (e, (y, f)) in excess.iter_mut().zip(series.stretch.iter().zip(&series.drag)) {
            *e = pull * y - f;
        }
        excess
    }
}
