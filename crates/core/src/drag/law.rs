//! The law of drag: its knots and branches, its closure, its values and slopes.

use super::{Closure, MixedContact, Mode, Rest, Strengthening, TemperatureLaw};
use crate::error::{Error, above, at_least, below, finite};
use crate::lubrication::mixed::MixedLaw;

/// Drag force of a lubricated contact as a function of sliding speed and temperature.
#[derive(Debug, Clone, PartialEq)]
pub struct Drag {
    /// (speed, force) where branches meet, speeds ascending.
    pub(super) knots: Vec<(f64, f64)>,
    /// Exponent of force in speed, below the first knot, between knots, above the last.
    pub(super) exponents: Vec<f64>,
    /// Knot of the transition between mixed and EHL.
    pub(super) transition: usize,
    /// The law of both branches, if it is that of mixed lubrication.
    pub(super) mixed: Option<MixedContact>,
    pub(super) stick_speed: f64,
    pub(super) closure: Closure,
    pub(super) breakaway_force: f64,
    /// Speed over which drag falls by a factor `e` below the stick speed.
    pub(super) decay_speed: f64,
    pub(super) strengthening: Option<Strengthening>,
    pub(super) rest: Rest,
    /// Speed from which on all drag together rises.
    pub(super) rising_from: f64,
    pub(super) temperature_law: Option<TemperatureLaw>,
}

