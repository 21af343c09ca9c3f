//! Slip laps of a belt whose drag is a smooth curve, and the drive speed at which they die out.
//!
//! A stuck belt is let go at one pull, whatever its closure: the laps of all closures differ by the pull and the speed
//! at which they begin. A lap that slows to the stick speed sticks; one that speeds up again before has escaped, and
//! as laps do not cross it comes no nearer later. The greatest drive speed at which a lap sticks is `V*`.
//!
//! Steps are those of Dormand and Prince (J. Comput. Appl. Math. 6 (1980) 19).

use crate::drag::{Closure, Curve, Rest};
use crate::error::{Error, above, at_least, unless_stopped};
use crate::motion::Drivetrain;
use crate::work::Work;

/// A belt whose drag is a curve, from its stick speed up.
#[derive(Debug, Clone)]
pub struct CurveBelt {
    /// Spring, mass and grip.
    pub train: Drivetrain,
    /// Drag of the contact in steady sliding.
    pub curve: Curve,
    /// Speed `v_s` below which the closure holds.
    pub stick_speed: f64,
    /// What the belt does below it; bristles count as `Stiction`.
    pub closure: Closure,
    /// Force that breaks a belt at rest away, over the drag at the stick speed: `e` in the paper.
    pub static_ratio: f64,
    /// What else moves with the belt.
    pub rest: Rest,
}

/// Where the behaviour of a belt changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurveFold {
    /// Speed of least drag.
    pub transition: f64,
    /// `V*`: the greatest drive speed at which the belt goes on to stick; the transition where there is none,
    /// infinite beyond 10,000 times that.
    pub upper: f64,
    /// Pull at which a belt at rest is let go.
    pub holding: f64,
    /// Whether the grip does not let it go.
    pub stalls: bool,
}

/// What becomes of a belt that is started from rest by a step of its drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurveStart {
    /// Greatest pull of the spring before the belt slows down for the first time; what holds it if it stalls.
    pub first_peak: f64,
    /// Whether it is never let go.
    pub stalls: bool,
    /// The cycle to which it settles; none if it ends sliding.
    pub cycle: Option<CurveCycle>,
}

/// The cycle of a belt that sticks and slips.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurveCycle {
    /// Duration of a cycle.
    pub period: f64,
    /// Greatest pull of the spring.
    pub pull_max: f64,
    /// Least pull of the spring.
    pub pull_min: f64,
    /// Time in which the belt is held.
    pub stuck: f64,
    /// Rate at which the pull grows while it is held.
    pub slope: f64,
}

/// Greatest drive speed looked at, over the transition speed.
const FASTEST: f64 = 1e4;
/// Factor by which drive speeds are tried until one is fast enough.
const STRIDE: f64 = 1.4;
/// Steps of one lap after which it is given up.
const MOST_STEPS: usize = 20_000;
/// Laps in which a deeper stick-slip settles, and how near a release must come to the last to be the same.
const LAPS: usize = 60;
const SAME: f64 = 1e-6;
/// Error of a step, over its state, against the accuracy asked of the fold.
const SHARE: f64 = 0.02;
/// Slowest speed of the curve that is looked at, over the stick speed.
const SLOWEST: f64 = 0.02;
/// Speeds below the stick speed, over it, of which the one with the greatest drag of the smooth closure is taken.
const CREEPS: (usize, f64) = (64, 0.004);
/// Relative excess of pull with which a belt leaves the crest of the smooth closure.
const OVER_THE_CREST: f64 = 1e-6;

/// The fold of each of `belts`, to a relative `accuracy`.
///
/// # Errors
/// If `accuracy` is out of range or `work` is stopped; each belt's may be an error of its own.
pub fn curve_folds(
    belts: &[CurveBelt],
    accuracy: f64,
    work: &Work,
) -> Result<Vec<Result<CurveFold, Error>>, Error> {
    above("accuracy", accuracy, 0.0)?;
    let each =
        belts.iter().map(|belt| Laps::new(belt, accuracy)?.fold(&work.apart(work.allowed())));
    unless_stopped(each)
}

