//! What adds up along a motion: ways, work of the drive, and the heat that friction makes of it.
//!
//! The motion itself keeps no sums. They are made here from values and slopes at three times of each step, by a rule of
//! sixth order; the step follows the difference to the rule of fourth order. A step never reaches across an event.

use hersey_core::motion::State;

/// Difference of the two rules over a step, as a share of the energies there, that a step may have.
const TOLERANCE: f64 = 1e-7;
/// Factors by which a step is cut if it was too long, and may grow at the most.
pub const CUT: f64 = 0.25;
const GROWTH: f64 = 4.0;

/// What acts on a motion between two changes of its inputs.
#[derive(Debug, Clone, Copy)]
pub struct Acting {
    pub stiffness: f64,
    pub mass: f64,
    /// Whether the drive is a speed at the end of the spring, else a force on the mass.
    pub is_speed: bool,
    /// Speed or force of the drive at the time `since`, and its slope.
    pub drive: [f64; 2],
    pub since: f64,
    /// Force and damping of the rest of the drive then, and their slopes.
    pub rest: [f64; 2],
    pub rest_slope: [f64; 2],
}

/// A quantity and its slope in time.
type Rate = [f64; 2];

/// What flows at a moment.
#[derive(Debug, Clone, Copy)]
struct Flows {
    /// Power of the drive, and of it the rest of the drive, W.
    work: Rate,
    rest: Rate,
    /// Speed of the roll ahead of the belt on which it slips, m/s.
    slip: Rate,
    pull: f64,
    stored: f64,
}

impl Acting {
    /// Drive at a time.
    fn drive_at(&self, time: f64) -> f64 {
        self.drive[0] + self.drive[1] * (time - self.since)
    }

    /// Energy of spring and mass.
    pub fn stored(&self, state: &State) -> f64 {
        let State { stretch, belt_speed, .. } = state;
        0.5 * (self.stiffness * stretch * stretch + self.mass * belt_speed * belt_speed)
    }

    /// Power that the rest of the drive takes, W.
    pub fn rest_power(&self, state: &State) -> f64 {
        self.rest_rate(state, 0.0)[0]
    }

    fn rest_rate(&self, state: &State, acceleration: f64) -> Rate {
        let (speed, elapsed) = (state.belt_speed.abs(), state.time - self.since);
        let [force, damping] = [0, 1].map(|i| self.rest[i] + self.rest_slope[i] * elapsed);
        let faster = acceleration * state.belt_speed.signum();
        let warmer = (self.rest_slope[0] + self.rest_slope[1] * speed) * speed;
        [(force + damping * speed) * speed, (force + 2.0 * damping * speed) * faster + warmer]
    }

    /// Speed of the roll ahead of the belt, where it slips on it.
    fn slip_rate(&self, state: &State, acceleration: f64) -> Rate {
        if !(state.slipping && self.is_speed) {
            return [0.0; 2];
        }
        [self.drive_at(state.time) - state.belt_speed, self.drive[1] - acceleration]
    }

    /// Heat of the roll that slips, W.
    pub fn slip_power(&self, state: &State) -> f64 {
        state.pull * self.slip_rate(state, 0.0)[0]
    }

    fn flows(&self, state: &State) -> Flows {
        let State { belt_speed, pull, drag, .. } = *state;
        let acceleration = (pull - drag) / self.mass;
        let (drive, slope) = (self.drive_at(state.time), self.drive[1]);
        let work = if self.is_speed {
            let grips = if state.slipping { 0.0 } else { self.stiffness };
            [pull * drive, grips * (drive - belt_speed) * drive + pull * slope]
        } else {
            [drive * belt_speed, slope * belt_speed + drive * acceleration]
        };
        let rest = self.rest_rate(state, acceleration);
        let slip = self.slip_rate(state, acceleration);
        Flows { work, rest, slip, pull, stored: self.stored(state) }
    }

    /// Longest step over which the spring's swing is seen.
    pub fn longest(&self) -> f64 {
        if self.stiffness > 0.0 { (self.mass / self.stiffness).sqrt() } else { f64::INFINITY }
    }
}

