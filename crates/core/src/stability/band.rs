//! The band of drive speeds where the past decides whether a belt sticks.

use super::fold::{Fold, Gripped, SlippingFold, folds, gripped};
use super::lower_edge::lower_edges;
use super::slip_lap::{SlipLap, slip_lap};
use super::smooth::SmoothBelt;
use crate::drag::{Closure, Drag};
use crate::error::{Error, unless_stopped};
use crate::motion::{
    Belt, CycleKind, Drivetrain, Span, Start, StickSlipCycle, System, checked_tolerance, ensemble,
    first_slide, settle,
};
use crate::work::Work;

/// Edges of the behaviour over drive speed, for one belt.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// Where the last motion without sticking ends: below, every start leads to stick-slip.
    pub lower: f64,
    /// Transition speed of the law of drag. Steady sliding is unstable where drag, the rest of the drive counted, falls with
    /// speed: below `Drag::rising_from`, which is this speed unless the rest rises with speed or the law falls beyond.
    pub transition: f64,
    /// The fold `V*`: above, stick-slip dies out, and any swing on which the roll slips. Zero, as `lower` is, where the roll slips on a belt that sticks and
    /// holds it for good: then there is no stick-slip.
    pub upper: f64,
    /// The roll's grip does not start a belt at rest.
    pub stalls: bool,
    /// Greatest belt speed of the slip lap at the fold; not a number where that was found by simulation.
    pub speed_max: f64,
    /// Relative accuracy of the edges.
    pub lower_accuracy: f64,
    /// Relative accuracy of the fold.
    pub upper_accuracy: f64,
    /// How the fold was found.
    pub method: Method,
    /// The stick-slip that lasts longest is not the one released at the stick speed (see `docs/theory/hysteresis.md`).
    pub deeper: bool,
    /// Slip laps followed to find the fold; zero where it was found by simulation.
    pub laps: usize,
}

/// How a fold was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Slip laps forward and back in time that meet.
    HalfLaps,
    /// Simulation from rest, halving the interval.
    Simulation,
}

/// Accuracy of edges found by halving.
const HALVED: f64 = 1e-9;
/// The same for smooth closures, whose motion takes a hundred times as long.
const HALVED_SMOOTH: f64 = 1e-6;
/// The same for the lower edge, where each motion takes long to decide.
const HALVED_LOWER: f64 = 1e-4;
/// Accuracy of edges of half laps, in tolerances, and transition speeds from which on the error grows with the fold: of
/// 2,600 random belts without rest or with, gripped or not, up to 180 transition speeds, at tolerances of 1e-7 to 1e-10
/// against 1e-14, the worst was off by 346 up to 32 transition speeds and by 1,024 up to 100.
const MEETING: f64 = 400.0;
const GROWS_FROM: f64 = 15.0;
/// Accuracy of the lower edge of smooth closures, from the least of a few swings.
const FOUND_LOWER: f64 = 1e-5;
/// The same of folds by simulation, which pass slowly by the motion that is about to vanish.
const PASSING: f64 = 1e4;
/// How far above the fold the belt is started from rest to see whether some deeper stick-slip lasts.
const ABOVE: f64 = 1e-4;
/// Greatest drive speed looked at, in transition speeds.
const FASTEST: f64 = 1e4;
/// Work of all motions of a belt together, over what one of them may take.
const MOTIONS: u64 = 1;
/// The same for smooth closures.
const MOTIONS_SMOOTH: u64 = 6;

