//! The motion from call to call, its drive and temperature given on the way.
//!
//! The stepper keeps the moment at the start of the smooth piece under way and the time reached in it, so that where and
//! how often one stops changes no bit of the motion. Only another drive or temperature cuts a piece, as the change of a
//! schedule does.

use super::event::Event;
use super::hybrid::Motion;
use super::moment::Moment;
use super::piece::{Path, Phase, Piece};
use super::polynomial::{derivative, value};
use super::schedule::Cubic;
use super::system::{Integrator, Start, System};
use crate::drag::Mode;
use crate::error::{Error, at_least, at_most, finite};
use crate::work::Work;

/// A motion that goes on from call to call, and whose drive and temperature may change between them.
#[derive(Debug, Clone)]
pub struct Stepper {
    /// The system as it was given, and as it is driven now.
    given: System,
    system: System,
    tolerance: f64,
    integrator: Integrator,
    moment: Moment,
    /// The piece under way, unless it is to be made.
    ahead: Option<Ahead>,
    /// Least and greatest temperature at which the law is known to be one.
    checked: Option<(f64, f64)>,
}

/// Where a motion stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// The time reached.
    pub time: f64,
    /// State of lubrication.
    pub mode: Mode,
    /// Whether the roll slips on the belt.
    pub slipping: bool,
    /// Belt speed.
    pub belt_speed: f64,
    /// Spring stretch; with a drive of given force, position of the mass.
    pub stretch: f64,
    /// Force that pulls at the belt: of the spring, and with a drive of given force of both.
    pub pull: f64,
    /// Drag on the belt, all of it; of a held belt, what holds it.
    pub drag: f64,
}

/// A piece of the motion, and what follows it.
#[derive(Debug, Clone)]
struct Ahead {
    start: Phase,
    path: Path,
    end: f64,
    next: Result<(Moment, Option<Event>), Error>,
}

impl Stepper {
    /// The motion of `system` from `start`, at time 0.
    ///
    /// # Errors
    /// If a value is not finite or out of range, or the temperature of the system is a state.
    pub fn new(
        system: System,
        start: Start,
        tolerance: f64,
        integrator: Integrator,
    ) -> Result<Self, Error> {
        if system.heat.is_some() {
            let quantity = "temperature of a motion in steps, which is given and no state,";
            return Err(Error::TooFew { quantity, needed: 1 });
        }
        let work = Work::default();
        let moment = Motion::new(&system, start, tolerance, integrator, &work)?.moment();
        let given = system.clone();
        Ok(Self { given, system, tolerance, integrator, moment, ahead: None, checked: None })
    }

