//! What surrounds the belt as the motion goes on: the drive, the temperature, and the law of drag that it makes.

use super::event::ROUNDING;
use super::heat::Heat;
use super::polynomial::{ORDER, Polynomial};
use super::schedule::Cubic;
use super::system::{Drive, System};
use super::taylor::UNCHANGED;
use super::thermal::ThermalFactors;
use crate::drag::{Closure, TemperatureLaw};
use crate::error::Error;

/// Drive and drag law at the time that the motion has reached.
pub(super) struct Surroundings<'a> {
    pub system: &'a System,
    pub time: f64,
    /// Segments of the drive and of the temperature that hold now.
    drive_segment: usize,
    temperature_segment: usize,
    /// When the drive or the temperature changes its formula.
    pub next_change: f64,
    /// How the law moves with the temperature, if it does.
    pub thermal: Option<ThermalFactors>,
    /// What makes the temperature, if it is a state.
    pub heat: Option<Heat<'a>>,
}

/// What changes at once where a schedule does.
#[derive(Debug, Clone, Copy)]
pub(super) struct Jump {
    /// Jump of the pull.
    pub pull: f64,
    /// Whether that, or one of the temperature, is more than rounding.
    pub is_felt: bool,
}

impl<'a> Surroundings<'a> {
    /// Those of `system` at time 0.
    pub(super) fn at_start(system: &'a System) -> Result<Self, Error> {
        Self::at(system, 0.0, system.segments(0.0))
    }

    /// Those of `system` at `time`, where these segments of drive and temperature hold.
    pub(super) fn at(
        system: &'a System,
        time: f64,
        [drive_segment, temperature_segment]: [usize; 2],
    ) -> Result<Self, Error> {
        let mut surroundings = Self {
            system,
            time,
            drive_segment,
            temperature_segment,
            next_change: f64::INFINITY,
            thermal: None,
            heat: system.heat.as_ref().map(Heat::at_start),
        };
        surroundings.find_next_change();
        surroundings.take_temperature()?;
        Ok(surroundings)
    }

    /// Rate of the pull if the belt stood still, about now, for a belt that moves in `direction`.
    #[inline]
    pub(super) fn rate(&self, direction: f64) -> Cubic {
        let d = direction;
        match &self.system.drive {
            Drive::Speed(schedule) => {
                let k = self.system.train.stiffness();
                schedule.about(self.drive_segment, self.time).map(|c| d * k * c)
            }
            Drive::Force(schedule) => {
                let [_, b, c, e] = schedule.about(self.drive_segment, self.time);
                [d * b, d * 2.0 * c, d * 3.0 * e, 0.0]
            }
        }
    }

    /// Segments of drive and temperature that hold now.
    pub(super) fn segments(&self) -> [usize; 2] {
        [self.drive_segment, self.temperature_segment]
    }

    /// Time left until the drive or the temperature changes its formula.
    #[inline]
    pub(super) fn until_change(&self) -> f64 {
        self.next_change - self.time
    }

    /// Drive and temperature now.
    pub(super) fn inputs(&self) -> [f64; 2] {
        let drive = self.system.drive.schedule().about(self.drive_segment, self.time)[0];
        let temperature = self.system.temperature.as_ref();
        let steady = || self.system.steady_temperature();
        [
            drive,
            temperature.map_or_else(steady, |t| t.about(self.temperature_segment, self.time)[0]),
        ]
    }

    fn find_next_change(&mut self) {
        let drive = self.system.drive.schedule().end(self.drive_segment);
        let temperature = &self.system.temperature;
        let segment_end =
            temperature.as_ref().map_or(f64::INFINITY, |t| t.end(self.temperature_segment));
        let heat = self.heat.as_ref().map_or(f64::INFINITY, Heat::next_change);
        self.next_change = drive.min(segment_end).min(heat);
    }

    /// Enter the next segment of the schedules.
    pub(super) fn pass_change(&mut self) -> Jump {
        let before = self.inputs();
        if self.system.drive.schedule().end(self.drive_segment) <= self.time {
            self.drive_segment += 1;
        }
        if let Some(temperature) = &self.system.temperature
            && temperature.end(self.temperature_segment) <= self.time
        {
            self.temperature_segment += 1;
        }
        if let Some(heat) = &mut self.heat {
            heat.pass_change(self.time);
        }
        self.find_next_change();
        self.jump_from(before)
    }

