//! Many start-ups at once: in lanes where they are plain, one by one where they are not.
//!
//! A lane is scaled as those of an ensemble are: time by `sqrt(m/k)`, speed by `v_t`, pull by `v_t sqrt(k m)` and less
//! what the rest of the drive drags at any speed. The belt is followed from the moment at which it breaks away, held in
//! closed form wherever it sticks, and judged as [`start_up`] does. What is rare (a belt that is held back, a swing that
//! takes long to die out) is left to that.

use std::f64::consts::TAU;
use std::sync::OnceLock;

use super::cycle::{STEADY, Span, settle};
use super::event::Guard;
use super::hybrid::Motion;
use super::lanes::{Lanes, arrival, run_lanes};
use super::schedule::Schedule;
use super::start_up::{Ending, StartUp, Started, WATCH, greatest_pull, holds, start_up};
use super::stick_slip_cycle::CycleKind;
use super::system::{Drive, Drivetrain, Integrator, Start, System, checked_tolerance};
use crate::drag::{Closure, Drag, Mode, Rest};
use crate::error::{Error, above, unless_stopped};
use crate::work::Work;

/// Steps after which a belt is followed alone.
const MAX_STEPS: u32 = 4000;
/// Laps after the last ramp after which it is, too: swings that hardly die out.
const LONGEST: f64 = 50.0;
/// Pieces of motion off the lanes after which it is.
const MAX_PIECES: usize = 200;
/// Damping of the rising branch, in scaled units, from which the motion is stiff, and as much of the falling one.
const STIFF: f64 = 30.0;

/// A belt that is to be started, and what it is known to do.
#[derive(Debug)]
pub struct BeltAtRest {
    /// Spring and mass.
    pub train: Drivetrain,
    /// Drag, at one temperature on a lane.
    pub drag: Drag,
    /// Bits of drive speed and tolerance at which it was asked what sticking there settles to, and the answer.
    settled: OnceLock<(u64, u64, CycleKind)>,
}

impl BeltAtRest {
    /// A belt of which nothing is known yet.
    #[must_use]
    pub fn new(train: Drivetrain, drag: Drag) -> Self {
        Self { train, drag, settled: OnceLock::new() }
    }

    /// What a belt that is let go at the stick speed settles to, whatever came before.
    ///
    /// If that sticks, so does one that was held at less speed: it is let go with a harder pull, and its way in the plane of
    /// pull and speed, which none crosses, lies around the other.
    fn settled(&self, target: f64, tolerance: f64, work: &Work) -> Result<CycleKind, Error> {
        let asked = (target.to_bits(), tolerance.to_bits());
        if let Some((speed, within, kind)) = self.settled.get()
            && (*speed, *within) == asked
        {
            return Ok(*kind);
        }
        let speed = self.drag.stick_speed();
        let stretch = self.drag.holding_force(speed) / self.train.stiffness();
        let start = Start { belt_speed: speed, stretch };
        let span = Span::UntilClosed;
        let kind = settle(&self.train, &self.drag, target, start, span, tolerance, work)?.kind;
        let _ = self.settled.set((asked.0, asked.1, kind)); // the first question is kept
        Ok(kind)
    }
}

/// A belt, the speed of its drive, and what is asked of its start-up.
#[derive(Debug, Clone, Copy)]
pub struct Starting<'a> {
    /// The belt.
    pub belt: &'a BeltAtRest,
    /// Drive speed against time.
    pub drive: &'a Schedule,
    /// What is asked.
    pub asked: StartUp,
}

/// What each start-up comes to, in their order; it does not depend on the others.
///
/// What `work` allows is for each of them.
///
/// # Errors
/// If a value is out of range, a motion switches mode without end, or `work` ends before it.
pub fn start_ups(
    starting: &[Starting],
    tolerance: f64,
    work: &Work,
) -> Result<Vec<Started>, Error> {
    checked_tolerance(tolerance)?;
    for each in starting {
        above("target", each.asked.target, 0.0)?;
    }
    let mut results: Vec<Option<Result<Started, Error>>> = vec![None; starting.len()];
    let mut waiting = starting.iter().enumerate();
    let admit = |lanes: &mut Lanes, l: usize| {
        waiting.find_map(|(index, each)| {
            let mut rider = Rider::new(index, each)?;
            rider.break_away(lanes, l).then_some(rider)
        })
    };
    run_lanes::<true, _>(tolerance, work, admit, |rider, lanes, l| {
        match rider.follow(lanes, l, tolerance, work) {
            Next::Rides => return true,
            Next::Leaves => {}
            Next::Ends(ending) => results[rider.index] = Some(Ok(rider.started(ending))),
            Next::Fails(error) => results[rider.index] = Some(Err(error)),
        }
        lanes.end[l] = f64::INFINITY;
        false
    })?;
    let results = results.into_iter().zip(starting).map(|(result, each)| {
        result.unwrap_or_else(|| alone(each, tolerance, &work.apart(work.allowed())))
    });
    unless_stopped(results)?.into_iter().collect()
}

