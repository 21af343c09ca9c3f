//! The motion as a chain of pieces: in each the equation is smooth, between them lies a located event.
//!
//! The belt is followed in the direction it moves: `direction` is the sign of the belt speed and every
//! other quantity is mirrored with it, so that speed `u >= 0` here and one set of guards serves both.

use super::event::{Event, Guard};
use super::piece::{Condition, Path, Phase, Piece};
use super::polynomial::first_crossing;
use super::runge_kutta::{Flow, Formula, growth};
use super::schedule::Cubic;
use super::system::{Drive, Integrator, Start, System, checked_tolerance};
use super::taylor::{Recurrence, Series, Slip, SlipStart, Warmth, creep_series, held_series};
use crate::drag::{Closure, Mode, Warming};
use crate::error::Error;

/// Longest step in units of `sqrt(m/k)`, about half a period of the free oscillation.
const LONGEST_STEP: f64 = 3.0;

/// Decay over the time in question, in e-folds, from which the rising branch counts as stiff.
const STIFF: f64 = 30.0;

/// Steps after which a motion is given up as too long, some seconds of work.
const MAX_STEPS: usize = 5_000_000;
/// The same for Runge-Kutta steps, which cost more.
const MAX_RUNGE_KUTTA_STEPS: usize = 500_000;

/// Lengths tried for one Runge-Kutta step before the motion is given up.
const MAX_TRIES: usize = 200;

/// Events without any time passing before the motion is given up as endless switching.
const MAX_EVENTS_AT_ONCE: u32 = 32;

/// Deviation from steady sliding at the transition speed itself, relative, that is lost in rounding.
const ROUNDING: f64 = 1e-12;

/// Pull and speed with which a belt that starts below the stick speed first slides faster, if it does.
pub(crate) fn first_slide(system: &System, start: Start, tolerance: f64) -> Option<(f64, f64)> {
    let mut motion = Motion::new(system, start, tolerance, Integrator::Adaptive).ok()?;
    for _ in 0..1000 {
        let phase = motion.phase();
        if matches!(phase.mode, Mode::Ehl | Mode::Mixed) && phase.direction > 0.0 {
            return Some((phase.pull, phase.speed));
        }
        motion.advance(f64::INFINITY).ok()?;
    }
    None
}

/// The motion, from one piece to the next.
pub(super) struct Motion<'a> {
    system: &'a System,
    tolerance: f64,
    integrator: Integrator,
    arch: pulp::Arch,
    time: f64,
    phase: Phase,
    /// Segments of the drive and of the temperature that hold now.
    drive_segment: usize,
    temperature_segment: usize,
    /// When the drive or the temperature changes its formula.
    next_change: f64,
    /// Length that the next Runge-Kutta step should have.
    next_step: f64,
    warmth: Option<Warmth>,
    events_at_once: u32,
    /// Pieces made, and those of them by Runge-Kutta.
    pub steps: usize,
    runge_kutta_steps: usize,
    /// Kinetic energy lost by stopping dead.
    pub stopped: f64,
}

impl<'a> Motion<'a> {
    pub(super) fn new(
        system: &'a System,
        start: Start,
        tolerance: f64,
        integrator: Integrator,
    ) -> Result<Self, Error> {
        let pull = system.pull(start)?;
        let toward = if start.belt_speed == 0.0 { pull } else { start.belt_speed };
        let direction = if toward < 0.0 { -1.0 } else { 1.0 };
        let phase = Phase {
            mode: Mode::Stuck,
            branch: 0,
            released: false,
            creeping: false,
            direction,
            pull: direction * pull,
            speed: direction * start.belt_speed,
            bristle: 0.0,
        };
        let mut motion = Self {
            system,
            tolerance: checked_tolerance(tolerance)?,
            integrator,
            arch: pulp::Arch::new(),
            time: 0.0,
            phase,
            drive_segment: system.drive.schedule().segment(0.0),
            temperature_segment: system.temperature.as_ref().map_or(0, |t| t.segment(0.0)),
            next_change: f64::INFINITY,
            next_step: f64::INFINITY,
            warmth: None,
            events_at_once: 0,
            steps: 0,
            runge_kutta_steps: 0,
            stopped: 0.0,
        };
        motion.find_next_change();
        motion.warm();
        motion.bend_bristles();
        motion.enter_mode_at_start();
        Ok(motion)
    }

