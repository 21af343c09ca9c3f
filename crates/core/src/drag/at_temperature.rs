//! The law of drag as it is at one temperature.

use super::{Drag, TemperatureLaw};
use crate::error::{Error, above, below, finite};

impl Drag {
    /// The same law, varying with temperature.
    ///
    /// # Errors
    /// If a value is not finite, or the reference temperature is not positive in its scale.
    pub fn with_temperature_law(mut self, temperature_law: TemperatureLaw) -> Result<Self, Error> {
        temperature_law.check()?;
        self.temperature_law = Some(temperature_law);
        Ok(self)
    }

    /// The law at one `temperature`, in the scale of its exponents.
    ///
    /// # Errors
    /// If the temperature is not positive, or the law leaves the range of numbers there.
    pub fn at(&self, temperature: f64) -> Result<Self, Error> {
        let Some(temperature_law) = self.temperature_law else { return Ok(self.clone()) };
        above("temperature", temperature, 0.0)?;
        let force = temperature_law.force_factor(temperature);
        let speed = temperature_law.speed_factor(temperature)?;
        let mut drag = self.clone();
        drag.temperature_law = None;
        for (v, f) in &mut drag.knots {
            *v = above("transition speed at this temperature", *v * speed, 0.0)?;
            *f = above("drag at this temperature", *f * force, 0.0)?;
        }
        drag.stick_speed = above("stick speed at this temperature", drag.stick_speed * speed, 0.0)?;
        drag.decay_speed = finite("stick speed at this temperature", drag.decay_speed * speed)?;
        let boundary = temperature_law.boundary_factor(temperature)?;
        let below_stick_speed = force * (1.0 + self.boundary_share() * (boundary - 1.0));
        let breakaway = drag.breakaway_force * below_stick_speed;
        drag.breakaway_force = finite("drag at this temperature", breakaway)?;
        if let Some(mixed) = &mut drag.mixed {
            mixed.viscosity /= speed;
            mixed.law = mixed.law.with_forces(force, boundary);
            drag.knots = vec![mixed.knot()?];
            below("stick_speed", drag.stick_speed, drag.transition_speed())?;
        }
        if !drag.rest.is_none() {
            drag.rest = drag.rest.scaled(temperature_law.rest_factor(temperature)?);
        }
        drag.check_rest()?;
        drag.rising_from = drag.found_rising_from();
        Ok(drag)
    }

    /// How the law varies with temperature, if it does.
    #[must_use]
    pub fn temperature_law(&self) -> Option<&TemperatureLaw> {
        self.temperature_law.as_ref()
    }
}