fn alone(each: &Starting, tolerance: f64, work: &Work) -> Result<Started, Error> {
    let Starting { belt, drive, asked } = each;
    let system = System::new(belt.train, &belt.drag, Drive::Speed((*drive).clone()), None)?;
    start_up(&system, asked, tolerance, work)
}

/// What becomes of a belt on its lane.
enum Next {
    Rides,
    Leaves,
    Ends(Ending),
    Fails(Error),
}

/// Where a belt is that is not held in closed form.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Range {
    /// Below the stick speed, on its way up.
    Creep,
    Mixed,
    Ehl,
}

/// A belt on a lane; all numbers scaled.
struct Rider<'a> {
    index: usize,
    belt: &'a BeltAtRest,
    asked: &'a StartUp,
    drive: &'a Schedule,
    segment: usize,
    time_scale: f64,
    speed_scale: f64,
    pull_scale: f64,
    /// Drag of the contact at the transition, and of a belt at rest.
    damping: f64,
    breakaway: f64,
    /// What holds a belt at the stick speed, the rest at any speed left out.
    release: f64,
    exponents: (f64, f64),
    stick_speed: f64,
    rest: Rest,
    grip: f64,
    target: f64,
    /// Drag of steady sliding at the target, and the speed from which drag rises.
    steady: f64,
    foot: f64,
    ramps: f64,
    until: f64,
    latest: f64,
    /// When a belt that is held is judged in any case, and when one that slides is followed alone.
    watched: f64,
    given_up: f64,
    range: Range,
    released: f64,
    /// Whether it is known that a belt that sticks comes to slide, or not asked.
    judged: bool,
    steps: u32,
    /// Least and greatest pull, with the rest at any speed.
    pulls: (f64, f64),
}

impl<'a> Rider<'a> {
    /// The belt in scaled units, if its start-up is plain.
    fn new(index: usize, each: &'a Starting) -> Option<Box<Self>> {
        let Starting { belt: belt @ BeltAtRest { train, drag, .. }, drive, asked } = each;
        let exponents = drag.two_branches()?;
        let (time_scale, speed_scale) = (train.time_scale(), drag.transition_speed());
        let pull_scale = speed_scale * train.impedance();
        let damping = drag.transition_force() / pull_scale;
        let rest = Rest {
            force: drag.rest().force / pull_scale,
            damping: drag.rest().damping * speed_scale / pull_scale,
        };
        let (stick_speed, target) = (drag.stick_speed() / speed_scale, asked.target / speed_scale);
        let steepest = exponents.1.max(exponents.0);
        let plain = drag.closure() == Closure::Retained
            && drive.is_linear()
            && target > 1.01 * stick_speed
            && target < 1e3
            && damping * steepest + rest.damping < STIFF
            && damping > 1e-6
            && damping < 1e3;
        if !plain {
            return None;
        }
        let scaled = |time: f64| time / time_scale;
        let (ramps, until) = (scaled(asked.ramps), scaled(asked.until));
        Some(Box::new(Self {
            index,
            belt,
            asked,
            drive,
            segment: drive.segment(0.0),
            time_scale,
            speed_scale,
            pull_scale,
            damping,
            breakaway: drag.breakaway_force() / pull_scale,
            release: drag.holding_force(drag.stick_speed()) / pull_scale - rest.force,
            exponents,
            stick_speed,
            rest,
            grip: train.grip() / pull_scale,
            target,
            steady: drag.force(asked.target) / pull_scale,
            foot: drag.rising_from() / speed_scale,
            ramps,
            until,
            latest: scaled(asked.latest),
            watched: ramps + WATCH * TAU,
            given_up: ramps.max(until) + LONGEST * TAU,
            range: Range::Creep,
            released: f64::INFINITY,
            judged: asked.peak,
            steps: 0,
            pulls: (0.0, 0.0),
        }))
    }

