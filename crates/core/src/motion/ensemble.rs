//! What thousands of belts settle to: laps in lanes where they are plain, the full motion where they are not.

use super::cycle::{Span, settle};
use super::hybrid::Motion;
use super::lanes::{Lanes, arrival, run_lanes};
use super::piece::Piece;
use super::stick_slip_cycle::{CycleKind, StickSlipCycle};
use super::system::{Drivetrain, Integrator, Start, System, checked_tolerance};
use crate::drag::{Closure, Drag, Mode, Rest};
use crate::error::{Error, above, finite, unless_stopped};
use crate::work::Work;

/// One belt of an ensemble: a drivetrain and drag at constant drive speed, and where the motion starts.
#[derive(Debug, Clone, PartialEq)]
pub struct Belt {
    /// Spring and mass.
    pub train: Drivetrain,
    /// Drag at one temperature.
    pub drag: Drag,
    /// Speed of the drive.
    pub drive_speed: f64,
    /// Where the motion starts.
    pub start: Start,
}

/// What a belt settles to, or why its motion cannot be followed.
pub type Outcome = Result<StickSlipCycle, Error>;

/// What each of `belts` settles to, in their order.
///
/// The outcome of a belt does not depend on the others; what `work` allows is for each of them.
///
/// # Errors
/// If tolerance, time or a drive speed is out of range, or `work` is stopped; each belt's outcome may be an error of
/// its own.
pub fn ensemble(
    belts: &[Belt],
    span: Span,
    tolerance: f64,
    work: &Work,
) -> Result<Vec<Outcome>, Error> {
    checked_tolerance(tolerance)?;
    if let Span::Lasting(duration) = span {
        above("duration", duration, 0.0)?;
    }
    for belt in belts {
        finite("drive_speed", belt.drive_speed)?;
    }
    let mut results: Vec<Option<Outcome>> = vec![None; belts.len()];
    let mut waiting = belts.iter().enumerate();
    let admit = |lanes: &mut Lanes, l: usize| {
        waiting.find_map(|(index, belt)| {
            let mut member = Member::new(index, belt, span)?;
            member.start(belt.start, lanes, l, tolerance, work).then_some(member)
        })
    };
    run_lanes::<false, _>(tolerance, work, admit, |member, lanes, l| {
        let verdict = member.follow(lanes, l, span, tolerance, work);
        match verdict {
            // a grip that the belt never needed changes nothing; else the motion is another
            Verdict::Arrived if member.slips() => {}
            Verdict::Arrived => results[member.index] = Some(Ok(member.cycle())),
            Verdict::TooLong => results[member.index] = Some(Err(member.too_long(lanes, l, work))),
            Verdict::Rides | Verdict::Leaves => {}
        }
        matches!(verdict, Verdict::Rides)
    })?;
    let results = results.into_iter().zip(belts);
    unless_stopped(results.map(|(result, belt)| {
        result.unwrap_or_else(|| alone(belt, span, tolerance, &work.apart(work.allowed())))
    }))
}

fn alone(belt: &Belt, span: Span, tolerance: f64, work: &Work) -> Outcome {
    settle(&belt.train, &belt.drag, belt.drive_speed, belt.start, span, tolerance, work)
}

/// Turns of the speed without sticking after which a belt is followed alone, where its orbit is looked at as a
/// whole: few below the transition speed, where swings do not die out.
const MAX_TURNS: (u32, u32) = (8, 200);
/// Steps without any event after which a belt is followed alone.
const MAX_STEPS: u32 = 2000;
/// Pieces of motion off the lanes after which a belt is followed alone.
const MAX_PIECES: usize = 200;
/// Damping of the rising branch, in scaled units, from which the motion is stiff.
const STIFF: f64 = 30.0;
/// Relative change of the pull at release between laps at which an orbit has closed.
const CLOSED: f64 = 1e-9;

/// Sizes that make the equation of a belt dimensionless.
#[derive(Debug, Clone, Copy)]
struct Scale {
    time: f64,
    speed: f64,
    pull: f64,
}

