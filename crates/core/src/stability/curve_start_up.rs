//! Start-ups of belts whose drag is a smooth curve: does a profile of drive speed end in sliding for good?
//!
//! The belt is followed from rest, held in closed form wherever it sticks. It slides for good once its slowest speed
//! grows from one lap to the next after the last ramp. Steps are those of Dormand and Prince.

use super::curve_laps::{CurveBelt, Laps, Release};
use crate::drag::Closure;
use crate::error::{Error, above, unless_stopped};
use crate::motion::dormand_prince::{ERROR, STAGES, WEIGHTS};
use crate::work::Work;

/// What came of a start-up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurveStarted {
    /// Whether the belt slides for good after the last ramp.
    pub slides: bool,
    /// Greatest pull of the spring on the way.
    pub peak: f64,
    /// When the belt was last let go; infinite if it is held. Of stick-slip that goes on, when that is sure.
    pub released: f64,
}

/// Steps after which a start-up is given up, and laps after the last ramp.
const MOST_STEPS: usize = 200_000;
const LAPS: f64 = 60.0;

/// What the profile `(time, speed)`, straight in between and constant after the last, does to each of `belts`.
///
/// # Errors
/// If times do not ascend from zero, or `work` is stopped; each belt's may be an error of its own.
pub fn curve_start_ups(
    belts: &[CurveBelt],
    profile: &[(f64, f64)],
    accuracy: f64,
    work: &Work,
) -> Result<Vec<Result<CurveStarted, Error>>, Error> {
    above("accuracy", accuracy, 0.0)?;
    if profile.is_empty() {
        return Err(Error::TooFew { quantity: "corners of the drive profile", needed: 1 });
    }
    for (index, pair) in profile.windows(2).enumerate() {
        if pair[1].0 < pair[0].0 {
            let value = pair[1].0;
            return Err(Error::Backwards { quantity: "times of the drive profile", index, value });
        }
    }
    unless_stopped(belts.iter().map(|belt| {
        let laps = Laps::new(belt, accuracy)?;
        StartUp { laps: &laps, profile }.follow(&work.apart(work.allowed()))
    }))
}

struct StartUp<'a> {
    laps: &'a Laps<'a>,
    profile: &'a [(f64, f64)],
}

/// Drive speed over a stretch of time: value at its beginning, slope, and when it ends.
#[derive(Clone, Copy)]
struct Segment {
    begin: f64,
    speed: f64,
    slope: f64,
    end: f64,
}

impl Segment {
    fn at(&self, time: f64) -> f64 {
        self.speed + self.slope * (time - self.begin)
    }
}

/// The belt under way.
struct State {
    time: f64,
    speed: f64,
    pull: f64,
    peak: f64,
    released: f64,
}

