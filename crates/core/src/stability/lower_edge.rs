//! The least drive speed of any cycle without sticking, where two of them meet.
//!
//! Let `w(s)` be the drive speed of the cycle whose slowest speed is `s`. The edge is the least `w`. A lap of any slowest
//! speed at any drive speed ends with a gap, and small deviations followed along it give how that gap changes with
//! both. So each lap gives an estimate of `w(s)` and of its slope. The edge depends on the slope squared, so that small
//! errors of the slope hardly matter.

use super::deviation::{Deviation, Point};
use super::half_laps::{HalfLaps, Met, step_tolerance};
use super::parabolas::by_parabolas;
use super::rising_edge::where_drag_rises;
use super::secant::Outcome;
use super::slip_lap::SlipLap;
use super::valley::{LowerEdge, Step, Trial, Valley};
use crate::error::Error;
use crate::motion::lanes::{Lanes, run_lanes};
use crate::work::Work;

/// Slope of the falling drag, over that of a node, from which on laps come so close to steady sliding that their gaps say
/// nothing of where they began.
const ALMOST_A_NODE: f64 = 0.97;

/// Least drive speed of the cycles of each lap whose slowest speed is no less than its own. At the speed from which drag
/// rises cycles shrink to nothing, so no edge is higher.
///
/// # Errors
/// If `work` is stopped.
pub(super) fn lower_edges(
    laps: &[SlipLap],
    tolerance: f64,
    work: &Work,
) -> Result<Vec<LowerEdge>, Error> {
    let mut found = by_slopes(laps, tolerance, work)?;
    for find in [where_drag_rises, by_parabolas] {
        let unsolved: Vec<usize> = (0..laps.len()).filter(|i| found[*i].is_none()).collect();
        let unsolved_laps: Vec<SlipLap> = unsolved.iter().map(|i| laps[*i]).collect();
        for (index, edge) in unsolved.into_iter().zip(find(&unsolved_laps, tolerance, work)?) {
            found[index] = edge;
        }
    }
    Ok(found.into_iter().flatten().collect())
}

/// The edges that laps and their slopes lead to.
fn by_slopes(
    laps: &[SlipLap],
    tolerance: f64,
    work: &Work,
) -> Result<Vec<Option<LowerEdge>>, Error> {
    // no belt comes back from below the transition to a node
    let at_node = |lap: &SlipLap| LowerEdge { drive_speed: lap.rising_from(), laps: 0 };
    let mut found: Vec<Option<LowerEdge>> =
        laps.iter().map(|lap| lap.is_node().then(|| at_node(lap))).collect();
    let mut waiting = laps.iter().enumerate().filter(|(_, lap)| !lap.is_node());
    let admit = |lanes: &mut Lanes, l: usize| {
        waiting.find_map(|(index, lap)| {
            let mut descent = Descent::new(index, lap)?;
            descent.begin(lanes, l);
            Some(descent)
        })
    };
    run_lanes::<false, _>(
        step_tolerance(tolerance),
        work,
        admit,
        |descent, lanes, l| match descent.follow(lanes, l) {
            Next::Goes => true,
            Next::Found(edge) => {
                found[descent.index] = Some(edge);
                false
            }
            Next::Fails => false,
        },
    )?;
    Ok(found)
}

/// One search on its lane.
struct Descent {
    index: usize,
    halves: HalfLaps,
    valley: Valley,
    /// Where the step under way began, and the exponent of drag on it.
    from: Point,
    exponent: f64,
    /// Deviations over the half under way, and over the one forward once that is done.
    deviation: Deviation,
    forward: Option<Deviation>,
}

enum Next {
    Goes,
    Found(LowerEdge),
    Fails,
}

impl Descent {
    /// None if small cycles already ask for a faster drive than that from which on drag rises.
    fn new(index: usize, lap: &SlipLap) -> Option<Self> {
        let rises = lap.rising_from();
        let (slowest, drive_speed) = guess(lap)?;
        let (slowest, drive_speed) = ((slowest * rises).max(lap.slowest), drive_speed * rises);
        let mut halves = HalfLaps::new(SlipLap { slowest, ..*lap });
        halves.drive_speed = drive_speed;
        Some(Self {
            index,
            halves,
            valley: Valley::new(lap.slowest, rises, (slowest, drive_speed)),
            from: Point::of(&Lanes::idle(), 0, 1.0),
            exponent: f64::NAN,
            deviation: Deviation::NEW,
            forward: None,
        })
    }

    fn begin(&mut self, lanes: &mut Lanes, l: usize) {
        let lap = self.halves.lap;
        self.halves.begin(lanes, l, (lap.mixed_force(lap.slowest), lap.slowest));
        (self.deviation, self.forward) = (Deviation::NEW, None);
        self.depart(lanes, l);
    }

    fn depart(&mut self, lanes: &Lanes, l: usize) {
        self.exponent = lanes.exponent[l];
        self.from = Point::of(lanes, l, self.exponent);
    }