/// Extremes and durations of the lap under way, scaled.
#[derive(Debug, Clone, Copy)]
struct Lap {
    begin: f64,
    stuck: f64,
    speed: (f64, f64),
    pull: (f64, f64),
    impulse: f64,
}

impl Lap {
    fn starting(time: f64) -> Self {
        let none = (f64::INFINITY, f64::NEG_INFINITY);
        Self { begin: time, stuck: 0.0, speed: none, pull: none, impulse: 0.0 }
    }

    fn add_speed(&mut self, speed: f64) {
        self.speed = (self.speed.0.min(speed), self.speed.1.max(speed));
    }

    fn add_pull(&mut self, pull: f64) {
        self.pull = (self.pull.0.min(pull), self.pull.1.max(pull));
    }
}

/// A belt on a lane.
struct Member {
    index: usize,
    system: System,
    scale: Scale,
    /// Drag at the transition, stick speed and pull at release, scaled.
    damping: f64,
    stick_speed: f64,
    release: f64,
    /// Drag of the rest of the drive: at any speed, which the pull on the lane leaves out, and per speed, scaled.
    rest: Rest,
    exponents: (f64, f64),
    drive: f64,
    /// Time at which the belt is taken off, scaled.
    until: f64,
    lap: Lap,
    /// Pull and speed at the release that began the lap, if one did.
    released: Option<(f64, f64)>,
    whole: Option<(Lap, f64)>,
    /// Greatest pull of the laps before, either way.
    hardest: f64,
    laps: usize,
    turns: u32,
    steps: u32,
    /// Steps in all.
    all_steps: u64,
    /// The belt slides with the drive for good.
    steady: bool,
}

/// What becomes of a member.
enum Verdict {
    Rides,
    Arrived,
    Leaves,
    /// The belt has taken all the steps that it may.
    TooLong,
}

impl Member {
    /// The belt in scaled units, if its laps are plain.
    fn new(index: usize, belt: &Belt, span: Span) -> Option<Box<Self>> {
        let Belt { train, drag, drive_speed, .. } = belt;
        let (mixed, ehl) = drag.two_branches()?;
        let scale = Scale {
            time: train.time_scale(),
            speed: drag.transition_speed(),
            pull: drag.transition_speed() * train.impedance(),
        };
        let damping = drag.transition_force() / scale.pull;
        let (stick_speed, drive) = (drag.stick_speed() / scale.speed, drive_speed / scale.speed);
        let rest = Rest {
            force: drag.rest().force / scale.pull,
            damping: drag.rest().damping * scale.speed / scale.pull,
        };
        let plain = drag.closure() == Closure::Retained
            && drive > 1.01 * stick_speed
            && drive < 1e3
            && damping * ehl.max(mixed) + rest.damping < STIFF
            && damping > 1e-6
            && damping < 1e3;
        if !plain {
            return None;
        }
        let until = match span {
            Span::UntilClosed => f64::INFINITY,
            Span::Lasting(duration) => duration / scale.time,
        };
        Some(Box::new(Self {
            index,
            system: System::at_speed(*train, drag, *drive_speed).ok()?,
            scale,
            damping,
            stick_speed,
            release: drag.holding_force(drag.stick_speed()) / scale.pull,
            rest,
            exponents: (mixed, ehl),
            drive,
            until,
            lap: Lap::starting(0.0),
            released: None,
            whole: None,
            hardest: 0.0,
            laps: 0,
            turns: 0,
            steps: 0,
            all_steps: 0,
            steady: false,
        }))
    }

    /// Put the belt on its lane at the moment it first slides; false if it does not.
    fn start(
        &mut self,
        start: Start,
        lanes: &mut Lanes,
        l: usize,
        tolerance: f64,
        work: &Work,
    ) -> bool {
        (lanes.time[l], lanes.impulse[l], lanes.sense[l]) = (0.0, 0.0, 1.0);
        self.off_lane(start, lanes, l, Span::UntilClosed, tolerance, work)
            .is_some_and(|v| matches!(v, Verdict::Rides))
    }