    fn started(&self, ending: Ending) -> Started {
        let (low, high) = self.pulls;
        let peak = if self.asked.peak { high.max(-low) * self.pull_scale } else { 0.0 };
        Started { ending, released: self.released * self.time_scale, peak }
    }

    /// When the segment of the drive ends.
    fn segment_end(&self) -> f64 {
        self.drive.end(self.segment) / self.time_scale
    }

    /// Speed of the drive and its rate at a time of the segment.
    fn drive_at(&self, time: f64) -> (f64, f64) {
        let [speed, rate, ..] = self.drive.about(self.segment, time * self.time_scale);
        (speed / self.speed_scale, rate * self.time_scale / self.speed_scale)
    }

    /// When a belt that is held at `speed` from `time` on is pulled with `hardest`; none where the pull would fall.
    fn held_until(
        &mut self,
        mut time: f64,
        mut pull: f64,
        speed: f64,
        hardest: f64,
    ) -> Option<f64> {
        loop {
            let (drive, rate) = self.drive_at(time);
            let (ahead, end) = (drive - speed, self.segment_end());
            if ahead < 0.0 || (ahead == 0.0 && rate <= 0.0 && end.is_infinite()) {
                return None;
            }
            let missing = hardest - pull;
            let root = ahead * ahead + 2.0 * rate * missing;
            let wait =
                if root >= 0.0 { 2.0 * missing / (ahead + root.sqrt()) } else { f64::INFINITY };
            if time + wait <= end {
                return (missing >= 0.0 && wait.is_finite()).then_some(time + wait);
            }
            let rest = end - time;
            pull += rest * (ahead + 0.5 * rate * rest);
            time = end;
            self.segment += 1;
        }
    }

    /// Put the belt on its lane when it breaks away from rest; false if that is not plain.
    fn break_away(&mut self, lanes: &mut Lanes, l: usize) -> bool {
        let pull = self.breakaway + self.rest.force;
        let Some(time) = self.held_until(0.0, 0.0, 0.0, pull) else { return false };
        if pull >= self.grip || time >= self.ramps.min(self.latest) {
            return false;
        }
        (lanes.most[l], lanes.least[l]) = (self.breakaway, -self.rest.force);
        self.released = time;
        self.let_go(lanes, l, time, (self.breakaway, 0.0));
        self.enter(lanes, l, Range::Creep);
        true
    }

    /// Let a belt go that is pulled with just what it drags.
    fn let_go(&self, lanes: &mut Lanes, l: usize, time: f64, (pull, speed): (f64, f64)) {
        (lanes.time[l], lanes.pull[l], lanes.speed[l]) = (time, pull, speed);
        (lanes.impulse[l], lanes.sense[l], lanes.turned[l]) = (0.0, 1.0, 1.0);
        (lanes.rest[l], lanes.floor[l]) = (self.rest.damping, self.stick_speed);
        lanes.balance(l);
        self.drive_on(lanes, l);
    }

    /// Take the drive from its segment.
    fn drive_on(&self, lanes: &mut Lanes, l: usize) {
        (lanes.drive[l], lanes.ramp[l]) = self.drive_at(lanes.time[l]);
        lanes.end[l] = self.segment_end().min(self.given_up);
    }

    /// The belt goes on over a range of speeds.
    fn enter(&mut self, lanes: &mut Lanes, l: usize, range: Range) {
        self.range = range;
        let decay = self.belt.drag.decay_speed() / self.speed_scale;
        (lanes.exponent[l], lanes.decay[l], lanes.lower[l], lanes.upper[l]) = match range {
            Range::Creep => (0.0, decay, -1.0, self.stick_speed),
            Range::Mixed => (self.exponents.0, 0.0, self.stick_speed, 1.0),
            Range::Ehl => (self.exponents.1, 0.0, 1.0, f64::INFINITY),
        };
    }

