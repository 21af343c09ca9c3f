//! Sliding drag against belt speed (Eqs. 17-30 of the paper).
//!
//! A law is a chain of power branches `F = F_k (v/v_k)^p` that meet at knots `(v_k, F_k)`. Two branches
//! that meet at the transition are the paper's law; a chain through measured points is a tabulated one,
//! monotone between its points. Drag is odd in speed: reversal works.
//!
//! Below the stick speed `v_s` drag falls from the force `A` that breaks a belt at rest away to that of the law at
//! `v_s`: `A exp(-k |v|/v_s)` with `k = ln(A/F(v_s))`. The paper's `A = e F(v_s)` makes `k = 1` (Eqs. 28-30).
//!
//! With temperature the law keeps its shape: all forces vary as `(T/T_0)^b`, all speeds, the stick speed
//! among them, as `(T/T_0)^d`. Two fitted surfaces `B = a T^b w^c` that meet at a transition are of this form.
//!
//! A third law is that of mixed lubrication, where film and asperities share the load: smooth, it falls and rises by
//! itself, and its knot is the speed of least force. It hangs on viscosity times speed, which moves its speeds with
//! temperature, and on boundary friction.
//!
//! Beside the lubricated contact stands the rest of the drive, `r_0 + r_1 v`: bearings, gears, the roll's own losses.

mod closure;
mod temperature;

pub use closure::Closure;
pub use temperature::{SpeedLaw, TemperatureLaw};

use crate::error::{Error, above, at_least, below, finite};
use crate::lubrication::mixed::MixedLaw;

/// State of lubrication, which decides the equation of motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// Full film: speed at or above the transition speed.
    Ehl,
    /// Mixed lubrication: between the stick speed and the transition speed.
    Mixed,
    /// Slower than the stick speed, and moving as the forces say.
    Microslip,
    /// Slower than the stick speed, and held by the drag.
    Stuck,
}

/// What moves with the belt besides the lubricated contact: a drag of its own, `force + damping v`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rest {
    /// Drag at any speed.
    pub force: f64,
    /// Drag per speed.
    pub damping: f64,
}

impl Rest {
    /// Drag at `u >= 0`.
    pub(crate) fn at(&self, u: f64) -> f64 {
        self.force + self.damping * u
    }

    /// Whether there is any.
    pub(crate) fn is_none(&self) -> bool {
        self.force == 0.0 && self.damping == 0.0
    }

    /// The same, `factor` times as large.
    pub(crate) fn scaled(self, factor: f64) -> Self {
        Self { force: self.force * factor, damping: self.damping * factor }
    }
}

/// Drag force of a lubricated contact as a function of sliding speed and temperature.
#[derive(Debug, Clone, PartialEq)]
pub struct Drag {
    /// (speed, force) where branches meet, speeds ascending.
    knots: Vec<(f64, f64)>,
    /// Exponent of force in speed, below the first knot, between knots, above the last.
    exponents: Vec<f64>,
    /// Knot of the transition between mixed and EHL.
    transition: usize,
    /// The law of both branches, if it is that of mixed lubrication.
    mixed: Option<MixedContact>,
    stick_speed: f64,
    closure: Closure,
    breakaway_force: f64,
    /// Speed over which drag falls by a factor `e` below the stick speed.
    decay_speed: f64,
    strengthening: Option<Strengthening>,
    rest: Rest,
    /// Speed from which on all drag together rises.
    rising_from: f64,
    temperature_law: Option<TemperatureLaw>,
}

/// How the force that breaks a belt at rest away grows with the time at rest, with its logarithm.
///
/// E. Rabinowicz, J. Appl. Phys. 22 (1951) 1373; J. H. Dieterich, J. Geophys. Res. 77 (1972) 3690:
/// `A (1 + growth ln(1 + t/time))`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Strengthening {
    /// Relative growth per e-fold of time.
    pub growth: f64,
    /// Time from which on it grows.
    pub time: f64,
}

