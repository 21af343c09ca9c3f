//! The drive speed at which a slip lap comes back to just where it began.
//!
//! In scaled units (time by `sqrt(m/k)`, speed by `v_t`, pull by `v_t sqrt(k m)`) the belt obeys
//! `p' = w - u`, `u' = p - d u^e - r u`, with `r` of the rest of the drive; its constant part only shifts the
//! pull, which is counted from there. A lap without sticking passes its slowest speed `u0` with pull and drag equal,
//! and one that comes back to that point is a cycle: unstable, or stable where it is small. At the stick
//! speed the same point is where a held belt is released, so there the cycle of sticking and slipping and the
//! unstable one meet: the upper fold `V*`.
//!
//! Whether a lap comes back is asked where it slows down through the transition: forward from the start, and
//! back in time from the slowest point, where the motion forgets what forward it would blow up. The drive
//! speed at which both arrive with the same pull is found by the secant method, each on its own lane.
//!
//! Where the roll slips before the belt is as fast as the drive, both meet with just the pull that the grip
//! bears, whatever came before: the lap then begins there.

use super::secant::{Outcome, Search, Step};
use super::slip_lap::SlipLap;
use crate::error::Error;
use crate::motion::lanes::{Lanes, arrival, run_lanes};
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

/// Tolerance of the steps, whose errors add up along a lap, over that asked for, and the tightest.
const SHARE: f64 = 0.1;
const TIGHTEST: f64 = 1e-14;
/// Steps of one lap after which a search is given up.
const MAX_STEPS: u32 = 20_000;
/// Halvings, in logarithms, of the range of speeds where the way back may begin: nobody sees more.
const MAX_HALVINGS: usize = 12;
/// Closeness of laps to the curve of slow motion, in e-folds, from which they are the same.
const FORGOTTEN: f64 = 45.0;
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
    let steps = (SHARE * tolerance).max(TIGHTEST);
    run_lanes::<false, _>(steps, work, admit, |seeker, lanes, l| {
        match seeker.follow(lanes, l, &start) {
            Next::Goes => true,
            Next::Found(fold) => {
                found[seeker.index] = Some(fold);
                false
            }
            Next::Fails => false,
        }
    })?;
    Ok(found)
}

