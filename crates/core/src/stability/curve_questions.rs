//! What is asked of a belt on a curve, lap by lap: where it begins to stick, and what a start comes to.

use super::curve_answers::{Asks, Next, answers};
use super::curve_laps::{CurveBelt, CurveCycle, CurveFold, CurveStart, Lap, Laps, Release};
use crate::drag::Closure;
use crate::error::{Error, above};
use crate::work::Work;

/// Greatest drive speed looked at, over the transition speed.
const FASTEST: f64 = 1e4;
/// Factor by which drive speeds are tried until one is fast enough.
const STRIDE: f64 = 1.4;
/// Laps in which a deeper stick-slip settles, and how near a release must come to the last to be the same.
const LAPS: usize = 60;
const SAME: f64 = 1e-6;

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
    answers(belts.iter().map(|belt| Ok(FoldQuestion::new(Laps::new(belt, accuracy)?))), work)
}

/// What becomes of each belt, started from rest at its drive speed.
///
/// # Errors
/// As `curve_folds`.
pub fn curve_starts(
    starting: &[(CurveBelt, f64)],
    accuracy: f64,
    work: &Work,
) -> Result<Vec<Result<CurveStart, Error>>, Error> {
    above("accuracy", accuracy, 0.0)?;
    let each = starting.iter().map(|(belt, drive_speed)| {
        above("drive_speed", *drive_speed, 0.0)?;
        Ok(StartQuestion::new(Laps::under(belt, *drive_speed, accuracy)?, *drive_speed))
    });
    answers(each, work)
}

/// Laps that follow each other under one drive speed.
#[derive(Debug, Clone, Copy)]
struct Settling {
    now: Release,
    done: usize,
}

/// What a lap means for those after it.
enum Settled {
    /// The next begins there.
    GoesOn(Release),
    /// They repeat this lap, from this release, or stick no more.
    Ends(Option<(Release, Lap)>),
}

impl Settling {
    fn new(release: Release) -> Self {
        Self { now: release, done: 0 }
    }

    fn take(&mut self, laps: &Laps, lap: Lap) -> Settled {
        let Some(pull) = lap.sticks else { return Settled::Ends(None) };
        let next = laps.held(pull);
        if self.done == LAPS || (next.pull - self.now.pull).abs() <= SAME * self.now.pull {
            return Settled::Ends(Some((self.now, lap)));
        }
        (self.now, self.done) = (next, self.done + 1);
        Settled::GoesOn(next)
    }
}

/// The greatest drive speed at which a belt sticks, from one on: by strides, then by halves.
struct Edge {
    low: f64,
    high: f64,
    /// Drive speed that is looked at.
    at: f64,
    /// Strides that were taken; none once there is a speed at which it slides.
    strides: Option<usize>,
    accuracy: f64,
    fastest: f64,
}

impl Edge {
    fn new(from: f64, laps: &Laps) -> Self {
        let (accuracy, fastest) = (laps.accuracy, FASTEST * laps.transition());
        let high = from * (1.0 + accuracy);
        Self { low: from, high, at: high, strides: Some(0), accuracy, fastest }
    }

    /// The edge, if it is known by whether the belt sticks at the speed that is looked at; that changes otherwise.
    fn take(&mut self, sticks: bool) -> Option<f64> {
        match self.strides {
            Some(strides) if sticks => {
                (self.low, self.high) = (self.high, self.high * STRIDE);
                (self.at, self.strides) = (self.high, Some(strides + 1));
                return (self.high > self.fastest).then_some(f64::INFINITY);
            }
            Some(0) => return Some(self.low),
            Some(_) => self.strides = None,
            None if sticks => self.low = self.at,
            None => self.high = self.at,
        }
        self.at = (self.low * self.high).sqrt();
        (self.high <= self.low * (1.0 + self.accuracy)).then_some(self.at)
    }
}

/// Where a belt begins to stick.
pub(super) struct FoldQuestion<'a> {
    laps: Laps<'a>,
    found: CurveFold,
    release: Release,
    at_rest: Release,
    edge: Edge,
    /// The laps from rest; none as long as one from the release of its closure says enough.
    deeper: Option<Settling>,
    /// Whether laps from rest are known to go on beyond the edge of the others.
    beyond: bool,
}

