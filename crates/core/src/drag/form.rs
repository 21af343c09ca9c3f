//! A drag in the wire form: its kinds and its values by name.
//!
//! | field             | value                                                                                |
//! |-------------------|--------------------------------------------------------------------------------------|
//! | `law`             | a word of `ShapeKind`: the numbers or lists of the shape go with it                  |
//! | `closure`         | a word of `ClosureKind`                                                              |
//! | `temperature_law` | a word of `TemperatureKind`: none, power, or a law of viscosity with its coefficients |
//! | `NUMBERS`         | numbers; temperatures in K, counted from `temperature_zero`                           |
//! | `LISTS`           | lists of numbers                                                                     |

use super::{Closure, ClosureKind, Drag, Rest, SpeedLaw, Strengthening, TemperatureLaw};
use crate::error::Error;
use crate::lubrication::mixed::{MixedLaw, Sharing};
use crate::lubrication::viscosity::{self, ViscosityKind};
use crate::wire::{Unreadable, Values, exactly, kinds, unknown};

kinds! {
    /// Shapes of a law of drag, by their words.
    ShapeKind of "law" {
        /// Two power branches.
        Power = "power",
        /// A chain of branches through points.
        Table = "table",
        /// Film and asperities share the load.
        Mixed = "mixed",
    }
}

/// How a drag varies with temperature, by its word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TemperatureKind {
    /// Not at all.
    None,
    /// Forces and speeds as powers.
    Power,
    /// Speeds as the inverse of a viscosity.
    Viscosity(ViscosityKind),
}

impl TemperatureKind {
    /// All of them, in the order in which they are numbered.
    pub fn all() -> impl Iterator<Item = Self> {
        let viscosities = ViscosityKind::ALL.into_iter().map(Self::Viscosity);
        [Self::None, Self::Power].into_iter().chain(viscosities)
    }

    /// The word of this one.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Power => "power",
            Self::Viscosity(kind) => kind.word(),
        }
    }

    /// The kind of a word.
    ///
    /// # Errors
    /// If there is none, with those that there are.
    pub fn of(word: &str) -> Result<Self, Unreadable> {
        Self::all().find(|kind| kind.word() == word).ok_or_else(|| {
            unknown("temperature_law", word, &Self::all().map(Self::word).collect::<Vec<_>>())
        })
    }
}

/// Names of the choices of a drag.
pub const CHOICES: [&str; 3] = ["law", "closure", "temperature_law"];

/// Names of the numbers of a drag, of any kind.
pub const NUMBERS: [&str; 19] = [
    "stick_speed",
    "transition_force",
    "transition_speed",
    "ehl_exponent",
    "mixed_exponent",
    "viscosity",
    "bristle_stiffness",
    "bristle_damping",
    "static_force",
    "rest_force",
    "rest_damping",
    "static_growth",
    "static_growth_time",
    "reference_temperature",
    "temperature_zero",
    "force_temperature_exponent",
    "speed_temperature_exponent",
    "boundary_temperature_slope",
    "rest_temperature_slope",
];

/// Names of the lists of a drag.
pub const LISTS: [&str; 4] = ["speeds", "forces", "numbers", "viscosity_numbers"];

/// Whether a field is one of such a drag, and if so whether it must be given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Belongs {
    /// It is not.
    No,
    /// It may be given.
    Optional,
    /// It must be given.
    Needed,
}

/// The choices of a drag.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Kinds {
    /// Shape of the law.
    pub shape: ShapeKind,
    /// What the belt does near rest.
    pub closure: ClosureKind,
    /// How the law varies with temperature.
    pub temperature: TemperatureKind,
}