/// What becomes of each of `belts`, started from rest at its drive speed.
///
/// # Errors
/// As `curve_folds`.
pub fn curve_starts(
    belts: &[CurveBelt],
    drive_speeds: &[f64],
    accuracy: f64,
    work: &Work,
) -> Result<Vec<Result<CurveStart, Error>>, Error> {
    above("accuracy", accuracy, 0.0)?;
    let each = belts.iter().zip(drive_speeds).map(|(belt, drive_speed)| {
        above("drive_speed", *drive_speed, 0.0)?;
        Laps::new(belt, accuracy)?.start(*drive_speed, &work.apart(work.allowed()))
    });
    unless_stopped(each)
}

/// One lap: what became of it, and what was seen on the way.
#[derive(Debug, Clone, Copy)]
struct Lap {
    /// Pull with which the belt came to the stick speed; none if it escaped.
    sticks: Option<f64>,
    duration: f64,
    pull: (f64, f64),
}

/// Where a lap begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Release {
    pub pull: f64,
    pub speed: f64,
}

pub(super) struct Laps<'a> {
    pub belt: &'a CurveBelt,
    accuracy: f64,
    pub tolerance: f64,
    /// Drag of the contact at the stick speed and at rest, and how it decays between them.
    sliding: f64,
    breakaway: f64,
    decay: f64,
    transition: f64,
}

impl<'a> Laps<'a> {
    pub(super) fn new(belt: &'a CurveBelt, accuracy: f64) -> Result<Self, Error> {
        above("stick_speed", belt.stick_speed, 0.0)?;
        above("static_ratio", belt.static_ratio, 1.0)?;
        at_least("rest_force", belt.rest.force, 0.0)?;
        at_least("rest_damping", belt.rest.damping, 0.0)?;
        let sliding = belt.curve.force(belt.stick_speed);
        let transition = belt.curve.least(belt.stick_speed, belt.rest.damping);
        Ok(Self {
            belt,
            accuracy,
            tolerance: SHARE * accuracy,
            sliding,
            breakaway: belt.static_ratio * sliding,
            decay: belt.static_ratio.ln() / belt.stick_speed,
            transition,
        })
    }

    /// Pull that the drag of a sliding belt balances.
    #[inline]
    pub(super) fn drag(&self, speed: f64, starting: bool) -> f64 {
        let belt = self.belt;
        if speed >= belt.stick_speed || !starting {
            return belt.curve.force(speed.max(SLOWEST * belt.stick_speed)) + belt.rest.at(speed);
        }
        let share = match belt.closure {
            Closure::Stribeck => belt.closure.share(speed / belt.stick_speed),
            _ => 1.0,
        };
        (self.breakaway * (-self.decay * speed).exp() + belt.rest.at(speed)) * share
    }

    /// The crest of the smooth closure, below which a belt creeps.
    fn crest(&self) -> Release {
        let (count, apart) = CREEPS;
        #[allow(clippy::cast_precision_loss)] // they are few
        let speeds = (1..=count).map(|i| apart * i as f64 * self.belt.stick_speed);
        let crest = speeds.map(|speed| Release { pull: self.drag(speed, true), speed });
        let Release { pull, speed } =
            crest.fold(Release { pull: 0.0, speed: 0.0 }, |best, next| {
                if next.pull > best.pull { next } else { best }
            });
        Release { pull: pull * (1.0 + OVER_THE_CREST), speed }
    }

    /// Speed of least drag.
    pub(super) fn transition(&self) -> f64 {
        self.transition
    }

    /// Where the laps of the closure begin, and where the first from rest does.
    pub(super) fn releases(&self) -> (Release, Release) {
        let belt = self.belt;
        let at_rest = Release { pull: self.breakaway + belt.rest.force, speed: 0.0 };
        let kept = Release {
            pull: self.sliding + belt.rest.at(belt.stick_speed),
            speed: belt.stick_speed,
        };
        match belt.closure {
            Closure::Retained => (kept, at_rest),
            Closure::Stribeck => (self.crest(), self.crest()),
            _ => (at_rest, at_rest),
        }
    }

