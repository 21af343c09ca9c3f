//! The equation to solve: drivetrain, drag, drive and temperature.

use super::heat::HeatBalance;
use super::moment::Moment;
use super::schedule::{Cubic, Schedule};
use crate::drag::{Closure, Drag, Mode, SpeedLaw};
use crate::error::{Error, above, at_least, at_most, below, finite};

/// Spring and mass between the drive and the sliding contact; for a rotor, torsional stiffness and inertia.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drivetrain {
    stiffness: f64,
    mass: f64,
    grip: f64,
    // of the two above, so that no step takes a root
    time_scale: f64,
    impedance: f64,
}

impl Drivetrain {
    /// A drivetrain of `stiffness` `k` and moving `mass` `m`; only a drive that gives a force can do without a spring.
    ///
    /// # Errors
    /// If a value is not finite, `stiffness` is negative, or `mass` is not positive.
    pub fn new(stiffness: f64, mass: f64) -> Result<Self, Error> {
        let stiffness = at_least("stiffness", stiffness, 0.0)?;
        let mass = above("mass", mass, 0.0)?;
        let (time_scale, impedance) = ((mass / stiffness).sqrt(), (stiffness * mass).sqrt());
        Ok(Self { stiffness, mass, grip: f64::INFINITY, time_scale, impedance })
    }

    /// The same, of a roll that grips the belt no harder than with the force `grip` (Eq. 11 assumes that it always does).
    ///
    /// The spring ends at the roll, so it pulls no harder either: beyond, the roll slips on the belt.
    ///
    /// # Errors
    /// If `grip` is not positive.
    pub fn with_grip(mut self, grip: f64) -> Result<Self, Error> {
        self.grip = above("grip", grip, 0.0)?;
        Ok(self)
    }

    /// Force up to which the roll grips the belt; infinite if it always does.
    #[must_use]
    pub fn grip(&self) -> f64 {
        self.grip
    }

    /// Spring stiffness `k`.
    #[must_use]
    pub fn stiffness(&self) -> f64 {
        self.stiffness
    }

    /// Moving mass `m`.
    #[must_use]
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// Time scale `sqrt(m/k)` of the free oscillation.
    #[must_use]
    pub fn time_scale(&self) -> f64 {
        self.time_scale
    }

    /// Impedance `sqrt(k m)`: force over speed of the free oscillation.
    pub(crate) fn impedance(&self) -> f64 {
        self.impedance
    }
}

/// What moves the belt.
#[derive(Debug, Clone, PartialEq)]
pub enum Drive {
    /// A given speed at the far end of the spring (Eqs. 12-16).
    Speed(Schedule),
    /// A given force on the mass, which a spring holds to the ground; for a rotor, torque (Eq. 11).
    Force(Schedule),
}

impl Drive {
    pub(super) fn schedule(&self) -> &Schedule {
        match self {
            Self::Speed(schedule) | Self::Force(schedule) => schedule,
        }
    }
}

/// Where the motion starts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Start {
    /// Belt speed.
    pub belt_speed: f64,
    /// Spring stretch: drive position minus belt position; with a drive of given force, position of the mass.
    pub stretch: f64,
}

/// Share of the drive speed by which a nudged start is faster: an unstable balance is nothing that a belt can keep.
pub const NUDGE: f64 = 1e-3;

impl Start {
    /// Belt at rest and spring slack.
    pub const REST: Self = Self { belt_speed: 0.0, stretch: 0.0 };

    /// Sliding at `speed`, with the spring stretched by just the drag there.
    ///
    /// # Errors
    /// If there is no spring.
    pub fn steady(train: &Drivetrain, drag: &Drag, speed: f64) -> Result<Self, Error> {
        let stiffness = above("stiffness", train.stiffness, 0.0)?;
        Ok(Self { belt_speed: speed, stretch: drag.force(speed) / stiffness })
    }

    /// The same, but for a nudge of the speed by `NUDGE`.
    #[must_use]
    pub fn nudged(self) -> Self {
        Self { belt_speed: self.belt_speed * (1.0 + NUDGE), ..self }
    }
}

/// How the smooth pieces of the motion are integrated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Integrator {
    /// Taylor series, and Radau IIA where the equation is stiff.
    Adaptive,
    /// Dormand and Prince's explicit Runge-Kutta pair, as a second opinion.
    DormandPrince,
}

/// A belt with its drivetrain, drag and drive.
#[derive(Debug, Clone, PartialEq)]
pub struct System {
    pub(super) train: Drivetrain,
    pub(super) drag: Drag,
    pub(super) drive: Drive,
    /// Temperature, if it moves and the drag with it.
    pub(super) temperature: Option<Schedule>,
    /// What makes the temperature, if it is a state.
    pub(super) heat: Option<HeatBalance>,
    /// The law as it was given and the one temperature at which `drag` is it.
    given: Option<(Drag, f64)>,
    /// Whether the temperature goes on without end, beyond where there is a law of drag.
    pub(super) is_open: bool,
}