impl Kinds {
    /// From the words of values.
    ///
    /// # Errors
    /// If a word is missing or not known.
    pub fn read(values: &impl Values) -> Result<Self, Unreadable> {
        let word = |field: &'static str| {
            values.word(field).ok_or(Unreadable::Missing { field, choice: None })
        };
        Ok(Self {
            shape: ShapeKind::of(word("law")?)?,
            closure: ClosureKind::of(word("closure")?)?,
            temperature: TemperatureKind::of(word("temperature_law")?)?,
        })
    }

    /// Whether a number or list is one of such a drag; `No` of what is no field of a drag, too.
    #[must_use]
    pub fn belongs(self, field: &str) -> Belongs {
        let Self { shape, closure, temperature } = self;
        let varies = temperature != TemperatureKind::None;
        let (is_there, needed) = match field {
            "stick_speed" => (true, true),
            "transition_force" | "transition_speed" | "ehl_exponent" | "mixed_exponent" => {
                (shape == ShapeKind::Power, true)
            }
            "speeds" | "forces" => (shape == ShapeKind::Table, true),
            "viscosity" | "numbers" => (shape == ShapeKind::Mixed, true),
            "bristle_stiffness" | "bristle_damping" => (closure == ClosureKind::LuGre, true),
            "static_growth" | "static_growth_time" => (closure == ClosureKind::Stiction, false),
            "static_force" | "rest_force" | "rest_damping" => (true, false),
            "reference_temperature" => (varies, true),
            "force_temperature_exponent" | "speed_temperature_exponent" => {
                (temperature == TemperatureKind::Power, true)
            }
            "temperature_zero" => (temperature == TemperatureKind::Power, false),
            "viscosity_numbers" => (matches!(temperature, TemperatureKind::Viscosity(_)), true),
            "boundary_temperature_slope" => (varies && shape == ShapeKind::Mixed, false),
            "rest_temperature_slope" => (varies, false),
            _ => (false, false),
        };
        match (is_there, needed) {
            (false, _) => Belongs::No,
            (true, false) => Belongs::Optional,
            (true, true) => Belongs::Needed,
        }
    }

    /// How many numbers a list must have, if that is fixed.
    #[must_use]
    pub fn count(self, list: &str) -> Option<usize> {
        match (list, self.temperature) {
            ("numbers", _) => Some(Sharing::NAMES.len()),
            ("viscosity_numbers", TemperatureKind::Viscosity(kind)) => {
                Some(kind.form().coefficients.len())
            }
            _ => None,
        }
    }

    /// The choice by which a field is needed, if it is not always.
    fn choice(self, field: &str) -> Option<(&'static str, &'static str)> {
        match field {
            "stick_speed" => None,
            "bristle_stiffness" | "bristle_damping" | "static_growth_time" => {
                Some(("closure", self.closure.word()))
            }
            "reference_temperature"
            | "force_temperature_exponent"
            | "speed_temperature_exponent"
            | "viscosity_numbers" => Some(("temperature_law", self.temperature.word())),
            _ => Some(("law", self.shape.word())),
        }
    }
}

/// Numbers of the shape of a law.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// As of `Drag::new`.
    Power {
        /// Drag at the transition.
        transition_force: f64,
        /// Where both branches meet.
        transition_speed: f64,
        /// Exponent of damping above.
        ehl_exponent: f64,
        /// Exponent of damping below.
        mixed_exponent: f64,
    },
    /// As of `Drag::tabulated`.
    Table {
        /// Ascending.
        speeds: Vec<f64>,
        /// One for each speed.
        forces: Vec<f64>,
    },
    /// As of `Drag::mixed`.
    Mixed {
        /// The contact.
        sharing: Sharing,
        /// Viscosity at the reference, Pa s.
        viscosity: f64,
    },
}

/// A drag as plain values, of which its law is made.
#[derive(Debug, Clone, PartialEq)]
pub struct DragForm {
    /// Drag against speed.
    pub shape: Shape,
    /// Speed below which the closure holds.
    pub stick_speed: f64,
    /// What the belt does there.
    pub closure: Closure,
    /// Force that breaks a belt at rest away, if it is not the one of Eq. 29.
    pub static_force: Option<f64>,
    /// What else moves with the belt.
    pub rest: Rest,
    /// How the static force grows at rest.
    pub strengthening: Option<Strengthening>,
    /// How all of it varies with temperature.
    pub temperature_law: Option<TemperatureLaw>,
}

/// Values that must or may be given for such kinds.
struct Reader<'a, V: Values>(Kinds, &'a V);

impl<'a, V: Values> Reader<'a, V> {
    fn missing(&self, field: &'static str) -> Unreadable {
        Unreadable::Missing { field, choice: self.0.choice(field) }
    }

    fn number(&self, field: &'static str) -> Result<f64, Unreadable> {
        self.1.number(field).ok_or_else(|| self.missing(field))
    }

    fn or_none(&self, field: &str) -> f64 {
        self.1.number(field).unwrap_or(0.0)
    }