    fn follow(&mut self, lanes: &mut Lanes, l: usize) -> Next {
        let to = Point::of(lanes, l, self.exponent);
        self.deviation.pass(&self.from, &to);
        match (self.halves.meet(lanes, l), self.forward) {
            (Met::Nothing, forward) => {
                if forward.is_none() && self.halves.is_on_the_way_back() {
                    self.forward = Some(std::mem::replace(&mut self.deviation, Deviation::NEW));
                }
                self.depart(lanes, l);
                Next::Goes
            }
            (Met::End(Outcome::Gap(gap)), Some(forward)) => {
                let trial = self.trial(gap, to.gain, &forward);
                match self.valley.take(&trial) {
                    Step::Found(edge) => Next::Found(edge),
                    Step::Nowhere => Next::Fails,
                    Step::Try(slowest, drive_speed) => {
                        (self.halves.lap.slowest, self.halves.drive_speed) = (slowest, drive_speed);
                        self.begin(lanes, l);
                        Next::Goes
                    }
                }
            }
            _ => Next::Fails,
        }
    }

    /// What the lap says that has ended with a gap, at a rate of the speed.
    fn trial(&self, gap: f64, gain: f64, forward: &Deviation) -> Trial {
        let (slowest, drive_speed) = (self.halves.lap.slowest, self.halves.drive_speed);
        let back = self.deviation;
        let added = forward.added + back.added;
        let kept = if self.halves.passes_over_the_start() { 0.0 } else { back.kept };
        Trial {
            slowest,
            drive_speed,
            correction: -gap * gain / added,
            error: forward.error().max(back.error()),
            slope: (drive_speed - slowest) * (forward.kept - kept) / added,
        }
    }
}