impl StartUp<'_> {
    /// The segment that holds just after `time`.
    fn segment(&self, time: f64) -> Segment {
        let next = self.profile.iter().position(|(t, _)| *t > time);
        match next {
            None => {
                let (begin, speed) = self.profile[self.profile.len() - 1];
                Segment { begin, speed, slope: 0.0, end: f64::INFINITY }
            }
            Some(0) => Segment { begin: 0.0, speed: 0.0, slope: 0.0, end: self.profile[0].0 },
            Some(i) => {
                let ((a, v), (b, w)) = (self.profile[i - 1], self.profile[i]);
                Segment { begin: a, speed: v, slope: (w - v) / (b - a), end: b }
            }
        }
    }

    fn follow(&self, work: &Work) -> Result<CurveStarted, Error> {
        let (_, at_rest) = self.laps.releases();
        let (ramps, target) = self.profile[self.profile.len() - 1];
        let train = &self.laps.belt.train;
        let until = ramps
            + LAPS * std::f64::consts::TAU * (train.mass() / train.stiffness()).sqrt()
            + 2.0 * at_rest.pull / (train.stiffness() * target);
        let mut state =
            State { time: 0.0, speed: 0.0, pull: 0.0, peak: 0.0, released: f64::INFINITY };
        let mut release = at_rest;
        let keeps = |release: &Release| match self.laps.belt.closure {
            Closure::Retained => release.speed,
            _ => 0.0,
        };
        let failed = |state: &State| CurveStarted {
            slides: false,
            peak: state.peak,
            released: state.released,
        };
        loop {
            if release.pull >= train.grip()
                || !self.wait(&mut state, release, keeps(&release), until)
            {
                return Ok(failed(&state));
            }
            state.released = state.time;
            match self.slide(&mut state, release, until, work)? {
                Slid::ForGood => {
                    let State { peak, released, .. } = state;
                    return Ok(CurveStarted { slides: true, peak, released });
                }
                Slid::Sticks => {
                    let next = self.laps.held(state.pull);
                    // under a drive that no longer changes the same release brings the same lap, again and again
                    if state.released >= ramps && next == release {
                        return Ok(failed(&state));
                    }
                    release = next;
                }
                Slid::Undecided => return Ok(failed(&state)),
            }
        }
    }

    /// Wait until the spring pulls as hard as `release`; false if it never does.
    fn wait(&self, state: &mut State, release: Release, keeps: f64, until: f64) -> bool {
        let stiffness = self.laps.belt.train.stiffness();
        while state.time < until {
            let segment = self.segment(state.time);
            let (ahead, growth) = (segment.at(state.time) - keeps, 0.5 * segment.slope);
            let missing = (release.pull - state.pull) / stiffness;
            let wait = first_root(growth, ahead, missing);
            if state.time + wait <= segment.end && wait.is_finite() {
                state.time += wait;
                (state.pull, state.speed) = (release.pull, release.speed);
                state.peak = state.peak.max(release.pull);
                return true;
            }
            if segment.end.is_infinite() {
                return false;
            }
            let passed = segment.end - state.time;
            state.pull += stiffness * (ahead * passed + growth * passed * passed);
            state.time = segment.end;
        }
        false
    }

    /// Follow the sliding belt.
    fn slide(
        &self,
        state: &mut State,
        release: Release,
        until: f64,
        work: &Work,
    ) -> Result<Slid, Error> {
        let belt = self.laps.belt;
        let (k, m, grip) = (belt.train.stiffness(), belt.train.mass(), belt.train.grip());
        let (ramps, target) = self.profile[self.profile.len() - 1];
        let (stick, longest) = (belt.stick_speed, 0.2 * (m / k).sqrt());
        let mut step = 0.01 * (m / k).sqrt();
        let (mut slowing, mut starting) = (false, release.speed < stick);
        let mut least: Option<f64> = None;
        for _ in 0..MOST_STEPS {
            work.take(1)?;
            if state.time >= until {
                return Ok(Slid::Undecided);
            }
            let segment = self.segment(state.time);
            let size = step.min(segment.end - state.time);
            let begin = state.time;
            // autonomous in time by the mean drive speed of the step: exact for a straight ramp to second order
            let drive = segment.at(begin + 0.5 * size);
            let rate = |u: f64, p: f64| -> (f64, f64) {
                let growth = if p >= grip && u < drive { 0.0 } else { k * (drive - u) };
                ((p.min(grip) - self.laps.drag(u, starting)) / m, growth)
            };
            let Step { speed: after, pull, error } = stepped(&rate, state.speed, state.pull, size);
            let scale = (state.speed.abs().max(stick.max(1e-3 * target)), release.pull);
            let off =
                (error.0 / scale.0).abs().max((error.1 / scale.1).abs()) / self.laps.tolerance;
            if (off > 1.0 || off.is_nan()) && size > 1e-9 * longest {
                step = size * (0.9 * off.powf(-0.2)).clamp(0.1, 0.7);
                continue;
            }
            step = (size * (0.9 * off.max(1e-9).powf(-0.2)).clamp(0.3, 4.0)).min(longest);
            state.time += size;
            if slowing && after <= stick {
                state.pull += (pull - state.pull)
                    * ((state.speed - stick) / (state.speed - after)).clamp(0.0, 1.0);
                state.speed = stick;
                return Ok(Slid::Sticks);
            }
            if slowing && after > state.speed && begin >= ramps {
                if least.is_some_and(|before| state.speed > before)
                    && target > self.laps.transition()
                {
                    return Ok(Slid::ForGood);
                }
                least = Some(state.speed);
            }
            slowing = after < state.speed && after > stick;
            starting = starting && after < stick;
            (state.speed, state.pull) = (after, pull.min(grip));
            state.peak = state.peak.max(state.pull);
            if begin >= ramps && self.laps.dies_out(state.speed, target, state.pull) {
                return Ok(Slid::ForGood);
            }
        }
        Ok(Slid::Undecided)
    }
}

enum Slid {
    ForGood,
    Sticks,
    Undecided,
}

/// The first time at which `growth t^2 + ahead t` is `missing`; infinite if never.
fn first_root(growth: f64, ahead: f64, missing: f64) -> f64 {
    if missing <= 0.0 {
        return 0.0;
    }
    if growth == 0.0 {
        return if ahead > 0.0 { missing / ahead } else { f64::INFINITY };
    }
    let under = ahead * ahead + 4.0 * growth * missing;
    if under < 0.0 {
        return f64::INFINITY;
    }
    let root = under.sqrt();
    let first = 2.0 * missing / (ahead + root);
    if first >= 0.0 && (ahead + root) > 0.0 { first } else { f64::INFINITY }
}