    /// What the step that lane `l` has just made means for the belt.
    fn follow(
        &mut self,
        lanes: &mut Lanes,
        l: usize,
        span: Span,
        tolerance: f64,
        work: &Work,
    ) -> Verdict {
        if lanes.time[l] >= self.until {
            return if self.whole.is_some() { Verdict::Arrived } else { Verdict::Leaves };
        }
        self.steps += 1;
        let met = lanes.arrival[l];
        if met == arrival::NONE {
            return if self.steps <= MAX_STEPS { Verdict::Rides } else { Verdict::Leaves };
        }
        if met == arrival::LOST {
            return Verdict::Leaves;
        }
        if met == arrival::TURNING {
            self.lap.add_speed(lanes.speed[l]);
            self.turns += 1;
            self.begin_steps();
            self.steady = matches!(span, Span::UntilClosed) && self.dies_out(lanes, l);
            let most = if self.drive > 1.0 { MAX_TURNS.1 } else { MAX_TURNS.0 };
            return match self.steady {
                true => Verdict::Arrived,
                false if self.turns > most => Verdict::Leaves,
                false => Verdict::Rides,
            };
        }
        self.begin_steps();
        let level = lanes.speed[l];
        if level <= self.stick_speed {
            return self.stick(lanes, l, span, tolerance, work);
        }
        let rising = met == arrival::UPPER;
        self.at_level(lanes, l, level, rising);
        Verdict::Rides
    }

    /// Whether the belt has too little energy about steady sliding to leave the EHL branch ever again.
    fn dies_out(&self, lanes: &Lanes, l: usize) -> bool {
        let margin = self.drive - 1.0;
        if margin <= 0.0 {
            return false;
        }
        let steady =
            self.damping * self.drive.powf(self.exponents.1) + self.rest.damping * self.drive;
        if (steady + self.rest.force) * self.scale.pull >= self.system.train.grip() {
            return false;
        }
        let (ahead, off) = (lanes.speed[l] - self.drive, lanes.pull[l] - steady);
        ahead * ahead + off * off < margin * margin
    }

    /// Enter the range of speeds beyond `level`.
    #[allow(clippy::float_cmp)] // a level is reached by assigning it
    fn at_level(&mut self, lanes: &mut Lanes, l: usize, level: f64, rising: bool) {
        if level == self.drive {
            self.lap.add_pull(lanes.pull[l] + self.rest.force);
        }
        if level == 1.0 {
            lanes.drag[l] = self.damping;
        }
        let fast = level > 1.0 || (level == 1.0 && rising);
        lanes.exponent[l] = if fast { self.exponents.1 } else { self.exponents.0 };
        let (low, high) = (self.drive.min(1.0), self.drive.max(1.0));
        let next = [self.stick_speed, low, high, f64::INFINITY];
        if rising {
            lanes.lower[l] = level;
            lanes.upper[l] = next.into_iter().find(|v| *v > level).unwrap_or(f64::INFINITY);
        } else {
            lanes.upper[l] = level;
            lanes.lower[l] =
                next.into_iter().rev().find(|v| *v < level).unwrap_or(self.stick_speed);
        }
    }