    /// Go on from another state.
    pub(super) fn resume(&mut self, time: f64, belt_speed: f64, pull: f64) {
        self.time = time;
        let direction = if belt_speed < 0.0 { -1.0 } else { 1.0 };
        (self.phase.direction, self.phase.released, self.phase.creeping) =
            (direction, false, false);
        (self.phase.speed, self.phase.pull) = (direction * belt_speed, direction * pull);
        self.next_step = f64::INFINITY;
        self.bend_bristles();
        self.enter_mode_at_start();
    }

    /// Bristles of a sliding belt are bent as in steady sliding.
    fn bend_bristles(&mut self) {
        if let Closure::LuGre { bristle_stiffness, .. } = self.system.drag.closure()
            && self.phase.speed >= self.speed(self.system.drag.stick_speed())
        {
            self.phase.bristle = self.steady_drag(self.phase.speed) / bristle_stiffness;
        }
    }

    pub(super) fn phase(&self) -> &Phase {
        &self.phase
    }

    pub(super) fn time(&self) -> f64 {
        self.time
    }

    /// The next piece, no longer than `longest`, and the event that ends it, if one does.
    pub(super) fn advance(&mut self, longest: f64) -> Result<(Piece<'a>, Option<Event>), Error> {
        self.steps += 1;
        if self.steps > MAX_STEPS || self.runge_kutta_steps > MAX_RUNGE_KUTTA_STEPS {
            return Err(Error::TooLong { steps: self.steps, time: self.time });
        }
        self.warm();
        if self.phase.creeping && self.rate()[0] >= self.system.train.stiffness() * self.phase.speed
        {
            // the drive has turned: the backward pull no longer grows, and the belt is held
            (self.phase.creeping, self.phase.mode) = (false, Mode::Stuck);
        }
        let until_change = self.next_change - self.time;
        let mut piece = self.piece(longest.min(until_change))?;
        let crossing = self.first_guard(&piece);
        let before = self.time;
        let Some((elapsed, guard)) = crossing else {
            [self.phase.pull, self.phase.speed, self.phase.bristle] = piece.state(piece.duration);
            self.phase.released = false;
            self.time += piece.duration;
            if piece.duration >= until_change && until_change.is_finite() {
                self.time = self.next_change;
                self.pass_change();
            }
            return Ok((piece, None));
        };
        piece.duration = elapsed;
        self.time += elapsed;
        [self.phase.pull, self.phase.speed, self.phase.bristle] = piece.state(elapsed);
        let from = self.phase.mode;
        self.warm();
        self.cross(guard);
        self.events_at_once = if self.time > before { 0 } else { self.events_at_once + 1 };
        if self.events_at_once > MAX_EVENTS_AT_ONCE {
            return Err(Error::Chattering { guard: guard.name(), time: self.time });
        }
        if guard == Guard::TablePoint {
            return Ok((piece, None));
        }
        let Phase { mode: to, direction, pull, speed, .. } = self.phase;
        let event = Event {
            time: self.time,
            from,
            to,
            guard,
            stretch: self.system.stretch(direction * pull, self.time),
            belt_speed: direction * speed,
        };
        Ok((piece, Some(event)))
    }

    /// Rate of the pull if the belt stood still, about now, mirrored.
    fn rate(&self) -> Cubic {
        let d = self.phase.direction;
        match &self.system.drive {
            Drive::Speed(schedule) => {
                let k = self.system.train.stiffness();
                schedule.about(self.drive_segment, self.time).map(|c| d * k * c)
            }
            Drive::Force(schedule) => {
                let [_, b, c, e] = schedule.about(self.drive_segment, self.time);
                [d * b, d * 2.0 * c, d * 3.0 * e, 0.0]
            }
        }
    }

    fn find_next_change(&mut self) {
        let drive = self.system.drive.schedule().end(self.drive_segment);
        let temperature = &self.system.temperature;
        let warm = temperature.as_ref().map_or(f64::INFINITY, |t| t.end(self.temperature_segment));
        self.next_change = drive.min(warm);
    }

    /// Enter the next segment of the schedules; a jump of the driving force is a jump of the pull.
    fn pass_change(&mut self) {
        let schedule = self.system.drive.schedule();
        if schedule.end(self.drive_segment) <= self.time {
            let before = schedule.about(self.drive_segment, self.time)[0];
            self.drive_segment += 1;
            let after = schedule.about(self.drive_segment, self.time)[0];
            if matches!(self.system.drive, Drive::Force(_)) {
                self.phase.pull += self.phase.direction * (after - before);
            }
        }
        if let Some(temperature) = &self.system.temperature
            && temperature.end(self.temperature_segment) <= self.time
        {
            self.temperature_segment += 1;
        }
        self.next_step = f64::INFINITY;
        self.find_next_change();
    }