impl System {
    /// The equation of `train` and `drag` under `drive`, at a `temperature` in the scale of the drag law.
    ///
    /// # Errors
    /// If a drive of given speed has no spring, the temperature leaves the positive range of its scale, or the law of drag
    /// ends within the range of the temperature; a law that does not vary with temperature is the same at all.
    pub fn new(
        train: Drivetrain,
        drag: &Drag,
        drive: Drive,
        temperature: Option<Schedule>,
    ) -> Result<Self, Error> {
        if matches!(drive, Drive::Speed(_)) {
            above("stiffness", train.stiffness, 0.0)?;
        }
        let mut system = Self {
            train,
            drag: drag.clone(),
            drive,
            temperature: None,
            heat: None,
            given: None,
            is_open: false,
        };
        let Some(schedule) = temperature else { return Ok(system) };
        let (low, high) = schedule.range();
        above("temperature", low, 0.0)?;
        system.check_law_at(low)?;
        system.check_law_at(high)?;
        match schedule.steady() {
            Some(temperature) => system.keep_temperature(temperature)?,
            None => system.temperature = drag.temperature_law().map(|_| schedule),
        }
        Ok(system)
    }

    /// The equation of `train` and `drag` under `drive`, at the temperature that `heat` and friction make.
    ///
    /// # Errors
    /// If a drive of given speed has no spring, a number of the balance is out of range, or the drag does not vary with
    /// temperature.
    pub fn with_heat(
        train: Drivetrain,
        drag: &Drag,
        drive: Drive,
        heat: HeatBalance,
    ) -> Result<Self, Error> {
        heat.check()?;
        let law = drag
            .temperature_law()
            .ok_or(Error::TooFew { quantity: "temperature law of the drag", needed: 1 })?;
        if matches!(law.speed, SpeedLaw::Viscosity(_)) {
            let quantity = "zero of the temperature scale of a viscosity, which is absolute,";
            at_most(quantity, at_least(quantity, heat.temperature_zero, 0.0)?, 0.0)?;
        }
        let start = heat.start[0] - heat.temperature_zero;
        let system = Self { heat: Some(heat), ..Self::new(train, drag, drive, None)? };
        system.check_law_at(start)?;
        Ok(system)
    }

    /// Take the law at one temperature.
    fn keep_temperature(&mut self, temperature: f64) -> Result<(), Error> {
        let law = self.law();
        if law.temperature_law().is_none() {
            return Ok(());
        }
        let law = law.clone();
        (self.drag, self.temperature, self.is_open) = (law.at(temperature)?, None, false);
        self.given = Some((law, temperature));
        Ok(())
    }

    /// The law of drag as it was given.
    fn law(&self) -> &Drag {
        self.given.as_ref().map_or(&self.drag, |(law, _)| law)
    }

    /// The temperature that holds at all times, if one does; zero if the law does not vary.
    pub(super) fn steady_temperature(&self) -> f64 {
        let reference = self.drag.temperature_law().map_or(0.0, |law| law.reference);
        self.given.as_ref().map_or(reference, |(_, temperature)| *temperature)
    }

    /// Drive and temperature that hold one value from `segments` on for good, as courses; no temperature where the law
    /// does not vary.
    pub(super) fn steady_inputs(&self, segments: [usize; 2]) -> [Option<Cubic>; 2] {
        let course = |value: f64| [value, 0.0, 0.0, 0.0];
        let schedule = self.drive.schedule();
        let drive = schedule.steady().filter(|_| schedule.end(segments[0]).is_infinite());
        let varies = self.law().temperature_law().is_some() && self.temperature.is_none();
        [drive.map(course), varies.then(|| course(self.steady_temperature()))]
    }

    /// Whether the temperature, of which `segment` holds, goes on for good as `course` does, in the time from `time` on.
    #[allow(clippy::float_cmp)] // the same to the last bit
    pub(super) fn temperature_goes_on_as(&self, segment: usize, time: f64, course: &Cubic) -> bool {
        match &self.temperature {
            Some(temperature) => temperature.goes_on_as(segment, time, course),
            None => *course == [self.steady_temperature(), 0.0, 0.0, 0.0],
        }
    }

    /// Drive by a cubic in the time from `since` on.
    pub(super) fn set_drive(&mut self, since: f64, course: Cubic) {
        let (Drive::Speed(schedule) | Drive::Force(schedule)) = &mut self.drive;
        *schedule = Schedule::onward(since, course);
    }

