//! The next piece of smooth motion: held in closed form, as a Taylor series, or by a Runge-Kutta step.

use super::event::ROUNDING;
use super::hybrid::Motion;
use super::piece::{Path, Phase, Piece};
use super::polynomial::{INVERSE, ORDER, Polynomial, first_crossing, value};
use super::recurrence::{Recurrence, product};
use super::runge_kutta::{Flow, Formula, growth};
use super::schedule::Cubic;
use super::sharing::SharingStart;
use super::system::Integrator;
use super::taylor::{Series, Slip, SlipStart, UNCHANGED, creep_series, held_series, rough_root};
use crate::drag::{Closure, Mode, Strengthening, TemperatureLaw};
use crate::error::Error;

/// Longest step in units of `sqrt(m/k)`, about half a period of the free oscillation.
const LONGEST_STEP: f64 = 3.0;

/// Decay over the time in question, in e-folds, from which the rising branch counts as stiff.
const STIFF: f64 = 30.0;

/// What an implicit and an explicit Runge-Kutta step cost, tried and looked at for guards, in Taylor steps.
const RUNGE_KUTTA: (u64, u64) = (40, 10);

/// Longest Runge-Kutta step.
const FARTHEST: f64 = 1e9;

/// Factor by which a series is shortened that has left the law, and how often at most.
const SHORTENED: f64 = 0.7;
const MAX_SHORTENINGS: usize = 20;

/// Lengths tried for one Runge-Kutta step before the motion is given up.
const MAX_TRIES: usize = 200;

impl<'a> Motion<'a> {
    /// Make the smooth motion from here, `longest` at most, with its own length; guards are not looked at.
    pub(super) fn piece(&mut self, longest: f64, piece: &mut Piece<'a>) -> Result<(), Error> {
        if self.phase.mode == Mode::Stuck {
            *piece = self.held_piece(longest);
        } else if self.on_a_corner() {
            *piece = self.still_piece(longest);
        } else if self.phase.creeping {
            *piece = self.creep_piece(longest);
        } else if self.needs_steps(longest) {
            *piece = self.steps_piece(longest)?;
        } else {
            self.series_piece(longest, piece);
        }
        Ok(())
    }