    /// The belt has slowed to the stick speed: it is held until the spring has stretched, in closed form.
    fn stick(
        &mut self,
        lanes: &mut Lanes,
        l: usize,
        span: Span,
        tolerance: f64,
        work: &Work,
    ) -> Verdict {
        if self.all_steps > work.allowed() {
            return Verdict::TooLong;
        }
        let pull = lanes.pull[l] + self.rest.force;
        if pull.abs() > self.release {
            let start = Start {
                belt_speed: self.system.drag.stick_speed(),
                stretch: pull * self.scale.pull / self.system.train.stiffness(),
            };
            let verdict = self.off_lane(start, lanes, l, span, tolerance, work);
            return verdict.unwrap_or(Verdict::Leaves);
        }
        let wait = (self.release - pull) / (self.drive - self.stick_speed);
        self.lap.stuck += wait;
        self.lap.add_pull(pull);
        self.lap.add_pull(self.release);
        self.lap.add_speed(self.stick_speed);
        lanes.impulse[l] += (0.5 * (pull + self.release) - self.rest.force) * wait;
        lanes.time[l] += wait;
        (lanes.pull[l], lanes.speed[l]) = (self.release - self.rest.force, self.stick_speed);
        lanes.balance(l);
        lanes.turned[l] = 0.0;
        self.at_level(lanes, l, self.stick_speed, true);
        self.let_go(lanes.time[l], lanes.impulse[l], (self.release, self.stick_speed), span)
    }

    /// A release ends the lap and begins the next.
    fn let_go(&mut self, time: f64, impulse: f64, state: (f64, f64), span: Span) -> Verdict {
        if time > self.until {
            return if self.whole.is_some() { Verdict::Arrived } else { Verdict::Leaves };
        }
        self.turns = 0;
        if let Some((pull, speed)) = self.released {
            self.lap.impulse = impulse - self.lap.impulse;
            self.whole = Some((self.lap, time));
            self.laps += 1;
            let closed = (pull - state.0).abs() <= CLOSED * pull.abs()
                && (speed - state.1).abs() <= CLOSED * self.stick_speed;
            if closed && matches!(span, Span::UntilClosed) {
                return Verdict::Arrived;
            }
        }
        self.released = Some(state);
        self.hardest = self.hardest_pull();
        self.lap = Lap { impulse, ..Lap::starting(time) };
        self.lap.add_speed(state.1);
        self.lap.add_pull(state.0);
        Verdict::Rides
    }

    /// Follow the belt with the full motion from `start` until it slides forward; none if it never does.
    fn off_lane(
        &mut self,
        start: Start,
        lanes: &mut Lanes,
        l: usize,
        span: Span,
        tolerance: f64,
        work: &Work,
    ) -> Option<Verdict> {
        let system = self.system.clone();
        let Scale { time: time_scale, speed: speed_scale, pull: pull_scale } = self.scale;
        let origin = lanes.time[l];
        let work = work.apart(work.allowed());
        let mut motion =
            Motion::new(&system, start, tolerance, Integrator::Adaptive, &work).ok()?;
        let mut piece = motion.no_piece();
        for _ in 0..MAX_PIECES {
            if matches!(motion.phase().mode, Mode::Ehl | Mode::Mixed)
                && motion.phase().direction > 0.0
            {
                lanes.time[l] = origin + motion.time() / time_scale;
                self.load(&motion, lanes, l);
                return Some(Verdict::Rides);
            }
            let event = motion.advance(f64::INFINITY, &mut piece).ok()?;
            self.all_steps += 1;
            if piece.duration.is_infinite() {
                return None;
            }
            self.take_in(&piece);
            let shifted = self.rest.force * piece.duration / time_scale;
            lanes.impulse[l] += piece.impulse(0.0) / (pull_scale * time_scale) - shifted;
            if let Some(event) = event.filter(|e| e.from == Mode::Stuck && e.to != Mode::Stuck) {
                let now = origin + event.time / time_scale;
                let stretch = event.stretch * system.train.stiffness() / pull_scale;
                let state = (stretch, event.belt_speed / speed_scale);
                let verdict = self.let_go(now, lanes.impulse[l], state, span);
                if !matches!(verdict, Verdict::Rides) {
                    return Some(verdict);
                }
            }
        }
        None
    }

    /// After an event, steps without one are counted anew.
    fn begin_steps(&mut self) {
        self.all_steps += u64::from(self.steps);
        self.steps = 0;
    }

    fn too_long(&self, lanes: &Lanes, l: usize, work: &Work) -> Error {
        Error::TooLong { steps: work.allowed(), time: lanes.time[l] * self.scale.time }
    }