    /// Course of the temperature from now on, and how the law varies with it.
    fn warming(&self) -> Option<(Cubic, Warming)> {
        let temperature = self.system.temperature.as_ref()?;
        let warming = self.system.drag.warming()?;
        Some((temperature.about(self.temperature_segment, self.time), warming))
    }

    fn warm(&mut self) {
        self.warmth = self.warming().map(|(temperature, warming)| {
            let ratio = temperature.map(|c| c / warming.reference);
            let mut warmth = Warmth::new(&ratio, warming.force_exponent, warming.speed_exponent);
            let force = ratio[0].powf(warming.force_exponent);
            let speed = ratio[0].powf(warming.speed_exponent);
            warmth.force = warmth.force.map(|c| c * force);
            warmth.speed = warmth.speed.map(|c| c * speed);
            warmth.slowness = warmth.slowness.map(|c| c / speed);
            warmth
        });
    }

    /// A speed of the law as it is now.
    fn speed(&self, base: f64) -> f64 {
        self.warmth.as_ref().map_or(base, |warmth| base * warmth.speed[0])
    }

    /// A force of the law as it is now.
    fn force(&self, base: f64) -> f64 {
        self.warmth.as_ref().map_or(base, |warmth| base * warmth.force[0])
    }

    /// A belt speed in the terms of the law as it was given.
    fn unwarmed(&self, speed: f64) -> f64 {
        self.warmth.as_ref().map_or(speed, |warmth| speed * warmth.slowness[0])
    }

    /// Whether a held belt is faster than the stick speed, which may move past it, or about to be.
    fn held_fast(&self) -> bool {
        let (x, v_s) = (self.unwarmed(self.phase.speed), self.system.drag.stick_speed());
        let falling = self.warmth.as_ref().is_some_and(|warmth| warmth.speed[1] < 0.0);
        if (x - v_s).abs() <= ROUNDING * v_s { falling } else { x > v_s }
    }

    /// What can hold a belt at `speed`; a law that moves may leave a held belt above the stick speed.
    fn holding_force(&self, speed: f64) -> f64 {
        let (drag, x) = (&self.system.drag, self.unwarmed(speed));
        let fast = x > drag.stick_speed();
        self.force(if fast { drag.force(x) } else { drag.holding_force(x) })
    }

    fn steady_drag(&self, speed: f64) -> f64 {
        self.force(self.system.drag.force(self.unwarmed(speed)))
    }

    fn enter_mode_at_start(&mut self) {
        let drag = &self.system.drag;
        let Phase { pull, speed, .. } = self.phase;
        let v_s = self.speed(drag.stick_speed());
        if speed < v_s {
            if drag.closure() == Closure::Stiction {
                self.phase.mode = self.mode_below_stick_speed();
            } else {
                let held = !drag.closure().is_smooth() && pull.abs() <= self.holding_force(speed);
                self.phase.mode = if held { Mode::Stuck } else { Mode::Microslip };
            }
            return;
        }
        // on a boundary the motion itself says which side it belongs to: m u' and, where that is nil, u''
        let net_force = pull - self.steady_drag(speed);
        let onward = self.rate()[0] - self.system.train.stiffness() * speed;
        let rising = net_force > 0.0 || (net_force == 0.0 && onward >= 0.0);
        let x = self.unwarmed(speed);
        let mut branch = drag.branch(x);
        if !rising && branch > 0 && drag.upper_knot(branch - 1) == Some(x) && x > drag.stick_speed()
        {
            branch -= 1;
        }
        self.phase.branch = branch;
        self.phase.mode = if rising || speed > v_s {
            drag.branch_mode(branch)
        } else {
            self.mode_below_stick_speed()
        };
    }

    /// Mode of a belt that has slowed to the stick speed; with `Stiction` it stops dead if it can be held.
    fn mode_below_stick_speed(&mut self) -> Mode {
        let drag = &self.system.drag;
        let closure = drag.closure();
        let holding = self.holding_force(self.speed(drag.stick_speed()));
        if closure.is_smooth() || self.phase.pull.abs() > holding {
            return Mode::Microslip;
        }
        if closure == Closure::Stiction {
            self.stop_dead();
        }
        Mode::Stuck
    }

