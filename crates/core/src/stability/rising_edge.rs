//! Lower edges at the speed from which drag rises: there cycles shrink to nothing, and no edge is higher.

use super::fold::{Fold, capped};
use super::slip_lap::SlipLap;
use super::valley::LowerEdge;
use crate::error::Error;
use crate::work::Work;

/// Slowest speeds at which cycles are looked for, as shares of the way from the least to that from which drag rises.
pub(super) const SHARES: [f64; 7] = [0.0, 0.3, 0.45, 0.6, 0.75, 0.88, 0.96];

/// Edges at the speed from which drag rises, where none of the sampled cycles has a slower drive; none elsewhere.
pub(super) fn where_drag_rises(
    laps: &[SlipLap],
    tolerance: f64,
    work: &Work,
) -> Result<Vec<Option<LowerEdge>>, Error> {
    let folds = capped(&sampled(laps).collect::<Vec<_>>(), tolerance, work)?;
    let (sevens, _) = folds.as_chunks::<{ SHARES.len() }>();
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

/// Each lap with all the slowest speeds at which its cycles are looked for.
pub(super) fn sampled(laps: &[SlipLap]) -> impl Iterator<Item = SlipLap> {
    laps.iter().flat_map(|lap| {
        let reach = lap.rising_from() - lap.slowest;
        SHARES.map(|share| SlipLap { slowest: lap.slowest + share * reach, ..*lap })
    })
}