/// The band of each belt, without its lower edge (not a number) unless `lower` asks for it: it costs a quarter
/// of the fold. What `work` allows is for each motion.
///
/// # Errors
/// If `tolerance` is out of range, or `work` is stopped; each belt's may be an error of its own, if its motion cannot
/// be followed, or its drag does not fall to the transition more steeply than it goes on from there.
pub fn bands(
    belts: &[(Drivetrain, Drag)],
    lower: bool,
    tolerance: f64,
    work: &Work,
) -> Result<Vec<Result<Band, Error>>, Error> {
    checked_tolerance(tolerance)?;
    let laps: Vec<Option<SlipLap>> =
        belts.iter().map(|(train, drag)| slip_lap(train, drag)).collect();
    let free = half_lap_folds(belts, &laps, tolerance, work)?;
    let slipping = gripped_folds(belts, &laps, &free, tolerance, work)?;
    let uppers: Vec<Option<Fold>> =
        slipping.iter().map(|found| Some(found.as_ref()?.fold)).collect();
    let deeper = deeper_stick_slip(belts, &uppers, tolerance, work)?;
    let lowers =
        if lower { lower_edges_of(&laps, tolerance, work)? } else { vec![None; belts.len()] };
    unless_stopped((0..belts.len()).map(|i| {
        let (train, drag) = &belts[i];
        checked_branches(drag)?;
        let motions = Motions::new(train, drag, tolerance, work);
        let transition = drag.transition_speed();
        let stalls = stalls(&motions)?;
        let half = uppers[i].filter(|_| !deeper[i]);
        let never = Band {
            lower: if lower { 0.0 } else { f64::NAN },
            transition,
            upper: 0.0,
            stalls,
            speed_max: f64::NAN,
            lower_accuracy: if lower { 0.0 } else { f64::NAN },
            upper_accuracy: 0.0,
            method: if half.is_some() { Method::HalfLaps } else { Method::Simulation },
            deeper: false,
            laps: 0,
        };
        if holds_for_good(train, drag, stalls) {
            return Ok(never);
        }
        let (lower, lower_accuracy) = match lowers[i] {
            _ if !lower => (f64::NAN, f64::NAN),
            Some(edge) => (edge * transition, MEETING * tolerance),
            None => lower_by_motions(&motions)?,
        };
        let (upper, upper_accuracy) = if let Some(fold) = half {
            let far = (fold.drive_speed / GROWS_FROM).max(1.0);
            (fold.drive_speed * transition, MEETING * tolerance * far)
        } else {
            let from = uppers[i].map_or(1.0, |fold| fold.drive_speed * (1.0 + ABOVE));
            // so near to the fold that steps decide, a motion may stick now and then for thousands of laps
            let near = if drag.closure().is_smooth() {
                HALVED_SMOOTH
            } else {
                HALVED.max(10.0 * tolerance)
            };
            let start = if stalls { released(train, drag) } else { Start::REST };
            let (upper, near) = match motions.smooth() {
                Some(belt) => {
                    let range = [from * transition, drag.stick_speed(), FASTEST * transition];
                    belt.upper(range, near, &motions.together)?
                }
                None => (upper_by_simulation(&motions, start, from * transition, near)?, near),
            };
            (upper, near.max(PASSING * tolerance))
        };
        // no swing is wider than that on which the roll slips
        let slips = train.grip().is_finite() && uppers[i] != free[i];
        let sticks_below = match slipping[i].filter(|_| half.is_some()) {
            Some(found) if slips => found.sticks_below * transition,
            None if train.grip().is_finite() => upper,
            // the lap from the stick speed is one of those that do not stick
            _ if lowers[i].is_some() => upper,
            _ => f64::INFINITY,
        };
        let (lower, lower_accuracy) = if sticks_below < lower {
            (sticks_below, upper_accuracy)
        } else {
            (lower, lower_accuracy)
        };
        Ok(Band {
            lower,
            upper,
            speed_max: half.map_or(f64::NAN, |fold| fold.speed_max * transition),
            lower_accuracy,
            upper_accuracy,
            deeper: deeper[i],
            laps: half.map_or(0, |fold| fold.laps),
            ..never
        })
    }))
}

