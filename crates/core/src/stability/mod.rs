//! Where smooth sliding and stick-slip part (Figs. 13-14).
//!
//! | module | responsibility                                                                     |
//! |--------|------------------------------------------------------------------------------------|
//! | `fold` | drive speed at which a slip lap comes back to its start, many at once              |
//! | `cycles` | swings that never stick, by their slowest speed                                 |
//! | `band` | lower edge, transition and upper fold of a belt, for every closure                 |

mod band;
mod cycles;
mod fold;

pub use band::{Band, Method, bands, slip_lap};
pub use cycles::{Swing, cycles, swings};
pub use fold::{Fold, SlipLap};