/// What a step adds: work, rest and slip, and how far the two rules differ, of what is allowed.
#[derive(Debug, Clone, Copy)]
pub struct Share {
    work: f64,
    rest: f64,
    slipped: f64,
    slip: f64,
    error: f64,
}

/// Integral over three times, in the middle and at both ends of `span`, and its difference to Simpson's rule.
fn integral(span: f64, rates: [Rate; 3]) -> [f64; 2] {
    let [[a, slope_a], [b, _], [c, slope_c]] = rates;
    let fine = span * (7.0 * (a + c) + 16.0 * b) / 30.0 + span * span * (slope_a - slope_c) / 60.0;
    [fine, fine - span * (a + 4.0 * b + c) / 6.0]
}

impl Share {
    /// Over a step from the first state to the last, the second half-way between.
    pub fn of(acting: &Acting, states: &[State; 3]) -> Self {
        let span = states[2].time - states[0].time;
        let flows = [0, 1, 2].map(|i| acting.flows(&states[i]));
        let [work, work_gap] = integral(span, flows.map(|flow| flow.work));
        let [rest, rest_gap] = integral(span, flows.map(|flow| flow.rest));
        let [slipped, slip_gap] = integral(span, flows.map(|flow| flow.slip));
        let scale = flows.iter().fold(0.0, |scale: f64, flow| {
            scale.max(flow.stored + span * (flow.work[0].abs() + flow.rest[0].abs()))
        });
        let pull = flows[2].pull; // that of the grip all along, where it slips
        let gap = work_gap.abs().max(rest_gap.abs()).max((pull * slip_gap).abs());
        let error = if scale > 0.0 { gap / (TOLERANCE * scale) } else { 0.0 };
        Self { work, rest, slipped, slip: pull * slipped, error }
    }

    /// Whether the step was too long to be known well; one that is no number is left to others.
    pub fn is_rough(&self) -> bool {
        self.error > 1.0
    }
}

/// Heat since the start, which does not fall: what friction gives back for a while is set off against what it takes next.
///
/// It gives back where the `retained` rule keeps a belt moving that the spring pulls back, and where bristles spring back.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Heat {
    energy: f64,
    owed: f64,
}

impl Heat {
    fn add(&mut self, gained: f64, gives_back: bool) {
        if gives_back || self.owed > 0.0 {
            self.owed -= gained;
            self.energy += (-self.owed).max(0.0);
            self.owed = self.owed.max(0.0);
        } else {
            self.energy += gained;
        }
    }

    fn power(&self, power: f64) -> f64 {
        if self.owed > 0.0 { 0.0 } else { power.max(0.0) }
    }
}

/// Sums since the start.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Account {
    /// Stretch at the start, and energy of spring and mass as last added up.
    stretch: f64,
    stored: f64,
    /// Speed of the drive and its slope, since when, and the way of the drive until then.
    drive: [f64; 2],
    since: f64,
    position: f64,
    /// Way by which the roll has slipped ahead of the belt, and its heat.
    slipped: f64,
    slip: f64,
    friction: Heat,
    contact: Heat,
    /// Step that the rules would take next; none at the start.
    step: f64,
}

impl Account {
    /// How many numbers it is.
    pub const NUMBERS: usize = 13;

    /// At the start of a motion.
    pub fn begun(acting: &Acting, state: &State) -> Self {
        let (stretch, stored) = (state.stretch, acting.stored(state));
        Self { stretch, stored, drive: acting.drive, since: acting.since, ..Self::default() }
    }

    /// All of it as numbers.
    pub fn numbers(&self) -> [f64; Self::NUMBERS] {
        let Self { stretch, stored, drive, since, position, slipped, slip, step, .. } = *self;
        let Self { friction, contact, .. } = *self;
        let [speed, slope] = drive;
        let heats = [friction.energy, friction.owed, contact.energy, contact.owed];
        let [a, b, c, d] = heats;
        [stretch, stored, speed, slope, since, position, slipped, slip, a, b, c, d, step]
    }