    /// The speed that a belt of the paper's rule keeps where it comes to rest with this pull, and its next release.
    pub(super) fn held(&self, pull: f64) -> Release {
        let rest = self.belt.rest;
        let (kept, _) = self.releases();
        if self.belt.closure != Closure::Retained || pull.abs() <= kept.pull {
            return kept;
        }
        // it slows on until A exp(-decay u) + rest bears the pull: Newton's method from the stick speed
        let mut speed = self.belt.stick_speed;
        for _ in 0..40 {
            let contact = self.breakaway * (-self.decay * speed).exp();
            let off = contact + rest.at(speed) - pull.abs();
            let next = speed - off / (rest.damping - self.decay * contact);
            if (next - speed).abs() <= 1e-12 * self.belt.stick_speed {
                break;
            }
            speed = next;
        }
        let speed = speed.clamp(0.0, self.belt.stick_speed);
        Release { pull: pull.abs(), speed }
    }

    fn fold(&self, work: &Work) -> Result<CurveFold, Error> {
        let (release, at_rest) = self.releases();
        let (grip, transition) = (self.belt.train.grip(), self.transition);
        let found = CurveFold {
            transition,
            upper: transition,
            holding: at_rest.pull,
            stalls: at_rest.pull >= grip,
        };
        if release.pull >= grip {
            return Ok(found);
        }
        let upper = self.last(|w| Ok(self.lap(w, release, work)?.sticks.is_some()), transition)?;
        if self.belt.closure != Closure::Retained || found.stalls {
            return Ok(CurveFold { upper, ..found });
        }
        // the first slip from rest is the widest: stick-slip may go on where the one released at v_s dies out
        let deeper = |w: f64| self.goes_on(w, at_rest, work);
        let beyond = upper * (1.0 + 2.0 * self.accuracy);
        let upper =
            if upper.is_finite() && deeper(beyond)? { self.last(deeper, beyond)? } else { upper };
        Ok(CurveFold { upper, ..found })
    }

    /// The greatest drive speed at which `sticks` holds, `from` or above.
    fn last(&self, sticks: impl Fn(f64) -> Result<bool, Error>, from: f64) -> Result<f64, Error> {
        let mut low = from;
        let mut high = from * (1.0 + self.accuracy);
        if !sticks(high)? {
            return Ok(from);
        }
        while sticks(high)? {
            (low, high) = (high, high * STRIDE);
            if high > FASTEST * self.transition {
                return Ok(f64::INFINITY);
            }
        }
        while high > low * (1.0 + self.accuracy) {
            let middle = (low * high).sqrt();
            if sticks(middle)? { low = middle } else { high = middle }
        }
        Ok((low * high).sqrt())
    }

    /// Whether laps from `release` go on to stick for good.
    fn goes_on(&self, drive_speed: f64, release: Release, work: &Work) -> Result<bool, Error> {
        Ok(self.settled(drive_speed, release, work)?.is_some())
    }

    /// The release and the lap to which laps from `release` come, if they go on to stick.
    fn settled(
        &self,
        drive_speed: f64,
        release: Release,
        work: &Work,
    ) -> Result<Option<(Release, Lap)>, Error> {
        let mut now = release;
        for _ in 0..LAPS {
            let lap = self.lap(drive_speed, now, work)?;
            let Some(pull) = lap.sticks else { return Ok(None) };
            let next = self.held(pull);
            if (next.pull - now.pull).abs() <= SAME * now.pull {
                return Ok(Some((now, lap)));
            }
            now = next;
        }
        let lap = self.lap(drive_speed, now, work)?;
        Ok(lap.sticks.map(|_| (now, lap)))
    }

