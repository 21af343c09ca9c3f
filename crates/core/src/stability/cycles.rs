//! Swings around steady sliding that never stick, each by its slowest speed.

use super::fold::{self, Fold};
use super::slip_lap::{SlipLap, slip_lap};
use crate::drag::Drag;
use crate::error::{Error, above, at_least, below};
use crate::motion::{Drivetrain, checked_tolerance};
use crate::work::Work;

/// Relative distance of the laps on either side of one, to see which way the drive speed goes.
const NEAR: f64 = 1e-4;

/// A lap between `slowest` and `fastest` at a constant drive speed; not a number where there is none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Swing {
    /// Least belt speed.
    pub slowest: f64,
    /// Greatest belt speed.
    pub fastest: f64,
    /// The drive speed that it asks for.
    pub drive_speed: f64,
    /// Whether a neighbour comes to it: where it does not, it is the edge between sliding and sticking.
    pub stable: bool,
}

/// The swing of each of the `slowest` speeds, from the stick speed to below the transition speed.
///
/// # Errors
/// If a speed or the tolerance is out of that range, there is no spring or mass, or `work` is stopped. None if the drag does not fall
/// below the transition and rise above it, or has bristles, which remember.
pub fn swings(
    train: &Drivetrain,
    drag: &Drag,
    slowest: &[f64],
    tolerance: f64,
    work: &Work,
) -> Result<Option<Vec<Swing>>, Error> {
    checked_tolerance(tolerance)?;
    above("stiffness", train.stiffness(), 0.0)?;
    let Some(lap) = slip_lap(train, drag) else { return Ok(None) };
    let transition = drag.transition_speed();
    let many = work.apart(u64::MAX);
    // a cycle is stable where its drive speed rises with its slowest speed: where a slower drive swings wider
    let mut laps = Vec::with_capacity(3 * slowest.len());
    for speed in slowest {
        many.take(1)?;
        at_least("slowest", *speed, drag.stick_speed())?;
        let own = below("slowest", *speed, transition)? / transition;
        let most = 0.5 * (lap.rising_from().max(own) + own);
        let beside = [own, own * (1.0 - NEAR), own * (1.0 + NEAR)];
        laps.extend(beside.map(|s| SlipLap { slowest: s.min(most), ..lap }));
    }
    let mut found = cycles(&laps, tolerance, work)?;
    // where drag only rises from the slowest speed on, nothing keeps a swing up
    for (fold, lap) in found.iter_mut().zip(&laps) {
        *fold = fold.filter(|_| lap.slowest < lap.rising_from());
    }
    let (triples, _) = found.as_chunks::<3>();
    Ok(Some(
        slowest.iter().zip(triples).map(|(s, three)| swing(&lap, *s, transition, three)).collect(),
    ))
}

/// The swing that begins at `slowest`, from its own lap and those beside it.
fn swing(lap: &SlipLap, slowest: f64, transition: f64, found: &[Option<Fold>; 3]) -> Swing {
    let [drive_speed, slower, faster] =
        found.map(|fold| fold.map_or(f64::NAN, |fold| transition * fold.drive_speed));
    // at a node a search that ends at the transition found nothing
    let gone = lap.is_node() && drive_speed <= transition * (1.0 + NEAR * NEAR);
    if gone {
        return Swing { slowest, fastest: f64::NAN, drive_speed: f64::NAN, stable: false };
    }
    let fastest = found[0].map_or(f64::NAN, |fold| transition * fold.speed_max);
    Swing { slowest, fastest, drive_speed, stable: faster > slower }
}

/// Folds of laps that begin at their own slowest point: the unstable cycles, and `V*` where that is `v_s`.
///
/// # Errors
/// If `work` is stopped.
pub fn cycles(laps: &[SlipLap], tolerance: f64, work: &Work) -> Result<Vec<Option<Fold>>, Error> {
    fold::folds(laps, tolerance, work, |index, _| {
        let lap = &laps[index];
        Some((lap.mixed_force(lap.slowest), lap.slowest))
    })
}
