//! Where smooth sliding and stick-slip part (Figs. 13-14).
//!
//! | module | responsibility                                                                     |
//! |--------|------------------------------------------------------------------------------------|
//! | `fold` | drive speed at which a slip lap comes back to its start, many at once              |
//! | `band` | lower edge, transition and upper fold of a belt, for every closure                 |

mod band;
mod fold;

pub use band::{Band, Method, bands, slip_lap};
pub use fold::{Fold, SlipLap};

/// Folds of laps that begin at their own slowest point: the unstable cycles, and `V*` where that is `v_s`.
#[must_use]
pub fn cycles(laps: &[SlipLap], tolerance: f64) -> Vec<Option<Fold>> {
    fold::folds(laps, tolerance, |index, _| {
        let SlipLap { damping, slowest, mixed, .. } = laps[index];
        Some((damping * slowest.powf(mixed), slowest))
    })
}
