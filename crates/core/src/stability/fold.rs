//! The drive speed at which a slip lap comes back to just where it began.
//!
//! In scaled units (time by `sqrt(m/k)`, speed by `v_t`, pull by `v_t sqrt(k m)`) the belt obeys
//! `p' = w - u`, `u' = p - d u^e - r u`, with `r` of the rest of the drive; its constant part only shifts the
//! pull, which is counted from there. A lap without sticking passes its slowest speed `u0` with pull and drag equal,
//! and one that comes back to that point is a cycle: unstable, or stable where it is small. At the stick
//! speed the same point is where a held belt is released, so there the cycle of sticking and slipping and the
//! unstable one meet: the upper fold `V*`.
//!
//! The drive speed at which both halves of the lap arrive with the same pull is found by the secant method, each on its own
//! lane.

use super::half_laps::{HalfLaps, Met, step_tolerance};
use super::secant::{Outcome, Search, Step};
use super::slip_lap::SlipLap;
use crate::error::Error;
use crate::motion::lanes::{Lanes, run_lanes};
use crate::work::Work;

/// A drive speed at which the lap comes back to its start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fold {
    /// Drive speed over `v_t`; infinite beyond 10,000.
    pub drive_speed: f64,
    /// Greatest speed of the lap over `v_t`.
    pub speed_max: f64,
    /// Laps followed, a lap forward and the rest of it back in time together.
    pub laps: usize,
}

/// Room left beside the greatest speed of a lap near the fold.
const CLOSE: f64 = 0.01;

/// The fold of each of `laps`; none where they cannot be followed.
///
/// `start` gives pull and speed at which the forward lap of a given index begins at a drive speed, if not
/// from its slowest point.
///
/// # Errors
/// If `work` is stopped.
pub(super) fn folds(
    laps: &[SlipLap],
    tolerance: f64,
    work: &Work,
    start: impl Fn(usize, f64) -> Option<(f64, f64)>,
) -> Result<Vec<Option<Fold>>, Error> {
    let seekers = laps.iter().enumerate().map(|(index, lap)| Seeker::new(index, *lap));
    seek(seekers, laps.len(), tolerance, work, start)
}

/// The folds of `laps` from their own slowest points, as far as they lie below the speed from which on drag rises; that
/// speed where they do not.
///
/// # Errors
/// If `work` is stopped.
pub(super) fn capped(
    laps: &[SlipLap],
    tolerance: f64,
    work: &Work,
) -> Result<Vec<Option<Fold>>, Error> {
    let start = |index: usize, _| {
        let lap: &SlipLap = &laps[index];
        Some((lap.mixed_force(lap.slowest), lap.slowest))
    };
    let seekers = laps.iter().enumerate().map(|(index, lap)| {
        let mut seeker = Seeker::new(index, *lap);
        (seeker.search.at, seeker.search.most) = (lap.rising_from(), lap.rising_from());
        seeker
    });
    seek(seekers, laps.len(), tolerance, work, start)
}

/// A lap whose fold is known, and the greatest pull on it, scaled: that of the roll's grip.
pub(super) struct Gripped {
    pub lap: SlipLap,
    pub grip: f64,
    pub free: Fold,
}

impl Gripped {
    /// Whether the free lap at the fold asks for the grip, as far as can be said without following it.
    ///
    /// From the drive speed `w` up to the greatest speed `(p - F)(p - F)' >= -(u - w) u'` where `F` is the greatest
    /// drag on the way, so the pull where the belt overtakes the drive is less than that by the gain in speed.
    pub(super) fn may_slip(&self) -> bool {
        let Fold { drive_speed, speed_max, .. } = self.free;
        let drag = self.lap.force(drive_speed).max(self.lap.force(speed_max));
        let pull = drag + (speed_max - drive_speed).max(0.0);
        // the greatest speed is that of the last lap that was followed, close to the fold
        let most = pull * (1.0 + CLOSE);
        !(most.is_finite() && self.grip > most)
    }
}