    /// What the step that lane `l` has just made means for the belt.
    fn follow(&mut self, lanes: &mut Lanes, l: usize, tolerance: f64, work: &Work) -> Next {
        self.steps += 1;
        let (met, time) = (lanes.arrival[l], lanes.time[l]);
        if met == arrival::LOST || self.steps > MAX_STEPS {
            return Next::Leaves;
        }
        self.pulls = (lanes.least[l] + self.rest.force, lanes.most[l] + self.rest.force);
        if self.pulls.1 >= self.grip || -self.pulls.0 >= self.grip {
            return Next::Ends(Ending::GripLost);
        }
        if met == arrival::TURNING && self.range == Range::Creep {
            return Next::Leaves;
        }
        let crossed = met == arrival::UPPER || met == -arrival::UPPER;
        if crossed && self.range == Range::Creep {
            self.released = time;
            self.enter(lanes, l, Range::Mixed);
        } else if met == arrival::UPPER || (crossed && self.range == Range::Ehl) {
            lanes.drag[l] = self.damping;
            self.enter(lanes, l, if met == arrival::UPPER { Range::Ehl } else { Range::Mixed });
        }
        let sticks = crossed && lanes.speed[l] <= self.stick_speed && met != arrival::UPPER;
        let held = sticks || self.range == Range::Creep;
        if time >= self.latest && (held || self.released >= self.latest) {
            return Next::Ends(Ending::Late);
        }
        if sticks {
            return self.stick(lanes, l, tolerance, work);
        }
        if !held && time >= self.ramps.max(self.until) && self.dies_out(lanes, l) {
            return Next::Ends(Ending::Slides);
        }
        if time >= self.given_up {
            return Next::Leaves;
        }
        if time >= self.segment_end() {
            self.segment += 1;
        }
        if time >= lanes.end[l] {
            self.drive_on(lanes, l);
        }
        Next::Rides
    }

    /// The belt has slowed to the stick speed: it is held until the spring has stretched.
    fn stick(&mut self, lanes: &mut Lanes, l: usize, tolerance: f64, work: &Work) -> Next {
        let (time, pull) = (lanes.time[l], lanes.pull[l]);
        if pull + self.rest.force < -(self.release + self.rest.force) {
            return self.off_lane(lanes, l, tolerance, work);
        }
        self.hold(lanes, l, (time, pull, self.stick_speed), tolerance, work)
    }

    /// The belt is held at a speed from a time on, until the spring has stretched.
    fn hold(
        &mut self,
        lanes: &mut Lanes,
        l: usize,
        (time, pull, speed): (f64, f64, f64),
        tolerance: f64,
        work: &Work,
    ) -> Next {
        let BeltAtRest { train, drag, .. } = self.belt;
        let slower = speed < self.stick_speed;
        let release = if slower {
            drag.holding_force(speed * self.speed_scale) / self.pull_scale - self.rest.force
        } else {
            self.release
        };
        let held = slower.then(|| Start {
            belt_speed: speed * self.speed_scale,
            stretch: (pull + self.rest.force) * self.pull_scale / train.stiffness(),
        });
        while time >= self.segment_end() {
            self.segment += 1;
        }
        let Some(end) = self.held_until(time, pull, speed, release) else { return Next::Leaves };
        if end > self.ramps {
            // held when the drive moves as it will
            if time.max(self.ramps) >= self.latest {
                return Next::Ends(Ending::Late);
            }
            if let Some(end) = self.judge(held, tolerance, work) {
                return end;
            }
        }
        if release + self.rest.force >= self.grip {
            return Next::Ends(Ending::GripLost);
        }
        if end >= self.latest {
            return Next::Ends(Ending::Late);
        }
        if end >= self.watched.max(self.until) {
            self.judged = false;
            if let Some(end) = self.judge(held, tolerance, work) {
                return end;
            }
        }
        lanes.most[l] = lanes.most[l].max(release);
        self.released = end;
        self.let_go(lanes, l, end, (release, speed));
        self.enter(lanes, l, if slower { Range::Creep } else { Range::Mixed });
        Next::Rides
    }

