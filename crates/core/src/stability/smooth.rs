//! Edges of a belt whose closure is smooth, from where it overtakes the drive.
//!
//! How hard the spring pulls where the belt overtakes the drive decides what follows: above the speed of the bristles,
//! if there are any, they have long forgotten. So each lap maps a pull to the next, and a lap without sticking cannot
//! swap two pulls. Once such a lap brings less pull than the one before, all later laps do, and the belt
//! never sticks again: one or two laps decide what takes hundreds to die out. Stick-slip itself need not repeat: with
//! `LuGre` it is often chaotic, so there is no orbit to follow; it ends where a lap just comes
//! to the unstable cycle around steady sliding.

use std::collections::VecDeque;

use super::secant::below_three;
use crate::drag::{Closure, Drag};
use crate::error::Error;
use crate::motion::{Drivetrain, Overtakings, Start, System};
use crate::work::Work;

/// Laps after which a motion that still sticks is taken to go on so.
const MOST_LAPS: usize = 200;
/// The same while the edge is looked for; what lasts no longer is found beside it.
const FEW_LAPS: usize = 24;
/// Laps after which a belt that still sticks and then slides is chaotic: each lap multiplies errors.
const ORDERLY: usize = 12;
/// Accuracy of an edge above which that happens: chaotic laps have then no sharp end, and
/// when they end depends on rounding.
const CHAOTIC: f64 = 1e-3;
/// Change of the pull between laps, in tolerances, from which the motion repeats itself.
const CLOSED: f64 = 100.0;
/// Laps after which a motion with memory may repeat itself.
const MAX_PERIOD: usize = 16;
/// Laps in a row without sticking that bring less pull, from which the belt is known to slide: bristles may take one.
const FALLING: usize = 2;
/// Rate at which bristles forget, per rate of the free oscillation, from which they keep up with the belt.
const FORGOTTEN: f64 = 10.0;
/// Relative distance below the edge at which the motion is followed as long as any, and by how much that widens each time
/// it ends all the same.
const BESIDE: f64 = 5e-5;
const WIDER: f64 = 4.0;
/// Tolerance of the motions, in that of the edge: their error is a hundredth of its accuracy.
const LOOSER: f64 = 10.0;
const LOOSEST: f64 = 1e-7;
/// Share of the accuracy to which the edge is narrowed.
const NARROWED: f64 = 0.2;
/// Growth of the drive speed in search of one at which the belt slides.
const GROWTH: f64 = 1.25;

/// What becomes of stick-slip at a drive speed.
#[derive(Clone, Copy, PartialEq)]
enum Fate {
    Lasts,
    /// It has ended for good after so many laps, the belt having stuck last in that one.
    Ends(usize, usize),
}

/// A belt whose roll always grips.
pub(super) struct SmoothBelt<'a> {
    train: &'a Drivetrain,
    drag: &'a Drag,
    tolerance: f64,
}

impl<'a> SmoothBelt<'a> {
    pub(super) fn new(train: &'a Drivetrain, drag: &'a Drag, tolerance: f64) -> Self {
        Self { train, drag, tolerance: (LOOSER * tolerance).min(LOOSEST.max(tolerance)) }
    }
}