    /// Let the temperature be a cubic in the time from `since` on.
    ///
    /// # Errors
    /// If there is no law of drag at its start; nothing has changed then.
    pub(super) fn set_temperature(&mut self, since: f64, course: Cubic) -> Result<(), Error> {
        above("temperature", course[0], 0.0)?;
        check_law(self.law(), course[0])?;
        if course[1..] == [0.0; 3] {
            return self.keep_temperature(course[0]);
        }
        if let Some((law, _)) = self.given.take() {
            self.drag = law;
        }
        if self.drag.temperature_law().is_some() {
            self.temperature = Some(Schedule::onward(since, course));
            self.is_open = true;
        }
        Ok(())
    }

    /// Segments of drive and temperature at `time`.
    pub(super) fn segments(&self, time: f64) -> [usize; 2] {
        let temperature = self.temperature.as_ref().map_or(0, |t| t.segment(time));
        [self.drive.schedule().segment(time), temperature]
    }

    /// Refuse a moment that no motion of the system can have.
    pub(super) fn check_moment(&self, moment: &Moment) -> Result<(), Error> {
        let last = self.segments(f64::INFINITY);
        let at_most = |quantity: &'static str, value: usize, limit: usize| {
            #[allow(clippy::cast_precision_loss)] // they are few
            at_most(quantity, value as f64, limit as f64)
        };
        at_most("segment of the drive", moment.segments[0], last[0])?;
        at_most("segment of the temperature", moment.segments[1], last[1])?;
        at_most("branch", moment.phase.branch, self.drag.branch(f64::INFINITY))?;
        let (stuck, sticks) = (moment.phase.mode == Mode::Stuck, !self.drag.closure().is_smooth());
        at_most("sticking, of a closure that has none,", stuck.into(), sticks.into())?;
        let (slips, can_slip) = (moment.phase.slipping, self.grip().is_some());
        at_most("slip, of a roll that grips for ever,", slips.into(), can_slip.into()).map(|_| ())
    }

    /// Refuse a `temperature`, in the scale of the law, at which there is no law of drag.
    pub(super) fn check_law_at(&self, temperature: f64) -> Result<(), Error> {
        check_law(&self.drag, temperature)
    }

    /// A belt at constant `drive_speed` and the temperature at which the law is given.
    ///
    /// # Errors
    /// If the speed is not finite or there is no spring.
    pub fn at_speed(train: Drivetrain, drag: &Drag, drive_speed: f64) -> Result<Self, Error> {
        finite("drive_speed", drive_speed)?;
        Self::new(train, drag, Drive::Speed(Schedule::constant(drive_speed)), None)
    }

    /// Pull of the spring on the belt at `start`, checked.
    pub(super) fn pull(&self, start: Start) -> Result<f64, Error> {
        finite("start belt_speed", start.belt_speed)?;
        let spring = self.train.stiffness * finite("start stretch", start.stretch)?;
        let pull = match &self.drive {
            Drive::Speed(_) => spring,
            Drive::Force(force) => force.at(0.0) - spring,
        };
        finite("start stretch", pull)
    }

    /// Spring stretch that goes with `pull` at `time`; without a spring, zero.
    #[inline]
    pub(super) fn stretch(&self, pull: f64, time: f64) -> f64 {
        if self.train.stiffness == 0.0 {
            return 0.0;
        }
        match &self.drive {
            Drive::Speed(_) => pull / self.train.stiffness,
            Drive::Force(force) => (force.at(time) - pull) / self.train.stiffness,
        }
    }

    /// Force up to which the roll grips the belt, if there is such a limit; a drive that gives a force has no roll.
    pub(super) fn grip(&self) -> Option<f64> {
        (self.train.grip.is_finite() && matches!(self.drive, Drive::Speed(_)))
            .then_some(self.train.grip)
    }

    pub(super) fn has_bristles(&self) -> bool {
        matches!(self.drag.closure(), Closure::LuGre { .. })
    }
}

/// Refuse a `temperature` at which `drag` is no law.
fn check_law(drag: &Drag, temperature: f64) -> Result<(), Error> {
    let law = drag.at(temperature)?;
    let quantity = "stick speed at this temperature, against the transition speed,";
    below(quantity, law.stick_speed(), law.transition_speed()).map(|_| ())
}

/// Loosest and tightest relative tolerance that the steps are built for.
const TOLERANCE_RANGE: (f64, f64) = (1e-14, 1e-3);

pub(crate) fn checked_tolerance(tolerance: f64) -> Result<f64, Error> {
    above("tolerance", tolerance, TOLERANCE_RANGE.0 * 0.999)?;
    at_most("tolerance", tolerance, TOLERANCE_RANGE.1)
}