impl Strengthening {
    /// Factor of the static force after `rest` at rest.
    pub(crate) fn at(&self, rest: f64) -> f64 {
        1.0 + self.growth * (rest / self.time).ln_1p()
    }
}

/// A contact whose load film and asperities share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MixedContact {
    pub law: MixedLaw,
    pub viscosity: f64,
}

impl MixedContact {
    /// Speed and force of the transition.
    fn knot(&self) -> Result<(f64, f64), Error> {
        let transition = self.law.transition().ok_or(Error::NotFalling { quantity: "drag" })?;
        Ok((above("transition_speed", transition.product / self.viscosity, 0.0)?, transition.force))
    }

    /// Speed of the transition with `boundary` times the boundary friction; zero where there is none.
    #[inline(never)]
    pub(crate) fn transition_speed(&self, boundary: f64) -> f64 {
        self.law.transition_product(boundary).map_or(0.0, |product| product / self.viscosity)
    }

    #[inline(never)]
    fn force(&self, u: f64) -> f64 {
        self.law.force(self.viscosity * u)
    }

    /// Force and slope at `u`, boundary friction being `boundary` times as large.
    #[inline(never)]
    fn force_and_slope(&self, u: f64, boundary: f64) -> (f64, f64) {
        let (force, slope) =
            self.law.with_forces(1.0, boundary).force_and_slope(self.viscosity * u);
        (force, slope * self.viscosity)
    }
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
    fn check_rest(&self) -> Result<(), Error> {
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
        drag.rest = drag.rest.scaled(temperature_law.rest_factor(temperature)?);
        drag.check_rest()?;
        drag.rising_from = drag.found_rising_from();
        Ok(drag)
    }

