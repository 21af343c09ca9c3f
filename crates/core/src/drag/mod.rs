//! Sliding drag against belt speed (Eqs. 17-30 of the paper).
//!
//! Each branch is written relative to the transition speed, `F = F_t (v/v_t)^(1+n)`, so that drag is
//! continuous there in any units. Drag is odd in speed: reversal works.

use crate::error::{Error, above, at_most, finite};

/// What the belt does near zero speed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Closure {
    /// The paper's rule (Eqs. 24-27): below the stick speed drag is `A exp(-|v|/v_s)`, and while the
    /// spring cannot overcome it the belt keeps its small speed.
    Retained,
}

/// State of lubrication, which decides the equation of motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// Full film: speed at or above the transition speed.
    Ehl,
    /// Mixed lubrication: between the stick speed and the transition speed.
    Mixed,
    /// Slower than the stick speed, and the spring overcomes the drag.
    Microslip,
    /// Slower than the stick speed, and the spring does not overcome the drag.
    Stuck,
}

/// Drag force of a lubricated contact as a function of sliding speed at one temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drag {
    transition_force: f64,
    transition_speed: f64,
    ehl_exponent: f64,
    mixed_exponent: f64,
    stick_speed: f64,
    closure: Closure,
    breakaway_force: f64,
}

impl Drag {
    /// A drag law from its value at the transition and the damping exponents on either side.
    ///
    /// `transition_force` is `F_t` at `transition_speed` `v_t`; the exponents are those of damping
    /// (`n` in `B = B_0 v^n`), so force varies as `v^(1+n)`; `stick_speed` is `v_s`.
    ///
    /// # Errors
    /// If a value is not finite, force or a speed is not positive, or `v_s` is not below `v_t`.
    pub fn new(
        transition_force: f64,
        transition_speed: f64,
        ehl_exponent: f64,
        mixed_exponent: f64,
        stick_speed: f64,
        closure: Closure,
    ) -> Result<Self, Error> {
        above("transition_force", transition_force, 0.0)?;
        above("transition_speed", transition_speed, 0.0)?;
        finite("ehl_exponent", ehl_exponent)?;
        finite("mixed_exponent", mixed_exponent)?;
        above("stick_speed", stick_speed, 0.0)?;
        at_most("stick_speed", stick_speed, transition_speed)?;
        let mut drag = Self {
            transition_force,
            transition_speed,
            ehl_exponent,
            mixed_exponent,
            stick_speed,
            closure,
            breakaway_force: f64::NAN,
        };
        drag.breakaway_force =
            finite("breakaway force", std::f64::consts::E * drag.power_law(stick_speed))?;
        Ok(drag)
    }

    /// Speed `v_t` where the mixed and the EHL branch meet.
    #[must_use]
    pub fn transition_speed(&self) -> f64 {
        self.transition_speed
    }

    /// Speed `v_s` below which the closure holds.
    #[must_use]
    pub fn stick_speed(&self) -> f64 {
        self.stick_speed
    }

    /// What the belt does near zero speed.
    #[must_use]
    pub fn closure(&self) -> Closure {
        self.closure
    }

    /// `A`, the drag that a belt at rest can bear: `e F(v_s)`, which makes drag continuous at `v_s` (Eq. 29).
    #[must_use]
    pub fn breakaway_force(&self) -> f64 {
        self.breakaway_force
    }

    /// Largest force that drag can oppose at `speed` (below `v_s`) without the belt accelerating (Eqs. 25-26).
    #[must_use]
    pub fn holding_force(&self, speed: f64) -> f64 {
        self.breakaway_force * (-speed.abs() / self.stick_speed).exp()
    }

    /// Drag force at `speed`, with the sign of `speed`; zero at rest, where it takes whatever value is needed.
    #[must_use]
    pub fn force(&self, speed: f64) -> f64 {
        let u = speed.abs();
        let magnitude = match u {
            0.0 => return 0.0,
            _ if u < self.stick_speed => self.holding_force(u),
            _ => self.power_law(u),
        };
        magnitude.copysign(speed)
    }

    /// Exponent of force in speed, `1 + n`, on the branch of `mode`.
    pub(crate) fn force_exponent(&self, mode: Mode) -> f64 {
        1.0 + if mode == Mode::Ehl { self.ehl_exponent } else { self.mixed_exponent }
    }

    /// Drag on the power-law branches, for `u >= v_s`.
    pub(crate) fn power_law(&self, u: f64) -> f64 {
        let mode = if u >= self.transition_speed { Mode::Ehl } else { Mode::Mixed };
        self.transition_force * (u / self.transition_speed).powf(self.force_exponent(mode))
    }
}