impl<'a> FoldQuestion<'a> {
    pub(super) fn new(laps: Laps<'a>) -> Self {
        let ((release, at_rest), transition) = (laps.releases(), laps.transition());
        let stalls = at_rest.pull >= laps.belt.train.grip();
        let found = CurveFold { transition, upper: transition, holding: at_rest.pull, stalls };
        let edge = Edge::new(transition, &laps);
        Self { laps, found, release, at_rest, edge, deeper: None, beyond: false }
    }

    /// The lap that begins what a drive speed is asked for.
    fn ask(&mut self) -> Next<CurveFold> {
        let release = if self.deeper.is_some() { self.at_rest } else { self.release };
        Next::Lap(self.edge.at, release)
    }

    fn answer(&self, upper: f64) -> Next<CurveFold> {
        Next::Answer(CurveFold { upper, ..self.found })
    }

    /// The edge of the laps from the release of the closure.
    fn take_plain(&mut self, sticks: bool) -> Next<CurveFold> {
        let Some(upper) = self.edge.take(sticks) else { return self.ask() };
        let closure = self.laps.belt.closure;
        if closure != Closure::Retained || self.found.stalls || upper.is_infinite() {
            return self.answer(upper);
        }
        // the first slip from rest is the widest: stick-slip may go on where the one released at v_s dies out
        self.found.upper = upper;
        self.edge.at = upper * (1.0 + 2.0 * self.laps.accuracy);
        self.deeper = Some(Settling::new(self.at_rest));
        self.ask()
    }

    /// The edge of those from rest.
    fn take_deeper(&mut self, sticks: bool) -> Next<CurveFold> {
        if self.beyond {
            if let Some(upper) = self.edge.take(sticks) {
                return self.answer(upper);
            }
        } else if sticks {
            self.beyond = true;
            self.edge = Edge::new(self.edge.at, &self.laps);
        } else {
            return self.answer(self.found.upper);
        }
        self.deeper = Some(Settling::new(self.at_rest));
        self.ask()
    }
}

impl Asks for FoldQuestion<'_> {
    type Answer = CurveFold;

    fn laps(&self) -> &Laps<'_> {
        &self.laps
    }

    fn first(&mut self) -> Next<CurveFold> {
        if self.release.pull >= self.laps.belt.train.grip() {
            return Next::Answer(self.found);
        }
        self.ask()
    }

    fn take(&mut self, lap: Lap) -> Next<CurveFold> {
        let Some(settling) = &mut self.deeper else {
            return self.take_plain(lap.sticks.is_some());
        };
        match settling.take(&self.laps, lap) {
            Settled::GoesOn(release) => Next::Lap(self.edge.at, release),
            Settled::Ends(settled) => self.take_deeper(settled.is_some()),
        }
    }
}

/// What becomes of a belt that is started from rest at a drive speed.
pub(super) struct StartQuestion<'a> {
    laps: Laps<'a>,
    drive_speed: f64,
    at_rest: Release,
    /// The greatest pull of the first lap, and those after it.
    first_peak: f64,
    settling: Option<Settling>,
}

impl<'a> StartQuestion<'a> {
    pub(super) fn new(laps: Laps<'a>, drive_speed: f64) -> Self {
        let (_, at_rest) = laps.releases();
        Self { laps, drive_speed, at_rest, first_peak: 0.0, settling: None }
    }

    fn ends(&self, settled: Option<(Release, Lap)>) -> Next<CurveStart> {
        let cycle = settled.and_then(|(release, lap)| self.cycle(release, lap));
        Next::Answer(CurveStart { first_peak: self.first_peak, stalls: false, cycle })
    }