/// Refuse a law of two branches that do not bend upwards at the transition: there is none to divide the behaviour.
fn checked_branches(drag: &Drag) -> Result<(), Error> {
    match drag.two_branches() {
        Some((mixed, ehl)) if mixed >= ehl => {
            // as the user gave them, without the rounding of the one that was added
            let given = |exponent: f64| {
                let rounded = ((exponent - 1.0) * 1e12).round() / 1e12;
                if rounded.is_finite() { rounded } else { exponent }
            };
            let (value, limit) = (given(mixed), given(ehl));
            Err(Error::NotBelow { quantity: "mixed_exponent", value, limit })
        }
        _ => Ok(()),
    }
}

/// The motions of one belt, whose work together is bounded.
struct Motions<'a> {
    train: &'a Drivetrain,
    drag: &'a Drag,
    tolerance: f64,
    /// Steps of one motion.
    each: u64,
    together: Work<'a>,
}

impl<'a> Motions<'a> {
    fn new(train: &'a Drivetrain, drag: &'a Drag, tolerance: f64, work: &Work<'a>) -> Self {
        let many = if drag.closure().is_smooth() { MOTIONS_SMOOTH } else { MOTIONS };
        let each = work.allowed();
        Self { train, drag, tolerance, each, together: work.apart(each.saturating_mul(many)) }
    }

    /// Whether the belt goes on to stick and slip.
    fn stick(&self, drive_speed: f64, start: Start) -> Result<bool, Error> {
        Ok(lasts(&self.settle(drive_speed, start)?, self.drag))
    }

    /// The belt as one whose edges one or two laps decide: its closure is smooth, and the roll always grips.
    fn smooth(&self) -> Option<SmoothBelt<'_>> {
        let (train, drag, tolerance) = (self.train, self.drag, self.tolerance);
        let known = drag.closure().is_smooth() && train.grip().is_infinite();
        known.then(|| SmoothBelt::new(train, drag, tolerance))
    }

    fn settle(&self, drive_speed: f64, start: Start) -> Result<StickSlipCycle, Error> {
        let work = self.together.apart(self.each.min(self.together.left()));
        let (train, drag, tolerance) = (self.train, self.drag, self.tolerance);
        let cycle = settle(train, drag, drive_speed, start, Span::UntilClosed, tolerance, &work);
        self.together.take(work.done())?;
        cycle
    }
}

/// Whether the belt is held at one force, and at once.
fn is_sharp(drag: &Drag) -> bool {
    !drag.closure().is_smooth() && drag.strengthening().is_none()
}

/// Whether the roll's grip does not start a belt at rest, at the transition speed if that depends on the speed.
fn stalls(motions: &Motions) -> Result<bool, Error> {
    let (train, drag) = (motions.train, motions.drag);
    if train.grip().is_infinite() {
        return Ok(false);
    }
    if is_sharp(drag) {
        return Ok(train.grip() <= drag.holding_force(0.0));
    }
    Ok(motions.settle(drag.transition_speed(), Start::REST)?.kind == CycleKind::Stalled)
}

/// Whether a belt that sticks is held for good, as the roll slips before it would be released.
fn holds_for_good(train: &Drivetrain, drag: &Drag, stalls: bool) -> bool {
    if is_sharp(drag) { train.grip() <= drag.holding_force(drag.stick_speed()) } else { stalls }
}

/// Where a belt that sticks at the stick speed is released.
fn released(train: &Drivetrain, drag: &Drag) -> Start {
    let belt_speed = drag.stick_speed();
    Start { belt_speed, stretch: drag.holding_force(belt_speed) / train.stiffness() }
}

