//! The motion as a chain of pieces: in each the equation is smooth, between them lies a located event.
//!
//! The belt is followed in the direction it moves: `direction` is the sign of the belt speed and every
//! other quantity is mirrored with it, so that speed `u >= 0` here and one set of guards serves both.

use super::event::{Event, Guard};
use super::moment::Moment;
use super::piece::{Path, Phase, Piece};
use super::polynomial::{ORDER, Polynomial, derivative, first_crossing, value};
use super::schedule::Cubic;
use super::surroundings::{Jump, Surroundings};
use super::system::{Integrator, Start, System, checked_tolerance};
use super::taylor::rough_root;
use crate::drag::Mode;
use crate::error::{Error, above};
use crate::work::Work;

/// Rounds in which a piece and its temperature are made anew.
const MAX_ROUNDS: usize = 40;
/// Relative change of the temperatures between rounds, from which they are the same.
const SAME_TEMPERATURE: f64 = 1e-14;

/// How far beyond a temperature the law is looked at, so that it need not be at each.
const BEYOND: f64 = 1.0;

/// Events without any time passing before the motion is given up as endless switching.
const MAX_EVENTS_AT_ONCE: u32 = 32;

/// Share of the time reached and of the time scale of the belt that is next to no time, and pieces as short as that, one
/// after the other, before the motion is given up.
const NO_TIME: f64 = 1e-14;
const MAX_CRAWLED: u32 = 1000;

/// Pull and speed with which a belt that starts below the stick speed first slides faster, if it does.
pub(crate) fn first_slide(
    system: &System,
    start: Start,
    tolerance: f64,
    work: &Work,
) -> Option<(f64, f64)> {
    let mut motion = Motion::new(system, start, tolerance, Integrator::Adaptive, work).ok()?;
    let mut piece = motion.no_piece();
    for _ in 0..1000 {
        let phase = motion.phase();
        if matches!(phase.mode, Mode::Ehl | Mode::Mixed) && phase.direction > 0.0 {
            return Some((phase.pull, phase.speed));
        }
        motion.advance(f64::INFINITY, &mut piece).ok()?;
    }
    None
}

/// When a piece meets a guard, in time since its start.
pub(super) type Met = (f64, Guard);

/// The motion, from one piece to the next.
pub(super) struct Motion<'a> {
    pub now: Surroundings<'a>,
    pub tolerance: f64,
    pub integrator: Integrator,
    pub arch: pulp::Arch,
    pub phase: Phase,
    /// Length that the next Runge-Kutta step should have.
    pub next_step: f64,
    events_at_once: u32,
    /// Pieces in a row in which next to no time passed, and the unit of time of the belt.
    crawled: u32,
    unit: f64,
    /// Least and greatest temperature at which the law is known to be one.
    pub checked: Option<(f64, f64)>,
    /// Whether the last piece ended for its accuracy only: the next one begins with its law, where it ended.
    pub goes_on: bool,
    /// Pieces made.
    pub steps: usize,
    pub work: &'a Work<'a>,
    /// Kinetic energy lost by stopping dead.
    pub stopped: f64,
    /// Temperatures along the last piece, if they are states.
    pub temperatures: [Polynomial; 2],
}

impl<'a> Motion<'a> {
    pub(super) fn new(
        system: &'a System,
        start: Start,
        tolerance: f64,
        integrator: Integrator,
        work: &'a Work<'a>,
    ) -> Result<Self, Error> {
        let mut motion = Self {
            phase: phase_at(start, system.pull(start)?),
            ..Self::blank(system, tolerance, integrator, work)?
        };
        motion.bend_bristles();
        motion.take_grip();
        motion.enter_mode_at_start();
        Ok(motion)
    }

    /// A motion that has not begun.
    fn blank(
        system: &'a System,
        tolerance: f64,
        integrator: Integrator,
        work: &'a Work<'a>,
    ) -> Result<Self, Error> {
        Ok(Self {
            phase: phase_at(Start::REST, 0.0),
            tolerance: checked_tolerance(tolerance)?,
            integrator,
            arch: pulp::Arch::new(),
            now: Surroundings::at_start(system)?,
            checked: None,
            next_step: f64::INFINITY,
            events_at_once: 0,
            crawled: 0,
            unit: Some(system.train.time_scale()).filter(|unit| unit.is_finite()).unwrap_or(0.0),
            goes_on: false,
            steps: 0,
            work,
            stopped: 0.0,
            temperatures: [[0.0; ORDER + 1]; 2],
        })
    }