    /// What has changed at once, where drive and temperature were others just `before`.
    pub(super) fn jump_from(&self, before: [f64; 2]) -> Jump {
        let now = self.inputs();
        let is_force = matches!(self.system.drive, Drive::Force(_));
        let pull = if is_force { now[0] - before[0] } else { 0.0 };
        let force = before[0].abs() + now[0].abs() + self.system.drag.transition_force();
        let warming = (now[1] - before[1]).abs();
        let is_felt = pull.abs() > ROUNDING * force || warming > ROUNDING * now[1].abs();
        Jump { pull, is_felt }
    }

    /// Course of the temperature from now on, and how the law varies with it.
    pub(super) fn temperature_law(&self) -> Option<(Polynomial, &'a TemperatureLaw)> {
        let course = if let Some(heat) = &self.heat {
            heat.course_of_law()
        } else {
            let temperature = self.system.temperature.as_ref()?;
            let mut course = [0.0; ORDER + 1];
            course[..4].copy_from_slice(&temperature.about(self.temperature_segment, self.time));
            course
        };
        Some((course, self.system.drag.temperature_law()?))
    }

    /// Let time pass, and heat flow with it.
    pub(super) fn pass(&mut self, elapsed: f64) {
        self.time += elapsed;
        if let Some(heat) = &mut self.heat {
            heat.pass(elapsed);
        }
    }

    /// Take the law as it is now.
    ///
    /// # Errors
    /// If it has ended.
    #[inline]
    pub(super) fn take_temperature(&mut self) -> Result<(), Error> {
        if self.heat.is_none() && self.system.temperature.is_none() {
            return Ok(()); // nothing to take, and the factors are large
        }
        let Some((temperature, law)) = self.temperature_law() else { return Ok(()) };
        let share = self.system.drag.boundary_share();
        self.thermal = Some(ThermalFactors::new(law, share, &temperature)?);
        Ok(())
    }

    /// Whether the transition of a mixed contact moves among the speeds of the law, as boundary friction varies by itself.
    pub(super) fn transition_moves(&self) -> bool {
        let law = self.system.drag.temperature_law();
        let moves = self.thermal.is_some() && law.is_some_and(|law| law.boundary_slope != 0.0);
        moves && self.system.drag.mixed_contact().is_some()
    }

    /// A speed of the law as it is now.
    #[inline]
    pub(super) fn speed(&self, base: f64) -> f64 {
        self.thermal.as_ref().map_or(base, |thermal| base * thermal.speed[0])
    }

    /// A force of the law as it is now.
    #[inline]
    pub(super) fn force(&self, base: f64) -> f64 {
        self.thermal.as_ref().map_or(base, |thermal| base * thermal.force[0])
    }

    /// The same of a force below the stick speed.
    #[inline]
    pub(super) fn force_below(&self, base: f64) -> f64 {
        self.thermal.as_ref().map_or(base, |thermal| base * thermal.below[0])
    }

    /// A belt speed in the terms of the law as it was given.
    #[inline]
    pub(super) fn at_reference(&self, speed: f64) -> f64 {
        self.thermal.as_ref().map_or(speed, |thermal| speed * thermal.slowness[0])
    }

    /// Branch of the law on which a belt slides at `speed`.
    pub(super) fn sliding_branch(&self, speed: f64) -> usize {
        let (drag, x) = (&self.system.drag, self.at_reference(speed));
        if let (Some(contact), Some(thermal)) = (drag.mixed_contact(), &self.thermal) {
            return usize::from(x >= contact.transition_speed(thermal.boundary[0]));
        }
        drag.branch(x)
    }