    /// From numbers, if they are such.
    pub fn from_numbers(numbers: &[f64; Self::NUMBERS]) -> Option<Self> {
        let [stretch, stored, speed, slope, since, position, slipped, slip, a, b, c, d, step] =
            *numbers;
        let heat = |energy, owed| Heat { energy, owed };
        let (friction, contact) = (heat(a, b), heat(c, d));
        let is_one = numbers.iter().all(|number| number.is_finite()) && step >= 0.0;
        let drive = [speed, slope];
        let account = Self {
            stretch,
            stored,
            drive,
            since,
            position,
            slipped,
            slip,
            friction,
            contact,
            step,
        };
        (is_one && b >= 0.0 && d >= 0.0).then_some(account)
    }

    /// Way of the drive since the start.
    pub fn drive_position(&self, time: f64) -> f64 {
        let elapsed = time - self.since;
        self.position + (self.drive[0] + 0.5 * self.drive[1] * elapsed) * elapsed
    }

    /// Way of the belt since the start: of the drive but for slip and stretch, or of the mass that a force drives.
    pub fn belt_position(&self, is_speed: bool, state: &State) -> f64 {
        let stretched = state.stretch - self.stretch;
        if is_speed {
            self.drive_position(state.time) - self.slipped - stretched
        } else {
            stretched
        }
    }

    /// Heat since the start: of all drag, of the contact, of the roll that slips.
    pub fn heats(&self) -> [f64; 3] {
        // less than nothing is rounding
        [self.friction.energy, self.contact.energy, self.slip].map(|energy| energy.max(0.0))
    }

    /// Power of all drag on the belt and of the contact alone.
    pub fn powers(&self, acting: &Acting, state: &State) -> [f64; 2] {
        let friction = state.drag * state.belt_speed;
        let contact = friction - acting.rest_power(state);
        [self.friction.power(friction), self.contact.power(contact)]
    }

    /// The inputs change, and with them maybe the state, at once.
    pub fn follow(&mut self, acting: &Acting, state: &State) {
        let [before, slope] = self.drive;
        let goes_on = before + slope * (state.time - self.since);
        if acting.drive[1].to_bits() != slope.to_bits()
            || acting.drive[0].to_bits() != goes_on.to_bits()
        {
            self.position = self.drive_position(state.time);
            (self.drive, self.since) = (acting.drive, state.time);
        }
        self.settle(acting, state, 0.0, 0.0, [false; 2]);
    }

    /// Step to take next, of what is left.
    pub fn next_step(&self, acting: &Acting, left: f64) -> f64 {
        let wanted = if self.step > 0.0 { self.step } else { left };
        wanted.min(acting.longest()).min(left)
    }

    /// Take a share over a step along three states; `after` is the last once what happens there has happened.
    pub fn add(&mut self, acting: &Acting, share: &Share, nodes: &[State; 3], after: &State) {
        let (length, error) = (nodes[2].time - nodes[0].time, share.error.max(1e-12));
        let wanted = length * (0.9 * error.powf(-0.2)).clamp(CUT, GROWTH);
        // a step that was cut short by its end says nothing about the next
        self.step = if length < self.step { self.step.max(wanted) } else { wanted };
        self.slipped += share.slipped;
        self.slip += share.slip;
        let any = |gives: fn(f64, f64) -> bool| {
            let power = |state: &State| state.drag * state.belt_speed;
            nodes.iter().any(|state| gives(power(state), acting.rest_power(state)))
        };
        let gives_back = [any(|drag, _| drag < 0.0), any(|drag, rest| drag < rest)];
        self.settle(acting, after, share.work - share.slip, share.rest, gives_back);
    }

    /// What of the work is not stored is heat.
    fn settle(
        &mut self,
        acting: &Acting,
        state: &State,
        work: f64,
        rest: f64,
        gives_back: [bool; 2],
    ) {
        let stored = acting.stored(state);
        let heat = work - (stored - self.stored);
        self.stored = stored;
        self.friction.add(heat, gives_back[0]);
        self.contact.add(heat - rest, gives_back[1]);
    }
}