    /// Go on from `moment`, in its mode.
    ///
    /// # Errors
    /// If the law of drag has ended there.
    pub(super) fn at(
        system: &'a System,
        moment: &Moment,
        tolerance: f64,
        integrator: Integrator,
        work: &'a Work<'a>,
    ) -> Result<Self, Error> {
        Ok(Self {
            now: Surroundings::at(system, moment.start, moment.segments)?,
            phase: moment.phase,
            next_step: moment.next_step,
            events_at_once: moment.events_at_once,
            crawled: moment.crawled,
            ..Self::blank(system, tolerance, integrator, work)?
        })
    }

    /// What is needed to go on from here; drive and temperature are those of the system.
    pub(super) fn moment(&self) -> Moment {
        Moment {
            phase: self.phase,
            start: self.now.time,
            time: self.now.time,
            segments: self.now.segments(),
            next_step: self.next_step,
            events_at_once: self.events_at_once,
            crawled: self.crawled,
            drive: None,
            temperature: None,
        }
    }

    /// Go on from another state.
    pub(super) fn resume(&mut self, time: f64, belt_speed: f64, pull: f64) {
        self.now.time = time;
        let direction = if belt_speed < 0.0 { -1.0 } else { 1.0 };
        (self.phase.direction, self.phase.released, self.phase.creeping) =
            (direction, false, false);
        (self.phase.speed, self.phase.pull) = (direction * belt_speed, direction * pull);
        self.next_step = f64::INFINITY;
        self.bend_bristles();
        self.take_grip();
        (self.phase.at_rest_since, self.phase.strength) = (time, 1.0);
        self.enter_mode_at_start();
    }

    pub(super) fn phase(&self) -> &Phase {
        &self.phase
    }

    pub(super) fn time(&self) -> f64 {
        self.now.time
    }

    /// Make the next `piece`, no longer than `longest`, and go on to its end; the event that ends it, if one does.
    ///
    /// A piece is large, so that it is made where it is wanted.
    pub(super) fn advance(
        &mut self,
        longest: f64,
        piece: &mut Piece<'a>,
    ) -> Result<Option<Event>, Error> {
        let guard = self.look_ahead(longest, piece)?;
        self.follow(piece, guard)
    }

    /// Make the next `piece`, no longer than `longest`; when it meets a guard, if it does.
    #[inline]
    pub(super) fn look_ahead(
        &mut self,
        longest: f64,
        piece: &mut Piece<'a>,
    ) -> Result<Option<Met>, Error> {
        self.steps += 1;
        self.work.take(1).map_err(|error| error.at_time(self.now.time))?;
        self.now.take_temperature()?;
        if self.phase.creeping {
            self.creep_on();
        }
        let longest = longest.min(self.now.until_change());
        if self.now.heat.is_some() {
            self.warmed_piece(longest, piece)?;
        } else if self.now.system.is_open {
            self.piece_within_law(longest, piece)?;
        } else {
            self.piece(longest, piece)?;
        }
        Ok(self.first_guard(piece))
    }

    /// To the end of the piece, which is where it meets a guard, and into what follows.
    #[inline]
    pub(super) fn follow(
        &mut self,
        piece: &mut Piece,
        guard: Option<Met>,
    ) -> Result<Option<Event>, Error> {
        let Some((elapsed, guard)) = guard else {
            if piece.duration < self.now.until_change() {
                self.check_progress(piece.duration)?;
            }
            return self.go_on(piece);
        };
        piece.duration = elapsed;
        self.check_progress(elapsed)?;
        self.meet(guard, piece)
    }

    /// Refuse to go on in pieces that lead nowhere, one after the other.
    #[inline]
    fn check_progress(&mut self, duration: f64) -> Result<(), Error> {
        if duration > NO_TIME * (self.now.time + self.unit) {
            self.crawled = 0;
            return Ok(());
        }
        self.crawled += 1;
        if self.crawled > MAX_CRAWLED { Err(self.stalled()) } else { Ok(()) }
    }

    /// Why the motion cannot go on: the law of drag is about to end, or numbers do.
    #[cold]
    pub(super) fn stalled(&self) -> Error {
        let near = self.now.temperature_law().and_then(|(course, _)| {
            let ahead = course[0] + BEYOND * course[1].signum();
            self.now.system.check_law_at(ahead).err()
        });
        near.unwrap_or(Error::Stalled { time: self.now.time })
    }

