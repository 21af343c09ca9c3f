//! The law of drag of a question, and the names of all that it can be made of.

use hersey_core::drag::form::{Kinds, LISTS, NUMBERS, Shape, ShapeKind, TemperatureKind};
use hersey_core::drag::{ClosureKind, Drag, DragForm};
use hersey_core::lubrication::mixed::Sharing;
use hersey_core::lubrication::viscosity::ViscosityKind;
use hersey_core::wire::Values;

use crate::question::Question;
use crate::refusal::{Refusal, quoted};

/// The values of a drag: its numbers in the order of `NUMBERS`, not a number where one is not given, and its lists.
struct AskedValues<'a> {
    numbers: [f64; NUMBERS.len()],
    lists: [&'a [f64]; LISTS.len()],
}

impl Values for AskedValues<'_> {
    fn word(&self, _: &str) -> Option<&str> {
        None
    }

    fn number(&self, field: &str) -> Option<f64> {
        let place = NUMBERS.iter().position(|name| *name == field)?;
        Some(self.numbers[place]).filter(|number| !number.is_nan())
    }

    fn numbers(&self, field: &str) -> Option<&[f64]> {
        let place = LISTS.iter().position(|name| *name == field)?;
        Some(self.lists[place])
    }
}

/// A law of drag as it was asked for: the places of its law, closure and temperature law among their words, its numbers
/// in the order of `NUMBERS`, and its lists in the order of `LISTS`.
pub struct AskedLaw(DragForm);

impl AskedLaw {
    pub fn read(question: &mut Question) -> Result<Self, Refusal> {
        let kinds = Kinds {
            shape: question.one_of(ShapeKind::ALL)?,
            closure: question.one_of(ClosureKind::ALL)?,
            temperature: question.one_of(TemperatureKind::all())?,
        };
        let numbers = question.numbers()?;
        let mut lists: [&[f64]; LISTS.len()] = Default::default();
        for list in &mut lists {
            *list = question.list()?;
        }
        Ok(Self(DragForm::of(kinds, &AskedValues { numbers, lists })?))
    }

    /// The law at a temperature in the scale of its exponents, if it is to be at one, and there with another stick
    /// speed, if one is given.
    pub fn at(&self, temperature: Option<f64>, stick_speed: Option<f64>) -> Result<Drag, Refusal> {
        let own = self.0.law()?;
        let drag = temperature.map_or(Ok(own.clone()), |temperature| own.at(temperature))?;
        let Some(stick_speed) = stick_speed else { return Ok(drag) };
        let there = DragForm { stick_speed, temperature_law: None, ..self.0.clone() };
        if let Shape::Power { ehl_exponent, mixed_exponent, .. } = self.0.shape {
            let shape = Shape::Power {
                transition_force: drag.transition_force(),
                transition_speed: drag.transition_speed(),
                ehl_exponent,
                mixed_exponent,
            };
            let static_force = self.0.static_force.map(|_| drag.breakaway_force());
            return Ok(DragForm { shape, static_force, rest: drag.rest(), ..there }.law()?);
        }
        let (Some(_), Some(temperature)) = (self.0.temperature_law, temperature) else {
            return Ok(there.law()?);
        };
        // the temperature moves it to where it is asked for
        let moved = stick_speed / (drag.stick_speed() / self.0.stick_speed);
        Ok(DragForm { stick_speed: moved, ..self.0.clone() }.law()?.at(temperature)?)
    }
}

/// A law, the temperature at which it holds (or none) and its stick speed there (or its own).
pub fn drag(question: &mut Question) -> Result<Drag, Refusal> {
    let law = AskedLaw::read(question)?;
    let (temperature, stick_speed) = (question.given()?, question.given()?);
    law.at(temperature, stick_speed)
}

/// All names of which a law of drag is made, as JSON: words of its choices in the order of their places, names of its
/// numbers and lists, those of the numbers of mixed lubrication, and coefficients of each law of viscosity.
pub fn names() -> String {
    let list = |words: &[&str]| {
        format!("[{}]", words.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(","))
    };
    let viscosities = ViscosityKind::ALL
        .map(|kind| format!("{}:{}", quoted(kind.word()), list(kind.form().coefficients)));
    let temperatures: Vec<_> = TemperatureKind::all().map(TemperatureKind::word).collect();
    let entries = [
        ("law", list(&ShapeKind::WORDS)),
        ("closure", list(&ClosureKind::WORDS)),
        ("temperature_law", list(&temperatures)),
        ("numbers", list(&NUMBERS)),
        ("lists", list(&LISTS)),
        ("sharing", list(&Sharing::NAMES)),
        ("viscosity", format!("{{{}}}", viscosities.join(","))),
    ];
    let entries = entries.map(|(name, value)| format!("{}:{value}", quoted(name)));
    format!("{{{}}}", entries.join(","))
}