impl Drag {
    /// The paper's law, from its value at the transition and the damping exponents on either side.
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
        let knots = vec![(transition_speed, transition_force)];
        Self::chain(knots, vec![1.0 + mixed_exponent, 1.0 + ehl_exponent], 0, stick_speed, closure)
    }

    /// A law through measured points `(speed, force)`: straight lines between them in logarithmic scales.
    ///
    /// Beyond the points the outer lines go on. The transition is the point of least force.
    ///
    /// # Errors
    /// If there are fewer than two points, speeds do not ascend, a value is not positive and finite, or
    /// `stick_speed` is not below the transition speed.
    pub fn tabulated(
        speeds: &[f64],
        forces: &[f64],
        stick_speed: f64,
        closure: Closure,
    ) -> Result<Self, Error> {
        if speeds.len() < 2 || speeds.len() != forces.len() {
            return Err(Error::TooFew { quantity: "points of the drag table", needed: 2 });
        }
        for (index, (speed, force)) in speeds.iter().zip(forces).enumerate() {
            above("speed of the drag table", *speed, 0.0)?;
            above("force of the drag table", *force, 0.0)?;
            if index > 0 && *speed <= speeds[index - 1] {
                return Err(Error::Backwards {
                    quantity: "speed of the drag table",
                    index,
                    value: *speed,
                });
            }
        }
        let between: Vec<f64> = (1..speeds.len())
            .map(|i| (forces[i] / forces[i - 1]).ln() / (speeds[i] / speeds[i - 1]).ln())
            .collect();
        let mut exponents = vec![between[0]];
        exponents.extend(&between);
        exponents.push(between[between.len() - 1]);
        let least =
            (0..forces.len()).min_by(|a, b| forces[*a].total_cmp(&forces[*b])).unwrap_or_default();
        let knots = speeds.iter().copied().zip(forces.iter().copied()).collect();
        Self::chain(knots, exponents, least, stick_speed, closure)
    }

    /// The law of mixed lubrication, of a contact of `law` at a `viscosity` (Pa s).
    ///
    /// # Errors
    /// If drag rises at all speeds, so that there is no transition, a value is not positive and finite, or `stick_speed`
    /// is not below the transition speed.
    pub fn mixed(
        law: MixedLaw,
        viscosity: f64,
        stick_speed: f64,
        closure: Closure,
    ) -> Result<Self, Error> {
        let contact = MixedContact { law, viscosity: above("viscosity", viscosity, 0.0)? };
        let mut drag = Self::without_closure(vec![contact.knot()?], vec![-1.0, 1.0], 0);
        drag.mixed = Some(contact);
        drag.closed(stick_speed, closure)
    }

    fn chain(
        knots: Vec<(f64, f64)>,
        exponents: Vec<f64>,
        transition: usize,
        stick_speed: f64,
        closure: Closure,
    ) -> Result<Self, Error> {
        Self::without_closure(knots, exponents, transition).closed(stick_speed, closure)
    }

    fn without_closure(knots: Vec<(f64, f64)>, exponents: Vec<f64>, transition: usize) -> Self {
        Self {
            knots,
            exponents,
            transition,
            mixed: None,
            stick_speed: f64::NAN,
            closure: Closure::Retained,
            breakaway_force: f64::NAN,
            decay_speed: f64::NAN,
            strengthening: None,
            rest: Rest::default(),
            rising_from: f64::NAN,
            temperature_law: None,
        }
    }

    fn closed(mut self, stick_speed: f64, closure: Closure) -> Result<Self, Error> {
        above("stick_speed", stick_speed, 0.0)?;
        below("stick_speed", stick_speed, self.transition_speed())?;
        closure.check()?;
        (self.stick_speed, self.decay_speed, self.closure) = (stick_speed, stick_speed, closure);
        let continuous = std::f64::consts::E * self.force_at_stick_speed();
        self.breakaway_force = finite("breakaway force", continuous)?;
        above("breakaway force", self.breakaway_force, 0.0)?;
        self.rising_from = self.found_rising_from();
        Ok(self)
    }

    /// The same law with another force that breaks a belt at rest away.
    ///
    /// # Errors
    /// If `breakaway_force` is not finite, or not above the drag at the stick speed.
    pub fn with_breakaway_force(mut self, breakaway_force: f64) -> Result<Self, Error> {
        let sliding = self.force_at_stick_speed();
        above("breakaway_force", breakaway_force, sliding)?;
        self.decay_speed = self.stick_speed / ((breakaway_force - sliding) / sliding).ln_1p();
        self.breakaway_force = breakaway_force;
        self.check_rest()?;
        Ok(self)
    }

    /// The same law with a static force that grows while the belt stands; only `Stiction` lets it stand.
    ///
    /// # Errors
    /// If growth is negative or time not positive.
    pub fn with_strengthening(mut self, strengthening: Strengthening) -> Result<Self, Error> {
        at_least("static_growth", strengthening.growth, 0.0)?;
        above("static_growth_time", strengthening.time, 0.0)?;
        self.strengthening = (strengthening.growth > 0.0).then_some(strengthening);
        Ok(self)
    }

    /// How the static force grows at rest, if it does and a belt may rest.
    #[must_use]
    pub fn strengthening(&self) -> Option<Strengthening> {
        self.strengthening.filter(|_| self.closure == Closure::Stiction)
    }

    /// The same law beside what else moves with the belt.
    ///
    /// # Errors
    /// If a value is not finite or negative, or the rest grows with speed as fast as the drag below the stick speed falls.
    pub fn with_rest(mut self, rest: Rest) -> Result<Self, Error> {
        at_least("rest_force", rest.force, 0.0)?;
        at_least("rest_damping", rest.damping, 0.0)?;
        self.rest = rest;
        self.check_rest()?;
        self.rising_from = self.found_rising_from();
        Ok(self)
    }

    /// A belt that the paper's rule holds while it moves is held the less the faster it is.
    pub(super) fn check_rest(&self) -> Result<(), Error> {
        if self.rest.damping > 0.0 && self.closure == Closure::Retained {
            below(
                "rest_damping",
                self.rest.damping,
                self.force_at_stick_speed() / self.decay_speed,
            )?;
        }
        Ok(())
    }

    fn force_at_stick_speed(&self) -> f64 {
        self.branch_force(self.branch(self.stick_speed), self.stick_speed)
    }

    /// Speed `v_t` where the mixed and the EHL branch meet.
    #[must_use]
    pub fn transition_speed(&self) -> f64 {
        self.knots[self.transition].0
    }

    /// Drag `F_t` at the transition speed.
    #[must_use]
    pub fn transition_force(&self) -> f64 {
        self.knots[self.transition].1
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

    /// What else moves with the belt.
    #[must_use]
    pub fn rest(&self) -> Rest {
        self.rest
    }

    /// `A`, the drag of the contact that a belt at rest can bear; if not given `e F(v_s)`, the paper's (Eq. 29).
    #[must_use]
    pub fn breakaway_force(&self) -> f64 {
        self.breakaway_force
    }

    /// Largest force that drag can oppose at `speed` (below `v_s`) without the belt accelerating (Eqs. 25-26), the rest
    /// of the drive counted.
    #[must_use]
    pub fn holding_force(&self, speed: f64) -> f64 {
        let u = speed.abs();
        match self.closure {
            Closure::Stiction => self.breakaway_force + self.rest.force,
            _ => self.exponential(u) + self.rest.at(u),
        }
    }

    /// Drag force in steady sliding at `speed`, with its sign and the rest of the drive; zero at rest, where it takes
    /// whatever value is needed.
    #[must_use]
    pub fn force(&self, speed: f64) -> f64 {
        let u = speed.abs();
        match u {
            0.0 => 0.0,
            _ => (self.contact_force(u) + self.rest.at(u) * self.smoothed(u).0).copysign(speed),
        }
    }

    /// Drag of the lubricated contact alone in steady sliding at `u > 0`.
    pub(crate) fn contact_force(&self, u: f64) -> f64 {
        if u >= self.stick_speed {
            self.branch_force(self.branch(u), u)
        } else {
            self.force_and_slope_below(u).0
        }
    }

    /// Share of a constant drag that acts at `u`, and its slope: less than one where the closure is smooth through zero.
    pub(crate) fn smoothed(&self, u: f64) -> (f64, f64) {
        if u >= self.stick_speed { (1.0, 0.0) } else { self.smoothed_below(u) }
    }

    /// The same below the stick speed, continued through zero speed.
    pub(crate) fn smoothed_below(&self, u: f64) -> (f64, f64) {
        let (share, slope) = self.closure.smoothed(u / self.stick_speed);
        (share, slope / self.stick_speed)
    }

    /// Slope of the drag force in steady sliding at `speed`.
    #[must_use]
    pub fn slope(&self, speed: f64) -> f64 {
        let u = speed.abs();
        let (share, growth) = self.smoothed(u);
        let contact = if u >= self.stick_speed {
            self.branch_force_and_slope(self.branch(u), u, 1.0).1
        } else {
            self.force_and_slope_below(u).1
        };
        contact + self.rest.damping * share + self.rest.at(u) * growth
    }

    /// Drag of the contact below the stick speed and its slope, continued through zero speed.
    pub(crate) fn force_and_slope_below(&self, u: f64) -> (f64, f64) {
        self.strengthened_below(u, 1.0)
    }

    /// The same after a rest that has made the static force `strength` times as large.
    #[inline]
    pub(crate) fn strengthened_below(&self, u: f64, strength: f64) -> (f64, f64) {
        let decay_speed = self.strengthened_decay_speed(strength);
        let exponential = strength * self.breakaway_force * (-u / decay_speed).exp();
        let (share, growth) = self.closure.smoothed(u / self.stick_speed);
        (exponential * share, exponential * (growth / self.stick_speed - share / decay_speed))
    }

    /// Speed over which drag then falls by a factor `e`, to what it is at the stick speed in any case.
    #[inline]
    pub(crate) fn strengthened_decay_speed(&self, strength: f64) -> f64 {
        if strength > 1.0 {
            self.stick_speed / (self.stick_speed / self.decay_speed + strength.ln())
        } else {
            self.decay_speed
        }
    }

    /// `A exp(-k u/v_s)` (Eq. 30, where k is 1).
    pub(crate) fn exponential(&self, u: f64) -> f64 {
        self.breakaway_force * (-u / self.decay_speed).exp()
    }

    /// Share of boundary friction in the drag at the stick speed, with which all below it varies.
    pub(crate) fn boundary_share(&self) -> f64 {
        self.mixed.map_or(0.0, |mixed| {
            let state = mixed.law.at(mixed.viscosity * self.stick_speed);
            state.boundary / state.force()
        })
    }

    /// Speed over which drag falls by a factor `e` below the stick speed.
    pub(crate) fn decay_speed(&self) -> f64 {
        self.decay_speed
    }

    /// Branch on which `u` lies; at a knot the upper one.
    pub(crate) fn branch(&self, u: f64) -> usize {
        self.knots.iter().take_while(|(speed, _)| *speed <= u).count()
    }

    /// Mode of motion on `branch`.
    pub(crate) fn branch_mode(&self, branch: usize) -> Mode {
        if branch > self.transition { Mode::Ehl } else { Mode::Mixed }
    }

    /// The law of mixed lubrication, if it is that.
    pub(crate) fn mixed_contact(&self) -> Option<&MixedContact> {
        self.mixed.as_ref()
    }

    /// Exponent of force in speed on `branch` of a chain of powers.
    pub(crate) fn branch_exponent(&self, branch: usize) -> f64 {
        self.exponents[branch]
    }

    /// Drag of the contact on `branch` at `u`, exact at the knots on either side of it.
    pub(crate) fn branch_force(&self, branch: usize, u: f64) -> f64 {
        if let Some(mixed) = &self.mixed {
            return mixed.force(u);
        }
        if let Some((speed, force)) = self.knots.get(branch)
            && u.total_cmp(speed).is_eq()
        {
            return *force;
        }
        let (speed, force) = self.knots[branch.saturating_sub(1)];
        force * (u / speed).powf(self.exponents[branch])
    }

    /// The same with its slope, boundary friction being `boundary` times as large.
    #[inline]
    pub(crate) fn branch_force_and_slope(
        &self,
        branch: usize,
        u: f64,
        boundary: f64,
    ) -> (f64, f64) {
        if let Some(mixed) = &self.mixed {
            return mixed.force_and_slope(u, boundary);
        }
        let force = self.branch_force(branch, u);
        (force, self.exponents[branch] * force / u)
    }

    /// Exponents of the mixed and the EHL branch, if these are all there is.
    pub(crate) fn two_branches(&self) -> Option<(f64, f64)> {
        match self.exponents[..] {
            [mixed, ehl] if self.mixed.is_none() => Some((mixed, ehl)),
            _ => None,
        }
    }

    /// Speed of the knot above `branch`.
    pub(crate) fn upper_knot(&self, branch: usize) -> Option<f64> {
        self.knots.get(branch).map(|knot| knot.0)
    }

    /// Speed of the knot below `branch`, if it is above the stick speed.
    pub(crate) fn lower_knot(&self, branch: usize) -> Option<f64> {
        branch.checked_sub(1).map(|i| self.knots[i].0).filter(|speed| *speed > self.stick_speed)
    }

    /// Whether the knot between `branch` and the one above is the transition.
    pub(crate) fn is_transition(&self, branch: usize) -> bool {
        branch == self.transition
    }
}