/// What is left of a fold under a roll that slips.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SlippingFold {
    /// Drive speed, over `v_t`, above which the belt sticks no more.
    pub sticks_below: f64,
    /// Above this no swing lasts on which the roll slips, be it without sticking.
    pub fold: Fold,
}

/// The folds of the same laps under a roll that slips; the fold itself where the grip is never needed.
///
/// Where the free lap pulls less than the grip where the belt overtakes the drive, one that begins there with
/// the pull of the grip comes back slower and sticks: then the drive speed of the fold is found to stick at once.
///
/// # Errors
/// If `work` is stopped.
pub(super) fn gripped(
    laps: &[Gripped],
    tolerance: f64,
    work: &Work,
) -> Result<Vec<Option<SlippingFold>>, Error> {
    let start = |index: usize, drive_speed: f64| Some((laps[index].grip, drive_speed));
    let seekers = laps.iter().enumerate().map(|(index, given)| Seeker::gripped(index, given));
    let sticking = seek(seekers, laps.len(), tolerance, work, start)?;
    let slips =
        |index: usize| sticking[index].filter(|f| f.drive_speed < laps[index].free.drive_speed);
    let seekers = laps.iter().enumerate().filter_map(|(index, given)| {
        Some(Seeker::gripped(index, given).meeting(given.grip, slips(index)?.drive_speed))
    });
    let swinging = seek(seekers, laps.len(), tolerance, work, start)?;
    let least = |index: usize| {
        let sticks_below = sticking[index]?.drive_speed;
        let free = laps[index].free;
        if slips(index).is_none() {
            return Some(SlippingFold { sticks_below: free.drive_speed, fold: free });
        }
        let fold = swinging[index]?;
        Some(SlippingFold { sticks_below, fold })
    };
    Ok((0..laps.len()).map(least).collect())
}

/// What `seekers`, so many, find.
fn seek(
    mut seekers: impl Iterator<Item = Seeker>,
    many: usize,
    tolerance: f64,
    work: &Work,
    start: impl Fn(usize, f64) -> Option<(f64, f64)>,
) -> Result<Vec<Option<Fold>>, Error> {
    let mut found = vec![None; many];
    let admit = |lanes: &mut Lanes, l: usize| {
        seekers.find_map(|mut seeker| seeker.forward(lanes, l, &start).then_some(seeker))
    };
    run_lanes::<false, _>(step_tolerance(tolerance), work, admit, |seeker, lanes, l| match seeker
        .follow(lanes, l, &start)
    {
        Next::Goes => true,
        Next::Found(fold) => {
            found[seeker.index] = Some(fold);
            false
        }
        Next::Fails => false,
    })?;
    Ok(found)
}

/// One search on its lane.
struct Seeker {
    index: usize,
    halves: HalfLaps,
    search: Search,
}

enum Next {
    Goes,
    Found(Fold),
    Fails,
}

impl Seeker {
    fn new(index: usize, lap: SlipLap) -> Self {
        let guess = lap.guess();
        // without a way back from below the transition the fold is there or above
        let search = if lap.is_node() {
            Search::new(1.0 - f64::EPSILON, 1.0)
        } else {
            Search::new(lap.slowest, guess.max(0.5 * (1.0 + lap.slowest)))
        };
        Self { index, halves: HalfLaps::new(lap), search }
    }

    /// The same for a lap that begins at the drive speed with the pull of the grip, no faster than the free one.
    fn gripped(index: usize, Gripped { lap, grip, free }: &Gripped) -> Self {
        let mut seeker = Self::new(index, *lap);
        // from here on sliding drags more than the grip bears, and no belt overtakes the drive
        let stalls = lap.drags(*grip);
        seeker.search.most = free.drive_speed;
        seeker.search.at = if free.drive_speed < stalls {
            free.drive_speed
        } else {
            seeker.search.escapes = Some(stalls);
            lap.guess().min(0.5 * (1.0 + stalls))
        };
        seeker
    }

    /// The same for a lap that comes back to where the roll slips, from the drive speed at which it just sticks.
    fn meeting(mut self, grip: f64, sticks: f64) -> Self {
        (self.search.sticks, self.search.at) = (sticks, sticks);
        self.halves.meets = Some(grip);
        self
    }