/// Folds by half laps, for the closures whose stuck belt is released and caught where the branches end.
fn half_lap_folds(
    belts: &[(Drivetrain, Drag)],
    laps: &[Option<SlipLap>],
    tolerance: f64,
    work: &Work,
) -> Result<Vec<Option<Fold>>, Error> {
    let (places, known): (Vec<usize>, Vec<SlipLap>) = laps
        .iter()
        .enumerate()
        .filter_map(|(i, lap)| Some((i, (*lap)?)))
        .filter(|(i, _)| is_sharp(&belts[*i].1))
        .unzip();
    let start = |index: usize, drive_speed: f64| {
        let (train, drag) = &belts[places[index]];
        if drag.closure() == Closure::Retained {
            let lap = &known[index];
            return Some((lap.mixed_force(lap.slowest), lap.slowest));
        }
        leaving_stick_speed(train, drag, drive_speed, tolerance, work)
    };
    let mut found = vec![None; belts.len()];
    for (place, fold) in places.iter().zip(folds(&known, tolerance, work, start)?) {
        found[*place] = fold;
    }
    Ok(found)
}

/// Lower edges by half laps, over the transition speed.
fn lower_edges_of(
    laps: &[Option<SlipLap>],
    tolerance: f64,
    work: &Work,
) -> Result<Vec<Option<f64>>, Error> {
    let known: Vec<SlipLap> = laps.iter().flatten().copied().collect();
    let mut edges = lower_edges(&known, tolerance, work)?.into_iter();
    let edge = |lap: &Option<SlipLap>| lap.and_then(|_| edges.next()).map(|e| e.drive_speed);
    Ok(laps.iter().map(edge).collect())
}

/// The same under a roll that slips on belts whose laps ask for more than its grip.
fn gripped_folds(
    belts: &[(Drivetrain, Drag)],
    laps: &[Option<SlipLap>],
    free: &[Option<Fold>],
    tolerance: f64,
    work: &Work,
) -> Result<Vec<Option<SlippingFold>>, Error> {
    let (places, known): (Vec<usize>, Vec<Gripped>) = belts
        .iter()
        .enumerate()
        .filter(|(_, (train, drag))| train.grip().is_finite() && !holds_for_good(train, drag, true))
        .filter_map(|(i, (train, drag))| {
            let impedance = train.impedance();
            let grip = (train.grip() - drag.rest().force) / (drag.transition_speed() * impedance);
            Some((i, Gripped { lap: laps[i]?, grip, free: free[i]? }))
        })
        .filter(|(_, given)| given.may_slip())
        .unzip();
    let gripping = |fold: &Option<Fold>| {
        fold.map(|fold| SlippingFold { sticks_below: fold.drive_speed, fold })
    };
    let mut found: Vec<Option<SlippingFold>> = free.iter().map(gripping).collect();
    for (place, fold) in places.into_iter().zip(gripped(&known, tolerance, work)?) {
        found[place] = fold;
    }
    Ok(found)
}

/// Scaled pull and speed at which a belt that stood still passes the stick speed, for a scaled drive speed.
fn leaving_stick_speed(
    train: &Drivetrain,
    drag: &Drag,
    drive_speed: f64,
    tolerance: f64,
    work: &Work,
) -> Option<(f64, f64)> {
    let speed = drag.transition_speed();
    let always_grips = Drivetrain::new(train.stiffness(), train.mass()).ok()?;
    let system = System::at_speed(always_grips, drag, drive_speed * speed).ok()?;
    let start = Start { belt_speed: 0.0, stretch: drag.holding_force(0.0) / train.stiffness() };
    let (pull, belt_speed) = first_slide(&system, start, tolerance, &work.apart(work.allowed()))?;
    let pull = pull - drag.rest().force;
    let impedance = train.impedance();
    Some((pull / (speed * impedance), belt_speed / speed))
}