    fn stop_dead(&mut self) {
        self.stopped += 0.5 * self.system.train.mass() * self.phase.speed * self.phase.speed;
        self.phase.speed = 0.0;
    }

    /// Enter the mode behind `guard`, on it exactly.
    fn cross(&mut self, guard: Guard) {
        let drag = &self.system.drag;
        let crept = self.phase.creeping;
        (self.phase.released, self.phase.creeping) = (false, false);
        self.next_step = f64::INFINITY;
        self.phase.mode = match (guard, self.phase.mode) {
            (Guard::TransitionSpeed | Guard::TablePoint, _) => {
                let x = self.unwarmed(self.phase.speed);
                let above = drag.upper_knot(self.phase.branch);
                let below = drag.lower_knot(self.phase.branch);
                // the knot that was reached is the nearer one
                let up = match (above, below) {
                    (Some(a), Some(b)) => (a - x).abs() <= (x - b).abs(),
                    (above, _) => above.is_some(),
                };
                let knot = if up { above } else { below };
                self.phase.speed = self.speed(knot.unwrap_or(x));
                self.phase.branch = if up { self.phase.branch + 1 } else { self.phase.branch - 1 };
                drag.branch_mode(self.phase.branch)
            }
            (Guard::StickSpeed, Mode::Microslip) => {
                self.phase.speed = self.speed(drag.stick_speed());
                self.phase.branch = drag.branch(drag.stick_speed());
                drag.branch_mode(self.phase.branch)
            }
            (Guard::StickSpeed, _) => {
                self.phase.speed = self.speed(drag.stick_speed());
                self.mode_below_stick_speed()
            }
            (Guard::HoldingForce, Mode::Stuck) => self.released(),
            (Guard::HoldingForce, _) => {
                // held by just what it is pulled with
                self.phase.pull = self.holding_force(self.phase.speed).copysign(self.phase.pull);
                if drag.closure() == Closure::Stiction {
                    self.stop_dead();
                }
                Mode::Stuck
            }
            (Guard::Reversal, _) => {
                self.phase.speed = 0.0;
                if crept {
                    self.released()
                } else if drag.closure() == Closure::Stiction
                    && self.phase.pull.abs() <= self.holding_force(0.0)
                {
                    Mode::Stuck
                } else {
                    self.mirror();
                    Mode::Microslip
                }
            }
        };
    }

    /// Leave the stuck phase with the spring force exactly at the holding force.
    fn released(&mut self) -> Mode {
        let drag = &self.system.drag;
        self.phase.pull = self.holding_force(self.phase.speed).copysign(self.phase.pull);
        let forward = self.phase.pull > 0.0;
        if self.phase.speed == 0.0 && !forward {
            self.mirror();
        }
        self.phase.creeping = self.phase.speed > 0.0 && !forward;
        self.phase.released = !self.phase.creeping;
        if forward && self.phase.speed >= self.speed(drag.stick_speed()) {
            self.phase.branch = drag.branch(self.unwarmed(self.phase.speed));
            drag.branch_mode(self.phase.branch)
        } else {
            Mode::Microslip
        }
    }

    fn mirror(&mut self) {
        self.phase.direction = -self.phase.direction;
        self.phase.pull = -self.phase.pull;
        self.phase.bristle = -self.phase.bristle;
    }

    /// Whether the belt rests on a corner of the drag law, where rounding would switch modes for ever.
    fn on_a_corner(&self) -> bool {
        let Phase { mode, pull, speed, branch, .. } = self.phase;
        if mode == Mode::Microslip || self.warmth.is_some() {
            return false;
        }
        let drag = &self.system.drag;
        let onward = (self.rate()[0] - self.system.train.stiffness() * speed).abs();
        let steady = self.rate()[1..] == [0.0; 3]
            && onward <= ROUNDING * self.system.train.stiffness() * speed;
        steady
            && [drag.upper_knot(branch), drag.lower_knot(branch)].into_iter().flatten().any(
                |knot| {
                    let force = drag.force(knot);
                    (speed - knot).abs() <= ROUNDING * knot
                        && (pull - force).abs() <= ROUNDING * force
                },
            )
    }

