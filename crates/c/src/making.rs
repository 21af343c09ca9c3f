//! The core's objects of a described drive.

use hersey_core::Error;
use hersey_core::drag::form::LISTS;
use hersey_core::drag::{Drag, DragForm};
use hersey_core::motion::{self, Drivetrain, Integrator, Schedule, Stepper, System};
use hersey_core::wire::{Unreadable, Values as ByName};

use crate::description::{Choices, Coupling, Description, Drive, Start, Values};
use crate::variables::{TEMPERATURE, place_of};

/// A drive with the values that its variables have.
pub struct Making<'a> {
    pub description: &'a Description,
    pub values: &'a Values,
}

/// What the core reads of the drag; its kinds are known.
impl ByName for Making<'_> {
    fn word(&self, _: &str) -> Option<&str> {
        None
    }

    fn number(&self, field: &str) -> Option<f64> {
        self.given(field)
    }

    fn numbers(&self, field: &str) -> Option<&[f64]> {
        let place = LISTS.iter().position(|name| *name == field)?;
        self.description.lists.get(place).map(Vec::as_slice)
    }
}

impl Making<'_> {
    /// Stiffness of the spring.
    pub fn stiffness(&self) -> f64 {
        self.value("stiffness")
    }

    /// Moving mass.
    pub fn mass(&self) -> f64 {
        self.value("mass")
    }

    /// Refuse a roll without a radius; a drive that has no roll has none.
    pub fn checked_radius(&self) -> Result<(), String> {
        match self.given("roll_radius") {
            Some(radius) if radius <= 0.0 => {
                Err(format!("roll_radius is {radius}: it must be greater than 0"))
            }
            _ => Ok(()),
        }
    }

    /// Radius of the roll.
    pub fn roll_radius(&self) -> f64 {
        self.value("roll_radius")
    }

    /// What the rest of the drive takes at a temperature of the input: force, and damping.
    pub fn rest(&self, temperature: f64) -> [f64; 2] {
        let warmer = temperature - self.value("reference_temperature");
        let factor = self
            .given("rest_temperature_slope")
            .filter(|_| self.description.is_warmed())
            .map_or(1.0, |slope| 1.0 + slope * warmer);
        [factor * self.value("rest_force"), factor * self.value("rest_damping")]
    }

    fn value(&self, name: &str) -> f64 {
        place_of(name).map_or(f64::NAN, |place| self.values[place])
    }

    fn given(&self, name: &str) -> Option<f64> {
        Some(self.value(name)).filter(|value| !value.is_nan())
    }

    /// What moves the belt as the core takes it: its speed, or the force of the torque on the roll (Eq. 11).
    pub fn drive(&self, value: f64) -> f64 {
        let Choices { drive, coupling, .. } = self.description.choices;
        match (drive, coupling) {
            (Drive::Speed, Coupling::Translational) => value,
            (Drive::Speed, Coupling::Rotational) => value * self.roll_radius(),
            (Drive::Torque, _) => value / self.roll_radius(),
        }
    }

    /// A temperature in the scale of the law.
    pub fn temperature(&self, value: f64) -> f64 {
        value - self.given("temperature_zero").unwrap_or(0.0)
    }

    /// Why there is no such motion; the core counts temperatures in the scale of the law.
    pub fn words(&self, error: impl Into<Unreadable>) -> String {
        let error = error.into();
        match (error.field(), self.given("temperature_zero")) {
            (Some("temperature"), Some(zero)) if zero != 0.0 => {
                format!("{error} (counted from temperature_zero, {zero} K)")
            }
            _ => error.to_string(),
        }
    }

    fn train(&self) -> Result<Drivetrain, Error> {
        let train = Drivetrain::new(self.stiffness(), self.value("mass"))?;
        self.given("grip").map_or(Ok(train), |grip| train.with_grip(grip))
    }

    fn drag(&self) -> Result<Drag, Unreadable> {
        Ok(DragForm::of(self.description.choices.drag, self)?.law()?)
    }

    /// The motion from its start, at the inputs as they are.
    pub fn stepper(&self) -> Result<Stepper, Unreadable> {
        let (train, drag) = (self.train()?, self.drag()?);
        let given = self.values[self.description.drive_place()];
        let given = self.drive(given);
        let now = Schedule::constant(given);
        let drive = match self.description.choices.drive {
            Drive::Speed => motion::Drive::Speed(now),
            Drive::Torque => motion::Drive::Force(now),
        };
        let temperature =
            self.description.is_warmed().then(|| self.temperature(self.values[TEMPERATURE]));
        let start = match self.description.choices.start {
            Start::Rest => motion::Start::REST,
            Start::Given => motion::Start {
                belt_speed: self.value("start_belt_speed"),
                stretch: self.value("start_stretch"),
            },
            Start::Steady => {
                let now =
                    temperature.map_or(Ok(drag.clone()), |temperature| drag.at(temperature))?;
                motion::Start::steady(&train, &now, given)?
            }
        };
        let system = System::new(train, &drag, drive, temperature.map(Schedule::constant))?;
        Ok(Stepper::new(system, start, self.value("tolerance"), Integrator::Adaptive)?)
    }
}