/// Whether a belt started from rest just above its fold goes on to stick, released higher each time.
fn deeper_stick_slip(
    belts: &[(Drivetrain, Drag)],
    uppers: &[Option<Fold>],
    tolerance: f64,
    work: &Work,
) -> Result<Vec<bool>, Error> {
    let mut deeper = vec![false; belts.len()];
    let (places, above): (Vec<usize>, Vec<Belt>) = belts
        .iter()
        .zip(uppers)
        .enumerate()
        .filter(|(_, ((_, drag), _))| drag.closure() == Closure::Retained)
        .filter_map(|(i, ((train, drag), fold))| {
            let drive_speed = (*fold)?.drive_speed * drag.transition_speed() * (1.0 + ABOVE);
            Some((i, Belt { train: *train, drag: drag.clone(), drive_speed, start: Start::REST }))
        })
        .unzip();
    match ensemble(&above, Span::UntilClosed, tolerance, work) {
        Ok(outcomes) => {
            for (place, outcome) in places.into_iter().zip(outcomes) {
                deeper[place] = outcome.is_ok_and(|cycle| lasts(&cycle, &belts[place].1));
            }
        }
        Err(Error::Stopped) => return Err(Error::Stopped),
        Err(_) => {}
    }
    Ok(deeper)
}

/// Whether a motion goes on to slow down to the stick speed, be it held there or swinging back through zero, and
/// to slip again: a belt that is held for good does not.
fn lasts(cycle: &StickSlipCycle, drag: &Drag) -> bool {
    use CycleKind::{GripSlip, Stalled, SteadySliding};
    !matches!(cycle.kind, SteadySliding | GripSlip | Stalled)
        && cycle.speed_min <= drag.stick_speed() * (1.0 + HALVED)
}

/// Least drive speed above `from` at which a belt from `start`, at rest or released, ends without sticking and
/// without a roll that slips each lap, if it does not at `from`; otherwise the greatest below at which it does.
fn upper_by_simulation(
    motions: &Motions,
    start: Start,
    from: f64,
    accuracy: f64,
) -> Result<f64, Error> {
    let drag = motions.drag;
    let sticks = |drive_speed: f64| {
        let cycle = motions.settle(drive_speed, start)?;
        Ok(lasts(&cycle, drag) || cycle.grip_slip_duration > 0.0)
    };
    let (mut low, mut high) = (from, from);
    if sticks(from)? {
        while sticks(high)? {
            (low, high) = (high, 1.25 * high);
            if high > FASTEST * drag.transition_speed() {
                return Ok(f64::INFINITY);
            }
        }
    } else {
        while !sticks(low)? {
            (low, high) = (0.8 * low, low);
            if low < drag.stick_speed() {
                return Ok(low);
            }
        }
    }
    halved(low, high, accuracy, sticks)
}

/// The lower edge where half laps do not give it, and its accuracy.
fn lower_by_motions(motions: &Motions) -> Result<(f64, f64), Error> {
    if let Some(belt) = motions.smooth() {
        return Ok(match belt.lower(motions.drag.rising_from(), &motions.together)? {
            Some(edge) => (edge, FOUND_LOWER),
            None => (belt.lower_by_halving(HALVED_LOWER, &motions.together)?, HALVED_LOWER),
        });
    }
    Ok((lower_by_simulation(motions)?, HALVED_LOWER))
}

/// Drive speed below the transition under which a belt nudged from steady sliding comes to stick.
fn lower_by_simulation(motions: &Motions) -> Result<f64, Error> {
    let (train, drag) = (motions.train, motions.drag);
    let transition = drag.transition_speed();
    let sticks = |drive_speed: f64| {
        motions.stick(drive_speed, Start::steady(train, drag, drive_speed)?.nudged())
    };
    let mut low = 0.9 * transition;
    while !sticks(low)? {
        low *= 0.8;
        if low < drag.stick_speed() {
            return Ok(low);
        }
    }
    halved(low, transition, HALVED_LOWER, sticks)
}

/// Where `sticks` changes between `low`, where it holds, and `high`, where it does not.
fn halved(
    mut low: f64,
    mut high: f64,
    accuracy: f64,
    sticks: impl Fn(f64) -> Result<bool, Error>,
) -> Result<f64, Error> {
    while high - low > accuracy * high {
        let middle = 0.5 * (low + high);
        if sticks(middle)? { low = middle } else { high = middle }
    }
    Ok(0.5 * (low + high))
}