impl SmoothBelt<'_> {
    /// Greatest drive speed at which a belt from rest goes on to stick, and its accuracy: looked for up and down
    /// from `from`, no further than `least` and `most`; infinite if it does so at `most`.
    ///
    /// # Errors
    /// If a motion cannot be followed, or `work` ends before.
    pub(super) fn upper(
        &self,
        [from, least, most]: [f64; 3],
        accuracy: f64,
        work: &Work,
    ) -> Result<(f64, f64), Error> {
        let fate = |drive_speed: f64, laps: usize| self.fate(drive_speed, laps, work);
        let (mut low, mut high) = (from, from);
        let (mut ended, mut stuck) = loop {
            match fate(high, FEW_LAPS)? {
                Fate::Ends(laps, last) => break (laps, last),
                Fate::Lasts if high > most => return Ok((f64::INFINITY, accuracy)),
                Fate::Lasts => (low, high) = (high, GROWTH * high),
            }
        };
        if low >= high {
            while let Fate::Ends(laps, last) = fate(low, FEW_LAPS)? {
                (low, high, ended, stuck) = (low / GROWTH, low, laps, last);
                if low < least {
                    return Ok((low, accuracy));
                }
            }
        }
        let near = |stuck| if stuck > ORDERLY { CHAOTIC } else { accuracy };
        while high - low > NARROWED * near(stuck) * high {
            let middle = 0.5 * (low + high);
            match fate(middle, ended + FEW_LAPS)? {
                Fate::Lasts => low = middle,
                Fate::Ends(laps, last) => (high, ended, stuck) = (middle, laps, last),
            }
        }
        let mut step = BESIDE;
        low = loop {
            let below = (1.0 - step) * high;
            match fate(below, MOST_LAPS)? {
                Fate::Lasts if step <= BESIDE => return Ok((0.5 * (low + high), near(stuck))),
                Fate::Lasts => break below,
                Fate::Ends(..) if below < least => return Ok((below, accuracy)),
                Fate::Ends(..) => (high, step) = (below, (WIDER * step).min(0.5)),
            }
        };
        // chaotic laps that end late, if they do
        while high - low > NARROWED * CHAOTIC * high {
            let middle = 0.5 * (low + high);
            match fate(middle, MOST_LAPS)? {
                Fate::Lasts => low = middle,
                Fate::Ends(..) => high = middle,
            }
        }
        Ok((0.5 * (low + high), CHAOTIC))
    }

    /// What becomes of the stick-slip of a belt from rest, within so many laps.
    fn fate(&self, drive_speed: f64, most: usize, work: &Work) -> Result<Fate, Error> {
        let system = System::at_speed(*self.train, self.drag, drive_speed)?;
        let mut laps = Overtakings::from(&system, drive_speed, Start::REST, self.tolerance, work)?;
        let memory = self.drag.closure().has_memory();
        let (period, enough) = if memory { (MAX_PERIOD, FALLING) } else { (1, 1) };
        let mut past = VecDeque::new();
        let (mut falling, mut sliding, mut stuck) = (0, 0, 0);
        for lap in 1..=most {
            let Some(met) = laps.next()? else { return Ok(Fate::Ends(lap, stuck)) };
            (sliding, stuck) = if met.stuck { (0, lap) } else { (sliding + 1, stuck) };
            let falls = past.front().is_some_and(|before| met.pull < *before);
            falling =
                if falls && !met.stuck && self.forgets(met.slowest) { falling + 1 } else { 0 };
            if falling == enough {
                return Ok(Fate::Ends(lap, stuck));
            }
            let near = CLOSED * self.tolerance * met.pull.abs();
            let repeats = |before: &f64| (met.pull - before).abs() <= near;
            if let Some(place) = past.iter().position(repeats) {
                return Ok(if sliding > place { Fate::Ends(lap, stuck) } else { Fate::Lasts });
            }
            past.push_front(met.pull);
            past.truncate(period);
        }
        Ok(if sliding > period { Fate::Ends(most, stuck) } else { Fate::Lasts })
    }

    /// Whether bristles, if there are any, keep up with a belt at this speed or faster.
    fn forgets(&self, speed: f64) -> bool {
        let Closure::LuGre { bristle_stiffness, .. } = self.drag.closure() else { return true };
        let rate = speed * bristle_stiffness / self.drag.force(speed);
        speed > 0.0 && rate * self.train.time_scale() >= FORGOTTEN
    }
}

/// Sizes of the swings looked at: their excess of pull over the transition speed times `sqrt(k m)`.
const SIZES: [f64; 7] = [0.05, 0.12, 0.25, 0.4, 0.55, 0.7, 0.9];
/// Parabolas drawn through the least of three points, after those sizes.
const PARABOLAS: usize = 5;
/// Drive speeds between which the swing of a size is looked for, over the transition speed.
const SLOWEST: f64 = 0.8;
const FASTEST: f64 = 1.1;
/// Relative accuracy of the drive speed of a swing, and laps at most on the way to it.
const FOUND: f64 = 1e-8;
const MOST_TRIES: usize = 60;
/// Relative distances below and above the edge at which single motions are to agree with it: below it they pass slowly by
/// the swing that has vanished.
const BELOW: f64 = 1e-3;
const ABOVE: f64 = 1e-4;
/// Laps after which a swing that has not come to stick is taken not to do so.
const MOST_SWINGS: usize = 1000;