    fn start(&self, drive_speed: f64, work: &Work) -> Result<CurveStart, Error> {
        let (_, at_rest) = self.releases();
        let grip = self.belt.train.grip();
        if at_rest.pull >= grip || drive_speed <= at_rest.speed {
            let first_peak = at_rest.pull.min(grip);
            return Ok(CurveStart { first_peak, stalls: at_rest.pull >= grip, cycle: None });
        }
        let first = self.lap(drive_speed, at_rest, work)?;
        let settled = match first.sticks {
            Some(pull) => self.settled(drive_speed, self.held(pull), work)?,
            None => None,
        };
        let cycle = settled.and_then(|(release, lap)| self.cycle(drive_speed, release, lap));
        Ok(CurveStart { first_peak: first.pull.1, stalls: false, cycle })
    }

    /// The cycle of a lap that comes back to its release; none if the drive is slower than the belt that is held.
    fn cycle(&self, drive_speed: f64, release: Release, lap: Lap) -> Option<CurveCycle> {
        let keeps = if self.belt.closure == Closure::Retained { release.speed } else { 0.0 };
        let slope = self.belt.train.stiffness() * (drive_speed - keeps);
        let stuck = (release.pull - lap.sticks?) / slope;
        let (pull_min, pull_max) = lap.pull;
        let period = lap.duration + stuck;
        (slope > 0.0).then_some(CurveCycle { period, pull_max, pull_min, stuck, slope })
    }

    /// Follow the belt from its release until it is as slow as the stick speed, or speeds up again.
    fn lap(&self, drive_speed: f64, release: Release, work: &Work) -> Result<Lap, Error> {
        let (k, m) = (self.belt.train.stiffness(), self.belt.train.mass());
        let grip = self.belt.train.grip();
        let stick = self.belt.stick_speed;
        let (mut speed, mut pull, mut time) = (release.speed, release.pull, 0.0);
        let (mut slowing, mut starting) = (false, release.speed < stick);
        let mut ends = (pull, pull);
        let mut step = 0.01 * (m / k).sqrt();
        let longest = 0.2 * (m / k).sqrt();
        let slowest = stick.max(1e-3 * drive_speed);
        for _ in 0..MOST_STEPS {
            work.take(1)?;
            let rate = |u: f64, p: f64| -> (f64, f64) {
                let slips = p >= grip && u < drive_speed;
                let growth = if slips { 0.0 } else { k * (drive_speed - u) };
                ((p.min(grip) - self.drag(u, starting)) / m, growth)
            };
            let Step { speed: after, pull: pulled, error } = stepped(&rate, speed, pull, step);
            let scale = (speed.abs().max(slowest), release.pull);
            let off = (error.0 / scale.0).abs().max((error.1 / scale.1).abs()) / self.tolerance;
            if (off > 1.0 || off.is_nan()) && step > 1e-9 * longest {
                step *= (0.9 * off.powf(-0.2)).clamp(0.1, 0.7);
                continue;
            }
            let taken = step;
            step = (step * (0.9 * off.max(1e-9).powf(-0.2)).clamp(0.3, 4.0)).min(longest);
            if slowing && after <= stick {
                // straight in between: the step is short, as the drag is steep there
                let share = ((speed - stick) / (speed - after)).clamp(0.0, 1.0);
                let sticks = pull + share * (pulled - pull);
                ends = (ends.0.min(sticks), ends.1);
                let duration = time + share * taken;
                return Ok(Lap { sticks: Some(sticks), duration, pull: ends });
            }
            if slowing && after > speed {
                return Ok(Lap { sticks: None, duration: time, pull: ends });
            }
            slowing = slowing || (after < speed && after > stick);
            starting = starting && after < stick;
            time += taken;
            (speed, pull) = (after, pulled.min(grip));
            ends = (ends.0.min(pull), ends.1.max(pull));
            if !(speed.is_finite() && pull.is_finite()) {
                return Err(Error::WorkSpent { steps: work.allowed() });
            }
            if self.dies_out(speed, drive_speed, pull) {
                return Ok(Lap { sticks: None, duration: time, pull: ends });
            }
        }
        Err(Error::WorkSpent { steps: work.allowed() })
    }