    /// The time reached.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.moment.time
    }

    /// All that changes, from which `restore` goes on to the last bit.
    ///
    /// Drive and temperature that stay go along, so that a stepper that began with others goes on the same. Of a drive
    /// or a temperature that was given as a course in time, the stepper that takes the moment must have the same.
    #[must_use]
    pub fn moment(&self) -> Moment {
        let mut moment = self.moment;
        let [drive, temperature] = self.given.steady_inputs(moment.segments);
        if moment.drive.is_none()
            && let Some(course) = drive
        {
            (moment.drive, moment.segments[0]) = (Some((0.0, course)), 0);
        }
        if moment.temperature.is_none()
            && let Some(course) = temperature
        {
            (moment.temperature, moment.segments[1]) = (Some((0.0, course)), 0);
        }
        moment
    }

    /// On to `until`, or to the first change of mode before or at it, which is returned: the state is then just after it.
    ///
    /// # Errors
    /// If `until` lies behind, there is no law of drag at the temperature reached, the motion switches mode without end,
    /// or `work` ends before it; the motion then stands where it has come.
    pub fn advance(&mut self, until: f64, work: &Work) -> Result<Option<Event>, Error> {
        at_least("until", until, self.moment.time)?;
        loop {
            let ahead = match self.ahead.take() {
                Some(ahead) => ahead,
                None => self.look(work)?,
            };
            if until < ahead.end {
                self.moment.time = until;
                self.ahead = Some(ahead);
                return Ok(None);
            }
            let (next, event) = ahead.next?;
            self.moment = next;
            if event.is_some() {
                return Ok(event);
            }
        }
    }

    /// The drive from now on, as a cubic in the time from now: speed or force, as the drive of the system is.
    ///
    /// As [`Stepper::set_inputs`].
    ///
    /// # Errors
    /// If a coefficient is not finite.
    pub fn set_drive(&mut self, course: Cubic) -> Result<Option<Event>, Error> {
        self.set_inputs(Some(course), None)
    }

    /// The temperature from now on, as a cubic in the time from now, in the scale of the law.
    ///
    /// As [`Stepper::set_inputs`].
    ///
    /// # Errors
    /// If a coefficient is not finite, or there is no law of drag at the temperature now.
    pub fn set_temperature(&mut self, course: Cubic) -> Result<Option<Event>, Error> {
        self.set_inputs(None, Some(course))
    }

    /// Drive and temperature from now on, both at once; none goes on as it is, and so does one that does not change.
    ///
    /// Pull and speed stay as they are, but for a jump of a driving force. The mode changes at once if the law asks for it
    /// now: that event is returned.
    ///
    /// # Errors
    /// As of [`Stepper::set_drive`] and [`Stepper::set_temperature`]; nothing has changed then.
    pub fn set_inputs(
        &mut self,
        drive: Option<Cubic>,
        temperature: Option<Cubic>,
    ) -> Result<Option<Event>, Error> {
        for (name, course) in [("drive", drive), ("temperature", temperature)] {
            for coefficient in course.into_iter().flatten() {
                finite(name, coefficient)?;
            }
        }
        let (system, mut moment) = (&self.system, self.moment);
        let [drive_segment, temperature_segment] = moment.segments;
        let drive = drive.filter(|course| {
            !system.drive.schedule().goes_on_as(drive_segment, moment.time, course)
        });
        let temperature = temperature.filter(|course| {
            !system.temperature_goes_on_as(temperature_segment, moment.time, course)
        });
        if drive.is_none() && temperature.is_none() {
            return Ok(None);
        }
        let work = Work::default();
        let before = self.motion(&work)?.inputs_at(moment.time);
        moment.phase = self.phase();
        (moment.start, moment.next_step) = (moment.time, f64::INFINITY);
        let mut driven = system.clone();
        if let Some(course) = temperature {
            driven.set_temperature(moment.time, course)?;
            moment.temperature = Some((moment.time, course));
            moment.segments[1] = 0;
        }
        if let Some(course) = drive {
            driven.set_drive(moment.time, course);
            moment.drive = Some((moment.time, course));
            moment.segments[0] = 0;
        }
        let mut motion = Motion::at(&driven, &moment, self.tolerance, self.integrator, &work)?;
        let jump = motion.now.jump_from(before);
        let event = motion.take_jump(jump)?;
        let Moment { drive, temperature, .. } = moment;
        self.moment = Moment { drive, temperature, ..motion.moment() };
        (self.system, self.ahead) = (driven, None);
        Ok(event)
    }

    /// Go on from `moment`, of this stepper or of another of the same system, start apart, tolerance and integrator.
    ///
    /// # Errors
    /// If the moment is none that the system can have; nothing has changed then.
    pub fn restore(&mut self, moment: Moment) -> Result<(), Error> {
        let mut system = self.given.clone();
        if let Some((since, course)) = moment.drive {
            system.set_drive(since, course);
        }
        if let Some((since, course)) = moment.temperature {
            system.set_temperature(since, course)?;
        }
        system.check_moment(&moment)?;
        let mut stepper = Self { system, moment, ahead: None, ..self.clone() };
        if moment.time > moment.start {
            let ahead = stepper.look(&Work::default())?;
            at_most("time of a moment, within its piece", moment.time, ahead.end)?;
            stepper.ahead = Some(ahead);
        }
        *self = stepper;
        Ok(())
    }

    /// Where the motion stands.
    #[must_use]
    pub fn state(&self) -> State {
        let Phase { mode, slipping, direction, pull, speed, .. } = self.phase();
        let (time, pull, belt_speed) = (self.moment.time, direction * pull, direction * speed);
        let stretch = self.system.stretch(pull, time);
        let drag = self.drag(pull, belt_speed).unwrap_or(pull);
        State { time, mode, slipping, belt_speed, stretch, pull, drag }
    }

    /// The state now, at which the piece under way would begin if it were cut here.
    fn phase(&self) -> Phase {
        let elapsed = self.moment.time - self.moment.start;
        match &self.ahead {
            Some(ahead) if elapsed > 0.0 => {
                let mut phase = Phase { released: false, ..ahead.start };
                let work = Work::default();
                if let Ok(piece) = self.piece(ahead, &work) {
                    [phase.pull, phase.speed, phase.bristle] = piece.state(elapsed);
                }
                phase
            }
            _ => self.moment.phase,
        }
    }

    /// Drag now, where pull and speed are these, signed.
    fn drag(&self, pull: f64, belt_speed: f64) -> Result<f64, Error> {
        let (elapsed, work) = (self.moment.time - self.moment.start, Work::default());
        let piece = if let Some(ahead) = &self.ahead {
            self.piece(ahead, &work)?
        } else {
            let mut motion = self.motion(&work)?;
            let mut piece = motion.no_piece();
            motion.look_ahead(f64::INFINITY, &mut piece)?;
            piece
        };
        if piece.start.mode == Mode::Stuck {
            return Ok(pull);
        }
        match &piece.path {
            // in between what the law gives and what it can bear
            Path::Series(series) if piece.start.creeping => {
                let rate = piece.start.direction * value(&derivative(&series.speed), elapsed);
                Ok(pull - self.system.train.mass() * rate)
            }
            _ => Ok(piece.friction(elapsed, pull, belt_speed)),
        }
    }

    /// The motion at the start of the piece under way.
    fn motion<'a>(&'a self, work: &'a Work<'a>) -> Result<Motion<'a>, Error> {
        let mut motion =
            Motion::at(&self.system, &self.moment, self.tolerance, self.integrator, work)?;
        motion.checked = self.checked;
        Ok(motion)
    }

    /// The piece under way, as it was made.
    fn piece<'a>(&'a self, ahead: &Ahead, work: &'a Work<'a>) -> Result<Piece<'a>, Error> {
        let mut motion = self.motion(work)?;
        motion.phase = ahead.start;
        let (time, duration) = (self.moment.start, ahead.end - self.moment.start);
        let (flow, path) = (motion.flow(), ahead.path);
        Ok(Piece { time, duration, start: ahead.start, flow, path, heated: false })
    }

    /// Make the piece under way, and see where it leads.
    fn look(&mut self, work: &Work) -> Result<Ahead, Error> {
        let mut motion = self.motion(work)?;
        let mut piece = motion.no_piece();
        let guard = motion.look_ahead(f64::INFINITY, &mut piece)?;
        let (start, path) = (piece.start, piece.path);
        let (end, next) = if piece.duration.is_finite() {
            let event = motion.follow(&mut piece, guard);
            let Moment { drive, temperature, .. } = self.moment;
            let moment = Moment { drive, temperature, ..motion.moment() };
            (moment.time, event.map(|event| (moment, event)))
        } else {
            (f64::INFINITY, Ok((self.moment, None)))
        };
        let checked = motion.checked;
        self.checked = checked;
        Ok(Ahead { start, path, end, next })
    }
}