impl SmoothBelt<'_> {
    /// Least drive speed of any swing that never sticks, no more than `none`, below which drag falls; no number if it is
    /// slower than any looked at.
    ///
    /// # Errors
    /// As for [`Self::upper`].
    pub(super) fn lower(&self, none: f64, work: &Work) -> Result<Option<f64>, Error> {
        let mut seen: Vec<(f64, f64)> = Vec::new();
        for size in SIZES {
            let Some(drive_speed) = self.drive_of(size, work)? else { return Ok(None) };
            seen.push((size, drive_speed));
        }
        for _ in 0..PARABOLAS {
            let Some(size) = below_three(&seen) else { break };
            let Some(drive_speed) = self.drive_of(size, work)? else { break };
            let place = seen.partition_point(|(s, _)| *s < size);
            seen.insert(place, (size, drive_speed));
        }
        let edge = seen.iter().fold(none, |least, (_, drive_speed)| least.min(*drive_speed));
        // where bristles make swings of several laps, these last below any that repeats itself at once
        let meets = self.comes_to_stick((1.0 - BELOW) * edge, work)?
            && !self.comes_to_stick((1.0 + ABOVE) * edge, work)?;
        Ok(meets.then_some(edge))
    }

    /// The same by halving what a belt nudged from steady sliding comes to.
    ///
    /// # Errors
    /// As for [`Self::upper`].
    pub(super) fn lower_by_halving(&self, accuracy: f64, work: &Work) -> Result<f64, Error> {
        let (mut low, mut high) = (self.drag.transition_speed(), self.drag.transition_speed());
        while !self.comes_to_stick(low, work)? {
            (low, high) = (SLOWEST * low, low);
            if low < self.drag.stick_speed() {
                return Ok(low);
            }
        }
        while high - low > accuracy * high {
            let middle = 0.5 * (low + high);
            if self.comes_to_stick(middle, work)? { low = middle } else { high = middle }
        }
        Ok(0.5 * (low + high))
    }

    /// Whether a belt nudged from steady sliding comes to stick.
    fn comes_to_stick(&self, drive_speed: f64, work: &Work) -> Result<bool, Error> {
        let system = System::at_speed(*self.train, self.drag, drive_speed)?;
        let start = Start::steady(self.train, self.drag, drive_speed)?.nudged();
        let mut laps = Overtakings::from(&system, drive_speed, start, self.tolerance, work)?;
        let mut past = VecDeque::new();
        for _ in 0..MOST_SWINGS {
            let Some(met) = laps.next()? else { return Ok(false) };
            if met.stuck {
                return Ok(true);
            }
            let swing = met.pull - self.drag.force(drive_speed);
            let near = CLOSED * self.tolerance * swing.abs();
            if past.iter().any(|before: &f64| (swing - before).abs() <= near) {
                return Ok(false);
            }
            past.push_front(swing);
            past.truncate(MAX_PERIOD);
        }
        Ok(false)
    }

    /// Drive speed at which a swing of this size neither grows nor falls; the fastest looked at if it is no slower.
    fn drive_of(&self, size: f64, work: &Work) -> Result<Option<f64>, Error> {
        let transition = self.drag.transition_speed();
        let (mut low, mut high) = ((SLOWEST * transition, None), (FASTEST * transition, None));
        match self.growth(low.0, size, work)? {
            Growth::Falls(_) => return Ok(None),
            Growth::Grows(by) => low.1 = by,
        }
        match self.growth(high.0, size, work)? {
            Growth::Grows(_) => return Ok(Some(high.0)),
            Growth::Falls(by) => high.1 = by,
        }
        // false position, and halving where that has no value or closes in from one side only
        for count in 0..MOST_TRIES {
            if high.0 - low.0 <= FOUND * high.0 {
                break;
            }
            let middle = 0.5 * (low.0 + high.0);
            let secant = low.1.zip(high.1).map(|(g, f)| low.0 + (high.0 - low.0) * g / (g + f));
            let inside = |w: &f64| *w > low.0 && *w < high.0;
            let drive_speed = secant.filter(|w| count % 3 < 2 && inside(w)).unwrap_or(middle);
            match self.growth(drive_speed, size, work)? {
                Growth::Grows(by) => low = (drive_speed, by),
                Growth::Falls(by) => high = (drive_speed, by),
            }
        }
        Ok(Some(0.5 * (low.0 + high.0)))
    }

    /// What becomes of a swing of this size: its second lap against the first, in which bristles fall in with it.
    fn growth(&self, drive_speed: f64, size: f64, work: &Work) -> Result<Growth, Error> {
        let system = System::at_speed(*self.train, self.drag, drive_speed)?;
        let impedance = self.train.impedance();
        let excess = size * self.drag.transition_speed() * impedance;
        let pull = self.drag.force(drive_speed) + excess;
        let start = Start { belt_speed: drive_speed, stretch: pull / self.train.stiffness() };
        let mut laps = Overtakings::from(&system, drive_speed, start, self.tolerance, work)?;
        let mut before = pull;
        for lap in 0..2 {
            match laps.next()? {
                None => return Ok(Growth::Falls(None)),
                Some(met) if met.stuck => return Ok(Growth::Grows(None)),
                Some(met) if lap == 0 => before = met.pull,
                Some(met) if met.pull < before => {
                    return Ok(Growth::Falls(Some(before - met.pull)));
                }
                Some(met) => return Ok(Growth::Grows(Some(met.pull - before))),
            }
        }
        Ok(Growth::Falls(None))
    }
}