    /// Greatest pull so far, either way, scaled.
    fn hardest_pull(&self) -> f64 {
        let (low, high) = self.lap.pull;
        if low > high { self.hardest } else { self.hardest.max(-low).max(high) }
    }

    /// Whether the belt pulled harder than the roll's grip on it bears.
    fn slips(&self) -> bool {
        self.hardest_pull() * self.scale.pull >= self.system.train.grip()
    }

    /// Extremes and stuck time of a piece off the lanes.
    fn take_in(&mut self, piece: &Piece) {
        if piece.start.mode == Mode::Stuck {
            self.lap.stuck += piece.duration / self.scale.time;
        }
        // off the lanes a belt that moves forward is slower than the stick speed and the drive: nothing turns
        let backward = piece.start.direction < 0.0;
        let turning = if backward { piece.turning_points() } else { [None; 2] };
        for elapsed in
            [Some(0.0), Some(piece.duration), turning[0], turning[1]].into_iter().flatten()
        {
            let (speed, pull) = piece.at(elapsed);
            self.lap.add_speed(speed / self.scale.speed);
            self.lap.add_pull(pull / self.scale.pull);
        }
    }

    /// Put the sliding belt on its lane.
    #[allow(clippy::float_cmp)] // the motion puts a belt on a boundary by assigning it
    fn load(&mut self, motion: &Motion, lanes: &mut Lanes, l: usize) {
        let phase = motion.phase();
        let drag = &self.system.drag;
        let speed = if phase.speed == drag.stick_speed() {
            self.stick_speed
        } else if phase.speed == drag.transition_speed() {
            1.0
        } else {
            phase.speed / self.scale.speed
        };
        lanes.speed[l] = speed;
        lanes.pull[l] = phase.pull / self.scale.pull - self.rest.force;
        lanes.drag[l] = drag.contact_force(phase.speed) / self.scale.pull;
        lanes.rest[l] = self.rest.damping;
        lanes.drive[l] = self.drive;
        lanes.floor[l] = self.stick_speed;
        lanes.turned[l] = 0.0;
        if phase.released {
            lanes.balance(l);
        }
        let slower = [1.0, self.drive, self.stick_speed].into_iter().filter(|v| *v <= speed);
        let below = slower.fold(self.stick_speed, f64::max);
        self.at_level(lanes, l, below, true);
        lanes.exponent[l] =
            if phase.mode == Mode::Ehl { self.exponents.1 } else { self.exponents.0 };
        if phase.mode == Mode::Mixed && speed >= 1.0 {
            // on the transition and slowing down
            self.at_level(lanes, l, 1.0, false);
        }
        self.lap.add_speed(speed);
    }

    fn cycle(&self) -> StickSlipCycle {
        if self.steady {
            let drive_speed = self.drive * self.scale.speed;
            let stretch = self.system.drag.force(drive_speed) / self.system.train.stiffness();
            let laps = self.laps + self.turns as usize / 2;
            return StickSlipCycle::steady(drive_speed, stretch, laps);
        }
        let (lap, end) = self.whole.unwrap_or((self.lap, self.lap.begin));
        let Scale { time, speed, pull } = self.scale;
        let (duration, stuck) = ((end - lap.begin) * time, lap.stuck * time);
        let stretch = pull / self.system.train.stiffness();
        StickSlipCycle {
            kind: CycleKind::StickSlip,
            frequency: 1.0 / duration,
            slip_duration: duration - stuck,
            stick_duration: stuck,
            speed_min: lap.speed.0 * speed,
            speed_max: lap.speed.1 * speed,
            stretch_min: lap.pull.0 * stretch,
            stretch_max: lap.pull.1 * stretch,
            grip_slip_duration: 0.0,
            laps_per_period: 1,
            drag_work: self.drive * speed * lap.impulse * pull * time
                + self.drive * speed * self.system.drag.rest().force * duration,
            laps: self.laps,
        }
    }
}
