//! One drive under way: its phase, its values, its motion, and what of that a tool outside may see.

use hersey_core::drag::Mode;
use hersey_core::motion::{Event, Moment, State, Stepper};
use hersey_core::{Error, Work};

use crate::account::{Account, Acting, CUT, Share};
use crate::description::{Description, Drive, Values};
use crate::making::Making;
use crate::measured::{Crossing, Outside, Watched};
use crate::variables::{
    COUNT, Causality, DRIVE_TORQUE, Kind, TEMPERATURE, TIME, TOLERANCE, VARIABLES, Variable,
    place_at,
};

/// Phases of the standard; a plain caller knows the first and that of the steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    Instantiated,
    Initialization,
    Event,
    Step,
    Terminated,
}

impl Phase {
    pub const ALL: [Self; 5] =
        [Self::Instantiated, Self::Initialization, Self::Event, Self::Step, Self::Terminated];

    fn words(self) -> &'static str {
        match self {
            Self::Instantiated => "before its initialization",
            Self::Initialization => "in its initialization",
            Self::Event => "at an event",
            Self::Step => "between two steps",
            Self::Terminated => "terminated",
        }
    }
}

/// What changes by leaps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Discrete {
    pub mode: Mode,
    pub slipping: bool,
}

/// How far a step has led.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reached {
    pub time: f64,
    /// Whether mode or slip are others than were seen before.
    pub changed: bool,
    /// Whether it ended there for that reason.
    pub early: bool,
}

/// All of an instance that changes.
#[derive(Debug, Clone, PartialEq)]
pub struct Saved {
    pub phase: Phase,
    pub values: Values,
    /// Slopes of the drive and of the temperature, for the step to come.
    pub slopes: [f64; 2],
    pub origin: f64,
    pub time: f64,
    pub stop: f64,
    pub seen: Option<Discrete>,
    pub account: Account,
    pub outside: Outside,
    pub moment: Option<[f64; Moment::NUMBERS]>,
}

/// One drive under way.
pub struct Instance {
    description: Description,
    phase: Phase,
    values: Values,
    slopes: [f64; 2],
    /// Time at which the motion began, and now.
    origin: f64,
    time: f64,
    stop: f64,
    motion: Option<Stepper>,
    /// The motion now, once somebody has asked.
    now: Option<State>,
    /// Mode and slip as they were last shown.
    seen: Option<Discrete>,
    /// Ways, work and heat since the start.
    account: Account,
    /// What has left the range in which the law was measured, and what of that nobody was told yet.
    outside: Outside,
    crossings: Vec<Crossing>,
    /// Whether anybody wants to be told.
    pub warns: bool,
    /// Whether they are shown anew only in event mode, and whether a step may end at their change.
    pub event_mode: bool,
    pub early_return: bool,
}

/// Difference of two times that comes of rounding alone: share of the step, and of the times.
const SAME_TIME: (f64, f64) = (1e-6, 16.0 * f64::EPSILON);

/// Steps in which the sums of one call are made at the most: beyond they are made less exactly.
const MOST_STRIDES: f64 = 1e5;

impl Instance {
    /// A drive as its text describes it.
    pub fn new(text: &str) -> Result<Self, String> {
        let description = Description::read(text)?;
        let mut instance = Self {
            values: description.values,
            description,
            phase: Phase::Instantiated,
            slopes: [0.0; 2],
            origin: 0.0,
            time: 0.0,
            stop: f64::INFINITY,
            motion: None,
            now: None,
            seen: None,
            account: Account::default(),
            outside: Outside::default(),
            crossings: Vec::new(),
            warns: true,
            event_mode: false,
            early_return: false,
        };
        instance.moving()?; // a drive that cannot be is refused at once
        instance.motion = None;
        Ok(instance)
    }

    /// The sum of the text and the word by which a tool knows its unit.
    pub fn identity(&self) -> (u64, Option<&str>) {
        (self.description.sum, self.description.token.as_deref())
    }

    /// Refuse what is not allowed now.
    pub fn must_be(&self, phases: &[Phase]) -> Result<(), String> {
        if phases.contains(&self.phase) {
            return Ok(());
        }
        Err(format!("not allowed while the instance is {}", self.phase.words()))
    }

    pub fn enter(&mut self, phase: Phase, from: &[Phase]) -> Result<(), String> {
        self.must_be(from)?;
        self.phase = phase;
        Ok(())
    }