    /// A piece to be made.
    pub(super) fn no_piece(&self) -> Piece<'a> {
        self.along(Series::still(0.0, 0.0), 0.0)
    }

    /// The belt rests on a corner of the law.
    #[cold]
    fn still_piece(&self, longest: f64) -> Piece<'a> {
        let still = Series::still(self.phase.pull, self.phase.speed);
        let reach = self.reach(&still);
        self.along(still, longest.min(reach))
    }

    /// Whether the belt rests on a corner of the drag law, where rounding would switch modes for ever.
    fn on_a_corner(&self) -> bool {
        let Phase { mode, pull, speed, branch, .. } = self.phase;
        if mode == Mode::Microslip || self.now.thermal.is_some() {
            return false;
        }
        let drag = &self.now.system.drag;
        let onward = (self.rate()[0] - self.stiffness() * speed).abs();
        let steady = self.is_driven_evenly() && onward <= ROUNDING * self.stiffness() * speed;
        steady
            && [drag.upper_knot(branch), drag.lower_knot(branch)].into_iter().flatten().any(
                |knot| {
                    let force = drag.force(knot);
                    (speed - knot).abs() <= ROUNDING * knot
                        && (pull - force).abs() <= ROUNDING * force
                },
            )
    }

    /// The held belt keeps its speed while the pull grows.
    fn held_piece(&self, longest: f64) -> Piece<'a> {
        let series = held_series(&self.slip_start());
        if let Some(strengthening) = self.now.system.drag.strengthening() {
            return self.strengthening_piece(series, &strengthening, longest);
        }
        let duration = match &self.now.thermal {
            // the guard is found inside the piece, of which it must not be too small a part
            None if self.is_driven_evenly() && !self.phase.slipping => {
                longest.min(1.01 * self.release_time())
            }
            None => longest.min(self.reach(&series)),
            Some(thermal) => {
                // no longer than the series of the holding force is good for
                let breakaway = self.now.system.drag.breakaway_force();
                let holding = Series { pull: series.drag, ..series };
                let scale = self.phase.pull.abs().max(1e-3 * breakaway);
                let good = holding.step_size(self.tolerance, scale, 1.0);
                let good = if good.is_finite() { good } else { self.reach(&series) }.min(longest);
                let branch = self.now.standing_branch(self.phase.speed);
                self.until_law_changes(branch, &series.speed, &thermal.speed, good)
            }
        };
        self.along(series, duration)
    }

    /// How long something takes to change by as much as it is, on a series that has no end by itself; infinite if nothing
    /// does. Guards are looked for on pieces that end.
    #[cold]
    fn reach(&self, series: &Series) -> f64 {
        let [pull, speed, _] = self.scales();
        let pull = pull.max(series.drag[0].abs());
        let mut reach = f64::INFINITY;
        let mut look = |c: &[f64], scale: f64| {
            for (c, n) in c.iter().zip(0..).skip(1).filter(|(c, _)| **c != 0.0) {
                reach = reach.min(rough_root(scale / c.abs(), n));
            }
        };
        look(&series.pull, pull);
        look(&series.drag, pull);
        look(&series.speed, speed);
        if self.phase.slipping {
            let rate = self.drive_rate();
            look(&rate, rate[0].abs().max(self.now.system.train.stiffness() * speed));
        }
        reach
    }

    /// No longer than until a speed of the law passes a belt that is held or creeps: there another formula holds it.
    fn until_law_changes(
        &self,
        branch: Option<usize>,
        speed: &Polynomial,
        factor: &Polynomial,
        longest: f64,
    ) -> f64 {
        let drag = &self.now.system.drag;
        let v_s = drag.stick_speed();
        let (lower, upper) = match branch {
            None => (None, Some(v_s)),
            Some(branch) => (Some(drag.lower_knot(branch).unwrap_or(v_s)), drag.upper_knot(branch)),
        };
        let passing = |limit: Option<f64>, side: f64| {
            let limit = limit?;
            let mut gap: Polynomial =
                std::array::from_fn(|n| side * (limit * factor[n] - speed[n]));
            if gap[0] <= ROUNDING * speed[0] {
                gap[0] = 0.0; // it leaves the belt now, and may come back
            }
            first_crossing(&gap, longest).filter(|passing| *passing > 0.0)
        };
        let first = [passing(lower, -1.0), passing(upper, 1.0)].into_iter().flatten();
        first.fold(longest, f64::min)
    }

    /// The same while what holds the belt grows with the time that it has stood.
    #[allow(clippy::large_types_passed_by_value)] // it moves into the piece
    #[cold]
    fn strengthening_piece(
        &self,
        mut series: Series,
        strengthening: &Strengthening,
        longest: f64,
    ) -> Piece<'a> {
        let strength = self.strength_now();
        let age = strengthening.time + self.now.time - self.phase.at_rest_since;
        // the rest of the drive does not grow
        let mut rest = self.now.thermal.as_ref().map_or(UNCHANGED, |thermal| thermal.rest);
        rest = rest.map(|c| c * self.now.system.drag.rest().force);
        let contact: Polynomial = std::array::from_fn(|n| (series.drag[n] - rest[n]) / strength);
        let mut growing = [0.0; ORDER + 1];
        growing[0] = strength;
        let mut power = -strengthening.growth;
        for (c, per) in growing.iter_mut().zip(INVERSE).skip(1) {
            power /= -age;
            *c = power * per;
        }
        let first = series.drag[0];
        series.drag = std::array::from_fn(|n| product(&contact, &growing, n) + rest[n]);
        series.drag[0] = first;
        let holding = Series { pull: series.drag, ..series };
        let duration = holding.step_size(self.tolerance, first, 1.0).min(longest);
        self.along(series, duration)
    }

    /// A piece from here along `series`.
    #[allow(clippy::large_types_passed_by_value)] // it moves into the piece
    fn along(&self, series: Series, duration: f64) -> Piece<'a> {
        let path = Path::Series(series);
        Piece {
            time: self.now.time,
            duration,
            start: self.phase,
            flow: self.flow(),
            path,
            heated: self.now.heat.is_some(),
        }
    }

    /// Whether the pull of a held belt grows, or falls, at the same rate for good.
    fn is_driven_evenly(&self) -> bool {
        self.rate()[1..] == [0.0; 3]
    }

    /// How long the drive, at constant speed, takes to overcome what holds the belt.
    fn release_time(&self) -> f64 {
        let Phase { pull, speed, .. } = self.phase;
        let rate = self.rate()[0] - self.stiffness() * speed;
        let limit = self.holding_force();
        if rate == 0.0 { f64::INFINITY } else { ((limit.copysign(rate) - pull) / rate).max(0.0) }
    }

    fn scales(&self) -> [f64; 3] {
        let drag = &self.now.system.drag;
        let train = &self.now.system.train;
        let speed = self.phase.speed.max(self.now.speed(drag.stick_speed()));
        let pull = self
            .phase
            .pull
            .abs()
            .max(speed * train.impedance())
            .max(1e-9 * drag.transition_force());
        let bristle = match drag.closure() {
            Closure::LuGre { bristle_stiffness, .. } => drag.transition_force() / bristle_stiffness,
            _ => 1.0,
        };
        [pull, speed, bristle]
    }

    /// Whether the equation is stiff here, or has no series.
    fn needs_steps(&self, longest: f64) -> bool {
        if self.integrator == Integrator::DormandPrince || self.now.system.has_bristles() {
            return true;
        }
        let drag = &self.now.system.drag;
        if self.phase.mode == Mode::Microslip {
            return drag.closure() == Closure::Stribeck;
        }
        let horizon = longest.min(self.now.system.train.time_scale());
        let rising = if drag.mixed_contact().is_some() {
            let x = self.now.at_reference(self.phase.speed);
            self.now.force(drag.branch_force_and_slope(self.phase.branch, x, 1.0).1) * x
                / self.phase.speed
        } else {
            let force = self.phase.pull.max(drag.transition_force());
            drag.branch_exponent(self.phase.branch) * force / self.phase.speed
        };
        let slope = rising + drag.rest().damping;
        slope * horizon > STIFF * self.now.system.train.mass()
    }

    fn slip_start(&self) -> SlipStart<'_> {
        self.slip_start_on(match self.phase.mode {
            Mode::Ehl | Mode::Mixed => Some(self.phase.branch),
            Mode::Stuck => self.now.standing_branch(self.phase.speed),
            Mode::Microslip => None,
        })
    }

    /// The same by a branch of the law, or by the one below the stick speed.
    fn slip_start_on(&self, on_branch: Option<usize>) -> SlipStart<'_> {
        let Phase { mode, pull, speed, .. } = self.phase;
        let drag = &self.now.system.drag;
        let x = self.now.at_reference(speed);
        let contact = drag.mixed_contact().filter(|_| on_branch.is_some());
        let sharing = contact.map(|contact| SharingStart::at(contact, x));
        let (base, law) = match on_branch {
            Some(branch) => {
                let boundary = self.now.thermal.as_ref().map_or(1.0, |thermal| thermal.boundary[0]);
                let base = match sharing {
                    Some(_) => drag.branch_force_and_slope(branch, x, boundary).0,
                    None => drag.branch_force(branch, x),
                };
                (base, Recurrence::power(drag.branch_exponent(branch), x))
            }
            None if mode == Mode::Stuck => {
                let strength = self.strength_now();
                (strength * drag.exponential(x), Recurrence::exponential(drag.decay_speed()))
            }
            None => {
                let decay_speed = drag.strengthened_decay_speed(self.phase.strength);
                let base = self.phase.strength * drag.breakaway_force() * (-x / decay_speed).exp();
                (base, Recurrence::exponential(decay_speed))
            }
        };
        let drag_now = match on_branch {
            Some(_) => self.now.force(base),
            None => self.now.force_below(base),
        };
        let released = self.phase.released;
        let total = if released { pull.abs() } else { drag_now + self.now.rest(speed) };
        SlipStart {
            stiffness: self.stiffness(),
            mass: self.now.system.train.mass(),
            rate: self.rate(),
            pull,
            speed,
            force: base,
            total,
            law,
            sharing,
            rest: drag.rest(),
            thermal: self.now.thermal.as_ref(),
            below: on_branch.is_none(),
        }
    }

    fn series_piece(&self, longest: f64, piece: &mut Piece<'a>) {
        let [pull_scale, speed_scale, _] = self.scales();
        let series = piece.path.series();
        self.arch.dispatch(Slip(&self.slip_start(), series));
        let good = series
            .step_size(self.tolerance, pull_scale, speed_scale)
            .min(LONGEST_STEP * self.now.system.train.time_scale());
        let good = if good.is_finite() { good } else { self.reach(series) };
        (piece.time, piece.duration) = (self.now.time, good.min(longest));
        (piece.start, piece.flow) = (self.phase, self.flow());
        piece.heated = self.now.heat.is_some();
        if self.now.system.drag.mixed_contact().is_some() {
            self.keep_to_law(piece, speed_scale);
        }
    }

    /// Shorten a piece until its series is still true at its end: the share of asperities that begin to touch may grow
    /// by terms beyond the last, which the length of a step does not see.
    #[cold]
    fn keep_to_law(&self, piece: &mut Piece, speed_scale: f64) {
        let Path::Series(series) = &piece.path else { return };
        let (course, mass) = (self.now.temperature_law(), piece.flow.mass);
        for _ in 0..MAX_SHORTENINGS {
            let t = piece.duration;
            let (speed, pull) = (value(&series.speed, t), value(&series.pull, t));
            let state = [pull, speed, 0.0];
            let temperature = course.map(|(course, _)| value(&course, t));
            let force = piece.flow.at_temperature(temperature).force(t, &state);
            let off = value(&series.drag, t) - force;
            if off.abs() * t <= self.tolerance * mass * speed_scale {
                return;
            }
            piece.duration *= SHORTENED;
        }
    }

    fn crept(&self, branch: Option<usize>) -> Series {
        let slope = self.now.holding_slope(branch, self.phase.speed);
        creep_series(&self.slip_start_on(branch), slope)
    }

    /// Branch of the law, or the one below the stick speed, that a creeping belt follows.
    pub(super) fn creep_branch(&self) -> Option<usize> {
        let fallen = self.now.held_branch(self.phase.speed, false);
        let risen = self.now.held_branch(self.phase.speed, true);
        if let Some(thermal) = &self.now.thermal
            && risen != fallen
            && product(&self.crept(fallen).speed, &thermal.slowness, 1) > 0.0
        {
            return risen;
        }
        fallen
    }

    /// The belt slows just as fast as the growing backward pull allows.
    #[cold]
    fn creep_piece(&self, longest: f64) -> Piece<'a> {
        let pull = self.phase.pull;
        let branch = self.creep_branch();
        let series = self.crept(branch);
        let [_, speed_scale, _] = self.scales();
        let good = series
            .step_size(self.tolerance, pull.abs(), speed_scale) // the speed follows the pull's logarithm
            .min(LONGEST_STEP * self.now.system.train.time_scale())
            .min(longest);
        let duration = match &self.now.thermal {
            Some(thermal) => self.until_law_changes(branch, &series.speed, &thermal.speed, good),
            None if branch.is_some() => {
                self.until_law_changes(branch, &series.speed, &UNCHANGED, good)
            }
            None => good,
        };
        self.along(series, duration)
    }

    /// Course of the temperature as far as steps follow it, and how the law varies with it.
    fn cubic_law(&self) -> Option<(Cubic, &'a TemperatureLaw)> {
        let (course, law) = self.now.temperature_law()?;
        Some(([course[0], course[1], course[2], course[3]], law))
    }

    /// The equation of motion from here.
    pub(super) fn flow(&self) -> Flow<'a> {
        let sliding = matches!(self.phase.mode, Mode::Ehl | Mode::Mixed);
        Flow {
            drag: &self.now.system.drag,
            branch: sliding.then_some(self.phase.branch),
            temperature_law: self.cubic_law(),
            rate: self.rate(),
            stiffness: self.stiffness(),
            mass: self.now.system.train.mass(),
            strength: self.phase.strength,
        }
    }

    fn steps_piece(&mut self, longest: f64) -> Result<Piece<'a>, Error> {
        let (system, flow) = (self.now.system, self.flow());
        let (formula, cost) = match self.integrator {
            Integrator::Adaptive => (Formula::Radau, RUNGE_KUTTA.0),
            Integrator::DormandPrince => (Formula::DormandPrince, RUNGE_KUTTA.1),
        };
        let (scales, tolerance) = (self.scales(), self.tolerance);
        let state = self.phase.state();
        let rates = flow.rates(0.0, &state);
        let mut duration = self.next_step;
        if !duration.is_finite() {
            // a first step in which nothing changes by more than a hundredth of its scale
            let change = (0..3).map(|i| rates[i].abs() / scales[i]).fold(0.0, f64::max);
            duration = 0.01 / change.max(1e-3 / system.train.time_scale());
        }
        // where nothing moves, one step is as good as another
        duration = duration.min(longest).min(FARTHEST);
        let mut tries = 0;
        let end = loop {
            tries += 1;
            if tries > MAX_TRIES {
                return Err(self.stalled());
            }
            self.work.take(cost).map_err(|error| error.at_time(self.now.time))?;
            if let Some((end, errors)) = formula.step(&flow, &state, duration, &scales, tolerance) {
                let error =
                    (0..3).map(|i| errors[i].abs() / (tolerance * scales[i])).fold(0.0, f64::max);
                if error <= 1.0 {
                    self.next_step = duration * growth(error);
                    break end;
                }
                duration *= growth(error).min(0.8);
            } else {
                duration *= 0.25;
            }
        };
        let path = Path::Steps { formula, scales, tolerance, end: (duration, end) };
        Ok(Piece {
            time: self.now.time,
            duration,
            start: self.phase,
            flow,
            path,
            heated: self.now.heat.is_some(),
        })
    }
}