    /// The end of a belt that is held while the drive moves as it will, at the stick speed or where `held` says.
    fn judge(&mut self, held: Option<Start>, tolerance: f64, work: &Work) -> Option<Next> {
        if self.judged {
            return None;
        }
        self.judged = true;
        let (target, work) = (self.asked.target, work.apart(work.allowed()));
        let kind = match (self.belt.settled(target, tolerance, &work), held) {
            (Ok(CycleKind::SteadySliding), Some(start)) => {
                let BeltAtRest { train, drag, .. } = self.belt;
                settle(train, drag, target, start, Span::UntilClosed, tolerance, &work)
                    .map(|cycle| cycle.kind)
            }
            (kind, _) => kind,
        };
        match kind {
            Ok(CycleKind::SteadySliding) => None,
            Ok(kind) => Some(Next::Ends(Ending::Settles(kind))),
            Err(error) => Some(Next::Fails(error)),
        }
    }

    /// Follow a belt that the spring pulls back harder than it is held with the full motion until it is held.
    fn off_lane(&mut self, lanes: &mut Lanes, l: usize, tolerance: f64, work: &Work) -> Next {
        let (origin, BeltAtRest { train, drag, .. }) = (lanes.time[l], self.belt);
        let scale = self.time_scale;
        let scaled = |elapsed: f64| origin + elapsed / scale;
        let drive = Drive::Speed(self.drive.from(origin * self.time_scale));
        let pull = (lanes.pull[l] + self.rest.force) * self.pull_scale;
        let start = Start { belt_speed: drag.stick_speed(), stretch: pull / train.stiffness() };
        let work = work.apart(work.allowed());
        let Ok(system) = System::new(*train, drag, drive, None) else { return Next::Leaves };
        let Ok(mut motion) = Motion::new(&system, start, tolerance, Integrator::Adaptive, &work)
        else {
            return Next::Leaves;
        };
        let mut piece = motion.no_piece();
        for _ in 0..MAX_PIECES {
            let phase = motion.phase();
            let time = scaled(motion.time());
            if time >= self.latest && (holds(phase.mode) || self.released >= self.latest) {
                return Next::Ends(Ending::Late);
            }
            if !holds(phase.mode) || phase.direction < 0.0 {
                return Next::Leaves;
            }
            if phase.mode == Mode::Stuck {
                let pull = phase.pull / self.pull_scale - self.rest.force;
                let state = (time, pull, phase.speed / self.speed_scale);
                return self.hold(lanes, l, state, tolerance, &work);
            }
            let Ok(event) = motion.advance(f64::INFINITY, &mut piece) else {
                return Next::Leaves;
            };
            if piece.duration.is_infinite() {
                return Next::Leaves;
            }
            let hardest = greatest_pull(&piece) / self.pull_scale;
            lanes.most[l] = lanes.most[l].max(hardest - self.rest.force);
            if event.is_some_and(|e| e.guard == Guard::GripLost) {
                return Next::Ends(Ending::GripLost);
            }
        }
        Next::Leaves
    }

    /// Whether the belt slides with the drive for good, as `swing_that_dies_out` says, and was pulled as hard before as it
    /// will be, or need not be.
    fn dies_out(&self, lanes: &Lanes, l: usize) -> bool {
        let rising = self.target >= self.foot;
        let margin = self.target - if rising { self.foot } else { 1.0 };
        let above = self.range == Range::Ehl
            || (self.rest.damping > 0.0 && rising && lanes.speed[l] > self.foot);
        if !above || margin < 0.0 || self.steady > self.grip {
            return false;
        }
        let reach = (if rising { margin } else { 0.0 }).max(STEADY * self.target);
        let ahead = lanes.speed[l] - self.target;
        let off = lanes.pull[l] + self.rest.force - self.steady;
        let energy = ahead * ahead + off * off;
        let most = if self.asked.peak { self.pulls.1.max(-self.pulls.0) } else { self.grip };
        energy < reach * reach && self.steady + energy.sqrt() <= most
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers that are spread evenly between nil and one, the same in every run.
    fn even(i: u32, of: u32) -> f64 {
        (f64::from(i)
            * [0.754_877_666, 0.569_840_291, 0.819_172_513, 0.438_579_021][of as usize % 4]
            + 0.1 * f64::from(of))
        .fract()
    }

    /// A belt and a profile up, along and down for it.
    fn case(i: u32) -> (BeltAtRest, Schedule, StartUp) {
        let at = |of| even(i, of);
        let (mixed, ehl) = (-1.4 + 0.3 * at(3), -0.9 + 0.4 * at(2));
        let stick_speed = 0.003 * 30_f64.powf(at(0));
        let drag =
            Drag::new(0.2 + 2.0 * at(1), 1.0, ehl, mixed, stick_speed, Closure::Retained).unwrap();
        let rest = Rest { force: 0.3 * at(2), damping: 0.05 * at(1) };
        let drag = if i.is_multiple_of(3) { drag.with_rest(rest).unwrap() } else { drag };
        let mut train = Drivetrain::new(1.0, 1.0).unwrap();
        if i.is_multiple_of(5) {
            train = train.with_grip(drag.holding_force(0.0) * (1.0 + at(3))).unwrap();
        }
        let target = 1.05 + 1.5 * at(0);
        let (peak, rise) = (target * (1.0 + 2.0 * at(1)), 8.0 * at(2));
        let times = [0.0, rise, rise + 6.0 * at(3), rise + 6.0 * at(3) + 9.0 * even(i, 7)];
        let drive = Schedule::linear("drive", &times, &[0.0, peak, peak, target]).unwrap();
        let latest = if i.is_multiple_of(7) { times[3] + 3.0 } else { f64::INFINITY };
        let asked =
            StartUp { target, ramps: times[3], until: 0.0, latest, peak: i.is_multiple_of(2) };
        (BeltAtRest::new(train, drag), drive, asked)
    }

    fn all(cases: &[(BeltAtRest, Schedule, StartUp)]) -> Vec<Starting<'_>> {
        cases.iter().map(|(belt, drive, asked)| Starting { belt, drive, asked: *asked }).collect()
    }