    /// From when on, how long at most, and how exactly at least.
    pub fn set_up(
        &mut self,
        start: f64,
        stop: Option<f64>,
        tolerance: Option<f64>,
    ) -> Result<(), String> {
        self.must_be(&[Phase::Instantiated])?;
        if !start.is_finite() {
            return Err(format!("start time {start} is not finite"));
        }
        if let Some(stop) = stop.filter(|stop| stop.is_nan() || *stop < start) {
            return Err(format!("stop time {stop} is not after start time {start}"));
        }
        if let Some(tolerance) = tolerance {
            if !(tolerance.is_finite() && tolerance > 0.0) {
                return Err(format!("tolerance {tolerance} is not positive"));
            }
            // a looser one would save next to nothing
            let own = &mut self.values[TOLERANCE];
            *own = own.min(tolerance.max(TIGHTEST));
            self.motion = None;
        }
        (self.origin, self.time) = (start, start);
        self.stop = stop.unwrap_or(f64::INFINITY);
        Ok(())
    }

    /// Begin the motion with the values as they are.
    pub fn begin(&mut self, phase: Phase) -> Result<(), String> {
        self.must_be(&[Phase::Instantiated, Phase::Initialization])?;
        self.moving()?;
        self.seen = Some(self.discrete()?);
        let state = self.state()?;
        self.account = Account::begun(&self.acting(state.time), &state);
        self.watch(&state);
        self.phase = phase;
        Ok(())
    }

    /// All as it was at first.
    pub fn reset(&mut self) {
        self.values = self.description.values;
        self.slopes = [0.0; 2];
        (self.origin, self.time, self.stop) = (0.0, 0.0, f64::INFINITY);
        (self.motion, self.now, self.seen) = (None, None, None);
        (self.account, self.outside) = (Account::default(), Outside::default());
        self.phase = Phase::Instantiated;
    }

    pub fn time(&self) -> f64 {
        self.time
    }