    /// The cycle of a lap that comes back to its release; none if the drive is slower than the belt that is held.
    fn cycle(&self, release: Release, lap: Lap) -> Option<CurveCycle> {
        let belt = self.laps.belt;
        let keeps = if belt.closure == Closure::Retained { release.speed } else { 0.0 };
        let slope = belt.train.stiffness() * (self.drive_speed - keeps);
        let stuck = (release.pull - lap.sticks?) / slope;
        let (pull_min, pull_max) = lap.pull;
        let period = lap.duration + stuck;
        (slope > 0.0).then_some(CurveCycle { period, pull_max, pull_min, stuck, slope })
    }
}

impl Asks for StartQuestion<'_> {
    type Answer = CurveStart;

    fn laps(&self) -> &Laps<'_> {
        &self.laps
    }

    fn first(&mut self) -> Next<CurveStart> {
        let Release { pull, speed } = self.at_rest;
        let grip = self.laps.belt.train.grip();
        if pull >= grip || self.drive_speed <= speed {
            let first_peak = pull.min(grip);
            return Next::Answer(CurveStart { first_peak, stalls: pull >= grip, cycle: None });
        }
        Next::Lap(self.drive_speed, self.at_rest)
    }

    fn take(&mut self, lap: Lap) -> Next<CurveStart> {
        let settling = if let Some(settling) = &mut self.settling {
            settling
        } else {
            self.first_peak = lap.pull.1;
            let Some(pull) = lap.sticks else { return self.ends(None) };
            let next = self.laps.held(pull);
            let settling = self.settling.insert(Settling::new(next));
            if next != self.at_rest {
                return Next::Lap(self.drive_speed, next);
            }
            settling // the lap from there has just been followed
        };
        match settling.take(&self.laps, lap) {
            Settled::GoesOn(release) => Next::Lap(self.drive_speed, release),
            Settled::Ends(settled) => self.ends(settled),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drag::{Curve, Rest};
    use crate::motion::Drivetrain;

    fn belt(closure: Closure) -> CurveBelt {
        let values: Vec<f64> = (0..60).map(|i| (0.1 * f64::from(i) - 3.0).powi(2)).collect();
        CurveBelt {
            train: Drivetrain::new(1000.0, 1.0).unwrap(),
            curve: Curve::new(-3.0, 0.1, &values).unwrap(),
            stick_speed: 0.1,
            closure,
            static_ratio: 2.0,
            rest: Rest::default(),
        }
    }

    /// Where laps begin until the answer, if each ends with `pull`.
    fn asked<A: Asks>(mut question: A, pull: f64) -> (Vec<(f64, Release)>, A::Answer) {
        let (mut laps, mut next) = (Vec::new(), question.first());
        loop {
            match next {
                Next::Answer(answer) => return (laps, answer),
                Next::Lap(drive_speed, release) => {
                    laps.push((drive_speed, release));
                    let lap = Lap { sticks: Some(pull), duration: 1.0, pull: (pull, pull) };
                    next = question.take(lap);
                }
            }
        }
    }

    #[test]
    fn a_belt_that_stops_dead_is_started_by_one_lap_and_one_that_creeps_on_by_two() {
        for (closure, many) in
            [(Closure::Stiction, 1), (Closure::Stribeck, 1), (Closure::Retained, 2)]
        {
            let belt = belt(closure);
            let laps = Laps::new(&belt, 1e-3).unwrap();
            let (followed, start) = asked(StartQuestion::new(laps, 0.5), 0.1);
            assert_eq!(followed.len(), many, "{closure:?}");
            assert!(start.cycle.is_some());
        }
    }

    #[test]
    fn no_drive_speed_is_asked_for_twice() {
        let belt = belt(Closure::Stiction);
        for factor in [1.0, 1.0005, 1.3, 7.0, 900.0, f64::INFINITY] {
            let laps = Laps::new(&belt, 1e-3).unwrap();
            let (mut edge, mut seen) = (Edge::new(1.0, &laps), Vec::new());
            let found = loop {
                assert!(!seen.contains(&edge.at), "{factor} {seen:?}");
                seen.push(edge.at);
                if let Some(found) = edge.take(edge.at <= factor) {
                    break found;
                }
            };
            let near = (found / factor - 1.0).abs() < 1e-3;
            assert!(near || found.is_infinite() && factor.is_infinite(), "{factor} {found}");
        }
    }
}