    #[test]
    fn a_start_up_on_a_lane_is_the_one_followed_alone() {
        let cases: Vec<_> = (0..300).map(case).collect();
        let starting = all(&cases);
        let found = start_ups(&starting, 1e-11, &Work::default()).unwrap();
        let mut endings = [0; 4];
        for (i, (each, found)) in starting.iter().zip(&found).enumerate() {
            let known = alone(each, 1e-11, &Work::default()).unwrap();
            assert_eq!(found.ending, known.ending, "{i} {each:?}");
            endings[match known.ending {
                Ending::Slides => 0,
                Ending::GripLost => 1,
                Ending::Late => 2,
                Ending::Settles(_) | Ending::Sticking => 3,
            }] += 1;
            if known.ending == Ending::Slides {
                let grip = each.belt.train.grip();
                let off = (found.peak.min(grip) - known.peak.min(grip)).abs();
                assert!(off <= 1e-9 * known.peak, "{i} {found:?} {known:?}");
                let off = (found.released - known.released).abs();
                assert!(off <= 1e-9 * known.released, "{i} {found:?} {known:?}");
            }
        }
        assert!(endings.iter().all(|count| *count > 0), "{endings:?}");
    }

    #[test]
    fn belts_that_are_neither_pulled_back_nor_judged_stay_on_their_lanes() {
        let cases: Vec<_> = (0..200).map(case).collect();
        // the full motion has no step to take
        let stays = |each: &&Starting| start_ups(&[**each], 1e-9, &Work::unwatched(0)).is_ok();
        assert!(all(&cases).iter().filter(stays).count() > 40);
    }

    #[test]
    fn a_start_up_is_the_same_among_others_and_when_it_is_asked_for_again() {
        let cases: Vec<_> = (0..40).map(case).collect();
        let (starting, work) = (all(&cases), Work::default());
        let together = start_ups(&starting, 1e-9, &work).unwrap();
        for (each, found) in starting.iter().zip(&together) {
            assert_eq!(start_ups(&[*each], 1e-9, &work).unwrap()[0], *found);
            // a belt of which nothing is known yet
            let belt = BeltAtRest::new(each.belt.train, each.belt.drag.clone());
            let anew = Starting { belt: &belt, ..*each };
            assert_eq!(start_ups(&[anew], 1e-9, &work).unwrap()[0], *found);
        }
    }

    #[test]
    fn what_sticking_settles_to_is_asked_anew_for_another_drive() {
        let (belt, ..) = case(1);
        let kinds: Vec<_> = [1.2, 30.0, 1.2]
            .iter()
            .map(|target| belt.settled(*target, 1e-9, &Work::default()).unwrap())
            .collect();
        let (sticks, slides) = (CycleKind::StickSlip, CycleKind::SteadySliding);
        assert_eq!(kinds, [sticks, slides, sticks]);
    }
}