    fn making(&self) -> Making<'_> {
        Making { description: &self.description, values: &self.values }
    }

    /// The motion, begun if it is not.
    fn moving(&mut self) -> Result<&mut Stepper, String> {
        if self.motion.is_none() {
            self.making().checked_radius()?;
            let motion = self.making().stepper().map_err(|error| self.making().words(error))?;
            self.motion = Some(motion);
            self.now = None;
        }
        self.motion.as_mut().ok_or_else(|| "no motion".to_owned())
    }

    fn state(&mut self) -> Result<State, String> {
        if let Some(now) = self.now {
            return Ok(now);
        }
        let mut state = self.moving()?.state();
        if self.phase == Phase::Event {
            // what the inputs make of it, which the motion follows once all is settled
            let [drive, temperature] = self.inputs();
            let mut settled = self.moving()?.clone();
            let event = settled.set_inputs(drive, temperature);
            event.map_err(|error| self.making().words(error))?;
            state = settled.state();
        }
        self.now = Some(state);
        Ok(state)
    }

    fn discrete(&mut self) -> Result<Discrete, String> {
        let State { mode, slipping, .. } = self.state()?;
        Ok(Discrete { mode, slipping })
    }

    /// Whether mode or slip are others than were shown.
    pub fn has_changed(&mut self) -> Result<bool, String> {
        let now = self.discrete()?;
        Ok(self.seen != Some(now))
    }

    /// Show mode and slip as they are now, which at an event is as the inputs make them.
    pub fn show(&mut self) -> Result<(), String> {
        if self.phase == Phase::Event {
            self.follow()?;
        }
        self.seen = Some(self.discrete()?);
        Ok(())
    }

    /// Place of the variable that a tool names by number, if this drive has it and it is of that kind.
    pub fn place(&self, reference: u32, kind: Kind) -> Result<usize, String> {
        let place = place_at(reference).filter(|place| self.has(*place));
        let place =
            place.ok_or_else(|| format!("no variable has the value reference {reference}"))?;
        let Variable { name, kind: own, .. } = &VARIABLES[place];
        if *own == kind {
            return Ok(place);
        }
        Err(format!("{name} (value reference {reference}) is {own:?}, not {kind:?}"))
    }

    /// Whether this drive has a variable.
    pub fn has(&self, place: usize) -> bool {
        self.description.computes(place) || !self.values[place].is_nan()
    }

    /// The value of a variable of this drive.
    pub fn get(&mut self, place: usize) -> Result<f64, String> {
        if place == TIME {
            return Ok(self.time);
        }
        let variable = &VARIABLES[place];
        if variable.causality != Causality::Output {
            return Ok(self.values[place]);
        }
        if self.phase == Phase::Instantiated {
            self.must_be(&Phase::ALL[1..])?;
        }
        let state = self.state()?;
        let shown = match (self.phase, self.seen) {
            (Phase::Initialization, _) | (_, None) => {
                Discrete { mode: state.mode, slipping: state.slipping }
            }
            (_, Some(seen)) => seen,
        };
        Ok(match variable.name {
            "belt_speed" => state.belt_speed,
            "spring_force" => self.making().stiffness() * state.stretch,
            "drag" => state.drag,
            "stretch" => state.stretch,
            "mode" => f64::from(shown.mode as u8),
            "stuck" => f64::from(u8::from(shown.mode == Mode::Stuck)),
            "slipping" => f64::from(u8::from(shown.slipping)),
            name => self.sum(name, &state),
        })
    }

    /// A power, a heat or a way; those since the start are none before it.
    fn sum(&self, name: &str, state: &State) -> f64 {
        let (acting, account) = (self.acting(state.time), &self.account);
        let [friction_power, contact_power] = account.powers(&acting, state);
        let [friction_energy, contact_energy, slip_energy] = account.heats();
        match name {
            "friction_power" => friction_power,
            "contact_power" => contact_power,
            "slip_power" => acting.slip_power(state),
            "friction_energy" => friction_energy,
            "contact_energy" => contact_energy,
            "slip_energy" => slip_energy,
            "reaction_torque" => state.pull * self.making().roll_radius(),
            _ if self.phase == Phase::Initialization => 0.0,
            "belt_position" => account.belt_position(acting.is_speed, state),
            "drive_position" => account.drive_position(state.time),
            _ => account.drive_position(state.time) / self.making().roll_radius(),
        }
    }

    /// Refuse to set a variable of this drive, or to set it now, or to such a value.
    pub fn check(&self, place: usize, value: f64) -> Result<(), String> {
        let Variable { name, causality, .. } = &VARIABLES[place];
        match causality {
            Causality::Parameter => self
                .must_be(&[Phase::Instantiated, Phase::Initialization])
                .map_err(|words| format!("{name} is fixed: {words}"))?,
            Causality::Input => self.must_be(&Phase::ALL[..4])?,
            _ => return Err(format!("{name} is computed and cannot be set")),
        }
        if !value.is_finite() {
            return Err(format!("{name} {value} is not finite"));
        }
        if place == TEMPERATURE && self.making().temperature(value) <= 0.0 {
            let zero = -self.making().temperature(0.0);
            return Err(format!("{name} is {value} K: the law begins above {zero} K"));
        }
        Ok(())
    }

    /// Set a variable that was checked; an input holds from now on.
    pub fn set(&mut self, place: usize, value: f64) -> Result<(), String> {
        self.check(place, value)?;
        self.values[place] = value;
        self.now = None;
        if matches!(self.phase, Phase::Instantiated | Phase::Initialization) {
            self.motion = None;
        }
        Ok(())
    }

    /// Let an input go on with a slope over the step to come.
    pub fn set_slope(&mut self, place: usize, slope: f64) -> Result<(), String> {
        let Variable { name, causality, .. } = &VARIABLES[place];
        if *causality != Causality::Input {
            return Err(format!("{name} is no input"));
        }
        self.check(place, slope)?;
        self.slopes[usize::from(place == TEMPERATURE)] = slope;
        Ok(())
    }

    /// Drive and temperature from now on, as the core takes them.
    fn inputs(&self) -> [Option<[f64; 4]>; 2] {
        let (making, [drive_slope, slope]) = (self.making(), self.slopes);
        let drive = self.values[self.description.drive_place()];
        let drive = [making.drive(drive), making.drive(drive_slope), 0.0, 0.0];
        let temperature = [making.temperature(self.values[TEMPERATURE]), slope, 0.0, 0.0];
        [Some(drive), self.description.is_warmed().then_some(temperature)]
    }

    /// What acts on the motion from a time of it on.
    fn acting(&self, since: f64) -> Acting {
        let (making, [drive_slope, slope]) = (self.making(), self.slopes);
        let drive = self.values[self.description.drive_place()];
        let temperature = self.values[TEMPERATURE];
        let rest = making.rest(temperature);
        let later = making.rest(temperature + slope);
        Acting {
            stiffness: making.stiffness(),
            mass: making.mass(),
            is_speed: self.description.choices.drive == Drive::Speed,
            drive: [making.drive(drive), making.drive(drive_slope)],
            since,
            rest,
            rest_slope: [later[0] - rest[0], later[1] - rest[1]],
        }
    }

    /// Let the motion follow the inputs from now on: what goes on as it was cuts nothing.
    fn follow(&mut self) -> Result<Acting, String> {
        let [drive, temperature] = self.inputs();
        let event = self.moving()?.set_inputs(drive, temperature);
        self.now = None;
        event.map_err(|error| self.making().words(error))?;
        let state = self.moving()?.state();
        let acting = self.acting(state.time);
        self.account.follow(&acting, &state);
        self.watch(&state);
        Ok(acting)
    }

    /// Notice what leaves the range in which the law was measured.
    fn watch(&mut self, state: &State) {
        let drive = self.description.drive_place();
        let time = self.origin + state.time;
        let speed = self.making().drive(self.values[drive]);
        let all = [
            (Watched::Drive, Some(speed).filter(|_| drive != DRIVE_TORQUE)),
            (Watched::Temperature, Some(self.values[TEMPERATURE])),
            (Watched::Belt, Some(state.belt_speed)),
        ];
        for (watched, value) in all {
            let Some(value) = value else { continue };
            let left = self.description.measured.left(&mut self.outside, watched, value);
            if let Some(range) = left.filter(|_| self.warns) {
                self.crossings.push(Crossing { watched, time, value, range });
            }
        }
    }

    /// What has left its range since this was asked last.
    pub fn take_crossings(&mut self) -> Vec<Crossing> {
        std::mem::take(&mut self.crossings)
    }

    /// A step of the standard, `length` from `from` on.
    pub fn step(&mut self, from: f64, length: f64) -> Result<Reached, String> {
        self.must_be(&[Phase::Step])?;
        let until = from + length;
        if !(until.is_finite() && length > 0.0) {
            return Err(format!(
                "a step from {from:?} over {length:?} is none: its length must be positive"
            ));
        }
        let same = SAME_TIME.0 * length + SAME_TIME.1 * from.abs().max(until.abs());
        if (from - self.time).abs() > same {
            let time = self.time;
            return Err(format!("the step begins at {from:?}, but the instance is at {time:?}"));
        }
        let stopping = self.event_mode && self.early_return;
        if stopping && self.has_changed()? {
            return Err(format!("an event waits at {:?}: enter event mode first", self.time));
        }
        self.advance(until, same, stopping)
    }

    /// On to `until`, or to the first change of mode or slip before it if `stopping`.
    ///
    /// What fails leaves all as it was.
    pub fn advance(&mut self, until: f64, same: f64, stopping: bool) -> Result<Reached, String> {
        self.must_be(&[Phase::Step])?;
        if !until.is_finite() || until < self.time {
            return Err(format!("time {until:?} is not after {:?}", self.time));
        }
        if until > self.stop + same {
            return Err(format!("time {until:?} is beyond the stop time {:?}", self.stop));
        }
        let moment = self.moving()?.moment();
        let (account, outside) = (self.account, self.outside);
        self.now = None;
        self.led(until, stopping).or_else(|words| {
            self.now = None;
            (self.account, self.outside) = (account, outside);
            self.moving()?.restore(moment).map_err(|error| error.to_string())?;
            Err(words)
        })
    }

    fn led(&mut self, until: f64, stopping: bool) -> Result<Reached, String> {
        let acting = self.follow()?;
        let (origin, before) = (self.origin, self.time);
        let work = Work::unwatched(self.description.most_steps);
        // the mode may change at once, by a jump of an input
        let mut early = stopping && self.has_changed()?;
        let mut time = if early { before } else { until };
        while !early {
            let Some(event) = self.walk(&acting, until - origin, &work)? else { break };
            early = stopping && event.time + origin < until && self.has_changed()?;
            time = if early { event.time + origin } else { until };
        }
        self.time = time;
        let places = [self.description.drive_place(), TEMPERATURE];
        for (slope, place) in self.slopes.iter_mut().zip(places) {
            if *slope != 0.0 {
                self.values[place] += *slope * (time - before);
                *slope = if early { *slope } else { 0.0 };
            }
        }
        let state = self.state()?;
        self.watch(&state);
        let State { belt_speed, stretch, pull, drag, .. } = state;
        if ![belt_speed, stretch, pull, drag].iter().all(|number| number.is_finite()) {
            return Err(format!("the motion is no longer finite at {time:?}: are the inputs?"));
        }
        let changed = self.has_changed()?;
        if !self.event_mode {
            self.show()?;
        }
        Ok(Reached { time, changed, early })
    }

    /// On to a time of the motion or to the first event before it, in steps over which all that adds up is known.
    fn walk(&mut self, acting: &Acting, until: f64, work: &Work) -> Result<Option<Event>, String> {
        let looking = Work::unwatched(self.description.most_steps);
        let shortest = (until - self.moving()?.time()) / MOST_STRIDES;
        loop {
            self.now = None;
            let before = self.moving()?.state();
            let left = until - before.time;
            let mut length = self.account.next_step(acting, left).max(shortest);
            let (target, nodes, share) = loop {
                let stop = before.time + length;
                let target = if length < left && stop > before.time { stop } else { until };
                let nodes = self.nodes(&before, target, &looking)?;
                let share = Share::of(acting, &nodes);
                let shorter = CUT * (nodes[2].time - before.time);
                if !share.is_rough() || shorter <= shortest {
                    break (target, nodes, share);
                }
                length = shorter;
            };
            let event = self.moving()?.advance(target, work);
            let event = event.map_err(|error| self.making().words(error))?;
            let after = self.moving()?.state();
            self.account.add(acting, &share, &nodes, &after);
            self.watch(&after);
            if event.is_some() || target >= until {
                return Ok(event);
            }
        }
    }

    /// The motion at a time, half-way to it, and before; if an event comes first, just before that.
    fn nodes(&mut self, before: &State, end: f64, work: &Work) -> Result<[State; 3], String> {
        self.moving()?;
        let Some(motion) = &self.motion else { return Ok([*before; 3]) };
        let look = |end: f64| {
            let mut along = motion.clone();
            if let Some(event) = along.advance(f64::midpoint(before.time, end), work)? {
                return Ok(Err(event.time));
            }
            let middle = along.state();
            let event = along.advance(end, work)?;
            Ok(event.map_or(Ok([*before, middle, along.state()]), |event| Err(event.time)))
        };
        let words = |error: Error| self.making().words(error);
        let early = match look(end).map_err(words)? {
            Ok(nodes) => return Ok(nodes),
            Err(early) => early.next_down(),
        };
        if early <= before.time {
            return Ok([*before; 3]);
        }
        Ok(look(early).map_err(words)?.unwrap_or([*before; 3]))
    }

    /// All that changes.
    pub fn saved(&self) -> Saved {
        Saved {
            phase: self.phase,
            values: self.values,
            slopes: self.slopes,
            origin: self.origin,
            time: self.time,
            stop: self.stop,
            seen: self.seen,
            account: self.account,
            outside: self.outside,
            moment: self.motion.as_ref().map(|motion| motion.moment().numbers()),
        }
    }

    /// Go on from what was saved, of this drive, earlier or elsewhere.
    pub fn restore(&mut self, saved: &Saved) -> Result<(), String> {
        let (before, motion) = (self.saved(), self.motion.clone());
        self.take(saved).inspect_err(|_| {
            self.take_values(&before);
            (self.motion, self.now) = (motion, None);
        })
    }

    fn take_values(&mut self, saved: &Saved) {
        (self.phase, self.values, self.slopes) = (saved.phase, saved.values, saved.slopes);
        (self.seen, self.now) = (saved.seen, None);
        (self.account, self.outside) = (saved.account, saved.outside);
        (self.origin, self.time, self.stop) = (saved.origin, saved.time, saved.stop);
    }

    fn take(&mut self, saved: &Saved) -> Result<(), String> {
        let own = self.description.values.iter().zip(&saved.values);
        let has_all = own.clone().all(|(own, value)| own.is_nan() || value.is_finite());
        if !has_all || own.clone().any(|(own, value)| own.is_nan() != value.is_nan()) {
            return Err("the values saved are not those of this drive".to_owned());
        }
        let same = |place: usize| self.values[place].to_bits() == saved.values[place].to_bits();
        let is_parameter = |place: &usize| VARIABLES[*place].causality == Causality::Parameter;
        if !(0..COUNT).filter(is_parameter).all(same) {
            self.motion = None;
        }
        self.take_values(saved);
        let Some(numbers) = &saved.moment else {
            self.motion = None;
            return Ok(());
        };
        let moment = Moment::from_numbers(numbers).map_err(|error| error.to_string())?;
        self.moving()?.restore(moment).map_err(|error| error.to_string())
    }
}

/// Tightest tolerance that the core takes.
const TIGHTEST: f64 = 1e-14;

#[cfg(test)]
mod tests;
