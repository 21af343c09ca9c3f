//! The lower edge from cycles at some slowest speeds, and about the least of them: slow, but it takes no slopes.

use super::cycles;
use super::fold::{Fold, capped};
use super::secant::below_three;
use super::slip_lap::SlipLap;
use super::valley::LowerEdge;
use crate::error::Error;
use crate::work::Work;

/// Slowest speeds, over those there are, at which cycles are looked for.
const LOOKS: [f64; 7] = [0.0, 0.3, 0.45, 0.6, 0.75, 0.88, 0.96];
/// Rounds of looks about the least of them, and how close they come to it.
const ROUNDS: usize = 24;
const CLOSE: f64 = 1e-6;

/// The edges that are where drag begins to rise: one lap there tells of each cycle that it is faster.
pub(super) fn where_drag_rises(
    laps: &[SlipLap],
    tolerance: f64,
    work: &Work,
) -> Result<Vec<Option<LowerEdge>>, Error> {
    let looked = capped(&looks_at(laps).collect::<Vec<_>>(), tolerance, work)?;
    let (sevens, _) = looked.as_chunks::<{ LOOKS.len() }>();
    Ok(laps
        .iter()
        .zip(sevens)
        .map(|(lap, seven)| {
            let drive_speed = lap.rising_from();
            let above = |fold: &Option<Fold>| fold.is_some_and(|f| f.drive_speed >= drive_speed);
            let laps = seven.iter().flatten().map(|fold| fold.laps).sum();
            seven.iter().all(above).then_some(LowerEdge { drive_speed, laps })
        })
        .collect())
}

/// The laps at whose slowest speeds cycles are looked for.
fn looks_at(laps: &[SlipLap]) -> impl Iterator<Item = SlipLap> {
    laps.iter().flat_map(|lap| {
        let reach = lap.rising_from() - lap.slowest;
        LOOKS.map(|share| SlipLap { slowest: lap.slowest + share * reach, ..*lap })
    })
}

/// The same edges without slopes: the least of some cycles, and of those at the bottoms of parabolas through them.
pub(super) fn by_looks(
    laps: &[SlipLap],
    tolerance: f64,
    work: &Work,
) -> Result<Vec<Option<LowerEdge>>, Error> {
    let mut edges: Vec<LowerEdge> =
        laps.iter().map(|lap| LowerEdge { drive_speed: lap.rising_from(), laps: 0 }).collect();
    // (slowest speed, drive speed) of the cycles looked at, by slowest speed
    let mut seen: Vec<Vec<(f64, f64)>> = vec![Vec::new(); laps.len()];
    let mut look = |seen: &mut Vec<Vec<(f64, f64)>>, which: &[usize], with: &[SlipLap]| {
        for ((i, lap), fold) in which.iter().zip(with).zip(cycles(with, tolerance, work)?) {
            let Some(fold) = fold else { continue };
            let place = seen[*i].partition_point(|(slowest, _)| *slowest < lap.slowest);
            seen[*i].insert(place, (lap.slowest, fold.drive_speed));
            let edge = &mut edges[*i];
            edge.drive_speed = edge.drive_speed.min(fold.drive_speed);
            edge.laps += fold.laps;
        }
        Ok(())
    };
    // all at once, so that a single belt has company in the lanes
    let which: Vec<usize> = (0..laps.len()).flat_map(|i| [i; LOOKS.len()]).collect();
    look(&mut seen, &which, &looks_at(laps).collect::<Vec<_>>())?;
    for round in 0..ROUNDS {
        let (mut which, mut with) = (Vec::new(), Vec::new());
        for (i, points) in seen.iter().enumerate() {
            for slowest in about_the_least(points, laps[i].rising_from(), round % 2 == 0) {
                which.push(i);
                with.push(SlipLap { slowest, ..laps[i] });
            }
        }
        look(&mut seen, &which, &with)?;
    }
    Ok(edges.into_iter().map(Some).collect())
}

/// Where to look next for less than the least of some points: at the bottom of the parabola through it and its neighbours, or
/// halfway to each of them.
fn about_the_least(points: &[(f64, f64)], end: f64, parabola: bool) -> Vec<f64> {
    let Some(least) = (0..points.len()).min_by(|i, j| points[*i].1.total_cmp(&points[*j].1)) else {
        return Vec::new();
    };
    if let Some(bottom) = below_three(points).filter(|_| parabola) {
        return vec![bottom];
    }
    let here = points[least].0;
    let before = least.checked_sub(1).map(|i| points[i].0);
    let after = points.get(least + 1).map_or(end, |point| point.0);
    let halfway = |there: f64| 0.5 * (here + there);
    let far = |there: &f64| (there - here).abs() > CLOSE * here;
    before.into_iter().chain([after]).map(halfway).filter(far).collect()
}