    /// The next piece at the temperature that its own friction makes: made anew until it is.
    #[cold]
    fn warmed_piece(&mut self, mut longest: f64, piece: &mut Piece<'a>) -> Result<(), Error> {
        let (step, tolerance) = (self.next_step, self.tolerance);
        for _ in 0..MAX_ROUNDS {
            self.next_step = step;
            self.piece(longest, piece)?;
            let power = piece.power_of_contact(&self.now.rest_course());
            let time = self.now.time;
            let Some(heat) = &mut self.now.heat else { return Ok(()) };
            let (warming, until) = heat.heating_part(&power, piece.duration);
            // power that ends with the motion must not end the piece just before the belt turns, again and again
            let until = until.max(NO_TIME * (time + self.unit));
            let assumed = heat.courses; // those to come take their slope already
            // steps follow a cubic
            let terms = if matches!(piece.path, Path::Steps { .. }) { 4 } else { ORDER };
            let (courses, good) = heat.foreseen(time, &warming, terms, tolerance);
            let good = good.min(until);
            if piece.duration > good {
                (piece.duration, longest) = (good, good);
            }
            let moved = |i: usize| {
                let (new, old) = (&courses[i], &assumed[i]);
                (value(new, piece.duration) - value(old, piece.duration)).abs() / new[0]
            };
            let off = if piece.duration.is_finite() { moved(0).max(moved(1)) } else { 0.0 };
            heat.courses = courses;
            // colder than the scale of the law begins, there is none
            let end = if piece.duration.is_finite() { piece.duration } else { 0.0 };
            let law = self.now.temperature_law();
            above("temperature", law.map_or(1.0, |(course, _)| value(&course, end)), 0.0)?;
            self.now.take_temperature()?;
            if off <= SAME_TEMPERATURE && piece.duration <= good {
                self.check_law(end)?;
                self.temperatures = courses;
                return Ok(());
            }
        }
        Err(self.stalled())
    }

    /// The next piece, over which the temperature keeps to where there is a law of drag.
    #[cold]
    fn piece_within_law(&mut self, mut longest: f64, piece: &mut Piece<'a>) -> Result<(), Error> {
        let Some((course, _)) = self.now.temperature_law() else {
            return self.piece(longest, piece);
        };
        for (c, n) in course.iter().zip(0..).skip(1).filter(|(c, _)| **c != 0.0) {
            longest = longest.min(rough_root(course[0] / c.abs(), n));
        }
        let (step, mut rounds) = (self.next_step, 0);
        loop {
            self.next_step = step;
            self.piece(longest, piece)?;
            match self.check_law(piece.duration) {
                Err(error) if rounds == MAX_ROUNDS => return Err(error),
                Err(_) => longest = 0.5 * piece.duration,
                Ok(()) => return Ok(()),
            }
            rounds += 1;
        }
    }

    /// Drive and temperature at `time`, not far from now.
    pub(super) fn inputs_at(mut self, time: f64) -> [f64; 2] {
        self.now.time = time;
        self.now.inputs()
    }

    /// The temperature that the law followed along the last piece, in its scale.
    pub(super) fn law_temperature(&self) -> Polynomial {
        let mut course = self.temperatures[0];
        course[0] -= self.now.system.heat.as_ref().map_or(0.0, |heat| heat.temperature_zero);
        course
    }

    /// Refuse temperatures over `elapsed` from now at which there is no law of drag.
    #[cold]
    fn check_law(&mut self, elapsed: f64) -> Result<(), Error> {
        let Some((course, _)) = self.now.temperature_law() else { return Ok(()) };
        let slope = derivative(&course);
        let rising = if slope[0] < 0.0 { slope.map(|c| -c) } else { slope };
        let turned = first_crossing(&rising, elapsed).unwrap_or(0.0);
        for temperature in [turned, elapsed].map(|t| value(&course, t)) {
            let (low, high) = self.checked.unwrap_or((f64::INFINITY, f64::NEG_INFINITY));
            if low <= temperature && temperature <= high {
                continue;
            }
            // all of a law is monotone in temperature, so that what holds at both ends holds between them
            let beyond =
                if temperature < low { temperature - BEYOND } else { temperature + BEYOND };
            let reached = if self.now.system.check_law_at(beyond).is_ok() {
                beyond
            } else {
                self.now.system.check_law_at(temperature)?;
                temperature
            };
            self.checked =
                Some((low.min(reached).min(temperature), high.max(reached).max(temperature)));
        }
        Ok(())
    }

