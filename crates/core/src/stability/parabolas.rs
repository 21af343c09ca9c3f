//! The lower edge without slopes: cycles at some slowest speeds, then at the bottoms of parabolas through the least of them.
//!
//! Slow, but it needs no laps that almost come back.

use super::cycles;
use super::rising_edge::{SHARES, sampled};
use super::secant::below_three;
use super::slip_lap::SlipLap;
use super::valley::LowerEdge;
use crate::error::Error;
use crate::work::Work;

/// Rounds of cycles about the least.
const ROUNDS: usize = 24;
/// Relative distance of slowest speeds below which none is tried between them.
const CLOSE: f64 = 1e-6;

/// The least drive speed of the cycles of each lap.
pub(super) fn by_parabolas(
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
    let which: Vec<usize> = (0..laps.len()).flat_map(|i| [i; SHARES.len()]).collect();
    look(&mut seen, &which, &sampled(laps).collect::<Vec<_>>())?;
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