    /// The smooth motion from here, `longest` at most, with its own length; guards are not looked at.
    fn piece(&mut self, longest: f64) -> Result<Piece<'a>, Error> {
        let start = self.phase;
        if start.mode == Mode::Stuck {
            return Ok(self.held_piece(longest));
        }
        if self.on_a_corner() {
            return Ok(self.along(Series::still(start.pull, start.speed), longest));
        }
        if start.creeping || !self.needs_steps(longest) {
            return Ok(self.series_piece(longest));
        }
        self.steps_piece(longest)
    }

    /// The held belt keeps its speed while the pull grows.
    fn held_piece(&self, longest: f64) -> Piece<'a> {
        let series = held_series(&self.slip_start());
        let duration = match &self.warmth {
            // the guard is found inside the piece
            None if longest.is_infinite() => 1.01 * self.release_time(),
            None => longest,
            Some(warmth) => {
                // no longer than the series of the holding force is good for
                let breakaway = self.system.drag.breakaway_force();
                let holding = Series { pull: series.drag, ..series };
                let scale = self.phase.pull.abs().max(1e-3 * breakaway);
                let good = holding.step_size(self.tolerance, scale, 1.0).min(longest);
                // and not past the moment when the stick speed passes the belt: there another law holds it
                let (speed, v_s) = (self.phase.speed, self.system.drag.stick_speed());
                let side = if self.held_fast() { -1.0 } else { 1.0 };
                let mut gap = warmth.speed.map(|c| side * v_s * c);
                gap[0] -= side * speed;
                let apart = gap[0] > ROUNDING * speed;
                let passing = if apart { first_crossing(&gap, good) } else { None };
                passing.unwrap_or(good)
            }
        };
        self.along(series, duration)
    }

    /// A piece from here along `series`.
    #[allow(clippy::large_types_passed_by_value)] // it moves into the piece
    fn along(&self, series: Series, duration: f64) -> Piece<'a> {
        let path = Path::Series(series);
        Piece { time: self.time, duration, start: self.phase, flow: self.flow(), path }
    }

    /// How long the drive, at constant speed, takes to overcome what holds the belt.
    fn release_time(&self) -> f64 {
        let Phase { pull, speed, .. } = self.phase;
        let rate = self.rate()[0] - self.system.train.stiffness() * speed;
        let limit = self.holding_force(speed);
        if rate == 0.0 { f64::INFINITY } else { ((limit.copysign(rate) - pull) / rate).max(0.0) }
    }

    fn scales(&self) -> [f64; 3] {
        let drag = &self.system.drag;
        let train = &self.system.train;
        let speed = self.phase.speed.max(self.speed(drag.stick_speed()));
        let impedance = (train.stiffness() * train.mass()).sqrt();
        let pull = self.phase.pull.abs().max(speed * impedance).max(1e-9 * drag.transition_force());
        let bristle = match drag.closure() {
            Closure::LuGre { bristle_stiffness, .. } => drag.transition_force() / bristle_stiffness,
            _ => 1.0,
        };
        [pull, speed, bristle]
    }

    /// Whether the equation is stiff here, or has no series.
    fn needs_steps(&self, longest: f64) -> bool {
        if self.integrator == Integrator::DormandPrince || self.system.has_bristles() {
            return true;
        }
        let drag = &self.system.drag;
        if self.phase.mode == Mode::Microslip {
            return drag.closure() == Closure::Stribeck;
        }
        let horizon = longest.min(self.system.train.time_scale());
        let exponent = drag.branch_exponent(self.phase.branch);
        let force = self.phase.pull.max(drag.transition_force());
        exponent * force / (self.phase.speed * self.system.train.mass()) * horizon > STIFF
    }

    fn slip_start(&self) -> SlipStart<'_> {
        let Phase { mode, branch, pull, speed, .. } = self.phase;
        let drag = &self.system.drag;
        let x = self.unwarmed(speed);
        let (base, law) = match mode {
            Mode::Ehl | Mode::Mixed => {
                (drag.branch_force(branch, x), Recurrence::power(drag.branch_exponent(branch), x))
            }
            Mode::Stuck if self.held_fast() => {
                let exponent = drag.branch_exponent(drag.branch(x));
                (drag.force(x), Recurrence::power(exponent, x))
            }
            _ => (drag.exponential(x), Recurrence::exponential(drag.stick_speed())),
        };
        let force = if self.phase.released { pull / self.force(1.0) } else { base };
        SlipStart {
            stiffness: self.system.train.stiffness(),
            mass: self.system.train.mass(),
            rate: self.rate(),
            pull,
            speed,
            force,
            law,
            warmth: self.warmth.as_ref(),
        }
    }

    fn series_piece(&self, longest: f64) -> Piece<'a> {
        let [mut pull_scale, speed_scale, _] = self.scales();
        if self.phase.creeping {
            pull_scale = self.phase.pull.abs(); // the speed follows its logarithm
        }
        let start = self.slip_start();
        let v_s = self.system.drag.stick_speed();
        let series = if self.phase.creeping {
            creep_series(&start, v_s)
        } else {
            self.arch.dispatch(Slip(start))
        };
        let duration = series
            .step_size(self.tolerance, pull_scale, speed_scale)
            .min(LONGEST_STEP * self.system.train.time_scale())
            .min(longest);
        self.along(series, duration)
    }

    /// The equation of motion from here.
    fn flow(&self) -> Flow<'a> {
        let sliding = matches!(self.phase.mode, Mode::Ehl | Mode::Mixed);
        Flow {
            drag: &self.system.drag,
            branch: sliding.then_some(self.phase.branch),
            warming: self.warming(),
            rate: self.rate(),
            stiffness: self.system.train.stiffness(),
            mass: self.system.train.mass(),
        }
    }

    fn steps_piece(&mut self, longest: f64) -> Result<Piece<'a>, Error> {
        self.runge_kutta_steps += 1;
        let (system, flow) = (self.system, self.flow());
        let formula = match self.integrator {
            Integrator::Adaptive => Formula::Radau,
            Integrator::DormandPrince => Formula::DormandPrince,
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
        duration = duration.min(longest);
        let mut tries = 0;
        loop {
            tries += 1;
            if tries > MAX_TRIES {
                return Err(Error::TooLong { steps: self.steps, time: self.time });
            }
            if let Some((_, errors)) = formula.step(&flow, &state, duration, &scales, tolerance) {
                let error =
                    (0..3).map(|i| errors[i].abs() / (tolerance * scales[i])).fold(0.0, f64::max);
                if error <= 1.0 {
                    self.next_step = duration * growth(error);
                    break;
                }
                duration *= growth(error).min(0.8);
            } else {
                duration *= 0.25;
            }
        }
        let path = Path::Steps { formula, scales, tolerance };
        Ok(Piece { time: self.time, duration, start: self.phase, flow, path })
    }

    /// The guard that the piece crosses first, if it crosses any.
    fn first_guard(&self, piece: &Piece) -> Option<(f64, Guard)> {
        if piece.duration.is_infinite() {
            return None;
        }
        let mut first: Option<(f64, Guard)> = None;
        let range = if self.warmth.is_none() { piece.speed_range() } else { None };
        let mut watch = |condition: Condition, guard: Guard| {
            if range.is_some_and(|range| condition.holds_over(range)) {
                return;
            }
            if let Some(elapsed) = piece.end_of(condition, self.warmth.as_ref())
                && first.is_none_or(|(earliest, _)| elapsed < earliest)
            {
                first = Some((elapsed, guard));
            }
        };
        let drag = &self.system.drag;
        let v_s = drag.stick_speed();
        let Phase { mode, branch, .. } = self.phase;
        match mode {
            Mode::Stuck => {
                watch(Condition::HeldForward, Guard::HoldingForce);
                watch(Condition::HeldBack, Guard::HoldingForce);
            }
            Mode::Microslip if self.phase.creeping => {
                watch(Condition::Faster(0.0), Guard::Reversal);
            }
            Mode::Microslip => {
                watch(Condition::Slower(v_s), Guard::StickSpeed);
                match drag.closure() {
                    Closure::Retained => watch(Condition::Overcome, Guard::HoldingForce),
                    Closure::Stiction => {
                        watch(Condition::Pulled(drag.breakaway_force()), Guard::HoldingForce);
                    }
                    _ => {}
                }
                watch(Condition::Faster(0.0), Guard::Reversal);
            }
            Mode::Ehl | Mode::Mixed => {
                let named = |is_transition: bool| {
                    if is_transition { Guard::TransitionSpeed } else { Guard::TablePoint }
                };
                if let Some(knot) = drag.upper_knot(branch) {
                    watch(Condition::Slower(knot), named(drag.is_transition(branch)));
                }
                match drag.lower_knot(branch) {
                    Some(knot) => {
                        watch(Condition::Faster(knot), named(drag.is_transition(branch - 1)));
                    }
                    None => watch(Condition::Faster(v_s), Guard::StickSpeed),
                }
            }
        }
        first
    }
}