    fn list(&self, field: &'static str) -> Result<&'a [f64], Unreadable> {
        self.1.numbers(field).ok_or_else(|| self.missing(field))
    }

    fn shape(&self) -> Result<Shape, Unreadable> {
        Ok(match self.0.shape {
            ShapeKind::Power => Shape::Power {
                transition_force: self.number("transition_force")?,
                transition_speed: self.number("transition_speed")?,
                ehl_exponent: self.number("ehl_exponent")?,
                mixed_exponent: self.number("mixed_exponent")?,
            },
            ShapeKind::Table => Shape::Table {
                speeds: self.list("speeds")?.to_vec(),
                forces: self.list("forces")?.to_vec(),
            },
            ShapeKind::Mixed => Shape::Mixed {
                sharing: Sharing::from_numbers(exactly("numbers", self.list("numbers")?)?),
                viscosity: self.number("viscosity")?,
            },
        })
    }

    fn strengthening(&self) -> Result<Option<Strengthening>, Unreadable> {
        let growth = self.1.number("static_growth").filter(|growth| *growth != 0.0);
        let of = |growth| Ok(Strengthening { growth, time: self.number("static_growth_time")? });
        growth.map(of).transpose()
    }

    fn temperature_law(&self) -> Result<Option<TemperatureLaw>, Unreadable> {
        let (force_exponent, speed) = match self.0.temperature {
            TemperatureKind::None => return Ok(None),
            TemperatureKind::Power => {
                let speed = SpeedLaw::Power(self.number("speed_temperature_exponent")?);
                (self.number("force_temperature_exponent")?, speed)
            }
            TemperatureKind::Viscosity(kind) => {
                let coefficients = self.list("viscosity_numbers")?;
                let law = viscosity::TemperatureLaw::from_coefficients(kind, coefficients)?;
                (0.0, SpeedLaw::Viscosity(law))
            }
        };
        Ok(Some(TemperatureLaw {
            reference: self.number("reference_temperature")? - self.or_none("temperature_zero"),
            force_exponent,
            speed,
            boundary_slope: self.or_none("boundary_temperature_slope"),
            rest_slope: self.or_none("rest_temperature_slope"),
        }))
    }
}

impl DragForm {
    /// From values by name; those that do not belong to its kinds are not looked at.
    ///
    /// # Errors
    /// If a kind is not known, or a value that it needs is not given.
    pub fn read(values: &impl Values) -> Result<Self, Unreadable> {
        Self::of(Kinds::read(values)?, values)
    }

    /// From values by name, of kinds that are known.
    ///
    /// # Errors
    /// If a value that they need is not given.
    pub fn of(kinds: Kinds, values: &impl Values) -> Result<Self, Unreadable> {
        let reader = Reader(kinds, values);
        let bristles = (values.number("bristle_stiffness"), values.number("bristle_damping"));
        Ok(Self {
            shape: reader.shape()?,
            stick_speed: reader.number("stick_speed")?,
            closure: Closure::of(kinds.closure, bristles)?,
            static_force: values.number("static_force"),
            rest: Rest {
                force: reader.or_none("rest_force"),
                damping: reader.or_none("rest_damping"),
            },
            strengthening: reader.strengthening()?,
            temperature_law: reader.temperature_law()?,
        })
    }

    /// The law of drag of these values.
    ///
    /// # Errors
    /// If the physics cannot work with one of them.
    pub fn law(&self) -> Result<Drag, Error> {
        let (stick_speed, closure) = (self.stick_speed, self.closure);
        let drag = match &self.shape {
            Shape::Power { transition_force, transition_speed, ehl_exponent, mixed_exponent } => {
                Drag::new(
                    *transition_force,
                    *transition_speed,
                    *ehl_exponent,
                    *mixed_exponent,
                    stick_speed,
                    closure,
                )?
            }
            Shape::Table { speeds, forces } => {
                Drag::tabulated(speeds, forces, stick_speed, closure)?
            }
            Shape::Mixed { sharing, viscosity } => {
                Drag::mixed(MixedLaw::new(*sharing)?, *viscosity, stick_speed, closure)?
            }
        };
        let drag = match self.static_force {
            Some(force) => drag.with_breakaway_force(force)?,
            None => drag,
        };
        let drag = drag.with_rest(self.rest)?;
        let drag = match self.strengthening {
            Some(strengthening) => drag.with_strengthening(strengthening)?,
            None => drag,
        };
        match self.temperature_law {
            Some(law) => drag.with_temperature_law(law),
            None => Ok(drag),
        }
    }
}
