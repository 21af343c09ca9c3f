//! The law of drag of a question.

use hersey_core::drag::{Closure, Drag, Rest, SpeedLaw, Strengthening, TemperatureLaw};
use hersey_core::lubrication::mixed::{MixedLaw, Sharing};
use hersey_core::lubrication::viscosity;

use crate::question::Question;
use crate::refusal::Refusal;

/// A law of drag as it was asked for.
///
/// Its numbers, in this order: shape (0 two powers, 1 points, 2 mixed lubrication); stick speed; closure (0 retained,
/// 1 stiction, 2 Stribeck, 3 `LuGre`), bristle stiffness and damping; static force (or none), force and damping of the
/// rest of the drive; growth of the static force and the time from which on; how it varies with temperature (0 not,
/// 1 powers, 2 as a viscosity of Arrhenius, 3 of Vogel, 4 of Walther), reference temperature, force exponent, slopes of
/// boundary friction and of the rest, three numbers of the speeds' law; a list of the numbers of the shape.
pub struct AskedLaw<'a> {
    shape: f64,
    stick_speed: f64,
    closure: Closure,
    static_force: Option<f64>,
    rest: Rest,
    strengthening: Strengthening,
    temperature_law: Option<TemperatureLaw>,
    numbers: &'a [f64],
}

impl<'a> AskedLaw<'a> {
    pub fn read(question: &mut Question<'a>) -> Result<Self, Refusal> {
        let [shape, stick_speed, closure, bristle_stiffness, bristle_damping] =
            question.numbers()?;
        let closure = match closure {
            0.0 => Closure::Retained,
            1.0 => Closure::Stiction,
            2.0 => Closure::Stribeck,
            3.0 => Closure::LuGre { bristle_stiffness, bristle_damping },
            _ => return Err(Refusal::Malformed("a closure of no known kind")),
        };
        let static_force = question.given()?;
        let [force, damping, growth, time] = question.numbers()?;
        let temperature_law = temperature_law(question)?;
        Ok(Self {
            shape,
            stick_speed,
            closure,
            static_force,
            rest: Rest { force, damping },
            strengthening: Strengthening { growth, time },
            temperature_law,
            numbers: question.list()?,
        })
    }

    /// The law at a temperature in the scale of its exponents, if it is to be at one, and there with another stick
    /// speed, if one is given.
    pub fn at(&self, temperature: Option<f64>, stick_speed: Option<f64>) -> Result<Drag, Refusal> {
        let own = self.own(self.stick_speed)?;
        let own = match self.temperature_law {
            Some(law) => own.with_temperature_law(law)?,
            None => own,
        };
        let drag = temperature.map_or(Ok(own.clone()), |temperature| own.at(temperature))?;
        let Some(stick_speed) = stick_speed else { return Ok(drag) };
        if let (0.0, [_, _, ehl, mixed]) = (self.shape, self.numbers) {
            let numbers = [drag.transition_force(), drag.transition_speed(), *ehl, *mixed];
            let static_force = self.static_force.map(|_| drag.breakaway_force());
            let same: AskedLaw<'_> = AskedLaw { static_force, rest: drag.rest(), ..*self };
            return AskedLaw { numbers: &numbers, ..same }.own(stick_speed);
        }
        let (Some(law), Some(temperature)) = (self.temperature_law, temperature) else {
            return self.own(stick_speed);
        };
        // the temperature moves it to where it is asked for
        let moved = stick_speed / (drag.stick_speed() / self.stick_speed);
        Ok(self.own(moved)?.with_temperature_law(law)?.at(temperature)?)
    }

    /// The law at its reference, with this stick speed.
    fn own(&self, stick_speed: f64) -> Result<Drag, Refusal> {
        let numbers = self.numbers;
        let drag = match (self.shape, numbers) {
            (0.0, [force, speed, ehl, mixed]) => {
                Drag::new(*force, *speed, *ehl, *mixed, stick_speed, self.closure)?
            }
            (1.0, points) if points.len().is_multiple_of(2) => {
                let (speeds, forces) = points.split_at(points.len() / 2);
                Drag::tabulated(speeds, forces, stick_speed, self.closure)?
            }
            (2.0, [viscosity, sharing @ ..]) => {
                let numbers = <[f64; 10]>::try_from(sharing)
                    .map_err(|_| Refusal::Malformed("a mixed law of other than ten numbers"))?;
                let law = MixedLaw::new(Sharing::from_numbers(numbers))?;
                Drag::mixed(law, *viscosity, stick_speed, self.closure)?
            }
            _ => return Err(Refusal::Malformed("a law of no known shape")),
        };
        let drag = match self.static_force {
            Some(force) => drag.with_breakaway_force(force)?,
            None => drag,
        };
        let drag = drag.with_rest(self.rest)?;
        Ok(match self.strengthening.growth {
            0.0 => drag,
            _ => drag.with_strengthening(self.strengthening)?,
        })
    }
}

fn temperature_law(question: &mut Question) -> Result<Option<TemperatureLaw>, Refusal> {
    let [kind, reference, force_exponent, boundary_slope, rest_slope, a, b, c] =
        question.numbers()?;
    let speed = match kind {
        0.0 => return Ok(None),
        1.0 => SpeedLaw::Power(a),
        2.0 => SpeedLaw::Viscosity(viscosity::TemperatureLaw::Arrhenius {
            prefactor: a,
            activation_energy: b,
        }),
        3.0 => SpeedLaw::Viscosity(viscosity::TemperatureLaw::Vogel {
            prefactor: a,
            slope: b,
            zero: c,
        }),
        4.0 => SpeedLaw::Viscosity(viscosity::TemperatureLaw::Walther { a, b, density: c }),
        _ => return Err(Refusal::Malformed("a temperature law of no known kind")),
    };
    Ok(Some(TemperatureLaw { reference, force_exponent, speed, boundary_slope, rest_slope }))
}

/// A law, the temperature at which it holds (or none) and its stick speed there (or its own).
pub fn drag(question: &mut Question) -> Result<Drag, Refusal> {
    let law = AskedLaw::read(question)?;
    let (temperature, stick_speed) = (question.given()?, question.given()?);
    law.at(temperature, stick_speed)
}