    /// How the law varies with temperature, if it does.
    #[must_use]
    pub fn temperature_law(&self) -> Option<&TemperatureLaw> {
        self.temperature_law.as_ref()
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

    /// The speeds on either side of the transition at which drag has risen to `force`: below it none, so zero, where
    /// the stick speed is reached first; above it infinite, where drag never gets there.
    ///
    /// On a law that falls to its least force and rises from it these are the only ones; for less force, both are the
    /// speed of least force.
    #[must_use]
    pub fn speeds_of(&self, force: f64) -> (f64, f64) {
        let smooth = self.rest.damping > 0.0 || self.mixed.is_some();
        let foot = if smooth { self.rising_from() } else { self.transition_speed() };
        if force <= self.force(foot) {
            return (foot, foot);
        }
        if smooth {
            return self.searched_speeds(force, foot);
        }
        let force = force - self.rest.force;
        let on = |branch: usize, knot: usize| {
            let ((v, f), exponent) = (self.knots[knot], self.exponents[branch]);
            v * (force / f).powf(1.0 / exponent)
        };
        let slower = (self.branch(self.stick_speed)..=self.transition).rev().find_map(|branch| {
            let low = self.lower_knot(branch).unwrap_or(self.stick_speed);
            (self.branch_force(branch, low) >= force).then(|| on(branch, branch))
        });
        let faster = (self.transition + 1..self.exponents.len()).find_map(|branch| {
            let reached = match self.knots.get(branch) {
                Some((_, end)) => *end >= force,
                None => self.exponents[branch] > 0.0,
            };
            reached.then(|| on(branch, branch - 1))
        });
        (slower.unwrap_or(0.0), faster.unwrap_or(f64::INFINITY))
    }

    /// As `speeds_of`, on either side of the speed of least force, by halving.
    fn searched_speeds(&self, force: f64, foot: f64) -> (f64, f64) {
        let slower = if self.force(self.stick_speed) < force {
            0.0
        } else {
            halved(self.stick_speed, foot, |v| self.force(v) >= force)
        };
        let mut high = 2.0 * foot;
        while self.force(high) < force {
            high *= 2.0;
            if high > HIGHEST * foot {
                return (slower, f64::INFINITY);
            }
        }
        (slower, halved(0.5 * high, high, |v| self.force(v) < force))
    }

    /// Speed from which on the drag rises, the rest of the drive counted: the transition speed, or below it where the
    /// rest rises more than the contact falls; above it the last speed at which it falls.
    #[must_use]
    pub fn rising_from(&self) -> f64 {
        self.rising_from
    }

    fn found_rising_from(&self) -> f64 {
        if self.mixed.is_some() {
            return self.mixed_rising_from();
        }
        let mut from = self.stick_speed;
        for branch in self.branch(self.stick_speed)..self.exponents.len() {
            let (exponent, end) =
                (self.exponents[branch], self.upper_knot(branch).unwrap_or(f64::INFINITY));
            if exponent >= 0.0 {
                continue;
            }
            let (speed, force) = self.knots[branch.saturating_sub(1)];
            // where exponent F/v = -damping
            let fall = -exponent * force / speed;
            let least = if self.rest.damping > 0.0 {
                speed * (fall / self.rest.damping).powf(1.0 / (1.0 - exponent))
            } else {
                f64::INFINITY
            };
            from = from.max(least.min(end));
        }
        from
    }

    fn mixed_rising_from(&self) -> f64 {
        let transition = self.transition_speed();
        if self.rest.damping == 0.0 {
            return transition;
        }
        let falls = |v: f64| self.slope(v) < 0.0;
        let mut low = transition;
        while !falls(low) {
            if low <= self.stick_speed {
                return self.stick_speed;
            }
            low *= STRIDE;
        }
        halved(low.max(self.stick_speed), (low / STRIDE).min(transition), falls)
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

/// Step in which a speed of least force is looked for, as a factor.
const STRIDE: f64 = 0.97;
/// Most that a speed is looked for beyond that of least force.
const HIGHEST: f64 = 1e12;

/// Where `holds`, which is true at `low` and not at `high`, changes.
fn halved(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    while high - low > f64::EPSILON * high {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if holds(middle) { low = middle } else { high = middle }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[allow(clippy::float_cmp)] // limits are given as they are
    fn speeds_of_a_force_have_that_force() {
        let drag = Drag::new(50.0, 1.0, -0.7, -1.2, 0.01, Closure::Retained).unwrap();
        let (slow, fast) = drag.speeds_of(100.0);
        // (v)^-0.2 = 2, (v)^0.3 = 2
        assert!((slow - 1.0 / 32.0).abs() < 1e-15 && (fast - 2_f64.powf(1.0 / 0.3)).abs() < 1e-13);
        assert_eq!(drag.speeds_of(50.0), (1.0, 1.0));
        assert_eq!(drag.speeds_of(10.0), (1.0, 1.0));
        // beyond the drag at the stick speed, 125.6, the belt is held
        assert_eq!(drag.speeds_of(126.0).0, 0.0);
        assert!(drag.speeds_of(125.0).0 > 0.01);
        assert_eq!(drag.speeds_of(f64::INFINITY), (0.0, f64::INFINITY));
        let (speeds, forces) = ([0.01, 0.1, 1.0, 3.0, 9.0], [120.0, 80.0, 50.0, 70.0, 75.0]);
        let table = Drag::tabulated(&speeds, &forces, 0.02, Closure::Retained).unwrap();
        for force in [55.0, 69.0, 72.0, 79.0, 85.0, 100.0] {
            let (slow, fast) = table.speeds_of(force);
            assert!((table.force(slow) / force - 1.0).abs() < 1e-13 && slow < 1.0, "{force}");
            assert!((table.force(fast) / force - 1.0).abs() < 1e-13 && fast > 1.0, "{force}");
        }
        assert_eq!(table.speeds_of(119.0).0, 0.0);
        let falling = Drag::new(50.0, 1.0, -1.1, -1.2, 0.01, Closure::Retained).unwrap();
        assert_eq!(falling.speeds_of(60.0).1, f64::INFINITY);
    }
}