    /// Branch of the law that holds a belt at `speed`, where a law that moves has left it above the stick speed; where
    /// formulas meet that on which it is about to be, `rising` in the terms of the law or not.
    pub(super) fn held_branch(&self, speed: f64, rising: bool) -> Option<usize> {
        let drag = &self.system.drag;
        let nudge = if rising { 2.0 * ROUNDING } else { -2.0 * ROUNDING };
        let x = self.at_reference(speed) * (1.0 + nudge);
        (x > drag.stick_speed()).then(|| drag.branch(x))
    }

    /// The same of a belt that keeps its speed.
    pub(super) fn standing_branch(&self, speed: f64) -> Option<usize> {
        let falling = self.thermal.as_ref().is_some_and(|thermal| thermal.speed[1] < 0.0);
        self.held_branch(speed, falling)
    }

    /// Slope in speed of what holds a belt at `speed`, by `branch` of the law or the one below the stick speed.
    pub(super) fn holding_slope(&self, branch: Option<usize>, speed: f64) -> f64 {
        let (drag, x) = (&self.system.drag, self.at_reference(speed));
        let contact = match branch {
            Some(branch) => {
                let boundary = self.thermal.as_ref().map_or(1.0, |thermal| thermal.boundary[0]);
                self.force(drag.branch_force_and_slope(branch, x, boundary).1)
            }
            None => -self.force_below(drag.exponential(x)) / drag.decay_speed(),
        };
        let slowness = self.thermal.as_ref().map_or(1.0, |thermal| thermal.slowness[0]);
        contact * slowness + self.rest_slope()
    }

    /// What can hold a belt at `speed`; a law that moves may leave a held belt above the stick speed.
    pub(super) fn holding_force(&self, speed: f64) -> f64 {
        self.strengthened_holding_force(speed, 1.0)
    }

    /// The same after a rest that has made the static force `strength` times as large.
    pub(super) fn strengthened_holding_force(&self, speed: f64, strength: f64) -> f64 {
        let (drag, x) = (&self.system.drag, self.at_reference(speed));
        // a belt that has come down to the stick speed may lie above it by rounding
        if x > drag.stick_speed() * (1.0 + ROUNDING) {
            return self.contact_drag(speed) + self.rest(speed);
        }
        match drag.closure() {
            Closure::Stiction => {
                self.force_below(strength * drag.breakaway_force()) + self.rest(0.0)
            }
            _ => self.force_below(drag.exponential(x)) + self.rest(speed),
        }
    }

    /// Drag of the contact in steady sliding at `speed > 0`, without the rest of the drive.
    pub(super) fn contact_drag(&self, speed: f64) -> f64 {
        let drag = &self.system.drag;
        let x = self.at_reference(speed);
        if x >= drag.stick_speed() {
            self.branch_drag(drag.branch(x), speed)
        } else {
            self.force_below(drag.contact_force(x))
        }
    }

    /// Drag of the contact on `branch` at `speed > 0`.
    pub(super) fn branch_drag(&self, branch: usize, speed: f64) -> f64 {
        let (drag, x) = (&self.system.drag, self.at_reference(speed));
        let boundary = self.thermal.as_ref().map_or(1.0, |thermal| thermal.boundary[0]);
        self.force(drag.branch_force_and_slope(branch, x, boundary).0)
    }

    /// Drag in steady sliding at `speed >= 0`, which is at least the stick speed or of a closure that is not smooth.
    pub(super) fn steady_drag(&self, speed: f64) -> f64 {
        self.contact_drag(speed) + self.rest(speed)
    }

    /// Factor of the rest of the drive from now on.
    pub(super) fn rest_course(&self) -> Polynomial {
        self.thermal.as_ref().map_or(UNCHANGED, |thermal| thermal.rest)
    }

    /// Slope in speed of the drag of the rest of the drive, as it is now.
    pub(super) fn rest_slope(&self) -> f64 {
        let damping = self.system.drag.rest().damping;
        self.thermal.as_ref().map_or(damping, |thermal| damping * thermal.rest[0])
    }

    /// Drag of the rest of the drive at `speed >= 0`, as it is now.
    pub(super) fn rest(&self, speed: f64) -> f64 {
        let rest = self.system.drag.rest().at(speed);
        self.thermal.as_ref().map_or(rest, |thermal| rest * thermal.rest[0])
    }
}