/// Where the edge lies about: slowest speed and drive speed over that from which on drag rises, fitted to 4,000 random laps.
///
/// `ratio` compares how drag falls and rises about the transition. Up to half the slope of a node, `slow`, the swings
/// are almost those of a free belt; close to it they creep, and forget where they began.
fn guess(lap: &SlipLap) -> Option<(f64, f64)> {
    let SlipLap { damping, mixed, ehl, rest, .. } = *lap;
    let falls = -mixed * damping;
    let ratio = falls / (ehl * damping + 2.0 * rest);
    let slow = 0.5 * (falls - rest);
    if ratio >= 1.0 || slow <= 0.0 || slow >= ALMOST_A_NODE {
        return None;
    }
    let free = (1.0 - ratio).powi(2) * (0.415 + ratio * (-0.52 + 0.22 * ratio));
    let creeping = (1.0 - slow).powi(4) * (0.574 + 0.215 * slow);
    let below = free * creeping / free.hypot(creeping);
    let creeps = (free / creeping).min(2.0);
    let swing = (1.0 - ratio) * (1.015 + ratio * (-0.451 + 0.063 * ratio));
    let mut slowest = 1.0 - swing - creeps * ratio * (0.646 - 0.668 * ratio).max(0.0);
    if creeps >= 2.0 {
        let power = 1.0 - 2.0 * mixed;
        let forgotten = (4.0 * slow * slow / (30.0 * power)).powf(1.0 / power);
        slowest = slowest.min(forgotten * (1.0 + 4.0 * ratio.powi(3)));
    }
    Some((slowest, 1.0 - below))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TOLERANCE: f64 = 1e-11;

    fn found(laps: &[SlipLap], tolerance: f64) -> Vec<LowerEdge> {
        lower_edges(laps, tolerance, &Work::default()).unwrap()
    }

    /// A map like that of the benchmark: stiffness 500 to 2000, drag at the transition 25 to 100.
    fn map(side: u32) -> Vec<SlipLap> {
        let step = 1.0 / f64::from(side - 1);
        let row = |i: u32| (0..side).map(move |j| (f64::from(i) * step, f64::from(j) * step));
        let lap = |(x, y): (f64, f64)| SlipLap {
            damping: (25.0 + 75.0 * y) / (500.0 + 1500.0 * x).sqrt(),
            slowest: 0.01,
            mixed: -0.2,
            ehl: 0.3,
            rest: 0.0,
        };
        (0..side).flat_map(row).map(lap).collect()
    }

    /// Laps all over what belts can be, the same each time: numbers that fill the unit interval evenly.
    fn all_kinds(many: u32) -> impl Iterator<Item = SlipLap> {
        let even = |i: u32, step: f64| (f64::from(i) * step).fract();
        let decades = |low: f64, high: f64, share: f64| 10_f64.powf(low + (high - low) * share);
        (0..many)
            .map(move |i| {
                let rests = even(i, 0.302_775_637_7) < 0.7;
                let rest = if rests { decades(-3.0, 0.3, even(i, 0.618_033_988_7)) } else { 0.0 };
                let mixed = -decades(-1.7, 0.2, even(i, 0.414_213_562_4));
                let slow = 0.002 + 1.1 * even(i, 0.732_050_807_6);
                SlipLap {
                    damping: (2.0 * slow + rest) / -mixed,
                    slowest: decades(-2.5, -0.3, even(i, 0.236_067_977_5)),
                    mixed,
                    ehl: decades(-1.0, 0.3, even(i, 0.645_751_311_1)),
                    rest,
                }
            })
            .filter(|lap| lap.slowest < 0.95 * lap.rising_from())
    }

    #[test]
    fn the_edges_of_a_map_take_five_laps_each() {
        let laps = map(16);
        let edges = by_slopes(&laps, 3e-9, &Work::default()).unwrap();
        let taken: Vec<usize> = edges.iter().map(|edge| edge.unwrap().laps).collect();
        // 4.4 on average; without slopes an edge takes about 300
        assert!(taken.iter().sum::<usize>() <= 9 * laps.len() / 2, "{taken:?}");
        assert!(taken.iter().all(|many| *many <= 5), "{taken:?}");
    }

    /// Damping, exponents, slowest speed, rest and edge of some laps.
    // computed with SciPy: laps by DOP853, the drive speed of each slowest speed and the least of them by Brent's methods
    const KNOWN: [([f64; 5], f64); 15] = [
        ([3.11, -0.251, 0.339, 0.183, 0.0], 0.990_685_041_647),
        ([3.11, -0.251, 0.339, 0.9, 0.0], 0.993_168_668_552),
        ([1.58, -0.2, 0.3, 0.01, 0.0], 0.981_792_374_121),
        ([0.6, -0.5, 0.8, 0.02, 0.0], 0.975_734_425_931),
        ([1.5, -0.8, 1.2, 0.05, 0.0], 0.990_472_731_964),
        ([0.2, -1.4, 1.9, 0.3, 0.0], 0.989_449_865_336),
        ([2.0, -0.3, 0.15, 0.02, 0.4], 0.931_137_307_101),
        ([0.8, -0.6, 0.3, 0.4, 0.3], 0.949_536_548_170),
        ([2.5, -0.7, 0.25, 0.03, 1.0], 0.978_061_965_016),
        ([0.9, -0.25, 0.5, 0.45, 0.01], 0.941_989_813_481),
        ([2.9, -0.55, 0.3, 0.02, 0.9], 0.967_322_805_600),
        ([3.6, -0.5, 0.9, 0.05, 0.2], 0.998_788_472_052),
        ([1.0, -1.5, 1.9, 0.05, 0.6], 0.982_301_899_494),
        ([5.0, -0.35, 0.5, 0.005, 0.05], 0.999_528_062_072),
        // drag rises less above the transition than it falls below: all cycles are faster than the transition
        ([4.0, -0.4, 0.2, 0.1, 0.2], 1.0),
    ];

    #[test]
    fn edges_are_those_of_another_integrator() {
        let lap = |[damping, mixed, ehl, slowest, rest]: [f64; 5]| SlipLap {
            damping,
            slowest,
            mixed,
            ehl,
            rest,
        };
        let laps = KNOWN.map(|(numbers, _)| lap(numbers));
        for (edge, (numbers, known)) in found(&laps, TOLERANCE).iter().zip(KNOWN) {
            assert!((edge.drive_speed - known).abs() < 1e-7, "{numbers:?}: {edge:?}");
        }
        let without_slopes = by_parabolas(&laps, TOLERANCE, &Work::default()).unwrap();
        for (edge, (numbers, known)) in without_slopes.iter().zip(KNOWN) {
            let difference = edge.unwrap().drive_speed - known;
            assert!(difference.abs() < 1e-7, "{numbers:?}: {edge:?}");
        }
    }

    #[test]
    fn an_edge_is_the_same_among_others() {
        let laps: Vec<SlipLap> = all_kinds(150).collect();
        for (lap, edge) in laps.iter().zip(found(&laps, 1e-9)) {
            assert_eq!(found(&[*lap], 1e-9), [edge]);
        }
    }

    #[test]
    fn slopes_lead_to_the_edges_found_without() {
        let laps: Vec<SlipLap> = all_kinds(700).collect();
        let edges = by_slopes(&laps, TOLERANCE, &Work::default()).unwrap();
        let unsolved: Vec<SlipLap> =
            laps.iter().zip(&edges).filter(|(_, e)| e.is_none()).map(|(lap, _)| *lap).collect();
        let higher = where_drag_rises(&unsolved, TOLERANCE, &Work::default()).unwrap();
        let without_slopes = by_parabolas(&laps, TOLERANCE, &Work::default()).unwrap();
        let differences: Vec<f64> = edges
            .iter()
            .zip(without_slopes)
            .filter_map(|(edge, without_slopes)| {
                Some(edge.as_ref()?.drive_speed - without_slopes?.drive_speed)
            })
            .collect();
        assert!(differences.len() > laps.len() * 7 / 10, "{}", differences.len());
        assert!(differences.iter().all(|difference| *difference < 400.0 * TOLERANCE));
        // parabolas miss the least cycles where the laps of a stiff belt are lost
        let same =
            differences.iter().filter(|difference| difference.abs() < 400.0 * TOLERANCE).count();
        assert!(same > differences.len() * 96 / 100, "{same}");
        let unknown = higher.iter().filter(|edge| edge.is_none()).count();
        assert!(unknown < laps.len() / 18, "{unknown}");
    }
}