    /// To the end of a piece that no guard ends, and into the next segment of the schedules if it reaches there.
    #[inline]
    fn go_on(&mut self, piece: &Piece) -> Result<Option<Event>, Error> {
        let until_change = self.now.until_change();
        [self.phase.pull, self.phase.speed, self.phase.bristle] = piece.state(piece.duration);
        self.phase.released = false;
        self.now.pass(piece.duration);
        self.goes_on = piece.duration < until_change || until_change.is_infinite();
        if self.goes_on {
            return Ok(None);
        }
        self.now.time = self.now.next_change;
        self.next_step = f64::INFINITY;
        let jump = self.now.pass_change();
        self.take_jump(jump)
    }

    /// Go on after a jump of the driving force or of the law: pull and speed stay, but for that, and the mode may not.
    #[cold]
    pub(super) fn take_jump(&mut self, jump: Jump) -> Result<Option<Event>, Error> {
        self.phase.pull += self.phase.direction * jump.pull;
        if !jump.is_felt {
            return Ok(None);
        }
        self.now.take_temperature()?;
        let from = self.phase.mode;
        self.enter_mode_after_jump();
        let to = self.phase.mode;
        Ok((from != to).then(|| self.event(from, Guard::between(from, to))))
    }

    /// To the end of a piece, where `guard` is met, and across it; no event if the mode does not change.
    #[inline]
    fn meet(&mut self, guard: Guard, piece: &Piece) -> Result<Option<Event>, Error> {
        let before = self.now.time;
        self.goes_on = false;
        self.now.pass(piece.duration);
        [self.phase.pull, self.phase.speed, self.phase.bristle] = piece.state(piece.duration);
        let from = self.phase.mode;
        self.now.take_temperature()?;
        self.cross(guard);
        if self.phase.mode == Mode::Stuck && from != Mode::Stuck {
            self.phase.at_rest_since = self.now.time;
        }
        self.events_at_once = if self.now.time > before { 0 } else { self.events_at_once + 1 };
        if self.events_at_once > MAX_EVENTS_AT_ONCE {
            return Err(Error::Chattering { guard: guard.name(), time: self.now.time });
        }
        if guard == Guard::TablePoint {
            return Ok(None);
        }
        Ok(Some(self.event(from, guard)))
    }

    /// What has just happened to a belt that was in the mode `from`.
    #[inline]
    fn event(&self, from: Mode, guard: Guard) -> Event {
        let Phase { mode: to, direction, pull, speed, .. } = self.phase;
        Event {
            time: self.now.time,
            from,
            to,
            guard,
            stretch: self.now.system.stretch(direction * pull, self.now.time),
            belt_speed: direction * speed,
        }
    }

    /// Rate of the pull if the belt stood still, about now, mirrored; nil while the roll slips.
    #[inline]
    pub(super) fn rate(&self) -> Cubic {
        if self.phase.slipping { [0.0; 4] } else { self.drive_rate() }
    }

    /// The same if the roll gripped the belt.
    #[inline]
    pub(super) fn drive_rate(&self) -> Cubic {
        self.now.rate(self.phase.direction)
    }

    /// What the contact has given the belt and not got back.
    pub(super) fn owed(&self) -> f64 {
        self.now.heat.as_ref().map_or(0.0, |heat| heat.owed)
    }

    /// Factor of the static force of a belt that has stood until now.
    pub(super) fn strength_now(&self) -> f64 {
        let at_rest = self.now.time - self.phase.at_rest_since;
        self.now.system.drag.strengthening().map_or(1.0, |strengthening| strengthening.at(at_rest))
    }

    /// What can hold the stuck belt now.
    pub(super) fn holding_force(&self) -> f64 {
        self.now.strengthened_holding_force(self.phase.speed, self.strength_now())
    }

    /// What the pull loses per length that the belt moves: the stiffness of the spring, nil while the roll slips.
    #[inline]
    pub(super) fn stiffness(&self) -> f64 {
        if self.phase.slipping { 0.0 } else { self.now.system.train.stiffness() }
    }
}

/// The belt at its start, mirrored so that it moves forward; its mode is found later.
fn phase_at(start: Start, pull: f64) -> Phase {
    let toward = if start.belt_speed == 0.0 { pull } else { start.belt_speed };
    let direction = if toward < 0.0 { -1.0 } else { 1.0 };
    Phase {
        mode: Mode::Stuck,
        branch: 0,
        released: false,
        creeping: false,
        slipping: false,
        at_rest_since: 0.0,
        strength: 1.0,
        direction,
        pull: direction * pull,
        speed: direction * start.belt_speed,
        bristle: 0.0,
    }
}