    /// Whether the belt has too little energy about steady sliding to come down to the speed of least drag ever again:
    /// above it drag rises, and takes energy from the swing.
    pub(super) fn dies_out(&self, speed: f64, drive_speed: f64, pull: f64) -> bool {
        let (k, m) = (self.belt.train.stiffness(), self.belt.train.mass());
        let (ahead, margin) = (speed - drive_speed, drive_speed - self.transition);
        if margin <= 0.0 || ahead.abs() >= margin {
            return false;
        }
        let steady = self.drag(drive_speed, false);
        let off = pull - steady;
        steady < self.belt.train.grip() && ahead * ahead + off * off / (k * m) < margin * margin
    }
}

pub(super) struct Step {
    pub speed: f64,
    pub pull: f64,
    pub error: (f64, f64),
}

/// One step of Dormand and Prince, of order five, and its error.
#[inline]
pub(super) fn stepped(rate: &impl Fn(f64, f64) -> (f64, f64), u: f64, p: f64, h: f64) -> Step {
    let a = rate(u, p);
    let b = rate(u + h * 0.2 * a.0, p + h * 0.2 * a.1);
    let at = |c: [(f64, (f64, f64)); 5]| {
        let (mut du, mut dp) = (0.0, 0.0);
        for (weight, slope) in c {
            du += weight * slope.0;
            dp += weight * slope.1;
        }
        (u + h * du, p + h * dp)
    };
    let none = (0.0, a);
    let (x, y) = at([(3.0 / 40.0, a), (9.0 / 40.0, b), none, none, none]);
    let c = rate(x, y);
    let (x, y) = at([(44.0 / 45.0, a), (-56.0 / 15.0, b), (32.0 / 9.0, c), none, none]);
    let d = rate(x, y);
    let (x, y) = at([
        (19372.0 / 6561.0, a),
        (-25360.0 / 2187.0, b),
        (64448.0 / 6561.0, c),
        (-212.0 / 729.0, d),
        none,
    ]);
    let e = rate(x, y);
    let (x, y) = at([
        (9017.0 / 3168.0, a),
        (-355.0 / 33.0, b),
        (46732.0 / 5247.0, c),
        (49.0 / 176.0, d),
        (-5103.0 / 18656.0, e),
    ]);
    let f = rate(x, y);
    let (x, y) = at([
        (35.0 / 384.0, a),
        (500.0 / 1113.0, c),
        (125.0 / 192.0, d),
        (-2187.0 / 6784.0, e),
        (11.0 / 84.0, f),
    ]);
    let g = rate(x, y);
    let error = |i: fn((f64, f64)) -> f64| {
        h * (71.0 / 57600.0 * i(a) - 71.0 / 16695.0 * i(c) + 71.0 / 1920.0 * i(d)
            - 17253.0 / 339_200.0 * i(e)
            + 22.0 / 525.0 * i(f)
            - i(g) / 40.0)
    };
    Step { speed: x, pull: y, error: (error(|s| s.0), error(|s| s.1)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BASE: (f64, f64, f64) = (50.0, 1.0, 0.01);

    /// The rounded curve of two powers, `p` sharp; a corner for infinite `p`.
    fn rounded(p: f64) -> Curve {
        let (up, down) = (0.3_f64, -0.2_f64);
        let w = -down / (up - down);
        let (first, step) = (f64::ln(0.005), 0.02);
        let values: Vec<f64> = (0..500)
            .map(|i| {
                let x = first + step * f64::from(i);
                let bend = if p.is_infinite() {
                    (up * x).max(down * x)
                } else {
                    (w * (up * p * x).exp() + (1.0 - w) * (down * p * x).exp()).ln() / p
                };
                BASE.0.ln() + bend
            })
            .collect();
        Curve::new(first, step, &values).unwrap()
    }

    fn belt(curve: Curve, closure: Closure) -> CurveBelt {
        CurveBelt {
            train: Drivetrain::new(1000.0, 1.0).unwrap(),
            curve,
            stick_speed: BASE.2,
            closure,
            static_ratio: std::f64::consts::E,
            rest: Rest::default(),
        }
    }

    fn fold(belt: &CurveBelt) -> CurveFold {
        curve_folds(std::slice::from_ref(belt), 1e-7, &Work::default()).unwrap()[0].unwrap()
    }

    #[test]
    fn rounded_curves_have_the_folds_of_an_independent_solution() {
        for (p, upper) in [(1.0, 3.56116), (2.0, 3.28219), (4.0, 2.82374), (8.0, 2.47685)] {
            let found = fold(&belt(rounded(p), Closure::Retained));
            assert!((found.upper - upper).abs() < 6e-6 * upper, "{p}: {found:?}");
            assert!((found.transition - 1.0).abs() < 1e-4, "{p}: {found:?}");
        }
    }

    #[test]
    fn a_corner_is_rounded_over_a_step_alone() {
        let found = fold(&belt(rounded(f64::INFINITY), Closure::Retained));
        assert!((found.upper - 2.173_493).abs() < 2e-4, "{found:?}");
    }

    #[test]
    fn a_belt_that_stops_dead_is_let_go_at_the_greater_force() {
        // field notes: the Karnopp variant of the baseline has its fold at 9.958
        let found = fold(&belt(rounded(f64::INFINITY), Closure::Stiction));
        assert!((found.upper - 9.958).abs() < 3e-3, "{found:?}");
        assert!((found.holding - 341.4).abs() < 0.05);
    }

    #[test]
    fn cycles_have_the_frequency_of_the_reference() {
        let work = Work::default();
        for (closure, drive_speed, frequency) in [
            (Closure::Retained, 0.4, 2.240_799),
            (Closure::Retained, 1.0, 3.940_314),
            (Closure::Retained, 1.9, 4.751_533),
            (Closure::Stiction, 1.0, 1.637_431),
        ] {
            let belt = belt(rounded(f64::INFINITY), closure);
            let found = curve_starts(&[belt], &[drive_speed], 1e-7, &work).unwrap();
            let start = found[0].unwrap();
            let cycle = start.cycle.unwrap();
            // the first slip from rest is released at A = 341.4, and the spring stretches until the belt is as fast
            assert!(start.first_peak > 341.40 && start.first_peak < 355.0, "{start:?}");
            assert!((1.0 / cycle.period / frequency - 1.0).abs() < 2e-4, "{cycle:?}");
        }
        let above = belt(rounded(f64::INFINITY), Closure::Retained);
        let slides = curve_starts(&[above], &[2.5], 1e-6, &work).unwrap()[0].unwrap();
        assert_eq!(slides.cycle, None);
    }

    #[test]
    fn a_belt_that_creeps_sticks_up_to_the_speed_that_its_motion_has() {
        // against the motion of the law with two branches, from rest, settled at drive speeds beside the fold
        let drag = crate::drag::Drag::new(50.0, 1.0, -0.7, -1.2, 0.01, Closure::Stribeck).unwrap();
        let found = fold(&belt(rounded(f64::INFINITY), Closure::Stribeck));
        let train = Drivetrain::new(1000.0, 1.0).unwrap();
        for (share, sticks) in [(0.995, true), (1.005, false)] {
            let (work, start) = (Work::default(), crate::motion::Start::REST);
            let span = crate::motion::Span::UntilClosed;
            let cycle =
                crate::motion::settle(&train, &drag, share * found.upper, start, span, 1e-8, &work);
            let slow = cycle.unwrap().speed_min < 0.0101;
            assert_eq!(slow, sticks, "{found:?}");
        }
    }

    #[test]
    fn a_grip_too_weak_stalls_and_a_rest_shifts_the_pull() {
        let mut weak = belt(rounded(4.0), Closure::Stiction);
        weak.train = weak.train.with_grip(200.0).unwrap();
        let found = fold(&weak);
        assert!(found.stalls && (found.upper - found.transition).abs() < 1e-9);
        let mut shifted = belt(rounded(4.0), Closure::Retained);
        shifted.rest = Rest { force: 20.0, damping: 0.0 };
        let found = fold(&shifted);
        // a force that acts at any speed only shifts the pull
        assert!((found.upper - 2.82374).abs() < 2e-5 * 2.82374, "{found:?}");
    }
}