    /// Begin the lap at the drive speed that is looked at.
    fn forward(
        &mut self,
        lanes: &mut Lanes,
        l: usize,
        start: &impl Fn(usize, f64) -> Option<(f64, f64)>,
    ) -> bool {
        let Some(begin) = start(self.index, self.search.at) else { return false };
        self.halves.drive_speed = self.search.at;
        self.halves.begin(lanes, l, begin);
        true
    }

    fn follow(
        &mut self,
        lanes: &mut Lanes,
        l: usize,
        start: &impl Fn(usize, f64) -> Option<(f64, f64)>,
    ) -> Next {
        match self.halves.meet(lanes, l) {
            Met::Nothing => Next::Goes,
            Met::End(outcome) => self.judge(outcome, lanes, l, start),
            Met::Lost => Next::Fails,
        }
    }

    /// Go on with the drive speed that follows from the outcome at this one.
    fn judge(
        &mut self,
        outcome: Outcome,
        lanes: &mut Lanes,
        l: usize,
        start: &impl Fn(usize, f64) -> Option<(f64, f64)>,
    ) -> Next {
        let speed_max = self.halves.speed_max;
        match self.search.take(outcome) {
            Step::Again if self.forward(lanes, l, start) => Next::Goes,
            Step::Again | Step::Nowhere => Next::Fails,
            Step::At(drive_speed) => {
                Next::Found(Fold { drive_speed, speed_max, laps: self.search.laps })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Folds of laps that nobody stops.
    fn cycles(laps: &[SlipLap], tolerance: f64) -> Vec<Option<Fold>> {
        crate::stability::cycles(laps, tolerance, &Work::default()).unwrap()
    }

    const BASELINE: SlipLap =
        SlipLap { damping: 1.581_138_830_084_19, slowest: 0.01, mixed: -0.2, ehl: 0.3, rest: 0.0 };

    #[test]
    fn the_fold_of_the_baseline_takes_five_laps() {
        let fold = cycles(&[BASELINE], 1e-12)[0].unwrap();
        assert!((fold.drive_speed - 2.173_493_478).abs() < 1e-9);
        assert!(fold.laps <= 5);
    }

    #[test]
    fn a_fold_is_the_same_among_others() {
        let laps: Vec<SlipLap> =
            (1..40).map(|i| SlipLap { damping: 0.1 * f64::from(i), ..BASELINE }).collect();
        let together = cycles(&laps, 1e-9);
        for (lap, found) in laps.iter().zip(together) {
            assert_eq!(cycles(&[*lap], 1e-9)[0], found);
        }
    }

    #[test]
    fn cycles_of_small_size_begin_at_the_transition() {
        let small = SlipLap { slowest: 0.98, ..BASELINE };
        let drive = cycles(&[small], 1e-10)[0].unwrap().drive_speed;
        assert!(drive > 0.995 && drive < 1.0, "{drive}");
    }

    #[test]
    fn no_belt_swings_below_a_drive_it_creeps_towards() {
        let heavy = SlipLap { damping: 1e3, ..BASELINE };
        let fold = cycles(&[heavy], 1e-10)[0].unwrap();
        assert!((fold.drive_speed - 1.0).abs() < 1e-12);
    }
    #[test]
    fn long_steps_meet_slow_levels_and_laps_that_die_out_end() {
        let at = |damping, slowest, ehl, tolerance| {
            let lap = SlipLap { damping, slowest, ehl, ..BASELINE };
            cycles(&[lap], tolerance)[0].unwrap().drive_speed
        };
        // the way back comes to the section almost at rest
        assert!((at(5.196_846_5, 0.004_172_21, 0.616_805_63, 1e-7) - 0.967_789).abs() < 1e-5);
        // steady sliding that is looked at first is just no node
        assert!((at(3.514_712_4, 0.019_925_71, 0.691_635_395, 1e-11) - 0.917_444_1).abs() < 1e-6);
    }
}
