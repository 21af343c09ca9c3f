//! The core's objects of a described drive.

use hersey_core::Error;
use hersey_core::drag::{self, Drag, Rest, SpeedLaw, Strengthening, TemperatureLaw};
use hersey_core::lubrication::mixed::{MixedLaw, Sharing};
use hersey_core::lubrication::viscosity;
use hersey_core::motion::{self, Drivetrain, Integrator, Schedule, Stepper, System};

use crate::description::{
    Choices, Closure, Coupling, Description, Drive, Law, Start, Values, Warmth,
};
use crate::variables::{TEMPERATURE, place_of};

/// A drive with the values that its variables have.
pub struct Making<'a> {
    pub description: &'a Description,
    pub values: &'a Values,
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
    pub fn words(&self, error: Error) -> String {
        match (error.quantity(), self.given("temperature_zero")) {
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

    fn closure(&self) -> drag::Closure {
        match self.description.choices.closure {
            Closure::Retained => drag::Closure::Retained,
            Closure::Stiction => drag::Closure::Stiction,
            Closure::Stribeck => drag::Closure::Stribeck,
            Closure::LuGre => drag::Closure::LuGre {
                bristle_stiffness: self.value("bristle_stiffness"),
                bristle_damping: self.value("bristle_damping"),
            },
        }
    }

    fn temperature_law(&self) -> Option<TemperatureLaw> {
        let number =
            |i: usize| self.description.viscosity_numbers.get(i).copied().unwrap_or(f64::NAN);
        let (a, b, c) = (number(0), number(1), number(2));
        let speed = match self.description.choices.warmth {
            Warmth::None => return None,
            Warmth::Power => SpeedLaw::Power(self.value("speed_temperature_exponent")),
            Warmth::Arrhenius => SpeedLaw::Viscosity(viscosity::TemperatureLaw::Arrhenius {
                prefactor: a,
                activation_energy: b,
            }),
            Warmth::Vogel => SpeedLaw::Viscosity(viscosity::TemperatureLaw::Vogel {
                prefactor: a,
                slope: b,
                zero: c,
            }),
            Warmth::Walther => {
                SpeedLaw::Viscosity(viscosity::TemperatureLaw::Walther { a, b, density: c })
            }
        };
        Some(TemperatureLaw {
            reference: self.temperature(self.value("reference_temperature")),
            force_exponent: self.given("force_temperature_exponent").unwrap_or(0.0),
            speed,
            boundary_slope: self.given("boundary_temperature_slope").unwrap_or(0.0),
            rest_slope: self.given("rest_temperature_slope").unwrap_or(0.0),
        })
    }

    fn shape(&self) -> Result<Drag, Error> {
        let (stick_speed, closure) = (self.value("stick_speed"), self.closure());
        let Description { choices, speeds, forces, numbers, .. } = self.description;
        match (choices.law, <[f64; 10]>::try_from(&numbers[..])) {
            (Law::Power, _) => Drag::new(
                self.value("transition_force"),
                self.value("transition_speed"),
                self.value("ehl_exponent"),
                self.value("mixed_exponent"),
                stick_speed,
                closure,
            ),
            (Law::Mixed, Ok(numbers)) => {
                let law = MixedLaw::new(Sharing::from_numbers(numbers))?;
                Drag::mixed(law, self.value("viscosity"), stick_speed, closure)
            }
            _ => Drag::tabulated(speeds, forces, stick_speed, closure),
        }
    }

    fn drag(&self) -> Result<Drag, Error> {
        let drag = self.shape()?;
        let drag = match self.given("static_force") {
            Some(force) => drag.with_breakaway_force(force)?,
            None => drag,
        };
        let rest = Rest { force: self.value("rest_force"), damping: self.value("rest_damping") };
        let drag = drag.with_rest(rest)?;
        let drag = match self.given("static_growth").filter(|growth| *growth != 0.0) {
            Some(growth) => drag.with_strengthening(Strengthening {
                growth,
                time: self.value("static_growth_time"),
            })?,
            None => drag,
        };
        self.temperature_law().map_or(Ok(drag.clone()), |law| drag.with_temperature_law(law))
    }

    /// The motion from its start, at the inputs as they are.
    pub fn stepper(&self) -> Result<Stepper, Error> {
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
        Stepper::new(system, start, self.value("tolerance"), Integrator::Adaptive)
    }
}