/// One search on its lane.
struct Seeker {
    index: usize,
    lap: SlipLap,
    search: Search,
    /// Pull with which the forward half has slowed to the section, once it has.
    arrived: Option<f64>,
    speed_max: f64,
    /// Drag in steady sliding at the drive speed that is looked at.
    steady: f64,
    steps: u32,
    /// Pull of the grip with which the lap is to end at the drive speed, and begin anew, if not at its slowest point.
    meets: Option<f64>,
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
        Self {
            index,
            lap,
            search,
            arrived: None,
            speed_max: 0.0,
            steady: f64::NAN,
            steps: 0,
            meets: None,
        }
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
        self.meets = Some(grip);
        self
    }

    /// Speed at which the two halves are compared.
    fn section(&self) -> f64 {
        self.search.at.min(1.0)
    }

    fn load(&mut self, lanes: &mut Lanes, l: usize, (pull, speed): (f64, f64), sense: f64) {
        let SlipLap { damping, mixed, ehl, slowest, rest } = self.lap;
        // only where belt and drive meet under a roll that slips
        let fast = speed > 1.0 || (speed >= 1.0 && sense > 0.0);
        let exponent = if fast { ehl } else { mixed };
        self.steps = 0;
        (lanes.time[l], lanes.impulse[l], lanes.sense[l]) = (0.0, 0.0, sense);
        (lanes.pull[l], lanes.speed[l], lanes.rest[l]) = (pull, speed, rest);
        lanes.drag[l] = damping * speed.powf(exponent);
        (lanes.drive[l], lanes.exponent[l], lanes.floor[l]) = (self.search.at, exponent, slowest);
        (lanes.lower[l], lanes.upper[l]) = if fast {
            (1.0, f64::INFINITY)
        } else {
            (0.5 * slowest, if sense > 0.0 { 1.0 } else { self.section() })
        };
        let balanced = pull.to_bits() == (lanes.drag[l] + rest * speed).to_bits();
        if balanced {
            lanes.balance(l);
        }
        lanes.turned[l] = f64::from(balanced);
    }

    /// Pull and speed from which the lap is followed back in time.
    ///
    /// Back in time laps close in on the curve of slow motion, `p = F + u'` with `u' = (w - u)/F'`, by the
    /// factor `exp(-integral of F'^2/(w - u) du)` up to the section. Where little is left of the rest, the
    /// stiff part of the way is passed over.
    fn last_point(&self) -> (f64, f64) {
        let SlipLap { damping, mixed, slowest, rest, .. } = self.lap;
        let power = 2.0 * mixed - 1.0;
        let steepness = (mixed * damping).powi(2) / (self.search.at * -power);
        let section = self.section().min(self.lap.rising_from());
        // as if nothing but the contact dragged, whose slope is the steeper one
        let begin = (section.powf(power) + FORGOTTEN / steepness).powf(1.0 / power);
        if begin <= slowest {
            return (self.lap.mixed_force(slowest), slowest);
        }
        let begin = if rest == 0.0 { begin } else { self.begin_beside_rest(section, begin) };
        let begin = begin.min(0.9 * section).max(slowest);
        let slope = mixed * (damping * begin.powf(mixed)) / begin + rest;
        (self.lap.mixed_force(begin) + (self.search.at - begin) / slope, begin)
    }

    /// Where the way back begins, at `most` or slower, if the rest of the drive takes from the slope of the drag.
    fn begin_beside_rest(&self, section: f64, most: f64) -> f64 {
        let SlipLap { damping, mixed, slowest, rest, .. } = self.lap;
        let steep = -mixed * damping;
        // integral of F'^2, up to a constant
        let forgets = |u: f64| {
            let fall = steep * u.powf(mixed) / u;
            u * (fall * fall / (2.0 * mixed - 1.0) - 2.0 * rest * fall / mixed + rest * rest)
        };
        let enough = forgets(section) - FORGOTTEN * self.search.at;
        let (mut low, mut high) = (slowest, most);
        for _ in 0..MAX_HALVINGS {
            let middle = (low * high).sqrt();
            if forgets(middle) < enough { low = middle } else { high = middle }
        }
        low
    }

    /// Begin the lap at the drive speed that is looked at.
    fn forward(
        &mut self,
        lanes: &mut Lanes,
        l: usize,
        start: &impl Fn(usize, f64) -> Option<(f64, f64)>,
    ) -> bool {
        let Some(begin) = start(self.index, self.search.at) else { return false };
        (self.arrived, self.speed_max) = (None, 0.0);
        self.steady = self.lap.force(self.search.at);
        self.load(lanes, l, begin, 1.0);
        true
    }

    fn follow(
        &mut self,
        lanes: &mut Lanes,
        l: usize,
        start: &impl Fn(usize, f64) -> Option<(f64, f64)>,
    ) -> Next {
        self.steps += 1;
        let met = lanes.arrival[l];
        if met == arrival::LOST || self.steps > MAX_STEPS {
            return Next::Fails;
        }
        if self.creeps_to_the_drive(lanes, l) || self.dies_out(lanes, l) {
            return self.judge(Outcome::Escapes, lanes, l, start);
        }
        if met == arrival::NONE {
            return Next::Goes;
        }
        if let Some(pull) = self.arrived {
            if self.goes_on_back(lanes, l) {
                return Next::Goes;
            }
            // back in time from the slowest point the belt has reached the section
            return self.judge(Outcome::Gap(pull - lanes.pull[l]), lanes, l, start);
        }
        let SlipLap { damping, mixed, ehl, rest, .. } = self.lap;
        if met == arrival::UPPER {
            (lanes.drag[l], lanes.exponent[l]) = (damping, ehl);
            (lanes.lower[l], lanes.upper[l]) = (1.0, f64::INFINITY);
            return Next::Goes;
        }
        if met == arrival::TURNING {
            if self.speed_max > 0.0 {
                // the belt speeds up again before it has slowed to the section: it has escaped
                return self.judge(Outcome::Escapes, lanes, l, start);
            }
            self.speed_max = lanes.speed[l];
            if self.speed_max < 1.0 {
                lanes.lower[l] = self.section();
            }
            return Next::Goes;
        }
        if lanes.speed[l] > self.section() {
            (lanes.drag[l], lanes.exponent[l]) = (damping, mixed);
            (lanes.lower[l], lanes.upper[l]) = (self.section(), 1.0);
            return Next::Goes;
        }
        let drive = self.search.at;
        let contact = damping * drive.powf(mixed);
        if drive <= 1.0 && -mixed * contact - rest * drive >= 2.0 * drive {
            // steady sliding is an unstable node: whatever falls below it sticks, and back in time laps end there
            let steady = contact + rest * drive;
            return self.judge(Outcome::Gap(lanes.pull[l] - steady), lanes, l, start);
        }
        self.arrived = Some(lanes.pull[l]);
        let last = self.last_point();
        self.load(lanes, l, self.meets.map_or(last, |grip| (grip, drive)), -1.0);
        if self.meets.is_some() && drive <= 1.0 {
            lanes.lower[l] = last.1;
        }
        Next::Goes
    }

    /// Whether the lap back from where the roll slips goes on: over the transition, past its slowest point, or,
    /// where that is slower than any that matters, from there.
    fn goes_on_back(&mut self, lanes: &mut Lanes, l: usize) -> bool {
        if self.meets.is_none() || lanes.arrival[l] == arrival::UPPER {
            return false;
        }
        let SlipLap { damping, mixed, .. } = self.lap;
        if lanes.arrival[l] == arrival::TURNING {
            return true;
        }
        let last = self.last_point();
        if lanes.speed[l] > last.1 {
            (lanes.drag[l], lanes.exponent[l]) = (damping, mixed);
            (lanes.lower[l], lanes.upper[l]) = (last.1, 1.0);
        } else {
            self.load(lanes, l, last, -1.0);
        }
        true
    }

    /// Whether the belt slows down so gently that it cannot fall below a drive faster than the transition.
    ///
    /// With `y = u - w > 0` the EHL branch gives `y'' = -y - c y'`, where the damping `c = e F/u + r` only grows as
    /// the belt slows down. From `c >= 2` and `y' >= -y` on, `y' >= -y` holds for good and `y` never passes zero.
    fn creeps_to_the_drive(&self, lanes: &Lanes, l: usize) -> bool {
        let (speed, ahead) = (lanes.speed[l], lanes.speed[l] - self.search.at);
        self.search.at >= 1.0
            && self.speed_max > 0.0
            && speed >= 1.0
            && self.arrived.is_none()
            && self.lap.ehl * lanes.drag[l] + self.lap.rest * speed >= 2.0 * speed
            && lanes.pull[l] - (lanes.drag[l] + self.lap.rest * speed) >= -ahead
    }

    /// Whether the belt has too little energy about steady sliding to slow down to the transition ever again: on the
    /// rising branch that energy only falls.
    fn dies_out(&self, lanes: &Lanes, l: usize) -> bool {
        let margin = self.search.at - 1.0;
        let (ahead, off) = (lanes.speed[l] - self.search.at, lanes.pull[l] - self.steady);
        margin > 0.0
            && self.speed_max > 0.0
            && lanes.speed[l] >= 1.0
            && self.arrived.is_none()
            && ahead * ahead + off * off < margin * margin
    }

    /// Go on with the drive speed that follows from the outcome at this one.
    fn judge(
        &mut self,
        outcome: Outcome,
        lanes: &mut Lanes,
        l: usize,
        start: &impl Fn(usize, f64) -> Option<(f64, f64)>,
    ) -> Next {
        let speed_max = self.speed_max;
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

    #[test]
    fn the_way_back_begins_where_the_rest_is_forgotten() {
        let lap = SlipLap { damping: 20.0, slowest: 1e-4, mixed: -0.09, rest: 0.3, ..BASELINE };
        let mut seeker = Seeker::new(0, lap);
        (seeker.search.at, seeker.search.sticks) = (1.5, 0.0);
        let begin = seeker.begin_beside_rest(1.0, 0.9);
        let slope = |u: f64| lap.mixed * lap.damping * u.powf(lap.mixed - 1.0) + lap.rest;
        let step = (1.0 - begin) / 1e5;
        let forgotten: f64 = (0..100_000)
            .map(|i| slope(begin + (f64::from(i) + 0.5) * step).powi(2) / seeker.search.at * step)
            .sum();
        assert!((forgotten - FORGOTTEN).abs() < 0.5, "{begin} {forgotten}");
    }
}