/// Which way the pull goes from lap to lap: up, or to sticking, or down to sliding; by so much where that is known.
enum Growth {
    Grows(Option<f64>),
    Falls(Option<f64>),
}

#[cfg(test)]
mod tests {
    use super::*;

    const WORK: u64 = 30_000_000;

    fn lugre() -> (Drivetrain, Drag) {
        let closure = Closure::LuGre { bristle_stiffness: 8e4, bristle_damping: 839.0 };
        let drag = Drag::new(30.0, 0.4, -0.7, -1.2, 0.008, closure).unwrap();
        (Drivetrain::new(4000.0, 2.2).unwrap(), drag)
    }

    #[test]
    fn the_edge_of_chaotic_stick_slip_is_that_of_an_independent_solution() {
        let (train, drag) = lugre();
        let belt = SmoothBelt::new(&train, &drag, 1e-10);
        let work = Work::unwatched(WORK);
        let (upper, accuracy) = belt.upper([0.4, 0.008, 4000.0], 1e-6, &work).unwrap();
        // LSODA at 1e-10 of the same equations, halved: the pull of the first laps grows or falls
        assert!(upper > 0.464_846_09 - 5e-7 && upper < 0.464_846_88 + 5e-7, "{upper}");
        assert!((accuracy - 1e-6).abs() < 1e-18);
        // a motion followed to its end takes as much as 200 laps, of some 5,000 steps each
        assert!(work.done() < 8_000_000, "{}", work.done());
    }

    #[test]
    fn work_that_does_not_suffice_is_an_error() {
        let (train, drag) = lugre();
        let belt = SmoothBelt::new(&train, &drag, 1e-9);
        let found = belt.upper([0.4, 0.008, 4000.0], 1e-6, &Work::unwatched(10_000));
        assert!(found.is_err_and(|error| error.is_unfinished()));
        let found = belt.lower(0.4, &Work::unwatched(10_000));
        assert!(found.is_err_and(|error| error.is_unfinished()));
    }

    #[test]
    fn bristles_forget_above_a_speed() {
        let (train, drag) = lugre();
        let belt = SmoothBelt::new(&train, &drag, 1e-9);
        // u s0/g sqrt(m/k): 0.4 * 8e4/30 * 0.02345 = 25.0, and 0.1 * 8e4/(30 * 0.25^-0.2) * 0.02345 = 4.74
        assert!(belt.forgets(0.4) && !belt.forgets(0.1) && !belt.forgets(-0.4));
    }
}