struct Step {
    speed: f64,
    pull: f64,
    error: (f64, f64),
}

/// One step of Dormand and Prince, of order five, and its error.
#[inline]
fn stepped(rate: &impl Fn(f64, f64) -> (f64, f64), u: f64, p: f64, h: f64) -> Step {
    let mut slopes = [rate(u, p); STAGES];
    slopes[1] = rate(u + h * WEIGHTS[1][0] * slopes[0].0, p + h * WEIGHTS[1][0] * slopes[0].1);
    let (mut speed, mut pull) = (u, p);
    for stage in 2..STAGES {
        let (mut du, mut dp) = (0.0, 0.0);
        for (weight, slope) in WEIGHTS[stage].iter().zip(&slopes[..stage]) {
            du += weight * slope.0;
            dp += weight * slope.1;
        }
        (speed, pull) = (u + h * du, p + h * dp);
        slopes[stage] = rate(speed, pull);
    }
    let error = |of: fn(&(f64, f64)) -> f64| {
        let sum: f64 =
            ERROR.iter().zip(&slopes[..STAGES - 1]).map(|(w, slope)| w * of(slope)).sum();
        // the last weight is -1/40: dividing by 40 rounds less
        h * (sum - of(&slopes[STAGES - 1]) / 40.0)
    };
    Step { speed, pull, error: (error(|s| s.0), error(|s| s.1)) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drag::{Curve, Rest};
    use crate::motion::Drivetrain;

    /// The baseline with a corner.
    fn belt() -> CurveBelt {
        let (first, step) = (f64::ln(0.005), 0.02);
        let values: Vec<f64> = (0..500)
            .map(|i| {
                let x = first + step * f64::from(i);
                f64::ln(50.0) + (0.3 * x).max(-0.2 * x)
            })
            .collect();
        CurveBelt {
            train: Drivetrain::new(1000.0, 1.0).unwrap(),
            curve: Curve::new(first, step, &values).unwrap(),
            stick_speed: 0.01,
            closure: Closure::Retained,
            static_ratio: std::f64::consts::E,
            rest: Rest::default(),
        }
    }

    fn slides(profile: &[(f64, f64)]) -> bool {
        curve_start_ups(&[belt()], profile, 1e-6, &Work::default()).unwrap()[0].unwrap().slides
    }

    #[test]
    fn a_step_from_rest_slides_above_the_fold_alone() {
        // V* = 2.173493 (physics.md, section 5)
        assert!(!slides(&[(0.0, 2.10)]));
        assert!(slides(&[(0.0, 2.25)]));
        // the first slip swings so far back that the belt sticks once more before it slides for good
        let found = curve_start_ups(&[belt()], &[(0.0, 2.25)], 1e-6, &Work::default()).unwrap();
        assert!(found[0].unwrap().released > 0.3);
    }

    #[test]
    fn an_overshoot_escapes_and_a_sudden_step_down_falls_back() {
        // section 5: from steady 2.5 a step to 1.2 sticks, one to 1.3 does not; a ramp of -5 reaches 1.0 safely,
        // and 1.05 is tried here, as steady sliding at 1.0 has no room
        let step_to = |target: f64| [(0.0, 2.5), (3.0, 2.5), (3.000_001, target)];
        assert!(!slides(&step_to(1.2)));
        assert!(slides(&step_to(1.3)));
        assert!(slides(&[(0.0, 2.5), (3.0, 2.5), (3.29, 1.05)]));
    }

    #[test]
    fn the_belt_breaks_away_where_the_spring_has_stretched_enough() {
        let mut dead = belt();
        dead.closure = Closure::Stiction;
        let found = curve_start_ups(&[dead], &[(0.0, 15.0)], 1e-6, &Work::default()).unwrap();
        let found = found[0].unwrap();
        // released at A = e 125.594322 after A/(k w)
        assert!((found.released - 341.400_76 / 15_000.0).abs() < 1e-6, "{found:?}");
        assert!(found.slides && found.peak > 341.4, "{found:?}");
    }

    #[test]
    fn stick_slip_that_goes_on_is_told_after_two_laps() {
        // of the baseline at half its transition a lap takes about 0.6 s; 60 free periods are 12 s
        let found = curve_start_ups(&[belt()], &[(0.0, 0.5)], 1e-6, &Work::default()).unwrap();
        let found = found[0].unwrap();
        assert!(!found.slides && found.released < 2.0, "{found:?}");
    }

    #[test]
    fn profiles_that_run_backwards_are_refused() {
        let work = Work::default();
        assert!(curve_start_ups(&[belt()], &[], 1e-6, &work).is_err());
        assert!(curve_start_ups(&[belt()], &[(1.0, 1.0), (0.5, 2.0)], 1e-6, &work).is_err());
    }
}
