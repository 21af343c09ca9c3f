//! Where smooth sliding and stick-slip part (Figs. 13-14).
//!
//! | module | responsibility                                                                     |
//! |--------|------------------------------------------------------------------------------------|
//! | `slip_lap` | a belt on two power branches in units that suit it                             |
//! | `secant` | the drive speed at which a lap just comes back, from laps at others              |
//! | `fold` | drive speed at which a slip lap comes back to its start, many at once              |
//! | `half_laps` | a slip lap at one drive speed, forward and back in time                      |
//! | `cycles` | swings that never stick, by their slowest speed                                 |
//! | `lower_edge` | least drive speed of any of them, many at once                              |
//! | `deviation` | what becomes of a small deviation along a lap                                |
//! | `valley` | the bottom of a curve, from laps that do not quite come back                    |
//! | `rising_edge` | lower edges at the speed from which drag rises                             |
//! | `parabolas` | the lower edge from cycles at some slowest speeds, without slopes            |
//! | `band` | lower edge, transition and upper fold of a belt, for every closure                 |
//! | `smooth` | edges of a belt with a smooth closure, decided by a lap or two                   |
//! | `curve_laps` | slip laps and fold of a belt whose drag is a smooth curve                    |
//! | `curve_lanes` | many laps of such belts at once, several to a register                         |
//! | `curve_answers` | what many such belts come to, each by the laps that it asks for               |
//! | `curve_questions` | which laps say where such a belt begins to stick, or what a start comes to |
//! | `curve_start_up` | what a profile of drive speed does to such a belt                             |
//! | `unstable` | the lap between the starts that come to slide and those that come to stick    |

mod band;
mod curve_answers;
mod curve_lanes;
mod curve_laps;
mod curve_questions;
mod curve_start_up;
mod cycles;
mod deviation;
mod fold;
mod half_laps;
mod lower_edge;
mod parabolas;
mod rising_edge;
mod secant;
mod slip_lap;
mod smooth;
mod unstable;
mod valley;

pub use band::{Band, Method, bands};
pub use curve_laps::{CurveBelt, CurveCycle, CurveFold, CurveStart};
pub use curve_questions::{curve_folds, curve_starts};
pub use curve_start_up::{CurveStarted, curve_start_ups};
pub use cycles::{Swing, cycles, swings};
pub use fold::Fold;
pub use slip_lap::{SlipLap, slip_lap};
pub use unstable::{UnstableLap, unstable_lap};
